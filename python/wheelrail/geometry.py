"""Profiles of wheels and rails, and where a wheelset touches its track, by the command line `wheelrail`."""

import copy
import errno
import hashlib
import numbers
import os
import re
import shutil
import subprocess
import sysconfig
import tempfile
import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cache
from os import PathLike, fspath
from pathlib import Path
from typing import Any, NamedTuple, TypeAlias

import numpy as np
import pandas as pd

from .archive import PACKAGE, AnyPath, kept_folder
from .arguments import counted, finite
from .units import heading
from .variables import near

NAME = "wheelrail.exe" if os.name == "nt" else "wheelrail"
# Names of a file, by which the command knows what a profile is: with y to the field side and z as the format has it.
ENDINGS = {"rail": ".prr", "wheel": ".prw"}

# Beginnings of the names of folders: that of the files of profiles that are parameters, in it those of inclined rails.
GIVEN, INCLINED = "wheelrail-profiles-", "inclined-"

# Arc lengths that one call of the command is given: Windows takes some 32 000 letters.
ARCS_AT_ONCE = 1000

# Options of a profile that are one of a few words.
CHOICES = {"body": ("rail", "wheel"), "unit": ("m", "mm", "in", "inch")}
CHOICES |= {"y_to": ("field", "gauge"), "z": ("up", "down")}

# Numbers that `contact_geometry` takes by name.
DIMENSIONS = ["gauge", "gauge_depth", "rail_inclination", "flange_back_distance", "flange_back_position"]
DIMENSIONS += ["wheel_radius", "wheel_radius_right", "smoothing"]


def command_path() -> Path:
    """Path of the command line: in a clone its own, else that which was installed with the package.

    Raises
    ------
    FileNotFoundError
        There is none: the package is that for platforms without a command.
    """
    clone = PACKAGE.parent.parent
    places = [clone / "target" / "release" / NAME] if (clone / "Cargo.toml").exists() else []
    schemes = [scheme for scheme in sysconfig.get_scheme_names() if scheme == f"{os.name}_user"]
    places += [Path(sysconfig.get_path("scripts")) / NAME]
    places += [Path(sysconfig.get_path("scripts", scheme)) / NAME for scheme in schemes]
    found = next((path for path in places if path.exists()), None) or shutil.which(NAME)
    if found is None:
        raise FileNotFoundError(
            f"the command {NAME} is neither in {' nor in '.join(str(path.parent) for path in places)}: profiles need a"
            " package with it, or a clone in which `make command` was run"
        )
    return Path(found)


def run(*arguments: str, named: Mapping[Path, str] | None = None) -> "subprocess.CompletedProcess[str]":
    """Call the command: its result on the standard output, and what it says beside on the standard error.

    Parameters
    ----------
    *arguments
        What it is given.
    named
        What errors call the files that were made for the call, as the user knows nothing of them.

    Raises
    ------
    ValueError
        It refused, in its words.
    """
    done = subprocess.run([command_path(), *arguments], capture_output=True, text=True, encoding="utf-8", check=False)
    if done.returncode != 0:
        # Before the error it may have said what the profile is.
        text = (
            re.split("^wheelrail: ", done.stderr.strip(), flags=re.MULTILINE)[-1]
            or f"{arguments[0]}: {done.returncode}"
        )
        raise ValueError(called(text, named or {}))
    return done


def called(text: str, named: Mapping[Path, str]) -> str:
    """A text of the command in the package's words: names in place of files that were made for the call."""
    text = text.replace("(--smoothing)", "(smoothing=…)")
    for path, name in named.items():
        text = text.replace(str(path), name).replace(path.name, name)
    return text


@cache
def built_in_names() -> tuple[str, ...]:
    """Names of the profiles that are built in."""
    return tuple(line.split()[0] for line in run("profile").stdout.splitlines())


def file_of(profile: AnyPath) -> str:
    """The name of a profile that is built in, or the path of a file, which is there and can be read.

    Raises
    ------
    OSError
        The file is not there, or cannot be read.
    """
    text = fspath(profile)
    path = Path(text)
    # Without an ending it may be the name of a built-in profile, misspelt: the command says which there are.
    if text.casefold() not in map(str.casefold, built_in_names()) and (path.suffix or path.exists()):
        with path.open("rb"):
            pass
    return text


