//! Table of the variables, the only one: inputs, outputs, parameters and locals, in the order of a model description. An array is one
//! variable; FMI 2.0, which has no arrays, lists its elements ([`crate::fmi2::variables`]).

mod list;

use crate::parameters::{INTEGER_PARAMETERS, IntegerKind, Parameters, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{CONTACTS, INPUTS, OUTPUTS};
use crate::wheel_rail::{ContactNode, DEPTH_POINTS, PROFILE_POINTS, ProfileDepths, Profiles, STRIP_POINTS, WornPlace};
use std::ops::Range;

pub use list::{fields, time, variables};

/// Number of a variable, or of an element of an array, in the calls of an importer. Each version of FMI gives its own.
pub type ValueReference = u32;

/// One plotted profile.
pub struct ProfileColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the values.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Number of points.
    pub points: usize,
    /// Reads the points.
    pub values: fn(&Profiles) -> &[f64],
}

/// The profiles.
#[rustfmt::skip]
pub const PROFILES: [ProfileColumn; 13] = [
    ProfileColumn { name: "profile.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, points: PROFILE_POINTS,
        description: "Position along the rail ahead of the axle", values: |p| &p.x },
    ProfileColumn { name: "profile.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, points: PROFILE_POINTS,
        description: "Contact pressure", values: |p| &p.pressure },
    ProfileColumn { name: "profile.shear", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, points: PROFILE_POINTS,
        description: "Shear traction on the rail", values: |p| &p.shear },
    ProfileColumn { name: "profile.slip", unit: "m/s", display_unit: None, nominal: 1e-1, points: PROFILE_POINTS,
        description: "Slip velocity of the rail relative to the wheel", values: |p| &p.slip },
    ProfileColumn { name: "profile.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: PROFILE_POINTS,
        description: "Absolute temperature of the rail surface", values: |p| &p.temperature },
    ProfileColumn { name: "profile.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, points: PROFILE_POINTS,
        description: "Depth of wear of the rail surface", values: |p| &p.wear_depth },
    ProfileColumn { name: "depth.z", unit: "m", display_unit: Some("mm"), nominal: 1e-3, points: DEPTH_POINTS,
        description: "Depth below the hottest contact point", values: |p| &p.depth },
    ProfileColumn { name: "depth.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: DEPTH_POINTS,
        description: "Absolute temperature below the hottest contact point", values: |p| &p.depth_temperature },
    ProfileColumn { name: "strip.position", unit: "m", display_unit: Some("mm"), nominal: 1e-2, points: STRIP_POINTS,
        description: "Position across the rail to the left", values: |p| &p.strips.position },
    ProfileColumn { name: "strip.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, points: STRIP_POINTS,
        description: "Largest contact pressure along the strip", values: |p| &p.strips.pressure },
    ProfileColumn { name: "strip.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: STRIP_POINTS,
        description: "Largest absolute temperature of the rail surface along the strip", values: |p| &p.strips.temperature },
    ProfileColumn { name: "strip.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, points: STRIP_POINTS,
        description: "Depth of wear of the strip behind the contact", values: |p| &p.strips.wear_depth },
    ProfileColumn { name: "strip.friction_power", unit: "W/m", display_unit: Some("kW/m"), nominal: 1e6, points: STRIP_POINTS,
        description: "Power dissipated by friction in the strip per width", values: |p| &p.strips.friction_power },
];

/// A field over the cells of a patch, or the places of the cells. Only where arrays have the lengths that parameters give
/// them: FMI 2.0 would need a variable for each cell.
pub struct FieldColumn {
    /// Name.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the values.
    pub display_unit: Option<&'static str>,
    /// Typical magnitude.
    pub nominal: f64,
    /// One sentence.
    pub description: &'static str,
    /// Whether it has an element for each strip, and for each cell along a strip.
    pub over: [bool; 2],
    /// Reads the value of a cell; the ambient temperature is in `K`.
    pub value: fn(&ContactNode, f64) -> f64,
}

