"""The braking manoeuvre that tests/platforms/host.c drives a library through, and the comparison of what it prints.

Two platforms differ in the last bits of sines, powers and sums: their C libraries and their vector instructions are
not the same. What round-off makes of an output or a derivative is measured on linux64 itself, where inputs and
parameters are moved by some last bits; a difference of another size is a defect. Needs Python's own library only.
"""

import csv
import math
import random
import subprocess
import xml.etree.ElementTree as ElementTree
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
HOST = REPOSITORY / "tests" / "platforms" / "host.c"
DESCRIPTION = REPOSITORY / "modelDescription" / "modelDescription.xml"
BRAKING = REPOSITORY / "examples" / "braking.csv"
# Between platforms, of the largest magnitude that an output or a derivative has in the run, where round-off makes no
# more than that of it.
TOLERANCE = 1e-12
# Inputs and parameters are moved by so much of themselves, up or down, in so many runs ...
ROUND_OFF = 1e-15
NUDGES = 8
# ... and platforms may differ by so many times what that makes of a series: where sums run in another order, the
# iterations of the patch end elsewhere within their tolerance. What a run comes to is printed as the largest ratio.
OF_ROUND_OFF = 100
# Set in each run, so that their last bits can be moved: of the compliance, the temperature and the window.
PARAMETERS = ("wheel_radius", "strip_height", "strip_half_length", "thermal_diffusivity", "largest_load")
FORCES = ("traction_force", "friction_torque", "lateral_force", "spin_moment")


@dataclass(frozen=True)
class Manoeuvre:
    """A piece of the braking manoeuvre, with the parameters that make it one of a line or of a patch."""

    name: str
    first: int  # row of the table
    steps: int
    save: int  # the state, each so many steps
    derivatives: int  # each so many steps
    integers: dict
    constants: dict  # inputs that the table has not


MANOEUVRES = (
    Manoeuvre("line", 0, 1000, 50, 100, {"slip_source": 2}, {}),
    # Sticking, then sliding, then sticking again, moving sideways and turning all the while.
    Manoeuvre(
        "patch", 390, 180, 20, 30, {"slip_source": 2, "contact_model": 2}, {"lateral_speed": 0.02, "spin_rate": 0.3}
    ),
)


def described():
    """Return the GUID, the value references by name, the start values of `PARAMETERS` and the outputs' names."""
    root = ElementTree.parse(DESCRIPTION).getroot()
    variables = root.findall("ModelVariables/ScalarVariable")
    references = {variable.get("name"): variable.get("valueReference") for variable in variables}
    starts = {v.get("name"): v.find("Real").get("start") for v in variables if v.get("name") in PARAMETERS}
    outputs = [v.get("name") for v in variables if v.get("causality") == "output"]
    return root.get("guid"), references, starts, outputs


def nudged(numbers):
    """Return a function that moves a number, given as text, up or down by round-off."""
    return lambda text: repr(float(text) * (1 + numbers.choice((-ROUND_OFF, ROUND_OFF))))


def write_scenario(manoeuvre, path, unmask, nudge):
    """Write what host.c reads, each real number through `nudge`; return the names of inputs and outputs.

    Those of the inputs by value reference.
    """
    guid, references, starts, outputs = described()
    with BRAKING.open() as file:
        table = list(csv.DictReader(file))
    rows = table[manoeuvre.first : manoeuvre.first + manoeuvre.steps + 1]
    driven = [name for name in rows[0] if name != "time"]
    inputs = [*driven, *manoeuvre.constants]
    step = float(rows[1]["time"]) - float(rows[0]["time"])
    lines = [
        f"guid {guid}",
        f"unmask {int(unmask)}",
        f"save {manoeuvre.save}",
        f"derivatives {manoeuvre.derivatives}",
        f"integers {len(manoeuvre.integers)}",
        *(f"{references[name]} {value}" for name, value in manoeuvre.integers.items()),
        f"reals {len(starts)}",
        *(f"{references[name]} {nudge(value)}" for name, value in starts.items()),
        f"outputs {len(outputs)} " + " ".join(references[name] for name in outputs),
        f"inputs {len(inputs)} " + " ".join(references[name] for name in inputs),
        f"step {step:.6g}",
        f"steps {manoeuvre.steps}",
    ]
    constants = [repr(value) for value in manoeuvre.constants.values()]
    lines += [" ".join(map(nudge, [*(row[name] for name in driven), *constants])) for row in rows]
    path.write_text("\n".join(lines) + "\n")
    return {references[name]: name for name in inputs}, outputs


