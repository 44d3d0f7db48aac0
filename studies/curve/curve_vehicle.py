"""What rolls in studies/curve: masses, springs, and the wheels, whose contact is the component's.

A bogie with two wheelsets and half a passenger car's body on it, after vehicle 1 of the Manchester benchmarks. Bodies
are numbered: leading wheelset, trailing wheelset, frame, body. Each has x, y, z of its centre and three angles in
space: it is turned about x, then about the y and then about the z so turned. A wheelset's z is its axle, to the left
(curve_track.py).
"""

from dataclasses import dataclass
from math import atan2

import numpy as np
from curve_track import INPUTS, LATERAL, LATERAL_SPEED, MAIN, TAPE_WIDTH, VERTICAL, VERTICAL_SPEED
from helpers import FMU, WHEEL_RADIUS, Instance

GRAVITY = 9.81
SPEED = 60.0 / 3.6  # m/s
LEADING, TRAILING, FRAME, BODY = range(4)
AXLES = ("leading", "trailing")
SIDES = {"left": 1, "right": -1}
WHEELS = [(axle, side) for axle in AXLES for side in SIDES]

MASS = np.array([1813.0, 1813.0, 2615.0, 16000.0])  # kg
# About x, y and z of each body; a wheelset's z is its axle.
INERTIA = np.array([[1120.0, 1120.0, 112.0]] * 2 + [[1722.0, 1476.0, 3067.0], [28400.0, 985000.0, 985000.0]])  # kg.m2
HALF_WHEELBASE, HALF_SPRING_BASE, HALF_SECONDARY_BASE = 1.28, 1.0, 1.0  # m
ALONG = (HALF_WHEELBASE, -HALF_WHEELBASE, 0.0, 0.0)  # of the bodies from the bogie's middle
FRAME_HEIGHT, SECONDARY_HEIGHT, BODY_HEIGHT = 0.6, 0.9, 1.8  # m above the rails
# Of a spring, one at each axle's end and one on each side of the frame: along, across, vertically [N/m], [N.s/m].
PRIMARY = ((3.14e7, 3.88e6, 1.22e6), (1.5e4, 2.0e4, 1.0e4))
SECONDARY = ((1.6e5, 1.6e5, 4.3e5), (3.0e4, 4.0e4, 5.0e4))
# A rail under a wheel, which yields across the track and vertically.
RAIL_MASS, RAIL_STIFFNESS, RAIL_DAMPING = 300.0, (4.3e7, 7.0e7), (1.5e5, 1.5e5)  # kg, N/m, N.s/m
# The vehicle's other bogie, this far behind, holds the body's heading and its pitch; the train holds its speed.
PIVOTS, GUIDE, GUIDE_DAMPING = 19.0, 4.0e7, 5.0e6  # m, N.m/rad, N.m.s/rad
HOLD = 1.0e6  # N/(m/s)

WHEEL_LOAD = GRAVITY * MASS.sum() / 4.0
CARRIED = (0.25 * GRAVITY * (MASS[BODY] + MASS[FRAME]), 0.5 * GRAVITY * MASS[BODY])  # N, by a spring

CONTACT = {"contact_model": "profiles", "slip_source": "vehicle_speed", "control": "height", "largest_load": 250e3}
# Coarser than by default, which moves the forces by 0.2 %: a step takes half the time.
CONTACT |= {"patch_nodes": 24, "patch_strips": 15}
FORCES = ("force_x", "force_y", "force_z", "moment_x", "moment_y", "moment_z")
OF_CONTACTS = ("rail_position", "normal_force", "inclination", "peak_pressure")
SHOWN = ("contacts", "peak_temperature", "wear_number", "friction_power")
SHOWN += tuple(f"contact.{name}[{number}]" for name in OF_CONTACTS for number in (1, 2, 3))

# What tables have of a wheel: its force on the rail outwards and downwards, and so on [N], [m].
OF_WHEEL = ("Y", "Q", "force_x", "rail_lateral", "rail_vertical", "missed", *SHOWN)


@dataclass(frozen=True)
class Spring:
    """A spring and a damper between points of two bodies, along the axes of the first one, whose force is offset."""

    first: int
    at_first: tuple
    second: int
    at_second: tuple
    stiffness: tuple
    damping: tuple
    carried: float


def springs():
    """Primary springs at the axles' ends, secondary springs on both sides."""
    made = []
    for axle, along in ((LEADING, HALF_WHEELBASE), (TRAILING, -HALF_WHEELBASE)):
        for side in SIDES.values():
            across = side * HALF_SPRING_BASE
            frame = (along, across, WHEEL_RADIUS - FRAME_HEIGHT)
            made.append(Spring(FRAME, frame, axle, (0.0, 0.0, across), *PRIMARY, -CARRIED[0]))
    for side in SIDES.values():
        across = side * HALF_SECONDARY_BASE
        frame, body = (0.0, across, SECONDARY_HEIGHT - FRAME_HEIGHT), (0.0, across, SECONDARY_HEIGHT - BODY_HEIGHT)
        made.append(Spring(FRAME, frame, BODY, body, *SECONDARY, CARRIED[1]))
    return made


