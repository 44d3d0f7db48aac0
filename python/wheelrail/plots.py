"""Pictures: a braking manoeuvre over time, the fields of a patch in plan view, creep curves.

Each function returns a matplotlib figure, to show, change or save: `figure.savefig("braking.png")`.
"""

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import wraps
from typing import Any, ParamSpec, TypeAlias

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Ellipse

# Okabe and Ito's colours: told apart by everybody, in print too.
BLACK, BLUE, ORANGE, GREEN, RED, SKY = "#000000", "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9"
STICK, SLIP = "#dcebf5", "#f6e3d3"

# As Any: the settings' names are of a type of matplotlib's own.
STYLE: Any = {
    "figure.dpi": 150,
    "savefig.dpi": 150,
    "font.size": 9,
    "axes.titlesize": 10,
    "axes.titlelocation": "left",
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.color": "#dddddd",
    "grid.linewidth": 0.6,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
}

P = ParamSpec("P")
Columns: TypeAlias = Mapping[str, Any] | pd.DataFrame


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw with the look of the documentation, and leave matplotlib's settings as they are."""

    @wraps(draw)
    def drawn(*arguments: P.args, **named: P.kwargs) -> Figure:
        with plt.rc_context(STYLE):
            return draw(*arguments, **named)

    return drawn


# ---- over time ------------------------------------------------------------------------------------------------------


@styled
def braking(result: Columns, *, wheel_radius: float = 0.46, title: str = "") -> Figure:
    """Draw a braking manoeuvre, and what it does to the contact.

    Parameters
    ----------
    result
        What `simulate` returned for a table with `wheel_speed`.
    wheel_radius
        The component's parameter [m].
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Six panels over time: speeds, traction force, creepage, peak temperature, coefficients, worn volume.
    """
    columns = {str(name): np.asarray(result[name]) for name in result}
    time, wheel = columns["time"], wheel_radius * columns["wheel_speed"]
    vehicle = columns.get("vehicle_speed")
    if vehicle is None:
        vehicle = wheel / (1.0 + columns["slip_creepage"])
    figure, panels = plt.subplots(6, 1, figsize=(8.4, 11.0), sharex=True, layout="constrained")
    speeds, traction, creepage, temperature, friction, wear = panels

    speeds.plot(time, vehicle, color=BLACK, label="vehicle")
    speeds.plot(time, wheel, color=BLUE, label="wheel circumference")
    speeds.set_ylabel("speed [m/s]")
    speeds.legend(loc="upper right", ncols=2)

    traction.plot(time, columns["traction_force"] / 1e3, color=BLACK, linewidth=1.0)
    traction.set_ylabel("traction force [kN]")
    # At a standstill there is no creepage.
    rolling = np.logical_and.accumulate(vehicle > 0.0)
    creepage.plot(time[rolling], -100 * columns["slip_creepage"][rolling], color=GREEN)
    creepage.set(yscale="log", ylabel="creepage, negative [%]", ylim=(0.01, 150))
    temperature.plot(time, columns["peak_temperature"] - 273.15, color=RED)
    temperature.set(ylabel="peak temperature [°C]", ylim=(0, None))
    friction.plot(time, columns["friction_coefficient"], color=BLUE, label="friction coefficient")
    friction.plot(time, -columns["traction_coefficient"], color=ORANGE, linewidth=1.0, label="braking force / load")
    friction.set(ylabel="coefficient [1]", ylim=(-0.05, 0.5))
    friction.legend(loc="center right")
    wear.plot(time, columns["worn_volume"] * 1e9, color=BLACK)
    wear.set(ylabel="worn volume [mm³]", xlabel="time [s]", xlim=(time[0], time[-1]), ylim=(0, None))
    figure.align_ylabels(panels)
    speeds.set_title(title)
    return figure


# ---- in plan view ---------------------------------------------------------------------------------------------------


