//! Failures of a call of FMI 2.0, and who is to blame.

use crate::fmi::call::Refusal;
use crate::fmi::failures::{self, Blame};

/// Reason why a call did not return fmi2OK.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// Failure that can occur in every version of FMI.
    #[error(transparent)]
    Shared(#[from] failures::Failure),
    /// fmi2EnterInitializationMode before fmi2SetupExperiment.
    #[error("fmi2SetupExperiment must be called before")]
    NoExperiment,
    /// A rate of change of an input that cannot be; nothing was set.
    #[error("the time derivative of {name} = {value}: allowed is any finite value")]
    Rate {
        /// The input.
        name: &'static str,
        /// The refused value.
        value: f64,
    },
    /// Only the first time derivative of an input has an effect.
    #[error("the time derivative of order {order} of {name} is not used: inputs are interpolated to order 1")]
    HigherOrder {
        /// The input.
        name: &'static str,
        /// The order.
        order: i32,
    },
    /// A status that this component does not have.
    #[error(
        "status kind {kind} cannot be retrieved: there are fmi2LastSuccessfulTime (2, Real) and fmi2Terminated (3, Boolean); steps are not asynchronous"
    )]
    StatusKind {
        /// The status kind.
        kind: i32,
    },
}

impl Refusal for Failure {
    fn blame(&self) -> Blame {
        match self {
            Failure::Shared(failure) => failure.blame(),
            Failure::HigherOrder { .. } => Blame::Remark,
            Failure::Rate { .. } | Failure::StatusKind { .. } => Blame::Value,
            Failure::NoExperiment => Blame::Call,
        }
    }
}
