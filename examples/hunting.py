"""A suspended wheelset with conical treads on straight track: it settles below its critical speed, and hunts above.

    .venv/bin/python examples/hunting.py            (after `make fmu`; or `make coupling-hunting`)

running_wheelset.py has the wheelset, its kinematics and the master: each wheel is an instance of the component, with
contact_model 2, the patch. Here: Klingel's wavelength without the suspension; growth of small swings and the critical
speed, against the linear model with Kalker's coefficients; a slow ramp of the speed; the limit cycle, its temperature
and its wear; and a wheelset at a constant yaw angle in a curve, beside CONTACT. docs/couplings/hunting.md.
"""

from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, RESULTS, SKY, WHEEL_RADIUS, save, show, write_csv
from kalker import coefficients, ellipse
from matplotlib.animation import PillowWriter
from running_wheelset import (
    CLEARANCE,
    CONICITY,
    FLANGE_STIFFNESS,
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


# ---- what is measured -----------------------------------------------------------------------------------------------


def crossings(place, y):
    """Where a swing crosses the middle to the left."""
    before = np.flatnonzero((y[:-1] < 0.0) & (y[1:] >= 0.0))
    return place[before] - y[before] * (place[before + 1] - place[before]) / (y[before + 1] - y[before])


def klingel():
    """Wavelength of a wheelset without a suspension that rolls on pure cones (Klingel 1883) [m]."""
    return 2.0 * np.pi * np.sqrt(WHEEL_RADIUS * HALF_GAUGE / CONICITY)


def free_rolling(waves=2.4, speed=10.0, y=3e-3, step=5e-3):
    """Let a wheelset without a suspension roll from a displacement."""
    wheelset = Wheelset(speed, y, FREE)
    result = wheelset.run(waves * klingel() / speed, speed, step)
    wheelset.close()
    return result


def wavelength(result):
    """Mean distance of the crossings to the left."""
    return np.diff(crossings(result["place"], result["y"])).mean()


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
        wheel, rows = None, []
        for angle in angles:
            state = np.array([y, angle, 0.0, CURVE_SPEED / CURVE_RADIUS, CURVE_SPEED / WHEEL_RADIUS])
            wheel = wheel or Wheel(side, state, CURVE_SPEED)
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


# ---- pictures -------------------------------------------------------------------------------------------------------

LINEAR_LOOK = {"Kalker's coefficients": (BLUE, "-"), "the component's derivatives": (ORANGE, "--")}
SIDE_LOOK = {"left": BLUE, "right": RED}


def eigenvalue(found, name, speed):
    """Of the linear model at a speed."""
    return hunting_mode(system(running(speed), speed, found.linear[name](speed), found.suspension))


def draw_stability(found, free, growth, ramp):
    """Draw Klingel's wave, growth over speed, and the ramp."""
    result = found.free
    free.plot(result["place"], 1e3 * result["y"], color=BLUE, label="without suspension")
    wave = result["y"][0] * np.cos(2.0 * np.pi * result["place"] / klingel())
    free.plot(result["place"], 1e3 * wave, color=BLACK, linestyle=":", label=f"Klingel: {klingel():.2f} m")
    free.set(xlabel="place along the track [m]", ylabel="displacement [mm]", title="Rolling freely", ylim=(-3.5, 5.0))
    free.legend(loc="upper center", ncols=2, fontsize=8)

    speeds = np.linspace(GROWTH_SPEEDS[0], GROWTH_SPEEDS[-1], 40)
    for name, (colour, line) in LINEAR_LOOK.items():
        values = [eigenvalue(found, name, speed).real for speed in speeds]
        growth.plot(speeds, values, color=colour, linestyle=line, label=f"linear, {name}")
    growth.plot(GROWTH_SPEEDS, [value.real for value in found.modes], "o", color=BLACK, label="small swings")
    growth.axhline(0.0, color="#888888", linewidth=0.8)
    growth.set(xlabel="speed [m/s]", ylabel="growth [1/s]", title="Small swings: decay and growth")
    growth.legend(loc="upper left", fontsize=8)

    ramp.plot(found.ramp["speed"], 1e3 * found.ramp["y"], color=BLUE, linewidth=0.5)
    for name, colour, line in (("Kalker's coefficients", BLACK, "--"), ("slow ramp", RED, ":")):
        label = f"{name}: {found.critical[name]:.1f} m/s"
        ramp.axvline(found.critical[name], color=colour, linestyle=line, label=label)
    for edge in (-1e3 * CLEARANCE, 1e3 * CLEARANCE):
        ramp.axhline(edge, color="#888888", linewidth=0.8)
    ramp.set(xlabel="speed [m/s]", ylabel="displacement [mm]", title="Slowly faster", xlim=RAMP, ylim=(-11, 17))
    ramp.legend(loc="upper left", fontsize=8, frameon=True, framealpha=1.0, edgecolor="none")


def draw_cycle(found, swing, heat, across):
    """Draw two cycles with their temperatures, and the wear across rail and tread."""
    start = crossings(found.cycle["time"], found.cycle["y"])[-3]
    shown = found.cycle[found.cycle["time"] >= start]
    place = shown["place"] - shown["place"][0]
    swing.plot(place, 1e3 * shown["y"], color=BLACK, label="displacement [mm]")
    swing.plot(place, 1e3 * shown["yaw"], color=GREEN, label="yaw [mrad]")
    swing.set(title=f"Limit cycle at {CYCLE_SPEED:g} m/s", xlabel="place along the track [m]", ylabel="[mm], [mrad]")
    swing.set(ylim=(-12, 16))
    swing.legend(loc="upper left", ncols=2, fontsize=8)
    for side, colour in SIDE_LOOK.items():
        heat.plot(place, shown[f"peak_temperature_{side}"] - 273.15, color=colour, label=f"{side} wheel")
    heat.set(xlabel="place along the track [m]", ylabel="peak temperature [°C]", title="Its temperature")
    heat.legend(loc="upper right", ncols=2, fontsize=8)
    low, high = heat.get_ylim()
    heat.set_ylim(low, high + 0.12 * (high - low))

    lateral, rail, tread = found.wear
    across.fill_between(1e3 * lateral, 1e9 * rail, color=SKY, alpha=0.5, linewidth=0, label="rail")
    across.plot(1e3 * lateral, 1e9 * tread, color=BLACK, label="tread")
    across.set(xlabel="towards the flange [mm]", ylabel="wear of a passage [nm]")
    across.set(title="Wear at the left, mean of a cycle")
    across.legend(loc="upper right", fontsize=8)


def draw_curve(found, force, heat, reference):
    """Draw forces and temperature over the yaw angle, and what CONTACT has beside it."""
    angle = 1e3 * found.curve["yaw angle [rad]"]
    for side, colour in SIDE_LOOK.items():
        force.plot(angle, 1e-3 * found.curve[f"lateral_force_{side}"], color=colour, label=f"{side} wheel")
        bound = found.curve[f"friction_coefficient_{side}"] * LOAD
        force.plot(angle, 1e-3 * bound, color=colour, linestyle=":", linewidth=1.0)
        heat.plot(angle, found.curve[f"peak_temperature_{side}"] - 273.15, color=colour, label=f"{side} wheel")
    force.plot([], [], color="#777777", linestyle=":", linewidth=1.0, label="friction × load")
    force.set(xlabel="yaw angle [mrad]", ylabel="lateral force [kN]", title=f"In a curve of {CURVE_RADIUS:g} m")
    force.legend(loc="lower right", fontsize=8)
    heat.set(xlabel="yaw angle [mrad]", ylabel="peak temperature [°C]", title="Its temperature")
    heat.legend(loc="lower right", fontsize=8)

    (lateral, moment), limit = found.contact
    creepage = 1e3 * REFERENCE[0]
    reference.semilogx(creepage, lateral, color=BLUE, label="lateral force / μN")
    reference.semilogx(creepage, limit, "o", color=BLUE, markerfacecolor="none")
    reference.semilogx(creepage, moment, color=ORANGE, label="spin moment / μNc")
    reference.semilogx(creepage, REFERENCE[3], "o", color=ORANGE, markerfacecolor="none")
    reference.plot([], [], "o", color=BLACK, markerfacecolor="none", label="CONTACT")
    reference.set(xlabel="lateral creepage [‰]", ylabel="[1]", title="Beside CONTACT, constant friction, no spin")
    ticks = [0.2, 0.5, 1, 2, 5, 10]
    reference.set_xticks(ticks, [f"{tick:g}" for tick in ticks])
    reference.legend(loc="center left", fontsize=8)


def draw(found):
    """Draw all panels."""
    figure, panels = plt.subplots(3, 3, figsize=(13.0, 10.5), layout="constrained")
    draw_stability(found, *panels[0])
    draw_cycle(found, *panels[1])
    draw_curve(found, *panels[2])
    save(figure, "hunting.png")


LARGER = 40.0  # displacement and yaw, in the animation
HALF_WHEEL = np.array([[-0.46, -0.46, 0.46, 0.46, -0.46], [-0.06, 0.06, 0.06, -0.06, -0.06]])  # m


def draw_wheelset(axes, found, row, colours):
    """Draw the wheelset from above, with the path of its middle, the forces on its wheels and their temperatures."""
    now, before = found.cycle[row], found.cycle[: row + 1]
    before = before[before["place"] > now["place"] - 16.0]
    axes.clear()
    for rail in (-HALF_GAUGE, HALF_GAUGE):
        axes.plot([-4.2, 1.2], [rail, rail], color="#999999", linewidth=4, solid_capstyle="butt")
    axes.plot(0.25 * (before["place"] - now["place"]), LARGER * before["y"], color=SKY, linewidth=1.5)
    angle, shift = LARGER * now["yaw"], LARGER * now["y"]
    turn = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    axle = turn @ np.array([[0.0, 0.0], [-1.0, 1.0]])
    axes.plot(axle[0], axle[1] + shift, color="#445566", linewidth=3)
    for side, sign in SIDES.items():
        outline = turn @ (HALF_WHEEL + np.array([[0.0], [sign * HALF_GAUGE]]))
        colour = plt.cm.plasma(colours(now[f"peak_temperature_{side}"] - 273.15))
        axes.fill(outline[0], outline[1] + shift, facecolor=colour, edgecolor="#333333", zorder=3)
        tail = turn @ [0.0, sign * HALF_GAUGE] + [0.0, shift]
        tip = tail + np.array([now[f"traction_force_{side}"], now[f"lateral_force_{side}"]]) / 20e3
        axes.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": GREEN, "linewidth": 2.0}, zorder=4)
    axes.set(xlim=(-4.2, 1.2), ylim=(-1.5, 1.5), aspect="equal", xticks=[], yticks=[])
    axes.grid(False)
    axes.set_title(f"{now['speed']:.0f} m/s, y = {1e3 * now['y']:+.1f} mm (movements × {LARGER:g}; path shortened)")


def animate(found, frames=60):
    """The last two cycles: from above, and temperature and wear across the tread of the left wheel."""
    first = crossings(found.cycle["time"], found.cycle["y"])[-3]
    profiles = [profile for profile in found.wheelset.profiles if found.cycle["time"][profile[0]] >= first]
    profiles = profiles[:: max(1, round(len(profiles) / frames))]
    hottest = max(found.cycle[f"peak_temperature_{side}"][found.last].max() for side in SIDES) - 273.15
    coldest = min(found.cycle[f"peak_temperature_{side}"][found.last].min() for side in SIDES) - 273.15
    colours = plt.Normalize(coldest, hottest)
    base = min(left[1].min() for _, (left, _) in profiles) - 273.15
    most = max(left[2].max() for _, (left, _) in profiles)
    reach = 1e3 * np.abs(found.wear[0]).max()
    figure = plt.figure(figsize=(7.2, 6.0), layout="constrained", dpi=80)
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.5, 1])
    above, (heat, worn) = top.subplots(), bottom.subplots(1, 2)
    scale = top.colorbar(plt.cm.ScalarMappable(colours, "plasma"), ax=above, shrink=0.8)
    scale.set_label("peak temperature [°C]")
    RESULTS.mkdir(exist_ok=True)
    path, writer = RESULTS / "hunting.gif", PillowWriter(fps=15)
    with writer.saving(figure, path, dpi=80):
        for number, (row, (left, _)) in enumerate(profiles):
            draw_wheelset(above, found, row, colours)
            position, temperature, wear = left
            place = 1e3 * on_tread(position, found.cycle["y"][row])
            for axes, values, bottom_value, top_value, label in (
                (heat, temperature - 273.15, base, hottest, "temperature [°C]"),
                (worn, 1e9 * wear, 0.0, 1e9 * most, "wear of a passage [nm]"),
            ):
                axes.clear()
                axes.fill_between(place, values[::-1], bottom_value, color=ORANGE, alpha=0.8)
                axes.set(xlim=(-reach, reach), xlabel="on the left tread, towards the flange [mm]", ylabel=label)
                axes.set_ylim(bottom_value, top_value + 0.05 * (top_value - bottom_value))
            writer.grab_frame()
            show((number + 1) / len(profiles), "animation")
    plt.close(figure)
    print(f"  wrote results/{path.name}")


