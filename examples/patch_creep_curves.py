"""Draw what examples/patch_creep_curves computes: results/patch_creep_curves.png.

    cargo run --release --example patch_creep_curves > results/patch_creep_curves.csv
    .venv/bin/python examples/patch_creep_curves.py

What no program has computed is not drawn.
"""

import csv
import sys

import matplotlib.pyplot as plt
from helpers import BLACK, BLUE, GREEN, RED, RESULTS, save

TABLE = RESULTS / "patch_creep_curves.csv"
# Creepage, force, and what they are called.
PANELS = {
    ("longitudinal", "Fx"): (r"longitudinal creepage $\xi$ [%]", r"$F_x/(\mu N)$"),
    ("lateral", "Fy"): (r"lateral creepage $\eta$ [%]", r"$F_y/(\mu N)$"),
    ("lateral", "Mz"): (r"lateral creepage $\eta$ [%]", r"$M_z/(\mu N c)$"),
    ("spin", "Fy"): (r"spin creepage $\varphi c$ [%]", r"$F_y/(\mu N)$"),
    ("spin", "Mz"): (r"spin creepage $\varphi c$ [%]", r"$M_z/(\mu N c)$"),
}
COLOURS = {"0.5": BLUE, "1.0": RED, "2.0": GREEN}
STYLES = {
    "wheelrail": {"linestyle": "-"},
    "fastsim": {"linestyle": "--", "linewidth": 1.0},
    "limit": {"linestyle": "none", "marker": "x", "markersize": 4},
    "contact": {"linestyle": "none", "marker": "o", "markersize": 4, "markerfacecolor": "white"},
}
NAMES = {"wheelrail": "wheelrail", "fastsim": "FASTSIM", "contact": "CONTACT", "limit": "limit of fine grids"}


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
    figure, panels = plt.subplots(2, 3, figsize=(9.6, 6.0), layout="constrained")
    for axes, ((driven, force), (creepage, share)) in zip(panels.flat, PANELS.items(), strict=False):
        axes.axhline(0.0, color=BLACK, linewidth=0.6)
        for (ratio, over, by), columns in curves.items():
            if over == driven and by in STYLES:
                percent = [100.0 * value for value in columns["creepage"]]
                axes.plot(percent, columns[force], color=COLOURS[ratio], **STYLES[by])
        axes.set(xlabel=creepage, title=share, xlim=(0.0, 0.6))
    explain(panels.flat[5], {by for _, _, by in curves})
    figure.suptitle("Creep curves of an elliptic contact, 80 kN, friction coefficient 0.3", x=0.01, ha="left")
    save(figure, "patch_creep_curves.png")


def explain(axes, programs):
    """Use the panel that is left for colours and lines."""
    axes.axis("off")
    handles = [plt.Line2D([], [], color=colour, label=f"$a/b$ = {ratio}") for ratio, colour in COLOURS.items()]
    handles += [
        plt.Line2D([], [], color=BLACK, label=NAMES[by], **style) for by, style in STYLES.items() if by in programs
    ]
    axes.legend(handles=handles, loc="center left", fontsize=10)


def times(curves):
    """Print the median time of a point, in microseconds."""
    for (ratio, driven, by), columns in curves.items():
        measured = sorted(time for time in columns["time"] if time == time)
        if measured:
            print(f"  a/b = {ratio}, {driven:12} {by:16} {measured[len(measured) // 2]:9.1f} µs")


def main():
    """Read, draw, print."""
    if not TABLE.exists():
        sys.exit(f"{TABLE} is not there: run the example of the same name in Rust first")
    curves = read(TABLE)
    draw(curves)
    times(curves)


if __name__ == "__main__":
    main()
