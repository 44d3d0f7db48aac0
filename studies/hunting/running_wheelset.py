"""A wheelset with conical treads on straight track between two patches: kinematics, suspension, and a master.

The state is z = (y, ψ, dy/dt, dψ/dt, ω): lateral displacement to the left, yaw anticlockwise seen from above, angular
speed of the axle. A frame that runs at V(t) holds the wheelset by springs and dampers, sideways and in yaw. Each wheel
is an instance of the component, with contact_model 2: the patch. For the left wheel with the upper sign, the right one
with the lower, small angles:

    rolling radius     r = r₀ ± λ y                λ: conicity of the treads
    wheel_speed        ω r/r₀                      the component's wheel has the radius r₀
    vehicle_speed      V ∓ b₀ dψ/dt                b₀: half the distance of the contacts
    lateral_speed      dy/dt − V ψ
    spin_rate          dψ/dt ∓ λ ω                 the cone's axis is not parallel to the contact

So the creepages are ξ = ±λ y/r₀ ± b₀ (dψ/dt)/V + (ω r₀ − V)/V, η = (dy/dt)/V − ψ, φ = (dψ/dt)/V ∓ λ/r₀. These speeds
are u(z, V), and the forces F = (torque, traction, lateral force, spin moment) of a wheel act on the wheelset as
(∂u/∂(dz/dt))ᵀ F, so that no power is lost on the way.

The cones stand on the rails with the load's lateral part. The axle rolls by λ y/b₀, and 2 N λ/b₀ pushes back to the
middle; it yaws, and 2 N λ b₀ turns it further. A flange is a spring beyond a clearance, the rail's sideways; what rubs
at it is left out. So are: shift of load between the wheels (hunting.py prints how large it would be), the roll of the
axle in the lateral speed (a share λ r₀/b₀ of it), gyroscopic torques, and the contact's movement on the rail. The
component's window is fixed to the contact's centre: as the wheelset moves to the left by y, the contact moves on the
treads by y to the right, towards the flange of the left wheel.
"""

import numpy as np
from helpers import FMU, WHEEL_RADIUS, Instance, show

MASS, YAW_INERTIA, SPIN_INERTIA = 1500.0, 900.0, 100.0  # kg, kg.m2, kg.m2
INERTIAS = np.array([MASS, YAW_INERTIA, SPIN_INERTIA])
HALF_GAUGE = 0.75  # m
CONICITY = 0.1  # 1: of worn cones; 0.05 when new
LOAD = 70e3  # N, on a wheel
# Of the suspension, sideways [N/m], [N.s/m], and in yaw [N.m/rad], [N.m.s/rad].
STIFFNESS, DAMPING = (3e5, 2.5e6), (1e4, 1e4)
CLEARANCE, FLANGE_STIFFNESS = 8e-3, 1.5e7  # m, N/m: of a flange to its rail, and of the rail sideways
STEP = 1e-3  # s
SLOPES_EVERY = 10  # steps with the same derivatives of the contacts
SIDES = {"left": 1.0, "right": -1.0}
INPUTS = ("wheel_speed", "vehicle_speed", "lateral_speed", "spin_rate")
FORCES = ("friction_torque", "traction_force", "lateral_force", "spin_moment")
OTHERS = ("peak_temperature", "friction_power", "friction_energy")
STRIPS = 21
CONTACT = {"contact_model": 2, "slip_source": 2, "normal_load": LOAD}


# ---- kinematics, the suspension, the linear model --------------------------------------------------------------------


def motion(side, state, speed):
    """What a wheel's contact sees: (wheel speed, vehicle speed, lateral speed, spin rate)."""
    y, yaw, y_rate, yaw_rate, spin = state
    radius = WHEEL_RADIUS + side * CONICITY * y
    return np.array(
        [
            spin * radius / WHEEL_RADIUS,
            speed - side * HALF_GAUGE * yaw_rate,
            y_rate - speed * yaw,
            yaw_rate - side * CONICITY * spin,
        ]
    )


