//! The FMI 2.0 co-simulation interface (standard 2.0.5): a thin layer over [`crate::wheel_rail`].
//!
//! Read in this order: [`types`] (the C types), [`variables`] (the one table of variables), [`modes`] (which call is
//! allowed when), [`instance`] (what the calls do), `stepping` and `saving` (the rest of what they do),
//! [`state`] (the serialised form), [`failure`] (who is to blame, and the status that follows), [`logging`] and last
//! [`functions`] (the exported functions: pointers, panic fence, status).
//!
//! This is the only module with `unsafe` code.

#![allow(unsafe_code)]

pub mod failure;
mod fence;
pub mod functions;
pub mod instance;
pub mod logging;
pub mod modes;
mod pointers;
mod resource;
mod saving;
pub mod state;
mod stepping;
pub mod types;
pub mod variables;

/// The GUID of the checked-in model description: a library and a description of different builds refuse each other.
pub const GUID: &str = guid_of(include_str!("../../modelDescription/modelDescription.xml"));

/// The value of the first attribute `guid` of a model description, which must have one.
pub const fn guid_of(xml: &str) -> &str {
    const ATTRIBUTE: &[u8] = b"guid=\"";
    let bytes = xml.as_bytes();
    let mut start = 0;
    loop {
        let mut matched = 0;
        while matched < ATTRIBUTE.len() && bytes[start + matched] == ATTRIBUTE[matched] {
            matched += 1;
        }
        if matched == ATTRIBUTE.len() {
            break;
        }
        start += 1;
    }
    start += ATTRIBUTE.len();
    let mut end = start;
    while bytes[end] != b'"' {
        end += 1;
    }
    xml.split_at(end).0.split_at(start).1
}
