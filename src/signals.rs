//! What goes into a step and what comes out of it: names, units, ranges and descriptions.

use crate::error::Result;
use crate::parameters::{Parameters, SlipSource, check_range};
use serde::{Deserialize, Serialize};

/// The continuous inputs at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Inputs {
    /// Angular speed ω of the wheel, positive when it rolls towards +x₁, `rad/s`.
    pub wheel_speed: f64,
    /// Normal load N, `N`; 0 is a lifted wheel.
    pub normal_load: f64,
    /// Creepage ξ = (ω r₀ − V)/V, `1`; used under [`SlipSource::Creepage`].
    pub creepage: f64,
    /// Speed V of the wheel's axle along the rail, `m/s`; used under [`SlipSource::VehicleSpeed`].
    pub vehicle_speed: f64,
    /// Factor on the friction coefficient (wet or contaminated rail, sanding), `1`.
    pub friction_scale: f64,
    /// Ambient temperature, `K`; the rail's and the wheel's far away from the contact.
    pub ambient_temperature: f64,
    /// Temperature of the rail's skin where it enters, `K` (`heat::incoming`).
    pub incoming_temperature: f64,
    /// Wear depth of the rail where it enters, `m`.
    pub incoming_wear_depth: f64,
}

/// The outputs at one instant.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Outputs {
    /// Force T on the wheel along x₁, `N`.
    pub traction_force: f64,
    /// Torque −(T r₀ + N e) on the wheel about its axle, `N·m`.
    pub friction_torque: f64,
    /// Largest absolute temperature of the rail surface, `K`.
    pub peak_temperature: f64,
    /// T / N, `1`; 0 when lifted.
    pub traction_coefficient: f64,
    /// ξ = (ω r₀ − V)/V, `1`.
    pub slip_creepage: f64,
    /// Penetration δ, `m`; 0 when lifted.
    pub penetration: f64,
    /// Length of the contact, `m`.
    pub contact_length: f64,
    /// Position e of the pressure's resultant ahead of the axle, `m`.
    pub contact_offset: f64,
    /// Largest contact pressure, `Pa`.
    pub peak_pressure: f64,
    /// Largest magnitude of the shear traction, `Pa`.
    pub peak_shear: f64,
    /// Share of the contact that sticks, `1`.
    pub stick_fraction: f64,
    /// Pressure-weighted mean of μ(θ), `1`.
    pub friction_coefficient: f64,
    /// Friction power b ∫ |τ s| dx, `W`.
    pub friction_power: f64,
    /// Heat flowing into the rail through the contact, `W`.
    pub rail_heat_flow: f64,
    /// Wear depth behind the contact, what came in with the rail included, `m`.
    pub wear_depth: f64,
    /// Volume worn per time, `m³/s`.
    pub wear_rate: f64,
    /// Volume worn since the start, `m³`.
    pub worn_volume: f64,
    /// Friction work since the start, `J`.
    pub friction_energy: f64,
    /// Distance ∫|V| dt rolled since the start, `m`.
    pub distance: f64,
    /// Temperature T_w of the wheel's rim, `K` ([`crate::contact::rim`]).
    pub wheel_temperature: f64,
    /// Heat flowing into the wheel through the contact, `W`.
    pub wheel_heat_flow: f64,
    /// Radius that the wheel has lost by wear since the start, `m`.
    pub wheel_wear_depth: f64,
    /// Temperature of the rail's skin where it leaves, `K` (`heat::incoming`).
    pub leaving_temperature: f64,
    /// Wear depth of the rail where it leaves, `m`.
    pub leaving_wear_depth: f64,
}

/// One row of the table of inputs.
pub struct InputSignal {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Start value.
    pub default: f64,
    /// Smallest allowed value.
    pub minimum: f64,
    /// Largest allowed value.
    pub maximum: f64,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Inputs) -> f64,
    /// Writes the value.
    pub set: fn(&mut Inputs, f64),
}

/// One row of the table of outputs.
pub struct OutputSignal {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Smallest possible value, where there is one.
    pub minimum: Option<f64>,
    /// Largest possible value, where there is one.
    pub maximum: Option<f64>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Outputs) -> f64,
    /// Writes the value.
    pub set: fn(&mut Outputs, f64),
}

macro_rules! input {
    ($field:ident, $unit:literal, $default:expr, $minimum:expr, $maximum:expr, $nominal:expr, $description:literal) => {
        InputSignal {
            name: stringify!($field),
            unit: $unit,
            default: $default,
            minimum: $minimum,
            maximum: $maximum,
            nominal: $nominal,
            description: $description,
            get: |i| i.$field,
            set: |i, value| i.$field = value,
        }
    };
}

macro_rules! output {
    ($field:ident, $unit:literal, $minimum:expr, $maximum:expr, $nominal:expr, $description:literal) => {
        OutputSignal {
            name: stringify!($field),
            unit: $unit,
            minimum: $minimum,
            maximum: $maximum,
            nominal: $nominal,
            description: $description,
            get: |o| o.$field,
            set: |o, value| o.$field = value,
        }
    };
}

