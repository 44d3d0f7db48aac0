//! The command line `wheelrail`, and the archive that it packs in an importer written by others.

mod fmu_runner;
mod geometry;
mod images;
mod pack;
mod presets;
mod simulate;

use std::env::{consts, current_exe};
use std::path::PathBuf;

/// The shared library that `cargo test` leaves in `target/<profile>/deps`, beside the test.
fn library_path() -> PathBuf {
    let name = format!("{}wheelrail{}", consts::DLL_PREFIX, consts::DLL_SUFFIX);
    current_exe().expect("the test has a path").with_file_name(name)
}
