//! Calls with null pointers and absurd counts, for sequences.rs.

use super::calls::Odd;
use super::importer::{
    Answer, Api, Arguments, Component, FMI2_FUNCTIONS, FMI3_FUNCTIONS, Fmi2, Fmi3, Handle, Journal, RIGHT,
};
use std::ffi::c_int;
use std::ptr::{null, null_mut};

impl Odd {
    fn or_null<T>(&self, bit: u8, pointer: *const T) -> *const T {
        if self.nulls >> bit & 1 == 1 { null() } else { pointer }
    }

    fn or_null_mut<T>(&self, bit: u8, place: &mut T) -> *mut T {
        self.or_null(bit, place).cast_mut()
    }

    /// Large meshes are slow to build, and test nothing more here.
    fn integers(&self) -> [c_int; 2] {
        self.values.map(|value| (value as c_int).clamp(-1, 30))
    }
}

/// Makes the call; its status, where it has one.
pub fn odd(api: &Api, c: Component, state: &mut Handle, odd: &Odd) -> Option<c_int> {
    let name = match api.standard {
        Fmi2 => FMI2_FUNCTIONS[odd.function],
        Fmi3 => FMI3_FUNCTIONS[odd.function],
    };
    let c = odd.or_null(7, c).cast_mut();
    // SAFETY: the free function ignores null; the rest is null or valid.
    unsafe {
        match &name[4..] {
            "GetTypesPlatform" | "GetVersion" => return None,
            "Instantiate"
            | "InstantiateCoSimulation"
            | "InstantiateModelExchange"
            | "InstantiateScheduledExecution" => {
                let journal = Journal::default();
                let token = api.standard.token();
                let arguments = Arguments {
                    name: odd.or_null(0, c"odd".as_ptr()),
                    kind: c_int::from(!name.ends_with("ModelExchange")) + c_int::from(name.ends_with("Execution")),
                    token: Some(odd.or_null(1, token.as_ptr())),
                    location: odd.or_null(2, c"odd".as_ptr()),
                    journal: (odd.nulls >> 3 & 1 == 0).then_some(&journal),
                    event_mode: odd.nulls >> 4 & 1 == 1,
                    early_return: odd.nulls >> 5 & 1 == 1,
                    intermediate_variables: odd.count,
                    ..RIGHT
                };
                api.instantiates(&arguments);
                return None;
            }
            "FreeInstance" => {
                api.free_instance(null_mut());
                return None;
            }
            _ => {}
        }
    }
    Some(shared(api, c, state, odd, name).unwrap_or_else(|| match api.standard {
        Fmi2 => of_fmi2(api, c, odd, name),
        Fmi3 => of_fmi3(api, c, odd, name),
    }))
}

/// Functions that both standards have with the same arguments, or nearly so; `None` for any other.
fn shared(api: &Api, c: Component, state: &mut Handle, odd: &Odd, name: &str) -> Option<c_int> {
    let n = odd.count;
    let references = odd.or_null(0, odd.references.as_ptr());
    let values = odd.or_null(1, odd.values.as_ptr());
    let (mut real, mut integer, mut string) = ([0.0; 2], [0; 2], [c"%n".as_ptr(); 2]);
    let (orders, integers) = ([1, 2], odd.integers());
    let handle = odd.or_null(2, *state).cast_mut();
    // SAFETY: as for the functions of the standards, but for null pointers and for counts above usize::MAX - 1000, which the
    // library refuses; handles are never followed.
    let status = unsafe {
        match name[4..].to_lowercase().as_str() {
            "setdebuglogging" => api.set_debug_logging(c, 1, n, odd.or_null(0, string.as_ptr())),
            "exitinitializationmode" => api.exit_initialization(c),
            "terminate" => api.terminate(c),
            "reset" => api.reset(c),
            "getboolean" => api.get_boolean(c, references, n, odd.or_null_mut(1, &mut integer).cast()),
            "getstring" => api.get_string(c, references, n, odd.or_null_mut(1, &mut string).cast()),
            "setboolean" => api.set_boolean(c, references, n, odd.or_null(1, integers.as_ptr())),
            "setstring" => api.set_string(c, references, n, odd.or_null(1, string.as_ptr())),
            "getfmustate" => api.get_state(c, odd.or_null_mut(0, state)),
            "setfmustate" => api.set_state(c, handle),
            "freefmustate" => api.free_state(c, odd.or_null_mut(0, state)),
            "serializedfmustatesize" => api.serialized_size(c, handle, odd.or_null_mut(0, &mut 0)),
            // Two bytes are never the size of a state.
            "serializefmustate" => api.serialize(c, handle, odd.or_null_mut(0, &mut [0_u8; 2]).cast(), n),
            "deserializefmustate" => {
                let bytes = [1_u8; 2];
                api.deserialize(c, odd.or_null(0, bytes.as_ptr()), n, odd.or_null_mut(1, state))
            }
            "getdirectionalderivative" => api.directional_derivative(
                c,
                references,
                n,
                odd.or_null(2, odd.references.as_ptr()),
                n,
                values,
                odd.or_null_mut(3, &mut real).cast(),
            ),
            "getrealoutputderivatives" | "getoutputderivatives" => api.get_output_derivatives(
                c,
                references,
                n,
                odd.or_null(2, orders.as_ptr()),
                odd.or_null_mut(1, &mut real).cast(),
            ),
            "getreal" => api.get_real(c, references, n, odd.or_null_mut(1, &mut real).cast()),
            "setreal" => api.set_real(c, references, n, values),
            "getinteger" => api.get_integer(c, references, n, odd.or_null_mut(1, &mut integer).cast()),
            "setinteger" => api.set_integer(c, references, n, odd.or_null(1, integers.as_ptr())),
            _ => return None,
        }
    };
    Some(status)
}

