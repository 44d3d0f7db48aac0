//! Every physical and numerical parameter: unit, default, range, source; validated once.
//!
//! `table` declares each parameter in one place: the field of [`Parameters`], its start value, and the row of
//! [`REAL_PARAMETERS`] or [`INTEGER_PARAMETERS`] that the FMI variables, the command line and the validation read; `rows` has the
//! macros that make these three of one declaration.
//! `choices` are the types of those that choose, `derived` what follows from the values by a formula, `validation` what must
//! hold between them.

// First, because `table` is written in its macros.
#[macro_use]
mod rows;

mod choices;
mod derived;
mod range;
mod table;
mod validation;

pub use crate::geometry::hertz::HertzEllipse;
pub use choices::{ContactModel, Control, FrictionLaw, MeshKind, NormalSolver, SlipSource, Wheel, WheelHeating};
pub use range::check_range;
pub use table::{
    INTEGER_PARAMETERS, IntegerKind, IntegerParameter, Parameters, REAL_PARAMETERS, RealParameter, TABLE_POINTS,
};
