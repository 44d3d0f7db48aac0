"""The pictures of studies/hunting, one for each part of its page, and the limit cycle from above, animated."""

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, RESULTS, SKY, save, show
from hunting_runs import (
    CURVE_RADIUS,
    CYCLE_SPEED,
    FREE_SPEED,
    GROWTH_SPEEDS,
    RAMP,
    REFERENCE,
    crossings,
    eigenvalue,
    klingel,
    on_tread,
)
from matplotlib.animation import PillowWriter
from running_wheelset import CLEARANCE, HALF_GAUGE, LOAD, SIDES

LINEAR_LOOK = {"Kalker's coefficients": (BLUE, "-"), "the component's derivatives": (ORANGE, "--")}
SIDE_LOOK = {"left": BLUE, "right": RED}
GREY = "#888888"
RAIL_TEMPERATURE = "peak temperature of the rail [°C]"


# Widths in inches: at the width of a page's column letters keep their size.
WIDE = 7.6


def draw_stability(found):
    """Draw Klingel's wave, growth over speed, and the ramp."""
    figure, panels = plt.subplot_mosaic(
        [["free", "growth"], ["ramp", "ramp"]], figsize=(WIDE, 6.6), layout="constrained"
    )
    free, growth, ramp = (panels[name] for name in ("free", "growth", "ramp"))
    result = found.free
    free.plot(result["place"], 1e3 * result["y"], color=BLUE, label="without suspension")
    wave = result["y"][0] * np.cos(2.0 * np.pi * result["place"] / klingel())
    free.plot(result["place"], 1e3 * wave, color=BLACK, linestyle=":", label=f"Klingel's wave, {klingel():.2f} m")
    free.set(xlabel="place along the track [m]", ylabel="lateral displacement [mm]", ylim=(-3.5, 5.5))
    free.set_title(f"Rolling freely at {FREE_SPEED:g} m/s")
    free.legend(loc="upper center")

    speeds = np.linspace(GROWTH_SPEEDS[0], GROWTH_SPEEDS[-1], 40)
    for name, (colour, line) in LINEAR_LOOK.items():
        values = [eigenvalue(found, name, speed).real for speed in speeds]
        growth.plot(speeds, values, color=colour, linestyle=line, label=f"linear, {name}")
    growth.plot(GROWTH_SPEEDS, [value.real for value in found.modes], "o", color=BLACK, label="small swings")
    growth.axhline(0.0, color=GREY, linewidth=0.8, label="0: neither decays nor grows")
    growth.set(xlabel="speed [m/s]", ylabel="growth [1/s]", title="Small swings", ylim=(-2.6, 5.2))
    growth.legend(loc="upper left")

    ramp.plot(found.ramp["speed"], 1e3 * found.ramp["y"], color=BLUE, linewidth=0.5)
    for name, colour, line in (("Kalker's coefficients", BLACK, "--"), ("slow ramp", RED, ":")):
        label = f"critical speed by {'the ' if name == 'slow ramp' else ''}{name}: {found.critical[name]:.1f} m/s"
        ramp.axvline(found.critical[name], color=colour, linestyle=line, label=label)
    for edge, label in ((-1e3 * CLEARANCE, None), (1e3 * CLEARANCE, f"a flange touches: ±{1e3 * CLEARANCE:g} mm")):
        ramp.axhline(edge, color=GREY, linewidth=0.8, label=label)
    ramp.set(xlabel="speed [m/s]", ylabel="lateral displacement [mm]", title="Slowly faster", xlim=RAMP, ylim=(-11, 20))
    ramp.legend(loc="upper left", frameon=True, framealpha=1.0, edgecolor="none")
    save(figure, "hunting_stability.png")


