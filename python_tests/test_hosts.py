"""The same scenario in every simulation host, and natively without FMI: the same results.

Each host runs in a process of its own. The step is 1/512 s: exact in binary, and a whole number of the nanoseconds in
which libcosim counts. Inputs are constant, since not every host can change them; the rail warms up from cold.
"""

import ctypes
import json
import sys
from pathlib import Path

import pytest
from wheelrail import read_table

REPOSITORY = Path(__file__).resolve().parent.parent
COFMUPY = REPOSITORY / ".venv-cofmupy" / "bin" / "python"
TBB = REPOSITORY / ".venv" / "tbb"

INPUTS = {
    "wheel_speed": 22.0,
    "normal_load": 50e3,
    "creepage": 0.01,
    "vehicle_speed": 10.0,
    "friction_scale": 0.9,
    "ambient_temperature": 280.0,
    "incoming_temperature": 285.0,
    "incoming_wear_depth": 1e-7,
}
# Real parameters only: CoFmuPy sets everything through fmi2SetReal.
PARAMETERS = {"friction_cold": 0.4, "thermal_expansion": 1.1e-5, "heat_partition": 0.45}
STEP, STEPS = 1.0 / 512.0, 64


def has_tbb():
    """Whether ecos finds libtbb.so.12."""
    if list(TBB.rglob("libtbb.so.12")):
        return True
    try:
        ctypes.CDLL("libtbb.so.12")
    except OSError:
        return False
    return True


@pytest.fixture(scope="module")
def native(simulate_natively, tmp_path_factory):
    """Return the outputs at the end of the native simulation."""
    scenario = tmp_path_factory.mktemp("scenario") / "constant.csv"
    values = ",".join(repr(value) for value in INPUTS.values())
    scenario.write_text(f"time,{','.join(INPUTS)}\n0.0,{values}\n{STEP * STEPS!r},{values}\n")
    table = read_table(simulate_natively(scenario, STEP, PARAMETERS)).to_records(index=False)
    assert len(table) == STEPS + 1
    return table[-1]


@pytest.mark.parametrize(
    ("script", "python"),
    [
        pytest.param("fmpy_simulate.py", sys.executable, id="FMPy, simulate_fmu"),
        pytest.param("fmpy_slave.py", sys.executable, id="FMPy, low level"),
        pytest.param("fmpy_container.py", sys.executable, id="FMPy, FMU container"),
        pytest.param("libcosim.py", sys.executable, id="libcosim"),
        pytest.param("pathsim_host.py", sys.executable, id="PathSim"),
        pytest.param("syssimx_host.py", sys.executable, id="SysSimX"),
        pytest.param(
            "ecos.py",
            sys.executable,
            id="ecos",
            marks=pytest.mark.skipif(not has_tbb(), reason="no libtbb.so.12 (Debian: libtbb12), see tools/hosts.py"),
        ),
        pytest.param(
            "cofmu.py",
            str(COFMUPY),
            id="CoFmuPy",
            marks=pytest.mark.skipif(not COFMUPY.exists(), reason="CoFmuPy was not installed, see tools/hosts.py"),
        ),
    ],
)
def test_host_equals_native_simulation(script, python, native, host_process, outputs):
    """All outputs within 1e-12 relative: the hosts add nothing to the numbers, only rounding of the time."""
    scenario = {"start": INPUTS | PARAMETERS, "step": STEP, "steps": STEPS, "outputs": outputs}
    answer = host_process(script, scenario, python)
    assert answer["peak_temperature"] > INPUTS["ambient_temperature"] + 10.0
    for name in outputs:
        assert answer[name] == pytest.approx(native[name], rel=1e-12, abs=0.0), name


@pytest.mark.parametrize("script", ["pathsim_host.py", "syssimx_host.py"], ids=["PathSim", "SysSimX"])
def test_unconnected_inputs_of_zero_are_refused(script, fmu, run_host, tmp_path):
    """These hosts write 0 to what is not connected: the component says which input that cannot be, and why."""
    file = tmp_path / "scenario.json"
    file.write_text(json.dumps({"start": {}, "step": STEP, "steps": 2, "outputs": [], "connected": False}))
    path = REPOSITORY / "python_tests" / "hosts" / script
    done = run_host([sys.executable, path, fmu, file])
    assert done.returncode != 0
    assert "ambient_temperature = 0: allowed is 100 to 1000 K" in done.stdout + done.stderr


def test_fmu_manipulation_toolbox_checks(fmu, run_host):
    """Its checker, for the schema and for the rules that a schema cannot express, has no complaint."""
    done = run_host([Path(sys.executable).parent / "fmutool", "-input", fmu, "-check"])
    text = done.stdout + done.stderr
    assert done.returncode == 0, text
    assert "compliant with FMI-2.0" in text
    assert "ERROR" not in text
    assert "WARNING" not in text
