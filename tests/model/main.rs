//! How the stepped model behaves, natively: what it bears, what it refuses, and what must not depend on how it is driven.

mod at_rest;
mod bad_input;
mod by_speeds;
mod damage;
mod defaults;
mod derivatives;
mod effects;
mod falling_friction;
mod given_geometry;
mod lift_off;
mod paper_mesh;
mod profile_fields;
mod profiles;
mod random_sensitivity;
mod robustness;
mod rough_track;
mod sensitivity;
mod setups;
mod shared_model;
mod time_step;
mod torture;
mod wear;
mod wear_laws;
mod wheel_heat;
mod worn_profiles;
mod yielding_layer;
