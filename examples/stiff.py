"""Three masters for a stiff coupling: explicit, linearly implicit with derivatives, iterating with saved states.

    .venv/bin/python examples/stiff.py              (after `make fmu`; or `make coupling-stiff`)

A wheel with its share of a vehicle starts from walking pace: it is driven, then braked. At such speeds the creep force
answers to microns per second of slip, and what holds the wheel on the rail has a time constant of tens of microseconds.

    J dω/dt = D(t) + M(ω, V),   m dV/dt = T(ω, V)        D: driving torque; M, T: the contact's answer

Each master gives the contact wheel speed and vehicle speed for a step and reads its torque and force at the end of it.
docs/couplings/stiff.md.
"""

import time

import matplotlib.pyplot as plt
import numpy as np
from helpers import BLACK, BLUE, FMU, ORANGE, RED, WHEEL_RADIUS, Instance, save, show, write_csv

WHEEL_INERTIA = 60.0  # kg.m2, half a wheelset
VEHICLE_MASS = 6000.0  # kg, on one wheel
SPEED = 1.0  # m/s at the start
DRIVE = 12e3  # N.m, at its peak 93 % of what friction can carry
STOP = 0.4  # s
REFERENCE_STEP = 10e-6  # s
EXPLICIT_STEPS = (20e-6, 30e-6, 40e-6, 50e-6, 62.5e-6, 80e-6, 100e-6, 125e-6, 250e-6, 500e-6)  # s
IMPLICIT_STEPS = (125e-6, 250e-6, 500e-6, 1.5625e-3, 3.125e-3, 6.25e-3)  # s
MASSES = np.array([WHEEL_INERTIA, VEHICLE_MASS])
NAMES = ("friction_torque", "traction_force")
SPEEDS = ("wheel_speed", "vehicle_speed")


def drive(now):
    """Driving torque: half a sine wave forward, a smaller one backward."""
    phase = np.sin(2.0 * np.pi * now / STOP)
    return DRIVE * (phase if phase > 0.0 else 0.6 * phase) * abs(phase)


class Contact(Instance):
    """The component, its inputs and answers as vectors: speeds (ω, V) in, forces (M, T) out."""

    def __init__(self):
        """Start steady, with the wheel rolling freely: Newton's method for a torque of zero."""
        self.speeds = np.array([SPEED / WHEEL_RADIUS, SPEED])
        super().__init__(FMU, slip_source=2, **dict(zip(SPEEDS, map(float, self.speeds), strict=True)))
        self.start()
        for _ in range(8):
            for _ in range(200):
                self.initial = self.forces(self.speeds, 20e-3)
            self.speeds[0] -= self.initial[0] / self.jacobian()[0, 0]

    def forces(self, speeds, step):
        """Step with these speeds and return the forces at the end of the step."""
        self.set(**dict(zip(SPEEDS, map(float, speeds), strict=True)))
        self.step(step)
        return np.array(self.get(*NAMES))

    def jacobian(self):
        """Derivatives of the forces with respect to the speeds, a column for each speed."""
        return np.column_stack([self.derivative(NAMES, speed) for speed in SPEEDS])


def accelerations(forces, now):
    """Right-hand side of the two equations of motion."""
    return (forces + np.array([drive(now), 0.0])) / MASSES


# ---- the three masters: each goes on from (speeds, forces) at the beginning of a step -------------------------------


def explicit(contact, speeds, forces, now, step, _memory):
    """Euler's method: what any master does that only sets, steps and gets."""
    speeds = speeds + step * accelerations(forces, now)
    return speeds, contact.forces(speeds, step)


def linearly_implicit(contact, speeds, forces, now, step, _memory):
    """Rosenbrock's method of one stage, by fmi2GetDirectionalDerivative: the implicit step, linearised.

    v' = v + h f(v') with f(v') = f(v) + F (v' - v), so (1 - h F) (v' - v) = h f(v): one small linear system a step,
    nothing repeated. The torque is that at the end of the step, as in the other implicit master.
    """
    system = np.eye(2) - step * contact.jacobian() / MASSES[:, None]
    speeds = speeds + np.linalg.solve(system, step * accelerations(forces, now + step))
    return speeds, contact.forces(speeds, step)


