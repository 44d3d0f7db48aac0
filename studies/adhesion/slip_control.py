"""Slip controllers of a driven wheelset: torque cut and ramp, constant creepage, and a search for the most adhesion.

Each has `torque(now, wheel_speed, vehicle_speed, motor_torque, largest)`, called once a control period with what an
inverter knows: the wheelset's speed, the train's speed, and the mean torque that its motor had since the last call. All
of them estimate the adhesion force as what is left of that torque beside the acceleration of the wheelset,

    F = (M - J dω/dt) / r

through a filter of first order. studies/adhesion compares them.
"""

import math
from collections import deque

import numpy as np

PERIOD = 5e-3  # s, of a controller
OBSERVER_LAG = 10e-3  # s, of the filter of the estimated force


class Observer:
    """Estimates the adhesion force of a wheelset, and filters the slip velocity alike."""

    def __init__(self, inertia, radius):
        """Of a wheelset with a moment of inertia [kg.m2] and a radius [m]."""
        self.inertia, self.radius = inertia, radius
        self.force = self.slip = 0.0
        self.last_speed = None

    def see(self, wheel_speed, vehicle_speed, motor_torque):
        """Take the speeds now and the mean torque since the last time; return the slip velocity [m/s]."""
        slip = wheel_speed * self.radius - vehicle_speed
        if self.last_speed is not None:
            acceleration = (wheel_speed - self.last_speed) / PERIOD
            force = (motor_torque - self.inertia * acceleration) / self.radius
            share = 1.0 - math.exp(-PERIOD / OBSERVER_LAG)
            self.force += share * (force - self.force)
            self.slip += share * (slip - self.slip)
        self.last_speed = wheel_speed
        return slip


class ConstantCreepage:
    """Holds one creepage: the torque of the estimated force, and more or less of it by the error of the slip."""

    GAIN = 40.0  # 1/s: how fast an error of the slip velocity is taken back

    def __init__(self, inertia, radius, creepage):
        """With the creepage to hold."""
        self.observer = Observer(inertia, radius)
        self.creepage = creepage
        self.wanted = 0.0

    def set_point(self, now, vehicle_speed, error):
        """Slip velocity to hold [m/s]; error is that of the last period."""
        return self.creepage * vehicle_speed

    def torque(self, now, wheel_speed, vehicle_speed, motor_torque, largest):
        """Torque that the motor is to have, at most the driver's [N.m]."""
        observer = self.observer
        slip = observer.see(wheel_speed, vehicle_speed, motor_torque)
        self.wanted = self.set_point(now, vehicle_speed, slip - self.wanted)
        needed = observer.radius * observer.force
        needed += observer.inertia / observer.radius * self.GAIN * (self.wanted - slip)
        return min(max(needed, 0.0), largest)


class Search(ConstantCreepage):
    """Looks for the creepage with the most adhesion, whatever it is: goes up the slope of force over slip.

    The slip to hold swings a little. Force and slip of the last swing give the slope dF/ds, by least squares; the slip
    goes on where the force grows and back where it falls. Where the wheel does not follow, as where the rail changes,
    the slope says nothing, and the search waits for another swing.
    """

    SWING, PERIODS = 0.03, 64  # m/s; control periods of a swing
    FOLLOWS = 0.045  # m/s: error of the slip up to which the wheel follows
    PACE = 0.5  # (m/s)2/s: pace at which the slip goes, per relative slope dF/ds/F
    FASTEST = 0.2  # m/s2
    LEAST, MOST = 0.05, 1.5  # m/s, of the slip to hold

    def __init__(self, inertia, radius, phase=0.0):
        """With the phase of the swing, different from wheelset to wheelset, so that the train does not feel it."""
        super().__init__(inertia, radius, 0.0)
        self.phase = phase
        self.middle = 0.1  # m/s
        self.seen = deque(maxlen=self.PERIODS)

    def slope(self):
        """Relative slope dF/ds/F [s/m]: 0 before a whole swing is seen, infinite if the slip hardly follows it."""
        if len(self.seen) < self.PERIODS:
            return 0.0
        slip, force = np.array(self.seen).T
        apart = slip - slip.mean()
        variance = apart @ apart / self.PERIODS
        if variance < (0.1 * self.SWING) ** 2 or force.mean() <= 0.0:
            return math.inf
        return apart @ force / self.PERIODS / variance / force.mean()

    def set_point(self, now, vehicle_speed, error):
        """Slip velocity to hold [m/s]."""
        self.seen.append((self.observer.slip, self.observer.force))
        if abs(error) > self.FOLLOWS:
            self.seen.clear()
        pace = self.PACE * self.slope()
        self.middle += PERIOD * min(max(pace, -self.FASTEST), self.FASTEST)
        self.middle = min(max(self.middle, self.LEAST), self.MOST)
        return self.middle + self.SWING * math.sin(2.0 * math.pi * now / (self.PERIODS * PERIOD) + self.phase)


class CutAndRamp:
    """Lets the torque grow until the wheel slips, cuts it until the wheel has caught the rail, and begins again.

    It knows neither the curve nor a good creepage, only that a wheel at more than LIMIT has lost its hold.
    """

    LIMIT, CAUGHT = 0.5, 0.05  # m/s, slip velocity at which it cuts, and at which it ends the cut
    CUT, AGAIN = 0.5, 0.85  # shares of the estimated adhesion: during the cut, and after it
    RAMP = 0.06  # 1/s, of the largest torque

    def __init__(self, inertia, radius):
        """Follow the driver until the wheel slips for the first time."""
        self.observer = Observer(inertia, radius)
        self.level = math.inf
        self.held = None

    def torque(self, now, wheel_speed, vehicle_speed, motor_torque, largest):
        """Torque that the motor is to have, at most the driver's [N.m]."""
        slip = self.observer.see(wheel_speed, vehicle_speed, motor_torque)
        if self.held is None and slip > self.LIMIT:
            self.held = self.observer.radius * self.observer.force
        elif self.held is not None and slip < self.CAUGHT:
            self.level, self.held = self.AGAIN * self.held, None
        if self.held is not None:
            return min(self.CUT * self.held, largest)
        self.level += self.RAMP * PERIOD * largest
        return min(self.level, largest)
