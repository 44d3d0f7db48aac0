"""An instance of the component, step by step."""

import math
import os
from collections.abc import Sequence
from contextlib import suppress
from os import PathLike, fspath
from types import TracebackType
from typing import Any, Self

import numpy as np
from fmpy.fmi1 import FMICallException

from .access import NONE
from .archive import AnyPath, description, fmu_path, shipped
from .arguments import names_of, plain, seconds, values_of
from .errors import InstanceClosedError, SimulationError
from .native import FMU3Component, Phase, connect
from .saving import Saving
from .states import SavedState, state_of
from .variables import by_name, choices, number, unit, users

__all__ = ["Instance", "InstanceClosedError", "SimulationError"]

# What a line about an instance shows, where it has them and uses them.
SHOWN = (
    *("contact_model", "slip_source"),
    *("normal_load", "prescribed_penetration", "vertical_displacement", "contact_penetration"),
    *("vehicle_speed", "wheel_speed", "creepage"),
)
SHOWN_RUNNING = ("traction_force", "friction_coefficient", "peak_temperature")


class Instance(Saving):
    """The component step by step, or another co-simulation FMU: what a master written by hand needs.

    A call that is refused or fails changes nothing: the instance goes on from where it was. It is freed by `close`, at
    the end of a `with`, or when nobody refers to it any more. Threads may share it; their calls take turns. A forked
    process has a copy of its own. It is pickled and copied as `save` and `load` do it, with everything that it holds.

    FMPy's class below it speaks in value references and may be used beside it: `instance.slave`.

    Parameters
    ----------
    fmu
        Path of the FMU, of FMI 2.0 or 3.0; by default the package's own.
    name
        Name of the instance, in messages.
    start_time
        Time at which it starts [s].
    **start_values
        Parameters and inputs by name, in any order; choices by name or number, tables of parameters as a sequence:
        `**{"friction_table.temperature": [300.0, 400.0]}`; profiles by name, as the path of a file or a `Profile`.

    Attributes
    ----------
    time
        Time of the instance [s].
    variables
        The FMU's variables by name, as FMPy describes them.
    lengths
        Lengths of the arrays of FMI 3.0, by the name of the parameter that gives them.

    Raises
    ------
    ValueError
        An unknown name or choice, a value out of range, a file that is no FMU for co-simulation.
    TypeError
        An argument of a wrong type.
    FileNotFoundError
        The FMU is not there.
    SimulationError
        The component refuses a value beside the others, or has no library for this platform.

    Examples
    --------
    >>> with Instance(slip_source="vehicle_speed", normal_load=60e3).start() as contact:
    ...     contact.set(vehicle_speed=10.0, wheel_speed=21.8)
    ...     contact.step(1e-3)
    ...     force, torque = contact.get("traction_force", "friction_torque")
    """

    def __init__(
        self, fmu: AnyPath | None = None, name: str = "instance", start_time: float = 0.0, **start_values: Any
    ) -> None:
        """Unpack, instantiate, set parameters and inputs, and initialise."""
        start_time = seconds("start_time", start_time)
        if not isinstance(name, str):
            raise TypeError(f"name = {name!r}: a text is needed")
        if fmu is not None and not isinstance(fmu, str | PathLike):
            raise TypeError(f"fmu = {fmu!r}: the path of an FMU is needed")
        self.fmu: str = os.path.abspath(fspath(fmu_path() if fmu is None else fmu))
        self.name = name
        self.slave: Any = connect(self.fmu, name)
        self.variables = by_name(self.fmu)
        self.lengths = {
            name: int(variable.start)
            for name, variable in self.variables.items()
            if variable.causality == "structuralParameter"
        }
        self._first = start_time, dict(start_values)
        self._plans, self._bounds = {}, {}
        try:
            self._initialise()
        except BaseException:
            self.slave.free()
            raise

    # ---- its life ----------------------------------------------------------------------------------------------------

    def _initialise(self) -> None:
        """Enter the initialisation with start values."""
        time, values = self._first
        with self._calls("initialise", Phase.INSTANTIATED):
            self._set(values)
            self.slave.initialise(time)

    def start(self) -> Self:
        """Leave the initialisation: from here on, step.

        Raises
        ------
        SimulationError
            The parameters do not go together, the contact has no solution, or the instance was started before. Other
            values may be set then, and `start` called again.
        """
        with self._calls("start", Phase.INITIALISING, undo=True):
            self.slave.exitInitializationMode()
        return self

    def reset(self) -> Self:
        """Go back to before `start`, with the start values that the instance was made with.

        It leads out of every state but a closed one; saved states are kept.

        Raises
        ------
        SimulationError
            The instance is closed.
        """
        with self._calls("reset"):
            self.slave.reset()
            self._initialise()
        return self

    def close(self) -> None:
        """Terminate and free; every later call raises `InstanceClosedError`, but another `close`."""
        with self.slave.lock:
            if self.slave.gone is None:
                if self.slave.phase is Phase.RUNNING:
                    with suppress(FMICallException):
                        self.slave.terminate()
                self.slave.free()

    def __enter__(self) -> Self:
        """The instance itself, which is closed at the end."""
        with self._calls("with"):
            return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        """Close."""
        self.close()

    @property
    def time(self) -> float:
        """Time of the instance [s]; a master may take the round-off of a sum of steps out of it.

        Raises
        ------
        TypeError, ValueError
            No number, or another time than the instance's but for round-off.
        """
        return float(self.slave.time)

    @time.setter
    def time(self, time: float) -> None:
        now, given = self.time, seconds("time", time)
        if abs(given - now) > 1e-9 * max(1.0, abs(now)):
            raise ValueError(f"time = {time!r}: the instance is at t = {now:g} s, and goes on by step()")
        self.slave.time = given

    def __repr__(self) -> str:
        """What it is, how far, and its main inputs and outputs."""
        what = f"{self.name!r} of {description(self.fmu).modelName}, FMI {description(self.fmu).fmiVersion}"
        with self.slave.lock:
            if self.slave.gone is not None:
                return f"<wheelrail.Instance {what}: closed>"
            text, phase = f"{what}: {self.slave.phase.value}, t = {self.time:g} s", self.slave.phase
            shown = SHOWN + (SHOWN_RUNNING if phase is Phase.RUNNING else ())
            # FMI 2.0 has nothing to read before the initialisation, and an error to no avail would be one more.
            if phase in (Phase.INITIALISING, Phase.RUNNING):
                with suppress(SimulationError):
                    found = [name for name in shown if name in self.variables and self._is_used(name)]
                    values = zip(found, self.get(*found), strict=True)
                    text = "; ".join([text, *(self._said(name, value) for name, value in values)])
        return f"<wheelrail.Instance {text}>"

    def _is_used(self, name: str) -> bool:
        """Whether the component uses a variable under the choices that are made."""
        conditions = users(self.variables, self.variables[name], "used where|0 unless")
        return all(self.get(choice)[0] in needed.values() for choice, needed in conditions)

    def _said(self, name: str, value: float) -> str:
        """A variable with its value, as a line about the instance has it."""
        variable = self.variables[name]
        named = {chosen: choice for choice, chosen in choices(variable).items()}
        return f"{name} = {named.get(int(value)) or format(value, 'g') if named else format(value, 'g')}" + (
            f" {unit(variable)}" if unit(variable) not in ("", "1") else ""
        )

    # ---- steps -------------------------------------------------------------------------------------------------------

    def step(self, step: float) -> None:
        """Step on in time.

        Parameters
        ----------
        step
            Length of the step [s]: positive.

        Raises
        ------
        TypeError, ValueError
            No positive finite number.
        SimulationError
            Before `start`, or the contact has no solution: other inputs or a shorter step may lead on.
        """
        self.slave.check()
        step = seconds("step", step, positive=True)
        with self._calls("step", Phase.RUNNING, undo=True):
            self.slave.doStep(self.time, step)

    def follow(self, names: Sequence[str], before: Sequence[float], after: Sequence[float], step: float) -> None:
        """Step on in time, with inputs that go from one value to another.

        In FMI 2.0 the component is told their rates of change; FMI 3.0 has none, and it is told the values at the end.

        Parameters
        ----------
        names
            Names of inputs.
        before, after
            Values at the beginning and at the end of the step, one for each name.
        step
            Length of the step [s]: positive.

        Raises
        ------
        ValueError
            An unknown name or none of an input, a value out of its range, another number of values than names.
        TypeError
            An argument of a wrong type.
        SimulationError
            As `step`, or the component refuses an input.
        """
        self.slave.check()
        step = seconds("step", step, positive=True)
        listed = names_of("names", names)
        references = [self._variable(name).valueReference for name in listed]
        ends = [
            [
                self._within(name, value)
                for name, value in zip(listed, values_of(what, values, len(listed)), strict=True)
            ]
            for what, values in (("before", before), ("after", after))
        ]
        with self._calls("follow", Phase.RUNNING, undo=True):
            if isinstance(self.slave, FMU3Component):
                self.slave.setFloat64(references, ends[1])
            else:
                rates = [(then - now) / step for now, then in zip(*ends, strict=True)]
                self.slave.setReal(references, ends[0])
                self.slave.setRealInputDerivatives(references, [1] * len(rates), rates)
            self.slave.doStep(self.time, step)

    def _within(self, name: str, value: Any) -> float:
        """A value of an input, checked; quick where it is as it should be."""
        if self._fits(name, value):
            return float(value)
        variable = self._variable(name)
        if self._bounds[name] == NONE:
            raise ValueError(f"{name} is of kind {variable.causality}: a real input is needed")
        return float(number(variable, plain(name, value)))

    def steady(
        self, names: Sequence[str], step: float = 5.0, relative: float = 1e-9, absolute: float = 0.0, most: int = 50
    ) -> np.ndarray:
        """Step until variables rest, and return their values.

        Parameters
        ----------
        names
            Variables that become steady under constant inputs.
        step
            Time step [s]: long against the rail's passage through the model, so that a few of them are enough.
        relative, absolute
            Largest change over a step.
        most
            Largest number of steps.

        Returns
        -------
        numpy.ndarray
            A value for each variable.

        Raises
        ------
        ValueError, TypeError
            No names, an unknown one, a step or a tolerance that cannot be.
        SimulationError
            They do not rest: the instance is then where the last step led. Or as `step`.
        """
        self.slave.check()
        listed, step = names_of("names", names), seconds("step", step, positive=True)
        if not listed:
            raise ValueError("names: at least one variable is needed")
        if isinstance(most, bool) or not isinstance(most, int):
            raise TypeError(f"most = {most!r}: a whole number of steps is needed")
        if most < 2:
            raise ValueError(f"most = {most}: at least 2 steps are needed, to compare the second with the first")
        for what, tolerance in (("relative", relative), ("absolute", absolute)):
            if not isinstance(plain(what, tolerance), int | float) or not 0.0 <= tolerance < math.inf:
                raise ValueError(f"{what} = {tolerance!r}: a finite number of 0 or more is needed")
        before = np.array(math.nan)
        for _ in range(most):
            self.step(step)
            now = np.array(self.get(listed))
            if np.allclose(now, before, rtol=relative, atol=absolute):
                return now
            before = now
        raise SimulationError(f"not steady after {most * step:g} s")

    def derivative(self, outputs: Sequence[str], known: str) -> list[float]:
        """Partial derivatives of outputs with respect to one input, at the end of the last step.

        Parameters
        ----------
        outputs
            Names of outputs; that of an array, `contact.normal_force`, stands for its elements one after another as in
            `get`, `contact.normal_force[2]` for one of them.
        known
            Name of the input.

        Returns
        -------
        list of float
            A derivative for each output, in the output's unit over the input's.

        Raises
        ------
        ValueError
            An unknown name, one that is no output or no input.
        TypeError
            A name that is no text.
        SimulationError
            The FMU has no derivatives, or the component cannot compute them.
        """
        self.slave.check()
        unknown, places, count = self._meant(names_of("outputs", outputs))
        wanted = self._variable(known)
        for variable, causality in [*((variable, "output") for variable in unknown), (wanted, "input")]:
            if variable.causality != causality or self._kind(variable) not in ("Real", "Float64"):
                raise ValueError(
                    f"{variable.name} is of kind {variable.causality}: the name of an {causality} is needed"
                )
        if not self.slave.can_differentiate:
            raise SimulationError(f"{self.fmu} does not provide derivatives")
        arguments: list[Any] = [[variable.valueReference for variable in unknown], [wanted.valueReference], [1.0]]
        if isinstance(self.slave, FMU3Component):
            arguments.append(count)
        with self._calls("derivative", Phase.INITIALISING, Phase.RUNNING, undo=True):
            found = self.slave.getDirectionalDerivative(*arguments)
        return [found[place] for place in places]

    # ---- in another process ------------------------------------------------------------------------------------------

    @classmethod
    def load(cls, saved: SavedState | bytes | AnyPath, fmu: AnyPath | None = None, name: str = "instance") -> Self:
        """Make an instance that goes on from a saved state: of another process, or of another instance.

        Parameters
        ----------
        saved
            What `save` returned, its bytes, or the path of the file that holds them.
        fmu
            Path of the FMU, of FMI 2.0 or 3.0; by default the package's own.
        name
            Name of the instance, in messages.

        Raises
        ------
        ValueError, TypeError, OSError, SimulationError
            As `restore`, and as making an instance.
        """
        state = state_of(saved)
        contents = state._read()
        made = cls.__new__(cls)
        Instance.__init__(made, fmu, name, contents.time, **contents.parameters)
        made.restore(SavedState(contents.time, None, None, contents))
        return made

    def __reduce__(self) -> tuple[Any, ...]:
        """Pickled and copied by its state, with what a class that is derived from this one has added."""
        added = {name: value for name, value in vars(self).items() if name not in OWN}
        return loaded, (type(self), shipped(self.fmu), self.name, self._first, self.save().to_bytes()), added


OWN = ("fmu", "name", "slave", "variables", "lengths", "_first", "_plans", "_bounds")


def loaded(kind: type[Instance], fmu: str, name: str, first: tuple[float, dict[str, Any]], data: bytes) -> Instance:
    """An instance from its pickled form."""
    instance = kind.load(data, fmu_path(fmu) if fmu in ("2.0", "3.0") else fmu, name)
    instance._first = first
    return instance
