//! Rail and wheel as elastic bodies: what is computed once. After it, no sparse system is solved.
//!
//! [`mesh`] triangulates a body, [`elasticity`] assembles and factorises it, [`compliance`] makes the dense maps of it that a
//! step uses, [`pair`] adds those of rail and wheel.

pub mod compliance;
pub mod elasticity;
pub mod half_plane;
pub mod mesh;
pub mod pair;
