//! Contents of a saved state.

use super::modes::Mode;
use crate::parameters::{Parameters, ProfileContents};
use crate::signals::Inputs;
use crate::wheel_rail::State;
use serde::{Deserialize, Serialize};

/// The times of an experiment.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Experiment {
    /// Start time, `s`.
    pub start: f64,
    /// Stop time, where one is defined, `s`.
    pub stop: Option<f64>,
}

/// Everything of an instance that changes: a saved state is a copy of it. The order of the fields is that of the serialised
/// form.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Snapshot {
    /// State of the instance.
    pub mode: Mode,
    /// Times of the experiment, once they are set.
    pub experiment: Option<Experiment>,
    /// All parameters.
    pub parameters: Parameters,
    /// The inputs at the communication point.
    pub inputs: Inputs,
    /// Rates of change of the inputs in the next step, per second.
    pub rates: Inputs,
    /// The communication point, `s`.
    pub time: f64,
    /// Rail and contact, once computed.
    pub state: Option<State>,
    /// Contents of the profiles' files that the state was computed with.
    pub contents: Option<ProfileContents>,
}
