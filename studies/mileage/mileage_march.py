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
from dataclasses import asdict, dataclass

import numpy as np
import pyarrow.parquet as pq
from curve_vehicle import WHEELS
from dask_runs import is_done, write_table
from mileage_bogie import NoEquilibriumError, Starts, rates_or_error
from mileage_line import is_its_own_mirror, named
from mileage_plan import OtherPlanError, differences, read_plan, write_plan
from mileage_wheels import NewWheel, smoothed

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
    OtherPlanError
        The folder has results of another plan; one that is the same but longer goes on from them.
    NoEquilibriumError
        In a class of the line there is no steady curving; what was computed before is kept.
    """
    data, digest = component
    folder.mkdir(parents=True, exist_ok=True)
    refuse_another(folder, plan, digest)
    new = NewWheel.of(plan.wheel)
    stamp = plan.stamp(digest, new)
    progress = last_state(folder, stamp) or Progress(0, 0.0, np.stack([new.none()] * len(WHEELS)), {})
    if progress.step:
        report(f"  {progress.step} steps, {1e-3 * progress.distance:.0f} km, are there from before")
    else:
        forget(folder)
        write_state(folder, stamp, new, progress)
    write_plan(folder, plan.described(digest, new))
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


def differing(folder, plan, digest):
    """Return where the plan of a folder's results differs from this one, or None: there are no steps of another one.

    Where the folder does not say what its plan was, there is nothing to name.
    """
    if not state_file(folder, 1).exists():
        return None
    if (there := read_plan(folder)) is None:
        return []
    new = NewWheel.of(plan.wheel)
    found = differences(there, plan.described(digest, new))
    return None if not found and is_done(state_file(folder, 0), plan.stamp(digest, new)) else found


def refuse_another(folder, plan, digest):
    """Refuse a folder with steps of another plan, but not of one that is the same and shorter."""
    found = differing(folder, plan, digest)
    if found is None:
        return
    longer = [name for name, *_ in found] == ["distance"] and found[0][2] > found[0][1]
    if not longer:
        raise OtherPlanError(folder, found)


def forget(folder):
    """Remove the steps that are there."""
    for path in (path for kind in ("wheels", "classes", "times") for path in folder.glob(f"{kind}_*")):
        path.unlink()


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
