"""The scenarios that tools/bits.py records: parameters, and inputs step by step.

Those of the line first; then a row of variants, each for the line and for a patch of few cells: what a contact can be
asked for besides ordinary rolling. The random ones are the same ones each time.
"""

import csv
from collections.abc import Callable, Iterator
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

BRAKING = Path(__file__).resolve().parent.parent / "examples" / "braking.csv"
RANDOM_LINES, RANDOM_LINE_STEPS = 50, 60
RANDOM_PATCHES, RANDOM_PATCH_STEPS = 8, 40


@dataclass(frozen=True)
class Scenario:
    """One run: what is set before it, and before each step; whether its state is restored half-way."""

    name: str
    parameters: dict[str, float]
    steps: list[tuple[dict[str, float], float]]  # inputs, and the step's length in s
    restarted: bool = False


def braking(name: str, parameters: dict, start: float, steps: int, step: float, **constants: float) -> Scenario:
    """A piece of the manoeuvre of examples/braking.csv from `start` s on, in steps of `step` s."""
    with BRAKING.open() as file:
        rows = list(csv.DictReader(line for line in file if not line.startswith("#")))
    table = {name: np.array([float(row[name]) for row in rows]) for name in rows[0]}
    times = table.pop("time")

    def inputs(time):
        return {name: float(np.interp(time, times, values)) for name, values in table.items()} | constants

    return Scenario(name, {"slip_source": 2} | parameters, [(inputs(start + step * k), step) for k in range(steps)])


def paper(name: str, law: int, hot: float) -> Scenario:
    """A case of the paper: a given penetration of 0.1 mm, 10 m/s, creepage 4 %."""
    parameters = {"control": 2, "friction_law": law, "friction_temperature_hot": hot + 273.15}
    parameters["friction_temperature_cold"] = 50 + 273.15
    inputs = {"creepage": 0.04, "wheel_speed": 10.4 / 0.46, "ambient_temperature": 273.15}
    inputs["incoming_temperature"] = 273.15
    return Scenario(f"paper, {name}", parameters, [(inputs, 1e-2)] * 50)


def random_line(number: int, generator: np.random.Generator) -> Scenario:
    """Parameters and a walk of the inputs, with jumps."""
    one_of = generator.choice
    uniform = generator.uniform
    parameters = {
        "slip_source": int(one_of([1, 2])),
        "friction_law": int(one_of([1, 2, 3, 4])),
        "wheel": int(one_of([1, 2])),
        "wheel_heating": int(one_of([1, 2])),
        "normal_solver": int(one_of([1, 1, 1, 2])),
        "mesh": int(one_of([1, 1, 1, 1, 1, 1, 2])),
        "contact_nodes": int(one_of([31, 60, 61, 83])),
        "depth_nodes": int(one_of([21, 41])),
        "slip_regularisation": 10 ** uniform(-4, -2),
        "wear_coefficient": 10 ** uniform(-13, -11),
        "contact_thermal_resistance": 10 ** uniform(1, 4),
        "contact_width": uniform(0.006, 0.02),
        "wheel_wear_coefficient": 1e-13,
        "wheel_radius": uniform(0.3, 0.6),
    }
    radius = parameters["wheel_radius"]
    speed, creepage, load = uniform(-40, 40), uniform(-0.02, 0.02), uniform(20e3, 60e3)
    steps = []
    for moment in range(RANDOM_LINE_STEPS):
        if generator.random() < 0.1:
            creepage, load = uniform(-0.05, 0.05), one_of([0.0, uniform(10e3, 70e3)])
        if generator.random() < 0.03:
            speed = uniform(-40, 40)
        inputs = {
            "wheel_speed": speed * (1 + creepage) / radius,
            "vehicle_speed": speed,
            "creepage": creepage,
            "normal_load": float(load) * (1 + 0.03 * np.sin(moment)),
            "friction_scale": 1 + 0.1 * np.sin(0.3 * moment),
            "incoming_temperature": 293.15 + 20 * (1 + np.sin(0.1 * moment)),
            "incoming_wear_depth": 1e-7 * (1 + np.cos(0.2 * moment)),
        }
        steps.append((inputs, float(one_of([1e-4, 1e-3, 1e-2]))))
    return Scenario(f"random {number}", parameters, steps)


