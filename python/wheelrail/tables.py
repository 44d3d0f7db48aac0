"""Tables of inputs in any of the accepted forms, and files whose headings have units."""

import csv
import datetime
import math
import numbers
import warnings
from collections.abc import Mapping, Sequence
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import pandas as pd

from .archive import AnyPath
from .arguments import counted
from .units import heading, in_component_units, model, said_units, scale_of, spelling
from .variables import settable
from .variables import unit as unit_of

Table: TypeAlias = pd.DataFrame | np.ndarray | Mapping[str, Any] | str | PathLike[str]

FORMS = "a data frame, a structured array, a mapping of columns, or the path of a CSV file"


# ---- files ----------------------------------------------------------------------------------------------------------


def read_table(path: AnyPath, *, fmu: AnyPath | None = None) -> pd.DataFrame:
    """Read a CSV file whose headings may have units, `normal_load [kN]`, in SI units.

    Columns are separated by commas, semicolons or tabs; beside the latter two numbers may have a decimal comma. Lines
    that begin with `#` and empty lines are left out. The text is UTF-8, with or without a mark at its beginning.

    Parameters
    ----------
    path
        Path of the file.
    fmu
        Another FMU than the package's own: what its variables are called, and in which units they may be given.

    Returns
    -------
    pandas.DataFrame
        Columns by name. Time and the component's variables are converted to the component's units, SI; other columns
        stay as they are. `attrs["units"]` has the unit of each column as it is now, an empty text where none is known.

    Raises
    ------
    ValueError
        It is no table, two columns have one name, a unit is unknown or not one of the variable, a cell that is to be
        converted is no number.
    FileNotFoundError
        There is no such file.

    Examples
    --------
    >>> table = read_table("loads.csv")  # time [ms],normal_load [kN]
    >>> table.attrs["units"]
    {'time': 's', 'normal_load': 'N'}
    """
    source = Path(fspath(path))
    if source.is_dir():
        raise ValueError(f"{source} is a folder: the path of a CSV file is needed")
    if not source.exists():
        raise FileNotFoundError(f"{source} is not there")
    labels, cells = read_cells(source)
    own = {variable.name: unit_of(variable) for variable in model(fmu).modelVariables} | {"time": "s"}
    units: dict[str, str] = {}
    columns: dict[str, Any] = {}
    for label, (_, column) in zip(labels, cells.items(), strict=True):
        name, given = heading(label)
        if name in columns:
            raise ValueError(f"{source}: two columns are called {name}")
        units[name], columns[name] = own.get(name, given or ""), column
        if name in own and given is not None and spelling(given) != spelling(own[name]):
            scale = scale_of(fmu, name, own[name], given)
            columns[name] = in_component_units(plain(name, column), scale)
    result = pd.DataFrame(columns, index=cells.index)
    result.attrs["units"] = units
    return result


def read_cells(source: Path) -> tuple[list[str], pd.DataFrame]:
    """Read the headings of a CSV file as they stand there, and its columns, by number."""
    before, first = 0, ""
    try:
        with source.open(encoding="utf-8-sig") as file:
            for before, line in enumerate(file):  # noqa: B007
                if line.strip() and not line.startswith("#"):
                    first = line
                    break
        if not first:
            raise ValueError(f"{source} has no heading: its first line names the columns")
        separator = max(";\t,", key=first.count) if any(mark in first for mark in ";\t") else ","
        names = next(csv.reader([first.rstrip("\r\n")], delimiter=separator))
        # A decimal comma where it makes numbers of what is text without.
        frame = parsed(source, before + 1, names, separator, ".")
        if separator != "," and texts(frame):
            other = parsed(source, before + 1, names, separator, ",")
            frame = other if len(texts(other)) < len(texts(frame)) else frame
    except UnicodeDecodeError as error:
        raise ValueError(f"{source} is no text in UTF-8: {error.reason} at byte {error.start}") from None
    except (pd.errors.ParserError, pd.errors.ParserWarning) as error:
        raise ValueError(f"{source}: the rows have not as many cells as the heading, {len(names)}: {error}") from None
    # What spreadsheets leave at the end of each line: a separator with nothing behind it.
    while len(names) > 1 and not names[-1].strip() and frame.iloc[:, -1].isna().all():
        names.pop()
        frame = frame.iloc[:, :-1]
    return names, frame


