//! Grids of a patch that have a name: each with the error of its forces and the time of its step.

use crate::error::{Error, Result};

/// Name under which a grid is chosen where parameters are set by name; it sets `patch_nodes` and `patch_strips`.
pub const PATCH_GRID: &str = "patch_grid";

/// Grid of a patch by its name.
///
/// The error of a grid is the largest one of F_x/(μ F_N), F_y/(μ F_N) and M_z/(μ F_N √(ab)) in steady rolling, against the limits of
/// CONTACT and of an independent program for ever finer elements: creepages and spin alone and combined, on three ellipses
/// (`verification::patch_creep::largest_deviations`). The limits themselves are known to some 0.002. Times are in
/// `docs/performance.md`, as `cargo run --release --example error_over_time` measured them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PatchGrid {
    /// Grid for many wheels and for real time.
    Fast,
    /// Grid of the start values.
    Default,
    /// Grid for what is compared with measurements or other programs.
    Fine,
}

impl PatchGrid {
    /// All grids, from the coarsest on.
    pub const ALL: [PatchGrid; 3] = [PatchGrid::Fast, PatchGrid::Default, PatchGrid::Fine];
    /// Names of the grids, in the same order.
    pub const NAMES: &[&str] = &["fast", "default", "fine"];

    /// Grid of a name.
    ///
    /// # Errors
    /// [`Error::UnknownChoice`].
    pub fn of(name: &str) -> Result<PatchGrid> {
        let place = PatchGrid::NAMES.iter().position(|known| *known == name);
        let unknown = || Error::UnknownChoice {
            name: PATCH_GRID,
            text: name.to_owned(),
            allowed: PatchGrid::NAMES,
        };
        place.map(|place| PatchGrid::ALL[place]).ok_or_else(unknown)
    }

    /// Name of the grid.
    pub fn name(self) -> &'static str {
        PatchGrid::NAMES[self as usize]
    }

    /// Number of cells along the window, `patch_nodes`.
    pub fn nodes(self) -> usize {
        [8, 34, 48][self as usize]
    }

    /// Number of strips across the window, `patch_strips`.
    pub fn strips(self) -> usize {
        [8, 21, 31][self as usize]
    }
}
