"""A wheel whose height is the master's: the contact's stiffness, and the largest stable step of four masters.

    .venv/bin/python studies height             (after `make fmu`; or `make coupling-height`)

With `control` height the unit takes the wheelset's height and gives the force: towards the master it is a spring, some
1e9 N/m stiff, on which half a wheelset bounces at 130 to 200 Hz. How long a step may be then is not a matter of the
unit, which takes any, but of how the master exchanges height and force. For each way the linear sampled system says for
which steps a bounce dies away; beside it stands what is found with the unit. docs/couplings/height.md.
"""

from dataclasses import dataclass

import numpy as np
from helpers import BLACK, BLUE, FMU, GREEN, ORANGE, RED, WHEEL_RADIUS, Instance, markdown_table, save, write_tables
from matplotlib import pyplot as plt
from scipy.linalg import expm

SPEED = 20.0  # m/s
LATERAL = 3e-3  # m: on the tread, where the contact is of one piece
LOADS = (10e3, 30e3, 60e3, 100e3)  # N
LOAD = 60e3
HALF_MASS = 0.5 * 1813.0  # kg: half a wheelset
RATIOS = (0.01, 0.05, 0.2)  # of a damper to critical damping
RAIL_MASS, RAIL_STIFFNESS, RAIL_DAMPING = 300.0, 7.0e7, 1.5e5  # kg, N/m, N.s/m
START = 1e-7  # m: of the bounce, so small that the contact is linear
MANY = 100  # steps in which it grows or dies away
SHORT = 2e-5  # s
GROWTH_STEPS = (5e-5, 1e-4, 2e-4, 4e-4)  # s
PARAMETERS = {"contact_model": "profiles", "slip_source": "vehicle_speed", "control": "height", "largest_load": 150e3}


# ---- the unit -------------------------------------------------------------------------------------------------------


class Wheel(Instance):
    """A left wheel that rolls, at a height over its rail."""

    def __init__(self):
        """Above the rail."""
        super().__init__(FMU, "wheel", **PARAMETERS)
        self.set(lateral_displacement=LATERAL, vertical_displacement=0.01)
        self.set(vehicle_speed=SPEED, wheel_speed=SPEED / WHEEL_RADIUS)
        self.start()

    def force(self, height, step, speed=0.0, rail=(0.0, 0.0)):
        """Vertical force after a step at a height and a speed of the wheelset and of the rail."""
        self.set(vertical_displacement=float(height), vertical_speed=float(speed))
        self.set(rail_vertical_displacement=float(rail[0]), rail_vertical_speed=float(rail[1]))
        self.step(step)
        return self.get("force_z")[0]

    def stiffness(self):
        """What the unit says of its stiffness after its last step [N/m]."""
        return -self.derivative(["force_z"], "vertical_displacement")[0]

    def height_of(self, load, step=0.1):
        """Height at which the wheel carries a load: Newton's method with the stiffness, from the first touch on."""
        height = 1e-3
        while self.force(height, step) < 1e3:
            height -= 1e-5
        for _ in range(20):
            missing = load - self.force(height, step)
            if abs(missing) < 1e-6 * load:
                return height
            height -= missing / self.stiffness()
        raise RuntimeError(f"no height for {load:g} N")


def stiffnesses():
    """Rows of load, height, approach, stiffness by derivative and difference, and 3/2 of the load over the approach."""
    wheel, rows = Wheel(), []
    for load in LOADS:
        height = wheel.height_of(load)
        said, approach = wheel.stiffness(), wheel.get("penetration")[0]
        change = 1e-7
        forces = [wheel.force(height + sign * change, 0.1) for sign in (1.0, -1.0)]
        rows.append((load, height, approach, said, (forces[1] - forces[0]) / (2.0 * change), 1.5 * load / approach))
    wheel.close()
    return rows


# ---- bodies ---------------------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Bodies:
    """What the contact's force acts on, dx/dt = A x + B f, and the approach's change that it makes, C x."""

    name: str
    matrix: np.ndarray
    force: np.ndarray
    over: np.ndarray

    def rail(self, state):
        """Height and speed of the rail."""
        return state[2:] if len(state) == 4 else np.zeros(2)


def free(name, damping=0.0):
    """Half a wheelset on a rail that stays, with a damper beside the contact: x = (height, speed)."""
    return Bodies(
        name,
        np.array([[0.0, 1.0], [0.0, -damping / HALF_MASS]]),
        np.array([0.0, 1.0 / HALF_MASS]),
        np.array([1.0, 0.0]),
    )


def yielding():
    """Half a wheelset on a rail that yields: x = (height, speed, height and speed of the rail)."""
    matrix = np.zeros((4, 4))
    matrix[[0, 2], [1, 3]] = 1.0
    matrix[3, 2:] = -RAIL_STIFFNESS / RAIL_MASS, -RAIL_DAMPING / RAIL_MASS
    force = np.array([0.0, 1.0 / HALF_MASS, 0.0, -1.0 / RAIL_MASS])
    return Bodies("rail that yields", matrix, force, np.array([1.0, 0.0, -1.0, 0.0]))


