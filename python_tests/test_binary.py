"""The shared libraries in the archive: what they export, what they need, where they load."""

import re
import shutil
import subprocess
import sys
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY / "tools"))

import binaries  # noqa: E402


def tool(*command):
    """Return what a tool of binutils prints."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"no {command[0]}")
    return subprocess.check_output(command, text=True)


def test_exports_only_the_standard(library):
    """All 34 functions of fmi2Functions.h for co-simulation, and nothing else."""
    tool("nm", "--version")
    symbols = binaries.exports(library)
    assert len(symbols) == 34
    assert all(re.fullmatch(r"fmi2[A-Z]\w+", symbol) for symbol in symbols), symbols


def test_needs_only_the_c_library(library):
    """libc, libm, libgcc_s and what an old glibc splits off them; no folder where they would have to be."""
    assert not re.search(r"RPATH|RUNPATH", tool("readelf", "-d", library))
    needed = binaries.needs(library)
    assert "libc.so.6" in needed
    assert needed <= binaries.NEEDED["linux64"]


def test_loads_on_old_systems(library):
    """No symbol of a glibc newer than 2.17."""
    if (REPOSITORY / "target" / "library.portable").read_text().strip() != "True":
        pytest.skip("not the portable build: cargo-zigbuild was not usable, `make fmu` says why")
    tool("objdump", "--version")
    assert (0, 0) < binaries.newest_glibc(library) <= binaries.OLDEST_GLIBC


@pytest.mark.parametrize("name", ["win64/wheelrail.dll"])
def test_other_platforms(unpacked, library, name):
    """The same functions as on linux64, and no library that the system does not have."""
    other = unpacked / "binaries" / name
    if not other.exists():
        pytest.skip(f"the archive has no {name}: `make platforms` adds it")
    tool("objdump", "--version")
    assert binaries.complaints(other.parent.name, other, binaries.exports(library)) == []


@pytest.mark.parametrize("folder", ["/home", "/root", "/tmp", "/usr/lib/rustlib", str(REPOSITORY)])
def test_names_no_folder_of_the_machine_that_compiled_it(library, folder):
    """Compiled in another folder the library has the same bytes: it names none."""
    if (REPOSITORY / "target" / "library.portable").read_text().strip() != "True":
        pytest.skip("not the portable build: cargo-zigbuild was not usable, `make fmu` says why")
    assert f"{folder}/".encode() not in library.read_bytes()


def test_is_stripped(library):
    """No symbol table but the dynamic one, no debugging sections."""
    sections = tool("readelf", "-SW", library)
    assert ".dynsym" in sections
    assert ".symtab" not in sections
    assert ".debug_info" not in sections


def test_archive(fmu):
    """Stored or deflated entries only, at the standard's places, with one fixed date."""
    with zipfile.ZipFile(fmu) as archive:
        entries = archive.infolist()
    names = {entry.filename for entry in entries}
    assert {"modelDescription.xml", "model.png", "binaries/linux64/wheelrail.so", "documentation/index.html"} <= names
    assert any(name.startswith("documentation/licenses/") for name in names)
    assert {entry.compress_type for entry in entries} <= {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
    assert len({entry.date_time for entry in entries}) == 1


def test_archive_is_the_same_each_time(wheelrail, tmp_path):
    """Packing again gives the same bytes."""
    library = (REPOSITORY / "target" / "library.path").read_text().strip()
    archives = [tmp_path / "first.fmu", tmp_path / "second.fmu"]
    for archive in archives:
        subprocess.run([wheelrail, "pack", "--library", library, "-o", archive], cwd=REPOSITORY, check=True)
    assert archives[0].read_bytes() == archives[1].read_bytes()


def test_archive_says_what_compiled_it(unpacked):
    """A line for each platform, with the versions of compiler and linker."""
    lines = (unpacked / "documentation" / "build.txt").read_text().splitlines()
    platforms = sorted(path.name for path in (unpacked / "binaries").iterdir())
    assert [line.split(":")[0] for line in lines] == platforms
    assert all(re.search(r"rustc \d+\.\d+\.\d+ .*; linked by ", line) for line in lines), lines


def test_schema(description, unpacked):
    """modelDescription.xml is valid under the standard's schema, as FMPy brings it along."""
    from importlib.resources import files

    from lxml import etree

    schema = etree.XMLSchema(file=str(files("fmpy") / "schema" / "fmi2" / "fmi2ModelDescription.xsd"))
    tree = etree.parse(str(unpacked / "modelDescription.xml"))
    assert schema.validate(tree), schema.error_log
    assert description.fmiVersion == "2.0"
