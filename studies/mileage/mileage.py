"""A bogie's wheels over 100 000 km of a line with its curves: they wear, and meet the rails anew.

    .venv/bin/python studies mileage                       two workers on this machine (or `make coupling-mileage`)
    .venv/bin/python studies mileage --small               a few kilometres of two classes, within a minute
    .venv/bin/python studies mileage --line line.csv --vehicle vehicle.toml --wheel wheel.prw --distance 50000
    .venv/bin/python studies mileage --scheduler tcp://... an existing cluster

mileage_line.py reads line and vehicle, mileage_plan.py has what is asked for, mileage_bogie.py steady curving and its
wear on a worker, mileage_units.py its units, mileage_wheels.py the worn wheels, mileage_march.py the way from mileage
to mileage, mileage_tables.py and mileage_pictures.py what is shown. After a kill, the same command goes on; results of
another plan are kept. docs/couplings/mileage.md.
"""

import argparse
import json
import shutil
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pyarrow.parquet as pq
from curve_vehicle import Wheel
from dask_runs import add_options, client_for, is_done, read_component, write_table
from helpers import FMU3, RESULTS, markdown_table, wheelrail, write_tables
from mileage_bogie import NoEquilibriumError, rates
from mileage_line import BadInputError, main_line, read_line, read_vehicle, short_line, straight_line, wrong
from mileage_march import differing, forget, march, read_state, refuse_another, state_file, to_compute, weighted
from mileage_pictures import draw_curves, draw_depths, draw_laws, draw_measures, draw_profiles
from mileage_plan import RANGES, UNITS, OtherPlanError, Plan
from mileage_tables import (
    NAMES,
    curves_table,
    depths_at,
    fatigue_table,
    measures,
    measures_table,
    places_table,
    run_table,
    steps_of,
)
from mileage_wheels import MEASURES, NewWheel, smoothed

WORK = RESULTS / "mileage"
# Each behind what it imports: a scheduler and its workers import what they are sent.
MODULES = ("curve_track", "curve_vehicle", "curve_equilibrium", "mileage_line", "mileage_units", "mileage_bogie")
DISTANCE = 100_000e3  # m
# The grid of a contact's window, about as coarse as "fast", the coarsest that has a name, which is 8 x 8; a table says
# how far finer ones are from it.
GRID = {"patch_nodes": 10, "patch_strips": 7}
FINER = ((16, 11), (24, 15))
# Friction is constant, so that what lubrication changes is seen alone.
PARAMETERS = GRID | {"friction_law": "constant", "wear_law": "energy"}
# Of dry discs in a laboratory to a line in all weathers: chosen so that flanges lose half a millimetre in 100 000 km.
WEAR_FACTOR = 0.02
# Factor on friction at the gauge faces of curves up to 800 m, and the mileage at which the two are compared.
LUBRICATED, COMPARED = 0.3, 30_000e3  # 1, m
# Wheels last longer on plains. There the bogie is the motor bogie of a train that stops every ten kilometres or so:
# shares of straight track, and the force along the track that a wheelset's torque makes there. 10 kN at 160 km/h are
# 440 kW.
PLAIN = 1_000_000e3  # m
TRACTIONS = ((0.60, 0.0), (0.25, 10e3), (0.15, -10e3))  # 1, N
# Treads as flat as these have a conicity that goes to and fro with steps of 0.1 mm.
PLAIN_DEPTH = 5e-5  # m
LAWS = ("energy", "archard_map", "archard")
# Runs of the study by name, and what lies beside them: no run of the user's own is called so.
STUDY = ("hills", "plain", "rolling", "lubricated", *LAWS[1:], "new_wheels")
# Parameters of the units that come from elsewhere, and from where.
ELSEWHERE = {
    "side": "each wheel has its own",
    "wheel_profile": "--wheel gives it",
    "wheel_radius": "the vehicle has it",
    "friction_cold": "the line has it, as friction",
    "gauge_face_friction_scale": "the line has it, as gauge_face_friction",
}


def main_plan(**changes):
    """The plan of the page: dry gauge faces, energy's law."""
    return Plan(tuple(main_line()), DISTANCE, parameters=PARAMETERS, wear_factor=WEAR_FACTOR, **changes)


