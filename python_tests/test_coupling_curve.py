"""studies/curve: a wheelset's kinematics in a curve, steady curving in balance, and Exudyn that stays in it."""

from math import cos, hypot, sin

import curve_bogie
import curve_equilibrium
import curve_track
import curve_vehicle
import numpy as np
import pytest
from curve_track import INPUTS, Layout, Track, motion
from curve_vehicle import AXLES, GRAVITY, MASS, SIDES, SPEED, WHEELS
from helpers import WHEEL_RADIUS

IN_CURVE = 100.0  # m
PLACE = 6.0  # m, on straight track


@pytest.fixture(scope="module")
def track():
    """Return the track without unevenness."""
    return Track()


@pytest.fixture(scope="module")
def straight(track):
    """Return the equilibrium on straight track."""
    found = curve_equilibrium.straight_running(track, PLACE)
    yield found
    found.close()


@pytest.fixture(scope="module")
def steady(track, straight):
    """Return the equilibrium in the curve, solved once more from where it stands: the windows know no way there."""
    first = curve_equilibrium.Equilibrium(track, IN_CURVE).start_from(straight).solve()
    found = curve_equilibrium.Equilibrium(track, IN_CURVE).start_from(first).solve()
    first.close()
    yield found
    found.close()


def test_track_is_its_layout(track):
    """In the curve three points lie on its radius; the whole curve turns by its length; its outer rail is lifted."""
    layout, marks = track.layout, track.layout.marks
    points = [complex(*track.at(place)[:2]) for place in (70.0, 90.0, 110.0)]
    a, b, c = (abs(points[i] - points[j]) for i, j in ((0, 1), (1, 2), (0, 2)))
    half = 0.5 * (a + b + c)
    area = np.sqrt(half * (half - a) * (half - b) * (half - c))
    assert a * b * c / (4.0 * area) == pytest.approx(abs(layout.radius), rel=1e-6)
    # Each transition turns half as much as the curve.
    assert track.at(marks[-1])[2] == pytest.approx((layout.curve + layout.transition) / layout.radius)
    left, right = (track.axes(IN_CURVE)[1] @ [0.0, side * 0.75, 0.0] for side in (1.0, -1.0))
    assert (left - right)[2] == pytest.approx(layout.cant)
    x, y, heading, *_ = track.at(IN_CURVE)
    beside = track.place_of(x - 0.3 * sin(heading), y + 0.3 * cos(heading), IN_CURVE - 1.0)
    assert beside == pytest.approx(IN_CURVE, abs=1e-9)


def test_motion_that_follows_the_curve(track):
    """A wheelset that follows the curve stands still against the track, and turns by V/R all the same."""
    coordinates = curve_vehicle.standing(track, IN_CURVE)[0]
    place = IN_CURVE + curve_vehicle.HALF_WHEELBASE
    _, axes = track.axes(place)
    turning = np.array([0.0, 0.0, SPEED / track.layout.radius])
    rates = np.concatenate([SPEED * axes[:, 0], np.linalg.solve(curve_track.turning(coordinates), turning)])
    rates[5] += 36.0
    found_place, told = motion(track, coordinates, rates, IN_CURVE)
    told = dict(zip(INPUTS, told, strict=True))
    assert found_place == pytest.approx(place, abs=1e-9)
    still = ("lateral_displacement", "vertical_displacement", "roll_angle", "yaw_angle", "lateral_speed")
    for name in (*still, "vertical_speed", "roll_rate"):
        assert told[name] == pytest.approx(0.0, abs=1e-9)
    cant = track.at(place)[4]
    assert told["vehicle_speed"] == pytest.approx(SPEED)
    assert told["yaw_rate"] == pytest.approx(turning[2] * cos(cant))
    assert told["wheel_speed"] == pytest.approx(36.0 + turning[2] * sin(cant))


