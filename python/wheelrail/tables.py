"""Tables of inputs, and tables whose headings have units."""

import re
from collections.abc import Mapping
from os import PathLike
from pathlib import Path
from typing import Any, TypeAlias

import numpy as np
import pandas as pd

from .archive import AnyPath
from .variables import bounds, settable, unit

Table: TypeAlias = pd.DataFrame | np.ndarray | Mapping[str, Any] | str | PathLike[str]


def read_table(path: AnyPath) -> pd.DataFrame:
    """Read a CSV file whose headings may have units, `normal_load [N]`.

    Returns
    -------
    pandas.DataFrame
        Columns by name, their units in `attrs["units"]`.
    """
    frame = pd.read_csv(path)
    units = {}
    for heading in frame.columns:
        name, found = re.fullmatch(r"(.*?)\s*(?:\[([^\]]*)\])?", heading.strip()).groups()  # type: ignore[union-attr]
        units[name] = found or ""
    frame.columns = pd.Index(list(units))
    frame.attrs["units"] = units
    return frame


def columns_of(table: Table) -> dict[str, np.ndarray]:
    """Columns of a table in any of the accepted forms, `time` first, all of one length."""
    if isinstance(table, (str, PathLike)):
        table = read_table(Path(table))
    if isinstance(table, pd.DataFrame):
        if "time" not in table.columns:
            # A table by time: the index, whatever its name.
            table = table.rename_axis("time").reset_index()
        columns = {str(name): table[name] for name in table.columns}
    elif isinstance(table, np.ndarray):
        if table.dtype.names is None:
            raise ValueError("an array of inputs needs named columns: a structured array, a mapping or a data frame")
        columns = {name: table[name] for name in table.dtype.names}
    else:
        columns = dict(table)
    if "time" not in columns:
        raise ValueError(f"the table of inputs has no column time; columns: {', '.join(columns)}")
    arrays = {name: np.atleast_1d(np.asarray(column, dtype=float)) for name, column in columns.items()}
    time = arrays.pop("time")
    for name, column in arrays.items():
        if column.ndim != 1 or column.size not in (1, time.size):
            raise ValueError(f"column {name} has the shape {column.shape}, time has {time.size} rows")
    return {"time": time} | {name: np.broadcast_to(column, time.shape) for name, column in arrays.items()}


def check_columns(fmu: AnyPath, columns: Mapping[str, np.ndarray]) -> None:
    """Refuse columns that are no inputs, times that go back, and values out of range.

    Raises
    ------
    ValueError
        With the name of the column, and the first time at which it cannot be.
    """
    time = columns["time"]
    if time.size == 0 or not np.all(np.isfinite(time)) or np.any(np.diff(time) < 0.0):
        raise ValueError("time: finite numbers in ascending order are needed")
    for name, column in columns.items():
        if name == "time":
            continue
        variable = settable(fmu, name, ("input",))
        low, high = bounds(variable)
        wrong = np.flatnonzero(~((column >= low) & (column <= high)))
        if wrong.size:
            raise ValueError(
                f"{name} = {column[wrong[0]]:g} at {time[wrong[0]]:g} s:"
                f" allowed is {low:g} to {high:g} {unit(variable)}".rstrip()
            )
