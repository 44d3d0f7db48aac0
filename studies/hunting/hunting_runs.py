"""What studies/hunting shows: a linear model with Kalker's coefficients, and runs of the wheelset on two patches.

Klingel's wavelength without the suspension; growth of small swings and the critical speed; a slow ramp of the speed;
the limit cycle, its temperature and its wear; and a wheelset at a constant yaw angle in a curve, beside CONTACT.
"""

from types import SimpleNamespace

import numpy as np
from helpers import WHEEL_RADIUS, show
from kalker import coefficients, ellipse
from running_wheelset import (
    CLEARANCE,
    CONICITY,
    FREE,
    HALF_GAUGE,
    LOAD,
    SIDES,
    Suspension,
    Wheel,
    Wheelset,
    motion,
    running,
    system,
)

GROWTH_SPEEDS = (60.0, 67.5, 75.0, 82.5, 90.0)  # m/s
RAMP, RAMP_TIME, RAMP_STEP = (68.0, 90.0), 8.0, 2e-3  # m/s, s, s
CYCLE_SPEED, CYCLE_SETTLED, CYCLE_END = 84.0, 1.5, 2.0  # m/s, s, s


# ---- the linear model -----------------------------------------------------------------------------------------------


def creep_slopes(side, speed, axes, table, shear_modulus):
    """Derivatives of a wheel's forces with respect to its motion in the middle, by Kalker's linear theory."""
    c11, c22, c23, c33 = table
    area, size = axes[0] * axes[1], np.sqrt(axes[0] * axes[1])
    of_creepages = (shear_modulus * area) * np.array(
        [
            [-WHEEL_RADIUS * c11, 0.0, 0.0],
            [c11, 0.0, 0.0],
            [0.0, -c22, -size * c23],
            [0.0, size * c23, -(size**2) * c33],
        ]
    )
    spin = -side * CONICITY / WHEEL_RADIUS
    creepages = np.array([[WHEEL_RADIUS, -1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, -spin, 0.0, 1.0]])
    return of_creepages @ creepages / speed


def measured_slopes(speed, step=0.05):
    """Derivatives of both wheels' forces in the middle, from the component itself."""
    wheels = [Wheel(side, running(speed), speed) for side in SIDES.values()]
    slopes = [wheel.settle(step).slopes() for wheel in wheels]
    for wheel in wheels:
        wheel.close()
    return slopes


def measured_coefficients(axes, speed, step=0.05):
    """C11, C22, C23, -C32 and C33 over Hertz's ellipse, from the component's derivatives at creepages of 0.

    Also half the contact's length and half its breadth, as the component has them [m].
    """
    wheel = Wheel(0.0, running(speed), speed).settle(step)
    slopes, its_axes = wheel.slopes() * speed, 0.5 * np.array(wheel.get("contact_length", "contact_breadth"))
    shear_modulus, area = wheel.get("shear_modulus")[0], axes[0] * axes[1]
    wheel.close()
    values = (slopes[1, 0] / WHEEL_RADIUS, -slopes[2, 2], -slopes[2, 3], slopes[3, 2], -slopes[3, 3])
    sizes = area ** np.array([1.0, 1.0, 1.5, 1.5, 2.0])
    return np.array(values) / (shear_modulus * sizes), its_axes


def theory():
    """Semi-axes [m], C11, C22, C23 and C33, shear modulus [Pa]: Hertz's and Kalker's, for the component's bodies."""
    wheel = Wheel(0.0, running(10.0), 10.0)
    names = ("shear_modulus", "lame_lambda", "rail_transverse_curvature", "wheel_transverse_curvature")
    shear_modulus, lame, rail, tread = wheel.get(*names)
    wheel.close()
    poisson = 0.5 * lame / (lame + shear_modulus)
    axes = ellipse(LOAD, 0.5 / WHEEL_RADIUS, 0.5 * (rail + tread), shear_modulus, poisson)
    return axes, coefficients(axes[0] / axes[1], poisson), shear_modulus


