"""studies/train: eight units chained by the rail. Heat and wear add up from wheel to wheel, and the rail cools."""

import numpy as np
import pytest
import train

STEP = 5e-3  # s


@pytest.fixture(scope="module")
def result():
    """Return the whole manoeuvre, at a step twice that of the example."""
    return train.Train().run(step=STEP)


@pytest.fixture(scope="module")
def table(result):
    """Return what each wheel finds and leaves at a place that all pass while braking."""
    return train.summary(result)


def test_units_fit_between_the_axles():
    """Two coaches, eight axles, and each unit's strip is at most as long as the distance to the next."""
    assert len(train.AXLES) == 8
    assert min(train.GAPS) >= 2.0 * train.HALF_LENGTH
    # What enters in a step has left before it: all units can step at the same time.
    assert min(train.GAPS) - 2.0 * train.HALF_LENGTH > train.SPEED * STEP


def test_delay_is_a_distance(result):
    """What enters a unit is what left the one in front at the same place of the track, while the speed changes.

    To 2 % of the largest wear: what enters in a step is a mean over its length. Constant delays, (D - 2 L)/V at the
    speed of the start, are wrong by more than a half where the brakes let go.
    """
    assert result["speed"].min() < 0.75 * train.SPEED
    largest = 0.0
    for wheel, gap in enumerate(train.GAPS):
        left = result["distance"] + train.AXLES[wheel] - train.HALF_LENGTH
        entered = result["distance"] + train.AXLES[wheel + 1] + train.HALF_LENGTH
        there = entered > left[0]
        sent = np.interp(entered[there], left, result["leaving_wear_depth"][:, wheel])
        arrived = result["incoming_wear_depth"][there, wheel + 1]
        scale = result["leaving_wear_depth"][:, wheel].max()
        # The mean over a step lags by half its length.
        assert np.abs(arrived - sent).max() < 0.02 * scale
        delay = (gap - 2.0 * train.HALF_LENGTH) / train.SPEED
        late = np.interp(result["time"] - delay, result["time"], result["leaving_wear_depth"][:, wheel])
        largest = max(largest, np.abs(late[there] - arrived).max() / scale)
    assert largest > 0.5


def test_wear_adds_up(result, table):
    """Each wheel finds what those before it wore off, and behind the last one lies the wear of all."""
    own = table["own_wear"]
    assert np.all(own > 2e-7)
    before = np.concatenate([[0.0], np.cumsum(own)])
    assert table["wear_before"] == pytest.approx(before[:-1], rel=1e-3)
    last = train.passage(result, ahead=-train.HALF_LENGTH)[-1]
    left = np.interp(last, result["time"], result["leaving_wear_depth"][:, -1])
    assert left == pytest.approx(before[-1], rel=1e-3)
    books = train.books(result)
    assert books["worn off the rail behind the last"] == pytest.approx(books["worn by the wheels"], rel=1e-4)


def test_heat_adds_up(result, table):
    """The same for the heat, whatever the skin depths: nothing is lost between units."""
    own = table["own_heat"]
    before = np.concatenate([[0.0], np.cumsum(own)])
    assert np.all(own > 30e3)
    assert table["heat_before"] == pytest.approx(before[:-1], rel=1e-3, abs=1.0)
    books = train.books(result)
    assert books["heat in the rail behind the last"] == pytest.approx(books["heat into the rail"], rel=1e-4)


def test_rail_warms_from_wheel_to_wheel(table):
    """The heat grows at each wheel, and the second wheel of each bogie finds warmer rail than that of the bogie before.

    Between two wheels the rail cools: it is colder ahead of a wheel than it was behind the one in front. So much over a
    long distance that the first wheel of a bogie may find colder rail than the wheel in front of it did.
    """
    ahead, behind = table["rail_ahead"], table["rail_behind"]
    assert ahead[0] == pytest.approx(train.AMBIENT, abs=1e-9)
    assert np.all(np.diff(table["heat_before"]) > 30e3)
    assert np.all(np.diff(ahead[1::2]) > 0.1)
    assert np.all(ahead[1::2] > ahead[0::2] + 3.0)
    assert np.all(ahead[1:] < behind[:-1] - 50.0)
    assert np.all(ahead[1:] > train.AMBIENT + 3.0)


def test_rail_is_as_warm_as_by_hand(table):
    """Ahead of each wheel, the sum of Q / (rho c sqrt(pi kappa t)) over the wheels before, within 7 %.

    Both the temperature that enters, given skin depths that are those of the ages at one typical speed, and the rail's
    surface ahead of the contact, after the march through coarse columns.
    """
    for name in ("incoming", "rail_ahead"):
        value = table["incoming_temperature" if name == "incoming" else name][1:] - train.AMBIENT
        by_hand = table[f"{name}_by_hand"][1:] - train.AMBIENT
        assert value == pytest.approx(by_hand, rel=0.07)


def test_hot_rail_holds_less(result):
    """At one time, and so at one speed, the hotter the rail that a wheel finds, the less the friction."""
    index = np.searchsorted(result["time"], train.passage(result)[-1])
    order = np.argsort(result[train.AHEAD][index])
    assert np.all(np.diff(result["friction_coefficient"][index][order]) < 0.0)


def test_rail_at_rest_is_ambient(result):
    """Before it brakes, and where the train has passed after it has braked, nothing is on the rail."""
    early = result["time"] < train.BRAKE_START
    assert result["incoming_temperature"][early] == pytest.approx(train.AMBIENT, abs=1e-3)
    assert result["incoming_temperature"][-1] == pytest.approx(train.AMBIENT, abs=0.2)


def test_momentum(result):
    """The impulse of the traction forces of both rails is the train's change of momentum."""
    impulse = 2.0 * STEP * result["traction_force"].sum()
    assert train.MASS * (result["speed"][-1] - train.SPEED) == pytest.approx(impulse, rel=1e-9)


def test_threads_give_the_same_bits(result):
    """Eight threads, for the first 1.2 s: all values of all units, and their trails."""
    threaded = train.Train().run(1.2, STEP, threads=8)
    steps = len(threaded["time"])
    assert np.abs(threaded["traction_force"][-1]).min() > 5e3
    for name in ("speed", *train.INPUTS, *train.OUTPUTS):
        assert np.array_equal(threaded[name], result[name][:steps]), name
    for mine, its in zip(threaded["trail"], result["trail"], strict=True):
        assert np.array_equal(mine, its[:, : steps + 1])


def test_a_unit_that_is_too_long_is_refused():
    """Where the next unit's strip overlaps with that in front, there is no delay."""
    with pytest.raises(ValueError, match="longer than the distance"):
        train.Trail(0.0).until(0.1)
