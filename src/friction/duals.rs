//! The laws of friction over again, in dual numbers, from their published equations: an oracle for derivatives, without differences.

use super::*;
use num_dual::{Dual64, DualNum};

/// The smaller of two, with its derivative.
pub fn lesser(one: Dual64, other: Dual64) -> Dual64 {
    if one.re <= other.re { one } else { other }
}

/// The larger of two, with its derivative.
pub fn larger(one: Dual64, other: Dual64) -> Dual64 {
    -lesser(-one, -other)
}

/// μ(θ) at an absolute temperature `K`: (12)–(13) with the lower bound of Fig. 3 of the paper, its flow stress of rail steel, and the
/// line through the points of a table.
pub fn coefficient_at(law: &Parameters, temperature: Dual64) -> Dual64 {
    let line = |points: &[(f64, f64)]| {
        let last = points[points.len() - 1];
        let ends = |[one, other]: [(f64, f64); 2]| {
            let part = (temperature - one.0) / (other.0 - one.0);
            (temperature.re <= other.0).then_some((-part + 1.0) * one.1 + part * other.1)
        };
        if temperature.re <= points[0].0 {
            return Dual64::from(points[0].1);
        }
        let mut pieces = points.windows(2).map(|pair| ends([pair[0], pair[1]]));
        pieces.find_map(|piece| piece).unwrap_or(Dual64::from(last.1))
    };
    let (cold, hot) = (law.friction_cold, law.friction_hot);
    match law.friction_law {
        FrictionLaw::Constant => Dual64::from(cold),
        FrictionLaw::PiecewiseLinear => line(&[
            (law.friction_temperature_cold, cold),
            (law.friction_temperature_hot, hot),
        ]),
        FrictionLaw::FlowStress => {
            let hardness = if temperature.re < 600.0 {
                Dual64::from(925.7)
            } else {
                let steel = temperature * 5.936 * ((temperature.recip() * 3074.0).exp() * 0.0023).asinh();
                lesser(Dual64::from(925.7), steel)
            };
            hardness / 925.7 * (cold - hot) + hot
        }
        FrictionLaw::Table => {
            let points = law
                .friction_table_temperature
                .iter()
                .zip(&law.friction_table_coefficient);
            line(
                &points
                    .take(law.friction_table_points)
                    .map(|(&t, &c)| (t, c))
                    .collect::<Vec<_>>(),
            )
        }
    }
}

/// A table of several pieces, rising and falling.
pub fn with_table(law: FrictionLaw) -> Parameters {
    let mut parameters = Parameters {
        friction_law: law,
        friction_table_points: 4,
        ..Parameters::default()
    };
    parameters.friction_table_temperature[..4].copy_from_slice(&[310.0, 360.0, 420.0, 700.0]);
    parameters.friction_table_coefficient[..4].copy_from_slice(&[0.3, 0.5, 0.2, 0.25]);
    parameters
}

#[test]
fn the_laws_of_temperature_have_the_derivatives_of_their_equations() {
    for kind in FrictionLaw::ALL {
        let law = with_table(*kind);
        for temperature in (0..200).map(|point| 251.3 + 7.1 * f64::from(point)) {
            let expected = coefficient_at(&law, Dual64::new(temperature, 1.0));
            let (mu, slope) = coefficient(&law, temperature);
            assert!(
                (mu - expected.re).abs() < 1e-14,
                "{kind:?}, {temperature} K: {mu}, {expected}"
            );
            assert!(
                (slope - expected.eps).abs() < 1e-15,
                "{kind:?}, {temperature} K: {slope}, {expected}"
            );
        }
    }
}
