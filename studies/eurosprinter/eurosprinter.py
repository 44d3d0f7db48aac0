"""The measured creep curve of the locomotive Eurosprinter 127 001: fits of friction and of a layer between.

    .venv/bin/python studies eurosprinter        (or `make measurements`)

Writes results/eurosprinter.png and the tables of docs/measurements.md, prints all fits. presets/eurosprinter.toml holds
what the fit CHOSEN finds; python_tests/test_measurements.py compares.
"""

import matplotlib.pyplot as plt
import numpy as np
from fitting import fit, read_measured, steady_points
from helpers import BLACK, BLUE, GREEN, ORANGE, RED, markdown_table, save, write_tables
from scipy.integrate import quad

LOAD, SPEED = 106.7e3, 10.0  # N, m/s
# Standard deviation of a single point about its mean, and of reading one, as the table has them.
SCATTER, READING = 0.04, 0.003
# CONTACT's example for this locomotive: friction falls from 0.33 at 0 °C by 0.19 over 400 K. The ratio is kept.
COLD, HOT = 273.15, 673.15  # K
FALL = 0.19 / 0.33
# Layers are fitted in mm/GPa = 1e-12 m/Pa, slip shares as 1 and decays in s/m: numbers near 1.
LAYER = 1e-12
# A grid of 24 by 15 cells takes two fifths of the time of the default one and is within 0.0006 of it in traction over
# load, a twentieth of the least deviation of a measured point.
GRID = {"patch_nodes": 24, "patch_strips": 15}

SYMBOLS = {
    "friction_cold": "μ₀",
    "layer": "h/G₃ [mm/GPa]",
    "fall": "fall over 400 K",
    "friction_slip_share": "A",
    "friction_slip_decay": "B [s/m]",
}
START = {"friction_cold": 0.34, "layer": 0.16, "fall": 0.6, "friction_slip_share": 0.3, "friction_slip_decay": 0.3}
BOUNDS = {
    "friction_cold": (0.1, 0.8),
    "layer": (0.0, 10.0),
    "fall": (0.0, 0.99),
    "friction_slip_share": (0.0, 1.0),
    "friction_slip_decay": (0.01, 20.0),
}
HEAT, NO_HEAT = {"fall": FALL}, {"fall": 0.0}
SLIP = ("friction_slip_share", "friction_slip_decay")
# Name, what is free, what is held.
FITS = {
    "constant friction, layer": (("friction_cold", "layer"), NO_HEAT),
    "heat, no layer": (("friction_cold",), HEAT),
    "heat, layer": (("friction_cold", "layer"), HEAT),
    "heat with a fall of its own, layer": (("friction_cold", "layer", "fall"), {}),
    "slip, layer": (("friction_cold", "layer", *SLIP), NO_HEAT),
    "heat and slip, layer": (("friction_cold", "layer", *SLIP), HEAT),
}
CHOSEN, RIVAL = "heat, layer", "slip, layer"
DRAWN = {"heat, no layer": ORANGE, "constant friction, layer": GREEN, CHOSEN: RED, RIVAL: BLUE}


def curvature_ratio(axes_ratio):
    """Curvature across over that along the rail, of Hertz's ellipse with semi-axes a/b, along over across."""

    def moment(along, across):
        return quad(lambda t: (axes_ratio**2 + t * t) ** -along * (1.0 + t * t) ** -across, 0.0, np.inf)[0]

    return moment(0.5, 1.5) / moment(1.5, 0.5)


WHEEL_RADIUS = 0.625  # m: a curvature of 0.5/r₀ = 0.8 1/m
# 1/m, of rail and wheel together: half their sum stands beside 0.5/r₀.
TRANSVERSE = 2.0 * 0.8 * curvature_ratio(0.5)
VEHICLE = {
    "contact_model": 2,
    "wheel_radius": WHEEL_RADIUS,
    "rail_transverse_curvature": TRANSVERSE,
    "wheel_transverse_curvature": 0.0,
    "largest_load": LOAD,
    "normal_load": LOAD,
    # Both surfaces flash alike: half of the heat goes into each, and none from one to the other.
    "heat_partition": 0.5,
    "contact_thermal_resistance": 1e12,
}


def parameters(friction_cold, layer=0.0, fall=FALL, friction_slip_share=1.0, friction_slip_decay=0.0):
    """Start values of the component from what is fitted."""
    return VEHICLE | {
        "friction_law": 2 if fall else 1,
        "friction_cold": friction_cold,
        "friction_hot": friction_cold * (1.0 - fall),
        "friction_temperature_cold": COLD,
        "friction_temperature_hot": HOT,
        "friction_slip_share": friction_slip_share,
        "friction_slip_decay": friction_slip_decay,
        "layer_compliance": layer * LAYER,
    }


def traction(creepages, speed=SPEED, absolute=0.0, grid=GRID, **fitted):
    """Traction over load at creepages."""
    return steady_points(creepages, speed, ("traction_coefficient",), absolute, **parameters(**fitted), **grid)[0]


