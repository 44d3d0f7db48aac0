"""Pictures of creep curves; `wheelrail.plots` has them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from .drawing import BLACK, BLUE, GREEN, ORANGE, RED, SKY, columns_for, styled

# What a table needs, and in what unit.
CREEPAGES = {"creepage": "1", "lateral_creepage": "1", "spin_creepage": "1/m"}
FORCES = {"traction_force": "N", "lateral_force": "N", "spin_moment": "N.m"}
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
    """Draw forces over the creepages that are driven: five panels for all three, and one that is left for a legend.

    Parameters
    ----------
    curves
        Curves of any contacts, drawn in this order.
    labels
        What creepages ("longitudinal", "lateral", "spin") and forces ("Fx", "Fy", "Mz") are called.
    """
    drawn = list(curves)
    chosen = [panel for panel in CREEP_PANELS if panel[0] in {curve.driven for curve in drawn}]
    if not chosen:
        raise ValueError("creep_panels: there is no curve to draw")
    # Up to three panels in a row; four are a square.
    wide = len(chosen) if len(chosen) <= 3 else -(-len(chosen) // 2)
    high = -(-len(chosen) // wide)
    size = (max(3.2 * wide, 5.6), 3.0 * high if wide > 1 else 3.6)
    figure, panels = plt.subplots(high, wide, figsize=size, layout="constrained", squeeze=False)
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
    """Draw what `wheelrail.creep_curves` computed, and say the load and the speed.

    Parameters
    ----------
    curves
        One table, or several by what they are to be called.
    title
        Heading.

    Returns
    -------
    matplotlib.figure.Figure
        A panel for each force over each creepage that is driven.

    Raises
    ------
    ValueError
        A table lacks columns, which are named, or its load and speed.
    TypeError
        It is no data frame.

    Examples
    --------
    >>> curves = wheelrail.creep_curves("lateral", load=80e3)
    >>> creep_curves(curves).savefig("creep.png")
    """
    tables = dict(curves) if isinstance(curves, Mapping) else {"": curves}
    if not tables:
        raise ValueError("creep_curves: there is no table to draw")
    said = {name: conditions(table) for name, table in tables.items()}
    alike = len(set(said.values())) == 1
    colours = (BLUE, RED, GREEN, ORANGE, SKY, BLACK)
    drawn, handles = [], []
    inputs = {"longitudinal": ("creepage", 100.0), "lateral": ("lateral_creepage", 100.0), "spin": ("spin_creepage", 1)}
    for number, (name, table) in enumerate(tables.items()):
        style: dict[str, Any] = {"color": colours[number % len(colours)], "marker": ".", "markersize": 3}
        handles.append(Line2D([], [], label=str(name) if alike else f"{name}: {said[name]}", **style))
        load = table.attrs["normal_load"]
        columns_for("creep_curves", table, CREEPAGES | FORCES, "wheelrail.creep_curves")
        for driven, rows in table.groupby("driven", sort=False):
            column, scale = inputs[str(driven)]
            forces = {
                "Fx": rows["traction_force"].to_numpy() / load,
                "Fy": rows["lateral_force"].to_numpy() / load,
                "Mz": rows["spin_moment"].to_numpy() / load * 1e3,
            }
            drawn.append(CreepCurve(str(driven), scale * rows[column].to_numpy(), forces, style))
    figure = creep_panels(drawn)
    if isinstance(curves, Mapping):
        # In the panel that is left, if there is one.
        axes = next((axes for axes in figure.axes if not axes.axison), figure.axes[0])
        axes.legend(handles=handles, loc="best" if axes.axison else "upper left", fontsize=9)
    heading = [title] if title else []
    figure.suptitle(": ".join(heading + ([next(iter(said.values()))] if alike else [])), x=0.01, ha="left", fontsize=10)
    return figure


def conditions(table: pd.DataFrame) -> str:
    """Load and speed of creep curves, in words.

    Raises
    ------
    TypeError
        It is no data frame.
    ValueError
        It does not say them.
    """
    if not isinstance(table, pd.DataFrame):
        raise TypeError(f"creep_curves: a data frame of wheelrail.creep_curves is needed, not a {type(table).__name__}")
    columns = ["driven", *CREEPAGES, *FORCES]
    if missing := [name for name in columns if name not in table]:
        raise ValueError(
            f"creep_curves needs {', '.join(missing)}, which the table has not; wheelrail.creep_curves returns them"
        )
    if missing := [name for name in ("normal_load", "speed") if name not in table.attrs]:
        raise ValueError(
            f"creep_curves: attrs of the table lack {' and '.join(missing)}; wheelrail.creep_curves sets them, and some"
            " functions of pandas drop them"
        )
    return f"{table.attrs['normal_load'] / 1e3:g} kN, {table.attrs['speed']:g} m/s"
