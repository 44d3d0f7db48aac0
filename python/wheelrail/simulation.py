"""A table of inputs in, a table of outputs out."""

import math
import sys
from collections.abc import Callable, Iterable, Mapping, Sequence
from itertools import pairwise
from typing import Any, TypeAlias

import numpy as np
import pandas as pd

from .archive import AnyPath, fmu_path
from .instance import Instance, SimulationError
from .tables import Table, check_columns, columns_of
from .variables import outputs_named, settable, shape, start_values, unit

Progress: TypeAlias = bool | str | Callable[[float], object]


def simulate(
    table: Table | None = None,
    *,
    step: float = 1e-3,
    stop_time: float | None = None,
    outputs: Iterable[str] | None = None,
    parameters: Mapping[str, Any] | None = None,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    instance: Instance | None = None,
    **values: Any,
) -> pd.DataFrame:
    """Drive the component through a table of inputs.

    Parameters
    ----------
    table
        Inputs over time: a data frame, a structured array, a mapping of columns, or the path of a CSV file. It has a
        column `time` [s] and one for each input that varies; between its rows inputs are interpolated, at two rows of
        the same time they jump. Without a table all inputs are constant.
    step
        Communication step [s]: a row of the result for each.
    stop_time
        End [s]; by default the last time of the table.
    outputs
        Names of what comes back; by default every output. A profile's name, `profile.pressure`, stands for its points.
    parameters
        Parameters and constant inputs whose names are no Python names, `{"friction_table.temperature": [...]}`.
    progress
        True for a line on standard error, a text for one with that title, or a function that is called with the share
        that is done.
    fmu
        Another FMU than the package's own, of FMI 2.0 or 3.0.
    instance
        An `Instance` to go on with from its own time; it is left as it is at the end.
    **values
        Parameters and constant inputs by name; choices by name or number: `friction_law="constant"`.

    Returns
    -------
    pandas.DataFrame
        `time`, the inputs that were given, and the outputs, at each communication point. `attrs["units"]` has the unit
        of each column.

    Raises
    ------
    ValueError
        An unknown name, a value out of range, a table that is none.
    SimulationError
        The component refused a combination or could not complete a step; `table` of the error has the rows before.

    Examples
    --------
    >>> table = {"time": [0.0, 1.0], "creepage": [0.0, 0.02], "normal_load": [60e3, 80e3]}
    >>> result = simulate(table, friction_law="piecewise_linear", friction_hot=0.2, wheel_speed=40.0)
    >>> result["peak_temperature"].max()
    """
    fmu = instance.fmu if instance is not None else fmu or fmu_path()
    given = start_values(fmu, {**(parameters or {}), **values})
    constants = {name: value for name, value in given.items() if settable_as_input(fmu, name)}
    start = 0.0 if instance is None else instance.time
    columns = columns_of({"time": [start]} if table is None else table)
    check_columns(fmu, columns)
    if twice := columns.keys() & given.keys():
        raise ValueError(f"given in the table and as a constant: {', '.join(sorted(twice))}")
    if instance is not None and given.keys() - constants.keys():
        fixed = ", ".join(sorted(given.keys() - constants.keys()))
        raise ValueError(f"parameters of an instance are set when it is made: {fixed}")
    start = float(columns["time"][0]) if instance is None else start
    end = float(columns["time"][-1]) if stop_time is None else stop_time
    if not start < end < math.inf:
        raise ValueError(f"stop_time = {end:g} s: after {start:g} s is needed")
    if not step > 0.0:
        raise ValueError(f"step = {step!r}: a positive number of seconds is needed")
    names = outputs_named(fmu, outputs)
    report = reporter(progress, start, end)
    times = points(start, end, step, columns["time"])
    inputs = {name: column for name, column in columns.items() if name != "time"}
    first = {name: float(np.interp(start, columns["time"], column)) for name, column in inputs.items()}
    if instance is not None:
        instance.set(**constants)
        rows = follow(instance, times, columns["time"], inputs, names, report)
    else:
        own = Instance(fmu, "simulate", start, **given, **first)
        try:
            rows = follow(own.start(), times, columns["time"], inputs, names, report)
        finally:
            own.close()
    after = {name: np.interp(times, columns["time"], column) for name, column in inputs.items()}
    after |= {name: np.full(times.size, value) for name, value in constants.items()}
    return frame(times, after, rows, own if instance is None else instance, names)


