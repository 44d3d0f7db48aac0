//! The FMI 2.0 co-simulation interface (standard 2.0.5): a thin layer over [`crate::fmi`].
//!
//! Read in this order: [`types`] (the C types), [`variables`] (the table with arrays as their elements), `references` (their
//! value references), [`states`] (which call is allowed when), [`failures`] (the status that follows from who is to blame),
//! `logger` (the importer's callback), [`instance`] and `values` (what a call does), and last [`functions`] (the exported
//! functions: pointers, panic fence, status). [`description`] is `modelDescription.xml`, `schema` its elements.

use crate::fmi::token::attribute;

#[cfg(feature = "cli")]
pub mod description;
pub mod failures;
pub mod functions;
pub mod instance;
mod logger;
mod references;
#[cfg(feature = "cli")]
mod schema;
pub mod states;
pub mod types;
mod values;
pub mod variables;

/// The GUID of the checked-in model description.
pub const GUID: &str = guid_of(include_str!("../../modelDescription/modelDescription.xml"));

/// The GUID of a model description.
pub const fn guid_of(xml: &str) -> &str {
    attribute("guid", xml)
}
