//! The line engine: plane strain, one strip.

pub mod fields;
pub mod profiles;
pub mod rail;
pub mod sensitivity;
pub mod split;