def places(name: str, values: Any) -> np.ndarray:
    """A list of finite numbers, or a single one, as an array.

    Raises
    ------
    ValueError
        It is none.
    """
    try:
        found = np.atleast_1d(np.asarray(values, dtype=float))
    except (TypeError, ValueError):
        raise ValueError(f"{name}: a list of numbers is needed") from None
    if found.ndim > 1:
        raise ValueError(f"{name} has {found.ndim} dimensions: a list of numbers is needed")
    if (wrong := np.flatnonzero(~np.isfinite(found))).size:
        raise ValueError(f"{name}[{wrong[0]}] = {found[wrong[0]]}: a finite number is needed")
    return found


def options(values: Mapping[str, Any]) -> list[str]:
    """Options of the command from names and values, those that are None left out.

    Raises
    ------
    ValueError
        A word that is none of its choices, a number that is not finite.
    TypeError
        A value that is no number.
    """
    given = {name: value for name, value in values.items() if value is not None}
    return [f"--{name.replace('_', '-')}={option(name, value)}" for name, value in given.items()]


def option(name: str, value: Any) -> str:
    """An option's value as the command reads it."""
    if name in CHOICES:
        if value not in CHOICES[name]:
            hint = near(str(value), CHOICES[name])
            raise ValueError(f"{name} = {value!r}: choose one of {', '.join(CHOICES[name])}{hint}")
        return str(value)
    if isinstance(value, np.generic):
        value = value.item()
    whole = name == "part"
    if isinstance(value, bool) or not isinstance(value, numbers.Integral if whole else numbers.Real):
        raise TypeError(f"{name} = {value!r}: a {'whole ' if whole else ''}number is needed")
    if not np.isfinite(finite(name, value)):
        raise ValueError(f"{name} = {value!r}: a finite number is needed")
    if whole and value < 1:
        raise ValueError(f"{name} = {value!r}: 1 or more is needed")
    return str(value) if whole else repr(float(value))


def table_of(path: Path) -> pd.DataFrame:
    """A table that the command wrote, with names as headings and the units in `attrs`."""
    table = pd.read_csv(path)
    heads = [heading(str(column)) for column in table]
    table.columns = pd.Index([head.name for head in heads])
    table.attrs["units"] = {head.name: head.unit for head in heads if head.unit is not None}
    return table


@dataclass(frozen=True)
class WheelMeasures:
    """Measures of a wheel's profile by EN 15313, about the running circle [m].

    Attributes
    ----------
    flange_height
        Sh: of the flange's tip from the running circle.
    flange_thickness
        Sd: from the flange's back to its face 10 mm below the running circle.
    flange_gradient
        qR: along the axle, between the face 2 mm above the tip and 10 mm below the running circle.
    hollow_depth
        The largest radius to the field side of a place, less the radius there, at the place where that is most.
    """

    flange_height: float
    flange_thickness: float
    flange_gradient: float
    hollow_depth: float


@dataclass(frozen=True)
class WheelWear:
    """Difference of a wheel's profile to the new one, both with the flange's back and tip at the same place.

    Attributes
    ----------
    worn_area
        Area of the cross-section that is gone, from the tip of the flange to the field side [m²].
    tread_depth
        Depth at the running circle, along the radius [m].
    largest_depth
        Largest depth along the new profile's normal [m].
    largest_depth_position
        Lateral position of that depth on the new profile [m].
    """

    worn_area: float
    tread_depth: float
    largest_depth: float
    largest_depth_position: float


class CurvePoint(NamedTuple):
    """Place, direction and curvature of a profile at arc lengths: those along y and z are the last axis of an array.

    Attributes
    ----------
    place
        Lateral position y, positive to the field side, and height z [m].
    tangent
        Unit tangent in the direction of rising arc length.
    curvature
        Derivative of the tangent's angle, from y towards z, over the arc length [1/m].
    """

    place: np.ndarray
    tangent: np.ndarray
    curvature: np.ndarray


