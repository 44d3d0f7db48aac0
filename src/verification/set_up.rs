//! Set-ups that several checks share.

use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters};

/// Most steps of the secant method: the creep curve is nearly straight where it crosses zero, and three are enough.
const STEPS: usize = 5;

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
