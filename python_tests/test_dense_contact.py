"""Profiles against tools/dense_contact.py, a second program for the same equations: tread, two contacts, flange."""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

TOOLS = Path(__file__).resolve().parent.parent / "tools"
sys.path.insert(0, str(TOOLS))

import dense_contact  # noqa: E402
from random_states import BENCHMARK_LOAD, BODIES, FRICTION, RADIUS, ROLLING, SPEED, benchmark  # noqa: E402
from wheelrail import Instance  # noqa: E402

# Load, the most that forces may differ over μQ, contacts, inputs. On the tread other cells of the second program change
# its forces by 0.004, in the other states by 0.0006.
TWO_CONTACTS, _, ON_FLANGE, _ = benchmark()
STATES = {
    "tread": (
        (30e3, 6e-3, 1),
        {
            **{"lateral_displacement": -2e-3, "roll_angle": 1e-3, "yaw_angle": 6e-3},
            **{"lateral_speed": 0.15, "yaw_rate": 0.04, "wheel_speed": 1.001 * SPEED / RADIUS},
        },
    ),
    "flange": (
        (30e3, 1e-3, 1),
        {
            **{"lateral_displacement": -6.8e-3, "roll_angle": 0.0, "yaw_angle": -12e-3},
            **{"lateral_speed": -0.2, "yaw_rate": 0.02, "wheel_speed": 1.002 * SPEED / RADIUS},
        },
    ),
    "two contacts of the benchmark": ((1e3 * BENCHMARK_LOAD, 1e-3, 2), TWO_CONTACTS),
    "flange of the benchmark": ((1e3 * BENCHMARK_LOAD, 1e-3, 1), ON_FLANGE),
}
# Along and across.
CELLS = (20, 16)
NAMES = ("force_x", "force_y", "force_z", "peak_pressure", "contacts")


@pytest.mark.parametrize("name", STATES)
def test_a_second_program_agrees(fmu3, name):
    """Forces in the track frame, with yaw, lateral speed and turning; the largest pressure to 1 %."""
    (load, allowed, contacts), inputs = STATES[name]
    with Instance(fmu3, **BODIES, **dense_contact.material(), normal_load=0.0, **ROLLING) as wheel:
        wheel.start()
        wheel.set(normal_load=load, **inputs)
        for _ in range(2):
            wheel.step(0.1)
        *force, peak, count = np.ravel(wheel.get(*NAMES))
        normal_force = np.sum(wheel.get("contact.normal_force"))
    second = dense_contact.of_right_wheel(ROLLING | inputs, normal_force, CELLS)
    assert (count, second.contacts) == (contacts, contacts)
    np.testing.assert_allclose(force, second.force, rtol=0.0, atol=allowed * FRICTION * load)
    assert peak == pytest.approx(1e6 * second.peak, rel=1e-2)


def random_states(*arguments):
    """What the command says to these arguments, and its exit status."""
    command = [sys.executable, TOOLS / "random_states.py", *arguments]
    done = subprocess.run(command, capture_output=True, text=True, timeout=120, check=False)
    return done.stdout + done.stderr, done.returncode


@pytest.mark.usefixtures("fmu3")
def test_random_states_are_compared():
    """One state against finer cells and against the second program, which has as many cells as it is told."""
    for arguments in ([], ["--dense", "--cells", "12", "10"]):
        said, status = random_states("--states", "1", *arguments)
        assert status == 0, said
        assert "forces over μQ: median 0.0" in said
        assert "peak pressure: median 0.0" in said


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        (["--cells", "12", "10"], "--cells goes with --dense"),
        (["--dense", "--cells", "0", "10"], "8 each way are the least"),
        (["--benchmark", "--load", "60"], "--benchmark has its own load"),
        (["--to-the-right", "3", "1"], "from the smaller displacement to the larger one"),
        (["--states", "0"], "at least one state"),
        (["--load", "nan"], "a load above 0"),
    ],
)
def test_what_is_not_compared_is_refused(arguments, words):
    """An option that its mode does not use, and numbers that make no sense."""
    said, status = random_states(*arguments)
    assert status == 2
    assert words in said