class Profile:
    """Profile of a wheel or a rail, built in or from a file.

    y points to the field side, outwards from the track's middle, and z upward, in metres. A rail's origin is its
    highest point, a wheel's its running circle. Where the file does not say how it is turned and in which unit it is,
    the shape may show it; else the error says what has to be given.

    Parameters
    ----------
    profile
        A name of `Profile.built_in()`, or the path of a file: SIMPACK (.prr, .prw), MiniProf (.ban, .whl, .mpt),
        VAMPIRE, or columns y and z.
    body
        "rail" or "wheel", where the file does not say it.
    unit
        Unit of the file's coordinates: "m", "mm" or "in".
    y_to
        Direction of the file's y: "field" or "gauge".
    z
        Direction of the file's z: "up" or "down".
    part
        Number of the profile in a file with more than one.
    flange_back_position
        Distance of a wheel's running circle from the back of its flange, where the y of the file is not 0 on the
        running circle: moves the points, the outermost of which is the back [m]. That of `contact_geometry` says where
        the wheels stand in the track.
    smoothing
        Wavelength of the smoothing: waves of this length are halved [m].
    inclination
        Inclination that a rail is given, as a slope: 1/40.

    Attributes
    ----------
    name, body, source
        What it is called, of which body it is, and where it comes from.
    points
        Data frame: y, z, arc_length, inclination, curvature; `attrs["units"]` has their units.

    Raises
    ------
    ValueError
        It is no profile, or that of the other body.
    OSError
        The file is not there, or cannot be read.

    Examples
    --------
    >>> rail = Profile("60E1", inclination=1 / 40)
    >>> abs(float(rail.points["z"].max())) < 1e-9
    True
    """

    def __init__(
        self,
        profile: AnyPath,
        *,
        body: str | None = None,
        unit: str | None = None,
        y_to: str | None = None,
        z: str | None = None,
        part: int | None = None,
        flange_back_position: float | None = None,
        smoothing: float | None = None,
        inclination: float | None = None,
    ) -> None:
        """Read it."""
        given = {"body": body, "unit": unit, "y_to": y_to, "z": z, "part": part, "smoothing": smoothing}
        given |= {"flange_back_position": flange_back_position, "inclination": inclination}
        self._read(["profile", file_of(profile), *options(given)])
        self._built_in = self.name if inclination is None and self.name in built_in_names() else None
        self._inclined = bool(inclination)

    def _read(self, arguments: list[str], named: Mapping[Path, str] | None = None) -> None:
        """Take the profile of these arguments of the command; errors call files as `run` does."""
        with tempfile.TemporaryDirectory() as folder:
            table = Path(folder) / "profile.csv"
            said = run(*arguments, "--output", str(table), named=named).stderr.strip()
            self.points = table_of(table)
            # As a file that says itself how it is turned, for `contact_geometry` and `write`.
            found = re.fullmatch(r"(.*): (rail|wheel), (.*)", said)
            if found is None:
                raise ValueError(f"{arguments[1]}: {said}")
            self.name, self.body, self.source = found.groups()
            own = Path(folder) / f"profile{ENDINGS[self.body]}"
            run(*arguments, "--output", str(own))
            self._text = own.read_text(encoding="utf-8")

    @classmethod
    def from_points(cls, y: Any, z: Any, *, body: str, smoothing: float | None = None) -> "Profile":
        """Profile through points, or smoothed.

        Parameters
        ----------
        y, z
            Places, y to the field side and z upward, in either order along the profile [m].
        body
            "rail" or "wheel".
        smoothing
            Wavelength of the smoothing: waves of this length are halved [m].

        Raises
        ------
        ValueError
            Another number of y than of z, one that is not finite, or the points are no profile of that body.
        """
        columns = [places("y", y), places("z", z)]
        if columns[0].size != columns[1].size:
            raise ValueError(
                f"y has {counted(columns[0].size, 'value')} and z {columns[1].size}: as many of each are needed"
            )
        given = options({"body": body, "y_to": "field", "z": "up", "smoothing": smoothing})
        made = cls.__new__(cls)
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "points.csv"
            np.savetxt(path, np.column_stack(columns), delimiter=",", header="y [m],z [m]", comments="")
            made._read(["profile", str(path), *given], {path: "points"})
        made.name, made.source, made._built_in, made._inclined = "points", "given points", None, False
        return made

    @staticmethod
    def built_in() -> list[str]:
        """Names of the profiles that are built in."""
        return list(built_in_names())

    def write(self, path: AnyPath) -> None:
        """Write a file: SIMPACK (.prr, .prw), MiniProf (.ban, .whl, .mpt), VAMPIRE (.rai, .whe), or CSV of `points`.

        Raises
        ------
        ValueError
            The ending is that of files of the other body.
        OSError
            The file cannot be written.
        """
        path = Path(path)
        if path.is_dir():
            raise IsADirectoryError(errno.EISDIR, os.strerror(errno.EISDIR), str(path))
        with tempfile.TemporaryDirectory() as own, tempfile.TemporaryDirectory() as other:
            written = Path(other) / path.name
            self._run(Path(own), "--output", str(written), named={written: str(path)})
            # Here, so that an error of the system is one of Python.
            path.write_bytes(written.read_bytes())

    def at(self, arc: Any) -> CurvePoint:
        """Place, tangent and curvature at an arc length, or at each of several.

        Of a profile that is not built in they are those of its file, written and read again: places to 10 nm; where the
        curvature jumps it passes over between the points beside the jump.

        Parameters
        ----------
        arc
            Arc length as in `points`, a number or a list of them; beyond the ends the profile goes on straight [m].

        Raises
        ------
        ValueError
            One is no finite number, or the list has more than one dimension.

        Examples
        --------
        >>> tread = Profile("cone40").at([0.01, 0.02])
        >>> (tread.tangent[:, 1] / tread.tangent[:, 0]).round(6).tolist()
        [0.025, 0.025]
        """
        arcs = places("arc", arc)
        found = [np.empty((0, 4))]
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            for first in range(0, arcs.size, ARCS_AT_ONCE):
                table = folder / "at.csv"
                listed = ",".join(map(repr, arcs[first : first + ARCS_AT_ONCE].tolist()))
                self._run(folder, f"--at={listed}", "--output", str(table))
                found.append(table_of(table)[["y", "z", "inclination", "curvature"]].to_numpy())
        y, z, inclination, curvature = (part.reshape(np.shape(arc)) for part in np.concatenate(found).T)
        tangent = np.stack([np.cos(inclination), np.sin(inclination)], axis=-1)
        return CurvePoint(np.stack([y, z], axis=-1), tangent, curvature)

    def smoothed(self, smoothing: float) -> "Profile":
        """Profile whose short waves are damped, after it has worn for example.

        Parameters
        ----------
        smoothing
            Wavelength of the smoothing: waves of this length are halved, 0 leaves all of them [m].

        Raises
        ------
        ValueError
            The wavelength is not from 0 to 0.1 m.
        TypeError
            It is no number.
        """
        # Asked for by name: None is no wavelength.
        given = f"--smoothing={option('smoothing', smoothing)}"
        if smoothing == 0.0:
            return copy.deepcopy(self)
        smooth = Profile.__new__(Profile)
        with tempfile.TemporaryDirectory() as name:
            own = self._file(Path(name), "profile")
            smooth._read(["profile", own, given], {Path(own): self.name})
        smooth.name, smooth.source, smooth._built_in, smooth._inclined = self.name, self.source, None, self._inclined
        return smooth

    def worn_by(self, arc_length: Any, depth: Any) -> "Profile":
        """Profile that has worn by depths along its normal.

        Parameters
        ----------
        arc_length
            Places, ascending, as in `points` [m].
        depth
            Depth at each of them, or one for all: positive where material is gone. Between the places it is a monotone
            cubic, before the first one and behind the last it is theirs [m].

        Raises
        ------
        ValueError
            The places do not ascend or lie beyond the profile, or have another number of depths; the depth reaches the
            radius of curvature.

        Examples
        --------
        >>> wheel = Profile("S1002")
        >>> worn = wheel.worn_by([0.09, 0.1, 0.11], [0.0, 1e-3, 0.0])
        >>> round(1e3 * worn.measures().flange_height, 2)
        28.26
        """
        along, depths = places("arc_length", arc_length), places("depth", depth)
        if depths.size not in (1, along.size):
            raise ValueError(
                f"depth has {depths.size} values and arc_length {along.size}: one for each place is needed, or"
                " one for all"
            )
        rows = np.column_stack([along, np.broadcast_to(depths, along.shape)])
        worn = Profile.__new__(Profile)
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            table = folder / "depths.csv"
            # As many digits as read back to the same number.
            np.savetxt(table, rows, fmt="%.17g", delimiter=",", header="arc_length [m],depth [m]", comments="")
            own = self.argument(folder, "profile")
            worn._read(["profile", own, f"--worn-by={table}"], {Path(own): self.name, table: "the depths"})
        suffix = ", worn" if np.any(rows[:, 1]) and not self.source.endswith(", worn") else ""
        worn.name, worn.source, worn._built_in, worn._inclined = self.name, self.source + suffix, None, self._inclined
        return worn

    def measures(self, *, flange_back_position: float = 0.07) -> WheelMeasures:
        """Measures of a wheel by EN 15313: height, thickness and gradient of its flange, hollow of its tread.

        Parameters
        ----------
        flange_back_position
            Distance of the running circle from the flange's back, from which the flange's thickness is measured [m].

        Raises
        ------
        ValueError
            It is a rail, has no flange of 12 mm, or begins on it before its tip; the distance is not 0.01 to 0.2 m.
        TypeError
            The distance is no number.

        Examples
        --------
        >>> round(1e3 * Profile("S1002").measures().flange_thickness, 2)
        32.5
        """
        with tempfile.TemporaryDirectory() as name:
            back = option("flange_back_position", flange_back_position)
            return WheelMeasures(**self._measured(Path(name), f"--back={back}"))

    def worn_against(self, new: "AnyProfile") -> WheelWear:
        """Wear of a wheel against its new profile: back and tip of the flange, which no rail touches, agree.

        Parameters
        ----------
        new
            The new profile: a name, the path of a file that says how it is turned, or a `Profile`.

        Raises
        ------
        ValueError
            One of both has no measures of a wheel.
        OSError
            The new profile's file is not there, or cannot be read.
        """
        with tempfile.TemporaryDirectory() as name:
            folder = Path(name)
            other = new.argument(folder, "new") if isinstance(new, Profile) else file_of(new)
            named = {Path(other): new.name} if isinstance(new, Profile) else {}
            found = self._measured(folder, f"--against={other}", named=named)
        return WheelWear(**{key: value for key, value in found.items() if key in WheelWear.__annotations__})

    def worn_area(self, new: "AnyProfile") -> float:
        """Area of the cross-section that a wheel has lost against its new profile, as in `worn_against` [m²]."""
        return self.worn_against(new).worn_area

    def _measured(self, folder: Path, *arguments: str, named: Mapping[Path, str] | None = None) -> dict[str, float]:
        """What the command measures, by name."""
        table = folder / "measures.csv"
        self._run(folder, "--measures", *arguments, "--output", str(table), named=named)
        return {str(name): float(value) for name, value in table_of(table).iloc[0].items()}

    def _run(self, folder: Path, *arguments: str, named: Mapping[Path, str] | None = None) -> None:
        """Call the command for this profile, which errors call by its name."""
        own = self.argument(folder, "profile")
        run("profile", own, *arguments, named={Path(own): self.name, **(named or {})})

    def argument(self, folder: Path, name: str) -> str:
        """What the command is given for this profile: its name, or a file for the given purpose in a folder."""
        if self._built_in is not None:
            return self._built_in
        return self._file(folder, name)

    def _file(self, folder: Path, name: str) -> str:
        """File of this profile, for the given purpose, in a folder."""
        # No file of the user's is likely to be called so: errors are told with the profile's name in its place.
        path = folder / f"wheelrail-given-{name}{ENDINGS[self.body]}"
        path.write_text(self._text, encoding="utf-8")
        return str(path)

    def parameter(self) -> str:
        """What the component is given for this profile: its name, or a file that is kept until the process ends."""
        if self._built_in is not None:
            return self._built_in
        kind = INCLINED if self._inclined else ""
        digest = hashlib.sha256(self._text.encode()).hexdigest()[:16]
        path = given_folder(os.getpid()) / f"{kind}{digest}" / f"{Path(self.name).stem}{ENDINGS[self.body]}"
        if not path.exists():
            path.parent.mkdir(exist_ok=True)
            with tempfile.TemporaryDirectory(dir=path.parent) as own:
                # In one piece, as another thread may be reading it.
                Path(self._file(Path(own), "profile")).replace(path)
        return str(path)

    def __repr__(self) -> str:
        """Name and body."""
        return f"<Profile {self.name}: {self.body}, {self.source}>"