fn of_fmi2(api: &Api, c: Component, odd: &Odd, name: &str) -> c_int {
    let (api, n, orders) = (&api.fmi2, odd.count, [1, 2]);
    let references = odd.or_null(0, odd.references.as_ptr());
    let values = odd.or_null(1, odd.values.as_ptr());
    // SAFETY: as above.
    unsafe {
        match name {
            "fmi2SetupExperiment" => (api.fmi2SetupExperiment)(c, 1, odd.values[1], odd.values[0], 1, odd.values[1]),
            "fmi2EnterInitializationMode" => (api.fmi2EnterInitializationMode)(c),
            "fmi2SetRealInputDerivatives" => {
                (api.fmi2SetRealInputDerivatives)(c, references, n, odd.or_null(2, orders.as_ptr()), values)
            }
            "fmi2DoStep" => (api.fmi2DoStep)(c, odd.values[0], odd.values[1], n as c_int),
            "fmi2CancelStep" => (api.fmi2CancelStep)(c),
            "fmi2GetStatus" => (api.fmi2GetStatus)(c, n as c_int, odd.or_null_mut(0, &mut 0)),
            "fmi2GetRealStatus" => (api.fmi2GetRealStatus)(c, n as c_int, odd.or_null_mut(0, &mut 0.0)),
            "fmi2GetIntegerStatus" => (api.fmi2GetIntegerStatus)(c, n as c_int, odd.or_null_mut(0, &mut 0)),
            "fmi2GetBooleanStatus" => (api.fmi2GetBooleanStatus)(c, n as c_int, odd.or_null_mut(0, &mut 0)),
            "fmi2GetStringStatus" => (api.fmi2GetStringStatus)(c, n as c_int, odd.or_null_mut(0, &mut null())),
            other => unreachable!("{other}"),
        }
    }
}

