"""The shared library in the archive: what it exports, what it needs, where it loads."""

import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import pytest

REPOSITORY = Path(__file__).resolve().parent.parent
# glibc 2.17 keeps dl, pthread and rt in libraries of their own.
ALLOWED = {
    "libc.so.6",
    "libm.so.6",
    "libgcc_s.so.1",
    "ld-linux-x86-64.so.2",
    "libdl.so.2",
    "libpthread.so.0",
    "librt.so.1",
}


def tool(*command):
    """Return what a tool of binutils prints."""
    if shutil.which(command[0]) is None:
        pytest.skip(f"no {command[0]}")
    return subprocess.check_output(command, text=True)


def test_exports_only_the_standard(library):
    """All 34 functions of fmi2Functions.h for co-simulation, and nothing else."""
    symbols = {line.split()[-1] for line in tool("nm", "-D", "--defined-only", library).splitlines()}
    assert len(symbols) == 34
    assert all(re.fullmatch(r"fmi2[A-Z]\w+", symbol) for symbol in symbols), symbols


def test_needs_only_the_c_library(library):
    """libc, libm, libgcc_s and what an old glibc splits off them."""
    needed = re.findall(r"\(NEEDED\).*\[(.+)\]", tool("readelf", "-d", library))
    assert "libc.so.6" in needed
    assert set(needed) <= ALLOWED
    assert not re.search(r"RPATH|RUNPATH", tool("readelf", "-d", library))


def test_loads_on_old_systems(library):
    """No symbol of a glibc newer than 2.17."""
    if (REPOSITORY / "target" / "library.portable").read_text().strip() != "True":
        pytest.skip("not the portable build: cargo-zigbuild was not usable, `make fmu` says why")
    versions = re.findall(r"GLIBC_(\d+)\.(\d+)", tool("objdump", "-T", library))
    assert versions
    assert max((int(major), int(minor)) for major, minor in versions) <= (2, 17)


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


def test_archive_is_the_same_each_time(fmu, wheelrail, tmp_path):
    """Packing again gives the same bytes."""
    library = (REPOSITORY / "target" / "library.path").read_text().strip()
    again = tmp_path / "again.fmu"
    subprocess.run([wheelrail, "pack", "--library", library, "-o", again], cwd=REPOSITORY, check=True)
    assert again.read_bytes() == Path(fmu).read_bytes()


def test_schema(description, unpacked):
    """modelDescription.xml is valid under the standard's schema, as FMPy brings it along."""
    from importlib.resources import files

    from lxml import etree

    schema = etree.XMLSchema(file=str(files("fmpy") / "schema" / "fmi2" / "fmi2ModelDescription.xsd"))
    tree = etree.parse(str(unpacked / "modelDescription.xml"))
    assert schema.validate(tree), schema.error_log
    assert description.fmiVersion == "2.0"
