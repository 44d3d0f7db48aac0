"""Contact of a left wheel S1002 on a rail UIC60 as one dense system: a second program for the equations of profiles.

Everything is worked out anew here: the profiles by the formulas of their standards, the influence of rectangles on a
half-space, all cells of all contacts in one matrix; no windows, no transforms, no heat. It is slow, and there to
compare with: `tools/random_states.py --dense` and `python_tests/test_dense_contact.py` do.

Lengths in mm, forces in N, tractions in MPa, angles in rad, times in s. Track frame: x forward, y to the left, z up.
The arc length s runs along the rail's profile to the field side; every cell has the normal of its place on the rail.
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.polynomial import Polynomial

POISSON, SHEAR_MODULUS, FRICTION = 0.28, 82e3, 0.3
RADIUS = 460.0
# From the wheelset's middle to the running circle; from the track's middle to the gauge face, below the rail's top.
RUNNING_CIRCLE, GAUGE_FACE, GAUGE_DEPTH = 750.0, 717.5, 14.0
INCLINATION = np.arctan(1 / 40)

# UIC60 from its middle outwards: radius, y of the centre, its depth below the middle, y of the arc's end.
RAIL = [(300.0, 0.0, 300.0, 10.25), (80.0, 7.7, 80.135, 26.04), (13.0, 23.016, 14.909, 36.016)]

# S1002 by EN 13715, z down over y from the running circle: root of the flange, tread.
ROOT = Polynomial(
    [
        *(-4.320221063e3, -1.038384026e3, -1.065501873e2, -6.051367875),
        *(-2.054332446e-1, -4.169739389e-3, -4.687195829e-5, -2.252755540e-7),
    ]
)
TREAD = Polynomial(
    [
        *(0.0, -3.358537058e-2, 1.565681624e-3, -2.810427944e-5, 5.844240864e-8),
        *(-1.562379023e-8, 5.309217349e-15, -5.957839843e-12, 2.646656573e-13),
    ]
)
LINE = Polynomial([-93.576667419, -2.747477419])
END = Polynomial([1.364323640, -0.066666667])

# Steps of Newton's method, of the search for the cells under pressure, of that for the height.
MOST_STEPS = 60


class DenseError(Exception):
    """A state that this program cannot solve."""


@dataclass(frozen=True)
class Motion:
    """Place and motion of the wheelset at its centre."""

    lateral: float  # mm
    roll: float  # rad
    yaw: float  # rad
    lateral_speed: float  # mm/s
    yaw_rate: float  # rad/s
    wheel_speed: float  # rad/s
    speed: float  # mm/s


class Cells(NamedTuple):
    """Rectangles on the unrolled rail: their middles and how long and broad they are."""

    x: np.ndarray
    s: np.ndarray
    length: np.ndarray
    breadth: np.ndarray


class Solution(NamedTuple):
    """Force on the wheelset in the track frame, the largest pressure and the number of contacts."""

    force: np.ndarray
    peak: float
    contacts: int


def wheel_profile(y):
    """Height of S1002 downwards and its slope, over y from the running circle to the field side."""

    def arc(middle, height, radius, side=1):
        half = np.sqrt(np.maximum(radius**2 - (y - middle) ** 2, 1e-6))
        return height + side * half, -side * (y - middle) / half

    def along(curve):
        return curve(y), curve.deriv()(y)

    pieces = [
        (-62.764705882, arc(-49.5, 9.519259302, 20.5)),
        (-49.662510381, arc(-55.0, 16.0, 12.0)),
        (-39.764473993, arc(-58.558326413, 8.834924130, 20.0)),
        (-38.426669071, along(LINE)),
        (-35.0, arc(-26.210665, 16.446, 13.0, -1)),
        (-26.0, along(ROOT)),
        (32.15796, along(TREAD)),
        (np.inf, along(END)),
    ]
    within = [y < end for end, _ in pieces]
    return [np.select(within, [piece[part] for _, piece in pieces]) for part in (0, 1)]


class Rail:
    """The inclined left rail in its place in the track."""

    def __init__(self):
        """Lay it: its top at z = 0, its gauge face at half the gauge."""
        self.shift = np.zeros(2)
        # An inclined circle is highest where its slope makes up for the inclination.
        self.top = RAIL[0][0] * INCLINATION
        self.shift = np.array([0.0, -self.at(self.top)[0][1]])
        low, high = -self.reach(), self.top
        for _ in range(MOST_STEPS):
            middle = (low + high) / 2
            low, high = (middle, high) if self.at(middle)[0][1] < -GAUGE_DEPTH else (low, middle)
        self.shift[0] = GAUGE_FACE - self.at(low)[0][0]

    @staticmethod
    def arcs():
        """Of each arc: radius, centre, its angles from and to, its arc length from and to."""
        before, start = 0.0, 0.0
        for radius, y, depth, end in RAIL:
            first, last = np.arcsin((start - y) / radius), np.arcsin((end - y) / radius)
            yield radius, (y, depth), (first, last), (before, before + radius * (last - first))
            before, start = before + radius * (last - first), end

    def reach(self):
        """Arc length from the middle to the end of the head."""
        return list(self.arcs())[-1][3][1]

    def at(self, s):
        """Place (y, z) and tangent at arc lengths from the rail's middle."""
        s = np.asarray(s, float)
        side, far = np.where(s < 0.0, -1.0, 1.0), np.abs(s)
        y, z, angle = (np.zeros(s.shape) for _ in range(3))
        for radius, (middle, depth), (first, _), (begin, end) in self.arcs():
            here = (far >= begin) & (far <= end)
            turned = first + (far - begin) / radius
            y = np.where(here, middle + radius * np.sin(turned), y)
            z = np.where(here, radius * np.cos(turned) - depth, z)
            angle = np.where(here, turned, angle)
        c, t = np.cos(INCLINATION), np.sin(INCLINATION)
        turn = np.array([[c, -t], [t, c]])
        place = np.tensordot(turn, np.stack([side * y, z]), 1)
        tangent = np.tensordot(turn, np.stack([np.cos(angle), -side * np.sin(angle)]), 1)
        return place + self.shift.reshape(2, *[1] * s.ndim), tangent


