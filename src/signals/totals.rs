//! Totals: what the steps add up, which the outputs show and no output is made from.

use serde::{Deserialize, Serialize};

/// Sums over the steps since the start, or their rates of growth per second.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Totals {
    /// Volume worn off the rail, `m³`.
    pub worn_volume: f64,
    /// Work dissipated by friction, `J`.
    pub friction_energy: f64,
    /// Distance rolled, `m`.
    pub distance: f64,
    /// Radius that the wheel has lost by wear, `m`.
    pub wheel_wear_depth: f64,
    /// Volume worn off the wheel, `m³`.
    pub wheel_worn_volume: f64,
    /// Area of the cross-section that the wheel's profile has lost, `m²`.
    pub wheel_worn_area: f64,
    /// Area of the cross-section that the rail's profile has lost, `m²`.
    pub rail_worn_area: f64,
}

impl Totals {
    /// Totals after they have grown at the given rates for `duration` `s`.
    pub fn grown(&self, rates: &Totals, duration: f64) -> Totals {
        Totals {
            worn_volume: self.worn_volume + rates.worn_volume * duration,
            friction_energy: self.friction_energy + rates.friction_energy * duration,
            distance: self.distance + rates.distance * duration,
            wheel_wear_depth: self.wheel_wear_depth + rates.wheel_wear_depth * duration,
            wheel_worn_volume: self.wheel_worn_volume + rates.wheel_worn_volume * duration,
            wheel_worn_area: self.wheel_worn_area + rates.wheel_worn_area * duration,
            rail_worn_area: self.rail_worn_area + rates.rail_worn_area * duration,
        }
    }

    /// Whether all are numbers.
    pub fn is_finite(&self) -> bool {
        let totals = [
            self.worn_volume,
            self.friction_energy,
            self.distance,
            self.wheel_wear_depth,
            self.wheel_worn_volume,
            self.wheel_worn_area,
            self.rail_worn_area,
        ];
        totals.iter().all(|total| total.is_finite())
    }
}
