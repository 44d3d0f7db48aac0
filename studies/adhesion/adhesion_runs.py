"""What studies/adhesion compares: controllers on one locomotive, with and without heat, and steady creep curves."""

import multiprocessing
import os
from concurrent.futures import ProcessPoolExecutor

import numpy as np
from helpers import FMU, Instance
from locomotive import (
    AXLES,
    CONTACT,
    GRADIENT,
    GRAVITY,
    INERTIA,
    LEAVES,
    RESISTANCE,
    SPEED,
    STOP,
    WHEEL_LOAD,
    WHEEL_RADIUS,
    Locomotive,
    constant_friction,
)
from slip_control import ConstantCreepage, CutAndRamp, Search

CONTROLLERS = {
    "search": lambda axle: Search(INERTIA, WHEEL_RADIUS, 0.5 * np.pi * axle),
    "constant 1 %": lambda axle: ConstantCreepage(INERTIA, WHEEL_RADIUS, 0.01),
    "constant 10 %": lambda axle: ConstantCreepage(INERTIA, WHEEL_RADIUS, 0.10),
    "cut and ramp": lambda axle: CutAndRamp(INERTIA, WHEEL_RADIUS),
}
# As it is; friction of the ambient's temperature, whatever the contact's; each wheelset on rail as cold as the first's;
# controllers that see speeds with noise.
AS_IT_IS, CONSTANT, COLD, NOISY = "as it is", "without temperature", "rail cold under each", "noise"
NOISE = 5e-3  # m/s at the tread
VARIANTS = {AS_IT_IS: {}, CONSTANT: constant_friction(), COLD: {"chained": False}, NOISY: {"noise": NOISE}}
COMPARED = ("search", "constant 10 %")
SETTLED = (4.0, 8.0)  # s: on wet rail, the search has found its place
CREEPAGES = np.array([0.05, 0.1, 0.2, 0.3, 0.5, 0.7, 1.0, 1.4, 2.0, 3.0, 4.0, 5.0, 7.0, 10.0, 14.0, 20.0]) / 100.0


def run(controller, variant=AS_IT_IS, stop=STOP, **options):
    """One run: the table and the books."""
    controllers = [CONTROLLERS[controller](axle) for axle in range(len(AXLES))]
    return Locomotive(controllers, **(VARIANTS[variant] | options)).run(stop)


def all_runs():
    """All runs, by controller and variant, side by side in processes; the variants only as far as the leaves."""
    asked = [(controller, AS_IT_IS, STOP) for controller in CONTROLLERS]
    asked += [(controller, variant, SETTLED[1]) for variant in (CONSTANT, COLD) for controller in COMPARED]
    asked.append(("search", NOISY, SETTLED[1]))
    spawn = multiprocessing.get_context("spawn")
    with ProcessPoolExecutor(min(os.cpu_count() or 1, 4), mp_context=spawn) as pool:
        results = list(pool.map(run, *zip(*asked, strict=True)))
    return {(controller, variant): result for (controller, variant, _), result in zip(asked, results, strict=True)}


def steady(scale=1.0, creepages=CREEPAGES, load=WHEEL_LOAD, **start_values):
    """Traction over load and peak temperature in steady rolling at 10 m/s, on rail of the ambient's temperature."""
    motion = {"normal_load": load, "vehicle_speed": SPEED, "wheel_speed": SPEED / WHEEL_RADIUS}
    contact = Instance(FMU, **(CONTACT | start_values), **motion, friction_scale=scale).start()
    rows = []
    for creepage in creepages:
        contact.set(wheel_speed=SPEED * (1.0 + creepage) / WHEEL_RADIUS)
        # The rail passes through the contact, 13 mm long, in less than a step.
        for _ in range(8):
            contact.step(5e-3)
        rows.append(contact.get("traction_coefficient", "peak_temperature"))
    contact.close()
    return np.array(rows).T


def steady_curves():
    """The steady curves of the page: on wet rail, without temperature, in the leaves, and on a fine grid."""
    fine = steady(patch_nodes=34, patch_strips=21)
    return {
        "fine": fine,
        AS_IT_IS: steady(),
        CONSTANT: steady(**VARIANTS[CONSTANT]),
        "leaves": steady(scale=min(LEAVES.scales)),
    }


def most(curve):
    """The most that all wheels together can pull on a rail with a steady curve [N]."""
    return 8.0 * WHEEL_LOAD * float(curve[0].max())


# ---- what a run comes to --------------------------------------------------------------------------------------------


def during(table, begin=SETTLED[0], end=SETTLED[1]):
    """The rows of a span of time."""
    return (table["time"] > begin + 1e-9) & (table["time"] < end + 1e-9)


def in_leaves(table):
    """The rows while at least one wheelset is in the leaves."""
    return (table["distance"] > LEAVES.places[0]) & (table["distance"] < LEAVES.places[-1] - AXLES[-1])


def creepage(table):
    """Creepage of each wheelset."""
    return table["wheel_speed"] * WHEEL_RADIUS / table["vehicle_speed"] - 1.0


def effort(table):
    """Tractive effort of the locomotive [N]."""
    return 2.0 * table["traction_force"].sum(axis=1)


def summary(table, rows):
    """Means over some rows: effort [N], creepage, slip energy [J/m], wear [m3/m]; the highest temperature [K]."""
    first, last = np.flatnonzero(rows)[[0, -1]]
    way = table["distance"][last] - table["distance"][first]
    spent, worn = (2.0 * np.sum(table[name][last] - table[name][first]) for name in ("friction_energy", "worn_volume"))
    return {
        "effort": effort(table)[rows].mean(),
        "creepage": creepage(table)[rows].mean(),
        "energy": spent / way,
        "wear": worn / way,
        "peak": table["peak_temperature"][rows].max(),
    }


def hauled(force):
    """Mass that a tractive effort moves up the gradient at 10 m/s without getting slower, locomotive included [kg]."""
    still, linear, square = RESISTANCE
    return force / (GRAVITY * (GRADIENT + still + linear * SPEED + square * SPEED**2))
