"""Whether a component takes given inputs: their ranges, and whether what it was told to follow uses them."""

import re
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np
from fmpy.model_description import ModelVariable

from .archive import AnyPath
from .instance import Instance
from .variables import allowed, bounds, by_name, choices, settable, unit, users

# Gives the value of a parameter under which inputs are to be judged.
Parameter = Callable[[str], float]
# Where `largest_load` follows the loads it is larger than all of them by this factor, and it follows them up to the
# load of a wheel under an axle of 40 t [N]: a larger one is more likely a slip of the pen.
HEADROOM, HEAVIEST_WHEEL = 1.05, 200e3


def with_window(fmu: AnyPath, given: Mapping[str, Any], loads: np.ndarray) -> dict[str, Any]:
    """Parameters whose contact window takes the loads that are known beforehand.

    `largest_load` sizes the window. Its start value resolves the load of a passenger coach's wheel, which a window for
    a locomotive's would do more coarsely; where it is not given and a load is above it, it follows the load.

    Parameters
    ----------
    fmu
        The component.
    given
        Parameters and constant inputs by name.
    loads
        Normal loads to come [N].

    Returns
    -------
    dict
        The same, with `largest_load` where it follows.
    """
    variable = by_name(str(fmu)).get("largest_load")
    if variable is None or "largest_load" in given or loads.size == 0:
        return dict(given)
    largest = float(loads.max())
    if not float(variable.start) < largest <= HEAVIEST_WHEEL:
        return dict(given)
    return {**given, "largest_load": HEADROOM * largest}


def parameters_of(fmu: AnyPath, given: Mapping[str, Any], instance: Instance | None) -> Parameter:
    """Values of parameters: those of an instance, or those that are given and else the start values."""
    known = by_name(str(fmu))

    def value(name: str) -> float:
        if instance is not None:
            return float(instance.get(name)[0])
        return float(given.get(name, known[name].start))

    return value


def check_inputs(
    fmu: AnyPath, columns: Mapping[str, np.ndarray], constants: Mapping[str, Any], value: Parameter
) -> None:
    """Refuse inputs out of range, and those that the chosen mode does not use.

    An input that has its start value throughout says nothing, and passes: tables with a column for every input are in
    use.

    Parameters
    ----------
    fmu
        The component.
    columns
        A table of inputs, `time` among them.
    constants
        Inputs that are constant, each within the range of its variable.
    value
        Gives the value of a parameter.

    Raises
    ------
    ValueError
        With the name of the input, its value, where in the table, what is allowed, and what to change.
    """
    time = columns["time"]
    for name, column in columns.items():
        if name == "time":
            continue
        variable = settable(fmu, name, ("input",))
        check_used(fmu, variable, bool(np.any(column != float(variable.start))), value)
        check_range(fmu, variable, column, value, time)
    for name, constant in constants.items():
        variable = settable(fmu, name, ("input",))
        check_used(fmu, variable, constant != float(variable.start), value)
        check_range(fmu, variable, np.array([constant]), value)


def check_used(fmu: AnyPath, variable: ModelVariable, says: bool, value: Parameter) -> None:
    """Refuse an input that says something where the component does not use it: its description has the choice."""
    if not says:
        return
    known = by_name(str(fmu))
    for choice, needed in users(known, variable, "used where"):
        chosen = value(choice)
        if chosen not in needed.values():
            now = next((name for name, number in choices(known[choice]).items() if number == chosen), f"{chosen:g}")
            raise ValueError(
                f"{variable.name} is given and not used: {choice} is {now!r};"
                f" choose {' or '.join(f'{choice}={name!r}' for name in needed)}, or leave {variable.name} out"
            )


def check_range(
    fmu: AnyPath, variable: ModelVariable, values: np.ndarray, value: Parameter, time: np.ndarray | None = None
) -> None:
    """Refuse values out of the range of an input, which a parameter may narrow: "at most largest_load"."""
    low, high = bounds(variable)
    hint = ""
    found = re.search(r"at most (\w+)", variable.description or "")
    if found is not None and found[1] in by_name(str(fmu)):
        narrowed = value(found[1])
        if narrowed < high:
            high, hint = narrowed, f"; {found[1]} = {narrowed:g} {unit(variable)} sets it"
    wrong = np.flatnonzero(~((values >= low) & (values <= high)))
    if wrong.size:
        row = int(wrong[0])
        place = "" if time is None else f" in row {row + 1}, at {time[row]:g} s"
        raise ValueError(f"{variable.name} = {values[row]:.12g}{place}: {allowed(variable, low, high)}{hint}")