def hunting_mode(matrix):
    """The eigenvalue of the least damped oscillation [1/s]."""
    values = np.linalg.eigvals(matrix)
    swinging = values[values.imag > 1e-3]
    return swinging[np.argmax(swinging.real)]


def critical_speed(slopes_at, suspension, low=5.0, high=150.0):
    """The speed at which an oscillation begins to grow, by bisection; slopes_at(speed) are those of both sides."""
    while high - low > 1e-3:
        middle = 0.5 * (low + high)
        grows = hunting_mode(system(running(middle), middle, slopes_at(middle), suspension)).real > 0.0
        low, high = (low, middle) if grows else (middle, high)
    return 0.5 * (low + high)


def eigenvalue(found, name, speed):
    """Of the linear model at a speed, with the derivatives of one of the names in found.linear [1/s]."""
    return hunting_mode(system(running(speed), speed, found.linear[name](speed), found.suspension))


# ---- what is measured -----------------------------------------------------------------------------------------------


def crossings(place, y):
    """Where a swing crosses the middle to the left."""
    before = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    return place[before] - y[before] * (place[before + 1] - place[before]) / (y[before + 1] - y[before])


def klingel():
    """Wavelength of a wheelset without a suspension that rolls on pure cones (Klingel 1883) [m]."""
    return 2.0 * np.pi * np.sqrt(WHEEL_RADIUS * HALF_GAUGE / CONICITY)


FREE_SPEED = 10.0  # m/s


def free_rolling(waves=2.4, y=3e-3, step=5e-3):
    """Let a wheelset without a suspension roll from a displacement."""
    wheelset = Wheelset(FREE_SPEED, y, FREE)
    result = wheelset.run(waves * klingel() / FREE_SPEED, FREE_SPEED, step)
    wheelset.close()
    return result


def mode(result, start, stride=5):
    """The eigenvalue [1/s] of a swing from a time on: of the map that takes (y, ψ) over some steps, by least squares.

    By then what decays fast has gone, and displacement and yaw make one oscillation.
    """
    rows = result[result["time"] >= start][::stride]
    swing = np.column_stack([rows["y"], rows["yaw"]])
    step = rows["time"][1] - rows["time"][0]
    onward = np.linalg.lstsq(swing[:-1], swing[1:], rcond=None)[0]
    values = np.log(np.linalg.eigvals(onward).astype(complex)) / step
    return values[np.argmax(values.imag)]


def measured_mode(speed, duration=0.9, step=2e-3, y=0.3e-3):
    """The eigenvalue of small swings, by letting them swing; they end before they reach a flange."""
    wheelset = Wheelset(speed, y)
    result = wheelset.run(duration, speed, step)
    wheelset.close()
    return mode(result, 0.25)


def zero(speeds, growths):
    """The speed at which the growth is 0."""
    order = np.argsort(growths)
    return float(np.interp(0.0, np.asarray(growths)[order], np.asarray(speeds)[order]))


def amplitude(result):
    """Amplitude of a swing at any instant [m]: displacement and yaw are a quarter of a cycle apart."""
    share = np.sqrt(np.mean(result["y"] ** 2) / np.mean(result["yaw"] ** 2))
    return np.hypot(result["y"], share * result["yaw"])


def loses_stability(result):
    """The speed at which the amplitude of a slow ramp is least: there it neither decays nor grows.

    By a parabola through its logarithm, in the middle half of the speeds.
    """
    speed = result["speed"]
    low, high = speed.min(), speed.max()
    inside = np.abs(speed - 0.5 * (low + high)) < 0.25 * (high - low)
    curve = np.polynomial.Polynomial.fit(speed[inside], np.log(amplitude(result)[inside]), 2)
    return float(curve.deriv().roots()[0])


