//! Undeformed surfaces of wheel and rail: the [`gap`] between them, and [`hertz`], the contact of bodies whose gap is quadratic.

pub mod gap;
pub mod hertz;