class Pair:
    """A wheel, which turns about its axle, over the rail."""

    def __init__(self, motion):
        """Turn the axle by yaw and roll."""
        self.rail, self.motion = Rail(), motion
        (cr, sr), (cy, sy) = ((np.cos(angle), np.sin(angle)) for angle in (motion.roll, motion.yaw))
        yaw = np.array([[cy, -sy, 0.0], [sy, cy, 0.0], [0.0, 0.0, 1.0]])
        self.turn = yaw @ np.array([[1.0, 0.0, 0.0], [0.0, cr, -sr], [0.0, sr, cr]])

    def normals(self, s):
        """Unit normals (y, z) of the rail, to the wheel."""
        _, (y, z) = self.rail.at(s)
        return np.stack([-z, y])

    def places(self, x, s, distance, height):
        """Places from the wheelset's centre of points at distances along the rail's normal."""
        (y, z), _ = self.rail.at(s)
        ny, nz = self.normals(s)
        centre = RADIUS + height
        return np.stack([x, y + distance * ny - self.motion.lateral, z + distance * nz - centre])

    def distances(self, x, s, height):
        """From the rail along its normal to the wheel; below 0 where the undeformed bodies overlap."""
        x, s = np.broadcast_arrays(np.asarray(x, float), np.asarray(s, float))
        ny, nz = self.normals(s)
        direction = np.tensordot(self.turn.T, np.stack([np.zeros(s.shape), ny, nz]), 1)
        distance = np.zeros(s.shape)
        for _ in range(12):
            place = np.tensordot(self.turn.T, self.places(x, s, distance, height), 1)
            radius = np.hypot(place[0], place[2])
            depth, slope = wheel_profile(np.clip(place[1] - RUNNING_CIRCLE, -69.5, 60.0))
            outside = radius - RADIUS - depth
            grows = (place[0] * direction[0] + place[2] * direction[2]) / radius - slope * direction[1]
            # Farther away than 3 mm, and where the normal passes the wheel, no distance is needed.
            distance = distance - np.clip(outside / np.where(np.abs(grows) < 0.05, -0.05, grows), -3.0, 3.0)
        return distance

    def rigid_slip(self, cells, height):
        """Velocity of the wheel's own surface over V, along the rail and across it in the plane of each cell."""
        motion = self.motion
        at = self.places(cells.x, cells.s, self.distances(cells.x, cells.s, height), height)
        turning = motion.wheel_speed * self.turn[:, 1] + np.array([0.0, 0.0, motion.yaw_rate])
        velocity = np.cross(turning, at.T).T + np.array([motion.speed, motion.lateral_speed, 0.0])[:, None]
        _, (y, z) = self.rail.at(cells.s)
        return np.stack([velocity[0], velocity[1] * y + velocity[2] * z]) / motion.speed


