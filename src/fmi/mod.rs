//! Parts that every version of FMI shares: an instance of the component, without a C type or a function of a standard.
//!
//! Read in this order: [`variables`] (the one table, arrays as arrays) and [`units`]; [`modes`] (the states of an
//! instance); [`component`] (what an instance holds, its way through the states), [`resources`] (files beside it), `values`, `stepping`, `derivatives`
//! and `saving` (the rest of what it does); [`snapshot`], [`serialized`] and [`saved_states`] (saved states);
//! `states` (how a standard's table of calls is written), `call` (the way into every call);
//! [`failures`] (what can go wrong, and who is to blame) and [`logging`] (messages); `pointers` and `fence` (the boundary to
//! C: arguments, panics), `arithmetic` (the floating-point environment).

pub(crate) mod arithmetic;
pub(crate) mod call;
pub mod component;
pub mod derivatives;
pub(crate) mod exported;
pub mod failures;
pub(crate) mod fence;
pub mod logging;
pub mod modes;
pub(crate) mod pointers;
pub mod resources;
pub mod saved_states;
mod saving;
#[cfg(feature = "cli")]
pub(crate) mod schema;
pub mod serialized;
pub mod snapshot;
pub(crate) mod states;
mod stepping;
pub(crate) mod token;
pub mod units;
mod values;
pub mod variables;
