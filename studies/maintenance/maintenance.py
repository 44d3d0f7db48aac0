"""What if, for the maintenance engineer: lines of 1000 braking trains over one spot of the rail, as a Dask job.

    .venv/bin/python studies maintenance                          two workers (or `make coupling-maintenance`)
    .venv/bin/python studies maintenance --scheduler tcp://...    an existing cluster

A task is one line: 8000 wheels with a load, a braking, a friction each, and what they wear off (braking_line.py). Many
lines say how much chance there is in it, scenarios what would change it. A finished line is at once a file, and not
computed again. docs/couplings/maintenance.md.
"""

import argparse
import shutil
import sys
from pathlib import Path

import braking_line
import numpy as np
import pyarrow.parquet as pq
from braking_line import COLUMNS, FACTORS, SCENARIOS, TRAINS
from dask_runs import add_options, client_for, computed, missing, read_component, stamp_of, write_table
from helpers import FMU, RESULTS
from maintenance_results import ALONE, draw, tables

LINES = 24  # of each scenario, the same ones: what differs between scenarios is not chance
LINES_ALONE = 12  # of those with the weather drawn anew for each train
LINES_AGAIN = 4  # of these, for each factor that is drawn again
WORK = RESULTS / "braking_lines"
# What a line depends on besides the component and its settings: what is drawn, and how a wheel is solved.
METHOD = Path(braking_line.__file__)


def all_lines(scenarios=tuple(SCENARIOS), lines=LINES, alone=LINES_ALONE, again=LINES_AGAIN):
    """Keys of all lines: scenario, number, and the factor drawn again or none."""
    keys = [(name, number, "") for name in scenarios for number in range(alone if name == ALONE else lines)]
    return keys + [(ALONE, number, factor) for factor in FACTORS for number in range(again) if ALONE in scenarios]


def part(folder, scenario, number, again):
    """The file of one line."""
    words = f"{scenario} {number:03d} {again}".replace("%", "percent").replace("–", "-").split()
    return folder / f"{'-'.join(words)}.parquet"


def write_part(path, stamp, columns):
    """Write one line; the file is there as a whole or not at all."""
    units = COLUMNS | {"share": "1"}
    write_table(path, stamp, {name: (units[name], values) for name, values in columns.items()})


def run(client, folder, keys, trains=TRAINS):
    """Compute the lines that are not there yet; return how many those were."""
    folder.mkdir(parents=True, exist_ok=True)
    component, digest = read_component()
    method = METHOD.read_text()

    def stamp(scenario, number, again):
        return stamp_of(digest, method, SCENARIOS[scenario], number, again, trains)

    def arguments(scenario, number, again):
        return digest, SCENARIOS[scenario], number, trains, again or None

    left = missing(keys, lambda *key: part(folder, *key), stamp, "lines of trains")
    for key, columns in computed(client, braking_line.line, left, component, arguments, "lines of trains"):
        write_part(part(folder, *key), stamp(*key), columns)
    return len(left)


def gather(folder, keys):
    """All lines, by scenario and factor drawn again: for each column an array of lines by trains."""
    found = {}
    for scenario, number, again in keys:
        table = pq.read_table(part(folder, scenario, number, again))
        found.setdefault((scenario, again), []).append(table)
    return {
        key: {name: np.array([table[name].to_numpy() for table in lines]) for name in lines[0].column_names}
        for key, lines in found.items()
    }


def main():
    """Run the lines, gather, write tables, draw."""
    options = argparse.ArgumentParser(description="Wear of a spot of rail under lines of braking trains, as a Dask job")
    add_options(options, "lines")
    chosen = options.parse_args()
    if not FMU.exists():
        sys.exit(f"{FMU} is not there: run `make fmu` first")
    keys = all_lines()
    with client_for(chosen.scheduler, chosen.workers, ("braking_line",)) as client:
        if chosen.fresh:
            shutil.rmtree(WORK, ignore_errors=True)
        run(client, WORK, keys)
    lines = gather(WORK, keys)
    tables(lines)
    draw(lines)


if __name__ == "__main__":
    main()