def draw_cycle(found):
    """Draw two cycles with the temperatures of both rails, and the wear across rail and tread."""
    figure, panels = plt.subplot_mosaic(
        [["swing", "across"], ["heat", "heat"]], figsize=(WIDE, 6.2), layout="constrained"
    )
    swing, heat, across = (panels[name] for name in ("swing", "heat", "across"))
    start = crossings(found.cycle["time"], found.cycle["y"])[-3]
    shown = found.cycle[found.cycle["time"] >= start]
    place = shown["place"] - shown["place"][0]
    swing.plot(place, 1e3 * shown["y"], color=BLACK, label="lateral displacement [mm]")
    swing.plot(place, 1e3 * shown["yaw"], color=GREEN, label="yaw [mrad]")
    swing.set(title=f"Limit cycle at {CYCLE_SPEED:g} m/s", xlabel="place along the track [m]", ylabel="[mm], [mrad]")
    swing.set(ylim=(-12, 19))
    swing.legend(loc="upper left")
    for side, colour in SIDE_LOOK.items():
        heat.plot(place, shown[f"peak_temperature_{side}"] - 273.15, color=colour, label=f"under the {side} wheel")
    heat.set(xlabel="place along the track [m]", ylabel=RAIL_TEMPERATURE)
    heat.set_title("Hottest point of the rail under each wheel, in the limit cycle")
    heat.legend(loc="upper right", ncols=2)
    low, high = heat.get_ylim()
    heat.set_ylim(low, high + 0.15 * (high - low))

    lateral, rail, tread = found.wear
    across.fill_between(1e3 * lateral, 1e9 * rail, color=SKY, alpha=0.5, linewidth=0, label="rail")
    across.plot(1e3 * lateral, 1e9 * tread, color=BLACK, label="tread of the wheel")
    across.set(xlabel="towards the flange [mm]", ylabel="wear of a passage [nm]", ylim=(0, 1.45e9 * rail.max()))
    across.set_title("Wear at the left, mean of a cycle")
    across.legend(loc="upper right")
    save(figure, "hunting_cycle.png")


def draw_curve(found):
    """Draw forces and temperature over the yaw angle."""
    figure, (force, heat) = plt.subplots(1, 2, figsize=(WIDE, 3.5), layout="constrained")
    angle = 1e3 * found.curve["yaw angle [rad]"]
    for side, colour in SIDE_LOOK.items():
        force.plot(angle, 1e-3 * found.curve[f"lateral_force_{side}"], color=colour, label=f"{side} wheel")
        heat.plot(
            angle, found.curve[f"peak_temperature_{side}"] - 273.15, color=colour, label=f"under the {side} wheel"
        )
    for side, colour in SIDE_LOOK.items():
        bound = found.curve[f"friction_coefficient_{side}"] * LOAD
        force.plot(angle, 1e-3 * bound, color=colour, linestyle=":", linewidth=1.4, label=f"friction × load, {side}")
    force.set(xlabel="yaw angle [mrad]", ylabel="lateral force on the wheel [kN]")
    force.set_title(f"Forces in a curve of {CURVE_RADIUS:g} m")
    force.legend(loc="lower right")
    heat.set(xlabel="yaw angle [mrad]", ylabel=RAIL_TEMPERATURE, title="Rail under each wheel")
    heat.legend(loc="lower right")
    save(figure, "hunting_curve.png")


def draw_contact(found):
    """Draw force and moment over lateral creepage, and what CONTACT has beside them."""
    figure, reference = plt.subplots(figsize=(0.7 * WIDE, 3.4), layout="constrained")
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
    reference.legend(loc="center left")
    save(figure, "hunting_contact.png")


def draw(found):
    """Draw all pictures of the page."""
    draw_stability(found)
    draw_cycle(found)
    draw_curve(found)
    draw_contact(found)


LARGER = 40.0  # displacement and yaw, in the animation
ARROW = 20e3  # N per metre of the animation
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
        tip = tail + np.array([now[f"traction_force_{side}"], now[f"lateral_force_{side}"]]) / ARROW
        axes.annotate("", tip, tail, arrowprops={"arrowstyle": "-|>", "color": GREEN, "linewidth": 2.0}, zorder=4)
    axes.annotate("", (-3.5, -1.2), (-4.0, -1.2), arrowprops={"arrowstyle": "-|>", "color": GREEN, "linewidth": 2.0})
    axes.text(
        -3.4, -1.2, f"{1e-3 * 0.5 * ARROW:g} kN of friction on a wheel; running to the right", va="center", fontsize=9
    )
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