/// The fields of a patch.
#[rustfmt::skip]
pub const FIELDS: [FieldColumn; 9] = [
    FieldColumn { name: "patch.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [false, true],
        description: "Position of the cells of a strip along the rail, ahead of the axle", value: |node, _| node.position },
    FieldColumn { name: "patch.y", unit: "m", display_unit: Some("mm"), nominal: 1e-2, over: [true, false],
        description: "Position of the strips across the rail, to the left", value: |node, _| node.lateral_position },
    FieldColumn { name: "patch.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, over: [true, true],
        description: "Contact pressure in the cells of the patch", value: |node, _| node.pressure },
    FieldColumn { name: "patch.shear_x", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the patch, along the rail", value: |node, _| node.shear },
    FieldColumn { name: "patch.shear_y", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, over: [true, true],
        description: "Shear traction on the rail in the cells of the patch, to the left", value: |node, _| node.lateral_shear },
    FieldColumn { name: "patch.slip_x", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the patch, along the rail", value: |node, _| node.slip },
    FieldColumn { name: "patch.slip_y", unit: "m/s", display_unit: None, nominal: 1e-1, over: [true, true],
        description: "Slip velocity of the rail relative to the wheel in the cells of the patch, to the left", value: |node, _| node.lateral_slip },
    FieldColumn { name: "patch.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, over: [true, true],
        description: "Absolute temperature of the rail surface in the cells of the patch", value: |node, ambient| ambient + node.temperature },
    FieldColumn { name: "patch.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, over: [true, true],
        description: "Depth of wear of the rail surface in the cells of the patch", value: |node, _| node.wear_depth },
];

/// A number of each place of a profile that wears. As the fields, only where arrays have the lengths that parameters give them.
pub struct WearColumn {
    /// Name.
    pub name: &'static str,
    /// Typical magnitude.
    pub nominal: f64,
    /// Unit in which a person would read the values.
    pub display_unit: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Reads the places of a profile.
    pub places: fn(&ProfileDepths) -> &[WornPlace],
    /// Reads the value of a place.
    pub value: fn(&WornPlace) -> f64,
}

/// The wear of the profiles, in `m`.
#[rustfmt::skip]
pub const PROFILE_WEAR: [WearColumn; 6] = [
    WearColumn { name: "wheel_profile.position", nominal: 1e-2, display_unit: "mm",
        description: "Lateral positions of the places on the new profile of the wheel, outwards from the running circle; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.position },
    WearColumn { name: "wheel_profile.arc_length", nominal: 1e-2, display_unit: "mm",
        description: "Arc lengths of the places on the new profile of the wheel from its flange side; 0 unless contact_model is profiles", places: |p| &p.wheel, value: |place| place.arc_length },
    WearColumn { name: "wheel_profile.wear_depth", nominal: 1e-5, display_unit: "µm",
        description: "Depths along the normal that the wheel's profile has lost; 0 unless wheel_profile_wear is on", places: |p| &p.wheel, value: |place| place.depth },
    WearColumn { name: "rail_profile.position", nominal: 1e-2, display_unit: "mm",
        description: "Lateral positions of the places on the new upright profile of the rail, outwards from its highest point; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.position },
    WearColumn { name: "rail_profile.arc_length", nominal: 1e-2, display_unit: "mm",
        description: "Arc lengths of the places on the new profile of the rail from its gauge side; 0 unless contact_model is profiles", places: |p| &p.rail, value: |place| place.arc_length },
    WearColumn { name: "rail_profile.wear_depth", nominal: 1e-5, display_unit: "µm",
        description: "Depths along the normal that the rail's profile has lost; 0 unless rail_profile_wear is on", places: |p| &p.rail, value: |place| place.depth },
];

/// Lengths of arrays. Those of a patch's fields and of the profiles' wear follow from parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Lengths {
    strips: usize,
    cells: usize,
    wear_points: usize,
}

impl Lengths {
    /// Lengths that follow from the parameters.
    pub fn of(parameters: &Parameters) -> Lengths {
        Lengths {
            strips: parameters.patch_strips,
            cells: parameters.patch_nodes,
            wear_points: parameters.profile_wear_points,
        }
    }

    /// The number of elements of a variable; 1 where it is no array.
    pub fn elements(self, variable: RealVariable) -> usize {
        match variable {
            RealVariable::Parameter(row) => REAL_PARAMETERS[row].elements.len(),
            RealVariable::Contacts(_) => CONTACTS,
            RealVariable::Profile(row) => PROFILES[row].points,
            RealVariable::Field(row) => {
                let [strips, cells] = FIELDS[row].over;
                (if strips { self.strips } else { 1 }) * (if cells { self.cells } else { 1 })
            }
            RealVariable::ProfileWear(_) => self.wear_points,
            _ => 1,
        }
    }

    /// The cell whose value an element of a row of [`FIELDS`] is, counted strip by strip.
    pub fn cell(self, row: usize, element: usize) -> usize {
        match FIELDS[row].over {
            [true, false] => element * self.cells,
            _ => element,
        }
    }
}

/// Causality of a variable: who sets it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set before the simulation, or during it where tunable.
    Parameter,
    /// Set by the importer at communication points.
    Input,
    /// Computed, to be connected.
    Output,
    /// Computed, to be looked at.
    Local,
    /// Time. FMI 2.0 has no variable for it here.
    Independent,
}

impl Causality {
    /// Name of the causality in the standards.
    pub fn name(self) -> &'static str {
        match self {
            Causality::Parameter => "parameter",
            Causality::Input => "input",
            Causality::Output => "output",
            Causality::Local => "local",
            Causality::Independent => "independent",
        }
    }
}

/// Variability of a variable: when it changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variability {
    /// Never after the initialisation.
    Fixed,
    /// Variable that the importer changes at communication points.
    Tunable,
    /// Variable that changes at communication points.
    Discrete,
    /// Variable that changes at any time.
    Continuous,
}

