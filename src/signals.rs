//! Inputs and outputs of a step, each declared once: field, start value and row of the table.
//!
//! A row reads
//!
//! ```text
//! /// The description: one sentence, on as many lines as it needs.
//! name symbol: columns
//! ```
//!
//! where the symbol is that of the equations, where there is one. The order is that of the table and of a saved state.
//!
//! An input that only one slip_source uses has the column `by creepage` or `by vehicle_speed`; the end of its description
//! follows from it, and from the column `patch only`.

// First, because the tables below are written in its macros.
#[macro_use]
mod rows;

mod motion;
#[cfg(test)]
mod tests;
mod totals;

use crate::error::{Error, Result};
use crate::parameters::{ContactModel, Parameters, SlipSource, check_range};
use serde::{Deserialize, Serialize};

use motion::LARGEST_SPEED;
pub use motion::Motion;
pub use totals::Totals;

/// One row of the table of inputs.
pub struct InputSignal {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the value.
    pub display_unit: Option<&'static str>,
    /// Start value.
    pub default: f64,
    /// Smallest value that any parameters allow, as the model description says it.
    pub minimum: f64,
    /// Largest value that any parameters allow.
    pub maximum: f64,
    /// The range that the parameters leave; [`InputSignal::range`] reads it.
    limits: fn(&Parameters) -> (f64, f64),
    /// Parameters that narrow the range, and how, in words for a refusal; empty where none does.
    pub narrowed_by: &'static str,
    /// The only `slip_source` that uses it; `None` where each does.
    pub slip_source: Option<SlipSource>,
    /// Whether only a patch takes another value than 0.
    pub patch_only: bool,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Inputs) -> f64,
    /// Writes the value.
    pub set: fn(&mut Inputs, f64),
}

/// Kind of an output: the way in which it follows from the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputKind {
    /// Output of the fields and the inputs at the instant.
    Instantaneous,
    /// Output of the instant that is counted in nodes: constant between jumps, its derivative is 0.
    Counted,
    /// A sum over the steps, of [`Totals`]: it starts at 0, and at a communication point it depends on no input.
    Total,
}

