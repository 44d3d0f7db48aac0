//! The friction coefficient μ(θ), and the regularised Coulomb law (30) with its derivative.

use crate::dense;
use crate::parameters::{FrictionLaw, Parameters};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2, FRAC_PI_4, SQRT_2};

/// Strength of cold rail steel in section 3 of the paper, `Pa`.
const COLD_FLOW_STRESS: f64 = 925.7e6;

/// μ at an absolute temperature `K` and its derivative `1/K`.
pub fn coefficient(law: &Parameters, temperature: f64) -> (f64, f64) {
    match law.friction_law {
        FrictionLaw::Constant => (law.friction_cold, 0.0),
        FrictionLaw::PiecewiseLinear => interpolate(
            (law.friction_temperature_cold, law.friction_cold),
            (law.friction_temperature_hot, law.friction_hot),
            temperature,
        ),
        FrictionLaw::FlowStress => {
            let (stress, slope) = flow_stress(temperature);
            let drop = law.friction_cold - law.friction_hot;
            (
                law.friction_hot + drop * stress / COLD_FLOW_STRESS,
                drop * slope / COLD_FLOW_STRESS,
            )
        }
        FrictionLaw::Table => table(law, temperature),
    }
}

/// The largest μ that the law takes at any temperature.
pub fn largest_coefficient(law: &Parameters) -> f64 {
    match law.friction_law {
        FrictionLaw::Table => {
            let points = &law.friction_table_coefficient[..law.friction_table_points];
            points.iter().fold(0.0, |m, &c| c.max(m))
        }
        _ => law.friction_cold.max(law.friction_hot),
    }
}

/// Linear between two (temperature, coefficient) points, constant outside: (12)–(13) with the lower bound of Fig. 3.
fn interpolate((cold, mu_cold): (f64, f64), (hot, mu_hot): (f64, f64), temperature: f64) -> (f64, f64) {
    if temperature <= cold {
        (mu_cold, 0.0)
    } else if temperature >= hot {
        (mu_hot, 0.0)
    } else {
        let slope = (mu_hot - mu_cold) / (hot - cold);
        (mu_cold + slope * (temperature - cold), slope)
    }
}

fn table(law: &Parameters, temperature: f64) -> (f64, f64) {
    let points = law.friction_table_points;
    let temperatures = &law.friction_table_temperature[..points];
    let coefficients = &law.friction_table_coefficient[..points];
    let upper = temperatures.partition_point(|&t| t < temperature).clamp(1, points - 1);
    let point = |i: usize| (temperatures[i], coefficients[i]);
    interpolate(point(upper - 1), point(upper), temperature)
}

/// Flow stress σ₀ of rail steel, `Pa`, at an absolute temperature `K`, and its derivative `Pa/K` (section 3 of the
/// paper, after Popov et al. 2002): 925.7 MPa, above 663 K 5.936 T asinh(0.0023 exp(3074 K/T)) MPa. The paper prints 0.0025
/// under the root and degrees Celsius; only this form is continuous: the two branches meet at 662.8 K.
fn flow_stress(temperature: f64) -> (f64, f64) {
    let argument = 0.0023 * (3074.0 / temperature).exp();
    let stress = 5.936e6 * temperature * argument.asinh();
    // Near 0 K the argument overflows; the cold branch is meant there.
    if !argument.is_finite() || temperature < 600.0 || stress >= COLD_FLOW_STRESS {
        return (COLD_FLOW_STRESS, 0.0);
    }
    let slope_of_asinh = -3074.0 / (temperature * temperature) * argument / (1.0 + argument * argument).sqrt();
    (stress, 5.936e6 * (argument.asinh() + temperature * slope_of_asinh))
}

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

/// tan π/8.
const TAN_PI_8: f64 = SQRT_2 - 1.0;
/// (arctan √z / √z − 1)/z over 0 ≤ z ≤ tan² π/8: the polynomial through its values at the 11 Chebyshev points. Its error in
/// the arctangent is 5e-18.
const ARCTANGENT: [f64; 11] = [
    -0.333_333_333_333_333_3,
    0.199_999_999_999_955_2,
    -0.142_857_142_846_665_43,
    0.111_111_110_152_563_62,
    -0.090_909_045_781_239_02,
    0.076_921_831_908_260_87,
    -0.066_645_114_473_819_48,
    0.058_581_489_128_022_1,
    -0.050_854_497_379_402_6,
    0.039_231_658_295_587_19,
    -0.019_176_887_119_062_26,
];

