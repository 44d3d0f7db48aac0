"""What all pictures share: their look, how a notebook shows them, and what they ask of the tables that they draw."""

from collections.abc import Callable, Mapping
from functools import wraps
from typing import Any, ParamSpec, TypeAlias

import matplotlib
import matplotlib.pyplot as plt
import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from .units import in_component_units, said_units, scale_of, spelling
from .variables import near

# Okabe and Ito's colours: told apart by everybody, in print too.
BLACK, BLUE, ORANGE, GREEN, RED, SKY = "#000000", "#0072B2", "#E69F00", "#009E73", "#D55E00", "#56B4E9"

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
# Backends that open no window: files, and pictures below a notebook's cell.
WITHOUT_WINDOW = ("agg", "cairo", "inline", "pdf", "pgf", "ps", "svg", "template")

P = ParamSpec("P")
Columns: TypeAlias = Mapping[str, Any] | pd.DataFrame


def styled(draw: Callable[P, Figure]) -> Callable[P, Figure]:
    """Draw with the look of the documentation, leaving matplotlib's settings and its open figures as they are.

    A notebook shows what a cell's last line returns, and what pyplot has open besides: the picture would be there
    twice. Where there are windows the figure stays open, for `plt.show()`.
    """

    @wraps(draw)
    def drawn(*arguments: P.args, **named: P.kwargs) -> Figure:
        with plt.rc_context(STYLE):
            figure = draw(*arguments, **named)
            # Ticks are counted and made when a figure is first drawn, with the settings of that moment.
            for axes in figure.axes:
                axes.tick_params(labelsize=STYLE["font.size"])
            figure.draw_without_rendering()
        backend = str(matplotlib.get_backend()).lower().rpartition("backend_")[2]
        if backend in WITHOUT_WINDOW:
            plt.close(figure)
        return figure

    return drawn


def columns_for(drawn: str, table: Columns, needed: Mapping[str, str], source: str) -> dict[str, np.ndarray]:
    """All columns of a table as arrays, those that a picture needs in the unit that it takes them in.

    Parameters
    ----------
    drawn
        What is drawn, for messages.
    table
        A data frame, whose `attrs["units"]` may say other units, or a mapping.
    needed
        Unit of each column that must be there.
    source
        What returns such a table, for messages.

    Raises
    ------
    TypeError
        It is no table.
    ValueError
        Columns are missing; a unit is none of theirs.
    """
    if not isinstance(table, Mapping | pd.DataFrame):
        raise TypeError(f"{drawn}: a table is needed, as {source} returns it, not a {type(table).__name__}")
    columns = {str(name): np.asarray(table[name]) for name in table}
    if missing := [name for name in needed if name not in columns]:
        hint = near(missing[0], columns)
        raise ValueError(f"{drawn} needs {', '.join(missing)}, which the table has not; {source} returns them{hint}")
    said = said_units(table.attrs, needed) if isinstance(table, pd.DataFrame) else {}
    for name, unit in said.items():
        if spelling(unit) != spelling(needed[name]):
            columns[name] = in_component_units(columns[name], scale_of(None, name, needed[name], unit))
    return columns