def parsed(source: Path, above: int, names: Sequence[str], separator: str, decimal: str) -> pd.DataFrame:
    """Read the cells below the heading, columns by number."""
    with warnings.catch_warnings():
        # That cells are dropped.
        warnings.simplefilter("error", pd.errors.ParserWarning)
        options: Any = {"header": None, "index_col": False, "comment": "#", "low_memory": False}
        return pd.read_csv(
            source,
            sep=separator,
            decimal=decimal,
            skiprows=above,
            names=range(len(names)),
            encoding="utf-8-sig",
            skipinitialspace=True,
            **options,
        )


def texts(frame: pd.DataFrame) -> list[Any]:
    """Columns that are no numbers."""
    return [name for name, column in frame.items() if column.dtype.kind not in "biuf"]


# ---- tables of inputs -----------------------------------------------------------------------------------------------


class Column(NamedTuple):
    """A column as it was given."""

    heading: str
    values: Any
    unit: str | None


def columns_of(table: Table, fmu: AnyPath) -> dict[str, np.ndarray]:
    """Columns of a table of inputs in any of the accepted forms, `time` first, all of one length, in SI units.

    Raises
    ------
    ValueError
        It is no table of inputs, with the name of the column, the row and the value that cannot be.
    TypeError
        It has none of the forms.
    """
    arrays: dict[str, np.ndarray] = {}
    for label, values, said in given_columns(table, fmu):
        name, unit = heading(label)
        if unit is not None and said is not None and spelling(unit) != spelling(said):
            raise ValueError(
                f"{name}: its heading says {unit or '-'}, attrs['units'] says {said}; one of them has to go"
            )
        if name in arrays:
            raise ValueError(f"{name}: two columns of the table have this name")
        arrays[name] = column_in_si(name, values, said if unit is None else unit, fmu)
    if "time" not in arrays:
        raise ValueError(f"the table of inputs has no column time; columns: {', '.join(arrays) or 'none'}")
    time = arrays.pop("time")
    if time.size == 0:
        raise ValueError("the table of inputs has no rows")
    back = np.flatnonzero(np.diff(time) < 0.0)
    if back.size:
        row = int(back[0]) + 1
        raise ValueError(f"time goes back in row {row + 1}: {time[row]:g} s after {time[row - 1]:g} s")
    for name, column in arrays.items():
        if column.size not in (1, time.size):
            raise ValueError(f"column {name} has {column.size} values, time has {counted(time.size, 'row')}")
    return {"time": time} | {name: np.broadcast_to(column, time.shape) for name, column in arrays.items()}


def given_columns(table: Table, fmu: AnyPath) -> list[Column]:
    """Columns of a table as they were given, the index of a data frame among them where it is the time."""
    if isinstance(table, (str, PathLike)):
        table = read_table(table, fmu=fmu)
        return [Column(name, table[name], table.attrs["units"][name] or None) for name in table.columns]
    if isinstance(table, pd.DataFrame):
        return columns_of_frame(table)
    if isinstance(table, np.ndarray):
        if table.dtype.names is None:
            raise ValueError(f"table: an array needs named columns; give {FORMS}")
        return [Column(name, table[name], None) for name in table.dtype.names]
    if isinstance(table, Mapping):
        for name in table:
            if not isinstance(name, str):
                raise TypeError(f"table: a column is called {name!r}; the name of an input is needed, as a text")
        return [Column(name, values, None) for name, values in table.items()]
    kind = "data frame of one column, a Series" if isinstance(table, pd.Series) else type(table).__name__
    raise TypeError(f"table: this is no table of inputs but a {kind}; give {FORMS}")


def columns_of_frame(table: pd.DataFrame) -> list[Column]:
    """Columns of a data frame."""
    if table.columns.nlevels > 1:
        raise ValueError("table: its columns have names of more than one level; join them, or choose one level")
    names = [str(name) for name in table.columns]
    said = said_units(table.attrs, (heading(name).name for name in names))
    columns = [Column(name, table.iloc[:, number], said.get(heading(name).name)) for number, name in enumerate(names)]
    if "time" not in (heading(name).name for name in names):
        columns.insert(0, time_of_index(table))
    return columns


