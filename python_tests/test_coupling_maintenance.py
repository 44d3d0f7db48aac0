"""studies/maintenance: wear of a wheel, spread of a line by hand; a killed job goes on and gives the same bits."""

import os
import subprocess
import sys

import braking_line
import folders
import maintenance
import numpy as np
import pytest
from braking_line import AMBIENT, AS_IT_IS, CONTACT, CONTACT_WIDTH, FACTORS, WEAR_COEFFICIENT, drawn
from dask_runs import read_component
from helpers import FMU, WHEEL_RADIUS, Instance
from maintenance_results import line_variance, trains_to_limit
from scipy.integrate import quad
from scipy.special import ndtri

TRAINS = 40
KEYS = [(scenario, number, "") for scenario in ("as it is", "vehicles 20 % heavier") for number in range(4)]
KEYS += [("weather anew for each train", 0, ""), ("weather anew for each train", 0, "load")]
# The same lines, short, in a process of its own, which goes on after each part when it is told to: it can be killed
# half-way.
PROGRAM = """
import os, sys
from pathlib import Path
sys.path[:0] = sys.argv[1].split(os.pathsep)
import dask_runs, maintenance
write = maintenance.write_part
def waiting(*arguments):
    write(*arguments)
    print("written", flush=True)
    sys.stdin.readline()
maintenance.write_part = waiting
if __name__ == "__main__":
    with dask_runs.local_client(2) as client:
        count = maintenance.run(client, Path(sys.argv[2]), {keys!r}, {trains})
    print("computed", count, flush=True)
""".replace("{keys!r}", repr(KEYS)).replace("{trains}", str(TRAINS))


@pytest.fixture(scope="module")
def place():
    """Return the spot of rail."""
    return braking_line.spot(FMU)


# ---- a wheel --------------------------------------------------------------------------------------------------------


@pytest.mark.parametrize(("speed", "friction", "held"), [(10.0, 0.05, 0.05), (15.0, 0.08, 0.20), (22.0, 0.04, 0.10)])
def test_sliding_wheel_wears_by_archard(place, speed, friction, held):
    """A wheel that slides wears k (load/width) times creepage, whatever friction and speed: p|s| over the passage.

    What the elastic slip adds has no mean over the contact but by its unlike pressure: some 1e-5.
    """
    load = 55e3
    place.begin(speed, friction)
    found, slides = place.brake(0.12 * load, load, AMBIENT, held)
    assert slides
    assert found["leaving_wear_depth"] == pytest.approx(WEAR_COEFFICIENT * load / CONTACT_WIDTH * held, rel=1e-4)
    # Of what friction gives at rest, the law of slip leaves 0.4 and more.
    assert 0.4 * friction < -found["traction_coefficient"] < friction


@pytest.mark.parametrize(
    ("friction", "wanted", "tolerance"), [(0.2, 0.07, 0.04), (0.4, 0.07, 0.08), (0.3, 0.12, 0.04), (0.11, 0.09, 0.04)]
)
def test_creeping_wheel_wears_by_carter(place, friction, wanted, tolerance):
    """A wheel that creeps wears k times the integral of p|s|/V over the zone where Carter's solution slips.

    4 %: a strip of 0.5 m by 1 m for a half-space, friction that falls with slip by 1 % or so, and the mesh, where some
    20 nodes are in contact: twice that where only two of them slip.
    """
    load, speed = 60e3, 15.0
    place.begin(speed, friction)
    found, slides = place.brake(wanted * load, load, AMBIENT, 0.1)
    assert not slides
    assert -found["traction_coefficient"] == pytest.approx(wanted, rel=braking_line.TRACTION_TOLERANCE)
    half = braking_line.half_length(load)
    stick = half * np.sqrt(1.0 - wanted / friction)
    peak = 2.0 * load / CONTACT_WIDTH / (np.pi * half)

    def worn(x):
        """Of a point behind the zone of stick, whose middle is `half - stick` ahead of that of the contact."""
        pressure = peak * np.sqrt(1.0 - (x / half) ** 2)
        slip = friction / WHEEL_RADIUS * np.sqrt((x - half + stick) ** 2 - stick**2)
        return pressure * slip

    by_hand = WEAR_COEFFICIENT * quad(worn, -half, half - 2.0 * stick)[0]
    assert found["leaving_wear_depth"] == pytest.approx(by_hand, rel=tolerance)


