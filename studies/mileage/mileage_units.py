"""Units of studies/mileage on a worker: how long their calls take, and their profiles as files."""

import hashlib
import time

from curve_vehicle import Wheel
from dask_runs import own_file


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


def profile_file(text, ending=".prw"):
    """The file of a profile, of this worker: of a wheel, or with the ending of a rail's."""
    content = text.encode()
    return own_file(f"{hashlib.sha256(content).hexdigest()}{ending}", content)
