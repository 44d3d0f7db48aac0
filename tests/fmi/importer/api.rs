//! The exported functions of both standards, by their names.

use libloading::Library;
use std::ffi::{c_char, c_int, c_void};
use std::path::PathBuf;
use wheelrail::fmi2::types::CallbackFunctions;
use wheelrail::fmi3::types::{ClockUpdateCallback, IntermediateUpdateCallback, LogMessageCallback, PreemptionCallback};

use super::standard::Standard;

pub type Component = *mut c_void;
pub type Handle = *mut c_void;

/// `fmi3Boolean`, of which any byte can be given.
pub type Byte = u8;
type References = *const u32;
type Text = *const c_char;

macro_rules! functions {
    ($words:literal $api:ident $names:ident $($symbol:ident($($argument:ty),*) $(-> $result:ty)?;)*) => {
        #[doc = $words]
        #[allow(non_snake_case)]
        pub struct $api {
            $(pub $symbol: unsafe extern "C" fn($($argument),*) $(-> $result)?,)*
        }

        /// Their names.
        pub const $names: &[&str] = &[$(stringify!($symbol)),*];

        impl $api {
            fn of(library: &Library) -> $api {
                // SAFETY: each symbol has the signature of the standard.
                unsafe {
                    $api {
                        $($symbol: *library.get(concat!(stringify!($symbol), "\0").as_bytes()).expect(stringify!($symbol)),)*
                    }
                }
            }
        }
    };
}

functions! {
    "The functions of fmi2Functions.h for co-simulation." FunctionsOfFmi2 FMI2_FUNCTIONS
    fmi2GetTypesPlatform() -> Text;
    fmi2GetVersion() -> Text;
    fmi2SetDebugLogging(Component, c_int, usize, *const Text) -> c_int;
    fmi2Instantiate(Text, c_int, Text, Text, *const CallbackFunctions, c_int, c_int) -> Component;
    fmi2FreeInstance(Component);
    fmi2SetupExperiment(Component, c_int, f64, f64, c_int, f64) -> c_int;
    fmi2EnterInitializationMode(Component) -> c_int;
    fmi2ExitInitializationMode(Component) -> c_int;
    fmi2Terminate(Component) -> c_int;
    fmi2Reset(Component) -> c_int;
    fmi2GetReal(Component, References, usize, *mut f64) -> c_int;
    fmi2GetInteger(Component, References, usize, *mut c_int) -> c_int;
    fmi2GetBoolean(Component, References, usize, *mut c_int) -> c_int;
    fmi2GetString(Component, References, usize, *mut Text) -> c_int;
    fmi2SetReal(Component, References, usize, *const f64) -> c_int;
    fmi2SetInteger(Component, References, usize, *const c_int) -> c_int;
    fmi2SetBoolean(Component, References, usize, *const c_int) -> c_int;
    fmi2SetString(Component, References, usize, *const Text) -> c_int;
    fmi2GetFMUstate(Component, *mut Handle) -> c_int;
    fmi2SetFMUstate(Component, Handle) -> c_int;
    fmi2FreeFMUstate(Component, *mut Handle) -> c_int;
    fmi2SerializedFMUstateSize(Component, Handle, *mut usize) -> c_int;
    fmi2SerializeFMUstate(Component, Handle, *mut u8, usize) -> c_int;
    fmi2DeSerializeFMUstate(Component, *const u8, usize, *mut Handle) -> c_int;
    fmi2GetDirectionalDerivative(Component, References, usize, References, usize, *const f64, *mut f64) -> c_int;
    fmi2SetRealInputDerivatives(Component, References, usize, *const c_int, *const f64) -> c_int;
    fmi2GetRealOutputDerivatives(Component, References, usize, *const c_int, *mut f64) -> c_int;
    fmi2DoStep(Component, f64, f64, c_int) -> c_int;
    fmi2CancelStep(Component) -> c_int;
    fmi2GetStatus(Component, c_int, *mut c_int) -> c_int;
    fmi2GetRealStatus(Component, c_int, *mut f64) -> c_int;
    fmi2GetIntegerStatus(Component, c_int, *mut c_int) -> c_int;
    fmi2GetBooleanStatus(Component, c_int, *mut c_int) -> c_int;
    fmi2GetStringStatus(Component, c_int, *mut Text) -> c_int;
}

