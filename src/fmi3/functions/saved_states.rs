//! Saved states.

use crate::fmi::exported;
use crate::fmi3::instance::Instance;
use crate::fmi3::states::Function;
use crate::fmi3::types::{self, Byte, FmuState, Status};

/// Saves the state, in the one handed in where there is one.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetFMUState(instance: types::Instance, state: *mut FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::get_state::<Instance>(instance, Function::GetFmuState, state) }
}

/// Restores a saved state.
///
/// # Safety
/// `instance` must be null or a live instance; `state` is never followed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetFMUState(instance: types::Instance, state: FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::set_state::<Instance>(instance, Function::SetFmuState, state) }
}

/// Frees a saved state and sets the pointer to null.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3FreeFMUState(instance: types::Instance, state: *mut FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::free_state::<Instance>(instance, Function::FreeFmuState, state) }
}

/// The number of bytes of a serialised state.
///
/// # Safety
/// A live instance and a place for the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializedFMUStateSize(
    instance: types::Instance,
    state: FmuState,
    size: *mut usize,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::serialized_size::<Instance>(instance, Function::SerializedFmuStateSize, state, size) }
}

/// Writes a saved state as bytes.
///
/// # Safety
/// A live instance and room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SerializeFMUState(
    instance: types::Instance,
    state: FmuState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::serialize::<Instance>(instance, Function::SerializeFmuState, state, bytes, size) }
}

/// Makes a saved state of bytes.
///
/// # Safety
/// A live instance, `size` bytes and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3DeserializeFMUState(
    instance: types::Instance,
    bytes: *const Byte,
    size: usize,
    state: *mut FmuState,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::deserialize::<Instance>(instance, Function::DeserializeFmuState, bytes, size, state) }
}
