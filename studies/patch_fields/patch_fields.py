"""The fields of a patch that drives, moves sideways and spins, in plan view: `wheelrail simulate --fields`.

    .venv/bin/python studies patch_fields       (after `make fmu`)

A wheel of the default parameters rolls until it is steady, with its friction that falls with temperature, heat and
wear. Hertz's ellipse beside the cells is the closed form of Johnson, Contact Mechanics, 4.24 to 4.26.
"""

import csv
import subprocess
import sys

import numpy as np
from helpers import REPOSITORY, RESULTS, WHEEL_RADIUS, save
from wheelrail import read_table
from wheelrail.plots import patch_fields

WHEELRAIL = REPOSITORY / "target" / "release" / "wheelrail"
SCENARIO, OUTPUTS, FIELDS = (RESULTS / f"patch_{name}.csv" for name in ("scenario", "outputs", "fields"))
SPEED, LOAD = 20.0, 70e3  # m/s, N
CREEPAGES = {"creepage": 1e-3, "lateral_creepage": 1e-3, "spin_creepage": 0.5}
# Twice the default cells each way, for the picture.
PARAMETERS = {"contact_model": 2, "patch_nodes": 68, "patch_strips": 43}
STOP, STEP = 0.1, 2e-3
# Of the default parameters.
RAIL_CURVATURE, SHEAR_MODULUS, LAME_LAMBDA = 1.0 / 0.3, 8.2e10, 1.166e11


def simulate():
    """Roll, and return the fields at the end, a row for each cell, and the last outputs."""
    if not WHEELRAIL.exists():
        sys.exit(f"{WHEELRAIL} is not there: run `make fmu` first")
    RESULTS.mkdir(exist_ok=True)
    inputs = {"normal_load": LOAD, "wheel_speed": SPEED * (1.0 + CREEPAGES["creepage"]) / WHEEL_RADIUS, **CREEPAGES}
    with SCENARIO.open("w", newline="") as file:
        writer = csv.writer(file)
        writer.writerow(["time", *inputs])
        writer.writerows([[time, *inputs.values()] for time in (0.0, STOP)])
    command = [WHEELRAIL, "simulate", SCENARIO, "--output", OUTPUTS, "--fields", FIELDS, f"--step={STEP}"]
    command += [f"--set={name}={value}" for name, value in PARAMETERS.items()]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return read_table(FIELDS), read_table(OUTPUTS).iloc[-1]


def complete_integrals(k):
    """Complete elliptic integrals K and E of the modulus k, by the arithmetic-geometric mean."""
    a, b, share, weight = 1.0, np.sqrt(1.0 - k * k), 0.5 * k * k, 1.0
    for _ in range(8):
        a, b, c = 0.5 * (a + b), np.sqrt(a * b), 0.5 * (a - b)
        share += weight * c * c
        weight *= 2.0
    first = 0.5 * np.pi / a
    return first, first * (1.0 - share)


def hertz():
    """Semi-axes along and across the rail of like bodies under the gap A x² + B y² [m]."""
    along, across = 0.5 / WHEEL_RADIUS, 0.5 * RAIL_CURVATURE
    if along > across:
        raise ValueError("here the contact is longer along the rail than across it")
    low, high = 1e-3, 1.0 - 1e-12
    for _ in range(60):
        ratio = 0.5 * (low + high)
        k, e = complete_integrals(np.sqrt(1.0 - ratio * ratio))
        # The curvatures' ratio falls as b/a rises.
        if (e / ratio**2 - k) / (k - e) > across / along:
            low = ratio
        else:
            high = ratio
    poisson = 0.5 * LAME_LAMBDA / (LAME_LAMBDA + SHEAR_MODULUS)
    modulus = SHEAR_MODULUS / (1.0 - poisson)  # E*, E/(2(1-ν²)) of like bodies
    # A = (p0/E*) (b/(e² a²)) (K - E), p0 = 3N/(2π a b), e² = 1 - b²/a².
    semi_axis = (1.5 * LOAD / (np.pi * modulus * along) * (k - e) / (1.0 - ratio**2)) ** (1 / 3)
    return semi_axis, ratio * semi_axis


def draw(fields, outputs):
    """Pressure, shear over stick and slip, slip, temperature, beside Hertz's ellipse."""
    axis_pair = hertz()
    title = (
        f"{LOAD / 1e3:.0f} kN, {SPEED:.0f} m/s, creepages $\\xi$ = {100 * CREEPAGES['creepage']:g} %,"
        f" $\\eta$ = {100 * CREEPAGES['lateral_creepage']:g} %, spin $\\varphi$ = {CREEPAGES['spin_creepage']:g} /m:"
        f" $F_x$ = {outputs['traction_force'] / 1e3:.1f} kN, $F_y$ = {outputs['lateral_force'] / 1e3:.1f} kN,"
        f" $M_z$ = {outputs['spin_moment']:.1f} N·m"
    )
    save(patch_fields(fields, ellipse=axis_pair, title=title.replace("-", "−")), "patch_fields.png")
    return axis_pair


def main():
    """Simulate, draw, report."""
    fields, outputs = simulate()
    along, across = draw(fields, outputs)
    print(f"  wrote results/{FIELDS.name}")
    print(
        f"  contact {1e3 * outputs['contact_length']:.2f} by {1e3 * outputs['contact_breadth']:.2f} mm"
        f" (Hertz {2e3 * along:.2f} by {2e3 * across:.2f}), peak pressure {outputs['peak_pressure'] / 1e6:.0f} MPa"
        f" (Hertz {1.5e-6 * LOAD / (np.pi * along * across):.0f})"
    )
    print(
        f"  forces {outputs['traction_force'] / 1e3:.2f} and {outputs['lateral_force'] / 1e3:.2f} kN,"
        f" spin moment {outputs['spin_moment']:.1f} N·m, hottest {outputs['peak_temperature'] - 273.15:.1f} °C"
    )


if __name__ == "__main__":
    main()
