"""Error over time a case: profiles beside CONTACT, KPEC and ANALYN in case A-2.2 of the Manchester contact benchmark.

    .venv/bin/python studies manchester         (after `make fmu`; a part of `make bench`)

The right wheel S1002 on UIC60 under 10 kN, 0, 0.5 and 5 mm from the middle: the positions for which results of two fast
methods are at hand. The reference is CONTACT on the curved surface (src/verification/manchester_cases.rs). A case is a
step from a lifted wheel, so that nothing is left of another position; processor time, the shortest of several.
"""

import time

import numpy as np
from helpers import BLACK, BLUE, FMU, GREEN, ORANGE, RED, Instance, markdown_table, save, write_csv
from matplotlib import pyplot as plt

SPEED, LOAD, FRICTION = 20.0, 10e3, 0.3  # m/s, N, 1
SHEAR, POISSON = 82e9, 0.28  # Pa, 1
# To the right [mm], roll and yaw in the benchmark's axes, y to the right and z down [rad], speed of the wheel [rad/s].
POSITIONS = ((0.0, 0.0, 0.0, 43.481181), (0.5, -2.304e-05, 0.0012, 43.474134), (5.0, -3.554e-4, 0.012, 43.353637))
# Of each position: peak pressure [MPa], area [mm²], force on the wheel along the rail [N], normal force [N].
REFERENCE = ((338.3239, 51.56, 115.2156, 9997.637), (632.5053, 45.88, 986.9941, 9867.012))
REFERENCE += ((1558.87, 15.56, 828.399, 9575.537),)
# Published by CONTACT's author: examples/mbench_a22_right and mbench_a22_kpec.ref_out of github.com/eve70a/CONTACT,
# commit d431cdb. CONTACT's output gives its time for 21 cases: 1.6 s on two threads, 76 ms a case.
CONTACT_TIME = 76.0  # ms
PUBLISHED = {
    "CONTACT, in one plane": ((338.3, 51.64, -0.2783), (632.5, 45.88, 880.0), (1556.0, 15.56, 763.3)),
    "KPEC": ((442.6, 51.28, 341.7), (569.8, 37.56, 973.6), (1625.0, 9.0, 965.9)),
    "ANALYN": ((352.1, 48.96, -340.5), (710.3, 40.64, 1088.0), (1627.0, 10.2, 962.4)),
}
CELLS = ((17, 11), (24, 15), (34, 21), (48, 30), (68, 42))  # along and across; the third is the default
REPEATS = 5
ERRORS = {
    "peak pressure": "largest error of the\npeak pressure [%]",
    "area": "largest error of\nthe area [%]",
    "force": "largest error of $F_x$,\nin $\\mu F_N$ [%]",
}


def errors(values):
    """Largest errors over the positions: peak pressure and area of themselves, F_x of μ F_N."""
    (peak, area, along), (peaks, areas, forces, normal) = np.transpose(values), np.transpose(REFERENCE)
    found = (peak / peaks - 1.0, area / areas - 1.0, (along - forces) / (FRICTION * normal))
    return [100.0 * np.abs(error).max() for error in found]


def computed(nodes, strips):
    """Peak pressure, area and force of each position on so many cells, and the time of a case [ms]."""
    elastic = {"lame_lambda": 2.0 * SHEAR * POISSON / (1.0 - 2.0 * POISSON), "shear_modulus": SHEAR}
    wheel = Instance(
        FMU,
        "wheel",
        contact_model="profiles",
        slip_source="vehicle_speed",
        side="right",
        rail_profile="UIC60",
        wheel_profile="S1002",
        friction_law="constant",
        friction_cold=FRICTION,
        thermal_expansion=0.0,
        wear_coefficient=0.0,
        patch_nodes=nodes,
        patch_strips=strips,
        normal_load=0.0,
        **elastic,
        **{f"wheel_{name}": value for name, value in elastic.items()},
    ).start()
    lifted, values, times = wheel.save(), [], []
    for lateral, roll, yaw, speed in POSITIONS:
        taken = []
        for _ in range(REPEATS):
            wheel.restore(lifted)
            wheel.set(lateral_displacement=-1e-3 * lateral, roll_angle=roll, yaw_angle=-yaw)
            wheel.set(normal_load=LOAD, vehicle_speed=SPEED, wheel_speed=speed)
            start = time.process_time()
            wheel.step(0.1)
            taken.append(1e3 * (time.process_time() - start))
        times.append(min(taken))
        peak, area, along = wheel.get("peak_pressure", "contact_area", "force_x")
        values.append((1e-6 * peak, 1e6 * area, along))
    wheel.close()
    return values, float(np.mean(times))


def draw(rows):
    """Draw each error over the time of a case; lines where no time is published."""
    figure, panels = plt.subplots(1, 3, figsize=(9.6, 3.6), layout="constrained")
    ours = np.array([(taken, *wrong) for _, _, taken, wrong in rows])
    default = CELLS.index((34, 21))
    for number, (axes, label) in enumerate(zip(panels, ERRORS.values(), strict=True)):
        axes.loglog(ours[:, 0], ours[:, 1 + number], "o-", color=BLUE, markersize=4, label="profiles, by cells")
        axes.loglog(ours[default, 0], ours[default, 1 + number], "o", color=BLUE, markersize=9, label="default cells")
        name = "CONTACT, in one plane"
        axes.loglog(CONTACT_TIME, errors(PUBLISHED[name])[number], "s", color=BLACK, markersize=7, label=name)
        for name, colour, line in (("KPEC", RED, "--"), ("ANALYN", ORANGE, ":")):
            axes.axhline(errors(PUBLISHED[name])[number], color=colour, linestyle=line, label=f"{name}, any time")
        axes.set(xlabel="processor time of a case [ms]", ylabel=label, ylim=(0.02, 100), xlim=(1, 300))
        axes.grid(visible=True, which="both", color=GREEN, alpha=0.08)
    panels[0].legend(loc="lower left", fontsize=7)
    save(figure, "manchester.png")


def main():
    """Compute, draw, write, report."""
    rows = []
    for nodes, strips in CELLS:
        values, taken = computed(nodes, strips)
        rows.append((nodes, strips, taken, errors(values)))
    draw(rows)
    table = {"cells along": [row[0] for row in rows], "cells across": [row[1] for row in rows]}
    table |= {"time of a case [ms]": [row[2] for row in rows]}
    table |= {f"{name} [%]": [row[3][k] for row in rows] for k, name in enumerate(ERRORS)}
    write_csv("manchester.csv", table)
    lines = [
        [f"profiles, {nodes} × {strips}", f"{taken:.1f} ms", *(f"{error:.2g} %" for error in wrong)]
        for nodes, strips, taken, wrong in rows
    ]
    for name, values in PUBLISHED.items():
        taken = f"{CONTACT_TIME:.0f} ms" if name.startswith("CONTACT") else "not published"
        lines.append([name, taken, *(f"{error:.2g} %" for error in errors(values))])
    print(markdown_table(["largest error of", "time of a case", *ERRORS], lines))


if __name__ == "__main__":
    main()
