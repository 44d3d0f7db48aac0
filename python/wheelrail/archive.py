"""Where the FMUs are, unpacked once in a process."""

import atexit
import os
import shutil
import tempfile
import tomllib
import zipfile
from functools import cache
from multiprocessing.util import Finalize
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
        words = f"{path} is not there; FMUs in this package: {', '.join(there) or 'none'}"
        # A package that runs from the repository has none in it.
        clone = PACKAGE.parent.parent
        if (clone / "Makefile").exists():
            words += (
                "; in a clone `make wheel` builds the package with them, `make fmu fmu3` the FMUs alone, for"
                f" fmu={str(clone / 'target' / ARCHIVES[version])!r}"
            )
        raise FileNotFoundError(words)
    return path


def shipped(fmu: str) -> str:
    """The version of an FMU that is the package's own, which another machine has too; the path of another one."""
    own = {str(PACKAGE / "fmu" / file): version for version, file in ARCHIVES.items()}
    return own.get(fmu, fmu)


def example(name: str = "braking") -> Path:
    """Path of a table of inputs to begin with.

    Parameters
    ----------
    name
        "braking": from 20 m/s, with a wheel slide; for `slip_source="vehicle_speed"`.

    Raises
    ------
    ValueError
        There is no such table.
    FileNotFoundError
        The package was built without tables.
    """
    return named("table", name, PACKAGE / "data", ".csv")


def preset(name: str, /, **overrides: Any) -> dict[str, Any]:
    """A named set of parameters: `simulate(table, **preset("wet"))`.

    Parameters
    ----------
    name
        "dry", "wet", "contaminated" or "eurosprinter"; where each value comes from is in the package's presets.
    **overrides
        Parameters beside those of the set, or in their place: `simulate(table, **preset("wet", friction_cold=0.2))`.

    Returns
    -------
    dict
        Parameters by name.

    Raises
    ------
    ValueError
        There is no such set.
    TypeError
        The name is no text.
    """
    folder = PACKAGE / "presets"
    if not folder.exists():
        # A package that runs from the repository.
        folder = PACKAGE.parent.parent / "presets"
    parameters: dict[str, Any] = tomllib.loads(named("preset", name, folder, ".toml").read_text("utf-8"))["parameters"]
    return parameters | overrides


def named(what: str, name: str, folder: Path, suffix: str) -> Path:
    """The file of a name in one of the package's folders."""
    # It imports from here.
    from .variables import near

    if not isinstance(name, str):
        raise TypeError(f"{what} {name!r}: its name is a text")
    there = sorted(file.stem for file in folder.glob(f"*{suffix}"))
    if not there:
        raise FileNotFoundError(f"{what} {name!r}: this package was built without {folder.name}")
    if name not in there:
        raise ValueError(
            f"{what} {name!r}: there is none of this name; choose one of {', '.join(there)}{near(name, there)}"
        )
    return folder / f"{name}{suffix}"


def description(fmu: AnyPath) -> ModelDescription:
    """Model description of an FMU, read once.

    Raises
    ------
    FileNotFoundError
        The FMU is not there.
    ValueError
        The file is no FMU.
    """
    return read_description(fspath(fmu))


@cache
def read_description(fmu: str) -> ModelDescription:
    """Read a model description; that the archive is valid is tested where it is built."""
    if not Path(fmu).exists():
        raise FileNotFoundError(f"{fmu} is not there")
    if not zipfile.is_zipfile(fmu):
        raise ValueError(f"{fmu} is no FMU: an FMU is a zip archive")
    try:
        return fmpy.read_model_description(fmu, validate=False)
    # FMPy has no type of its own for what it cannot read.
    except Exception as error:
        raise ValueError(f"{fmu} is no FMU that can be read: {error}") from error


def unpacked(fmu: AnyPath) -> str:
    """Folder of an unpacked FMU: unpacked once by a process, removed when it ends."""
    return unpack(fspath(fmu), os.getpid())


@cache
def unpack(fmu: str, process: int) -> str:
    """Unpack an FMU for a process: a fork of it has its own folder, as either may end first."""
    return str(fmpy.extract(fmu, kept_folder("fmu-", process)))


def kept_folder(prefix: str, process: int) -> str:
    """Make a folder that is removed when the process ends."""
    folder = tempfile.mkdtemp(prefix=prefix)
    atexit.register(remove, folder, process)
    # A process of multiprocessing ends without what is registered there, with what is here.
    Finalize(None, remove, (folder, process), exitpriority=0)
    return folder


def remove(folder: str, process: int) -> None:
    """Remove a folder at the end of the process that made it, not at that of its forks."""
    if os.getpid() == process:
        shutil.rmtree(folder, ignore_errors=True)
