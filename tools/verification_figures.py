"""Draw the curves of `wheelrail verify --curves` beside their closed forms: results/verification/*.png.

The curves are computed by the functions that the Rust tests and `wheelrail verify` call.
"""

import csv
import subprocess
import sys
from pathlib import Path

import matplotlib
import numpy as np

REPOSITORY = Path(__file__).resolve().parent.parent
WHEELRAIL = REPOSITORY / "target" / "release" / "wheelrail"
RESULTS = REPOSITORY / "results" / "verification"
COLOURS = ("#0072b2", "#d55e00", "#009e73")
MODEL = {"linestyle": "none", "marker": "o", "markersize": 4}
CLOSED_FORM = {"color": "#222222", "linewidth": 1.0}

matplotlib.use("Agg")
import matplotlib.pyplot as plt  # noqa: E402


def curves(folder):
    """Return the columns of each curve, after writing them to a folder."""
    subprocess.run([WHEELRAIL, "verify", "--curves", folder], check=True)
    columns = {}
    for path in sorted(Path(folder).glob("*.csv")):
        with path.open(newline="") as file:
            columns[path.stem] = np.array([row for row in list(csv.reader(file))[1:]], float).T
    return columns


def axes_and_difference(name):
    """Return axes for a curve, and below them axes for its difference from the closed form."""
    figure, (axes, difference) = plt.subplots(
        2, 1, figsize=(7.2, 5.4), sharex=True, height_ratios=[3, 1], layout="constrained", num=name
    )
    axes.grid(alpha=0.3)
    difference.grid(alpha=0.3)
    difference.axhline(0.0, **CLOSED_FORM)
    return figure, axes, difference


def save(figure, name):
    """Write the picture."""
    figure.savefig(RESULTS / f"{name}.png", dpi=130)
    plt.close(figure)


def draw_hertz(load, x, pressure, closed_form):
    """Contact pressure at three loads."""
    figure, axes, difference = axes_and_difference("hertz")
    for colour, one in zip(COLOURS, np.unique(load), strict=True):
        chosen = (load == one) & (closed_form + pressure > 0.0)
        position = 1e3 * x[chosen]
        peak = closed_form[chosen].max()
        # The semi-ellipse between the nodes, with the same peak and the half-length that it has at the nodes.
        half_length = half_length_of(position, closed_form[chosen] / peak)
        fine = np.linspace(-half_length, half_length, 401)
        ellipse = peak * np.sqrt(np.maximum(1.0 - (fine / half_length) ** 2, 0.0))
        axes.plot(fine, ellipse / 1e6, **CLOSED_FORM, label="Hertz" if one == load.min() else None)
        axes.plot(position, pressure[chosen] / 1e6, color=colour, label=f"model, {one / 1e3:.0f} kN", **MODEL)
        error = 100.0 * (pressure - closed_form)[chosen] / peak
        difference.plot(position, error, color=colour, **MODEL)
    axes.set(ylabel="contact pressure [MPa]", ylim=(0, None), title="Hertz line contact, rigid wheel, no friction")
    difference.set(ylabel="difference\n[% of peak]", xlabel="position along the rail, $x_1$ [mm]")
    axes.legend()
    save(figure, "hertz")


def half_length_of(position, share):
    """Return a of √(1 − x²/a²) from its values."""
    inside = (share > 0.0) & (np.abs(position) > 0.1)
    return float(np.median(np.abs(position[inside]) / np.sqrt(1.0 - share[inside] ** 2)))


def draw_carter(creepage, traction, closed_form):
    """Creep curve."""
    figure, axes, difference = axes_and_difference("carter")
    axes.plot(100.0 * creepage, closed_form, **CLOSED_FORM, label="Carter")
    axes.plot(100.0 * creepage, traction, color=COLOURS[0], label="model", **MODEL)
    difference.plot(100.0 * creepage, traction - closed_form, color=COLOURS[0], **MODEL)
    axes.set(ylabel=r"traction over its limit, $T/(\mu N)$ [1]", ylim=(0, None))
    axes.set_title("Creep curve of like bodies, constant friction coefficient")
    difference.set(ylabel="difference\n[1]", xlabel=r"creepage, $\xi$ [%]")
    axes.legend(loc="lower right")
    save(figure, "carter")


