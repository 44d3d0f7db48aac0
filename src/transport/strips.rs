//! The columns that the strips of a patch share, and the rail ahead of and behind their window.
//!
//! A patch is divided across the rail into strips of one breadth b, which rail crosses side by side: each has values of its own at
//! the cells of the window and at one column next to it at either end, all at one distance. From there to ±L the columns widen
//! as those of a line contact, and hold one value for all strips. What comes from there is the same for every strip; what leaves
//! is the mean over the breadth B of the contact. A rail that came in at 0 and got a_j in the strips then holds Σ b a_j = B ā.
//! But what came in is in strips that the contact does not touch, too. So the rail beside the contact, a strip that is never touched,
//! is marched with the others, and the breadth-averaged value is its value plus the mean excess of the strips:
//!
//! ā = a_beside + (b/B) Σ (a_j − a_beside).
//!
//! It is linear in the strips' values, so that every balance of a strip's cells is one of B a_beside + Σ b (a_j − a_beside) as well: what
//! enters over the breadth B, what the contact adds and what leaves add up to round-off while B stays.

use crate::numerics::dense::LANES;
use crate::transport::Upwind;
use std::ops::Range;

/// Strips side by side.
#[derive(Debug, Clone)]
pub struct Strips {
    /// Number of strips.
    pub strips: usize,
    /// Number of cells of a strip.
    pub cells: usize,
    /// Breadth b of a strip, `m`.
    pub breadth: f64,
    /// Positions of all columns, ascending, `m`.
    x: Vec<f64>,
    /// The first cell among them.
    first: usize,
}

/// One end of the strips: a place in what is kept for both.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Side {
    /// End towards −x₁.
    Left = 0,
    /// End towards +x₁.
    Right = 1,
}

impl Strips {
    /// Strips, `strips` of breadth `breadth` `m`, over columns at `x` `m`, of which those in `window` are the cells of the window. The
    /// columns next to the window are as far from it as its cells are from each other; there are two or more at either end.
    pub fn new(x: &[f64], window: Range<usize>, strips: usize, breadth: f64) -> Strips {
        Strips {
            strips,
            cells: window.len(),
            breadth,
            x: x.to_vec(),
            first: window.start,
        }
    }

    /// Number of columns at which the strips have values of their own: the cells, and one column at either end.
    pub fn columns(&self) -> usize {
        self.cells + 2
    }

    /// Number of blocks of [`LANES`] strips, the rail beside the contact among them.
    pub fn blocks(&self) -> usize {
        (self.strips + 1).div_ceil(LANES)
    }

    /// Distance of those columns, `m`.
    pub fn spacing(&self) -> f64 {
        self.x[self.first] - self.x[self.first - 1]
    }

    /// The march through those columns at V `m/s`.
    pub fn window(&self, speed: f64) -> Upwind<'_> {
        Upwind::new(&self.x[self.first - 1..][..self.columns()], speed)
    }

    /// The march through the columns on one side, with that next to the window.
    pub fn outer(&self, side: Side, speed: f64) -> Upwind<'_> {
        Upwind::new(self.outer_positions(side), speed)
    }

    /// Positions of those columns, `m`.
    pub fn outer_positions(&self, side: Side) -> &[f64] {
        match side {
            Side::Left => &self.x[..self.first],
            Side::Right => &self.x[self.first + self.cells..],
        }
    }

    /// Sides of the window (inflow, outflow): the one that rail comes from, and the one that it goes to.
    pub fn ends(&self, speed: f64) -> (Side, Side) {
        if speed >= 0.0 {
            (Side::Right, Side::Left)
        } else {
            (Side::Left, Side::Right)
        }
    }

    /// Mean ā over the breadth B `m`, of values by strip.
    pub fn mean(&self, breadth: f64, value: impl Fn(usize) -> f64) -> f64 {
        value(self.strips) + self.breadth / breadth * self.excess(value)
    }

    /// Excess Σ (a_j − a_beside) of the strips over the rail beside them.
    pub fn excess(&self, value: impl Fn(usize) -> f64) -> f64 {
        let beside = value(self.strips);
        (0..self.strips).map(|strip| value(strip) - beside).sum()
    }
}
