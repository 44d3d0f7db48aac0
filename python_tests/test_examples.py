"""The Python programs of examples/, as they are copied: with the installed package, in an empty folder.

Those in Rust are in tests/examples.rs.
"""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
PROGRAMS = sorted((REPOSITORY / "examples").glob("*.py"))


@pytest.fixture(scope="module")
def run(fmu, tmp_path_factory):
    """Return a function that runs an example and returns the numbers that it prints, line by line, and its folder."""
    package = tmp_path_factory.mktemp("package")
    shutil.copytree(REPOSITORY / "python" / "wheelrail", package / "wheelrail")
    (package / "wheelrail" / "fmu").mkdir(exist_ok=True)
    shutil.copy(fmu, package / "wheelrail" / "fmu")

    def numbers(name):
        folder = tmp_path_factory.mktemp(name)
        program = shutil.copy(REPOSITORY / "examples" / f"{name}.py", folder)
        environment = os.environ | {"PYTHONPATH": str(package)}
        done = subprocess.run([sys.executable, program], cwd=folder, env=environment, capture_output=True, text=True)
        assert done.returncode == 0, done.stderr
        found = re.compile(r"-?\d+(?:\.\d+)?")
        return [[float(number) for number in found.findall(line)] for line in done.stdout.splitlines()], folder

    return numbers


def test_there_are_few_and_they_are_short():
    """What a user copies: six programs, in both languages, each on a page or so."""
    programs = [*PROGRAMS, *(REPOSITORY / "examples").glob("*.rs")]
    assert len(programs) == 6
    for program in programs:
        assert len(program.read_text().splitlines()) < 70, program.name
        assert f"fn {program.stem}" in TESTS or f"def test_{program.stem}" in TESTS, program.name


TESTS = Path(__file__).read_text() + (REPOSITORY / "tests" / "examples.rs").read_text()


def test_simulate(run):
    """Traction stays within friction times load, the friction's energy is that of its power over time."""
    printed, folder = run("simulate")
    ((traction,), (celsius,), (energy, *_)) = printed
    result = np.genfromtxt(folder / "simulated.csv", delimiter=",", names=True)
    assert len(result) == 1001
    assert 0.4 * 60.0 < traction < 0.45 * 62.0
    # Friction is 0.45 up to 50 °C, so that the heat has lowered it.
    assert celsius > 60.0
    assert result["friction_coefficient"].min() < 0.45 * 0.4
    powers = result["friction_power"]
    assert energy == pytest.approx(np.sum(powers[1:]) * 1e-3, rel=0.02)


def test_vehicle(run):
    """The wheel is braked by what its brake takes, and falls behind only where the rail gives less."""
    ((speed, way, braked, releases), (worn, *_)) = run("vehicle")[0]
    assert way == 60.0
    # 3 kN m over 0.46 m, for the mass and the inertia.
    assert braked == pytest.approx(3.0 / 0.46 * 6000.0 / (6000.0 + 60.0 / 0.46**2), rel=0.02)
    # Where it never slid, v² falls by that all the way; on ten metres of 0.45 × 0.15 it falls by less.
    slowest = 15.0**2 - 2.0 * 60.0 * 1e3 * braked / 6000.0
    fastest = slowest + 2.0 * 10.0 * 1e3 * braked / 6000.0
    assert slowest < speed**2 < fastest
    assert releases >= 2
    assert worn > 0.1


def test_derivatives(run):
    """Newton's method with the derivatives of the step converges quadratically."""
    iterations = run("derivatives")[0]
    forces = [line[2] for line in iterations]
    assert len(iterations) <= 4
    errors = [abs(force - 3000.0) for force in forces]
    assert errors[-1] < 3e-3
    assert errors[-1] < 1e-3 * errors[-2]
