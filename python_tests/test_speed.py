"""tools/speed.py: its manoeuvres are those of the tables and of the benchmark; what cannot be run is refused."""

import re
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

ROOT = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(ROOT / "tools"))

import speed  # noqa: E402


@pytest.mark.parametrize(("table", "steps"), [("examples/braking.csv", 22001), ("benches/rough_track.csv", 3001)])
def test_a_manoeuvre_is_as_long_as_its_table(table, steps):
    """The last step that is allowed has the inputs of the last row; one more is refused."""
    inputs, rows = speed.inputs_at(table, speed.STEP * np.arange(steps)), speed.rows_of(table)
    assert set(inputs) == set(rows) - {"time"}
    for name, values in inputs.items():
        assert len(values) == steps
        assert values[-1] == pytest.approx(rows[name][-1], rel=1e-12), name
    with pytest.raises(SystemExit, match=f"--steps {steps + 1}: {table} .* {steps} steps at most"):
        speed.inputs_at(table, speed.STEP * np.arange(steps + 1))


def test_profiles_have_the_spin_of_the_track():
    """Yaw and the inclination of the contact, which the benchmark takes for as much, make the spin of the table."""
    track = (ROOT / "benches" / "track" / "mod.rs").read_text()
    assert float(re.search(r"const INCLINED: f64 = ([\d.]+);", track)[1]) == speed.INCLINED
    inputs = speed.inputs_at("benches/rough_track.csv", speed.STEP * np.arange(10))
    on_profiles = speed.on_profiles(inputs, 5e-3)
    assert (on_profiles["lateral_displacement"] == 5e-3).all()
    assert not on_profiles["spin_rate"].any()
    spin = on_profiles["yaw_rate"] + speed.INCLINED * inputs["vehicle_speed"]
    assert spin == pytest.approx(inputs["spin_rate"], abs=1e-12)


def test_it_measures_both_units_and_refuses_too_few_steps(fmu):
    """Three rows for the line and for the patch; what they say hangs on the machine."""
    command = [sys.executable, ROOT / "tools" / "speed.py", fmu, fmu, "--steps"]
    done = subprocess.run([*command, "3"], check=True, capture_output=True, text=True, timeout=300)
    rows = [line.split()[0] for line in done.stdout.splitlines()]
    assert rows == ["line"] * 3 + ["patch"] * 3
    refused = subprocess.run([*command, "2"], check=False, capture_output=True, text=True, timeout=300)
    assert (refused.returncode, "--steps 2: 3 at least" in refused.stderr) == (2, True)