/// arctan x to round-off, without branches: a fifth of the C library's time where several are computed at once.
#[inline(always)]
fn arctangent(x: f64) -> f64 {
    let a = x.abs();
    let (numerator, denominator, offset) = if a > 1.0 / TAN_PI_8 {
        (-1.0, a, FRAC_PI_2)
    } else if a > TAN_PI_8 {
        (a - 1.0, a + 1.0, FRAC_PI_4)
    } else {
        (a, 1.0, 0.0)
    };
    let t = numerator / denominator;
    let z = t * t;
    let (z2, z4) = (z * z, z * z * z * z);
    let c = ARCTANGENT;
    let low = (c[0] + c[1] * z) + (c[2] + c[3] * z) * z2;
    let middle = (c[4] + c[5] * z) + (c[6] + c[7] * z) * z2;
    let high = (c[8] + c[9] * z) + c[10] * z2;
    (offset + (t + t * z * (low + (middle + high * z4) * z4))).copysign(x)
}

/// dφ/ds, `s/m`.
pub fn saturation_slope(slip: f64, regularisation: f64) -> f64 {
    FRAC_2_PI * regularisation / (regularisation * regularisation + slip * slip)
}

/// A node sticks below this value of |φ|: |s| < 6.3 ε.
pub const STICK_SATURATION: f64 = 0.9;

#[cfg(test)]
mod tests {
    use super::*;

    fn law(friction_law: FrictionLaw) -> Parameters {
        Parameters {
            friction_law,
            ..Parameters::default()
        }
    }

    #[test]
    fn the_piecewise_linear_law_is_that_of_fig_3() {
        let law = law(FrictionLaw::PiecewiseLinear);
        for (celsius, mu) in [(-20.0, 0.45), (50.0, 0.45), (100.0, 0.35), (150.0, 0.25), (800.0, 0.25)] {
            assert!((coefficient(&law, celsius + 273.15).0 - mu).abs() < 1e-12);
        }
    }

    #[test]
    fn the_flow_stress_meets_the_published_value_at_663_kelvin() {
        // Printed in the paper: 925.7 MPa below; its corrected formula gives 925.4 MPa at 663 K.
        assert!((flow_stress(663.0).0 / 925.4e6 - 1.0).abs() < 1e-4);
        assert_eq!(flow_stress(293.15).0, 925.7e6);
        let law = law(FrictionLaw::FlowStress);
        assert_eq!(coefficient(&law, 293.15).0, 0.45);
        assert!(coefficient(&law, 2000.0).0 < 0.35);
    }

    #[test]
    fn the_arctangent_is_that_of_the_c_library() {
        for exponent in -320..=300 {
            for mantissa in [1.0, 2.0_f64.sqrt() - 1.0, 1.999, 3.3, 7.7] {
                let x = mantissa * 10.0_f64.powi(exponent);
                for x in [x, -x] {
                    // Round-off of the argument's reduction.
                    assert!(
                        (arctangent(x) - x.atan()).abs() <= 2.0 * f64::EPSILON * x.atan().abs(),
                        "{x:e}"
                    );
                }
            }
        }
        for x in [0.0, -0.0, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(arctangent(x).to_bits(), x.atan().to_bits());
        }
        assert!(arctangent(f64::NAN).is_nan());
    }

    #[test]
    fn slopes_are_the_derivatives() {
        for kind in [
            FrictionLaw::Constant,
            FrictionLaw::PiecewiseLinear,
            FrictionLaw::FlowStress,
            FrictionLaw::Table,
        ] {
            let law = law(kind);
            for temperature in [300.0, 340.0, 400.0, 660.0, 700.0, 1000.0] {
                let h = 1e-3;
                let difference =
                    (coefficient(&law, temperature + h).0 - coefficient(&law, temperature - h).0) / (2.0 * h);
                assert!(
                    (coefficient(&law, temperature).1 - difference).abs() < 1e-9,
                    "{kind:?} {temperature}"
                );
                assert!(coefficient(&law, temperature).0 <= largest_coefficient(&law));
            }
        }
        for slip in [-0.1, 0.0, 1e-4, 3e-3] {
            let h = 1e-8;
            let difference = (saturation(slip + h, 1e-3) - saturation(slip - h, 1e-3)) / (2.0 * h);
            assert!((saturation_slope(slip, 1e-3) / difference - 1.0).abs() < 1e-4);
        }
    }

    #[test]
    fn a_table_is_exact_at_its_points() {
        let mut law = law(FrictionLaw::Table);
        law.friction_table_points = 3;
        law.friction_table_temperature[..3].copy_from_slice(&[300.0, 350.0, 500.0]);
        law.friction_table_coefficient[..3].copy_from_slice(&[0.3, 0.5, 0.1]);
        for (t, mu) in [
            (200.0, 0.3),
            (300.0, 0.3),
            (325.0, 0.4),
            (350.0, 0.5),
            (425.0, 0.3),
            (500.0, 0.1),
            (600.0, 0.1),
        ] {
            assert!((coefficient(&law, t).0 - mu).abs() < 1e-12, "{t}");
        }
    }
}
