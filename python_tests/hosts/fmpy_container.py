"""FMPy's FMU container: the component packed into another FMU, which FMPy then runs."""

import tempfile
from pathlib import Path

import fmpy
import scenario
from fmpy.container_fmu.cli import create_container_fmu
from fmpy.container_fmu.config import Component, Configuration
from fmpy.model_description import CoSimulation, DefaultExperiment, ModelDescription, ModelVariable, Unknown

path, run = scenario.read()
description = fmpy.read_model_description(path)
inner = {variable.name: variable for variable in description.modelVariables}
component = Component(name="contact", filename=Path(path), modelDescription=description)

# The container counts its value references from the independent variable on.
time = ModelVariable(name="time", valueReference=0, type="Real", causality="independent", variability="continuous")
variables = [time]
for name in [*run["start"], *run["outputs"]]:
    original = inner[name]
    start = str(run["start"][name]) if name in run["start"] else None
    variable = ModelVariable(
        name=name, valueReference=0, type="Real", causality=original.causality, variability=original.variability
    )
    variable.start = start
    variable.initial = original.initial
    variables.append(variable)
outer = ModelDescription(
    fmiVersion="2.0",
    modelName="Container",
    instantiationToken="container",
    coSimulation=CoSimulation(modelIdentifier="container_fmu"),
    defaultExperiment=DefaultExperiment(startTime="0", stopTime="1"),
    modelVariables=variables,
)
outer.coSimulation.fixedInternalStepSize = run["step"]
outer.coSimulation.canHandleVariableCommunicationStepSize = True
outer.outputs = [Unknown(variable=variable) for variable in variables if variable.causality == "output"]
mappings = {variable: [(component, inner[variable.name])] for variable in variables[1:]}
configuration = Configuration(
    parallelDoStep=False, modelDescription=outer, components=[component], connections=[], variableMappings=mappings
)
with tempfile.TemporaryDirectory() as folder:
    container = Path(folder) / "Container.fmu"
    create_container_fmu(configuration, Path(tempfile.mkdtemp(dir=folder)), container)
    result = fmpy.simulate_fmu(
        str(container),
        stop_time=run["step"] * run["steps"],
        output_interval=run["step"],
        start_values=run["start"],
        output=run["outputs"],
    )
scenario.answer({name: result[name][-1] for name in run["outputs"]})
