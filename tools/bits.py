"""Record what an FMU computes, to the bit, and compare two records.

For a change that is to leave the results as they are: record the FMU built before it, record the one built after it,
compare. The scenarios are the braking manoeuvre, the paper's cases, and fifty with random parameters and inputs (the
same ones each time). Of each, all outputs at every step, and at its end the profiles, the derivatives of all outputs
with respect to all inputs, and the serialized state. Variables that only one of the two has are left out of the
comparison; the serialized states are compared where the variables are the same.
"""

import argparse
import csv
import shutil
import sys
import tempfile
from pathlib import Path

import numpy as np
from fmpy import extract, read_model_description
from fmpy.fmi2 import FMU2Slave

BRAKING = Path(__file__).resolve().parent.parent / "examples" / "braking.csv"
RANDOM_SCENARIOS, RANDOM_STEPS = 50, 60


class Component:
    """One instance, its variables by name."""

    def __init__(self, folder, description, parameters):
        """Instantiate and set the parameters."""
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.integers = {variable.name for variable in description.modelVariables if variable.type == "Integer"}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="bits",
        )
        self.fmu.instantiate()
        self.set(parameters)
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.time = 0.0

    def set(self, values):
        """Set values by name."""
        for name, value in values.items():
            setter = self.fmu.setInteger if name in self.integers else self.fmu.setReal
            setter([self.references[name]], [value])

    def step(self, duration):
        """Step, and remember the time."""
        self.fmu.doStep(currentCommunicationPoint=self.time, communicationStepSize=duration)
        self.time += duration

    def state(self):
        """Return the serialized state."""
        handle = self.fmu.getFMUstate()
        serialized = self.fmu.serializeFMUstate(handle)
        self.fmu.freeFMUstate(handle)
        return np.frombuffer(bytes(serialized), dtype=np.uint8)


def braking():
    """The manoeuvre of examples/braking.csv, 1 ms steps."""
    with BRAKING.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    times = table.pop("time")

    def inputs(time):
        return {name: float(np.interp(time, times, values)) for name, values in table.items()}

    return {"slip_source": 2}, [(inputs(1e-3 * k), 1e-3) for k in range(int(times[-1] * 1e3))]


def paper(law, hot):
    """A case of the paper: a given penetration of 0.1 mm, 10 m/s, creepage 4 %."""
    parameters = {"control": 2, "friction_law": law, "friction_temperature_hot": hot + 273.15}
    parameters["friction_temperature_cold"] = 50 + 273.15
    inputs = {"creepage": 0.04, "wheel_speed": 10.4 / 0.46, "ambient_temperature": 273.15}
    inputs["incoming_temperature"] = 273.15
    return parameters, [(inputs, 1e-2)] * 50


def random_scenario(generator):
    """Parameters and a walk of the inputs, with jumps."""
    one_of = generator.choice
    uniform = generator.uniform
    parameters = {
        "slip_source": int(one_of([1, 2])),
        "friction_law": int(one_of([1, 2, 3, 4])),
        "wheel": int(one_of([1, 2])),
        "wheel_heating": int(one_of([1, 2])),
        "normal_solver": int(one_of([1, 1, 1, 2])),
        "mesh": int(one_of([1, 1, 1, 1, 1, 1, 2])),
        "contact_nodes": int(one_of([31, 60, 61, 83])),
        "depth_nodes": int(one_of([21, 41])),
        "slip_regularisation": 10 ** uniform(-4, -2),
        "wear_coefficient": 10 ** uniform(-13, -11),
        "contact_thermal_resistance": 10 ** uniform(1, 4),
        "contact_width": uniform(0.006, 0.02),
        "wheel_wear_coefficient": 1e-13,
        "wheel_radius": uniform(0.3, 0.6),
    }
    radius = parameters["wheel_radius"]
    speed, creepage, load = uniform(-40, 40), uniform(-0.02, 0.02), uniform(20e3, 60e3)
    steps = []
    for number in range(RANDOM_STEPS):
        if generator.random() < 0.1:
            creepage, load = uniform(-0.05, 0.05), one_of([0.0, uniform(10e3, 70e3)])
        if generator.random() < 0.03:
            speed = uniform(-40, 40)
        inputs = {
            "wheel_speed": speed * (1 + creepage) / radius,
            "vehicle_speed": speed,
            "creepage": creepage,
            "normal_load": float(load) * (1 + 0.03 * np.sin(number)),
            "friction_scale": 1 + 0.1 * np.sin(0.3 * number),
            "incoming_temperature": 293.15 + 20 * (1 + np.sin(0.1 * number)),
            "incoming_wear_depth": 1e-7 * (1 + np.cos(0.2 * number)),
        }
        steps.append((inputs, float(one_of([1e-4, 1e-3, 1e-2]))))
    return parameters, steps


