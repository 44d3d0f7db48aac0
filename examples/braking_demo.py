"""A braking manoeuvre with a wheel slide, through FMPy.

    .venv/bin/python examples/braking_demo.py       (after `make fmu`)

Wheel speed, vehicle speed and load come from examples/braking.csv; examples/braking.py says how they were made.
"""

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, REPOSITORY, WHEEL_RADIUS, read_scenario, save, simulate, write_csv

SCENARIO = REPOSITORY / "examples" / "braking.csv"
STEP = 1e-3  # s
VEHICLE_SPEED = 2  # slip_source: wheel speed and vehicle speed define the motion
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


def sliding(signals, result):
    """First and last time at which the wheel turns at less than 98 % of the rolling speed."""
    slow = result["time"][result["slip_creepage"] < -0.02]
    return slow.min(), slow.max()


def draw(signals, result):
    """Draw the manoeuvre, and what it does to the contact."""
    figure, panels = plt.subplots(6, 1, figsize=(8.4, 11.0), sharex=True, layout="constrained")
    time = result["time"]
    speeds, traction, creepage, temperature, friction, wear = panels

    speeds.plot(signals["time"], signals["vehicle_speed"], color=BLACK, label="vehicle")
    speeds.plot(signals["time"], WHEEL_RADIUS * signals["wheel_speed"], color=BLUE, label="wheel circumference")
    speeds.set_ylabel("speed [m/s]")
    speeds.legend(loc="upper right", ncols=2)

    traction.plot(time, result["traction_force"] / 1e3, color=BLACK, linewidth=1.0)
    traction.set_ylabel("traction force [kN]")
    creepage.plot(time, -100 * result["slip_creepage"], color=GREEN)
    creepage.set(yscale="log", ylabel="creepage, negative [%]", ylim=(0.01, 150))
    temperature.plot(time, result["peak_temperature"] - 273.15, color=RED)
    temperature.set(ylabel="peak temperature [°C]", ylim=(0, None))
    friction.plot(time, result["friction_coefficient"], color=BLUE, label="friction coefficient")
    friction.plot(time, -result["traction_coefficient"], color=ORANGE, linewidth=1.0, label="braking force / load")
    friction.set(ylabel="coefficient [1]", ylim=(0, 0.5))
    friction.legend(loc="center right")
    wear.plot(time, result["worn_volume"] * 1e9, color=BLACK)
    wear.set(ylabel="worn volume [mm³]", xlabel="time [s]", xlim=(time[0], time[-1]), ylim=(0, None))

    start, end = sliding(signals, result)
    for axes in panels:
        axes.axvspan(start, end, color="#f0f0f0", zorder=0)
    speeds.annotate("wheel slide", (0.5 * (start + end), 18), ha="center", color="#666666")
    figure.align_ylabels(panels)
    speeds.set_title("Braking from 20 m/s with a wheel slide")
    save(figure, "braking.png")


def main():
    """Simulate, draw, write, report."""
    signals = read_scenario(SCENARIO)
    result = simulate("braking", STEP, signals["time"][-1], list(OUTPUTS), {"slip_source": VEHICLE_SPEED}, signals)
    inputs = {
        f"{name} [{unit}]": np.interp(result["time"], signals["time"], signals[name])
        for name, unit in {"wheel_speed": "rad/s", "vehicle_speed": "m/s", "normal_load": "N"}.items()
    }
    write_csv(
        "braking.csv",
        {"time [s]": result["time"]} | inputs | {f"{name} [{unit}]": result[name] for name, unit in OUTPUTS.items()},
    )
    draw(signals, result)
    hottest = np.argmax(result["peak_temperature"])
    start, end = sliding(signals, result)
    before = np.searchsorted(result["time"], start)
    after = np.searchsorted(result["time"], end)
    worn = result["worn_volume"]
    print(f"  {result['distance'][-1]:.1f} m in {result['time'][-1]:.0f} s, {len(result)} rows")
    print(f"  hottest: {result['peak_temperature'][hottest] - 273.15:.1f} °C at {result['time'][hottest]:.2f} s")
    friction = result["friction_coefficient"]
    print(f"  friction coefficient: {friction.min():.3f} to {friction.max():.3f}")
    print(f"  friction energy: {result['friction_energy'][-1] / 1e3:.1f} kJ")
    print(f"  worn: {worn[-1] * 1e9:.2f} mm³, {100 * (worn[after] - worn[before]) / worn[-1]:.0f} % of it in the slide")


if __name__ == "__main__":
    main()
