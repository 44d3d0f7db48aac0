//! Which call the standard allows in which state, as one table: functions × states.

use crate::fmi::modes::Mode;

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

        const TABLE: &[(&str, [bool; Mode::ALL.len()])] = &[$(($name, [$(allowed!($allowed)),*]),)*];
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_columns_stand_in_the_order_of_the_states() {
        for (column, mode) in Mode::ALL.into_iter().enumerate() {
            assert_eq!(mode as usize, column);
        }
        assert!(Function::DoStep.is_allowed(Mode::StepComplete) && !Function::DoStep.is_allowed(Mode::StepFailed));
        assert_eq!(Function::Terminate.allowed_modes(), "stepComplete, stepFailed");
    }
}
