"""Time the steps of two FMUs by turns in one process.

    .venv/bin/python tools/speed.py BEFORE.fmu AFTER.fmu

Two manoeuvres in steps of 1 ms: braking (examples/braking.csv) and, with --rough, the rough track of the benchmark
rough_track, which has the grid `fast` and profiles besides line and patch. The two take turns of a few steps, so that a
change of the processor's clock meets both; processor time of the thread, without setting the inputs. Printed are the
medians, the times that one step in a hundred exceeds, the quickest of a few starts of an instance, and their ratios.
"""

import argparse
import csv
import shutil
import time
from pathlib import Path

import numpy as np
from bits import Component
from fmpy import extract, read_model_description

ROOT = Path(__file__).resolve().parent.parent
STEP = 1e-3
TURN = 20
# With fewer, a patch in the braking, which takes a third of them, would have none.
LEAST_STEPS = 3
# Starts by turns, each alone in memory: the second of two instances that stay takes a quarter longer than the first.
STARTS = 4
SLIP_FROM_SPEEDS = 2
LINE, PATCH, PROFILES = 1, 2, 3
FAST_GRID = {"contact_model": PATCH, "patch_nodes": 8, "patch_strips": 8}
# As benches/track/profiles.rs has them: part of the track's spin that the inclination of the contact makes, 1/m, and
# wheel radius, m; name, lateral displacement, rolling radius and lever of the contact that carries most, m.
INCLINED = 0.1
RADIUS = 0.46
ON_PROFILES = (("tread", 0.0, 459.98e-3, 750.6e-3), ("two", 5e-3, 461.24e-3, 732.6e-3))


def rows_of(table):
    """Return the columns of a table of inputs."""
    with (ROOT / table).open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    return {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}


def inputs_at(table, times):
    """Return the inputs of the manoeuvre at the given times, a column each."""
    columns = rows_of(table)
    known = columns.pop("time")
    most = round(known[-1] / STEP) + 1
    if len(times) > most:
        raise SystemExit(f"--steps {len(times)}: {table} is {known[-1]:g} s long, {most} steps at most")
    return {name: np.interp(times, known, values) for name, values in columns.items()}


def on_profiles(inputs, displacement, rolling_radius, lever):
    """Return the inputs for a wheelset that is displaced to the left, with the same creepages, mirrored."""
    yaw_rate = INCLINED * inputs["vehicle_speed"] - inputs["spin_rate"]
    return {
        **inputs,
        "wheel_speed": (RADIUS * inputs["wheel_speed"] - lever * yaw_rate) / rolling_radius,
        "lateral_speed": -inputs["lateral_speed"],
        "spin_rate": np.zeros_like(yaw_rate),
        "yaw_rate": yaw_rate,
        "lateral_displacement": np.full_like(yaw_rate, displacement),
    }


def straight(inputs):
    """Return the inputs without motion across the rail, which a line does not have."""
    return {name: np.zeros_like(v) if name in ("lateral_speed", "spin_rate") else v for name, v in inputs.items()}


def runs(rough, steps):
    """Return name, parameters and inputs of each run; a patch takes a third of the steps of the line."""
    if not rough:
        inputs = inputs_at("examples/braking.csv", STEP * np.arange(steps))
        fewer = {name: values[: steps // 3] for name, values in inputs.items()}
        return [("line", {"contact_model": LINE}, inputs), ("patch", {"contact_model": PATCH}, fewer)]
    inputs = inputs_at("benches/rough_track.csv", STEP * np.arange(steps))
    return [
        ("line", {"contact_model": LINE}, straight(inputs)),
        ("patch", {"contact_model": PATCH}, inputs),
        ("8 x 8", FAST_GRID, inputs),
        *((name, {"contact_model": PROFILES}, on_profiles(inputs, *place)) for name, *place in ON_PROFILES),
    ]


def timed(call, *arguments, **keywords):
    """Return what a call gives, and its processor time in µs."""
    start = time.thread_time_ns()
    result = call(*arguments, **keywords)
    return result, 1e-3 * (time.thread_time_ns() - start)


def times_of(folders, descriptions, parameters, columns):
    """Return the quickest start, and the times of all steps, of both components."""
    inputs = [dict(zip(columns, values, strict=True)) for values in zip(*columns.values(), strict=True)]
    steps = len(inputs)
    parameters = {"slip_source": SLIP_FROM_SPEEDS, **parameters}
    units = list(zip(folders, descriptions, strict=True))
    starts = [[], []]
    for _ in range(STARTS):
        for unit, own in zip(units, starts, strict=True):
            component, start = timed(Component, *unit, parameters, inputs[0])
            own.append(start)
            component.fmu.freeInstance()
    components = [Component(*unit, parameters, inputs[0]) for unit in units]
    times = [[], []]
    for first in range(0, steps, TURN):
        for component, own in zip(components, times, strict=True):
            for step in range(first, min(first + TURN, steps)):
                component.set(inputs[step])
                point = {"currentCommunicationPoint": STEP * step, "communicationStepSize": STEP}
                own.append(timed(component.fmu.doStep, **point)[1])
    for component in components:
        component.fmu.freeInstance()
    return np.min(starts, axis=1), np.array(times)


def main():
    """Print a table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("before", type=Path)
    parser.add_argument("after", type=Path)
    parser.add_argument("--steps", type=int, default=3000, help="steps of the line; braking, a patch takes a third")
    parser.add_argument("--rough", action="store_true", help="the rough track in place of braking")
    arguments = parser.parse_args()
    if arguments.steps < LEAST_STEPS:
        parser.error(f"--steps {arguments.steps}: {LEAST_STEPS} at least")
    archives = [str(arguments.before), str(arguments.after)]
    descriptions = [read_model_description(archive) for archive in archives]
    folders = [extract(archive) for archive in archives]
    try:
        for name, parameters, inputs in runs(arguments.rough, arguments.steps):
            starts, times = times_of(folders, descriptions, parameters, inputs)
            rows = {"median step": np.median(times, axis=1), "99 %": np.quantile(times, 0.99, axis=1), "start": starts}
            for row, (before, after) in rows.items():
                print(f"{name:6}{row:12}{before:10.1f} µs{after:10.1f} µs   ratio {after / before:.3f}")
    finally:
        for folder in folders:
            shutil.rmtree(folder, ignore_errors=True)


if __name__ == "__main__":
    main()
