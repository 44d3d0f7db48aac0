//! The exported functions of fmi3Functions.h: pointers become slices, the instance does the work.

#![allow(unsafe_code)]

mod absent;
mod call;
mod derivatives;
mod life;
mod saved_states;
mod stepping;
mod values;

pub use absent::*;
pub use derivatives::*;
pub use life::*;
pub use saved_states::*;
pub use stepping::*;
pub use values::*;
