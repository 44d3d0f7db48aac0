"""A twin disc test: friction, flash and bulk temperature over slip, and the wear of its steel.

    .venv/bin/python studies twin_disc        (or `make measurements`)

Writes results/twin_disc.png, results/wear_branches.png and their tables of docs/measurements.md.

The component's wheel rolls on a flat and its radius is at least 50 mm; two discs of 23.5 mm have the contact of one of
half that radius on a flat. What is computed is that contact enlarged: all lengths along and into the rail times SCALE,
the width divided by it. Load, pressure, speed and friction power are those of the discs. With the diffusivity times
SCALE and the same heat capacity so are Péclet's number and all temperatures; a layer's compliance grows by SCALE too.
"""

import matplotlib.pyplot as plt
import numpy as np
from fitting import fit, read_measured
from helpers import BLACK, BLUE, FMU, ORANGE, RED, Instance, markdown_table, save, write_tables

# The discs: 47 mm diameter, 10 mm wide, 7.3 kN, 400 rpm.
DISC_RADIUS, DISC_WIDTH, LOAD = 0.0235, 0.010, 7.3e3  # m, m, N
SPEED = 2.0 * np.pi * 400.0 / 60.0 * DISC_RADIUS  # m/s
AMBIENT = 293.15  # K
RADIUS = 0.05  # m, the least that the component takes
SCALE = RADIUS / (0.5 * DISC_RADIUS)
# Steel as the authors of the temperatures took it: 8000 kg/m³, 500 J/(kg K), and the diffusivity of their Péclet number
# of 10.3 = U a/(2 χ) at a half-length a of 0.315 mm.
DENSITY, CAPACITY = 8000.0, 500.0
DIFFUSIVITY = SPEED * 0.315e-3 / (2.0 * 10.3)  # m²/s
LAYER = 1e-12  # m/Pa: layers are fitted in mm/GPa
# Equal weights: no scatter is given. The number only scales χ², and deviations are those of the misfit itself.
UNIT = 0.01
DISCS = {
    "wheel_radius": RADIUS,
    "contact_width": DISC_WIDTH / SCALE,
    "largest_load": LOAD,
    "normal_load": LOAD,
    "density": DENSITY,
    "wheel_density": DENSITY,
    "heat_capacity": CAPACITY,
    "wheel_heat_capacity": CAPACITY,
    "thermal_diffusivity": DIFFUSIVITY * SCALE,
    # Both discs flash alike: half of the heat into each, and none from one to the other.
    "heat_partition": 0.5,
    "contact_thermal_resistance": 1e12,
    # The rim as the whole disc: same volume, so that its time constant is right too.
    "wheel_heating": 2,
    "rim_depth": RADIUS,
    "rim_width": DISC_RADIUS**2 * DISC_WIDTH / RADIUS**2,
    # What comes in has the disc's bulk temperature as deep as heat goes in the contact, and a short way to it: on the
    # default's two metres it would lose some kelvin into the depth.
    "skin_depth": 0.1,
    "strip_half_length": 0.1,
    "wear_coefficient": 0.0,
}
CONSTANT, DEFAULT, FLOW = "constant", "component's default", "flow stress"
LAWS = {
    CONSTANT: {"friction_law": 1},
    DEFAULT: {"friction_law": 2, "friction_temperature_cold": 323.15, "friction_temperature_hot": 423.15},
    FLOW: {"friction_law": 3},
}
# Of the default law: 0.25 of 0.45.
HOT_SHARE = 0.25 / 0.45
FITS = {
    "constant, no layer": (CONSTANT, ("friction_cold",)),
    "constant, layer": (CONSTANT, ("friction_cold", "layer")),
    "flow stress, layer": (FLOW, ("friction_cold", "layer")),
    "default law, layer": (DEFAULT, ("friction_cold", "layer")),
}
CHOSEN = "flow stress, layer"


def measured():
    """The published table, and the friction coefficient that its heat has."""
    table = read_measured("twin_disc.csv")
    slip = 0.01 * table["slip"]
    return table | {"slip": slip, "friction": table["heat"] / (LOAD * slip * SPEED)}


def heat_transfer():
    """Loss of a disc per kelvin [W/K] after the published bulk temperatures of the long tests."""
    table = measured()
    long = table["slip"] < 0.12
    rise = (table["bulk temperature"] - (AMBIENT - 273.15))[long]
    half = 0.5 * table["heat"][long]
    return (half @ half) / (half @ rise)


