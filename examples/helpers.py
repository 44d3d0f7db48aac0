"""What the examples share: where things are, simulation with progress, an instance, tables and the look of pictures."""

import atexit
import csv
import shutil
import sys
import tempfile
from functools import cache
from pathlib import Path

import fmpy
import matplotlib
from fmpy.fmi2 import FMU2Slave

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


def simulate(title, step, stop_time, output, start_values, signals=None, instance=None):
    """Run the component in FMPy with a line of progress on the terminal; an instance is left as it is at the end."""
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
        **({} if instance is None else {"fmu_instance": instance.slave, "initialize": False, "terminate": False}),
    )
    if instance is not None:
        instance.time = stop_time
    if sys.stdout.isatty():
        print()
    return result


class Instance:
    """An instance of a co-simulation FMU, its variables by name: what a master written by hand needs.

    FMPy's class below it speaks in value references and may be used beside it: `instance.slave`.
    """

    def __init__(self, fmu, name="instance", **start_values):
        """Unpack, instantiate, set parameters and inputs, and initialise."""
        if not Path(fmu).exists():
            sys.exit(f"{fmu} is not there: run `make fmu` first, and for a coupling `make couplings`")
        description = fmpy.read_model_description(str(fmu), validate=False)
        self.reference = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.type = {variable.name: variable.type for variable in description.modelVariables}
        self.slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=unpacked(fmu),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        self.slave.instantiate()
        self.slave.setupExperiment(startTime=0.0)
        self.time = 0.0
        self.set(**start_values)
        self.slave.enterInitializationMode()

    def start(self):
        """Leave the initialisation: from here on, step."""
        self.slave.exitInitializationMode()
        return self

    def set(self, **values):
        """Set variables, Integer or Real."""
        for name, value in values.items():
            set_value = self.slave.setInteger if self.type[name] == "Integer" else self.slave.setReal
            set_value([self.reference[name]], [value])

    def get(self, *names):
        """Return the values of Real variables."""
        return self.slave.getReal([self.reference[name] for name in names])

    def step(self, step):
        """Step on in time."""
        self.slave.doStep(self.time, step)
        self.time += step

    def derivative(self, outputs, known):
        """Partial derivatives of outputs with respect to one input."""
        unknown = [self.reference[name] for name in outputs]
        return self.slave.getDirectionalDerivative(unknown, [self.reference[known]], [1.0])

    def save(self):
        """Return the state as it is now."""
        return self.slave.getFMUState(), self.time

    def restore(self, saved):
        """Go back to a saved state, which is kept."""
        self.slave.setFMUState(saved[0])
        self.time = saved[1]

    def forget(self, saved):
        """Free a saved state."""
        self.slave.freeFMUState(saved[0])

    def close(self):
        """Terminate and free. The library stays loaded: another instance may be using it."""
        self.slave.terminate()
        self.slave.fmi2FreeInstance(self.slave.component)


@cache
def unpacked(fmu):
    """Unpack an FMU, once in a process; the folder goes when the process ends."""
    folder = tempfile.mkdtemp(prefix="fmu-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return fmpy.extract(str(fmu), folder)


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
