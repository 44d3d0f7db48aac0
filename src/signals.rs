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
//! An input that only one slip_source uses has the column `by creepage` or `by vehicle_speed`, one that only a given height
//! uses `by height`, one that only a patch of given geometry uses `by geometry`; one that not every contact model takes has the column `only […]` with those that do. The end of its
//! description follows from these columns. What each of up to [`CONTACTS`] contacts has is a table of its own: a row there is
//! a field of [`ContactOutputs`], and as many rows of [`OUTPUTS`] as there are contacts.

// First, because the tables below are written in its macros.
#[macro_use]
mod rows;

mod motion;
#[cfg(test)]
mod tests;
mod totals;

use crate::error::{Error, Result};
use crate::parameters::{ContactModel, Control, Parameters, PatchGeometry, SlipSource, check_range};
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
    /// The only choice under which it is used; `None` where it is under each.
    pub used_by: Option<UsedBy>,
    /// Contact models that take another value than 0.
    pub models: &'static [ContactModel],
    /// Words for those models, with the verb, in a refusal: "2 (patch) takes".
    takers: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Inputs) -> f64,
    /// Writes the value.
    pub set: fn(&mut Inputs, f64),
}

/// Reason why a radius or a curvature of 0 is refused where it is used. Where it is not, some importers set what they are not told of to 0.
const GIVEN: &str = "patch_geometry = 2 (inputs) sets the lower limit";

/// Least value of a radius or a curvature: 0 where it is not used.
fn least_given(parameters: &Parameters, least: f64) -> f64 {
    match parameters.patch_geometry {
        PatchGeometry::Parameters => 0.0,
        PatchGeometry::Inputs => least,
    }
}

/// Choice under which an input is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum UsedBy {
    /// Choice of `slip_source`.
    SlipSource(SlipSource),
    /// Choice of `control`.
    Control(Control),
    /// Choice of `patch_geometry`.
    PatchGeometry(PatchGeometry),
}

impl UsedBy {
    /// The parameter, the number of its choice and that one's name.
    fn described(self) -> (&'static str, i32, &'static str) {
        match self {
            UsedBy::SlipSource(source) => ("slip_source", source as i32 + 1, SlipSource::NAMES[source as usize]),
            UsedBy::Control(control) => ("control", control as i32 + 1, Control::NAMES[control as usize]),
            UsedBy::PatchGeometry(geometry) => (
                "patch_geometry",
                geometry as i32 + 1,
                PatchGeometry::NAMES[geometry as usize],
            ),
        }
    }

    /// The choice that the parameters have made of the same.
    fn chosen(self, parameters: &Parameters) -> UsedBy {
        match self {
            UsedBy::SlipSource(_) => UsedBy::SlipSource(parameters.slip_source),
            UsedBy::Control(_) => UsedBy::Control(parameters.control),
            UsedBy::PatchGeometry(_) => UsedBy::PatchGeometry(parameters.patch_geometry),
        }
    }
}

/// Number of contacts that have outputs of their own.
pub const CONTACTS: usize = 4;

/// Kind of an output: the way in which it follows from the steps.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OutputKind {
    /// Output of the fields and the inputs at the instant.
    Instantaneous,
    /// Output of the instant that is counted in nodes: constant between jumps, its derivative is 0.
    Counted,
    /// Output of what the steps before the last one have left: the inputs do not move it, its derivative is 0.
    Kept,
    /// A sum over the steps, of [`Totals`]: it starts at 0, and at a communication point it depends on no input.
    Total,
}

