"""From mileage to mileage: wear rates in all classes of the line, as tasks of Dask, and profiles that follow them.

A step of mileage is explicit: the rates on the profiles as they are, weighted by the line's shares, and as many
kilometres as take the largest depth by a given amount. What is there after a step is two Parquet files, whole or not
there: the depths of the four wheels and what the next step begins from, and what each class had. A run that was killed
goes on behind its last step. Sums run in the order of the line's classes whoever computed them, so that the bits are
the same for any number of workers.

Where each curve of the line has its like to the other hand, and both wheels of each wheelset are the same, one hand is
computed and the other one is its mirror.
"""

import json
import time
from dataclasses import asdict, dataclass, field

import numpy as np
import pyarrow.parquet as pq
from curve_vehicle import VEHICLE, WHEELS, Vehicle
from dask_runs import is_done, stamp_of, write_table
from mileage_bogie import NoEquilibriumError, Settings, Starts, rates_or_error
from mileage_line import by_size, is_its_own_mirror, named, wrong
from mileage_wheels import NewWheel, smoothed

# Least and largest value of what a plan has as numbers, in SI units.
RANGES = {"distance": (1e3, 1e10), "wear_factor": (1e-6, 100.0), "largest_depth": (1e-6, 5e-4)}
# Share of what friction can carry that a wheelset's traction may take: the rest is for the curve and the irregularity.
MOST_TRACTION = 0.6
RANGES |= {"smoothing": (0.0, 0.02), "samples": (1, 99), "samples_straight": (1, 99)}
# Of the four wheels, those of the other side.
MIRROR = (1, 0, 3, 2)
UNITS = {
    "radius": "m",
    "traction": "N",
    "Y": "N",
    "Q": "N",
    "wear_number": "N",
    "peak_temperature": "K",
    "peak_pressure": "Pa",
    "left": "N",
}


@dataclass(frozen=True)
class Plan:
    """A run: the line, the vehicle, the wheel, how far and in which steps.

    Attributes
    ----------
    line
        Classes of the line, whose shares are 1 together.
    parameters
        Parameters of the units by name.
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
                raise wrong("plan", name, value, f"{least:g} to {most:g}")
        shares = sum(curve.share for curve in self.line)
        if abs(shares - 1.0) > 1e-9:
            raise wrong("plan", "the sum of the line's shares", f"{shares:g}", "1")
        for name, curve in named(self.line).items():
            most = MOST_TRACTION * curve.friction * 2.0 * self.vehicle.wheel_load
            if abs(curve.traction) > most:
                allowed = f"{-most:.0f} to {most:.0f} N, {MOST_TRACTION:g} of the friction under the wheelset,"
                raise wrong(name, "traction", f"{curve.traction:g} N", allowed)

    def settings(self):
        """What tasks need of it."""
        parameters = tuple(sorted(self.parameters.items()))
        return Settings(self.vehicle, parameters, self.samples, self.samples_straight)

    def stamp(self, digest, new):
        """Return what results of this run, with a component, are known by."""
        given = [digest, sorted(self.line, key=by_size), self.distance, asdict(self.vehicle), self.settings()]
        given += [self.largest_depth, self.smoothing, self.wear_factor, new.profile._text]
        return stamp_of(*given)


@dataclass
class Progress:
    """Where a run is: steps done, mileage [m], depths of the wheels, and what the next step begins from by class."""

    step: int
    distance: float
    depth: np.ndarray
    starts: dict


def state_file(folder, step):
    """The file of the wheels after a step; that after none has the new wheels."""
    return folder / f"wheels_{step:04d}.parquet"


def classes_file(folder, step):
    """The file of what the classes had in a step."""
    return folder / f"classes_{step:04d}.parquet"


def times_file(folder, step):
    """The file of how long the workers took for a step: beside the others, whose bits are always the same."""
    return folder / f"times_{step:04d}.json"


def say(line):
    """Print a line of progress at once."""
    print(line, flush=True)


def march(client, plan, folder, component, report=say):
    """Run, or go on; return the number of steps.

    Parameters
    ----------
    client
        Client of Dask, or None: then all is computed here.
    plan
        What is run.
    folder
        Where results are, and the state to go on from.
    component
        The FMU as data and its digest.
    report
        Called with a line after each step.

    Raises
    ------
    NoEquilibriumError
        In a class of the line there is no steady curving; what was computed before is kept.
    """
    data, digest = component
    folder.mkdir(parents=True, exist_ok=True)
    new = NewWheel.of(plan.wheel)
    stamp = plan.stamp(digest, new)
    progress = last_state(folder, stamp) or Progress(0, 0.0, np.stack([new.none()] * len(WHEELS)), {})
    if progress.step:
        report(f"  {progress.step} steps, {1e-3 * progress.distance:.0f} km, are there from before")
    else:
        for left_over in (path for kind in ("wheels", "classes", "times") for path in folder.glob(f"{kind}_*")):
            left_over.unlink()
        write_state(folder, stamp, new, progress)
    shared = client.scatter(data, broadcast=True) if client else data
    while progress.distance < plan.distance:
        began = time.perf_counter()
        wheels = [new.for_units(depth) for depth in progress.depth]
        classes = to_compute(plan.line, wheels)
        starts = [progress.starts.get(name) for name in classes]
        pairs = zip(classes.values(), starts, strict=True)
        arguments = [(digest, plan.settings(), wheels, curve, start) for curve, start in pairs]
        if client:
            results = client.gather([client.submit(rates_or_error, shared, *given, pure=False) for given in arguments])
        else:
            results = [rates_or_error(shared, *given) for given in arguments]
        for result in results:
            if isinstance(result, NoEquilibriumError):
                raise result
        raw = weighted(plan, classes.values(), results)
        rate = np.stack([smoothed(area, new.cell, plan.smoothing) for area in raw])
        growth = np.stack([new.depth_of(area, depth) for area, depth in zip(rate, progress.depth, strict=True)])
        # The last steps are alike.
        left = plan.distance - progress.distance
        length = plan.largest_depth / growth.max()
        length = left / np.ceil(left / length - 1e-9)
        seconds = [result["seconds"] for result in results]
        spent = {what: sum(one[what] for one in seconds) for what in seconds[0]}
        times_file(folder, progress.step).write_text(json.dumps(spent))
        write_classes(folder, stamp, progress, length, classes, results, raw, rate)
        starts = {name: result["starts"] for name, result in zip(classes, results, strict=True)}
        distance = plan.distance if left - length < 1.0 else progress.distance + length
        progress = Progress(progress.step + 1, distance, progress.depth + length * growth, starts)
        write_state(folder, stamp, new, progress)
        report(
            f"  step {progress.step}: {1e-3 * distance:.0f} of {1e-3 * plan.distance:.0f} km,"
            f" {sum(result['iterations'] for result in results)} iterations,"
            f" largest force left {max(result['left'] for result in results):.0f} N,"
            f" {sum(result['missed'] for result in results)} samples left out,"
            f" {time.perf_counter() - began:.1f} s"
        )
    return progress.step


def to_compute(line, wheels):
    """Classes that are computed, by name: of a line that is its own mirror, on wheels that are too, one hand."""
    if is_its_own_mirror(line) and all(wheels[k] == wheels[other] for k, other in enumerate(MIRROR)):
        return {name: curve for name, curve in named(line).items() if curve.radius < 0.0 or np.isinf(curve.radius)}
    return named(line)


def weighted(plan, classes, results):
    """Areas of the cells that all classes together take away per distance, of each wheel [m]."""
    whole, total = len(classes) == len(plan.line), 0.0
    for curve, result in zip(classes, results, strict=True):
        areas = np.stack(result["area"])
        if whole:
            total = total + curve.share * areas
        else:
            # Straight track is its own mirror.
            share = curve.share if np.isinf(curve.radius) else 2.0 * curve.share
            total = total + 0.5 * share * (areas + areas[list(MIRROR)])
    return plan.wear_factor * total


# ---- what is kept ---------------------------------------------------------------------------------------------------


def write_state(folder, stamp, new, progress):
    """Write the wheels' depths, the mileage and what the next step begins from."""
    columns = {"arc_length": ("m", new.place)}
    wheels = zip(WHEELS, progress.depth, strict=True)
    columns |= {f"depth_{axle}_{side}": ("m", depth) for (axle, side), depth in wheels}
    starts = {name: asdict(found) for name, found in progress.starts.items()}
    notes = {"step": progress.step, "distance": progress.distance, "starts": starts}
    write_table(state_file(folder, progress.step), stamp, columns, {"progress": json.dumps(notes)})