def small_plan(**changes):
    """A plan that ends within a minute: straight track and one curve, two steps."""
    given = {"parameters": PARAMETERS, "wear_factor": 0.05, "largest_depth": 4e-5, "samples": 2}
    given |= {"line": tuple(short_line()), "distance": 400e3, "samples_straight": 2}
    return Plan(**(given | changes))


# ---- comparisons ----------------------------------------------------------------------------------------------------


def first_rates(client, component, plan, parameters):
    """What all classes take away from new wheels with other parameters: whole line, and area per distance by class."""
    data, digest = component
    new = NewWheel.of(plan.wheel)
    changed = replace(plan, parameters=plan.parameters | parameters)
    stamp = changed.stamp(digest, new)
    path = WORK / "new_wheels" / f"{'_'.join(str(value) for value in parameters.values())}.parquet"
    if not is_done(path, stamp):
        wheels = [new.for_units(new.none())] * len(NAMES)
        classes = to_compute(plan.line, wheels)
        shared = client.scatter(data, broadcast=True)
        arguments = [(digest, changed.settings(), wheels, curve, None) for curve in classes.values()]
        results = client.gather([client.submit(rates, shared, *given, pure=False) for given in arguments])
        areas = weighted(changed, classes.values(), results)
        sums = {name: [area.sum() for area in result["area"]] for name, result in zip(classes, results, strict=True)}
        path.parent.mkdir(parents=True, exist_ok=True)
        columns = {
            name: ("m", smoothed(area, new.cell, plan.smoothing)) for name, area in zip(NAMES, areas, strict=True)
        }
        write_table(path, stamp, columns, {"sums": json.dumps(sums)})
    table = pq.read_table(path)
    return np.stack([table[name].to_numpy() for name in NAMES]), json.loads(table.schema.metadata[b"sums"])


def laws_table(found):
    """Area that each law takes from a new wheel in each class [mm² per 1000 km], as the law has it."""
    lines = []
    for name in found[LAWS[0]][1]:
        line = [name]
        for wheel in (0, 1, 2):
            line.append(", ".join(f"{1e12 * found[law][1][name][wheel]:.3g}" for law in LAWS))
        lines.append(line)
    return markdown_table(["class", *(f"{NAMES[wheel]}: {', '.join(LAWS)}" for wheel in (0, 1, 2))], lines)


def grids_table(found):
    """Area that the whole line takes from new wheels on finer grids, over that of the study's grid."""
    lines = []
    base = found[next(iter(found))][0]
    for grid, (whole, _) in found.items():
        sums = [area.sum() for area in whole[::2]]
        more = [own / area.sum() - 1.0 for own, area in zip(sums, base[::2], strict=True)]
        lines.append([grid, *(f"{1e12 * own:.3f}" for own in sums), *(f"{100.0 * share:+.1f} %" for share in more)])
    head = ["cells", "leading [mm² per 1000 km]", "trailing", "leading, against the first", "trailing"]
    return markdown_table(head, lines)


# ---- runs -----------------------------------------------------------------------------------------------------------