def parameters(law, friction_cold, layer=0.0, **others):
    """Start values of the component."""
    depth, width = DISCS["rim_depth"], DISCS["rim_width"]
    surface = 2.0 * np.pi * RADIUS * width + 2.0 * np.pi * depth * (2.0 * RADIUS - depth)
    hot = {"friction_hot": friction_cold * HOT_SHARE} if law == DEFAULT else {"friction_hot": 0.0}
    return (
        DISCS
        | LAWS[law]
        | hot
        | {
            "friction_cold": friction_cold,
            "layer_compliance": layer * LAYER * SCALE,
            "wheel_heat_transfer": heat_transfer() / surface,
        }
        | others
    )


# The rail's surface ahead of the contact: what enters is a profile in depth, at the surface a per cent less hot than
# `incoming_temperature`.
AHEAD = "profile.temperature[61]"
OUTPUTS = ("traction_coefficient", "friction_power", "contact_length", "wear_rate", "peak_pressure")


def points(slips, law, **fitted):
    """Steady state of the discs at slips [1]: a dict of arrays, temperatures in K.

    After each step the disc that is the rail enters as hot as the other, the wheel, has become: they are alike.
    """
    rows = {name: [] for name in (*OUTPUTS, "bulk", "flash")}
    instance = Instance(FMU, **parameters(law, **fitted)).start()
    try:
        for slip in slips:
            instance.set(creepage=float(slip), wheel_speed=SPEED * (1.0 + slip) / RADIUS)
            bulk = settle(instance)
            *now, peak, ahead = instance.get(*OUTPUTS, "peak_temperature", AHEAD)
            for name, value in zip(rows, (*now, bulk, peak - ahead), strict=True):
                rows[name].append(value)
    finally:
        instance.close()
    return {name: np.array(values) for name, values in rows.items()}


def settle(instance, step=20.0, close=1e-3, most=200):
    """Step, with the time constant of a disc being half a minute, until both discs rest within a millikelvin."""
    before = np.inf
    for _ in range(most):
        instance.step(step)
        (bulk,) = instance.get("wheel_temperature")
        instance.set(incoming_temperature=bulk)
        if abs(bulk - before) < close:
            return bulk
        before = bulk
    raise RuntimeError(f"the discs do not come to rest within {most * step:g} s")


def fitted(name):
    """One of the fits to the friction coefficients."""
    law, free = FITS[name]
    table = measured()
    start = {key: {"friction_cold": 0.47, "layer": 0.005}[key] for key in free}
    bounds = {key: {"friction_cold": (0.1, 1.0), "layer": (0.0, 1.0)}[key] for key in free}

    def curve(**now):
        return points(table["slip"], law, **now)["traction_coefficient"]

    return fit(curve, table["friction"], np.full(len(table["slip"]), UNIT), start, bounds)


def misfit(found):
    """Root mean square of the residuals, of the degrees of freedom."""
    return UNIT * np.sqrt(found.chi_squared / found.freedom)


# ---- wear -----------------------------------------------------------------------------------------------------------


def branches():
    """The published branches: name, from, to [N/mm²], slope [µg/(m N)], offset [µg/(m mm²)]."""
    table = read_measured("usfd.csv")
    return list(zip(*table.values(), strict=True))


def usfd(loads):
    """Published wear rate [µg/(m mm²)] at Tγ/A [N/mm²]."""
    loads = np.asarray(loads, dtype=float)
    rates = np.full(loads.shape, np.nan)
    for _, begin, end, slope, offset in branches():
        within = (loads >= begin) & (loads < end)
        rates[within] = (slope * loads + offset)[within]
    return rates


def mild_coefficient(friction):
    """Archard's coefficient [1/Pa] that has the mild branch: all of the area slides, with this friction coefficient.

    Archard: mass per distance and area ρ k p γ. Tγ/A = μ p γ. 1 µg/(m N) = 1e-9 kg/(m N).
    """
    slope = branches()[0][3]
    return slope * 1e-9 * friction / DENSITY


