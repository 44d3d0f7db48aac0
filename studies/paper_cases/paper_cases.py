"""The cases of Chudzikiewicz and Myśliński's paper, rolled through FMPy until they are steady.

    .venv/bin/python studies paper_cases        (after `make fmu`)

A rigid wheel of 0.46 m pressed 0.1 mm into the rail rolls at 10 m/s with a creepage of 4 %, at an ambient temperature
of 0 °C. The friction coefficient is constant, or falls from 0.45 at 50 °C to 0.25 at 150 °C (a), 125 °C (b) or 100 °C
(c).
The pictures are the paper's Figures 4 and 5, and what happens in the contact.
"""

import csv

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, FMU, ORANGE, RED, RESULTS, WHEEL_RADIUS, profile, save, write_csv
from wheelrail import simulate

SPEED, CREEPAGE, AMBIENT = 10.0, 0.04, 273.15

# Label, colour, friction law, temperature at which the friction has fallen to its hot value [°C].
CASES = {
    "constant": ("constant $\\mu$", BLACK, "constant", 150.0),
    "a": ("a: $\\theta_F$ = 150 °C", BLUE, "piecewise_linear", 150.0),
    "b": ("b: $\\theta_F$ = 125 °C", ORANGE, "piecewise_linear", 125.0),
    "c": ("c: $\\theta_F$ = 100 °C", RED, "piecewise_linear", 100.0),
}
OUTPUTS = ["traction_force", "traction_coefficient", "peak_temperature", "peak_pressure", "friction_coefficient"]
ACROSS = ["x", "pressure", "shear", "slip", "temperature", "wear_depth"]
STOP, STEP = 2.0, 0.01


def roll(case):
    """One case until it is steady."""
    _, _, law, hot = CASES[case]
    result = simulate(
        fmu=FMU,
        step=STEP,
        stop_time=STOP,
        outputs=[*OUTPUTS, *(f"profile.{quantity}" for quantity in ACROSS), "depth.z", "depth.temperature"],
        progress=f"case {case}",
        wheel="rigid",
        slip_regularisation=1e-3,
        control="penetration",
        prescribed_penetration=1e-4,
        friction_law=law,
        friction_temperature_cold=323.15,
        friction_temperature_hot=hot + 273.15,
        wheel_speed=SPEED * (1.0 + CREEPAGE) / WHEEL_RADIUS,
        creepage=CREEPAGE,
        ambient_temperature=AMBIENT,
        incoming_temperature=AMBIENT,
    )
    late = np.ptp(result["peak_temperature"][-20:])
    if late > 1e-6:
        raise RuntimeError(f"case {case} is not steady: the peak still moves by {late:g} K over the last 20 steps")
    return result


def celsius(kelvin):
    """From absolute temperature."""
    return kelvin - 273.15


def draw_temperature(results):
    """Draw the paper's Figures 4 and 5."""
    figure, (depth, along) = plt.subplots(1, 2, figsize=(9.6, 3.9), width_ratios=[1, 1.35], layout="constrained")
    for case, (label, colour, _, _) in CASES.items():
        result = results[case]
        z, below = profile(result, "depth.z"), celsius(profile(result, "depth.temperature"))
        depth.plot(1e3 * z, below, color=colour, label=label, marker=".", markersize=4)
        x, surface = profile(result, "profile.x"), celsius(profile(result, "profile.temperature"))
        along.plot(1e3 * x, surface, color=colour, label=label)
    depth.set(xlim=(0, 0.4), ylim=(0, None), xlabel="depth below the hottest point [mm]", ylabel="temperature [°C]")
    depth.set_title("Into the rail (the paper's Fig. 4)")
    depth.legend()
    along.set(xlabel="position along the rail, $x_1$ [mm]", ylabel="surface temperature [°C]", ylim=(0, None))
    along.set_title("Along the rail (the paper's Fig. 5)")
    along.annotate(
        "direction of travel", (0.97, 0.9), (0.66, 0.9), "axes fraction", va="center", arrowprops={"arrowstyle": "->"}
    )
    shade_contact(along, results["constant"])
    draw_wake(along.inset_axes([0.27, 0.13, 0.36, 0.33]), results)
    save(figure, "paper_temperature.png")


def draw_wake(axes, results):
    """How the surface cools behind the contact, each case relative to its own peak."""
    for case, (_, colour, _, _) in CASES.items():
        x, rise = profile(results[case], "profile.x"), profile(results[case], "profile.temperature") - AMBIENT
        behind = x < -3e-3
        axes.plot(1e3 * x[behind], rise[behind] / rise.max(), color=colour)
    axes.set_title("wake: rise over its peak", fontsize=8)
    axes.tick_params(labelsize=7)
    axes.set_xlim(1e3 * x.min(), -3.0)


