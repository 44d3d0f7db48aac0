//! Numerical methods that know nothing of contact.

pub mod anderson;
pub mod arctangent;
pub mod decay;
pub mod dense;
pub mod elliptic;
pub mod interpolation;
pub mod sparse_cholesky;