/// One row of the table of outputs: a number, or an element of an array over the contacts. The elements of an array follow each
/// other.
#[derive(Clone, Copy)]
pub struct OutputSignal {
    /// Name, with an index where it is an element.
    pub name: &'static str,
    /// Name of the array that it is an element of, and its place there, counted from 0.
    pub array: Option<(&'static str, usize)>,
    /// Whether it is always 0 but of profiles.
    pub profiles_only: bool,
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
    /// Normal load of the wheel on the rail, where contact_model is profiles its vertical load, at most largest_load; 0 is a lifted
    /// wheel
    normal_load "N": "N" shown in "kN", by load, start 60e3, range [0.0, 1e7; |parameters| (0.0, parameters.largest_load), "largest_load sets the upper limit"], nominal 6e4;
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
    /// Lateral creepage: lateral velocity of the wheel relative to the rail, positive to the left in the direction of x with z
    /// upward, over the speed of its axle, which is negative in reverse
    lateral_creepage "η": "1", by creepage, start 0.0, range [-10.0, 10.0], nominal 1e-2, only [patch];
    /// Spin creepage: angular velocity of the wheel relative to the rail about the upward normal, positive anticlockwise seen
    /// from above, over the speed of its axle, which is negative in reverse
    spin_creepage "φ": "1/m", by creepage, start 0.0, range [-1e3, 1e3], nominal 1.0, only [patch];
    /// Lateral velocity of the wheel relative to the rail, where contact_model is profiles that of the centre of the wheelset,
    /// positive to the left
    lateral_speed "v_y": "m/s", by vehicle_speed, start 0.0, range [-100.0, 100.0], nominal 0.1, only [patch, profiles];
    /// Angular velocity of the wheel relative to the rail about the upward normal, positive anticlockwise seen from
    /// above
    spin_rate "ω_z": "rad/s", by vehicle_speed, start 0.0, range [-1e3, 1e3], nominal 1.0, only [patch];
    /// Lateral displacement of the centre of the wheelset from the middle of the track, positive to the left
    lateral_displacement "y": "m" shown in "mm", start 0.0, range [-0.1, 0.1], nominal 1e-3, only [profiles];
    /// Height of the centre of the wheelset above wheel_radius over the tops of the rails
    vertical_displacement "z": "m" shown in "mm", by height, start 0.0, range [-0.1, 0.1], nominal 1e-4, only [profiles];
    /// Roll of the wheelset about its forward axis, which is that along the track turned by yaw_angle, positive where its left wheel rises
    roll_angle "φ_x": "rad" shown in "mrad", start 0.0, range [-0.2, 0.2], nominal 1e-3, only [profiles];
    /// Yaw of the wheelset about the upward axis, positive anticlockwise seen from above
    yaw_angle "ψ": "rad" shown in "mrad", start 0.0, range [-0.2, 0.2], nominal 1e-3, only [profiles];
    /// Vertical velocity of the centre of the wheelset, positive upward
    vertical_speed "v_z": "m/s", start 0.0, range [-100.0, 100.0], nominal 0.1, only [profiles];
    /// Angular velocity of the roll of the wheelset
    roll_rate "ω_x": "rad/s", start 0.0, range [-1e3, 1e3], nominal 0.1, only [profiles];
    /// Angular velocity of the yaw of the wheelset
    yaw_rate "ω_ψ": "rad/s", start 0.0, range [-1e3, 1e3], nominal 0.1, only [profiles];
    /// Lateral displacement of the rail from its place, positive to the left
    rail_lateral_displacement: "m" shown in "mm", start 0.0, range [-0.1, 0.1], nominal 1e-3, only [profiles];
    /// Vertical displacement of the rail from its place, positive upward
    rail_vertical_displacement: "m" shown in "mm", start 0.0, range [-0.1, 0.1], nominal 1e-4, only [profiles];
    /// Roll of the rail about the axis along the track through its origin, positive where its left side rises
    rail_roll_angle: "rad" shown in "mrad", start 0.0, range [-0.2, 0.2], nominal 1e-3, only [profiles];
    /// Lateral velocity of the rail, positive to the left
    rail_lateral_speed: "m/s", start 0.0, range [-100.0, 100.0], nominal 0.1, only [profiles];
    /// Vertical velocity of the rail, positive upward
    rail_vertical_speed: "m/s", start 0.0, range [-100.0, 100.0], nominal 0.1, only [profiles];
    /// Rolling radius of the wheel at the contact
    rolling_radius "r": "m", by geometry, start 0.46,
        range [0.0, 5.0; |parameters| (least_given(parameters, 0.05), 5.0), GIVEN], nominal 0.5;
    /// Sum of the curvatures of wheel and rail along the rail at the contact
    longitudinal_curvature "1/R_x": "1/m", by geometry, start 1.0 / 0.46,
        range [0.0, 1e3; |parameters| (least_given(parameters, 1e-3), 1e3), GIVEN], nominal 1.0;
    /// Sum of the curvatures of wheel and rail across the rail at the contact
    transverse_curvature "1/R_y": "1/m", by geometry, start 1.0 / 0.3,
        range [0.0, 1e3; |parameters| (least_given(parameters, 1e-3), 1e3), GIVEN], nominal 1.0;
    /// Penetration of the undeformed wheel into the undeformed rail along the normal of the contact, negative where they are apart
    contact_penetration: "m" shown in "µm", by height, start 0.0, range [-0.1, 1e-2], nominal 1e-4, only [patch];
    /// Rate of contact_penetration, for normal_damping
    contact_penetration_speed: "m/s", by height, start 0.0, range [-100.0, 100.0], nominal 0.1, only [patch];
    /// Inclination of the contact to the plane of the track, about the axis along the track, positive where its left side is
    /// higher: force_y and force_z are the contact's forces turned by it
    contact_inclination "δ": "rad" shown in "deg", start 0.0, range [-1.6, 1.6], nominal 0.1, only [patch];
}

outputs! {
    /// Friction force on the wheel along the rail, positive when it drives the vehicle forward
    traction_force "T": "N" shown in "kN", Instantaneous, nominal 1e4;
    /// Torque of the contact forces on the wheel about its axle
    friction_torque: "N.m" shown in "kN.m", Instantaneous, nominal 1e4;
    /// Largest absolute temperature of the rail surface: of a line over all the rail that it follows, also ahead of the contact,
    /// otherwise over the contact windows
    peak_temperature: "K" shown in "degC", Instantaneous, at least 0.0, nominal 300.0;
    /// traction_force over the normal force, of profiles the sum over the contacts, in either without normal_damping
    traction_coefficient: "1", Instantaneous, nominal 0.1;
    /// Creepage (wheel_speed*wheel_radius - V)/V of the last step, over 0.001 m/s in the direction of V where V is slower
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
    /// Absolute temperature of the rail leaving at the trailing edge of the strip: its heat spread over skin_depth and the breadth of the contacts
    leaving_temperature: "K" shown in "degC", Instantaneous, nominal 300.0;
    /// Depth of wear of the rail leaving at the trailing edge of the strip
    leaving_wear_depth: "m" shown in "µm", Instantaneous, at least 0.0, nominal 1e-7;
    /// Friction force on the wheel across the rail, positive to the left
    lateral_force "F_y": "N" shown in "kN", Instantaneous, nominal 1e4, only [patch, profiles];
    /// Moment of the shear traction on the wheel about the upward normal
    spin_moment "M_z": "N.m", Instantaneous, nominal 10.0, only [patch, profiles];
    /// Breadth of the contact across the rail
    contact_breadth: "m" shown in "mm", Instantaneous, at least 0.0, nominal 1e-2, only [patch, profiles];
    /// Area of the contact
    contact_area: "m2" shown in "mm2", Instantaneous, at least 0.0, nominal 1e-4, only [patch, profiles];
    /// Wear number: power of creep forces and spin moment over the speed, of 0.001 m/s at least
    wear_number "Tγ": "N", Instantaneous, nominal 100.0, only [patch, profiles];
    /// Force of the contacts on the wheelset along the track, positive forward
    force_x "F_x": "N" shown in "kN", Instantaneous, nominal 1e4, only [patch, profiles];
    /// Force of the contacts on the wheelset across the track, positive to the left
    force_y: "N" shown in "kN", Instantaneous, nominal 1e4, only [patch, profiles];
    /// Force of the contacts on the wheelset perpendicular to the track, positive upward
    force_z "F_z": "N" shown in "kN", Instantaneous, nominal 6e4, only [patch, profiles];
    /// Moment of the contacts on the wheelset about the axis through its centre along the track
    moment_x "M_x": "N.m" shown in "kN.m", Instantaneous, nominal 1e4, only [profiles];
    /// Moment of the contacts on the wheelset about the axis through its centre across the track, to the left
    moment_y "M_y": "N.m" shown in "kN.m", Instantaneous, nominal 1e4, only [profiles];
    /// Moment of the contacts on the wheelset about the upward axis through its centre
    moment_z: "N.m" shown in "kN.m", Instantaneous, nominal 1e4, only [profiles];
    /// Number of contacts
    contacts: "1", Counted, at least 0.0, nominal 1.0, only [profiles];
    /// Normal force of the contact, of profiles the sum over the contacts; with normal_damping where control is height
    normal_force "N": "N" shown in "kN", Instantaneous, at least 0.0, nominal 6e4;
    /// Volume worn off the wheel since the start; wear_acceleration does not count
    wheel_worn_volume: "m3" shown in "mm3", Total, at least 0.0, nominal 1e-9;
    /// Area of its cross-section that the wheel's profile has lost since the start, with wear_acceleration; 0 unless wheel_profile_wear is on
    wheel_worn_area: "m2" shown in "mm2", Total, at least 0.0, nominal 1e-9, only [profiles];
    /// Area of its cross-section that the rail's profile has lost since the start, with wear_acceleration; 0 unless rail_profile_wear is on
    rail_worn_area: "m2" shown in "mm2", Total, at least 0.0, nominal 1e-9, only [profiles];
    /// Height Sh of the wheel's flange, as worn at the beginning of the last step: of its tip from the running circle; 0 of a wheel
    /// without a flange
    flange_height "Sh": "m" shown in "mm", Kept, at least 0.0, nominal 3e-2, only [profiles];
    /// Thickness Sd of the wheel's flange, as worn at the beginning of the last step: from its back to its face 10 mm below the running
    /// circle; 0 of a wheel without a flange
    flange_thickness "Sd": "m" shown in "mm", Kept, at least 0.0, nominal 3e-2, only [profiles];
    /// Gradient qR of the wheel's flange, as worn at the beginning of the last step: along the axle between its face 2 mm above the tip
    /// and 10 mm below the running circle; 0 of a wheel without a flange
    flange_gradient "qR": "m" shown in "mm", Kept, nominal 1e-2, only [profiles];
    /// Depth of the hollow of the wheel's tread, as worn at the beginning of the last step: the largest radius to the field side of a
    /// place less the radius there, where that is most; 0 of a wheel without a flange
    hollow_depth: "m" shown in "mm", Kept, at least 0.0, nominal 1e-3, only [profiles];
    /// Damage by rolling contact fatigue that the wheel does to the rail with one passage, that of the contact that does most: of the wear number,
    /// 1 being that at which cracks begin; negative where all contacts wear more off than fatigue damages
    rcf_damage: "1", Instantaneous, nominal 2e-5, only [patch, profiles];
    /// Surface fatigue index: the largest value over the contact of the shear traction less shear_yield_stress, over the pressure; positive where the
    /// surface ratchets; 0 without contact
    surface_fatigue_index "FI": "1", Instantaneous, nominal 0.1;
    /// Largest depth below its surface to which the rail is hotter than austenite_temperature, in the contact and next to it; 0 where no surface is
    austenite_depth: "m" shown in "µm", Instantaneous, at least 0.0, nominal 1e-4;
}

contact_outputs! {
    /// Lateral position of a contact in the frame of the rail's profile, outwards from the profile's highest point
    rail_position: "m" shown in "mm", nominal 1e-2;
    /// Lateral position of a contact in the frame of the wheel's profile, outwards from the running circle
    wheel_position: "m" shown in "mm", nominal 1e-2;
    /// Position of a contact along the rail ahead of the axle
    position: "m" shown in "mm", nominal 1e-3;
    /// Inclination of a contact to the plane of the track, positive on the side of the gauge face
    inclination: "rad" shown in "deg", nominal 0.1;
    /// Normal force of a contact
    normal_force: "N" shown in "kN", at least 0.0, nominal 6e4;
    /// Friction force of a contact on the wheel along the rail, positive when it drives the vehicle forward
    longitudinal_force: "N" shown in "kN", nominal 1e4;
    /// Friction force of a contact on the wheel across the rail in the plane of the contact, positive to the left
    lateral_force: "N" shown in "kN", nominal 1e4;
    /// Moment of the shear traction of a contact on the wheel about the normal of the contact, away from the rail
    spin_moment: "N.m", nominal 10.0;
    /// Longitudinal creepage at the centre of a contact, positive where the wheel turns faster than it rolls, in either direction;
    /// creepages are over V, of 0.001 m/s at least
    longitudinal_creepage: "1", nominal 1e-2;
    /// Lateral creepage at the centre of a contact in its plane: velocity of the wheel relative to the rail, positive to the
    /// left, over the speed V of the axle, which is negative in reverse
    lateral_creepage: "1", nominal 1e-2;
    /// Spin creepage of a contact: angular velocity of the wheel relative to the rail about the normal of the contact, positive
    /// anticlockwise, over the speed V of the axle, which is negative in reverse
    spin_creepage: "1/m", nominal 1.0;
    /// Length of a contact along the rail
    length: "m" shown in "mm", at least 0.0, nominal 1e-2;
    /// Breadth of a contact along the rail's profile
    breadth: "m" shown in "mm", at least 0.0, nominal 1e-2;
    /// Area of a contact
    area: "m2" shown in "mm2", at least 0.0, nominal 1e-4;
    /// Largest pressure of a contact
    peak_pressure: "Pa" shown in "MPa", at least 0.0, nominal 1e9;
    /// Largest absolute temperature of the rail surface in a contact
    peak_temperature: "K" shown in "degC", at least 0.0, nominal 300.0;
    /// Power dissipated by friction in a contact
    friction_power: "W" shown in "kW", at least 0.0, nominal 1e4;
    /// Wear number of a contact: power of creep forces and spin moment over the speed, of 0.001 m/s at least
    wear_number: "N", nominal 100.0;
    /// Damage by rolling contact fatigue that a contact does to the rail with one passage: of its wear number, 1 being that at which cracks begin;
    /// negative where it wears more off than fatigue damages
    rcf_damage: "1", nominal 2e-5;
    /// Surface fatigue index of a contact: the largest value of the shear traction less shear_yield_stress, over the pressure
    surface_fatigue_index: "1", nominal 0.1;
    /// Largest depth below its surface to which the rail is hotter than austenite_temperature, in a contact and next to it
    austenite_depth: "m" shown in "µm", at least 0.0, nominal 1e-4;
}

/// The outputs in the order in which they are listed: numbers, then what the contacts have.
pub const OUTPUTS: &[OutputSignal] = &{
    let mut rows = [NUMBERS[0]; NUMBERS.len() + CONTACTS * ELEMENTS.len()];
    let mut row = 0;
    while row < rows.len() {
        rows[row] = if row < NUMBERS.len() {
            NUMBERS[row]
        } else {
            let element = row - NUMBERS.len();
            ELEMENTS[element / CONTACTS][element % CONTACTS]
        };
        row += 1;
    }
    rows
};

/// Rounding of a value at the end of a ramp, relative to the range.
const ROUNDING: f64 = 1e-12;
/// Rounding of a constant value that an importer has interpolated, as FMPy does, relative to the value: a few units of the last bit.
const CONSTANT_ROUNDING: f64 = 8.0 * f64::EPSILON;

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
    /// [`Error::OutOfRange`], [`Error::OtherModelOnly`].
    pub fn check(&self, value: f64, parameters: &Parameters) -> Result<()> {
        self.check_range(value, parameters)?;
        let model = parameters.contact_model;
        if value != 0.0 && !self.is_taken_by(model) {
            return Err(Error::OtherModelOnly {
                name: self.name,
                value,
                number: model as i32 + 1,
                choice: ContactModel::NAMES[model as usize],
                takers: self.takers,
            });
        }
        Ok(())
    }

