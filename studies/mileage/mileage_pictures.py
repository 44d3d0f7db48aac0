"""Pictures of studies/mileage: profiles and measures over the mileage, and what wears in which curve."""

from itertools import product

import matplotlib.pyplot as plt
import numpy as np
from curve_vehicle import WHEELS
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, SKY, save
from matplotlib.cm import ScalarMappable
from matplotlib.colors import Normalize
from mileage_march import read_state, state_file
from mileage_tables import NAMES, by_class, chosen

COLOURS = (BLUE, SKY, RED, ORANGE)
DEPTH = "depth along the normal [mm]"
MILEAGE = "mileage [1000 km]"


def middles(new):
    """Lateral positions of the cells' middles on the new profile [mm]."""
    return 5e2 * (new.y[1:] + new.y[:-1])


def draw_profiles(new, folder, name):
    """Profiles of the left wheels as they wear: flange and tread, new and after the mileage."""
    states = [read_state(state_file(folder, step)) for step in chosen(folder, 5)]
    figure, panels = plt.subplots(2, 2, figsize=(9.0, 6.2), layout="constrained", width_ratios=(1.0, 1.35))
    for row, number in zip(panels, (0, 2), strict=True):
        for axes, (title, x, equal) in zip(
            row, (("flange", (-44, -24), True), ("tread, height enlarged", (-25, 45), False)), strict=True
        ):
            for k, state in enumerate(states):
                shade = plt.cm.plasma(0.85 * k / (len(states) - 1))
                y, height = worn_points(new, state.depth[number])
                axes.plot(y, height, color=shade, lw=1.2, label=label(state.distance))
            axes.set(xlim=x, xlabel="across the wheel [mm]", title=f"{NAMES[number]}: {title}")
            inside = (y > x[0]) & (y < x[1])
            low, high = height[inside].min(), height[inside].max()
            axes.set_ylim(low - 0.06 * (high - low) - 0.1, high + 0.12 * (high - low) + 0.1)
            axes.set_aspect("equal" if equal else "auto")
        row[0].set_ylabel("height [mm]")
    panels[0, 0].legend(loc="lower right", fontsize=7)
    save(figure, name)


def label(distance):
    """A mileage in words."""
    return "new" if distance == 0.0 else f"{1e-3 * distance:,.0f} km".replace(",", "\u202f")


def worn_points(new, depth):
    """Points of the worn profile [mm], in the axes of the new one."""
    at_ends = np.interp(new.edges, new.place, depth)
    return 1e3 * (new.y + at_ends * new.normal[0]), 1e3 * (new.z + at_ends * new.normal[1])


def draw_depths(new, folder, name):
    """Depths over the profiles of the four wheels, coloured by the mileage."""
    states = [read_state(state_file(folder, step)) for step in chosen(folder, 11)]
    figure, panels = plt.subplots(2, 2, figsize=(9.0, 5.6), sharex=True, sharey="row", layout="constrained")
    norm = Normalize(0.0, 1e-6 * states[-1].distance)
    for axes, (number, title) in zip(panels.flat, enumerate(NAMES), strict=True):
        for state in states[1:]:
            shade = plt.cm.viridis_r(norm(1e-6 * state.distance))
            axes.plot(middles(new), 1e3 * state.depth[number], color=shade, lw=1.1)
        axes.set(title=title, xlim=(-50, 50))
        axes.axvline(0.0, color=BLACK, lw=0.6, ls=":")
    for axes in panels[:, 0]:
        axes.set_ylabel(DEPTH)
    for axes in panels[1]:
        axes.set_xlabel("across the wheel, to the field side [mm]")
    figure.colorbar(ScalarMappable(norm, "viridis_r"), ax=panels, label=MILEAGE, shrink=0.7)
    save(figure, name)


def draw_measures(found, name, limits, others=(), title=""):
    """Sh, Sd, qR, hollow, worn area and conicity over the mileage, with the user's limits.

    Those of another run, with a title, are dashed.
    """
    figure, panels = plt.subplots(2, 3, figsize=(9.6, 5.6), sharex=True, layout="constrained")
    shown = [("flange_height", "Sh [mm]", 1e3), ("flange_thickness", "Sd [mm]", 1e3)]
    shown += [("flange_gradient", "qR [mm]", 1e3), ("hollow_depth", "hollow [mm]", 1e3)]
    shown += [("worn_area", "worn area [mm²]", 1e6)]
    shown += [("conicity", "equivalent conicity at 3 mm [1]", 1.0)]
    runs = [(found, "-", "")] + [(other, "--", f", {title}") for other in others]
    for axes, (key, heading, factor) in zip(panels.flat, shown, strict=True):
        for run, style, behind in runs:
            for number, colour in alike(run, key):
                own = run["wheel"] == NAMES[number]
                x, y = 1e-6 * run["mileage"][own], factor * run[key][own]
                axes.plot(x, y, style, color=colour, lw=1.3, label=who(run, key, number) + behind)
        if key in limits:
            axes.axhline(1e3 * limits[key], color=BLACK, lw=0.8, ls=":")
        axes.set_title(heading)
    for axes in panels[1]:
        axes.set_xlabel(MILEAGE)
    panels[1, 1].legend(fontsize=7)
    save(figure, name)


