"""Eight wheels of a braking train, an instance of the component each, chained by the rail that passes under them.

    .venv/bin/python studies train              (after `make couplings-set-up`; or `make coupling-train`)

Two coaches with two bogies each, here their eight wheels on one rail. What leaves a unit lies on the track until the
next one gets there: a trail stores heat and wear against the position on the track, not against time, so that the delay
(D - 2 L) / V is right while the train brakes. As it is longer than a step, all units step at the same time: in threads,
if wanted, with the same bits. docs/couplings/train.md.
"""

import argparse
import os
import time
from concurrent.futures import ThreadPoolExecutor

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, FMU, GREEN, ORANGE, RED, WHEEL_RADIUS, Instance, save, show, write_csv
from matplotlib.patches import Circle
from rail_trail import Trail, skin_depths

GRAVITY = 9.81
AMBIENT = 283.15  # K
SPEED = 25.0  # m/s at the start
TYPICAL_SPEED = 21.0  # m/s, while the rail passes hot from wheel to wheel: for the skin depths
LOAD = 60e3  # N, of a wheel
STEP = 2.5e-3  # s
STOP = 8.0  # s
# Distances from axle to axle: two coaches, bogies with a wheelbase of 2.5 m, 19 m apart, coaches of 26.4 m.
GAPS = (2.5, 16.5, 2.5, 4.9, 2.5, 16.5, 2.5)  # m
HALF_LENGTH = 0.5  # m, of the piece of rail of a unit: at most half the smallest distance
AXLES = -np.concatenate([[0.0], np.cumsum(GAPS)])  # m, places of the axles at the start; the first is the front one
MASS = len(AXLES) * 2 * LOAD / GRAVITY  # kg: both rails carry it
# The brakes slide the wheels, a slide protection holds them at this creepage, on sanded wet rail; then they let go.
CREEPAGE, SANDED = -0.10, 0.5
BRAKE_START, BRAKE_RAMP, BRAKE_END = 0.3, 0.3, 4.0  # s
# The rail of the defaults, for the temperature by hand.
DIFFUSIVITY, HEAT_CAPACITY, CONTACT_WIDTH = 1.44e-5, 7800.0 * 460.0, 0.01  # m2/s, J/(m3.K), m
CONTACT = {
    "slip_source": 2,
    "wheel": 2,
    "wheel_heating": 2,
    "strip_half_length": HALF_LENGTH,
    # Absolute: both are to be set, and the rail enters at the ambient.
    "ambient_temperature": AMBIENT,
    "incoming_temperature": AMBIENT,
    "normal_load": LOAD,
    "friction_scale": SANDED,
    "vehicle_speed": SPEED,
    "wheel_speed": SPEED / WHEEL_RADIUS,
}
INPUTS = ("wheel_speed", "vehicle_speed", "incoming_temperature", "incoming_wear_depth")
# Rail surface 4 cm ahead of the axle, about, where the contact window begins, and behind it, where it ends.
BEHIND, AHEAD = "profile.temperature[1]", "profile.temperature[61]"
OUTPUTS = ("leaving_temperature", "leaving_wear_depth", "traction_force", "rail_heat_flow", "friction_coefficient")
OUTPUTS += ("peak_temperature", "wear_rate", "worn_volume", "wheel_temperature", AHEAD, BEHIND)
PLACE = 22.0  # m: a point of the rail that all wheels pass while they brake


def creepage(now):
    """Creepage that the slide protection holds: none, then the brake's, then none again."""
    return CREEPAGE * np.interp(
        now, [BRAKE_START, BRAKE_START + BRAKE_RAMP, BRAKE_END, BRAKE_END + BRAKE_RAMP], [0.0, 1.0, 1.0, 0.0]
    )


class Wheel:
    """A unit: an instance of the component, and the trail that it leaves."""

    def __init__(self, number, skin_depth, **start_values):
        """Instantiate and initialise."""
        self.contact = Instance(FMU, f"wheel {number + 1}", skin_depth=skin_depth, **CONTACT | start_values).start()
        variables = self.contact.variables
        self.inputs, self.outputs = ([variables[name].valueReference for name in names] for names in (INPUTS, OUTPUTS))
        self.skin_depth = skin_depth
        self.entered = (0.0, 0.0)
        self.trail = Trail(AXLES[number] - HALF_LENGTH)

    def step(self, step, values):
        """Set, step and get: this runs in a thread. The component computes without Python's lock (ctypes lets go)."""
        self.contact.slave.setReal(self.inputs, values)
        self.contact.step(step)
        return self.contact.slave.getReal(self.outputs)


