//! wheelrail
pub mod compliance;
pub mod contact;
pub mod dense;
pub mod elasticity;
pub mod error;
pub mod friction;
pub mod heat;
pub mod mesh;
pub mod normal;
pub mod parameters;
pub mod profiles;
pub mod signals;
pub mod tangential;
pub mod thermal_map;
pub mod transport;
pub mod wear;
pub mod wheel_rail;
