"""Units of studies/mileage on a worker: how long their calls take, and their profiles as files."""

import hashlib
import tempfile
import time
from pathlib import Path

from curve_vehicle import Wheel


class TimedWheel(Wheel):
    """A unit that adds up how long its steps, derivatives and initialisations take, those of all units here [s]."""

    spent = dict.fromkeys(("steps", "derivatives", "initialisation"), 0.0)

    def timed(self, what, call, *given):
        """Call and add the time."""
        began = time.perf_counter()
        try:
            return call(*given)
        finally:
            self.spent[what] += time.perf_counter() - began

    def start(self):
        """Initialise the unit."""
        return self.timed("initialisation", super().start)

    def step(self, step):
        """Make a step."""
        return self.timed("steps", super().step, step)

    def derivative(self, outputs, known):
        """Return derivatives of outputs."""
        return self.timed("derivatives", super().derivative, outputs, known)


def profile_file(text):
    """The file of a profile on this machine."""
    path = Path(tempfile.gettempdir()) / f"{hashlib.sha256(text.encode()).hexdigest()}.prw"
    if not path.exists():
        # Another process on the same machine may be doing the same.
        with tempfile.NamedTemporaryFile("w", dir=path.parent, delete=False, encoding="utf-8") as own:
            own.write(text)
        Path(own.name).replace(path)
    return path