fn of_fmi3(api: &Api, c: Component, odd: &Odd, name: &str) -> c_int {
    let (api, n) = (&api.fmi3, odd.count);
    // Two counts that differ at times.
    let m = if odd.nulls >> 6 & 1 == 1 { 1 } else { n };
    let references = odd.or_null(0, odd.references.as_ptr());
    let (mut reals, mut sizes, mut places) = (odd.values, [0_usize; 2], [0_u64; 2]);
    let (mut flags, mut qualifiers, mut strings) = ([0_u8; 2], [0; 2], [null::<u8>(); 2]);
    let integers = odd.integers();
    macro_rules! values {
        ($own:ident $($read:ident $write:ident $type:ty;)*) => {
            match name {
                // SAFETY: as above.
                $(stringify!($read) => unsafe {
                    (api.$read)(c, references, n, odd.or_null_mut(1, &mut [0 as $type; 2]).cast(), m)
                },
                // SAFETY: as above.
                stringify!($write) => unsafe {
                    (api.$write)(c, references, n, odd.or_null(1, &integers.map(|value| value as $type)).cast(), m)
                },)*
                _ => $own(),
            }
        };
    }
    let (real, seeds) = (
        odd.or_null_mut(1, &mut reals).cast::<f64>(),
        odd.or_null(2, odd.values.as_ptr()),
    );
    let (size, place) = (
        odd.or_null_mut(1, &mut sizes).cast(),
        odd.or_null_mut(2, &mut places).cast::<u64>(),
    );
    let flag = odd.or_null_mut(1, &mut flags).cast::<u8>();
    let qualifier = odd.or_null_mut(3, &mut qualifiers).cast::<c_int>();
    let binary = odd.or_null_mut(2, &mut strings).cast::<*const u8>();
    let knowns = odd.or_null(3, odd.references.as_ptr());
    let own = || {
        let mut answer = Answer::NONE;
        let [first, second] = odd.values;
        let mut others = [0_u8; 4];
        let [a, b, d, e] = others.each_mut();
        // SAFETY: as above.
        unsafe {
            match name {
                "fmi3EnterInitializationMode" => (api.fmi3EnterInitializationMode)(c, 1, second, first, 1, second),
                "fmi3EnterConfigurationMode" => (api.fmi3EnterConfigurationMode)(c),
                "fmi3ExitConfigurationMode" => (api.fmi3ExitConfigurationMode)(c),
                "fmi3DoStep" => (api.fmi3DoStep)(
                    c,
                    first,
                    second,
                    n as u8,
                    odd.or_null_mut(0, &mut answer.event_handling_needed),
                    odd.or_null_mut(1, &mut answer.terminate_simulation),
                    odd.or_null_mut(2, &mut answer.early_return),
                    odd.or_null_mut(3, &mut answer.last_successful_time),
                ),
                "fmi3GetAdjointDerivative" => {
                    (api.fmi3GetAdjointDerivative)(c, references, n, knowns, n, seeds, m, real, n)
                }
                "fmi3GetBinary" => (api.fmi3GetBinary)(c, references, n, size, binary, m),
                "fmi3SetBinary" => (api.fmi3SetBinary)(c, references, n, size, binary, m),
                "fmi3GetClock" => (api.fmi3GetClock)(c, references, n, flag),
                "fmi3SetClock" => (api.fmi3SetClock)(c, references, n, flag),
                "fmi3GetNumberOfVariableDependencies" => {
                    (api.fmi3GetNumberOfVariableDependencies)(c, odd.references[0], size)
                }
                "fmi3GetVariableDependencies" => {
                    (api.fmi3GetVariableDependencies)(c, odd.references[0], size, null_mut(), size, qualifier, n)
                }
                "fmi3GetIntervalDecimal" => (api.fmi3GetIntervalDecimal)(c, references, n, real, qualifier),
                "fmi3GetIntervalFraction" => (api.fmi3GetIntervalFraction)(c, references, n, place, place, qualifier),
                "fmi3GetShiftDecimal" => (api.fmi3GetShiftDecimal)(c, references, n, real),
                "fmi3GetShiftFraction" => (api.fmi3GetShiftFraction)(c, references, n, place, place),
                "fmi3SetIntervalDecimal" => (api.fmi3SetIntervalDecimal)(c, references, n, real),
                "fmi3SetIntervalFraction" => (api.fmi3SetIntervalFraction)(c, references, n, place, place),
                "fmi3SetShiftDecimal" => (api.fmi3SetShiftDecimal)(c, references, n, real),
                "fmi3SetShiftFraction" => (api.fmi3SetShiftFraction)(c, references, n, place, place),
                "fmi3EvaluateDiscreteStates" => (api.fmi3EvaluateDiscreteStates)(c),
                "fmi3UpdateDiscreteStates" => (api.fmi3UpdateDiscreteStates)(c, flag, a, b, d, e, real),
                "fmi3EnterEventMode" => (api.fmi3EnterEventMode)(c),
                "fmi3EnterStepMode" => (api.fmi3EnterStepMode)(c),
                "fmi3EnterContinuousTimeMode" => (api.fmi3EnterContinuousTimeMode)(c),
                "fmi3CompletedIntegratorStep" => (api.fmi3CompletedIntegratorStep)(c, 1, flag, flag),
                "fmi3SetTime" => (api.fmi3SetTime)(c, first),
                "fmi3SetContinuousStates" => (api.fmi3SetContinuousStates)(c, real, n),
                "fmi3GetContinuousStateDerivatives" => (api.fmi3GetContinuousStateDerivatives)(c, real, n),
                "fmi3GetEventIndicators" => (api.fmi3GetEventIndicators)(c, real, n),
                "fmi3GetContinuousStates" => (api.fmi3GetContinuousStates)(c, real, n),
                "fmi3GetNominalsOfContinuousStates" => (api.fmi3GetNominalsOfContinuousStates)(c, real, n),
                "fmi3GetNumberOfEventIndicators" => (api.fmi3GetNumberOfEventIndicators)(c, size),
                "fmi3GetNumberOfContinuousStates" => (api.fmi3GetNumberOfContinuousStates)(c, size),
                "fmi3ActivateModelPartition" => (api.fmi3ActivateModelPartition)(c, odd.references[0], first),
                "fmi3GetFloat64" => (api.fmi3GetFloat64)(c, references, n, real, m),
                "fmi3SetFloat64" => (api.fmi3SetFloat64)(c, references, n, real, m),
                other => unreachable!("{other}"),
            }
        }
    };
    values! {
        own
        fmi3GetFloat32 fmi3SetFloat32 f32;
        fmi3GetInt8 fmi3SetInt8 i8;
        fmi3GetUInt8 fmi3SetUInt8 u8;
        fmi3GetInt16 fmi3SetInt16 i16;
        fmi3GetUInt16 fmi3SetUInt16 u16;
        fmi3GetInt32 fmi3SetInt32 i32;
        fmi3GetUInt32 fmi3SetUInt32 u32;
        fmi3GetInt64 fmi3SetInt64 i64;
        fmi3GetUInt64 fmi3SetUInt64 u64;
    }
}
