//! The C types of fmi2TypesPlatform.h and fmi2FunctionTypes.h.

use crate::fmi::failures::{self, Blame};
use std::ffi::{c_char, c_int, c_uint, c_void};

/// `fmi2Component`, points to an [`super::instance::Instance`].
pub type Component = *mut c_void;
/// `fmi2ComponentEnvironment`, opaque: the importer's.
pub type ComponentEnvironment = *mut c_void;
/// `fmi2FMUstate`, opaque: names a saved state of one instance.
pub type FmuState = *mut c_void;
/// `fmi2ValueReference`.
pub type ValueReference = c_uint;
/// `fmi2Real`.
pub type Real = f64;
/// `fmi2Integer`.
pub type Integer = c_int;
/// `fmi2Boolean`: 0 is false, everything else true.
pub type Boolean = c_int;
/// `fmi2String`: UTF-8, ended by a zero byte.
pub type FmiString = *const c_char;
/// `fmi2Byte`.
pub type Byte = c_char;
/// `fmi2Type`, an enumeration in C: any integer can arrive.
pub type FmuType = c_int;
/// `fmi2StatusKind`, an enumeration in C: any integer can arrive.
pub type StatusKind = c_int;

/// `fmi2True`.
pub const TRUE: Boolean = 1;
/// `fmi2False`.
pub const FALSE: Boolean = 0;
/// `fmi2CoSimulation` of `fmi2Type`.
pub const CO_SIMULATION: FmuType = 1;
/// `fmi2LastSuccessfulTime` of `fmi2StatusKind`.
pub const LAST_SUCCESSFUL_TIME: StatusKind = 2;
/// `fmi2Terminated` of `fmi2StatusKind`.
pub const TERMINATED: StatusKind = 3;

/// `fmi2Status`: a transparent integer, so that no value from C is undefined behaviour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub struct Status(pub c_int);

impl Status {
    /// `fmi2OK`.
    pub const OK: Status = Status(failures::OK);
    /// `fmi2Warning`.
    pub const WARNING: Status = Status(failures::WARNING);
    /// `fmi2Discard`.
    pub const DISCARD: Status = Status(failures::DISCARD);
    /// `fmi2Error`.
    pub const ERROR: Status = Status(failures::ERROR);
    /// `fmi2Fatal`; never returned.
    pub const FATAL: Status = Status(4);
    /// `fmi2Pending`; never returned, steps are not asynchronous.
    pub const PENDING: Status = Status(5);

    /// The status of a call.
    pub fn of(blame: Option<Blame>) -> Status {
        Status(Blame::status(blame))
    }
}

/// `fmi2CallbackLogger`: variadic, `message` is a format.
pub type LoggerCallback = unsafe extern "C" fn(
    environment: ComponentEnvironment,
    instance_name: FmiString,
    status: Status,
    category: FmiString,
    message: FmiString,
    ...
);

/// `fmi2CallbackFunctions`; each may be null.
#[derive(Clone, Copy)]
#[repr(C)]
pub struct CallbackFunctions {
    /// Receives messages.
    pub logger: Option<LoggerCallback>,
    /// Not used: version 2.0.2 of the standard discourages it.
    pub allocate_memory: Option<unsafe extern "C" fn(usize, usize) -> *mut c_void>,
    /// Not used.
    pub free_memory: Option<unsafe extern "C" fn(*mut c_void)>,
    /// Not used: steps are not asynchronous.
    pub step_finished: Option<unsafe extern "C" fn(ComponentEnvironment, Status)>,
    /// Handed back to the callbacks.
    pub component_environment: ComponentEnvironment,
}
