"""Draws the cost of a step and of a cold start against the nodes in contact, from the table of `make bench`."""

import csv
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    """Draw docs/scaling.png."""
    with (ROOT / "results" / "scaling.csv").open() as file:
        rows = list(csv.DictReader(file))
    column = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
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
        axes.grid(color="0.9")
        axes.spines[["top", "right"]].set_visible(False)
    path = ROOT / "docs" / "scaling.png"
    figure.savefig(path, dpi=120)
    print(f"wrote {path.relative_to(ROOT)}")


if __name__ == "__main__":
    main()