def scenarios():
    """Name, parameters and steps of each."""
    yield "braking", *braking()
    for name, law, hot in [("constant", 1, 150), ("a", 2, 150), ("b", 2, 125), ("c", 2, 100)]:
        yield f"paper, {name}", *paper(law, hot)
    generator = np.random.default_rng(11)
    for number in range(RANDOM_SCENARIOS):
        yield f"random {number}", *random_scenario(generator)


def compared(description, causality):
    """Return the Real variables of a causality. The residual says how the last step came to rest, not where."""
    variables = (v for v in description.modelVariables if v.causality == causality and v.type == "Real")
    return [v for v in variables if not v.name.startswith("solver.")]


def names_of(causality):
    """Return the key of the names of the variables in a record."""
    return f"names: {causality}"


def shared_part(record, other, key):
    """Return an array of a record without the variables that the other record lacks; none where nothing is left."""
    values, quantity = record[key], key.rpartition(": ")[2]
    keep = {c: np.isin(record[names_of(c)], other[names_of(c)]) for c in ("output", "input", "local")}
    if quantity == "outputs":
        return values[:, keep["output"]] if values.size else values
    if quantity == "profiles":
        return values[keep["local"]]
    if quantity == "derivatives":
        return values[keep["input"]][:, keep["output"]]
    same = all(np.array_equal(record[names_of(c)], other[names_of(c)]) for c in keep)
    return values if same else None


def run(folder, description, parameters, steps):
    """What one scenario gives; a step that fails ends it, and its place is part of the record."""
    component = Component(folder, description, parameters)
    component.set(steps[0][0])
    component.fmu.exitInitializationMode()
    outputs, inputs, profiles = (
        [v.valueReference for v in compared(description, causality)] for causality in ("output", "input", "local")
    )
    history = []
    for values, duration in steps:
        component.set(values)
        try:
            component.step(duration)
        except Exception:
            break
        history.append(component.fmu.getReal(outputs))
    record = {
        "outputs": np.array(history),
        "profiles": np.array(component.fmu.getReal(profiles)),
        "derivatives": np.array([component.fmu.getDirectionalDerivative(outputs, [known], [1.0]) for known in inputs]),
        "state": component.state(),
    }
    component.fmu.freeInstance()
    return record


def record(fmu, path):
    """Run everything and keep it."""
    description = read_model_description(str(fmu))
    folder = extract(str(fmu))
    results = {}
    try:
        for name, parameters, steps in scenarios():
            for quantity, values in run(folder, description, parameters, steps).items():
                results[f"{name}: {quantity}"] = values
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for causality in ("output", "input", "local"):
        results[names_of(causality)] = np.array([v.name for v in compared(description, causality)])
    np.savez_compressed(path, **results)
    print(f"{len(results)} arrays: {path}")


def difference(one, other):
    """None for the same bits, otherwise how far apart they are in words."""
    if one is None or (one.shape == other.shape and one.tobytes() == other.tobytes()):
        return None
    if one.shape != other.shape:
        return f"{one.shape} against {other.shape}"
    if one.dtype == np.uint8:
        return f"{np.count_nonzero(one != other)} bytes differ"
    scale = np.maximum(np.abs(one), np.abs(other)).max(axis=0)
    change = np.abs(one - other).max(axis=0)
    relative = np.divide(change, scale, out=np.zeros_like(change), where=scale > 0)
    return f"up to {np.max(relative):.1e} of the largest value"


def compare(before, after):
    """Say what differs; whether nothing does."""
    with np.load(before) as one, np.load(after) as other:
        if set(one) != set(other):
            print("the records are not of the same scenarios")
            return False
        keys = [key for key in one if not key.startswith("names: ")]
        pairs = {key: (shared_part(one, other, key), shared_part(other, one, key)) for key in keys}
        differences = {key: text for key, pair in pairs.items() if (text := difference(*pair))}
        left_out = sum(pair[0] is None for pair in pairs.values())
        for name, text in differences.items():
            print(f"{name}: {text}")
        print(f"{len(keys) - left_out - len(differences)} of {len(keys) - left_out} arrays have the same bits")
        if left_out:
            print(f"{left_out} serialized states are not compared: the variables differ")
        return not differences


def main():
    """Record, compare, or record to a temporary file and compare with it."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("record", help="run the scenarios and keep what they give")
    command.add_argument("fmu", type=Path)
    command.add_argument("record", type=Path)
    command = commands.add_parser("compare", help="compare an FMU, or a record of it, with a record")
    command.add_argument("before", type=Path)
    command.add_argument("after", type=Path)
    arguments = parser.parse_args()
    if arguments.command == "record":
        record(arguments.fmu, arguments.record)
        return
    with tempfile.TemporaryDirectory() as folder:
        after = arguments.after
        if after.suffix == ".fmu":
            after = Path(folder) / "after.npz"
            record(arguments.after, after)
        sys.exit(not compare(arguments.before, after))


if __name__ == "__main__":
    main()
