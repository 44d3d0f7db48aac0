"""Pictures: results over time, a braking manoeuvre, fields of a patch and of profiles, creep curves, contact geometry.

Each function returns a matplotlib figure, to show, change or save: `figure.savefig("braking.png")`. A notebook shows it
where it is the last line of a cell.
"""

from collections.abc import Mapping, Sequence
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.collections import QuadMesh
from matplotlib.colors import ListedColormap
from matplotlib.figure import Figure
from matplotlib.patches import Ellipse

from .creep_plots import CreepCurve, creep_curves, creep_panels
from .drawing import BLACK, BLUE, GREEN, ORANGE, RED, SKY, STYLE, Columns, columns_for, styled
from .geometry_plots import contact_geometry
from .surface_plots import surface_fields
from .units import display_unit, in_shown_units, model, said_units, scale_of, shown
from .variables import near
from .variables import unit as unit_of

__all__ = ["BLACK", "BLUE", "GREEN", "ORANGE", "RED", "SKY", "STYLE", "CreepCurve"]
__all__ += ["braking", "contact_geometry", "creep_curves", "creep_panels", "over_time", "patch_fields"]
__all__ += ["surface_fields"]

STICK, SLIP = "#dcebf5", "#f6e3d3"
# What each picture needs, and in what unit.
BRAKING = {
    "time": "s",
    "wheel_speed": "rad/s",
    "traction_force": "N",
    "slip_creepage": "1",
    "peak_temperature": "K",
    "friction_coefficient": "1",
    "traction_coefficient": "1",
    "worn_volume": "m3",
}
FIELDS = {"x": "m", "y": "m", "pressure": "Pa", "shear_x": "Pa", "shear_y": "Pa"}
FIELDS |= {"slip_x": "m/s", "slip_y": "m/s", "temperature": "K"}


# ---- over time ------------------------------------------------------------------------------------------------------


