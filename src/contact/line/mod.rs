//! The line contact: plane strain, the contact resolved along the rail and uniform across it.
//!
//! [`operators`] are what is computed once, with [`relaxation`], the relaxation length of the displacement. [`fields`] are
//! what a step changes, [`solvers`] its solvers and buffers. The parts of a step are [`mechanics`] and [`heat_and_wear`],
//! [`tangent`] their derivatives, and [`engine`] puts them together. [`integrals`] and [`profiles`] are read off the fields.

mod engine;
pub mod fields;
mod heat_and_wear;
mod integrals;
mod mechanics;
pub mod operators;
mod profiles;
mod relaxation;
pub mod solvers;
pub mod tangent;
#[cfg(test)]
mod tests;