/// One row of the table of outputs.
pub struct OutputSignal {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the value.
    pub display_unit: Option<&'static str>,
    /// Kind of the output.
    pub kind: OutputKind,
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

inputs! {
    /// Angular speed of the wheel, positive when it rolls in the direction of travel
    wheel_speed "ω": "rad/s" shown in "rpm", start 10.0 / 0.46, range [-1e4, 1e4], nominal 20.0;
    /// Normal load of the wheel on the rail, at most largest_load; 0 is a lifted wheel
    normal_load "N": "N" shown in "kN", start 60e3, range [0.0, 1e7; |parameters| (0.0, parameters.largest_load), "largest_load sets the upper limit"], nominal 6e4;
    /// Creepage (wheel_speed*wheel_radius - V)/V
    creepage "ξ": "1", by creepage, start 0.0, range [-0.99, 100.0], nominal 1e-2;
    /// Speed of the wheel's axle along the rail
    vehicle_speed "V": "m/s" shown in "km/h", by vehicle_speed, start 10.0,
        range [-1e3, 1e3; |parameters| (-parameters.largest_speed(), parameters.largest_speed()), LARGEST_SPEED], nominal 10.0;
    /// Factor on the friction coefficient for a wet, contaminated or sanded rail
    friction_scale: "1", start 1.0, range [0.0, 2.0], nominal 1.0;
    /// Ambient temperature, the temperature of rail and wheel away from the contact
    ambient_temperature: "K" shown in "degC", start 293.15, range [100.0, 1000.0], nominal 300.0;
    /// Absolute temperature of the rail entering at the leading edge of the strip, over skin_depth:
    /// leaving_temperature of the wheel in front, or the ambient's
    incoming_temperature: "K" shown in "degC", start 293.15, range [100.0, 3000.0], nominal 300.0;
    /// Depth of wear of the rail entering at the leading edge of the strip: leaving_wear_depth of the wheel in
    /// front
    incoming_wear_depth: "m" shown in "µm", start 0.0, range [0.0, 1e-2], nominal 1e-7;
    /// Lateral creepage: lateral velocity of the wheel relative to the rail over the speed of its axle, positive to the
    /// left in the direction of x with z upward
    lateral_creepage "η": "1", by creepage, start 0.0, range [-10.0, 10.0], nominal 1e-2, patch only;
    /// Spin creepage: angular velocity of the wheel relative to the rail about the upward normal over the speed of its
    /// axle, positive anticlockwise seen from above
    spin_creepage "φ": "1/m", by creepage, start 0.0, range [-1e3, 1e3], nominal 1.0, patch only;
    /// Lateral velocity of the wheel relative to the rail, positive to the left
    lateral_speed "v_y": "m/s", by vehicle_speed, start 0.0, range [-100.0, 100.0], nominal 0.1, patch only;
    /// Angular velocity of the wheel relative to the rail about the upward normal, positive anticlockwise seen from
    /// above
    spin_rate "ω_z": "rad/s", by vehicle_speed, start 0.0, range [-1e3, 1e3], nominal 1.0, patch only;
}

outputs! {
    /// Friction force on the wheel along the rail, positive when it drives the vehicle forward
    traction_force "T": "N" shown in "kN", Instantaneous, nominal 1e4;
    /// Torque of the contact forces on the wheel about its axle
    friction_torque: "N.m" shown in "kN.m", Instantaneous, nominal 1e4;
    /// Largest absolute temperature of the rail surface
    peak_temperature: "K" shown in "degC", Instantaneous, at least 0.0, nominal 300.0;
    /// Friction force over normal load
    traction_coefficient: "1", Instantaneous, nominal 0.1;
    /// Creepage (wheel_speed*wheel_radius - V)/V of the last step
    slip_creepage "ξ": "1", Instantaneous, nominal 1e-2;
    /// Penetration of the undeformed wheel into the undeformed rail, 0 when lifted
    penetration "δ": "m" shown in "µm", Instantaneous, nominal 1e-4;
    /// Length of the contact along the rail
    contact_length: "m" shown in "mm", Instantaneous, at least 0.0, nominal 1e-2;
    /// Position of the resultant of the contact pressure ahead of the axle
    contact_offset "e": "m" shown in "mm", Instantaneous, nominal 1e-4;
    /// Largest contact pressure
    peak_pressure: "Pa" shown in "MPa", Instantaneous, at least 0.0, nominal 1e9;
    /// Largest magnitude of the shear traction
    peak_shear: "Pa" shown in "MPa", Instantaneous, at least 0.0, nominal 1e8;
    /// Share of the contact length that sticks
    stick_fraction: "1", Counted, at least 0.0, at most 1.0, nominal 1.0;
    /// Pressure-weighted mean of the friction coefficient; where a layer flows, its strength over the pressure counts
    friction_coefficient "μ": "1", Instantaneous, at least 0.0, nominal 0.1;
    /// Power dissipated by friction in the contact
    friction_power: "W" shown in "kW", Instantaneous, at least 0.0, nominal 1e4;
    /// Heat flowing into the rail through the contact
    rail_heat_flow: "W" shown in "kW", Instantaneous, nominal 1e4;
    /// Depth of wear behind the contact: what entered with the rail and what this passage adds
    wear_depth: "m" shown in "µm", Instantaneous, at least 0.0, nominal 1e-7;
    /// Volume worn off the rail per time
    wear_rate: "m3/s" shown in "mm3/s", Instantaneous, at least 0.0, nominal 1e-9;
    /// Volume worn off the rail since the start
    worn_volume: "m3" shown in "mm3", Total, at least 0.0, nominal 1e-9;
    /// Work dissipated by friction since the start
    friction_energy: "J" shown in "kJ", Total, at least 0.0, nominal 1e4;
    /// Distance rolled since the start
    distance: "m" shown in "km", Total, at least 0.0, nominal 10.0;
    /// Absolute temperature of the wheel's rim
    wheel_temperature "T_w": "K" shown in "degC", Instantaneous, at least 0.0, nominal 300.0;
    /// Heat flowing into the wheel through the contact
    wheel_heat_flow: "W" shown in "kW", Instantaneous, nominal 1e4;
    /// Radius that the wheel has lost by wear since the start, uniform over the circumference
    wheel_wear_depth: "m" shown in "µm", Total, at least 0.0, nominal 1e-9;
    /// Absolute temperature of the rail leaving at the trailing edge of the strip: its heat spread over skin_depth
    leaving_temperature: "K" shown in "degC", Instantaneous, nominal 300.0;
    /// Depth of wear of the rail leaving at the trailing edge of the strip
    leaving_wear_depth: "m" shown in "µm", Instantaneous, at least 0.0, nominal 1e-7;
    /// Friction force on the wheel across the rail, positive to the left; 0 unless contact_model is patch
    lateral_force "F_y": "N" shown in "kN", Instantaneous, nominal 1e4;
    /// Moment of the shear traction on the wheel about the upward normal; 0 unless contact_model is patch
    spin_moment "M_z": "N.m", Instantaneous, nominal 10.0;
    /// Breadth of the contact across the rail; 0 unless contact_model is patch
    contact_breadth: "m" shown in "mm", Instantaneous, at least 0.0, nominal 1e-2;
    /// Area of the contact; 0 unless contact_model is patch
    contact_area: "m2" shown in "mm2", Instantaneous, at least 0.0, nominal 1e-4;
    /// Wear number: creep forces and spin moment times their creepages, work per distance rolled; 0 unless contact_model
    /// is patch
    wear_number "Tγ": "N", Instantaneous, nominal 100.0;
}

/// Rounding of a value at the end of a ramp, relative to the range.
const ROUNDING: f64 = 1e-12;

impl Outputs {
    /// The rows of the outputs that are sums over the steps.
    pub fn totals() -> impl Iterator<Item = &'static OutputSignal> {
        OUTPUTS.iter().filter(|signal| signal.kind == OutputKind::Total)
    }
}

