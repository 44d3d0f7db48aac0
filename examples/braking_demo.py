"""A braking manoeuvre with a wheel slide, to a stop on a gradient, through FMPy.

    .venv/bin/python examples/braking_demo.py       (after `make fmu`)

Up to `COUPLED` wheel speed, vehicle speed and load come from examples/braking.csv; examples/braking.py says how they
were made. From there on they are those of a wheel with its share of a vehicle, coupled to the same instance by the
iterating master of examples/stiff.py: the brake goes on with the torque that it has, the vehicle stops, and the locked
wheel holds it on the gradient.
"""

from types import SimpleNamespace

import numpy as np
from helpers import BLACK, FMU, REPOSITORY, RESULTS, WHEEL_RADIUS, save, write_csv
from stiff import LOAD, NAMES, SPEEDS, WHEEL_INERTIA, Contact, iterating
from wheelrail import read_table, simulate, variables
from wheelrail.plots import braking

TITLE = "Braking from 20 m/s with a wheel slide, to a stop on a gradient"
SCENARIO = REPOSITORY / "examples" / "braking.csv"
INPUTS_OF_ALL = RESULTS / "braking_inputs.csv"
STEP = 1e-3  # s
COUPLED = 21.0  # s, at 2 m/s; after it the table lets the brake go
COUPLED_STEP = 2e-3  # s
END = 28.0  # s
GRADIENT = 0.005  # uphill
DECELERATION = 0.9  # m/s2, of the table
# Output and unit.
OUTPUTS = {
    "traction_force": "N",
    "slip_creepage": "1",
    "peak_temperature": "K",
    "friction_coefficient": "1",
    "traction_coefficient": "1",
    "friction_power": "W",
    "wear_rate": "m3/s",
    "worn_volume": "m3",
    "friction_energy": "J",
    "distance": "m",
}
INPUTS = {"wheel_speed": "rad/s", "vehicle_speed": "m/s", "normal_load": "N"}


def driven(contact, signals):
    """Follow the table up to where the vehicle takes over: a column for each input and output."""
    result = simulate(signals, step=STEP, stop_time=COUPLED, outputs=OUTPUTS, instance=contact, progress="braking")
    return {name: result[name].to_numpy() for name in ("time", *INPUTS, *OUTPUTS)}


def coupled(contact, before):
    """Go on with wheel and vehicle as they are at the end, under the brake that slowed them down, to the end."""
    torque, _ = contact.get(*NAMES)
    brake = torque + WHEEL_INERTIA * DECELERATION / WHEEL_RADIUS
    manoeuvre = SimpleNamespace(gradient=GRADIENT, drive=lambda now: 0.0, brake=lambda now: brake)
    speeds, forces, memory = np.array([before[name][-1] for name in SPEEDS]), None, {}
    load = before["normal_load"][-1]
    contact.set(normal_load=load)
    rows = []
    for number in range(1, round((END - COUPLED) / COUPLED_STEP) + 1):
        now = COUPLED + number * COUPLED_STEP
        speeds, forces, _ = iterating(contact, speeds, forces, manoeuvre, now, COUPLED_STEP, memory)
        rows.append((now, *speeds, load, *contact.get(*OUTPUTS)))
    return dict(zip(("time", *INPUTS, *OUTPUTS), np.array(rows).T, strict=True))


def sliding(result):
    """First and last time at which the wheel turns at less than 98 % of the rolling speed, before the vehicle stops."""
    slow = result["time"][(result["slip_creepage"] < -0.02) & (result["time"] < COUPLED)]
    return slow.min(), slow.max()


def standing(result):
    """When the vehicle first stands."""
    return result["time"][np.argmax(result["vehicle_speed"] <= 0.0)]


def place(result):
    """Place of the vehicle from where it is at the end [m], in the coupled part."""
    after = result["time"] > COUPLED
    way = np.cumsum(result["vehicle_speed"][after]) * COUPLED_STEP
    return result["time"][after], way - way[-1]


def draw(result):
    """Draw the manoeuvre, and what it does to the contact."""
    figure = braking(result, wheel_radius=WHEEL_RADIUS, title=TITLE)
    panels = figure.axes
    speeds, traction, time, stood = *panels[:2], result["time"], standing(result)

    # The swing of the vehicle on the contact's spring, some tenths of a second.
    near = traction.inset_axes([0.815, 0.14, 0.17, 0.42])
    near.plot(result["time"], result["traction_force"] / 1e3, color=BLACK, linewidth=0.8)
    swing = result["traction_force"][(time > stood) & (time < stood + 0.4)] / 1e3
    near.set(xlim=(stood - 0.1, stood + 0.4), ylim=(-7.0, 1.1 * swing.max() + 1.0))
    near.tick_params(labelsize=7)
    near.set_title("standstill", fontsize=8)

    start, end = sliding(result)
    for axes in panels:
        axes.axvspan(start, end, color="#f0f0f0", zorder=0)
        axes.axvspan(stood, END, color="#eef5ee", zorder=0)
    speeds.annotate("wheel slide", (0.5 * (start + end), 18), ha="center", color="#666666")
    speeds.annotate(f"held on {GRADIENT:.1%}", (0.5 * (stood + END), 5), ha="center", color="#557755")
    save(figure, "braking.png")


def write_inputs(signals):
    """Write the table with a column for every input of the component: there are hosts that ask for it."""
    table = variables(FMU)
    others = table[(table["kind"] == "input") & ~table.index.isin(signals.columns)]
    signals.assign(**others["start"]).to_csv(INPUTS_OF_ALL, index=False)
    print(f"  wrote {INPUTS_OF_ALL.relative_to(REPOSITORY)}")


def main():
    """Simulate, draw, write, report."""
    signals = read_table(SCENARIO)
    contact = Contact(signals["vehicle_speed"][0], signals["normal_load"][0])
    first = driven(contact, signals)
    then = coupled(contact, first)
    contact.close()
    result = {name: np.concatenate([first[name], then[name]]) for name in first}
    units = {"time": "s"} | INPUTS | OUTPUTS
    write_csv("braking.csv", {f"{name} [{unit}]": result[name] for name, unit in units.items()})
    draw(result)
    write_inputs(signals)
    hottest = np.argmax(result["peak_temperature"])
    start, end = sliding(result)
    before = np.searchsorted(result["time"], start)
    after = np.searchsorted(result["time"], end)
    worn = result["worn_volume"]
    print(f"  {result['distance'][-1]:.1f} m in {result['time'][-1]:.0f} s, {len(result['time'])} rows")
    print(f"  hottest: {result['peak_temperature'][hottest] - 273.15:.1f} °C at {result['time'][hottest]:.2f} s")
    friction = result["friction_coefficient"]
    print(f"  friction coefficient: {friction.min():.3f} to {friction.max():.3f}")
    print(f"  friction energy: {result['friction_energy'][-1] / 1e3:.1f} kJ")
    print(f"  worn: {worn[-1] * 1e9:.2f} mm³, {100 * (worn[after] - worn[before]) / worn[-1]:.0f} % of it in the slide")
    stood, (time, way) = standing(result), place(result)
    held, traction = time > stood + 1.0, then["traction_force"]
    print(
        f"  stands at {stood:.2f} s, swings {1e6 * np.ptp(way[time >= stood]):.1f} µm on the contact's spring;"
        f" a second later it moves {1e9 * np.ptp(way[held]):.2g} nm in {END - stood - 1.0:.1f} s,"
        f" held by {traction[held].min():.2f} to {traction[held].max():.2f} N, the gradient's {GRADIENT * LOAD:.0f} N"
    )


if __name__ == "__main__":
    main()
