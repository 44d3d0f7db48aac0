"""A braking manoeuvre with a wheel slide through FMPy, and another end to it: a stop on a gradient.

    .venv/bin/python studies braking_demo       (after `make fmu`)

The manoeuvre is a table: wheel speed, vehicle speed and load come from examples/braking.csv; tools/braking_table.py
says how they were made. results/braking.png is the picture of README, and of the lines of Python beside it there.

For the stop they come from the table up to `COUPLED` only. From there on they are those of a wheel with its share of a
vehicle, coupled to the same instance by the iterating master of studies/stiff: the brake goes on with the torque
that it has, the vehicle stops, and the locked wheel holds it on the gradient.
"""

from types import SimpleNamespace

import numpy as np
from helpers import BLACK, BLUE, FMU, REPOSITORY, RESULTS, WHEEL_RADIUS, plt, save, write_csv
from stiff import LOAD, NAMES, SPEEDS, WHEEL_INERTIA, Contact, iterating
from wheelrail import read_table, simulate, variables
from wheelrail.plots import braking

TITLE = "Braking from 20 m/s with a wheel slide"
SCENARIO = REPOSITORY / "examples" / "braking.csv"
INPUTS_OF_ALL = RESULTS / "braking_inputs.csv"
STEP = 1e-3  # s
COUPLED = 21.0  # s, at 2 m/s; after it the table lets the brake go
COUPLED_STEP = 2e-3  # s
END = 28.0  # s
SHOWN = 20.0  # s, from here on the stop is drawn
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


def driven(contact, signals, stop_time=None):
    """Follow the table from where the contact is, to its end if nothing else is said: a column for each output too."""
    result = simulate(signals, step=STEP, stop_time=stop_time, outputs=OUTPUTS, instance=contact, progress="braking")
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


def joined(first, then):
    """Two parts of a run as one; the second may begin with the row that the first ends with."""
    new = then["time"] > first["time"][-1]
    return {name: np.concatenate([first[name], then[name][new]]) for name in first}


def draw_stop(result):
    """Draw speeds and traction of the stop, on the right the swing of the vehicle on the contact's spring."""
    figure, panels = plt.subplots(2, 2, figsize=(7.8, 4.6), sharex="col", layout="constrained")
    time, stood = result["time"], standing(result)
    for (speeds, traction), limits, scale in zip(
        panels.T, ((SHOWN, END), (stood - 0.1, stood + 0.4)), (1.0, 1e3), strict=True
    ):
        shown = (time >= limits[0]) & (time <= limits[1])
        vehicle, wheel = (scale * result[name][shown] for name in ("vehicle_speed", "wheel_speed"))
        speeds.plot(time[shown], vehicle, color=BLACK, linewidth=2.6, alpha=0.4, label="vehicle")
        speeds.plot(time[shown], WHEEL_RADIUS * wheel, color=BLUE, linewidth=1.0, label="wheel circumference")
        traction.plot(time[shown], result["traction_force"][shown] / 1e3, color=BLACK, linewidth=1.0)
        traction.set(xlabel="time [s]", xlim=limits)
        for axes in (speeds, traction):
            axes.axvspan(stood, limits[1], color="#eef5ee", zorder=0)
    (speeds, near), (traction, _) = panels
    speeds.set(ylabel="speed [m/s]", title="To a stop on a gradient")
    near.set(ylabel="speed [mm/s]", title="The vehicle swings on the contact's spring", ylim=(-12, 30))
    speeds.legend(loc="upper right")
    speeds.annotate(f"held on {GRADIENT:.1%}", (0.5 * (stood + END), 0.5), ha="center", color="#557755")
    traction.set_ylabel("traction force [kN]")
    save(figure, "braking_stop.png")


def write_inputs(signals):
    """Write the table with a column for every input of the component: there are hosts that ask for it."""
    table = variables(FMU)
    others = table[(table["kind"] == "input") & ~table.index.isin(signals.columns)]
    signals.assign(**others["start"]).to_csv(INPUTS_OF_ALL, index=False)
    print(f"  wrote {INPUTS_OF_ALL.relative_to(REPOSITORY)}")


def write(name, result):
    """Write a result with units in its headings."""
    units = {"time": "s"} | INPUTS | OUTPUTS
    write_csv(name, {f"{column} [{unit}]": result[column] for column, unit in units.items()})


def report(result):
    """Print what the manoeuvre did to the contact."""
    hottest = np.argmax(result["peak_temperature"])
    before, after = np.searchsorted(result["time"], sliding(result))
    worn, friction = result["worn_volume"], result["friction_coefficient"]
    print(f"  {result['distance'][-1]:.1f} m in {result['time'][-1]:.0f} s, {len(result['time'])} rows")
    print(f"  hottest: {result['peak_temperature'][hottest] - 273.15:.1f} °C at {result['time'][hottest]:.2f} s")
    print(f"  friction coefficient: {friction.min():.3f} to {friction.max():.3f}")
    print(f"  friction energy: {result['friction_energy'][-1] / 1e3:.1f} kJ")
    print(f"  worn: {worn[-1] * 1e9:.2f} mm³, {100 * (worn[after] - worn[before]) / worn[-1]:.0f} % of it in the slide")


def report_stop(result):
    """Print how well the vehicle is held."""
    stood, (time, way) = standing(result), place(result)
    held, traction = time > stood + 1.0, result["traction_force"][result["time"] > stood + 1.0]
    print(
        f"  stands at {stood:.2f} s, swings {1e6 * np.ptp(way[time >= stood]):.1f} µm on the contact's spring;"
        f" a second later it moves {1e9 * np.ptp(way[held]):.2g} nm in {END - stood - 1.0:.1f} s,"
        f" held by {traction.min():.2f} to {traction.max():.2f} N, the gradient's {GRADIENT * LOAD:.0f} N"
    )


def main():
    """Simulate, draw, write, report."""
    signals = read_table(SCENARIO)
    contact = Contact(signals["vehicle_speed"][0], signals["normal_load"][0])
    first = driven(contact, signals, COUPLED)
    there = contact.save()
    result = joined(first, driven(contact, signals))
    contact.restore(there)
    stop = joined(first, coupled(contact, first))
    contact.close()
    write("braking.csv", result)
    save(braking(result, wheel_radius=WHEEL_RADIUS, title=TITLE), "braking.png")
    write("braking_stop.csv", stop)
    draw_stop(stop)
    write_inputs(signals)
    report(result)
    report_stop(stop)


if __name__ == "__main__":
    main()
