"""A Bo'Bo' locomotive before a heavy train: four driven wheelsets, an instance of the component each.

Each wheelset stands for its two wheels, whose contacts are alike. The rail takes heat and wear from one to the next
(studies/common/rail_trail.py). The train is a mass on a gradient.

    J dω/dt = M_motor + 2 M         m dV/dt = Σ 2 T - R(V) - m g i         τ dM_motor/dt = demanded torque - M_motor

A master steps speeds with the contacts' last forces, then the contacts with the new speeds. For studies/adhesion.
"""

import math

import numpy as np
from helpers import FMU, Instance, wheelrail
from rail_trail import Trail, skin_depths
from slip_control import PERIOD

# Wet rail under a Eurosprinter, as fitted to the creep curve that was measured with one: presets/eurosprinter.toml.
WET_RAIL = wheelrail.preset("eurosprinter")
GRAVITY = 9.81
AMBIENT = 293.15  # K
SPEED = 10.0  # m/s at the start
WHEEL_RADIUS = WET_RAIL["wheel_radius"]  # m
WHEEL_LOAD = 106.7e3  # N
AXLES = -np.array([0.0, 3.0, 9.9, 12.9])  # m, places at the start: bogies with a wheelbase of 3 m, pivots 9.9 m apart
WHEELBASE, PIVOTS = 3.0, 9.9  # m
COUPLER, LINK = 1.06, 0.25  # m above the rail: where the train pulls, and where a bogie pulls the body
SUSPENSION_LAG = 0.15  # s, with which the loads follow the tractive effort
INERTIA = 540.0  # kg.m2 of a wheelset: 150 of the wheels and the axle, 22 of the rotor at a gear ratio of 4.2
MOTOR_LAG = 10e-3  # s, of the torque
STARTING_EFFORT = 300e3  # N, of the locomotive, the driver's demand
DEMAND_RISES = 1.0  # s
LOCOMOTIVE_MASS = 8.0 * WHEEL_LOAD / GRAVITY  # kg
TRAIN_MASS = 1600e3  # kg, behind the locomotive
MASS = LOCOMOTIVE_MASS + TRAIN_MASS
GRADIENT = 0.012
RESISTANCE = (1.5e-3, 2e-5, 3e-6)  # over the weight; per speed [s/m] and its square
HALF_LENGTH = 0.5  # m, of the piece of rail of a unit
DIFFUSIVITY = 1.44e-5  # m2/s, of the rail
# A coarse patch, which is quick; the page has the adhesion on a fine one beside it.
CONTACT = WET_RAIL | {
    "patch_nodes": 16,
    "patch_strips": 11,
    "largest_load": 135e3,
    "slip_source": 2,
    "strip_half_length": HALF_LENGTH,
    "wheel_heating": 2,
    "ambient_temperature": AMBIENT,
    "incoming_temperature": AMBIENT,
}
INPUTS = ("wheel_speed", "vehicle_speed", "normal_load", "friction_scale", "incoming_temperature")
INPUTS += ("incoming_wear_depth",)
OUTPUTS = ("traction_force", "friction_torque", "leaving_temperature", "leaving_wear_depth", "contact_offset")
OUTPUTS += ("friction_power", "peak_temperature", "friction_coefficient", "wear_rate", "friction_energy")
OUTPUTS += ("wheel_temperature", "worn_volume", "rail_heat_flow")
STEP = 2.5e-3  # s
STOP = 16.0  # s


def constant_friction():
    """What makes the friction that of the ambient's temperature, whatever the contact's."""
    temperatures, coefficients = (
        [WET_RAIL[f"friction_{of}{at}"] for at in ("cold", "hot")] for of in ("temperature_", "")
    )
    return {"friction_law": 1, "friction_cold": float(np.interp(AMBIENT, temperatures, coefficients))}


def axle_loads(forces):
    """Loads of the four wheelsets [N] under their tractive forces [N], by statics.

    The train pulls the body back at the coupler, the bogies pull it at their links: the moment unloads the front bogie
    and loads the rear one. Each bogie is pulled back at its link above the rail: that unloads its front wheelset. The
    locomotive's own resistance and inertia count as if they acted at the coupler.
    """
    bogies = np.array([forces[0] + forces[1], forces[2] + forces[3]])
    body = bogies.sum() * (COUPLER - LINK) / PIVOTS
    tilt = bogies * LINK / WHEELBASE
    change = np.array([-0.5 * body - tilt[0], -0.5 * body + tilt[0], 0.5 * body - tilt[1], 0.5 * body + tilt[1]])
    return 2.0 * WHEEL_LOAD + change


