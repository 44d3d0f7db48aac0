//! The shared library as an importer sees it: loaded at run time, called through C pointers.

#![allow(unsafe_code)]

mod importer;
mod own_process;

mod abi;
mod calls;
mod description;
mod directional_derivatives;
mod input_derivatives;
#[cfg(all(target_os = "linux", target_arch = "x86_64"))]
mod isolation;
mod logging;
mod probes;
mod sequences;
#[cfg(target_os = "linux")]
mod soak;
mod state;
mod states;
mod steps;
#[cfg(target_os = "linux")]
mod unload;
mod values;
