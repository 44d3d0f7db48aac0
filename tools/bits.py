"""Record what an FMU computes, to the bit, and compare two records.

    tools/bits.py record FMU RECORD       run the scenarios of tools/bits_scenarios.py and keep what they give
    tools/bits.py compare BEFORE AFTER    each an FMU or a record
    tools/bits.py revision REVISION FMU   compare with the FMU of a revision of git, which is built: `make bits`

For a change that is to leave the results as they are. Of each scenario: all outputs at every step, and at its end the
profiles, the derivatives of all outputs with respect to all inputs, and the serialized state; of some, a second run
whose state goes half-way through its bytes into another instance, which must go on with the same bits. A step that
fails, or is refused an input, ends a scenario, and its place is part of the record. Variables that only one of the two
has are left out of the comparison; the serialized states are compared where the variables are the same.
"""

import argparse
import os
import shutil
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from bits_scenarios import scenarios
from fmpy import extract, read_model_description
from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

REPOSITORY = Path(__file__).resolve().parent.parent
QUANTITIES = ("outputs", "profiles", "derivatives", "state")
CAUSALITIES = ("output", "input", "local")


class Component:
    """One instance, its variables by name."""

    def __init__(self, folder, description, parameters, inputs):
        """Instantiate, set the parameters and the first inputs, and initialise."""
        self.references = {variable.name: variable.valueReference for variable in description.modelVariables}
        self.integers = {variable.name for variable in description.modelVariables if variable.type == "Integer"}
        self.fmu = FMU2Slave(
            guid=description.guid,
            unzipDirectory=folder,
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName="bits",
        )
        # Inputs without effect are set on purpose: no word of it.
        self.callbacks = fmi2CallbackFunctions()
        self.callbacks.logger = fmi2CallbackLoggerTYPE(lambda *_: None)
        self.fmu.instantiate(callbacks=self.callbacks)
        self.set(parameters)
        self.fmu.setupExperiment(startTime=0.0)
        self.fmu.enterInitializationMode()
        self.set(inputs)
        self.fmu.exitInitializationMode()

    def set(self, values):
        """Set values by name."""
        for name, value in values.items():
            setter = self.fmu.setInteger if name in self.integers else self.fmu.setReal
            setter([self.references[name]], [value])

    def steps(self, steps, time, outputs):
        """Step from `time` on until one fails; return the outputs after each, and the time."""
        history = []
        for values, duration in steps:
            try:
                self.set(values)
                self.fmu.doStep(currentCommunicationPoint=time, communicationStepSize=duration)
            except FMICallException:
                break
            time += duration
            history.append(self.fmu.getReal(outputs))
        return history, time

    def state(self):
        """Return the serialized state."""
        handle = self.fmu.getFMUstate()
        serialized = self.fmu.serializeFMUstate(handle)
        self.fmu.freeFMUstate(handle)
        return bytes(serialized)

    def restore(self, serialized):
        """Go to a serialized state."""
        handle = self.fmu.deSerializeFMUstate(serialized, None)
        self.fmu.setFMUstate(handle)
        self.fmu.freeFMUstate(handle)


def compared(description, causality):
    """Return the Real variables of a causality. The residual says how the last step came to rest, not where."""
    variables = (v for v in description.modelVariables if v.causality == causality and v.type == "Real")
    return [v for v in variables if not v.name.startswith("solver.")]


def names_of(causality):
    """Return the key of the names of the variables in a record."""
    return f"names: {causality}"


def values_of(read, *arguments):
    """Return what a call gives; nothing where it is refused after a step that failed."""
    try:
        return np.array(read(*arguments))
    except FMICallException:
        return np.array([])


def run(folder, description, scenario, restart):
    """What one scenario gives, restored half-way into another instance or not."""
    outputs, inputs, profiles = ([v.valueReference for v in compared(description, c)] for c in CAUSALITIES)
    start = (folder, description, scenario.parameters, scenario.steps[0][0])
    component = Component(*start)
    half = len(scenario.steps) // 2 if restart else len(scenario.steps)
    history, time = component.steps(scenario.steps[:half], 0.0, outputs)
    if restart and len(history) == half:
        state = component.state()
        component.fmu.freeInstance()
        component = Component(*start)
        component.restore(state)
        rest, time = component.steps(scenario.steps[half:], time, outputs)
        history += rest
    derivative = component.fmu.getDirectionalDerivative
    record = {
        "outputs": np.array(history),
        "profiles": values_of(component.fmu.getReal, profiles),
        "derivatives": values_of(lambda: [derivative(outputs, [known], [1.0]) for known in inputs]),
        "state": np.frombuffer(component.state(), dtype=np.uint8),
    }
    component.fmu.freeInstance()
    return record


def results_of(folder, description, scenario):
    """What a scenario gives; an error where a restored state does not lead on to the same bits."""
    results = run(folder, description, scenario, restart=False)
    if scenario.restarted:
        restored = run(folder, description, scenario, restart=True)
        differences = [f"{key}: {text}" for key in results if (text := difference(results[key], restored[key]))]
        if differences:
            raise SystemExit(f"{scenario.name}: restoring the state changes {'; '.join(differences)}")
    return results