@styled
def patch_fields(fields: Columns, *, ellipse: tuple[float, float] | None = None, title: str = "") -> Figure:
    """Draw the fields of a patch in plan view: pressure, shear over stick and slip, slip, temperature.

    Parameters
    ----------
    fields
        `x`, `y` [m], `pressure`, `shear_x`, `shear_y` [Pa], `slip_x`, `slip_y` [m/s], `temperature` [K] and, if there,
        `saturation` [1] of each cell: what `Instance.fields` returns, arrays of strips by cells, or the columns that
        `wheelrail simulate --fields` writes (`read_table`).
    ellipse
        Semi-axes of an ellipse to compare with, along and across the rail [m].
    title
        Heading.
    """
    field = grids(fields)
    contact = field["pressure"] > 0.0
    limits = ellipse or (np.abs(field["x"][contact]).max(), np.abs(field["y"][contact]).max())

    def inside(values: np.ndarray) -> np.ndarray:
        return np.where(contact, values, np.nan)

    figure, ((pressure, shear), (slip, temperature)) = plt.subplots(2, 2, figsize=(9.6, 7.0), layout="constrained")
    plan(pressure, field, inside(field["pressure"]) / 1e6, "MPa", "Blues")

    speed = np.hypot(field["slip_x"], field["slip_y"])
    slips = field["saturation"] > 1.0 - 1e-6 if "saturation" in field else speed > 1e-6 * speed.max()
    sliding = np.where(slips, 1.0, 0.0)
    across, along = 1e3 * field["y"], 1e3 * field["x"]
    shear.pcolormesh(
        along, across, inside(sliding), cmap=ListedColormap([STICK, SLIP]), shading="nearest", vmin=0.0, vmax=1.0
    )
    every = np.zeros_like(contact)
    step = max(contact.shape[1] // 22, 1)
    every[step // 2 :: step, step // 2 :: step] = True
    shown = contact & every
    arrows = shear.quiver(
        along[shown],
        across[shown],
        -field["shear_x"][shown] / 1e6,
        -field["shear_y"][shown] / 1e6,
        scale=4200,
        width=0.0028,
        pivot="mid",
    )
    shear.quiverkey(arrows, 0.9, 0.05, 200, "200 MPa", labelpos="N", labelsep=0.05)

    plan(slip, field, inside(np.where(sliding > 0, speed, 0.0)) * 1e3, "mm/s", "Oranges")
    celsius = field["temperature"] - 273.15
    plan(temperature, field, celsius, "°C", "YlOrRd").set_clim(celsius.min(), None)
    titles = {
        pressure: "Pressure, and Hertz's ellipse" if ellipse else "Pressure",
        shear: "Shear on the wheel; stick blue, slip orange",
        slip: "Slip",
        temperature: "Surface temperature",
    }
    for axes, text in titles.items():
        frame(axes, text, limits, ellipse is not None)
    for axes in (slip, temperature):
        axes.set_xlabel("along the rail, x [mm]; travel to the right")
    for axes in (pressure, slip):
        axes.set_ylabel("to the left, y [mm]")
    figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    return figure


def grids(fields: Columns) -> dict[str, np.ndarray]:
    """Fields as arrays of strips by cells along the rail; a table has a row for each cell, strip by strip."""
    arrays = {str(name): np.asarray(fields[name]) for name in fields}
    if arrays["x"].ndim == 2:
        return arrays
    strips = np.unique(arrays["y"]).size
    return {name: values.reshape(strips, -1) for name, values in arrays.items()}


def plan(axes: Axes, field: Mapping[str, np.ndarray], values: np.ndarray, unit: str, colours: str) -> QuadMesh:
    """One field over the cells."""
    mesh = axes.pcolormesh(1e3 * field["x"], 1e3 * field["y"], values, cmap=colours, shading="nearest", vmin=0.0)
    bar = axes.figure.colorbar(mesh, ax=axes, shrink=0.85, pad=0.02)
    bar.outline.set_visible(False)
    bar.set_label(unit)
    return mesh


def frame(axes: Axes, title: str, limits: tuple[float, float], ellipse: bool) -> None:
    """What all plan views share."""
    along, across = (1e3 * limit for limit in limits)
    if ellipse:
        size = (2 * along, 2 * across)
        axes.add_patch(Ellipse((0, 0), *size, fill=False, edgecolor=BLACK, linewidth=0.9, linestyle="--"))
    axes.set(title=title, xlim=(-1.12 * along, 1.12 * along), ylim=(-1.2 * across, 1.2 * across), aspect="equal")
    axes.grid(False)


# ---- over creepage --------------------------------------------------------------------------------------------------

# What is driven, and the force over it.
CREEP_PANELS = (
    ("longitudinal", "Fx"),
    ("lateral", "Fy"),
    ("lateral", "Mz"),
    ("spin", "Fy"),
    ("spin", "Mz"),
)
CREEP_LABELS = {
    "longitudinal": r"longitudinal creepage $\xi$ [%]",
    "lateral": r"lateral creepage $\eta$ [%]",
    "spin": r"spin creepage $\varphi$ [1/m]",
    "Fx": r"$F_x/N$ [1]",
    "Fy": r"$F_y/N$ [1]",
    "Mz": r"$M_z/N$ [mm]",
}


@dataclass(frozen=True)
class CreepCurve:
    """Forces over one creepage, in the units of the labels, and how to draw them."""

    driven: str
    creepage: Sequence[float] | np.ndarray
    forces: Mapping[str, Sequence[float] | np.ndarray]
    style: Mapping[str, Any]


@styled
def creep_panels(curves: Iterable[CreepCurve], labels: Mapping[str, str] = CREEP_LABELS) -> Figure:
    """Draw forces over the creepages that are driven, five panels for all three, and one that is left for a legend.

    Parameters
    ----------
    curves
        Curves of any contacts, drawn in this order.
    labels
        What creepages ("longitudinal", "lateral", "spin") and forces ("Fx", "Fy", "Mz") are called.
    """
    drawn = list(curves)
    chosen = [panel for panel in CREEP_PANELS if panel[0] in {curve.driven for curve in drawn}]
    wide = min(len(chosen) + 1, 3)
    high = -(-(len(chosen) + 1) // wide)
    figure, panels = plt.subplots(high, wide, figsize=(3.2 * wide, 3.0 * high), layout="constrained", squeeze=False)
    for axes, (driven, force) in zip(panels.flat, chosen, strict=False):
        axes.axhline(0.0, color=BLACK, linewidth=0.6)
        for curve in drawn:
            if curve.driven == driven:
                axes.plot(curve.creepage, curve.forces[force], **curve.style)
        axes.set(xlabel=labels[driven], title=labels[force])
    for axes in panels.flat[len(chosen) :]:
        axes.axis("off")
    return figure


@styled
def creep_curves(curves: pd.DataFrame | Mapping[str, pd.DataFrame], *, title: str = "") -> Figure:
    """Draw what `wheelrail.creep_curves` computed.

    Parameters
    ----------
    curves
        One table, or several by what they are to be called.
    title
        Heading.
    """
    tables = {"": curves} if isinstance(curves, pd.DataFrame) else dict(curves)
    colours = (BLUE, RED, GREEN, ORANGE, SKY, BLACK)
    drawn, handles = [], []
    inputs = {"longitudinal": ("creepage", 100.0), "lateral": ("lateral_creepage", 100.0), "spin": ("spin_creepage", 1)}
    for number, (name, table) in enumerate(tables.items()):
        style: dict[str, Any] = {"color": colours[number % len(colours)], "marker": ".", "markersize": 3}
        handles.append(Line2D([], [], label=name, **style))
        load = table.attrs["normal_load"]
        for driven, rows in table.groupby("driven", sort=False):
            column, scale = inputs[str(driven)]
            forces = {
                "Fx": rows["traction_force"].to_numpy() / load,
                "Fy": rows["lateral_force"].to_numpy() / load,
                "Mz": rows["spin_moment"].to_numpy() / load * 1e3,
            }
            drawn.append(CreepCurve(str(driven), scale * rows[column].to_numpy(), forces, style))
    figure = creep_panels(drawn)
    if "" not in tables:
        last = next(axes for axes in figure.axes if not axes.axison)
        last.legend(handles=handles, loc="upper left", fontsize=9)
    figure.suptitle(title, x=0.01, ha="left")
    return figure
