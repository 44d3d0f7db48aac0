"""What the package raises, beside ValueError and TypeError, and warns of."""

from typing import Any


class SimulationError(RuntimeError):
    """The component refused a value, could not complete a step, or cannot be called now: its words, and the way out.

    Attributes
    ----------
    table
        The rows of a simulation up to there, or None.
    fields
        The fields of a simulation up to there, or None.
    """

    table: Any = None
    fields: Any = None


class InstanceClosedError(SimulationError):
    """The instance was closed: nothing can be asked of it, nor of its saved states."""


class SimulationWarning(UserWarning):
    """The component did what it was asked and remarks on it: a staggered step, a contact that fills its window."""
