"""A track, straight, transition, curve, transition, and how a wheelset stands and moves on it.

The world has x and y level and z upward. A place on the track is the length s along its middle, where it has a heading
ψ (anticlockwise from above), a curvature κ = dψ/ds, positive to the left, and a cant φ, positive where the left rail is
higher, about its middle. There the track's own axes are t along it, n to its left in its plane, and up = t × n:

    t = (cos ψ, sin ψ, 0)    n = (−sin ψ cos φ, cos ψ cos φ, sin φ)

Position and motion of a wheelset are those of its centre p, its axle's direction e to the left, its velocity v and its
angular velocity Ω, in space, in the axes of the place s at which (p − c(s))·t = 0:

    lateral_displacement  (p − c)·n          lateral_speed   v·n      vehicle_speed  v·t
    vertical_displacement (p − c)·up − r₀    vertical_speed  v·up
    yaw_angle, roll_angle  e = (−sin yaw cos roll, cos yaw cos roll, sin roll)
    yaw_rate, roll_rate, wheel_speed         Ω = yaw_rate up + roll_rate (cos yaw t + sin yaw n) + wheel_speed e

Rails do not move along in a curve, so speeds are those in space and not those against axes that turn. Thus the yaw rate
is V κ when the wheelset does nothing but follow the curve, and the wheel outside goes faster by V κ b over its rail.
"""

from dataclasses import dataclass
from math import asin, atan2, cos, hypot, sin

import numpy as np
from helpers import WHEEL_RADIUS

# What a wheel is told, but for the rail's own movement.
INPUTS = ("lateral_displacement", "vertical_displacement", "roll_angle", "yaw_angle", "vehicle_speed")
INPUTS += ("lateral_speed", "vertical_speed", "roll_rate", "yaw_rate", "wheel_speed")
LATERAL, VERTICAL = INPUTS.index("lateral_displacement"), INPUTS.index("vertical_displacement")
LATERAL_SPEED, VERTICAL_SPEED = INPUTS.index("lateral_speed"), INPUTS.index("vertical_speed")
MAIN = (LATERAL, VERTICAL, LATERAL_SPEED, VERTICAL_SPEED, INPUTS.index("wheel_speed"))
TAPE_WIDTH = 1.5  # m: distance of the rails' middles, over which the cant is given


@dataclass(frozen=True)
class Layout:
    """Lengths along the track [m], radius [m], positive to the left, cant [m] of the outer rail."""

    straight: float = 20.0
    transition: float = 40.0
    curve: float = 90.0
    behind: float = 30.0
    radius: float = -300.0
    cant: float = 0.1

    @property
    def marks(self):
        """Where transition, curve, transition and straight track begin, and the end."""
        lengths = (self.straight, self.transition, self.curve, self.transition, self.behind)
        return tuple(float(mark) for mark in np.cumsum(lengths))


class Track:
    """Middle line, heading, cant, and unevenness of both rails."""

    GRID = 0.1  # m

    def __init__(self, layout=None, rough=0.0, seed=25):
        """A layout; the unevenness times a factor, 0 for even rails."""
        self.layout = layout = layout or Layout()
        marks = np.array(layout.marks)
        self.rough = Unevenness(seed, rough) if rough else None
        # From 30 m before the start to 30 m behind the end. The curvature is linear between the marks.
        self.first = -30.0
        place = np.arange(self.first, marks[-1] + 30.0, self.GRID)
        share = np.interp(place, marks[:4], [0.0, 1.0, 1.0, 0.0])
        curvature = share / layout.radius
        heading = np.concatenate([[0.0], np.cumsum(0.5 * (curvature[1:] + curvature[:-1])) * self.GRID])
        # Middles of the cells for Simpson's rule: the heading is a parabola there.
        middle = 0.5 * (heading[1:] + heading[:-1]) - self.GRID / 8.0 * np.diff(curvature)
        self.points = []
        for function in (np.cos, np.sin):
            ends, inside = function(heading), function(middle)
            cells = self.GRID / 6.0 * (ends[:-1] + 4.0 * inside + ends[1:])
            self.points.append(np.concatenate([[0.0], np.cumsum(cells)]))
        self.points[0] += self.first
        self.lists = [values.tolist() for values in (*self.points, heading, curvature)]
        self.radius, self.largest_cant = layout.radius, asin(layout.cant / TAPE_WIDTH)

    def at(self, place):
        """Return x, y, heading, curvature and cant at a place."""
        cell, part = divmod((place - self.first) / self.GRID, 1.0)
        k = int(cell)
        xs, ys, headings, curvatures = self.lists
        start, end = curvatures[k], curvatures[k + 1]
        curvature = start + part * (end - start)
        heading = headings[k] + self.GRID * part * (start + 0.5 * part * (end - start))
        # The middle line by its places and directions at both ends of the cell: Hermite's cubic.
        square, cube = part * part, part**3
        of_end, of_start = 3.0 * square - 2.0 * cube, self.GRID * (cube - 2.0 * square + part)
        of_last = self.GRID * (cube - square)
        h0, h1 = headings[k], headings[k + 1]
        x = xs[k] + of_end * (xs[k + 1] - xs[k]) + of_start * cos(h0) + of_last * cos(h1)
        y = ys[k] + of_end * (ys[k + 1] - ys[k]) + of_start * sin(h0) + of_last * sin(h1)
        # The outer rail is lifted: the left one in a curve to the right.
        return x, y, heading, curvature, -self.largest_cant * abs(self.radius) * curvature

    def place_of(self, x, y, guess):
        """Return the place at which a point is right beside the middle line."""
        for _ in range(4):
            at_x, at_y, heading, curvature, _ = self.at(guess)
            tx, ty = cos(heading), sin(heading)
            ahead = (x - at_x) * tx + (y - at_y) * ty
            beside = (y - at_y) * tx - (x - at_x) * ty
            guess += ahead / (1.0 - curvature * beside)
            if abs(ahead) < 1e-12:
                break
        return guess

    def axes(self, place):
        """Return the middle's point, and t, n and up by columns."""
        x, y, heading, _, cant = self.at(place)
        c, s, cc, sc = cos(heading), sin(heading), cos(cant), sin(cant)
        return np.array([x, y, 0.0]), np.array([[c, -s * cc, s * sc], [s, c * cc, -c * sc], [0.0, sc, cc]])

    def uneven(self, side, place):
        """Lateral and vertical displacement of a rail by its unevenness [m]; side 1 left, -1 right."""
        return self.rough.at(side, place) if self.rough else (0.0, 0.0)