def standing(track, place):
    """Coordinates of all bodies, a row each, where they stand on the track as on their own, about a place."""
    rows = np.zeros((4, 6))
    heights = (WHEEL_RADIUS, WHEEL_RADIUS, FRAME_HEIGHT, BODY_HEIGHT)
    for body, (along, height) in enumerate(zip(ALONG, heights, strict=True)):
        middle, axes = track.axes(place + along)
        ahead, left, up = axes.T
        rows[body, :3] = middle + height * up
        if body in (LEADING, TRAILING):
            rows[body, 3:5] = np.arctan2(-left[1], left[2]), np.arcsin(left[0])
        else:
            rows[body, 3:] = np.arctan2(-up[1], up[2]), np.arcsin(up[0]), np.arctan2(-left[0], ahead[0])
    return rows


def chord(track, place):
    """Heading of the line between the body's pivots."""
    ahead, behind = track.at(place), track.at(place - PIVOTS)
    return atan2(ahead[1] - behind[1], ahead[0] - behind[0])


def turn(angles):
    """Rotation matrix of a body."""
    (ca, cb, cg), (sa, sb, sg) = np.cos(angles), np.sin(angles)
    return np.array(
        [
            [cb * cg, -cb * sg, sb],
            [ca * sg + sa * sb * cg, ca * cg - sa * sb * sg, -sa * cb],
            [sa * sg - ca * sb * cg, sa * cg + ca * sb * sg, ca * cb],
        ]
    )


def guidance(track, turned, angular_velocity, speed, place):
    """Moment by which the rest of the vehicle holds the body in its heading and level [N.m], in space."""
    forward = turned[:, 0]
    heading = atan2(forward[1], forward[0])
    left = np.array([-np.sin(heading), np.cos(heading), 0.0])
    turning = speed * (chord(track, place + 0.05) - chord(track, place - 0.05)) / 0.1
    about_z = -GUIDE * (heading - chord(track, place)) - GUIDE_DAMPING * (angular_velocity[2] - turning)
    about_left = GUIDE * np.arcsin(forward[2]) - GUIDE_DAMPING * angular_velocity @ left
    return about_left * left + np.array([0.0, 0.0, about_z])


class Wheel(Instance):
    """A unit, what it was told last over its own rail, and its forces on the wheelset in the track's axes."""

    def __init__(self, side, fmu=FMU, **parameters):
        """A wheel of one side, without contact."""
        super().__init__(fmu, side, **(CONTACT | {"side": side} | parameters))
        self.set(vertical_displacement=0.05, vehicle_speed=SPEED, wheel_speed=SPEED / WHEEL_RADIUS)
        self.start()
        self.side = SIDES[side]
        self.forces, self.told = np.zeros(6), np.zeros(len(INPUTS))

    def roll(self, told, rail, rail_rates, uneven, step):
        """Step with the wheelset's motion, and displacement, speed and unevenness of the rail, each (across, up)."""
        self.set(
            **dict(zip(INPUTS, told, strict=True)),
            rail_lateral_displacement=rail[0] + uneven[0],
            rail_vertical_displacement=rail[1] + uneven[1],
            rail_lateral_speed=rail_rates[0],
            rail_vertical_speed=rail_rates[1],
        )
        self.step(step)
        self.told = over_rail(told, rail, rail_rates, uneven)
        self.forces = np.array(self.get(*FORCES))
        return self.forces

    def slopes(self):
        """Derivatives of the forces with respect to what the wheel is told, by the component."""
        return np.column_stack([self.derivative(FORCES, name) for name in INPUTS])

    def main_slopes(self):
        """Derivatives as slopes(), from half as many calls: the others are what moves a point of contact likewise.

        At a single contact, a radius below the axle and half a tape's width beside the middle, a turn about x moves
        the wheel to the left and up, a yaw angle rolls it sideways, and a speed forward is a slower turning wheel.
        """
        across, up, left, rise, spin = (np.array(self.derivative(FORCES, INPUTS[number])) for number in MAIN)
        beside = 0.5 * TAPE_WIDTH * self.side
        forward = -spin / WHEEL_RADIUS
        roll, roll_rate = (WHEEL_RADIUS * y + beside * z for y, z in ((across, up), (left, rise)))
        yaw = -self.told[INPUTS.index("vehicle_speed")] * left
        return np.column_stack([across, up, roll, yaw, forward, left, rise, roll_rate, -beside * forward, spin])


def over_rail(told, rail, rail_rates, uneven):
    """Motion of the wheelset over a rail that has moved: forces hang on the difference alone."""
    over = np.array(told)
    over[LATERAL] -= rail[0] + uneven[0]
    over[VERTICAL] -= rail[1] + uneven[1]
    over[LATERAL_SPEED] -= rail_rates[0]
    over[VERTICAL_SPEED] -= rail_rates[1]
    return over
