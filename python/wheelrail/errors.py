"""What the package raises, beside ValueError and TypeError, and warns of."""

import inspect
import warnings
from pathlib import Path
from typing import Any

# As in the frames of calls: not resolved, where the folder is a link.
PACKAGE = Path(__file__).parent


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


def warn(words: str) -> None:
    """Warn with `SimulationWarning`, in the name of the line that called the package."""
    level, frame = 1, inspect.currentframe()
    while frame is not None and Path(frame.f_code.co_filename).parent == PACKAGE:
        level, frame = level + 1, frame.f_back
    warnings.warn(words, SimulationWarning, stacklevel=level)
