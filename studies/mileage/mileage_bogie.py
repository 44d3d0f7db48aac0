"""The bogie of studies/mileage on a worker: four worn wheels in steady curving, and what wears them there.

Steady curving is that of curve_equilibrium.py, by Newton's method with the units' own derivatives, and no time is
stepped. Two things are added to it.

A wheel has a profile of its own, and the radius that its running circle has left.

Irregularities that are short against the frame's way of following them leave the frame where it is: the rails under a
wheelset lie off their places by d, and the wheelset finds its own equilibrium between its springs and its contacts.
States are sampled so, about the equilibrium of the curve, at quantiles of a normal distribution of d.
"""

import time
from dataclasses import dataclass, replace
from functools import cache
from statistics import NormalDist

import numpy as np
from curve_equilibrium import LONG, MOST, PULL, PULL_UNIT, RAILS, UNKNOWN_BODIES, Equilibrium
from curve_track import LATERAL, Layout, Track
from curve_vehicle import FRAME, SIDES, WHEELS, Vehicle
from dask_runs import local_file
from helpers import wheelrail
from mileage_units import TimedWheel, profile_file

# A place on straight track, one in the curve.
ON_STRAIGHT, IN_CURVE = 6.0, 100.0  # m
# Unknowns of the wheelsets and of the rails: what moves where the frame stays.
OF_WHEELSETS = np.r_[0 : 6 * FRAME, UNKNOWN_BODIES : UNKNOWN_BODIES + RAILS]
HELD = np.r_[6 * FRAME : UNKNOWN_BODIES]
# Largest force or moment that is left. Where contacts jump between places, or windows change their strips, forces have
# steps, and Newton's method may find nothing better than such a step: it is taken, if it is not too large, and counted.
# An equilibrium, about which states are sampled, may be less good than these; where it is not even that, frame and body
# stay where the step of mileage before had them.
TOLERANCE, ACCEPTED, ACCEPTED_MIDDLE, MOST_ITERATIONS = 1.0, 3e3, 1e4, 45  # N, N.m
# The suspension's derivatives hardly change: they are renewed after so many iterations.
RENEWED = 40
# Below this residual, one that does not fall by a tenth makes the changes shorter, and ends it after some tries.
NEAR, TRIES = 1e4, 6  # N, N.m
# Share of the residual that an iteration may leave for the contacts' derivatives to be kept in the next one.
FAST = 0.2
# How often a state that a wheel refuses is left, and the way back from the flange where there is no state before it.
REFUSED_MOST, BACK = 8, 2e-4  # m
OFFSET_MOST = 5e-4  # m: by which rails are moved at once
DEBUG = False
ACCELERATION = 1e-3  # of the wear that is measured
# What each wheel is asked in each state, beside Y and Q.
ASKED = ("contacts", "wear_number", "rcf_damage", "peak_temperature", "peak_pressure")


@dataclass(frozen=True)
class Settings:
    """What all tasks of a run have in common: the vehicle, parameters of the units, how many states are sampled.

    Where the parameters name a file of a rail, rail is its text in SIMPACK's format: workers need not have the file.
    """

    vehicle: Vehicle
    parameters: tuple  # pairs of name and value
    samples: int
    samples_straight: int
    rail: str | None = None


@dataclass(frozen=True)
class WornWheel:
    """A wheel as a worker is given it.

    Profile as a text in SIMPACK's format, depth at its running circle, ends of the cells as arc lengths of the worn
    profile.
    """

    profile: str
    depth: float  # m
    ends: tuple  # m


@cache
def track_of(radius, cant):
    """The track of a class: straight, or a transition and a curve."""
    return Track(Layout() if np.isinf(radius) else Layout(radius=radius, cant=cant))