def iterating(contact, speeds, forces, now, step, memory):
    """Implicit Euler's method, by fmi2GetFMUstate and fmi2SetFMUstate: repeats the step until both sides agree.

    Finds v' with r(v') = v' - v - h f(v') = 0 by Broyden's method: the slope is learnt from the repetitions, at first
    and after ten without success from one repetition per speed. A change that makes r larger is halved.
    """
    saved = contact.save()

    def residual(guess):
        contact.restore(saved)
        memory["count"] = memory.get("count", 0) + 1
        answer = contact.forces(guess, step)
        return guess - speeds - step * accelerations(answer, now + step), answer

    guess = speeds + memory.get("last", np.zeros(2))
    left, answer = residual(guess)
    for repetition in range(60):
        if "slope" not in memory or repetition % 10 == 9:
            changes = 1e-6 * np.eye(2)
            memory["slope"] = np.column_stack([(residual(guess + change)[0] - left) / 1e-6 for change in changes])
        change = -np.linalg.solve(memory["slope"], left)
        after, answer = residual(guess + change)
        for _ in range(10):
            if np.abs(after).max() <= 2.0 * np.abs(left).max() + TOLERANCE:
                break
            change *= 0.5
            after, answer = residual(guess + change)
        memory["slope"] += np.outer(after - left - memory["slope"] @ change, change) / (change @ change)
        guess, left = guess + change, after
        if np.abs(change).max() < TOLERANCE:
            break
    else:
        raise RuntimeError(f"no agreement at {now:g} s: {change}")
    contact.forget(saved)
    memory["last"] = guess - speeds
    return guess, answer


TOLERANCE = 1e-9  # rad/s and m/s: some 10 mN at the steepest
MASTERS = {"explicit": explicit, "linearly implicit": linearly_implicit, "iterating": iterating}


def run(master, step):
    """One master at one step: time, speeds, forces, and what it cost."""
    contact = Contact()
    speeds, forces = contact.speeds, contact.initial
    rows, memory = [(0.0, *speeds, *forces)], {}
    began = time.process_time()
    for number in range(round(STOP / step)):
        speeds, forces = MASTERS[master](contact, speeds, forces, number * step, step, memory)
        rows.append(((number + 1) * step, *speeds, *forces))
    spent = time.process_time() - began
    contact.close()
    table = np.array(rows, dtype=object).astype(float)
    names = ("time", *SPEEDS, *NAMES)
    return {name: table[:, column] for column, name in enumerate(names)} | {
        "spent": spent,
        "repetitions": memory.get("count", 0) / round(STOP / step),
    }


def error(result, reference):
    """Largest error of the traction force, relative to its largest value."""
    there = np.interp(result["time"], reference["time"], reference["traction_force"])
    return float(np.abs(result["traction_force"] - there).max() / np.abs(reference["traction_force"]).max())


def time_constant():
    """Time constant of the wheel on the rail at the start: inertia over the slope of the torque."""
    contact = Contact()
    slope = contact.jacobian()[0, 0]
    contact.close()
    return -WHEEL_INERTIA / slope


# ---- error and cost against step ------------------------------------------------------------------------------------

LOOK = {"explicit": (BLUE, "o"), "linearly implicit": (ORANGE, "s"), "iterating": (RED, "D")}


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


