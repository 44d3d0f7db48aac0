//! The states of an instance. Which call is allowed in which of them is each standard's own table.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The states, named as in FMI 2.0 for co-simulation (section 4.2.4). Three of the standard's are never reached:
/// *stepInProgress* and *stepCanceled*, because steps are not asynchronous, and *fatal*, because one instance cannot harm
/// another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// New, or reset.
    Instantiated,
    /// Between the calls that enter and exit the initialisation mode.
    Initialization,
    /// At a communication point.
    StepComplete,
    /// After a step that came only part of its way.
    StepFailed,
    /// After the simulation was terminated.
    Terminated,
    /// After a call that failed.
    Error,
}

impl Mode {
    /// All states, in the order of the columns of a standard's table.
    pub const ALL: [Mode; 6] = [
        Mode::Instantiated,
        Mode::Initialization,
        Mode::StepComplete,
        Mode::StepFailed,
        Mode::Terminated,
        Mode::Error,
    ];
}

impl fmt::Display for Mode {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        formatter.write_str(match self {
            Mode::Instantiated => "instantiated",
            Mode::Initialization => "initializationMode",
            Mode::StepComplete => "stepComplete",
            Mode::StepFailed => "stepFailed",
            Mode::Terminated => "terminated",
            Mode::Error => "error",
        })
    }
}
