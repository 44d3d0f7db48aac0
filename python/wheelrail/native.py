"""An instance of an FMU behind FMPy's classes, made so that no call from Python reaches freed or shared memory.

What the standard leaves to the importer is kept here: that an instance is freed once and not used after, that one
thread at a time is in it, and in what phase of its life it is. FMPy's methods, which speak in value references, are all
there.
"""

import os
import threading
import weakref
from collections.abc import Callable
from ctypes import CFUNCTYPE, byref, c_char_p, c_int, c_void_p, cast, string_at
from enum import Enum
from typing import Any

from fmpy.fmi1 import FMICallException
from fmpy.fmi2 import FMU2Slave, defaultCallbacks, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE
from fmpy.fmi3 import FMU3Slave
from fmpy.model_description import ModelDescription

from .archive import AnyPath, description, unpacked
from .errors import InstanceClosedError, SimulationError


class Phase(Enum):
    """How far an instance is in its life."""

    INSTANTIATED = "not initialised"
    INITIALISING = "not started"
    RUNNING = "running"
    ENDED = "terminated"
    FAILED = "failed"


# Where a function that succeeds leads.
LEADS_TO = {
    "enterinitializationmode": Phase.INITIALISING,
    "exitinitializationmode": Phase.RUNNING,
    "terminate": Phase.ENDED,
    "reset": Phase.INSTANTIATED,
}
# The functions that change phase or time, by their names in each version of FMI.
NAMES = ["DoStep", "SetupExperiment", "EnterInitializationMode", "ExitInitializationMode", "Terminate", "Reset"]
NAMES += ["FreeInstance", *(f"{verb}FMU{state}" for verb in ("Get", "Set", "Free") for state in ("state", "State"))]
FOLLOWED = {f"{version}{name}": name.lower() for version in ("fmi2", "fmi3") for name in NAMES}
DISCARD, ERROR, FATAL = 2, 3, 4

# The logger of FMI 2.0 is variadic in C, which ctypes cannot declare. Where arguments are passed in registers, as on
# every platform that the FMU has a binary for, one that is declared with one more argument receives the first variadic
# one. FMPy has a native part that formats messages, with one logger for a whole process: it calls the one that it was
# told last even if that was freed since (FMPy 0.3.32), which ends the process.
LOGGER = CFUNCTYPE(None, c_void_p, c_char_p, c_int, c_char_p, c_char_p, c_void_p)


def logger_into(messages: list[str]) -> Any:
    """A logger of FMI 2.0 that keeps messages in a list."""

    def keep(_environment: int, _name: bytes, _status: int, _category: bytes, form: bytes, first: int | None) -> None:
        # Other forms than this one ask for arguments that cannot be known.
        text = string_at(first) if form == b"%s" and first else form or b""
        messages.append(text.decode(errors="replace"))

    return LOGGER(keep)


def free_once(function: Callable[[int], None], component: int, _kept: tuple[Any, ...]) -> None:
    """Free an instance; its callbacks are kept until then."""
    function(component)


# The functions of each library that was loaded, by its path.
FUNCTIONS: dict[str, dict[str, Any]] = {}