def settable_as_input(fmu: AnyPath, name: str) -> bool:
    """Whether a name is that of an input."""
    return bool(settable(fmu, name, ("input", "parameter", "structuralParameter")).causality == "input")


def points(start: float, end: float, step: float, table: np.ndarray) -> np.ndarray:
    """Communication points: every step, the jumps of the table, the end."""
    regular = start + step * np.arange(math.ceil((end - start) / step * (1.0 - 1e-12)))
    jumps = table[1:][np.diff(table) == 0.0]
    jumps = np.unique(np.append(jumps[(jumps > start) & (jumps < end)], end))
    # A point that is one of these but for round-off is that one.
    marks = np.concatenate([[-np.inf], jumps, [np.inf]])
    after = np.searchsorted(marks, regular)
    other = np.minimum(marks[after] - regular, regular - marks[after - 1]) > 1e-9 * step
    return np.union1d(regular[other], jumps)


def values_at(times: np.ndarray, table: np.ndarray, inputs: Mapping[str, np.ndarray]) -> np.ndarray:
    """Inputs at given times, a row for each; at a jump those after it."""
    values = np.empty((times.size, len(inputs)))
    for number, column in enumerate(inputs.values()):
        values[:, number] = np.interp(times, table, column)
    return values


def follow(
    instance: Instance,
    times: np.ndarray,
    table: np.ndarray,
    inputs: Mapping[str, np.ndarray],
    names: Sequence[str],
    report: Callable[[float], object],
) -> np.ndarray:
    """Step through the communication points with the inputs of the table; a row of outputs for each."""
    moving = list(inputs)
    right = values_at(times, table, inputs)
    # Seen from behind, the values before a jump.
    left = values_at(-times, -table[::-1], {name: column[::-1] for name, column in inputs.items()})
    rows = [instance.get(*names)]
    for number, (now, then) in enumerate(pairwise(times.tolist())):
        try:
            instance.follow(moving, right[number].tolist(), left[number + 1].tolist(), then - now)
            rows.append(instance.get(*names))
        except SimulationError as error:
            failed = SimulationError(f"after {now:g} s: {error}")
            failed.table = frame(times[: number + 1], {}, np.array(rows), instance, names)
            raise failed from error
        # Without the round-off of a sum.
        instance.time = then
        report(then)
    return np.array(rows)


def frame(
    times: np.ndarray, inputs: Mapping[str, np.ndarray], rows: np.ndarray, instance: Instance, names: Sequence[str]
) -> pd.DataFrame:
    """The result as a data frame: time, inputs, outputs, with units; arrays as a column for each element."""
    known = instance.variables
    labels = [
        f"{name}[{','.join(str(i + 1) for i in index)}]" if index else name
        for name in names
        for index in np.ndindex(shape(known[name], instance.lengths))
    ]
    columns = {"time": times, **inputs, **dict(zip(labels, rows.T, strict=True))}
    result = pd.DataFrame(columns)
    result.attrs["units"] = {"time": "s"} | {
        label: unit(known.get(label) or known[label.partition("[")[0]]) for label in columns if label != "time"
    }
    return result


def reporter(progress: Progress, start: float, end: float) -> Callable[[float], None]:
    """What is called with the time after each step."""
    if progress is False:
        return lambda time: None
    if callable(progress):
        call = progress
        return lambda time: void(call((time - start) / (end - start)))
    title = progress if isinstance(progress, str) else "simulate"
    shown = 0

    def show(time: float) -> None:
        nonlocal shown
        percent = int(100.0 * (time - start) / (end - start) + 1e-6)
        terminal = sys.stderr.isatty()
        # A terminal shows each percent in place, a log file each half.
        if percent > shown and (terminal or percent // 50 > shown // 50):
            mark = "\r" if terminal and percent < 100 else "\n"
            text = f"  {title}: {time:6.2f} of {end:.2f} s, {percent:3d} %"
            print(text, end=mark, file=sys.stderr, flush=True)
            shown = percent

    return show


def void(_: object) -> None:
    """Drop a value."""