def last_cycle(result):
    """The rows from the last but one crossing to the left to the last."""
    first, last = crossings(result["time"], result["y"])[-2:]
    return (result["time"] >= first) & (result["time"] < last)


def books(result, wheelset):
    """Where the work of the frame's pull went [J], and what the component says its friction took."""
    spent = {name: result[name][-1] - result[name][0] for name in ("guide_work", "creep_work", "damper_work")}
    energy = wheelset.energy(result)
    spent["stored"] = energy[-1] - energy[0]
    spent["missing"] = spent["guide_work"] - spent["creep_work"] - spent["damper_work"] - spent["stored"]
    spent["friction"] = sum(np.ptp(result[f"friction_energy_{side}"]) for side in SIDES)
    return spent


def on_tread(position, y):
    """Places on the tread of the left wheel, from the contact in the middle towards the flange [m]."""
    return y - position[::-1]


def mean_wear(wheelset, rows, points=161):
    """Mean wear by the left wheel's passages of some rows over the place towards its flange: (place, rail, tread) [m].

    The rail is worn around the contact, which stays where it is; the tread is worn further towards the flange by y, to
    the left. A point of the tread loses per turn what the rail loses, given the same wear coefficient.
    """
    chosen = [
        (wheelset.rows[row][wheelset.COLUMNS.index("y")], left) for row, (left, _) in wheelset.profiles if rows[row]
    ]
    reach = max(np.abs(on_tread(position, y)).max() for y, (position, _, _) in chosen)
    place = np.linspace(-reach, reach, points)

    def mean(share):
        layers = [
            np.interp(place, on_tread(position, share * y), wear[::-1], left=0.0, right=0.0)
            for y, (position, _, wear) in chosen
        ]
        return np.mean(layers, axis=0)

    return place, mean(0.0), mean(1.0)


# ---- at a constant yaw angle ----------------------------------------------------------------------------------------

CURVE_RADIUS, CURVE_SPEED = 600.0, 20.0  # m, m/s; a curve to the left
YAW_ANGLES = np.array([0.0, 0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0, 12.0, 15.0]) * 1e-3
CURVE_OUTPUTS = ("lateral_force", "spin_moment", "traction_force", "friction_coefficient", "peak_temperature")
CURVE_OUTPUTS += ("wear_number",)
# CONTACT (open version of 2025-07-23, steady rolling), like bodies of the component's default material, 80 kN, μ = 0.3,
# r₀ = 0.46 m, a round ellipse, 20 m/s: F_y/(μN) on grids of 40 and 80, M_z/(μN c) on 80, over the lateral creepage.
REFERENCE_LOAD, REFERENCE_FRICTION = 80e3, 0.3
REFERENCE = np.array(
    [
        [0.0002, 0.0005, 0.001, 0.0015, 0.002, 0.003, 0.005, 0.01],
        [0.09665, 0.23062, 0.42571, 0.58655, 0.71606, 0.89220, 0.99908, 0.99982],
        [0.09555, 0.22805, 0.42090, 0.58105, 0.71053, 0.88788, 0.99884, 0.99982],
        [0.03558, 0.07667, 0.11734, 0.13073, 0.12493, 0.08361, 0.01868, 0.00859],
    ]
)


def in_curve(angles=YAW_ANGLES):
    """Forces of both wheels on the rolling line of a curve, over the yaw angle from the curve's radius.

    There, at y = -r₀ b₀/(λ R), the radii make up for the ways: what creeps is sideways, and spin. The cant carries the
    centrifugal force.
    """
    y = -WHEEL_RADIUS * HALF_GAUGE / (CONICITY * CURVE_RADIUS)
    table = {"yaw angle [rad]": np.asarray(angles)}
    for name, side in SIDES.items():
        states = [np.array([y, angle, 0.0, CURVE_SPEED / CURVE_RADIUS, CURVE_SPEED / WHEEL_RADIUS]) for angle in angles]
        wheel, rows = Wheel(side, states[0], CURVE_SPEED), []
        for state in states:
            wheel.motion = motion(side, state, CURVE_SPEED)
            rows.append(wheel.settle(0.05).get(*CURVE_OUTPUTS))
        wheel.close()
        table |= {f"{output}_{name}": values for output, values in zip(CURVE_OUTPUTS, np.array(rows).T, strict=True)}
    return table