def test_wheel_slides_where_the_rail_gives_less(place):
    """The more a wheel is to brake the more it wears, up to the limit; from there on it slides."""
    load, friction = 60e3, 0.12
    before = 0.0
    for wanted in (0.02, 0.06, 0.10, 0.11, 0.115):
        place.begin(15.0, friction)
        found, slides = place.brake(wanted * load, load, AMBIENT, 0.1)
        assert not slides
        assert found["leaving_wear_depth"] > before
        before = found["leaving_wear_depth"]
    for wanted in (0.1199, 0.13):
        place.begin(15.0, friction)
        found, slides = place.brake(wanted * load, load, AMBIENT, 0.1)
        assert slides
        assert found["leaving_wear_depth"] > 10.0 * before


def test_what_carries_from_wheel_to_wheel():
    """Wear that is there already adds, and changes nothing else; half the coefficient is half the wear."""
    results = []
    for coefficient, incoming in ((5e-13, 0.0), (5e-13, 2e-4), (2.5e-13, 0.0)):
        contact = Instance(FMU, **CONTACT | {"wear_coefficient": coefficient, "incoming_wear_depth": incoming}).start()
        contact.set(vehicle_speed=15.0, wheel_speed=15.0 * 0.9 / WHEEL_RADIUS, friction_scale=0.15, normal_load=60e3)
        contact.step(braking_line.STEP)
        traction, depth = contact.get("traction_force", "leaving_wear_depth")
        results.append((traction, depth - incoming))
        contact.close()
    new, worn, tough = results
    # Round-off of 0.2 mm in a step of 0.3 um; the bits of the load's iteration.
    assert worn == pytest.approx(new, rel=1e-6)
    # The wheel's own 0.3 um in a contact that is pressed in by 80: a ten-thousandth, or so.
    assert tough[0] == pytest.approx(new[0], rel=1e-4)
    assert tough[1] == pytest.approx(0.5 * new[1], rel=1e-4)


def test_warm_rail():
    """Heat of the wheels before, by hand: q/(rho c sqrt(pi kappa t)) of each."""
    rise = braking_line.warmed([1e4, 3e4], 10.0)
    by_hand = 1e4 / np.sqrt(np.pi * 1.44e-5 * 19.0 / 10.0) + 3e4 / np.sqrt(np.pi * 1.44e-5 * 16.5 / 10.0)
    assert rise == pytest.approx(by_hand / (7800.0 * 460.0), rel=1e-12)
    assert braking_line.warmed([], 10.0) == 0.0


def test_wear_by_energy():
    """The mild branch is 6.8e-13 m2/N of the friction energy per area, whatever the length; no jump but the printed."""
    power, length, speed = 300.0, 0.011, 15.0
    assert braking_line.by_energy(power, length, speed) == pytest.approx(
        5.3e-9 / 7800.0 * power / (speed * CONTACT_WIDTH), rel=1e-12
    )
    area = CONTACT_WIDTH * length
    for edge, jump in ((10.4, 55.0 / (5.3 * 10.4)), (77.2, 1.0)):
        below, above = (
            braking_line.by_energy(edge * 1e6 * area * speed * x, length, speed) for x in (1 - 1e-9, 1 + 1e-9)
        )
        assert above / below == pytest.approx(jump, rel=1e-6)


# ---- what is drawn --------------------------------------------------------------------------------------------------


def test_draws_depend_on_their_line_and_factor_alone():
    """Drawn again, in any order, they are the same bits; another line, or one factor again, is another."""
    first, heavier = drawn(AS_IT_IS, 3), drawn(AS_IT_IS | {"load": 1.2}, 3)
    other = drawn(AS_IT_IS, 4)
    for name, values in drawn(AS_IT_IS, 3).items():
        assert np.array_equal(values, first[name]), name
        assert not np.array_equal(values, other[name]), name
    assert np.array_equal(first["friction"], heavier["friction"])
    assert heavier["load"] == pytest.approx(1.2 * first["load"], rel=1e-12)
    for factor, names in zip(
        FACTORS, ({"friction", "share"}, {"load", "brake_force"}, {"brake_force"}, {"speed"}, {"held"}), strict=True
    ):
        again = drawn(AS_IT_IS, 3, again=factor)
        assert {name for name in again if not np.array_equal(again[name], first[name])} == names


