//! The C types of fmi3PlatformTypes.h and fmi3FunctionTypes.h.

use crate::fmi::failures::{self, Blame};
use std::ffi::{c_char, c_int, c_void};

/// `fmi3Instance`, points to an [`super::instance::Instance`].
pub type Instance = *mut c_void;
/// `fmi3InstanceEnvironment`, opaque: the importer's.
pub type InstanceEnvironment = *mut c_void;
/// `fmi3FMUState`, opaque: names a saved state of one instance.
pub type FmuState = *mut c_void;
/// `fmi3ValueReference`.
pub type ValueReference = u32;
/// `fmi3Float64`.
pub type Float64 = f64;
/// `fmi3Int32`.
pub type Int32 = i32;
/// `fmi3Int64`: what an enumeration is read and set as.
pub type Int64 = i64;
/// `fmi3UInt64`.
pub type UInt64 = u64;
/// `fmi3Boolean`, `bool` in C. A byte, so that no value from C is undefined behaviour: 0 is false, everything else true.
pub type Boolean = u8;
/// `fmi3Clock`, as [`Boolean`].
pub type Clock = u8;
/// `fmi3String`: UTF-8, ended by a zero byte.
pub type FmiString = *const c_char;
/// `fmi3Byte`.
pub type Byte = u8;
/// `fmi3Binary`.
pub type Binary = *const Byte;
/// `fmi3DependencyKind`, an enumeration in C.
pub type DependencyKind = c_int;
/// `fmi3IntervalQualifier`, an enumeration in C.
pub type IntervalQualifier = c_int;

/// `fmi3True`.
pub const TRUE: Boolean = 1;
/// `fmi3False`.
pub const FALSE: Boolean = 0;

/// `fmi3Status`: a transparent integer, so that no value from C is undefined behaviour.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(transparent)]
pub struct Status(pub c_int);

impl Status {
    /// `fmi3OK`.
    pub const OK: Status = Status(failures::OK);
    /// `fmi3Warning`.
    pub const WARNING: Status = Status(failures::WARNING);
    /// `fmi3Discard`.
    pub const DISCARD: Status = Status(failures::DISCARD);
    /// `fmi3Error`.
    pub const ERROR: Status = Status(failures::ERROR);
    /// `fmi3Fatal`; never returned.
    pub const FATAL: Status = Status(4);

    /// The status of a call.
    pub fn of(blame: Option<Blame>) -> Status {
        Status(Blame::status(blame))
    }
}

/// `fmi3LogMessageCallback`.
pub type LogMessageCallback =
    unsafe extern "C" fn(environment: InstanceEnvironment, status: Status, category: FmiString, message: FmiString);

/// `fmi3IntermediateUpdateCallback`, which is never called.
pub type IntermediateUpdateCallback = unsafe extern "C" fn(
    environment: InstanceEnvironment,
    intermediate_update_time: Float64,
    intermediate_variable_set_requested: Boolean,
    intermediate_variable_get_allowed: Boolean,
    intermediate_step_finished: Boolean,
    can_return_early: Boolean,
    early_return_requested: *mut Boolean,
    early_return_time: *mut Float64,
);

/// `fmi3ClockUpdateCallback`, which is never called.
pub type ClockUpdateCallback = unsafe extern "C" fn(environment: InstanceEnvironment);

/// `fmi3LockPreemptionCallback` and `fmi3UnlockPreemptionCallback`, which are never called.
pub type PreemptionCallback = unsafe extern "C" fn();