def random_patch(number: int, generator: np.random.Generator) -> Scenario:
    """A patch of few cells, of any curvatures and laws, under a walk of all inputs, with jumps."""
    one_of = generator.choice
    uniform = generator.uniform
    chance = generator.random
    radius = uniform(0.3, 0.6)
    # B/A, from a contact longer than broad to one broader than long.
    curvatures = 10 ** uniform(-0.7, 0.7) / radius
    hollow = float(one_of([0.0, -uniform(0.1, 3.0)]))
    parameters = {
        "contact_model": 2,
        "patch_nodes": int(generator.integers(10, 21)),
        "patch_strips": int(generator.integers(7, 16)),
        "slip_source": int(one_of([1, 2])),
        "friction_law": int(one_of([1, 2, 3])),
        "wheel": int(one_of([1, 2])),
        "wheel_heating": int(one_of([1, 2])),
        "slip_regularisation": float(one_of([0.0, 10 ** uniform(-4, -2)])),
        "wear_coefficient": 10 ** uniform(-13, -11),
        "contact_thermal_resistance": 10 ** uniform(1, 4),
        "wheel_wear_coefficient": float(one_of([0.0, 1e-13])),
        "wheel_radius": radius,
        "wheel_transverse_curvature": hollow,
        "rail_transverse_curvature": curvatures - hollow,
        "layer_compliance": float(one_of([0.0, 10 ** uniform(-14, -12)])),
    }
    speed, creepage, load = uniform(5, 40) * one_of([-1, 1]), uniform(-0.01, 0.01), uniform(20e3, 60e3)
    lateral, spin = uniform(-0.01, 0.01), uniform(-1, 1)
    steps = []
    for moment in range(RANDOM_PATCH_STEPS):
        if chance() < 0.1:
            creepage, load = uniform(-0.03, 0.03), one_of([0.0, uniform(10e3, 90e3)])
        if chance() < 0.1:
            lateral, spin = uniform(-0.01, 0.01), uniform(-1, 1)
        inputs = {
            "wheel_speed": speed * (1 + creepage) / radius,
            "vehicle_speed": speed,
            "creepage": creepage,
            "lateral_creepage": lateral,
            "spin_creepage": spin,
            "lateral_speed": lateral * abs(speed),
            "spin_rate": spin * abs(speed),
            "normal_load": float(load) * (1 + 0.03 * np.sin(moment)),
            "friction_scale": 1 + 0.1 * np.sin(0.3 * moment),
            "incoming_temperature": 293.15 + 20 * (1 + np.sin(0.1 * moment)),
            "incoming_wear_depth": 1e-7 * (1 + np.cos(0.2 * moment)),
        }
        steps.append((inputs, float(one_of([1e-4, 1e-3, 1e-2]))))
    return Scenario(f"random patch {number}", parameters, steps)


# ---- variants, each for both contacts -------------------------------------------------------------------------------

RADIUS = 0.46


def inputs_at(moment: int, speed: float, creepage: float, load: float = 60e3) -> dict[str, float]:
    """Inputs around an operating point, by speeds; what only a patch has is left out by the line."""
    return {
        "vehicle_speed": speed,
        "wheel_speed": speed * (1 + creepage * (1 + 0.5 * np.sin(0.5 * moment))) / RADIUS,
        "normal_load": load * (1 + 0.1 * np.sin(0.7 * moment)),
        "lateral_speed": 1e-3 * abs(speed) * np.sin(0.2 * moment),
        "spin_rate": 0.3 * abs(speed),
    }


def rolling(steps: int = 40, speed: float = 20.0, creepage: float = 4e-3) -> list:
    """Rolling whose creepage and load vary."""
    return [(inputs_at(moment, speed, creepage), 1e-3) for moment in range(steps)]


def reversing() -> list:
    """From 0.5 m/s through standstill to -0.5 m/s."""
    return [(inputs_at(moment, 0.025 * (20 - moment), 6e-3), 2e-3) for moment in range(41)]


def standing() -> list:
    """At rest, under a load that varies: first the wheel turns on the spot, then it stands."""
    at_rest = {"vehicle_speed": 0.0, "lateral_speed": 0.0}
    turning = [inputs_at(k, 0.0, 0.0) | {"wheel_speed": 2e-3, "spin_rate": 0.05} for k in range(20)]
    standing = [inputs_at(k, 0.0, 0.0) | {"wheel_speed": 0.0, "spin_rate": 0.0} for k in range(20, 40)]
    return [(inputs | at_rest, 2e-3) for inputs in turning + standing]


def lifting() -> list:
    """Rolling, lifted off for some steps, and on the rail again; twice."""
    loads = [60e3, 60e3, 20e3, 0.0, 0.0, 0.0, 5e3, 60e3, 80e3, 60e3] * 4
    return [(inputs_at(moment, 20.0, 4e-3, load), 1e-3) for moment, load in enumerate(loads)]


