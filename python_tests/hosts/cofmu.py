"""CoFmuPy, in its own environment: it pins an older FMPy."""

import json
import sys
import tempfile
from pathlib import Path

from cofmupy import Coordinator

path, scenario = sys.argv[1], json.loads(Path(sys.argv[2]).read_text())
with tempfile.TemporaryDirectory() as folder:
    configuration = Path(folder) / "configuration.json"
    configuration.write_text(
        json.dumps(
            {
                "fmus": [{"id": "contact", "path": path, "initialization": scenario["start"]}],
                "connections": [],
                "cosim_method": "jacobi",
                "iterative": False,
                "root": folder,
            }
        )
    )
    coordinator = Coordinator()
    coordinator.start(str(configuration))
    for _ in range(scenario["steps"]):
        coordinator.do_step(scenario["step"])
    values = {name: coordinator.get_variable(("contact", name))[-1] for name in scenario["outputs"]}
print(json.dumps({name: float(value) for name, value in values.items()}), flush=True)
