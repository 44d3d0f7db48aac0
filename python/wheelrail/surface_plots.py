"""Picture of a field of profiles on the unrolled surface of the rail."""

from collections.abc import Mapping
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.colors import Normalize
from matplotlib.figure import Figure

from .drawing import columns_for, styled
from .variables import near

# Unit, that of the picture, its size and the colours of each field; shear and slip are magnitudes.
DRAWN = {
    "pressure": ("Pa", "MPa", 1e-6, "Blues"),
    "shear": ("Pa", "MPa", 1e-6, "Purples"),
    "slip": ("m/s", "mm/s", 1e3, "Oranges"),
    "friction_coefficient": ("1", "1", 1.0, "Greens"),
    "temperature": ("K", "°C", 1.0, "YlOrRd"),
    "wear_depth": ("m", "µm", 1e6, "Greys"),
}
PLACES = {"cell_length": "m", "strip_breadth": "m", "x": "m", "arc_length": "m", "pressure": "Pa"}
SOURCE = "Instance.fields or simulate with fields, where contact_model is profiles"


@styled
def surface_fields(fields: Any, field: str = "pressure", *, title: str = "") -> Figure:
    """Draw a field of profiles on the unrolled surface of the rail, a panel for each contact.

    Parameters
    ----------
    fields
        What `Instance.fields` returns where `contact_model` is profiles; fields of `simulate` at one time,
        `fields.isel(time=-1)`; or the columns that `wheelrail simulate --fields` writes (`read_table`).
    field
        `pressure`, `shear`, `slip`, `friction_coefficient`, `temperature` or `wear_depth`; shear and slip are
        magnitudes.
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each window that carries, from the gauge side to the field side: x ahead of the axle, and across it
        the arc length of the rail's profile from its gauge side.

    Raises
    ------
    ValueError
        There is no such field, or it is missing; they are those of several times; nothing is in contact.
    TypeError
        These are no fields.

    Examples
    --------
    >>> fields = wheelrail.Instance(wheelrail.fmu_path("3.0"), contact_model="profiles", slip_source=2).start().fields()
    >>> surface_fields(fields).savefig("pressure.png")
    """
    if field not in DRAWN:
        raise ValueError(
            f"surface_fields: there is no field {field}{near(str(field), DRAWN)}; fields: {', '.join(DRAWN)}"
        )
    unit, shown, factor, colours = DRAWN[field]
    parts = [f"{field}_x", f"{field}_s"] if field in ("shear", "slip") else [field]
    windows = carrying(fields, PLACES | dict.fromkeys(parts, unit))
    drawn = [np.hypot(*(window[part] for part in parts)) if len(parts) > 1 else window[field] for window in windows]
    values = [factor * array - (273.15 if field == "temperature" else 0.0) for array in drawn]
    # Where nothing touches there is temperature and wear, but no friction.
    everywhere = field in ("temperature", "wear_depth")
    values = [
        array if everywhere else np.where(window["pressure"] > 0.0, array, np.nan)
        for window, array in zip(windows, values, strict=True)
    ]
    low = min(np.nanmin(array) for array in values) if field == "temperature" else 0.0
    scale = Normalize(low, max(max(np.nanmax(array) for array in values), low + 1e-12))

    figure, panels = plt.subplots(
        1, len(windows), figsize=(1.6 + 4.4 * len(windows), 4.2), layout="constrained", squeeze=False
    )
    for number, (axes, window, array) in enumerate(zip(panels[0], windows, values, strict=True)):
        edges = [edges_of(window[place], window[size]) for place, size in AXES]
        mesh = axes.pcolormesh(*edges, array, cmap=colours, norm=scale)
        force = np.sum(window["pressure"]) * window["cell_length"] * window["strip_breadth"]
        axes.set(title=f"contact {number + 1}: {force / 1e3:.1f} kN", xlabel="ahead of the axle, x [mm]")
        axes.grid(False)
    panels[0, 0].set_ylabel("along the rail's profile\nfrom its gauge side [mm]")
    bar = figure.colorbar(mesh, ax=list(panels[0]), shrink=0.85, pad=0.02)
    bar.outline.set_visible(False)
    bar.set_label(f"{field.replace('_', ' ')} [{shown}]" if shown != "1" else field.replace("_", " "))
    figure.suptitle(title, x=0.01, ha="left", fontsize=10)
    return figure


# Places along either axis with the size of what is between them.
AXES = (("x", "cell_length"), ("arc_length", "strip_breadth"))


def edges_of(middles: np.ndarray, size: float) -> np.ndarray:
    """Edges of cells [mm] from their middles and their size [m]."""
    return 1e3 * (np.append(middles, middles[-1] + size) - 0.5 * size)


def carrying(fields: Any, needed: Mapping[str, str]) -> list[dict[str, Any]]:
    """Windows that carry: places along either axis, sizes of the cells, fields over strips and cells."""
    # A data set of xarray has its places beside its fields.
    table = {**fields.coords, **fields.data_vars} if hasattr(fields, "data_vars") else fields
    is_table = isinstance(table, pd.DataFrame)
    arrays = columns_for("surface_fields", table, {"window": "1", **needed} if is_table else needed, SOURCE)
    if arrays["pressure"].ndim > 3:
        raise ValueError("surface_fields: these are the fields of several times; choose one, fields.isel(time=-1)")
    windows = (
        rows(arrays, needed)
        if is_table
        else [{name: arrays[name][number] for name in needed} for number in range(len(arrays["pressure"]))]
    )
    found = [window for window in windows if np.any(window["pressure"] > 0.0)]
    if not found:
        raise ValueError("surface_fields: no cell is in contact")
    return found


def rows(arrays: Mapping[str, np.ndarray], needed: Mapping[str, str]) -> list[dict[str, Any]]:
    """Windows of a table that has a row for each cell, strip by strip."""
    found = []
    for window in np.unique(arrays["window"]):
        own = {name: arrays[name][arrays["window"] == window] for name in needed}
        strips = np.unique(own["arc_length"]).size
        if own["x"].size % strips:
            raise ValueError(f"surface_fields: {own['x'].size} cells in {strips} strips are no window")
        grid = {name: values.reshape(strips, -1) for name, values in own.items()}
        places = {"x": grid["x"][0], "arc_length": grid["arc_length"][:, 0]}
        places |= {size: grid[size][0, 0] for _, size in AXES}
        found.append(grid | places)
    return found
