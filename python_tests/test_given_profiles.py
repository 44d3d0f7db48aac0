"""Profiles of Python as parameters of the component: the forces of their files, not smoothed or inclined anew."""

import os
import pickle
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail as package  # noqa: E402

# The fixture that says, with a reason, where the command line is not built.
pytestmark = pytest.mark.usefixtures("wheelrail")

LOAD = 60e3
# On the tread, in the flange's root, on the flange.
PLACES = (0.0, 5e-3, 6.5e-3)
ROLLING = {"contact_model": "profiles", "slip_source": "vehicle_speed", "patch_grid": "fast", "normal_load": LOAD}
ROLLING |= {"vehicle_speed": 20.0, "wheel_speed": 43.5}


@pytest.fixture(params=["2.0", "3.0"])
def either(request, fmu, fmu3):
    """Return the path of the FMU of each version."""
    return fmu if request.param == "2.0" else fmu3


def forces(fmu, **parameters):
    """Forces of the first step at each place."""
    found = []
    for place in PLACES:
        with package.Instance(fmu, **ROLLING, lateral_displacement=place, **parameters).start() as instance:
            instance.step(0.01)
            found.append(instance.get("force_x", "force_y", "force_z"))
    return np.array(found)


@pytest.fixture
def wheel():
    """Return a wheel that has worn on its tread."""
    return package.Profile("S1002").worn_by([0.075, 0.085, 0.105, 0.115], [0.0, 2e-3, 2e-3, 0.0])


def test_a_profile_makes_the_forces_of_its_file(either, wheel, tmp_path):
    """A built-in one exactly those of its name, others those of the file that they write or are from."""
    wheel.write(tmp_path / "worn.whl")
    own = forces(either, wheel_profile=wheel)
    np.testing.assert_allclose(own, forces(either, wheel_profile=tmp_path / "worn.whl"), atol=1e-9 * LOAD)
    read = package.Profile(tmp_path / "worn.whl")
    np.testing.assert_allclose(forces(either, wheel_profile=read), own, atol=1e-9 * LOAD)
    new = forces(either, wheel_profile="S1002", rail_profile="54E1")
    given = {"wheel_profile": package.Profile("S1002"), "rail_profile": package.Profile("54E1")}
    np.testing.assert_array_equal(forces(either, **given), new)
    assert np.abs(new - own).max() > 0.01 * LOAD


def test_simulate_takes_profiles(fmu, wheel, tmp_path):
    """By name and in `parameters`."""
    wheel.write(tmp_path / "worn.prw")
    table = {"time": [0.0, 0.01], "lateral_displacement [mm]": [0.0, 1.0]}
    tables = [
        package.simulate(table, step=0.01, fmu=fmu, **ROLLING, **given)
        for given in (
            {"wheel_profile": tmp_path / "worn.prw"},
            {"wheel_profile": wheel},
            {"parameters": {"wheel_profile": wheel, "rail_profile": package.Profile("60E1")}},
        )
    ]
    for other in tables[1:]:
        np.testing.assert_allclose(other["force_y"], tables[0]["force_y"], atol=1e-9 * LOAD)


def test_a_rail_is_inclined_once(either):
    """It goes with `rail_inclination` 0 alone, and has the forces of the one that the component inclines."""
    rail = package.Profile("60E1", inclination=1 / 40)
    own = forces(either, rail_profile=rail, rail_inclination=0.0)
    # Its curvature jumps between two points of its file, not at one: 1.3e-5 at the flange's root, on few cells.
    np.testing.assert_allclose(own, forces(either), atol=3e-5 * LOAD)
    for again in (rail, rail.smoothed(1e-3), rail.worn_by([0.05], [1e-5])):
        with pytest.raises(ValueError, match=r"rail_inclination = 0\.025: .* inclined already; rail_inclination=0"):
            package.Instance(either, rail_profile=again)
    with package.Instance(either, rail_profile=rail, rail_inclination=0.0) as instance:
        with pytest.raises(ValueError, match=r"rail_inclination = 0\.05"):
            instance.set(rail_inclination=0.05)
        instance.set(rail_inclination=0.05, rail_profile="60E1")
        with pytest.raises(ValueError, match=r"rail_inclination = 0\.05"):
            instance.set(rail_profile=rail)


