"""Two wheels of a wheelset over its lateral displacement: where they touch, what carries, what it does to the wheelset.

    .venv/bin/python studies wheelset_sweep       (after `make fmu`)

S1002 on 60E1. Each wheel is a component of its own, `side` left or right, under half of the load. The wheelset moves
slowly to the left; its roll is the one at which rigid wheels touch on both sides (`wheelrail.contact_geometry`).
"""

import numpy as np
from helpers import BLACK, BLUE, FMU, RED, WHEEL_RADIUS, save, wheelrail, write_csv
from matplotlib import pyplot as plt

SPEED, LOAD = 20.0, 30e3  # m/s, N on each wheel
REACH = 6.6e-3  # m
# Slow enough that each place is steady: 0.02 mm a step, in which the wheel rolls 0.2 m, many contacts' lengths.
DRIFT, STEP = 2e-3, 1e-2  # m/s, s
CONTACTS = range(1, 5)
OF_CONTACTS = ("rail_position", "wheel_position", "inclination", "normal_force", "peak_pressure", "area")
OUTPUTS = ["force_x", "force_y", "force_z", "moment_x", "moment_z", "contacts"]
SIDES = {"left": BLUE, "right": RED}


def motion():
    """Position of the wheelset over time, from the middle to the left."""
    geometry = wheelrail.contact_geometry("60E1", "S1002", lateral=(0.0, REACH), step=5e-5)
    lateral = geometry["lateral_displacement"]
    return {"time": lateral / DRIFT, "lateral_displacement": lateral, "roll_angle": geometry["roll_angle"]}


def simulate(side, table):
    """Outputs of the wheel of one side."""
    return wheelrail.simulate(
        table,
        fmu=FMU,
        step=STEP,
        outputs=[*OUTPUTS, *(f"contact.{name}" for name in OF_CONTACTS)],
        contact_model="profiles",
        slip_source="vehicle_speed",
        side=side,
        normal_load=LOAD,
        vehicle_speed=SPEED,
        wheel_speed=SPEED / WHEEL_RADIUS,
        lateral_speed=DRIFT,
    )


def contact(result, name, number):
    """What one of the contacts has, where there is so many."""
    return np.where(result["contacts"] >= number, result[f"contact.{name}[{number}]"], np.nan)


def draw(results):
    """Places, normal forces, peak pressures and forces on the wheelset over the displacement."""
    figure, ((places, loads), (pressures, forces)) = plt.subplots(
        2, 2, figsize=(9.6, 6.4), sharex=True, layout="constrained"
    )
    for side, colour in SIDES.items():
        result = results[side]
        lateral = 1e3 * result["lateral_displacement"]
        for number in CONTACTS:
            style = {"color": colour, "marker": ".", "markersize": 4, "linestyle": "none"}
            label = f"{side} wheel" if number == 1 else None
            places.plot(lateral, 1e3 * contact(result, "rail_position", number), **style, label=label)
            loads.plot(lateral, contact(result, "normal_force", number) / 1e3, **style)
            pressures.plot(lateral, contact(result, "peak_pressure", number) / 1e6, **style)
        forces.plot(lateral, result["force_y"] / 1e3, color=colour, label=f"$F_y$, {side} wheel")
        forces.plot(lateral, result["force_x"] / 1e3, color=colour, linestyle=":", label=f"$F_x$, {side} wheel")
    both = sum(result["force_y"] for result in results.values())
    forces.plot(lateral, both / 1e3, color=BLACK, label="$F_y$, both")
    places.set(ylabel="contacts on the rail,\noutwards from its top [mm]")
    loads.set(ylabel="normal force of each contact [kN]", ylim=(0, None))
    pressures.set(ylabel="largest pressure of each contact [MPa]", ylim=(0, None))
    forces.set(ylabel="force on the wheelset [kN]")
    for axes in (pressures, forces):
        axes.set(xlabel="wheelset to the left by [mm]")
    places.legend(loc="lower left", fontsize=8)
    forces.legend(loc="lower left", fontsize=7)
    title = f"S1002 on 60E1, {LOAD / 1e3:.0f} kN on each wheel, {SPEED:.0f} m/s, without yaw"
    figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    save(figure, "wheelset_sweep.png")


def main():
    """Simulate both wheels, draw, report."""
    table = motion()
    results = {side: simulate(side, table) for side in SIDES}
    columns = {"lateral_displacement [m]": results["left"]["lateral_displacement"]}
    for side, result in results.items():
        columns |= {f"{side} {name}": result[name] for name in OUTPUTS}
        for name in OF_CONTACTS:
            columns |= {f"{side} contact.{name}[{n}]": result[f"contact.{name}[{n}]"] for n in CONTACTS}
    write_csv("wheelset_sweep.csv", columns)
    draw(results)
    for side, result in results.items():
        two = 1e3 * result.loc[result["contacts"] > 1.0, "lateral_displacement"]
        where = f"two contacts from {two.min():.2f} to {two.max():.2f} mm" if len(two) else "one contact throughout"
        steepest = np.degrees(max(result["contact.inclination[1]"]))
        highest = max(result[[f"contact.peak_pressure[{n}]" for n in CONTACTS]].max()) / 1e6
        print(f"  {side} wheel: {where}; up to {steepest:.0f}° steep and {highest:.0f} MPa")


if __name__ == "__main__":
    main()