impl Variability {
    /// Name of the variability in the standards.
    pub fn name(self) -> &'static str {
        match self {
            Variability::Fixed => "fixed",
            Variability::Tunable => "tunable",
            Variability::Discrete => "discrete",
            Variability::Continuous => "continuous",
        }
    }
}

/// Shape of a variable: its number of elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Shape {
    /// One; it is no array.
    Number,
    /// Array of a given number of elements.
    Array(usize),
    /// Array of a row of [`FIELDS`]: over strips, cells along a strip, or both, as many of them as parameters say.
    Field([bool; 2]),
    /// Array of a row of [`PROFILE_WEAR`]: over the places of a profile, as many of them as a parameter says.
    ProfileWear,
}

/// Properties of a real number, or of an array of them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RealKind {
    /// Variable of the model that it stands for.
    pub variable: RealVariable,
    /// Shape: the number of elements.
    pub shape: Shape,
    /// Unit.
    pub unit: &'static str,
    /// Unit in which a person would read the value.
    pub display_unit: Option<&'static str>,
    /// Smallest value.
    pub minimum: Option<f64>,
    /// Largest value.
    pub maximum: Option<f64>,
    /// Typical magnitude; none of a parameter, where it is that of the start value.
    pub nominal: Option<f64>,
    /// Start values of what is set from outside, one for each element; otherwise none.
    pub start: &'static [f64],
}

impl RealKind {
    /// Typical magnitude of an element: that of its start value where none is given.
    pub fn typical_magnitude(&self, element: usize) -> Option<f64> {
        let start = self.start.get(element).map(|start| start.abs());
        self.nominal.or(start.filter(|nominal| *nominal > 0.0))
    }
}

