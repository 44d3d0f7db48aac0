//! Set-ups that several checks share.

use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::simulation::Simulation;
use crate::wheel_rail::Model;
use std::sync::Arc;

/// Most steps of the secant method: the creep curve is nearly straight where it crosses zero, and three are enough.
const STEPS: usize = 5;

/// Model whose steps are solved or refused, none taken staggered: what is compared with a closed form is a solution.
///
/// # Errors
/// Those of [`Model::new`].
pub fn model(parameters: Parameters) -> Result<Model> {
    Model::with_settings(parameters, Settings::strict())
}

/// Simulation of such a model.
///
/// # Errors
/// Those of [`Simulation::new`].
pub fn simulation(parameters: &Parameters, inputs: &Inputs) -> Result<Simulation> {
    Simulation::of(Arc::new(model(parameters.clone())?), inputs)
}

/// Mechanics alone: constant μ, and neither thermal expansion nor wear in the gap.
pub fn mechanics_alone() -> Parameters {
    Parameters {
        friction_law: FrictionLaw::Constant,
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        ..Parameters::default()
    }
}

/// The creepage of free rolling, at which `traction` of it vanishes, from two guesses by the secant method.
///
/// # Errors
/// Those of `traction`.
pub fn free_rolling(guesses: [f64; 2], mut traction: impl FnMut(f64) -> Result<f64>) -> Result<f64> {
    let [mut before, mut now] = guesses;
    let mut traction_before = traction(before)?;
    for _ in 0..STEPS {
        let traction_now = traction(now)?;
        // At round-off there is no secant; like bodies begin there.
        if traction_now.abs() <= f64::EPSILON || traction_now == traction_before {
            break;
        }
        let next = now - traction_now * (now - before) / (traction_now - traction_before);
        (before, traction_before, now) = (now, traction_now, next);
    }
    Ok(now)
}