def shade_contact(axes, result):
    """Grey where constant friction has contact pressure."""
    x, pressure = 1e3 * profile(result, "profile.x"), profile(result, "profile.pressure")
    axes.axvspan(x[pressure > 0].min(), x[pressure > 0].max(), color="#f0f0f0", zorder=0)
    axes.set_xlim(x.min(), x.max())


def draw_contact(results):
    """Pressure, shear traction and slip in the contact."""
    figure, panels = plt.subplots(3, 1, figsize=(7.2, 7.6), sharex=True, layout="constrained")
    for case, (label, colour, _, _) in CASES.items():
        result = results[case]
        x = 1e3 * profile(result, "profile.x")
        pressure = profile(result, "profile.pressure")
        # Slip is defined where there is pressure.
        slip = np.where(pressure > 0, profile(result, "profile.slip"), np.nan)
        panels[0].plot(x, pressure / 1e6, color=colour, label=label)
        panels[1].plot(x, -profile(result, "profile.shear") / 1e6, color=colour)
        panels[2].plot(x, slip, color=colour)
    panels[0].set_ylabel("contact pressure [MPa]")
    panels[1].set_ylabel("shear traction on the wheel [MPa]")
    panels[2].set_ylabel("slip velocity [m/s]")
    panels[2].set_xlabel("position along the rail, $x_1$ [mm]; travel to the right")
    panels[0].set_title(f"Contact at {SPEED:.0f} m/s, creepage {100 * CREEPAGE:.0f} %, penetration 0.1 mm")
    panels[0].legend(loc="upper left")
    panels[2].axhline(SPEED * CREEPAGE, color="#777777", linestyle="--", linewidth=1.0)
    panels[2].annotate("rigid slip $\\omega r_0 - V$", (-5.9, SPEED * CREEPAGE - 0.003), va="top", color="#777777")
    for axes in panels:
        shade_contact(axes, results["constant"])
    for axes in panels[:2]:
        axes.set_ylim(0, None)
    panels[2].set_ylim(0.35, 0.46)
    panels[1].annotate(
        "grey: contact at constant $\\mu$", (0.99, 0.93), xycoords="axes fraction", ha="right", color="#777777"
    )
    save(figure, "paper_contact.png")


def write_tables(results):
    """Write the profiles of all cases side by side."""
    first = results["constant"]
    across = {"x [m]": profile(first, "profile.x")}
    depth = {"z [m]": profile(first, "depth.z")}
    units = {"pressure": "Pa", "shear": "Pa", "slip": "m/s", "temperature": "K", "wear_depth": "m"}
    for case, result in results.items():
        for quantity, unit in units.items():
            across[f"{quantity} {case} [{unit}]"] = profile(result, f"profile.{quantity}")
        depth[f"temperature {case} [K]"] = profile(result, "depth.temperature")
    write_csv("paper_along.csv", across)
    write_csv("paper_depth.csv", depth)


def write_summary(results):
    """One row of figures per case."""
    constant = results["constant"]["peak_temperature"].iloc[-1]
    RESULTS.mkdir(exist_ok=True)
    path = RESULTS / "paper_cases.csv"
    with path.open("w", newline="") as file:
        writer = csv.writer(file)
        units = dict(zip(OUTPUTS, ["N", "1", "K", "Pa", "1"], strict=True))
        writer.writerow(["case", "lower [K]", *(f"{name} [{unit}]" for name, unit in units.items())])
        for case, result in results.items():
            last = result.iloc[-1]
            lower = constant - last["peak_temperature"]
            writer.writerow([case, *(repr(float(value)) for value in (lower, *(last[name] for name in OUTPUTS)))])
    print(f"  wrote results/{path.name}")


def main():
    """Simulate, draw, write, report."""
    results = {case: roll(case) for case in CASES}
    draw_temperature(results)
    draw_contact(results)
    write_tables(results)
    write_summary(results)
    peaks = {case: celsius(result["peak_temperature"].iloc[-1]) for case, result in results.items()}
    print("  case       peak temperature   lower than constant   mean friction   peak pressure   traction")
    for case, result in results.items():
        last = result.iloc[-1]
        print(
            f"  {case:9s} {peaks[case]:13.2f} °C {peaks['constant'] - peaks[case]:17.2f} K"
            f" {last['friction_coefficient']:17.4f} {last['peak_pressure'] / 1e6:11.1f} MPa"
            f" {last['traction_force'] / 1e3:7.2f} kN"
        )


if __name__ == "__main__":
    main()
