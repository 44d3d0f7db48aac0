"""Simulation with FMPy: inputs, parameters, step sizes, profiles, and the native simulation as reference."""

import sys
from itertools import pairwise
from pathlib import Path

import fmpy
import numpy as np
import pytest
from wheelrail import read_table

REPOSITORY = Path(__file__).resolve().parent.parent
TOTALS = ["worn_volume", "friction_energy", "distance", "wheel_wear_depth"]


def test_input_from_csv(fmu, outputs):
    """A table with all inputs is followed: the creepage is that of the speeds."""
    table = np.genfromtxt(REPOSITORY / "examples" / "braking.csv", delimiter=",", names=True)
    result = fmpy.simulate_fmu(
        fmu, stop_time=10.0, output_interval=0.02, start_values={"slip_source": 2}, input=table, output=outputs
    )
    speed = np.interp(result["time"], table["time"], table["vehicle_speed"])
    wheel = np.interp(result["time"], table["time"], table["wheel_speed"])
    # Outputs belong to the inputs that were set at the beginning of the step.
    expected = (0.46 * wheel / speed - 1.0)[:-1]
    assert result["slip_creepage"][1:] == pytest.approx(expected, rel=1e-9, abs=1e-12)
    assert result["slip_creepage"].min() < -0.2
    for name in TOTALS:
        assert np.all(np.diff(result[name]) >= 0.0), name


def test_parameters_are_used(fmu):
    """Friction that is constant at 0.3 limits the traction in full sliding to 0.3 of the load."""
    settings = {"stop_time": 0.1, "output_interval": 0.01, "output": ["traction_coefficient", "peak_temperature"]}
    # With neither debris nor conduction to the wheel nor thermal bulge, the rise is proportional to the partition.
    start = {"creepage": 0.05, "friction_law": 1, "friction_cold": 0.3, "thermal_expansion": 0.0}
    start |= {"contact_thermal_resistance": 1e12, "wear_coefficient": 0.0}
    sliding = fmpy.simulate_fmu(fmu, start_values=start, **settings)
    # Coulomb's law: the bound itself, but for round-off.
    assert sliding["traction_coefficient"][-1] == pytest.approx(0.3, rel=1e-12)
    halved = fmpy.simulate_fmu(fmu, start_values=start | {"heat_partition": 0.25}, **settings)
    rise, half = (result["peak_temperature"][-1] - 293.15 for result in (sliding, halved))
    assert half / rise == pytest.approx(0.5, rel=1e-6)


def test_first_order_in_the_communication_step(fmu):
    """Inputs held over a step make an error of order 1 in the step, from 100 ms down to 0.1 ms.

    The creepage rises linearly. The energy is a sum over the steps (error h/2 times the change of the power), the
    traction lags by one step: both halve with the step. The finest step stands in for the limit; that moves the
    observed orders of the steps from 100 ms to 6.25 ms by at most 0.1/6.25 = 2 %, or 0.03, and the curvature of the
    traction over 100 ms by some more.
    """
    end = 1.6
    ramp = np.array(
        [(0.0, 0.003), (end, 0.011)],
        dtype=[("time", float), ("creepage", float)],
    )

    def run(step):
        result = fmpy.simulate_fmu(
            fmu, stop_time=end, output_interval=step, input=ramp, output=["friction_energy", "friction_power"]
        )
        assert result["time"][-1] == pytest.approx(end)
        return np.array([result["friction_energy"][-1], result["friction_power"][-1]])

    limit = run(1e-4)
    steps = 0.1 * 0.5 ** np.arange(5)
    errors = np.array([np.abs(run(step) / limit - 1.0) for step in steps])
    orders = np.log2(errors[:-1] / errors[1:])
    assert np.all(np.abs(orders - 1.0) < 0.15), orders
    # And 1 ms is as much closer as it is shorter.
    assert np.all(np.abs(run(1e-3) / limit - 1.0) < errors[0] / 50.0)


def test_settled_result_does_not_depend_on_the_step(fmu, outputs):
    """Constant inputs: after 4 s, ten times what the rail takes to pass through the strip, to 1e-9 relative."""
    instant = [name for name in outputs if name not in TOTALS]
    settled = [
        fmpy.simulate_fmu(fmu, stop_time=4.0, output_interval=step, start_values={"creepage": 0.01}, output=instant)[-1]
        for step in (1e-4, 1e-3, 1e-2, 1e-1)
    ]
    for name in instant:
        values = [row[name] for row in settled]
        assert values == pytest.approx([values[0]] * 4, rel=1e-9), name


def test_repeats_bit_for_bit(fmu, outputs):
    """The same simulation twice has the same bits."""
    table = np.genfromtxt(REPOSITORY / "examples" / "braking.csv", delimiter=",", names=True)

    def run():
        return fmpy.simulate_fmu(
            fmu, stop_time=9.0, output_interval=0.02, start_values={"slip_source": 2}, input=table, output=outputs
        )

    assert run().tobytes() == run().tobytes()