    /// Whether profiles alone take another value than 0.
    pub fn is_of_profiles_alone(&self) -> bool {
        self.models == [ContactModel::Profiles]
    }

    /// Whether a contact model takes another value than 0.
    pub fn is_taken_by(&self, model: ContactModel) -> bool {
        self.models.contains(&model)
    }

    /// Refuses a value that is not finite or outside [`InputSignal::range`].
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check_range(&self, value: f64, parameters: &Parameters) -> Result<()> {
        let (minimum, maximum) = self.range(parameters);
        check_range(self.name, value, minimum, maximum, self.unit, self.narrowed_by)
    }

    /// The limit of the range that a value misses by no more than the rounding of a constant; `None` of other values.
    pub fn rounded_limit(&self, value: f64, parameters: &Parameters) -> Option<f64> {
        self.missed_limit(value, parameters, |limit, _| CONSTANT_ROUNDING * limit.abs())
    }

    /// The limit of the range that a value misses by no more than what `room` makes of the limit and of the range's width.
    fn missed_limit(&self, value: f64, parameters: &Parameters, room: fn(f64, f64) -> f64) -> Option<f64> {
        let (minimum, maximum) = self.range(parameters);
        let limit = value.max(minimum).min(maximum);
        let missed = (value - limit).abs();
        (missed > 0.0 && missed <= room(limit, maximum - minimum)).then_some(limit)
    }

