"""studies/multibody: a braked bogie in Exudyn. Momentum, load transfer and slip are those of mechanics."""

import multibody
import numpy as np
import pytest

JOINT = 16.0  # m
BRAKE_START, BRAKE_RAMP = 0.05, 0.1  # s


@pytest.fixture(scope="module")
def result():
    """Return 0.8 s on a track that is even but for a dipped joint, braked early."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(multibody, "BRAKE_START", BRAKE_START)
        patch.setattr(multibody, "BRAKE_RAMP", BRAKE_RAMP)
        track = multibody.Track(joint=JOINT)
        track.amplitude *= 0.0
        return multibody.Bogie(track).run(0.8)


def test_starts_at_rest_vertically(result):
    """The static state is one of the model: until it brakes, loads stay at their static values."""
    before = result["time"] < BRAKE_START
    for axle in ("front", "rear"):
        assert result[f"load_{axle}"][before] == pytest.approx(multibody.STATIC_LOAD, rel=1e-4)


def test_momentum_along_the_track(result):
    """Traction is the only outer force: its impulse is the change of momentum of all bodies.

    To the impulse of one step: generalised alpha weighs the force of a step with that of the step before.
    """
    masses = {"speed_front": multibody.WHEELSET_MASS, "speed_rear": multibody.WHEELSET_MASS}
    masses |= {"frame_speed": multibody.FRAME_MASS, "body_speed": multibody.BODY_MASS}
    momentum = sum(mass * result[name] for name, mass in masses.items())
    force = multibody.WHEELS * (result["traction_force_front"] + result["traction_force_rear"])
    impulse = np.concatenate([[0.0], np.cumsum(force[:-1]) * multibody.STEP])
    assert momentum - momentum[0] == pytest.approx(impulse, abs=multibody.STEP * np.abs(force).max())
    assert impulse[-1] < -30e3


def test_brakes_shift_load_forward(result):
    """The brakes' reaction on the frame, 2 B, is taken by the axles: load of a wheel ± B / (2 a), a half the wheelbase.

    Within 3 %: the frame still swings a little.
    """
    rolling = (result["time"] > 0.35) & (result["place_front"] < JOINT - 3.0)
    shift = multibody.BRAKE_TORQUE / (2.0 * multibody.HALF_WHEELBASE)
    for axle, sign in (("front", 1.0), ("rear", -1.0)):
        assert result[f"load_{axle}"][rolling].mean() - multibody.STATIC_LOAD == pytest.approx(sign * shift, rel=0.03)


def test_joint_unloads_and_slides(result):
    """Behind the dip a wheel is unloaded. The rear wheels, lighter, slide there, get hot and wear more."""
    for axle in ("front", "rear"):
        place, load = result[f"place_{axle}"], result[f"load_{axle}"]
        ahead, behind = (place > JOINT - 4.0) & (place < JOINT - 3.0), np.abs(place - JOINT) < 1.0
        assert load[behind].max() > 1.4 * load[ahead].mean()
        assert load[behind].min() < 0.8 * load[ahead].mean()
        # Traction stays within friction: the mean over the contact at the time.
        used = np.abs(result[f"traction_force_{axle}"][1:]) / load[1:]
        assert np.all(used < 1.001 * result[f"friction_coefficient_{axle}"][1:])
    assert result["slip_creepage_rear"][behind].min() < 2.0 * result["slip_creepage_rear"][ahead].min()
    assert result["peak_temperature_rear"][behind].max() > result["peak_temperature_rear"][ahead].max() + 10.0
    assert result["wear_depth_rear"][behind].max() > 3.0 * result["wear_depth_rear"][ahead].max()