def study(client, component):
    """The runs of the page, its tables and its pictures."""
    plan = main_plan()
    oiled = replace(plan, line=tuple(main_line(LUBRICATED)), distance=COMPARED)
    rolling = replace(plan, line=tuple(straight_line()), distance=PLAIN, largest_depth=PLAIN_DEPTH)
    plain = replace(rolling, line=tuple(straight_line(TRACTIONS)))
    new = NewWheel.of(plan.wheel)
    laws = {law: first_rates(client, component, plan, {"wear_law": law}) for law in LAWS}
    # Each law with the factor with which it takes from the new leading wheels what the energy's law takes.
    taken = {law: whole[:2].sum() for law, (whole, _) in laws.items()}
    factors = {law: WEAR_FACTOR * taken["energy"] / area for law, area in taken.items()}
    runs = {"hills": plan, "plain": plain, "rolling": rolling, "lubricated": oiled}
    for law in LAWS[1:]:
        parameters = plan.parameters | {"wear_law": law}
        runs[law] = replace(plan, distance=COMPARED, parameters=parameters, wear_factor=factors[law])
    for name, one in runs.items():
        print(f"  {name}", flush=True)
        # The page's runs are as if computed in one go.
        if differing(WORK / name, one, component[1]) is not None:
            forget(WORK / name)
        march(client, one, WORK / name, component)
    base, straights = WORK / "hills", WORK / "plain"
    finer = {f"{n} × {m}": {"patch_nodes": n, "patch_strips": m} for n, m in FINER}
    grids = {"10 × 7": laws["energy"]}
    grids |= {title: first_rates(client, component, plan, grid) for title, grid in finer.items()}
    found = {name: measures(runs[name], WORK / name) for name in ("hills", "plain", "rolling")}
    last = steps_of(base) - 1
    tables = {
        "run": run_table(plan, base),
        "hills": measures_table(found["hills"]),
    }
    tables |= {name: measures_table(found[name]) for name in ("plain", "rolling")}
    tables |= {"curves of the plain": curves_table(straights, (0, steps_of(straights) - 1))}
    tables |= {"curves": curves_table(base, (0, last)), "fatigue": fatigue_table(base, (0, last))}
    dry_and_oiled = {"dry": base, "lubricated": WORK / "lubricated"}
    by_law = {law: WORK / law if law in runs else base for law in LAWS}
    titles = {f"{law} × {factors[law]:.3g}": folder for law, folder in by_law.items()}
    tables |= {"lubrication": places_table(new, dry_and_oiled, COMPARED), "laws": laws_table(laws)}
    tables |= {"laws over mileage": places_table(new, titles, COMPARED), "grids": grids_table(grids)}
    write_tables("mileage.md", tables)
    draw_profiles(new, base, "mileage_profiles.png")
    draw_depths(new, base, "mileage_depths.png")
    draw_depths(new, straights, "mileage_plain.png")
    draw_measures(found["hills"], "mileage_measures.png", {})
    draw_profiles(new, straights, "mileage_plain_profiles.png")
    draw_measures(found["plain"], "mileage_plain_measures.png", {}, [found["rolling"]], "no traction")
    draw_curves(base, (0, last), ("new", "at the end"), "mileage_curves.png")
    depths = {title: depths_at(folder, COMPARED) for title, folder in (dry_and_oiled | by_law).items()}
    shapes = {law: whole for law, (whole, _) in laws.items()}
    dry_and_oiled = {title: depths[title] for title in dry_and_oiled}
    draw_laws(new, shapes, {law: depths[law] for law in LAWS}, dry_and_oiled, COMPARED, "mileage_laws.png")


def own_run(client, component, plan, name, limits):
    """A run of the user's own: its tables and pictures under its name."""
    folder = WORK / name
    march(client, plan, folder, component)
    new, found, last = NewWheel.of(plan.wheel), measures(plan, folder), steps_of(folder) - 1
    tables = {"run": run_table(plan, folder), "measures": measures_table(found)}
    tables |= {"curves": curves_table(folder, (0, last)), "fatigue": fatigue_table(folder, (0, last))}
    write_tables(f"mileage_{name}.md", tables)
    draw_profiles(new, folder, f"mileage_{name}_profiles.png")
    draw_depths(new, folder, f"mileage_{name}_depths.png")
    draw_measures(found, f"mileage_{name}_measures.png", limits)
    draw_curves(folder, (0, last), ("new", "at the end"), f"mileage_{name}_curves.png")
    for title, depth in zip(NAMES, read_state(state_file(folder, last + 1)).depth, strict=True):
        new.worn(depth).write(folder / f"{title.replace(' ', '_')}.prw")
    print(f"  wrote results/mileage/{name}: wheels and classes of each step, measures, profiles at the end")


# ---- the command line -----------------------------------------------------------------------------------------------


def pairs(texts, kind, option):
    """NAME=VALUE of an option, by name; values that are numbers as numbers."""
    found = {}
    for text in texts or ():
        name, equals, value = text.partition("=")
        if not equals:
            raise BadInputError(f"--{option} {text}: NAME=VALUE is needed")
        try:
            found[name] = float(value)
        except ValueError:
            if kind is float:
                raise wrong(f"--{option}", name, repr(value), "a number") from None
            found[name] = value
    return found


def in_si(name, value):
    """A number of the plan in SI units, from the command line's."""
    return value * UNITS[name][1] if name in UNITS else value


