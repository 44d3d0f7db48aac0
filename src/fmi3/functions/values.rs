//! Variables.

use super::call::call;
use crate::error::LONGEST_TEXT;
use crate::fmi::failures::Failure;
use crate::fmi::pointers::{bytes, input, output};
use crate::fmi3::instance::Instance;
use crate::fmi3::states::Function;
use crate::fmi3::types::{self, Binary, Boolean, Float64, FmiString, Int32, Int64, Status, UInt64, ValueReference};
use std::mem::MaybeUninit;

/// A pair of functions that read and set the variables of a type.
macro_rules! variables {
    ($($words:literal, $type:ty, $read:ident $reading:ident by $get:ident, $write:ident $setting:ident by $set:ident;)*) => {$(
        #[doc = concat!("Reads ", $words, ", all or none.")]
        ///
        /// # Safety
        /// A live instance and as many elements as given behind each pointer.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $read(
            instance: types::Instance,
            references: *const ValueReference,
            n_references: usize,
            values: *mut $type,
            n_values: usize,
        ) -> Status {
            // SAFETY: as many elements as given (the caller's promise).
            let body = |instance: &mut Instance| unsafe {
                instance.$get(input(references, n_references, "valueReferences")?, output(values, n_values, "values")?)
            };
            // SAFETY: a live instance (the caller's promise).
            unsafe { call(instance, Function::$reading, body) }
        }

        #[doc = concat!("Sets ", $words, ", all or none.")]
        ///
        /// # Safety
        /// As for reading them.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $write(
            instance: types::Instance,
            references: *const ValueReference,
            n_references: usize,
            values: *const $type,
            n_values: usize,
        ) -> Status {
            // SAFETY: as many elements as given (the caller's promise).
            let body = |instance: &mut Instance| unsafe {
                instance.$set(input(references, n_references, "valueReferences")?, input(values, n_values, "values")?)
            };
            // SAFETY: a live instance (the caller's promise).
            unsafe { call(instance, Function::$setting, body) }
        }
    )*};
}

variables! {
    "real numbers and arrays of them", Float64,
        fmi3GetFloat64 GetFloat64 by get_float, fmi3SetFloat64 SetFloat64 by set_float;
    "counts", Int32, fmi3GetInt32 GetInt32 by get_integer, fmi3SetInt32 SetInt32 by set_integer;
    "choices, by number", Int64, fmi3GetInt64 GetInt64 by get_integer, fmi3SetInt64 SetInt64 by set_integer;
    "lengths of arrays", UInt64, fmi3GetUInt64 GetUInt64 by get_integer, fmi3SetUInt64 SetUInt64 by set_integer;
    "choices between off and on", Boolean,
        fmi3GetBoolean GetBoolean by get_integer, fmi3SetBoolean SetBoolean by set_integer;
}

/// Reads texts, all or none. What is read stays where it is at least until the next call.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetString(
    instance: types::Instance,
    references: *const ValueReference,
    n_references: usize,
    values: *mut FmiString,
    n_values: usize,
) -> Status {
    // SAFETY: as many elements as given (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        instance.get_string(
            input(references, n_references, "valueReferences")?,
            output(values, n_values, "values")?,
        )
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::GetString, body) }
}

/// Sets texts, all or none.
///
/// # Safety
/// As for reading them; each value is null or a string ended by zero.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetString(
    instance: types::Instance,
    references: *const ValueReference,
    n_references: usize,
    values: *const FmiString,
    n_values: usize,
) -> Status {
    // SAFETY: as many elements as given, each null or a string (the caller's promise).
    let body = |instance: &mut Instance| unsafe {
        let references = input(references, n_references, "valueReferences")?;
        let values = input(values, n_values, "values")?;
        instance.set_string(references, values.iter().map(|value| bytes(*value, LONGEST_TEXT)))
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, Function::SetString, body) }
}