def beside_contact():
    """F_y/(μN) and M_z/(μN c) of the component at CONTACT's creepages, and CONTACT's F_y in the limit of fine grids.

    CONTACT's error is of first order: the limit is as far from the finer grid again, less a quarter.
    """
    cold = {"friction_law": 1, "friction_cold": REFERENCE_FRICTION, "thermal_expansion": 0.0, "wear_coefficient": 0.0}
    wheel = Wheel(
        0.0,
        running(20.0),
        20.0,
        normal_load=REFERENCE_LOAD,
        rail_transverse_curvature=1.0 / WHEEL_RADIUS,
        **cold,
    )
    found = []
    for creepage in REFERENCE[0]:
        wheel.motion = motion(0.0, running(20.0), 20.0)
        wheel.motion[2] = -20.0 * creepage
        wheel.settle(0.05)
        size = np.sqrt(np.prod(0.5 * np.array(wheel.get("contact_length", "contact_breadth"))))
        largest = REFERENCE_FRICTION * REFERENCE_LOAD
        found.append((wheel.forces[2] / largest, -wheel.forces[3] / (largest * size)))
    wheel.close()
    limit = REFERENCE[2] + 0.75 * (REFERENCE[2] - REFERENCE[1])
    return np.array(found).T, limit


# ---- everything, once -----------------------------------------------------------------------------------------------


def measure():
    """Run everything that is shown."""
    found = SimpleNamespace(suspension=Suspension())
    found.theory = theory()
    found.coefficients = measured_coefficients(found.theory[0], GROWTH_SPEEDS[0])
    middle = measured_slopes(GROWTH_SPEEDS[0])
    found.linear = {
        "Kalker's coefficients": lambda speed: [creep_slopes(side, speed, *found.theory) for side in SIDES.values()],
        # At given creepages forces do not depend on the speed, and their derivatives by speeds are as its inverse.
        "the component's derivatives": lambda speed: [slope * GROWTH_SPEEDS[0] / speed for slope in middle],
    }
    found.critical = {name: critical_speed(slopes, found.suspension) for name, slopes in found.linear.items()}
    found.free = free_rolling()
    found.free_modes = {
        f"linear, {name}": hunting_mode(system(running(FREE_SPEED), FREE_SPEED, slopes_at(FREE_SPEED), FREE))
        for name, slopes_at in found.linear.items()
    }
    found.free_modes["rolling freely"] = mode(found.free, 0.25)
    found.modes = []
    for number, speed in enumerate(GROWTH_SPEEDS):
        found.modes.append(measured_mode(speed))
        show((number + 1) / len(GROWTH_SPEEDS), "small swings")
    found.critical["small swings"] = zero(GROWTH_SPEEDS, [value.real for value in found.modes])

    slow, fast = RAMP
    wheelset = Wheelset(slow, 2e-3)
    found.ramp = wheelset.run(RAMP_TIME, lambda now: slow + (fast - slow) * now / RAMP_TIME, RAMP_STEP, title="ramp")
    wheelset.close()
    found.critical["slow ramp"] = loses_stability(found.ramp)

    found.wheelset = Wheelset(CYCLE_SPEED, CLEARANCE)
    found.wheelset.run(CYCLE_SETTLED, CYCLE_SPEED, title="limit cycle")
    found.cycle = found.wheelset.run(CYCLE_END, CYCLE_SPEED, strips_every=4)
    found.wheelset.close()
    found.last = last_cycle(found.cycle)
    found.wear = mean_wear(found.wheelset, found.last)
    found.curve = in_curve()
    found.contact = beside_contact()
    return found
