"""libcosim, the Open Simulation Platform's library, through libcosimpy."""

import scenario
from libcosimpy.CosimExecution import CosimExecution
from libcosimpy.CosimLogging import CosimLogLevel, log_output_level
from libcosimpy.CosimObserver import CosimObserver
from libcosimpy.CosimSlave import CosimLocalSlave

log_output_level(CosimLogLevel.WARNING)
path, run = scenario.read()
# Its time is in whole nanoseconds.
execution = CosimExecution.from_step_size(round(run["step"] * 1e9))
index = execution.add_local_slave(CosimLocalSlave(fmu_path=path, instance_name="contact"))
reference = {variable.name.decode(): variable.reference for variable in execution.slave_variables(index)}
for name, value in run["start"].items():
    execution.real_initial_value(slave_index=index, variable_reference=reference[name], value=value)
observer = CosimObserver.create_last_value()
execution.add_observer(observer=observer)
execution.step(run["steps"])
values = observer.last_real_values(slave_index=index, variable_references=[reference[name] for name in run["outputs"]])
scenario.answer(dict(zip(run["outputs"], values, strict=True)))
