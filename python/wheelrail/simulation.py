"""A table of inputs in, a table of outputs out."""

from __future__ import annotations

import os
from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any, Literal, overload

import numpy as np
import pandas as pd

from .archive import AnyPath, fmu_path
from .archive import preset as preset_named
from .arguments import seconds
from .fields import Fields, needs_xarray, whole
from .inputs import check_inputs, parameters_of, with_window
from .instance import Instance
from .progress import Progress, reporter
from .stepping import follow, points
from .tables import Table, columns_of
from .variables import by_name, choices, lengths_of, outputs_named, start_values

if TYPE_CHECKING:
    import xarray


@overload
def simulate(
    table: Table | None = None,
    *,
    step: float = 1e-3,
    stop_time: float | None = None,
    outputs: str | Iterable[str] | None = None,
    preset: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    fields: Literal[False] = False,
    fields_every: int = 1,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    instance: Instance | None = None,
    **values: Any,
) -> pd.DataFrame: ...


@overload
def simulate(
    table: Table | None = None,
    *,
    step: float = 1e-3,
    stop_time: float | None = None,
    outputs: str | Iterable[str] | None = None,
    preset: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    fields: Literal[True] | str | Iterable[str],
    fields_every: int = 1,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    instance: Instance | None = None,
    **values: Any,
) -> tuple[pd.DataFrame, xarray.Dataset]: ...


def simulate(
    table: Table | None = None,
    *,
    step: float = 1e-3,
    stop_time: float | None = None,
    outputs: str | Iterable[str] | None = None,
    preset: str | None = None,
    parameters: Mapping[str, Any] | None = None,
    fields: bool | str | Iterable[str] = False,
    fields_every: int = 1,
    progress: Progress = False,
    fmu: AnyPath | None = None,
    instance: Instance | None = None,
    **values: Any,
) -> pd.DataFrame | tuple[pd.DataFrame, xarray.Dataset]:
    """Drive the component through a table of inputs.

    Parameters
    ----------
    table
        Inputs over time: a data frame, a structured array, a mapping of columns, or the path of a CSV file. It has a
        column `time` [s] and one for each input that varies; between its rows inputs are interpolated, at two rows of
        the same time they jump. Headings may have units, `normal_load [kN]`, and so may `attrs["units"]` of a data
        frame; the values are converted. The index of a data frame is its time where it is called `time`, where it has
        durations, and where it has fractions and no name. Without a table all inputs are constant.
    step
        Communication step [s]: a row of the result for each.
    stop_time
        End [s]; by default the last time of the table. Behind the table inputs stay as they are in its last row.
    outputs
        Names of what comes back, or one name; by default every output but arrays. A profile's name, `profile.pressure`,
        stands for its points, `contact.normal_force` for the contacts, `contact.normal_force[1]` for the first of them.
    preset
        Name of a set of parameters, "wet" for example; what is given by name goes before it.
    parameters
        Parameters and constant inputs whose names are no Python names, `{"friction_table.temperature": [...]}`.
    fields
        True for the fields of the contact over time as well, or the names of some: pressure, shear, slip, temperature
        and wear over the cells of a patch or of the windows of profiles, or along a line and into the depth. They need
        xarray, and come from the FMU of FMI 3.0 unless another is given.
    fields_every
        Communication points from one set of fields to the next; the first and the last point are always among them.
    progress
        True for a line on standard error, a text for one with that title, or a function that is called with the share
        that is done.
    fmu
        Another FMU than the package's own, of FMI 2.0 or 3.0.
    instance
        An `Instance` to go on with from its own time; it is left as it is at the end.
    **values
        Parameters and constant inputs by name, in SI units; choices by name or number: `friction_law="constant"`;
        `rail_profile` and `wheel_profile` by name, as the path of a file or a `Profile`.
        `largest_load`, which sizes the contact window, follows the largest load up to 200 kN unless it is given.

    Returns
    -------
    pandas.DataFrame
        `time`, the inputs that were given, and the outputs, at each communication point. `attrs["units"]` has the unit
        of each column.
    xarray.Dataset
        With `fields`, as the second of two: each field over `time` and the places `y`, `x` of the cells, or `x` along a
        line and `z` below it [m]; of profiles over `time`, `window`, `strip` and `cell`, with the places of the cells
        as coordinates that move with the windows; units in `attrs["units"]` of each.

    Raises
    ------
    ValueError
        Before anything is computed: an unknown name, a value out of range, an input that the chosen mode does not use,
        a unit that is unknown or not one of the variable, a cell that is no number, a step or a stop time that cannot
        be.
    TypeError
        An argument of a wrong type: a table of none of the forms, names that are no texts.
    FileNotFoundError
        The table's file or the FMU is not there.
    ImportError
        `fields` without xarray.
    SimulationError
        The component refused a combination or could not complete a step; `table` of the error has the rows before, and
        `fields` the fields.

    Examples
    --------
    >>> table = {"time": [0.0, 1.0], "creepage [%]": [0.0, 2.0], "normal_load [kN]": [60.0, 80.0]}
    >>> result = simulate(table, friction_law="piecewise_linear", friction_hot=0.2, wheel_speed=40.0)
    >>> result["peak_temperature"].max()
    >>> result, fields = simulate(table, fields=["pressure"], fields_every=10, contact_model="patch")
    >>> fields.pressure.isel(time=-1).max()
    """
    if fields is not False:
        needs_xarray()
    fmu = fmu_of(fmu, instance, "2.0" if fields is False else "3.0")
    given = start_values(fmu, given_values(preset, parameters, values))
    known = by_name(str(fmu))
    constants = {name: value for name, value in given.items() if known[name].causality == "input"}
    if instance is not None and given.keys() - constants.keys():
        fixed = ", ".join(sorted(given.keys() - constants.keys()))
        raise ValueError(f"parameters of an instance are set when it is made: {fixed}")
    if table is None and stop_time is None:
        raise ValueError("without a table stop_time is needed: how long to go on [s]")
    columns = columns_of({"time": [0.0 if instance is None else instance.time]} if table is None else table, fmu)
    if twice := columns.keys() & given.keys():
        raise ValueError(f"given in the table and as a constant: {', '.join(sorted(twice))}")
    if instance is None:
        given = with_window(fmu, given, columns.get("normal_load", np.atleast_1d(given.get("normal_load", 0.0))))
    value = parameters_of(fmu, given, instance)
    check_inputs(fmu, columns, constants, value)
    start = float(columns["time"][0]) if instance is None else instance.time
    end = float(columns["time"][-1]) if stop_time is None else seconds("stop_time", stop_time)
    if not start < end:
        where = "the table ends there, and" if stop_time is None else f"stop_time = {end:g} s, and"
        raise ValueError(f"{where} a run from {start:g} s needs a stop_time after that")
    listed = {"time", *columns, *constants}
    # What is an input already has its column.
    lengths = lengths_of(fmu, given) if instance is None else instance.lengths
    names = [name for name in outputs_named(fmu, without_time(outputs), lengths) if name not in listed]
    times = points(start, end, seconds("step", step), columns["time"], len(listed) + len(names))
    report = reporter(progress, start, end, "simulate", "s")
    every = whole("fields_every", fields_every)
    models = choices(known["contact_model"]) if "contact_model" in known else {}
    model = value("contact_model") if models else None
    named = next((name for name, number in models.items() if number == model), "line")
    first = {
        name: float(np.interp(start, columns["time"], column)) for name, column in columns.items() if name != "time"
    }

    def run(contact: Instance) -> pd.DataFrame | tuple[pd.DataFrame, xarray.Dataset]:
        taken = None if fields is False else Fields(contact, named, fields, every, times.size)
        if contact is instance:
            contact.set(**constants)
        result = follow(contact, times, columns, constants, names, report, taken)
        return result if taken is None else (result, taken.dataset(times))

    if instance is not None:
        return run(instance)
    own = Instance(fmu, "simulate", start, **given, **first)
    try:
        return run(own.start())
    finally:
        own.close()


