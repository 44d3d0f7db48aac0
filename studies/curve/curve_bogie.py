"""The bogie of studies/curve in Exudyn: rigid bodies in space, springs, and the units of four wheels.

Between a wheelset and its two rails stands one object of Exudyn, an ObjectGenericODE2 with a user function, whose force
is linear over a step:

    f = f₀ + (∂f/∂u)(u(w) − u₀)      w: the wheelset's and the rails' coordinates and their rates

f₀ are the units' forces at the end of the step before, at what they were told then, u₀, and ∂f/∂u their derivatives by
fmi2GetDirectionalDerivative; u(w), the kinematics, is linear about where the wheelset will be if it rolls on. So
Exudyn's implicit step has the contact's stiffness and the creep's damping in it. After the step the units step to where
Exudyn has gone, and their own forces are the next f₀.
"""

from concurrent.futures import ThreadPoolExecutor

import exudyn
import numpy as np
from curve_equilibrium import LONG, SETTLING, UNKNOWN_BODIES
from curve_track import INPUTS, motion, turning
from curve_vehicle import (
    ALONG,
    AXLES,
    BODY,
    BODY_HEIGHT,
    FRAME,
    GRAVITY,
    HOLD,
    INERTIA,
    MASS,
    OF_WHEEL,
    RAIL_DAMPING,
    RAIL_MASS,
    RAIL_STIFFNESS,
    SECONDARY_HEIGHT,
    SHOWN,
    SIDES,
    SPEED,
    Wheel,
    guidance,
    over_rail,
    springs,
    turn,
)
from exudyn.itemInterface import (
    LoadForceVector,
    LoadMassProportional,
    LoadTorqueVector,
    MarkerBodyMass,
    MarkerBodyRigid,
    Node1D,
    NodeRigidBodyRxyz,
    ObjectConnectorRigidBodySpringDamper,
    ObjectGenericODE2,
    ObjectRigidBody,
)
from helpers import show

STEP = 1e-3  # s: 17 mm of way
# Derivatives are renewed where the force that they foretold is off by this, and after so many steps.
MISSED, SLOPES_EVERY = 1.5e3, 80  # N, steps
SIDES_IN_TURN = tuple(SIDES.values())
COORDINATES, RATES = exudyn.OutputVariableType.Coordinates, exudyn.OutputVariableType.Coordinates_t
DIFFERENCE = 1e-6
OF_AXLE = ("place", "y", "z", "roll", "yaw", "wheel_speed", "sum_of_y")
OF_BOGIE = ("time", "place", "speed", "pull", "frame_yaw", "body_roll")