def alike(found, key):
    """Wheels to draw, with their colours: one of two that are the same."""
    kept = []
    for number, colour in enumerate(COLOURS):
        own = found[key][found["wheel"] == NAMES[number]]
        if number % 2 == 0 or not np.array_equal(own, found[key][found["wheel"] == NAMES[number - 1]], equal_nan=True):
            kept.append((number, colour))
    return kept


def who(found, key, number):
    """What a curve is of: a wheel, or both of an axle."""
    axle, side = WHEELS[number]
    drawn = [one for one, _ in alike(found, key)]
    return f"{axle} {side}" if {number, number ^ 1} <= set(drawn) else axle


def draw_curves(folder, steps, titles, name):
    """Tγ and fatigue over the radius, of the wheels on both rails, in some steps: new wheels, and worn ones.

    Of classes of one radius it has the one that is driven or braked least.
    """
    figure, panels = plt.subplots(2, 2, figsize=(9.0, 6.4), sharex=True, sharey="row", layout="constrained")
    shown = (("wear_number", 1.0), ("rcf_damage", 1e6))
    for axes, ((quantity, factor), (axle, first)) in zip(
        panels.flat, product(shown, (("leading", 0), ("trailing", 2))), strict=True
    ):
        for step, title, style in zip(steps, titles, ("-o", "--s"), strict=True):
            every = by_class(folder, step)
            one_hand = {name: one for name, one in every.items() if one["radius"] < 0.0 or np.isinf(one["radius"])}
            least = {}
            for one in one_hand.values():
                least[one["radius"]] = min(abs(one["traction"]), least.get(one["radius"], np.inf))
            classes = {name: one for name, one in one_hand.items() if abs(one["traction"]) == least[one["radius"]]}
            inverse = np.array([1.0 / abs(one["radius"]) for one in classes.values()])
            order = np.argsort(inverse)
            for wheel, rail, colour in ((first, "outer rail", RED), (first + 1, "inner rail", BLUE)):
                values = factor * np.array([one[quantity][wheel] for one in classes.values()])
                axes.plot(inverse[order], values[order], style, ms=3.5, color=colour, label=f"{rail}, {title}", lw=1.2)
        radii = [abs(one["radius"]) for one in classes.values() if np.isfinite(one["radius"])]
        axes.set_xticks([0.0, *(1.0 / radius for radius in radii)], ["straight", *(f"{radius:g}" for radius in radii)])
        axes.tick_params(axis="x", labelrotation=60)
        axes.set(title=f"{axle} wheelset" if quantity == "wear_number" else "")
    for axes in panels[0]:
        axes.set_yscale("log")
    for axes in panels[1]:
        axes.axhline(0.0, color=BLACK, lw=0.6)
        axes.set_xlabel("radius, evenly by its inverse [m]")
    panels[0, 0].set_ylabel("Tγ, mean over the states [N]")
    panels[1, 0].set_ylabel("fatigue of a passage [10⁻⁶]")
    panels[0, 0].legend(fontsize=7)
    save(figure, name)


def draw_laws(new, shapes, by_law, depths, distance, name):
    """Where each law of wear takes its area from a leading wheel, new and at a mileage; lubricated gauge faces."""
    figure, panels = plt.subplots(1, 3, figsize=(11.0, 3.6), sharex=True, layout="constrained")
    left, middle, right = panels
    for (law, areas), colour in zip(shapes.items(), (BLACK, GREEN, ORANGE), strict=True):
        left.plot(middles(new), 100.0 * areas[0] / areas[0].sum() / (1e3 * new.cell), color=colour, lw=1.2, label=law)
        middle.plot(middles(new), 1e3 * by_law[law][0], color=colour, lw=1.2, label=law)
    left.set(title="leading wheel, new: the laws", ylabel="share of the worn area [% per mm]")
    middle.set(title=f"leading wheel, {label(distance)}", ylabel=DEPTH)
    for (title, depth), style in zip(depths.items(), ("-", "--"), strict=True):
        for number, colour in ((0, BLUE), (2, RED)):
            text = f"{NAMES[number].partition(' ')[0]}, {title}"
            right.plot(middles(new), 1e3 * depth[number], style, color=colour, lw=1.2, label=text)
    right.set(title=f"gauge faces, {label(distance)}", ylabel=DEPTH)
    for axes in panels:
        axes.set(xlim=(-50, 40), xlabel="across the wheel [mm]")
        axes.legend(fontsize=7)
    save(figure, name)
