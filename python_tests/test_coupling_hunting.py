"""studies/hunting: a wheelset on two patches settles below the linear model's critical speed, and hunts above."""

import re
from itertools import pairwise
from pathlib import Path

import hunting_runs as hunting
import kalker
import numpy as np
import pytest
import running_wheelset
from running_wheelset import (
    CLEARANCE,
    LOAD,
    SIDES,
    Suspension,
    Wheel,
    Wheelset,
    motion,
    motion_slopes,
    running,
)

REPOSITORY = Path(__file__).resolve().parent.parent


@pytest.fixture(scope="module")
def theory():
    """Return Hertz's semi-axes, Kalker's coefficients and the shear modulus."""
    return hunting.theory()


@pytest.fixture(scope="module")
def critical(theory):
    """Return the critical speed of the linear model with Kalker's coefficients."""
    return hunting.critical_speed(
        lambda speed: [hunting.creep_slopes(side, speed, *theory) for side in SIDES.values()], Suspension()
    )


@pytest.fixture(scope="module")
def slopes(critical):
    """Return the derivatives of both wheels' forces at that speed, from the component."""
    return hunting.measured_slopes(critical)


@pytest.fixture(scope="module")
def cycle(critical):
    """Return 1.1 s at 112 % of the critical speed, from a flange on, and the wheelset with the last profiles."""
    wheelset = Wheelset(1.12 * critical, CLEARANCE)
    wheelset.run(0.7, 1.12 * critical)
    result = wheelset.run(1.1, 1.12 * critical, strips_every=4)
    wheelset.close()
    return result, wheelset


def test_motion_and_its_derivatives():
    """The derivatives are those of the motion; in the middle the creepages are those of the docstring."""
    state, speed = np.array([3e-3, 2e-3, 0.1, 0.05, 40.0]), 20.0
    for side in SIDES.values():
        slopes = motion_slopes(side, state, speed)
        for number in range(5):
            change = 1e-4 * np.eye(5)[number]
            difference = (motion(side, state + change, speed) - motion(side, state - change, speed)) / 2e-4
            assert slopes[:, number] == pytest.approx(difference, abs=1e-9)
        wheel_speed, vehicle_speed, lateral_speed, spin_rate = motion(side, running(speed), speed)
        assert wheel_speed * hunting.WHEEL_RADIUS == pytest.approx(vehicle_speed)
        assert lateral_speed == 0.0
        assert spin_rate / speed == pytest.approx(-side * running_wheelset.CONICITY / hunting.WHEEL_RADIUS)


def test_load_on_the_cones():
    """The wheels' loads are normal to the cones: the axle rolled by λ y/b0 they push back, yawed by ψ they turn on."""
    free, y, yaw = running_wheelset.FREE, 2e-3, 3e-3
    thrust = turning = 0.0
    for side in SIDES.values():
        # The normal of the left cone leans to the right, more so when the left wheel has climbed.
        roll = running_wheelset.CONICITY * y / running_wheelset.HALF_GAUGE
        thrust += LOAD * (-side * running_wheelset.CONICITY - roll)
        along = -side * running_wheelset.HALF_GAUGE * yaw
        turning += along * LOAD * -side * running_wheelset.CONICITY
    assert free.forces(np.array([y, yaw, 0.0, 0.0, 0.0])) == pytest.approx([thrust, turning, 0.0])


def test_table_is_that_of_the_verification():
    """The two rows of kalker.py are those of src/verification/kalker.rs, which has them from b/a = 0.1 on."""
    text = (REPOSITORY / "src" / "verification" / "kalker.rs").read_text()
    numbers = [float(number) for number in re.findall(r"\d+\.\d+", text.split("const LONG")[1].split("];")[0])]
    for ratio, rows in kalker.TABLE.items():
        first = 12 * (round(10 * ratio) - 1)
        assert numbers[first : first + 12] == [value for row in rows for value in row]