def test_braking_equals_native_simulation(instance, reference, outputs, simulate_natively):
    """The braking manoeuvre with a wheel slide, inputs changing linearly within a step: 1e-12 relative.

    The interface drives the same model; what could differ is the rounding of time and step.
    """
    table = simulate_natively(REPOSITORY / "examples" / "braking.csv", 0.02, {"slip_source": 2})
    native = read_table(table).to_records(index=False)
    inputs = ["wheel_speed", "normal_load", "creepage", "vehicle_speed", "friction_scale", "ambient_temperature"]
    input_references, output_references = ([reference[n] for n in names] for names in (inputs, outputs))

    slave = instance()
    slave.setupExperiment(startTime=0.0)
    slave.setInteger([reference["slip_source"]], [2])
    slave.setReal(input_references, [native[name][0] for name in inputs])
    slave.enterInitializationMode()
    slave.exitInitializationMode()
    values = [slave.getReal(output_references)]
    for now, then in pairwise(native):
        step = then["time"] - now["time"]
        slave.setReal(input_references, [now[name] for name in inputs])
        rates = [(then[name] - now[name]) / step for name in inputs]
        slave.setRealInputDerivatives(input_references, [1] * len(inputs), rates)
        slave.doStep(now["time"], step)
        values.append(slave.getReal(output_references))
    for name, series in zip(outputs, np.transpose(values), strict=True):
        assert series == pytest.approx(native[name], rel=1e-12, abs=0.0), name
    assert native["peak_temperature"].max() > 500.0


def test_profiles(fmu):
    """The profiles agree with the outputs that are taken from the same fields."""
    quantities = ["x", "pressure", "shear", "slip", "temperature", "wear_depth"]
    names = {q: [f"profile.{q}[{i}]" for i in range(1, 62)] for q in quantities}
    depth = {q: [f"depth.{q}[{i}]" for i in range(1, 42)] for q in ("z", "temperature")}
    scalars = ["peak_pressure", "peak_shear", "peak_temperature", "wear_depth", "traction_force"]
    result = fmpy.simulate_fmu(
        fmu,
        stop_time=0.5,
        output_interval=0.01,
        start_values={"creepage": 0.01, "contact_nodes": 61},
        output=[n for group in (*names.values(), *depth.values(), scalars) for n in group],
    )[-1]
    x, pressure, shear, slip, temperature, wear = (np.array([result[n] for n in names[q]]) for q in quantities)
    # With 61 contact nodes the points of the profiles are the nodes.
    assert pressure.max() == pytest.approx(result["peak_pressure"], rel=1e-12)
    assert np.abs(shear).max() == pytest.approx(result["peak_shear"], rel=1e-12)
    assert temperature.max() == pytest.approx(result["peak_temperature"], rel=1e-12)
    assert wear[0] == pytest.approx(result["wear_depth"], rel=1e-12)
    spacing = np.diff(x)
    assert spacing == pytest.approx(np.full(60, spacing[0]), rel=1e-9)
    assert 0.01 * spacing[0] * pressure.sum() == pytest.approx(60e3, rel=1e-9)
    assert -0.01 * spacing[0] * shear.sum() == pytest.approx(result["traction_force"], rel=1e-9)
    # Material enters unworn and cold at the right, wear grows to the left.
    assert np.all(np.diff(wear) <= 1e-9 * wear[0])
    assert wear[-1] == 0.0
    assert np.all(slip[pressure == 0.0] == 0.0)
    z, below = (np.array([result[n] for n in depth[q]]) for q in ("z", "temperature"))
    assert z[0] == 0.0
    assert np.all(np.diff(z) > 0.0)
    assert below[0] == pytest.approx(result["peak_temperature"], rel=1e-12)
    # It falls, but for the undershoot of a consistent mass matrix ahead of a steep front: 4e-5 of the rise.
    assert np.all(np.diff(below) <= 1e-4 * (below[0] - 293.15))


def test_nothing_is_printed(fmu, run_host):
    """Logging off, the library writes neither to standard output nor to standard error."""
    program = (
        "import fmpy, sys\n"
        "from fmpy.fmi2 import FMU2Slave\n"
        "path = sys.argv[1]\n"
        "d = fmpy.read_model_description(path)\n"
        "s = FMU2Slave(guid=d.guid, unzipDirectory=fmpy.extract(path), modelIdentifier='wheelrail', instanceName='s')\n"
        "s.instantiate()\n"
        "s.setupExperiment(startTime=0.0)\n"
        "s.enterInitializationMode()\n"
        "s.exitInitializationMode()\n"
        "for i in range(10): s.doStep(0.01 * i, 0.01)\n"
        "s.terminate()\n"
        "s.freeInstance()\n"
    )
    done = run_host([sys.executable, "-c", program, fmu])
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
