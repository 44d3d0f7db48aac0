"""Saving and restoring an instance."""

from typing import Any

from .access import Access
from .archive import AnyPath, description
from .errors import SimulationError
from .states import Contents, SavedState, state_of


class Saving(Access):
    """Saved states of an instance."""

    def save(self) -> SavedState:
        """Return the state as it is now, to go back to, or to take along as bytes or in a file.

        Raises
        ------
        SimulationError
            The FMU cannot save its state.
        """
        with self._calls("save"):
            if not self.slave.can_save:
                raise SimulationError(f"{self.fmu} cannot save its state")
            return SavedState(self.slave.time, self, self.slave.getFMUState(), None)

    def restore(self, saved: SavedState | bytes | AnyPath) -> None:
        """Go back to a saved state, which is kept.

        Parameters
        ----------
        saved
            What `save` returned, of this instance or of another one with the same fixed parameters; its bytes, or the
            path of the file that holds them.

        Raises
        ------
        ValueError
            The state was forgotten, is damaged, or is that of another model, version or set of fixed parameters.
        TypeError
            No state.
        OSError
            The file cannot be read.
        SimulationError
            The component refuses the state.
        """
        self.slave.check()
        state = state_of(saved)
        with self._calls("restore"):
            handle = state._of(self)
            if handle is not None:
                self.slave.setFMUState(handle)
                return
            contents = state._read()
            self._check_contents(contents)
            with self._calls("restore", undo=True):
                handle = self.slave.deserializeFMUState(contents.serialised)
                self.slave.states[handle.value] = contents.phase_of(), contents.time
                try:
                    self.slave.setFMUState(handle)
                finally:
                    self.slave.freeFMUState(handle)

    def forget(self, saved: SavedState) -> None:
        """Free a saved state; one that was forgotten before is none any more.

        Parameters
        ----------
        saved
            What `save` returned, of this instance.

        Raises
        ------
        TypeError, ValueError
            No state, or one that another instance keeps.
        SimulationError
            The instance is closed.
        """
        self.slave.check()
        if not isinstance(saved, SavedState):
            raise TypeError(f"{saved!r}: a saved state is needed")
        with self._calls("forget"):
            handle = saved._of(self)
            if handle is not None:
                self.slave.freeFMUState(handle)
            elif saved._instance is not None:
                raise ValueError(f"{saved!r} is kept by another instance: forget it there")
            saved._forget()

    def _serialised(self, handle: Any) -> Contents:
        """Contents of one of the instance's states."""
        with self._calls("save"):
            if not self.slave.can_serialise:
                raise SimulationError(f"{self.fmu} cannot turn its states into bytes")
            model = description(self.fmu)
            here = self.slave.getFMUState()
            try:
                # The parameters are those of the state, which need not be those of now.
                self.slave.setFMUState(handle)
                phase, time, parameters = self.slave.phase, self.slave.time, self.parameters()
            finally:
                self.slave.setFMUState(here)
                self.slave.freeFMUState(here)
            serialised = self.slave.serializeFMUState(handle)
        return Contents(model.modelName, model.version or "", phase.name, time, parameters, serialised)

    def _check_contents(self, contents: Contents) -> None:
        """Refuse a state that is not for this instance, with the parameters in which they differ."""
        model = description(self.fmu)
        ours, theirs = (model.modelName, model.version or ""), (contents.model, contents.version)
        if ours != theirs:
            raise ValueError(f"the state is one of {' '.join(theirs)}, the instance is of {' '.join(ours)}")
        here = self.parameters()
        for name, value in contents.parameters.items():
            variable = self.variables.get(name) or self.variables.get(f"{name}[1]")
            if (variable is None or variable.variability != "tunable") and here.get(name) != value:
                raise ValueError(
                    f"{name} = {here.get(name)!r}, in the state {value!r}: Instance.load makes an instance for it"
                )