class Threads(ThreadPoolExecutor):
    """Threads that know how many they are."""

    def __init__(self, size):
        """Start them."""
        super().__init__(size)
        self.size = size


class Train:
    """Wheels one behind the other on one rail, and the train above them as a mass."""

    def __init__(self, depths=None, **start_values):
        """Make the units, the front one first, with the given skin depths [m]."""
        if depths is None:
            depths = skin_depths(AXLES, HALF_LENGTH, TYPICAL_SPEED, DIFFUSIVITY)
        self.wheels = [Wheel(number, float(depth), **start_values) for number, depth in enumerate(depths)]
        self.speed, self.time, self.distance = SPEED, 0.0, 0.0

    def arrives(self, number, distance):
        """Incoming temperature and wear depth: the mean of the trail in front over what a unit comes to in a step.

        Heat stays the same from one skin depth to another: the trail holds the product of temperature rise and depth.
        """
        if number == 0:
            return AMBIENT, 0.0
        wheel = self.wheels[number]
        heat, wear = self.wheels[number - 1].trail.until(AXLES[number] + HALF_LENGTH + self.distance + distance)
        entered, wheel.entered = wheel.entered, (heat, wear)
        return AMBIENT + (heat - entered[0]) / (distance * wheel.skin_depth), (wear - entered[1]) / distance

    def advance(self, step, pool=None):
        """One step of all: what enters is known, as the next wheel is further behind than it comes in a step."""
        distance = self.speed * step
        wheel_speed = self.speed * (1.0 + creepage(self.time)) / WHEEL_RADIUS
        values = [[wheel_speed, self.speed, *self.arrives(number, distance)] for number in range(len(self.wheels))]
        outputs = [None] * len(self.wheels)

        def steps(share):
            for number in share:
                outputs[number] = self.wheels[number].step(step, values[number])

        # Each thread takes its share of the wheels.
        everybody = range(len(self.wheels))
        if pool is None:
            steps(everybody)
        else:
            list(pool.map(steps, (everybody[first :: pool.size] for first in range(pool.size))))
        for wheel, (temperature, wear, *_) in zip(self.wheels, outputs, strict=True):
            wheel.trail.leave(distance, (temperature - AMBIENT) * wheel.skin_depth, wear)
        row = [[*own, *result] for own, result in zip(values, outputs, strict=True)]
        self.time += step
        self.distance += distance
        # Both rails.
        self.speed += step * 2.0 * sum(result[OUTPUTS.index("traction_force")] for result in outputs) / MASS
        return row

    def run(self, stop=STOP, step=STEP, threads=1, title=None):
        """Run and free: time, distance and speed at the end of each step, and of each wheel inputs and outputs."""
        pool = Threads(threads) if threads > 1 else None
        steps = round(stop / step)
        times, rows = [], []
        for number in range(1, steps + 1):
            rows.append(self.advance(step, pool))
            times.append((self.time, self.distance, self.speed))
            if title and number % 100 == 0:
                show(number / steps, title)
        if pool:
            pool.shutdown()
        for wheel in self.wheels:
            wheel.contact.close()
        values = np.array(rows)
        result = {name: values[:, :, column] for column, name in enumerate((*INPUTS, *OUTPUTS))}
        result |= dict(zip(("time", "distance", "speed"), np.array(times).T, strict=True))
        result["trail"] = [
            np.array([wheel.trail.position, wheel.trail.heat, wheel.trail.wear]) for wheel in self.wheels
        ]
        result["skin_depth"] = np.array([wheel.skin_depth for wheel in self.wheels])
        return result


# ---- what happens to the rail ---------------------------------------------------------------------------------------


def passage(result, place=PLACE, ahead=0.0):
    """Time at which each axle, or what is so far ahead of it, passes a place on the track: a row for each place."""
    return np.interp(np.subtract.outer(place, AXLES) - ahead, result["distance"], result["time"])