def fmu_of(fmu: AnyPath | None, instance: Instance | None, version: str) -> AnyPath:
    """The FMU to drive: that of an instance, the given one, or the package's own of a version.

    Raises
    ------
    ValueError
        There are two.
    TypeError
        What is given is none.
    """
    if not isinstance(fmu, str | os.PathLike | None):
        raise TypeError(f"fmu = {fmu!r}: the path of an FMU is needed")
    if instance is None:
        return fmu or fmu_path(version)
    if not isinstance(instance, Instance):
        raise TypeError(f"instance = {instance!r}: an Instance is needed")
    if fmu is not None and os.path.abspath(fmu) != os.path.abspath(instance.fmu):
        raise ValueError(f"fmu = {fmu}: the instance is one of {instance.fmu} already; leave fmu out")
    return instance.fmu


def given_values(preset: str | None, parameters: Mapping[str, Any] | None, values: Mapping[str, Any]) -> dict[str, Any]:
    """Values by name: those of a preset, and before them those that are given.

    Raises
    ------
    ValueError
        A name is given twice.
    TypeError
        It is no name, or no mapping.
    """
    if preset is not None and not isinstance(preset, str):
        raise TypeError(f"preset = {preset!r}: the name of a preset is needed; its parameters go into parameters=…")
    if not isinstance(parameters, Mapping | None):
        raise TypeError(f"parameters = {parameters!r}: a mapping of names to values is needed")
    named = dict(parameters or {})
    if twice := named.keys() & values.keys():
        raise ValueError(f"given in parameters and by name: {', '.join(sorted(twice))}")
    return {**(preset_named(preset) if preset is not None else {}), **named, **values}


def without_time(outputs: str | Iterable[str] | None) -> str | Iterable[str] | None:
    """Outputs without the time, which always comes back."""
    if isinstance(outputs, str):
        outputs = (outputs,)
    return outputs if not isinstance(outputs, Iterable) else [name for name in outputs if name != "time"]