@cache
def given_folder(process: int) -> Path:
    """Folder of the files that a process has made of profiles for its components."""
    return Path(kept_folder(GIVEN, process))


def is_given(text: str) -> bool:
    """Whether the text of a parameter is the file of a `Profile`."""
    return Path(text).parent.parent.name.startswith(GIVEN)


def is_inclined(text: str) -> bool:
    """Whether it is that of one which was inclined when it was made."""
    return is_given(text) and Path(text).parent.name.startswith(INCLINED)


AnyProfile: TypeAlias = Profile | str | PathLike[str]


def contact_geometry(
    rail: AnyProfile = "60E1",
    wheel: AnyProfile = "S1002",
    *,
    rail_right: AnyProfile | None = None,
    wheel_right: AnyProfile | None = None,
    lateral: Sequence[float] = (-8e-3, 8e-3),
    step: float = 1e-4,
    yaw: float = 0.0,
    level: bool = False,
    outlines_at: float | None = None,
    **dimensions: float,
) -> pd.DataFrame:
    """Where the wheels of a wheelset touch the rails, over its lateral displacement, without forces.

    Both wheels touch: roll and height follow. Places on rail and wheel are positive to the field side, from the rail's
    highest point and the wheel's running circle.

    Parameters
    ----------
    rail, wheel
        Profiles: names, paths of files that say how they are turned, or a `Profile`.
    rail_right, wheel_right
        Those of the right side, where they are others.
    lateral
        First and last lateral displacement, to the left [m]. The table begins at the first one, and ends at the last
        one where that is a whole number of steps away, else at the last step before it.
    step
        Step of the displacement, from the first one on [m].
    yaw
        Yaw, anticlockwise from above [rad].
    level
        Whether the axle stays level, each wheel touching by itself: the reference results of EN 15302 are without roll.
    outlines_at
        Displacement at which `attrs["outlines"]` has the outlines of rails and wheels, which
        `plots.contact_geometry` draws [m].
    **dimensions
        `gauge` (1.435), `gauge_depth` (0.014), `rail_inclination` (a slope, 0.025; 0 for profiles that are inclined
        already), `flange_back_distance` (1.36), `flange_back_position` (0.07), `wheel_radius` (0.46),
        `wheel_radius_right`, `smoothing` of profiles from files (0) [m].

    Returns
    -------
    pandas.DataFrame
        A row for each displacement. `attrs["units"]` has the units, `attrs["jumps"]` the displacements at which a
        contact jumps and from where to where, `attrs["conicity"]` the equivalent conicity at 3 mm, or None.

    Raises
    ------
    ValueError
        A profile or a dimension does not serve; a wheel stands beside its rail or on the tip of its flange.
    TypeError
        A dimension that there is not, or one that is no number; `lateral` is not two numbers.
    OSError
        A profile's file is not there, or cannot be read.

    Warns
    -----
    UserWarning
        A profile's direction turns to and fro, as noise does, and the contacts jump with it: smoothing takes that off.

    Examples
    --------
    >>> table = contact_geometry("60E1", "S1002", lateral=(-4e-3, 4e-3))
    >>> round(table.attrs["conicity"], 3)
    0.177
    """
    if others := [name for name in dimensions if name not in DIMENSIONS]:
        raise TypeError(f"there is no dimension {others[0]}; there are {', '.join(DIMENSIONS)}")
    try:
        first, last = lateral
    except (TypeError, ValueError):
        raise TypeError(f"lateral = {lateral!r}: two numbers are needed, the first and the last displacement") from None
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        given = {"rail": rail, "wheel": wheel, "rail_right": rail_right, "wheel_right": wheel_right}
        profiles = {
            key: value.argument(folder, key) if isinstance(value, Profile) else file_of(value)
            for key, value in given.items()
            if value is not None
        }
        named = {Path(profiles[key]): value.name for key, value in given.items() if isinstance(value, Profile)}
        files = {key: folder / f"{key}.csv" for key in ("output", "jumps", "outlines")}
        if outlines_at is None:
            del files["outlines"]
        amounts = {"from": first, "to": last, "step": step, "yaw": yaw, "outlines_at": outlines_at, **dimensions}
        texts = [f"--{key.replace('_', '-')}={text}" for key, text in (profiles | files).items()]
        said = run("geometry", *texts, *options(amounts), *(["--level"] if level else []), named=named).stderr
        table = table_of(files["output"])
        table.attrs["jumps"] = table_of(files["jumps"]).to_dict("records")
        if outlines_at is not None:
            table.attrs["outlines"] = table_of(files["outlines"]).to_dict("list")
    for line in said.splitlines():
        if line.startswith("remark: "):
            warnings.warn(called(line.removeprefix("remark: "), named), stacklevel=2)
    marker = "equivalent conicity at 3 mm: "
    table.attrs["conicity"] = next(
        (float(line.removeprefix(marker)) for line in said.splitlines() if line.startswith(marker)), None
    )
    return table
