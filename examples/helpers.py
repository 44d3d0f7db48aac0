"""What the examples share: where things are, a simulation with progress, tables and the look of the pictures."""

import csv
import sys
from pathlib import Path

import fmpy
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

REPOSITORY = Path(__file__).resolve().parent.parent
FMU = REPOSITORY / "target" / "WheelRailContact.fmu"
RESULTS = REPOSITORY / "results"
WHEEL_RADIUS = 0.46  # m, the component's default

# Okabe and Ito's colours: told apart by everybody, in print too.
BLACK, BLUE, ORANGE, GREEN, RED, SKY = "#000000", "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9"

plt.rcParams.update(
    {
        "figure.dpi": 150,
        "savefig.dpi": 150,
        "font.size": 9,
        "axes.titlesize": 10,
        "axes.titlelocation": "left",
        "axes.spines.top": False,
        "axes.spines.right": False,
        "axes.grid": True,
        "grid.color": "#dddddd",
        "grid.linewidth": 0.6,
        "lines.linewidth": 1.4,
        "legend.frameon": False,
    }
)


def read_scenario(path):
    """Read a table with `time` and some inputs; those without a column stay at their start values."""
    table = np.genfromtxt(path, delimiter=",", names=True)
    description = fmpy.read_model_description(str(FMU))
    missing = [
        (variable.name, float(variable.start))
        for variable in description.modelVariables
        if variable.causality == "input" and variable.name not in table.dtype.names
    ]
    complete = np.empty(len(table), dtype=[*table.dtype.descr, *((name, float) for name, _ in missing)])
    for name in table.dtype.names:
        complete[name] = table[name]
    for name, value in missing:
        complete[name] = value
    return complete


def simulate(title, step, stop_time, output, start_values, signals=None):
    """Run the component in FMPy with a line of progress on the terminal."""
    if not FMU.exists():
        sys.exit(f"{FMU} is not there: run `make fmu` first")
    shown = 0

    def progress(time, _recorder):
        nonlocal shown
        percent = int(100.0 * time / stop_time + 1e-6)
        # A terminal shows each percent in place, a log file each half.
        if percent > shown and (sys.stdout.isatty() or percent % 50 == 0):
            end = "\r" if sys.stdout.isatty() else "\n"
            print(f"  {title}: {time:6.2f} of {stop_time:.2f} s, {percent:3d} %", end=end, flush=True)
            shown = percent
        return True

    result = fmpy.simulate_fmu(
        str(FMU),
        start_time=0.0,
        stop_time=stop_time,
        output_interval=step,
        start_values=start_values,
        input=signals,
        output=output,
        step_finished=progress,
    )
    if sys.stdout.isatty():
        print()
    return result


def profile(result, name, row=-1):
    """One of the profiles, `profile.pressure` for example, at a row of the result."""
    names = [n for n in result.dtype.names if n.startswith(name + "[")]
    return np.array([result[n][row] for n in names])


def profile_names(name, points):
    """List the names of a profile's variables."""
    return [f"{name}[{i}]" for i in range(1, points + 1)]


def write_csv(name, columns):
    """Write a table with a heading per column, each number in full."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / name
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(columns)
        writer.writerows([[repr(float(value)) for value in row] for row in zip(*columns.values(), strict=True)])
    print(f"  wrote {path.relative_to(REPOSITORY)}")


def save(figure, name):
    """Put a picture into the results."""
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / name
    figure.savefig(path)
    plt.close(figure)
    print(f"  wrote {path.relative_to(REPOSITORY)}")