class Component:
    """What this package adds to FMPy's class of an instance.

    Attributes
    ----------
    lock
        Held during each call: ctypes lets other threads run meanwhile, and the component is for one at a time.
    messages
        What the component said, since they were cleared.
    phase
        How far the instance is.
    time
        Its communication point [s].
    """

    component: Any
    dll: Any
    _functions: dict[str, Any]
    version: str

    def __init__(self, model: ModelDescription, folder: str, name: str) -> None:
        """Load the library and instantiate."""
        self.lock = threading.RLock()
        self.messages: list[str] = []
        self.phase, self.time = Phase.INSTANTIATED, 0.0
        # Why nothing can be asked any more.
        self.gone: str | None = None
        # Phase and time of each saved state by its address; addresses of those that nobody refers to any more.
        self.states: dict[int, tuple[Phase, float]] = {}
        self.dropped: list[int] = []
        self.checkpoint: Any = None
        platform = model.coSimulation
        self.can_save = bool(platform.canGetAndSetFMUstate)
        self.can_serialise = bool(platform.canSerializeFMUstate)
        # Of FMI 3.0 FMPy does not read it (0.3.32).
        self.can_differentiate = self.version == "fmi3" or bool(platform.providesDirectionalDerivative)
        arguments = {
            "guid": model.guid,
            "unzipDirectory": folder,
            "modelIdentifier": platform.modelIdentifier,
            "instanceName": name,
        }
        # FMPy goes into the library's folder to load it, and stays there where that fails.
        with LOADING:
            before = os.getcwd()
            try:
                super().__init__(**arguments)
            except Exception as error:
                os.chdir(before)
                raise SimulationError(
                    f"{error} Platforms of the FMU: {', '.join(platforms(folder)) or 'none'}"
                ) from error
        try:
            kept = self.begin(model)
        except SimulationError:
            raise
        except Exception as error:
            raise SimulationError("; ".join(self.messages) or str(error)) from error
        free = self._functions[f"{self.version}FreeInstance"]
        self.finalizer = weakref.finalize(self, free_once, free, self.component, kept)
        # At the end of the process memory goes as a whole, and a thread may still be in a call.
        self.finalizer.atexit = False
        COMPONENTS.add(self)

    def _loadFunctions(self) -> None:  # noqa: N802
        """As FMPy's, which takes longer than all else of an instance: once for a library."""
        known = FUNCTIONS.get(self.dll._name)
        if known is None:
            super()._loadFunctions()  # type: ignore[misc]
            FUNCTIONS[self.dll._name] = self._functions
        else:
            self._functions = known

    def begin(self, model: ModelDescription) -> tuple[Any, ...]:
        """Instantiate; return what must live as long as the instance."""
        raise NotImplementedError

    def free(self) -> None:
        """Free the instance, once; every later call is refused."""
        with self.lock:
            self.gone = self.gone or "the instance is closed: make a new one"
            self.component = None
            self.states.clear()
            self.finalizer()

    def freeInstance(self) -> None:  # noqa: N802
        """As FMPy's: the library stays loaded, since another instance may be using it."""
        self.free()

    def check(self) -> None:
        """Refuse to go on where there is no instance any more."""
        if self.gone is not None:
            raise InstanceClosedError(self.gone)

    def _call(self, fname: str, *args: Any) -> Any:
        """Every call of FMPy's: one at a time, none after the end, and what it does to phase and time."""
        with self.lock:
            if self.gone is not None:
                raise InstanceClosedError(self.gone)
            function = FOLLOWED.get(fname)
            if function == "freeinstance":
                return self.free()
            # Freed, a state has no address any more.
            state = address(args[1]) if function == "freefmustate" else None
            try:
                result = super()._call(fname, *args)  # type: ignore[misc]
            except FMICallException as error:
                self.note_failure(function, error.status)
                raise
            if function is not None:
                self.note_success(function, args, state)
            return result

    def note_success(self, function: str, args: tuple[Any, ...], freed: int | None) -> None:
        """Follow phase and time."""
        if function == "dostep":
            self.time = float(args[1]) + float(args[2])
        elif function == "getfmustate":
            self.states[address(args[1]) or 0] = self.phase, self.time
            self.free_dropped()
        elif function == "setfmustate":
            # Of one that was not saved here, but made of bytes through FMPy, nothing is known.
            self.phase, self.time = self.states.get(address(args[1]) or 0, (Phase.RUNNING, self.time))
        elif function == "freefmustate":
            self.states.pop(freed or 0, None)
        else:
            if function in ("setupexperiment", "enterinitializationmode") and len(args) > 1:
                self.time = float(args[3])
            self.phase = LEADS_TO.get(function, self.phase)

    def note_failure(self, function: str | None, status: int) -> None:
        """Follow the phase: after an error little is allowed, after a fatal one nothing, not even to free."""
        if status == ERROR or (status == DISCARD and function == "dostep"):
            self.phase = Phase.FAILED
        elif status == FATAL:
            self.gone = "the component failed fatally: " + ("; ".join(self.messages) or "it says no more")
            self.finalizer.detach()

    # ---- saved states ------------------------------------------------------------------------------------------------

    def free_dropped(self) -> None:
        """Free the states that nobody refers to. Their finalisers do not, as they may run in any thread at any time."""
        while self.dropped:
            state = c_void_p(self.dropped.pop())
            if state.value in self.states:
                self.freeFMUState(state)  # type: ignore[attr-defined]

    def remember(self) -> None:
        """Keep the state of now, to go back to if a call fails; each time in the same memory."""
        if self.can_save:
            self.checkpoint = self.checkpoint or c_void_p()
            try:
                self._call(self.get_state, self.component, byref(self.checkpoint))
            except FMICallException:
                self.checkpoint = None

    def go_back(self) -> bool:
        """Go back to the state of the last `remember`; False where that cannot be."""
        if not (self.can_save and self.checkpoint):
            return False
        try:
            self.setFMUState(self.checkpoint)  # type: ignore[attr-defined]
        except FMICallException:
            return False
        return True

    get_state: str


