//! Every physical and numerical parameter: unit, default, range, source; validated once.
//!
//! `table` declares each parameter in one place: the field of [`Parameters`], its start value, and the row of
//! [`REAL_PARAMETERS`], [`INTEGER_PARAMETERS`] or [`TEXT_PARAMETERS`] that the FMI variables, the command line and the validation
//! read; `rows` has the macros that make these three of one declaration.
//! `choices` are the types of those that choose, `derived` what follows from the values by a formula, `validation` what must
//! hold between them, `text` what a text must be, `source` what
//! that of a profile names, `profile_contents` what is in its file; `without_effect` finds those that the choices leave unused; `grids` are names for pairs of `patch_nodes` and `patch_strips`.

// First, because `table` is written in its macros.
#[macro_use]
mod rows;

mod choices;
mod derived;
mod grids;
mod profile_contents;
mod range;
mod source;
mod table;
mod text;
mod validation;
mod without_effect;

pub use crate::geometry::hertz::HertzEllipse;
pub use choices::{
    ContactModel, Control, FrictionLaw, MeshKind, NormalSolver, PatchGeometry, ProfileWear, Side, SlipSource, WearLaw,
    Wheel, WheelHeating, WheelWearLaw,
};
pub use grids::{PATCH_GRID, PatchGrid};
pub use profile_contents::ProfileContents;
pub use range::check_range;
pub use source::{ProfileSource, path_of};
pub use table::{
    INTEGER_PARAMETERS, IntegerKind, IntegerParameter, Parameters, REAL_PARAMETERS, RealParameter, TABLE_POINTS,
    TEXT_PARAMETERS, TextParameter,
};
pub use text::check_text;
