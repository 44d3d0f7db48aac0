//! Calls that the standard allows in each state, as one table: functions × states.

use crate::fmi::modes::Mode;
use crate::fmi::states::functions;

/// The states as the standard names them, in the order of the columns (section 4.2.4).
const STATES: [&str; 6] = [
    "instantiated",
    "initializationMode",
    "stepComplete",
    "stepFailed",
    "terminated",
    "error",
];

/// The column of a state. One that only FMI 3.0 has may come from a saved state of it.
fn column(mode: Mode) -> usize {
    match mode {
        Mode::Instantiated | Mode::Configuration => 0,
        Mode::Initialization => 1,
        Mode::StepComplete => 2,
        Mode::StepFailed => 3,
        Mode::Terminated => 4,
        Mode::Error => 5,
    }
}

/// State in which a function is named that is never allowed.
const NEVER: &str = "stepInProgress, which is never reached: steps are not asynchronous";

// The functions that work on an instance and are bound to states. fmi2FreeInstance is allowed in all of them.
// Columns: instantiated, initializationMode, stepComplete, stepFailed, terminated, error.
functions! {
    SetDebugLogging          "fmi2SetDebugLogging"          [x x x x x x]
    SetupExperiment          "fmi2SetupExperiment"          [x - - - - -]
    EnterInitializationMode  "fmi2EnterInitializationMode"  [x - - - - -]
    ExitInitializationMode   "fmi2ExitInitializationMode"   [- x - - - -]
    Terminate                "fmi2Terminate"                [- - x x - -]
    Reset                    "fmi2Reset"                    [x x x x x x]
    GetReal                  "fmi2GetReal"                  [- x x x x x]
    GetInteger               "fmi2GetInteger"               [- x x x x x]
    GetBoolean               "fmi2GetBoolean"               [- x x x x x]
    GetString                "fmi2GetString"                [- x x x x x]
    SetReal                  "fmi2SetReal"                  [x x x - - -]
    SetInteger               "fmi2SetInteger"               [x x x - - -]
    SetBoolean               "fmi2SetBoolean"               [x x x - - -]
    SetString                "fmi2SetString"                [x x x - - -]
    GetFmuState              "fmi2GetFMUstate"              [x x x x x x]
    SetFmuState              "fmi2SetFMUstate"              [x x x x x x]
    FreeFmuState             "fmi2FreeFMUstate"             [x x x x x x]
    SerializedFmuStateSize   "fmi2SerializedFMUstateSize"   [x x x x x x]
    SerializeFmuState        "fmi2SerializeFMUstate"        [x x x x x x]
    DeserializeFmuState      "fmi2DeSerializeFMUstate"      [x x x x x x]
    GetDirectionalDerivative "fmi2GetDirectionalDerivative" [- x x x x x]
    SetRealInputDerivatives  "fmi2SetRealInputDerivatives"  [x x x - - -]
    GetRealOutputDerivatives "fmi2GetRealOutputDerivatives" [- - x x x x]
    DoStep                   "fmi2DoStep"                   [- - x - - -]
    CancelStep               "fmi2CancelStep"               [- - - - - -]
    GetStatus                "fmi2GetStatus"                [- - x x x -]
    GetRealStatus            "fmi2GetRealStatus"            [- - x x x -]
    GetIntegerStatus         "fmi2GetIntegerStatus"         [- - x x x -]
    GetBooleanStatus         "fmi2GetBooleanStatus"         [- - x x x -]
    GetStringStatus          "fmi2GetStringStatus"          [- - x x x -]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::call::Function as _;

    #[test]
    fn the_columns_are_those_of_the_states() {
        assert!(Function::DoStep.is_allowed(Mode::StepComplete) && !Function::DoStep.is_allowed(Mode::StepFailed));
        assert_eq!(Function::Terminate.allowed_modes(), "stepComplete, stepFailed");
    }
}