def at_passage(result, name, times):
    """Value of each wheel at its own time."""
    values = [np.interp(times[..., wheel], result["time"], result[name][:, wheel]) for wheel in range(len(AXLES))]
    return np.stack(values, axis=-1)


def laid(result, name, times):
    """What each wheel lays on the rail per area: heat [J/m2] of rail_heat_flow, wear [m] of wear_rate."""
    return at_passage(result, name, times) / (at_passage(result, "vehicle_speed", times) * CONTACT_WIDTH)


def superposed(result, now, place=PLACE):
    """Temperature rise of the rail's surface by hand: the sum of Q / (rho c sqrt(pi kappa t)) over those before."""
    times = passage(result, place)
    age = np.expand_dims(now, -1) - times
    before = age > 1e-9
    spread = np.sqrt(np.pi * DIFFUSIVITY * np.where(before, age, 1.0))
    return np.sum(before * laid(result, "rail_heat_flow", times) / (HEAT_CAPACITY * spread), axis=-1)


def summary(result, place=PLACE):
    """Return a table of what each wheel finds and leaves at a place, in the order of the wheels."""
    times, enters = passage(result, place), passage(result, place, HALF_LENGTH)
    return {
        "wheel": np.arange(1, len(times) + 1),
        "time": times,
        "speed": np.interp(times, result["time"], result["vehicle_speed"][:, 0]),
        "incoming_temperature": at_passage(result, "incoming_temperature", enters),
        "incoming_by_hand": AMBIENT + superposed(result, enters, place),
        "rail_ahead": at_passage(result, AHEAD, times),
        "rail_ahead_by_hand": AMBIENT + superposed(result, times, place),
        "peak_temperature": at_passage(result, "peak_temperature", times),
        "rail_behind": at_passage(result, BEHIND, times),
        "friction_coefficient": at_passage(result, "friction_coefficient", times),
        "heat_before": HEAT_CAPACITY
        * result["skin_depth"]
        * (at_passage(result, "incoming_temperature", enters) - AMBIENT),
        "own_heat": laid(result, "rail_heat_flow", times),
        "wear_before": at_passage(result, "incoming_wear_depth", enters),
        "own_wear": laid(result, "wear_rate", times),
    }


def books(result):
    """Return volume [m3] and heat [J] that all wheels together laid on the rail, and those in the trail of the last.

    Only where the last unit has already been.
    """
    step = np.diff(result["time"], prepend=0.0)[:, None]
    place, heat, wear = result["trail"][-1]
    there = np.add.outer(result["distance"], AXLES) < place[-1]
    return {
        "worn by the wheels": float(np.sum(step * there * result["wear_rate"])),
        "worn off the rail behind the last": CONTACT_WIDTH * wear[-1],
        "heat into the rail": float(np.sum(step * there * result["rail_heat_flow"])),
        "heat in the rail behind the last": CONTACT_WIDTH * HEAT_CAPACITY * heat[-1],
    }


def same(one, other):
    """Whether two results have the same bits."""
    return all(np.array_equal(one[name], other[name]) for name in one if name != "trail") and all(
        np.array_equal(mine, its) for mine, its in zip(one["trail"], other["trail"], strict=True)
    )


# ---- the picture ----------------------------------------------------------------------------------------------------


def between(result, now, column):
    """Places on the track and what lies there between and behind the wheels now: 1 heat (over rho c), 2 wear."""
    distance = np.interp(now, result["time"], result["distance"])
    places, values = [], []
    for wheel, trail in enumerate(result["trail"]):
        last = wheel + 1 == len(AXLES)
        end = distance - HALF_LENGTH + AXLES[wheel]
        begin = end - 12.0 if last else distance + HALF_LENGTH + AXLES[wheel + 1]
        inside = (trail[0, 1:] <= end) & (trail[0, :-1] >= begin)
        places.append(trail[0, 1:][inside])
        values.append((np.diff(trail[column]) / np.diff(trail[0]))[inside])
    return distance, places, values