def draw(reference, examples, rows, limit):
    """Draw the traction force of each master, error against step and error against time spent."""
    figure = plt.figure(figsize=(10.5, 7.4), layout="constrained")
    top, bottom = figure.subfigures(2, 1, height_ratios=[1.05, 1])
    panels = top.subplots(1, 3, sharey=True, sharex=True)
    for axes, (master, step, result) in zip(panels, examples, strict=True):
        axes.plot(reference["time"], reference["traction_force"] / 1e3, color=BLACK, linewidth=2.6, alpha=0.3)
        colour, mark = LOOK[master]
        few = "" if len(result["time"]) > 500 else mark
        width = 0.5 if master == "explicit" else 1.2
        axes.plot(
            result["time"], result["traction_force"] / 1e3, color=colour, marker=few, markersize=2, linewidth=width
        )
        axes.set(title=f"{master}, {1e3 * step:g} ms: {step / limit:.2g} × limit", xlabel="time [s]", xlim=(0, STOP))
    panels[0].set_ylabel("traction force [kN]")
    panels[0].set_xticks([0, 0.1, 0.2, 0.3, 0.4])
    panels[2].plot([], [], color=BLACK, linewidth=2.6, alpha=0.3, label=f"explicit, {1e6 * REFERENCE_STEP:g} µs")
    panels[2].legend(loc="lower left")

    against_step, against_cost = bottom.subplots(1, 2, sharey=True, width_ratios=[1.25, 1])
    for master, (colour, mark) in LOOK.items():
        its = [(step, value, spent) for name, step, value, spent, _ in rows if name == master]
        steps, values, spent = np.array(its).T
        against_step.loglog(1e3 * steps, values, color=colour, marker=mark, markersize=5, label=master)
        good = values < 0.1
        against_cost.loglog(spent[good] / STOP, values[good], color=colour, marker=mark, markersize=5)
    against_step.axvline(1e3 * limit, color="#777777", linestyle=":")
    against_step.annotate(
        "explicit limit, 2 τ", (1.1e3 * limit, 1e-6), rotation=90, va="bottom", color="#777777", fontsize=8
    )
    against_step.axvspan(20e3 * limit, 6, color="#eef5ee", zorder=0)
    against_step.annotate("over 20 × the limit", (22e3 * limit, 2.0), va="top", color="#557755", fontsize=8)
    against_step.set(xlabel="communication step [ms]", ylabel="error of the traction force /\nits largest value [1]")
    against_step.set(xlim=(8e-3, 6), ylim=(5e-7, 4))
    against_step.set_xticks([0.01, 0.1, 1], ["0.01", "0.1", "1"])
    against_step.legend(loc="upper left")
    against_cost.set(xlabel="processor time per second simulated [s/s]")
    against_cost.set_title("What an accuracy costs (stable steps)")
    against_step.set_title("Error against step")
    save(figure, "stiff.png")


def main():
    """Measure, draw, write, report."""
    limit = 2.0 * time_constant()
    print(f"  time constant at {SPEED:g} m/s: {0.5e6 * limit:.1f} µs; explicit limit {1e6 * limit:.1f} µs")
    reference = run("explicit", REFERENCE_STEP)
    rows = measure(reference)
    for master, step, value, spent, repetitions in rows:
        print(
            f"  {master:17s} {1e3 * step:7.4f} ms = {step / limit:5.2f} x limit: error {value:8.1e},"
            f" {spent / STOP:6.2f} s per second, {repetitions:.1f} repetitions a step"
        )
    shown = (
        ("explicit", EXPLICIT_STEPS[6]),
        ("linearly implicit", IMPLICIT_STEPS[-2]),
        ("iterating", IMPLICIT_STEPS[-2]),
    )
    draw(reference, [(master, step, run(master, step)) for master, step in shown], rows, limit)
    names = {"explicit": 0, "linearly implicit": 1, "iterating": 2}
    columns = list(zip(*((names[master], *rest) for master, *rest in rows), strict=True))
    head = [f"master ({', '.join(f'{number} {name}' for name, number in names.items())})", "step [s]", "error [1]"]
    write_csv("stiff.csv", dict(zip([*head, "processor time [s]", "repetitions per step [1]"], columns, strict=True)))


if __name__ == "__main__":
    main()
