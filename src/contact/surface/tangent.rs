//! Linearised mechanics of a contact of profiles.

use super::operators::SurfaceOperators;
use crate::settings::Settings;

/// Solvers and buffers of the linearised mechanics, heat and wear.
pub struct SurfaceTangent;

impl SurfaceTangent {
    /// Solvers for the given operators.
    pub fn new(_operators: &SurfaceOperators, _settings: &Settings) -> SurfaceTangent {
        SurfaceTangent
    }
}
