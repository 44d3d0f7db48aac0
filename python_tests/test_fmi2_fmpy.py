"""FMPy finds nothing to complain about and simulates the unit."""

from pathlib import Path

import fmpy
import numpy as np
from fmpy.validation import validate_fmu

FMU = str(Path(__file__).resolve().parent.parent / "target" / "WheelRailContact.fmu")


def test_validation_reports_nothing():
    """Schema, names, structure, start values and units."""
    assert validate_fmu(FMU) == []


def test_simulation_with_inputs_and_parameters():
    """Input from a table, parameters set, logging on."""
    signals = np.array(
        [(0.0, 2e4, 0.0), (0.1, 6e4, 0.01)], dtype=[("time", float), ("normal_load", float), ("creepage", float)]
    )
    messages = []
    result = fmpy.simulate_fmu(
        FMU,
        stop_time=0.1,
        output_interval=0.01,
        start_values={"friction_law": 1, "friction_cold": 0.3},
        input=signals,
        output=["traction_force", "traction_coefficient", "profile.pressure[31]"],
        debug_logging=True,
        logger=lambda *arguments: messages.append(arguments),
    )
    assert result["time"][-1] == 0.1
    assert 0.25 < result["traction_coefficient"][-1] <= 0.3
    assert result["profile.pressure[31]"][-1] > 5e8
    assert messages