/// Type of a variable and what belongs to it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Kind {
    /// A real number, or an array of them.
    Real(RealKind),
    /// An integer.
    Integer {
        /// Variable of the model that it stands for.
        variable: IntegerVariable,
        /// Kind of the integer: a count or a choice.
        kind: IntegerKind,
        /// Smallest value.
        minimum: Option<i32>,
        /// Largest value.
        maximum: Option<i32>,
        /// Start value of what is set from outside.
        start: Option<i32>,
    },
    /// A text, which is set from outside.
    Text {
        /// Row of [`TEXT_PARAMETERS`].
        row: usize,
        /// Start value.
        start: &'static str,
    },
}

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name, by the structured naming convention; of an array without an index.
    pub name: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Causality: who sets it.
    pub causality: Causality,
    /// Variability: when it changes.
    pub variability: Variability,
    /// Type, unit and range.
    pub kind: Kind,
}

/// Quantity that a real variable stands for; rows are those of the tables of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RealVariable {
    /// Row of [`INPUTS`].
    Input(usize),
    /// Row of [`OUTPUTS`].
    Output(usize),
    /// Array of outputs over the contacts, by the row of [`OUTPUTS`] that its first element is.
    Contacts(usize),
    /// Row of [`REAL_PARAMETERS`].
    Parameter(usize),
    /// Row of [`PROFILES`].
    Profile(usize),
    /// Row of [`FIELDS`].
    Field(usize),
    /// Row of [`PROFILE_WEAR`].
    ProfileWear(usize),
    /// `solver.residual`.
    Residual,
    /// The communication point.
    Time,
}

impl RealVariable {
    /// The rows of [`OUTPUTS`] that the variable is, where it is an output.
    pub fn outputs(self) -> Option<Range<usize>> {
        match self {
            RealVariable::Output(row) => Some(row..row + 1),
            RealVariable::Contacts(row) => Some(row..row + CONTACTS),
            _ => None,
        }
    }
}

/// Quantity that an integer variable stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntegerVariable {
    /// Row of [`INTEGER_PARAMETERS`].
    Parameter(usize),
    /// `solver.iterations`.
    Iterations,
}

/// A real variable, or an element of an array, as a call names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Real {
    /// Value reference of the variable, for messages.
    pub reference: ValueReference,
    /// The variable.
    pub variable: RealVariable,
    /// The element; 0 where it is no array.
    pub element: usize,
}

/// An integer variable, as a call names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Integer {
    /// Value reference of the variable, for messages.
    pub reference: ValueReference,
    /// The variable.
    pub variable: IntegerVariable,
}

/// A text variable, as a call names it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Text {
    /// Value reference of the variable, for messages.
    pub reference: ValueReference,
    /// Row of [`TEXT_PARAMETERS`].
    pub row: usize,
}

impl Real {
    /// Name of the variable, with the index of an element counted from 1.
    pub fn name(&self) -> String {
        match self.variable {
            RealVariable::Input(row) => INPUTS[row].name.to_owned(),
            RealVariable::Output(row) => OUTPUTS[row].name.to_owned(),
            RealVariable::Contacts(row) => OUTPUTS[row + self.element].name.to_owned(),
            RealVariable::Parameter(row) => REAL_PARAMETERS[row].elements[self.element].to_owned(),
            RealVariable::Profile(row) => format!("{}[{}]", PROFILES[row].name, self.element + 1),
            RealVariable::Field(row) => FIELDS[row].name.to_owned(),
            RealVariable::ProfileWear(row) => PROFILE_WEAR[row].name.to_owned(),
            RealVariable::Residual => RESIDUAL.to_owned(),
            RealVariable::Time => TIME.to_owned(),
        }
    }
}

impl Integer {
    /// Name of the variable.
    pub fn name(&self) -> &'static str {
        match self.variable {
            IntegerVariable::Parameter(row) => INTEGER_PARAMETERS[row].name,
            IntegerVariable::Iterations => ITERATIONS,
        }
    }
}

impl Text {
    /// Name of the variable.
    pub fn name(&self) -> &'static str {
        TEXT_PARAMETERS[self.row].name
    }
}

const RESIDUAL: &str = "solver.residual";
const ITERATIONS: &str = "solver.iterations";
const TIME: &str = "time";
