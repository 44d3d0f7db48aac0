"""What a run of studies/mileage is given: the plan, by which its results are known, and where two plans differ.

A folder keeps the plan of its results as plan.json, so that those of another plan are not lost unasked.
"""

import json
from dataclasses import asdict, dataclass, field
from functools import cached_property
from hashlib import sha256
from urllib.parse import unquote, urlsplit

from curve_vehicle import VEHICLE, Vehicle
from dask_runs import stamp_of
from helpers import wheelrail
from mileage_bogie import Settings
from mileage_line import FORCE, LENGTH, NUMBER, SPEED, BadInputError, by_size, named, wrong

# Least and largest value of what a plan has as numbers, in SI units.
RANGES = {"distance": (1e3, 1e10), "wear_factor": (1e-6, 100.0), "largest_depth": (1e-6, 5e-4)}
RANGES |= {"smoothing": (0.0, 0.02), "samples": (1, 99), "samples_straight": (1, 99)}
# Share of what friction can carry that a wheelset's traction may take: the rest is for the curve and the irregularity.
MOST_TRACTION = 0.6
# Units of the command line's options and of columns of a line; what is not here is in SI units.
UNITS = {"distance": ("km", LENGTH["km"]), "largest_depth": ("mm", LENGTH["mm"]), "smoothing": ("mm", LENGTH["mm"])}
UNITS |= {"cant": ("mm", LENGTH["mm"]), "irregularity": ("mm", LENGTH["mm"]), "speed": ("km/h", SPEED["km/h"])}
UNITS |= {"share": ("%", NUMBER["%"]), "traction": ("kN", FORCE["kN"])}
# So many differences of two plans are named.
NAMED = 4


class OtherPlanError(BadInputError):
    """A folder has results of another plan.

    Attributes
    ----------
    folder
        Where they are.
    differences
        Name, value there and value here of what differs; empty where the folder does not say what its plan was.
    """

    def __init__(self, folder, differences):
        """Name the folder and what differs."""
        self.folder, self.differences = folder, differences
        texts = [f"{name} = {shown(name, old)} there, {shown(name, new)} here" for name, old, new in differences]
        more = [f"{len(texts) - NAMED} more"] if len(texts) > NAMED else []
        known = "; ".join(texts[:NAMED] + more) or "it does not say which"
        super().__init__(f"{folder} has results of another plan: {known}")


