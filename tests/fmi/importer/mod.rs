//! The shared library as an importer sees it: loaded at run time, called through C pointers, by either standard.

mod api;
mod client;
mod dispatch;
mod messages;
mod standard;

pub use api::*;
pub use client::Client;
pub use dispatch::Answer;
pub use messages::*;
pub use standard::*;

use std::ffi::c_int;

pub use wheelrail::parameters::ContactModel::{self, Line, Patch, Profiles};

pub const OK: c_int = 0;
pub const WARNING: c_int = 1;
pub const DISCARD: c_int = 2;
pub const ERROR: c_int = 3;

/// Takes a test once by each standard. The last one that a failure prints is where it failed.
#[track_caller]
pub fn with_each_standard(test: impl Fn(&Api)) {
    for standard in Standard::ALL {
        println!("{standard:?}");
        test(&Api::load(standard));
    }
}

/// Takes a test once by each standard with each contact model.
#[track_caller]
pub fn with_each(test: impl Fn(&Api, ContactModel)) {
    with_each_standard(|api| with_each_contact_model(api, &test));
}

/// Takes a test once with the contact models that are driven by creepages: profiles have their own, in `profiles.rs`.
#[track_caller]
pub fn with_each_contact_model(api: &Api, test: impl Fn(&Api, ContactModel)) {
    for contact in [Line, Patch] {
        println!("{contact:?}");
        test(api, contact);
    }
}

/// Parameters of a contact model with a grid so coarse that tests are quick.
pub fn coarse(contact: ContactModel) -> &'static [(&'static str, c_int)] {
    match contact {
        Line => &[("contact_nodes", 25), ("depth_nodes", 17)],
        Patch => &[
            ("contact_model", 2),
            ("patch_nodes", 14),
            ("patch_strips", 7),
            ("depth_nodes", 17),
        ],
        Profiles => &[
            ("contact_model", 3),
            ("slip_source", 2),
            ("patch_nodes", 14),
            ("patch_strips", 7),
            ("depth_nodes", 17),
        ],
    }
}

/// Lateral and spin motion, where a contact model takes it: creepages, and the speeds that they make at 10 m/s.
pub fn sideways(contact: ContactModel) -> &'static [(&'static str, f64)] {
    match contact {
        Line => &[],
        Patch => &[
            ("lateral_creepage", 0.001),
            ("spin_creepage", 0.3),
            ("lateral_speed", 0.01),
            ("spin_rate", 3.0),
        ],
        Profiles => &[("lateral_speed", 0.01), ("yaw_rate", 0.1)],
    }
}
