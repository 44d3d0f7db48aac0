//! Failures of a call, and who is to blame: that decides the status which each version of FMI returns.

use super::serialized::Corruption;
use crate::error::Error;

/// Party to blame for a call that did not do all it was asked for, and with it the state of the instance afterwards.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Blame {
    /// Nobody: all was done, and there is something to say of it, an argument without effect or a step taken staggered.
    Remark,
    /// A value, or a question that has no answer: nothing was changed, the instance goes on.
    Value,
    /// A step whose solvers gave up after a part of it was committed.
    PartOfStep,
    /// A call that cannot be, parameters that make no model, or a solver that gave up at once: nothing was changed, but
    /// the importer must decide how to go on.
    Call,
    /// Blame of this library.
    Library,
}

/// The number of a status, the same in every version of FMI: OK, warning, discard, error.
pub const OK: i32 = 0;
/// Everything but a part without effect was done.
pub const WARNING: i32 = 1;
/// Nothing was changed, and the computation may go on.
pub const DISCARD: i32 = 2;
/// The computation must not go on as it is.
pub const ERROR: i32 = 3;

impl Blame {
    /// The number of the status: a value, or a step that stopped half-way, is discarded; what else cannot be done is an error.
    pub fn status(blame: Option<Blame>) -> i32 {
        match blame {
            None => OK,
            Some(Blame::Remark) => WARNING,
            Some(Blame::Value | Blame::PartOfStep) => DISCARD,
            Some(Blame::Call | Blame::Library) => ERROR,
        }
    }
}

/// Reason why a call failed, in words that hold for every version of FMI. The message names the variable or argument,
/// its value and what is allowed; the name of the function is put before it where it is logged.
#[derive(Debug, thiserror::Error)]
pub enum Failure {
    /// A call that the standard's table of states does not allow.
    #[error("not allowed in state {state}; allowed in {allowed}")]
    NotAllowed {
        /// The instance's state.
        state: &'static str,
        /// The states in which the call is allowed.
        allowed: String,
    },
    /// Derivative order 0 or below.
    #[error("order {order} of the time derivative of {name}: allowed is 1 and above")]
    Order {
        /// The variable.
        name: &'static str,
        /// The order.
        order: i32,
    },
    /// A direction, or a seed of a derivative, that is not finite.
    #[error("{argument} of {name} = {value}: allowed is any finite value")]
    Seed {
        /// The argument.
        argument: &'static str,
        /// The variable.
        name: &'static str,
        /// The refused value.
        value: f64,
    },
    /// A defect of this library.
    #[error("internal error: {message}; only a saved state, a reset or a new instance leads on")]
    Panic {
        /// Message of the panic.
        message: String,
    },
    /// A value that cannot be; nothing was set.
    #[error("{0}")]
    Value(Error),
    /// A step that came only part of its way.
    #[error(
        "the step stopped at t = {reached} s, {committed} s after its start, and the last committed state stands: {error}"
    )]
    Interrupted {
        /// Time reached, `s`.
        reached: f64,
        /// Part of the step that was committed, `s`.
        committed: f64,
        /// Reason why the step stopped.
        error: Error,
    },
    /// A step that could not be begun, with the last committed state standing.
    #[error("the step from t = {time} s failed, and the last committed state stands: {error}")]
    Step {
        /// Time of the last communication point, `s`.
        time: f64,
        /// Reason why the computation failed.
        error: Error,
    },
    /// The model refuses the combination of parameters and inputs, or cannot solve for it.
    #[error("{0}")]
    Model(Error),
    /// A pointer that must not be null.
    #[error("argument {argument} is a null pointer")]
    NullPointer {
        /// The argument.
        argument: &'static str,
    },
    /// A pointer that cannot be one of its type.
    #[error("argument {argument} is not aligned for its type")]
    Misaligned {
        /// The argument.
        argument: &'static str,
    },
    /// More elements than memory can hold.
    #[error("{count} elements of argument {argument} do not fit into memory")]
    Count {
        /// The argument.
        argument: &'static str,
        /// The number of elements.
        count: usize,
    },
    /// A value reference that no variable of the type has.
    #[error("value reference {reference} is not that of {expected}")]
    UnknownReference {
        /// The value reference.
        reference: u32,
        /// Value that the argument should have.
        expected: &'static str,
    },
    /// A variable that cannot be set now.
    #[error("{name} (value reference {reference}) cannot be set {when}; {settable}")]
    NotSettable {
        /// The variable.
        name: String,
        /// Value reference of the variable.
        reference: u32,
        /// Time in the life of the instance.
        when: &'static str,
        /// Variables that can be set at that time.
        settable: &'static str,
    },
    /// A start time that is not finite.
    #[error("startTime = {value} s: allowed is any finite value")]
    StartTime {
        /// The refused value.
        value: f64,
    },
    /// A stop time before the start time or not a number.
    #[error("stopTime = {value} s: allowed is startTime = {start} s and above")]
    StopTime {
        /// The refused value.
        value: f64,
        /// The start time, `s`.
        start: f64,
    },
    /// A step size that is not a positive finite number.
    #[error("communicationStepSize = {value} s: allowed is any finite value above 0")]
    StepSize {
        /// The refused value.
        value: f64,
    },
    /// A communication point other than the one where the last step ended.
    #[error("currentCommunicationPoint = {value} s: the last communication point was t = {expected} s")]
    CommunicationPoint {
        /// The refused value.
        value: f64,
        /// Time at which the last step ended, `s`.
        expected: f64,
    },
    /// A step beyond the stop time of the experiment.
    #[error("the step from t = {time} s by {size} s ends beyond stopTime = {stop} s")]
    BeyondStop {
        /// Communication point, `s`.
        time: f64,
        /// Step size, `s`.
        size: f64,
        /// Stop time, `s`.
        stop: f64,
    },
    /// A log category that is not declared.
    #[error("there is no log category {name:?}; declared are logStatusError, logStatusWarning, logSolver, logEvents")]
    UnknownCategory {
        /// The category.
        name: String,
    },
    /// No outputs exist: the error came before the initialisation.
    #[error("nothing has been computed: the error came before the end of the initialisation")]
    NothingComputed,
    /// A state that this instance has not saved, or has freed.
    #[error("FMUstate {address:#x} is not a saved state of this instance")]
    UnknownState {
        /// The address.
        address: usize,
    },
    /// A buffer of the wrong size.
    #[error("size = {given}: the serialized state has {needed} bytes")]
    BufferSize {
        /// Size of the buffer.
        given: usize,
        /// Size of the serialised state.
        needed: usize,
    },
    /// Bytes that are no serialised state of this instance.
    #[error("the serialized state is refused: {0}")]
    Corrupt(#[from] Corruption),
}

impl Failure {
    /// Returns the party to blame.
    pub fn blame(&self) -> Blame {
        match self {
            Failure::Value(_) => Blame::Value,
            Failure::Interrupted { .. } => Blame::PartOfStep,
            Failure::Panic { .. } => Blame::Library,
            _ => Blame::Call,
        }
    }
}
