"""A line as its distribution of curves, from a table, and a vehicle, from a file: what is wrong in either is named.

A line is a list of classes. Each has a radius, positive to the left and infinite on straight track, the cant of the
outer rail, a speed, the share of the line's length, the factor on friction at the gauge face, the friction coefficient,
the deviation of the track's lateral irregularity, and the traction of a wheelset there, which is negative where it
brakes. A mirrored line has its curves to the other hand.
"""

import csv
import math
import tomllib
from dataclasses import dataclass, fields, replace
from pathlib import Path

import numpy as np
from curve_vehicle import Vehicle
from helpers import wheelrail  # noqa: F401  the package's folder is on the path from here on
from wheelrail.units import heading, spelling

STRAIGHT = math.inf
# Units of a heading, by what a column is of: the factor to SI.
LENGTH = {"m": 1.0, "mm": 1e-3, "km": 1e3}
SPEED = {"m/s": 1.0, "km/h": 1.0 / 3.6}
NUMBER = {"1": 1.0, "%": 1e-2}
FORCE = {"N": 1.0, "kN": 1e3}
# Columns: units, unit in words, least and largest value.
COLUMNS = {
    "radius": (LENGTH, "m", -math.inf, math.inf),
    "cant": (LENGTH, "m", 0.0, 0.2),
    "speed": (SPEED, "m/s", 1.0, 100.0),
    "share": (NUMBER, "1", 0.0, math.inf),
    "length": (LENGTH, "m", 0.0, math.inf),
    "gauge_face_friction": (NUMBER, "1", 0.0, 2.0),
    "friction": (NUMBER, "1", 0.02, 1.0),
    "irregularity": (LENGTH, "m", 0.0, 5e-3),
    "traction": (FORCE, "N", -5e4, 5e4),
}
NEEDED = ("radius", "cant", "speed")
LEAST_RADIUS = 150.0  # m: below, the changes of Newton's method from straight running are too large


class BadInputError(ValueError):
    """A line, a vehicle or a profile that does not serve, with the field, its value and what is allowed."""


def wrong(where, field, value, allowed):
    """Return the error of a value."""
    return BadInputError(f"{where}: {field} = {value}: {allowed} is needed")


@dataclass(frozen=True)
class Curve:
    """A class of track: all its curves of one hand and about one radius, or the straight track."""

    radius: float  # m, positive to the left, infinite on straight track
    cant: float  # m
    speed: float  # m/s
    share: float  # of the line's length, all of them 1
    gauge_face_friction: float = 1.0  # factor on the friction coefficient
    friction: float = 0.35
    irregularity: float = 1.5e-3  # m: deviation of the track's lateral irregularity under a wheelset
    traction: float = 0.0  # N: force along the track that a wheelset's torque makes, positive drives

    @property
    def name(self):
        """What it is called in tables: R 300 right; straight, driven 8 kN."""
        hand = "left" if self.radius > 0.0 else "right"
        place = "straight" if math.isinf(self.radius) else f"R {abs(self.radius):g} {hand}"
        if self.traction == 0.0:
            return place
        return f"{place}, {'driven' if self.traction > 0.0 else 'braked'} {1e-3 * abs(self.traction):g} kN"

    def mirrored(self):
        """The same to the other hand."""
        return self if math.isinf(self.radius) else replace(self, radius=-self.radius)


def named(line):
    """The classes by names, each its own: those that share radius and traction are numbered."""
    found = {}
    for curve in line:
        alike = sum(other.name == curve.name for other in found.values())
        found[f"{curve.name}, {alike + 1}" if alike else curve.name] = curve
    return found


def both_hands(radius, cant, speed, share, **others):
    """Curves to the right and to the left, of half the share each: m, mm, km/h, 1."""
    right = Curve(-radius, 1e-3 * cant, speed / 3.6, 0.5 * share, **others)
    return [right, right.mirrored()]


def main_line(gauge_face_friction=1.0):
    """A line of some hills: half of it straight, the other half in curves down to 300 m; cant deficiencies 40 to 65 mm.

    It is no survey of a line. The factor is that at the gauge face in curves up to 800 m.
    """
    face = {"gauge_face_friction": gauge_face_friction}
    return [
        Curve(STRAIGHT, 0.0, 140.0 / 3.6, 0.50),
        *both_hands(3000.0, 30.0, 140.0, 0.16),
        *both_hands(1500.0, 70.0, 130.0, 0.15),
        *both_hands(800.0, 100.0, 105.0, 0.10, **face),
        *both_hands(500.0, 110.0, 85.0, 0.06, **face),
        *both_hands(300.0, 100.0, 60.0, 0.03, **face),
    ]


def straight_line(tractions=((1.0, 0.0),)):
    """A line over plains at 160 km/h: five sixths straight, the others curves of 3000 m.

    On straight track wheelsets have tractions [N], each over a share of it.
    """
    straight = [Curve(STRAIGHT, 0.0, 160.0 / 3.6, 5.0 / 6.0 * share, traction=force) for share, force in tractions]
    return [*straight, *both_hands(3000.0, 50.0, 160.0, 1.0 / 6.0)]


def short_line():
    """Straight track and one curve to the right: for the test."""
    return [Curve(STRAIGHT, 0.0, 30.0, 0.7), Curve(-500.0, 0.11, 85.0 / 3.6, 0.3)]


def mirrored(line):
    """The line with its curves to the other hand."""
    return [curve.mirrored() for curve in line]


def is_its_own_mirror(line):
    """Whether each curve has its like to the other hand."""
    return sorted(line, key=by_size) == sorted(mirrored(line), key=by_size)


def by_size(curve):
    """Key by which the classes of a line are ordered."""
    return tuple(getattr(curve, field.name) for field in fields(curve))


