//! Undeformed surfaces of wheel and rail: the [`gap`] between them, [`hertz`], the contact of bodies whose gap is quadratic, and the
//! [`profile`] of a wheel or rail as it is, and where a [`wheelset`] of such profiles touches its track.

pub mod gap;
pub mod hertz;
pub mod profile;
mod quintics;
mod spline;
pub mod wheelset;
