"""Draw what Newton's method on the interface vector takes beside the fixed point alone, over hard steps.

`wheelrail torture --solved` takes the slowest steps that it has solved again, with Newton's method and without it;
those in which it makes no difference are left out. Steps that are taken staggered are none of them: with and without it
they end at the budget of work. The picture is docs/newton.png, the numbers are printed.
"""

import argparse
import re
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt
from matplotlib.ticker import NullFormatter

REPOSITORY = Path(__file__).resolve().parent.parent
STEP = re.compile(r"--run (\d+) step (\d+): (\d+) µs \(\d+ µs in the run\), (\d+) iterations")
COLOURS = ("tab:blue", "tab:red")
WITHOUT = re.compile(r"Newton's method: (?:(fails)|(\d+) µs, (\d+))")


def hard_steps(model, arguments):
    """Yield time and iterations of a step with Newton's method, and without it (none where it fails)."""
    command = [REPOSITORY / "target/release/wheelrail", "torture", "--model", model, "--solved"]
    command += ["--runs", arguments.runs, "--seed", arguments.seed, "--slowest", arguments.slowest]
    text = subprocess.run(list(map(str, command)), text=True, stdout=subprocess.PIPE, check=False).stdout
    step = None
    for line in text.splitlines():
        if found := STEP.search(line):
            step = float(found[3]), int(found[4])
        elif (found := WITHOUT.search(line)) and step:
            yield step, None if found[1] else (float(found[2]), int(found[3]))


def draw(steps_of, path):
    """Draw iterations and time, each without against with."""
    figure, axes = plt.subplots(1, 2, figsize=(9, 4.2))
    for axis, index, scale, name in [(axes[0], 1, 1, "sweeps of a step"), (axes[1], 0, 1e-3, "time of a step [ms]")]:
        everything = [value for steps in steps_of.values() for pair in steps for value in pair if value]
        ends = [scale * value[index] for value in everything]
        low, high = 0.7 * min(ends), 1.5 * max(ends)
        axis.loglog([low, high], [low, high], color="0.7", linewidth=0.8)
        for (model, steps), colour in zip(steps_of.items(), COLOURS, strict=True):
            pairs = [(scale * with_[index], scale * without[index]) for with_, without in steps if without]
            failed = [scale * with_[index] for with_, without in steps if not without]
            axis.loglog(*zip(*pairs, strict=True), "o", color=colour, markersize=4, label=model) if pairs else None
            label = f"{model}, the fixed point alone fails"
            axis.loglog(failed, [high] * len(failed), "x", color=colour, markersize=6, label=label, clip_on=False)
        axis.set(xlabel=f"{name}, with Newton's method", ylabel=f"{name}, fixed point alone", xlim=(low, high))
        axis.set_ylim(low, high)
        for coordinate in (axis.xaxis, axis.yaxis):
            coordinate.set_minor_formatter(NullFormatter())
    axes[0].legend(loc="lower right", fontsize=8)
    figure.subplots_adjust(left=0.09, right=0.98, bottom=0.14, top=0.97, wspace=0.25)
    figure.savefig(path, dpi=130)


def main():
    """Run the torture, draw, print."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--runs", type=int, default=100)
    parser.add_argument("--seed", type=int, default=77)
    parser.add_argument("--slowest", type=int, default=40)
    parser.add_argument("--output", type=Path, default=REPOSITORY / "docs/newton.png")
    arguments = parser.parse_args()
    steps_of = {model: list(hard_steps(model, arguments)) for model in ("line", "patch")}
    for model, steps in steps_of.items():
        both = [(with_, without) for with_, without in steps if without]
        print(f"{model}: {len(steps)} hard steps; without Newton's method {len(steps) - len(both)} fail")
        for index, name in [(0, "time"), (1, "sweeps")] if both else []:
            ratios = sorted(without[index] / with_[index] for with_, without in both)
            median = ratios[len(ratios) // 2]
            print(f"  {name} without over with: least {ratios[0]:.2f}, median {median:.2f}, largest {ratios[-1]:.1f}")
    if not any(steps_of.values()):
        raise SystemExit("none of the slowest steps needs Newton's method: take more runs")
    draw(steps_of, arguments.output)


if __name__ == "__main__":
    main()
