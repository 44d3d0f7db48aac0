//! Calls that the standard allows in each state, as one table: functions × states.

use crate::fmi::modes::Mode;
use crate::fmi::states::functions;

/// The states as the standard names them, in the order of the columns (sections 2.3 and 4.2).
const STATES: [&str; 5] = [
    "Instantiated",
    "Configuration Mode",
    "Initialization Mode",
    "Step Mode",
    "Terminated",
];

/// The column of a mode. A call that returns fmi3Error leads to *Terminated*; *stepFailed* is of FMI 2.0, from which a saved
/// state may come.
fn column(mode: Mode) -> usize {
    match mode {
        Mode::Instantiated => 0,
        Mode::Configuration => 1,
        Mode::Initialization => 2,
        Mode::StepComplete => 3,
        Mode::StepFailed | Mode::Terminated | Mode::Error => 4,
    }
}

/// State in which a function is named that is never allowed.
const NEVER: &str =
    "no state: this is a unit for co-simulation without event mode, clocks and other types of variables";

// Columns: Instantiated, Configuration Mode, Initialization Mode, Step Mode, Terminated. Lengths of arrays (UInt64) are set in
// Configuration Mode, and in Instantiated too: not every importer knows the former.
functions! {
    SetDebugLogging               "fmi3SetDebugLogging"               [x x x x x]
    EnterConfigurationMode        "fmi3EnterConfigurationMode"        [x - - - -]
    ExitConfigurationMode         "fmi3ExitConfigurationMode"         [- x - - -]
    EnterInitializationMode       "fmi3EnterInitializationMode"       [x - - - -]
    ExitInitializationMode        "fmi3ExitInitializationMode"        [- - x - -]
    EnterEventMode                "fmi3EnterEventMode"                [- - - - -]
    EnterStepMode                 "fmi3EnterStepMode"                 [- - - - -]
    Terminate                     "fmi3Terminate"                     [- - - x -]
    Reset                         "fmi3Reset"                         [x x x x x]
    GetFloat32                    "fmi3GetFloat32"                    [x - x x x]
    GetFloat64                    "fmi3GetFloat64"                    [x - x x x]
    GetInt8                       "fmi3GetInt8"                       [x - x x x]
    GetUInt8                      "fmi3GetUInt8"                      [x - x x x]
    GetInt16                      "fmi3GetInt16"                      [x - x x x]
    GetUInt16                     "fmi3GetUInt16"                     [x - x x x]
    GetInt32                      "fmi3GetInt32"                      [x - x x x]
    GetUInt32                     "fmi3GetUInt32"                     [x - x x x]
    GetInt64                      "fmi3GetInt64"                      [x - x x x]
    GetUInt64                     "fmi3GetUInt64"                     [x - x x x]
    GetBoolean                    "fmi3GetBoolean"                    [x - x x x]
    GetString                     "fmi3GetString"                     [x - x x x]
    GetBinary                     "fmi3GetBinary"                     [x - x x x]
    GetClock                      "fmi3GetClock"                      [- - - - -]
    SetFloat32                    "fmi3SetFloat32"                    [x - x x -]
    SetFloat64                    "fmi3SetFloat64"                    [x - x x -]
    SetInt8                       "fmi3SetInt8"                       [x - x x -]
    SetUInt8                      "fmi3SetUInt8"                      [x - x x -]
    SetInt16                      "fmi3SetInt16"                      [x - x x -]
    SetUInt16                     "fmi3SetUInt16"                     [x - x x -]
    SetInt32                      "fmi3SetInt32"                      [x - x x -]
    SetUInt32                     "fmi3SetUInt32"                     [x - x x -]
    SetInt64                      "fmi3SetInt64"                      [x - x x -]
    SetUInt64                     "fmi3SetUInt64"                     [x x - - -]
    SetBoolean                    "fmi3SetBoolean"                    [x - x x -]
    SetString                     "fmi3SetString"                     [x - x x -]
    SetBinary                     "fmi3SetBinary"                     [x - x x -]
    SetClock                      "fmi3SetClock"                      [- - - - -]
    GetNumberOfVariableDependencies "fmi3GetNumberOfVariableDependencies" [- - - - -]
    GetVariableDependencies       "fmi3GetVariableDependencies"       [- - - - -]
    GetFmuState                   "fmi3GetFMUState"                   [x x x x x]
    SetFmuState                   "fmi3SetFMUState"                   [x x x x x]
    FreeFmuState                  "fmi3FreeFMUState"                  [x x x x x]
    SerializedFmuStateSize        "fmi3SerializedFMUStateSize"        [x x x x x]
    SerializeFmuState             "fmi3SerializeFMUState"             [x x x x x]
    DeserializeFmuState           "fmi3DeserializeFMUState"           [x x x x x]
    GetDirectionalDerivative      "fmi3GetDirectionalDerivative"      [- - x x x]
    GetAdjointDerivative          "fmi3GetAdjointDerivative"          [- - x x x]
    GetIntervalDecimal            "fmi3GetIntervalDecimal"            [- - - - -]
    GetIntervalFraction           "fmi3GetIntervalFraction"           [- - - - -]
    GetShiftDecimal               "fmi3GetShiftDecimal"               [- - - - -]
    GetShiftFraction              "fmi3GetShiftFraction"              [- - - - -]
    SetIntervalDecimal            "fmi3SetIntervalDecimal"            [- - - - -]
    SetIntervalFraction           "fmi3SetIntervalFraction"           [- - - - -]
    SetShiftDecimal               "fmi3SetShiftDecimal"               [- - - - -]
    SetShiftFraction              "fmi3SetShiftFraction"              [- - - - -]
    EvaluateDiscreteStates        "fmi3EvaluateDiscreteStates"        [- - - - -]
    UpdateDiscreteStates          "fmi3UpdateDiscreteStates"          [- - - - -]
    EnterContinuousTimeMode       "fmi3EnterContinuousTimeMode"       [- - - - -]
    CompletedIntegratorStep       "fmi3CompletedIntegratorStep"       [- - - - -]
    SetTime                       "fmi3SetTime"                       [- - - - -]
    SetContinuousStates           "fmi3SetContinuousStates"           [- - - - -]
    GetContinuousStateDerivatives "fmi3GetContinuousStateDerivatives" [- - - - -]
    GetEventIndicators            "fmi3GetEventIndicators"            [- - - - -]
    GetContinuousStates           "fmi3GetContinuousStates"           [- - - - -]
    GetNominalsOfContinuousStates "fmi3GetNominalsOfContinuousStates" [- - - - -]
    GetNumberOfEventIndicators    "fmi3GetNumberOfEventIndicators"    [- - - - -]
    GetNumberOfContinuousStates   "fmi3GetNumberOfContinuousStates"   [- - - - -]
    GetOutputDerivatives          "fmi3GetOutputDerivatives"          [- - - x x]
    DoStep                        "fmi3DoStep"                        [- - - x -]
    ActivateModelPartition        "fmi3ActivateModelPartition"        [- - - - -]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fmi::call::Function as _;

    #[test]
    fn the_columns_are_those_of_the_states() {
        assert!(Function::DoStep.is_allowed(Mode::StepComplete) && !Function::DoStep.is_allowed(Mode::StepFailed));
        assert_eq!(Function::SetUInt64.allowed_modes(), "Instantiated, Configuration Mode");
        assert_eq!(Function::name_of(Mode::Error), "Terminated");
    }
}
