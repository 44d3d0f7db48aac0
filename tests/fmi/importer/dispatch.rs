//! The calls that both standards have, with the arguments of FMI 2.0: FMI 3.0 is given as many values as value references, and
//! integers by the type that it has for them. Null pointers and absurd counts are handed on as they are.

use super::api::{Api, Byte, Component, Handle};
use super::standard::Standard::{self, Fmi2, Fmi3};
use std::ffi::{c_char, c_int};
use wheelrail::fmi3::references::Type;

/// Where a step of FMI 3.0 says how it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Answer {
    pub event_handling_needed: Byte,
    pub terminate_simulation: Byte,
    pub early_return: Byte,
    pub last_successful_time: f64,
}

impl Answer {
    /// What no step answers.
    pub const NONE: Answer = Answer {
        event_handling_needed: 77,
        terminate_simulation: 77,
        early_return: 77,
        last_successful_time: f64::NAN,
    };
}

macro_rules! alike {
    ($($name:ident($($argument:ident: $type:ty),*) = $fmi2:ident, $fmi3:ident;)*) => {
        impl Api {
            $(
                /// # Safety
                /// As the standards say.
                pub unsafe fn $name(&self, $($argument: $type),*) -> c_int {
                    // SAFETY: the caller's promise.
                    unsafe {
                        match self.standard {
                            Fmi2 => (self.fmi2.$fmi2)($($argument),*),
                            Fmi3 => (self.fmi3.$fmi3)($($argument),*),
                        }
                    }
                }
            )*
        }
    };
}

alike! {
    exit_initialization(c: Component) = fmi2ExitInitializationMode, fmi3ExitInitializationMode;
    terminate(c: Component) = fmi2Terminate, fmi3Terminate;
    reset(c: Component) = fmi2Reset, fmi3Reset;
    get_state(c: Component, state: *mut Handle) = fmi2GetFMUstate, fmi3GetFMUState;
    set_state(c: Component, state: Handle) = fmi2SetFMUstate, fmi3SetFMUState;
    free_state(c: Component, state: *mut Handle) = fmi2FreeFMUstate, fmi3FreeFMUState;
    serialized_size(c: Component, state: Handle, size: *mut usize) = fmi2SerializedFMUstateSize, fmi3SerializedFMUStateSize;
    serialize(c: Component, state: Handle, bytes: *mut u8, size: usize) = fmi2SerializeFMUstate, fmi3SerializeFMUState;
    deserialize(c: Component, bytes: *const u8, size: usize, state: *mut Handle) = fmi2DeSerializeFMUstate, fmi3DeserializeFMUState;
}

/// The same with as many values as value references.
macro_rules! values {
    ($($name:ident($values:ty) = $fmi2:ident, $fmi3:ident;)*) => {
        impl Api {
            $(
                /// # Safety
                /// As the standards say.
                pub unsafe fn $name(&self, c: Component, references: *const u32, n: usize, values: $values) -> c_int {
                    // SAFETY: the caller's promise.
                    unsafe {
                        match self.standard {
                            Fmi2 => (self.fmi2.$fmi2)(c, references, n, values),
                            // Booleans of FMI 3.0 are narrower, and fit where those of FMI 2.0 do.
                            Fmi3 => (self.fmi3.$fmi3)(c, references, n, values.cast(), n),
                        }
                    }
                }
            )*
        }
    };
}

values! {
    get_real(*mut f64) = fmi2GetReal, fmi3GetFloat64;
    set_real(*const f64) = fmi2SetReal, fmi3SetFloat64;
    get_boolean(*mut c_int) = fmi2GetBoolean, fmi3GetBoolean;
    set_boolean(*const c_int) = fmi2SetBoolean, fmi3SetBoolean;
    get_string(*mut *const c_char) = fmi2GetString, fmi3GetString;
    set_string(*const *const c_char) = fmi2SetString, fmi3SetString;
}

/// More elements than any test has: a count that is meant to be refused.
const MANY: usize = 1 << 20;

