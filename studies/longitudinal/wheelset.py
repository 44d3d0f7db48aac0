"""A braking and accelerating wheelset with its share of a vehicle, made into an FMU by PythonFMU.

    .venv/bin/python -m pythonfmu build -f studies/longitudinal/wheelset.py -d target      (`make couplings` does it)

Two wheels on one axle carry a share of the vehicle along straight level track. With the contact forces T and the
friction torques M on each of the two wheels, and N on each of them the vehicle's weight,

    m dV/dt = 2 T - R(V)                       R: running resistance
    J dω/dt = M_traction - p M_brake + 2 M     p: pressure in the brake cylinder over its largest
    τ dp/dt = demand(t) release(ξ) - p         wheel-slide protection: valve and cylinder as one lag τ

Traction and brake are demanded over given intervals. The wheel-slide protection sees both speeds and lets air out of
the cylinder as the creepage -ξ grows from `slide_start` to `slide_end`. A stretch of the rail is wet. The inputs are
held over a communication step; inside, a fourth-order Runge-Kutta method takes steps of at most 1 ms.

Works and energies are states too, so the balance can be drawn up outside: see studies/longitudinal.
"""

import math

from pythonfmu import Fmi2Causality, Fmi2Slave, Fmi2Variability, Real

GRAVITY = 9.81
LONGEST = 1e-3  # s, of the inner steps
# Name and start value.
PARAMETERS = {
    "vehicle_mass": 12e3,  # kg, on this wheelset, it included
    "axle_inertia": 180.0,  # kg.m2, with the geared motor
    "wheel_radius": 0.46,  # m
    "initial_speed": 22.0,  # m/s
    "initial_creepage": 0.0,  # 1; a wheel of the rail's material rolls freely at this one
    "resistance_constant": 120.0,  # N
    "resistance_quadratic": 0.45,  # N.s2/m2
    "traction_torque": 9e3,  # N.m
    "traction_start": 0.2,  # s
    "traction_end": 2.0,  # s
    "brake_torque": 15e3,  # N.m
    "brake_start": 2.5,  # s
    "brake_end": 7.0,  # s
    "ramp": 0.4,  # s, of both demands
    "brake_lag": 0.06,  # s
    "slide_start": 0.03,  # 1
    "slide_end": 0.20,  # 1
    "wet_start": 80.0,  # m
    "wet_end": 125.0,  # m
    "wet_scale": 0.3,  # 1, friction on the wet stretch over that on the dry rail
}


def smooth(value, start, end):
    """From 0 at start to 1 at end, with zero slope at both."""
    s = min(max((value - start) / (end - start), 0.0), 1.0)
    return s * s * (3.0 - 2.0 * s)


class Wheelset(Fmi2Slave):
    """The vehicle's side of the coupling."""

    description = "Wheelset with its share of a vehicle, traction, brake and wheel-slide protection"

    INPUTS = ("traction_force", "friction_torque")
    OUTPUTS = (
        "wheel_speed",
        "vehicle_speed",
        "normal_load",
        "friction_scale",
        "brake_pressure",
        "position",
        "traction_work",
        "brake_work",
        "resistance_work",
        "kinetic_energy",
    )

    def __init__(self, **kwargs):
        """Declare the variables."""
        super().__init__(**kwargs)
        for name, start in PARAMETERS.items():
            setattr(self, name, start)
            self.declare(name, Fmi2Causality.parameter, Fmi2Variability.fixed)
        for name in self.INPUTS:
            setattr(self, name, 0.0)
            self.declare(name, Fmi2Causality.input)
        self.start()
        for name in self.OUTPUTS:
            self.declare(name, Fmi2Causality.output)

    def declare(self, name, causality, variability=Fmi2Variability.continuous):
        """Make an attribute a Real variable of the FMU."""
        self.register_variable(Real(name, causality=causality, variability=variability))

    def start(self):
        """States at the start: speed, wheel speed, brake, position, works of traction, brake and resistance."""
        wheel_speed = self.initial_speed * (1.0 + self.initial_creepage) / self.wheel_radius
        self.state = [self.initial_speed, wheel_speed, 0.0, 0.0, 0.0, 0.0, 0.0]
        self.publish()

    def exit_initialization_mode(self):
        """Parameters are final: start from them."""
        self.start()

    def publish(self):
        """Set the outputs from the states."""
        self.vehicle_speed, self.wheel_speed, self.brake_pressure, self.position = self.state[:4]
        self.traction_work, self.brake_work, self.resistance_work = self.state[4:]
        self.kinetic_energy = 0.5 * (
            self.vehicle_mass * self.vehicle_speed**2 + self.axle_inertia * self.wheel_speed**2
        )
        self.normal_load = 0.5 * self.vehicle_mass * GRAVITY
        wet = smooth(self.position, self.wet_start, self.wet_start + 2.0)
        wet -= smooth(self.position, self.wet_end - 2.0, self.wet_end)
        self.friction_scale = 1.0 + (self.wet_scale - 1.0) * wet

    def demand(self, time, start, end):
        """From 0 to 1 and back to 0, with ramps inside the interval."""
        return smooth(time, start, start + self.ramp) - smooth(time, end - self.ramp, end)

    def rates(self, time, state):
        """Time derivatives of the states, by the equations above."""
        speed, wheel_speed, pressure = state[:3]
        creepage = wheel_speed * self.wheel_radius / speed - 1.0
        release = 1.0 - smooth(-creepage, self.slide_start, self.slide_end)
        resistance = self.resistance_constant + self.resistance_quadratic * speed * speed
        traction = self.traction_torque * self.demand(time, self.traction_start, self.traction_end)
        # No torque on a wheel that stands.
        brake = -self.brake_torque * pressure * math.tanh(wheel_speed)
        return (
            (2.0 * self.traction_force - resistance) / self.vehicle_mass,
            (traction + brake + 2.0 * self.friction_torque) / self.axle_inertia,
            (self.demand(time, self.brake_start, self.brake_end) * release - pressure) / self.brake_lag,
            speed,
            traction * wheel_speed,
            brake * wheel_speed,
            resistance * speed,
        )

    def do_step(self, current_time, step_size):
        """One communication step."""
        count = math.ceil(step_size / LONGEST - 1e-9)
        step = step_size / count
        for number in range(count):
            self.runge_kutta(current_time + number * step, step)
        self.publish()
        return True

    def runge_kutta(self, time, step):
        """Fourth-order step."""

        def moved(rates, share):
            return [value + share * step * rate for value, rate in zip(self.state, rates, strict=True)]

        first = self.rates(time, self.state)
        second = self.rates(time + 0.5 * step, moved(first, 0.5))
        third = self.rates(time + 0.5 * step, moved(second, 0.5))
        fourth = self.rates(time + step, moved(third, 1.0))
        mean = [(a + 2.0 * b + 2.0 * c + d) / 6.0 for a, b, c, d in zip(first, second, third, fourth, strict=True)]
        self.state = moved(mean, 1.0)