@dataclass(frozen=True)
class Plan:
    """A run: the line, the vehicle, the wheel, how far and in which steps.

    Attributes
    ----------
    line
        Classes of the line, whose shares are 1 together.
    parameters
        Parameters of the units by name; a rail_profile that is a file is read once, when it is first needed.
    wheel
        New profile of all wheels: a name, a path, or a Profile.
    distance
        Mileage [m].
    largest_depth
        By which a profile changes at most in a step [m].
    smoothing
        Wavelength that is halved in what a step takes away [m].
    wear_factor
        By which what the law of wear has is multiplied: rails are not as dry as a laboratory's discs.
    samples, samples_straight
        States about each equilibrium, in a curve and on straight track.
    """

    line: tuple
    distance: float
    vehicle: Vehicle = VEHICLE
    parameters: dict = field(default_factory=dict)
    wheel: object = "S1002"
    largest_depth: float = 1e-4
    smoothing: float = 5e-3
    wear_factor: float = 1.0
    samples: int = 4
    samples_straight: int = 7

    def __post_init__(self):
        """Refuse what is out of range, with its name."""
        for name, (least, most) in RANGES.items():
            value = getattr(self, name)
            if not isinstance(value, int | float) or not least <= value <= most:
                unit, factor = UNITS.get(name, ("", 1.0))
                allowed = f"{number(least / factor)} to {number(most / factor)} {unit}".rstrip()
                raise wrong("plan", name, shown(name, value), allowed)
        shares = sum(curve.share for curve in self.line)
        if abs(shares - 1.0) > 1e-9:
            raise wrong("plan", "the sum of the line's shares", f"{shares:g}", "1")
        for name, curve in named(self.line).items():
            most = MOST_TRACTION * curve.friction * 2.0 * self.vehicle.wheel_load
            if abs(curve.traction) > most:
                allowed = f"{-most:.0f} to {most:.0f} N, {MOST_TRACTION:g} of the friction under the wheelset,"
                raise wrong(name, "traction", f"{curve.traction:g} N", allowed)

    @cached_property
    def rail(self):
        """The profile of a rail_profile that is a file; None of one that is built in, or not given."""
        text = self.parameters.get("rail_profile")
        # What is no text the units refuse.
        if not isinstance(text, str) or text.casefold() in map(str.casefold, wheelrail.Profile.built_in()):
            return None
        path = unquote(urlsplit(text).path) if text.casefold().startswith("file:") else text
        return wheelrail.Profile(path, body="rail")

    def settings(self):
        """What tasks need of it."""
        parameters = tuple(sorted(self.parameters.items()))
        rail = self.rail and self.rail._text
        return Settings(self.vehicle, parameters, self.samples, self.samples_straight, rail)

    def described(self, digest, new):
        """Return all that results of this run, with a component, hang on: names, and values that JSON has."""
        found = {name: getattr(self, name) for name in RANGES}
        found["wheel"] = with_points(new.profile)
        found["line"] = {name: asdict(curve) for name, curve in named(sorted(self.line, key=by_size)).items()}
        found["vehicle"] = asdict(self.vehicle)
        rail = {"rail_profile": with_points(self.rail)} if self.rail else {}
        found["parameters"] = dict(sorted((self.parameters | rail).items()))
        found["component"] = digest[:12]
        return plain(found)

    def stamp(self, digest, new):
        """Return what results of this run, with a component, are known by; a longer run goes on from them."""
        found = self.described(digest, new)
        del found["distance"]
        return stamp_of(json.dumps(found))


def with_points(profile):
    """Return a profile's name and the beginning of a digest of its points, which tells apart files of one name."""
    # The first line has the name of the file, and not of what is in it.
    points = profile._text.partition("\n")[2]
    return f"{profile.name} ({sha256(points.encode()).hexdigest()[:12]})"


def plain(value):
    """Return a value as JSON reads it back, all numbers of one kind: 10 and 10.0 are the same plan."""
    if isinstance(value, dict):
        return {name: plain(one) for name, one in value.items()}
    if isinstance(value, list | tuple):
        return [plain(one) for one in value]
    return float(value) if isinstance(value, int | float) else str(value)


def number(value):
    """Return a number as a text, without what a change of units leaves in its last digits."""
    return f"{value:.12g}"


def shown(name, value):
    """Return a value of a plan as a text, in the unit in which it is given."""
    if value is None:
        return "nothing"
    if isinstance(value, dict):  # a class of the line
        return f"{number(100.0 * value['share'])} % of the line"
    if isinstance(value, list):
        return ", ".join(shown(name, one) for one in value)
    if not isinstance(value, int | float):
        return str(value)
    unit, factor = UNITS.get(name.rpartition(": ")[2], ("", 1.0))
    return f"{number(value / factor)} {unit}".rstrip()


def differences(there, here, where=""):
    """Return name, value there and value here of what differs between two plans as described."""
    found = []
    for name in dict.fromkeys([*there, *here]):
        old, new = there.get(name), here.get(name)
        if isinstance(old, dict) and isinstance(new, dict):
            found += differences(old, new, f"{where}{name}: ")
        elif old != new:
            found.append((f"{where}{name}", old, new))
    return found


# ---- the plan of a folder -------------------------------------------------------------------------------------------


def plan_file(folder):
    """The file of the plan of what is in a folder."""
    return folder / "plan.json"


def write_plan(folder, described):
    """Write the plan; the file is there whole or not at all."""
    unfinished = plan_file(folder).with_suffix(".unfinished")
    unfinished.write_text(json.dumps(described, indent=1, ensure_ascii=False), encoding="utf-8")
    unfinished.replace(plan_file(folder))


def read_plan(folder):
    """Read the plan as described, None where there is none."""
    path = plan_file(folder)
    return json.loads(path.read_text(encoding="utf-8")) if path.exists() else None