def last_state(folder, stamp):
    """Return the last state that is there and of this run, or None; a step is there with both files."""
    step, found = 0, None
    while is_done(state_file(folder, step), stamp) and (step == 0 or is_done(classes_file(folder, step - 1), stamp)):
        found, step = state_file(folder, step), step + 1
    return found and read_state(found)


def read_state(path):
    """Read a state."""
    table = pq.read_table(path)
    notes = json.loads(table.schema.metadata[b"progress"])
    depth = np.stack([table[f"depth_{axle}_{side}"].to_numpy() for axle, side in WHEELS])
    starts = {name: Starts(**found) for name, found in notes["starts"].items()}
    return Progress(notes["step"], notes["distance"], depth, starts)


def write_classes(folder, stamp, progress, length, classes, results, raw, rate):
    """Write what each class had: rows of its states and wheels; and what the whole line takes, before and smoothed."""
    rows = []
    for (name, curve), result in zip(classes.items(), results, strict=True):
        for row in result["rows"]:
            axle, side = WHEELS[row["wheel"]]
            known = {"class": name, "wheel": f"{axle} {side}"}
            known |= {"radius": curve.radius, "share": curve.share, "traction": curve.traction}
            rows.append(known | {name: value for name, value in row.items() if name != "wheel"})
    columns = {}
    for name in rows[0]:
        values = [row[name] for row in rows]
        words = isinstance(values[0], str)
        columns[name] = (None, values) if words else (UNITS.get(name, "1"), list(map(float, values)))
    notes = {
        "from": progress.distance,
        "length": length,
        "area": raw.sum(axis=1).tolist(),
        "moved": (0.5 * np.abs(rate - raw).sum(axis=1)).tolist(),
        "lost": (raw - rate).sum(axis=1).tolist(),
        "states": len(rows) // len(WHEELS),
        "iterations": sum(result["iterations"] for result in results),
        "left": max(result["left"] for result in results),
        "above": int(sum(row["left"] > 100.0 for row in rows)) // len(WHEELS),
        "missed": sum(result["missed"] for result in results),
        "held": sum(result["held"] for result in results),
    }
    write_table(classes_file(folder, progress.step), stamp, columns, {"step": json.dumps(notes)})
