"""The picture of studies/adhesion."""

import matplotlib.pyplot as plt
import numpy as np
from adhesion_runs import (
    AS_IT_IS,
    COMPARED,
    CONSTANT,
    CONTROLLERS,
    CREEPAGES,
    creepage,
    during,
    effort,
    in_leaves,
    most,
    summary,
)
from fitting import read_measured
from helpers import BLACK, BLUE, ORANGE, RED, save
from locomotive import AXLES, SPEED, STOP

GREY, BROWN = "#6b7680", "#a98f4f"
COLOURS = dict(zip(CONTROLLERS, (BLACK, BLUE, RED, ORANGE), strict=True))
# The search is drawn last, over the others.
DRAWN = tuple(CONTROLLERS)[::-1]


def shade_leaves(axes, table):
    """Shade the time in the leaves."""
    inside = table["time"][in_leaves(table)]
    axes.axvspan(inside[0], inside[-1], color="#f1ebdd", zorder=0)
    return inside.mean()


def draw_efforts(axes, plain, limit):
    """Tractive effort over time."""
    axes.axhline(1e-3 * limit, color=GREY, linewidth=1.0, linestyle="--")
    axes.text(2.0, 1e-3 * limit + 3.0, "the most that the wet rail gives", color=GREY, fontsize=8)
    axes.text(shade_leaves(axes, plain["search"]), 294.0, "leaves", ha="center", va="top", color=BROWN)
    for name in DRAWN:
        label = f"{name}: {1e-3 * summary(plain[name], during(plain[name]))['effort']:.0f} kN"
        axes.plot(plain[name]["time"], 1e-3 * effort(plain[name]), color=COLOURS[name], linewidth=1.2, label=label)
    axes.set(xlabel="time [s]", ylabel="tractive effort [kN]", xlim=(0.0, STOP), ylim=(0.0, 300.0))
    axes.set_title("What the locomotive pulls, by slip controller")
    handles, labels = axes.get_legend_handles_labels()
    axes.legend(
        handles[::-1],
        labels[::-1],
        loc="lower right",
        ncols=2,
        fontsize=8,
        title="mean on wet rail, 4 s to 8 s",
        title_fontsize=8,
    )


def draw_plane(axes, plain, curves):
    """Adhesion over creepage: steady curves, measured points, and where the leading wheelset is before the leaves."""
    percent = 100.0 * CREEPAGES
    axes.plot(percent, curves[AS_IT_IS][0], color=GREY, linewidth=2.2, label="steady curve, wet rail")
    axes.plot(percent, curves[CONSTANT][0], color=GREY, linestyle=":", label="the same without temperature")
    axes.plot(percent, curves["leaves"][0], color=BROWN, label="steady curve, leaves")
    measured = read_measured("eurosprinter.csv")
    points = (measured["creepage"], measured["traction_coefficient"])
    axes.plot(*points, "x", color="#8c96a0", markersize=5, linestyle="none", label="measured, Engel et al. 1998")
    for name in DRAWN:
        table, shown = plain[name], during(plain[name], 1.5)
        slips = 100.0 * creepage(table)[shown, 0]
        used = table["traction_force"][shown, 0] / table["normal_load"][shown, 0]
        axes.plot(slips, used, color=COLOURS[name], linewidth=0.9)
        axes.plot(slips.mean(), used.mean(), "o", color=COLOURS[name], markersize=6)
    axes.set(xscale="log", xlim=(0.1, 30.0), ylim=(0.0, 0.36), xlabel="creepage [%]", ylabel="traction / load [1]")
    axes.set_xticks([0.1, 0.3, 1, 3, 10, 30], ["0.1", "0.3", "1", "3", "10", "30"])
    axes.set_title("Where the leading wheelset works, 1.5 s to 8 s")
    axes.legend(fontsize=8, loc="lower right")


def draw_wheelsets(axes, search):
    """Creepage of the wheelsets under the search."""
    shade_leaves(axes, search)
    for axle, colour in enumerate(plt.get_cmap("viridis")(np.linspace(0.0, 0.85, len(AXLES)))):
        axes.plot(search["time"], 100.0 * creepage(search)[:, axle], color=colour, linewidth=1.0, label=f"{axle + 1}")
    axes.set(yscale="log", ylim=(0.2, 10.0), xlim=(0.0, STOP), xlabel="time [s]", ylabel="creepage [%]")
    axes.set_yticks([0.2, 0.5, 1, 2, 5, 10], ["0.2", "0.5", "1", "2", "5", "10"])
    axes.minorticks_off()
    axes.set_title("The search, wheelset by wheelset")
    axes.legend(title="wheelset", ncols=4, fontsize=8, title_fontsize=8, loc="upper left")


def draw_price(axes, results, limit):
    """Tractive effort against slip energy, and what temperature takes of it."""
    axes.axhline(1e-3 * limit, color=GREY, linewidth=1.0, linestyle="--")
    places = {}
    for (name, variant), (table, _) in results.items():
        means = summary(table, during(table))
        places[name, variant] = 1e-3 * means["energy"], 1e-3 * means["effort"]
    for name in CONTROLLERS:
        here = places[name, AS_IT_IS]
        axes.plot(*here, "o", color=COLOURS[name], markersize=8)
        axes.annotate(name, here, (8, -3), textcoords="offset points", va="top", fontsize=8)
    for name in COMPARED:
        here, there = places[name, AS_IT_IS], places[name, CONSTANT]
        axes.plot(*there, "o", color=COLOURS[name], markersize=8, fillstyle="none")
        axes.annotate(
            "", here, there, arrowprops={"arrowstyle": "->", "color": COLOURS[name], "shrinkA": 5, "shrinkB": 5}
        )
        middle = 0.5 * (here[0] + there[0]), 0.5 * (here[1] + there[1])
        takes = f"heat takes {100.0 * (1.0 - here[1] / there[1]):.1f} %"
        axes.annotate(takes, middle, (9, 0), textcoords="offset points", va="center", fontsize=8, color=COLOURS[name])
    axes.plot([], [], "o", color=GREY, markersize=8, fillstyle="none", linestyle="none", label="without temperature")
    axes.legend(loc="lower left", fontsize=8)
    efforts = [place[1] for place in places.values()]
    axes.set(
        xlim=(0.0, 1.3 * max(place[0] for place in places.values())), ylim=(min(efforts) - 12.0, max(efforts) + 8.0)
    )
    axes.set(xlabel="slip energy [MJ/km]", ylabel="tractive effort [kN]")
    axes.set_title("Gain and price on wet rail, 4 s to 8 s")


def draw(results, curves):
    """Effort over time, the plane of adhesion and creepage, the wheelsets at the leaves, gain against price."""
    plain = {name: results[name, AS_IT_IS][0] for name in CONTROLLERS}
    limit = most(curves[AS_IT_IS])
    figure, ((efforts, plane), (wheelsets, price)) = plt.subplots(2, 2, figsize=(11.0, 8.0), layout="constrained")
    figure.suptitle(
        f"A Bo'Bo' locomotive at the adhesion limit, wet rail, {SPEED:g} m/s", x=0.01, ha="left", fontsize=12
    )
    draw_efforts(efforts, plain, limit)
    draw_plane(plane, plain, curves)
    draw_wheelsets(wheelsets, plain["search"])
    draw_price(price, results, limit)
    save(figure, "adhesion.png")
