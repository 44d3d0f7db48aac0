//! What every version of FMI shares: an instance of the component, without a C type or a function of a standard.
//!
//! Read in this order: [`variables`] (the one table, arrays as arrays) and [`units`]; [`modes`] (the states of an
//! instance); [`component`] (what an instance holds, its way through the states), `values`, `stepping`, `derivatives`
//! and `saving` (the rest of what it does); [`snapshot`], [`serialized`] and [`saved_states`] (saved states);
//! [`failures`] (what can go wrong, and who is to blame) and [`logging`] (messages); `pointers` and `fence` (the boundary to
//! C: arguments, panics), `arithmetic` (the floating-point environment).

pub(crate) mod arithmetic;
pub mod component;
mod derivatives;
pub mod failures;
pub(crate) mod fence;
pub mod logging;
pub mod modes;
pub(crate) mod pointers;
pub mod saved_states;
mod saving;
pub mod serialized;
pub mod snapshot;
mod stepping;
pub mod units;
mod values;
pub mod variables;
