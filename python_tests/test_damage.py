"""Damage beside wear, from Python under both versions of FMI: that of the contacts, and parameters that are refused."""

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
    "vehicle_speed": 20.0,
    "wheel_speed": 20.1 / 0.46,
    "lateral_displacement": 5e-3,
    "yaw_angle": 5e-3,
}


@pytest.fixture(params=["fmu", "fmu3"])
def archive(request):
    """The component of one version of FMI."""
    return request.getfixturevalue(request.param)


def outputs(archive, names, **parameters):
    """Outputs after some steps."""
    with package.Instance(archive, **PROFILES, **parameters).start() as instance:
        for _ in range(5):
            instance.step(1e-3)
        return [value for name in names for value in instance.get(*name)]


def test_fatigue_is_that_of_the_wear_numbers(archive):
    """Of each contact, and of the wheel the largest; with the thresholds that are given."""
    thresholds = {"rcf_threshold": 5.0, "rcf_peak": 40.0, "rcf_balance": 90.0, "rcf_peak_damage": 2e-5}
    values = outputs(archive, [["contact.wear_number", "contact.rcf_damage", "rcf_damage"]], **thresholds)
    # Of up to four contacts.
    wear_numbers, found, wheel = np.array(values[:4]), values[4:8], values[8]
    assert np.max(wear_numbers) > 5.0
    # One slope before 40 N, the other goes on past 90 N.
    expected = np.where(wear_numbers < 40.0, 2e-5 * (wear_numbers - 5.0) / 35.0, 2e-5 * (90.0 - wear_numbers) / 50.0)
    np.testing.assert_allclose(found, np.where(wear_numbers > 5.0, expected, 0.0), rtol=1e-12)
    assert wheel == max(damage for damage, number in zip(found, wear_numbers, strict=True) if number != 0.0)


def test_the_index_falls_with_the_yield_stress_and_austenite_is_where_it_is_hot(archive):
    """Without a yield stress the index is the largest friction that the contact uses."""
    names = [["surface_fatigue_index", "peak_pressure", "friction_coefficient", "austenite_depth", "peak_temperature"]]
    soft = outputs(archive, names, shear_yield_stress=0.0, friction_law="constant", austenite_temperature=310.0)
    hard = outputs(archive, names, friction_law="constant")
    # A step's shear is found to 1e-6 of the largest pressure.
    assert soft[0] == pytest.approx(0.45, rel=1e-6)
    # Where the pressure is largest the contact slips, too.
    assert hard[0] == pytest.approx(0.45 - 300e6 / hard[1], rel=1e-3)
    assert hard[4] > 310.0
    assert soft[3] > 1e-6
    assert hard[3] == 0.0


def test_thresholds_that_do_not_ascend_are_refused_with_their_names(archive):
    """The refusal names both and their values."""
    with pytest.raises(package.SimulationError, match=r"rcf_peak.*10.*rcf_threshold.*15"):
        outputs(archive, [], rcf_peak=10.0)
