"""Stepping through communication points, into one array that becomes the result."""

import math
from collections.abc import Callable, Mapping, Sequence

import numpy as np
import pandas as pd

from .fields import Fields
from .instance import Instance, SimulationError
from .variables import unit

# What a run can hardly mean: more communication points, or a result that is larger.
MOST_POINTS = 100_000_000
MOST_BYTES = 16 * 2**30
# Steps between two looks at the table of inputs: so many rows of it are in memory as Python's numbers.
CHUNK = 1024


def points(start: float, end: float, step: float, table: np.ndarray, columns: int) -> np.ndarray:
    """Communication points: every step, the jumps of the table, the end.

    Parameters
    ----------
    start, end, step
        Seconds, the end after the start.
    table
        Times of the table of inputs.
    columns
        Columns of the result, with which its size is judged.

    Raises
    ------
    ValueError
        The step is not positive or shorter than the round-off of the time, or there are too many of them.
    """
    if not step > 0.0:
        raise ValueError(f"step = {step!r}: a positive number of seconds is needed")
    count = (end - start) / step + 1.0
    if not count <= MOST_POINTS:
        raise ValueError(
            f"step = {step:g} s from {start:g} to {end:g} s is {count:.3g} rows: at most {MOST_POINTS:.0e} are"
            " allowed; choose a longer step, or an earlier stop_time"
        )
    if count * columns * 8 > MOST_BYTES:
        raise ValueError(
            f"step = {step:g} s from {start:g} to {end:g} s: {count:.4g} rows of {columns} columns take"
            f" {count * columns * 8 / 2**30:.1f} GiB, and at most {MOST_BYTES / 2**30:.0f} are allowed; choose a longer"
            " step or fewer outputs, or go on part by part with an instance"
        )
    if step < 16.0 * np.spacing(max(abs(start), abs(end))):
        raise ValueError(f"step = {step:g} s: it is lost in the round-off of the time, {end:g} s")
    times = start + step * np.arange(math.ceil((end - start) / step * (1.0 - 1e-12)))
    jumps = table[1:][np.diff(table) == 0.0]
    jumps = np.unique(np.append(jumps[(jumps > start) & (jumps < end)], end))
    # A point that is one of these but for round-off is that one.
    after = np.searchsorted(times, jumps)
    for near in (after - 1, np.minimum(after, times.size - 1)):
        same = np.abs(times[near] - jumps) <= 1e-9 * step
        times[near[same]] = jumps[same]
    others = np.setdiff1d(jumps, times[np.minimum(np.searchsorted(times, jumps), times.size - 1)])
    return np.insert(times, np.searchsorted(times, others), others)


def follow(
    instance: Instance,
    times: np.ndarray,
    table: Mapping[str, np.ndarray],
    constants: Mapping[str, float],
    names: Sequence[str],
    report: Callable[[float], object],
    fields: Fields | None = None,
) -> pd.DataFrame:
    """Step through the communication points with the inputs of a table.

    Parameters
    ----------
    instance
        Stands at the first of the points, and is left at the last.
    times
        Communication points [s].
    table
        Inputs over `time`.
    constants
        Inputs that are constant, to be listed in the result.
    names
        Outputs, one for each column: of an array its elements.
    report
        Called with the time after each step.
    fields
        Takes the fields at the points that it wants.

    Returns
    -------
    pandas.DataFrame
        Time, inputs, outputs with their units: a row for each communication point.

    Raises
    ------
    SimulationError
        A step could not be completed; its `table` has the rows before, its `fields` the fields.
    """
    moving = [name for name in table if name != "time"]
    head = ["time", *moving, *constants]
    # One array, a column of the result behind the other, as pandas keeps them: it is not copied.
    values = np.empty((len(head) + len(names), times.size))
    values[0] = times
    for number, name in enumerate(moving, 1):
        # At a jump the value after it.
        values[number] = np.interp(times, table["time"], table[name])
    for number, constant in enumerate(constants.values(), 1 + len(moving)):
        values[number] = constant
    columns = [*head, *names]

    def read(number: int) -> None:
        if names:
            values[len(head) :, number] = instance.get(*names)
        if fields is not None:
            fields.take(instance, number)

    read(0)
    for first in range(0, times.size - 1, CHUNK):
        last = min(first + CHUNK, times.size - 1)
        now = times[first : last + 1].tolist()
        right = values[1 : 1 + len(moving), first:last].T.tolist()
        left = values_before(times[first + 1 : last + 1], table, moving).tolist()
        for number in range(last - first):
            try:
                instance.follow(moving, right[number], left[number], now[number + 1] - now[number])
                # Without the round-off of a sum.
                instance.time = now[number + 1]
                read(first + number + 1)
            except SimulationError as error:
                failed = SimulationError(f"after {now[number]:g} s: {error}")
                failed.table = frame(values[:, : first + number + 1].copy(), columns, instance)
                if fields is not None:
                    failed.fields = fields.dataset(times[: first + number + 1])
                raise failed from error
            report(now[number + 1])
    return frame(values, columns, instance)


def values_before(times: np.ndarray, table: Mapping[str, np.ndarray], names: Sequence[str]) -> np.ndarray:
    """Inputs at given times, a row for each; at a jump those before it: the table seen from behind."""
    values = np.empty((times.size, len(names)))
    for number, name in enumerate(names):
        values[:, number] = np.interp(-times, -table["time"][::-1], table[name][::-1])
    return values


def frame(values: np.ndarray, columns: Sequence[str], instance: Instance) -> pd.DataFrame:
    """The result as a data frame of an array of columns, which is not copied, with units."""
    known = instance.variables
    result = pd.DataFrame(values.T, columns=list(columns), copy=False)
    result.attrs["units"] = {
        name: "s" if name == "time" else unit(known.get(name) or known[name.partition("[")[0]]) for name in columns
    }
    return result
