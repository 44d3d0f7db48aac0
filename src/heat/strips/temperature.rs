//! Temperature of the strips: the state that a step of their heat changes.

use crate::numerics::dense::LANES;
use crate::transport::strips::{Side, Strips};
use serde::{Deserialize, Serialize};

/// Temperature of the strips and of the rail ahead and behind, or a change of it; m modes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct StripTemperature {
    /// Modal amplitudes of the strips, blocks × columns × m × [`LANES`]: the strips, after them the rail beside the contact.
    pub window: Vec<f64>,
    /// Modal amplitudes of the rail on either side, columns × m: at the column next to the window their mean.
    pub outer: [Vec<f64>; 2],
    /// Temperature rise at the surface of the cells, `K`.
    pub surface: Vec<f64>,
    /// Heat flux into the rail at the cells, `W/m²`.
    pub flux: Vec<f64>,
    /// Heat content Θ = ∫ θ dz of the cells, `K m`.
    pub content: Vec<f64>,
    /// Amplitudes that the step has overwritten: those in the strips' inflow column, blocks × m × [`LANES`], where rail
    /// entered, m, and the mean at the outflow column, m. The derivatives of the step need them.
    pub replaced: Vec<f64>,
    /// B of the last step with a contact, `m`.
    pub breadth: f64,
}

impl StripTemperature {
    /// Rail at ambient temperature.
    pub fn new(strips: &Strips, modes: usize) -> StripTemperature {
        let (cells, lanes) = (strips.strips * strips.cells, strips.blocks() * LANES);
        let outer = |side| vec![0.0; strips.outer_positions(side).len() * modes];
        StripTemperature {
            window: vec![0.0; strips.columns() * modes * lanes],
            outer: [outer(Side::Left), outer(Side::Right)],
            surface: vec![0.0; cells],
            flux: vec![0.0; cells],
            content: vec![0.0; cells],
            replaced: vec![0.0; (lanes + 2) * modes],
            breadth: strips.breadth * strips.strips as f64,
        }
    }

    /// Modal amplitudes of a cell.
    pub fn amplitudes(&self, strips: &Strips, strip: usize, cell: usize) -> impl Iterator<Item = f64> + Clone {
        let modes = self.window.len() / (strips.columns() * strips.blocks() * LANES);
        // The first column is the one beside the window.
        let column = strip / LANES * strips.columns() + cell + 1;
        let own = &self.window[column * modes * LANES..][..modes * LANES];
        own.iter().skip(strip % LANES).step_by(LANES).copied()
    }

    /// The vectors, in the order of their declaration.
    pub fn vectors(&self) -> [&Vec<f64>; 7] {
        let [left, right] = &self.outer;
        [
            &self.window,
            left,
            right,
            &self.surface,
            &self.flux,
            &self.content,
            &self.replaced,
        ]
    }

    /// The vectors to change, in the same order.
    pub fn vectors_mut(&mut self) -> [&mut Vec<f64>; 7] {
        let [left, right] = &mut self.outer;
        [
            &mut self.window,
            left,
            right,
            &mut self.surface,
            &mut self.flux,
            &mut self.content,
            &mut self.replaced,
        ]
    }

    /// Amplitude of a mode in a strip at one of its columns; the strip after the last is the rail beside the contact.
    #[cfg(feature = "verification")]
    pub fn amplitude(&self, strips: &Strips, strip: usize, column: usize, mode: usize) -> f64 {
        let modes = self.window.len() / (strips.columns() * strips.blocks() * LANES);
        let row = (strip / LANES * strips.columns() + column) * modes + mode;
        self.window[row * LANES + strip % LANES]
    }
}
