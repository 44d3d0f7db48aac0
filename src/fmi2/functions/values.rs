//! Variables.

use super::call::call;
use crate::fmi::failures::Failure;
use crate::fmi::pointers::{input, output};
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

/// Boolean and String: there are no variables of these types, so that every value reference is unknown.
///
/// # Safety
/// As [`fmi2GetReal`].
unsafe fn no_variables<T>(
    component: Component,
    function: Function,
    references: *const ValueReference,
    n: usize,
    values: *const T,
    expected: &'static str,
) -> Status {
    let body = |_: &mut Instance| {
        // SAFETY: `n` elements (the caller's promise).
        let references = unsafe { input(references, n, "vr") }?;
        // SAFETY: as before; the values are not read.
        unsafe { input(values.cast::<MaybeUninit<T>>(), n, "value") }?;
        match references.first() {
            Some(reference) => Err(Failure::UnknownReference {
                reference: *reference,
                expected,
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
    unsafe {
        no_variables(
            component,
            Function::GetBoolean,
            references,
            n,
            values,
            "a Boolean variable: there are none",
        )
    }
}

/// Reads String variables: there are none.
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
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::GetString,
            references,
            n,
            values,
            "a String variable: there are none",
        )
    }
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
    unsafe {
        no_variables(
            component,
            Function::SetBoolean,
            references,
            n,
            values,
            "a Boolean variable: there are none",
        )
    }
}

/// Sets String variables: there are none.
///
/// # Safety
/// As [`fmi2GetReal`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetString(
    component: Component,
    references: *const ValueReference,
    n: usize,
    values: *const FmiString,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe {
        no_variables(
            component,
            Function::SetString,
            references,
            n,
            values,
            "a String variable: there are none",
        )
    }
}
