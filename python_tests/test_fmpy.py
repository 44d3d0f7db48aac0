"""FMPy finds nothing to complain about and simulates the unit, under both versions of FMI with the same bits."""

from pathlib import Path

import fmpy
import numpy as np
import pytest
from fmpy.validation import validate_fmu

REPOSITORY = Path(__file__).resolve().parent.parent
PATCH = {"contact_model": 2, "lateral_creepage": 1e-3, "spin_creepage": 0.2}


@pytest.fixture(params=["fmu", "fmu3"])
def archive(request):
    """Return the path of the component under a version of FMI."""
    return request.getfixturevalue(request.param)


def test_validation_reports_nothing(archive):
    """Schema, names, structure, start values and units."""
    assert validate_fmu(archive) == []


def test_simulation_with_inputs_and_parameters(archive, fmu):
    """Input from a table, parameters set, logging on."""
    signals = np.array(
        [(0.0, 2e4, 0.0), (0.1, 6e4, 0.01)], dtype=[("time", float), ("normal_load", float), ("creepage", float)]
    )
    messages = []
    pressure = "profile.pressure[31]" if archive == fmu else "profile.pressure"
    result = fmpy.simulate_fmu(
        archive,
        stop_time=0.1,
        output_interval=0.01,
        start_values={"friction_law": 1, "friction_cold": 0.3},
        input=signals,
        output=["traction_force", "traction_coefficient", pressure],
        debug_logging=True,
        logger=lambda *arguments: messages.append(arguments),
    )
    assert result["time"][-1] == 0.1
    # The coefficient is the quotient of two sums over the nodes: it may exceed μ by their round-off.
    assert 0.25 < result["traction_coefficient"][-1] <= 0.3 * (1.0 + 1e-14)
    assert result[pressure][-1].max() > 5e8
    assert messages


@pytest.mark.parametrize("engine", ["line", "patch"])
def test_both_versions_give_the_same_bits(fmu, fmu3, outputs, engine):
    """The braking manoeuvre of the line, a shorter one of a patch that moves sideways and spins."""
    if engine == "line":
        table = np.genfromtxt(REPOSITORY / "examples" / "braking.csv", delimiter=",", names=True)
        settings = {"stop_time": 10.0, "output_interval": 0.02, "start_values": {"slip_source": 2}}
    else:
        table = np.array([(0.0, 0.0), (0.05, 0.01)], dtype=[("time", float), ("creepage", float)])
        settings = {"stop_time": 0.05, "output_interval": 1e-3, "start_values": PATCH}
    # FMI 3.0 has no derivatives of inputs: held over a step in both.
    results = [
        fmpy.simulate_fmu(archive, input=table, output=outputs, set_input_derivatives=False, **settings)
        for archive in (fmu, fmu3)
    ]
    assert results[0].tobytes() == results[1].tobytes()


def test_fields_of_a_patch_are_arrays(fmu3):
    """Strips by cells, as long as the default parameters say; across the strips the pressure is that of the profile."""
    names = ["patch.x", "patch.y", "patch.pressure", "strip.position", "strip.pressure"]
    settings = {"stop_time": 0.01, "output_interval": 1e-3, "start_values": PATCH}
    last = fmpy.simulate_fmu(fmu3, output=names, **settings)[-1]
    strips, cells = last["patch.pressure"].shape
    assert (last["patch.y"].size, last["patch.x"].size) == (strips, cells)
    assert np.all(np.diff(last["patch.x"]) > 0.0)
    assert np.all(np.diff(last["patch.y"]) > 0.0)
    across = np.interp(last["strip.position"], last["patch.y"], last["patch.pressure"].max(axis=1))
    # Both are linear between the strips; the profile has as many points as there are strips by default.
    assert last["strip.pressure"] == pytest.approx(across, rel=1e-12, abs=1e-3)
