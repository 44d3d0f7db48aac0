//! Functions that every version of FMI exports with the same arguments, under its own names.

#![allow(unsafe_code)]

use super::call::{Instance, call};
use super::failures::Failure;
use super::logging::Category;
use super::pointers::{input, output, place, string, variable};
use super::saved_states::Handle;
use std::ffi::{c_char, c_void};

/// Switches log categories on or off.
///
/// # Safety
/// As the standards say: null or a live instance, valid strings.
pub unsafe fn set_debug_logging<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    on: bool,
    n_categories: usize,
    categories: *const *const c_char,
) -> I::Status {
    let body = |instance: &mut I| {
        // SAFETY: as many strings as the caller says.
        let names = unsafe { input(categories, n_categories, "categories") }?;
        let categories = names.iter().map(|name| {
            // SAFETY: a valid string (the caller's promise).
            let name = unsafe { string(*name) };
            Category::named(name.ok_or(Failure::NullPointer {
                argument: "categories[i]",
            })?)
        });
        let categories: Vec<_> = categories.collect::<Result<_, Failure>>()?;
        instance.component().journal.switch(on, &categories);
        Ok(())
    };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// Ends the initialisation: builds the model and solves for the first contact.
///
/// # Safety
/// `instance` must be null or a live instance.
pub unsafe fn exit_initialization<I: Instance>(instance: *mut c_void, function: I::Function) -> I::Status {
    // SAFETY: null or a live instance (the caller's promise).
    unsafe {
        call(instance, function, |instance: &mut I| {
            Ok(instance.component().exit_initialization()?)
        })
    }
}

/// Something that cannot fail.
///
/// # Safety
/// `instance` must be null or a live instance.
pub unsafe fn simply<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    action: fn(&mut super::component::Component),
) -> I::Status {
    let body = |instance: &mut I| {
        action(instance.component());
        Ok(())
    };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// Saves the state, in the one handed in where there is one.
///
/// # Safety
/// Null or a live instance, and a pointer to a variable.
pub unsafe fn get_state<I: Instance>(instance: *mut c_void, function: I::Function, state: *mut Handle) -> I::Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut I| unsafe { Ok(instance.component().get_state(variable(state, "FMUstate")?)?) };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// Restores a saved state.
///
/// # Safety
/// `instance` must be null or a live instance; `state` is never followed.
pub unsafe fn set_state<I: Instance>(instance: *mut c_void, function: I::Function, state: Handle) -> I::Status {
    // SAFETY: null or a live instance (the caller's promise).
    unsafe {
        call(instance, function, |instance: &mut I| {
            Ok(instance.component().set_state(state)?)
        })
    }
}

/// Frees a saved state and sets the pointer to null.
///
/// # Safety
/// Null or a live instance, and a pointer to a variable.
pub unsafe fn free_state<I: Instance>(instance: *mut c_void, function: I::Function, state: *mut Handle) -> I::Status {
    // SAFETY: a variable of the importer (the caller's promise).
    let body = |instance: &mut I| unsafe { Ok(instance.component().free_state(variable(state, "FMUstate")?)?) };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// The number of bytes of a serialised state.
///
/// # Safety
/// Null or a live instance, and a place for the size.
pub unsafe fn serialized_size<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    state: Handle,
    size: *mut usize,
) -> I::Status {
    let body = |instance: &mut I| {
        // SAFETY: a place for one value (the caller's promise).
        let size = unsafe { place(size, "size") }?;
        size.write(instance.component().serialized(state)?.len());
        Ok(())
    };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// Writes a saved state as bytes.
///
/// # Safety
/// Null or a live instance, and room for `size` bytes.
pub unsafe fn serialize<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    state: Handle,
    bytes: *mut u8,
    size: usize,
) -> I::Status {
    let body = |instance: &mut I| {
        let serialized = instance.component().serialized(state)?;
        // SAFETY: room for `size` bytes (the caller's promise).
        let room = unsafe { output(bytes, size, "serializedState") }?;
        if room.len() != serialized.len() {
            let (given, needed) = (size, serialized.len());
            return Err(Failure::BufferSize { given, needed }.into());
        }
        for (place, byte) in room.iter_mut().zip(serialized) {
            place.write(byte);
        }
        Ok(())
    };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// Makes a saved state of bytes.
///
/// # Safety
/// Null or a live instance, `size` bytes and a pointer to a variable.
pub unsafe fn deserialize<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    bytes: *const u8,
    size: usize,
    state: *mut Handle,
) -> I::Status {
    let body = |instance: &mut I| {
        // SAFETY: `size` bytes and a variable of the importer (the caller's promise).
        let (bytes, handle) = unsafe { (input(bytes, size, "serializedState")?, variable(state, "FMUstate")?) };
        Ok(instance.component().deserialize(bytes, handle)?)
    };
    // SAFETY: null or a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}
