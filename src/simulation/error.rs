//! Reasons why a simulation cannot start, go on or be resumed.

use crate::error;
use thiserror::Error;

/// Errors of a simulation. What was simulated before stands.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Error {
    /// The model: parameters or inputs out of range, a solver that did not converge.
    #[error(transparent)]
    Model(#[from] error::Error),
    /// One row gives no time to simulate.
    #[error("a schedule needs at least two rows, this one has {rows}")]
    TooFewRows {
        /// Rows that there are.
        rows: usize,
    },
    /// A time that is not finite or does not lie after the one before it.
    #[error("row {row}: the time {time} is not after {before}")]
    TimeNotAscending {
        /// The row, the first being 0.
        row: usize,
        /// Time of the point, `s`.
        time: f64,
        /// The time of the row before, `s`; −∞ for the first.
        before: f64,
    },
    /// A communication step that leads nowhere.
    #[error("a communication step of {step} s: it must be positive and finite")]
    StepLength {
        /// The refused step, `s`.
        step: f64,
    },
    /// A step that did not reach its end. The state stands where the last sub-step ended that could be solved.
    #[error("the step from {time} s over {step} s: {source}")]
    Interrupted {
        /// Start of the step, `s`.
        time: f64,
        /// Length of the step, `s`.
        step: f64,
        /// Time of it that was simulated, `s`.
        committed: f64,
        /// Reason why the model could not go on.
        source: error::Error,
    },
    /// A state of a model with another mesh or other ranges, or with values that are not finite.
    #[error("the state at {time} s does not belong to this model: another mesh, or values that are not allowed")]
    ForeignState {
        /// Time of the refused state, `s`.
        time: f64,
    },
}

/// `Result` of a simulation.
pub type Result<T> = std::result::Result<T, Error>;
