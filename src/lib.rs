//! wheelrail
pub mod error;
pub mod parameters;
pub mod signals;
pub mod wheel_rail;
