"""Time the steps of two FMUs by turns in one process.

    .venv/bin/python tools/speed.py BEFORE.fmu AFTER.fmu

The braking manoeuvre of examples/braking.csv in steps of 1 ms, for the line and the patch. The two take turns of a few
steps, so that a change of the processor's clock meets both; processor time of the thread, without setting the inputs.
Printed are the medians, the times that one step in a hundred exceeds, the start of an instance, and their ratios.
"""

import argparse
import csv
import shutil
import time
from pathlib import Path

import numpy as np
from bits import Component
from fmpy import extract, read_model_description

TABLE = Path(__file__).resolve().parent.parent / "examples" / "braking.csv"
STEP = 1e-3
TURN = 20
SLIP_FROM_SPEEDS = 2


def inputs_at(times):
    """Return the inputs of the manoeuvre at the given times, a dictionary each."""
    with TABLE.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    known = table.pop("time")
    columns = {name: np.interp(times, known, values) for name, values in table.items()}
    return [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]


def timed(call, *arguments, **keywords):
    """Return what a call gives, and its processor time in µs."""
    start = time.thread_time_ns()
    result = call(*arguments, **keywords)
    return result, 1e-3 * (time.thread_time_ns() - start)


def times_of(folders, descriptions, model, steps):
    """Return the times of the starts, and of all steps, of both components."""
    inputs = inputs_at(STEP * np.arange(steps))
    parameters = {"slip_source": SLIP_FROM_SPEEDS, "contact_model": model}
    starts, components = [], []
    for folder, description in zip(folders, descriptions, strict=True):
        component, start = timed(Component, folder, description, parameters, inputs[0])
        components.append(component)
        starts.append(start)
    times = [[], []]
    for first in range(0, steps, TURN):
        for component, own in zip(components, times, strict=True):
            for step in range(first, min(first + TURN, steps)):
                component.set(inputs[step])
                point = {"currentCommunicationPoint": STEP * step, "communicationStepSize": STEP}
                own.append(timed(component.fmu.doStep, **point)[1])
    for component in components:
        component.fmu.freeInstance()
    return starts, np.array(times)


def main():
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--steps", type=int, default=3000, help="steps of the line; a patch takes a third")
    arguments = parser.parse_args()
    archives = [str(arguments.before), str(arguments.after)]
    descriptions = [read_model_description(archive) for archive in archives]
    folders = [extract(archive) for archive in archives]
    try:
        for name, model, steps in (("line", 1, arguments.steps), ("patch", 2, arguments.steps // 3)):
            starts, times = times_of(folders, descriptions, model, steps)
            rows = {"median step": np.median(times, axis=1), "99 %": np.quantile(times, 0.99, axis=1), "start": starts}
            for row, (before, after) in rows.items():
                print(f"{name:6}{row:12}{before:10.1f} µs{after:10.1f} µs   ratio {after / before:.3f}")
    finally:
        for folder in folders:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
