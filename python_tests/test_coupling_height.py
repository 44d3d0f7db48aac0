"""studies/height: the contact's stiffness, and the largest steps of masters beside the sampled system's."""

import height
import numpy as np
import pytest


@pytest.fixture(scope="module")
def wheel():
    """Return a wheel under the load of the study, its height, its stiffness, its state."""
    wheel = height.Wheel()
    place = wheel.height_of(height.LOAD)
    yield wheel, place, wheel.stiffness(), wheel.save()
    wheel.close()


def test_stiffness_is_that_of_a_difference(wheel):
    """To 0.2 %: the difference of 0.2 µm has 2e-6 of curvature, and the unit's forces are solved to 1e-9.

    And near 3/2 of the load over the approach, which holds for constant curvatures, to 5 %.
    """
    unit, place, stiffness, first = wheel
    change, forces = 1e-7, []
    for sign in (1.0, -1.0):
        unit.restore(first)
        forces.append(unit.force(place + sign * change, 0.1))
    assert stiffness == pytest.approx((forces[1] - forces[0]) / (2.0 * change), rel=2e-3)
    unit.restore(first)
    unit.force(place, 0.1)
    assert stiffness == pytest.approx(1.5 * height.LOAD / unit.get("penetration")[0], rel=0.05)


def test_theory_is_that_of_late_forces():
    """For small damping a held force allows 2 d/K, both at once 2 d/(3 K), speed first 2/ω: to second order."""
    stiffness, ratio = 1.1e9, 1e-3
    critical = 2.0 * np.sqrt(stiffness * height.HALF_MASS)
    bodies = height.free("", ratio * critical)
    found = {
        name: height.limit(lambda step: height.growth(master, bodies, step, stiffness), stiffness, 1e-7, parts=60)  # noqa: B023
        for name, master in height.MASTERS.items()
    }
    # limit() takes a growth of 1e-4 in a radian for none, a tenth of this damping.
    held = 2.0 * ratio * critical / stiffness
    assert found["force held"] == pytest.approx(held, rel=0.12)
    assert found["both at once"] == pytest.approx(held / 3.0, rel=0.12)
    assert found["speed first"] == pytest.approx(2.0 / height.frequency(stiffness), rel=2.0 * ratio)
    assert found["with the derivative"] == np.inf


@pytest.mark.parametrize("master", ["both at once", "force held", "speed first"])
def test_steps_beside_the_limit(wheel, master):
    """With a fifth of critical damping a bounce dies away 5 % below the sampled system's step, and grows 5 % above."""
    unit, place, stiffness, first = wheel
    bodies = height.free("", 0.2 * 2.0 * np.sqrt(stiffness * height.HALF_MASS))
    step = height.limit(
        lambda step: height.growth(height.MASTERS[master], bodies, step, stiffness), stiffness, parts=40
    )
    below, above = (
        height.measured_growth(unit, place, first, height.MASTERS[master], bodies, factor * step, stiffness)
        for factor in (0.95, 1.05)
    )
    assert below < 1.0 < above


def test_derivative_makes_any_step_stable(wheel):
    """Without a damper a held force grows at 0.1 ms, by K h/(4 m) in a second; with the derivative 20 ms are stable."""
    unit, place, stiffness, first = wheel
    bodies, step = height.free("no damper"), 1e-4
    held = height.measured_growth(unit, place, first, height.held, bodies, step, stiffness)
    # 5 %: friction damps a bounce of 31 1/s by some 0.5 1/s.
    assert np.log(held) / step == pytest.approx(stiffness * step / (4.0 * height.HALF_MASS), rel=0.05)
    assert height.measured_growth(unit, place, first, height.implicit, bodies, 20e-3, stiffness) < 1.0