@styled
def over_time(
    result: pd.DataFrame, names: str | Sequence[str], *, units: Mapping[str, str] | None = None, title: str = ""
) -> Figure:
    """Draw columns of a result over time, one panel below the other, with their units.

    Parameters
    ----------
    result
        What `simulate` returned, or a table of `read_table` with a column `time`.
    names
        Names of columns, or one name; that of a profile or of what each contact has, `contact.normal_force`, stands for
        the columns of its elements.
    units
        Units to draw in, by these names: `{"traction_force": "MN"}`; by default those in which people read the
        variables, kN and °C for example.
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each column.

    Raises
    ------
    ValueError
        A column is missing or is no numbers; a unit is none of the variable.
    TypeError
        These are no names, or this is no table.

    Examples
    --------
    >>> result = wheelrail.simulate(wheelrail.example(), slip_source="vehicle_speed")
    >>> over_time(result, ["traction_force", "peak_temperature"]).savefig("over_time.png")
    """
    listed = [names] if isinstance(names, str) else list(names)
    if not listed or not all(isinstance(name, str) for name in listed):
        raise TypeError(f"names = {names!r}: the names of columns are needed")
    there = list(map(str, result)) if isinstance(result, Mapping | pd.DataFrame) else []
    # The name under which each column was chosen: its own, or that of all elements.
    named = {
        column: name
        for name in listed
        for column in [other for other in there if other.startswith(f"{name}[")] or [name]
    }
    chosen, wished = list(named), dict(units or {})
    known = {variable.name: variable for variable in model(None).modelVariables}
    of_table = said_units(result.attrs, there) if isinstance(result, pd.DataFrame) else {}
    needed = {"time": "s"} | {
        name: unit_of(known[name]) if name in known else of_table.get(name, "") for name in chosen
    }
    columns = columns_for("over_time", result, needed, "simulate")
    if others := [name for name in wished if name not in (*listed, *chosen)]:
        raise ValueError(f"units: {others[0]} is not drawn{near(others[0], chosen)}")
    figure, panels = plt.subplots(
        len(chosen), 1, figsize=(8.4, 0.8 + 1.8 * len(chosen)), sharex=True, layout="constrained", squeeze=False
    )
    for axes, name in zip(panels[:, 0], chosen, strict=True):
        values, label = columns[name], needed[name]
        if values.dtype.kind not in "biuf":
            raise ValueError(f"over_time: the column {name} is no numbers")
        wanted = wished.get(name) or wished.get(named[name]) or (display_unit(known[name]) if name in known else None)
        if wanted is not None:
            scale = scale_of(None, name, label, wanted)
            values, label = in_shown_units(values, scale), scale.name
        axes.plot(columns["time"], values, color=BLACK)
        axes.set_ylabel(name.replace("_", " ") + (f" [{shown(label)}]" if shown(label) else ""))
    panels[-1, 0].set(xlabel="time [s]", xlim=(columns["time"].min(), columns["time"].max()))
    figure.align_ylabels(panels)
    panels[0, 0].set_title(title)
    return figure


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

    Raises
    ------
    ValueError
        A column is missing, which is named.

    Examples
    --------
    >>> result = wheelrail.simulate(wheelrail.example(), slip_source="vehicle_speed")
    >>> braking(result, title="Braking with a wheel slide").savefig("braking.png")
    """
    columns = columns_for("braking", result, BRAKING, "simulate of a table with wheel_speed")
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
def patch_fields(fields: Any, *, ellipse: tuple[float, float] | None = None, title: str = "") -> Figure:
    """Draw the fields of a patch in plan view: pressure, shear over stick and slip, slip, temperature.

    Parameters
    ----------
    fields
        `x`, `y` [m], `pressure`, `shear_x`, `shear_y` [Pa], `slip_x`, `slip_y` [m/s], `temperature` [K] and, if there,
        `saturation` [1] of each cell: what `Instance.fields` returns, arrays of strips by cells; fields of `simulate`
        at one time, `fields.isel(time=-1)`; or the columns that `wheelrail simulate --fields` writes (`read_table`).
    ellipse
        Semi-axes of an ellipse to compare with, along and across the rail [m].
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        Four panels in plan view.

    Raises
    ------
    ValueError
        A field is missing, which is named; they are those of several times; nothing is in contact.
    TypeError
        These are no fields.

    Examples
    --------
    >>> result, fields = wheelrail.simulate(stop_time=0.1, lateral_creepage=1e-3, contact_model="patch", fields=True)
    >>> patch_fields(fields.isel(time=-1)).savefig("patch.png")
    """
    field = grids(fields)
    contact = field["pressure"] > 0.0
    if not contact.any():
        raise ValueError("patch_fields: no cell is in contact")
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


def grids(fields: Any) -> dict[str, np.ndarray]:
    """Fields as arrays of strips by cells along the rail; a table has a row for each cell, strip by strip."""
    # A data set of xarray has its places beside its fields.
    table = {**fields.coords, **fields.data_vars} if hasattr(fields, "data_vars") else fields
    arrays = columns_for("patch_fields", table, FIELDS, "Instance.fields or simulate with fields")
    pressure = arrays["pressure"]
    if pressure.ndim > 2:
        raise ValueError("patch_fields: these are the fields of several times; choose one, fields.isel(time=-1)")
    if pressure.ndim == 2 and arrays["x"].ndim == 1:
        x, y = np.meshgrid(arrays["x"], arrays["y"])
        arrays = {name: values for name, values in arrays.items() if values.shape == x.shape} | {"x": x, "y": y}
    if arrays["x"].ndim == 2:
        return arrays
    strips = np.unique(arrays["y"]).size
    if strips < 2 or arrays["x"].size % strips:
        raise ValueError(f"patch_fields: {arrays['x'].size} cells in {strips} strips are no patch")
    size = arrays["x"].size
    return {name: values.reshape(strips, -1) for name, values in arrays.items() if values.size == size}


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
