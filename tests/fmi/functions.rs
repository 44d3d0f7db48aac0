//! The functions of a standard that take an instance: for each a call that is right in itself, and the states in which the
//! standard allows it, as the standard's text has them (2.0.5, section 4.2.4; 3.0.2, sections 2.3 and 4.2).

use super::importer::{Api, Component, Fmi2, Fmi3, Handle, OK, Standard};
use std::ffi::c_int;
use std::ptr::{null, null_mut};

/// A function with a call of it: given the library, an instance and a saved state of that.
pub struct Function {
    pub name: &'static str,
    pub call: fn(&Api, Component, Handle) -> c_int,
    /// By states, in the order of [`states_of`].
    pub allowed: &'static [bool],
}

/// The states, in the words of the standards.
pub fn states_of(standard: Standard) -> &'static [&'static str] {
    match standard {
        Fmi2 => &[
            "instantiated",
            "initializationMode",
            "stepComplete",
            "stepFailed",
            "terminated",
            "error",
        ],
        Fmi3 => &[
            "Instantiated",
            "Configuration Mode",
            "Initialization Mode",
            "Step Mode",
            "Terminated",
        ],
    }
}

pub fn of_standard(standard: Standard) -> &'static [Function] {
    match standard {
        Fmi2 => OF_FMI2,
        Fmi3 => OF_FMI3,
    }
}

const fn is_allowed(cell: &str) -> bool {
    matches!(cell.as_bytes(), b"x")
}

macro_rules! functions {
    (|$api:ident, $c:ident, $state:ident| $($name:ident [$($cell:tt)*] $body:block;)*) => {
        &[$(Function {
            name: stringify!($name),
            call: |$api, $c, $state| {
                let _ = $state;
                // SAFETY: a live instance or null, its state, and as many elements as are counted.
                unsafe { $body }
            },
            allowed: &[$(is_allowed(stringify!($cell))),*],
        }),*]
    };
}

/// The bytes of a state; none without an instance.
fn bytes(api: &Api, c: Component, state: Handle) -> Vec<u8> {
    let mut size = 0;
    // SAFETY: a live instance or null, its state, and room for the bytes.
    unsafe {
        api.serialized_size(c, state, &mut size);
        let mut bytes = vec![0; size];
        let status = api.serialize(c, state, bytes.as_mut_ptr(), size);
        assert!(status == OK || c.is_null());
        bytes
    }
}

/// A status that is allowed where there is nothing to tell.
fn discarded(status: c_int) -> c_int {
    if status == super::importer::DISCARD { OK } else { status }
}

