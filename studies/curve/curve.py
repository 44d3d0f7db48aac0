"""A bogie through a transition into a curve of 300 m and out, four wheels with profiles, in Exudyn and by Newton.

    .venv/bin/python studies curve              (after `make couplings-set-up`; or `make coupling-curve`)

Each wheel is a component of its own, S1002 on 60E1, which has the height of its wheelset (`control` height) and gives
the load. curve_track.py has the track and how a wheelset stands on it, curve_vehicle.py masses and springs,
curve_bogie.py the bodies in Exudyn, curve_equilibrium.py steady curving by Newton's method with the units' derivatives,
curve_pictures.py the pictures. Here: the runs, whether both agree, and the tables. docs/couplings/curve.md.
"""

import warnings
from types import SimpleNamespace

import numpy as np
from curve_bogie import STEP, Bogie
from curve_equilibrium import Equilibrium, straight_running
from curve_pictures import draw_way, draw_wheels
from curve_track import Layout, Track
from curve_vehicle import AXLES, SPEED, WHEEL_LOAD, WHEELS
from helpers import markdown_table, show, write_csv, write_tables

# On even track the bogie comes to rest in the curve; over its last metres it is compared with the equilibrium.
START, EVEN_STEP, COMPARED, HALF_BOGIE = 6.0, 2e-3, 10.0, 2.0  # m, s, m, m
# Force, displacement and yaw by which the mean over these may differ: as much as is left of the body's sway there,
# printed beside it. Its wave is longer than 10 m, so that the mean may keep most of it. What else differs is less:
# the train's pull needs 0.8 mm/s of speed, 1e-4 of the centrifugal force, some newtons.
FORCE, DISPLACEMENT, YAW = 50.0, 5e-6, 5e-6  # N, m, rad
QUANTITIES = {"Y": FORCE, "Q": FORCE}
POSES = {"y": DISPLACEMENT, "yaw": YAW}


def equilibrium(track, straight):
    """Steady curving in the middle of the curve, from straight running on."""
    _, begin, end, *_ = track.layout.marks
    found = Equilibrium(track, 0.5 * (begin + end)).start_from(straight)

    def report(so_far):
        show(min(len(so_far.history) / 45.0, 0.99), "equilibrium")

    found.solve(report=report)
    show(1.0, "equilibrium")
    return found


def measure(layout=None, length=None, even_length=None):
    """Both runs and the equilibrium."""
    layout = layout or Layout()
    even, rough = Track(layout), Track(layout, rough=1.0)
    straight = straight_running(even, START)
    straight.close()
    found = SimpleNamespace(layout=layout, even=even, rough=rough)
    steady = equilibrium(even, straight)
    found.history, found.steady = steady.history, steady.table()
    steady.close()
    marks = layout.marks
    found.settled, found.settled_count = run(straight, even, EVEN_STEP, even_length or marks[2] - HALF_BOGIE - START)
    found.way, found.count = run(straight, rough, STEP, length or marks[-1] - START)
    return found


def run(equilibrium, track, step, length):
    """Time integration, and how many of the units' steps were staggered."""
    bogie = Bogie(equilibrium, track, step)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        result = bogie.run(length)
    bogie.close()
    return result, sum("not solved together" in str(warning.message) for warning in caught)


def last(result, length=COMPARED):
    """Rows of the last metres."""
    return result[result["place"] > result["place"][-1] - length]


def in_curve(found):
    """Rows of the rough run in which both wheelsets are in the curve, but for its first 20 m."""
    _, begin, end, *_ = found.layout.marks
    place = found.way["place"]
    return found.way[(place > begin + 20.0) & (place < end - 2.0)]


def differences(found):
    """Name, equilibrium, mean over the last metres, half of the swing there, and what is allowed."""
    rows = last(found.settled)
    names = [(f"{name}_{axle}", most) for axle in AXLES for name, most in POSES.items()]
    names += [(f"{name}_{axle}_{side}", most) for axle, side in WHEELS for name, most in QUANTITIES.items()]
    return [(name, found.steady[name], rows[name].mean(), 0.5 * np.ptp(rows[name]), most) for name, most in names]


def check(found):
    """Both agree, or an error that says what does not."""
    for name, steady, mean, swing, most in differences(found):
        if abs(mean - steady) > most:
            raise AssertionError(f"{name}: {mean:g} in time, {steady:g} in equilibrium, swinging by {swing:g}")


# ---- tables ---------------------------------------------------------------------------------------------------------