/// An integer of FMI 2.0 as one of FMI 3.0 and back.
trait Wide: Copy + Default {
    fn of(value: c_int) -> Self;
    fn narrow(self) -> c_int;
}

macro_rules! wide {
    ($($type:ty: $of:expr, $narrow:expr;)*) => {$(
        impl Wide for $type {
            fn of(value: c_int) -> $type {
                let of: fn(c_int) -> $type = $of;
                of(value)
            }
            fn narrow(self) -> c_int {
                let narrow: fn($type) -> c_int = $narrow;
                narrow(self)
            }
        }
    )*};
}

wide! {
    i64: i64::from, |value| value as c_int;
    u64: |value| i64::from(value) as u64, |value| value as c_int;
    // Off is 1 and on is 2; anything else is a byte that no bool of C has.
    u8: |value| match value { 1 => 0, 2 => 1, other => other as u8 }, |value| 1 + c_int::from(value);
}

/// Sets integers as values of another type.
unsafe fn set_as<T: Wide>(
    set: unsafe extern "C" fn(Component, *const u32, usize, *const T, usize) -> c_int,
    c: Component,
    references: *const u32,
    n: usize,
    values: *const c_int,
) -> c_int {
    // SAFETY: the caller's promise; a count that is too large is refused before anything is read.
    unsafe {
        if values.is_null() || n > MANY {
            return set(c, references, n, values.cast(), n);
        }
        let values: Vec<T> = (0..n).map(|k| T::of(*values.add(k))).collect();
        set(c, references, n, values.as_ptr(), n)
    }
}

/// Gets integers that are values of another type.
unsafe fn get_as<T: Wide>(
    get: unsafe extern "C" fn(Component, *const u32, usize, *mut T, usize) -> c_int,
    c: Component,
    references: *const u32,
    n: usize,
    values: *mut c_int,
) -> c_int {
    // SAFETY: as above.
    unsafe {
        if values.is_null() || n > MANY {
            return get(c, references, n, values.cast(), n);
        }
        let mut read = vec![T::default(); n];
        let status = get(c, references, n, read.as_mut_ptr(), n);
        if status == 0 {
            for (k, value) in read.into_iter().enumerate() {
                *values.add(k) = value.narrow();
            }
        }
        status
    }
}

impl Api {
    /// The value reference of a variable that has one.
    #[track_caller]
    pub fn reference(&self, name: &str) -> u32 {
        match self.standard.find(name) {
            (entry, None) => entry.reference,
            _ => panic!("{name} has no value reference of its own"),
        }
    }

    /// The value references under which all elements of an array are read.
    pub fn array(&self, name: &str, elements: usize) -> Vec<u32> {
        match self.standard {
            Fmi2 => {
                let names = (1..=elements).map(|element| format!("{name}[{element}]"));
                names.map(|name| self.reference(&name)).collect()
            }
            Fmi3 => vec![self.reference(name)],
        }
    }