def test_a_profile_is_smoothed_once(either, wheel, tmp_path):
    """Smoothing is for files: beside a profile that is none it is refused, with what to do."""
    wheel.write(tmp_path / "worn.prw")
    smooth = package.Profile(tmp_path / "worn.prw", smoothing=4e-3)
    own = forces(either, wheel_profile=smooth)
    np.testing.assert_allclose(
        own, forces(either, wheel_profile=tmp_path / "worn.prw", profile_smoothing=4e-3), atol=1e-8 * LOAD
    )
    with pytest.raises(ValueError, match=r"profile_smoothing = 0\.004: wheel_profile is a Profile, .* smoothing=…"):
        package.Instance(either, wheel_profile=smooth, profile_smoothing=4e-3)
    with package.Instance(either, wheel_profile=smooth) as instance, pytest.raises(ValueError, match="is a Profile"):
        instance.set(profile_smoothing=4e-3)
    with package.Instance(either, wheel_profile=package.Profile("S1002"), profile_smoothing=4e-3):
        pass


def test_what_is_no_profile_of_the_body(either, wheel):
    """The other body's is refused by its parameter, and a text stays a text."""
    with pytest.raises(ValueError, match=r"rail_profile = <Profile S1002: wheel, .*>: the profile of a rail is needed"):
        package.Instance(either, rail_profile=wheel)
    with pytest.raises(ValueError, match=r"wheel_profile = <Profile 60E1: .* a wheel is needed"):
        package.simulate(stop_time=0.1, fmu=either, wheel_profile=package.Profile("60E1"))


def test_as_long_as_it_is_needed(either, wheel):
    """After a reset, in an instance with the same parameters, in a copy, and in a state that another process loads."""
    instance = package.Instance(either, wheel_profile=wheel, **ROLLING).start()
    instance.step(0.01)
    force = instance.get("force_x")
    inputs = {name: ROLLING[name] for name in ("normal_load", "vehicle_speed", "wheel_speed")}
    like = package.Instance(either, **instance.parameters(), **inputs)
    copy, state = pickle.loads(pickle.dumps(instance)), instance.save().to_bytes()
    for again in (instance.reset(), copy.reset(), like):
        again.start().step(0.01)
        assert again.get("force_x") == force
        again.close()
    assert package.Instance.load(state, either).get("force_x") == force


def test_files_are_gone_with_the_process(fmu3, tmp_path):
    """One file for a profile however often it is given; the process takes it along, and the folder."""
    program = """
import sys
import wheelrail
wheel = wheelrail.Profile("S1002").worn_by([0.1], [1e-4])
rail = wheelrail.Profile("60E1", inclination=0.025)
profiles = {"contact_model": "profiles", "slip_source": "vehicle_speed", "patch_grid": "fast"}
given = {"wheel_profile": wheel, "rail_profile": rail, "rail_inclination": 0.0}
first, second = (wheelrail.Instance(sys.argv[1], **profiles, **given).start() for _ in range(2))
assert first.parameters() == second.parameters()
print(first.parameters()["wheel_profile"])
print(first.worn_profiles().wheel)
try:
    wheelrail.Instance(sys.argv[1], rail_profile=first.worn_profiles().rail)
except ValueError as error:
    print(error)
"""
    environment = {"PYTHONPATH": str(REPOSITORY / "python"), "TMPDIR": str(tmp_path), "TEMP": str(tmp_path)}
    done = subprocess.run(
        [sys.executable, "-c", program, fmu3], capture_output=True, text=True, check=False, env=os.environ | environment
    )
    assert done.returncode == 0, done.stderr
    path, worn, refused = done.stdout.splitlines()
    assert Path(path).name == "S1002.prw"
    assert tmp_path in Path(path).parents
    assert worn.startswith("<Profile S1002.prw: wheel")
    assert "inclined already" in refused
    assert list(tmp_path.iterdir()) == []