def draw_flash_temperature(x, rise, closed_form):
    """Surface temperature under and behind a sliding source."""
    figure, axes, difference = axes_and_difference("flash_temperature")
    axes.plot(1e3 * x, closed_form, **CLOSED_FORM, label="integral")
    axes.plot(1e3 * x, rise, color=COLOURS[0], label="model", **MODEL)
    difference.plot(1e3 * x, rise - closed_form, color=COLOURS[0], **MODEL)
    axes.set(ylabel="temperature rise of the surface [K]", ylim=(0, None))
    axes.set_title("Flash temperature of a semi-elliptic source, 6 MN/m, 10 m/s, slip 0.1 m/s")
    difference.set(ylabel="difference\n[K]", xlabel="position along the rail, $x_1$ [mm]; travel to the right")
    axes.legend(loc="upper left")
    save(figure, "flash_temperature")


def draw_patch_hertz(x, y, pressure, closed_form):
    """Contact pressure of a patch along its middle strip and across it."""
    figure, axes, difference = axes_and_difference("patch_hertz")
    # The strip in the middle comes first; the column beside the middle has one x.
    across = x == x[-1]
    peak = closed_form.max()
    for colour, position, chosen, label in (
        (COLOURS[0], x, ~across, "along the rail"),
        (COLOURS[1], y, across, "across"),
    ):
        shown = chosen & (closed_form + pressure > 0.0)
        order = np.argsort(position[shown])
        place = 1e3 * position[shown][order]
        axes.plot(place, closed_form[shown][order] / 1e6, **CLOSED_FORM)
        axes.plot(place, pressure[shown][order] / 1e6, color=colour, label=f"model, {label}", **MODEL)
        difference.plot(place, 100.0 * (pressure - closed_form)[shown][order] / peak, color=colour, **MODEL)
    axes.set(ylabel="contact pressure [MPa]", ylim=(0, None), title="Hertz's ellipse, a/b = 0.5, no friction")
    difference.set(ylabel="difference\n[% of peak]", xlabel="position along or across [mm]")
    axes.legend()
    save(figure, "patch_hertz")


def draw_patch_creep(force, creepage, share, contact):
    """Creep forces of a patch on a circle."""
    figure, axes, difference = axes_and_difference("patch_creep")
    labels = (r"$F_x/(\mu N)$ by $\xi$", r"$F_y/(\mu N)$ by $\eta$", r"$M_z/(\mu N c)$ by $\eta$")
    for number, (colour, label) in enumerate(zip(COLOURS, labels, strict=True)):
        chosen = force == number
        axes.plot(100.0 * creepage[chosen], contact[chosen], **CLOSED_FORM)
        axes.plot(100.0 * creepage[chosen], share[chosen], color=colour, label=label, **MODEL)
        difference.plot(100.0 * creepage[chosen], (share - contact)[chosen], color=colour, **MODEL)
    axes.set(ylabel="share of the bound [1]", ylim=(0, None), title="Steady rolling on a circle, lines: CONTACT")
    difference.set(ylabel="difference\n[1]", xlabel="creepage [%]")
    axes.legend(loc="center right")
    save(figure, "patch_creep")


def draw_manchester(right, lateral, _, along, on_curve, _plane, across, across_it, *_others):
    """Forces of the right wheel of the Manchester benchmark."""
    figure, axes, difference = axes_and_difference("manchester")
    chosen = right == 1.0
    forces = ((along, on_curve, "$F_x$, forward"), (across, across_it, "$F_y$, to the left"))
    for colour, (force, contact, label) in zip(COLOURS, forces, strict=False):
        axes.plot(lateral[chosen], contact[chosen] / 1e3, **CLOSED_FORM)
        axes.plot(lateral[chosen], force[chosen] / 1e3, color=colour, label=label, **MODEL)
        difference.plot(lateral[chosen], (force - contact)[chosen], color=colour, **MODEL)
    title = "Manchester benchmark, right wheel under 10 kN; lines: CONTACT"
    axes.set(ylabel="force on the wheel [kN]", title=title)
    difference.set(ylabel="difference\n[N]", xlabel="wheelset to the right by [mm]")
    axes.legend(loc="upper left")
    save(figure, "manchester")


DRAW = {
    "hertz": draw_hertz,
    "carter": draw_carter,
    "flash_temperature": draw_flash_temperature,
    "patch_hertz": draw_patch_hertz,
    "patch_creep": draw_patch_creep,
    "manchester": draw_manchester,
}


def main():
    """Compute, draw and list."""
    if not WHEELRAIL.exists():
        sys.exit(f"{WHEELRAIL} is not there: run `make command` first")
    columns = curves(RESULTS)
    for name, draw in DRAW.items():
        draw(*columns[name])
        print(RESULTS / f"{name}.png")


if __name__ == "__main__":
    main()
