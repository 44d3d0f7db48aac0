"""examples/stiff.py: where the explicit master fails, the two others are stable and accurate at 20 times the step."""

import sys
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "examples"))

import stiff  # noqa: E402


@pytest.fixture(scope="module")
def limit():
    """Return the explicit master's largest stable step at the start, twice the time constant."""
    return 2.0 * stiff.time_constant()


@pytest.fixture(scope="module")
def reference():
    """Return the explicit master at a step that is stable; its error is 1e-5, by comparison with 10 µs."""
    return stiff.run("explicit", 40e-6)


def test_time_constant_is_tens_of_microseconds(limit):
    """Walking pace: J over the slope of the torque."""
    assert 10e-6 < 0.5 * limit < 50e-6


def test_explicit_master_fails_beyond_its_limit(limit, reference):
    """Stable at 80 % of 2 τ; at 130 % the force swings by most of its largest value."""
    assert stiff.error(stiff.run("explicit", stiff.STOP / round(stiff.STOP / (0.8 * limit))), reference) < 1e-3
    assert stiff.error(stiff.run("explicit", stiff.STOP / round(stiff.STOP / (1.3 * limit))), reference) > 0.3


@pytest.mark.parametrize("master", ["linearly implicit", "iterating"])
def test_implicit_masters_at_twenty_times_the_step(master, limit, reference):
    """Both are within 0.3 % at more than 20 and 1.5 % at more than 80 times the explicit limit, of order 1 or more."""
    steps = np.array([1.5625e-3, 3.125e-3, 6.25e-3])
    assert steps[0] > 20.0 * limit
    assert steps[-1] > 80.0 * limit
    errors = np.array([stiff.error(stiff.run(master, step), reference) for step in steps])
    assert errors[0] < 3e-3
    assert errors[-1] < 1.5e-2
    assert np.all(np.log2(errors[1:] / errors[:-1]) > 0.8), errors
