//! The patch engine: half-spaces, the contact resolved along the rail and across it.
//!
//! [`engine`] is what the outside sees. [`rail`] is what is computed once, with [`expansion`] by heat, [`fields`] what a step changes, [`problem`] one
//! step as a problem. [`split`] solves it: [`tractions`], pressure and then friction with the [`response`] of the slip to it, for what wear and
//! heat hand to the mechanics ([`coupling`]), then wear and heat for those tractions, until they rest. [`scratch`] are its buffers.
//! [`sensitivity`] are its derivatives, with the [`tangent`] of the tractions. [`readings`] and [`profiles`] are what is read off the fields.

pub mod coupling;
pub mod engine;
pub mod expansion;
pub mod extent;
pub mod fields;
mod memory;
pub mod operators;
pub mod problem;
pub mod profiles;
pub mod readings;
pub mod response;
pub mod scratch;
pub mod sensitivity;
pub mod split;
pub mod tangent;
pub mod tractions;
