"""studies/sweep: creep curves that fall with temperature; a killed sweep goes on and gives the same bits."""

import hashlib
import itertools
import os
import subprocess
import sys

import folders
import numpy as np
import pyarrow.parquet as pq
import pytest
import sweep

CREEPAGES = tuple(float(value) for value in np.geomspace(1e-3, 0.5, 20))
SMALL = {"laws": ("constant", "piecewise_linear"), "speeds": (5.0, 20.0), "loads": (40e3, 60e3, 80e3)}
# The same small sweep in a process of its own, which goes on after each part when it is told to: it can be killed
# half-way.
PROGRAM = """
import os, sys
from pathlib import Path
sys.path[:0] = sys.argv[1].split(os.pathsep)
import sweep
write = sweep.write_part
def waiting(*arguments):
    write(*arguments)
    print("written", flush=True)
    sys.stdin.readline()
sweep.write_part = waiting
if __name__ == "__main__":
    with sweep.local_client(1) as client:
        count = sweep.sweep(client, Path(sys.argv[2]), **{small!r}, creepages={creepages!r})
    print("computed", count, flush=True)
""".replace("{small!r}", repr(SMALL)).replace("{creepages!r}", repr(CREEPAGES))


@pytest.fixture(scope="module")
def curves():
    """Return one curve of each law, at 20 m/s and 60 kN, computed here without Dask."""
    component = sweep.FMU.read_bytes()
    digest = hashlib.sha256(component).hexdigest()
    columns = {law: sweep.curve(component, digest, law, 20.0, 60e3, CREEPAGES) for law in sweep.LAWS}
    return {law: {name: np.array(values) for name, values in curve.items()} for law, curve in columns.items()}


def test_traction_falls_with_temperature(curves):
    """Constant friction: the curve rises to the limit and stays. Falling friction: it passes a maximum and falls."""
    constant = curves["constant"]["traction_coefficient"]
    # A thousandth: the regularisation.
    assert np.all(np.diff(constant) > -1e-3 * 0.45)
    assert constant[-1] == pytest.approx(0.45, rel=2e-3)
    falling = curves["piecewise_linear"]
    top = np.argmax(falling["traction_coefficient"])
    assert 0 < top < len(CREEPAGES) - 8
    assert np.all(np.diff(falling["traction_coefficient"][top:]) < 0.0)
    assert falling["traction_coefficient"][-1] == pytest.approx(0.25, rel=0.02)
    assert np.all(np.diff(falling["peak_temperature"]) > 0.0)
    # It falls where the rail is hotter than 50 °C only.
    assert falling["peak_temperature"][top + 1] > 323.15


def test_traction_is_within_friction(curves):
    """Traction is at most the mean friction coefficient times the load, and most of it in full sliding."""
    for law, curve in curves.items():
        assert np.all(curve["traction_coefficient"] <= curve["friction_coefficient"] * (1.0 + 1e-9)), law
        assert curve["traction_coefficient"][-1] > 0.99 * curve["friction_coefficient"][-1], law


def test_killed_sweep_goes_on(tmp_path, killed_half_way):
    """Killed after some curves, it computes only the others; together they are the bits computed without Dask."""
    broken, whole = tmp_path / "broken", tmp_path / "whole"
    modules = os.pathsep.join(folders.folders())
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    killed_half_way([sys.executable, program, modules, broken])
    before = {path.name: path.stat().st_mtime_ns for path in broken.glob("*.parquet")}
    assert len(before) == 4

    def complete(folder):
        command = [sys.executable, program, modules, folder]
        done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
        assert done.returncode == 0, done.stderr
        return int(done.stdout.split("computed")[1])

    assert complete(broken) == 12 - len(before)
    after = {path.name: path.stat().st_mtime_ns for path in broken.glob("*.parquet")}
    assert len(after) == 12
    assert before.items() <= after.items()
    # Here, without Dask.
    component = sweep.FMU.read_bytes()
    digest = hashlib.sha256(component).hexdigest()
    whole.mkdir()
    for key in itertools.product(*SMALL.values()):
        columns = sweep.curve(component, digest, *key, CREEPAGES)
        sweep.write_part(sweep.part(whole, *key), b"stamp", *key, CREEPAGES, columns)
    table = sweep.gather(whole, **SMALL)
    assert sweep.gather(broken, **SMALL).replace_schema_metadata().equals(table.replace_schema_metadata())
    assert table.num_rows == 12 * len(CREEPAGES)
    assert table.schema.field("traction_force").metadata == {b"unit": b"N"}
    assert pq.read_schema(next(whole.glob("*.parquet"))).metadata[b"stamp"]


def test_wrong_options_lose_no_results(tmp_path, monkeypatch, capsys):
    """Whatever cannot begin forgets nothing, and says why in a line."""
    (tmp_path / "curve.parquet").write_bytes(b"")
    monkeypatch.setattr(sweep, "WORK", tmp_path)
    for options in (["--scheduler", "nonsense"], ["--workers", "0"]):
        monkeypatch.setattr(sys, "argv", ["sweep", "--fresh", *options])
        with pytest.raises(SystemExit) as caught:
            sweep.main()
        said = f"{caught.value.code}\n{capsys.readouterr().err}"
        assert " ".join(options) in said or "argument --workers: 0: at least 1" in said
    assert (tmp_path / "curve.parquet").exists()


@pytest.mark.parametrize("name", ["multibody", "longitudinal", "train"])
def test_studies_answer_what_they_are_asked(name):
    """No study begins to compute where it is asked what it is, or given what it does not know."""
    command = [sys.executable, folders.STUDIES, name]
    told, refused = (
        subprocess.run([*command, option], capture_output=True, text=True) for option in ("--help", "--nonsense")
    )
    assert told.returncode == 0
    assert told.stdout
    assert refused.returncode != 0
    assert "--nonsense" in refused.stderr
    assert "Traceback" not in refused.stderr
