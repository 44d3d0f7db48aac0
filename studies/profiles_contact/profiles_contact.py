"""Wheel and rail in contact, and the pressure on the unrolled surface of the rail: tread, two places, flange.

    .venv/bin/python studies profiles_contact       (after `make fmu`)

The left wheel of a wheelset S1002 on 60E1 that has moved to the left, as `wheelrail simulate --fields` writes the
pressure: a row for each cell of each window.
"""

import csv
import subprocess
import sys

import numpy as np
import pandas as pd
from helpers import BLACK, BLUE, REPOSITORY, RESULTS, WHEEL_RADIUS, save, wheelrail, write_csv
from matplotlib import pyplot as plt
from matplotlib.patches import Rectangle

WHEELRAIL = REPOSITORY / "target" / "release" / "wheelrail"
SPEED, LOAD = 20.0, 30e3  # m/s, N
INCLINATION, HALF_GAUGE, GAUGE_DEPTH = 1 / 40, 0.7175, 0.014  # of the default parameters; m
# Twice the default cells each way, for the picture.
NODES, STRIPS = 68, 42
PLACES = {"tread": 1e-3, "two places": 5e-3, "flange": 6.6e-3}


def simulate(lateral, roll):
    """Roll, and return the cells at the end and the last outputs."""
    RESULTS.mkdir(exist_ok=True)
    scenario, outputs, fields = (RESULTS / f"profiles_{name}.csv" for name in ("scenario", "outputs", "fields"))
    inputs = {
        "normal_load": LOAD,
        "vehicle_speed": SPEED,
        "wheel_speed": SPEED / WHEEL_RADIUS,
        "lateral_displacement": lateral,
        "roll_angle": roll,
    }
    with scenario.open("w", newline="") as file:
        csv.writer(file).writerows([["time", *inputs], [0.0, *inputs.values()], [2e-3, *inputs.values()]])
    parameters = {"contact_model": 3, "slip_source": 2, "patch_nodes": NODES, "patch_strips": STRIPS}
    command = [WHEELRAIL, "simulate", scenario, "--output", outputs, "--fields", fields, "--step=1e-3"]
    command += [f"--set={name}={value}" for name, value in parameters.items()]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(done.stderr)
    return wheelrail.read_table(fields), wheelrail.read_table(outputs).iloc[-1]


def windows(cells, rail):
    """The windows: x, arc length from the rail's top, and pressure of their cells, strip by strip."""
    top = np.interp(0.0, rail["y"], rail["arc_length"])
    for _, own in cells.groupby("window"):
        shape = (own["arc_length"].nunique(), -1)
        yield tuple(np.reshape(values.array, shape) for values in (own["x"], own["arc_length"] - top, own["pressure"]))


def running_face(rail):
    """Lateral position of the running face in the frame of the rail's profile."""
    inside = rail[(rail["y"] < 0.0) & (rail["z"] < -0.005)]
    return np.interp(-GAUGE_DEPTH, inside["z"], inside["y"])


def outlines(axes, lateral, rail_points, contacts):
    """Wheel and rail across the track, where they touch, and the places of the contacts."""
    geometry = wheelrail.contact_geometry("60E1", "S1002", lateral=(0.0, 8e-3), outlines_at=lateral)
    points = pd.DataFrame(geometry.attrs["outlines"])
    for body, colour in (("rail", BLACK), ("wheel", BLUE)):
        own = points[(points["side"] == "left") & (points["body"] == body)]
        axes.plot(1e3 * own["y"], 1e3 * own["z"], color=colour, label=body)
    top = HALF_GAUGE - running_face(rail_points)
    for contact in contacts:
        y, inclination = contact["rail_position"], contact["inclination"]
        z = np.interp(y, rail_points["y"], rail_points["z"])
        normal = np.array([-np.sin(inclination), np.cos(inclination)])
        end = 1e3 * np.array([y + top, z])
        tail = end - 0.4 * contact["normal_force"] / 1e3 * normal
        axes.annotate("", end, tail, arrowprops={"arrowstyle": "-|>", "color": "#D55E00", "linewidth": 1.3})
    axes.set(xlabel="to the left, y [mm]", aspect="equal", xlim=(794, 702), ylim=(-30, 12))


def draw(cases, rail):
    """Profiles above, the unrolled surface below."""
    figure, panels = plt.subplots(2, 3, figsize=(10.4, 5.9), layout="constrained", height_ratios=[2, 5])
    for (name, (lateral, cells, contacts)), (above, below) in zip(cases.items(), panels.T, strict=True):
        outlines(above, lateral, rail, contacts)
        above.set_title(f"{name}: {1e3 * lateral:.1f} mm to the left")
        highest = cells["pressure"].max() / 1e6
        for x, arc, pressure in windows(cells, rail):
            if not (pressure > 0.0).any():
                continue
            corner, size = (1e3 * x.min(), 1e3 * arc.min()), (1e3 * np.ptp(x), 1e3 * np.ptp(arc))
            below.add_patch(Rectangle(corner, *size, fill=False, edgecolor="#999999", linewidth=0.7))
            shown = np.where(pressure > 0.0, pressure / 1e6, np.nan)
            places = (1e3 * x, 1e3 * arc)
            # All windows of a panel have one scale.
            mesh = below.pcolormesh(*places, shown, cmap="viridis_r", shading="nearest", vmin=0, vmax=highest)
        lines = [
            f"{contact['normal_force'] / 1e3:.1f} kN at {np.degrees(contact['inclination']):.1f}°,"
            f" {contact['peak_pressure'] / 1e6:.0f} MPa"
            for contact in reversed(contacts)
        ]
        below.text(0.03, 0.98, "\n".join(lines), transform=below.transAxes, va="top", fontsize=8)
        below.set(xlabel="along the rail, x [mm]", aspect="equal", xlim=(-22, 22), ylim=(-50, 7))
        below.grid(False)
        figure.colorbar(mesh, ax=below, label="MPa", shrink=0.77, pad=0.02)
    panels[0, 0].set_ylabel("height, z [mm]")
    panels[0, 0].legend(loc="lower left", fontsize=7, borderaxespad=0.1)
    panels[1, 0].set_ylabel("along the rail's profile, s [mm],\nfrom its top to the field side")
    save(figure, "profiles_contact.png")


def main():
    """Simulate, draw, report."""
    if not WHEELRAIL.exists():
        sys.exit(f"{WHEELRAIL} is not there: run `make fmu` first")
    rail = wheelrail.Profile("60E1", inclination=INCLINATION).points
    geometry = wheelrail.contact_geometry("60E1", "S1002", lateral=(0.0, 8e-3))
    cases = {}
    for name, lateral in PLACES.items():
        roll = np.interp(lateral, geometry["lateral_displacement"], geometry["roll_angle"])
        cells, outputs = simulate(lateral, roll)
        names = ("rail_position", "inclination", "normal_force", "peak_pressure")
        count = round(outputs["contacts"])
        contacts = [{key: outputs[f"contact.{key}[{n}]"] for key in names} for n in range(1, count + 1)]
        cases[name] = (lateral, cells, contacts)
        parts = [f"{contact['normal_force'] / 1e3:.1f} kN" for contact in contacts]
        print(f"  {name}, {1e3 * lateral:.1f} mm: {' and '.join(parts)}")
    draw(cases, rail)
    rows = [
        {"lateral_displacement": lateral, **contact} for lateral, _, contacts in cases.values() for contact in contacts
    ]
    write_csv("profiles_contact.csv", {name: [row[name] for row in rows] for name in rows[0]})


if __name__ == "__main__":
    main()
