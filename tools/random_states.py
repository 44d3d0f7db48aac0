"""How far default cells are from fine ones, or from a second program: peak pressure and forces in random states.

    .venv/bin/python tools/random_states.py                    (after `make fmu3`)
    .venv/bin/python tools/random_states.py --load 60 --states 20 --to-the-right 5.7 6.1
    .venv/bin/python tools/random_states.py --dense --states 20
    .venv/bin/python tools/random_states.py --dense --benchmark

The right wheel S1002 on UIC60 without heat and wear, steady: displacement, roll, yaw, lateral speed, yaw rate and
creepage at random, with a fixed seed. The fine grid has twice the cells along and four times the strips; the second
program is `dense_contact.py`, half a minute a state. The benchmark is Manchester's, the right wheel between tread and
flange and on the flange.
"""

import argparse
import sys
from pathlib import Path

import dense_contact
import numpy as np

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "python"))

from wheelrail import Instance  # noqa: E402  the package's folder is on the path from here on

FMU = REPOSITORY / "target" / "WheelRailContact-fmi3.fmu"
SPEED, RADIUS, FRICTION = 20.0, 0.46, 0.3  # m/s, m, 1
DEFAULT, FINE, DENSE = (34, 21), (68, 84), (24, 32)
# On fewer cells a contact of the dense program hangs on where its ends lie.
LEAST_CELLS = 8
# What is drawn where nothing else is asked for: load [kN], states, displacements to the right [mm].
DRAWN = {"load": 100.0, "states": 120, "to_the_right": (-6.0, 8.0)}
ROLLING = {"vehicle_speed": SPEED, "wheel_speed": SPEED / RADIUS}
BODIES = {
    **{"contact_model": "profiles", "side": "right", "rail_profile": "UIC60", "wheel_profile": "S1002"},
    **{"friction_law": "constant", "friction_cold": FRICTION, "slip_source": "vehicle_speed"},
    **{"thermal_expansion": 0.0, "wear_coefficient": 0.0},
}


# Of the Manchester benchmark, case: displacement to the right [mm], roll, yaw [rad], wheel speed [rad/s]; the
# load [kN].
BENCHMARK = [
    (5.0, -0.0003554, 0.012, 43.353637),
    (6.5, -0.004376, 0.0156, 42.748834),
    (8.0, -0.008606, 0.0192, 42.534857),
    (10.0, -0.01126431, 0.024, 42.436375),
]
BENCHMARK_LOAD = 10.0


def benchmark():
    """Inputs of the benchmark's states, y to the left and z upward."""
    for lateral, roll, yaw, wheel_speed in BENCHMARK:
        place = {"lateral_displacement": -1e-3 * lateral, "roll_angle": roll, "yaw_angle": -yaw}
        yield place | {"lateral_speed": 0.0, "yaw_rate": 0.0, "wheel_speed": wheel_speed}


def states(chosen):
    """Inputs of each state."""
    if chosen.benchmark:
        yield from benchmark()
        return
    random = np.random.default_rng(5)
    least, most = chosen.to_the_right
    for _ in range(chosen.states):
        yaw = random.uniform(-0.012, 0.012)
        yield {
            "lateral_displacement": random.uniform(-1e-3 * most, -1e-3 * least),
            "roll_angle": random.uniform(-2e-3, 2e-3),
            "yaw_angle": yaw,
            "lateral_speed": SPEED * yaw + random.uniform(-0.05, 0.05),
            "yaw_rate": random.uniform(-0.05, 0.05),
            "wheel_speed": SPEED / RADIUS * (1.0 + random.uniform(-2e-3, 2e-3)),
        }


def computed(cells, chosen):
    """Peak pressure, forces and sum of the normal forces of all states, each from a lifted wheel."""
    bodies = BODIES | {"patch_nodes": cells[0], "patch_strips": cells[1]}
    if chosen.dense or chosen.benchmark:
        bodies |= dense_contact.material()
    found = []
    with Instance(FMU, **bodies, normal_load=0.0, **ROLLING) as wheel:
        wheel.start()
        lifted = wheel.save()
        for inputs in states(chosen):
            wheel.restore(lifted)
            wheel.set(normal_load=1e3 * chosen.load, **inputs)
            wheel.step(0.1)
            wheel.step(0.1)
            normal_force = np.sum(wheel.get("contact.normal_force"))
            found.append([*np.ravel(wheel.get("peak_pressure", "force_x", "force_y")), normal_force])
    return np.array(found)


