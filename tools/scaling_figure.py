"""Draws the cost of steps and of a cold start against nodes and cells in contact, from the tables of `make bench`."""

import csv
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parent.parent


def table(name: str) -> dict[str, np.ndarray]:
    """Read a table of results/, column by column."""
    with (ROOT / "results" / f"{name}.csv").open() as file:
        rows = list(csv.DictReader(file))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def write(figure: plt.Figure, name: str) -> None:
    """Write a figure into docs/."""
    for axes in figure.axes:
        axes.grid(color="0.9")
        axes.spines[["top", "right"]].set_visible(False)
    path = ROOT / "docs" / name
    figure.savefig(path, dpi=120)
    print(f"wrote {path.relative_to(ROOT)}")


def draw_line() -> None:
    """Draw docs/scaling.png."""
    column = table("scaling")
    nodes = column["nodes_in_contact"]

    figure, (step, start) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    step.loglog(nodes, column["median_us"], "o-", label="median")
    step.loglog(nodes, column["quantile_99_us"], "s--", label="99 % of the steps")
    square = column["median_us"][0] * (nodes / nodes[0]) ** 2
    step.loglog(nodes, square, ":", color="grey", label="growth with the square")
    step.set_ylabel("time of a step of 1 ms [µs]")
    step.legend(frameon=False)
    start.loglog(nodes, column["cold_start_ms"], "o-")
    start.set_ylabel("time from nothing to the first output [ms]")
    for axes in (step, start):
        axes.set_xlabel("nodes in contact [1]")
        axes.set_xticks([25, 50, 100, 200], ["25", "50", "100", "200"])
        axes.minorticks_off()
    write(figure, "scaling.png")


def draw_patch() -> None:
    """Draw docs/scaling_patch.png: a step of the patch beside a call of CONTACT."""
    patch, contact = table("scaling_patch"), table("scaling_contact")
    call = np.sqrt(contact["least_ms"] * contact["largest_ms"])
    spread = [call - contact["least_ms"], contact["largest_ms"] - call]
    step = 1e-3 * patch["median_us"]

    figure, (cells, error) = plt.subplots(1, 2, figsize=(10, 4), layout="constrained")
    order = np.argsort(patch["cells_in_contact"])
    inside = patch["cells_in_contact"][order]
    cells.loglog(inside, step[order], "o-", label="step of the patch, heat and wear, median")
    cells.loglog(inside, 1e-3 * patch["quantile_999_us"][order], "s--", label="99.9 % of the steps")
    style = {"fmt": "D", "color": "C3", "capsize": 3}
    cells.errorbar(contact["cells_in_contact"], call, spread, label="CONTACT, a steady case that is new", **style)
    cells.set_xlabel("cells in contact [1]")
    cells.set_ylabel("processor time [ms]")

    error.loglog(step, patch["error"], "o", label="patch")
    for cells_along, strips, x, y in zip(
        patch["patch_nodes"], patch["patch_strips"], step, patch["error"], strict=True
    ):
        error.annotate(
            f"{cells_along:.0f} × {strips:.0f}",
            (x, y),
            xytext=(5, 3 if 11 < strips < 42 else -10),
            textcoords="offset points",
            fontsize=8,
        )
    error.errorbar(call, contact["error"], xerr=spread, label="CONTACT, n = 20, 30, 40", **style)
    error.set_xlabel("processor time [ms]")
    error.set_ylabel("largest error of $F_x$, $F_y$ over $\\mu N$")
    cells.set_xticks([150, 300, 600, 1200], ["150", "300", "600", "1200"])
    ticks = [0.0015, 0.002, 0.003, 0.005, 0.01, 0.02]
    error.set_yticks(ticks, [f"{tick:g}" for tick in ticks])
    for axes in (cells, error):
        axes.minorticks_off()
        axes.legend(frameon=False, fontsize=8)
    write(figure, "scaling_patch.png")


def main() -> None:
    """Draw both."""
    draw_line()
    draw_patch()


if __name__ == "__main__":
    main()