    /// # Safety
    /// As the standards say.
    pub unsafe fn free_instance(&self, c: Component) {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2FreeInstance)(c),
                Fmi3 => (self.fmi3.fmi3FreeInstance)(c),
            }
        }
    }

    /// # Safety
    /// As the standards say.
    pub unsafe fn set_debug_logging(&self, c: Component, on: c_int, n: usize, names: *const *const c_char) -> c_int {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2SetDebugLogging)(c, on, n, names),
                Fmi3 => (self.fmi3.fmi3SetDebugLogging)(c, on as Byte, n, names),
            }
        }
    }

    /// As with fmi2SetupExperiment before where the standard has that; otherwise from 0 s without end.
    ///
    /// # Safety
    /// As the standards say.
    pub unsafe fn enter_initialization(&self, c: Component) -> c_int {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2EnterInitializationMode)(c),
                Fmi3 => (self.fmi3.fmi3EnterInitializationMode)(c, 0, 0.0, 0.0, 0, 0.0),
            }
        }
    }

    /// The type of the first of some integers, by which FMI 3.0 calls.
    unsafe fn first_type(&self, references: *const u32, n: usize) -> Type {
        if references.is_null() || n == 0 || !references.is_aligned() {
            return Type::Int32;
        }
        // SAFETY: there is at least one element (the caller's promise).
        let first = unsafe { *references };
        self.standard.type_of(first).unwrap_or(Type::Int32)
    }

    /// # Safety
    /// As the standards say.
    pub unsafe fn get_integer(&self, c: Component, references: *const u32, n: usize, values: *mut c_int) -> c_int {
        let api = &self.fmi3;
        // SAFETY: the caller's promise.
        unsafe {
            match (self.standard, self.first_type(references, n)) {
                (Fmi2, _) => (self.fmi2.fmi2GetInteger)(c, references, n, values),
                (Fmi3, Type::Int64) => get_as(api.fmi3GetInt64, c, references, n, values),
                (Fmi3, Type::UInt64) => get_as(api.fmi3GetUInt64, c, references, n, values),
                (Fmi3, Type::Boolean) => get_as(api.fmi3GetBoolean, c, references, n, values),
                (Fmi3, _) => (api.fmi3GetInt32)(c, references, n, values, n),
            }
        }
    }

    /// # Safety
    /// As the standards say.
    pub unsafe fn set_integer(&self, c: Component, references: *const u32, n: usize, values: *const c_int) -> c_int {
        let api = &self.fmi3;
        // SAFETY: the caller's promise.
        unsafe {
            match (self.standard, self.first_type(references, n)) {
                (Fmi2, _) => (self.fmi2.fmi2SetInteger)(c, references, n, values),
                (Fmi3, Type::Int64) => set_as(api.fmi3SetInt64, c, references, n, values),
                (Fmi3, Type::UInt64) => set_as(api.fmi3SetUInt64, c, references, n, values),
                (Fmi3, Type::Boolean) => set_as(api.fmi3SetBoolean, c, references, n, values),
                (Fmi3, _) => (api.fmi3SetInt32)(c, references, n, values, n),
            }
        }
    }

    /// # Safety
    /// As the standards say.
    #[expect(clippy::too_many_arguments)]
    pub unsafe fn directional_derivative(
        &self,
        c: Component,
        unknowns: *const u32,
        n_unknowns: usize,
        knowns: *const u32,
        n_knowns: usize,
        seed: *const f64,
        derivatives: *mut f64,
    ) -> c_int {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2GetDirectionalDerivative)(
                    c,
                    unknowns,
                    n_unknowns,
                    knowns,
                    n_knowns,
                    seed,
                    derivatives,
                ),
                Fmi3 => (self.fmi3.fmi3GetDirectionalDerivative)(
                    c,
                    unknowns,
                    n_unknowns,
                    knowns,
                    n_knowns,
                    seed,
                    n_knowns,
                    derivatives,
                    n_unknowns,
                ),
            }
        }
    }

    /// # Safety
    /// As the standards say.
    pub unsafe fn get_output_derivatives(
        &self,
        c: Component,
        references: *const u32,
        n: usize,
        orders: *const c_int,
        values: *mut f64,
    ) -> c_int {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2GetRealOutputDerivatives)(c, references, n, orders, values),
                Fmi3 => (self.fmi3.fmi3GetOutputDerivatives)(c, references, n, orders, values, n),
            }
        }
    }

    /// A step; FMI 2.0 answers nothing beside the status.
    ///
    /// # Safety
    /// As the standards say.
    pub unsafe fn do_step(&self, c: Component, time: f64, size: f64, answer: &mut Answer) -> c_int {
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => (self.fmi2.fmi2DoStep)(c, time, size, 1),
                Fmi3 => (self.fmi3.fmi3DoStep)(
                    c,
                    time,
                    size,
                    1,
                    &mut answer.event_handling_needed,
                    &mut answer.terminate_simulation,
                    &mut answer.early_return,
                    &mut answer.last_successful_time,
                ),
            }
        }
    }

    /// Whether inputs can be given rates of change.
    pub fn takes_rates(&self) -> bool {
        self.standard == Standard::Fmi2
    }
}
