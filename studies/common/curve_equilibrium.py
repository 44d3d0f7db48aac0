"""Steady curving by Newton's method: where a bogie stands that runs through a curve at a constant speed.

All bodies turn with V κ about the curve's middle. Unknown are their places, the wheels' angular speeds, the rails'
displacements and the pull that holds the speed: as many as there are equations,

    forces on a body = m V κ (ẑ × v)      moments about its centre = V κ (ẑ × H)      forces on a rail = 0

A wheelset may be driven or braked, by a torque about its axle that the frame takes up; the pull at the body holds the
speed then too, as the rest of the train does.

The contacts' forces are those of the units, after steps so long that nothing is left of what was before, and their
derivatives those of the units by fmi2GetDirectionalDerivative. The suspension's are differences: it costs nothing. No
line of this is shared with the bodies in Exudyn, but for the kinematics of a wheelset on its track and the data.
"""

import numpy as np
from curve_track import motion, turning
from curve_vehicle import (
    AXLES,
    BODY,
    FRAME,
    GRAVITY,
    OF_WHEEL,
    SHOWN,
    SIDES,
    SPEED,
    VEHICLE,
    Wheel,
    guidance,
    over_rail,
    springs,
    standing,
    turn,
)

LONG, SETTLING = 0.5, 3  # s, steps: the rail has passed through the windows many times
# Of a coordinate: a difference to differentiate by, and the largest change in an iteration.
DIFFERENCE = 1e-6
MOST = np.array([5e-3, 4e-4, 5e-5, 3e-4, 1e-3, 5e-2])  # of a wheelset: m and rad; the last rad/s
UNKNOWN_BODIES = 4 * 6
RAILS = 8  # two displacements of each of four rails
PULL = BODY * 6  # the body's place along the track is given; in its stead stands the pull
PULL_UNIT = 1e4  # N


def cross(a, b):
    """Vector product of vectors or of rows, in a tenth of the time of numpy's on so few."""
    a, b = np.asarray(a).T, np.asarray(b).T
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]).T


