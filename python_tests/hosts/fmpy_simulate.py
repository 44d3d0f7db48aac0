"""FMPy's simulate_fmu."""

import fmpy
import scenario

path, run = scenario.read()
result = fmpy.simulate_fmu(
    path,
    stop_time=run["step"] * run["steps"],
    step_size=run["step"],
    output_interval=run["step"],
    start_values=run["start"],
    output=run["outputs"],
)
scenario.answer({name: result[name][-1] for name in run["outputs"]})
