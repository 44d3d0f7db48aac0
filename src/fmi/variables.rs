//! Table of the variables, the only one: inputs, outputs, parameters and locals, in the order of a model description. An array is one
//! variable; FMI 2.0, which has no arrays, lists its elements ([`crate::fmi2::variables`]).

mod columns;
mod list;

use crate::parameters::{INTEGER_PARAMETERS, IntegerKind, Parameters, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{CONTACTS, INPUTS, OUTPUTS};
use std::ops::Range;

pub use columns::{FIELDS, PROFILE_WEAR, PROFILES, SURFACE};
pub use list::{fields, time, variables};

/// Number of a variable, or of an element of an array, in the calls of an importer. Each version of FMI gives its own.
pub type ValueReference = u32;

/// Rows of a window's strips in the arrays over `patch_strips`: a window has more of them than a patch.
pub const SURFACE_ROWS: usize = 2;

/// Lengths of arrays. Those of the fields of patch and profiles and of the profiles' wear follow from parameters.
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
            RealVariable::Surface(row) => {
                let [strips, cells] = self.in_window(SURFACE[row].over);
                CONTACTS * strips * cells
            }
            RealVariable::ProfileWear(_) => self.wear_points,
            _ => 1,
        }
    }

    /// Elements of a window over its strips and over the cells along them.
    fn in_window(self, over: [bool; 2]) -> [usize; 2] {
        let [strips, cells] = over;
        [
            if strips { SURFACE_ROWS * self.strips } else { 1 },
            if cells { self.cells } else { 1 },
        ]
    }

    /// Window, strip and cell whose value an element of a row of [`SURFACE`] is.
    pub fn surface_cell(self, row: usize, element: usize) -> (usize, [usize; 2]) {
        let [strips, cells] = self.in_window(SURFACE[row].over);
        (element / (strips * cells), [element / cells % strips, element % cells])
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
    /// Array of a row of [`SURFACE`]: over windows, and over strips, cells along a strip, or both.
    Surface([bool; 2]),
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
    /// Row of [`SURFACE`].
    Surface(usize),
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
            RealVariable::Surface(row) => SURFACE[row].name.to_owned(),
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
