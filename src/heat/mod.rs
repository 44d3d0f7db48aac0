//! Temperature of the rail (19), (23), and the displacement that it causes.

pub mod basis;
pub mod incoming;
pub mod march;
pub mod thermal_map;
