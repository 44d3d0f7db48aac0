//! The step and its status.

use super::call::call;
use crate::fmi::pointers::place;
use crate::fmi2::failures::Failure;
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Boolean, Component, FALSE, FmiString, Integer, Real, Status, StatusKind, TERMINATED};

/// Advances the instance by one communication step.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DoStep(
    component: Component,
    current_communication_point: Real,
    communication_step_size: Real,
    _no_set_fmu_state_prior_to_current_point: Boolean,
) -> Status {
    let body = |instance: &mut Instance| {
        Ok(instance
            .component
            .do_step(current_communication_point, communication_step_size)?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::DoStep, body) }
}

/// Never allowed: steps are not asynchronous.
///
/// # Safety
/// `component` must be null or a live instance.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2CancelStep(component: Component) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::CancelStep, |_| Ok(())) }
}

/// A status query: writes what `answer` finds.
///
/// # Safety
/// A live instance and a place for one value.
unsafe fn status_query<T>(
    component: Component,
    function: Function,
    value: *mut T,
    answer: impl FnOnce(&Instance) -> Result<T, Failure>,
) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: a place for one value (the caller's promise).
        let place = unsafe { place(value, "value") }?;
        place.write(answer(instance)?);
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, function, body) }
}

/// No status of this type: steps are not asynchronous.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStatus(component: Component, kind: StatusKind, value: *mut Status) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetStatus, value, answer) }
}

/// The time up to which the last step came.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealStatus(component: Component, kind: StatusKind, value: *mut Real) -> Status {
    let answer = |instance: &Instance| instance.last_successful_time(kind);
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetRealStatus, value, answer) }
}

/// No status of this type.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetIntegerStatus(component: Component, kind: StatusKind, value: *mut Integer) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetIntegerStatus, value, answer) }
}

/// Whether the component wants to end the simulation: never.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetBooleanStatus(component: Component, kind: StatusKind, value: *mut Boolean) -> Status {
    let answer = |_: &Instance| {
        if kind == TERMINATED {
            Ok(FALSE)
        } else {
            Err(Failure::StatusKind { kind })
        }
    };
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetBooleanStatus, value, answer) }
}

/// No status of this type: steps are not asynchronous.
///
/// # Safety
/// A live instance and a place for one value.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetStringStatus(component: Component, kind: StatusKind, value: *mut FmiString) -> Status {
    let answer = |_: &Instance| Err(Failure::StatusKind { kind });
    // SAFETY: the caller's promise.
    unsafe { status_query(component, Function::GetStringStatus, value, answer) }
}