/// No variable has the type, so that every value reference is unknown.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
unsafe fn none<T>(
    instance: types::Instance,
    function: Function,
    references: (*const ValueReference, usize),
    values: (*const T, usize),
    expected: &'static str,
) -> Status {
    let body = |_: &mut Instance| {
        // SAFETY: as many elements as given (the caller's promise); the values are not read.
        let (references, values) = unsafe {
            (
                input(references.0, references.1, "valueReferences")?,
                input(values.0.cast::<MaybeUninit<T>>(), values.1, "values")?,
            )
        };
        if let Some(reference) = references.first() {
            let reference = *reference;
            return Err(Failure::UnknownReference { reference, expected }.into());
        }
        super::super::values::check_number(values.len(), 0)
    };
    // SAFETY: a live instance (the caller's promise).
    unsafe { call(instance, function, body) }
}

/// A pair of functions of a type that no variable has.
macro_rules! no_variables {
    ($($words:literal, $type:ty, $read:ident $reading:ident, $write:ident $setting:ident;)*) => {$(
        #[doc = concat!("Reads ", $words, " variables: there are none.")]
        ///
        /// # Safety
        /// A live instance and as many elements as given behind each pointer.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $read(
            instance: types::Instance,
            references: *const ValueReference,
            n_references: usize,
            values: *mut $type,
            n_values: usize,
        ) -> Status {
            let expected = concat!("a variable of type ", $words, ": there are none");
            // SAFETY: the caller's promise.
            unsafe { none(instance, Function::$reading, (references, n_references), (values, n_values), expected) }
        }

        #[doc = concat!("Sets ", $words, " variables: there are none.")]
        ///
        /// # Safety
        /// As for reading them.
        #[unsafe(no_mangle)]
        pub unsafe extern "C" fn $write(
            instance: types::Instance,
            references: *const ValueReference,
            n_references: usize,
            values: *const $type,
            n_values: usize,
        ) -> Status {
            let expected = concat!("a variable of type ", $words, ": there are none");
            // SAFETY: the caller's promise.
            unsafe { none(instance, Function::$setting, (references, n_references), (values, n_values), expected) }
        }
    )*};
}

no_variables! {
    "Float32", f32, fmi3GetFloat32 GetFloat32, fmi3SetFloat32 SetFloat32;
    "Int8", i8, fmi3GetInt8 GetInt8, fmi3SetInt8 SetInt8;
    "UInt8", u8, fmi3GetUInt8 GetUInt8, fmi3SetUInt8 SetUInt8;
    "Int16", i16, fmi3GetInt16 GetInt16, fmi3SetInt16 SetInt16;
    "UInt16", u16, fmi3GetUInt16 GetUInt16, fmi3SetUInt16 SetUInt16;
    "UInt32", u32, fmi3GetUInt32 GetUInt32, fmi3SetUInt32 SetUInt32;
}

/// Reads Binary variables: there are none.
///
/// # Safety
/// A live instance and as many elements as given behind each pointer.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3GetBinary(
    instance: types::Instance,
    references: *const ValueReference,
    n_references: usize,
    _value_sizes: *mut usize,
    values: *mut Binary,
    n_values: usize,
) -> Status {
    let expected = "a variable of type Binary: there are none";
    // SAFETY: the caller's promise.
    unsafe {
        none(
            instance,
            Function::GetBinary,
            (references, n_references),
            (values, n_values),
            expected,
        )
    }
}

/// Sets Binary variables: there are none.
///
/// # Safety
/// As [`fmi3GetBinary`].
#[unsafe(no_mangle)]
pub unsafe extern "C" fn fmi3SetBinary(
    instance: types::Instance,
    references: *const ValueReference,
    n_references: usize,
    _value_sizes: *const usize,
    values: *const Binary,
    n_values: usize,
) -> Status {
    let expected = "a variable of type Binary: there are none";
    // SAFETY: the caller's promise.
    unsafe {
        none(
            instance,
            Function::SetBinary,
            (references, n_references),
            (values, n_values),
            expected,
        )
    }
}
