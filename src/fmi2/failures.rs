//! What can go wrong in a call of FMI 2.0, and the status that follows.

use super::types::Status;
use crate::fmi::failures::{self, Blame};
use crate::fmi::fence::Panic;
use crate::fmi::modes::Mode;

/// Why a call did not return fmi2OK.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// What can go wrong in every version of FMI.
    #[error(transparent)]
    Shared(#[from] failures::Failure),
    /// A call that the table of states does not allow.
    #[error("not allowed in state {mode}; allowed in {allowed}")]
    NotAllowed {
        /// The instance's state.
        mode: Mode,
        /// The states in which the call is allowed.
        allowed: String,
    },
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
    /// Derivative order 0 or below.
    #[error("order {order} of the time derivative of {name}: allowed is 1 and above")]
    Order {
        /// The variable.
        name: &'static str,
        /// The order.
        order: i32,
    },
    /// Only the first time derivative of an input has an effect.
    #[error("the time derivative of order {order} of {name} is not used: inputs are interpolated to order 1")]
    HigherOrder {
        /// The input.
        name: &'static str,
        /// The order.
        order: i32,
    },
    /// A direction that is not finite.
    #[error("dvKnown of {name} = {value}: allowed is any finite value")]
    Direction {
        /// The input.
        name: &'static str,
        /// The refused value.
        value: f64,
    },
    /// A status that this component does not have.
    #[error(
        "status kind {kind} cannot be retrieved: there are fmi2LastSuccessfulTime (2, Real) and fmi2Terminated (3, Boolean); steps are not asynchronous"
    )]
    StatusKind {
        /// The status kind.
        kind: i32,
    },
    /// A defect of this library.
    #[error("internal error: {message}; only fmi2SetFMUstate, fmi2Reset and fmi2FreeInstance lead on")]
    Panic {
        /// What the panic said.
        message: String,
    },
}

impl From<Panic> for Failure {
    fn from(panic: Panic) -> Failure {
        Failure::Panic { message: panic.message }
    }
}

impl Failure {
    /// Who is to blame.
    pub fn blame(&self) -> Blame {
        match self {
            Failure::Shared(failure) => failure.blame(),
            Failure::HigherOrder { .. } => Blame::Unused,
            Failure::Rate { .. } | Failure::StatusKind { .. } => Blame::Value,
            Failure::NotAllowed { .. } | Failure::NoExperiment | Failure::Order { .. } | Failure::Direction { .. } => {
                Blame::Call
            }
            Failure::Panic { .. } => Blame::Library,
        }
    }
}

impl Status {
    /// The status of a call: a value, or a step that stopped half-way, is discarded; what else cannot be done is an error.
    pub fn of(blame: Option<Blame>) -> Status {
        match blame {
            None => Status::OK,
            Some(Blame::Unused) => Status::WARNING,
            Some(Blame::Value | Blame::PartOfStep) => Status::DISCARD,
            Some(Blame::Call | Blame::Library) => Status::ERROR,
        }
    }
}
