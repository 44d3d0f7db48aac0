//! The state machine of the standard as one table: functions × states.

use serde::{Deserialize, Serialize};
use std::fmt;

/// The states of FMI 2.0 for co-simulation, section 4.2.4. Three of the standard's are never reached: *stepInProgress* and
/// *stepCanceled*, because steps are not asynchronous, and *fatal*, because one instance cannot harm another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Mode {
    /// After fmi2Instantiate or fmi2Reset.
    Instantiated,
    /// Between fmi2EnterInitializationMode and fmi2ExitInitializationMode.
    Initialization,
    /// At a communication point.
    StepComplete,
    /// After a step that came only part of its way (fmi2Discard).
    StepFailed,
    /// After fmi2Terminate.
    Terminated,
    /// After a call that returned fmi2Error.
    Error,
}

impl Mode {
    const ALL: [Mode; 6] = [
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

macro_rules! allowed {
    (x) => {
        true
    };
    (-) => {
        false
    };
}

macro_rules! table {
    ($($function:ident $name:literal [$($allowed:tt)*])*) => {
        /// The functions that work on an instance and are bound to states. fmi2FreeInstance is allowed in all of them.
        #[derive(Debug, Clone, Copy, PartialEq, Eq)]
        pub enum Function {
            $(
                #[doc = $name]
                $function,
            )*
        }

        const TABLE: &[(&str, [bool; 6])] = &[$(($name, [$(allowed!($allowed)),*]),)*];
    };
}

// Columns: instantiated, initializationMode, stepComplete, stepFailed, terminated, error (section 4.2.4).
table! {
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

impl Function {
    /// The exported name.
    pub fn name(self) -> &'static str {
        TABLE[self as usize].0
    }

    /// Whether the standard allows the call in a state.
    pub fn is_allowed(self, mode: Mode) -> bool {
        TABLE[self as usize].1[mode as usize]
    }

    /// The states in which the call is allowed, for messages.
    pub fn allowed_modes(self) -> String {
        let names: Vec<String> = Mode::ALL
            .into_iter()
            .filter(|mode| self.is_allowed(*mode))
            .map(|mode| mode.to_string())
            .collect();
        if names.is_empty() {
            "stepInProgress, which is never reached: steps are not asynchronous".to_owned()
        } else {
            names.join(", ")
        }
    }
}
