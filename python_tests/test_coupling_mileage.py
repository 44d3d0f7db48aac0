"""studies/mileage: wheels that wear over a line, the same for any number of workers, after a kill, and mirrored."""

import importlib.util
import json
import os
import pickle
import re
import subprocess
import sys
from contextlib import nullcontext
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import folders
import mileage
import numpy as np
import pytest
from curve_equilibrium import PULL, PULL_UNIT
from curve_vehicle import VEHICLE, WHEELS
from dask_runs import local_file, read_component
from helpers import FMU3, REPOSITORY, wheelrail
from mileage_bogie import NoEquilibriumError, in_equilibrium, no_equilibrium, rates
from mileage_line import (
    STRAIGHT,
    BadInputError,
    Curve,
    is_its_own_mirror,
    main_line,
    mirrored,
    named,
    read_line,
    straight_line,
    vehicle_of,
)
from mileage_march import MIRROR, Progress, march, read_state, state_file, times_file
from mileage_tables import by_class, classes_of, fatigue_table, measured, run_table
from mileage_wheels import NewWheel, smoothed

# The small run in a process of its own, which goes on after each file when it is told to: on workers, or on none.
PROGRAM = """
import os, sys
from contextlib import nullcontext
from pathlib import Path
sys.path[:0] = sys.argv[1].split(os.pathsep)
import mileage, mileage_march
from dask_runs import local_client, read_component
from helpers import FMU3
for name in ("write_state", "write_classes"):
    def waiting(*arguments, write=getattr(mileage_march, name)):
        write(*arguments)
        print("written", flush=True)
        sys.stdin.readline()
    setattr(mileage_march, name, waiting)
if __name__ == "__main__":
    with local_client(int(sys.argv[3])) if len(sys.argv) > 3 else nullcontext() as client:
        mileage_march.march(client, mileage.small_plan(), Path(sys.argv[2]), read_component(FMU3))
"""


@pytest.fixture(scope="module")
def component():
    """Return the component and its digest."""
    return read_component(FMU3)


@pytest.fixture(scope="module")
def run(component, tmp_path_factory):
    """Return the small run, computed here without Dask: its folder and the wheels after each step."""
    folder = tmp_path_factory.mktemp("run")
    count = march(None, mileage.small_plan(), folder, component)
    return folder, [read_state(state_file(folder, step)) for step in range(count + 1)]


@pytest.fixture(scope="module")
def new():
    """Return the new wheel."""
    return NewWheel.of("S1002")


def middle(new, depth):
    """Where half of the worn area lies to each side, across the wheel [m]."""
    total = np.cumsum(depth) / depth.sum()
    return np.interp(0.5, total, 0.5 * (new.y[1:] + new.y[:-1]))


def test_fatigue_of_the_classes_is_that_of_the_wear_numbers(run):
    """By the whole life rail model, where a wheel has one contact; it is worst in the curve."""
    table, _ = classes_of(run[0], 0)
    single = table["contacts"] == 1.0
    assert np.count_nonzero(single) >= 4
    expected = np.interp(table["wear_number"], [15.0, 65.0, 175.0], [0.0, 1e-5, 0.0])
    low = single & (table["wear_number"] < 175.0)
    np.testing.assert_allclose(table["rcf_damage"][low], expected[low], rtol=1e-9, atol=1e-18)
    assert np.max(np.abs(table["rcf_damage"])) > 1e-6


def test_tables_of_the_run(run):
    """Damage of a passage by class, as the means have it; the units' calls take a part of the workers' time."""
    folder, _ = run
    worst = max(by_class(folder, 0)["R 500 right"]["rcf_damage"])
    assert f"{1e6 * worst:.2f}" in fatigue_table(folder, (0,)).splitlines()[-1]
    assert "the contacts' steps" in run_table(mileage.small_plan(), folder)
    spent = json.loads(times_file(folder, 0).read_text())
    assert all(seconds > 0.0 for seconds in spent.values())
    assert spent["steps"] + spent["derivatives"] + spent["initialisation"] < spent["all"]


