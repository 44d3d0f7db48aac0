//! The states of an instance. Which call is allowed in which of them is each standard's own table.

use serde::{Deserialize, Serialize};

/// The states, named as in FMI 2.0 for co-simulation (section 4.2.4), and one that only FMI 3.0 has. Three of the standard's are never reached:
/// *stepInProgress* and *stepCanceled*, because steps are not asynchronous, and *fatal*, because one instance cannot harm
/// another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// New, or reset.
    Instantiated,
    /// Initialisation mode, between the calls that enter and exit it.
    Initialization,
    /// Communication point.
    StepComplete,
    /// State after a step that came only part of its way.
    StepFailed,
    /// State after the simulation was terminated.
    Terminated,
    /// State after a call that failed.
    Error,
    /// Configuration mode of FMI 3.0, between the calls that enter and exit it.
    Configuration,
}
