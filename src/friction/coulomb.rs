//! The regularised Coulomb law (30) and its derivative.

use crate::numerics::arctangent::arctangent;
use crate::numerics::dense;
use std::f64::consts::FRAC_2_PI;

/// φ(s) = (2/π) arctan(s/ε): τ = −μ p φ(s). The factor 2/π, which (30) lacks, keeps |τ| within Coulomb's bound.
#[inline(always)]
pub fn saturation(slip: f64, regularisation: f64) -> f64 {
    FRAC_2_PI * arctangent(slip / regularisation)
}

/// φ of each slip.
pub fn saturations(slip: &[f64], regularisation: f64, out: &mut [f64]) {
    dense::vectorised(
        #[inline(always)]
        |_| {
            for (out, slip) in out.iter_mut().zip(slip) {
                *out = saturation(*slip, regularisation);
            }
        },
    );
}

/// dφ/ds, `s/m`.
pub fn saturation_slope(slip: f64, regularisation: f64) -> f64 {
    FRAC_2_PI * regularisation / (regularisation * regularisation + slip * slip)
}

/// A node sticks below this value of |φ|: |s| < 6.3 ε.
const STICK_SATURATION: f64 = 0.9;

/// Whether a node with this slip counts as sticking.
pub fn sticks(slip: f64, regularisation: f64) -> bool {
    saturation(slip, regularisation).abs() < STICK_SATURATION
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_slope_is_the_derivative() {
        for slip in [-0.1, 0.0, 1e-4, 3e-3] {
            let h = 1e-8;
            let difference = (saturation(slip + h, 1e-3) - saturation(slip - h, 1e-3)) / (2.0 * h);
            assert!((saturation_slope(slip, 1e-3) / difference - 1.0).abs() < 1e-4);
        }
    }
}