def time_of_index(table: pd.DataFrame) -> Column:
    """The index of a data frame as its time: one that is called so, durations, or fractions without a name."""
    index = table.index
    if index.nlevels > 1:
        raise ValueError(
            "table: it has no column time, and its index has more than one level; table.reset_index() helps"
        )
    label = str(index.name) if index.name is not None else "time"
    if heading(label).name != "time" and index.dtype.kind != "m":
        raise ValueError(
            f"table: it has no column time, and its index is called {index.name}; if that is the time in seconds:"
            " table.rename_axis('time')"
        )
    if index.name is None and index.dtype.kind in "iub" and len(index) > 0:
        raise ValueError(
            "table: it has no column time, and its index counts rows: add a column time [s], or call the index so,"
            " table.rename_axis('time'), if its whole numbers are seconds"
        )
    said = said_units(table.attrs, ("time",)).get("time")
    return Column(label if index.dtype.kind != "m" else "time", index, said if index.dtype.kind != "m" else None)


def column_in_si(name: str, values: Any, unit: str | None, fmu: AnyPath) -> np.ndarray:
    """A column as numbers in the component's unit."""
    if name.lower() in ("t", "time") and name != "time":
        raise ValueError(f"there is no variable {name}; the column of the time is called time")
    own = "s" if name == "time" else unit_of(settable(fmu, name, ("input",)))
    array = np.atleast_1d(values if isinstance(values, np.ma.MaskedArray) else np.asarray(values))
    if array.ndim != 1:
        raise ValueError(f"column {name} has the shape {array.shape}; one value in each row is needed")
    if name == "time" and (seconds := durations(array)) is not None:
        if unit is not None and spelling(unit) != "s":
            raise ValueError(f"time [{unit}]: durations have their unit themselves; leave [{unit}] out")
        array = seconds
    array = plain(name, array)
    return array if unit is None else in_component_units(array, scale_of(fmu, name, own, unit))


def durations(array: np.ndarray) -> np.ndarray | None:
    """Durations in seconds; nothing where these are none.

    Raises
    ------
    ValueError
        They are dates.
    """
    first = array[0] if array.size and array.dtype.kind == "O" else None
    if array.dtype.kind == "M" or isinstance(first, (datetime.date, np.datetime64)):
        raise ValueError(
            f"time = {array[0] if array.size else array.dtype} in row 1: seconds are needed, not dates; those since the"
            " first row are (dates - dates[0]).total_seconds()"
        )
    if isinstance(first, (datetime.timedelta, np.timedelta64)):
        array = array.astype("timedelta64[ns]")
    if array.dtype.kind != "m":
        return None
    # Not a time is no number either.
    return np.asarray(array / np.timedelta64(1, "s"))


def plain(name: str, column: Any) -> np.ndarray:
    """A column as finite numbers.

    Raises
    ------
    ValueError
        With the name of the column, the row, counted from 1, and the value that is none.
    """
    given = np.ma.filled(column.astype(float), np.nan) if isinstance(column, np.ma.MaskedArray) else np.asarray(column)
    if given.dtype.kind in "fiu":
        values = given.astype(float, copy=False)
    elif given.dtype.kind in "mM":
        values = np.full(given.shape, np.nan)
    else:
        values = np.array([as_number(value) for value in given.tolist()], dtype=float)
    wrong = np.flatnonzero(~np.isfinite(values))
    if wrong.size:
        # One text makes texts of a whole column: that one is named.
        row = int(next((row for row in wrong if not is_text_of_number(given[row])), wrong[0]))
        value = given[row]
        said = repr(str(value)) if isinstance(value, str) else str(value)
        comma = "; a decimal point is needed" if isinstance(value, str) and "," in value else ""
        raise ValueError(f"{name} = {said} in row {row + 1}: a finite number is needed{comma}")
    return values


def is_text_of_number(value: Any) -> bool:
    """Whether a value is a text that has a number in it."""
    try:
        return isinstance(value, str) and math.isfinite(float(value))
    except ValueError:
        return False


def as_number(value: Any) -> float:
    """A number, infinite where it is too large; not a number for all else, texts and truth values among it."""
    try:
        return float(value) if isinstance(value, numbers.Real) and not isinstance(value, bool) else math.nan
    except OverflowError:
        return math.inf