class FMU2Component(Component, FMU2Slave):  # type: ignore[misc]
    """An instance of FMI 2.0. FMPy finds the version in the first letters of the name."""

    version, get_state = "fmi2", "fmi2GetFMUstate"

    def begin(self, model: ModelDescription) -> tuple[Any, ...]:
        """Instantiate with a logger of its own."""
        logger, callbacks = logger_into(self.messages), fmi2CallbackFunctions()
        callbacks.logger = cast(logger, fmi2CallbackLoggerTYPE)
        callbacks.allocateMemory = defaultCallbacks.allocateMemory
        callbacks.freeMemory = defaultCallbacks.freeMemory
        self.instantiate(callbacks=callbacks)
        return logger, callbacks

    def initialise(self, time: float) -> None:
        """Begin the initialisation at a time [s]."""
        self.setupExperiment(startTime=time)
        self.enterInitializationMode()


class FMU3Component(Component, FMU3Slave):  # type: ignore[misc]
    """An instance of FMI 3.0. FMPy finds the version in the first letters of the name."""

    version, get_state = "fmi3", "fmi3GetFMUState"

    def begin(self, model: ModelDescription) -> tuple[Any, ...]:
        """Instantiate with a logger, and ask for what is said of refusals."""
        messages = self.messages
        self.instantiate(logMessage=lambda _environment, _status, _category, text: messages.append(said(text)))
        # Nothing is said without; of a step that succeeds nothing need be.
        refusals = [category.name for category in model.logCategories if category.name.startswith("logStatus")]
        self.setDebugLogging(True, refusals)
        return self.logMessage, self.intermediateUpdate

    def initialise(self, time: float) -> None:
        """Begin the initialisation at a time [s]."""
        self.enterInitializationMode(startTime=time)


def connect(fmu: AnyPath, name: str) -> Component:
    """An instance of an FMU, instantiated."""
    model = description(fmu)
    kinds: dict[str, type[Component]] = {"2": FMU2Component, "3": FMU3Component}
    kind = kinds.get(model.fmiVersion[:1])
    if kind is None or model.coSimulation is None:
        raise ValueError(
            f"{fmu} is an FMU of FMI {model.fmiVersion}: one for co-simulation of FMI 2.0 or 3.0 is needed"
        )
    return kind(model, unpacked(fmu), name)


def said(text: bytes | None) -> str:
    """A message as text."""
    return (text or b"").decode(errors="replace")


def address(state: Any) -> int | None:
    """Address of a saved state, given it or a reference to it."""
    return getattr(getattr(state, "_obj", state), "value", None)


def platforms(folder: str) -> list[str]:
    """Names of the platforms that an unpacked FMU has a library for."""
    binaries = os.path.join(folder, "binaries")
    return sorted(os.listdir(binaries)) if os.path.isdir(binaries) else []


# ---- more than one thread, more than one process ---------------------------------------------------------------------

LOADING = threading.Lock()
COMPONENTS: weakref.WeakSet[Component] = weakref.WeakSet()


def after_fork() -> None:
    """In the child of a fork: it has a copy of each instance, which is whole unless another thread was in a call."""
    global LOADING
    LOADING = threading.Lock()
    for component in list(COMPONENTS):
        if not component.lock.acquire(blocking=False):
            component.gone = "the process was forked while another thread was in a call of the instance: make a new one"
            component.finalizer.detach()
        component.lock = threading.RLock()


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=after_fork)