class Unevenness:
    """Both rails' lateral and vertical unevenness: harmonics of the spectrum of the ORE (B 176, low disturbance).

    One-sided spectral density over the angular wavenumber k [rad/m]: S = A c²/((k² + r²)(k² + c²)). The middle of the
    track has it; each rail has a half of it in addition, of its own. It begins ahead of where the bogie starts.
    """

    VERTICAL, LATERAL = 4.032e-7, 2.119e-7  # A [rad.m]
    CUT_OFF, LONGEST = 0.8246, 0.0206  # c, r [rad/m]
    OF_A_RAIL, BEGIN = 0.5, 8.0  # a share, m
    TABLE = 0.02  # m

    def __init__(self, seed, factor, length=320.0, waves=(40.0, 2.0), number=120):
        """Harmonics with wavelengths from 2 to 40 m, phases from the seed, tabulated over a length."""
        random = np.random.default_rng(seed)
        edges = 2.0 * np.pi / np.geomspace(*waves, number + 1)
        wavenumber = np.sqrt(edges[1:] * edges[:-1])
        shape = self.CUT_OFF**2 / ((wavenumber**2 + self.LONGEST**2) * (wavenumber**2 + self.CUT_OFF**2))
        place = np.arange(-40.0, length, self.TABLE)
        begin = np.clip((place - self.BEGIN) / 10.0, 0.0, 1.0)
        begin = factor * begin * begin * (3.0 - 2.0 * begin)
        waves = []
        for size in (self.LATERAL, self.VERTICAL):
            amplitude = np.sqrt(2.0 * size * shape * np.diff(edges))
            drawn = [
                np.cos(np.multiply.outer(place, wavenumber) + random.uniform(0.0, 2.0 * np.pi, number)) @ amplitude
                for _ in range(3)
            ]
            waves.append([begin * (drawn[0] + self.OF_A_RAIL * own) for own in drawn[1:]])
        self.tables = {side: [direction[k].tolist() for direction in waves] for k, side in enumerate((1, -1))}

    def at(self, side, place):
        """Lateral and vertical displacement of a rail."""
        cell, part = divmod((place + 40.0) / self.TABLE, 1.0)
        k = int(cell)
        return tuple(table[k] + part * (table[k + 1] - table[k]) for table in self.tables[side])


def motion(track, coordinates, rates, guess, radius=WHEEL_RADIUS):
    """Return the place of a wheelset and what its wheels are told, over rails in their places.

    Coordinates are x, y, z of its centre and three angles (α, β, γ): turned by α about x, by β about the y so turned,
    by γ about the axle, which is its z axis. So α = −90° + roll and β = −heading, near enough for no singular place.
    """
    x, y, z, alpha, beta, _ = coordinates
    vx, vy, vz, alpha_rate, beta_rate, gamma_rate = rates
    place = track.place_of(x, y, guess)
    at_x, at_y, heading, _, cant = track.at(place)
    c, s, cc, sc = cos(heading), sin(heading), cos(cant), sin(cant)
    # Along, level to the left, upright; then in the plane of the track.
    beside = (y - at_y) * c - (x - at_x) * s
    lateral, vertical = cc * beside + sc * z, cc * z - sc * beside
    ca, sa, cb, sb = cos(alpha), sin(alpha), cos(beta), sin(beta)
    ex, ey, ez = sb, -sa * cb, ca * cb
    wx = alpha_rate + gamma_rate * ex
    wy = beta_rate * ca + gamma_rate * ey
    wz = beta_rate * sa + gamma_rate * ez

    def turned(a, b, up):
        level = b * c - a * s
        return a * c + b * s, cc * level + sc * up, cc * up - sc * level

    along, left, up = turned(ex, ey, ez)
    flat = hypot(along, left)
    roll, yaw = asin(up), atan2(-along, left)
    v_along, v_left, v_up = turned(vx, vy, vz)
    w_along, w_left, w_up = turned(wx, wy, wz)
    # Ω = yaw_rate up + roll_rate (cos yaw, sin yaw, 0) + wheel_speed e.
    cy, sy = left / flat, -along / flat
    roll_rate = cy * w_along + sy * w_left
    wheel_speed = (cy * w_left - sy * w_along) / flat
    yaw_rate = w_up - wheel_speed * up
    return place, (
        lateral, vertical - radius, roll, yaw, v_along, v_left, v_up, roll_rate, yaw_rate, wheel_speed,
    )  # fmt: skip


def turning(coordinates):
    """Axes about which the three angles of a wheelset turn it, by columns."""
    alpha, beta = coordinates[3:5]
    ca, sa, cb, sb = cos(alpha), sin(alpha), cos(beta), sin(beta)
    return np.array([[1.0, 0.0, sb], [0.0, ca, -sa * cb], [0.0, sa, ca * cb]])
