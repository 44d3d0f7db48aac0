"""The component's variables: what may be set and read, and how a name or a choice becomes a number."""

import difflib
import math
import numbers
import re
from collections.abc import Iterable, Mapping
from functools import cache
from os import PathLike, fspath
from typing import Any

import numpy as np
import pandas as pd
from fmpy.model_description import ModelDescription, ModelVariable

from .archive import AnyPath, description, fmu_path
from .arguments import counted, finite

# Name under which a grid of the patch is chosen.
PATCH_GRID = "patch_grid"
# The table of friction coefficients: the lists of its points, and the parameter that says how many of them are used.
FRICTION_TABLE = ("friction_table.temperature", "friction_table.coefficient")
TABLE_POINTS = "friction_table_points"
# Letters from which on a part of a name hints at it.
SHORTEST_PART = 4
# Arrays that FMI 3.0 alone has: fields of a patch and of profiles, and these profiles.
THIRD_ALONE = ("patch.", "surface.", "wheel_profile.", "rail_profile.")


def variables(fmu: AnyPath | None = None) -> pd.DataFrame:
    """Inputs, outputs and parameters of the component.

    Parameters
    ----------
    fmu
        Another FMU than the package's own.

    Returns
    -------
    pandas.DataFrame
        A row for each variable, by name: kind, unit, start, min, max, choices, description.
    """
    model = description(fmu or fmu_path())
    rows = [
        {
            "name": variable.name,
            "kind": variable.causality,
            "unit": unit(variable),
            "start": variable.start,
            "min": variable.min,
            "max": variable.max,
            "choices": ", ".join(choices(variable)),
            "description": variable.description,
        }
        for variable in model.modelVariables
        if variable.causality in ("input", "output", "parameter", "structuralParameter")
    ]
    return pd.DataFrame(rows).set_index("name")


@cache
def by_name(fmu: str) -> dict[str, ModelVariable]:
    """Variables of an FMU by name."""
    return {variable.name: variable for variable in description(fmu).modelVariables}


def unit(variable: ModelVariable) -> str:
    """Unit of a variable, an empty text where it has none."""
    declared = variable.declaredType.unit if variable.declaredType is not None else None
    return variable.unit or declared or ""


def choices(variable: ModelVariable) -> dict[str, int]:
    """Names and numbers of what a variable chooses from; empty where it is a quantity.

    FMI 3.0 has them as items of an enumeration, or off and on as a Boolean; FMI 2.0 in the description: "…: 1 constant,
    2 piecewise_linear, …".
    """
    if variable.type == "Boolean":
        return {"off": 0, "on": 1}
    if variable.type == "Enumeration" and variable.declaredType is not None:
        return {item.name: int(item.value) for item in variable.declaredType.items}
    if variable.type != "Integer" or variable.causality != "parameter":
        return {}
    low, high = int(variable.min), int(variable.max)
    # A description may go on with other numbers, in parentheses for example.
    found = {
        name: int(number)
        for number, name in re.findall(r"(?:: |, )(\d+) (\w+)", variable.description)
        if low <= int(number) <= high
    }
    return found if len(found) == high - low + 1 else {}


def users(known: Mapping[str, ModelVariable], variable: ModelVariable, words: str) -> list[tuple[str, dict[str, int]]]:
    """Choices that the use of a variable depends on, each with names and numbers of those that use it.

    The description has them behind some words, "used where" or "0 unless": "…, used where control is height; 0 unless
    contact_model is patch or profiles".
    """
    found = []
    for choice, needed in re.findall(rf"(?:{words}) (\w+) is (\w+(?: or \w+)*)", variable.description or ""):
        named = choices(known[choice]) if choice in known else {}
        if named.keys() >= set(needed.split(" or ")):
            found.append((choice, {name: named[name] for name in needed.split(" or ")}))
    return found


