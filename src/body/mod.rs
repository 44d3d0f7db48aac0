//! Rail and wheel as elastic bodies: what is computed once. After it, no sparse system is solved.
//!
//! [`mesh`] triangulates a body, [`forms`] has its bilinear forms, [`elasticity`] factorises it. [`half_plane`] is the closed
//! form of the near field, [`remainder`] what the body's finite size adds to it; [`unit_loads`] has both at once, on the
//! paper's mesh. [`thermal`] is the displacement by heat. [`pair`] makes of these the [`compliance`] of rail and wheel, the
//! dense maps that a step uses.

pub mod cell_integrals;
pub mod compliance;
pub mod elasticity;
pub mod forms;
pub mod grid;
pub mod half_plane;
pub mod half_space;
pub mod influence;
pub mod mesh;
pub mod pair;
pub mod remainder;
pub mod thermal;
pub mod unit_loads;
