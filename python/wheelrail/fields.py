"""Fields of the contact over time, as an xarray Dataset."""

from __future__ import annotations

import math
import numbers
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from .instance import Instance
from .surface import LINE, PATCH, PLACES, formed, sizes, sources
from .variables import near, unit

if TYPE_CHECKING:
    import xarray

# Largest size of the fields of a run.
MOST_BYTES = 16 * 2**30


def needs_xarray() -> None:
    """Refuse what needs xarray, where it is not installed, before anything is computed.

    Raises
    ------
    ImportError
        With the command that installs it.
    """
    try:
        import xarray  # noqa: F401
    except ImportError as error:
        raise ImportError("fields over time are an xarray Dataset: pip install xarray") from error


class Fields:
    """Takes the fields of an instance at every so many communication points.

    Parameters
    ----------
    instance
        Instance that is initialised.
    model
        Its contact model: line, patch or profiles.
    chosen
        True for all fields, or the names of some.
    every
        Communication points from one to the next; the first and the last are always among them.
    count
        Number of communication points.

    Raises
    ------
    ValueError
        The FMU has no such fields, or they are too large.
    """

    def __init__(
        self, instance: Instance, model: str, chosen: bool | str | Iterable[str], every: int, count: int
    ) -> None:
        """Find the fields, and make room for them."""
        self.instance = instance
        self.coordinates: dict[str, tuple[str, np.ndarray]] = {}
        known: dict[str, tuple[str, tuple[str, ...]]] = {}
        for prefix, short, places in {"line": LINE, "patch": PATCH}.get(model, ()):
            for place in places:
                if self.elements(prefix + place):
                    self.coordinates[place] = (prefix + place, np.array(instance.get(*self.elements(prefix + place))))
            names = dict.fromkeys(name.partition("[")[0] for name in instance.variables if name.startswith(prefix))
            fields = [name for name in names if name.removeprefix(prefix) not in places]
            known |= {short + name.removeprefix(prefix): (name, places) for name in fields}
        self.lengths = instance.lengths if model == "profiles" else None
        # Windows follow the contacts, and their cells with them.
        self.places: dict[str, tuple[str, tuple[str, ...]]] = {}
        if model == "profiles":
            known = sources(instance.variables)
            self.places = {name: known.pop(name) for name in PLACES if name in known}
        if not known:
            raise ValueError(
                f"{instance.fmu} has no fields of the {model};"
                f" those of {'profiles' if model == 'profiles' else 'the patch'} are in the FMU of FMI 3.0,"
                " fmu=wheelrail.fmu_path('3.0')"
            )
        self.sources = {name: known[name] for name in names_of(chosen, known)} | self.places
        used = {place for _, places in self.sources.values() for place in places}
        self.coordinates = {place: found for place, found in self.coordinates.items() if place in used}
        size_of = {place: values.size for place, (_, values) in self.coordinates.items()}
        size_of |= sizes(self.lengths) if self.lengths else {}
        self.rows = {number: row for row, number in enumerate(sorted({*range(0, count, every), count - 1}))}
        shapes = {
            name: (len(self.rows), *(size_of[place] for place in places)) for name, (_, places) in self.sources.items()
        }
        size = 8 * sum(math.prod(lengths) for lengths in shapes.values())
        if size > MOST_BYTES:
            raise ValueError(
                f"fields at {len(self.rows)} times take {size / 2**30:.1f} GiB, and at most {MOST_BYTES / 2**30:.0f}"
                " are allowed; choose a larger fields_every, or fewer fields"
            )
        self.values = {name: np.empty(lengths) for name, lengths in shapes.items()}

    def elements(self, name: str) -> list[str]:
        """The variables that hold an array: itself in FMI 3.0, its points in FMI 2.0."""
        if name in self.instance.variables:
            return [name]
        return [other for other in self.instance.variables if other.partition("[")[0] == name]

    def take(self, instance: Instance, number: int) -> None:
        """Take the fields as they are now, at a communication point."""
        row = self.rows.get(number)
        if row is not None:
            for name, (source, places) in self.sources.items():
                values, taken = self.values[name], instance.get(*self.elements(source))
                if self.lengths:
                    values[row] = formed(taken, places, self.lengths)
                else:
                    values[row] = np.reshape(taken, values.shape[1:])

    def dataset(self, times: np.ndarray) -> xarray.Dataset:
        """The fields at the communication points up to now."""
        import xarray

        taken = [row for number, row in self.rows.items() if number < times.size]
        when = [number for number in self.rows if number < times.size]
        known = self.instance.variables

        def about(source: str) -> dict[str, str]:
            variable = known[self.elements(source)[0]]
            text = variable.description.split(" at point ")[0]
            return {"units": unit(variable), "long_name": text}

        coordinates: dict[str, Any] = {"time": ("time", times[when], {"units": "s", "long_name": "Time"})}
        for place, (source, values) in self.coordinates.items():
            coordinates[place] = (place, values, about(source))
        fields = {
            name: (("time", *places), self.values[name][: len(taken)], about(source))
            for name, (source, places) in self.sources.items()
        }
        coordinates |= {name: fields.pop(name) for name in self.places}
        if self.lengths:
            numbers = np.arange(1, sizes(self.lengths)["window"] + 1)
            text = "Window; those that carry come first, in the order of the contacts"
            coordinates["window"] = ("window", numbers, {"units": "1", "long_name": text})
        return xarray.Dataset(fields, coordinates)


def names_of(chosen: bool | str | Iterable[str], known: Iterable[str]) -> Sequence[str]:
    """The fields that are asked for.

    Raises
    ------
    ValueError
        There is no such field, or none is chosen.
    TypeError
        These are no names.
    """
    every = list(known)
    if chosen is True:
        return every
    names = (chosen,) if isinstance(chosen, str) else chosen
    if not isinstance(names, Iterable):
        raise TypeError(f"fields = {chosen!r}: True, a name or a list of names is needed")
    found = []
    for name in names:
        if name not in every:
            raise ValueError(f"fields: there is no field {name}{near(str(name), every)}; fields: {', '.join(every)}")
        found.append(name)
    if not found:
        raise ValueError(f"fields = {chosen!r}: none is chosen; fields: {', '.join(every)}")
    return list(dict.fromkeys(found))


def whole(name: str, value: Any) -> int:
    """A positive whole number.

    Raises
    ------
    ValueError
        It is none.
    """
    if isinstance(value, bool) or not isinstance(value, numbers.Integral) or value < 1:
        raise ValueError(f"{name} = {value!r}: a whole number of at least 1 is needed")
    return int(value)