class Axle:
    """A wheelset, two rails, two units, and the force between them as Exudyn has it during a step."""

    def __init__(self, number, node, rails, wheels):
        """Nodes of Exudyn and the units."""
        self.number, self.node, self.rails, self.wheels = number, node, rails, wheels
        self.place, self.tangents = 0.0, None
        self.slopes, self.age, self.missed = [None, None], [SLOPES_EVERY] * 2, [0.0, 0.0]

    def read(self, mbs):
        """Coordinates and rates of the wheelset, then of the rails: left across and up, right across and up."""
        found = []
        for kind in (COORDINATES, RATES):
            values = [mbs.GetNodeOutput(self.node, kind), *(mbs.GetNodeOutput(rail, kind) for rail in self.rails)]
            found.append(np.concatenate([np.atleast_1d(value) for value in values]))
        found[0][:6] += self.reference
        return found

    def exchange(self, at, rates, track, step, pool):
        """Step the units to where the wheelset is, and make the force of the next step."""
        self.place, told = motion(track, at[:6], rates[:6], self.place)
        self.told, self.now = told, at
        guesses = self.guesses(at, rates)
        rails = [slice(6, 8), slice(8, 10)]

        def roll(k):
            wheel, side = self.wheels[k], SIDES_IN_TURN[k]
            wheel.roll(told, at[rails[k]], rates[rails[k]], track.uneven(side, self.place), step)
            # How far the linear force was off in the step before.
            self.missed[k] = np.abs(wheel.forces[:3] - guesses[k][:3]).max()
            self.age[k] += 1
            if self.age[k] >= SLOPES_EVERY or self.missed[k] > MISSED:
                self.slopes[k], self.age[k] = wheel.main_slopes(), 0

        list(pool.map(roll, range(2)))
        # Linear about where the wheelset will be if it rolls on as it does: on the way of a step, 17 mm, a curve of
        # 300 m departs by 0.5 µm from its tangent, and that is 0.5 kN at a flange.
        ahead, rates_ahead = self.ahead(at, rates, step, track.at(self.place)[3])
        seen, moved = self.differences(track, ahead, rates_ahead)
        _, axes = track.axes(self.place)
        carry = np.zeros((6, 6))
        carry[:3, :3], carry[3:, 3:] = axes, turning(at).T @ axes
        force, matrix = np.zeros(10), np.zeros((10, 20))
        self.tangents = [self.slopes[k] @ moved[k] for k in range(2)]
        self.expected = [
            wheel.forces + slopes @ (then - wheel.told)
            for wheel, slopes, then in zip(self.wheels, self.slopes, seen, strict=True)
        ]
        for rail, expected, tangent in zip(rails, self.expected, self.tangents, strict=True):
            force[:6] += carry @ expected
            matrix[:6] += carry @ tangent
            force[rail] = -expected[1:3]
            matrix[rail] = -tangent[1:3]
        self.at, self.rates, self.force, self.matrix = ahead, rates_ahead, force, matrix

    @staticmethod
    def ahead(at, rates, step, curvature):
        """Coordinates and rates after a step of rolling on."""
        turned = 0.5 * step * curvature * np.hypot(rates[0], rates[1])
        half = np.array([[np.cos(turned), -np.sin(turned)], [np.sin(turned), np.cos(turned)]])
        mean = rates.copy()
        mean[:2] = half @ rates[:2]
        then = rates.copy()
        then[:2] = half @ mean[:2]
        return at + step * mean, then

    def guesses(self, at, rates):
        """Forces that the linear law has for a state."""
        if self.tangents is None:
            return [wheel.forces for wheel in self.wheels]
        change = np.concatenate([at - self.at, rates - self.rates])
        return [expected + tangent @ change for expected, tangent in zip(self.expected, self.tangents, strict=True)]

    def differences(self, track, at, rates):
        """What each wheel is told, and its derivatives with respect to coordinates and rates, by differences."""
        moved = np.zeros((2, len(INPUTS), 20))

        def told(at, rates):
            place, seen = motion(track, at[:6], rates[:6], self.place)
            return [
                over_rail(seen, at[6 + 2 * k : 8 + 2 * k], rates[6 + 2 * k : 8 + 2 * k], track.uneven(side, place))
                for k, side in enumerate(SIDES.values())
            ]

        base = np.array(told(at, rates))
        for number in range(10):
            change = DIFFERENCE * np.eye(10)[number]
            moved[:, :, number] = (np.array(told(at + change, rates)) - base) / DIFFERENCE
            moved[:, :, 10 + number] = (np.array(told(at, rates + change)) - base) / DIFFERENCE
        return base, moved

    def push(self, _mbs, _time, _item, coordinates, rates):
        """The force on wheelset and rails, for Exudyn."""
        at = np.array(coordinates)
        at[:6] += self.reference
        return self.force + self.matrix @ np.concatenate([at - self.at, np.array(rates) - self.rates])

    def stiffen(self, _mbs, _time, _item, _coordinates, _rates, of_coordinates, of_rates):
        """Its derivative, as Exudyn wants it on the left-hand side."""
        return -(of_coordinates * self.matrix[:, :10] + of_rates * self.matrix[:, 10:])