// Columns: instantiated, initializationMode, stepComplete, stepFailed, terminated, error.
const OF_FMI2: &[Function] = functions! {
    |api, c, state|
    fmi2SetDebugLogging          [x x x x x x] { api.set_debug_logging(c, 0, 0, null()) };
    fmi2SetupExperiment          [x - - - - -] { (api.fmi2.fmi2SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0) };
    fmi2EnterInitializationMode  [x - - - - -] { api.enter_initialization(c) };
    fmi2ExitInitializationMode   [- x - - - -] { api.exit_initialization(c) };
    fmi2Terminate                [- - x x - -] { api.terminate(c) };
    fmi2Reset                    [x x x x x x] { api.reset(c) };
    fmi2GetReal                  [- x x x x x] { api.get_real(c, &api.reference("peak_pressure"), 1, &mut 0.0) };
    fmi2GetInteger               [- x x x x x] { api.get_integer(c, &api.reference("control"), 1, &mut 0) };
    fmi2GetBoolean               [- x x x x x] { api.get_boolean(c, null(), 0, null_mut()) };
    fmi2GetString                [- x x x x x] { api.get_string(c, null(), 0, null_mut()) };
    fmi2SetReal                  [x x x - - -] { api.set_real(c, &api.reference("normal_load"), 1, &5e4) };
    fmi2SetInteger               [x x x - - -] { api.set_integer(c, null(), 0, null()) };
    fmi2SetBoolean               [x x x - - -] { api.set_boolean(c, null(), 0, null()) };
    fmi2SetString                [x x x - - -] { api.set_string(c, null(), 0, null()) };
    fmi2GetFMUstate              [x x x x x x] { api.get_state(c, &mut null_mut()) };
    fmi2SetFMUstate              [x x x x x x] { api.set_state(c, state) };
    fmi2FreeFMUstate             [x x x x x x] { api.free_state(c, &mut state.clone()) };
    fmi2SerializedFMUstateSize   [x x x x x x] { api.serialized_size(c, state, &mut 0) };
    fmi2SerializeFMUstate        [x x x x x x] {
        let mut bytes = bytes(api, c, state);
        api.serialize(c, state, bytes.as_mut_ptr(), bytes.len())
    };
    fmi2DeSerializeFMUstate      [x x x x x x] {
        let bytes = bytes(api, c, state);
        api.deserialize(c, bytes.as_ptr(), bytes.len(), &mut null_mut())
    };
    fmi2GetDirectionalDerivative [- x x x x x] {
        let (unknown, known) = (api.reference("traction_force"), api.reference("creepage"));
        api.directional_derivative(c, &unknown, 1, &known, 1, &1.0, &mut 0.0)
    };
    fmi2SetRealInputDerivatives  [x x x - - -] {
        (api.fmi2.fmi2SetRealInputDerivatives)(c, &api.reference("normal_load"), 1, &1, &1.0)
    };
    fmi2GetRealOutputDerivatives [- - x x x x] {
        api.get_output_derivatives(c, &api.reference("traction_force"), 1, &1, &mut 0.0)
    };
    fmi2DoStep                   [- - x - - -] { (api.fmi2.fmi2DoStep)(c, 0.0, 1e-3, 1) };
    fmi2CancelStep               [- - - - - -] { (api.fmi2.fmi2CancelStep)(c) };
    // Allowed, but there is nothing to tell: fmi2Discard.
    fmi2GetStatus                [- - x x x -] { discarded((api.fmi2.fmi2GetStatus)(c, 0, &mut 0)) };
    fmi2GetRealStatus            [- - x x x -] { (api.fmi2.fmi2GetRealStatus)(c, 2, &mut 0.0) };
    fmi2GetIntegerStatus         [- - x x x -] { discarded((api.fmi2.fmi2GetIntegerStatus)(c, 0, &mut 0)) };
    fmi2GetBooleanStatus         [- - x x x -] { (api.fmi2.fmi2GetBooleanStatus)(c, 3, &mut 0) };
    fmi2GetStringStatus          [- - x x x -] { discarded((api.fmi2.fmi2GetStringStatus)(c, 1, &mut null())) };
};