def cases(stiffness):
    """All bodies of the table."""
    critical = 2.0 * np.sqrt(stiffness * HALF_MASS)
    damped = [free(f"damper, {ratio:g} of critical", ratio * critical) for ratio in RATIOS]
    return [free("no damper"), *damped, yielding()]


# ---- masters: one step of the bodies, from their state, the forces of this step and of the one before ---------------


def held(bodies, step, _stiffness):
    """The bodies, exactly, with the force of their height at the beginning."""
    size = len(bodies.force)
    block = np.zeros((size + 1, size + 1))
    block[:size, :size], block[:size, size] = bodies.matrix, bodies.force
    block = expm(step * block)
    return lambda state, now, _before: block[:size, :size] @ state + block[:size, size] * now


def side_by_side(bodies, step, _stiffness):
    """The bodies, exactly, with the force that the unit had at the end of its step before, as both step at once."""
    one = held(bodies, step, 0.0)
    return lambda state, _now, before: one(state, before, 0.0)


def speed_first(bodies, step, _stiffness):
    """Symplectic Euler: new speeds by the force, new heights by the new speeds."""

    def advance(state, now, _before):
        state = state.copy()
        rates = bodies.matrix @ state + bodies.force * now
        state[1::2] += step * rates[1::2]
        state[::2] += step * state[1::2]
        return state

    return advance


def implicit(bodies, step, stiffness):
    """Implicit Euler with the force and its derivative: f + df/dz (z' - z)."""
    size = len(bodies.force)
    spring = stiffness * np.outer(bodies.force, bodies.over)
    inverse = np.linalg.inv(np.eye(size) - step * (bodies.matrix - spring))
    return lambda state, now, _before: inverse @ (state + step * (bodies.force * now + spring @ state))


MASTERS = {
    "both at once": side_by_side,
    "force held": held,
    "speed first": speed_first,
    "with the derivative": implicit,
}
LONGEST = 20e-3  # s: what is stable at that is called stable


def growth(master, bodies, step, stiffness):
    """Growth per step by theory: the spectral radius of the sampled system, the contact being a spring."""
    advance = master(bodies, step, stiffness)
    size = len(bodies.force)
    columns = []
    for unit in np.eye(size + 1):
        state, before = unit[:size], unit[size]
        now = -stiffness * bodies.over @ state
        columns.append([*advance(state, now, before), now])
    # The force of the step before is scaled to a length.
    matrix = np.array(columns).T
    matrix[size, :], matrix[:, size] = matrix[size, :] / stiffness, matrix[:, size] * stiffness
    return np.abs(np.linalg.eigvals(matrix)).max()