/// The inputs in the order in which they are listed. The ranges of load and speed are narrowed by the parameters:
/// see [`Inputs::check`].
#[rustfmt::skip]
pub const INPUTS: &[InputSignal] = &[
    input!(wheel_speed, "rad/s", 10.0 / 0.46, -1e4, 1e4, 20.0, "Angular speed of the wheel, positive when it rolls in the direction of travel"),
    input!(normal_load, "N", 60e3, 0.0, 1e7, 6e4, "Normal load of the wheel on the rail, at most largest_load; 0 is a lifted wheel"),
    input!(creepage, "1", 0.0, -0.99, 100.0, 1e-2, "Creepage (wheel_speed*wheel_radius - V)/V, used where slip_source is creepage"),
    input!(vehicle_speed, "m/s", 10.0, -1e3, 1e3, 10.0, "Speed of the wheel's axle along the rail, used where slip_source is vehicle_speed"),
    input!(friction_scale, "1", 1.0, 0.0, 2.0, 1.0, "Factor on the friction coefficient for a wet, contaminated or sanded rail"),
    input!(ambient_temperature, "K", 293.15, 100.0, 1000.0, 300.0, "Ambient temperature, the temperature of rail and wheel away from the contact"),
    input!(incoming_temperature, "K", 293.15, 100.0, 3000.0, 300.0, "Absolute temperature of the rail entering at the leading edge of the strip, over skin_depth: leaving_temperature of the wheel in front, or the ambient's"),
    input!(incoming_wear_depth, "m", 0.0, 0.0, 1e-2, 1e-7, "Depth of wear of the rail entering at the leading edge of the strip: leaving_wear_depth of the wheel in front"),
];

/// The outputs in the order in which they are listed.
#[rustfmt::skip]
pub const OUTPUTS: &[OutputSignal] = &[
    output!(traction_force, "N", None, None, 1e4, "Friction force on the wheel along the rail, positive when it drives the vehicle forward"),
    output!(friction_torque, "N.m", None, None, 1e4, "Torque of the contact forces on the wheel about its axle"),
    output!(peak_temperature, "K", Some(0.0), None, 300.0, "Largest absolute temperature of the rail surface"),
    output!(traction_coefficient, "1", None, None, 0.1, "Friction force over normal load"),
    output!(slip_creepage, "1", None, None, 1e-2, "Creepage (wheel_speed*wheel_radius - V)/V of the last step"),
    output!(penetration, "m", None, None, 1e-4, "Penetration of the undeformed wheel into the undeformed rail, 0 when lifted"),
    output!(contact_length, "m", Some(0.0), None, 1e-2, "Length of the contact along the rail"),
    output!(contact_offset, "m", None, None, 1e-4, "Position of the resultant of the contact pressure ahead of the axle"),
    output!(peak_pressure, "Pa", Some(0.0), None, 1e9, "Largest contact pressure"),
    output!(peak_shear, "Pa", Some(0.0), None, 1e8, "Largest magnitude of the shear traction"),
    output!(stick_fraction, "1", Some(0.0), Some(1.0), 1.0, "Share of the contact length that sticks"),
    output!(friction_coefficient, "1", Some(0.0), None, 0.1, "Pressure-weighted mean of the friction coefficient"),
    output!(friction_power, "W", Some(0.0), None, 1e4, "Power dissipated by friction in the contact"),
    output!(rail_heat_flow, "W", None, None, 1e4, "Heat flowing into the rail through the contact"),
    output!(wear_depth, "m", Some(0.0), None, 1e-7, "Depth of wear behind the contact: what entered with the rail and what this passage adds"),
    output!(wear_rate, "m3/s", Some(0.0), None, 1e-9, "Volume worn off the rail per time"),
    output!(worn_volume, "m3", Some(0.0), None, 1e-9, "Volume worn off the rail since the start"),
    output!(friction_energy, "J", Some(0.0), None, 1e4, "Work dissipated by friction since the start"),
    output!(distance, "m", Some(0.0), None, 10.0, "Distance rolled since the start"),
    output!(wheel_temperature, "K", Some(0.0), None, 300.0, "Absolute temperature of the wheel's rim"),
    output!(wheel_heat_flow, "W", None, None, 1e4, "Heat flowing into the wheel through the contact"),
    output!(wheel_wear_depth, "m", Some(0.0), None, 1e-9, "Radius that the wheel has lost by wear since the start, uniform over the circumference"),
    output!(leaving_temperature, "K", None, None, 300.0, "Absolute temperature of the rail leaving at the trailing edge of the strip: its heat spread over skin_depth"),
    output!(leaving_wear_depth, "m", Some(0.0), None, 1e-7, "Depth of wear of the rail leaving at the trailing edge of the strip"),
];

/// Rows of [`OUTPUTS`] that are sums over the steps: they begin at 0 and grow at a rate.
const TOTALS: [&str; 4] = ["worn_volume", "friction_energy", "distance", "wheel_wear_depth"];

impl Outputs {
    /// The rows of the outputs that are sums over the steps.
    pub fn totals() -> impl Iterator<Item = &'static OutputSignal> {
        OUTPUTS.iter().filter(|signal| TOTALS.contains(&signal.name))
    }
}

