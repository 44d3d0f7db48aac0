//! Complete elliptic integrals by the arithmetic–geometric mean (Abramowitz and Stegun, 17.6).

/// Limit of the means; each squares the distance to the limit. From 1 and 1e-300 it takes twelve.
const MEANS: usize = 40;

/// Complete elliptic integrals of the modulus k.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Elliptic {
    /// Complete integral of the first kind, K(k).
    pub first: f64,
    /// Ratio S = (K − E)/(k² K), between ½ at k = 0 and 1 at k = 1: E = K (1 − k² S) without cancellation.
    pub share: f64,
}

/// Integrals of the complementary modulus k' = √(1 − k²), in (0, 1].
pub fn complete(complement: f64) -> Elliptic {
    let (mut arithmetic, mut geometric) = (1.0, complement);
    // S = Σ 2ⁿ⁻¹ c_n²/k², with c₀ = k and c_{n+1} = (a_n − g_n)/2 = c_n²/(4 a_{n+1}).
    let (mut share, mut ratio, mut weight) = (0.5, 1.0, 1.0);
    for _ in 0..MEANS {
        let half_difference = 0.5 * (arithmetic - geometric);
        (arithmetic, geometric) = (0.5 * (arithmetic + geometric), (arithmetic * geometric).sqrt());
        ratio *= half_difference / (4.0 * arithmetic);
        share += weight * ratio;
        weight *= 2.0;
        if half_difference <= f64::EPSILON * arithmetic {
            break;
        }
    }
    Elliptic {
        first: std::f64::consts::FRAC_PI_2 / arithmetic,
        share,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::{FRAC_PI_2, PI};

    /// ∫₀^{π/2} f(sin²) by the trapezium rule, which converges geometrically for a periodic function.
    fn integral(f: impl Fn(f64) -> f64) -> f64 {
        let points = 4000;
        let sum: f64 = (0..points)
            .map(|i| f((PI * (f64::from(i) + 0.5) / f64::from(points)).sin().powi(2)))
            .sum();
        0.5 * PI * sum / f64::from(points)
    }

    #[test]
    fn the_means_are_the_integrals() {
        for complement in [0.02_f64, 0.3, 0.9, 0.999_999, 1.0] {
            let m = 1.0 - complement * complement;
            let first = integral(|sine| 1.0 / (1.0 - m * sine).sqrt());
            // (K − E)/k² = ∫ sin²/√(1 − k² sin²).
            let difference = integral(|sine| sine / (1.0 - m * sine).sqrt());
            let elliptic = complete(complement);
            assert!((elliptic.first / first - 1.0).abs() < 1e-13, "{complement}");
            assert!(
                (elliptic.share * first / difference - 1.0).abs() < 1e-13,
                "{complement}"
            );
        }
        let circle = complete(1.0);
        assert_eq!((circle.first, circle.share), (FRAC_PI_2, 0.5));
    }

    /// K → ln(4/k') and S → 1 − 1/K for k' → 0.
    #[test]
    fn the_means_have_the_limit_of_a_long_ellipse() {
        for complement in [1e-6_f64, 1e-12, 1e-200] {
            let elliptic = complete(complement);
            let first = (4.0 / complement).ln();
            assert!((elliptic.first / first - 1.0).abs() < 1e-11, "{complement}");
            assert!((elliptic.share - (1.0 - 1.0 / first)).abs() < 1e-10, "{complement}");
        }
    }
}