def read_line(path):
    """Read a line from a CSV file: columns radius, cant, speed, and share or length; units in the headings.

    Straight track has no radius, or 0. Columns that may be there: gauge_face_friction, friction, irregularity,
    traction.
    """
    path = Path(path)
    text = path.read_text(encoding="utf-8-sig")
    rows = list(csv.reader(line for line in text.splitlines() if line.strip() and not line.startswith("#")))
    if len(rows) < 2:
        raise BadInputError(f"{path.name}: headings and at least one row are needed")
    columns = [column_of(path, title) for title in rows[0]]
    names = [name for name, _ in columns]
    if twice := {name for name in names if names.count(name) > 1}:
        raise BadInputError(f"{path.name}: column {sorted(twice)[0]} is there twice")
    if lacking := [name for name in NEEDED if name not in names]:
        raise BadInputError(f"{path.name}: column {lacking[0]} is needed")
    if ("share" in names) == ("length" in names):
        raise BadInputError(f"{path.name}: either a column share or a column length is needed")
    found = [row_of(f"{path.name}, row {number}", columns, row) for number, row in enumerate(rows[1:], 1)]
    sizes = np.array([row.pop("share" if "share" in row else "length") for row in found])
    if not sizes.sum() > 0.0:
        raise BadInputError(f"{path.name}: the shares of the line are all 0")
    return [Curve(share=float(share), **row) for share, row in zip(sizes / sizes.sum(), found, strict=True)]


def column_of(path, title):
    """Name of a column and the factor of its unit."""
    name, unit = heading(title)
    if name not in COLUMNS:
        raise BadInputError(f"{path.name}: there is no column {name}; there are {', '.join(COLUMNS)}")
    units, own, *_ = COLUMNS[name]
    given = spelling(unit if unit is not None else own)
    if given not in units:
        raise BadInputError(f"{path.name}: {name} [{unit}]: the unit is not known; allowed is {', '.join(units)}")
    return name, units[given]


def row_of(where, columns, cells):
    """Values of a row by name, in SI units."""
    if len(cells) != len(columns):
        raise BadInputError(f"{where}: {len(cells)} values under {len(columns)} headings")
    found = {}
    for (name, factor), cell in zip(columns, cells, strict=True):
        cell = cell.strip()
        if name == "radius" and cell.lower() in ("", "0", "inf", "straight"):
            found[name] = STRAIGHT
            continue
        try:
            value = factor * float(cell)
        except ValueError:
            raise wrong(where, name, repr(cell), "a number") from None
        _, own, least, most = COLUMNS[name]
        unit = "" if own == "1" else f" {own}"
        if not least <= value <= most or math.isnan(value):
            raise wrong(where, name, f"{value:g}{unit}", f"{least:g} to {most:g}{unit}")
        if name == "radius" and abs(value) < LEAST_RADIUS:
            allowed = f"{LEAST_RADIUS:g} m or more, negative to the right, 0 on straight track"
            raise wrong(where, name, f"{value:g} m", allowed)
        found[name] = value
    if math.isinf(found["radius"]) and found["cant"] != 0.0:
        raise wrong(where, "cant", f"{found['cant']:g} m", "0 on straight track")
    return found


# ---- the vehicle ----------------------------------------------------------------------------------------------------

# Least and largest value of a field of Vehicle, all of a tuple's.
RANGES = {
    "wheel_radius": (0.2, 0.7),
    "wheelset_mass": (200.0, 5e3),
    "frame_mass": (100.0, 2e4),
    "body_mass": (1e3, 1e5),
    "wheelset_inertia": (1.0, 1e4),
    "frame_inertia": (10.0, 1e5),
    "body_inertia": (100.0, 1e7),
    "half_wheelbase": (0.5, 5.0),
    "half_spring_base": (0.3, 2.0),
    "half_secondary_base": (0.3, 2.0),
    "frame_height": (0.1, 2.0),
    "secondary_height": (0.1, 3.0),
    "body_height": (0.1, 5.0),
    "primary_stiffness": (1e4, 1e10),
    "primary_damping": (0.0, 1e7),
    "secondary_stiffness": (1e3, 1e9),
    "secondary_damping": (0.0, 1e7),
    "rail_stiffness": (1e6, 1e10),
    "pivots": (2.0, 30.0),
    "guide_stiffness": (0.0, 1e10),
    "guide_damping": (0.0, 1e9),
}


def read_vehicle(path):
    """Read a vehicle from a TOML file: fields of Vehicle in SI units; what is not there is the default's."""
    path = Path(path)
    try:
        given = tomllib.loads(path.read_text(encoding="utf-8"))
    except tomllib.TOMLDecodeError as error:
        raise BadInputError(f"{path.name}: {error}") from None
    return vehicle_of(given, path.name)


def vehicle_of(given, where="vehicle"):
    """Return a vehicle of fields by name."""
    known = {field.name: field.default for field in fields(Vehicle)}
    values = {}
    for name, value in given.items():
        if name not in known:
            raise BadInputError(f"{where}: there is no field {name}; there are {', '.join(known)}")
        wanted = len(known[name]) if isinstance(known[name], tuple) else 1
        numbers = list(value) if isinstance(value, list | tuple) else [value]
        fits = len(numbers) == wanted and isinstance(value, list | tuple) == isinstance(known[name], tuple)
        if not fits or not all(isinstance(n, int | float) and not isinstance(n, bool) for n in numbers):
            raise wrong(where, name, value, "a number" if wanted == 1 else f"a list of {wanted} numbers")
        least, most = RANGES[name]
        for number in numbers:
            if not least <= number <= most:
                raise wrong(where, name, value, f"{least:g} to {most:g}")
        values[name] = tuple(map(float, numbers)) if isinstance(known[name], tuple) else float(value)
    return Vehicle(**values)
