//! Derivatives of inputs and outputs.

use super::call::call;
use crate::fmi::pointers::{input, output};
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Component, Integer, Real, Status, ValueReference};

/// The derivative of outputs in a direction of the inputs, at the communication point.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetDirectionalDerivative(
    component: Component,
    unknowns: *const ValueReference,
    n_unknowns: usize,
    knowns: *const ValueReference,
    n_knowns: usize,
    direction: *const Real,
    derivatives: *mut Real,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_directional_derivative(
            input(unknowns, n_unknowns, "vUnknown_ref")?,
            input(knowns, n_knowns, "vKnown_ref")?,
            input(direction, n_knowns, "dvKnown")?,
            output(derivatives, n_unknowns, "dvUnknown")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetDirectionalDerivative, body) }
}

/// Sets rates of change of inputs for the next step.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetRealInputDerivatives(
    component: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *const Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.set_input_derivatives(
            input(references, n, "vr")?,
            input(orders, n, "order")?,
            input(values, n, "value")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SetRealInputDerivatives, body) }
}

/// Reads rates of change of outputs at the communication point.
///
/// # Safety
/// A live instance and `n` elements behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetRealOutputDerivatives(
    component: Component,
    references: *const ValueReference,
    n: usize,
    orders: *const Integer,
    values: *mut Real,
) -> Status {
    // SAFETY: `n` elements (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_output_derivatives(
            input(references, n, "vr")?,
            input(orders, n, "order")?,
            output(values, n, "value")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetRealOutputDerivatives, body) }
}
