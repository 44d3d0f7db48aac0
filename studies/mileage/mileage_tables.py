"""Tables of studies/mileage: what is measured on the worn wheels, and what wears in which curve."""

import json

import numpy as np
import pyarrow.parquet as pq
from curve_vehicle import AXLES, WHEELS
from dask_runs import is_done, stamp_of, write_table
from helpers import markdown_table, wheelrail
from mileage_march import classes_file, read_state, state_file, times_file
from mileage_units import profile_file
from mileage_wheels import MEASURES, NewWheel

NAMES = [f"{axle} {side}" for axle, side in WHEELS]
# So many states of a run are measured.
MEASURED = 21
# Parameters of the units that enter the conicity, as contact_geometry() calls them.
GEOMETRY = {"rail_profile": "rail", "profile_smoothing": "smoothing"}
GEOMETRY |= {name: name for name in ("gauge", "gauge_depth", "rail_inclination")}
GEOMETRY |= {name: name for name in ("flange_back_distance", "flange_back_position")}
# Displacements of the wheelset that the conicity at 3 mm asks for: short of the flanges, which wear steep.
TREAD = (-5e-3, 5e-3)  # m


def steps_of(folder):
    """How many steps there are."""
    return len(list(folder.glob("wheels_*.parquet"))) - 1


def chosen(folder, most=MEASURED):
    """Steps after which wheels are looked at: evenly over the mileage, with the first and the last."""
    distances = np.array([read_state(state_file(folder, step)).distance for step in range(steps_of(folder) + 1)])
    wanted = np.linspace(0.0, distances[-1], most)
    return sorted({int(np.abs(distances - one).argmin()) for one in wanted})


def measures(plan, folder, most=MEASURED):
    """Measures of the wheels over the mileage, a column each, which are kept beside the run."""
    steps = chosen(folder, most)
    last = state_file(folder, steps[-1])
    # Runs of the same plan may be of several lengths, and older versions left measures with the default geometry.
    known = pq.read_schema(last).metadata[b"stamp"], read_state(last).distance, steps
    stamp = stamp_of(*known, *sorted(geometry_of(plan)))
    path = folder / "measures.parquet"
    if not is_done(path, stamp):
        new = NewWheel.of(plan.wheel)
        rows = [row for step in steps for row in measured(plan, new, read_state(state_file(folder, step)))]
        units = {"mileage": "m", "worn_area": "m2", "conicity": "1", "largest_depth": "m"}
        units |= dict.fromkeys(MEASURES, "m")
        columns = {"wheel": (None, [row["wheel"] for row in rows])}
        columns |= {name: (unit, [row[name] for row in rows]) for name, unit in units.items()}
        write_table(path, stamp, columns)
    table = pq.read_table(path)
    return {name: np.array(table[name].to_pylist()) for name in table.column_names}


def geometry_of(plan):
    """Rail and dimensions that a plan gives, for contact_geometry(), which else has the units' defaults."""
    found = {GEOMETRY[name]: value for name, value in plan.parameters.items() if name in GEOMETRY}
    return found | ({"rail": plan.rail} if plan.rail else {})


def measured(plan, new, progress):
    """Measures of the four wheels in a state, with the equivalent conicity of their wheelset at 3 mm."""
    worn = [new.worn(depth) for depth in progress.depth]
    radius, given = plan.vehicle.wheel_radius, geometry_of(plan)
    back = {name: value for name, value in given.items() if name == "flange_back_position"}
    rows = []
    for axle in range(len(AXLES)):
        units = [new.for_units(progress.depth[2 * axle + side]) for side in range(2)]
        left, right = worn[2 * axle : 2 * axle + 2]
        if given.get("smoothing"):
            # It is of files alone; the units have files of new wheels, too.
            left, right = (profile_file(one.profile) for one in units)
        try:
            conicity = wheelrail.contact_geometry(
                wheel=left,
                wheel_right=right,
                wheel_radius=radius - units[0].depth,
                wheel_radius_right=radius - units[1].depth,
                lateral=TREAD,
                **given,
            ).attrs["conicity"]
        except ValueError:
            # A wheel is off its rail at one of the displacements.
            conicity = None
        for side in range(2):
            number = 2 * axle + side
            found = worn[number].measures(**back)
            row = {"wheel": NAMES[number], "mileage": progress.distance, "worn_area": new.area(progress.depth[number])}
            row |= {"conicity": np.nan if conicity is None else conicity, "largest_depth": progress.depth[number].max()}
            rows.append(row | {name: getattr(found, name) for name in MEASURES})
    return rows


def depths_at(folder, distance):
    """Depths of the wheels at a mileage, linear between two steps."""
    states = [read_state(state_file(folder, step)) for step in range(steps_of(folder) + 1)]
    after = next(state for state in states if state.distance >= distance)
    if after.step == 0:
        return after.depth
    before = states[after.step - 1]
    share = (distance - before.distance) / (after.distance - before.distance)
    return before.depth + share * (after.depth - before.depth)


