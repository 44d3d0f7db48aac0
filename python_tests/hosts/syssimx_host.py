"""SysSimX's component: its ports begin at 0, and are written to every input before the initialisation.

Its `System` begins with a step of length 0, which FMI 2.0 excludes and the component refuses.
"""

import fmpy
import scenario
from syssimx import FMUComponent

path, run = scenario.read()
contact = FMUComponent("contact", fmu_path=path)
inputs = {name: value for name, value in run["start"].items() if name in contact.inputs}
contact.set_parameters(**{name: value for name, value in run["start"].items() if name not in inputs})
if run.get("connected", True):
    # Every input, those that the scenario leaves out at their start values.
    variables = fmpy.read_model_description(path).modelVariables
    inputs = {variable.name: float(variable.start) for variable in variables if variable.causality == "input"} | inputs
for name, value in inputs.items():
    contact.inputs[name].set(value=value, t=0.0)
contact.initialize(t0=0.0)
for number in range(run["steps"]):
    contact.do_step(number * run["step"], run["step"])
values = contact.get_outputs()
scenario.answer({name: getattr(values[name], "magnitude", values[name]) for name in run["outputs"]})
