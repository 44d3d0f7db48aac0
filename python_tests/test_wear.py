"""Profiles that wear, from Python: depths of an instance, the worn profiles, and their measures and files."""

import sys
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail as package  # noqa: E402

# The fixture that says, with a reason, where the command line is not built.
pytestmark = pytest.mark.usefixtures("wheelrail")

PROFILES = {
    "contact_model": "profiles",
    "slip_source": "vehicle_speed",
    "patch_grid": "fast",
    "depth_nodes": 9,
    "wheel_profile_wear": True,
    "rail_profile_wear": True,
    "rail_wear_length": 3.0,
    "wheel_wear_coefficient": 1e-12,
    "wear_acceleration": 300.0,
    "profile_wear_points": 800,
    "vehicle_speed": 20.0,
    "wheel_speed": 20.1 / 0.46,
    "lateral_displacement": 6.6e-3,
    "yaw_angle": 0.01,
}


@pytest.fixture
def worn(fmu3):
    """An instance whose flange has worn."""
    with package.Instance(fmu3, **PROFILES).start() as instance:
        for _ in range(10):
            instance.step(1e-3)
        yield instance


def test_depths_of_an_instance(worn):
    """They hold the area that the outputs have, where the contact is; a saved state takes them along."""
    wear = worn.profile_wear()
    assert {values.shape for values in wear} == {(800,)}
    for arcs, depth, area in (
        (wear.wheel_arc_length, wear.wheel_depth, "wheel_worn_area"),
        (wear.rail_arc_length, wear.rail_depth, "rail_worn_area"),
    ):
        assert np.sum(depth) * (arcs[1] - arcs[0]) == pytest.approx(worn.get(area)[0], rel=1e-9)
    (position,) = worn.get("contact.wheel_position")[:1]
    assert wear.wheel_position[np.argmax(wear.wheel_depth)] == pytest.approx(position, abs=5e-3)
    state = worn.save()
    worn.step(1e-3)
    assert np.max(worn.profile_wear().wheel_depth) > np.max(wear.wheel_depth)
    worn.restore(state)
    np.testing.assert_array_equal(worn.profile_wear().wheel_depth, wear.wheel_depth)


def test_worn_profiles_are_measured_and_written(worn, tmp_path):
    """Measures are those of the outputs but for the last step; each format is read back as the same wheel and rail."""
    wheel, rail = worn.worn_profiles()
    new = package.Profile("S1002")
    thickness, gradient, area = worn.get("flange_thickness", "flange_gradient", "wheel_worn_area")
    assert wheel.measures().flange_thickness == pytest.approx(thickness, abs=5e-6)
    assert wheel.measures().flange_gradient == pytest.approx(gradient, abs=5e-6)
    assert thickness < 32.5e-3 - 1e-7
    assert wheel.worn_area(new) == pytest.approx(area, rel=0.02)
    assert rail.body == "rail"
    assert wheel.source.endswith(", worn")
    plain = {"y_to": "field", "z": "up"}
    options = {"mpt": {"unit": "mm", **plain}, "csv": plain}
    for profile, endings in ((wheel, ("prw", "whl", "mpt", "whe", "csv")), (rail, ("prr", "ban", "mpt", "rai", "csv"))):
        for ending in endings:
            path = tmp_path / f"worn.{ending}"
            profile.write(path)
            again = package.Profile(path, body=profile.body, **options.get(ending, {}))
            at = np.linspace(-0.03, 0.03, 50)
            own, other = (np.interp(at, found.points["y"], found.points["z"]) for found in (profile, again))
            np.testing.assert_allclose(other, own, atol=2e-7)


def test_what_has_no_worn_profiles(fmu, fmu3):
    """Another contact model, and FMI 2.0, which has no arrays."""
    with package.Instance(fmu3).start() as instance, pytest.raises(ValueError, match="contact_model = 'profiles'"):
        instance.profile_wear()
    with package.Instance(fmu, **PROFILES).start() as instance:
        with pytest.raises(ValueError, match=r"FMI 3\.0"):
            instance.worn_profiles()
        assert instance.get("flange_height")[0] == pytest.approx(28e-3, abs=1e-6)