def over_cells(potential, at, cells):
    """Integral over each cell of a kernel with this potential, seen from places `at`: rows are places."""
    x, s = at[0][:, None] - cells.x, at[1][:, None] - cells.s
    corners = [(i, j) for i in (-0.5, 0.5) for j in (-0.5, 0.5)]
    return sum(4 * i * j * potential(x + i * cells.length, s + j * cells.breadth) for i, j in corners)


def sinh_along(a, b):
    """Potential a arsinh(b/|a|), whose mixed derivative is b²/r³."""
    return a * np.arcsinh(b / np.where(a == 0.0, 1.0, np.abs(a)))


def normal_influence(cells):
    """Approach of both surfaces at the middle of each cell by a unit pressure on each (Boussinesq)."""
    both = over_cells(lambda a, b: sinh_along(a, b) + sinh_along(b, a), (cells.x, cells.s), cells)
    return (1 - POISSON) / (np.pi * SHEAR_MODULUS) * both


def strain(cells):
    """Growth of the displacement by unit shear on each cell, over the cell's length ahead of its middle (Cerruti)."""

    def displacement(ahead):
        at = cells.x + ahead * cells.length, cells.s
        # Integrals of x²/r³ and s²/r³, which make up that of 1/r, and of x s/r³.
        along, across = (over_cells(kernel, at, cells) for kernel in (lambda a, b: sinh_along(b, a), sinh_along))
        mixed = over_cells(lambda a, b: -np.hypot(a, b), at, cells)
        both = (1 - POISSON) * (along + across)
        return np.block([[both + POISSON * along, POISSON * mixed], [POISSON * mixed, both + POISSON * across]])

    change = displacement(1.0) - displacement(0.0)
    return change / (np.pi * SHEAR_MODULUS * np.tile(cells.length, 2)[:, None])


def grid(along, across):
    """Cells of a rectangle: from, to and how many, along and across."""
    length, breadth = ((to - start) / count for start, to, count in (along, across))
    x, s = (start + (to - start) / count * (np.arange(count) + 0.5) for start, to, count in (along, across))
    x, s = (each.ravel() for each in np.meshgrid(x, s, indexing="ij"))
    return Cells(x, s, np.full(x.size, length), np.full(x.size, breadth))


def those(cells, which):
    """Some of the cells."""
    return Cells(*(part[which] for part in cells))


