"""What an instance is told and asked: variables by name, and calls that are refused before they can do harm."""

import math
from collections.abc import Mapping, Sequence
from itertools import groupby
from pathlib import Path
from types import TracebackType
from typing import Any, TypeAlias

import numpy as np
from fmpy.fmi1 import FMICallException
from fmpy.model_description import ModelVariable

from .arguments import names_of, plain
from .errors import SimulationError, warn
from .geometry import is_given, is_inclined
from .native import FMU3Component, Phase
from .surface import LINE, formed, sources
from .variables import (
    FRICTION_TABLE,
    PATCH_GRID,
    TABLE_POINTS,
    bounds,
    choices,
    element_named,
    missing,
    shape,
    start_values,
    with_grid,
)
from .wear import ProfileWear, WornProfiles, new_profile

# Why a call cannot be, and what can.
WAY_OUT = {
    Phase.INSTANTIATED: "the instance is not initialised: reset() it",
    Phase.INITIALISING: "call start() first",
    Phase.RUNNING: "the instance was started before: go on with set() and step(), or begin anew with reset()",
    Phase.ENDED: "the instance was terminated: restore() a saved state, reset() it, or make a new one",
    Phase.FAILED: "a call before has failed: restore() a saved state, reset() the instance, or make a new one",
}


# Parameters that say which profiles there are, and what is done to them.
SHAPING = {"rail_profile", "wheel_profile", "profile_smoothing", "rail_inclination"}

# Bounds that nothing lies between.
NONE = (math.inf, -math.inf)

# The calls that read variables, each with its arguments, and the places of what is asked for among the values that they
# return; none where that is all of them in their order.
Plan: TypeAlias = tuple[list[tuple[str, list[Any]]], list[int] | None]


class Calls:
    """Calls of the component that belong together, as a context: a class, as it stands around each step."""

    __slots__ = ("phases", "slave", "undo", "what")

    def __init__(self, slave: Any, what: str, phases: tuple[Phase, ...], undo: bool) -> None:
        """Of an instance, in the name of one of its methods."""
        self.slave, self.what, self.phases, self.undo = slave, what, phases, undo

    def __enter__(self) -> None:
        """Wait for the calls of other threads, and see whether these can be."""
        slave = self.slave
        slave.lock.acquire()
        try:
            slave.check()
            if self.phases and slave.phase not in self.phases:
                raise SimulationError(f"{self.what}(): {WAY_OUT[slave.phase]}")
            if self.undo:
                slave.remember()
            slave.messages.clear()
        except BaseException:
            slave.lock.release()
            raise

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Undo what failed, and say it in the component's words; warn of what it says of a call that did not fail."""
        slave = self.slave
        try:
            if error is None:
                for words in slave.messages:
                    warn(words)
                return
            words, failed = "; ".join(slave.messages), slave.phase is Phase.FAILED
            back = self.undo and slave.gone is None and slave.go_back()
            if isinstance(error, FMICallException):
                after = WAY_OUT[Phase.FAILED]
                if back:
                    after = f"the instance is as it was before {self.what}(), at t = {slave.time:g} s"
                raise SimulationError((words or str(error)) + (f"; {after}" if failed else "")) from error
        finally:
            slave.lock.release()