def motion_slopes(side, state, speed):
    """Derivatives of the motion with respect to the state; those of (dy/dt, dψ/dt, ω) carry forces back."""
    y, _, _, _, spin = state
    cone = side * CONICITY
    return np.array(
        [
            [cone * spin / WHEEL_RADIUS, 0.0, 0.0, 0.0, 1.0 + cone * y / WHEEL_RADIUS],
            [0.0, 0.0, 0.0, -side * HALF_GAUGE, 0.0],
            [0.0, -speed, 1.0, 0.0, 0.0],
            [0.0, 0.0, 0.0, 1.0, -cone],
        ]
    )


class Suspension:
    """Forces on the wheelset that are not the patches': springs, dampers, the load on the cones, the flanges."""

    def __init__(self, stiffness=STIFFNESS, damping=DAMPING):
        """Stiffness of all that is conservative, damping, each sideways and in yaw."""
        cones = 2.0 * LOAD * CONICITY * np.array([1.0 / HALF_GAUGE, -HALF_GAUGE])
        self.stiffness, self.damping = np.asarray(stiffness) + cones, np.asarray(damping)

    @staticmethod
    def flange(y):
        """How far a flange pushes its rail aside, to the left or to the right [m]."""
        return np.sign(y) * np.maximum(np.abs(y) - CLEARANCE, 0.0)

    def forces(self, state):
        """Force sideways, torque in yaw, torque about the axle."""
        forces = np.zeros(3)
        forces[:2] = -self.stiffness * state[:2] - self.damping * state[2:4]
        forces[0] -= FLANGE_STIFFNESS * self.flange(state[0])
        return forces

    def slopes(self, state):
        """Derivatives of the forces with respect to the state."""
        slopes = np.zeros((3, 5))
        slopes[[0, 1], [0, 1]], slopes[[0, 1], [2, 3]] = -self.stiffness, -self.damping
        slopes[0, 0] -= FLANGE_STIFFNESS * (abs(state[0]) > CLEARANCE)
        return slopes

    def energy(self, state):
        """In the springs, in the load that is lifted, and in a rail that is pushed aside [J]."""
        return 0.5 * (state[..., :2] ** 2 @ self.stiffness + FLANGE_STIFFNESS * self.flange(state[..., 0]) ** 2)


FREE = Suspension((0.0, 0.0), (0.0, 0.0))


def system(state, speed, slopes, suspension):
    """The matrix A of d(δz)/dt = A δz for given derivatives of the contacts' forces, one 4 × 4 matrix a side."""
    forces = suspension.slopes(state)
    for side, slope in zip(SIDES.values(), slopes, strict=True):
        kinematics = motion_slopes(side, state, speed)
        forces += kinematics[:, 2:].T @ slope @ kinematics
    matrix = np.zeros((5, 5))
    matrix[[0, 1], [2, 3]] = 1.0
    matrix[2:] = forces / INERTIAS[:, None]
    return matrix


def running(speed):
    """The state of a wheelset that runs straight, in the middle."""
    return np.array([0.0, 0.0, 0.0, 0.0, speed / WHEEL_RADIUS])


# ---- wheels and master ----------------------------------------------------------------------------------------------


class Wheel(Instance):
    """A wheel: the component, its motion and its forces as vectors."""

    def __init__(self, side, state, speed, **parameters):
        """Start with a given motion."""
        self.side = side
        self.motion = motion(side, state, speed)
        super().__init__(FMU, "wheel", **(CONTACT | parameters), **dict(zip(INPUTS, self.motion, strict=True)))
        self.start()
        self.forces = np.array(self.get(*FORCES))

    def roll(self, new_motion, step):
        """Step with a motion and return the forces at the end."""
        self.motion = new_motion
        self.set(**dict(zip(INPUTS, map(float, new_motion), strict=True)))
        self.step(step)
        self.forces = np.array(self.get(*FORCES))
        return self.forces

    def settle(self, step):
        """Run on as it runs, until nothing changes: what enters the contact leaves it within a step or two."""
        for _ in range(3):
            self.roll(self.motion, step)
        return self

    def slopes(self):
        """Derivatives of the forces of the last step with respect to its motion, a column for each speed."""
        return np.column_stack([self.derivative(FORCES, speed) for speed in INPUTS])

    def strips(self, name):
        """One of the profiles across the contact."""
        return np.array(self.get(*(f"strip.{name}[{number}]" for number in range(1, STRIPS + 1))))