def test_motion_on_straight_track(track):
    """Displaced, rolled and yawed on straight track it is told just that, and rates as they are."""
    roll, yaw = 4e-3, -7e-3
    coordinates = np.array([3.0, 2e-3, WHEEL_RADIUS - 1e-3, roll - 0.5 * np.pi, -yaw * cos(roll), 0.3])
    _, told = motion(track, coordinates, np.array([20.0, 0.03, -0.01, 0.02, 0.0, 43.0]), 2.0)
    told = dict(zip(INPUTS, told, strict=True))
    # Roll and yaw one after the other and the other way round differ to second order.
    expected = {"lateral_displacement": 2e-3, "vertical_displacement": -1e-3, "roll_angle": roll, "yaw_angle": yaw}
    expected |= {"vehicle_speed": 20.0, "lateral_speed": 0.03, "vertical_speed": -0.01}
    for name, value in expected.items():
        assert told[name] == pytest.approx(value, rel=1e-4), name
    assert told["roll_rate"] == pytest.approx(0.02, rel=1e-3)
    assert told["wheel_speed"] == pytest.approx(43.0, rel=1e-4)


def test_straight_running_is_symmetric(straight):
    """In the middle, the wheels under their static load, which rolling resistance hardly shifts; left as right."""
    row = straight.table()
    for axle in AXLES:
        assert row[f"y_{axle}"] == pytest.approx(0.0, abs=1e-7)
        loads = [row[f"Q_{axle}_{side}"] for side in SIDES]
        # Newton's method ends at 1 mN; of an asymmetry that leaves nothing else than this.
        assert loads[0] == pytest.approx(loads[1], abs=0.1)
        assert loads[0] == pytest.approx(curve_vehicle.WHEEL_LOAD, rel=1e-3)


def test_curving_is_in_balance(steady, track):
    """All forces of the rails together carry the weight and turn the masses: V²/R of each, to what Newton leaves."""
    row, forces = steady.table(), np.zeros(3)
    coordinates, _ = steady.state()
    for axle in range(2):
        place = track.place_of(*coordinates[axle, :2], steady.place)
        forces += track.axes(place)[1] @ steady.forces[axle].sum(axis=0)[:3]
    forward = np.array([cos(steady.heading), sin(steady.heading), 0.0])
    accelerations = np.cross(steady.turning, steady.velocity(coordinates[:, :3]))
    needed = MASS @ accelerations + np.array([0.0, 0.0, GRAVITY * MASS.sum()]) - row["pull"] * forward
    assert forces == pytest.approx(needed, abs=0.1)
    # Newton's method converges as it should: the last iterations square what is left.
    assert steady.history[-1] < 1e-3


def test_friction_takes_what_the_pull_gives(steady, track):
    """What the pull and the other bogie's moment do in a second is what all contacts dissipate, to 0.5 %.

    The component's friction is |traction times slip| over the cells: on those that it has by default, as the power is a
    small part of what each wheel's force and torque do.
    """
    cells = {"patch_nodes": 34, "patch_strips": 21}
    fine = curve_equilibrium.Equilibrium(track, IN_CURVE, **cells).start_from(steady).solve()
    row = fine.table()
    coordinates, _ = fine.state()
    fine.close()
    friction = sum(row[f"friction_power_{axle}_{side}"] for axle, side in WHEELS)
    turned = curve_vehicle.turn(coordinates[curve_vehicle.BODY, 3:])
    moment = curve_vehicle.guidance(track, turned, fine.turning, SPEED, fine.place)
    assert row["pull"] * SPEED + moment @ fine.turning == pytest.approx(friction, rel=5e-3)


def test_curving_is_as_railways_know_it(steady):
    """A bogie with stiff axles in a tight curve: the leading one runs outwards at an angle, its flange steers it."""
    row = steady.table()
    assert 6e-3 < row["y_leading"] < 8e-3
    assert row["yaw_leading"] > 5e-3
    assert abs(row["y_trailing"]) < 3e-3
    # The outer wheel is pushed by its flange, and the inner one outwards by its creep.
    assert row["Y_leading_left"] > 20e3 and row["Y_leading_right"] > 10e3
    assert np.degrees(row["contact.inclination[1]_leading_left"]) > 40.0
    assert 0.3 < row["Y_leading_left"] / row["Q_leading_left"] < 0.8
    assert row["wear_number_leading_left"] > 3.0 * row["wear_number_trailing_left"]
    assert row["Q_leading_left"] > row["Q_leading_right"]