def plan_of(chosen):
    """The plan that the options ask for, or None for the study."""
    numbers = {name: getattr(chosen, name) for name in RANGES}
    given = {name: in_si(name, value) for name, value in numbers.items() if value is not None}
    if chosen.line:
        given["line"] = tuple(read_line(chosen.line))
    if chosen.vehicle:
        given["vehicle"] = read_vehicle(chosen.vehicle)
    if chosen.wheel:
        given["wheel"] = chosen.wheel
    parameters = pairs(chosen.set, None, "set") | ({"wear_law": chosen.wear_law} if chosen.wear_law else {})
    if not given and not parameters and not chosen.small:
        return None
    if taken := [name for name in parameters if name in ELSEWHERE]:
        raise BadInputError(f"--set {taken[0]}: {ELSEWHERE[taken[0]]}")
    base = small_plan() if chosen.small else main_plan()
    return replace(base, parameters=base.parameters | parameters, **given)


def check_units(plan):
    """Refuse parameters that the component refuses, in its words."""
    try:
        Wheel("left", FMU3, **plan.parameters).close()
    except (wheelrail.SimulationError, TypeError) as error:
        raise BadInputError(str(error)) from error


def options():
    """The command line's options."""
    parser = argparse.ArgumentParser(description="A bogie's wheels over the mileage of a line, as a Dask job")
    add_options(parser, "steps")
    parser.add_argument("--small", action="store_true", help="straight track and one curve, within a minute")
    parser.add_argument("--line", type=Path, help="CSV: radius, cant, speed, share or length, traction, …")
    parser.add_argument("--vehicle", type=Path, help="TOML: fields of Vehicle in studies/common/curve_vehicle.py")
    parser.add_argument("--wheel", help="new profile of the wheels: a name or a file (S1002)")
    parser.add_argument("--distance", type=float, help="mileage [km] (100000)")
    parser.add_argument("--wear-law", choices=LAWS, help="law of wear (energy)")
    parser.add_argument("--wear-factor", type=float, help=f"factor on the law of wear ({WEAR_FACTOR:g})")
    parser.add_argument("--largest-depth", type=float, help="by which a profile changes in a step [mm] (0.1)")
    parser.add_argument("--smoothing", type=float, help="wavelength that is halved in what a step takes [mm] (5)")
    parser.add_argument("--samples", type=int, help="states about the equilibrium of a curve (4)")
    parser.add_argument("--samples-straight", type=int, help="states about that of straight track (7)")
    parser.add_argument("--set", action="append", metavar="NAME=VALUE", help="parameter of the component")
    parser.add_argument("--limit", action="append", metavar="NAME=MM", help=f"line to draw: {', '.join(MEASURES)}")
    parser.add_argument("--name", default=None, help="of the run's folder and files (own, or small)")
    return parser


def main():
    """The study, or a run of the user's own."""
    chosen = options().parse_args()
    if not FMU3.exists():
        sys.exit(f"{FMU3} is not there: run `make fmu fmu3` first")
    name = chosen.name or ("small" if chosen.small else "own")
    try:
        # --fresh removes the folder of this name.
        if name == ".." or Path(name).name != name:
            raise BadInputError(f"--name {name}: a name without folders is needed")
        if name in STUDY:
            raise BadInputError(f"--name {name}: the study without options has results of that name")
        plan = plan_of(chosen)
        limits = {name: 1e-3 * value for name, value in pairs(chosen.limit, float, "limit").items()}
        if unknown := [name for name in limits if name not in MEASURES]:
            raise BadInputError(f"--limit {unknown[0]}: there are {', '.join(MEASURES)}")
        if plan is not None:
            # What is wrong with wheel, parameters or rail is said before anything is computed.
            NewWheel.of(plan.wheel)
            check_units(plan)
            plan.settings()
        component = read_component(FMU3)
        if plan is not None and not chosen.fresh:
            refuse_another(WORK / name, plan, component[1])
    except OtherPlanError as error:
        sys.exit(f"mileage: --name {name}: {error}; another --name keeps them, --fresh forgets them")
    except (ValueError, OSError) as error:
        sys.exit(f"mileage: {error}")
    try:
        with client_for(chosen.scheduler, chosen.workers, MODULES) as client:
            if chosen.fresh:
                for one in STUDY if plan is None else (name,):
                    shutil.rmtree(WORK / one, ignore_errors=True)
            if plan is None:
                study(client, component)
            else:
                own_run(client, component, plan, name, limits)
    except NoEquilibriumError as error:
        sys.exit(f"mileage: {error}")


if __name__ == "__main__":
    main()
