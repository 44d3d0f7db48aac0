"""FMPy's low-level class."""

import fmpy
import scenario
from fmpy.fmi2 import FMU2Slave

path, run = scenario.read()
description = fmpy.read_model_description(path)
reference = {variable.name: variable.valueReference for variable in description.modelVariables}
fmu = FMU2Slave(
    guid=description.guid,
    unzipDirectory=fmpy.extract(path),
    modelIdentifier=description.coSimulation.modelIdentifier,
    instanceName="slave",
)
fmu.instantiate()
fmu.setupExperiment(startTime=0.0)
fmu.setReal([reference[name] for name in run["start"]], list(run["start"].values()))
fmu.enterInitializationMode()
fmu.exitInitializationMode()
for number in range(run["steps"]):
    fmu.doStep(number * run["step"], run["step"])
values = fmu.getReal([reference[name] for name in run["outputs"]])
fmu.terminate()
fmu.freeInstance()
scenario.answer(dict(zip(run["outputs"], values, strict=True)))