def resistance(speed):
    """Running resistance of the train [N]."""
    still, linear, square = RESISTANCE
    return MASS * GRAVITY * (still + linear * speed + square * speed * speed)


class Rail:
    """Wet rail with a place where it is more slippery: friction_scale against the position on the track."""

    def __init__(self, places=(), scales=()):
        """Piecewise linear between places [m]; 1 everywhere without any."""
        self.places, self.scales = (places, scales) if len(places) else ((0.0,), (1.0,))

    def scale(self, place):
        """Factor on the friction coefficient at a place."""
        return float(np.interp(place, self.places, self.scales))


# Wet leaves from 85 to 105 m.
LEAVES = Rail((85.0, 86.0, 104.0, 105.0), (1.0, 0.5, 0.5, 1.0))


class Wheelset:
    """A driven wheelset: its speed, motor and controller, the contact of one of its wheels, the trail it leaves."""

    def __init__(self, number, controller, speed, skin_depth, **start_values):
        """At an axle, rolling freely at a speed."""
        self.controller = controller
        self.spin, self.motor, self.demand = speed / WHEEL_RADIUS, 0.0, 0.0
        self.load = 2.0 * WHEEL_LOAD
        self.skin_depth = skin_depth
        values = CONTACT | start_values
        motion = {"normal_load": WHEEL_LOAD, "vehicle_speed": speed, "wheel_speed": self.spin}
        self.contact = Instance(FMU, f"wheelset {number + 1}", skin_depth=skin_depth, **values, **motion).start()
        variables = self.contact.variables
        self.inputs, self.outputs = ([variables[name].valueReference for name in names] for names in (INPUTS, OUTPUTS))
        self.force = self.torque = 0.0
        self.entered = (0.0, 0.0)
        self.trail = Trail(AXLES[number] - HALF_LENGTH)
        # Mean torque since the controller was last called; work of the motor, of slip, and of the offset pressure.
        self.motor_mean = self.motor_work = self.slip_work = self.offset_work = 0.0

    def turn(self, step):
        """Step motor and speed, with the contacts' last torque."""
        self.motor += (1.0 - math.exp(-step / MOTOR_LAG)) * (self.demand - self.motor)
        before = self.spin
        self.spin += step / INERTIA * (self.motor + 2.0 * self.torque)
        self.motor_mean += step / PERIOD * self.motor
        self.motor_work += step * self.motor * 0.5 * (before + self.spin)

    def roll(self, step, speed, scale, incoming):
        """Step the contact; return what was set and what came out."""
        values = [self.spin, speed, 0.5 * self.load, scale, *incoming]
        self.contact.slave.setReal(self.inputs, values)
        self.contact.step(step)
        outputs = self.contact.slave.getReal(self.outputs)
        self.force, self.torque = 2.0 * outputs[0], outputs[1]
        offset, creep = self.load * outputs[4], self.spin - speed / WHEEL_RADIUS
        self.slip_work += step * (self.force * WHEEL_RADIUS * creep + offset * speed / WHEEL_RADIUS)
        self.offset_work += step * offset * creep
        return values + outputs


