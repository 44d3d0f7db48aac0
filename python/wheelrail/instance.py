"""An instance of the component, its variables by name."""

import itertools
import math
from collections.abc import Iterator, Sequence
from contextlib import contextmanager, suppress
from ctypes import byref
from os import fspath
from pathlib import Path
from typing import Any, Self

import fmpy.logging
import numpy as np
from fmpy.fmi1 import FMICallException, printLogMessage
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import ModelVariable

from .archive import AnyPath, description, fmu_path, unpacked
from .variables import by_name, near, number, shape


class SimulationError(RuntimeError):
    """The component refused a value or could not complete a step: its own words.

    Attributes
    ----------
    table
        The rows of a simulation up to there, or None.
    """

    table: Any = None


# ---- what the component says ----------------------------------------------------------------------------------------

# Messages of each instance, by the environment that it was given.
MESSAGES: dict[int, list[str]] = {}
ENVIRONMENTS = itertools.count(1)


def _keep(environment: int | None, name: bytes, status: int, category: bytes, message: bytes) -> None:
    kept = MESSAGES.get(environment or 0)
    if kept is None:
        printLogMessage(environment, name, status, category, message)
    else:
        kept.append(message.decode(errors="replace"))


# Never freed: FMPy's native part, which puts numbers into messages, goes on with the logger that it was told last, also
# for instances that others make in this process.
LOGGER = fmi2CallbackLoggerTYPE(_keep)


def connect(fmu: AnyPath, name: str) -> tuple[Any, list[str]]:
    """FMPy's instance of an FMU, instantiated, and the list that takes its messages."""
    if not Path(fmu).exists():
        raise FileNotFoundError(f"{fmu} is not there")
    model = description(fmu)
    arguments = {
        "guid": model.guid,
        "unzipDirectory": unpacked(fmu),
        "modelIdentifier": model.coSimulation.modelIdentifier,
        "instanceName": name,
    }
    messages: list[str] = []
    if not model.fmiVersion.startswith("2."):
        slave = FMU3Slave(**arguments)
        slave.instantiate(logMessage=lambda _environment, _status, _category, text: messages.append(text.decode()))
        # Nothing is said without; of a step that succeeds nothing need be.
        refusals = [category.name for category in model.logCategories if category.name.startswith("logStatus")]
        slave.setDebugLogging(True, refusals)
        return slave, messages
    slave = FMU2Slave(**arguments)
    callbacks = fmi2CallbackFunctions()
    callbacks.logger = LOGGER
    callbacks.componentEnvironment = next(ENVIRONMENTS)
    MESSAGES[callbacks.componentEnvironment] = messages
    fmpy.logging.addLoggerProxy(byref(callbacks))
    slave.instantiate(callbacks=callbacks)
    # Both live as long as the instance, which calls them.
    slave.wheelrail_callbacks = callbacks
    return slave, messages


def disconnect(slave: Any) -> None:
    """Free FMPy's instance. The library stays loaded: another instance may be using it."""
    if isinstance(slave, FMU3Slave):
        slave.fmi3FreeInstance(slave.component)
    else:
        slave.fmi2FreeInstance(slave.component)
        MESSAGES.pop(slave.wheelrail_callbacks.componentEnvironment, None)


@contextmanager
def reported(messages: list[str]) -> Iterator[None]:
    """Turn a failed call into what the component said about it."""
    messages.clear()
    try:
        yield
    except FMICallException as error:
        raise SimulationError("; ".join(messages) or str(error)) from error


# ---- an instance ----------------------------------------------------------------------------------------------------


