//! The regularised Coulomb law (30) and its derivative.

use crate::numerics::arctangent::arctangent;
use crate::numerics::dense;
use std::f64::consts::FRAC_2_PI;

/// Traction utilisation φ(s) = (2/π) arctan(s/ε): τ = −μ p φ(s). The factor 2/π, which (30) lacks, keeps |τ| within Coulomb's
/// bound.
#[inline(always)]
pub fn utilisation(slip: f64, regularisation: f64) -> f64 {
    FRAC_2_PI * arctangent(slip / regularisation)
}

/// Computes φ of each slip.
pub fn utilisations(slip: &[f64], regularisation: f64, out: &mut [f64]) {
    dense::vectorised(
        #[inline(always)]
        |_| {
            for (out, slip) in out.iter_mut().zip(slip) {
                *out = utilisation(*slip, regularisation);
            }
        },
    );
}

/// Derivative dφ/ds, `s/m`.
pub fn utilisation_slope(slip: f64, regularisation: f64) -> f64 {
    FRAC_2_PI * regularisation / (regularisation * regularisation + slip * slip)
}

/// Limit of |φ| below which a node sticks by the regularised law: |s| < 6.3 ε. By Coulomb's own law the limit is 1.
pub const STICK_UTILISATION: f64 = 0.9;

/// Whether a node of this traction utilisation, of either sign, counts as sticking.
pub fn sticks(utilisation: f64, regularisation: f64) -> bool {
    utilisation.abs() < if regularisation > 0.0 { STICK_UTILISATION } else { 1.0 }
}

/// Friction power −τ s where it is positive. Friction takes power; the slip of a node is a mean over its two cells, and
/// where it changes sign between them, the mean may have the sign of the other one by a round-off of the scheme.
pub fn power(shear: f64, slip: f64) -> f64 {
    (-shear * slip).max(0.0)
}

/// Friction power of vectors, −τ·s along the rail and across it where it is positive; with none across, [`power`] to
/// the bit.
pub fn vector_power(shear: [f64; 2], slip: [f64; 2]) -> f64 {
    (-shear[0] * slip[0] - shear[1] * slip[1]).max(0.0)
}

/// Change of [`vector_power`].
pub fn vector_power_tangent(shear: [f64; 2], slip: [f64; 2], shear_change: [f64; 2], slip_change: [f64; 2]) -> f64 {
    if shear[0] * slip[0] + shear[1] * slip[1] < 0.0 {
        -(shear_change[0] * slip[0] + shear[0] * slip_change[0])
            - (shear_change[1] * slip[1] + shear[1] * slip_change[1])
    } else {
        0.0
    }
}

/// Length of a vector along the rail and across it; with nothing across, the magnitude of the rest to the bit.
pub fn magnitude([along, across]: [f64; 2]) -> f64 {
    if across == 0.0 {
        along.abs()
    } else {
        (along * along + across * across).sqrt()
    }
}

/// Change of [`magnitude`]; none where there is no direction.
pub fn magnitude_tangent(vector: [f64; 2], change: [f64; 2]) -> f64 {
    let length = magnitude(vector);
    if length > 0.0 {
        (vector[0] * change[0] + vector[1] * change[1]) / length
    } else {
        0.0
    }
}

/// Change of [`power`].
pub fn power_tangent(shear: f64, slip: f64, shear_change: f64, slip_change: f64) -> f64 {
    if shear * slip < 0.0 {
        -(shear_change * slip + shear * slip_change)
    } else {
        0.0
    }
}

/// Sliding of a surface: speed, and power per friction coefficient and pressure.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Sliding {
    /// Slip speed |s|, `m/s`.
    pub speed: f64,
    /// Power φ s per friction coefficient and pressure, `m/s`.
    pub power: f64,
}

impl Sliding {
    /// Sliding at a slip velocity s `m/s` and the traction utilisation φ = −τ/(μ p).
    pub fn new(slip: f64, utilisation: f64) -> Sliding {
        Sliding {
            speed: slip.abs(),
            power: power(-utilisation, slip),
        }
    }

    /// Change of [`Sliding::new`].
    pub fn tangent(slip: f64, utilisation: f64, slip_change: f64, utilisation_change: f64) -> Sliding {
        Sliding {
            speed: slip.signum() * slip_change,
            power: power_tangent(-utilisation, slip, -utilisation_change, slip_change),
        }
    }