def wear(slips, coefficient, **values):
    """Tγ/A [N/mm²] and wear rate [µg/(m mm²)] after the component's outputs."""
    now = points(slips, FITS[CHOSEN][0], wear_coefficient=coefficient, **values)
    area = now["contact_length"] * DISCS["contact_width"]
    loads = 1e-6 * now["friction_power"] / SPEED / area
    # kg/(m m²) is 1e9 µg over 1e6 mm².
    return loads, 1e3 * DENSITY * now["wear_rate"] / SPEED / area


# ---- tables and pictures --------------------------------------------------------------------------------------------


def fits_table(fits):
    """All fits in Markdown."""
    rows = []
    for name, found in fits.items():
        worse = misfit(found) / UNIT
        cells = [f"μ₀ = {found.values['friction_cold']:.3f} ± {found.deviations['friction_cold'] * worse:.3f}"]
        if "layer" in found.values:
            layer, deviation = (1e3 * of["layer"] for of in (found.values, found.deviations))
            cells.append(f"h/G₃ = {layer:.2f} ± {deviation * worse:.2f} µm/GPa")
        rows.append([name, ", ".join(cells), f"{misfit(found):.3f}", f"{UNIT * abs(found.residuals).max():.3f}"])
    return markdown_table(["friction law", "fitted", "rms misfit", "largest"], rows)


def slips_table(found, default):
    """Friction and temperatures by slip in Markdown: published, the fit CHOSEN, the default law."""
    table = measured()
    ours = points(table["slip"], FITS[CHOSEN][0], **found.values)
    other = points(table["slip"], DEFAULT, **default.values)
    head = ["slip", "μ: from heat", "ours", "default law", "flash [K]: published", "ours", "ours at the same heat"]
    head += ["bulk [°C]: published", "ours", "ours at the same heat"]
    rows = []
    for i, slip in enumerate(table["slip"]):
        share = table["heat"][i] / ours["friction_power"][i]
        bulk = ours["bulk"][i] - AMBIENT
        rows.append(
            [
                f"{100 * slip:g} %",
                f"{table['friction'][i]:.3f}",
                f"{ours['traction_coefficient'][i]:.3f}",
                f"{other['traction_coefficient'][i]:.3f}",
                f"{table['peak flash temperature'][i]:g}",
                f"{ours['flash'][i]:.1f}",
                f"{ours['flash'][i] * share:.1f}",
                f"{table['bulk temperature'][i]:.1f}",
                f"{ours['bulk'][i] - 273.15:.1f}",
                f"{AMBIENT - 273.15 + bulk * share:.1f}",
            ]
        )
    return markdown_table(head, rows)


def wear_table(found):
    """Wear by slip in Markdown: published branches, and Archard's law with two coefficients."""
    mild = mild_coefficient(found.values["friction_cold"])
    slips = measured()["slip"]
    loads, low = wear(slips, mild, **found.values)
    _, usual = wear(slips, 5e-13, **found.values)
    head = ["slip", "Tγ/A [N/mm²]", "USFD [µg/(m mm²)]", f"k = {mild * 1e13:.2f}·10⁻¹³/Pa", "k = 5·10⁻¹³/Pa, default"]
    rows = [
        [f"{100 * slip:g} %", f"{load:.2f}", f"{rate:.1f}", f"{a:.1f}", f"{b:.1f}"]
        for slip, load, rate, a, b in zip(slips, loads, usfd(loads), low, usual, strict=True)
    ]
    return markdown_table(head, rows)