class Bogie:
    """The multibody model, in the steady state of straight track at the start."""

    def __init__(self, equilibrium, track=None, step=STEP, **parameters):
        """Bodies where an equilibrium has them, rolling on as it does; on another track that is the same there."""
        self.track, self.step_size, self.place = track or equilibrium.track, step, equilibrium.place
        self.rows, self.time = [], 0.0
        # The units of an axle step beside each other.
        self.pool = ThreadPoolExecutor(2)
        self.container = exudyn.SystemContainer()
        self.mbs = self.container.AddSystem()
        self.base = base = equilibrium.base
        coordinates, rates = equilibrium.state()
        moved = coordinates - base
        self.nodes, self.bodies = [], []
        for body in range(4):
            node = self.mbs.AddNode(
                NodeRigidBodyRxyz(
                    referenceCoordinates=list(base[body]),
                    initialCoordinates=list(moved[body]),
                    initialVelocities=list(rates[body]),
                )
            )
            inertia = [*INERTIA[body], 0.0, 0.0, 0.0]
            made = self.mbs.AddObject(ObjectRigidBody(mass=MASS[body], inertia=inertia, nodeNumber=node))
            weighed = self.mbs.AddMarker(MarkerBodyMass(bodyNumber=made))
            self.mbs.AddLoad(LoadMassProportional(markerNumber=weighed, loadVector=[0.0, 0.0, -GRAVITY]))
            self.nodes.append(node)
            self.bodies.append(made)
        for spring in springs():
            self.hang(spring)
        rails = equilibrium.unknown[UNKNOWN_BODIES:].reshape(2, 4)
        self.axles = [
            self.axle(number, rails[number], coordinates[number], rates[number], parameters)
            for number in range(len(AXLES))
        ]
        self.guided = self.load(LoadTorqueVector, (0.0, 0.0, 0.0))
        self.pulled = self.load(LoadForceVector, (0.0, 0.0, SECONDARY_HEIGHT - BODY_HEIGHT))
        self.mbs.SetPreStepUserFunction(self.exchange)
        self.mbs.Assemble()

    def load(self, kind, at):
        """A load on the car body that changes from step to step."""
        marker = self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.bodies[BODY], localPosition=list(at)))
        return self.mbs.AddLoad(kind(markerNumber=marker, loadVector=[0.0, 0.0, 0.0]))

    def hang(self, spring):
        """A spring of the suspension, along the axes of its first body."""
        markers = [
            self.mbs.AddMarker(MarkerBodyRigid(bodyNumber=self.bodies[body], localPosition=list(at)))
            for body, at in ((spring.first, spring.at_first), (spring.second, spring.at_second))
        ]
        turning_free = [0.0, 0.0, 0.0]
        self.mbs.AddObject(
            ObjectConnectorRigidBodySpringDamper(
                markerNumbers=markers,
                stiffness=np.diag([*spring.stiffness, *turning_free]),
                damping=np.diag([*spring.damping, *turning_free]),
                offset=[0.0, 0.0, spring.carried / spring.stiffness[2], *turning_free],
            )
        )

    def axle(self, number, displaced, coordinates, rates, parameters):
        """Rails under a wheelset, and its contact, as they are in steady rolling."""
        rails = [self.mbs.AddNode(Node1D(initialCoordinates=[float(value)])) for value in displaced]
        axle = Axle(number, self.nodes[number], rails, [Wheel(side, **parameters) for side in SIDES])
        axle.reference, axle.place = self.base[number], self.place + ALONG[number]
        at, rates = np.concatenate([coordinates, displaced]), np.concatenate([rates, np.zeros(4)])
        for step in (*[LONG] * SETTLING, self.step_size):
            axle.exchange(at, rates, self.track, step, self.pool)
        stiffness, damping = np.array(RAIL_STIFFNESS * 2), np.array(RAIL_DAMPING * 2)
        none = np.zeros(6)
        self.mbs.AddObject(
            ObjectGenericODE2(
                nodeNumbers=[axle.node, *rails],
                massMatrix=np.diag([*none, *([RAIL_MASS] * 4)]),
                stiffnessMatrix=np.diag([*none, *stiffness]),
                dampingMatrix=np.diag([*none, *damping]),
                forceUserFunction=axle.push,
                jacobianUserFunction=axle.stiffen,
            )
        )
        return axle

    def exchange(self, mbs, _time):
        """Before each step of Exudyn: the units, the train's pull, the other bogie's guidance, a row of the table."""
        for axle in self.axles:
            axle.exchange(*axle.read(mbs), self.track, self.step_size, self.pool)
        at = mbs.GetNodeOutput(self.nodes[BODY], COORDINATES) + self.base[BODY]
        rates = mbs.GetNodeOutput(self.nodes[BODY], RATES)
        turned = turn(at[3:])
        angular = mbs.GetNodeOutput(self.nodes[BODY], exudyn.OutputVariableType.AngularVelocity)
        self.place = self.track.place_of(at[0], at[1], self.place)
        _, axes = self.track.axes(self.place)
        speed = float(rates[:3] @ axes[:, 0])
        moment = guidance(self.track, turned, angular, speed, self.place)
        pull = HOLD * (SPEED - speed)
        mbs.SetLoadParameter(self.guided, "loadVector", moment.tolist())
        mbs.SetLoadParameter(self.pulled, "loadVector", (pull * axes[:, 0]).tolist())
        frame = mbs.GetNodeOutput(self.nodes[FRAME], COORDINATES) + self.base[FRAME]
        heading = self.track.at(self.place)[2]
        row = [self.time, self.place, speed, pull, frame[5] - heading, at[3]]
        for axle in self.axles:
            row += [axle.place, *axle.told[:4], axle.told[-1], sum(wheel.forces[1] for wheel in axle.wheels)]
            for k, (side, wheel) in enumerate(zip(SIDES.values(), axle.wheels, strict=True)):
                rail = axle.now[6 + 2 * k : 8 + 2 * k] + self.track.uneven(side, axle.place)
                forces = wheel.forces
                row += [-side * forces[1], forces[2], forces[0], *rail, axle.missed[k], *wheel.get(*SHOWN)]
        self.rows.append(row)
        self.time += self.step_size
        if len(self.rows) % 100 == 0:
            show(min(self.time / self.stop, 1.0), "bogie")
        return True

    def run(self, length):
        """Roll over a length of track by generalised alpha; return the table of all steps."""
        self.stop = length / SPEED
        settings = exudyn.SimulationSettings()
        settings.timeIntegration.numberOfSteps = round(self.stop / self.step_size)
        settings.timeIntegration.endTime = settings.timeIntegration.numberOfSteps * self.step_size
        settings.timeIntegration.verboseMode = 0
        settings.timeIntegration.generalizedAlpha.spectralRadius = 0.6
        settings.timeIntegration.adaptiveStep = False
        # Forces [N]: at a stiffness of 1e9 N/m and places of 100 m round-off leaves 1e-5 N.
        settings.timeIntegration.newton.absoluteTolerance = 1e-3
        settings.timeIntegration.newton.useModifiedNewton = False
        settings.solution.file.write = False
        exudyn.config.printToConsole = False
        done = self.mbs.SolveDynamic(settings)
        exudyn.config.printToConsole = True
        if not done:
            raise RuntimeError(f"the multibody solver stopped at {self.time:g} s")
        return self.table()

    def table(self):
        """Return all steps."""
        names = list(OF_BOGIE)
        for axle in AXLES:
            names += [f"{name}_{axle}" for name in OF_AXLE]
            names += [f"{name}_{axle}_{side}" for side in SIDES for name in OF_WHEEL]
        return np.array([tuple(row) for row in self.rows], dtype=[(name, float) for name in names])

    def close(self):
        """Free all wheels."""
        self.pool.shutdown()
        for axle in self.axles:
            for wheel in axle.wheels:
                wheel.close()