    /// Refuses a value other than the start value, rounding apart, where the choices leave this input without effect. The model
    /// itself takes any: only who asked the user for the inputs knows that one was meant.
    ///
    /// # Errors
    /// [`Error::NotUsed`].
    pub fn check_used(&self, value: f64, parameters: &Parameters) -> Result<()> {
        let Some(used_by) = self.used_by.filter(|used_by| used_by.chosen(parameters) != *used_by) else {
            return Ok(());
        };
        // An importer that interpolates a column of start values rounds their last bits, as FMPy does: nobody meant another value.
        if (value - self.default).abs() <= CONSTANT_ROUNDING * self.default.abs() {
            return Ok(());
        }
        let (parameter, other_number, other) = used_by.described();
        let (_, number, choice) = used_by.chosen(parameters).described();
        Err(Error::NotUsed {
            name: self.name,
            value,
            parameter,
            number,
            choice,
            other_number,
            other,
        })
    }
}

impl Inputs {
    /// Checks every input, and the rolling speed that they make.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] names the first input that is not finite or out of its range, [`Error::OtherModelOnly`] one
    /// that the contact model does not take.
    pub fn check(&self, parameters: &Parameters) -> Result<()> {
        for signal in INPUTS {
            signal.check((signal.get)(self), parameters)?;
        }
        self.check_motion(parameters)
    }

    /// Values that miss a limit by rounding, at the end of a ramp to it, are moved onto the limit.
    pub fn snapped(&self, parameters: &Parameters) -> Inputs {
        let mut snapped = *self;
        for signal in INPUTS {
            let missed = signal.missed_limit((signal.get)(self), parameters, |_, width| ROUNDING * width);
            if let Some(limit) = missed {
                (signal.set)(&mut snapped, limit);
            }
        }
        snapped
    }
}
