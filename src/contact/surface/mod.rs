//! The contact of profiles: one problem on the unrolled surface of the rail, with a window about each contact.
//!
//! [`operators`] are wheel and rail in their shapes and the operators of a patch for each size of a [`windows`]' cells; [`search`] finds
//! where they overlap. In each window the fields, the mechanics, heat and wear are those of a patch.

mod apart;
mod approach_response;
mod approaches;
mod bodies;
mod contacts;
mod engine;
pub mod fields;
mod geometry;
mod interpolation;
mod mechanics;
pub mod operators;
mod placement;
mod plots;
mod pressure;
mod problem;
mod profile_wear;
mod seams;
mod search;
pub mod solvers;
pub mod tangent;
#[cfg(test)]
mod tests;
pub mod totals;
mod transfer;
mod windows;
pub mod worn_bodies;
