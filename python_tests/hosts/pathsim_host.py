"""PathSim through pathsim-fmi: it writes its signals to every input, 0 where nothing is connected."""

import fmpy
import scenario
from pathsim import Connection, Simulation
from pathsim.blocks import Constant
from pathsim_fmi import CoSimulationFMU

path, run = scenario.read()
variables = fmpy.read_model_description(path).modelVariables
inputs = [variable for variable in variables if variable.causality == "input"]
contact = CoSimulationFMU(path, start_values=run["start"], dt=run["step"])
# Every input connected, those that the scenario leaves out to their start values.
constants = {variable.name: Constant(run["start"].get(variable.name, float(variable.start))) for variable in inputs}
if not run.get("connected", True):
    constants = {}
connections = [Connection(block, contact[name]) for name, block in constants.items()]
simulation = Simulation([contact, *constants.values()], connections, dt=run["step"], log=False)
# The first step is at the start, so that the last is one step before the end.
simulation.run((run["steps"] - 1) * run["step"])
wrapper = contact.fmu_wrapper
values = wrapper.fmu.getReal([wrapper.output_refs[name] for name in run["outputs"]])
scenario.answer(dict(zip(run["outputs"], values, strict=True)))
