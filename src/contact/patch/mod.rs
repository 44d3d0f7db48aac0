//! The patch: half-spaces, the contact resolved along the rail and across it.
//!
//! [`operators`] are what is computed once, by the influence functions in [`kernels`] and the [`expansion`] by heat. [`fields`] are what a step changes, [`solvers`] its
//! solvers and buffers, [`problem`] has the parts of its equations, [`undeformed`] gap and rigid slip. The parts of a step are [`mechanics`], pressure and then friction
//! ([`shear`]) with the [`response`] of the slip to it, the [`centroid`] of the strips' loads, and what the cells' particles bring along ([`memory`]), and [`heat_and_wear`]; their
//! derivatives are [`tangent`], at the point of [`linearisation`], and [`march_tangent`]. [`begin`] begins a step, [`engine`] puts them together. [`integrals`], with the [`extent`] of the
//! contact, and [`profiles`] are read off the fields.

pub(super) mod begin;
mod centroid;
pub(super) mod engine;
mod expansion;
pub(super) mod extent;
pub mod fields;
pub(super) mod heat_and_wear;
pub(super) mod integrals;
mod kernels;
pub(super) mod linearisation;
pub(super) mod march_tangent;
pub(super) mod mechanics;
mod memory;
pub mod operators;
pub(super) mod problem;
pub(super) mod profiles;
mod response;
mod shear;
pub mod solvers;
pub mod tangent;
pub(super) mod undeformed;