def test_slopes_of_a_point_of_contact(steady):
    """Half of the derivatives, the others by a point's kinematics, are as all of them: on the tread to 5 %.

    A point half a tape's width from the middle and a radius below it is off the contact by some millimetres, and a yaw
    angle moves the contact as well.
    """
    wheel = steady.wheels[1][1]
    all_slopes, by_point = wheel.slopes(), wheel.main_slopes()
    for columns in ([0, 1, 2, 3], [4, 5, 6, 7, 8, 9]):
        largest = np.abs(all_slopes[:, columns]).max(axis=0)
        assert (np.abs(all_slopes - by_point)[:3, columns] / largest).max() < 0.05


def test_exudyn_stays_in_equilibrium(steady):
    """Bodies that start as Newton's method has them go on so: forces to 30 N, 0.05 % of the load.

    From 2 m on: Exudyn's first accelerations know the contact's linear law at the end of a step only, 2 µm further on
    the curve than the start, and that has to ring out. The train's pull needs 0.8 mm/s less of speed.
    """
    row = steady.table()
    bogie = curve_bogie.Bogie(steady, step=2e-3)
    result = bogie.run(5.0)
    bogie.close()
    result = result[result["place"] > IN_CURVE + 2.0]
    for axle in AXLES:
        assert result[f"y_{axle}"] == pytest.approx(row[f"y_{axle}"], abs=2e-6)
        assert result[f"yaw_{axle}"] == pytest.approx(row[f"yaw_{axle}"], abs=5e-6)
    for name in (f"{force}_{axle}_{side}" for force in ("Y", "Q") for axle, side in WHEELS):
        assert result[name] == pytest.approx(row[name], abs=30.0), name


def test_a_curve_to_the_left_is_the_mirror(steady):
    """Left and right change places: the equilibrium of the other curve has the same forces on the other wheels."""
    other = Track(Layout(radius=-steady.track.layout.radius))
    mirrored = curve_equilibrium.Equilibrium(other, IN_CURVE)
    # Its own unknowns: what lies sideways changes its sign, and so do roll and yaw.
    coordinates, _ = steady.state()
    base = coordinates - steady.base
    sign = np.array([1.0, -1.0, 1.0, -1.0, 1.0, -1.0])
    moved = base * sign
    # A wheelset's β is its yaw.
    moved[:2, 4] = -base[:2, 4]
    moved[:2, 5] = steady.unknown[[5, 11]]
    mirrored.unknown[:24] = moved.ravel()
    mirrored.unknown[curve_equilibrium.PULL] = steady.unknown[curve_equilibrium.PULL]
    rails = steady.unknown[24:].reshape(2, 2, 2)[:, ::-1] * [-1.0, 1.0]
    mirrored.unknown[24:] = rails.ravel()
    mirrored.solve(most=5)
    left, right = steady.table(), mirrored.table()
    mirrored.close()
    for axle in AXLES:
        assert right[f"y_{axle}"] == pytest.approx(-left[f"y_{axle}"], abs=1e-7)
        for force in ("Y", "Q", "force_x"):
            for side, opposite in (("left", "right"), ("right", "left")):
                # What Newton's method leaves, 1 mN, and the history of windows.
                assert right[f"{force}_{axle}_{side}"] == pytest.approx(left[f"{force}_{axle}_{opposite}"], abs=5.0)


def test_unevenness_begins_ahead_of_the_start():
    """At the start the rails are even, so that the bogie stands in equilibrium; the same seed gives the same rails."""
    rough = Track(rough=1.0)
    for side in SIDES.values():
        assert rough.uneven(side, PLACE + curve_vehicle.HALF_WHEELBASE) == (0.0, 0.0)
        assert hypot(*rough.uneven(side, IN_CURVE)) > 1e-4
        assert rough.uneven(side, IN_CURVE) == Track(rough=1.0).uneven(side, IN_CURVE)
