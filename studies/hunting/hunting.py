"""A suspended wheelset with conical treads on straight track: it settles below its critical speed, and hunts above.

    .venv/bin/python studies hunting            (after `make fmu`; or `make coupling-hunting`)

running_wheelset.py has the wheelset, its kinematics and the master: each wheel is an instance of the component, with
contact_model 2, the patch. hunting_runs.py has the linear model with Kalker's coefficients and what is run,
hunting_pictures.py the pictures. Here: the tables, and everything in turn. docs/couplings/hunting.md.
"""

import numpy as np
from helpers import WHEEL_RADIUS, markdown_table, write_csv, write_tables
from hunting_pictures import animate, draw
from hunting_runs import (
    CYCLE_END,
    CYCLE_SPEED,
    FREE_SPEED,
    GROWTH_SPEEDS,
    REFERENCE,
    books,
    crossings,
    eigenvalue,
    klingel,
    measure,
)
from running_wheelset import FLANGE_STIFFNESS, HALF_GAUGE, LOAD, SIDES, Suspension


def tables(found):
    """The tables of the page."""
    axes, (c11, c22, c23, c33), _ = found.theory
    its, its_axes = found.coefficients
    head = ["", "a", "b", "C₁₁", "C₂₂", "C₂₃", "−C₃₂", "C₃₃"]
    lines = [
        [name, *(f"{1e3 * value:.2f} mm" for value in semi), *(f"{value:.3g}" for value in values)]
        for name, semi, values in (
            ("Hertz, Kalker's table", axes, (c11, c22, c23, c23, c33)),
            ("the component", its_axes, its),
        )
    ]
    made = {"coefficients": markdown_table(head, lines)}
    kalker = found.critical["Kalker's coefficients"]
    made["critical"] = markdown_table(
        ["critical speed by", "", "against Kalker's"],
        [[name, f"{speed:.1f} m/s", f"{100 * (speed / kalker - 1):+.1f} %"] for name, speed in found.critical.items()],
    )
    lines = []
    for speed, measured in zip(GROWTH_SPEEDS, found.modes, strict=True):
        values = [*(eigenvalue(found, name, speed) for name in found.linear), measured]
        shown = [f"{value.real:.2f} 1/s, {value.imag / (2.0 * np.pi):.2f} Hz" for value in values]
        lines.append([f"{speed:g} m/s", *shown])
    made["growth"] = markdown_table(["speed", *(f"linear, {name}" for name in found.linear), "small swings"], lines)
    made["wavelength"] = wavelength_table(found)
    made["cycle"] = cycle_table(found)
    (lateral, moment), limit = found.contact
    lines = [
        [f"{1e3 * creepage:g} ‰", *(f"{value:.4f}" for value in values)]
        for creepage, *values in zip(REFERENCE[0], lateral, limit, moment, REFERENCE[3], strict=True)
    ]
    head = ["lateral creepage", "F_y/μN", "CONTACT's limit", "M_z/μNc", "CONTACT, n = 80"]
    return made | {"contact": markdown_table(head, lines)}


def wavelength_table(found):
    """Wavelength and growth without the suspension."""
    lines = [["Klingel, 2π√(r₀b₀/λ): no inertia", f"{klingel():.3f} m", "0.00 %"]]
    for name, value in found.free_modes.items():
        period = 2.0 * np.pi / value.imag
        lines.append([name, f"{FREE_SPEED * period:.3f} m", f"{100.0 * np.expm1(value.real * period):.2f} %"])
    return markdown_table(["", "wavelength", "growth of the swing in a wave"], lines)


def cycle_table(found):
    """What the limit cycle is like."""
    cycle, spent = found.cycle[found.last], books(found.cycle, found.wheelset)
    hottest = max(cycle[f"peak_temperature_{side}"].max() for side in SIDES) - 273.15
    sideways = cycle["lateral_force_left"] + cycle["lateral_force_right"]
    # Both rails' lateral forces, the flange's too, act a radius below the axle.
    at_rails = sideways - FLANGE_STIFFNESS * Suspension.flange(cycle["y"])
    shift = WHEEL_RADIUS / (2.0 * HALF_GAUGE) * np.abs(at_rails).max()
    duration = np.diff(crossings(found.cycle["time"], found.cycle["y"])[-2:])[0]
    _, rail, tread = found.wear
    rows = {
        "amplitude": f"{1e3 * np.abs(cycle['y']).max():.2f} mm, {1e3 * np.abs(cycle['yaw']).max():.2f} mrad",
        "frequency, wavelength": f"{1.0 / duration:.2f} Hz, {CYCLE_SPEED * duration:.1f} m",
        "largest lateral force of both wheels": f"{1e-3 * np.abs(sideways).max():.1f} kN",
        "largest temperature": f"{hottest:.1f} °C",
        "wear of a passage, deepest: mean over the rail, over the tread": f"{1e9 * rail.max():.3f}, "
        f"{1e9 * tread.max():.3f} nm",
        f"pull of the frame over {CYCLE_END:g} s": f"{spent['guide_work']:.0f} J",
        "of it creep, dampers, stored": f"{spent['creep_work']:.0f}, {spent['damper_work']:.0f}, "
        f"{spent['stored']:.0f} J",
        "missing": f"{spent['missing']:.2f} J",
        "the component's friction against the creep": f"{100 * (spent['friction'] / spent['creep_work'] - 1):+.2f} %",
        "left out: shift of load between the wheels": f"{100 * shift / LOAD:.1f} % of the load",
    }
    return markdown_table([f"limit cycle at {CYCLE_SPEED:g} m/s", ""], [list(row) for row in rows.items()])


def main():
    """Measure, draw, write, report."""
    found = measure()
    write_tables("hunting.md", tables(found))
    thinned = found.ramp[::5]
    write_csv("hunting.csv", {name: thinned[name] for name in thinned.dtype.names})
    write_csv("hunting_curve.csv", found.curve)
    names = ("towards the flange [m]", "wear of the rail [m]", "wear of the tread [m]")
    write_csv("hunting_wear.csv", dict(zip(names, found.wear, strict=True)))
    draw(found)
    animate(found)


if __name__ == "__main__":
    main()
