"""The exported functions against the standards' own headers: C programs are compiled, linked and run.

The headers are those that FMPy brings along. The assignment of each function to the header's type of it fails to
compile or link where one is missing, and the calls fail to run where a signature differs.
"""

import re
import shutil
import subprocess
from pathlib import Path

import fmpy
import pytest

IMPORTERS = Path(__file__).resolve().parent / "importers"
HEADERS = Path(fmpy.__file__).parent / "c-code"
VALGRIND = ("valgrind", "--quiet", "--error-exitcode=9", "--leak-check=full", "--errors-for-leak-kinds=definite")


@pytest.fixture(scope="module")
def compiled(tmp_path_factory):
    """Return a function that compiles a program of importers/."""
    if shutil.which("cc") is None:
        pytest.skip("no C compiler")

    def make(name, *options):
        executable = tmp_path_factory.mktemp("c") / name
        flags = ("-std=c99", "-Wall", "-Wextra", "-Werror", f"-I{HEADERS}")
        subprocess.run(["cc", *flags, IMPORTERS / f"{name}.c", "-o", executable, *options], check=True)
        return executable

    return make


@pytest.fixture(scope="module")
def mark():
    """Return the GUID of 2.0 and the token of 3.0, by version."""

    def of(archive):
        description = fmpy.read_model_description(archive)
        return description.guid or description.instantiationToken

    return of


def references(fmu3):
    """Return the value references that the program of 3.0 calls by other names, as options of the compiler."""
    names = {
        "LENGTH": "patch_nodes",
        "SWITCH": "wheel_heating",
        "ARRAY": "friction_table.coefficient",
        "FIELD": "patch.pressure",
        "TEXT": "rail_profile",
        "CONTACTS": "contact.normal_force",
    }
    variables = fmpy.read_model_description(fmu3).modelVariables
    found = {variable.name: variable.valueReference for variable in variables}
    return [f"-D{macro}={found[name]}" for macro, name in names.items()]


@pytest.fixture(scope="module", params=["fmi2", "fmi3"])
def program(request, compiled, library, mark, fmu, fmu3):
    """Return the command that runs the program of a version, linked with the library."""
    link = (str(library), f"-Wl,-rpath,{library.parent}")
    if request.param == "fmi2":
        return [compiled("fmi2", *link), mark(fmu)]
    return [compiled("fmi3", *references(fmu3), *link), mark(fmu3)]


def run(command):
    """Run a program; skip where valgrind does not know the processor."""
    result = subprocess.run(command, capture_output=True, text=True)
    output = result.stdout + result.stderr
    if "Unrecognised instruction" in output or "SIGILL" in output:
        pytest.skip("valgrind does not know the processor's vector instructions")
    return result


def test_compile_link_and_call_each_function(program):
    """All functions have the header's types and answer a C caller."""
    result = run(program)
    assert result.returncode == 0, result.stdout + result.stderr
    assert "bytes of state" in result.stdout
    assert result.stderr == ""


def test_all_functions_of_the_header_are_in_the_program(library):
    """The program names each function that the header of 3.0 declares: none is forgotten in it."""
    declared = set(re.findall(r"FMI3_Export fmi3\w+TYPE\s+(fmi3\w+);", (HEADERS / "fmi3Functions.h").read_text()))
    named = set(re.findall(r"SAME\(\w+, (fmi3\w+)\)", (IMPORTERS / "fmi3.c").read_text()))
    assert named == declared
    assert len(declared) == 75


def test_valgrind_is_clean(program):
    """No invalid access and no leak on a short run."""
    if shutil.which("valgrind") is None:
        pytest.skip("no valgrind")
    result = run([*VALGRIND, *program])
    assert result.returncode == 0, result.stdout + result.stderr


def test_nothing_is_left_behind(compiled, library, mark, fmu, fmu3):
    """A thousand times loaded and unloaded: the second half leaves not one byte on the heap, and none is lost.

    Without glibc's caches of freed blocks, which count as in use.
    """
    command = [compiled("cycles", "-ldl"), library, mark(fmu), mark(fmu3)]
    result = run(["env", "GLIBC_TUNABLES=glibc.malloc.tcache_count=0", *command, "1000"])
    assert result.returncode == 0, result.stdout + result.stderr
    half, all_of_them = map(int, result.stdout.split())
    assert all_of_them == half
    if shutil.which("valgrind") is None:
        pytest.skip("no valgrind")
    result = run([*VALGRIND, *command, "3"])
    assert result.returncode == 0, result.stdout + result.stderr