def near(name: str, names: Iterable[str]) -> str:
    """A hint at what may have been meant."""
    if with_unit := re.fullmatch(r"(.*\S)\s*\(([^()]*)\)", name):
        return f"; a unit stands in square brackets, {with_unit[1]} [{with_unit[2]}]"
    # A name by its letters, whatever their case; else those that it is a part of, as `load` is of `normal_load`.
    known, asked = {other.lower(): other for other in names}, name.lower()
    found = difflib.get_close_matches(asked, known, n=3, cutoff=0.6)
    if not found and len(asked) >= SHORTEST_PART:
        found = difflib.get_close_matches(asked, [other for other in known if asked in other], n=3, cutoff=0.0)
    close = [known[other] for other in found]
    return f"; did you mean {' or '.join(close)}?" if close else ""


def missing(fmu: AnyPath, name: str, names: Iterable[str]) -> str:
    """What is said of a variable that an FMU does not have."""
    prefix = next((prefix for prefix in THIRD_ALONE if name.startswith(prefix)), None)
    if prefix is not None and description(fmu).fmiVersion.startswith("2"):
        return (
            f"there is no variable {name} in FMI 2.0: that of FMI 3.0 has {prefix}*, fmu=wheelrail.fmu_path('3.0');"
            " simulate(…, fields=True) has the fields over time"
        )
    return f"there is no variable {name}{near(name, names)}"


def settable(fmu: AnyPath, name: str, causalities: tuple[str, ...]) -> ModelVariable:
    """The variable of a name that may be set.

    Raises
    ------
    ValueError
        There is no such variable, or it is not of that kind.
    """
    known = by_name(fspath(fmu))
    if name not in known:
        candidates = [other for other, variable in known.items() if variable.causality in causalities]
        # Beside the parameters there is the grid by its name, beside the columns of inputs that of the time.
        candidates += [PATCH_GRID] if "parameter" in causalities else ["time"]
        raise ValueError(missing(fmu, name, candidates))
    variable = known[name]
    if variable.causality not in causalities:
        by_name_alone = variable.causality in ("parameter", "structuralParameter") and causalities == ("input",)
        hint = f"; give it by name, {name}=…, beside the table" if by_name_alone else ""
        raise ValueError(
            f"{name} is of kind {variable.causality}: it cannot be set as {' or '.join(causalities)}{hint}"
        )
    return variable


def number(variable: ModelVariable, value: Any) -> float | int:
    """A value as the component takes it: a choice by its name or number, a quantity within its range.

    Raises
    ------
    ValueError
        It is no number, not finite, out of range, or no such choice.
    """
    name, named = variable.name, choices(variable)
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, bool | np.bool_) and set(named) == {"off", "on"}:
        value = "on" if value else "off"
    if isinstance(value, str) and value in named:
        return named[value]
    if isinstance(value, bool | np.bool_):
        raise ValueError(f"{name} = {value!r}: a number is needed")
    if isinstance(value, str) or not isinstance(value, numbers.Real) or not math.isfinite(finite(name, value)):
        expected = f"choose one of {', '.join(named)}" if named else "a finite number is needed"
        hint = near(value, named) if isinstance(value, str) else ""
        raise ValueError(f"{name} = {value!r}: {expected}{hint}")
    real, plain = variable.type in ("Real", "Float64"), finite(name, value)
    if not real and not plain.is_integer():
        raise ValueError(f"{name} = {value!r}: a whole number is needed")
    low, high = bounds(variable)
    if not low <= plain <= high:
        expected = f"choose one of {', '.join(named)}" if named else allowed(variable, low, high)
        raise ValueError(f"{name} = {value!r}: {expected}")
    return plain if real else int(plain)


