//! Saved states.

use super::call::call;
use crate::fmi::failures::Failure;
use crate::fmi::pointers::{input, output, place, variable};
use crate::fmi2::instance::Instance;
use crate::fmi2::states::Function;
use crate::fmi2::types::{Byte, Component, FmuState, Status};

/// Saves the state, in the one handed in where there is one.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2GetFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut Instance| unsafe { Ok(instance.component.get_state(variable(state, "FMUstate")?)?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::GetFmuState, body) }
}

/// Restores a saved state.
///
/// # Safety
/// `component` must be null or a live instance; `state` is never followed.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SetFMUstate(component: Component, state: FmuState) -> Status {
    // SAFETY: a live instance (the caller's promise).
    unsafe {
        call(component, Function::SetFmuState, |instance| {
            Ok(instance.component.set_state(state)?)
        })
    }
}

/// Frees a saved state and sets the pointer to null.
///
/// # Safety
/// A live instance and a pointer to a variable.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2FreeFMUstate(component: Component, state: *mut FmuState) -> Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut Instance| unsafe { Ok(instance.component.free_state(variable(state, "FMUstate")?)?) };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::FreeFmuState, body) }
}

/// The number of bytes of a serialised state.
///
/// # Safety
/// A live instance and a place for the size.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi2SerializedFMUstateSize(component: Component, state: FmuState, size: *mut usize) -> Status {
    let body = |instance: &mut Instance| {
        // SAFETY: a place for one value (the caller's promise).
        let size = unsafe { place(size, "size") }?;
        size.write(instance.component.serialized(state)?.len());
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SerializedFmuStateSize, body) }
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
    let body = |instance: &mut Instance| {
        let serialized = instance.component.serialized(state)?;
        // SAFETY: room for `size` bytes (the caller's promise).
        let room = unsafe { output(bytes.cast::<u8>(), size, "serializedState") }?;
        if room.len() != serialized.len() {
            return Err(Failure::BufferSize {
                given: size,
                needed: serialized.len(),
            }
            .into());
        }
        for (place, byte) in room.iter_mut().zip(serialized) {
            place.write(byte);
        }
        Ok(())
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::SerializeFmuState, body) }
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
    let body = |instance: &mut Instance| {
        // SAFETY: `size` bytes (the caller's promise).
        let bytes = unsafe { input(bytes.cast::<u8>(), size, "serializedState") }?;
        // SAFETY: a variable of the importer (the caller's promise).
        Ok(instance
            .component
            .deserialize(bytes, unsafe { variable(state, "FMUstate") }?)?)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(component, Function::DeserializeFmuState, body) }
}