class Wheelset:
    """The master: the wheelset's equations in a linearly implicit midpoint rule, with the contacts' derivatives."""

    COLUMNS = ("time", "speed", "place", "y", "yaw", "y_rate", "yaw_rate", "spin", *(
        f"{name}_{side}" for side in SIDES for name in (*FORCES, *OTHERS)
    ), "creep_work", "guide_work", "damper_work")  # fmt: skip

    def __init__(self, speed, y=0.0, suspension=None, **parameters):
        """At a lateral displacement, else as it runs straight."""
        self.suspension = suspension or Suspension()
        self.state = running(speed)
        self.state[0] = y
        self.time = self.place = 0.0
        self.wheels = [Wheel(side, self.state, speed, **parameters) for side in SIDES.values()]
        self.works, self.count = np.zeros(3), 0
        for wheel in self.wheels:
            wheel.settle(0.05)
        self.rows, self.profiles = [], []
        self.record(speed)

    def advance(self, speed, step):
        """One step: predict the middle implicitly, let the contacts step there, and balance with their forces.

        z' = z + h g(z_m) with z_m = z + (1 - h A/2)⁻¹ h g(z)/2, in which the contacts' forces are linear about those
        of the step before. The forces of the balance are the contacts' own, at z_m: of second order, and stable
        however stiff the creep is at low speed.
        """
        if self.count % SLOPES_EVERY == 0:
            self.slopes = [wheel.slopes() for wheel in self.wheels]
        self.count += 1
        state = self.state
        acting = self.suspension.forces(state)
        for wheel, slope in zip(self.wheels, self.slopes, strict=True):
            there = wheel.forces + slope @ (motion(wheel.side, state, speed) - wheel.motion)
            acting += motion_slopes(wheel.side, state, speed)[:, 2:].T @ there
        rate = np.concatenate([state[2:4], acting / INERTIAS])
        matrix = system(state, speed, self.slopes, self.suspension)
        middle = state + np.linalg.solve(np.eye(5) - 0.5 * step * matrix, 0.5 * step * rate)

        acting = self.suspension.forces(middle)
        creep = guide = 0.0
        for wheel in self.wheels:
            forces = wheel.roll(motion(wheel.side, middle, speed), step)
            acting += motion_slopes(wheel.side, middle, speed)[:, 2:].T @ forces
            creep -= forces @ wheel.motion
            # What the frame pulls along the track: against the traction, and the lateral force of a yawed wheel.
            guide -= speed * (forces[1] - middle[1] * forces[2])
        after = state.copy()
        after[2:] += step * acting / INERTIAS
        after[:2] += step * 0.5 * (state[2:4] + after[2:4])
        mean = 0.5 * (state + after)
        self.works += step * np.array([creep, guide, mean[2:4] ** 2 @ self.suspension.damping])
        self.state = after
        self.time += step
        self.place += step * speed

    def record(self, speed):
        """Put where it is into the table."""
        answers = [value for wheel in self.wheels for value in (*wheel.forces, *wheel.get(*OTHERS))]
        self.rows.append((self.time, speed, self.place, *self.state, *answers, *self.works))

    def record_strips(self):
        """Put the profiles across both contacts into a list: temperature and the wear that a passage leaves."""
        profiles = [[wheel.strips(name) for name in ("position", "temperature", "wear_depth")] for wheel in self.wheels]
        self.profiles.append((len(self.rows) - 1, profiles))

    def run(self, stop, speed, step=STEP, strips_every=0, title=None):
        """Go on to a time, at a speed or at speed(time); return the table so far, a row per step."""
        speed_at = speed if callable(speed) else lambda _: speed
        for number in range(1, round((stop - self.time) / step) + 1):
            now = speed_at(self.time + 0.5 * step)
            self.advance(now, step)
            self.record(now)
            if strips_every and number % strips_every == 0:
                self.record_strips()
            if title and number % 200 == 0:
                show(min(self.time / stop, 1.0), title)
        return np.array(self.rows, dtype=[(name, float) for name in self.COLUMNS])

    def energy(self, result):
        """Kinetic energy, the springs' and that of the lifted load, per row [J]."""
        state = np.column_stack([result[name] for name in ("y", "yaw", "y_rate", "yaw_rate", "spin")])
        return 0.5 * state[:, 2:] ** 2 @ INERTIAS + self.suspension.energy(state)

    def close(self):
        """Free both wheels."""
        for wheel in self.wheels:
            wheel.close()
