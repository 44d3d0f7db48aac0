"""A line of braking trains over one spot of the rail: what is drawn for each, and what each of its wheels wears off.

A train has eight wheels on this rail (two coaches). Each brakes by its share of the weight. Where the rail gives that
much, the wheel creeps as little as that takes; where it does not, the wheel slides, and a slide protection holds a
creepage. maintenance.py runs many lines of them on workers.
"""

from functools import cache
from itertools import accumulate

import numpy as np
from dask_runs import local_file
from helpers import WHEEL_RADIUS, reused
from scipy.special import ndtr

TRAINS = 1000
WHEELS = 8
GRAVITY = 9.81  # m/s2
AMBIENT = 283.15  # K
# Distances from axle to axle [m], as in train.py: two coaches with bogies.
GAPS = (2.5, 16.5, 2.5, 4.9, 2.5, 16.5, 2.5)
AXLES = np.concatenate([[0.0], np.cumsum(GAPS)])

# ---- what is drawn: assumptions of the example, with what they lean on, in docs/couplings/maintenance.md ------------

# The friction coefficient is this function of the share of trains that find a lower one: contaminated, wet, dry.
SHARES, FRICTIONS = (0.0, 0.04, 0.30, 1.0), (0.03, 0.10, 0.30, 0.60)
WEATHER = 20.0  # trains in which the correlation of the weather falls by e: half a day at two trains an hour
COACH_LOAD = (50e3, 75e3)  # N, of a wheel at rest, empty and full: anything between is as likely
UNEVENNESS, LARGEST_UNEVENNESS = 0.10, 0.30  # standard deviation and bound of the wheel's dynamic load over the static
DECELERATION, DECELERATION_SPREAD, DECELERATIONS = 0.70, 0.12, (0.3, 1.1)  # m/s2: mean, deviation, bounds
SPEED, SPEED_SPREAD, SPEEDS = 15.0, 2.5, (8.0, 22.0)  # m/s, rounded to 1 m/s: mean, deviation, bounds
HELD = (0.05, 0.20)  # creepage of a wheel in slide protection: its cycle is anywhere in this range
FACTORS = ("friction", "load", "braking", "speed", "creepage held")
SEED = 15

# What a scenario changes.
AS_IT_IS = {"contaminated": 1.0, "load": 1.0, "braking": 1.0, "held": HELD, "weather": WEATHER}
SCENARIOS = {
    "as it is": AS_IT_IS,
    "rail head cleaned": AS_IT_IS | {"contaminated": 2.0},
    "brake 20 % softer": AS_IT_IS | {"braking": 0.8},
    "slide protection 5–10 %": AS_IT_IS | {"held": (0.05, 0.10)},
    "vehicles 20 % heavier": AS_IT_IS | {"load": 1.2},
    "weather anew for each train": AS_IT_IS | {"weather": 0.0},
}

# ---- the component --------------------------------------------------------------------------------------------------

FRICTION_COLD = 0.45  # the default: friction_scale refers to it
WEAR_COEFFICIENT = 5e-13  # 1/Pa, the default
CONTACT_WIDTH, DENSITY, HEAT_CAPACITY, DIFFUSIVITY = 0.01, 7800.0, 7800.0 * 460.0, 1.44e-5
# Half a gap at most; friction falls with slip as in Polach's sets, see `friction_decay`.
CONTACT = {
    "slip_source": 2,
    "contact_nodes": 31,
    "depth_nodes": 31,
    "strip_half_length": 0.5,
    "largest_load": 130e3,
    "ambient_temperature": AMBIENT,
    "incoming_temperature": AMBIENT,
    "friction_slip_share": 0.4,
    # Of the heat of the wheel in front, 2.5 m before, at the mean speed.
    "skin_depth": float(np.sqrt(np.pi * DIFFUSIVITY * 2.5 / SPEED)),
}
# Rise of each axle for a heat of each axle before it, at 1 m/s.
RISES = [
    [1.0 / (HEAT_CAPACITY * np.sqrt(np.pi * DIFFUSIVITY * (axle - before))) for before in AXLES[:number]]
    for number, axle in enumerate(AXLES)
]
INPUTS = ("wheel_speed", "normal_load", "incoming_temperature")
OUTPUTS = ("traction_coefficient", "leaving_wear_depth", "friction_power", "contact_length", "rail_heat_flow")
OUTPUTS += ("peak_temperature",)
STEP = 5.0  # s: the rail passes through the model in a fraction of it, so that one step is the steady state
# Largest deviation of the traction from what the brake asks for, in its share: a thousandth of a depth, or two.
TRACTION_TOLERANCE = 1e-3
MOST_SOLVES = 12
COLUMNS = {
    "friction": "1",
    "speed": "m/s",
    "wear_depth": "m",
    "wear_depth_sliding": "m",
    "wear_depth_energy": "m",
    "wear_depth_energy_sliding": "m",
    "sliding_wheels": "1",
    "peak_temperature": "K",
    "incoming_rise": "K",
    "solves": "1",
}