class Instance:
    """The component step by step, or another co-simulation FMU: what a master written by hand needs.

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
        Parameters and inputs by name; choices by name or number.

    Examples
    --------
    >>> contact = Instance(slip_source="vehicle_speed", normal_load=60e3).start()
    >>> contact.set(vehicle_speed=10.0, wheel_speed=21.8)
    >>> contact.step(1e-3)
    >>> force, torque = contact.get("traction_force", "friction_torque")
    >>> contact.close()
    """

    def __init__(
        self, fmu: AnyPath | None = None, name: str = "instance", start_time: float = 0.0, **start_values: Any
    ) -> None:
        """Unpack, instantiate, set parameters and inputs, and initialise."""
        self.fmu = fspath(fmu or fmu_path())
        self.slave, self.messages = connect(self.fmu, name)
        self.variables = by_name(self.fmu)
        self.time = start_time
        # Lengths of arrays.
        self.lengths = {
            name: int(variable.start)
            for name, variable in self.variables.items()
            if variable.causality == "structuralParameter"
        }
        try:
            self._initialise(start_values)
        except (SimulationError, ValueError):
            disconnect(self.slave)
            raise

    def _initialise(self, start_values: dict[str, Any]) -> None:
        """Enter the initialisation with start values."""
        third = isinstance(self.slave, FMU3Slave)
        if not third:
            self.slave.setupExperiment(startTime=self.time)
        self.set(**start_values)
        with reported(self.messages):
            self.slave.enterInitializationMode(**({"startTime": self.time} if third else {}))

    def start(self) -> Self:
        """Leave the initialisation: from here on, step."""
        with reported(self.messages):
            self.slave.exitInitializationMode()
        return self

    def set(self, **values: Any) -> None:
        """Set variables; choices by name or number, arrays of FMI 3.0 as a sequence."""
        with reported(self.messages):
            for name, value in values.items():
                variable = self._variable(name)
                plain: Any = number(variable, value) if isinstance(value, str) else value
                kind = "Int64" if variable.type == "Enumeration" else variable.type
                set_values = getattr(self.slave, f"set{kind}")
                if name in self.lengths:
                    self.slave.enterConfigurationMode()
                    set_values([variable.valueReference], [plain])
                    self.slave.exitConfigurationMode()
                    self.lengths[name] = int(plain)
                else:
                    set_values([variable.valueReference], list(plain) if variable.dimensions else [plain])

    def get(self, *names: str) -> list[float]:
        """Return the values of real variables, those of an array of FMI 3.0 one after another."""
        variables = [self._variable(name) for name in names]
        references = [variable.valueReference for variable in variables]
        with reported(self.messages):
            if isinstance(self.slave, FMU3Slave):
                count = sum(math.prod(shape(variable, self.lengths)) for variable in variables)
                return list(self.slave.getFloat64(references, count))
            return list(self.slave.getReal(references))

    def fields(self) -> dict[str, np.ndarray]:
        """Fields of the patch as they are now, each as an array of strips by cells: FMI 3.0 alone has them.

        They are what `plots.patch_fields` draws: places `x`, `y` [m], `pressure`, `shear_x`, `shear_y` [Pa], `slip_x`,
        `slip_y` [m/s], `temperature` [K], `wear_depth` [m].
        """
        names = [name for name in self.variables if name.startswith("patch.")]
        if not names:
            raise ValueError(f"{self.fmu} has no fields of the patch: take the FMU of FMI 3.0")
        found = {
            name.removeprefix("patch."): np.reshape(self.get(name), shape(self.variables[name], self.lengths))
            for name in names
        }
        x, y = np.meshgrid(found.pop("x"), found.pop("y"))
        return {"x": x, "y": y, **found}

    def step(self, step: float) -> None:
        """Step on in time [s]."""
        with reported(self.messages):
            self.slave.doStep(self.time, step)
        self.time += step

    def follow(self, names: Sequence[str], before: Sequence[float], after: Sequence[float], step: float) -> None:
        """Step on in time, with inputs that go from one value to another.

        In FMI 2.0 the component is told their rates of change; FMI 3.0 has none, and it is told the values at the end.
        """
        references = [self._variable(name).valueReference for name in names]
        with reported(self.messages):
            if isinstance(self.slave, FMU3Slave):
                self.slave.setFloat64(references, after)
            else:
                rates = [(then - now) / step for now, then in zip(before, after, strict=True)]
                self.slave.setReal(references, before)
                self.slave.setRealInputDerivatives(references, [1] * len(rates), rates)
            self.slave.doStep(self.time, step)
        self.time += step

    def steady(
        self, names: Sequence[str], step: float = 5.0, relative: float = 1e-9, absolute: float = 0.0, most: int = 50
    ) -> np.ndarray:
        """Step until variables rest, and return their values.

        Parameters
        ----------
        names
            Real variables that become steady under constant inputs.
        step
            Time step [s]: long against the rail's passage through the model, so that a few of them are enough.
        relative, absolute
            Largest change over a step.
        most
            Largest number of steps.

        Raises
        ------
        SimulationError
            They do not rest.
        """
        before = np.full(len(names), np.nan)
        for _ in range(most):
            self.step(step)
            now = np.array(self.get(*names))
            if np.allclose(now, before, rtol=relative, atol=absolute):
                return now
            before = now
        raise SimulationError(f"not steady after {most * step:g} s")

    def derivative(self, outputs: Sequence[str], known: str) -> list[float]:
        """Partial derivatives of outputs with respect to one input."""
        unknown = [self._variable(name).valueReference for name in outputs]
        with reported(self.messages):
            return list(self.slave.getDirectionalDerivative(unknown, [self._variable(known).valueReference], [1.0]))

    def save(self) -> tuple[Any, float]:
        """Return the state as it is now."""
        return self.slave.getFMUState(), self.time

    def restore(self, saved: tuple[Any, float]) -> None:
        """Go back to a saved state, which is kept."""
        self.slave.setFMUState(saved[0])
        self.time = saved[1]

    def forget(self, saved: tuple[Any, float]) -> None:
        """Free a saved state."""
        self.slave.freeFMUState(saved[0])

    def close(self) -> None:
        """Terminate and free."""
        # After an error there is nothing to terminate.
        with suppress(FMICallException):
            self.slave.terminate()
        disconnect(self.slave)

    def _variable(self, name: str) -> ModelVariable:
        """A variable by name."""
        try:
            return self.variables[name]
        except KeyError:
            raise ValueError(f"there is no variable {name}{near(name, self.variables)}") from None
