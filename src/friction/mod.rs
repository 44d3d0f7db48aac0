//! Friction: the laws of the coefficient μ(θ) here, with slip and memory in [`path`] and [`memory`], a layer that flows in [`layer`], Coulomb's law in [`coulomb`].

pub mod coulomb;
#[cfg(test)]
pub mod duals;
pub mod layer;
pub mod memory;
mod node;
mod passage;
pub mod path;

use crate::parameters::{FrictionLaw, Parameters};

/// Strength of cold rail steel in section 3 of the paper, `Pa`.
const COLD_FLOW_STRESS: f64 = 925.7e6;

/// Coefficient μ at an absolute temperature `K` and its derivative `1/K`.
pub fn coefficient(law: &Parameters, temperature: f64) -> (f64, f64) {
    match law.friction_law {
        FrictionLaw::Constant => (law.friction_cold, 0.0),
        FrictionLaw::PiecewiseLinear => interpolate(
            TablePoint {
                temperature: law.friction_temperature_cold,
                coefficient: law.friction_cold,
            },
            TablePoint {
                temperature: law.friction_temperature_hot,
                coefficient: law.friction_hot,
            },
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

/// Point of a law that is piecewise linear in the temperature.
struct TablePoint {
    /// Absolute temperature, `K`.
    temperature: f64,
    /// Friction coefficient there.
    coefficient: f64,
}

/// Interpolates linearly between two points, constant outside: (12)–(13) with the lower bound of Fig. 3. Returns μ and its
/// slope `1/K`.
fn interpolate(cold: TablePoint, hot: TablePoint, temperature: f64) -> (f64, f64) {
    if temperature <= cold.temperature {
        (cold.coefficient, 0.0)
    } else if temperature >= hot.temperature {
        (hot.coefficient, 0.0)
    } else {
        let slope = (hot.coefficient - cold.coefficient) / (hot.temperature - cold.temperature);
        (cold.coefficient + slope * (temperature - cold.temperature), slope)
    }
}

fn table(law: &Parameters, temperature: f64) -> (f64, f64) {
    let points = law.friction_table_points;
    let temperatures = &law.friction_table_temperature[..points];
    let coefficients = &law.friction_table_coefficient[..points];
    let upper = temperatures.partition_point(|&t| t < temperature).clamp(1, points - 1);
    let point = |i: usize| TablePoint {
        temperature: temperatures[i],
        coefficient: coefficients[i],
    };
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

/// Absolute temperature and scale at which the friction law is evaluated.
#[derive(Debug, Clone, Copy)]
pub struct FrictionState<'a> {
    /// The law.
    pub parameters: &'a Parameters,
    /// Ambient temperature, `K`.
    pub ambient: f64,
    /// Factor on μ.
    pub scale: f64,
}

impl FrictionState<'_> {
    /// Coefficient μ at a temperature rise `K`, and dμ/dθ `1/K`.
    pub fn coefficient(&self, rise: f64) -> (f64, f64) {
        let (mu, slope) = coefficient(self.parameters, self.ambient + rise);
        (self.scale * mu, self.scale * slope)
    }

    /// Change of μ at a temperature rise with that of the rise `K`, the ambient `K` and the factor.
    pub fn coefficient_tangent(&self, rise: f64, [rise_change, ambient_change, scale_change]: [f64; 3]) -> f64 {
        let (mu, slope) = coefficient(self.parameters, self.ambient + rise);
        self.scale * slope * (rise_change + ambient_change) + scale_change * mu
    }
}

/// Law of μ at a point as a function of its temperature at given slip and history: `base` + `share` μ(θ), but no more than the
/// `layer_bound`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PointLaw {
    /// Part of μ that does not depend on the temperature.
    pub base: f64,
    /// Share of μ(θ).
    pub share: f64,
    /// The strength of a layer over the pressure; 0 where there is none.
    pub layer_bound: f64,
}

impl PointLaw {
    /// Coefficient and its derivative, from those of μ(θ).
    pub fn of(&self, (mu, slope): (f64, f64)) -> (f64, f64) {
        let surfaces = self.base + self.share * mu;
        if self.exceeds_layer_bound(surfaces) {
            (self.layer_bound, 0.0)
        } else {
            (surfaces, self.share * slope)
        }
    }

    /// Whether the layer's bound is below that of surfaces of this μ.
    fn exceeds_layer_bound(&self, surfaces: f64) -> bool {
        self.layer_bound > 0.0 && surfaces > self.layer_bound
    }

    /// The derivative by μ(θ), from μ(θ).
    pub fn share_at(&self, mu: f64) -> f64 {
        if self.exceeds_layer_bound(self.base + self.share * mu) {
            0.0
        } else {
            self.share
        }
    }
}

impl Default for PointLaw {
    /// Law μ(θ) without slip, history and layer.
    fn default() -> PointLaw {
        PointLaw {
            base: 0.0,
            share: 1.0,
            layer_bound: 0.0,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::differences;

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
    fn slopes_are_the_derivatives() {
        for kind in FrictionLaw::ALL {
            let law = law(*kind);
            // Between the corners of the laws.
            for temperature in (0..60).map(|point| 110.0 + 25.0 * f64::from(point)) {
                let difference = differences::slope(|h| coefficient(&law, temperature + h).0, 1e-3);
                let (mu, slope) = coefficient(&law, temperature);
                assert!(
                    (slope - difference).abs() < 1e-9,
                    "{kind:?} at {temperature} K: dμ/dθ = {slope} beside μ in `coefficient` of src/friction/mod.rs, \
                     {difference} by differences"
                );
                let largest = largest_coefficient(&law);
                assert!(
                    mu <= largest,
                    "{kind:?} at {temperature} K: μ = {mu} is above {largest} of `largest_coefficient` in \
                     src/friction/mod.rs"
                );
            }
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
