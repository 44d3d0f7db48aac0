"""Where the FMUs are, unpacked once in a process."""

import atexit
import shutil
import tempfile
import tomllib
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any, TypeAlias

import fmpy
from fmpy.model_description import ModelDescription

# The archive of each version of the standard, as the package's build puts it beside this file.
ARCHIVES = {"2.0": "WheelRailContact.fmu", "3.0": "WheelRailContact-fmi3.fmu"}
PACKAGE = Path(__file__).resolve().parent

AnyPath: TypeAlias = str | PathLike[str]


def fmu_path(version: str = "2.0") -> Path:
    """Path of the FMU.

    Parameters
    ----------
    version
        Version of the FMI standard, "2.0" or "3.0".

    Raises
    ------
    ValueError
        There is no such version.
    FileNotFoundError
        The package was built without that FMU.
    """
    if version not in ARCHIVES:
        raise ValueError(f"FMI version {version!r}: choose one of {', '.join(ARCHIVES)}")
    path = PACKAGE / "fmu" / ARCHIVES[version]
    if not path.exists():
        there = [name for name, file in ARCHIVES.items() if (path.parent / file).exists()]
        raise FileNotFoundError(f"{path} is not there; FMUs in this package: {', '.join(there) or 'none'}")
    return path


def example(name: str = "braking") -> Path:
    """Path of a table of inputs to begin with.

    Parameters
    ----------
    name
        "braking": from 20 m/s, with a wheel slide; for `slip_source="vehicle_speed"`.
    """
    path = PACKAGE / "data" / f"{name}.csv"
    if not path.exists():
        there = sorted(file.stem for file in path.parent.glob("*.csv"))
        raise FileNotFoundError(f"{path} is not there; tables in this package: {', '.join(there) or 'none'}")
    return path


def preset(name: str) -> dict[str, Any]:
    """A named set of parameters: `simulate(table, **preset("wet"))`.

    Parameters
    ----------
    name
        "dry", "wet", "contaminated" or "eurosprinter"; where each value comes from is in the package's presets.
    """
    folder = PACKAGE / "presets"
    if not folder.exists():
        # A package that runs from the repository.
        folder = PACKAGE.parent.parent / "presets"
    path = folder / f"{name}.toml"
    if not path.exists():
        there = sorted(file.stem for file in folder.glob("*.toml"))
        raise FileNotFoundError(f"preset {name!r}: there is none of this name; presets: {', '.join(there) or 'none'}")
    parameters: dict[str, Any] = tomllib.loads(path.read_text(encoding="utf-8"))["parameters"]
    return parameters


def description(fmu: AnyPath) -> ModelDescription:
    """Model description of an FMU, read once."""
    return read_description(fspath(fmu))


@cache
def read_description(fmu: str) -> ModelDescription:
    """Read a model description; that the archive is valid is tested where it is built."""
    return fmpy.read_model_description(fmu, validate=False)


def unpacked(fmu: AnyPath) -> str:
    """Folder of an unpacked FMU: unpacked once, removed when the process ends."""
    return unpack(fspath(fmu))


@cache
def unpack(fmu: str) -> str:
    """Unpack an FMU."""
    folder = tempfile.mkdtemp(prefix="fmu-")
    atexit.register(shutil.rmtree, folder, ignore_errors=True)
    return str(fmpy.extract(fmu, folder))