def test_weather_is_as_stated():
    """Friction has the stated shares, and a correlation of exp(-h/20) in its normal scores over h trains."""
    trains = 400_000
    draws = drawn(AS_IT_IS, 0, trains)
    # The correlation leaves 400 000/40 independent trains: 0.005 for a share of a half, at one deviation.
    for share, friction in zip(braking_line.SHARES, braking_line.FRICTIONS, strict=True):
        assert np.mean(draws["friction"] <= friction) == pytest.approx(share, abs=0.02)
    normal = ndtri(draws["share"])
    for lag in (1, 20, 60):
        found = np.mean(normal[lag:] * normal[:-lag])
        assert found == pytest.approx(np.exp(-lag / 20.0), abs=0.03)
    assert np.all((draws["speed"] >= 8.0) & (draws["speed"] <= 22.0))
    assert draws["load"].max() < CONTACT["largest_load"] / 1.2


# ---- the spread of lines --------------------------------------------------------------------------------------------


@pytest.mark.parametrize("memory", [0.0, 5.0, 20.0])
def test_spread_of_lines_by_formula(memory):
    """Wear by a rule that is quickly drawn: the formula, from single trains, is the spread over 2000 lines.

    2000 lines leave 1.6 % of a deviation, more as they are skew, and so do 400 000 trains, of which 3 % slide: 6 % are
    some three deviations. Left out, the weather would be missed by a factor of 2 and more.
    """
    rng = np.random.default_rng(1)

    def wear(share):
        """A train slides on the worst 3 % of rails, by how much is chance."""
        return (share < 0.03) * rng.uniform(1.0, 3.0, share.shape) + 0.01 * rng.uniform(size=share.shape)

    trains, lines = 300, 2000
    single = braking_line.weather(rng, 400_000, 0.0)
    share = np.array([braking_line.weather(rng, trains, memory) for _ in range(lines)])
    found = wear(share).sum(axis=1).std()
    worn = wear(single)
    assert np.sqrt(line_variance(single, worn, memory, trains)) == pytest.approx(found, rel=0.06)
    assert np.sqrt(line_variance(single, worn, 0.0, trains)) == pytest.approx(np.sqrt(trains) * worn.std(), rel=1e-12)


def test_trains_to_limit():
    """Certain lines reach a limit at limit/rate; with spread the early ones have 1.645 deviations more by then."""
    assert trains_to_limit(np.full(5, 60e-6), 1000, 300e-6) == pytest.approx([5000.0] * 3)
    depths = np.array([40e-6, 80e-6])
    early, usual, late = trains_to_limit(depths, 1000, 300e-6)
    assert usual == pytest.approx(5000.0)
    deviation = depths.std(ddof=1) / np.sqrt(1000.0)
    assert early * 60e-9 + 1.6449 * deviation * np.sqrt(early) == pytest.approx(300e-6, rel=1e-4)
    assert late * 60e-9 - 1.6449 * deviation * np.sqrt(late) == pytest.approx(300e-6, rel=1e-4)


# ---- the job --------------------------------------------------------------------------------------------------------


def test_killed_job_goes_on(tmp_path, killed_half_way):
    """Killed after some lines, it computes only the others; together they are the bits computed without Dask."""
    folder = tmp_path / "lines"
    modules = os.pathsep.join(folders.folders())
    program = tmp_path / "program.py"
    program.write_text(PROGRAM)
    killed_half_way([sys.executable, program, modules, folder])
    before = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.parquet")}
    assert len(before) == 4

    command = [sys.executable, program, modules, folder]
    done = subprocess.run(command, stdin=subprocess.DEVNULL, capture_output=True, text=True, timeout=900)
    assert done.returncode == 0, done.stderr
    assert int(done.stdout.split("computed")[1]) == len(KEYS) - len(before)
    after = {path.name: path.stat().st_mtime_ns for path in folder.glob("*.parquet")}
    assert len(after) == len(KEYS)
    assert before.items() <= after.items()
    # Here, without Dask, and in another order.
    component, digest = read_component()
    there = maintenance.gather(folder, KEYS)
    for scenario, number, again in reversed(KEYS):
        columns = braking_line.line(component, digest, braking_line.SCENARIOS[scenario], number, TRAINS, again or None)
        for name, values in columns.items():
            assert there[scenario, again][name][number].tolist() == values, (scenario, number, name)
