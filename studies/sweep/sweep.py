"""Creep curves over friction law, speed and load, as a Dask job.

    .venv/bin/python studies sweep                          two workers on this machine (or `make coupling-sweep`)
    .venv/bin/python studies sweep --scheduler tcp://...    an existing cluster
    .venv/bin/python studies sweep --scaling                the time that two workers take against one

A task is one curve: the steady traction at a list of creepages. Finished curves are written at once, a Parquet file
each, and not computed again: after a kill, the same command goes on. docs/couplings/sweep.md.
"""

import argparse
import itertools
import os
import shutil
import sys
import tempfile
import time
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyarrow as pa
import pyarrow.parquet as pq
from dask_runs import (
    add_options,
    client_for,
    computed,
    local_client,
    local_file,
    missing,
    read_component,
    stamp_of,
    write_table,
)
from helpers import FMU, REPOSITORY, RESULTS, WHEEL_RADIUS, reused, save
from matplotlib.collections import LineCollection
from matplotlib.colors import LogNorm

LAWS = {"constant": 1, "piecewise_linear": 2, "flow_stress": 3}
SPEEDS = (2.0, 5.0, 10.0, 15.0, 20.0, 30.0, 40.0, 50.0)  # m/s
LOADS = (20e3, 40e3, 60e3, 70e3, 80e3, 100e3)  # N
CREEPAGES = tuple(float(value) for value in np.geomspace(1e-4, 0.5, 32))
OUTPUTS = {
    "traction_force": "N",
    "traction_coefficient": "1",
    "friction_coefficient": "1",
    "peak_temperature": "K",
    "peak_pressure": "Pa",
    "stick_fraction": "1",
    "friction_power": "W",
    "wear_rate": "m3/s",
}
# A step that is long against the rail's passage through the model, so that a few of them are the steady state.
STEP = 5.0  # s
STEADY = 1e-9  # largest relative change over a step
WORK = RESULTS / "creep_curves"


# ---- on a worker ----------------------------------------------------------------------------------------------------


def curve(component, digest, law, speed, load, creepages):
    """Steady outputs of one curve, a list for each column; every curve starts from the same state."""
    instance = reused(local_file(component, digest), friction_law=LAWS[law])
    columns = {name: [] for name in OUTPUTS}
    for creepage in creepages:
        instance.set(creepage=creepage, normal_load=load, wheel_speed=speed * (1.0 + creepage) / WHEEL_RADIUS)
        now = instance.steady(tuple(OUTPUTS), STEP, STEADY)
        for name, value in zip(OUTPUTS, now, strict=True):
            columns[name].append(value)
    return columns


# ---- on the client --------------------------------------------------------------------------------------------------


def part(folder, law, speed, load):
    """The file of one curve."""
    return folder / f"{law}-{speed:g}-{load:g}.parquet"


def write_part(path, stamp, law, speed, load, creepages, columns):
    """Write one curve; the file is there as a whole or not at all."""
    count = len(creepages)
    known = {"friction_law": (None, [law] * count), "speed": ("m/s", [speed] * count)}
    known |= {"normal_load": ("N", [load] * count), "creepage": ("1", creepages)}
    write_table(path, stamp, known | {name: (unit, columns[name]) for name, unit in OUTPUTS.items()})


def sweep(client, folder, laws=tuple(LAWS), speeds=SPEEDS, loads=LOADS, creepages=CREEPAGES, quiet=False):
    """Compute the curves that are not there yet; return how many those were."""
    folder.mkdir(parents=True, exist_ok=True)
    component, digest = read_component()
    stamp = stamp_of(digest, creepages, STEP, STEADY)
    curves = list(itertools.product(laws, speeds, loads))
    left = missing(curves, lambda *key: part(folder, *key), lambda *key: stamp, "curves")

    def arguments(*key):
        return digest, *key, creepages

    for key, columns in computed(client, curve, left, component, arguments, "curves", quiet):
        write_part(part(folder, *key), stamp, *key, creepages, columns)
    return len(left)


def gather(folder, laws=tuple(LAWS), speeds=SPEEDS, loads=LOADS):
    """All curves as one table, in the order of the grid."""
    return pa.concat_tables([pq.read_table(part(folder, *key)) for key in itertools.product(laws, speeds, loads)])