def draw(found, default):
    """Friction, flash and bulk temperature over slip."""
    table = measured()
    along = np.geomspace(0.0015, 0.25, 40)
    curves = {
        "ours, flow-stress law and layer fitted": (points(along, FITS[CHOSEN][0], **found.values), BLUE, "-"),
        "ours, default law and layer fitted": (points(along, DEFAULT, **default.values), RED, "--"),
    }
    figure, panels = plt.subplots(1, 3, figsize=(11.0, 3.9), layout="constrained")
    columns = (("traction_coefficient", 0.0), ("flash", 0.0), ("bulk", -273.15))
    for axes, (column, shift) in zip(panels, columns, strict=True):
        for label, (curve, colour, style) in curves.items():
            axes.plot(100 * along, curve[column] + shift, style, color=colour, label=label)
    open_dots = {"linestyle": "none", "marker": "o", "markersize": 5, "color": BLACK, "markerfacecolor": "white"}
    slips = 100 * table["slip"]
    panels[0].plot(slips, table["friction"], **open_dots | {"markerfacecolor": BLACK}, label="from the measured heat")
    panels[1].plot(slips, table["peak flash temperature"], **open_dots, label="published, computed")
    panels[2].plot(slips, table["bulk temperature"], **open_dots, label="published, computed")
    for axes, label in zip(
        panels, ("traction / load [1]", "peak flash temperature [K]", "bulk temperature of the discs [°C]"), strict=True
    ):
        axes.set(xscale="log", xlabel="slip [%]", ylabel=label)
        axes.set_ylim(bottom=0.0)
        axes.set_xticks([0.2, 0.5, 1, 2, 5, 10, 20], ["0.2", "0.5", "1", "2", "5", "10", "20"])
        axes.minorticks_off()
    panels[0].legend(loc="lower right", fontsize=8)
    panels[1].legend(loc="upper left", fontsize=8)
    panels[1].set_yscale("log")
    panels[1].set_ylim(0.1, 200.0)
    figure.suptitle("Twin disc, R8T on 900A, dry, 1500 MPa, 400 rpm", x=0.01, ha="left", fontsize=10)
    save(figure, "twin_disc.png")


def draw_wear(found):
    """Wear rate over Tγ/A: published branches, and the component's with two coefficients."""
    figure, axes = plt.subplots(figsize=(7.0, 4.6), layout="constrained")
    for number, (name, begin, end, slope, offset) in enumerate(branches()):
        loads = np.geomspace(max(begin, 0.1) * 1.0001, min(end, 300.0), 200)
        axes.plot(
            loads, slope * loads + offset, color=BLACK, linewidth=2.2, label=None if number else "USFD, published"
        )
        place = {"mild": (2.6, 7.5), "severe": (22.0, 35.0), "catastrophic": (85.0, 3300.0)}[name]
        axes.annotate(name, place, ha="right" if name == "catastrophic" else "left", fontsize=9)
    slips = np.geomspace(1.5e-3, 0.25, 21)
    mild = mild_coefficient(found.values["friction_cold"])
    for coefficient, colour, name in ((mild, BLUE, "mild branch"), (5e-13, ORANGE, "default")):
        loads, rates = wear(slips, coefficient, **found.values)
        label = f"ours, k = {coefficient * 1e13:.2g}·10⁻¹³/Pa: {name}"
        axes.plot(loads, rates, "o-", color=colour, markersize=3, linewidth=1.0, label=label)
    for slip, place in ((0.01, (56, -14)), (0.1, (6, -28))):
        (load,), (rate,) = wear([slip], mild, **found.values)
        axes.plot(load, rate, "o", color=BLUE, markersize=7)
        axes.annotate(f"{100 * slip:g} % slip", (load, rate), place, textcoords="offset points", ha="right", color=BLUE)
    axes.set(xscale="log", yscale="log", xlim=(0.1, 300.0), ylim=(0.5, 2e4))
    axes.set(xlabel="Tγ/A [N/mm²]", ylabel="wear rate [µg/(m mm²)]")
    axes.set_title("Wear of R8T on 900A over the work in the contact")
    axes.legend(loc="upper left")
    save(figure, "wear_branches.png")


def main():
    """Fit, compute, draw."""
    fits = {name: fitted(name) for name in FITS}
    found, default = fits[CHOSEN], fits["default law, layer"]
    now = points([0.075, 0.1, 0.15, 0.2], FITS[CHOSEN][0], **found.values)
    half_length = 0.5 * now["contact_length"][0] / SCALE
    print(f"  half-length {1e3 * half_length:.3f} mm, largest pressure {1e-6 * now['peak_pressure'][0]:.0f} MPa")
    print(f"  loss of a disc {heat_transfer():.3f} W/K; largest temperature {now['bulk'][-1] + now['flash'][-1]:.0f} K")
    table = measured()
    ratio = now["flash"] / now["friction_power"] / (table["peak flash temperature"] / table["heat"])[-4:]
    print(f"  flash temperature per heat in full sliding, ours over published: {np.round(ratio, 3).tolist()}")
    tables = {
        "fits of the twin disc": fits_table(fits),
        "twin disc over slip": slips_table(found, default),
        "wear of the twin disc": wear_table(found),
    }
    write_tables("measurements_twin_disc.md", tables)
    draw(found, default)
    draw_wear(found)


if __name__ == "__main__":
    main()
