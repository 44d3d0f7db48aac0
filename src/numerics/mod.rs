//! Numerical methods that know nothing of contact.

pub mod anderson;
pub mod arctangent;
pub mod decay;
pub mod dense;
pub mod sparse_cholesky;