def scaling(rounds=3):
    """Time the whole sweep, from nothing, on one worker and on two, in turns; the workers are started before."""
    seconds = {1: [], 2: []}
    for workers in (1, 2) * rounds:
        with local_client(workers) as client, tempfile.TemporaryDirectory() as folder:
            client.wait_for_workers(workers)
            began = time.perf_counter()
            count = sweep(client, Path(folder), quiet=True)
            seconds[workers].append(time.perf_counter() - began)
            used = sum(client.run(time.process_time).values())
        load = os.getloadavg()[0]
        print(
            f"  {workers} worker(s): {count} curves in {seconds[workers][-1]:.1f} s,"
            f" {used:.1f} s of processor time in the workers, load {load:.1f}",
            flush=True,
        )
    ratio = min(seconds[1]) / min(seconds[2])
    print(f"  best of {rounds}: {ratio:.2f} times as fast on two workers as on one, on {os.cpu_count()} cores")


# ---- the picture ----------------------------------------------------------------------------------------------------


def draw(table):
    """Draw traction against creepage, coloured by temperature: speeds above, loads below, a column for each law."""
    data = {name: np.array(table[name].to_pylist()) for name in table.column_names}
    laws = {"constant": "constant", "piecewise_linear": "piecewise linear", "flow_stress": "flow stress"}
    speeds, loads = (2.0, 5.0, 10.0, 20.0, 50.0), (20e3, 40e3, 60e3, 80e3, 100e3)
    figure, panels = plt.subplots(2, 3, figsize=(8.4, 7.0), sharex=True, sharey=True, layout="constrained")
    colours = LogNorm(20.0, 800.0)
    for column, (law, title) in enumerate(laws.items()):
        for row, (name, values) in enumerate((("speed", speeds), ("normal_load", loads))):
            axes = panels[row, column]
            fixed = data["normal_load"] == 60e3 if name == "speed" else data["speed"] == 20.0
            ends = []
            for value in values:
                chosen = (data["friction_law"] == law) & fixed & (data[name] == value)
                x, y = 100 * data["creepage"][chosen], data["traction_coefficient"][chosen]
                points = np.column_stack([x, y])
                lines = LineCollection(np.stack([points[:-1], points[1:]], axis=1), cmap="plasma", norm=colours)
                temperature = data["peak_temperature"][chosen] - 273.15
                lines.set_array(0.5 * (temperature[1:] + temperature[:-1]))
                lines.set_linewidth(2.0)
                axes.add_collection(lines)
                ends.append((x[-1], y[-1]))
            label_ends(axes, values, ends, "m/s" if name == "speed" else "kN", 1.0 if name == "speed" else 1e3)
            axes.set_xscale("log")
            axes.set(xlim=(0.01, 400), ylim=(0.0, 0.48))
            axes.set_xticks([0.01, 0.1, 1, 10], ["0.01", "0.1", "1", "10"])
            axes.set_title(f"{title} friction, " + ("60 kN" if name == "speed" else "20 m/s"))
    for axes in panels[:, 0]:
        axes.set_ylabel("traction / load [1]")
    for axes in panels[1]:
        axes.set_xlabel("creepage [%]")
    bar = figure.colorbar(
        plt.cm.ScalarMappable(colours, "plasma"), ax=panels, location="bottom", shrink=0.7, aspect=35, extend="max"
    )
    bar.set_ticks([20, 50, 100, 200, 400, 800], labels=["20", "50", "100", "200", "400", "800"])
    bar.minorticks_off()
    bar.set_label("peak temperature of the rail [°C]")
    save(figure, "creep_curves.png")


def label_ends(axes, values, ends, unit, scale):
    """Label the first and the last of a family of curves at their right ends, or all by one where they meet."""
    first, last = f"{values[0] / scale:g}", f"{values[-1] / scale:g}"
    apart = abs(ends[0][1] - ends[-1][1]) > 0.012
    labels = (
        [(f"{first} {unit}", ends[0]), (f"{last} {unit}", ends[-1])] if apart else [(f"{first}–{last} {unit}", ends[0])]
    )
    for text, place in labels:
        axes.annotate(text, place, (4, 0), "data", "offset points", va="center", fontsize=7.5)


def main():
    """Sweep, gather, draw."""
    options = argparse.ArgumentParser(description="Creep curves over friction law, speed and load as a Dask job")
    add_options(options, "curves")
    options.add_argument("--scaling", action="store_true", help="measure two workers against one instead")
    chosen = options.parse_args()
    if not FMU.exists():
        sys.exit(f"{FMU} is not there: run `make fmu` first")
    if chosen.scaling:
        scaling()
        return
    with client_for(chosen.scheduler, chosen.workers, ()) as client:
        if chosen.fresh:
            shutil.rmtree(WORK, ignore_errors=True)
        sweep(client, WORK)
    table = gather(WORK)
    path = RESULTS / "creep_curves.parquet"
    pq.write_table(table, path)
    print(
        f"  wrote {path.relative_to(REPOSITORY)}: {table.num_rows} points on {len(list(WORK.glob('*.parquet')))} curves"
    )
    draw(table)


if __name__ == "__main__":
    main()