def agreement_table(found):
    """Equilibrium beside the time integration."""
    lines = []
    for name, steady, mean, swing, most in differences(found):
        quantity, *where = name.split("_")
        factor, unit = {"y": (1e3, "mm"), "yaw": (1e3, "mrad")}.get(quantity, (1e-3, "kN"))
        values = [f"{factor * value:.3f} {unit}" for value in (steady, mean, mean - steady, swing, most)]
        lines.append([f"{quantity}, {' '.join(where)}", *values])
    head = ["", "Newton", "Exudyn, end of the curve", "difference", "swing left", "allowed"]
    return markdown_table(head, lines)


def steady_table(found):
    """Steady curving of each wheel, and what the rough way has in the curve."""
    lines, rows = [], in_curve(found)
    for axle, side in WHEELS:
        at = f"{axle}_{side}"
        get = {name: found.steady[f"{name}_{at}"] for name in ("Y", "Q", "peak_temperature", "wear_number")}
        number = round(found.steady[f"contacts_{at}"])
        places = ", ".join(
            f"{1e3 * found.steady[f'contact.rail_position[{k}]_{at}']:.1f}" for k in range(1, number + 1)
        )
        steep = np.degrees(found.steady[f"contact.inclination[1]_{at}"])
        ratio = np.abs(rows[f"Y_{at}"] / rows[f"Q_{at}"])
        lines.append(
            [
                f"{axle} {side}",
                f"{get['Y'] / 1e3:.1f} kN",
                f"{get['Q'] / 1e3:.1f} kN",
                f"{get['Y'] / get['Q']:.2f}",
                f"{ratio.max():.2f}",
                f"{places} mm, {steep:.0f}°",
                f"{get['peak_temperature'] - 273.15:.0f} °C",
                f"{rows[f'peak_temperature_{at}'].max() - 273.15:.0f} °C",
                f"{get['wear_number']:.0f} N",
                f"{rows[f'wear_number_{at}'].mean():.0f} N",
            ]
        )
    head = ["wheel", "Y", "Q", "Y/Q", "largest, rough", "contacts on the rail, steepness of the first"]
    head += ["peak temperature", "largest, rough", "Tγ", "mean, rough"]
    return markdown_table(head, lines)


def run_table(found):
    """What the runs are like."""
    layout = found.layout
    level = SPEED**2 / abs(layout.radius)
    lean = 9.81 * layout.cant / 1.5
    rows = {
        "speed, radius, cant": f"{3.6 * SPEED:.0f} km/h, {abs(layout.radius):.0f} m, {1e3 * layout.cant:.0f} mm",
        "acceleration outwards: V²/R, less the cant": f"{level:.2f}, {level - lean:.2f} m/s²",
        "static load of a wheel": f"{WHEEL_LOAD / 1e3:.1f} kN",
        "pull that holds the speed in the curve": f"{found.steady['pull'] / 1e3:.2f} kN",
        "iterations of Newton's method into the curve": f"{len(found.history)}",
        "the last three residuals": ", ".join(f"{value:.1g} N" for value in found.history[-3:]),
        "steps on rough track": f"{len(found.way)} of {1e3 * STEP:g} ms, {found.count} of the units' staggered",
        "steps on even track": f"{len(found.settled)} of {1e3 * EVEN_STEP:g} ms, {found.settled_count} staggered",
        "largest Y on rough track": f"{max(found.way[f'Y_{a}_{s}'].max() for a, s in WHEELS) / 1e3:.1f} kN",
        "largest pressure on rough track": f"{peak_pressure(found) / 1e6:.0f} MPa",
    }
    return markdown_table(["", ""], [list(row) for row in rows.items()])


def peak_pressure(found):
    """Largest pressure of all wheels on the rough way."""
    return max(found.way[f"contact.peak_pressure[{k}]_{a}_{s}"].max() for a, s in WHEELS for k in (1, 2, 3))


def main():
    """Run, check, draw, write."""
    found = measure()
    tables = {"run": run_table(found), "steady": steady_table(found), "agreement": agreement_table(found)}
    write_tables("curve.md", tables)
    thinned = found.way[::5]
    write_csv("curve.csv", {name: thinned[name] for name in thinned.dtype.names})
    draw_way(found)
    draw_wheels(found)
    check(found)
    print(f"  both agree: forces to {FORCE:.0f} N, {1e3 * DISPLACEMENT:g} mm and {1e3 * YAW:g} mrad")


if __name__ == "__main__":
    main()
