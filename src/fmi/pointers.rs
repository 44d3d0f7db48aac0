//! Arguments from C: null and size checks, once for all functions.

#![allow(unsafe_code)]

use super::failures::Failure;
use std::ffi::{CStr, c_char};
use std::mem::MaybeUninit;

fn check<T>(pointer: *const T, count: usize, argument: &'static str) -> Result<(), Failure> {
    if pointer.is_null() {
        return Err(Failure::NullPointer { argument });
    }
    if !pointer.is_aligned() {
        return Err(Failure::Misaligned { argument });
    }
    // A slice may not exceed isize::MAX bytes.
    if count > isize::MAX as usize / size_of::<T>().max(1) {
        return Err(Failure::Count { argument, count });
    }
    Ok(())
}

/// A vector argument that is read. A null pointer is allowed where there are no elements.
///
/// # Safety
/// A pointer that is not null must point to `count` elements that nobody writes during the call.
pub unsafe fn input<'a, T>(pointer: *const T, count: usize, argument: &'static str) -> Result<&'a [T], Failure> {
    if count == 0 {
        return Ok(&[]);
    }
    check(pointer, count, argument)?;
    // SAFETY: not null and not too long (checked); the rest is the caller's promise.
    Ok(unsafe { std::slice::from_raw_parts(pointer, count) })
}

/// A vector argument that is written. A null pointer is allowed where there are no elements.
///
/// # Safety
/// A pointer that is not null must point to room for `count` elements that nobody else uses during the call.
pub unsafe fn output<'a, T>(
    pointer: *mut T,
    count: usize,
    argument: &'static str,
) -> Result<&'a mut [MaybeUninit<T>], Failure> {
    if count == 0 {
        return Ok(&mut []);
    }
    check(pointer, count, argument)?;
    // SAFETY: not null and not too long (checked); MaybeUninit makes no claim on the content; the rest is the caller's
    // promise.
    Ok(unsafe { std::slice::from_raw_parts_mut(pointer.cast(), count) })
}

/// A place for one value.
///
/// # Safety
/// As [`output`].
pub unsafe fn place<'a, T>(pointer: *mut T, argument: &'static str) -> Result<&'a mut MaybeUninit<T>, Failure> {
    check(pointer, 1, argument)?;
    // SAFETY: not null (checked); the rest is the caller's promise.
    Ok(unsafe { &mut *pointer.cast() })
}

/// A variable of the importer that is read and written.
///
/// # Safety
/// A pointer that is not null must point to a value that nobody else uses during the call.
pub unsafe fn variable<'a, T>(pointer: *mut T, argument: &'static str) -> Result<&'a mut T, Failure> {
    check(pointer, 1, argument)?;
    // SAFETY: not null (checked); the rest is the caller's promise.
    Ok(unsafe { &mut *pointer })
}

/// The bytes of a string before the zero that ends it, at most one more than `longest`; `None` for a null pointer.
///
/// # Safety
/// A pointer that is not null must point to a string ended by zero, or to more than `longest` bytes, that nobody writes while
/// the bytes are used.
pub unsafe fn bytes<'a>(pointer: *const c_char, longest: usize) -> Option<&'a [u8]> {
    if pointer.is_null() {
        return None;
    }
    let pointer = pointer.cast::<u8>();
    // SAFETY: the bytes up to the first zero, or to the one behind `longest` (the caller's promise); not null (checked).
    unsafe {
        let is_end = |place: &usize| *pointer.add(*place) == 0;
        let length = (0..=longest).find(is_end).unwrap_or(longest + 1);
        Some(std::slice::from_raw_parts(pointer, length))
    }
}

/// A string; `None` for a null pointer.
///
/// # Safety
/// A pointer that is not null must point to a string ended by zero that nobody writes during the call.
pub unsafe fn string<'a>(pointer: *const c_char) -> Option<&'a CStr> {
    if pointer.is_null() {
        return None;
    }
    // SAFETY: not null (checked); the rest is the caller's promise.
    Some(unsafe { CStr::from_ptr(pointer) })
}