@pytest.mark.parametrize("curve", [Curve(STRAIGHT, 0.0, 40.0, 1.0), Curve(-500.0, 0.11, 85.0 / 3.6, 1.0)])
@pytest.mark.parametrize("traction", [8e3, -8e3])
def test_torques_of_driven_and_braked_wheelsets(component, new, curve, traction):
    """The contacts' torque about each axle is the traction times the wheel's radius; the train takes what is pulled."""
    data, digest = component
    settings = mileage.small_plan().settings()
    wheels = [new.for_units(new.none())] * 4
    bogie, left, _ = in_equilibrium(local_file(data, digest), settings, wheels, replace(curve, traction=traction), None)
    assert left < 1.0
    torque = np.array([wheel.get("friction_torque")[0] for wheel in bogie.all_wheels()]).reshape(2, 2).sum(axis=1)
    along, up = bogie.forces[:, :, 0].sum(axis=1), bogie.forces[:, :, 2].sum(axis=1)
    pull = PULL_UNIT * bogie.unknown[PULL]
    bogie.close()
    # To what Newton's method leaves.
    assert torque == pytest.approx(np.full(2, -traction * VEHICLE.wheel_radius), abs=1.0)
    if np.isinf(curve.radius):
        # Both wheels roll on the running circle, to a tenth of a millimetre; spin takes some newtons.
        assert along == pytest.approx(np.full(2, traction), rel=2e-3)
        assert pull == pytest.approx(-2.0 * traction, rel=2e-3)
        # Pulled at the secondary springs' height, it leans on the wheelset behind. The frame's pitch moves what stands
        # on it by half a millimetre, which is 1 % of that moment.
        leans = 2.0 * traction * VEHICLE.secondary_height / (2.0 * VEHICLE.half_wheelbase)
        assert 0.5 * (up[1] - up[0]) == pytest.approx(leans, rel=0.02)


def test_mirrored_line_with_traction(component, tmp_path):
    """Driven in the curve and braked on straight track: mirrored curves wear the wheels of the other side."""
    plan = mileage.small_plan(distance=50e3)
    straight, curve = plan.line
    plan = replace(plan, line=(replace(straight, traction=-6e3), replace(curve, traction=8e3)))
    found = []
    for name, line in (("one", plan.line), ("other", tuple(mirrored(plan.line)))):
        assert march(None, replace(plan, line=line), tmp_path / name, component) == 1
        found.append(read_state(state_file(tmp_path / name, 1)).depth)
    assert np.abs(found[1][list(MIRROR)] - found[0]).max() < 1e-6 * found[0].max()


def test_wheels_wear_where_they_roll(run, new):
    """In a curve to the right the outer leading wheel wears at its flange's root, the inner one to the field side."""
    _, states = run
    assert len(states) >= 3
    last = states[-1]
    assert last.distance == 400e3
    outer, inner, *trailing = (middle(new, depth) for depth in last.depth)
    assert -0.040 < outer < -0.025
    assert 0.005 < inner < 0.025
    assert all(-0.020 < place < 0.020 for place in trailing)
    # All wear, the leading ones more, and no step takes more than it may.
    areas = [new.area(depth) for depth in last.depth]
    assert min(areas) > 0.0
    assert min(areas[:2]) > 3.0 * max(areas[2:])
    most = mileage.small_plan().largest_depth
    for before, after in pairwise(states):
        assert (after.depth >= before.depth).all()
        assert (after.depth - before.depth).max() <= most * (1.0 + 1e-9)