class Locomotive:
    """Four wheelsets one behind the other on a rail, and the train behind them."""

    def __init__(self, controllers, rail=LEAVES, chained=True, noise=0.0, **start_values):
        """With a controller for each wheelset; without the chain all of them find the rail of the first.

        The speeds that the controllers see have white noise of a standard deviation [m/s], at the tread.
        """
        depths = skin_depths(AXLES, HALF_LENGTH, SPEED, DIFFUSIVITY)
        self.wheelsets = [
            Wheelset(number, controller, SPEED, float(depth), **start_values)
            for number, (controller, depth) in enumerate(zip(controllers, depths, strict=True))
        ]
        self.rail, self.chained = rail, chained
        self.noise, self.random = noise / WHEEL_RADIUS, np.random.default_rng(1)
        self.speed, self.time, self.distance = SPEED, 0.0, 0.0
        self.carried = np.zeros(4)  # forces that the suspension has followed
        self.resistance_work = self.climb_work = 0.0

    def arrives(self, number, distance):
        """Temperature and wear of the rail that comes in: means over the distance of a step of the trail in front."""
        if number == 0 or not self.chained:
            return AMBIENT, 0.0
        wheelset = self.wheelsets[number]
        front = AXLES[number] + HALF_LENGTH + self.distance + distance
        heat, wear = self.wheelsets[number - 1].trail.until(front)
        entered, wheelset.entered = wheelset.entered, (heat, wear)
        return AMBIENT + (heat - entered[0]) / (distance * wheelset.skin_depth), (wear - entered[1]) / distance

    def control(self):
        """Let the controllers demand torques."""
        driver = STARTING_EFFORT / 4.0 * WHEEL_RADIUS * min(self.time / DEMAND_RISES, 1.0)
        for wheelset in self.wheelsets:
            seen = wheelset.spin + self.noise * self.random.standard_normal()
            wheelset.demand = wheelset.controller.torque(self.time, seen, self.speed, wheelset.motor_mean, driver)
            wheelset.motor_mean = 0.0

    def advance(self, step):
        """One step of all; return a row for each wheelset."""
        before = self.speed
        effort = sum(wheelset.force for wheelset in self.wheelsets)
        resisting, climbing = resistance(before), MASS * GRAVITY * GRADIENT
        self.speed += step / MASS * (effort - resisting - climbing)
        middle = 0.5 * (before + self.speed)
        self.resistance_work += step * middle * resisting
        self.climb_work += step * middle * climbing
        forces = np.array([wheelset.force for wheelset in self.wheelsets])
        self.carried += (1.0 - math.exp(-step / SUSPENSION_LAG)) * (forces - self.carried)
        for wheelset, load in zip(self.wheelsets, axle_loads(self.carried), strict=True):
            wheelset.turn(step)
            wheelset.load = float(load)
        distance = self.speed * step
        incoming = [self.arrives(number, distance) for number in range(len(self.wheelsets))]
        rows = []
        for number, wheelset in enumerate(self.wheelsets):
            scale = self.rail.scale(self.distance + distance + AXLES[number])
            row = wheelset.roll(step, self.speed, scale, incoming[number])
            temperature, wear = row[len(INPUTS) + 2], row[len(INPUTS) + 3]
            wheelset.trail.leave(distance, (temperature - AMBIENT) * wheelset.skin_depth, wear)
            rows.append([*row, wheelset.motor])
        self.time += step
        self.distance += distance
        return rows

    def kinetic(self):
        """Kinetic energy of train and wheelsets [J]."""
        turning = sum(0.5 * INERTIA * wheelset.spin**2 for wheelset in self.wheelsets)
        return 0.5 * MASS * self.speed**2 + turning

    def run(self, stop=STOP, step=STEP):
        """Run and free; return a table, a row for each control period, and the books of energy and momentum."""
        each = round(PERIOD / step)
        began = self.kinetic()
        spins = np.array([wheelset.spin for wheelset in self.wheelsets])
        pushed, turned = 0.0, np.zeros(4)
        times, rows = [], []
        for number in range(round(stop / step)):
            if number % each == 0:
                self.control()
            pushed += step * (sum(wheelset.force for wheelset in self.wheelsets) - resistance(self.speed))
            torques = np.array([2.0 * wheelset.torque for wheelset in self.wheelsets])
            row = self.advance(step)
            turned += step * (torques + [wheelset.motor for wheelset in self.wheelsets])
            if (number + 1) % each == 0:
                times.append((self.time, self.distance, self.speed))
                rows.append(row)
        values = np.array(rows)
        names = (*INPUTS, *OUTPUTS, "motor_torque")
        table = {name: values[:, :, column] for column, name in enumerate(names)}
        table |= dict(zip(("time", "distance", "speed"), np.array(times).T, strict=True))
        energies = {
            "work of the motors": sum(wheelset.motor_work for wheelset in self.wheelsets),
            "climbing": self.climb_work,
            "running resistance": self.resistance_work,
            "friction": 2.0 * float(table["friction_energy"][-1].sum()),
            "change of kinetic energy": self.kinetic() - began,
            "offset of the pressure": sum(wheelset.offset_work for wheelset in self.wheelsets),
        }
        # What the contacts' friction power leaves out: work on the thermal bulge and the worn surface, and the springs.
        slipping = sum(wheelset.slip_work for wheelset in self.wheelsets)
        energies["bulge, wear and springs of the contacts"] = slipping - energies["friction"]
        energies["missing: the coupling"] = 2.0 * energies["work of the motors"] - sum(energies.values())
        books = {
            "energies": energies,
            "impulse": pushed - MASS * GRAVITY * GRADIENT * self.time,
            "momentum": MASS * (self.speed - SPEED),
            "angular impulse": turned,
            "angular momentum": INERTIA * (np.array([wheelset.spin for wheelset in self.wheelsets]) - spins),
        }
        for wheelset in self.wheelsets:
            wheelset.contact.close()
        return table, books