def offsets(count, deviation):
    """Lateral displacements of the track under both wheelsets, as often one as the other: [sample][axle].

    Each wheelset has all quantiles, the trailing one in another order.
    """
    quantiles = np.array([NormalDist().inv_cdf((k + 0.5) / count) for k in range(count)])
    # Pairs change their signs only where both do, so that the mirrored track has the same pairs.
    number = np.arange(count)
    order = (2 * number + count // 2 + 1) % count if count % 2 else (2 * number + 1) % (count + 1)
    return deviation * np.column_stack([quantiles, quantiles[order]])


class WornBogie(Equilibrium):
    """Steady curving on worn wheels in a class of the line."""

    def __init__(self, fmu, settings, wheels, curve, place):
        """Units of the wheels, leading left and right, trailing left and right."""
        self.worn, self.fmu = wheels, fmu
        self.free, self.kept, self.age, self.ahead, self.saved = slice(None), None, 0, np.zeros(2), None
        parameters = (
            {"wheel_profile_wear": "on", "wheel_wear_law": "wear_law", "wear_acceleration": 0.0}
            | dict(settings.parameters)
            | {
                "friction_cold": curve.friction,
                "gauge_face_friction_scale": curve.gauge_face_friction,
            }
        )
        if settings.rail is not None:
            parameters["rail_profile"] = str(profile_file(settings.rail, ".prr"))
        track = track_of(curve.radius, curve.cant)
        super().__init__(track, place, curve.speed, settings.vehicle, **parameters)
        # A wheel whose radius has become less stands as if its rail were lower.
        self.own = np.array([(0.0, -wheel.depth) for wheel in wheels]).reshape(2, 2, 2)
        self.uneven = self.own.copy()
        self.traction = curve.traction

    def made_wheels(self, **parameters):
        """Units of the wheels, [axle][side], with profiles and radii of their own."""
        made = []
        for (_, side), worn in zip(WHEELS, self.worn, strict=True):
            radius = self.vehicle.wheel_radius - worn.depth
            path = str(profile_file(worn.profile))
            made.append(TimedWheel(side, self.fmu, wheel_profile=path, wheel_radius=radius, **parameters))
        return [made[:2], made[2:]]

    def start_from(self, other):
        """Take over the unknowns of the bogie on straight track, in the axes of this one's."""
        self.unknown, self.kept = other.unknown.copy(), None
        for body, along in enumerate(self.vehicle.along):
            _, (there, here) = zip(*(each.track.axes(each.place + along) for each in (other, self)), strict=True)
            self.unknown[6 * body : 6 * body + 3] = here @ there.T @ other.unknown[6 * body : 6 * body + 3]
        self.unknown[PULL] = other.unknown[PULL]
        return self

    def displaced(self, offsets, unknown):
        """Put the rails under the wheelsets off their places, from an equilibrium whose frame and body stay."""
        self.uneven, self.unknown = self.own.copy(), unknown.copy()
        self.free, self.ahead = OF_WHEELSETS, np.array(offsets)
        # Whatever was before: a state is the same in any order, and on any worker.
        if self.saved is None:
            self.saved = [wheel.save() for wheel in self.all_wheels()]
        for wheel, saved in zip(self.all_wheels(), self.saved, strict=True):
            wheel.restore(saved)

    def all_wheels(self):
        """Units of the wheels, one after the other."""
        return [wheel for pair in self.wheels for wheel in pair]

    def parts(self, forces):
        """Those of the equilibrium, which are kept for some iterations, and for all samples about it."""
        if self.kept is None or (self.age >= RENEWED and self.saved is None):
            self.kept, self.age = super().parts(forces), 0
        self.age += 1
        return self.kept

    def slopes(self, whole):
        """Derivatives of the units where they are: if not whole, of a wheel with one contact from half of the calls."""
        single = [[not whole and wheel.get("contacts")[0] == 1.0 for wheel in pair] for pair in self.wheels]
        return np.array(
            [
                [wheel.main_slopes() if one else wheel.slopes() for one, wheel in zip(ones, pair, strict=True)]
                for ones, pair in zip(single, self.wheels, strict=True)
            ]
        )

    def settle(self):
        """Newton's method; return the largest force that is left, and the iterations.

        Rails that are to lie off their places move there during the first iterations, each of which follows them by
        its derivatives.
        """
        best, at, since, share_of_change = np.inf, self.unknown, 0, 1.0
        previous, refused, derivatives, last = None, 0, None, np.inf
        for iteration in range(1, MOST_ITERATIONS + 1):
            try:
                _, forces, _ = self.contacts(slopes=False)
            except wheelrail.SimulationError:
                # Overloaded or beside the rail: half of the way back, or, at first, towards the middle of the track.
                refused += 1
                if refused > REFUSED_MOST:
                    raise
                if previous is None:
                    self.unknown[[1, 7]] -= BACK * np.sign(self.unknown[[1, 7]])
                else:
                    self.unknown = 0.5 * (self.unknown + previous)
                continue
            previous = self.unknown
            left = self.residual(self.unknown, forces)[self.free]
            size, there = np.abs(left).max(), not self.ahead.any()
            # Derivatives cost more than steps: they serve as long as the residual falls fast.
            if derivatives is None or not there or size > FAST * last:
                derivatives = self.slopes(whole=since > 0)
            last = size
            if there and size < 0.9 * best:
                best, at, since, share_of_change, self.forces = size, self.unknown, 0, 1.0, forces
            elif best < NEAR:
                # It goes to and fro over a step of the forces.
                since, share_of_change = since + 1, 0.4
            if since > TRIES:
                break
            if there and size < TOLERANCE:
                return size, iteration
            parts = self.parts(forces)
            share = min(1.0, OFFSET_MOST / np.abs(self.ahead).max()) if not there else 0.0
            moved = share * self.ahead
            # The rails under a wheelset move: over them it moves the other way.
            by_rails = -np.einsum("asf,a->asf", derivatives[..., LATERAL], moved).ravel()
            left = left + (parts[1] @ by_rails)[self.free]
            change = np.zeros(len(self.unknown))
            matrix = self.matrix(derivatives, parts)
            change[self.free] = np.linalg.solve(matrix[self.free][:, self.free], -left)
            # Shorter where a wheelset would move far: derivatives hold where the contact stays the same.
            most = np.abs(change[:12].reshape(2, 6)) / MOST
            self.unknown = self.unknown + share_of_change * change / max(1.0, most.max())
            self.uneven[:, :, 0] += moved[:, None]
            self.ahead = self.ahead - moved if share < 1.0 else np.zeros(2)
        self.unknown = at
        self.contacts(slopes=False)
        return best, iteration

    def attempt(self):
        """Call settle(); where a wheel is overloaded or derailed, or none touches, no equilibrium is found."""
        try:
            return self.settle()
        except (wheelrail.SimulationError, np.linalg.LinAlgError):
            return np.inf, MOST_ITERATIONS

    def of_wheels(self):
        """What tables have of each wheel in this state."""
        found = []
        for (axle, side), (_, side_name), wheel in zip(np.ndindex(2, 2), WHEELS, self.all_wheels(), strict=True):
            _, left, up, *_ = self.forces[axle, side]
            values = dict(zip(ASKED, wheel.get(*ASKED), strict=True))
            found.append({"Y": -SIDES[side_name] * left, "Q": up} | values)
        return found

    def worn_off(self, number):
        """Area of each cell of a wheel that wears off per distance [m]."""
        return np.diff(np.interp(self.worn[number].ends, *worn_in(self.all_wheels()[number])))


# ---- a task ---------------------------------------------------------------------------------------------------------


class NoEquilibriumError(RuntimeError):
    """Newton's method found no steady curving."""


def no_equilibrium(curve, offset, left):
    """Return the error that says where, and what force is left [N]; with a text alone, so that it can be pickled."""
    why = f"{left:.0f} N are left over" if np.isfinite(left) else "wheels are lifted, overloaded or off the rail"
    return NoEquilibriumError(
        f"{curve.name}, {3.6 * curve.speed:.0f} km/h, cant {1e3 * curve.cant:.0f} mm, rails off by"
        f" {1e3 * offset[0]:.1f} and {1e3 * offset[1]:.1f} mm: no equilibrium found, {why}"
    )


@dataclass(frozen=True)
class Starts:
    """Unknowns of a class's equilibrium and of its samples, and the depths at the running circles that these are of."""

    unknowns: tuple
    depths: tuple  # m

    def for_wheels(self, number, wheels, radius):
        """Unknowns of a state, for wheels that have worn on: the wheelsets sink, and turn faster."""
        unknown = np.array(self.unknowns[number])
        for axle in range(2):
            was, now = (0.5 * sum(depths[2 * axle : 2 * axle + 2]) for depths in (self.depths, depths_of(wheels)))
            unknown[6 * axle + 2] -= now - was
            unknown[6 * axle + 5] *= (radius - was) / (radius - now)
        return unknown


def depths_of(wheels):
    """Depths at the running circles."""
    return tuple(wheel.depth for wheel in wheels)


def in_equilibrium(fmu, settings, wheels, curve, starts):
    """Return the bogie in steady curving, the force that is left and the iterations."""
    place = IN_CURVE if np.isfinite(curve.radius) else ON_STRAIGHT
    bogie = WornBogie(fmu, settings, wheels, curve, place)
    tries = []
    if starts is not None:
        bogie.unknown = starts.for_wheels(0, wheels, settings.vehicle.wheel_radius)
        tries.append((*bogie.attempt(), bogie.unknown))
        if tries[0][0] < ACCEPTED:
            return bogie, *tries[0][:2]
    # From straight track, where the wheelsets are sunk a little deeper than rails and contacts ask for.
    straight = replace(curve, radius=np.inf, cant=0.0)
    running = WornBogie(fmu, settings, wheels, straight, ON_STRAIGHT)
    for axle in range(2):
        running.unknown[6 * axle + 2] = -1.1e-3 - 0.5 * sum(depths_of(wheels)[2 * axle : 2 * axle + 2])
    running.unknown[UNKNOWN_BODIES:] = np.tile([0.0, -0.8e-3], 4)
    # What both wheelsets pull goes through the secondary springs to the body, whose place is given.
    pull = 2.0 * curve.traction
    running.unknown[[0, 6, 6 * FRAME]] = pull / (2.0 * settings.vehicle.secondary_stiffness[0])
    running.unknown[PULL] = -pull / PULL_UNIT
    running.attempt()
    running.close()
    tries.append((*bogie.start_from(running).attempt(), bogie.unknown))
    left, _, bogie.unknown = min(tries, key=lambda found: found[0])
    if left > ACCEPTED_MIDDLE:
        if starts is None:
            raise no_equilibrium(curve, (0.0, 0.0), left)
        bogie.unknown = starts.for_wheels(0, wheels, settings.vehicle.wheel_radius)
    return bogie, left, sum(iterations for _, iterations, _ in tries)


def in_sample(bogie, settings, wheels, offset, number, starts, middle):
    """Bring the bogie from the unknowns of its equilibrium into a sampled state; return what is left, iterations."""
    if starts is not None:
        bogie.displaced(offset, starts.for_wheels(number, wheels, settings.vehicle.wheel_radius))
        # Frame and body are those of the equilibrium now, and the rails lie where they are to lie.
        bogie.unknown[HELD] = middle[HELD]
        bogie.uneven[:, :, 0], bogie.ahead = np.array(offset)[:, None], np.zeros(2)
        left, iterations = bogie.attempt()
        if left < ACCEPTED:
            return left, iterations
    bogie.displaced(offset, middle)
    return bogie.attempt()


def worn_in(wheel):
    """Area that a wheel loses per distance up to places of its profile, in the state that it is in.

    One step more of the steady state is a short run, whose wear is the difference of the depths: a thousandth of it, so
    that the profile stays as it is, as it does as long as Newton's method seeks.

    Returns
    -------
    tuple
        Arc length on the profile as it was read [m], at the ends of the component's cells; area from the flange's side
        up to there, per distance [m].
    """
    before, start = wheel.profile_wear(), wheel.get("distance")[0]
    wheel.set(wear_acceleration=ACCELERATION)
    wheel.step(LONG)
    wheel.set(wear_acceleration=0.0)
    after, end = wheel.profile_wear(), wheel.get("distance")[0]
    arc = after.wheel_arc_length
    ends = np.concatenate([[1.5 * arc[0] - 0.5 * arc[1]], 0.5 * (arc[1:] + arc[:-1]), [1.5 * arc[-1] - 0.5 * arc[-2]]])
    lost = (after.wheel_depth - before.wheel_depth) / (ACCELERATION * (end - start))
    return ends, np.concatenate([[0.0], np.cumsum(lost * np.diff(ends))])


def rates(component, digest, settings, wheels, curve, starts):
    """Steady curving on worn wheels in a class of the line, sampled over the track's irregularity.

    The component comes as data with its digest; starts are what was found on these wheels when they were less worn, or
    None.

    Returns
    -------
    dict
        area: of each wheel the area of each cell that wears off per distance [m], mean over the samples. rows: what
        tables have, for each state and wheel. starts: those of the next step. left: the largest force that is left over
        in a state [N]. missed: samples without an equilibrium, which are left out. held: 1 where the frame is that of
        the step before. iterations: all of Newton's method. seconds: how long all of it took, and the units' calls.
    """
    began, before = time.perf_counter(), dict(TimedWheel.spent)
    fmu = local_file(component, digest)
    bogie, left, iterations = in_equilibrium(fmu, settings, wheels, curve, starts)
    middle = bogie.unknown
    held = int(left > ACCEPTED_MIDDLE)
    unknowns, lefts, rows = [middle], [], []
    count = settings.samples if np.isfinite(curve.radius) else settings.samples_straight
    areas = [np.zeros(len(wheel.ends) - 1) for wheel in wheels]
    for sample, offset in enumerate(offsets(count, curve.irregularity)):
        left, needed = in_sample(bogie, settings, wheels, offset, 1 + sample, starts, middle)
        iterations += needed
        if left > ACCEPTED:
            unknowns.append(middle)
            continue
        unknowns.append(bogie.unknown)
        lefts.append(left)
        for number, (area, row) in enumerate(zip(areas, bogie.of_wheels(), strict=True)):
            area += bogie.worn_off(number)
            rows.append({"sample": sample, "wheel": number, "left": left} | row)
    bogie.close()
    reached = len(lefts)
    if 2 * reached < count:
        raise no_equilibrium(curve, (0.0, 0.0), left)
    areas = [area / reached for area in areas]
    found = Starts(tuple(tuple(unknown.tolist()) for unknown in unknowns), depths_of(wheels))
    counts = {"missed": count - reached, "held": held, "iterations": iterations}
    seconds = {what: spent - before[what] for what, spent in TimedWheel.spent.items()}
    seconds["all"] = time.perf_counter() - began
    return {"area": areas, "rows": rows, "starts": found, "left": max(lefts), "seconds": seconds, **counts}


def rates_or_error(*given):
    """Return what `rates` does, or its error where there is no equilibrium: Dask would log at length what is raised."""
    try:
        return rates(*given)
    except NoEquilibriumError as error:
        return error