def text(variable: ModelVariable, value: Any) -> str:
    """A text, or a path as one; a `Profile` by its name or a file.

    Raises
    ------
    TypeError
        It is none of them.
    ValueError
        It is blank, has a character in it that no text of C has, or is the profile of the other body.
    """
    # It imports from here.
    from .geometry import Profile

    if isinstance(value, Profile):
        body = variable.name.removesuffix("_profile")
        if value.body != body:
            raise ValueError(f"{variable.name} = {value!r}: the profile of a {body} is needed")
        return value.parameter()
    if isinstance(value, np.str_ | PathLike):
        value = fspath(value)
    if not isinstance(value, str):
        raise TypeError(f"{variable.name} = {value!r}: a text is needed")
    try:
        value.encode()
    except UnicodeEncodeError as error:
        raise ValueError(f"{variable.name} = {value!r}: {error.reason}") from None
    if not value.strip() or "\0" in value:
        raise ValueError(f"{variable.name} = {value!r}: a text that is not blank and has no zero in it is needed")
    return str(value)


def bounds(variable: ModelVariable) -> tuple[float, float]:
    """Smallest and largest value."""
    named = choices(variable)
    if named:
        return min(named.values()), max(named.values())
    return float(variable.min or -math.inf), float(variable.max or math.inf)


def allowed(variable: ModelVariable, low: float, high: float) -> str:
    """A range in words, with the unit where there is one."""
    of = f" {unit(variable)}" if unit(variable) not in ("", "1") else ""
    if math.isinf(low) and math.isinf(high):
        return f"any finite number{of} is allowed"
    if math.isinf(high):
        return f"allowed is {low:g}{of} or more"
    if math.isinf(low):
        return f"allowed is {high:g}{of} or less"
    return f"allowed is {low:g} to {high:g}{of}"


def patch_grids(fmu: AnyPath) -> dict[str, dict[str, int]]:
    """Grids of a patch by name, each as values of `patch_nodes` and `patch_strips`.

    The description of the former has them: "…: fast 8 x 8 (…), default 34 x 21 (…), …".
    """
    variable = by_name(fspath(fmu)).get("patch_nodes")
    found = re.findall(r"(?:: |, )(\w+) (\d+) x (\d+) \(", (variable and variable.description) or "")
    return {name: {"patch_nodes": int(nodes), "patch_strips": int(strips)} for name, nodes, strips in found}


def with_grid(fmu: AnyPath, given: Mapping[str, Any]) -> dict[str, Any]:
    """The same values with the cells and strips of `patch_grid` in its place.

    Raises
    ------
    ValueError
        There is no grid of this name, or its cells or strips are given as well.
    """
    values = dict(given)
    if PATCH_GRID not in values:
        return values
    name, grids = values.pop(PATCH_GRID), patch_grids(fmu)
    if not isinstance(name, str) or name not in grids:
        hint = near(name, grids) if isinstance(name, str) else ""
        expected = f"choose one of {', '.join(grids)}" if grids else "this FMU has no grids by name"
        raise ValueError(f"{PATCH_GRID} = {name!r}: {expected}{hint}")
    if twice := grids[name].keys() & values.keys():
        raise ValueError(f"{PATCH_GRID} = {name!r} sets {' and '.join(sorted(twice))}, which is given as well")
    return values | grids[name]