def by_the_second_program(normal_forces, chosen):
    """Peak pressure and forces under these normal forces, by dense_contact.py; of a state that it cannot solve, nan."""
    found = np.full((chosen.states, 3), np.nan)
    for number, (inputs, force) in enumerate(zip(states(chosen), normal_forces, strict=True)):
        try:
            solution = dense_contact.of_right_wheel(ROLLING | inputs, force, chosen.cells)
        except dense_contact.DenseError as error:
            print(f"state {number}: {error}", flush=True)
            continue
        found[number] = 1e6 * solution.peak, *solution.force[:2]
        print(f"state {number}: {solution.contacts} contacts", flush=True)
    return found


def main():
    """Print the errors, and the states with the largest."""
    parser = argparse.ArgumentParser(description="Default cells against fine ones, in random states")
    parser.add_argument("--load", type=float, help="vertical load [kN] (100)")
    parser.add_argument("--states", type=int, help="how many (120)")
    place = {"metavar": ("FROM", "TO"), "help": "displacement [mm] (-6 to 8)"}
    parser.add_argument("--to-the-right", type=float, nargs=2, **place)
    parser.add_argument("--dense", action="store_true", help="against dense_contact.py, not against finer cells")
    cells = {"metavar": ("ALONG", "ACROSS"), "help": "cells that dense_contact.py begins with (24 32)"}
    parser.add_argument("--cells", type=int, nargs=2, **cells)
    parser.add_argument("--benchmark", action="store_true", help="states of the Manchester benchmark under its load")
    parser.set_defaults(**DRAWN)
    chosen = parser.parse_args()
    if chosen.cells is not None and (not chosen.dense or min(chosen.cells) < LEAST_CELLS):
        parser.error(f"--cells goes with --dense, and {LEAST_CELLS} each way are the least")
    chosen.cells = chosen.cells or DENSE
    if chosen.benchmark:
        if (chosen.load, chosen.states, chosen.to_the_right) != tuple(DRAWN.values()):
            parser.error("--benchmark has its own load, states and displacements")
        chosen.load, chosen.states = BENCHMARK_LOAD, len(BENCHMARK)
    if chosen.states < 1 or not chosen.load > 0.0:
        parser.error("at least one state and a load above 0 are needed")
    if not chosen.to_the_right[0] <= chosen.to_the_right[1]:
        parser.error("--to-the-right goes from the smaller displacement to the larger one")
    default = computed(DEFAULT, chosen)
    fine = by_the_second_program(default[:, 3], chosen) if chosen.dense else computed(FINE, chosen)
    solved = ~np.isnan(fine[:, 0])
    default, fine = default[solved, :3], fine[solved, :3]
    peak = np.abs(default[:, 0] / fine[:, 0] - 1.0)
    force = np.hypot(*(default - fine)[:, 1:].T) / (1e3 * FRICTION * chosen.load)
    for name, error, limits in (("peak pressure", peak, (0.02, 0.04)), ("forces over μQ", force, (0.01, 0.02))):
        beyond = ", ".join(f"{(error > limit).sum()} beyond {limit:g}" for limit in limits)
        quantiles = f"median {np.median(error):.4f}, 95 % {np.quantile(error, 0.95):.4f}, worst {error.max():.4f}"
        print(f"{name}: {quantiles}; of {solved.sum()} {beyond}")
    places = np.array([-1e3 * inputs["lateral_displacement"] for inputs in states(chosen)])[solved]
    if chosen.benchmark:
        for place, here, there in zip(places, default, fine, strict=True):
            numbers = "; ".join(f"{1e-6 * peak:.0f} MPa, {x:.0f} and {y:.0f} N" for peak, x, y in (here, there))
            print(f"  {place:.1f} mm to the right: peak pressure, F_x and F_y: {numbers}")
        return
    for number in np.argsort(-peak)[:5]:
        share = 100.0 * peak[number]
        print(f"  {places[number]:.2f} mm to the right: peak off by {share:.1f} %, forces {force[number]:.4f}")


if __name__ == "__main__":
    main()