impl Default for Inputs {
    fn default() -> Self {
        let mut inputs = Inputs {
            wheel_speed: 0.0,
            normal_load: 0.0,
            creepage: 0.0,
            vehicle_speed: 0.0,
            friction_scale: 0.0,
            ambient_temperature: 0.0,
            incoming_temperature: 0.0,
            incoming_wear_depth: 0.0,
        };
        for signal in INPUTS {
            (signal.set)(&mut inputs, signal.default);
        }
        inputs
    }
}

/// Rounding of a value at the end of a ramp, relative to the range.
const ROUNDING: f64 = 1e-12;

/// Rolling of the wheel at one instant.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Speed V of the axle along the rail, `m/s`.
    pub rolling_speed: f64,
    /// Rigid slip ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
}

impl InputSignal {
    /// The allowed range under the given parameters.
    pub fn range(&self, parameters: &Parameters) -> (f64, f64) {
        match self.name {
            "normal_load" => (self.minimum, parameters.largest_load),
            "vehicle_speed" => (-parameters.largest_speed(), parameters.largest_speed()),
            _ => (self.minimum, self.maximum),
        }
    }

    /// Refuses a value that is not finite or outside [`InputSignal::range`].
    ///
    /// # Errors
    /// [`crate::error::Error::OutOfRange`].
    pub fn check(&self, value: f64, parameters: &Parameters) -> Result<()> {
        let (minimum, maximum) = self.range(parameters);
        check_range(self.name, value, minimum, maximum, self.unit)
    }
}

impl Inputs {
    /// Checks every input, and the rolling speed that they make.
    ///
    /// # Errors
    /// [`crate::error::Error::OutOfRange`] names the first input that is not finite or out of its range.
    pub fn check(&self, parameters: &Parameters) -> Result<()> {
        for signal in INPUTS {
            signal.check((signal.get)(self), parameters)?;
        }
        self.check_motion(parameters)
    }

    /// Checks the rolling speed that the inputs make.
    ///
    /// # Errors
    /// [`crate::error::Error::OutOfRange`].
    pub fn check_motion(&self, parameters: &Parameters) -> Result<()> {
        let largest = parameters.largest_speed();
        let speed = self.motion(parameters).rolling_speed;
        check_range(
            "rolling speed V of wheel_speed and creepage",
            speed,
            -largest,
            largest,
            "m/s",
        )
    }

    /// The motion that the inputs define: V and ω r₀ − V.
    pub fn motion(&self, parameters: &Parameters) -> Motion {
        let circumferential = self.wheel_speed * parameters.wheel_radius;
        let rolling_speed = match parameters.slip_source {
            SlipSource::Creepage => circumferential / (1.0 + self.creepage),
            SlipSource::VehicleSpeed => self.vehicle_speed,
        };
        let rigid_slip = match parameters.slip_source {
            // Not the difference of two large numbers.
            SlipSource::Creepage => rolling_speed * self.creepage,
            SlipSource::VehicleSpeed => circumferential - rolling_speed,
        };
        Motion {
            rolling_speed,
            rigid_slip,
        }
    }

    /// The change of [`Inputs::motion`] with that of the inputs: dV and d(ω r₀ − V).
    pub fn motion_tangent(&self, change: &Inputs, parameters: &Parameters) -> Motion {
        let circumferential = change.wheel_speed * parameters.wheel_radius;
        let rolling_speed = match parameters.slip_source {
            SlipSource::VehicleSpeed => change.vehicle_speed,
            SlipSource::Creepage => {
                let speed = self.motion(parameters).rolling_speed;
                (circumferential - speed * change.creepage) / (1.0 + self.creepage)
            }
        };
        Motion {
            rolling_speed,
            rigid_slip: circumferential - rolling_speed,
        }
    }

    /// The inputs after `time` at the given rates of change.
    pub fn advanced(&self, rates: &Inputs, time: f64) -> Inputs {
        let mut later = *self;
        for signal in INPUTS {
            (signal.set)(&mut later, (signal.get)(self) + (signal.get)(rates) * time);
        }
        later
    }

    /// Values that miss a limit by rounding, at the end of a ramp to it, are moved onto the limit.
    pub fn snapped(&self, parameters: &Parameters) -> Inputs {
        let mut snapped = *self;
        for signal in INPUTS {
            let (value, (minimum, maximum)) = ((signal.get)(self), signal.range(parameters));
            let room = ROUNDING * (maximum - minimum);
            if value < minimum && value >= minimum - room {
                (signal.set)(&mut snapped, minimum);
            } else if value > maximum && value <= maximum + room {
                (signal.set)(&mut snapped, maximum);
            }
        }
        snapped
    }

    /// All zero: the rates of inputs that are held.
    pub const ZERO: Inputs = Inputs {
        wheel_speed: 0.0,
        normal_load: 0.0,
        creepage: 0.0,
        vehicle_speed: 0.0,
        friction_scale: 0.0,
        ambient_temperature: 0.0,
        incoming_temperature: 0.0,
        incoming_wear_depth: 0.0,
    };
}