def measured():
    """Return creepages [1], traction over load, standard deviations of these means."""
    table = read_measured("eurosprinter.csv")
    deviation = np.hypot(SCATTER / np.sqrt(table["points"]), READING)
    return 0.01 * table["creepage"], table["traction_coefficient"], deviation


def fitted(name):
    """One of the fits."""
    free, held = FITS[name]
    creepages, values, deviation = measured()
    start, bounds = {key: START[key] for key in free}, {key: BOUNDS[key] for key in free}
    return fit(lambda **now: traction(creepages, **held, **now), values, deviation, start, bounds)


def everything(name, found):
    """What was free and what was held in a fit."""
    return FITS[name][1] | found.values


def profile_check(found):
    """How far χ² rises with a parameter of the fit CHOSEN held a standard deviation off, the rest fitted again."""
    creepages, values, deviation = measured()
    rises = []
    for name in found.values:
        for sign in (-1.0, 1.0):
            held = HEAT | {name: found.values[name] + sign * found.deviations[name]}
            rest = {key: value for key, value in found.values.items() if key != name}
            bounds = {key: BOUNDS[key] for key in rest}

            def curve(held=held, **now):
                return traction(creepages, **held, **now)

            rises.append(fit(curve, values, deviation, rest, bounds).chi_squared - found.chi_squared)
    return rises


# ---- beside CONTACT -------------------------------------------------------------------------------------------------


def beside_contact(hot=HOT):
    """CONTACT's table and ours at its points: traction and rise, constant and falling; `hot` stands for its 400 °C."""
    table = read_measured("contact_eurosprinter.csv")
    poisson, shear = 0.28, 8.2e10
    lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson)
    steel = {"lame_lambda": lame, "wheel_lame_lambda": lame, "density": 7850.0, "heat_capacity": 450.0}
    steel |= {"thermal_diffusivity": 50.0 / (7850.0 * 450.0), "thermal_expansion": 0.0, "wear_coefficient": 0.0}
    steel |= {"ambient_temperature": COLD, "incoming_temperature": COLD, "friction_temperature_hot": hot}
    ours = []
    for fall in (0.0, FALL):
        start_values = parameters(0.33, fall=fall) | steel
        names = ("traction_coefficient", "peak_temperature")
        force, peak = steady_points(0.01 * table["creepage"], SPEED, names, **start_values)
        ours += [force / 0.33, peak - COLD]
    return table, dict(zip(list(table)[1:], ours, strict=True))


def contact_table(table, ours, raised):
    """The comparison with CONTACT in Markdown; `raised` is ours with CONTACT's temperatures."""
    head = [
        "creepage",
        "rise, μ = 0.33: CONTACT",
        "ours",
        "F/(0.33 N), falling: CONTACT",
        "ours",
        "ours, temperatures as its",
    ]
    rows = [
        [
            f"{creepage:g} %",
            f"{table['rise constant'][i]:.1f} K",
            f"{ours['rise constant'][i]:.1f} K",
            f"{table['traction falling'][i]:.4f}",
            f"{ours['traction falling'][i]:.4f}",
            f"{raised['traction falling'][i]:.4f}",
        ]
        for i, creepage in enumerate(table["creepage"])
    ]
    return markdown_table(head, rows)


# ---- tables and picture ---------------------------------------------------------------------------------------------


def fits_table(fits):
    """All fits in Markdown."""
    rows = []
    for name, found in fits.items():
        cells = [
            f"{SYMBOLS[key]} = {value:.3f} ± {found.deviations[key]:.3f}"
            if found.deviations[key] < value
            else f"{SYMBOLS[key]} = {value:.2f}, not determined"
            for key, value in found.values.items()
        ]
        if slope(found):
            cells.append("(1 − A) B = {:.2f} ± {:.2f} s/m".format(*slope(found)))
        chi = f"{found.chi_squared:.1f}"
        rows.append([name, ", ".join(cells), chi, str(found.freedom), f"{found.chi_squared / found.freedom:.2f}"])
    return markdown_table(["fit", "fitted", "χ²", "degrees of freedom", "χ² per degree"], rows)


def residual_table(fits):
    """Residuals in standard deviations in Markdown."""
    creepages, values, deviation = measured()
    rows = [
        [f"{100 * creepage:g} %", f"{value:.3f} ± {sigma:.3f}"]
        + [f"{(found.residuals[i] * sigma):+.3f} ({found.residuals[i]:+.1f})" for found in fits.values()]
        for i, (creepage, value, sigma) in enumerate(zip(creepages, values, deviation, strict=True))
    ]
    return markdown_table(["creepage", "measured", *fits], rows)