def first_touch(pair):
    """Height at which the wheel touches the rail first."""
    end = pair.rail.reach()
    around = grid((-30.0, 30.0, 60), (0.5 - end, min(pair.rail.top + 35.0, end), 200))
    height = 5.0
    for _ in range(MOST_STEPS):
        distance = pair.distances(around.x, around.s, height)
        nearest = distance.argmin()
        if abs(distance[nearest]) < 1e-7:
            return height, around
        height -= distance[nearest] / max(pair.normals(around.s[nearest])[1], 0.2)
    raise DenseError("no height at which the wheel touches the rail")


def pressure_at(pair, cells, influence, height, active):
    """Pressure of the cells at a height of the wheel; `active` are those under pressure, as a guess and as found."""
    distance = pair.distances(cells.x, cells.s, height)
    for _ in range(MOST_STEPS):
        pressure = np.zeros(distance.size)
        pressure[active] = np.linalg.solve(influence[np.ix_(active, active)], -distance[active])
        found = active & (pressure >= 0.0) | ~active & (distance + influence @ pressure < -1e-9)
        if np.array_equal(found, active):
            return pressure, active
        active = found
    raise DenseError("the cells under pressure are not found")


def press(pair, cells, force, touch, guess):
    """Pressure of the cells that carries a normal force, and the height of the wheel: by regula falsi from a guess."""
    area, influence = cells.length * cells.breadth, normal_influence(cells)
    active = pair.distances(cells.x, cells.s, guess) < 0.0

    def missing(lower):
        nonlocal active
        pressure, active = pressure_at(pair, cells, influence, touch - lower, active)
        return area @ pressure - force, pressure

    low, high, at_low = 0.0, touch - guess, -force
    at_high, pressure = missing(high)
    while at_high < 0.0:
        low, at_low, high = high, at_high, 1.2 * high
        if high > 2.0:
            raise DenseError("the load is not carried by what overlaps 2 mm lower")
        at_high, pressure = missing(high)
    for _ in range(MOST_STEPS):
        lower = low - at_low * (high - low) / (at_high - at_low)
        rest, pressure = missing(lower)
        if abs(rest) < 1e-7 * force:
            return pressure, touch - lower
        # The end that stays counts half, so that it does not stay for ever.
        if rest < 0.0:
            low, at_low, at_high = lower, rest, at_high / 2
        else:
            high, at_high, at_low = lower, rest, at_low / 2
    raise DenseError("no height carries the load")


def rub(pair, cells, pressure, height):
    """Shear on the wheel by Coulomb's law, (2, cells): Newton's method on a law that is smoothed less and less."""
    rigid = pair.rigid_slip(cells, height).ravel()
    response, bound = strain(cells), FRICTION * pressure
    count = pressure.size

    def law(slip, least):
        speed = np.maximum(np.hypot(*slip.reshape(2, count)), 1e-300)
        return speed, 2 / np.pi * np.arctan(speed / least) / speed

    def residual(shear, least):
        slip = rigid - response @ shear
        return slip, shear + np.tile(bound * law(slip, least)[1], 2) * slip

    shear = np.zeros(2 * count)
    fastest = np.hypot(*rigid.reshape(2, count)).max()
    for least in fastest * np.array([1, 0.3, 0.1, 0.03, 0.01, 3e-3, 1e-3, 3e-4, 1e-4]):
        for _ in range(MOST_STEPS):
            slip, rest = residual(shear, least)
            if np.abs(rest).max() < 1e-7 * bound.max():
                break
            speed, share = law(slip, least)
            steeper = (2 / np.pi * least / (least**2 + speed**2) - share) / speed**2
            x, s = slip.reshape(2, count)
            blocks = [[share + steeper * x * x, steeper * x * s], [steeper * x * s, share + steeper * s * s]]
            by_slip = np.block([[np.diag(bound * part) for part in row] for row in blocks])
            change = np.linalg.solve(np.eye(2 * count) - by_slip @ response, -rest)
            part = 1.0
            while part > 1e-3:
                _, then = residual(shear + part * change, least)
                if then @ then < (1 - 1e-4 * part) * (rest @ rest):
                    break
                part /= 2
            shear = shear + part * change
        else:
            raise DenseError(f"the shear is not found with slip smoothed by {least:g}")
    return shear.reshape(2, count)


