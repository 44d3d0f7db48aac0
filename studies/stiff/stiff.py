"""Three masters for a stiff coupling: explicit, linearly implicit with derivatives, iterating with saved states.

    .venv/bin/python studies stiff              (after `make fmu`; or `make coupling-stiff`)

A wheel with its share of a vehicle at walking pace and below: driven and braked at 1 m/s; then braked to a stop on a
gradient, held, and driven off. What holds the wheel on the rail is a spring, some 3e8 N/m, in series with a damper that
grows without bound as the speed falls.

    J dω/dt = D(t) + B + M(ω, V),   m dV/dt = T(ω, V) - G     D: drive; B: brake, against ω, up to a torque; G: gradient

Each master gives the contact wheel speed and vehicle speed for a step and reads its torque M and force T at the end of
it. docs/couplings/stiff.md, whose tables and pictures this writes.
"""

import time
from types import SimpleNamespace

import matplotlib.pyplot as plt
import numpy as np
from helpers import (
    BLACK,
    BLUE,
    FMU,
    ORANGE,
    RED,
    WHEEL_RADIUS,
    Instance,
    markdown_table,
    save,
    show,
    write_csv,
    write_tables,
)

WHEEL_INERTIA = 60.0  # kg.m2, half a wheelset
VEHICLE_MASS = 6000.0  # kg, on one wheel
LOAD = 60e3  # N
FRICTION = 0.45  # of the cold rail
REFERENCE_STEP = 50e-6  # s, of the iterating master
EXPLICIT_STEPS = (50e-6, 125e-6, 250e-6, 500e-6, 1e-3, 1.6e-3, 2.5e-3, 4e-3)  # s
IMPLICIT_STEPS = (250e-6, 500e-6, 1e-3, 2.5e-3, 4e-3, 10e-3)  # s
MASSES = np.array([WHEEL_INERTIA, VEHICLE_MASS])
NAMES = ("friction_torque", "traction_force")
SPEEDS = ("wheel_speed", "vehicle_speed")
OTHERS = ("friction_energy", "contact_offset")


