//! Numerical methods that know nothing of contact.

pub mod anderson;
pub mod arctangent;
pub mod band_cholesky;
pub mod decay;
pub mod dense;
#[cfg(test)]
pub mod differences;
pub mod elliptic;
pub mod fourier;
pub mod gauss;
pub mod gmres;
pub mod interpolation;
pub mod inverse;
pub mod number;
pub mod real;
pub mod root;
pub mod single;
