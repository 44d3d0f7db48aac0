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
    """All 34 functions of fmi2Functions.h for co-simulation, all 75 of fmi3Functions.h, and nothing else."""
    tool("nm", "--version")
    symbols = binaries.exports(library)
    of_version = [[symbol for symbol in symbols if re.fullmatch(rf"{fmi}[A-Z]\w+", symbol)] for fmi in ("fmi2", "fmi3")]
    assert [len(names) for names in of_version] == [34, 75]
    assert len(symbols) == 34 + 75, symbols


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


FMI2 = {"modelDescription.xml", "model.png", "binaries/linux64/wheelrail.so", "documentation/index.html"}
FMI3 = {
    "modelDescription.xml",
    "terminalsAndIcons/terminalsAndIcons.xml",
    "terminalsAndIcons/icon.png",
    "binaries/x86_64-linux/wheelrail.so",
    "documentation/index.html",
}


@pytest.mark.parametrize(("archive", "expected"), [("fmu", FMI2), ("fmu3", FMI3)])
def test_archive(request, archive, expected):
    """Stored or deflated entries only, at the standard's places, with one fixed date."""
    with zipfile.ZipFile(request.getfixturevalue(archive)) as packed:
        entries = packed.infolist()
    names = {entry.filename for entry in entries}
    assert expected <= names
    assert "documentation/licenses/license.txt" in names
    assert {entry.compress_type for entry in entries} <= {zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED}
    assert len({entry.date_time for entry in entries}) == 1


def test_both_archives_have_the_same_library(fmu, fmu3):
    """Nothing is compiled twice."""
    libraries = [
        zipfile.ZipFile(archive).read(f"binaries/{folder}/wheelrail.so")
        for archive, folder in ((fmu, "linux64"), (fmu3, "x86_64-linux"))
    ]
    assert libraries[0] == libraries[1]


def test_archive_is_the_same_each_time(wheelrail, tmp_path):
    """Packing again gives the same bytes."""
    library = (REPOSITORY / "target" / "library.path").read_text().strip()
    for version in ("2", "3"):
        archives = [tmp_path / "first.fmu", tmp_path / "second.fmu"]
        for archive in archives:
            pack = [wheelrail, "pack", "--fmi", version, "--library", library, "-o", archive]
            subprocess.run(pack, cwd=REPOSITORY, check=True)
        assert archives[0].read_bytes() == archives[1].read_bytes()


def test_archive_says_what_compiled_it(unpacked):
    """A line for each platform, with the versions of compiler and linker."""
    lines = (unpacked / "documentation" / "build.txt").read_text().splitlines()
    platforms = sorted(path.name for path in (unpacked / "binaries").iterdir())
    assert [line.split(":")[0] for line in lines] == platforms
    assert all(re.search(r"rustc \d+\.\d+\.\d+ .*; linked by ", line) for line in lines), lines


@pytest.mark.parametrize(
    ("archive", "name", "schema"),
    [
        ("fmu", "modelDescription.xml", "fmi2/fmi2ModelDescription.xsd"),
        ("fmu3", "modelDescription.xml", "fmi3/fmi3ModelDescription.xsd"),
        ("fmu3", "terminalsAndIcons/terminalsAndIcons.xml", "fmi3/fmi3TerminalsAndIcons.xsd"),
    ],
)
def test_schema(request, archive, name, schema):
    """Each XML file is valid under the standard's schema, as FMPy brings it along."""
    from importlib.resources import files

    from lxml import etree

    rules = etree.XMLSchema(file=str(files("fmpy") / "schema" / schema))
    tree = etree.fromstring(zipfile.ZipFile(request.getfixturevalue(archive)).read(name))
    assert rules.validate(tree), rules.error_log
    assert tree.get("fmiVersion") == {"fmu": "2.0", "fmu3": "3.0"}[archive]
