//! Saved states.

use crate::fmi::exported;
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Byte, Component, FmuState, Status};

/// Saves the state, in the one handed in where there is one.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::get_state::<Instance>(component, Function::GetFmuState, state) }
}

/// Restores a saved state.
///
/// # Safety
/// `component` must be null or a live instance; `state` is never followed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Component, state: FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::set_state::<Instance>(component, Function::SetFmuState, state) }
}

/// Frees a saved state and sets the pointer to null.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::free_state::<Instance>(component, Function::FreeFmuState, state) }
}

/// The number of bytes of a serialised state.
///
/// # Safety
/// A live instance and a place for the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(component: Component, state: FmuState, size: *mut usize) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::serialized_size::<Instance>(component, Function::SerializedFmuStateSize, state, size) }
}

/// Writes a saved state as bytes.
///
/// # Safety
/// A live instance and room for `size` bytes.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializeFMUstate(
    component: Component,
    state: FmuState,
    bytes: *mut Byte,
    size: usize,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::serialize::<Instance>(component, Function::SerializeFmuState, state, bytes.cast(), size) }
}

/// Makes a saved state of bytes.
///
/// # Safety
/// A live instance, `size` bytes and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2DeSerializeFMUstate(
    component: Component,
    bytes: *const Byte,
    size: usize,
    state: *mut FmuState,
) -> Status {
    // SAFETY: the caller's promise.
    unsafe { exported::deserialize::<Instance>(component, Function::DeserializeFmuState, bytes.cast(), size, state) }
}
