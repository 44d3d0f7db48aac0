//! The half-planes of a pair.

use crate::parameters::{Parameters, Wheel};

/// Constants of the pair of half-planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlanes {
    /// Σ (1 − ν)/γ over the bodies, `1/Pa`.
    pub direct: f64,
    /// (1 − 2ν)/(2γ) of the rail less that of the wheel, `1/Pa`.
    pub coupling: f64,
}

impl HalfPlanes {
    /// Of the parameters' pair.
    pub fn of_pair(parameters: &Parameters) -> HalfPlanes {
        let body = |lambda: f64, shear: f64| {
            let poisson = lambda / (2.0 * (lambda + shear));
            ((1.0 - poisson) / shear, (1.0 - 2.0 * poisson) / (2.0 * shear))
        };
        let (mut direct, mut coupling) = body(parameters.lame_lambda, parameters.shear_modulus);
        if parameters.wheel == Wheel::Elastic {
            let wheel = body(parameters.wheel_lame_lambda, parameters.wheel_shear_modulus);
            direct += wheel.0;
            coupling -= wheel.1;
        }
        if !parameters.normal_tangential_coupling {
            coupling = 0.0;
        }
        HalfPlanes { direct, coupling }
    }
}
