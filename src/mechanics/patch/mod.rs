//! Pressure and shear of a patch, for given temperature and wear.
//!
//! [`contact`] lists the cells under pressure, [`normal`] finds them and their pressure, [`law`] is Coulomb's law of a cell with the
//! scheme in which the slip is taken, [`law_arrays`] holds it for all cells, [`linear_law`] what corrections multiply with, [`friction`] solves it for all cells together, with the [`blocks`] of the strips as
//! preconditioner.

pub mod blocks;
pub mod contact;
pub mod friction;
pub mod law;
pub mod law_arrays;
pub mod linear_law;
pub mod normal;