def start_values(fmu: AnyPath, given: Mapping[str, Any], used: int | None = None) -> dict[str, Any]:
    """Parameters and constant inputs as the component takes them.

    The points of a table may be given in one: `{"friction_table.temperature": [300.0, 400.0]}`. A text may be a path,
    that of a profile a `Profile`.
    `patch_grid` becomes the cells and strips of the grid of that name. `friction_table_points` follows the lists of the
    friction table where it is not given.

    Parameters
    ----------
    fmu
        The component.
    given
        Values by name.
    used
        Points of the friction table that are used so far; by default those that an instance starts with.

    Raises
    ------
    ValueError
        An unknown name, a value that is none, is out of range, or has too many or too few elements.
    TypeError
        A name that is no text, a value of a text that is none.
    """
    values: dict[str, Any] = {}
    known = by_name(fspath(fmu))
    kinds = ("parameter", "structuralParameter", "input")
    for name, value in with_grid(fmu, given).items():
        if not isinstance(name, str):
            raise TypeError(f"parameters: {name!r} is no name of a variable")
        if name in known and known[name].type == "String":
            values[name] = text(settable(fmu, name, kinds), value)
            continue
        elements = several(value)
        if elements is None:
            variable = settable(fmu, name, kinds)
            if variable.dimensions:
                raise ValueError(f"{name} = {value!r}: it is an array, and a list of numbers is needed")
            values[name] = number(variable, value)
            continue
        if not elements:
            raise ValueError(f"{name} = []: at least one value is needed")
        count = elements_of(known, name)
        if name in known:
            variable = settable(fmu, name, kinds)
            if not variable.dimensions:
                raise ValueError(f"{name} is a single value, not {value!r}")
            starts = variable.start.split()
            # The rest of an array stays as it is.
            values[name] = [number(variable, element) for element in elements] + [
                float(start) for start in starts[len(elements) :]
            ]
        elif count == 0:
            bases = dict.fromkeys(other.partition("[")[0] for other in known)
            raise ValueError(f"there is no variable {name}{near(name, bases)}")
        if len(elements) > count:
            raise ValueError(f"{name}: {len(elements)} values are given, it has {count} points")
        if name not in known:
            for index, element in enumerate(elements, 1):
                values[f"{name}[{index}]"] = number(settable(fmu, f"{name}[{index}]", kinds), element)
    return values | points_of_lists(known, given, used)


def elements_of(known: Mapping[str, ModelVariable], name: str) -> int:
    """How many elements an array has: as one variable in FMI 3.0, in FMI 2.0 a variable for each."""
    if name in known:
        return len(known[name].start.split()) if known[name].dimensions else 0
    return sum(other.partition("[")[0] == name for other in known)


def points_of_lists(
    known: Mapping[str, ModelVariable], given: Mapping[str, Any], used: int | None = None
) -> dict[str, int]:
    """How many points of the friction table are used, where both of its lists are given and it is not.

    A list of all points that there are, as `Instance.parameters` has it, goes with any number: what is behind is not
    used.

    Parameters
    ----------
    known
        The component's variables by name.
    given
        Values by name, each of which the component takes.
    used
        Points that are used so far; by default those that an instance starts with.

    Raises
    ------
    ValueError
        The lists differ in their lengths, or from `friction_table_points`, or one is missing.
    """
    lists = {name: several(given.get(name)) for name in FRICTION_TABLE}
    lengths = {name: len(elements) for name, elements in lists.items() if elements is not None}
    if not lengths or TABLE_POINTS not in known:
        return {}
    if len(set(lengths.values())) > 1:
        said = ", ".join(f"{name} has {counted(length, 'value')}" for name, length in lengths.items())
        raise ValueError(f"{said}: as many of each are needed, one for each point")
    name, length = next(iter(lengths.items()))
    every = elements_of(known, name)
    if TABLE_POINTS in given:
        points = number(known[TABLE_POINTS], given[TABLE_POINTS])
        if length not in (points, every):
            raise ValueError(
                f"{TABLE_POINTS} = {points}, and {name} has {counted(length, 'value')}: as many are needed; without"
                f" {TABLE_POINTS} the lists say how many points there are"
            )
        return {}
    before = int(known[TABLE_POINTS].start) if used is None else used
    if len(lengths) < len(FRICTION_TABLE):
        (other,) = set(FRICTION_TABLE) - set(lengths)
        if length not in (before, every):
            raise ValueError(
                f"{name} has {counted(length, 'value')}, and {other} is not given and has {before}: give both lists in"
                f" one call, or {TABLE_POINTS} = {length} before"
            )
        return {}
    least = int(bounds(known[TABLE_POINTS])[0])
    if length < least:
        raise ValueError(f"{name} has {length} value: {least} to {every} are needed, one for each point")
    # Also where it is the number from before: in FMI 3.0 the lists go on with all points that there are.
    return {TABLE_POINTS: length}


def several(value: Any) -> list[Any] | None:
    """The elements of a value that has several; nothing where it is a single one."""
    if isinstance(value, np.ndarray | pd.Series):
        return None if value.ndim == 0 else list(value)
    return list(value) if isinstance(value, list | tuple) else None