def measured_growth(wheel, height, first, master, bodies, step, stiffness, told=1.0):
    """Growth per step of a small bounce with the unit: of the linear map that fits its steps by least squares.

    The unit is told the bounce's speed as well, or a share of it.
    """
    advance = master(bodies, step, stiffness)
    size = len(bodies.force)
    # Heights, speeds and the force, all as lengths.
    scale = np.array([1.0, frequency(stiffness)] * (size // 2) + [stiffness]) * START
    state = np.zeros(size)
    state[0] = START
    wheel.restore(first)
    base = wheel.force(height, step)
    before, rows = 0.0, []
    for _ in range(MANY):
        rows.append(np.array([*state, before]) / scale)
        if not 1e-2 < np.abs(rows[-1]).max() < 1e3 and len(rows) > 4 * size:
            break
        now = wheel.force(height + state[0], step, told * state[1], bodies.rail(state)) - base
        state, before = advance(state, now, before), now
    rows = np.array(rows)
    # The size of a step's state is no weight: early and late ones say as much of the map.
    weight = 1.0 / np.linalg.norm(rows[:-1], axis=1)[:, None]
    matrix, *_ = np.linalg.lstsq(weight * rows[:-1], weight * rows[1:], rcond=1e-7)
    return np.abs(np.linalg.eigvals(matrix)).max()


def frequency(stiffness):
    """Angular frequency of half a wheelset on its contact [rad/s]."""
    return np.sqrt(stiffness / HALF_MASS)


def limit(function, stiffness, low=2e-6, high=LONGEST, parts=9):
    """Largest step that a growth allows: 0 where the shortest one grows, infinite where the longest one does not.

    What grows by less than 1e-4 of itself in a radian does not: without a damper nothing should decay either.
    """

    def stays(step):
        return function(step) <= 1.0 + 1e-4 * min(step * frequency(stiffness), 1.0)

    if stays(high):
        return np.inf
    if not stays(low):
        return 0.0
    for _ in range(parts):
        middle = np.sqrt(low * high)
        low, high = (middle, high) if stays(middle) else (low, middle)
    return np.sqrt(low * high)


def limits(found):
    """Limits of all bodies and masters: by theory, measured about it."""
    wheel = Wheel()
    height = wheel.height_of(LOAD)
    stiffness, first = wheel.stiffness(), wheel.save()
    rows = []
    for bodies in cases(stiffness):
        for name, master in MASTERS.items():
            theory = limit(lambda step: growth(master, bodies, step, stiffness), stiffness, parts=40)  # noqa: B023

            def grown(step, master=master, bodies=bodies):
                return measured_growth(wheel, height, first, master, bodies, step, stiffness)

            if theory == 0.0:
                seen = 0.0 if grown(SHORT) > 1.0 else np.nan
            elif np.isinf(theory):
                seen = np.inf if grown(LONGEST) <= 1.0 else np.nan
            else:
                seen = limit(grown, stiffness, 0.7 * theory, 1.4 * theory, 6)
            rows.append((bodies, name, theory, seen))
    found["growth"] = growths(wheel, height, first, stiffness)
    wheel.close()
    return found | {"stiffness": stiffness, "limits": rows}


def growths(wheel, height, first, stiffness):
    """Of a bounce without a damper, by theory and measured: step, growth in a second, with and without the speed."""
    rows = []
    bodies = free("no damper")
    for step in GROWTH_STEPS:
        theory = growth(held, bodies, step, stiffness)
        seen = [measured_growth(wheel, height, first, held, bodies, step, stiffness, told) for told in (1.0, 0.0)]
        rows.append((step, *(np.log(value) / step for value in (theory, *seen))))
    return rows


# ---- tables and picture ---------------------------------------------------------------------------------------------


def milliseconds(step):
    """A limit in words."""
    return {0.0: "none", np.inf: "any"}.get(step, f"{1e3 * step:.3g} ms")


def tables(found):
    """The tables of the page."""
    lines = [
        [f"{load / 1e3:g} kN", f"{1e6 * approach:.1f} µm", *(f"{value / 1e9:.4f}" for value in values)]
        for load, _, approach, *values in found["rows"]
    ]
    head = ["load", "approach", "by the derivative [GN/m]", "by a difference", "3/2 of load over approach"]
    made = {"stiffness": markdown_table(head, lines)}
    lines = []
    for name in dict.fromkeys(bodies.name for bodies, *_ in found["limits"]):
        row = [name]
        for bodies, _, theory, seen in found["limits"]:
            if bodies.name == name:
                row.append(milliseconds(theory) if theory == seen else " / ".join(map(milliseconds, (theory, seen))))
        lines.append(row)
    made["limits"] = markdown_table(["theory / measured", *MASTERS], lines)
    lines = [[f"{1e3 * step:g} ms", *(f"{value:.1f} 1/s" for value in values)] for step, *values in found["growth"]]
    made["growth"] = markdown_table(["step", "theory", "measured", "measured, vertical_speed left at 0"], lines)
    return made


def draw(found):
    """Draw the limits of the masters over the damper's ratio, theory and what was measured."""
    figure, axes = plt.subplots(figsize=(7.6, 4.2), layout="constrained")
    stiffness = found["stiffness"]
    ratios = np.geomspace(0.005, 0.5, 40)
    critical = 2.0 * np.sqrt(stiffness * HALF_MASS)
    for (name, master), colour in zip(MASTERS.items(), (ORANGE, RED, BLUE, GREEN), strict=True):
        if name == "with the derivative":
            continue
        theory = [
            limit(lambda step: growth(master, free("", ratio * critical), step, stiffness), stiffness, parts=30)  # noqa: B023
            for ratio in ratios
        ]
        axes.loglog(ratios, 1e3 * np.array(theory), color=colour, label=name)
        seen = [row[3] for row in found["limits"] if row[1] == name and row[0].name.startswith("damper")]
        axes.loglog(RATIOS, 1e3 * np.array(seen), "o", color=colour, markersize=6)
    axes.axhline(2e3 / frequency(stiffness), color=BLACK, linewidth=0.8, linestyle=":", label="2/ω")
    axes.plot([], [], "o", color=BLACK, label="measured")
    axes.set(xlabel="damping of the bounce, share of critical", ylabel="largest stable step [ms]", ylim=(5e-3, 5))
    axes.set_title(f"Half a wheelset on its contact, {frequency(stiffness) / 2 / np.pi:.0f} Hz under {LOAD / 1e3:g} kN")
    axes.legend(loc="lower right", ncols=2)
    axes.grid(visible=True, which="both", alpha=0.25)
    save(figure, "height.png")


def check(found):
    """Stiffness to 0.3 % of the difference, limits to 5 % of the sampled system's: a twentieth of a bisection's range.

    At 1 % of critical damping the limit hangs on a growth of 1e-5 in a step, and friction in the contact takes or gives
    as much: to 20 %.
    """
    for load, *_, said, difference, _ in found["rows"]:
        if abs(said / difference - 1.0) > 3e-3:
            raise AssertionError(
                f"stiffness under {load:g} N: {said:g} by the derivative, {difference:g} by difference"
            )
    for bodies, name, theory, seen in found["limits"]:
        most = 0.2 if "0.01" in bodies.name else 0.05
        if not (seen == theory or abs(seen / theory - 1.0) < most):
            raise AssertionError(f"{bodies.name}, {name}: largest step {theory:g} s by theory, {seen:g} s measured")


def main():
    """Measure, draw, write, check."""
    found = limits({"rows": stiffnesses()})
    write_tables("height.md", tables(found))
    draw(found)
    check(found)


if __name__ == "__main__":
    main()