def test_coefficients_are_kalkers(theory):
    """At creepages of 0, C11, C22, C23 and C33 within 1 %, of which the table's interpolation takes a part.

    -C32, which weighs the contact's edge and in the limit of fine grids is C23, within 2.5 %. Length and breadth of the
    contact within 0.5 %.
    """
    axes, (c11, c22, c23, c33), _ = theory
    found, its_axes = hunting.measured_coefficients(axes, 60.0)
    assert found[[0, 1, 2, 4]] == pytest.approx([c11, c22, c23, c33], rel=0.01)
    assert found[3] == pytest.approx(c23, rel=0.025)
    assert its_axes == pytest.approx(axes, rel=0.005)
    wheel = Wheel(0.0, running(60.0), 60.0).settle(0.05)
    slopes, linear = wheel.slopes(), hunting.creep_slopes(0.0, 60.0, *theory)
    wheel.close()
    # Torques over the wheel's radius and the contact's size, and spin as a speed at its edge: all of one magnitude.
    size = np.sqrt(axes[0] * axes[1])
    lengths = np.array([hunting.WHEEL_RADIUS, 1.0, 1.0, size])
    slopes, linear = (matrix / np.outer(lengths, [hunting.WHEEL_RADIUS, 1.0, 1.0, size]) for matrix in (slopes, linear))
    assert slopes == pytest.approx(linear, rel=0.025, abs=1e-5 * np.abs(linear).max())


def test_wheels_are_mirrored(slopes):
    """Running in the middle, what acts on the left wheel acts on the right one with lateral and spin reversed."""
    mirror = np.array([1.0, 1.0, -1.0, -1.0])
    other = slopes[1] * np.outer(mirror, mirror)
    assert slopes[0] == pytest.approx(other, rel=1e-6, abs=1e-6 * np.abs(other).max())


def test_rolls_in_klingels_wavelength(critical, slopes):
    """Without a suspension, 2 pi sqrt(r0 b0 / conicity) within 0.05 %, and a growth by inertia as the linear model's.

    Klingel knows no inertia: at 10 m/s that lengthens the wave by 6e-5 by the linear model, and the midpoint rule's
    (w h)^2/12 does by as much. Growth is read off two waves to 0.03 % of itself.
    """
    found, speed = hunting.mode(hunting.free_rolling(1.9), 0.25), hunting.FREE_SPEED
    assert 2.0 * np.pi * speed / found.imag == pytest.approx(hunting.klingel(), rel=5e-4)
    slopes = [slope * critical / speed for slope in slopes]
    linear = hunting.hunting_mode(hunting.system(running(speed), speed, slopes, running_wheelset.FREE))
    assert found.real == pytest.approx(linear.real, rel=2e-3)


def test_critical_speed_is_that_of_the_linear_model(critical, slopes):
    """The eigenvalues with the component's derivatives and with Kalker's coefficients, and swings: within 2 %.

    The cones' spin takes a part of the friction, which Kalker's coefficients leave out: some 10 % of the lateral
    slope, and 1.8 % of the speed. Swings grow as the component's derivatives say, to 0.03 % of a cycle's angular
    frequency, which the midpoint rule's (w h)^2/12 makes 0.05 % less; between 95 and 105 % of the speed growth is so
    straight that 0 is found to 0.2 %.
    """
    suspension = Suspension()
    linear = hunting.critical_speed(lambda speed: [slope * critical / speed for slope in slopes], suspension)
    assert linear == pytest.approx(critical, rel=0.02)
    speeds, growths = (0.95 * critical, 1.05 * critical), []
    for speed in speeds:
        found = hunting.measured_mode(speed)
        at = [slope * critical / speed for slope in slopes]
        expected = hunting.hunting_mode(hunting.system(running(speed), speed, at, suspension))
        assert found.real == pytest.approx(expected.real, abs=3e-4 * expected.imag)
        assert found.imag == pytest.approx(expected.imag, rel=1e-3)
        growths.append(found.real)
    assert growths[0] < 0.0 < growths[1]
    assert hunting.zero(speeds, growths) == pytest.approx(linear, rel=3e-3)


def test_settles_below(critical):
    """At 85 % of the critical speed a swing from flange to flange is down to a tenth after 1.5 s."""
    wheelset = Wheelset(0.85 * critical, CLEARANCE)
    result = wheelset.run(1.5, 0.85 * critical, step=2e-3)
    wheelset.close()
    assert hunting.amplitude(result)[-1] < 0.1 * CLEARANCE


