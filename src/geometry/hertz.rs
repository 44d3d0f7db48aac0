//! Hertz's contact of elastic bodies: the line contact of a cylinder (Johnson, Contact Mechanics, 4.43, 4.45), and the ellipse of
//! bodies that are curved along the rail and across it (4.24–4.26).

use crate::numerics::elliptic;
use std::f64::consts::PI;

/// Ratio of the curvatures across and along within which the contact is an ellipse worth the name, and its inverse.
pub const LARGEST_CURVATURE_RATIO: f64 = 1e4;

/// Limit of the steps for the ratio of the axes. Bisection alone would need 56.
const STEPS: usize = 80;

/// Hertz's solution for the gap A x² + B y².
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HertzEllipse {
    /// Semi-axis along the rail, `m`.
    pub along: f64,
    /// Semi-axis across the rail, `m`.
    pub across: f64,
    /// Peak pressure p₀ = 3 N/(2π a b), `Pa`.
    pub peak_pressure: f64,
    /// Approach of the bodies, `m`.
    pub approach: f64,
}

/// Ratio q ≤ 1 of the semi-axes for the `ratio` ≥ 1 of the curvatures: (E/q² − K)/(K − E) = (1 − S)/(S q²), which falls with q.
fn axes_ratio(ratio: f64) -> f64 {
    let excess = |logarithm: f64| {
        let share = elliptic::complete(logarithm.exp()).share;
        ((1.0 - share) / share).ln() - 2.0 * logarithm - ratio.ln()
    };
    // Over ln q, along which the slope is between −2 and −1.
    let (mut low, mut high) = (-ratio.ln(), 0.0);
    let mut logarithm = -ratio.ln() / 1.5;
    let mut last: Option<(f64, f64)> = None;
    for _ in 0..STEPS {
        let value = excess(logarithm);
        if value > 0.0 {
            low = logarithm;
        } else {
            high = logarithm;
        }
        let slope = match last {
            Some((before, value_before)) if before != logarithm => (value - value_before) / (logarithm - before),
            _ => -1.5,
        };
        last = Some((logarithm, value));
        let secant = logarithm - value / slope;
        let next = if secant > low && secant < high {
            secant
        } else {
            0.5 * (low + high)
        };
        if (next - logarithm).abs() <= 1e-15 * (1.0 + logarithm.abs()) {
            logarithm = next;
            break;
        }
        logarithm = next;
    }
    logarithm.exp()
}

/// Half-length a = √(4 N r/(π b E*)) of the contact of a cylinder of radius r and width b `m` under a load `N`, `m`, with the contact modulus
/// E* `Pa`.
pub fn line_half_length(load: f64, width: f64, radius: f64, modulus: f64) -> f64 {
    (4.0 * load * radius / (PI * width * modulus)).sqrt()
}

impl HertzEllipse {
    /// Ellipse under a `load` `N` for the curvatures A and B of the gap, along and across the rail, `1/m`, with the contact modulus E* `Pa`.
    pub fn new(load: f64, (along, across): (f64, f64), modulus: f64) -> HertzEllipse {
        let (small, large) = (along.min(across), along.max(across));
        let ratio = axes_ratio(large / small);
        let elliptic = elliptic::complete(ratio);
        // With the longer semi-axis a across the larger curvature: A = (p₀/E*) (b/a²) K S, p₀ = 3 N/(2π a b).
        let long = (1.5 * load * elliptic.first * elliptic.share / (PI * modulus * small)).cbrt();
        let short = ratio * long;
        let peak_pressure = if load > 0.0 {
            1.5 * load / (PI * long * short)
        } else {
            0.0
        };
        let (along, across) = if across > along { (long, short) } else { (short, long) };
        HertzEllipse {
            along,
            across,
            peak_pressure,
            approach: peak_pressure / modulus * short * elliptic.first,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::Parameters;

    fn curved(across: f64) -> Parameters {
        Parameters {
            rail_transverse_curvature: 2.0 * across,
            ..Parameters::default()
        }
    }

    /// Ellipse against Hertz's solution as the program CONTACT prints it, to its digits; its approach is 1e-4 to 2e-4
    /// below the closed form, also for spheres, where that is a²/R.
    #[test]
    fn the_ellipse_is_that_of_contact() {
        for (across, expected) in [
            (0.382360, [5.13773e-3, 10.27547e-3, 723.53e6, 69.05e-6]),
            (1.086957, [6.19524e-3, 6.19524e-3, 995.21e6, 83.43e-6]),
            (3.089949, [7.25363e-3, 3.62681e-3, 1451.95e6, 97.82e-6]),
        ] {
            let ellipse = curved(across).hertz_ellipse(80e3);
            let found = [ellipse.along, ellipse.across, ellipse.peak_pressure, ellipse.approach];
            for ((found, expected), digits) in found.into_iter().zip(expected).zip([2e-6, 2e-6, 1e-5, 2.5e-4]) {
                assert!((found / expected - 1.0).abs() < digits, "{across}: {found} {expected}");
            }
        }
    }

    /// Spheres: a³ = 3 N R/(4 E*), δ = a²/R (Johnson, Contact Mechanics, 4.22, 4.23).
    #[test]
    fn equal_curvatures_make_a_circle() {
        let parameters = curved(0.5 / Parameters::default().wheel_radius);
        let (load, radius) = (60e3, parameters.wheel_radius);
        let ellipse = parameters.hertz_ellipse(load);
        let axis = (0.75 * load * radius / parameters.contact_modulus()).cbrt();
        for (found, expected) in [
            (ellipse.along, axis),
            (ellipse.across, axis),
            (ellipse.approach, axis * axis / radius),
        ] {
            assert!((found / expected - 1.0).abs() < 1e-14, "{found} {expected}");
        }
    }

    /// The ratio of the curvatures comes back from the axes' for all that are allowed.
    #[test]
    fn the_ratio_of_the_axes_solves_its_equation() {
        for exponent in -40..=40 {
            let ratio = 10.0_f64.powf(f64::from(exponent) / 10.0);
            let (along, _) = Parameters::default().gap_curvatures();
            let ellipse = curved(ratio * along).hertz_ellipse(60e3);
            let q = (ellipse.along / ellipse.across).min(ellipse.across / ellipse.along);
            let share = elliptic::complete(q).share;
            let found = (1.0 - share) / (share * q * q);
            assert!((found / ratio.max(1.0 / ratio) - 1.0).abs() < 1e-12, "{ratio}: {found}");
            assert_eq!(ellipse.along > ellipse.across, ratio > 1.0);
        }
    }

    /// A cylinder across is a line contact: the load per width at the middle of a long ellipse, a² = 4 P r₀/(π E*).
    #[test]
    fn a_long_ellipse_is_a_line_at_its_middle() {
        let parameters = curved(1e-4);
        let ellipse = parameters.hertz_ellipse(1e5);
        // p₀ = 2 P/(π a).
        let load_per_width = 0.5 * PI * ellipse.along * ellipse.peak_pressure;
        let line = 4.0 * load_per_width * parameters.wheel_radius / (PI * parameters.contact_modulus());
        assert!((ellipse.along.powi(2) / line - 1.0).abs() < 1e-2, "{ellipse:?}");
    }
}
