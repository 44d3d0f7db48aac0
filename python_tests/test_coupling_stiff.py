"""studies/stiff: how long the explicit master's steps may be; the implicit ones beyond that, and through a stop."""

import re
import sys
from pathlib import Path

import numpy as np
import pytest
import stiff

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import update_docs  # noqa: E402


@pytest.fixture(scope="module")
def reference():
    """Return the iterating master at a short step; half of it moves the force by 1e-4."""
    return stiff.run("iterating", 100e-6)


@pytest.mark.parametrize("speed", [1.0, 0.1, 0.0])
def test_largest_step_is_that_of_the_spring(speed):
    """Over 1 ms, and spring and damper in series say it to 10 %; with the damper alone it would be 57 µs at 1 m/s."""
    measured = stiff.largest_stable_step(speed)
    damping = stiff.damper(speed) if speed > 0.0 else np.inf
    assert measured > 1e-3
    assert measured == pytest.approx(stiff.predicted(stiff.spring(), damping), rel=0.1)
    assert 2.0 * stiff.WHEEL_INERTIA / damping < 0.1e-3


def test_explicit_master_fails_beyond_its_limit(reference):
    """Within 5 % at 80 % of the limit of 2 ms; at 125 % the force swings from one limit of friction to the other."""
    assert stiff.error(stiff.run("explicit", 1.6e-3), reference) < 0.05
    assert stiff.error(stiff.run("explicit", 2.5e-3), reference) > 0.5


@pytest.mark.parametrize("master", ["linearly implicit", "iterating"])
def test_implicit_masters_beyond_the_limit(master, reference):
    """At twice the limit within 0.2 %, at five times it within 1 %."""
    assert stiff.error(stiff.run(master, 4e-3), reference) < 2e-3
    assert stiff.error(stiff.run(master, 10e-3), reference) < 1e-2


@pytest.mark.parametrize(
    ("master", "step"),
    [("linearly implicit", 2e-3), ("linearly implicit", 10e-3), ("iterating", 2e-3), ("iterating", 10e-3)],
)
def test_stop_hold_and_drive_off(master, step):
    """Held, it moves by less than a nanometre; off again, the books of energy close.

    Missing may be what the spring loses where it is let go in one step, (μN)²/2k at most, and 3 % of the friction
    energy, at a creepage of 1e-4; of the energy that is turned over that is a ten-thousandth.
    """
    result = stiff.run(master, step, stiff.STOPPING)
    way, speed = stiff.held(result)
    assert way < 1e-9
    assert speed < 10.0 * stiff.TOLERANCE
    assert result["vehicle_speed"][-1] > 0.8
    stiffness = stiff.spring()
    books = stiff.balance(result, stiffness)
    lost = 0.5 * (stiff.FRICTION * stiff.LOAD * stiff.WHEEL_RADIUS) ** 2 / stiffness
    assert abs(books["missing"]) < lost + 0.03 * books["friction"]
    assert abs(books["missing"]) < 1e-4 * (books["drive"] - books["brake"])


def test_derivatives_of_the_last_step_are_not_enough():
    """Without the trial step a master is a step late: the swing on the spring goes on, at micrometres."""

    def late(contact, speeds, forces, manoeuvre, now, step, _memory):
        speeds, brake = stiff.balanced(speeds, speeds, forces, contact.slopes(), manoeuvre, now, step)
        return speeds, contact.forces(speeds, step), brake

    stiff.MASTERS["late"] = late
    way, _ = stiff.held(stiff.run("late", 2e-3, stiff.STOPPING))
    del stiff.MASTERS["late"]
    assert way > 5e-6


def test_page_shows_what_is_measured():
    """The page's largest steps are those of now, to 5 %."""
    rows = update_docs.blocks(update_docs.STIFF.read_text())["limits"].splitlines()[2:]
    shown = {
        float(speed): float(step) for speed, step in re.findall(r"\| ([\d.]+) m/s .* ([\d.]+) ms \|", "\n".join(rows))
    }
    assert set(shown) == set(stiff.LIMIT_SPEEDS)
    for speed in (1.0, 0.0):
        measured = 1e3 * stiff.largest_stable_step(speed)
        assert shown[speed] == pytest.approx(measured, rel=0.05), "run `make couplings-docs` and commit what it changes"
