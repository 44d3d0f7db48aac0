//! Undeformed surfaces of wheel and rail: the [`gap`] between them, [`hertz`], the contact of bodies whose gap is quadratic, and the
//! [`profile`] of a wheel or rail as it is, and where a [`wheelset`] of such profiles touches its track. [`rail`] places a rail in the
//! track, [`unrolled`] a wheel over its surface.

pub mod gap;
pub mod hertz;
pub mod profile;
mod quintics;
pub mod rail;
mod spline;
pub mod unrolled;
pub mod wheelset;