// Columns: Instantiated, Configuration Mode, Initialization Mode, Step Mode, Terminated.
//
// The standard's other states belong to event mode, intermediate update and tunable structural parameters, which the description
// declines: hasEventMode, providesIntermediateUpdate, no structural parameter that is tunable. With them go the functions of
// clocks and events; those of model exchange and scheduled execution are not allowed in co-simulation, those of dependencies
// without providesPerElementDependencies.
//
// In Configuration Mode structural parameters alone are set, which are of type UInt64, and nothing is read. In one cell the unit
// allows more than the standard: importers that do not know Configuration Mode set structural parameters in Instantiated.
const OF_FMI3: &[Function] = functions! {
    |api, c, state|
    fmi3SetDebugLogging           [x x x x x] { api.set_debug_logging(c, 0, 0, null()) };
    fmi3EnterConfigurationMode    [x - - - -] { (api.fmi3.fmi3EnterConfigurationMode)(c) };
    fmi3ExitConfigurationMode     [- x - - -] { (api.fmi3.fmi3ExitConfigurationMode)(c) };
    fmi3EnterInitializationMode   [x - - - -] { (api.fmi3.fmi3EnterInitializationMode)(c, 1, 1e-6, 0.0, 1, 1.0) };
    fmi3ExitInitializationMode    [- - x - -] { api.exit_initialization(c) };
    fmi3Terminate                 [- - - x -] { api.terminate(c) };
    fmi3Reset                     [x x x x x] { api.reset(c) };
    fmi3GetFloat32                [x - x x x] { (api.fmi3.fmi3GetFloat32)(c, null(), 0, null_mut(), 0) };
    // An input, which has a value in every state.
    fmi3GetFloat64                [x - x x x] { api.get_real(c, &api.reference("normal_load"), 1, &mut 0.0) };
    fmi3GetInt8                   [x - x x x] { (api.fmi3.fmi3GetInt8)(c, null(), 0, null_mut(), 0) };
    fmi3GetUInt8                  [x - x x x] { (api.fmi3.fmi3GetUInt8)(c, null(), 0, null_mut(), 0) };
    fmi3GetInt16                  [x - x x x] { (api.fmi3.fmi3GetInt16)(c, null(), 0, null_mut(), 0) };
    fmi3GetUInt16                 [x - x x x] { (api.fmi3.fmi3GetUInt16)(c, null(), 0, null_mut(), 0) };
    fmi3GetInt32                  [x - x x x] { api.get_integer(c, &api.reference("contact_nodes"), 1, &mut 0) };
    fmi3GetUInt32                 [x - x x x] { (api.fmi3.fmi3GetUInt32)(c, null(), 0, null_mut(), 0) };
    fmi3GetInt64                  [x - x x x] { api.get_integer(c, &api.reference("control"), 1, &mut 0) };
    fmi3GetUInt64                 [x - x x x] { api.get_integer(c, &api.reference("patch_strips"), 1, &mut 0) };
    fmi3GetBoolean                [x - x x x] { api.get_boolean(c, &api.reference("wheel_heating"), 1, &mut 0) };
    fmi3GetString                 [x - x x x] { api.get_string(c, null(), 0, null_mut()) };
    fmi3GetBinary                 [x - x x x] { (api.fmi3.fmi3GetBinary)(c, null(), 0, null_mut(), null_mut(), 0) };
    fmi3SetFloat32                [x - x x -] { (api.fmi3.fmi3SetFloat32)(c, null(), 0, null(), 0) };
    fmi3SetFloat64                [x - x x -] { api.set_real(c, &api.reference("normal_load"), 1, &5e4) };
    fmi3SetInt8                   [x - x x -] { (api.fmi3.fmi3SetInt8)(c, null(), 0, null(), 0) };
    fmi3SetUInt8                  [x - x x -] { (api.fmi3.fmi3SetUInt8)(c, null(), 0, null(), 0) };
    fmi3SetInt16                  [x - x x -] { (api.fmi3.fmi3SetInt16)(c, null(), 0, null(), 0) };
    fmi3SetUInt16                 [x - x x -] { (api.fmi3.fmi3SetUInt16)(c, null(), 0, null(), 0) };
    fmi3SetInt32                  [x - x x -] { (api.fmi3.fmi3SetInt32)(c, null(), 0, null(), 0) };
    fmi3SetUInt32                 [x - x x -] { (api.fmi3.fmi3SetUInt32)(c, null(), 0, null(), 0) };
    fmi3SetInt64                  [x - x x -] { (api.fmi3.fmi3SetInt64)(c, null(), 0, null(), 0) };
    fmi3SetUInt64                 [x x - - -] { api.set_integer(c, &api.reference("patch_strips"), 1, &7) };
    fmi3SetBoolean                [x - x x -] { (api.fmi3.fmi3SetBoolean)(c, null(), 0, null(), 0) };
    fmi3SetString                 [x - x x -] { (api.fmi3.fmi3SetString)(c, null(), 0, null(), 0) };
    fmi3SetBinary                 [x - x x -] { (api.fmi3.fmi3SetBinary)(c, null(), 0, null(), null(), 0) };
    fmi3GetFMUState               [x x x x x] { api.get_state(c, &mut null_mut()) };
    fmi3SetFMUState               [x x x x x] { api.set_state(c, state) };
    fmi3FreeFMUState              [x x x x x] { api.free_state(c, &mut state.clone()) };
    fmi3SerializedFMUStateSize    [x x x x x] { api.serialized_size(c, state, &mut 0) };
    fmi3SerializeFMUState         [x x x x x] {
        let mut bytes = bytes(api, c, state);
        api.serialize(c, state, bytes.as_mut_ptr(), bytes.len())
    };
    fmi3DeserializeFMUState       [x x x x x] {
        let bytes = bytes(api, c, state);
        api.deserialize(c, bytes.as_ptr(), bytes.len(), &mut null_mut())
    };
    fmi3GetDirectionalDerivative  [- - x x x] {
        let (unknown, known) = (api.reference("traction_force"), api.reference("creepage"));
        api.directional_derivative(c, &unknown, 1, &known, 1, &1.0, &mut 0.0)
    };
    fmi3GetAdjointDerivative      [- - x x x] {
        let (unknown, known) = (api.reference("traction_force"), api.reference("creepage"));
        (api.fmi3.fmi3GetAdjointDerivative)(c, &unknown, 1, &known, 1, &1.0, 1, &mut 0.0, 1)
    };
    fmi3GetOutputDerivatives      [- - - x x] {
        api.get_output_derivatives(c, &api.reference("traction_force"), 1, &1, &mut 0.0)
    };
    fmi3DoStep                    [- - - x -] {
        (api.fmi3.fmi3DoStep)(c, 0.0, 1e-3, 1, &mut 0, &mut 0, &mut 0, &mut 0.0)
    };
    fmi3EnterEventMode            [- - - - -] { (api.fmi3.fmi3EnterEventMode)(c) };
    fmi3EnterStepMode             [- - - - -] { (api.fmi3.fmi3EnterStepMode)(c) };
    fmi3EvaluateDiscreteStates    [- - - - -] { (api.fmi3.fmi3EvaluateDiscreteStates)(c) };
    fmi3UpdateDiscreteStates      [- - - - -] {
        (api.fmi3.fmi3UpdateDiscreteStates)(c, &mut 0, &mut 0, &mut 0, &mut 0, &mut 0, &mut 0.0)
    };
    fmi3GetClock                  [- - - - -] { (api.fmi3.fmi3GetClock)(c, null(), 0, null_mut()) };
    fmi3SetClock                  [- - - - -] { (api.fmi3.fmi3SetClock)(c, null(), 0, null()) };
    fmi3GetIntervalDecimal        [- - - - -] { (api.fmi3.fmi3GetIntervalDecimal)(c, null(), 0, null_mut(), null_mut()) };
    fmi3GetIntervalFraction       [- - - - -] {
        (api.fmi3.fmi3GetIntervalFraction)(c, null(), 0, null_mut(), null_mut(), null_mut())
    };
    fmi3GetShiftDecimal           [- - - - -] { (api.fmi3.fmi3GetShiftDecimal)(c, null(), 0, null_mut()) };
    fmi3GetShiftFraction          [- - - - -] { (api.fmi3.fmi3GetShiftFraction)(c, null(), 0, null_mut(), null_mut()) };
    fmi3SetIntervalDecimal        [- - - - -] { (api.fmi3.fmi3SetIntervalDecimal)(c, null(), 0, null()) };
    fmi3SetIntervalFraction       [- - - - -] { (api.fmi3.fmi3SetIntervalFraction)(c, null(), 0, null(), null()) };
    fmi3SetShiftDecimal           [- - - - -] { (api.fmi3.fmi3SetShiftDecimal)(c, null(), 0, null()) };
    fmi3SetShiftFraction          [- - - - -] { (api.fmi3.fmi3SetShiftFraction)(c, null(), 0, null(), null()) };
    fmi3GetNumberOfVariableDependencies [- - - - -] {
        (api.fmi3.fmi3GetNumberOfVariableDependencies)(c, api.reference("traction_force"), &mut 0)
    };
    fmi3GetVariableDependencies   [- - - - -] {
        let (output, none) = (api.reference("traction_force"), null_mut());
        (api.fmi3.fmi3GetVariableDependencies)(c, output, none, null_mut(), none, null_mut(), 0)
    };
    fmi3EnterContinuousTimeMode   [- - - - -] { (api.fmi3.fmi3EnterContinuousTimeMode)(c) };
    fmi3CompletedIntegratorStep   [- - - - -] { (api.fmi3.fmi3CompletedIntegratorStep)(c, 1, &mut 0, &mut 0) };
    fmi3SetTime                   [- - - - -] { (api.fmi3.fmi3SetTime)(c, 0.0) };
    fmi3SetContinuousStates       [- - - - -] { (api.fmi3.fmi3SetContinuousStates)(c, null(), 0) };
    fmi3GetContinuousStateDerivatives [- - - - -] { (api.fmi3.fmi3GetContinuousStateDerivatives)(c, null_mut(), 0) };
    fmi3GetEventIndicators        [- - - - -] { (api.fmi3.fmi3GetEventIndicators)(c, null_mut(), 0) };
    fmi3GetContinuousStates       [- - - - -] { (api.fmi3.fmi3GetContinuousStates)(c, null_mut(), 0) };
    fmi3GetNominalsOfContinuousStates [- - - - -] { (api.fmi3.fmi3GetNominalsOfContinuousStates)(c, null_mut(), 0) };
    fmi3GetNumberOfEventIndicators [- - - - -] { (api.fmi3.fmi3GetNumberOfEventIndicators)(c, &mut 0) };
    fmi3GetNumberOfContinuousStates [- - - - -] { (api.fmi3.fmi3GetNumberOfContinuousStates)(c, &mut 0) };
    fmi3ActivateModelPartition    [- - - - -] { (api.fmi3.fmi3ActivateModelPartition)(c, 0, 0.0) };
};