    /// Sliding at a slip velocity along the rail and across it, `m/s`, and the traction utilisation −τ/(μ p).
    pub fn of_vectors(slip: [f64; 2], utilisation: [f64; 2]) -> Sliding {
        Sliding {
            speed: magnitude(slip),
            power: vector_power(utilisation.map(|u| -u), slip),
        }
    }

    /// Change of [`Sliding::of_vectors`].
    pub fn vector_tangent(
        slip: [f64; 2],
        utilisation: [f64; 2],
        slip_change: [f64; 2],
        utilisation_change: [f64; 2],
    ) -> Sliding {
        let (shear, shear_change) = (utilisation.map(|u| -u), utilisation_change.map(|u| -u));
        Sliding {
            speed: magnitude_tangent(slip, slip_change),
            power: vector_power_tangent(shear, slip, shear_change, slip_change),
        }
    }
}

/// The regularised law solved for a shear and a slip against it of which only a sum is given, t + r σ = z with t = μ p (2/π) arctan(σ/ε): as
/// well conditioned for a small ε as for a large one, and Coulomb's law to the limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Resisted {
    /// t/(μ p).
    pub utilisation: f64,
    /// t.
    pub shear: f64,
    /// dt/dz.
    pub by_length: f64,
    /// dt/d(μ p).
    pub by_bound: f64,
}

impl Resisted {
    /// Solves with the bound μ p, r > 0, ε > 0, and z ≥ 0, all in units of the shear but r, shear per slip, and ε, slip.
    pub fn new(bound: f64, scale: f64, regularisation: f64, length: f64) -> Resisted {
        let relative = relative_slip(bound, scale * regularisation, length);
        let utilisation = FRAC_2_PI * relative.atan();
        // dt/dσ.
        let slope = bound * FRAC_2_PI / (regularisation * (1.0 + relative * relative));
        let by_length = slope / (slope + scale);
        Resisted {
            utilisation,
            shear: bound * utilisation,
            by_length,
            by_bound: utilisation * (1.0 - by_length),
        }
    }
}

/// Limit of the Newton steps for the slip of one cell. From the start chosen they take three to five.
const SLIP_STEPS: usize = 20;

/// x ≥ 0 with b (2/π) arctan x + c x = z. The left side is concave, so that Newton's method from below stays below; it starts with
/// arctan x ≤ (π/2) x/(x + 2/π), which is exact for small and large x in its order.
fn relative_slip(b: f64, c: f64, z: f64) -> f64 {
    if z <= 0.0 {
        return 0.0;
    }
    let linear = c * FRAC_2_PI + b - z;
    let root = (linear * linear + 4.0 * c * FRAC_2_PI * z).sqrt();
    // The larger root of c x² + linear x − (2/π) z = 0, without the difference of nearly equal numbers.
    let mut x = if linear > 0.0 {
        2.0 * FRAC_2_PI * z / (linear + root)
    } else {
        (root - linear) / (2.0 * c)
    };
    for _ in 0..SLIP_STEPS {
        let change = (z - b * FRAC_2_PI * x.atan() - c * x) / (b * FRAC_2_PI / (1.0 + x * x) + c);
        x = (x + change).max(0.0);
        if change <= 1e-15 * x {
            break;
        }
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::differences::slope;

    #[test]
    fn the_slope_is_the_derivative() {
        for slip in [-0.1, 0.0, 1e-4, 3e-3] {
            let difference = slope(|h| utilisation(slip + h, 1e-3), 1e-8);
            assert!((utilisation_slope(slip, 1e-3) / difference - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn the_tangent_of_vectors_is_the_derivative() {
        for (slip, share) in [
            ([0.1, -0.3], [-0.4, 0.7]),
            ([0.2, 0.0], [-0.9, 0.1]),
            ([0.1, 0.2], [0.5, 0.1]),
        ] {
            let (slip_change, share_change) = ([0.3, -0.7], [0.2, 0.5]);
            let at = |h: f64| {
                let moved = |value: [f64; 2], change: [f64; 2]| [0, 1].map(|i| value[i] + h * change[i]);
                Sliding::of_vectors(moved(slip, slip_change), moved(share, share_change))
            };
            let exact = Sliding::vector_tangent(slip, share, slip_change, share_change);
            // Truncation h².
            assert!((exact.speed - slope(|h| at(h).speed, 1e-6)).abs() < 1e-9);
            assert!((exact.power - slope(|h| at(h).power, 1e-6)).abs() < 1e-9);
        }
    }
}