class Access:
    """The variables of an instance, and the way into every call."""

    fmu: str
    name: str
    slave: Any
    variables: Mapping[str, ModelVariable]
    lengths: dict[str, int]
    # How groups of variables are read.
    _plans: dict[tuple[str, ...], Plan]
    # Between what values real inputs lie; other variables between none.
    _bounds: dict[str, tuple[float, float]]

    # ---- calls -------------------------------------------------------------------------------------------------------

    def _calls(self, what: str, *phases: Phase, undo: bool = False) -> "Calls":
        """Calls of the component as one: in some phases only, by one thread, and on request undone where they fail."""
        return Calls(self.slave, what, phases, undo)

    def _kind(self, variable: ModelVariable) -> str:
        """The type in the names of the functions that read and set a variable."""
        third = isinstance(self.slave, FMU3Component)
        kinds: dict[str, str] = {"Enumeration": "Int64" if third else "Integer"}
        return kinds.get(variable.type, str(variable.type))

    def _variable(self, name: Any, settable: bool = False) -> ModelVariable:
        """A variable by name; where it is to be set, a table of parameters by its first element."""
        if not isinstance(name, str):
            raise TypeError(f"the name of a variable is a text, not {name!r}")
        variable = self.variables.get(name) or (self.variables.get(f"{name}[1]") if settable else None)
        if variable is None:
            raise ValueError(missing(self.fmu, name, self.variables))
        return variable

    # ---- values ------------------------------------------------------------------------------------------------------

    def set(self, **values: Any) -> None:
        """Set variables, all or none; in any order, though one may limit another.

        Parameters
        ----------
        **values
            Inputs, and parameters: before `start` all but the lengths of arrays of FMI 3.0, from then on those that are
            tunable. Choices by name or number, arrays as a sequence, texts as a text or a path, profiles as a
            `Profile`, too.

        Raises
        ------
        ValueError
            An unknown name or choice, a value out of its range, a variable that cannot be set, or not any more.
        TypeError
            A value that is no number, or no text where one is needed.
        SimulationError
            The component refuses a value beside the others, a load above `largest_load` for example.
        """
        slave = self.slave
        slave.check()
        with self._calls("set", Phase.INITIALISING, Phase.RUNNING, undo=slave.phase is Phase.INITIALISING):
            if all(self._fits(name, value) for name, value in values.items()):
                references = [self.variables[name].valueReference for name in values]
                (slave.setFloat64 if slave.version == "fmi3" else slave.setReal)(references, list(values.values()))
            else:
                self._set(values)

    def _set(self, values: Mapping[str, Any]) -> None:
        """Set variables: lengths of arrays first, then choices and counts, at last all quantities in one call."""
        given = {
            name: value if self._variable(name, True).type == "String" else plain(name, value)
            for name, value in with_grid(self.fmu, values).items()
        }
        calls: dict[str, tuple[list[int], list[Any]]] = {}
        lengths = {}
        used = None
        if self.slave.phase is not Phase.INSTANTIATED and any(name in given for name in FRICTION_TABLE):
            used = self._count(TABLE_POINTS)
        values = start_values(self.fmu, given, used)
        self._check_profiles(values)
        for name, value in values.items():
            variable = self.variables[name]
            self._check_settable(variable)
            elements = value if isinstance(value, list) else [value]
            if len(elements) != math.prod(shape(variable, self.lengths)):
                raise ValueError(f"{name}: {math.prod(shape(variable, self.lengths))} elements, not {len(elements)}")
            if name in self.lengths:
                lengths[name] = variable.valueReference, int(value)
                continue
            references, numbers = calls.setdefault(self._kind(variable), ([], []))
            references.append(variable.valueReference)
            numbers.extend(elements)
        if lengths:
            self.slave.enterConfigurationMode()
            for name, (reference, length) in lengths.items():
                self.slave.setUInt64([reference], [length])
                self.lengths[name] = length
            self.slave.exitConfigurationMode()
        for kind in sorted(calls, key=lambda kind: kind in ("Real", "Float64")):
            getattr(self.slave, f"set{kind}")(*calls[kind])

    def _check_profiles(self, values: Mapping[str, Any]) -> None:
        """Refuse what would smooth or incline once more what is given as a `Profile`."""
        if not values.keys() & SHAPING or not self.variables.keys() >= SHAPING:
            return
        before = {} if self.slave.phase is Phase.INSTANTIATED else self.parameters()
        now = {name: values.get(name, before.get(name, self.variables[name].start)) for name in SHAPING}
        smoothing, inclination = float(now["profile_smoothing"]), float(now["rail_inclination"])
        for name in ("rail_profile", "wheel_profile"):
            if is_given(now[name]) and smoothing != 0.0:
                raise ValueError(
                    f"profile_smoothing = {smoothing:g}: {name} is a Profile, which is smoothed when it is made; one in"
                    " a file goes beside it as a Profile with smoothing=…"
                )
        if is_inclined(now["rail_profile"]) and inclination != 0.0:
            raise ValueError(
                f"rail_inclination = {inclination:g}: rail_profile is a Profile that is inclined already;"
                " rail_inclination=0 leaves it so"
            )

    def _count(self, name: str) -> int:
        """A count as it is, within a call."""
        ((getter, arguments),), _ = self._plan((name,))
        return int(getattr(self.slave, getter)(*arguments)[0])

    def _fits(self, name: str, value: Any) -> bool:
        """Whether a value is surely one of a real input: the quick way for those that are set before each step."""
        bounds_of = self._bounds.get(name)
        if bounds_of is None:
            if name == PATCH_GRID:
                return False
            variable = self._variable(name, True)
            real = variable.type in ("Real", "Float64") and variable.causality == "input" and not variable.dimensions
            bounds_of = self._bounds[name] = bounds(variable) if real else NONE
        return type(value) is float and bounds_of[0] <= value <= bounds_of[1] and math.isfinite(value)

    def _check_settable(self, variable: ModelVariable) -> None:
        """Refuse what can be set before `start` alone."""
        name, phase = variable.name, self.slave.phase
        if variable.causality == "structuralParameter" and phase is not Phase.INSTANTIATED:
            raise ValueError(f"{name} is the length of arrays: give it where the instance is made")
        if phase is Phase.RUNNING and variable.causality == "parameter" and variable.variability != "tunable":
            raise ValueError(
                f"{name} is fixed from start() on: give it where the instance is made, or set() it after reset();"
                " inputs and tunable parameters may be set now"
            )

    def get(self, *names: str | Sequence[str]) -> list[float]:
        """Return the values of variables.

        Parameters
        ----------
        *names
            Names, or one sequence of them; that of an array, `profile.pressure` for example, stands for its elements
            one after another, `profile.pressure[2]` for one of them.

        Returns
        -------
        list of float
            Quantities in the units of `variables`; choices and counts as numbers.

        Raises
        ------
        ValueError
            An unknown name, or a variable that is no number.
        TypeError
            A name that is no text.
        SimulationError
            There are no outputs: before `start`, of parameters that do not go together.
        """
        self.slave.check()
        single = len(names) == 1 and not isinstance(names[0], str)
        asked = tuple(names_of("get()", names[0] if single else names))
        before = self.slave.phase is Phase.INITIALISING
        with self._calls("get", Phase.INITIALISING, Phase.RUNNING, Phase.ENDED, Phase.FAILED, undo=before):
            calls, places = self._plans.get(asked) or self._plan(asked)
            values = [value for getter, arguments in calls for value in getattr(self.slave, getter)(*arguments)]
            return values if places is None else [values[place] for place in places]

    def _plan(self, names: tuple[str, ...]) -> Plan:
        """The calls that read variables, and what of their values is meant; kept for the next time."""
        variables, places, count = self._meant(names)
        calls = []
        for kind, together in groupby(variables, key=self._kind):
            group = list(together)
            if kind in ("String", "Binary", "Clock"):
                where = "; parameters() has it" if group[0].causality == "parameter" else ""
                raise ValueError(f"{group[0].name} is no number, but of the type {kind}{where}")
            arguments: list[Any] = [[variable.valueReference for variable in group]]
            if isinstance(self.slave, FMU3Component):
                arguments.append(sum(math.prod(shape(variable, self.lengths)) for variable in group))
            calls.append((f"get{kind}", arguments))
        if len(self._plans) > 100:
            self._plans.clear()
        plan = self._plans[names] = calls, None if places == list(range(count)) else places
        return plan

    def _elements(self, name: str) -> list[ModelVariable]:
        """The variable of a name, or in FMI 2.0 the elements of what is an array in FMI 3.0."""
        if name in self.variables:
            return [self.variables[name]]
        elements = [variable for other, variable in self.variables.items() if other.startswith(f"{name}[")]
        return elements or [self._variable(name)]

    def _meant(self, names: Sequence[str]) -> tuple[list[ModelVariable], list[int], int]:
        """What names mean: variables to read, each once; the places among their values; how many values these are."""
        begins: dict[str, int] = {}
        variables: list[ModelVariable] = []
        places: list[int] = []
        count = 0
        for name in names:
            element = None if name in self.variables else element_named(self.variables, name, self.lengths)
            for variable in self._elements(name) if element is None else [element[0]]:
                width = math.prod(shape(variable, self.lengths))
                if variable.name not in begins:
                    begins[variable.name] = count
                    variables.append(variable)
                    count += width
                place = begins[variable.name]
                places += range(place, place + width) if element is None else [place + element[1]]
        return variables, places, count

    def parameters(self) -> dict[str, Any]:
        """Parameters as they are, choices by name and texts: what an instance like this one is made with.

        Raises
        ------
        SimulationError
            The instance is closed.
        """
        found: dict[str, Any] = {}
        named = [
            variable
            for variable in self.variables.values()
            if variable.causality in ("parameter", "structuralParameter")
        ]
        with self._calls("parameters"):
            for variable in named:
                if variable.type == "String":
                    found[variable.name] = self._text(variable)
                    continue
                values = self.get(variable.name)
                texts = {chosen: choice for choice, chosen in choices(variable).items()}
                plain_values = [texts.get(int(value), value) if texts else value for value in values]
                array = variable.name.partition("[")[0]
                if variable.dimensions or array != variable.name:
                    found.setdefault(array, []).extend(plain_values)
                else:
                    found[variable.name] = plain_values[0]
        return found

    def _text(self, variable: ModelVariable) -> str:
        """The value of a text."""
        phases = Phase.INITIALISING, Phase.RUNNING, Phase.ENDED, Phase.FAILED
        with self._calls("get", *phases):
            (value,) = self.slave.getString([variable.valueReference])
        return value.decode() if isinstance(value, bytes) else str(value)

    def profile_wear(self) -> ProfileWear:
        """Depths by which the profiles of wheel and rail are worn, as they are now: FMI 3.0 alone has them.

        Returns
        -------
        ProfileWear
            Arrays with an element for each of `profile_wear_points` places [m].

        Raises
        ------
        ValueError
            An FMU of FMI 2.0, or another contact model than profiles.
        SimulationError
            As `get`.
        """
        self.slave.check()
        if "wheel_profile.wear_depth" not in self.variables:
            raise ValueError(f"{self.fmu} does not say how its profiles are worn: take the FMU of FMI 3.0")
        with self._calls("profile_wear"):
            if self.get("contact_model") != [choices(self.variables["contact_model"])["profiles"]]:
                raise ValueError("there are no profiles that wear: they are those of contact_model = 'profiles'")
            names = {"position": "position", "depth": "wear_depth", "arc_length": "arc_length"}
            return ProfileWear(
                **{
                    f"{body}_{own}": np.array(self.get(f"{body}_profile.{name}"))
                    for body in ("wheel", "rail")
                    for own, name in names.items()
                }
            )

    def worn_profiles(self) -> WornProfiles:
        """Profiles of wheel and rail as they are worn now, to be measured and written: FMI 3.0 alone has them.

        Raises
        ------
        ValueError
            As `profile_wear`; a profile that is worn beyond its radius of curvature.
        SimulationError
            As `get`.
        """
        wear, given = self.profile_wear(), self.parameters()
        resources = Path(self.slave.unzipDirectory) / "resources"
        smoothing = float(given["profile_smoothing"])
        wheel, rail = (new_profile(given[f"{body}_profile"], body, smoothing, resources) for body in ("wheel", "rail"))
        return WornProfiles(
            wheel=wheel.worn_by(wear.wheel_arc_length, wear.wheel_depth),
            rail=rail.worn_by(wear.rail_arc_length, wear.rail_depth),
        )

    def fields(self) -> dict[str, np.ndarray]:
        """Fields of the contact as they are now; those of a patch and of profiles FMI 3.0 alone has.

        Those of a patch are what `plots.patch_fields` draws, those of profiles what `plots.surface_fields` does.

        Returns
        -------
        dict of numpy.ndarray
            Of a line: places `x` [m], `pressure`, `shear` [Pa], `slip` [m/s], `temperature` [K], `wear_depth` [m];
            into the depth below the hottest point `z` [m], `depth_temperature` [K]. Of a patch, as arrays of strips by
            cells: places `x`, `y` [m], `pressure`, `shear_x`, `shear_y` [Pa], `slip_x`, `slip_y` [m/s], `temperature`
            [K], `wear_depth` [m]. Of profiles, as arrays of windows by strips by cells, the contacts in their order
            first: `pressure`, `shear_x`, `shear_s` [Pa], `slip_x`, `slip_s` [m/s], `friction_coefficient` [1],
            `temperature` [K], `wear_depth` [m]; places `x` of windows by cells, `arc_length`, `y`, `z` [m],
            `inclination` [rad] of windows by strips; sizes of the cells `cell_length`,
            `strip_breadth` [m], 0 of a window that there is not; both profiles in the track `wheel_y`, `wheel_z`,
            `rail_y`, `rail_z` [m].

        Raises
        ------
        ValueError
            The FMU has none: of FMI 2.0, where the contact is a patch or one of profiles.
        SimulationError
            As `get`.
        """
        self.slave.check()
        names = [name for name, variable in self.variables.items() if name.startswith("patch.") and variable.dimensions]
        with self._calls("fields"):
            models = choices(self._variable("contact_model"))
            model = self.get("contact_model")
            if model == [models["line"]]:
                return self._line_fields()
            if not names:
                raise ValueError(f"{self.fmu} has no fields of patch and profiles: take the FMU of FMI 3.0")
            own = sources(self.variables)
            if own and model == [models["profiles"]]:
                return {short: formed(self.get(name), over, self.lengths) for short, (name, over) in own.items()}
            found = {
                name.removeprefix("patch."): np.reshape(self.get(name), shape(self.variables[name], self.lengths))
                for name in names
            }
        x, y = np.meshgrid(found.pop("x"), found.pop("y"))
        return {"x": x, "y": y, **found}

    def _line_fields(self) -> dict[str, np.ndarray]:
        """Fields of a line, with the places along it and into the depth."""
        found = {}
        for name in dict.fromkeys(name.partition("[")[0] for name in self.variables):
            for prefix, short, places in LINE:
                if name.startswith(prefix):
                    own = name.removeprefix(prefix)
                    found[own if own in places else short + own] = np.array(self.get(name))
        return found
