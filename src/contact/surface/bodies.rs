//! Rail and wheel in their shapes.

use crate::geometry::profile::WheelMeasures;
use crate::geometry::rail::PlacedRail;
use crate::geometry::unrolled::{RailPoint, Wheel};

/// Numbers of the bodies in arrays over both.
pub const WHEEL: usize = 0;
/// Number of the rail in arrays over both bodies.
pub const RAIL: usize = 1;
/// Rail and wheel.
#[derive(Debug, Clone)]
pub struct Bodies {
    /// The rail.
    pub rail: PlacedRail,
    /// The wheel.
    pub wheel: Wheel,
    /// Places at which contacts are sought: arc length and surface, from the field side to the gauge side.
    pub scan: Vec<(f64, RailPoint)>,
    /// Measures of the wheel's profile; 0 of a wheel without a flange.
    pub measures: WheelMeasures,
}

/// Measures of a wheel by its height, with its running circle so far from the back of its flange, `m`; 0 of one without a flange.
pub fn measures(wheel: &Wheel, flange_back_position: f64) -> WheelMeasures {
    WheelMeasures::of_height(&wheel.profile, flange_back_position).unwrap_or_default()
}