# ---- tables ---------------------------------------------------------------------------------------------------------


def table(head, rows):
    """A table in Markdown."""
    return "\n".join([f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)])


def tables(found):
    """The tables of the page."""
    axes, (c11, c22, c23, c33), _ = found.theory
    its, its_axes = found.coefficients
    head = ["", "a", "b", "C₁₁", "C₂₂", "C₂₃", "−C₃₂", "C₃₃"]
    lines = [
        [name, *(f"{1e3 * value:.2f} mm" for value in semi), *(f"{value:.3g}" for value in values)]
        for name, semi, values in (
            ("Hertz, Kalker's table", axes, (c11, c22, c23, c23, c33)),
            ("the component", its_axes, its),
        )
    ]
    made = {"coefficients": table(head, lines)}
    kalker = found.critical["Kalker's coefficients"]
    made["critical"] = table(
        ["critical speed by", "", "against Kalker's"],
        [[name, f"{speed:.1f} m/s", f"{100 * (speed / kalker - 1):+.1f} %"] for name, speed in found.critical.items()],
    )
    complex_number = "{0.real:.2f} 1/s, {1:.2f} Hz".format
    lines = []
    for speed, value in zip(GROWTH_SPEEDS, found.modes, strict=True):
        values = [*(eigenvalue(found, name, speed) for name in found.linear), value]
        lines.append([f"{speed:g} m/s", *(complex_number(value, value.imag / (2.0 * np.pi)) for value in values)])
    made["growth"] = table(["speed", *(f"linear, {name}" for name in found.linear), "small swings"], lines)
    made["wavelength"] = table(
        ["Klingel, 2π√(r₀b₀/λ)", "rolling freely"], [[f"{klingel():.3f} m", f"{wavelength(found.free):.3f} m"]]
    )
    made["cycle"] = cycle_table(found)
    (lateral, moment), limit = found.contact
    lines = [
        [f"{1e3 * creepage:g} ‰", *(f"{value:.4f}" for value in values)]
        for creepage, *values in zip(REFERENCE[0], lateral, limit, moment, REFERENCE[3], strict=True)
    ]
    head = ["lateral creepage", "F_y/μN", "CONTACT's limit", "M_z/μNc", "CONTACT, n = 80"]
    return made | {"contact": table(head, lines)}


