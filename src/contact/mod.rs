//! The contact of wheel and rail.

pub mod line;
pub mod outputs;
pub mod rim;
