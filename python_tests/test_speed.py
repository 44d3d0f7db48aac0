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


@pytest.mark.parametrize(("name", "displacement", "rolling_radius", "lever"), speed.ON_PROFILES)
def test_profiles_are_driven_as_the_benchmarks_drive_them(name, displacement, rolling_radius, lever):
    """The constants are those of the benchmarks; speeds and yaw rate make creepage and spin of the table."""
    source = (ROOT / "benches" / "track" / "profiles.rs").read_text()
    for constant in ("INCLINED", "RADIUS"):
        assert float(re.search(rf"const {constant}: f64 = ([\d.]+);", source)[1]) == getattr(speed, constant)
    place = [rf"{key}: ([\de.-]+),\s*" for key in ("displacement", "rolling_radius", "lever")]
    found = re.search(rf'name: "{name}",\s*' + "".join(place), source)
    assert [float(value) for value in found.groups()] == [displacement, rolling_radius, lever]
    inputs = speed.inputs_at("benches/rough_track.csv", speed.STEP * np.arange(10))
    driven = speed.on_profiles(inputs, displacement, rolling_radius, lever)
    assert (driven["lateral_displacement"] == displacement).all()
    assert not driven["spin_rate"].any()
    spin = speed.INCLINED * inputs["vehicle_speed"] - driven["yaw_rate"]
    assert spin == pytest.approx(inputs["spin_rate"], abs=1e-12)
    circumferential = rolling_radius * driven["wheel_speed"] + lever * driven["yaw_rate"]
    assert circumferential == pytest.approx(speed.RADIUS * inputs["wheel_speed"], rel=1e-12)


def test_it_measures_both_units_and_refuses_too_few_steps(fmu):
    """Three rows for the line and for the patch; what they say hangs on the machine."""
    command = [sys.executable, ROOT / "tools" / "speed.py", fmu, fmu, "--steps"]
    done = subprocess.run([*command, "3"], check=True, capture_output=True, text=True, timeout=300)
    rows = [line.split()[0] for line in done.stdout.splitlines()]
    assert rows == ["line"] * 3 + ["patch"] * 3
    refused = subprocess.run([*command, "2"], check=False, capture_output=True, text=True, timeout=300)
    assert (refused.returncode, "--steps 2: 3 at least" in refused.stderr) == (2, True)