functions! {
    "The functions of fmi3Functions.h." FunctionsOfFmi3 FMI3_FUNCTIONS
    fmi3GetVersion() -> Text;
    fmi3SetDebugLogging(Component, Byte, usize, *const Text) -> c_int;
    fmi3InstantiateModelExchange(Text, Text, Text, Byte, Byte, *mut c_void, Option<LogMessageCallback>) -> Component;
    fmi3InstantiateCoSimulation(Text, Text, Text, Byte, Byte, Byte, Byte, References, usize, *mut c_void,
        Option<LogMessageCallback>, Option<IntermediateUpdateCallback>) -> Component;
    fmi3InstantiateScheduledExecution(Text, Text, Text, Byte, Byte, *mut c_void, Option<LogMessageCallback>,
        Option<ClockUpdateCallback>, Option<PreemptionCallback>, Option<PreemptionCallback>) -> Component;
    fmi3FreeInstance(Component);
    fmi3EnterInitializationMode(Component, Byte, f64, f64, Byte, f64) -> c_int;
    fmi3ExitInitializationMode(Component) -> c_int;
    fmi3EnterEventMode(Component) -> c_int;
    fmi3Terminate(Component) -> c_int;
    fmi3Reset(Component) -> c_int;
    fmi3GetFloat32(Component, References, usize, *mut f32, usize) -> c_int;
    fmi3GetFloat64(Component, References, usize, *mut f64, usize) -> c_int;
    fmi3GetInt8(Component, References, usize, *mut i8, usize) -> c_int;
    fmi3GetUInt8(Component, References, usize, *mut u8, usize) -> c_int;
    fmi3GetInt16(Component, References, usize, *mut i16, usize) -> c_int;
    fmi3GetUInt16(Component, References, usize, *mut u16, usize) -> c_int;
    fmi3GetInt32(Component, References, usize, *mut i32, usize) -> c_int;
    fmi3GetUInt32(Component, References, usize, *mut u32, usize) -> c_int;
    fmi3GetInt64(Component, References, usize, *mut i64, usize) -> c_int;
    fmi3GetUInt64(Component, References, usize, *mut u64, usize) -> c_int;
    fmi3GetBoolean(Component, References, usize, *mut Byte, usize) -> c_int;
    fmi3GetString(Component, References, usize, *mut Text, usize) -> c_int;
    fmi3GetBinary(Component, References, usize, *mut usize, *mut *const u8, usize) -> c_int;
    fmi3GetClock(Component, References, usize, *mut Byte) -> c_int;
    fmi3SetFloat32(Component, References, usize, *const f32, usize) -> c_int;
    fmi3SetFloat64(Component, References, usize, *const f64, usize) -> c_int;
    fmi3SetInt8(Component, References, usize, *const i8, usize) -> c_int;
    fmi3SetUInt8(Component, References, usize, *const u8, usize) -> c_int;
    fmi3SetInt16(Component, References, usize, *const i16, usize) -> c_int;
    fmi3SetUInt16(Component, References, usize, *const u16, usize) -> c_int;
    fmi3SetInt32(Component, References, usize, *const i32, usize) -> c_int;
    fmi3SetUInt32(Component, References, usize, *const u32, usize) -> c_int;
    fmi3SetInt64(Component, References, usize, *const i64, usize) -> c_int;
    fmi3SetUInt64(Component, References, usize, *const u64, usize) -> c_int;
    fmi3SetBoolean(Component, References, usize, *const Byte, usize) -> c_int;
    fmi3SetString(Component, References, usize, *const Text, usize) -> c_int;
    fmi3SetBinary(Component, References, usize, *const usize, *const *const u8, usize) -> c_int;
    fmi3SetClock(Component, References, usize, *const Byte) -> c_int;
    fmi3GetNumberOfVariableDependencies(Component, u32, *mut usize) -> c_int;
    fmi3GetVariableDependencies(Component, u32, *mut usize, *mut u32, *mut usize, *mut c_int, usize) -> c_int;
    fmi3GetFMUState(Component, *mut Handle) -> c_int;
    fmi3SetFMUState(Component, Handle) -> c_int;
    fmi3FreeFMUState(Component, *mut Handle) -> c_int;
    fmi3SerializedFMUStateSize(Component, Handle, *mut usize) -> c_int;
    fmi3SerializeFMUState(Component, Handle, *mut u8, usize) -> c_int;
    fmi3DeserializeFMUState(Component, *const u8, usize, *mut Handle) -> c_int;
    fmi3GetDirectionalDerivative(Component, References, usize, References, usize, *const f64, usize, *mut f64, usize) -> c_int;
    fmi3GetAdjointDerivative(Component, References, usize, References, usize, *const f64, usize, *mut f64, usize) -> c_int;
    fmi3EnterConfigurationMode(Component) -> c_int;
    fmi3ExitConfigurationMode(Component) -> c_int;
    fmi3GetIntervalDecimal(Component, References, usize, *mut f64, *mut c_int) -> c_int;
    fmi3GetIntervalFraction(Component, References, usize, *mut u64, *mut u64, *mut c_int) -> c_int;
    fmi3GetShiftDecimal(Component, References, usize, *mut f64) -> c_int;
    fmi3GetShiftFraction(Component, References, usize, *mut u64, *mut u64) -> c_int;
    fmi3SetIntervalDecimal(Component, References, usize, *const f64) -> c_int;
    fmi3SetIntervalFraction(Component, References, usize, *const u64, *const u64) -> c_int;
    fmi3SetShiftDecimal(Component, References, usize, *const f64) -> c_int;
    fmi3SetShiftFraction(Component, References, usize, *const u64, *const u64) -> c_int;
    fmi3EvaluateDiscreteStates(Component) -> c_int;
    fmi3UpdateDiscreteStates(Component, *mut Byte, *mut Byte, *mut Byte, *mut Byte, *mut Byte, *mut f64) -> c_int;
    fmi3EnterContinuousTimeMode(Component) -> c_int;
    fmi3CompletedIntegratorStep(Component, Byte, *mut Byte, *mut Byte) -> c_int;
    fmi3SetTime(Component, f64) -> c_int;
    fmi3SetContinuousStates(Component, *const f64, usize) -> c_int;
    fmi3GetContinuousStateDerivatives(Component, *mut f64, usize) -> c_int;
    fmi3GetEventIndicators(Component, *mut f64, usize) -> c_int;
    fmi3GetContinuousStates(Component, *mut f64, usize) -> c_int;
    fmi3GetNominalsOfContinuousStates(Component, *mut f64, usize) -> c_int;
    fmi3GetNumberOfEventIndicators(Component, *mut usize) -> c_int;
    fmi3GetNumberOfContinuousStates(Component, *mut usize) -> c_int;
    fmi3EnterStepMode(Component) -> c_int;
    fmi3GetOutputDerivatives(Component, References, usize, *const i32, *mut f64, usize) -> c_int;
    fmi3DoStep(Component, f64, f64, Byte, *mut Byte, *mut Byte, *mut Byte, *mut f64) -> c_int;
    fmi3ActivateModelPartition(Component, u32, f64) -> c_int;
}

