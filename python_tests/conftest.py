"""What the tests share: the component that `make fmu` built, and a low-level instance of it."""

import json
import os
import signal
import subprocess
import sys
import tempfile
from pathlib import Path

import fmpy
import pytest
from fmpy.fmi2 import FMU2Slave, fmi2CallbackFunctions, fmi2CallbackLoggerTYPE

REPOSITORY = Path(__file__).resolve().parent.parent
# The Python package as it is here, for every test.
sys.path.insert(0, str(REPOSITORY / "python"))
# And the modules of the studies, as `python studies NAME` finds them.
sys.path.insert(0, str(REPOSITORY / "studies"))
import folders  # noqa: E402

sys.path[:0] = folders.folders()

# Files that take longest, the longest first. `make pytest` hands files to its workers in this order: begun late, one of
# these would run on alone at the end.
LONGEST = [
    "stranger",
    "coupling_hunting",
    "coupling_adhesion",
    "coupling_stiff",
    "documents",
    "coupling_mileage",
    "wheel",
    "hosts",
    "headers",
    "instance",
    "coupling_maintenance",
    "results",
    "coupling_curve",
    "random_calls",
    "measurements",
    "coupling_longitudinal",
    "site",
]


def pytest_collection_modifyitems(items):
    """Put the files that take longest first; the tests of a file stay together, in their order."""
    rank = {f"test_{name}": number for number, name in enumerate(LONGEST)}
    items.sort(key=lambda item: rank.get(item.path.stem, len(rank)))


def built(path):
    """Return a file that `make fmu fmu3` makes."""
    if not path.exists():
        pytest.exit(f"{path} is not there: run `make fmu fmu3` first", returncode=2)
    return path


@pytest.fixture(scope="session")
def fmu():
    """Return the path of the packed component."""
    return str(built(REPOSITORY / "target" / "WheelRailContact.fmu"))


@pytest.fixture(scope="session")
def fmu3():
    """Return the path of the component packed under FMI 3.0."""
    return str(built(REPOSITORY / "target" / "WheelRailContact-fmi3.fmu"))


@pytest.fixture(scope="session")
def wheelrail():
    """Return the path of the command line."""
    return built(REPOSITORY / "target" / "release" / "wheelrail")


@pytest.fixture(scope="session")
def description(fmu):
    """Return the component's model description."""
    return fmpy.read_model_description(fmu)


@pytest.fixture(scope="session")
def unpacked(fmu, tmp_path_factory):
    """Return the folder of the unpacked component."""
    return Path(fmpy.extract(fmu, tmp_path_factory.mktemp("unpacked")))


@pytest.fixture(scope="session")
def library(unpacked):
    """Return the shared library that is in the component."""
    return unpacked / "binaries" / "linux64" / "wheelrail.so"


@pytest.fixture(scope="session")
def reference(description):
    """Return the value reference of each name."""
    return {variable.name: variable.valueReference for variable in description.modelVariables}


@pytest.fixture(scope="session")
def outputs(description):
    """Return the names of the outputs that line and patch have."""
    found = (variable for variable in description.modelVariables if variable.causality == "output")
    others = ("; 0 unless contact_model is profiles", "; contacts count from the gauge side")
    return [variable.name for variable in found if not any(part in variable.description for part in others)]


@pytest.fixture
def callbacks():
    """Return callbacks that keep the messages, in the attribute `messages`.

    FMPy's own default logger is no longer callable once simulate_fmu was given another one in the same process: its
    native proxy keeps a pointer to the last logger, freed or not (FMPy 0.3.32).
    """
    messages = []

    def logger(_environment, _name, status, category, _format):
        messages.append((status, category.decode()))

    structure = fmi2CallbackFunctions()
    structure.logger = fmi2CallbackLoggerTYPE(logger)
    structure.messages = messages
    return structure


@pytest.fixture
def instance(unpacked, description, callbacks):
    """Return a function that makes instances in state `instantiated`; they are freed after the test."""
    made = []

    def make(name="contact", **options):
        slave = FMU2Slave(
            guid=description.guid,
            unzipDirectory=str(unpacked),
            modelIdentifier=description.coSimulation.modelIdentifier,
            instanceName=name,
        )
        slave.instantiate(callbacks=callbacks, **options)
        made.append(slave)
        return slave

    yield make
    for slave in made:
        # Unloading is tested elsewhere; here two instances may share the library.
        slave.fmi2FreeInstance(slave.component)


@pytest.fixture(scope="session")
def run_host():
    """Return a function that runs a program to its end; what it leaves among temporary files goes."""

    def run(command):
        with tempfile.TemporaryDirectory() as folder:
            environment = os.environ | {"TMPDIR": folder}
            return subprocess.run(command, capture_output=True, text=True, timeout=900, env=environment)

    return run


@pytest.fixture(scope="session")
def host_process(fmu, run_host, tmp_path_factory):
    """Return a function that runs a host script on a scenario in a process of its own and returns its answer."""

    def run(script, scenario, python=sys.executable):
        file = tmp_path_factory.mktemp("host") / "scenario.json"
        file.write_text(json.dumps(scenario))
        path = REPOSITORY / "python_tests" / "hosts" / script
        done = run_host([python, path, fmu, file])
        assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-2000:]
        return json.loads(done.stdout.splitlines()[-1])

    return run


@pytest.fixture(scope="session")
def simulate_natively(wheelrail, tmp_path_factory):
    """Return a function that runs `wheelrail simulate` and returns the path of its table."""

    def run(scenario, step, parameters):
        out = tmp_path_factory.mktemp("native") / "out.csv"
        options = [option for name, value in parameters.items() for option in ("--set", f"{name}={value!r}")]
        command = [wheelrail, "simulate", scenario, "-o", out, "--step", repr(step), *options]
        subprocess.run(command, check=True, capture_output=True)
        return out

    return run


@pytest.fixture
def killed_half_way(tmp_path_factory):
    """Return a function that kills a program after four parts: it says "written" after each, and waits for a line.

    What it leaves among temporary files, pytest keeps and removes as it does its own.
    """

    def kill(command):
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "start_new_session": True}
        environment = os.environ | {"TMPDIR": str(tmp_path_factory.mktemp("killed"))}
        with subprocess.Popen(command, **pipes, env=environment) as process:
            written = (line for line in process.stdout if line == "written\n")
            for _ in range(3):
                next(written)
                process.stdin.write("\n")
                process.stdin.flush()
            next(written)
            process.send_signal(signal.SIGKILL)

    return kill