def draw_coaches(axes):
    """Two coaches over the axles."""
    axes.set(ylim=(-0.25, 5.3), aspect="equal")
    axes.axis("off")
    axes.plot([-62.0, 4.0], [0.0, 0.0], color=BLACK, linewidth=1.0)
    for coach in range(2):
        own = AXLES[4 * coach : 4 * coach + 4]
        middle = own.mean()
        axes.add_patch(plt.Rectangle((middle - 13.0, 1.1), 26.0, 2.6, facecolor="#e8ecef", edgecolor="#6b7680"))
        for window in np.linspace(middle - 11.0, middle + 8.6, 9):
            axes.add_patch(plt.Rectangle((window, 2.3), 2.0, 0.8, facecolor="white", edgecolor="none"))
        for bogie in (own[:2], own[2:]):
            axes.plot(bogie, [0.75, 0.75], color="#6b7680", linewidth=2.0)
    for number, axle in enumerate(AXLES):
        axes.add_patch(Circle((axle, WHEEL_RADIUS), WHEEL_RADIUS, facecolor=BLACK))
        axes.text(axle, -0.6, f"{number + 1}", ha="center", va="top", fontsize=8)
    axes.annotate("", (4.0, 4.5), (-3.0, 4.5), arrowprops={"arrowstyle": "->"})


def draw(result):
    """The rail under the train at a moment, and speed, incoming temperature and wheels along the way."""
    figure = plt.figure(figsize=(11.0, 9.0), layout="constrained")
    upper, lower = figure.subfigures(2, 1, height_ratios=[1.75, 1.0])
    coaches, temperature, wear = upper.subplots(3, 1, sharex=True, height_ratios=[0.42, 1.0, 0.85])
    now = passage(result)[-1]
    index = np.searchsorted(result["time"], now)
    now = result["time"][index]
    draw_coaches(coaches)
    coaches.set_title(
        f"The rail under the braking train at {now:.1f} s, at {result['speed'][index]:.1f} m/s to the right"
    )
    distance, places, heats = between(result, now, 1)
    ahead = np.linspace(-61.0, 2.0, 4000)
    rise = superposed(result, np.full(len(ahead), now), distance + ahead)
    shown = np.where(rise < 22.0, rise + AMBIENT - 273.15, np.nan)
    temperature.plot(ahead, shown, color=ORANGE, linewidth=1.0)
    temperature.plot([], [], color=ORANGE, label=r"by hand: $\Sigma\, Q / (\rho c \sqrt{\pi \kappa t})$")
    enters = result["incoming_temperature"][index] - 273.15
    temperature.plot(AXLES + HALF_LENGTH, enters, "o", color=BLUE, markersize=5, label="incoming_temperature")
    skin = result[AHEAD][index] - 273.15
    temperature.plot(
        AXLES, skin, "^", color=BLACK, markersize=5, label="rail surface ahead of the contact, of the unit"
    )
    temperature.set(ylabel="rail surface [°C]", ylim=(8.0, 37.0))
    temperature.legend(loc="upper left", ncols=3, fontsize=8)
    heat_axes = wear.twinx()
    heat_axes.spines["right"].set_visible(True)
    heat_axes.grid(False)
    for place, heat, depth in zip(places, heats, between(result, now, 2)[2], strict=True):
        wear.plot(place - distance, 1e6 * depth, color=GREEN, linewidth=2.2)
        heat_axes.plot(place - distance, 1e-3 * HEAT_CAPACITY * heat, color=RED, linewidth=1.2, linestyle="--")
    wear.set(ylabel="depth of wear [µm]", xlabel="position from the front axle [m]", ylim=(0.0, 2.9), xlim=(-61.5, 4.5))
    wear.yaxis.label.set_color(GREEN)
    heat_axes.set_ylabel("heat in the rail [kJ/m²]", color=RED)
    heat_axes.set_ylim(0.0, 330.0)
    upper.align_ylabels([temperature, wear])

    speed, incoming, wheels = lower.subplots(1, 3)
    speed.plot(result["time"], result["speed"], color=BLACK)
    speed.axvspan(BRAKE_START, BRAKE_END + BRAKE_RAMP, color="#eef2f5", zorder=0)
    speed.text(0.5 * (BRAKE_START + BRAKE_END + BRAKE_RAMP), 17.5, "brakes on", ha="center", color="#6b7680")
    speed.set(xlabel="time [s]", ylabel="speed of the train [m/s]", title="Speed", xlim=(0.0, STOP), ylim=(17.0, 25.5))
    colours = plt.get_cmap("viridis")(np.linspace(0.0, 0.9, len(AXLES)))
    for wheel in range(1, len(AXLES)):
        incoming.plot(
            result["time"],
            result["incoming_temperature"][:, wheel] - 273.15,
            color=colours[wheel],
            label=f"{wheel + 1}",
        )
    incoming.set(xlabel="time [s]", ylabel="incoming_temperature [°C]", title="What arrives at wheels 2 to 8")
    incoming.set(xlim=(0.0, STOP), ylim=(9.0, 26.0))
    incoming.legend(fontsize=8, ncols=2, title="wheel", title_fontsize=8, loc="upper right")
    numbers = np.arange(1, len(AXLES) + 1)
    wheels.plot(numbers, result["friction_coefficient"][index], "o-", color=BLUE, linewidth=1.0)
    wheels.set(xlabel="wheel", ylabel="friction coefficient [1]", title=f"Friction at {now:.1f} s: lower on hot rail")
    wheels.set_xticks(numbers)
    save(figure, "train.png")