def test_killed_run_goes_on(run, tmp_path, killed_half_way):
    """Killed within a step and gone on with on two workers, it has the bits of one without Dask."""
    folder, states = run
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    command = [sys.executable, program, os.pathsep.join(folders.folders()), tmp_path / "broken"]
    killed_half_way(command)
    broken = sorted(path.name for path in (tmp_path / "broken").glob("*.parquet"))
    assert broken == ["classes_0000.parquet", "classes_0001.parquet", "wheels_0000.parquet", "wheels_0001.parquet"]
    done = subprocess.run([*command, "2"], stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
    assert "1 steps, 200 km, are there from before" in done.stdout
    for step in range(len(states)):
        for path in (state_file(folder, step), folder / f"classes_{step:04d}.parquet"):
            if path.exists():
                assert (tmp_path / "broken" / path.name).read_bytes() == path.read_bytes(), path.name


def test_program_of_the_page(tmp_path):
    """Line and program of the page run as they stand there, but for a kilometre alone."""
    page = (REPOSITORY / "docs" / "couplings" / "mileage.md").read_text()
    (line,), (program,) = (re.findall(rf"```{kind}\n(.*?)```", page, re.DOTALL) for kind in ("text", "python"))
    assert program.count("distance=50_000e3") == 1
    (tmp_path / "line.csv").write_text(line)
    short = program.replace("distance=50_000e3", "distance=1e3, samples=1, samples_straight=1")
    (tmp_path / "mine.py").write_text(short)
    (tmp_path / "studies").symlink_to(REPOSITORY / "studies")
    done = subprocess.run([sys.executable, "mine.py"], cwd=tmp_path, capture_output=True, text=True, timeout=600)
    assert done.returncode == 0, done.stderr
    assert "step 1: 1 of 1 km" in done.stdout
    assert read_state(state_file(tmp_path / "results" / "mine", 1)).depth.max() > 0.0


class Workers:
    """A client of Dask whose workers are this process: what they are given and return goes through pickle."""

    def scatter(self, data, broadcast):
        """Hand out data."""
        return data

    def submit(self, function, *arguments, pure):
        """Call at once; an error would be logged at length by Dask."""
        return pickle.loads(pickle.dumps(function(*arguments)))

    def gather(self, results):
        """Return them."""
        return results


def own_geometry(**parameters):
    """The small plan with parameters beside its own."""
    return mileage.small_plan(parameters=mileage.PARAMETERS | parameters)


def test_conicity_on_the_own_rail(new, tmp_path):
    """Measures have the conicity on the run's rail, in its dimensions; where a wheel is off its rail there is none."""

    def conicity(plan):
        return measured(plan, new, Progress(0, 0.0, np.stack([new.none()] * len(WHEELS)), {}))[0]["conicity"]

    def expected(rail="60E1", wheel="S1002", **dimensions):
        found = wheelrail.contact_geometry(rail, wheel, lateral=(-5e-3, 5e-3), **dimensions)
        return found.attrs["conicity"]

    dimensions = {"gauge": 1.433, "gauge_depth": 0.013, "rail_inclination": 0.05}
    dimensions |= {"flange_back_distance": 1.361, "flange_back_position": 0.0705}
    path = tmp_path / "räil.prr"
    wheelrail.Profile("54E1").write(path)
    new.profile.write(tmp_path / "wheel.prw")
    assert conicity(mileage.small_plan()) == expected()
    assert conicity(own_geometry(rail_profile="54e1", **dimensions)) == expected("54E1", **dimensions)
    assert conicity(own_geometry(rail_profile=str(path))) == expected(path) != expected()
    assert own_geometry(rail_profile=path.as_uri()).rail.points.equals(wheelrail.Profile(path).points)
    # The units have the new wheel as a file, and smooth it.
    smooth = expected(wheel=tmp_path / "wheel.prw", smoothing=0.01)
    assert conicity(own_geometry(profile_smoothing=0.01)) == smooth != expected()
    assert np.isnan(conicity(own_geometry(gauge=3.0)))


def test_workers_without_the_file_of_the_rail(component, new, tmp_path):
    """They have what is in it: the same wear as where it is, and that of the built-in rail that it is."""
    path = tmp_path / "rail.prr"
    wheelrail.Profile("54E1").write(path)
    wheels = [new.for_units(new.none())] * 4
    straight = main_line()[0]

    def areas(settings):
        settings = pickle.loads(pickle.dumps(replace(settings, samples_straight=1)))
        return rates(*component, settings, wheels, straight, None)["area"]

    settings = own_geometry(rail_profile=str(path)).settings()
    there = areas(replace(settings, rail=None))
    path.unlink()
    named = areas(own_geometry(rail_profile="54E1").settings())
    for found in (areas(settings), named):
        for area, expected in zip(found, there, strict=True):
            assert area.sum() == pytest.approx(expected.sum(), rel=1e-3)
            assert area.sum() > 0.0


def test_gauge_that_no_wheelset_spans(component, new):
    """Between rails that are too far apart the wheelsets fall, and no wheel carries: no equilibrium, and why."""
    settings = mileage.small_plan().settings()
    settings = replace(settings, parameters=(*settings.parameters, ("gauge", 3.0)))
    wheels = [new.for_units(new.none())] * 4
    with pytest.raises(NoEquilibriumError, match="wheels are lifted, overloaded or off the rail"):
        in_equilibrium(local_file(*component), settings, wheels, main_line()[0], None)


def test_class_without_an_equilibrium(monkeypatch, tmp_path, component):
    """A worker returns the error, the run raises it, and the command line says it in one line."""

    def without(_fmu, _settings, _wheels, curve, _starts):
        raise no_equilibrium(curve, (0.0, 0.0), 5e3)

    monkeypatch.setattr("mileage_bogie.in_equilibrium", without)
    words = r"^straight, \d+ km/h, cant 0 mm, rails off by 0.0 and 0.0 mm: no equilibrium found, 5000 N are left over$"
    for client in (Workers(), None):
        with pytest.raises(NoEquilibriumError, match=words):
            march(client, mileage.small_plan(), tmp_path, component)
    assert len(read_state(state_file(tmp_path, 0)).depth) == len(WHEELS)
    monkeypatch.setattr(mileage, "client_for", lambda *_: nullcontext(Workers()))
    monkeypatch.setattr(mileage, "WORK", tmp_path)
    monkeypatch.setattr(sys, "argv", ["mileage", "--small"])
    with pytest.raises(SystemExit) as caught:
        mileage.main()
    assert re.match(words.replace("^", "^mileage: "), caught.value.code)


def test_mirrored_line_mirrors_the_wheels(run, component, tmp_path):
    """Curves to the other hand wear the wheels of the other side, to what Newton's method leaves."""
    _, states = run
    plan = mileage.small_plan(distance=200e3)
    march(None, replace(plan, line=tuple(mirrored(plan.line))), tmp_path, component)
    found = read_state(state_file(tmp_path, 1))
    assert found.distance == states[1].distance
    difference = np.abs(found.depth[list(MIRROR)] - states[1].depth).max()
    assert difference < 1e-6 * states[1].depth.max()


def test_half_the_step(run, component, new, tmp_path):
    """Steps of half the length change the worn areas by less than 2 %."""
    _, states = run
    plan = mileage.small_plan(distance=200e3, largest_depth=0.5 * mileage.small_plan().largest_depth)
    assert march(None, plan, tmp_path, component) == 2
    halved = read_state(state_file(tmp_path, 2))
    for depth, finer in zip(states[1].depth, halved.depth, strict=True):
        assert new.area(finer) == pytest.approx(new.area(depth), rel=0.02)


def test_depths_make_the_profile(new):
    """The area of depths is that between the new and the worn profile; an area that is taken away is found again."""
    y = 0.5 * (new.y[1:] + new.y[:-1])
    depth = 1e-3 * np.exp(-(((y + 0.032) / 0.004) ** 2)) + 5e-4 * np.exp(-(((y - 0.01) / 0.01) ** 2))
    depth[: np.argmin(new.z)] = 0.0
    worn = new.worn(depth)
    assert worn.worn_area(wheelrail.Profile("S1002")) == pytest.approx(new.area(depth), rel=1e-3)
    area = 1e-9 * np.exp(-(((y - 0.005) / 0.005) ** 2))
    more = depth + new.depth_of(area, depth)
    assert new.area(more) - new.area(depth) == pytest.approx(area.sum(), rel=1e-2)
    # A wheel for the units: its cells lie along the worn profile, to what chords are shorter, and its running circle is
    # lower.
    wheel = new.for_units(depth)
    assert wheel.ends[-1] == pytest.approx(float(worn.points["arc_length"].iloc[-1]), abs=5e-6)
    assert wheel.depth == pytest.approx(5e-4 * np.exp(-1.0), rel=0.02)


def test_wheel_from_two_columns(new, tmp_path):
    """A file that does not say of which body it is has a wheel, that of its points."""
    path = tmp_path / "mine.csv"
    points = new.profile.points[["y", "z"]].to_numpy()
    np.savetxt(path, 1e3 * points, delimiter=",")
    found = NewWheel.of(path)
    assert found.profile.body == "wheel"
    # Running circle and directions are found anew on the points: to round-off of the file's millimetres, some 1e-9 m.
    np.testing.assert_allclose(found.z, new.z, atol=1e-8)


def test_smoothing_loses_nothing(new):
    """A wave of the given length is halved, and no area is lost."""
    wave = 5e-3
    place = new.place - new.place.mean()
    window = np.exp(-((place / 0.015) ** 2))
    area = window * (1.0 + 0.3 * np.cos(2.0 * np.pi * place / wave))
    found = smoothed(area, new.cell, wave)
    assert found.sum() == pytest.approx(area.sum(), rel=1e-9)
    centre = np.abs(place) < 0.5 * wave
    swing = np.ptp((found / smoothed(window, new.cell, wave))[centre])
    assert swing == pytest.approx(0.5 * 0.6, rel=0.03)


def test_modules_are_sent_behind_what_they_import():
    """A scheduler and workers elsewhere import each module as it comes."""
    for number, name in enumerate(mileage.MODULES):
        text = Path(importlib.util.find_spec(name).origin).read_text()
        imported = set(re.findall(r"^(?:from|import) (\w+)", text, re.MULTILINE))
        assert not imported & set(mileage.MODULES[number:]), name
        assert not {other for other in imported if other.startswith(("mileage", "curve"))} - set(mileage.MODULES), name


def test_line_of_the_page():
    """Its shares are 1, it is its own mirror, and no class asks for more than 70 mm more cant than it has."""
    line = main_line()
    assert sum(curve.share for curve in line) == pytest.approx(1.0)
    assert is_its_own_mirror(line)
    assert len(named([*line, *line])) == 2 * len(line)
    plain = straight_line(mileage.TRACTIONS)
    assert sum(curve.share for curve in plain) == pytest.approx(1.0)
    assert is_its_own_mirror(plain)
    assert list(named(plain))[:3] == ["straight", "straight, driven 10 kN", "straight, braked 10 kN"]
    for curve in line:
        assert 1.5 * curve.speed**2 / (9.81 * abs(curve.radius)) - curve.cant < 0.07


LINE = "radius [m],cant [mm],speed [km/h],length [km],gauge_face_friction\n,0,140,60,1\n-300,100,60,20,0.3\n"


def test_line_from_a_table(tmp_path):
    """Units in the headings, lengths as shares, straight track without a radius."""
    path = tmp_path / "line.csv"
    path.write_text(LINE + "300,100,60,20,0.3\n")
    line = read_line(path)
    assert [curve.name for curve in line] == ["straight", "R 300 right", "R 300 left"]
    assert [curve.share for curve in line] == pytest.approx([0.6, 0.2, 0.2])
    assert line[1].cant == pytest.approx(0.1)
    assert line[1].speed == pytest.approx(60.0 / 3.6)
    assert line[1].gauge_face_friction == 0.3
    assert is_its_own_mirror(line)
    path.write_text(DRIVEN)
    assert [curve.traction for curve in read_line(path)] == [0.0, -8e3]


DRIVEN = "radius [m],cant [mm],speed [km/h],share [%],traction [kN]\n,0,140,60,0\n-300,100,60,40,-8\n"


@pytest.mark.parametrize(
    ("text", "words"),
    [
        (DRIVEN.replace("-8", "-80"), "line.csv, row 2: traction = -80000 N: -50000 to 50000 N is needed"),
        (DRIVEN.replace("-8", "hard"), "line.csv, row 2: traction = 'hard': a number is needed"),
        (DRIVEN.replace("-8", ""), "line.csv, row 2: traction = '': a number is needed"),
        (DRIVEN.replace("[kN]", "[t]"), "line.csv: traction [t]: the unit is not known; allowed is N, kN"),
        (LINE.replace("-300", "-30"), "line.csv, row 2: radius = -30 m: 150 m or more, negative to the right"),
        (LINE.replace("-300", "abc"), "line.csv, row 2: radius = 'abc': a number is needed"),
        (LINE.replace("100,60", "1000,60"), "line.csv, row 2: cant = 1 m: 0 to 0.2 m is needed"),
        (LINE.replace("[km/h]", "[mph]"), "line.csv: speed [mph]: the unit is not known; allowed is m/s, km/h"),
        (LINE.replace("length", "share_of"), "line.csv: there is no column share_of; there are radius"),
        (LINE.replace("speed [km/h]", "share"), "line.csv: column speed is needed"),
        (LINE.replace(",0,140", ",20,140"), "line.csv, row 1: cant = 0.02 m: 0 on straight track is needed"),
        (LINE.replace("60,20,0.3", "60,20"), "line.csv, row 2: 4 values under 5 headings"),
        ("radius\n", "line.csv: headings and at least one row are needed"),
    ],
)
def test_bad_lines(tmp_path, text, words):
    """The file, the row, the field, its value and what is allowed."""
    path = tmp_path / "line.csv"
    path.write_text(text)
    with pytest.raises(BadInputError) as caught:
        read_line(path)
    assert words in str(caught.value)


def test_traction_beyond_friction():
    """What a wheelset cannot put on the rail is refused, by its load and the friction of its class."""
    line = (Curve(STRAIGHT, 0.0, 30.0, 1.0, traction=30e3),)
    with pytest.raises(
        BadInputError, match=r"straight, driven 30 kN: traction = 30000 N: -22\d\d\d to 22\d\d\d N, 0.6 of"
    ):
        mileage.small_plan(line=line)


def test_vehicle_of_the_user():
    """Fields by name; what is wrong is named with what is allowed."""
    vehicle = vehicle_of({"half_wheelbase": 1.3, "primary_stiffness": [1e7, 4e6, 1e6]})
    assert vehicle == replace(VEHICLE, half_wheelbase=1.3, primary_stiffness=(1e7, 4e6, 1e6))
    for given, words in (
        ({"wheelbase": 2.6}, "there is no field wheelbase; there are wheel_radius, wheelset_mass"),
        ({"half_wheelbase": 26}, "half_wheelbase = 26: 0.5 to 5 is needed"),
        ({"primary_stiffness": [1e7]}, "primary_stiffness = [10000000.0]: a list of 3 numbers is needed"),
        ({"body_mass": "heavy"}, "body_mass = heavy: a number is needed"),
    ):
        with pytest.raises(BadInputError) as caught:
            vehicle_of(given)
        assert words in str(caught.value)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        (["--distance", "-5"], "mileage: plan: distance = -5 km: 1 to 10000000 km is needed"),
        (["--largest-depth", "0.6"], "mileage: plan: largest_depth = 0.6 mm: 0.001 to 0.5 mm is needed"),
        (["--smoothing", "30"], "mileage: plan: smoothing = 30 mm: 0 to 20 mm is needed"),
        (["--wheel", "60E1"], "60E1 is the profile of a rail; a wheel is needed"),
        (["--limit", "flange=22"], "--limit flange: there are flange_height"),
        (["--fresh", "--name", ".."], "--name ..: a name without folders"),
        (["--fresh", "--name", "/somewhere"], "--name /somewhere: a name without folders"),
        (["--samples", "0"], "plan: samples = 0: 1 to 99 is needed"),
        (["--name", "hills", "--small"], "--name hills: the study without options has results of that name"),
        (["--set", "friction=0.3"], "there is no variable friction"),
        (["--set", "patch_nodes=4"], "patch_nodes = 4: allowed is 8 to 201"),
        (["--set", "rail_profile=5"], "rail_profile = 5.0: a text is needed"),
        (["--set", "rail_profile=none.prr"], "there is no file none.prr in the working directory"),
        (["--set", "wheel_profile=S1002"], "--set wheel_profile: --wheel gives it"),
        (["--set", "friction_law"], "--set friction_law: NAME=VALUE is needed"),
    ],
)
def test_bad_options(monkeypatch, options, words):
    """Refused before anything is computed."""
    monkeypatch.setattr(sys, "argv", ["mileage", *options])
    with pytest.raises(SystemExit) as caught:
        mileage.main()
    assert words in str(caught.value.code)
    assert "\n" not in caught.value.code
