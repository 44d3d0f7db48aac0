"""A table of inputs in, a table of outputs out."""

import sys
from collections.abc import Callable, Iterable, Mapping
from typing import Any, TypeAlias

import numpy as np
import pandas as pd
from fmpy.simulation import simulate_fmu

from .archive import AnyPath, description, fmu_path, unpacked
from .instance import Instance, SimulationError, connect, disconnect, reported
from .tables import Table, check_columns, columns_of, signals
from .variables import outputs_named, settable, start_values, units

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
    if not end > start:
        raise ValueError(f"stop_time = {end:g} s: after {start:g} s is needed")
    if not step > 0.0:
        raise ValueError(f"step = {step!r}: a positive number of seconds is needed")
    table_of_inputs = signals(fmu, columns, constants)
    names = outputs_named(fmu, outputs)
    rows = run(fmu, start, end, step, table_of_inputs, names, given, reporter(progress, start, end), instance)
    inputs = [name for name in table_of_inputs.dtype.names or () if name in columns or name in constants]
    return frame(rows, fmu, table_of_inputs, [name for name in inputs if name != "time"], names)


def settable_as_input(fmu: AnyPath, name: str) -> bool:
    """Whether a name is that of an input."""
    return bool(settable(fmu, name, ("input", "parameter", "structuralParameter")).causality == "input")


def run(
    fmu: AnyPath,
    start: float,
    end: float,
    step: float,
    table: np.ndarray,
    names: list[str],
    given: Mapping[str, Any],
    report: Callable[[float], object],
    instance: Instance | None,
) -> np.ndarray:
    """Simulate in FMPy, in an instance of its own or in a given one."""
    slave, messages = connect(fmu, "simulate") if instance is None else (instance.slave, instance.messages)
    last, recorder = start, None

    def finished(time: float, recorded: Any) -> bool:
        nonlocal last, recorder
        recorder = recorded
        # FMPy repeats a step that was discarded, without end.
        if time <= last:
            raise SimulationError("; ".join(messages) or "the step cannot be completed")
        last = time
        messages.clear()
        report(time)
        return True

    try:
        with reported(messages):
            rows: np.ndarray = simulate_fmu(
                unpacked(fmu),
                validate=False,
                start_time=start,
                stop_time=end,
                output_interval=step,
                start_values={} if instance is not None else dict(given),
                input=table,
                output=names,
                step_finished=finished,
                model_description=description(fmu),
                fmu_instance=slave,
                initialize=instance is None,
                terminate=instance is None,
            )
    except SimulationError as error:
        failed = SimulationError(f"after {last:g} s: {error}")
        if recorder is not None:
            failed.table = frame(recorder.result(), fmu, table, [], names)
        raise failed from error
    finally:
        if instance is None:
            disconnect(slave)
        else:
            instance.time = last
    return rows


def frame(rows: np.ndarray, fmu: AnyPath, table: np.ndarray, inputs: list[str], names: list[str]) -> pd.DataFrame:
    """The result as a data frame: time, inputs, outputs, with units; arrays as a column for each element."""
    time = rows["time"]
    columns = {"time": time} | {name: np.interp(time, table["time"], table[name]) for name in inputs}
    of_model = units(description(fmu))
    of_columns = {"time": "s"} | {name: of_model[name] for name in inputs}
    for name in names:
        values = rows[name]
        for index in np.ndindex(values.shape[1:]):
            label = f"{name}[{','.join(str(i + 1) for i in index)}]" if index else name
            columns[label] = values[(slice(None), *index)]
            of_columns[label] = of_model[name]
    result = pd.DataFrame(columns)
    result.attrs["units"] = of_columns
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
