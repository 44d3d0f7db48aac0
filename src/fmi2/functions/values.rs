//! Variables.

use super::call::call;
use crate::error::LONGEST_TEXT;
use crate::fmi::failures::Failure;
use crate::fmi::pointers::{bytes, input, output};
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Boolean, Component, FmiString, Integer, Real, Status, ValueReference};
use std::mem::MaybeUninit;

/// Reads Real variables.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetReal(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_real(input(references, n, "vr")?, output(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetReal, body) }
}

/// Reads Integer variables.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetInteger(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Integer,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_integer(input(references, n, "vr")?, output(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetInteger, body) }
}

/// Sets Real variables, all or none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetReal(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body =
        |instance: &mut Instance| unsafe { instance.set_real(input(references, n, "vr")?, input(values, n, "value")?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetReal, body) }
}

/// Sets Integer variables, all or none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetInteger(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Integer,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.set_integer(input(references, n, "vr")?, input(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetInteger, body) }
}

/// Reads String variables. What is read stays where it is at least until the next call.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetString(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut FmiString,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_string(input(references, n, "vr")?, output(values, n, "value")?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetString, body) }
}

/// Sets String variables, all or none.
///
/// # Safety
/// As [`fmi2GetReal`]; each value is null or a string ended by zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const FmiString,
) -> Status {
    // SAFETY: `n` elements, each null or a string (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        let (references, values) = (input(references, n, "vr")?, input(values, n, "value")?);
        instance.set_string(references, values.iter().map(|value| bytes(*value, LONGEST_TEXT)))
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetString, body) }
}

/// Boolean: there are no variables of this type, so that every value reference is unknown.
///
/// # Safety
/// As [`fmi2GetReal`].
unsafe fn no_variables(
    component: Component,
    function: Function,
    references: *const ValueReference,
    n: usize,
    values: *const Boolean,
) -> Status {
    let body = |_: &mut Instance| {
        // SAFETY: `n` elements (the caller's promise).
        let references = unsafe { input(references, n, "vr") }?;
        // SAFETY: as before; the values are not read.
        unsafe { input(values.cast::<MaybeUninit<Boolean>>(), n, "value") }?;
        match references.first() {
            Some(reference) => Err(Failure::UnknownReference {
                reference: *reference,
                expected: "a Boolean variable: there are none",
            }
            .into()),
            None => Ok(()),
        }
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, function, body) }
}

/// Reads Boolean variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBoolean(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *mut Boolean,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { no_variables(component, Function::GetBoolean, references, n, values) }
}

/// Sets Boolean variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetBoolean(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const Boolean,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { no_variables(component, Function::SetBoolean, references, n, values) }
}
