"""What every host script needs: the scenario it is to run, and where its answer goes.

A host script is called with the FMU and a JSON file: {"start": {name: value}, "step": s, "steps": n, "outputs": [...]}.
It prints one JSON object {output: value at the end} as its last line.
"""

import json
import sys


def read():
    """Return the FMU's path and the scenario."""
    with open(sys.argv[2]) as file:
        return sys.argv[1], json.load(file)


def answer(values):
    """Print the outputs at the end."""
    print(json.dumps({name: float(value) for name, value in values.items()}), flush=True)