def test_hunts_above(cycle):
    """At 112 % it goes from flange to flange, cycle after cycle the same, left and right alike.

    To 0.1 %: the highest of rows that are 1 ms apart is up to 0.02 % below the summit.
    """
    result, _ = cycle
    starts = hunting.crossings(result["time"], result["y"])
    heights = [result["y"][(result["time"] >= a) & (result["time"] < b)].max() for a, b in pairwise(starts)]
    assert min(heights[-3:]) > CLEARANCE
    assert heights[-1] == pytest.approx(heights[-2], rel=1e-3)
    last = hunting.last_cycle(result)
    assert -result["y"][last].min() == pytest.approx(heights[-1], rel=1e-3)
    warm = result["peak_temperature_left"][last]
    assert warm.max() > warm.min() + 1.0


def test_energy(cycle):
    """What the frame pulls goes into creep, dampers and springs, but for 0.02 %; and creep is the component's friction.

    The balance is the master's, of second order in the step. Friction is |traction times slip| summed over the
    contact, creep is forces times creepages: in a contact that a cycle hardly disturbs on its way through, they agree
    to 0.1 %.
    """
    result, wheelset = cycle
    spent = hunting.books(result, wheelset)
    assert spent["guide_work"] > 0.0 and spent["creep_work"] > 0.0 and spent["damper_work"] > 0.0
    assert abs(spent["missing"]) < 2e-4 * spent["guide_work"]
    assert spent["friction"] == pytest.approx(spent["creep_work"], rel=1e-3)


def test_wear_across_the_tread(cycle):
    """Over a cycle the tread is worn as much as the rail, wider and less deep; to the left, nearer to the flange.

    As much: to the sampling of both at the same places, measured 0.05 %. Wider: by the way of the contact, some two
    clearances and more. Nearer: by the mean displacement, weighted by the wear, to a twentieth of a clearance.
    """
    result, wheelset = cycle
    last = hunting.last_cycle(result)
    place, rail, tread = hunting.mean_wear(wheelset, last)
    assert rail.max() > 0.0
    assert tread.sum() == pytest.approx(rail.sum(), rel=2e-3)
    assert tread.max() < 0.6 * rail.max()
    width = {name: np.ptp(place[wear > 0.05 * wear.max()]) for name, wear in (("rail", rail), ("tread", tread))}
    assert width["tread"] > width["rail"] + 2.0 * CLEARANCE
    to_the_left = last & (result["y"] > 0.5 * CLEARANCE)
    place, rail, tread = hunting.mean_wear(wheelset, to_the_left)
    nearer = place @ tread / tread.sum() - place @ rail / rail.sum()
    assert nearer == pytest.approx(result["y"][to_the_left].mean(), abs=0.05 * CLEARANCE)


def test_yawed_in_a_curve():
    """Spin pulls the left wheel to the left and the right one to the right; yawed, both go left, within the friction.

    At large angles, where both slide, the contact is hot and friction falls: so does the force.
    """
    curve = hunting.in_curve(np.array([0.0, 2.0, 8.0, 15.0]) * 1e-3)
    left, right = curve["lateral_force_left"], curve["lateral_force_right"]
    assert left[0] > 0.0 > right[0]
    assert np.all(left[:3] > right[:3])
    for side in SIDES:
        force, friction = curve[f"lateral_force_{side}"], curve[f"friction_coefficient_{side}"]
        assert np.all(np.abs(force) < 1.001 * friction * LOAD)
        assert force[0] < force[1] < force[2] > force[3]
        assert np.all(np.diff(curve[f"peak_temperature_{side}"]) > 0.0)


def test_creep_curve_beside_contact():
    """F_y over the lateral creepage within 0.003 of CONTACT's limit, and M_z of its finer grid."""
    (lateral, moment), limit = hunting.beside_contact()
    assert lateral == pytest.approx(limit, abs=0.003)
    assert moment == pytest.approx(hunting.REFERENCE[3], abs=0.003)
