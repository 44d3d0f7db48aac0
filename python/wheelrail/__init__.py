"""Rolling contact of a wheel on a rail, with heat and wear: the FMU of wheelrail, driven from Python.

- `fmu_path`: where the FMU is, for any other importer.
- `simulate`: a table of inputs in, a table of outputs out, with units; parameters by name.
- `creep_curves`: steady forces over longitudinal, lateral and spin creepage.
- `preset`: a named set of parameters, for a wet rail for example.
- `Instance`: the component step by step, for a master written by hand; `SavedState`: what it can go back to.
- `Profile`, `contact_geometry`: profiles of wheels and rails, and where a wheelset touches its track;
  `CurvePoint`: a profile at an arc length; `WheelMeasures`, `WheelWear`: what is measured on a wheel.
- `variables`: what there is to set and to read.
- `wheelrail.plots`: pictures of a braking manoeuvre, of the patch in plan view, of creep curves, of profiles
  in contact.

All quantities are in SI units, angles in radians, temperatures absolute.
"""

from importlib import import_module, metadata
from typing import TYPE_CHECKING, Any

from .archive import example, fmu_path, preset
from .creep import creep_curves
from .errors import InstanceClosedError, SimulationError, SimulationWarning
from .geometry import CurvePoint, Profile, WheelMeasures, WheelWear, contact_geometry
from .instance import Instance
from .simulation import simulate
from .states import SavedState
from .tables import read_table
from .variables import variables
from .wear import ProfileWear, WornProfiles

if TYPE_CHECKING:
    from . import plots

__all__ = [
    "CurvePoint",
    "Instance",
    "InstanceClosedError",
    "Profile",
    "ProfileWear",
    "SavedState",
    "SimulationError",
    "SimulationWarning",
    "WheelMeasures",
    "WheelWear",
    "WornProfiles",
    "contact_geometry",
    "creep_curves",
    "example",
    "fmu_path",
    "plots",
    "preset",
    "read_table",
    "simulate",
    "variables",
]


def __getattr__(name: str) -> Any:
    """The pictures, with matplotlib where they are asked for only; the version of the installed package."""
    if name == "plots":
        return import_module(".plots", __name__)
    if name == "__version__":
        return metadata.version("wheelrail")
    raise AttributeError(f"module 'wheelrail' has no attribute {name!r}")
