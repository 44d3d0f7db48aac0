//! The shared library as an importer sees it: loaded at run time, called through C pointers.

#![allow(unsafe_code)]

mod importer;
mod own_process;

mod abi;
mod adjoint_derivatives;
mod arrays;
mod both_standards;
mod calls;
mod description;
mod directional_derivatives;
mod document;
mod early_return;
#[cfg(all(target_os = "linux", target_arch = "x86_64", target_env = "gnu"))]
mod floating_point;
mod fmi2_alone;
mod functions;
mod input_derivatives;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod isolation;
mod logging;
mod odd_calls;
mod probes;
mod probes_fmi3;
mod profiles;
mod sequences;
#[cfg(target_os = "linux")]
mod soak;
mod state;
mod states;
mod steps;
mod texts;
#[cfg(target_os = "linux")]
mod unload;
mod values;