def smooth(value, start, end):
    """From 0 at start to 1 at end, with zero slope at both."""
    s = min(max((value - start) / (end - start), 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


# ---- two manoeuvres: speed at the start [m/s], end [s], gradient, drive and largest brake [N.m] over time [s] ----


def half_waves(now):
    """Half a sine wave forward, at its peak 93 % of what friction can carry; a smaller one backward."""
    phase = np.sin(2.0 * np.pi * now / 0.4)
    return 12e3 * (phase if phase > 0.0 else 0.6 * phase) * abs(phase)


ROLLING = SimpleNamespace(speed=1.0, end=0.4, gradient=0.0, drive=half_waves, brake=lambda now: 0.0)

HELD = (1.5, 2.5)  # s: at rest, its swing on the spring over; until the brake lets go
STOPPING = SimpleNamespace(
    speed=1.0,
    end=4.0,
    gradient=0.03,
    drive=lambda now: 3e3 * smooth(now, 2.3, 2.5),
    brake=lambda now: 4e3 * smooth(now, 0.1, 0.3) * (1.0 - smooth(now, 2.5, 2.8)),
)

# Beyond what friction can carry: the wheel spins up, and then catches the rail.
SPINNING = SimpleNamespace(**vars(ROLLING) | {"drive": lambda now: 14.5 / 12.0 * half_waves(now)})


class Contact(Instance):
    """The component, its inputs and answers as vectors: speeds (ω, V) in, forces (M, T) out."""

    def __init__(self, speed, normal_load=LOAD):
        """Start with the wheel rolling freely; a wheel of the rail's material does so at a creepage of 0."""
        self.speeds = np.array([speed / WHEEL_RADIUS, speed])
        speeds = dict(zip(SPEEDS, self.speeds, strict=True))
        super().__init__(FMU, slip_source=2, normal_load=normal_load, **speeds)
        self.start()

    def forces(self, speeds, step):
        """Step with these speeds and return the forces at the end of the step."""
        self.set(**dict(zip(SPEEDS, map(float, speeds), strict=True)))
        self.step(step)
        return np.array(self.get(*NAMES))

    def slopes(self):
        """Derivatives of the forces of the last step with respect to its speeds, a column for each speed."""
        return np.column_stack([self.derivative(NAMES, speed) for speed in SPEEDS])


def balanced(speeds, about, forces, slopes, manoeuvre, now, step):
    """Speeds at the end of a step and the brake's torque, with forces of the contact that are linear about some speeds.

    The brake takes what stops the wheel within the step, as far as it can: so a wheel that stands is held.
    """
    system = np.diag(MASSES / step) - slopes
    acting = np.array([manoeuvre.drive(now), -manoeuvre.gradient * LOAD])
    free = np.linalg.solve(system, MASSES / step * speeds + forces - slopes @ about + acting)
    of_torque = np.linalg.solve(system, [1.0, 0.0])
    largest = manoeuvre.brake(now)
    brake = np.clip(-free[0] / of_torque[0], -largest, largest)
    return free + brake * of_torque, brake


# ---- the three masters: each goes on from (speeds, forces) at the beginning of a step -------------------------------


def explicit(contact, speeds, forces, manoeuvre, now, step, _memory):
    """Take turns: the vehicle steps with the contact's last forces, the contact with the vehicle's new speeds."""
    speeds, brake = balanced(speeds, speeds, forces, np.zeros((2, 2)), manoeuvre, now, step)
    return speeds, contact.forces(speeds, step), brake


def linearly_implicit(contact, speeds, _forces, manoeuvre, now, step, _memory):
    """Solve the implicit step linearised about a trial step: by fmi2GetDirectionalDerivative, and going back once.

    The contact remembers: a spring's force changes though the speeds stay. So the forces that belong to the old speeds
    are not the last ones, but those of a trial step with the old speeds; there the derivatives are taken.
    """
    saved = contact.save()
    forces = contact.forces(speeds, step)
    slopes = contact.slopes()
    contact.restore(saved)
    contact.forget(saved)
    speeds, brake = balanced(speeds, speeds, forces, slopes, manoeuvre, now, step)
    return speeds, contact.forces(speeds, step), brake


def iterating(contact, speeds, _forces, manoeuvre, now, step, memory):
    """Repeat the implicit step until both sides agree: by fmi2GetFMUstate and fmi2SetFMUstate, without derivatives.

    The slopes are learnt from the repetitions (Broyden's method): at first, and after eight without success, from one
    repetition per speed.
    """
    saved = contact.save()

    def repeated(guess):
        contact.restore(saved)
        memory["count"] = memory.get("count", 0) + 1
        return contact.forces(guess, step)

    guess, answer = speeds, repeated(speeds)
    for repetition in range(40):
        if "slopes" not in memory or repetition % 9 == 8:
            changes = 1e-6 * np.eye(2)
            memory["slopes"] = np.column_stack([(repeated(guess + change) - answer) / 1e-6 for change in changes])
        after, brake = balanced(speeds, guess, answer, memory["slopes"], manoeuvre, now, step)
        change, before = after - guess, answer
        guess, answer = after, repeated(after)
        if np.abs(change).max() < TOLERANCE:
            break
        memory["slopes"] = memory["slopes"] + np.outer(answer - before - memory["slopes"] @ change, change) / (
            change @ change
        )
    else:
        raise RuntimeError(f"no agreement at {now:g} s: {change}")
    contact.forget(saved)
    return guess, answer, brake


TOLERANCE = 1e-9  # rad/s and m/s
MASTERS = {"explicit": explicit, "linearly implicit": linearly_implicit, "iterating": iterating}


def run(master, step, manoeuvre=ROLLING):
    """One master at one step: time, speeds, forces, the rest of the balance, and what it cost."""
    contact = Contact(manoeuvre.speed)
    speeds, forces = contact.speeds, np.array(contact.get(*NAMES))
    rows, memory = [(0.0, *speeds, *forces, *contact.get(*OTHERS), 0.0)], {}
    began = time.process_time()
    for number in range(1, round(manoeuvre.end / step) + 1):
        now = number * step
        speeds, forces, brake = MASTERS[master](contact, speeds, forces, manoeuvre, now, step, memory)
        rows.append((now, *speeds, *forces, *contact.get(*OTHERS), brake))
    spent = time.process_time() - began
    contact.close()
    columns = zip(("time", *SPEEDS, *NAMES, *OTHERS, "brake"), np.array(rows).T, strict=True)
    return dict(columns) | {"spent": spent, "repetitions": memory.get("count", 0) * step / manoeuvre.end}


def error(result, reference):
    """Largest error of the traction force, relative to its largest value."""
    there = np.interp(result["time"], reference["time"], reference["traction_force"])
    return float(np.abs(result["traction_force"] - there).max() / np.abs(reference["traction_force"]).max())


# ---- the largest stable step ----------------------------------------------------------------------------------------

LIMIT_SPEEDS = (10.0, 1.0, 0.1, 0.01, 0.0)  # m/s


def spring():
    """Torque on the wheel per angle at rest, from the derivatives of a short step there [N.m]."""
    contact, step = Contact(0.0), 1e-4
    contact.forces(contact.speeds, step)
    slope = contact.slopes()[0, 0]
    contact.close()
    return -slope / step


def damper(speed):
    """Torque on the wheel per angular speed in steady rolling, from a step that is long enough to be steady [N.m.s]."""
    contact = Contact(speed)
    contact.forces(contact.speeds, 10.0 / speed)
    slope = contact.slopes()[0, 0]
    contact.close()
    return -slope


def predicted(stiffness, damping):
    """Largest stable step of the explicit master for a wheel on a damper and a spring in series [s].

    With M' = (M - κ h ω')/(1 + κ h/c), ω' = ω + h M/J a swing alternates without decay where κ h² = 4 J + 2 J κ h/c.
    """
    alone = WHEEL_INERTIA / damping
    return alone + np.sqrt(alone**2 + 4.0 * WHEEL_INERTIA / stiffness)


def growth(speed, step, count=300):
    """What is left of a swing: the wheel free at a given vehicle speed, under a third of what friction can carry."""
    contact = Contact(speed)
    speeds, drive, torque, swings = contact.speeds.copy(), FRICTION / 3.0 * LOAD * WHEEL_RADIUS, 0.0, []
    for _ in range(count):
        swings.append(abs(drive + torque))
        speeds[0] += step * (drive + torque) / WHEEL_INERTIA
        torque = contact.forces(speeds, step)[0]
    contact.close()
    return max(swings[-count // 4 :]) / max(swings[: count // 4])


def largest_stable_step(speed, low=20e-6, high=4e-3):
    """The explicit master's, to 1 %: up to it a swing decays."""
    while high > 1.01 * low:
        middle = np.sqrt(low * high)
        low, high = (middle, high) if growth(speed, middle) < 0.9 else (low, middle)
    return low


def limits():
    """For each speed: with the damper alone, as predicted, as measured [s]."""
    stiffness = spring()
    rows = []
    for speed in LIMIT_SPEEDS:
        damping = damper(speed) if speed > 0.0 else np.inf
        alone = 2.0 * WHEEL_INERTIA / damping
        rows.append((speed, alone, predicted(stiffness, damping), largest_stable_step(speed)))
        show(len(rows) / len(LIMIT_SPEEDS), "largest stable step")
    return stiffness, rows


# ---- error and cost against step, and the balance of a stop ---------------------------------------------------------


def measure(reference):
    """For each master and step: error, processor time, repetitions a step."""
    steps = {"explicit": EXPLICIT_STEPS, "linearly implicit": IMPLICIT_STEPS, "iterating": IMPLICIT_STEPS}
    count = sum(map(len, steps.values()))
    rows = []
    for master, its_steps in steps.items():
        for step in its_steps:
            result = run(master, step)
            rows.append((master, step, error(result, reference), result["spent"], result["repetitions"]))
            show(len(rows) / count, "error against step")
    return rows


def balance(result, stiffness):
    """The books of a stop [J]: works with the mean speed of each step, the spring's energy from its force."""
    manoeuvre, step = STOPPING, result["time"][1]
    wheel, vehicle = (0.5 * (result[name][1:] + result[name][:-1]) for name in SPEEDS)
    drive = np.array([manoeuvre.drive(now) for now in result["time"][1:]])
    kinetic = 0.5 * (WHEEL_INERTIA * result["wheel_speed"] ** 2 + VEHICLE_MASS * result["vehicle_speed"] ** 2)
    books = {
        "drive": step * drive @ wheel,
        "brake": step * result["brake"][1:] @ wheel,
        "gradient": -step * manoeuvre.gradient * LOAD * vehicle.sum(),
        "kinetic": kinetic[-1] - kinetic[0],
        "friction": result["friction_energy"][-1],
        "rolling": step * LOAD * result["contact_offset"][1:] @ (wheel - vehicle / WHEEL_RADIUS),
        "spring": 0.5 * (result["friction_torque"][-1] ** 2) / stiffness,
    }
    given = books["drive"] + books["brake"] + books["gradient"]
    books["missing"] = given - books["kinetic"] - books["friction"] - books["rolling"] - books["spring"]
    return books


def held(result):
    """While held: way [m] and largest speed [m/s]."""
    at_rest = (result["time"] > HELD[0]) & (result["time"] < HELD[1])
    speeds = result["vehicle_speed"][at_rest]
    return np.ptp(np.cumsum(speeds)) * result["time"][1], np.abs(speeds).max()


# ---- pictures and tables --------------------------------------------------------------------------------------------

LOOK = {"explicit": (BLUE, "o"), "linearly implicit": (ORANGE, "s"), "iterating": (RED, "D")}
SHOWN = {"explicit": 2.5e-3, "linearly implicit": 10e-3, "iterating": 10e-3}  # s
STOPS = (("explicit", 1e-3), ("linearly implicit", 1e-3), ("iterating", 1e-3), ("iterating", 10e-3))


def draw(reference, rows, limit):
    """Draw the traction force of each master, and error against step."""
    figure = plt.figure(figsize=(7.8, 7.4), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.15, 1])
    panels = top.subplots(1, 3, sharey=True, sharex=True)
    thick = {
        "color": BLACK,
        "linewidth": 2.6,
        "alpha": 0.3,
        "label": f"reference:\niterating, {1e6 * REFERENCE_STEP:g} µs",
    }
    for axes, (master, step) in zip(panels, SHOWN.items(), strict=True):
        result, (colour, mark) = run(master, step), LOOK[master]
        axes.plot(reference["time"], reference["traction_force"] / 1e3, **thick)
        axes.plot(
            result["time"],
            result["traction_force"] / 1e3,
            color=colour,
            marker=mark,
            markersize=2,
            linewidth=0.8,
            label=f"{master}, {1e3 * step:g} ms",
        )
        axes.set(title=f"{step / limit:.2g} × the explicit limit", xlabel="time [s]")
        axes.legend(loc="lower left", fontsize=8)
    # Below the curves there is room for what they are called.
    panels[0].set(ylabel="traction force [kN]", xlim=(0, ROLLING.end), xticks=[0, 0.1, 0.2, 0.3, 0.4], ylim=(-62, 32))
    panels[0].set_yticks([-20, 0, 20])

    against_step = bottom.subplots()
    for master, (colour, mark) in LOOK.items():
        steps, values = np.array([row[1:3] for row in rows if row[0] == master]).T
        against_step.loglog(1e3 * steps, values, color=colour, marker=mark, markersize=5, label=master)
    label = f"largest stable step of the explicit master, {1e3 * limit:.3g} ms"
    against_step.axvline(1e3 * limit, color="#777777", linestyle=":", label=label)
    against_step.set(xlabel="communication step [ms]", ylabel="error of the traction force /\nits largest value [1]")
    against_step.set(title="Error against step", xticks=[0.1, 1, 10], xticklabels=["0.1", "1", "10"])
    against_step.legend(loc="upper left")
    save(figure, "stiff.png")


def draw_stops(stops):
    """Draw speed, traction and place of a vehicle that stops, is held and drives off."""
    figure, (speeds, forces, places) = plt.subplots(3, 1, figsize=(8.4, 7.0), sharex=True, layout="constrained")
    for (master, step), result in stops.items():
        style = {"color": LOOK[master][0], "linestyle": "-" if step < 5e-3 else "--", "linewidth": 1.0}
        if master == "linearly implicit":
            # It lies under the iterating one.
            style |= {"linewidth": 3.5, "alpha": 0.6}
        label = f"{master}, {1e3 * step:g} ms"
        speeds.plot(result["time"], result["vehicle_speed"], **style, label=label)
        forces.plot(result["time"], result["traction_force"] / 1e3, **style)
        place = np.cumsum(result["vehicle_speed"]) * step
        places.plot(result["time"], 1e6 * (place - np.interp(HELD[1], result["time"], place)), **style)
    speeds.set(ylabel="speed [m/s]", title=f"Braked to a stop on {STOPPING.gradient:.0%}, held, driven off")
    speeds.legend(loc="upper center", bbox_to_anchor=(0.58, 1.0))
    forces.set(ylabel="traction force [kN]")
    places.set(ylabel="place from where\nit is held [µm]", xlabel="time [s]", xlim=(0, STOPPING.end), ylim=(-30, 60))
    for axes in (speeds, forces, places):
        axes.axvspan(*HELD, color="#f0f0f0", zorder=0)
    places.annotate("held", (np.mean(HELD), 50), ha="center", va="center", color="#666666")
    save(figure, "stiff_stop.png")


def limits_table(rows):
    """Largest stable steps."""
    head = ["speed", "damper alone, 2 J / c", "damper and spring in series", "measured"]
    digits = "{:.3g} ms".format
    return markdown_table(head, [[f"{speed:g} m/s", *(digits(1e3 * value) for value in row)] for speed, *row in rows])


def errors_table(rows):
    """Error of each master at each step, and what the iterating one needs."""
    found = {(master, step): rest for master, step, *rest in rows}
    lines = []
    for step in sorted({step for _, step, *_ in rows}):
        cells = [found.get((master, step), (None,))[0] for master in MASTERS]
        repetitions = found.get(("iterating", step), (0, 0, 0))[2]
        lines.append([f"{1e3 * step:g} ms", *("" if value is None else f"{100 * value:.2g} %" for value in cells)])
        lines[-1].append(f"{repetitions:.1f}" if repetitions else "")
    return markdown_table(["step", *MASTERS, "repetitions a step"], lines)


def costs_table(rows):
    """Processor time per second simulated."""
    found = {(master, step): rest for master, step, *rest in rows}
    lines = [
        [f"{1e3 * step:g} ms", *(f"{found[master, step][1] / ROLLING.end:.2f} s" for master in MASTERS)]
        for step in (500e-6, 1e-3)
    ]
    return markdown_table(["step", *MASTERS], lines)


def stops_table(stops, stiffness):
    """Held, and the books."""
    lines = []
    for (master, step), result in stops.items():
        books, (way, speed) = balance(result, stiffness), held(result)
        parts = ("brake", "drive", "gradient", "kinetic", "friction", "spring", "missing")
        lines.append([f"{master}, {1e3 * step:g} ms", f"{1e6 * way:.2g} µm", f"{speed:.1e} m/s"])
        lines[-1] += [f"{books[name]:.2f} J" for name in parts]
    head = ["master", "way while held", "largest speed", "brake", "drive", "gradient", "change of kinetic energy"]
    return markdown_table([*head, "friction", "in the spring", "missing"], lines)


def spinning_table():
    """Largest error of the force, and of the speed at the end, of a wheel that spins and catches the rail."""
    reference, lines = run("iterating", REFERENCE_STEP, SPINNING), []
    for master in MASTERS:
        for step in (200e-6, 1e-3):
            result = run(master, step, SPINNING)
            lines.append([f"{master}, {1e3 * step:g} ms", f"{100 * error(result, reference):.2g} %"])
            lines[-1].append(f"{result['vehicle_speed'][-1] - reference['vehicle_speed'][-1]:.1e} m/s")
    return markdown_table(["master", "largest error of the force", "error of the speed at the end"], lines)


def main():
    """Measure, draw, write, report."""
    stiffness, steps = limits()
    reference = run("iterating", REFERENCE_STEP)
    rows = measure(reference)
    draw(reference, rows, dict((speed, measured) for speed, _, _, measured in steps)[ROLLING.speed])
    stops = {(master, step): run(master, step, STOPPING) for master, step in STOPS}
    draw_stops(stops)
    print(f"  spring of the contact: {stiffness / WHEEL_RADIUS**2:.3g} N/m")
    tables = {"limits": limits_table(steps), "errors": errors_table(rows), "costs": costs_table(rows)}
    write_tables("stiff.md", tables | {"stops": stops_table(stops, stiffness), "spinning": spinning_table()})
    names = {"explicit": 0, "linearly implicit": 1, "iterating": 2}
    columns = list(zip(*((names[master], *rest) for master, *rest in rows), strict=True))
    head = [f"master ({', '.join(f'{number} {name}' for name, number in names.items())})", "step [s]", "error [1]"]
    write_csv("stiff.csv", dict(zip([*head, "processor time [s]", "repetitions per step [1]"], columns, strict=True)))


if __name__ == "__main__":
    main()