# ---- in threads -----------------------------------------------------------------------------------------------------


def share_of_steps(stop, **start_values):
    """Share of the processor time that is spent in fmi2DoStep, which is what threads can do at the same time."""
    train, inside = Train(**start_values), 0.0

    def timed(step):
        def measured(*arguments):
            nonlocal inside
            began = time.thread_time()
            step(*arguments)
            inside += time.thread_time() - began

        return measured

    for wheel in train.wheels:
        wheel.contact.slave.doStep = timed(wheel.contact.slave.doStep)
    began = time.thread_time()
    train.run(stop)
    return inside / (time.thread_time() - began)


def speed_up(stop=1.0, repetitions=5):
    """Time some seconds of the train on one thread and on more, in turns."""
    print(f"  {os.cpu_count()} cores, load average {os.getloadavg()[0]:.1f}")
    for nodes in (61, 121):
        share = share_of_steps(stop, contact_nodes=nodes)
        print(f"  {nodes} nodes: {100.0 * share:.0f} % in fmi2DoStep, so at most", end="")
        print("".join(f" {1.0 / (1.0 - share + share / cores):.2f} times on {cores} cores" for cores in (2, 8)))
        took = {1: [], 2: [], 4: []}
        for _ in range(repetitions):
            for threads, times in took.items():
                train = Train(contact_nodes=nodes)
                began = time.perf_counter()
                train.run(stop, threads=threads)
                times.append(time.perf_counter() - began)
        for threads, times in took.items():
            each = ", ".join(f"{taken:.2f}" for taken in times)
            ratio = min(took[1]) / min(times)
            print(f"  {nodes} nodes, {threads} threads: {each} s; best {ratio:.2f} times as fast as the best of one")
    print(f"  load average {os.getloadavg()[0]:.1f}")


def main():
    """Run on one thread and on two, compare, report, draw, write."""
    results = {}
    for threads in (1, 2):
        train = Train()
        began = time.perf_counter()
        results[threads] = train.run(threads=threads, title=f"{threads} thread(s)")
        print(f"  {STOP:g} s of {len(AXLES)} wheels, {threads} thread(s): {time.perf_counter() - began:.1f} s")
    result = results[1]
    print(f"  the same bits from both: {same(result, results[2])}")
    table = summary(result)
    for name, values in table.items():
        print(f"  {name:21s}", " ".join(f"{value:10.4g}" for value in values))
    for name, value in books(result).items():
        print(f"  {name:34s} {value:.9g}")
    longest, slowest = max(GAPS) - 2.0 * HALF_LENGTH, result["speed"].min()
    print(f"  a constant delay would misplace the rail by up to {longest * (1.0 - slowest / SPEED):.1f} m")
    columns = {name: result[name][::4] for name in ("time", "distance", "speed")}
    for wheel in range(len(AXLES)):
        for name in ("incoming_temperature", "incoming_wear_depth", *OUTPUTS[:9]):
            columns[f"{name}_{wheel + 1}"] = result[name][::4, wheel]
    write_csv("train.csv", columns)
    draw(result)


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--speed-up", action="store_true", help="only time threads against one")
    if parser.parse_args().speed_up:
        speed_up()
    else:
        main()
