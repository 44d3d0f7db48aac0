"""Draw the error of the forces over the time of a point, by patch, FASTSIM and CONTACT: results/error_over_time.png.

    cargo run --release --example error_over_time > results/error_over_time.csv
    .venv/bin/python studies error_over_time

What no program has computed is not drawn, but what CONTACT's author has published: it says where.
"""

import csv
import sys

import matplotlib.pyplot as plt
from helpers import BLUE, GREEN, RED, RESULTS, save

TABLE = RESULTS / "error_over_time.csv"
ERRORS = ("error of Fx/(mu N) [1]", "error of Fy/(mu N) [1]", "error of Mz/(mu N c) [1]")
STYLES = {
    "patch": {"label": "patch, a step on a rough track, with heat and wear", "color": BLUE, "marker": "o"},
    "fastsim": {"label": "FASTSIM of this repository", "color": RED, "marker": "s", "linestyle": "--"},
    "fastsim_elliptic": {
        "label": "FASTSIM of this repository, Hertz's pressure",
        "color": RED,
        "marker": "^",
        "linestyle": ":",
    },
    "contact": {"label": "CONTACT, a call, $F_x$ and $F_y$ alone", "color": GREEN, "marker": "D"},
    "contact_fastsim": {
        "label": "CONTACT's FASTSIM, a call, against CONTACT",
        "color": GREEN,
        "marker": "s",
        "linestyle": "--",
    },
}
# F_x of KPEC and ANALYN against CONTACT's [N], of a wheelset at 0, 0.5 and 5 mm, over 0.3 * 10 kN: the published values
# that docs/profiles.md has. No time was published with them.
PUBLISHED = {
    "KPEC": ((341.7, -0.3), (973.6, 880.0), (965.9, 763.3)),
    "ANALYN": ((-340.5, -0.3), (1088.0, 880.0), (962.4, 763.3)),
}
FRICTION_BOUND = 0.3 * 10e3


def read(path):
    """Return the rows by program."""
    rows = {}
    with path.open(newline="") as file:
        for row in csv.DictReader(file):
            rows.setdefault(row["by"], []).append(row)
    return rows


def worst(row):
    """Return the largest of the errors that are known; none where none is."""
    known = [float(row[error]) for error in ERRORS if row[error]]
    return max(known) if known else None


def draw(rows):
    """Draw error over time."""
    figure, axes = plt.subplots(figsize=(9, 5.5), layout="constrained")
    for by, style in STYLES.items():
        found = [row for row in rows.get(by, []) if worst(row) is not None]
        times = [1e-3 * float(row["time [us]"]) for row in found]
        axes.loglog(times, [worst(row) for row in found], markersize=5, **style)
        for time, row in zip(times, found, strict=True):
            name = f"{row['name']} {row['along']} × {row['across']}".strip()
            axes.annotate(
                name if by == "patch" else row["along"],
                (time, worst(row)),
                xytext=(5, -11) if name == "16 × 11" else (5, 5),
                textcoords="offset points",
                fontsize=7,
            )
            if row["largest [us]"]:
                span = [1e-3 * float(row[heading]) for heading in ("least [us]", "largest [us]")]
                axes.plot(span, [worst(row)] * 2, color=style["color"], linewidth=0.8, marker="|", alpha=0.6)
    off = {name: max(abs(own - other) for own, other in pairs) for name, pairs in PUBLISHED.items()}
    for error in off.values():
        axes.axhline(error / FRICTION_BOUND, xmax=0.07, color="0.4")
    axes.annotate(
        f"{' and '.join(off)}: $F_x$ on profiles,\nno time published",
        (0.01, max(off.values()) / FRICTION_BOUND),
        xycoords=("axes fraction", "data"),
        xytext=(0, 4),
        textcoords="offset points",
        fontsize=8,
    )
    axes.set_ylim(1e-3, 0.25)
    axes.set_xlabel("processor time of a point [ms]")
    axes.set_ylabel(r"largest error of $F_x/\mu F_N$, $F_y/\mu F_N$, $M_z/\mu F_N c$")
    axes.grid(color="0.9")
    axes.legend(frameon=False, fontsize=8, loc="lower left")
    save(figure, "error_over_time.png")


def main():
    """Read, draw, report."""
    if not TABLE.exists():
        sys.exit(f"{TABLE} is not there: run the example of the same name in Rust first")
    rows = read(TABLE)
    draw(rows)
    print("| | cells | $F_x$ | $F_y$ | $M_z$ | time of a point |\n|---|---|---|---|---|---|")
    for by, style in STYLES.items():
        for row in rows.get(by, []):
            errors = " | ".join(f"{float(row[error]):.4f}" if row[error] else "–" for error in ERRORS)
            cells = f"{row['name']} {row['along']} × {row['across']}".strip()
            print(f"| {style['label']} | {cells} | {errors} | {1e-3 * float(row['time [us]']):.3g} ms |")


if __name__ == "__main__":
    main()
