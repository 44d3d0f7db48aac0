//! Failures of a call of FMI 3.0, and who is to blame.

use crate::error::Error;
use crate::fmi::call::Refusal;
use crate::fmi::failures::{self, Blame};

/// Reason why a call did not return fmi3OK.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Failure that can occur in every version of FMI.
    #[error(transparent)]
    Shared(#[from] failures::Failure),
    /// A step that came only part of its way, under an importer that lets the unit return early.
    #[error("the step returned early at t = {reached} s: {error}")]
    ReturnedEarly {
        /// Time reached, `s`.
        reached: f64,
        /// Reason why the rest of the step was not begun.
        error: Error,
    },
    /// Room for another number of values than the variables have elements.
    #[error("nValues = {given}: the variables have {needed} elements")]
    Values {
        /// Room for so many values.
        given: usize,
        /// Elements.
        needed: usize,
    },
    /// Another number of seeds or sensitivities than the variables have elements.
    #[error("{argument} = {given}: the variables have {needed} elements")]
    Derivatives {
        /// The argument.
        argument: &'static str,
        /// Number that was given.
        given: usize,
        /// Variables.
        needed: usize,
    },
}

impl Refusal for Failure {
    fn blame(&self) -> Blame {
        match self {
            // Nothing was changed: the computation may go on with another step or other inputs.
            Failure::Shared(failures::Failure::Step { .. }) => Blame::Value,
            // The state is not that of before the call, which fmi3Discard would mean.
            Failure::Shared(failures::Failure::Interrupted { .. }) => Blame::Call,
            Failure::Shared(failure) => failure.blame(),
            Failure::ReturnedEarly { .. } => Blame::Remark,
            Failure::Values { .. } | Failure::Derivatives { .. } => Blame::Call,
        }
    }
}