def shape(variable: ModelVariable, lengths: Mapping[str, int]) -> tuple[int, ...]:
    """Lengths of an array of FMI 3.0, for given values of the structural parameters; empty for a single value."""
    return tuple(
        int(dimension.start) if dimension.variable is None else lengths[dimension.variable.name]
        for dimension in variable.dimensions or ()
    )


def lengths_of(fmu: AnyPath, given: Mapping[str, Any]) -> dict[str, int]:
    """Lengths of the arrays of FMI 3.0 by the parameters that give them, for given values of some of these."""
    return {
        name: int(given.get(name, variable.start))
        for name, variable in by_name(fspath(fmu)).items()
        if variable.causality == "structuralParameter"
    }


def element_names(variable: ModelVariable, lengths: Mapping[str, int]) -> list[str]:
    """Names of the elements of an array of FMI 3.0, counted from 1; the variable's own where it is a single value."""
    places = np.ndindex(shape(variable, lengths))
    return [
        f"{variable.name}[{','.join(str(index + 1) for index in place)}]" if place else variable.name
        for place in places
    ]


def element_named(
    known: Mapping[str, ModelVariable], name: str, lengths: Mapping[str, int]
) -> tuple[ModelVariable, int] | None:
    """The array of FMI 3.0 that has an element of this name, and the place of it; nothing where none has."""
    found = re.fullmatch(r"(.+)\[([1-9]\d*(?:,[1-9]\d*)*)\]", name)
    array = known.get(found[1]) if found else None
    if found is None or array is None:
        return None
    place, sizes = [int(number) - 1 for number in found[2].split(",")], shape(array, lengths)
    if len(place) != len(sizes) or any(index >= size for index, size in zip(place, sizes, strict=True)):
        return None
    return array, int(np.ravel_multi_index(place, sizes))


def outputs_named(fmu: AnyPath, names: str | Iterable[str] | None, lengths: Mapping[str, int]) -> list[str]:
    """Names of outputs, an array's elements one by one: by default all outputs but arrays.

    Parameters
    ----------
    fmu
        The component.
    names
        Names that are asked for; that of an array, `contact.position`, stands for its elements, in either version of
        FMI.
    lengths
        Lengths of the arrays of FMI 3.0.

    Raises
    ------
    ValueError
        There is no such variable, or it is not a real one.
    TypeError
        These are no names.
    """
    known = by_name(fspath(fmu))
    if names is None:
        outputs = (
            name for name, variable in known.items() if variable.causality == "output" and not variable.dimensions
        )
        return [name for name in outputs if "[" not in name]
    if isinstance(names, str):
        names = (names,)
    if not isinstance(names, Iterable):
        raise TypeError(f"outputs = {names!r}: a name or a list of names is needed")
    # Elements of the arrays that FMI 2.0 has as variables of their own.
    points: dict[str, list[ModelVariable]] = {}
    for name, variable in known.items():
        points.setdefault(name.partition("[")[0], []).append(variable)
    chosen: dict[str, ModelVariable] = {}
    for name in names:
        if not isinstance(name, str):
            raise TypeError(f"outputs: {name!r} is no name of an output")
        found = element_named(known, name, lengths)
        if found is not None:
            chosen[name] = found[0]
            continue
        if name not in known and name not in points:
            raise ValueError(missing(fmu, name, points))
        for variable in [known[name]] if name in known else points[name]:
            chosen |= dict.fromkeys(element_names(variable, lengths), variable)
    for name, variable in chosen.items():
        if variable.type not in ("Real", "Float64"):
            what = "text" if variable.type == "String" else "number that counts or chooses"
            raise ValueError(f"{name} is a {what}, and no output")
    return list(chosen)


def units(model: ModelDescription) -> dict[str, str]:
    """Unit of each variable of a model by name."""
    return {variable.name: unit(variable) for variable in model.modelVariables}