def islands(pair, force):
    """Rectangle around each contact, found on coarse cells; the heights of first touch and of the wheel."""
    touch, around = first_touch(pair)
    length, breadth = 1.0, 0.4
    depth, pressure = 0.1, None
    while pressure is None:
        below = pair.distances(around.x, around.s, touch - depth) < 0.0
        x, s = around.x[below], around.s[below]
        reach = [(x.min() - length, x.max() + length), (s.min() - breadth, s.max() + breadth)]
        counts = [int(np.ceil((to - start) / size)) for (start, to), size in zip(reach, (length, breadth), strict=True)]
        cells = grid((*reach[0], counts[0]), (*reach[1], counts[1]))
        cells = those(cells, pair.distances(cells.x, cells.s, touch - depth) < 0.0)
        pressure, height = press(pair, cells, force, touch, touch - depth / 2)
        if height < touch - depth:
            depth, pressure = 1.5 * depth, None
    loaded = those(cells, pressure > 0.0)
    strips = np.unique(loaded.s)
    found = []
    for group in np.split(strips, np.flatnonzero(np.diff(strips) > 1.5 * loaded.breadth[0]) + 1):
        x = loaded.x[np.isin(loaded.s, group)]
        along = x.min() - 1.5 * loaded.length[0], x.max() + 1.5 * loaded.length[0]
        found.append((along, (group[0] - 1.5 * loaded.breadth[0], group[-1] + 1.5 * loaded.breadth[0])))
    return found, touch, height


def solve(pair, force, cells, coarse):
    """Solve the contact under a normal force with so many cells along and across each contact of coarse cells."""
    found, touch, height = coarse
    parts = [grid((*along, cells[0]), (*across, cells[1])) for along, across in found]
    all_cells = Cells(*(np.concatenate(part) for part in zip(*parts, strict=True)))
    pressure, height = press(pair, all_cells, force, touch, height)
    loaded = pressure > 0.0
    all_cells, pressure = those(all_cells, loaded), pressure[loaded]
    shear = rub(pair, all_cells, pressure, height)
    area = all_cells.length * all_cells.breadth
    across = pressure * pair.normals(all_cells.s) + shear[1] * pair.rail.at(all_cells.s)[1]
    return Solution(np.array([shear[0] @ area, *(across @ area)]), pressure.max(), len(found))


def extrapolated(motion, force, cells):
    """Solution for cells of no length: strain half a cell ahead of the slip is an error of the first order."""
    pair = Pair(motion)
    coarse = islands(pair, force)
    longer, shorter = (solve(pair, force, (along, cells[1]), coarse) for along in (cells[0], 2 * cells[0]))
    return shorter._replace(force=2 * shorter.force - longer.force)


def material():
    """Parameters of the unit for the bodies here."""
    shear = 1e6 * SHEAR_MODULUS
    lame = 2 * shear * POISSON / (1 - 2 * POISSON)
    rail = {"lame_lambda": lame, "shear_modulus": shear}
    return rail | {f"wheel_{name}": value for name, value in rail.items()}


def of_right_wheel(inputs, force, cells):
    """Solution of a right wheel with the unit's inputs, in SI units: here it is its mirror image, a left wheel."""
    motion = Motion(
        lateral=-1e3 * inputs["lateral_displacement"],
        roll=-inputs["roll_angle"],
        yaw=-inputs["yaw_angle"],
        lateral_speed=-1e3 * inputs["lateral_speed"],
        yaw_rate=-inputs["yaw_rate"],
        wheel_speed=inputs["wheel_speed"],
        speed=1e3 * inputs["vehicle_speed"],
    )
    mirrored = extrapolated(motion, force, cells)
    return mirrored._replace(force=mirrored.force * [1.0, -1.0, 1.0])
