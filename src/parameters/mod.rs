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

/// TEMPORARY
#[derive(Debug, Clone, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Tmp {
    /// a
    pub rail_profile: String,
    /// a
    pub wheel_profile: String,
    /// a
    pub right: bool,
    /// a
    pub gauge: f64,
    /// a
    pub gauge_depth: f64,
    /// a
    pub flange_back_distance: f64,
    /// a
    pub flange_back_position: f64,
    /// a
    pub rail_inclination: f64,
    /// a
    pub height: bool,
}
impl Default for Tmp {
    fn default() -> Tmp {
        Tmp {
            rail_profile: "60E1".into(),
            wheel_profile: "S1002".into(),
            right: false,
            gauge: 1.435,
            gauge_depth: 14e-3,
            flange_back_distance: 1.36,
            flange_back_position: 70e-3,
            rail_inclination: 1.0 / 40.0,
            height: false,
        }
    }
}