def behind_another_wheel() -> list:
    """Rail that comes in hot and worn."""
    arriving = [
        {"incoming_temperature": 330.0 + 30.0 * np.sin(0.3 * k), "incoming_wear_depth": 1e-7 * (1 + np.cos(0.2 * k))}
        for k in range(40)
    ]
    return [(inputs | before, step) for (inputs, step), before in zip(rolling(creepage=1e-2), arriving, strict=True)]


def overloading() -> list:
    """Rolling, until a load is refused that is larger than the window allows."""
    return [*rolling(10), (inputs_at(0, 20.0, 4e-3, 2e5), 1e-3), *rolling(10)]


ELASTIC = {"layer_compliance": 3e-13}
YIELDING = ELASTIC | {"layer_yield_stress": 1.5e8, "layer_hardening": 3e12}
FALLING = {"friction_slip_share": 0.4, "friction_slip_decay": 1.0, "friction_memory_distance": 2e-5}
WARM_WHEEL = {"wheel_heating": 2, "wheel_wear_coefficient": 1e-13}
REGULARISED = {"slip_regularisation": 1e-3}

# Name, parameters and steps.
VARIANTS: tuple[tuple[str, dict[str, float], Callable[[], list]], ...] = (
    ("rolling", {}, rolling),
    ("sliding", {}, lambda: rolling(creepage=5e-2)),
    ("regularised slip", REGULARISED, rolling),
    ("rigid wheel", {"wheel": 1}, rolling),
    ("prescribed penetration", {"control": 2, "prescribed_penetration": 8e-5}, rolling),
    ("elastic layer", ELASTIC, rolling),
    ("layer that flows", {"layer_yield_stress": 1.5e8}, rolling),
    ("elastic layer that flows and hardens", YIELDING, rolling),
    ("falling friction without memory", {"friction_slip_share": 0.8, "friction_slip_decay": 0.2}, rolling),
    ("falling friction with memory", FALLING, rolling),
    ("falling friction with memory, layer", FALLING | YIELDING, rolling),
    ("memory of temperature alone", {"friction_memory_distance": 2e-5}, lambda: rolling(creepage=2e-2)),
    ("standstill", {}, standing),
    ("standstill, memory, layer", FALLING | YIELDING, standing),
    ("reverse", {}, reversing),
    ("reverse, memory, layer", FALLING | YIELDING, reversing),
    ("lift-off", {}, lifting),
    ("lift-off, memory, layer", FALLING | YIELDING, lifting),
    ("refused load", {}, overloading),
    ("warm wheel behind another", WARM_WHEEL, behind_another_wheel),
)
# Restored half-way: what has a state.
RESTARTED: tuple[tuple[str, dict[str, float], Callable[[], list]], ...] = (
    ("everything", FALLING | YIELDING | WARM_WHEEL, behind_another_wheel),
    ("lift-off", WARM_WHEEL, lifting),
)
SMALL_PATCH = {"contact_model": 2, "patch_nodes": 16, "patch_strips": 9}
PATCH_ONLY = ("lateral_speed", "spin_rate")


def of_contact(contact: str, scenario: Scenario) -> Scenario:
    """The variant of a contact, `line` or `patch`."""
    if contact == "patch":
        return replace(scenario, parameters=SMALL_PATCH | scenario.parameters)
    steps = [({n: v for n, v in inputs.items() if n not in PATCH_ONLY}, step) for inputs, step in scenario.steps]
    return replace(scenario, steps=steps)


def variants(contact: str) -> Iterator[Scenario]:
    """All variants of a contact."""
    for kind, restarted in ((VARIANTS, False), (RESTARTED, True)):
        for name, parameters, steps in kind:
            title = f"{contact}, {name}{', restarted' if restarted else ''}"
            given = {"slip_source": 2, "contact_nodes": 41, "depth_nodes": 21} | parameters
            yield of_contact(contact, Scenario(title, given, steps(), restarted))


def scenarios() -> Iterator[Scenario]:
    """All of them."""
    yield braking("braking", {}, 0.0, 22_000, 1e-3)
    for name, law, hot in [("constant", 1, 150), ("a", 2, 150), ("b", 2, 125), ("c", 2, 100)]:
        yield paper(name, law, hot)
    generator = np.random.default_rng(11)
    for number in range(RANDOM_LINES):
        yield random_line(number, generator)
    # Sticking, then sliding, moving sideways and turning all the while, with the default cells.
    yield braking("braking, patch", {"contact_model": 2}, 7.8, 120, 0.02, lateral_speed=0.02, spin_rate=0.3)
    generator = np.random.default_rng(12)
    for number in range(RANDOM_PATCHES):
        yield random_patch(number, generator)
    for contact in ("line", "patch"):
        yield from variants(contact)