def record(fmu, path, chosen):
    """Run the chosen scenarios and keep what they give."""
    description = read_model_description(str(fmu))
    folder = extract(str(fmu))
    results = {}
    try:
        for scenario in chosen:
            for quantity, values in results_of(folder, description, scenario).items():
                results[f"{scenario.name}: {quantity}"] = values
    finally:
        shutil.rmtree(folder, ignore_errors=True)
    for causality in CAUSALITIES:
        results[names_of(causality)] = np.array([v.name for v in compared(description, causality)])
    np.savez_compressed(path, **results)
    print(f"{len(results)} arrays: {path}")


def shared_part(record, other, key):
    """Return an array of a record without the variables that the other record lacks; none where nothing is left."""
    values, quantity = record[key], key.rpartition(": ")[2]
    keep = {c: np.isin(record[names_of(c)], other[names_of(c)]) for c in CAUSALITIES}
    if quantity == "state":
        same = all(np.array_equal(record[names_of(c)], other[names_of(c)]) for c in keep)
        return values if same else None
    if not values.size:
        return values
    if quantity == "outputs":
        return values[:, keep["output"]]
    if quantity == "profiles":
        return values[keep["local"]]
    return values[keep["input"]][:, keep["output"]]


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


def compare(before, after, left_out=()):
    """Say what differs; whether nothing does."""
    with np.load(before) as one, np.load(after) as other:
        if set(one) != set(other):
            print("the records are not of the same scenarios")
            return False
        keys = [key for key in one if not key.startswith("names: ") and key.rpartition(": ")[2] not in left_out]
        # What is compressed is read once.
        one, other = ({key: record[key] for key in record} for record in (one, other))
    pairs = {key: (shared_part(one, other, key), shared_part(other, one, key)) for key in keys}
    differences = {key: text for key, pair in pairs.items() if (text := difference(*pair))}
    without = sum(pair[0] is None for pair in pairs.values())
    for name, text in differences.items():
        print(f"{name}: {text}")
    print(f"{len(keys) - without - len(differences)} of {len(keys) - without} arrays have the same bits")
    if without:
        print(f"{without} serialized states are not compared: the variables differ")
    return not differences


def called(*command, **options):
    """Run a command, and end where it fails; return what it prints where that is asked for."""
    done = subprocess.run([str(word) for word in command], text=True, **options)
    if done.returncode != 0:
        raise SystemExit(f"`{' '.join(map(str, command))}` failed{': ' + done.stderr.strip() if done.stderr else ''}")
    return done.stdout


def fmu_of(revision, options):
    """Return the FMU of a revision: built once, in target/bits, from the files that git has of it.

    With a build folder of its own: cargo would take this folder's compiled packages for others, and compile them anew
    here and there. The sources always lie in the same place, so that a second revision finds them compiled.
    """
    asked = {"capture_output": True, "cwd": REPOSITORY}
    commit = called("git", "rev-parse", "--verify", f"{revision}^{{commit}}", **asked).strip()
    folder = REPOSITORY / "target" / "bits"
    fmu, source, target = folder / f"{commit}.fmu", folder / "source", folder / "target"
    if fmu.exists():
        return fmu
    print(f"building the FMU of {commit[:10]} in target/bits ...", flush=True)
    shutil.rmtree(source, ignore_errors=True)
    source.mkdir(parents=True)
    archive = folder / "source.tar"
    called("git", "archive", "--output", archive, commit, **asked)
    # Modified now: cargo takes files that are older than what it compiled for compiled.
    called("tar", "--extract", "--touch", "--file", archive, "--directory", source)
    archive.unlink()
    environment = os.environ | {"CARGO_TARGET_DIR": str(target)}
    called(sys.executable, "tools/cargo.py", *options, "library", cwd=source, env=environment)
    library = (target / "library.path").read_text().strip()
    part = fmu.with_suffix(".part")
    called(target / "release" / "wheelrail", "pack", "--library", library, "--output", part, cwd=source)
    shutil.rmtree(source)
    part.replace(fmu)
    return fmu


def main():
    """Record, compare, or record to temporary files and compare these."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    commands = parser.add_subparsers(dest="command", required=True)
    command = commands.add_parser("record", help="run the scenarios and keep what they give")
    command.add_argument("fmu", type=Path)
    command.add_argument("record", type=Path)
    compares = [commands.add_parser("compare", help="compare two, each an FMU or a record of one")]
    compares[0].add_argument("before", type=Path)
    compares.append(commands.add_parser("revision", help="build the FMU of a revision of git, and compare with it"))
    compares[1].add_argument("before", metavar="revision")
    for command in compares:
        command.add_argument("after", type=Path)
        command.add_argument("--leave-out", action="append", default=[], choices=QUANTITIES)
    compares[1].add_argument("options", nargs="*", help="options of tools/cargo.py, behind --")
    for command in commands.choices.values():
        command.add_argument("--only", action="append", help="the scenarios whose names have these words in them")
    given = parser.parse_args()

    def recorded(fmu, path):
        words = given.only or [""]
        record(fmu, path, [scenario for scenario in scenarios() if any(part in scenario.name for part in words)])
        return path

    if given.command == "record":
        recorded(given.fmu, given.record)
        return
    before = fmu_of(given.before, given.options) if given.command == "revision" else given.before
    with tempfile.TemporaryDirectory() as folder:
        sides = zip(("before", "after"), (before, given.after), strict=True)
        records = [recorded(p, Path(folder) / f"{s}.npz") if p.suffix == ".fmu" else p for s, p in sides]
        sys.exit(not compare(*records, given.leave_out))


if __name__ == "__main__":
    main()