def friction_decay(friction):
    """Decay of friction with slip velocity [s/m]: Polach's recommended sets, dry and wet, by the coefficient."""
    return 0.6 if friction > 0.35 else 0.2


def generator(line, factor, again):
    """Random numbers of one factor in one line: the same whatever else is drawn, wherever and in whatever order."""
    return np.random.default_rng(np.random.SeedSequence(SEED, spawn_key=(line, FACTORS.index(factor), again)))


def weather(rng, trains, memory):
    """Share of trains with lower friction, uniform, from train to train correlated by exp(-1/memory)."""
    keep = np.exp(-1.0 / memory) if memory > 0.0 else 0.0
    fresh = rng.standard_normal(trains)
    # The first is as good as any: its variance is 1 as well.
    fresh[1:] *= np.sqrt(1.0 - keep**2)
    return ndtr(list(accumulate(fresh.tolist(), lambda before, new: keep * before + new)))


def drawn(settings, line, trains=TRAINS, again=None):
    """What is drawn for a line; one factor may be drawn again, with the others as they were."""
    rng = {factor: generator(line, factor, int(factor == again)) for factor in FACTORS}
    share = weather(rng["friction"], trains, settings["weather"])
    clean = np.array(FRICTIONS)
    clean[:2] *= settings["contaminated"]
    # Cleaning lifts what is contaminated, and nothing beyond the wet rail.
    knots = np.minimum(clean, FRICTIONS[2])
    knots[3] = FRICTIONS[3]
    coaches = rng["load"].uniform(*COACH_LOAD, (trains, 2)) * settings["load"]
    still = np.repeat(coaches, WHEELS // 2, axis=1)
    uneven = np.clip(
        UNEVENNESS * rng["load"].standard_normal((trains, WHEELS)), -LARGEST_UNEVENNESS, LARGEST_UNEVENNESS
    )
    braking = DECELERATION + DECELERATION_SPREAD * rng["braking"].standard_normal(trains)
    speed = SPEED + SPEED_SPREAD * rng["speed"].standard_normal(trains)
    return {
        "friction": np.interp(share, SHARES, knots),
        "share": share,
        "load": still * (1.0 + uneven),
        # Brakes weigh the coach: force over the load at rest.
        "brake_force": still * settings["braking"] * (np.clip(braking, *DECELERATIONS) / GRAVITY)[:, None],
        "speed": np.clip(np.round(speed), *SPEEDS),
        "held": rng["creepage held"].uniform(*settings["held"], (trains, WHEELS)),
    }


# ---- wheels over the spot -------------------------------------------------------------------------------------------


@cache
def spot(fmu):
    """Return the spot of an FMU: a process has one."""
    return Spot(fmu)


class Spot:
    """The component over a spot of the rail, with a state to start from for each speed."""

    def __init__(self, fmu):
        """Make the component, or take that of this process."""
        self.fmu = fmu
        self.contact = reused(fmu, **CONTACT)
        self.fresh, self.rolling = self.contact.save(), {}
        variables = self.contact.variables
        self.inputs, self.outputs = ([variables[name].valueReference for name in names] for names in (INPUTS, OUTPUTS))

    def begin(self, speed, friction):
        """Go to a train's speed and friction: a speed is costly, as the rail's inertia is another, a state is not."""
        if speed not in self.rolling:
            self.contact.restore(self.fresh)
            self.contact.set(vehicle_speed=speed, wheel_speed=speed / WHEEL_RADIUS)
            self.contact.step(STEP)
            self.rolling[speed] = self.contact.save()
        self.contact.restore(self.rolling[speed])
        self.contact.set(friction_scale=friction / FRICTION_COLD, friction_slip_decay=friction_decay(friction))
        self.speed, self.friction = speed, friction
        # Slope of the creep curve over Carter's, found by the wheel before.
        self.slope, self.solves = 1.0, 0

    def roll(self, creepage, load, temperature):
        """Outputs of a wheel that brakes with a creepage, counted positive."""
        slave = self.contact.slave
        slave.setReal(self.inputs, [self.speed * (1.0 - creepage) / WHEEL_RADIUS, load, temperature])
        self.contact.step(STEP)
        self.solves += 1
        return dict(zip(OUTPUTS, slave.getReal(self.outputs), strict=True))

    def brake(self, force, load, temperature, held):
        """Outputs of a wheel that is to brake with a force, and whether it slides instead.

        Carter: T = mu N (1 - (1 - xi/xi_s)^2), and at xi_s the whole contact slides. The root beside it is nearly
        straight over the creepage, so that a line through the origin finds the creepage in one or two goes.
        """
        wanted, limit = force / load, self.friction
        saturation = limit * half_length(load) / WHEEL_RADIUS
        if wanted > 0.9 * limit:
            # Close to the limit: what the rail gives where it begins to slide as a whole is what there is.
            given = -self.roll(1.05 * saturation, load, temperature)["traction_coefficient"] if wanted < limit else 0.0
            if given <= wanted:
                return self.roll(held, load, temperature), True
            limit = max(limit, given)
        root = 1.0 - np.sqrt(1.0 - wanted / limit)
        low, high = 0.0, 1.05 * saturation
        creepage = min(saturation * root / self.slope, high)
        for _ in range(MOST_SOLVES):
            found = self.roll(creepage, load, temperature)
            given = -found["traction_coefficient"]
            if abs(given - wanted) <= TRACTION_TOLERANCE * wanted:
                return found, False
            low, high = (creepage, high) if given < wanted else (low, creepage)
            self.slope = (1.0 - np.sqrt(max(0.0, 1.0 - given / limit))) * saturation / creepage
            creepage = saturation * root / self.slope
            if not low < creepage < high:
                creepage = 0.5 * (low + high)
        raise RuntimeError(f"no creepage gives {wanted:g} of the load at friction {self.friction:g}")


def half_length(load):
    """Half the length of the contact by Hertz [m], for the default materials of wheel and rail."""
    shear, lame = 8.2e10, 1.166e11
    poisson = lame / (2.0 * (lame + shear))
    modulus = shear / (1.0 - poisson)  # of the contact: wheel and rail alike
    return np.sqrt(4.0 * load / CONTACT_WIDTH * WHEEL_RADIUS / (np.pi * modulus))


def by_energy(power, length, speed):
    """Depth of wear by friction energy [m], from what a rolled metre takes off a contact's area [ug/(m mm2)].

    With x = T gamma/A in N/mm2: 5.3 x up to 10.4, 55 up to 77.2, then 61.9 for each one more. R8T wheel on UIC 900A
    rail in a twin disc, dry (Braghin et al., Wear 261 (2006) 1253).
    """
    x = power / (speed * CONTACT_WIDTH * length) * 1e-6
    rate = 5.3 * x if x <= 10.4 else 55.0 + 61.9 * max(0.0, x - 77.2)
    return rate * 1e-3 * length / DENSITY


def warmed(heat, speed):
    """Temperature rise of the rail's surface where the next wheel finds it: heat [J/m2] of each wheel before.

    q/(rho c sqrt(pi kappa t)), t the time since that wheel.
    """
    return np.sqrt(speed) * sum(q * share for q, share in zip(heat, RISES[len(heat)], strict=True))


def passage(place, speed, friction, loads, forces, helds):
    """What one train does: its row of COLUMNS. Each wheel finds the rail as warm as those before it left it."""
    place.begin(speed, friction)
    row = dict.fromkeys(COLUMNS, 0.0) | {"friction": friction, "speed": speed}
    heat = []
    for load, force, held in zip(loads, forces, helds, strict=True):
        rise = warmed(heat, speed)
        found, slides = place.brake(force, load, AMBIENT + rise, held)
        heat.append(found["rail_heat_flow"] / (speed * CONTACT_WIDTH))
        worn = found["leaving_wear_depth"], by_energy(found["friction_power"], found["contact_length"], speed)
        for name, depth in zip(("wear_depth", "wear_depth_energy"), worn, strict=True):
            row[name] += depth
            row[f"{name}_sliding"] += slides * depth
        row["sliding_wheels"] += slides
        row["peak_temperature"] = max(row["peak_temperature"], found["peak_temperature"])
        row["incoming_rise"] = max(row["incoming_rise"], rise)
    return row | {"solves": place.solves}


def line(component, digest, settings, number, trains=TRAINS, again=None):
    """Run a line of trains on a worker: a list for each of COLUMNS, and what the weather was."""
    place = spot(local_file(component, digest))
    draws = drawn(settings, number, trains, again)
    names = ("speed", "friction", "load", "brake_force", "held")
    rows = [
        passage(place, float(speed), float(friction), loads.tolist(), forces.tolist(), helds.tolist())
        for speed, friction, loads, forces, helds in zip(*(draws[name] for name in names), strict=True)
    ]
    return {name: [float(row[name]) for row in rows] for name in COLUMNS} | {"share": draws["share"].tolist()}
