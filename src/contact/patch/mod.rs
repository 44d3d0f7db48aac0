//! The patch engine: half-spaces, the contact resolved along the rail and across it.

pub mod engine;
