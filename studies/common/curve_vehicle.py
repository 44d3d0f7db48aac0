"""What rolls in studies/curve and studies/mileage: masses, springs, and the wheels, whose contact is the component's.

A bogie with two wheelsets and half a passenger car's body on it, by default after vehicle 1 of the Manchester
benchmarks. Bodies are numbered: leading wheelset, trailing wheelset, frame, body. Each has x, y, z of its centre and
three angles in space: it is turned about x, then about the y and then about the z so turned. A wheelset's z is its
axle, to the left (curve_track.py).
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


@dataclass(frozen=True)
class Vehicle:
    """A bogie with half a car on it. Of springs and rails: along, across, vertically, or across and vertically."""

    wheel_radius: float = WHEEL_RADIUS  # m
    wheelset_mass: float = 1813.0  # kg
    frame_mass: float = 2615.0
    body_mass: float = 16000.0  # on this bogie
    wheelset_inertia: tuple = (1120.0, 1120.0, 112.0)  # kg.m2, the last about the axle
    frame_inertia: tuple = (1722.0, 1476.0, 3067.0)  # about x, y, z
    body_inertia: tuple = (28400.0, 985000.0, 985000.0)
    half_wheelbase: float = 1.28  # m
    half_spring_base: float = 1.0
    half_secondary_base: float = 1.0
    frame_height: float = 0.6  # m above the rails
    secondary_height: float = 0.9
    body_height: float = 1.8
    # Of a spring, one at each axle's end and one on each side of the frame.
    primary_stiffness: tuple = (3.14e7, 3.88e6, 1.22e6)  # N/m
    primary_damping: tuple = (1.5e4, 2.0e4, 1.0e4)  # N.s/m
    secondary_stiffness: tuple = (1.6e5, 1.6e5, 4.3e5)
    secondary_damping: tuple = (3.0e4, 4.0e4, 5.0e4)
    # A rail under a wheel, which yields across the track and vertically.
    rail_stiffness: tuple = (4.3e7, 7.0e7)  # N/m
    # The vehicle's other bogie, this far behind, holds the body's heading and its pitch.
    pivots: float = 19.0  # m
    guide_stiffness: float = 4.0e7  # N.m/rad
    guide_damping: float = 5.0e6  # N.m.s/rad

    @property
    def mass(self):
        """Masses of the bodies [kg]."""
        return np.array([self.wheelset_mass, self.wheelset_mass, self.frame_mass, self.body_mass])

    @property
    def inertia(self):
        """Moments of inertia of the bodies about their x, y and z, a row each [kg.m2]."""
        return np.array([self.wheelset_inertia, self.wheelset_inertia, self.frame_inertia, self.body_inertia])

    @property
    def along(self):
        """Places of the bodies along the track from the bogie's middle [m]."""
        return (self.half_wheelbase, -self.half_wheelbase, 0.0, 0.0)

    @property
    def wheel_load(self):
        """Static load of a wheel [N]."""
        return GRAVITY * self.mass.sum() / 4.0

    @property
    def carried(self):
        """Static load of a primary and of a secondary spring [N]."""
        return (
            0.25 * GRAVITY * (self.body_mass + self.frame_mass),
            0.5 * GRAVITY * self.body_mass,
        )


VEHICLE = Vehicle()
# As studies/curve has it in Exudyn.
MASS, INERTIA, ALONG, WHEEL_LOAD = VEHICLE.mass, VEHICLE.inertia, VEHICLE.along, VEHICLE.wheel_load
HALF_WHEELBASE, BODY_HEIGHT, SECONDARY_HEIGHT = VEHICLE.half_wheelbase, VEHICLE.body_height, VEHICLE.secondary_height
RAIL_STIFFNESS = VEHICLE.rail_stiffness
RAIL_MASS, RAIL_DAMPING = 300.0, (1.5e5, 1.5e5)  # kg, N.s/m
# The train holds the bogie's speed.
HOLD = 1.0e6  # N/(m/s)

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


def springs(vehicle=VEHICLE):
    """Primary springs at the axles' ends, secondary springs on both sides."""
    made = []
    axle_below, body_above = vehicle.wheel_radius - vehicle.frame_height, vehicle.secondary_height - vehicle.body_height
    primary = (vehicle.primary_stiffness, vehicle.primary_damping)
    secondary = (vehicle.secondary_stiffness, vehicle.secondary_damping)
    for axle, along in ((LEADING, vehicle.half_wheelbase), (TRAILING, -vehicle.half_wheelbase)):
        for side in SIDES.values():
            across = side * vehicle.half_spring_base
            frame = (along, across, axle_below)
            made.append(Spring(FRAME, frame, axle, (0.0, 0.0, across), *primary, -vehicle.carried[0]))
    for side in SIDES.values():
        across = side * vehicle.half_secondary_base
        frame, body = (0.0, across, vehicle.secondary_height - vehicle.frame_height), (0.0, across, body_above)
        made.append(Spring(FRAME, frame, BODY, body, *secondary, vehicle.carried[1]))
    return made


def standing(track, place, vehicle=VEHICLE):
    """Coordinates of all bodies, a row each, where they stand on the track as on their own, about a place."""
    rows = np.zeros((4, 6))
    heights = (vehicle.wheel_radius, vehicle.wheel_radius, vehicle.frame_height, vehicle.body_height)
    for body, (along, height) in enumerate(zip(vehicle.along, heights, strict=True)):
        middle, axes = track.axes(place + along)
        ahead, left, up = axes.T
        rows[body, :3] = middle + height * up
        if body in (LEADING, TRAILING):
            rows[body, 3:5] = np.arctan2(-left[1], left[2]), np.arcsin(left[0])
        else:
            rows[body, 3:] = np.arctan2(-up[1], up[2]), np.arcsin(up[0]), np.arctan2(-left[0], ahead[0])
    return rows


def chord(track, place, vehicle=VEHICLE):
    """Heading of the line between the body's pivots."""
    ahead, behind = track.at(place), track.at(place - vehicle.pivots)
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


def guidance(track, turned, angular_velocity, speed, place, vehicle=VEHICLE):
    """Moment by which the rest of the vehicle holds the body in its heading and level [N.m], in space."""
    forward = turned[:, 0]
    heading = atan2(forward[1], forward[0])
    left = np.array([-np.sin(heading), np.cos(heading), 0.0])
    turning = speed * (chord(track, place + 0.05, vehicle) - chord(track, place - 0.05, vehicle)) / 0.1
    stiffness, damping = vehicle.guide_stiffness, vehicle.guide_damping
    about_z = -stiffness * (heading - chord(track, place, vehicle)) - damping * (angular_velocity[2] - turning)
    about_left = stiffness * np.arcsin(forward[2]) - damping * angular_velocity @ left
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
