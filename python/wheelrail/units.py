"""Units of values that come from outside: read off headings and turned into those of the component.

What is allowed is what the model description lists for each unit, its display units: value shown = factor × value +
offset.
"""

import re
from collections.abc import Iterable, Mapping
from functools import cache
from os import fspath
from typing import Any, NamedTuple

import fmpy
import numpy as np
from fmpy.model_description import ModelDescription, ModelVariable

from .archive import PACKAGE, AnyPath, description, fmu_path

NOTHING = "1"  # the unit of a plain number
# The first letter my is the Greek one, the other the sign of the prefix.
LETTERS = str.maketrans(
    {"²": "2", "³": "3", "^": "", "·": ".", "⋅": ".", "*": ".", "u": "µ", "\u03bc": "\u00b5", "°": "deg"}
)


class Scale(NamedTuple):
    """How a value is shown: factor × value + offset."""

    name: str
    factor: float
    offset: float


class Heading(NamedTuple):
    """What a heading says: a name, and a unit where there is one."""

    name: str
    unit: str | None


def heading(text: str) -> Heading:
    """Take a heading such as `normal_load [kN]` apart.

    A number right behind a name is the index of a point, `profile.pressure[3]`, and no unit.
    """
    text = text.strip()
    found = re.fullmatch(r"(.*?\S)(\s*)\[([^\[\]]*)\]", text, re.DOTALL)
    if found is None or (not found[2] and re.fullmatch(r"[\d,]+", found[3])):
        return Heading(text, None)
    return Heading(found[1], found[3].strip())


def spelling(unit: str) -> str:
    """One spelling of a unit for all that are in use, by the rules of the command line.

    Spaces are dropped; nothing and `-` are the plain number; `²` and `³` become digits, and `^` is dropped; `·`, `⋅`
    and `*` become `.`; `u` and the Greek letter become the sign `µ`; `°` becomes `deg`; `Nm` becomes `N.m`. Capitals
    count: mN is not MN.
    """
    text = "".join(unit.split()).translate(LETTERS)
    return NOTHING if text in ("", "-", "–") else text.replace("Nm", "N.m")


def shown(unit: str) -> str:
    """A unit as text: nothing for a plain number, `°C`, `N·m`, `mm²` as they are written by hand."""
    if unit == NOTHING:
        return ""
    return re.sub(r"(?<=m)([23])", lambda power: "²³"[int(power[1]) - 2], unit.replace("degC", "°C").replace(".", "·"))


def model(fmu: AnyPath | None) -> ModelDescription:
    """Model description of an FMU: by default the package's own, or that of the repository that it runs from."""
    if fmu is not None:
        return description(fmu)
    try:
        return description(fmu_path())
    except FileNotFoundError:
        return of_repository()


@cache
def of_repository() -> ModelDescription:
    """Model description that is checked in, for a package that runs from the repository and has no FMU in it."""
    return fmpy.read_model_description(PACKAGE.parent.parent / "modelDescription", validate=False)


def scales(fmu: AnyPath | None) -> Mapping[str, Mapping[str, Scale]]:
    """For each unit of a component, the units in which its values may be given, by their spelling; itself the first."""
    return read_scales(None if fmu is None else fspath(fmu))


@cache
def read_scales(fmu: str | None) -> dict[str, dict[str, Scale]]:
    """Read the units off a model description."""
    # An FMU of FMI 2.0 need not list the unit of time, for which it has no variable.
    found: dict[str, dict[str, Scale]] = {"s": {}}
    for unit in model(fmu).unitDefinitions:
        found.setdefault(unit.name, {}).update(
            (spelling(other.name), Scale(other.name, float(other.factor), float(other.offset)))
            for other in unit.displayUnits
        )
    return {name: {spelling(name): Scale(name, 1.0, 0.0)} | others for name, others in found.items()}


def scale_of(fmu: AnyPath | None, name: str, unit: str, given: str) -> Scale:
    """How values of a variable, which has a unit, are told in a given one.

    Raises
    ------
    ValueError
        The unit is unknown, or is one of something else; what is allowed is said.
    """
    every = scales(fmu)
    here = every.get(unit, {spelling(unit): Scale(unit, 1.0, 0.0)})
    scale = here.get(spelling(given))
    if scale is not None:
        return scale
    elsewhere = any(spelling(given) in others for others in every.values())
    wrong = f"is no unit of {name}" if elsewhere else "is not known"
    allowed = ", ".join("-" if other.name == NOTHING else other.name for other in here.values())
    raise ValueError(f"{name} [{given}]: the unit {given or '-'} {wrong}; allowed is {allowed}")


def in_component_units(values: np.ndarray, scale: Scale) -> np.ndarray:
    """Values that were told in another unit, in that of the component."""
    if scale.factor == 1.0:
        return values - scale.offset if scale.offset else values
    # Of a factor such as 0.001 the inverse is the number that has no round-off.
    inverse = round(1.0 / scale.factor)
    exact = scale.factor < 1.0 and abs(inverse * scale.factor - 1.0) < 1e-15
    moved = values - scale.offset
    return moved * inverse if exact else moved / scale.factor


def in_shown_units(values: np.ndarray, scale: Scale) -> np.ndarray:
    """Values of the component, in another unit."""
    return np.asarray(scale.factor * values + scale.offset)


def said_units(attributes: Mapping[Any, Any], names: Iterable[str]) -> dict[str, str]:
    """Units that the attributes of a data frame say of its columns, as those of `read_table` and `simulate` do.

    Raises
    ------
    TypeError
        They are no mapping of names to texts.
    """
    units = attributes.get("units", {})
    if not isinstance(units, Mapping):
        raise TypeError(f"attrs['units'] = {units!r}: a mapping of columns to units is needed")
    # An empty text is what `read_table` has where no unit is known.
    said = {name: units[name] for name in names if units.get(name) not in (None, "")}
    for name, unit in said.items():
        if not isinstance(unit, str):
            raise TypeError(f"attrs['units'][{name!r}] = {unit!r}: the unit is needed as a text")
    return said


def display_unit(variable: ModelVariable) -> str:
    """Unit in which a person would read a variable."""
    declared = variable.declaredType
    units = (variable.displayUnit, declared and declared.displayUnit, variable.unit, declared and declared.unit)
    return next((unit for unit in units if unit), NOTHING)