class Equilibrium:
    """Unknowns, residual and Newton's method, at a place of a track whose curvature is constant around it."""

    def __init__(self, track, place, speed=SPEED, vehicle=VEHICLE, **parameters):
        """Units of four wheels, and bodies that stand as on straight track."""
        self.track, self.place, self.speed, self.vehicle = track, place, speed, vehicle
        self.springs, self.mass, self.inertia = springs(vehicle), vehicle.mass, vehicle.inertia
        self.wheels = self.made_wheels(**parameters)
        x, y, self.heading, self.curvature, _ = track.at(place)
        self.middle = np.array([x, y, 0.0])
        self.turning = np.array([0.0, 0.0, speed * self.curvature])
        self.base = standing(track, place, vehicle)
        # Displacements of each rail across and up, [axle][side], which the track has under this wheel.
        self.uneven = np.zeros((2, 2, 2))
        # Force along the track that the torque of a wheelset makes, the same for both [N]: positive drives.
        self.traction = 0.0
        # Bodies' displacements, with the wheels' speeds in place of their turns; rails.
        self.unknown = np.zeros(UNKNOWN_BODIES + RAILS)
        for axle in range(len(AXLES)):
            self.unknown[6 * axle + 5] = speed / vehicle.wheel_radius

    def made_wheels(self, **parameters):
        """Units of the wheels, [axle][side]."""
        return [[Wheel(side, **parameters) for side in SIDES] for _ in AXLES]

    def start_from(self, other):
        """Take over another equilibrium's unknowns, those of a curve that is much the same."""
        self.unknown = other.unknown.copy()
        return self

    # ---- equations ---------------------------------------------------------------------------------------------------

    def velocity(self, points):
        """Velocity of what turns with the curve."""
        forward = self.speed * np.array([np.cos(self.heading), np.sin(self.heading), 0.0])
        return forward + cross(self.turning, points - self.middle)

    def bodies(self, unknown):
        """Coordinates of all bodies, and the wheels' speeds."""
        coordinates = self.base + unknown[:UNKNOWN_BODIES].reshape(4, 6)
        spins = unknown[[5, 11]]
        coordinates[:2, 5] = 0.0
        coordinates[BODY, 0] = self.base[BODY, 0]
        return coordinates, spins

    def rates(self, coordinates):
        """Rates of a body's coordinates: what turns it is the curve."""
        return np.concatenate([self.velocity(coordinates[:3]), np.linalg.solve(turning(coordinates), self.turning)])

    def state(self):
        """Coordinates of all bodies and their rates, a row each."""
        coordinates, spins = self.bodies(self.unknown)
        rates = np.array([self.rates(row) for row in coordinates])
        rates[:2, 5] += spins
        return coordinates, rates

    def told(self, unknown):
        """What each wheel is told over its own rail: [axle][side]."""
        coordinates, spins = self.bodies(unknown)
        rails = unknown[UNKNOWN_BODIES:].reshape(2, 2, 2)
        told, self.motions = [], []
        for axle, spin in enumerate(spins):
            rates = self.rates(coordinates[axle])
            rates[5] += spin
            place = self.place + self.vehicle.along[axle]
            _, seen = motion(self.track, coordinates[axle], rates, place, self.vehicle.wheel_radius)
            self.motions.append(seen)
            pairs = zip(rails[axle], self.uneven[axle], strict=True)
            told.append([over_rail(seen, rail, (0.0, 0.0), uneven) for rail, uneven in pairs])
        return np.array(told)

    def residual(self, unknown, forces):
        """Forces and moments that are left, for given forces [axle][side] of the contacts in the track's axes."""
        coordinates, spins = self.bodies(unknown)
        rails = unknown[UNKNOWN_BODIES:].reshape(2, 2, 2)
        turns = [turn(row[3:]) for row in coordinates]
        force, moment = np.zeros((4, 3)), np.zeros((4, 3))
        force[:, 2] = -GRAVITY * self.mass
        for spring in self.springs:
            arms = [turns[spring.first] @ spring.at_first, turns[spring.second] @ spring.at_second]
            ends = [coordinates[body, :3] + arm for body, arm in zip((spring.first, spring.second), arms, strict=True)]
            velocities = [self.velocity(end) for end in ends]
            own = turns[spring.first].T
            pull = np.array(spring.stiffness) * (own @ (ends[1] - ends[0]))
            pull += np.array(spring.damping) * (own @ (velocities[1] - velocities[0]))
            pull[2] -= spring.carried
            pull = turns[spring.first] @ pull
            for body, arm, sign in zip((spring.first, spring.second), arms, (1.0, -1.0), strict=True):
                force[body] += sign * pull
                moment[body] += cross(arm, sign * pull)
        place = self.track.place_of(*coordinates[BODY, :2], self.place)
        moment[BODY] += guidance(self.track, turns[BODY], self.turning, self.speed, place, self.vehicle)
        forward = self.velocity(self.middle) / self.speed
        held = PULL_UNIT * unknown[PULL] * forward
        force[BODY] += held
        down = self.vehicle.secondary_height - self.vehicle.body_height
        moment[BODY] += cross(turns[BODY] @ [0.0, 0.0, down], held)
        for axle in range(2):
            where = self.track.place_of(*coordinates[axle, :2], self.place)
            _, axes = self.track.axes(where)
            both = forces[axle].sum(axis=0)
            force[axle] += axes @ both[:3]
            moment[axle] += axes @ both[3:]
            # Motor and gear, or a brake's callipers, hang on the frame.
            torque = self.traction * self.vehicle.wheel_radius * turns[axle][:, 2]
            moment[axle] += torque
            moment[FRAME] -= torque
        # What the curve takes.
        accelerations = cross(self.turning, self.velocity(coordinates[:, :3]))
        force -= self.mass[:, None] * accelerations
        for body in range(4):
            angular = self.turning.copy()
            if body < 2:
                angular = angular + spins[body] * turns[body][:, 2]
            momentum = turns[body] @ (self.inertia[body] * (turns[body].T @ angular))
            moment[body] -= cross(self.turning, momentum)
        on_rails = -forces[:, :, 1:3] - np.array(self.vehicle.rail_stiffness) * rails
        return np.concatenate([np.hstack([force, moment]).ravel(), on_rails.ravel()])

    # ---- Newton ------------------------------------------------------------------------------------------------------

    def contacts(self, slopes):
        """Forces of the units where everything stands, and their derivatives."""
        told = self.told(self.unknown)
        rails = self.unknown[UNKNOWN_BODIES:].reshape(2, 2, 2)
        forces, derivatives = np.zeros((2, 2, 6)), np.zeros((2, 2, 6, told.shape[-1]))
        for axle, pair in enumerate(self.wheels):
            for side, wheel in enumerate(pair):
                for _ in range(SETTLING):
                    rail, uneven = rails[axle, side], self.uneven[axle, side]
                    forces[axle, side] = wheel.roll(self.motions[axle], rail, (0, 0), uneven, LONG)
                if slopes:
                    derivatives[axle, side] = wheel.slopes()
        return told, forces, derivatives

    def differences(self, function):
        """Derivatives of a function of the unknowns, by differences."""
        columns = []
        for number in range(len(self.unknown)):
            change = np.zeros(len(self.unknown))
            change[number] = DIFFERENCE
            columns.append((function(self.unknown + change) - function(self.unknown - change)) / (2.0 * DIFFERENCE))
        return np.stack(columns, axis=-1)

    def parts(self, forces):
        """What derivatives by the unknowns are made of beside the contacts' own: see matrix()."""
        unit = np.eye(4 * 6).reshape(-1, 2, 2, 6)
        zero = self.residual(self.unknown, np.zeros((2, 2, 6)))
        through = np.stack([self.residual(self.unknown, one) - zero for one in unit], axis=-1)
        suspension = self.differences(lambda unknown: self.residual(unknown, forces))
        return suspension, through, self.differences(self.told)

    def matrix(self, derivatives, parts):
        """Derivatives of the residual: the suspension's, and what passes through forces that hang on what is told."""
        suspension, through, moved = parts
        of_forces = np.einsum("asfi,asiu->asfu", derivatives, moved)
        return suspension + through @ of_forces.reshape(4 * 6, -1)

    def solve(self, tolerance=1e-3, most=60, report=None):
        """Newton's method, with bounded changes, until no force or moment is above the tolerance [N], [N.m]."""
        self.history = []
        for _ in range(most):
            _, forces, derivatives = self.contacts(slopes=True)
            left = self.residual(self.unknown, forces)
            self.forces = forces
            self.history.append(np.abs(left).max())
            if report:
                report(self)
            if self.history[-1] < tolerance:
                return self
            matrix = self.matrix(derivatives, self.parts(forces))
            change = np.linalg.solve(matrix, -left)
            # Shorter where a wheelset would move far: derivatives hold where the contact stays the same.
            wheelsets = np.abs(change[:12].reshape(2, 6)) / MOST
            self.unknown = self.unknown + change / max(1.0, wheelsets.max())
        raise RuntimeError(f"Newton's method has not met {tolerance:g} N within {most} iterations: {self.history}")

    def table(self):
        """What the time integration has in its rows, by the same names."""
        row = {"pull": PULL_UNIT * self.unknown[PULL]}
        rails = self.unknown[UNKNOWN_BODIES:].reshape(2, 2, 2)
        for axle, (name, pair, seen) in enumerate(zip(AXLES, self.wheels, self.motions, strict=True)):
            row |= {f"{quantity}_{name}": seen[number] for number, quantity in enumerate(("y", "z", "roll", "yaw"))}
            for k, (side, wheel) in enumerate(zip(SIDES, pair, strict=True)):
                _, left, up, *_ = forces = self.forces[axle, k]
                values = [-SIDES[side] * left, up, forces[0], *rails[axle, k], 0.0, *wheel.get(*SHOWN)]
                row |= {f"{title}_{name}_{side}": value for title, value in zip(OF_WHEEL, values, strict=True)}
        return row

    def close(self):
        """Free all wheels."""
        for pair in self.wheels:
            for wheel in pair:
                wheel.close()


def straight_running(track, place, **parameters):
    """Equilibrium on straight track, from wheelsets that are sunk a little deeper than rails and contacts ask for."""
    found = Equilibrium(track, place, **parameters)
    for axle in range(len(AXLES)):
        found.unknown[6 * axle + 2] = -1.1e-3
    found.unknown[UNKNOWN_BODIES:] = np.tile([0.0, -0.8e-3], 4)
    return found.solve()