def slope(found):
    """How fast friction falls with slip at rest, (1 - A) B [s/m], and its deviation."""
    if SLIP[0] not in found.values:
        return None
    share, decay = (found.values[key] for key in SLIP)
    by = np.array([-decay * found.deviations[SLIP[0]], (1.0 - share) * found.deviations[SLIP[1]]])
    where = [list(found.values).index(key) for key in SLIP]
    return (1.0 - share) * decay, float(np.sqrt(by @ found.correlation[np.ix_(where, where)] @ by))


def apart_table(fits):
    """What the two rivals say of other speeds, in Markdown."""
    creepages, speeds = (0.02, 0.05, 0.1), (5.0, 10.0, 20.0, 40.0)
    rows = []
    for speed in speeds:
        both = [traction(creepages, speed, **everything(name, fits[name])) for name in (CHOSEN, RIVAL)]
        cells = [f"{heat:.3f}, {slip:.3f}" for heat, slip in zip(*both, strict=True)]
        rows.append([f"{speed:g} m/s", *cells])
    return markdown_table(["speed", *(f"{100 * creepage:g} %" for creepage in creepages)], rows)


def draw(fits):
    """Measured points, curves of the fits, residuals beneath."""
    creepages, values, deviation = measured()
    along = np.geomspace(7e-4, 0.22, 36)
    figure, (above, below) = plt.subplots(
        2, 1, figsize=(7.0, 6.0), sharex=True, height_ratios=(2.6, 1.0), layout="constrained"
    )
    above.errorbar(100 * creepages, values, deviation, fmt="o", color=BLACK, markersize=4, capsize=2, zorder=5)
    labels = {
        "heat, no layer": "friction falls with temperature, no layer",
        "constant friction, layer": "constant friction, layer",
        CHOSEN: "friction falls with temperature, layer",
        RIVAL: "friction falls with slip velocity, layer",
    }
    handles = [
        plt.Line2D([], [], color=BLACK, marker="o", markersize=4, linestyle="none", label="measured, ± one deviation")
    ]
    shifts = dict(zip(DRAWN, (0.94, 0.98, 1.02, 1.06), strict=True))
    for name, colour in DRAWN.items():
        style = "--" if name == RIVAL else "-"
        # Where the contact sticks in part, a cell at its edge may go to and fro; not to be seen.
        curve = traction(along, absolute=1e-5, **everything(name, fits[name]))
        (line,) = above.plot(100 * along, curve, style, color=colour)
        line.set_label(f"{labels[name]}: χ² = {fits[name].chi_squared:.1f} on {fits[name].freedom} degrees")
        handles.append(line)
        if name != "heat, no layer":
            below.plot(100 * creepages * shifts[name], fits[name].residuals, "o", color=colour, markersize=4)
        else:
            below.plot(100 * creepages * shifts[name], fits[name].residuals, "x", color=colour, markersize=4.5)
    above.legend(handles=handles, loc="lower center", fontsize=8.5)
    above.set(ylim=(0.0, 0.38), ylabel="traction / load [1]")
    above.set_title("Eurosprinter 127 001 at 36 km/h, 106.7 kN a wheel")
    below.axhspan(-1.0, 1.0, color="#eeeeee", zorder=0)
    below.axhline(0.0, color=BLACK, linewidth=0.8)
    below.set(xscale="log", xlim=(0.08, 25.0), ylim=(-4.0, 4.0), xlabel="creepage [%]")
    below.set_ylabel("computed − measured\n[deviations]")
    below.set_xticks([0.1, 0.2, 0.5, 1, 2, 5, 10, 20], ["0.1", "0.2", "0.5", "1", "2", "5", "10", "20"])
    below.minorticks_off()
    save(figure, "eurosprinter.png")


def main():
    """Fit, compare, draw."""
    fits = {name: fitted(name) for name in FITS}
    for name, found in fits.items():
        print(f"  {name}: {found.evaluations} curves; correlation {np.round(found.correlation, 2).tolist()}")
    rises = profile_check(fits[CHOSEN])
    print(f"  profile of '{CHOSEN}': χ² rises by {', '.join(f'{rise:.2f}' for rise in rises)} a deviation off")
    for key, value in parameters(**everything(CHOSEN, fits[CHOSEN])).items():
        print(f"    {key} = {value:.6g}")
    table, ours = beside_contact()
    higher = float(np.mean(table["rise constant"][2:] / ours["rise constant"][2:]))
    print(f"  CONTACT's rise over ours in full sliding: {higher:.3f}")
    _, raised = beside_contact(COLD + (HOT - COLD) / higher)
    tables = {
        "fits of the Eurosprinter": fits_table(fits),
        "residuals of the Eurosprinter": residual_table({name: fits[name] for name in DRAWN}),
        "heat or slip at other speeds": apart_table(fits),
        "CONTACT's curve of the Eurosprinter": contact_table(table, ours, raised),
    }
    write_tables("measurements_eurosprinter.md", tables)
    draw(fits)


if __name__ == "__main__":
    main()