impl InputSignal {
    /// The allowed range under the given parameters.
    pub fn range(&self, parameters: &Parameters) -> (f64, f64) {
        (self.limits)(parameters)
    }

    /// Refuses a value that is not finite or outside [`InputSignal::range`], and one that the contact model does not take.
    ///
    /// # Errors
    /// [`Error::OutOfRange`], [`Error::PatchOnly`].
    pub fn check(&self, value: f64, parameters: &Parameters) -> Result<()> {
        self.check_range(value, parameters)?;
        if self.patch_only && value != 0.0 && parameters.contact_model == ContactModel::Line {
            return Err(Error::PatchOnly { name: self.name, value });
        }
        Ok(())
    }

    /// Refuses a value that is not finite or outside [`InputSignal::range`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check_range(&self, value: f64, parameters: &Parameters) -> Result<()> {
        let (minimum, maximum) = self.range(parameters);
        check_range(self.name, value, minimum, maximum, self.unit, self.narrowed_by)
    }

    /// Refuses a value other than the start value where the motion does not follow from this input. The model itself takes
    /// any: only who asked the user for the inputs knows that one was meant.
    ///
    /// # Errors
    /// [`Error::NotUsed`].
    pub fn check_used(&self, value: f64, parameters: &Parameters) -> Result<()> {
        let chosen = parameters.slip_source;
        match self.slip_source {
            Some(source) if source != chosen && value != self.default => Err(Error::NotUsed {
                name: self.name,
                value,
                number: chosen as i32 + 1,
                choice: SlipSource::NAMES[chosen as usize],
                other_number: source as i32 + 1,
                other: SlipSource::NAMES[source as usize],
            }),
            _ => Ok(()),
        }
    }
}

impl Inputs {
    /// Checks every input, and the rolling speed that they make.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the first input that is not finite or out of its range, [`Error::PatchOnly`] one that the
    /// contact model does not take.
    pub fn check(&self, parameters: &Parameters) -> Result<()> {
        for signal in INPUTS {
            signal.check((signal.get)(self), parameters)?;
        }
        self.check_motion(parameters)
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
}
