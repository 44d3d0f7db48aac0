//! Damage of the rail beside wear: rolling contact fatigue by the wear number of a contact, and by the tractions at the points of its surface. How deep heat has
//! changed the steel is in [`crate::heat::isotherm`].

use crate::parameters::Parameters;

/// Damage by rolling contact fatigue that a contact does to the rail with one passage, as a share of what begins a crack, from its wear number Tγ `N` (whole life
/// rail model; M. Burstow, report AEATR-ES-2003-832 for the Rail Safety and Standards Board): 0 up to `rcf_threshold`, rising to `rcf_peak_damage` at
/// `rcf_peak`, from there on falling by one slope through 0 at `rcf_balance`, past which more is worn off than cracks grow.
pub fn rolling_contact_fatigue(parameters: &Parameters, wear_number: f64) -> f64 {
    let &Parameters {
        rcf_threshold: threshold,
        rcf_peak: peak,
        rcf_balance: balance,
        rcf_peak_damage: most,
        ..
    } = parameters;
    // Without damage the thresholds may be anything.
    if wear_number <= threshold || most == 0.0 {
        0.0
    } else if wear_number < peak {
        most * (wear_number - threshold) / (peak - threshold)
    } else {
        most * (balance - wear_number) / (balance - peak)
    }
}

/// Surface fatigue index: the largest (|τ| − k)/p over points under pressure, from pairs of p and |τ| in the unit of the yield stress in shear k; −∞ without a point. On Hertz's ellipse in full slip it is μ − 2πabk/(3F), the index of A. Ekberg, E. Kabo and H. Andersson (Fatigue & Fracture of Engineering Materials & Structures 25, 2002, 899).
pub fn surface_fatigue_index(points: impl Iterator<Item = (f64, f64)>, yield_stress: f64) -> f64 {
    points
        .map(|(pressure, shear)| (shear - yield_stress) / pressure)
        .fold(f64::NEG_INFINITY, f64::max)
}

/// Damage to the points of the rail in a contact, where it is largest.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointDamage {
    /// Surface fatigue index; −∞ without contact.
    pub surface_fatigue: f64,
    /// Depth to which the rail is hotter than that at which its steel becomes austenite, `m`.
    pub austenite_depth: f64,
}

impl Default for PointDamage {
    /// Damage of no contact.
    fn default() -> PointDamage {
        PointDamage {
            surface_fatigue: f64::NEG_INFINITY,
            austenite_depth: 0.0,
        }
    }
}

impl PointDamage {
    /// Larger damage of two contacts.
    pub fn with(&self, other: &PointDamage) -> PointDamage {
        PointDamage {
            surface_fatigue: self.surface_fatigue.max(other.surface_fatigue),
            austenite_depth: self.austenite_depth.max(other.austenite_depth),
        }
    }

    /// Surface fatigue index as an output, 0 without contact.
    pub fn surface_fatigue_index(&self) -> f64 {
        if self.surface_fatigue.is_finite() {
            self.surface_fatigue
        } else {
            0.0
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn fatigue_is_the_whole_life_rail_model_on_every_branch() {
        let parameters = Parameters::default();
        for (wear_number, damage) in [
            (-20.0, 0.0),
            (0.0, 0.0),
            (15.0, 0.0),
            (25.0, 2e-6),
            (40.0, 5e-6),
            (65.0, 1e-5),
            (120.0, 5e-6),
            (175.0, 0.0),
            (230.0, -5e-6),
            (285.0, -1e-5),
        ] {
            let found = rolling_contact_fatigue(&parameters, wear_number);
            assert!((found - damage).abs() < 1e-20, "{wear_number}: {found} {damage}");
        }
    }

    /// Slopes of 1e-5 over 50 N and 110 N: a step of 1e-9 N changes nothing by more than 2e-16.
    #[test]
    fn fatigue_has_no_jumps() {
        let parameters = Parameters::default();
        for corner in [15.0, 65.0, 175.0] {
            let [below, at, above] =
                [-1e-9, 0.0, 1e-9].map(|change| rolling_contact_fatigue(&parameters, corner + change));
            assert!((below - at).abs() < 3e-16 && (above - at).abs() < 3e-16, "{corner}");
        }
    }

    #[test]
    fn fatigue_without_a_peak_is_none() {
        let parameters = Parameters {
            rcf_threshold: 0.0,
            rcf_peak: 0.0,
            rcf_balance: 0.0,
            rcf_peak_damage: 0.0,
            ..Parameters::default()
        };
        assert!(
            [-1.0, 0.0, 1.0]
                .iter()
                .all(|&number| rolling_contact_fatigue(&parameters, number) == 0.0)
        );
    }

    #[test]
    fn the_index_is_that_of_the_worst_point_under_pressure() {
        let points = [(1e9, 0.2e9), (0.5e9, 0.2e9), (1e9, 0.35e9)];
        let index = |yield_stress| surface_fatigue_index(points.into_iter(), yield_stress);
        assert!((index(0.3e9) - 0.05).abs() < 1e-15);
        // Without a yield stress it is the largest utilisation.
        assert!((index(0.0) - 0.4).abs() < 1e-15);
        assert_eq!(surface_fatigue_index([].into_iter(), 1.0), f64::NEG_INFINITY);
    }
}