def drive(command, library, folder, *, unmask=False, nudge=str, environment=None):
    """Run the host with a library; return the printed values of each manoeuvre by what they are.

    A key is the name of an output, or names of an output and an input for a derivative; a value is the series.
    """
    printed = {}
    for manoeuvre in MANOEUVRES:
        scenario = folder / f"{manoeuvre.name}.scenario"
        inputs, outputs = write_scenario(manoeuvre, scenario, unmask, nudge)
        line = [*map(str, command), str(library), str(scenario)]
        run = subprocess.run(line, capture_output=True, text=True, env=environment, timeout=600)
        if run.returncode != 0:
            raise RuntimeError(f"{manoeuvre.name}: exit status {run.returncode}\n{run.stderr[-3000:]}")
        series = printed.setdefault(manoeuvre.name, {})
        for words in map(str.split, run.stdout.splitlines()):
            derivative = words[0] == "derivative"
            along = f" by {inputs[words[2]]}" if derivative else ""
            for name, value in zip(outputs, words[3 if derivative else 2 :], strict=True):
                series.setdefault(name + along, []).append(float(value))
        if len(series[outputs[0]]) != manoeuvre.steps:
            raise RuntimeError(f"{manoeuvre.name}: {len(series[outputs[0]])} of {manoeuvre.steps} steps were printed")
    return printed


def differences(reference, other):
    """Return the largest difference of each series, relative to its largest magnitude, by manoeuvre and name.

    It is infinite where a value is not finite, or should be 0 and is not.
    """
    relative = {}
    for manoeuvre, series in reference.items():
        for name, values in series.items():
            scale = max(map(abs, values))
            pairs = zip(values, other[manoeuvre][name], strict=True)
            largest = max(abs(a - b) if math.isfinite(b) else math.inf for a, b in pairs)
            relative[manoeuvre, name] = largest / scale if scale > 0 else math.inf if largest > 0 else 0.0
    return relative


def of_round_off(command, library, folder, reference):
    """Return what round-off in inputs and parameters makes of each series, on the platform of the reference."""
    largest = dict.fromkeys(differences(reference, reference), 0.0)
    for seed in range(NUDGES):
        run = drive(command, library, folder, nudge=nudged(random.Random(seed)))
        for key, difference in differences(reference, run).items():
            largest[key] = max(largest[key], difference)
    return largest


def compared(reference, other, round_off):
    """Return lines for a person, and lines about what differs by too much."""
    relative = differences(reference, other)
    lines = []
    for manoeuvre in reference:
        for kind in ("outputs", "derivatives"):
            keys = [key for key in relative if key[0] == manoeuvre and (" by " in key[1]) == (kind == "derivatives")]
            within = sum(relative[key] <= TOLERANCE for key in keys)
            largest = [
                f"{relative[key]:.1e} of {key[1]} (round-off makes {round_off[key]:.1e})"
                for key in sorted(keys, key=relative.get, reverse=True)[:2]
            ]
            lines.append(
                f"{manoeuvre}, {kind}: {within} of {len(keys)} within {TOLERANCE:.0e}, the largest differences "
                + ", ".join(largest)
            )
        forces = max(relative[key] for key in relative if key[0] == manoeuvre and key[1] in FORCES)
        lines.append(f"{manoeuvre}, forces and moments: within {forces:.1e}")
    ratio = max(difference / max(TOLERANCE, round_off[key]) for key, difference in relative.items())
    lines.append(f"at most {ratio:.1f} times what round-off makes, or {TOLERANCE:.0e}")
    wrong = [
        f"{key[0]}: {key[1]} differs by {difference:.1e}, round-off makes {round_off[key]:.1e}"
        for key, difference in relative.items()
        if difference > max(TOLERANCE, OF_ROUND_OFF * round_off[key])
    ]
    return lines, wrong
