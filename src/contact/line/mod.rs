//! The line engine: plane strain, the contact resolved along the rail and uniform across it.
//!
//! [`engine`] is what the outside sees. [`rail`] is what is computed once, with [`relaxation`], the way on which rolling
//! forgets a change. [`fields`] is what a step changes, [`problem`] one step as a problem: its data and the parts of its
//! equations. [`split`] solves it as section 4 of the paper does, over the values of [`coupling`], until
//! [`crate::contact::rest`] says that they rest; [`sensitivity`] is its derivative. [`readings`] and [`profiles`] are what is
//! read off the fields.

pub mod coupling;
pub mod engine;
pub mod fields;
pub mod operators;
pub mod problem;
pub mod profiles;
pub mod readings;
pub mod relaxation;
pub mod sensitivity;
pub mod split;
