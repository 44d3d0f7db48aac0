"""studies/longitudinal: two FMUs in three masters. The masters agree, and the energy balance closes."""

import longitudinal as model
import numpy as np
import pytest
import stiff
from test_hosts import has_tbb

needs_tbb = pytest.mark.skipif(not has_tbb(), reason="no libtbb.so.12 (Debian: libtbb12), see tools/hosts.py")


@pytest.fixture(scope="module")
def runs():
    """Return the short manoeuvre, braking onto wet rail, at the three steps in FMPy."""
    if not model.WHEELSET.exists():
        pytest.exit(f"{model.WHEELSET} is not there: run `make couplings-set-up` first", returncode=2)
    return {step: model.in_fmpy(step, model.SHORT_STOP, wheelset=model.SHORT) for step in model.STEPS}


@pytest.fixture(scope="module")
def books(runs):
    """Return the balance of each run."""
    return {step: model.balance(result) for step, result in runs.items()}


@pytest.mark.parametrize("master", ["libcosim", pytest.param("ecos", marks=needs_tbb)])
def test_masters_agree(master, runs, tmp_path):
    """One SSP file in libcosim and in ecos, against the plain loop: to 1e-9 of each value's largest magnitude.

    All three exchange at the end of each step and let both sides step with what they got (Jacobi), so they compute the
    same; libcosim's time is in whole nanoseconds, which changes the last bits of the step.
    """
    step = model.STEPS[0]
    ssp = model.write_ssp(tmp_path / "longitudinal.ssp", wheelset=model.SHORT)
    result = model.in_own_process(master, step, model.SHORT_STOP, 10, ssp)
    assert len(result) == round(model.SHORT_STOP / step / 10)
    assert result["wheelset.friction_scale"][-1] == pytest.approx(0.3)
    assert model.disagreement(result, runs[step]) < 1e-9


def test_energy_missing_shrinks_with_the_step(books):
    """What the exchange at communication points loses is of order 1 in the step.

    It is at most 0.1 % of the friction energy at 0.4 ms. What the contact's friction power leaves out, the work on the
    thermal bulge and on the worn surface, does not depend on the coupling, and is below 0.3 % of the friction energy.
    """
    lost = np.array([np.abs(books[step]["coupling"]).max() for step in model.STEPS])
    assert np.log2(lost[:-1] / lost[1:]) == pytest.approx(np.ones(2), abs=0.05)
    friction = books[model.STEPS[0]]["friction"][-1]
    assert friction > 10e3
    assert lost[0] < 1e-3 * friction
    bulge = np.array([books[step]["bulge"][-1] for step in model.STEPS])
    # Of the contact's own implicit step, of order 1 too.
    assert bulge == pytest.approx(bulge[-1], rel=5e-3)
    assert np.all(np.abs(bulge) < 3e-3 * friction)


def test_bulge_wear_and_spring_are_what_is_left():
    """Without thermal expansion and wear only what the contact's spring holds is left, T²/2k in each wheel: to 1 %.

    The spring is that of studies/stiff at 60 kN; from the wheelset's load it differs by 0.3 %.
    """
    contact = {"thermal_expansion": 0.0, "wear_coefficient": 0.0}
    result = model.in_fmpy(model.STEPS[-1], model.SHORT_STOP, contact=contact, wheelset=model.SHORT)
    held = 0.5 * result["contact.traction_force"][-1] ** 2 / stiff.spring() * stiff.WHEEL_RADIUS**2
    assert held > 0.05
    assert model.balance(result)["bulge"][-1] == pytest.approx(model.WHEELS * held, rel=1e-2)


def test_wheel_slides_and_is_caught(runs):
    """On wet rail the wheel slides, at the friction limit, and the slide protection holds it short of locking."""
    end = runs[model.STEPS[-1]][-1]
    assert -0.25 < end["contact.slip_creepage"] < -0.05
    assert 0.2 < end["wheelset.brake_pressure"] < 0.6
    used = -end["contact.traction_force"] / end["wheelset.normal_load"]
    # At most Coulomb's bound, but for round-off.
    assert 0.97 < used / end["contact.friction_coefficient"] < 1.0 + 1e-12
    # Hot: the friction has fallen below the cold 0.45 times the wet 0.3.
    assert end["contact.friction_coefficient"] < 0.8 * 0.45 * 0.3
    assert end["contact.peak_temperature"] > 293.15 + 80.0