def cycle_table(found):
    """What the limit cycle is like."""
    cycle, spent = found.cycle[found.last], books(found.cycle, found.wheelset)
    hottest = max(cycle[f"peak_temperature_{side}"].max() for side in SIDES) - 273.15
    sideways = cycle["lateral_force_left"] + cycle["lateral_force_right"]
    # Both rails' lateral forces, the flange's too, act a radius below the axle.
    at_rails = sideways - FLANGE_STIFFNESS * Suspension.flange(cycle["y"])
    shift = WHEEL_RADIUS / (2.0 * HALF_GAUGE) * np.abs(at_rails).max()
    duration = cycle["time"][-1] - cycle["time"][0]
    _, rail, tread = found.wear
    rows = {
        "amplitude": f"{1e3 * np.abs(cycle['y']).max():.2f} mm, {1e3 * np.abs(cycle['yaw']).max():.2f} mrad",
        "frequency, wavelength": f"{1.0 / duration:.2f} Hz, {CYCLE_SPEED * duration:.1f} m",
        "largest lateral force of both wheels": f"{1e-3 * np.abs(sideways).max():.1f} kN",
        "largest temperature": f"{hottest:.1f} °C",
        "wear of a passage, deepest: mean over the rail, over the tread": f"{1e9 * rail.max():.3f}, "
        f"{1e9 * tread.max():.3f} nm",
        f"pull of the frame over {CYCLE_END:g} s": f"{spent['guide_work']:.0f} J",
        "of it creep, dampers, stored": f"{spent['creep_work']:.0f}, {spent['damper_work']:.0f}, "
        f"{spent['stored']:.0f} J",
        "missing": f"{spent['missing']:.2f} J",
        "the component's friction against the creep": f"{100 * (spent['friction'] / spent['creep_work'] - 1):+.2f} %",
        "left out: shift of load between the wheels": f"{100 * shift / LOAD:.1f} % of the load",
    }
    return table([f"limit cycle at {CYCLE_SPEED:g} m/s", ""], [list(row) for row in rows.items()])


def write_tables(made):
    """The tables of the page, for `make couplings-docs`."""
    RESULTS.mkdir(exist_ok=True)
    blocks = [f"<!-- {name} -->\n{text}\n<!-- end of {name} -->\n" for name, text in made.items()]
    (RESULTS / "hunting.md").write_text("\n".join(blocks))
    print("\n".join(blocks))
    print("  wrote results/hunting.md")


def main():
    """Measure, draw, write, report."""
    found = measure()
    write_tables(tables(found))
    thinned = found.ramp[::5]
    write_csv("hunting.csv", {name: thinned[name] for name in thinned.dtype.names})
    write_csv("hunting_curve.csv", found.curve)
    names = ("towards the flange [m]", "wear of the rail [m]", "wear of the tread [m]")
    write_csv("hunting_wear.csv", dict(zip(names, found.wear, strict=True)))
    draw(found)
    animate(found)


if __name__ == "__main__":
    main()
