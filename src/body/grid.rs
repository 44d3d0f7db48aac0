//! The rectangular grid over the window of a patch: strips along x, evenly spaced across, each of cells of one size.
//!
//! Values on cells stand strip by strip, each strip in a row of [`Grid::stride`] values, of which the first
//! [`Grid::cells`] count: rows are filled up to whole vectors of the machine.

use crate::numerics::real::BLOCK;
use std::ops::Range;

/// The grid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Cells along a strip.
    pub cells: usize,
    /// Strips.
    pub strips: usize,
    /// Extent of a cell along x, `m`.
    pub length: f64,
    /// Extent of a cell along y, the breadth of a strip, `m`.
    pub breadth: f64,
}

impl Grid {
    /// Grid over a window of the given half-length and half-breadth, `m`.
    pub fn new(cells: usize, strips: usize, half_length: f64, half_breadth: f64) -> Grid {
        Grid {
            cells,
            strips,
            length: 2.0 * half_length / cells as f64,
            breadth: 2.0 * half_breadth / strips as f64,
        }
    }

    /// Values in the row of a strip.
    pub fn stride(&self) -> usize {
        self.cells.next_multiple_of(BLOCK)
    }

    /// Values on all rows.
    pub fn len(&self) -> usize {
        self.strips * self.stride()
    }

    /// Place of a cell in the values.
    pub fn place(&self, strip: usize, cell: usize) -> usize {
        strip * self.stride() + cell
    }

    /// The row of a strip.
    pub fn row(&self, strip: usize) -> Range<usize> {
        let start = strip * self.stride();
        start..start + self.cells
    }

    /// x of the centre of a cell, `m`: an odd function of the cell, so that the mirror image is exact.
    pub fn x(&self, cell: usize) -> f64 {
        0.5 * self.length * ((2 * cell + 1) as f64 - self.cells as f64)
    }

    /// y of the centre line of a strip, `m`.
    pub fn y(&self, strip: usize) -> f64 {
        0.5 * self.breadth * ((2 * strip + 1) as f64 - self.strips as f64)
    }

    /// Area of a cell, `m²`.
    pub fn cell_area(&self) -> f64 {
        self.length * self.breadth
    }

    /// Half the length of the window, `m`.
    pub fn half_length(&self) -> f64 {
        0.5 * self.length * self.cells as f64
    }
}
