//! The FMI 3.0 co-simulation interface (standard 3.0.2): a thin layer over [`crate::fmi`].
//!
//! Read in this order: [`types`] (the C types), `references` (value references; an array has one), [`states`] (which call is
//! allowed when), [`failures`] (the status that follows from who is to blame), `logger` (the importer's callback), [`instance`]
//! and `values` (what a call does), and last [`functions`] (the exported functions). [`description`] is
//! `modelDescription.xml`, `schema` its elements, [`terminals`] is `terminalsAndIcons.xml`.
//!
//! There is no event mode, no clock and no intermediate update.

use crate::fmi::token::attribute;

#[cfg(feature = "cli")]
pub mod description;
pub mod failures;
pub mod functions;
pub mod instance;
mod logger;
pub mod references;
#[cfg(feature = "cli")]
mod schema;
pub mod states;
#[cfg(feature = "cli")]
pub mod terminals;
pub mod types;
mod values;

/// The instantiation token of the checked-in model description.
pub const INSTANTIATION_TOKEN: &str = token_of(include_str!("../../modelDescription/fmi3/modelDescription.xml"));

/// The instantiation token of a model description.
pub const fn token_of(xml: &str) -> &str {
    attribute("instantiationToken", xml)
}
