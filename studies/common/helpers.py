"""What the studies share: where things are, an instance to go back to, tables and pictures.

Instances, simulation and the look of pictures are those of the package in python/.
"""

import csv
import sys
from functools import cache
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt

REPOSITORY = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(REPOSITORY / "python"))

import wheelrail  # noqa: E402
from wheelrail import Instance  # noqa: E402
from wheelrail.plots import BLACK, BLUE, GREEN, ORANGE, RED, SKY, STYLE  # noqa: E402

FMU = REPOSITORY / "target" / "WheelRailContact.fmu"
FMU3 = REPOSITORY / "target" / "WheelRailContact-fmi3.fmu"
RESULTS = REPOSITORY / "results"
WHEEL_RADIUS = 0.46  # m, the component's default

__all__ = ["BLACK", "BLUE", "FMU", "FMU3", "GREEN", "ORANGE", "RED", "REPOSITORY", "RESULTS", "SKY", "WHEEL_RADIUS"]
__all__ += ["Instance", "markdown_table", "profile", "reused", "save", "show", "wheelrail", "write_csv", "write_tables"]

plt.rcParams.update(STYLE)


def reused(fmu, **start_values):
    """Return an instance as initialised: a process makes it once, and then goes back to its first state."""
    instance, first = initialised(fmu, tuple(sorted(start_values.items())))
    instance.restore(first)
    return instance


@cache
def initialised(fmu, start_values):
    """An instance and its state after the initialisation."""
    instance = Instance(fmu, **dict(start_values)).start()
    return instance, instance.save()


def show(fraction, title):
    """A line of progress on a terminal, and nothing in a log file."""
    if sys.stdout.isatty():
        print(f"  {title}: {100.0 * fraction:3.0f} %", end="\r" if fraction < 1.0 else "\n", flush=True)


def profile(result, name):
    """One of the profiles, `profile.pressure` for example, at the end of a result."""
    return result[[column for column in result if column.startswith(f"{name}[")]].iloc[-1].to_numpy()


def write_csv(name, columns):
    """Write a table with a heading per column, each number in full."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / name
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([[repr(float(value)) for value in row] for row in zip(*columns.values(), strict=True)])
    print(f"  wrote {path.relative_to(REPOSITORY)}")


def markdown_table(head, rows):
    """A table in Markdown."""
    return "\n".join([f"| {' | '.join(row)} |" for row in (head, ["---"] * len(head), *rows)])


def write_tables(name, tables):
    """The tables of a page of docs/couplings/, for `make couplings-docs`."""
    RESULTS.mkdir(exist_ok=True)
    blocks = [f"<!-- {title} -->\n{text}\n<!-- end of {title} -->\n" for title, text in tables.items()]
    (RESULTS / name).write_text("\n".join(blocks))
    print("\n".join(blocks))
    print(f"  wrote results/{name}")


def save(figure, name):
    """Put a picture into the results."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / name
    figure.savefig(path)
    plt.close(figure)
    print(f"  wrote {path.relative_to(REPOSITORY)}")
