"""Draw what the program beside it computes, creep curves of the patch: results/patch_creep_curves.png.

    cargo run --release --example patch_creep_curves > results/patch_creep_curves.csv
    .venv/bin/python studies patch_creep_curves

What no program has computed is not drawn. The largest differences from the limits, creepages combined among them, go to
results/patch_accuracy.csv.
"""

import csv
import sys

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, GREEN, RED, RESULTS, save
from wheelrail.plots import CreepCurve, creep_panels

TABLE = RESULTS / "patch_creep_curves.csv"
ACCURACY = RESULTS / "patch_accuracy.csv"
FORCES = ("Fx", "Fy", "Mz")
LABELS = {
    "longitudinal": r"longitudinal creepage $\xi$ [%]",
    "lateral": r"lateral creepage $\eta$ [%]",
    "spin": r"spin creepage $\varphi c$ [%]",
    "Fx": r"$F_x/(\mu N)$",
    "Fy": r"$F_y/(\mu N)$",
    "Mz": r"$M_z/(\mu N c)$",
}
COLOURS = {"0.5": BLUE, "1.0": RED, "2.0": GREEN}
STYLES = {
    "wheelrail": {"linestyle": "-"},
    "fastsim": {"linestyle": "--", "linewidth": 1.0},
    "limit": {"linestyle": "none", "marker": "x", "markersize": 4},
    "contact": {"linestyle": "none", "marker": "o", "markersize": 4, "markerfacecolor": "white"},
}
NAMES = {"wheelrail": "wheelrail", "fastsim": "FASTSIM", "contact": "CONTACT", "limit": "limit of fine grids"}
COMPARED = {"wheelrail": "wheelrail", "fastsim": "FASTSIM", "fastsim_elliptic": "FASTSIM, Hertz's pressure"}
# Curve or call, and by whom.
TIMES = {
    ("wheelrail_step", ""): "wheelrail, a step from the point before",
    ("wheelrail", ""): "wheelrail, from nothing",
    ("fastsim", ""): "FASTSIM of this repository",
    ("contact", "varying"): "CONTACT, 316 cells",
    ("contact_fastsim", "varying"): "CONTACT's FASTSIM, 316 cells",
}


def read(path):
    """Return the table as a dict of columns for each ellipse, creepage and program."""
    curves = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            columns = curves.setdefault((row["a/b [1]"], row["driven"], row["by"]), {})
            for heading, text in row.items():
                if heading not in ("a/b [1]", "driven", "by"):
                    columns.setdefault(heading.partition("/")[0].partition(" ")[0], []).append(float(text or "nan"))
    return curves


def draw(curves):
    """Draw the five creep curves of the three ellipses."""
    drawn = [
        CreepCurve(driven, 100.0 * np.array(columns["creepage"]), columns, {"color": COLOURS[ratio]} | STYLES[by])
        for (ratio, driven, by), columns in curves.items()
        if by in STYLES and driven in LABELS
    ]
    figure = creep_panels(drawn, LABELS)
    for axes in figure.axes[:5]:
        axes.set_xlim(0.0, 0.6)
    explain(figure.axes[5], {by for _, _, by in curves})
    figure.suptitle("Creep curves of an elliptic contact, 80 kN, friction coefficient 0.3", x=0.01, ha="left")
    save(figure, "patch_creep_curves.png")


def explain(axes, programs):
    """Use the panel that is left for colours and lines."""
    handles = [plt.Line2D([], [], color=colour, label=f"$a/b$ = {ratio}") for ratio, colour in COLOURS.items()]
    handles += [
        plt.Line2D([], [], color=BLACK, label=NAMES[by], **style) for by, style in STYLES.items() if by in programs
    ]
    axes.legend(handles=handles, loc="upper left", fontsize=9, bbox_to_anchor=(0.0, 1.05))


def times(curves):
    """Median time of a point by program [ms]: on the curves, or in calls that vary."""
    medians = {}
    for (by, over), name in TIMES.items():
        measured = [
            time
            for (_, driven, program), columns in curves.items()
            for time in columns["time"]
            if program == by and (driven == over if over else driven not in ("varying", "limits")) and time == time
        ]
        if measured:
            medians[name] = 1e-3 * float(np.median(measured))
    return medians


def accuracy(curves):
    """Largest difference from the limits of fine grids by ellipse and program."""
    rows = []
    for ratio in COLOURS:
        limit = curves[ratio, "limits", "limit"]
        for by, name in COMPARED.items():
            computed = curves.get((ratio, "limits", by))
            if computed is None or computed["creepage"] != limit["creepage"]:
                sys.exit(f"{TABLE}: not every limit of a/b = {ratio} is there by {by}")
            off = [np.abs(np.subtract(computed[force], limit[force])).max() for force in FORCES]
            rows.append((ratio, len(limit["creepage"]), name, *off))
    return rows


def write_accuracy(rows):
    """The differences as a table."""
    with ACCURACY.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["a/b [1]", "points", "by", *(f"{force} [1]" for force in FORCES)])
        writer.writerows([*row[:3], *(repr(float(value)) for value in row[3:])] for row in rows)
    print(f"  wrote results/{ACCURACY.name}")


def main():
    """Read, draw, write, report."""
    if not TABLE.exists():
        sys.exit(f"{TABLE} is not there: run the example of the same name in Rust first")
    curves = read(TABLE)
    draw(curves)
    rows = accuracy(curves)
    write_accuracy(rows)
    for ratio, points, name, *off in rows:
        print(
            f"  a/b = {ratio}, {points} points, {name:39} off by at most {', '.join(f'{value:.4f}' for value in off)}"
        )
    for name, value in times(curves).items():
        print(f"  {name:39} {value:9.3f} ms a point")


if __name__ == "__main__":
    main()
