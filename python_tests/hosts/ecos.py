"""ecos through ecospy; libtbb.so.12 is loaded by hand where it is not on the system."""

import ctypes
from pathlib import Path

import scenario

for library in sorted((Path(__file__).resolve().parents[2] / ".venv" / "tbb").rglob("libtbb*.so.*")):
    if library.name in ("libtbbmalloc.so.2", "libtbb.so.12"):
        ctypes.CDLL(str(library), mode=ctypes.RTLD_GLOBAL)

from ecospy import EcosSimulation, EcosSimulationStructure  # noqa: E402

path, run = scenario.read()
with EcosSimulationStructure() as structure:
    structure.add_model("contact", path)
    structure.add_parameter_set("start", {f"contact::{name}": value for name, value in run["start"].items()})
    with EcosSimulation(structure=structure, step_size=run["step"]) as simulation:
        simulation.init(parameter_set="start")
        simulation.step(run["steps"])
        values = {name: simulation.get_real(f"contact::{name}") for name in run["outputs"]}
        simulation.terminate()
scenario.answer(values)
