//! Rail and wheel as elastic bodies: what is computed once.

pub mod compliance;
pub mod elastic_wheel;
pub mod elasticity;
pub mod mesh;