def places_table(new, folders, distance):
    """Worn area on flange, where it is steeper than 45°, root and tread at a mileage, of runs by their titles."""
    steep = new.normal[1] < np.cos(np.pi / 4.0)
    steep = 0.5 * (steep[1:] + steep[:-1]) > 0.25
    root = (new.y[1:] < -0.026) & ~steep
    parts = {"flange, steeper than 45°": steep, "its root, to -26 mm": root, "tread": ~(steep | root)}
    lines = []
    for title, folder in folders.items():
        depth = depths_at(folder, distance)
        for number in (0, 2):
            areas = [new.area(np.where(part, depth[number], 0.0)) for part in parts.values()]
            sd = new.worn(depth[number]).measures().flange_thickness
            line = [f"{title}, {NAMES[number].partition(' ')[0]}", *(f"{1e6 * area:.2f} mm²" for area in areas)]
            lines.append([*line, f"{1e3 * sd:.2f} mm", f"{1e3 * depth[number].max():.2f} mm"])
    head = [f"after {1e-3 * distance:.0f} km", *parts, "Sd", "largest depth"]
    return markdown_table(head, lines)


def classes_of(folder, step):
    """What the classes had in a step, a column each, and the notes."""
    table = pq.read_table(classes_file(folder, step))
    notes = json.loads(table.schema.metadata[b"step"])
    return {name: np.array(table[name].to_pylist()) for name in table.column_names}, notes


def measures_table(found):
    """What is measured on each wheel when it is new and at the end."""
    lines = []
    for name in NAMES:
        own = {key: values[found["wheel"] == name] for key, values in found.items()}
        line = [name]
        for key in MEASURES:
            line.append(f"{1e3 * own[key][0]:.2f} → {1e3 * own[key][-1]:.2f} mm")
        line.append(f"{1e6 * own['worn_area'][-1]:.1f} mm²")
        line.append(f"{own['conicity'][0]:.3f} → {own['conicity'][-1]:.3f}")
        lines.append(line)
    return markdown_table(["wheel", "Sh", "Sd", "qR", "hollow", "worn area", "conicity of its wheelset at 3 mm"], lines)


def run_table(plan, folder):
    """How a run went."""
    count = steps_of(folder)
    notes = [classes_of(folder, step)[1] for step in range(count)]
    lengths = 1e-3 * np.array([one["length"] for one in notes])
    taken = sum(one["length"] * np.array(one["area"]) for one in notes)
    moved = sum(one["length"] * np.array(one["moved"]) for one in notes)
    lost = sum(one["length"] * np.array(one["lost"]) for one in notes)
    states = sum(one["states"] for one in notes)
    rows = {
        "mileage, steps": f"{1e-3 * plan.distance:.0f} km, {count} of {lengths.min():.0f} to {lengths.max():.0f} km",
        "steady states, iterations of Newton's method": f"{states}, {sum(one['iterations'] for one in notes)}",
        "of them with more than 100 N left, largest": (
            f"{sum(one['above'] for one in notes)}, {max(one['left'] for one in notes):.0f} N"
        ),
        "sampled states left out": f"{sum(one['missed'] for one in notes)}",
        "classes about the frame of the step before": f"{sum(one['held'] for one in notes)}",
        "area that smoothing moves, of what is worn": f"{100 * (moved / taken).max():.1f} % at most",
        "area that smoothing loses": f"{(abs(lost) / taken).max():.0e} of it",
    }
    spent = [json.loads(times_file(folder, step).read_text()) for step in range(count)]
    whole = sum(one["all"] for one in spent)
    shares = {what: 100.0 * sum(one[what] for one in spent) / whole for what in spent[0]}
    title = "of the workers' time: the contacts' steps, their derivatives, making the units"
    parts = (shares[what] for what in ("steps", "derivatives", "initialisation"))
    rows[title] = ", ".join(f"{share:.0f} %" for share in parts)
    return markdown_table(["", ""], [list(row) for row in rows.items()])


def curves_table(folder, steps):
    """Tγ of the four wheels in each class, mean over the sampled states, in some steps: on new wheels and on worn."""
    lines = []
    tables = [by_class(folder, step) for step in steps]
    for name in tables[0]:
        line = [name, f"{100 * tables[0][name]['share']:.1f} %"]
        for number in range(len(NAMES)):
            line.append(" → ".join(f"{table[name]['wear_number'][number]:.0f} N" for table in tables))
        lines.append(line)
    return markdown_table(["class", "of the line", *NAMES], lines)


def fatigue_table(folder, steps):
    """Damage by rolling contact fatigue of one passage of each wheel, as curves_table()."""
    lines = []
    tables = [by_class(folder, step) for step in steps]
    for name in tables[0]:
        line = [name]
        for number in range(len(NAMES)):
            values = (1e6 * table[name]["rcf_damage"][number] for table in tables)
            line.append(" → ".join(f"{value + 0.0:.2f}".replace("-", "\u2212") for value in values))
        lines.append(line)
    return markdown_table(["damage of a passage, 10⁻⁶", *NAMES], lines)


def by_class(folder, step, quantities=("wear_number", "rcf_damage", "Y", "Q")):
    """Means over the sampled states by class, an element for each wheel."""
    table, _ = classes_of(folder, step)
    found = {}
    for name in dict.fromkeys(table["class"]):
        own = table["class"] == name
        entry = {known: table[known][own][0] for known in ("share", "radius", "traction")}
        for quantity in quantities:
            entry[quantity] = [float(table[quantity][own & (table["wheel"] == wheel)].mean()) for wheel in NAMES]
        found[str(name)] = entry
    return found
