//! What one step is to solve, and how it came to rest: common to all engines.

use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::{Inputs, Motion};
use serde::{Deserialize, Serialize};

/// What one implicit step holds fixed.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// The inputs at the end of the step.
    pub inputs: Inputs,
    /// The motion they make.
    pub motion: Motion,
    /// Length of the step, `s`.
    pub duration: f64,
}

/// What a step is solved for: the parameters, the limits of the methods, the conditions.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// The parameters. Friction, interface and wheel are read here, the rest is in the engine.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// What the step holds fixed.
    pub conditions: Conditions,
}

/// How the iteration of a step came to rest.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations of the operator split, summed over the sub-steps of a step.
    pub iterations: usize,
    /// Last relative change of the surface temperature.
    pub residual: f64,
    /// Whether the contact would reach beyond its window: it is held within it, and the groove that the wheel has worn is as wide
    /// as the window.
    pub fills_window: bool,
}
