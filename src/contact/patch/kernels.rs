//! Influence functions of a patch: displacement of the centre of a cell by a traction on another one, a function of the lag between
//! the two, in cells along x and strips across.

use crate::body::grid::Grid;
use crate::body::half_space::{HalfSpaces, Rectangle};

/// Influence functions of the pair of half-spaces with a layer between them, scaled: displacement per traction.
pub struct Kernels<'a> {
    /// Pair of half-spaces.
    pub pair: &'a HalfSpaces,
    /// Grid of the cells.
    pub grid: &'a Grid,
    /// Scaled displacement per traction and compliance of 1 `m/Pa`.
    pub unit: f64,
    /// Compliance of the layer, scaled; 0 without one.
    pub layer: f64,
}

impl Kernels<'_> {
    /// Cell, as the rectangle that is loaded, and the distance of the lag.
    fn cell(&self, lag: (isize, isize)) -> (Rectangle, f64, f64) {
        let (x, y) = self.grid.distance(lag);
        let rectangle = Rectangle {
            half_length: 0.5 * self.grid.length,
            half_breadth: 0.5 * self.grid.breadth,
        };
        (rectangle, x, y)
    }

    /// Normal displacement by pressure.
    pub fn normal(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.unit * self.pair.normal() * cell.one_over_r(x, y)
    }

    /// Displacement u_x by τ_x.
    pub fn along(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.normal(lag) + self.unit * self.pair.lateral * cell.xx_over_r3(x, y) + self.layer_at(lag)
    }

    /// Displacement u_y by τ_y.
    pub fn across(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.normal(lag) + self.unit * self.pair.lateral * cell.yy_over_r3(x, y) + self.layer_at(lag)
    }

    /// Displacement u_x by τ_y, and u_y by τ_x.
    pub fn mixed(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.unit * self.pair.lateral * cell.xy_over_r3(x, y)
    }

    /// Displacement u_x by pressure, and normal displacement by τ_x.
    pub fn coupling_along(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.coupling() * cell.x_over_r2(x, y)
    }

    /// Displacement u_y by pressure, and normal displacement by τ_y.
    pub fn coupling_across(&self, lag: (isize, isize)) -> f64 {
        let (cell, x, y) = self.cell(lag);
        self.coupling() * cell.y_over_r2(x, y)
    }

    fn coupling(&self) -> f64 {
        -self.unit * self.pair.coupling
    }

    /// Displacement over the layer, which a cell's own shear alone moves.
    fn layer_at(&self, lag: (isize, isize)) -> f64 {
        if lag == (0, 0) { self.layer } else { 0.0 }
    }
}
