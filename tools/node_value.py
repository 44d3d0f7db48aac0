"""Draw what a node is worth: error of the creep curve against the time of a step, for several numbers of contact nodes.

    tools/node_value.py target/release/wheelrail                 docs/node_value.png, and its table on standard output
    tools/node_value.py target/release/wheelrail --before OTHER  the same beside an earlier commit's command line

The error is the largest of T/(mu N) over creepages from -0.5 % to 0.5 % and three loads, against 401 nodes of the first
command; the time is that of the braking manoeuvre of the demo, by the processor's clock, less that of its start.
"""

import argparse
import csv
import os
import subprocess
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

ROOT = Path(__file__).resolve().parent.parent
NODES = [21, 31, 41, 51, 61, 81, 121]
FINE = 401
CREEPAGES = np.linspace(-0.005, 0.005, 21)
LOADS = [45e3, 60e3, 83e3]
# Longer than any way on which a change is remembered.
HOLD = 0.5
FRICTION = 0.45
STEADY = ["friction_law=1", "thermal_expansion=0", "wear_coefficient=0"]
BRAKING = ["slip_source=2"]
WHEELS = {"rigid": "wheel=1", "elastic": "wheel=2"}


def simulate(command, scenario, step, settings, output):
    """Run the command line; return the seconds of processor time it took."""
    line = [command, "simulate", str(scenario), "--output", str(output), "--step", repr(step)]
    for setting in settings:
        line += ["--set", setting]
    before = os.times()
    subprocess.run(line, check=True, capture_output=True)
    after = os.times()
    return after.children_user - before.children_user


def creep_curve(command, nodes, settings, folder):
    """T/(mu N) at each load and creepage."""
    scenario, output = folder / "creep.csv", folder / "out.csv"
    with scenario.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time", "creepage", "normal_load"])
        time = 0.0
        for load in LOADS:
            for creepage in CREEPAGES:
                writer.writerow([time, creepage, load])
                writer.writerow([time + HOLD - 1e-6, creepage, load])
                time += HOLD
    simulate(command, scenario, HOLD / 2, [*STEADY, f"contact_nodes={nodes}", *settings], output)
    with output.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    columns = {name.split(" ")[0]: name for name in rows[0]}
    time = np.array([float(row[columns["time"]]) for row in rows])
    share = np.array([float(row[columns["traction_coefficient"]]) for row in rows]) / FRICTION
    ends = [np.argmin(np.abs(time - (k + 0.5) * HOLD)) for k in range(len(LOADS) * len(CREEPAGES))]
    return share[ends]


def step_time(command, nodes, settings, folder):
    """Microseconds of processor time of a step of the braking manoeuvre: the least of three runs."""
    scenario, start = ROOT / "examples" / "braking.csv", folder / "start.csv"
    lines = [line for line in scenario.read_text().splitlines() if not line.startswith("#")]
    start.write_text("\n".join(lines[:3]) + "\n")
    steps = 1000 * (float(lines[-1].split(",")[0]) - float(lines[2].split(",")[0]))
    settings = [*BRAKING, f"contact_nodes={nodes}", *settings]
    whole = min(simulate(command, scenario, 1e-3, settings, folder / "out.csv") for _ in range(3))
    return 1e6 * (whole - min(simulate(command, start, 1e-3, settings, folder / "out.csv") for _ in range(3))) / steps


def main():
    """Measure, print and draw."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("command")
    parser.add_argument("--before", help="command line of an earlier commit")
    arguments = parser.parse_args()
    # An earlier commit has no Coulomb's law; its least regularisation stands for it.
    builds = {"now": (arguments.command, [])}
    if arguments.before:
        builds["before"] = (arguments.before, ["slip_regularisation=1e-6"])
    figure, axes = plt.subplots(figsize=(7, 4.5))
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        limits = {wheel: creep_curve(arguments.command, FINE, [setting], folder) for wheel, setting in WHEELS.items()}
        print("| build | wheel | nodes | error of T/(μN) | step [µs] |\n|---|---|---|---|---|")
        for build, (command, settings) in builds.items():
            for wheel, setting in WHEELS.items():
                points = []
                for nodes in NODES:
                    curve = creep_curve(command, nodes, [setting, *settings], folder)
                    error = np.abs(curve - limits[wheel]).max()
                    points.append((step_time(command, nodes, [setting], folder), error))
                    print(f"| {build} | {wheel} | {nodes} | {error:.4f} | {points[-1][0]:.1f} |", flush=True)
                time, error = zip(*points, strict=True)
                line = axes.loglog(time, error, "o-" if build == "now" else "s--", label=f"{wheel} wheel, {build}")
                for nodes, x, y in zip(NODES, time, error, strict=True):
                    axes.annotate(
                        str(nodes),
                        (x, y),
                        textcoords="offset points",
                        xytext=(4, 4),
                        fontsize=7,
                        color=line[0].get_color(),
                    )
    axes.set_xlabel("processor time of a step of the braking manoeuvre [µs]")
    axes.set_ylabel("largest error of T/(μN)")
    axes.grid(True, which="both", alpha=0.3)
    axes.legend()
    figure.tight_layout()
    figure.savefig(ROOT / "docs" / "node_value.png", dpi=110)


if __name__ == "__main__":
    main()
