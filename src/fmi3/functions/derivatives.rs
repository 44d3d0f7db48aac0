//! Derivatives of outputs.

use super::call::call;
use crate::fmi::pointers::{input, output};
use crate::fmi3::instance::Instance;
use crate::fmi3::states::Function;
use crate::fmi3::types::{self, Float64, Int32, Status, ValueReference};

/// The derivative of outputs in a direction of the inputs, at the communication point.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetDirectionalDerivative(
    instance: types::Instance,
    unknowns: *const ValueReference,
    n_unknowns: usize,
    knowns: *const ValueReference,
    n_knowns: usize,
    seed: *const Float64,
    n_seed: usize,
    sensitivity: *mut Float64,
    n_sensitivity: usize,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_directional_derivative(
            input(unknowns, n_unknowns, "unknowns")?,
            input(knowns, n_knowns, "knowns")?,
            input(seed, n_seed, "seed")?,
            output(sensitivity, n_sensitivity, "sensitivity")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::GetDirectionalDerivative, body) }
}

/// The derivative of a weighted sum of outputs with respect to inputs, at the communication point.
///
/// # Safety
/// As [`fmi3GetDirectionalDerivative`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetAdjointDerivative(
    instance: types::Instance,
    unknowns: *const ValueReference,
    n_unknowns: usize,
    knowns: *const ValueReference,
    n_knowns: usize,
    seed: *const Float64,
    n_seed: usize,
    sensitivity: *mut Float64,
    n_sensitivity: usize,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_adjoint_derivative(
            input(unknowns, n_unknowns, "unknowns")?,
            input(knowns, n_knowns, "knowns")?,
            input(seed, n_seed, "seed")?,
            output(sensitivity, n_sensitivity, "sensitivity")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::GetAdjointDerivative, body) }
}

/// Reads rates of change of outputs at the communication point.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetOutputDerivatives(
    instance: types::Instance,
    references: *const ValueReference,
    n_references: usize,
    orders: *const Int32,
    values: *mut Float64,
    n_values: usize,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_output_derivatives(
            input(references, n_references, "valueReferences")?,
            input(orders, n_references, "orders")?,
            output(values, n_values, "values")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::GetOutputDerivatives, body) }
}