/// The library, and the standard by which it is called: what both have alike has a method here, in dispatch.rs.
pub struct Api {
    pub standard: Standard,
    pub fmi2: FunctionsOfFmi2,
    pub fmi3: FunctionsOfFmi3,
    _library: Library,
}

impl Api {
    /// Loads the library that `cargo test` has built beside the test.
    pub fn load(standard: Standard) -> Api {
        // SAFETY: loading runs no code of ours.
        let library = unsafe { Library::new(library_path()) }.expect("the cdylib is beside the test");
        Api {
            standard,
            fmi2: FunctionsOfFmi2::of(&library),
            fmi3: FunctionsOfFmi3::of(&library),
            _library: library,
        }
    }
}

/// `cargo test` leaves the cdylib in `target/<profile>/deps`, beside the test.
pub fn library_path() -> PathBuf {
    let name = format!(
        "{}wheelrail{}",
        std::env::consts::DLL_PREFIX,
        std::env::consts::DLL_SUFFIX
    );
    let test = std::env::current_exe().expect("the test has a path");
    test.with_file_name(name)
}

/// Whether the library is in the memory of this process. A thread-local value with a destructor would keep it there after it
/// was closed, until the thread ends: the system counts the destructors that are still to be called (glibc 2.18 and above;
/// an older one would crash then).
#[cfg(target_os = "linux")]
pub fn is_mapped() -> bool {
    let maps = std::fs::read_to_string("/proc/self/maps").expect("maps");
    maps.lines()
        .any(|line| line.ends_with(&*library_path().to_string_lossy()))
}
