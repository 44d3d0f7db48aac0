"""What is asked of arguments before the component sees them."""

import math
import numbers
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np


def seconds(what: str, value: Any, positive: bool = False) -> float:
    """A time as a number.

    Raises
    ------
    TypeError
        It is no number.
    ValueError
        It is not finite, or not positive where it must be.
    """
    if type(value) is float and 0.0 < value < math.inf:
        return value
    needed = f"a {'positive ' if positive else ''}finite number of seconds is needed"
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool | np.bool_) or not isinstance(value, numbers.Real):
        raise TypeError(f"{what} = {value!r}: {needed}")
    number = finite(what, value)
    if not math.isfinite(number) or (positive and number <= 0.0):
        raise ValueError(f"{what} = {value!r}: {needed}")
    return number


def finite(what: str, value: Any) -> float:
    """A real number as a float, infinite where it was."""
    try:
        return float(value)
    except OverflowError:
        raise ValueError(f"{what}: the number is too large") from None


def counted(count: int, noun: str) -> str:
    """A number of things: "1 value", "2 values"."""
    return f"{count} {noun}" if count == 1 else f"{count} {noun}s"


def names_of(what: str, names: Any) -> list[str]:
    """Names of variables, of which one may stand alone.

    Raises
    ------
    TypeError
        It is something else than texts.
    """
    if type(names) in (tuple, list) and all(type(name) is str for name in names):
        return list(names)
    listed = [names] if isinstance(names, str) else names
    if isinstance(listed, Mapping | bytes) or not isinstance(listed, Iterable):
        raise TypeError(f"{what} = {names!r}: names of variables are needed")
    found = list(listed)
    for name in found:
        if not isinstance(name, str):
            raise TypeError(f"{what}: the name of a variable is a text, not {name!r}")
    return found


def plain(name: str, value: Any) -> Any:
    """A value as a number, a text, or a list of these.

    Raises
    ------
    TypeError
        It is none of them.
    ValueError
        It is an integer too large for a number of the component.
    """
    if isinstance(value, np.ndarray | np.generic):
        value = value.tolist()
    if isinstance(value, str | numbers.Real):
        return scalar(name, value)
    if isinstance(value, Mapping | bytes | set) or not isinstance(value, Iterable):
        raise TypeError(f"{name} = {value!r}: a number, the name of a choice, or a sequence of numbers is needed")
    return [scalar(name, element) for element in value]


def scalar(name: str, value: Any) -> Any:
    """A number or a text as it is, one of numpy as Python's."""
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, numbers.Real):
        finite(name, value)
    elif not isinstance(value, str):
        raise TypeError(f"{name}: {value!r} is no number")
    return value


def values_of(what: str, values: Any, count: int) -> Sequence[float]:
    """Numbers, one for each of so many names.

    Raises
    ------
    TypeError
        It is no sequence.
    ValueError
        It has another length.
    """
    if isinstance(values, str | bytes | Mapping) or not isinstance(values, Iterable):
        raise TypeError(f"{what} = {values!r}: a sequence of numbers is needed")
    found = list(values)
    if len(found) != count:
        raise ValueError(f"{what} has {counted(len(found), 'value')} for {counted(count, 'name')}")
    return found
