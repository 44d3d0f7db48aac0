//! Integrals of a kernel of the half-space over the cells of a grid, by the lag between the cell and the place: each corner function is
//! evaluated once for the four cells that meet there, and for positive lags only.

use super::grid::Grid;
use super::half_space::Kernel;

/// Integrals of one kernel, by the lag.
pub struct CellIntegrals {
    /// Values at the lags 0, 1, … along, row by row over the lags 0, 1, … across.
    values: Vec<f64>,
    /// Values of a row.
    along: usize,
    /// Whether the kernel is odd along and across.
    odd: [bool; 2],
}

impl CellIntegrals {
    /// Integrals at the lags up to the given ones, along and across.
    pub fn new(grid: &Grid, [along, across]: [usize; 2], kernel: &Kernel) -> CellIntegrals {
        // Corners lie half a cell before and behind the places.
        let corners = |lag: usize, size: f64| (lag as f64 - 0.5) * size;
        let corner_row = |row: usize| -> Vec<f64> {
            let y = corners(row, grid.breadth);
            (0..along + 2)
                .map(|corner| (kernel.corner)(corners(corner, grid.length), y))
                .collect()
        };
        let mut right = corner_row(0);
        let mut values = Vec::with_capacity((along + 1) * (across + 1));
        for row in 1..across + 2 {
            let left = corner_row(row);
            values.extend((0..along + 1).map(|lag| (left[lag + 1] - right[lag + 1]) - (left[lag] - right[lag])));
            right = left;
        }
        CellIntegrals {
            values,
            along: along + 1,
            odd: kernel.odd,
        }
    }

    /// Integral at a lag.
    pub fn at(&self, (along, across): (isize, isize)) -> f64 {
        let value = self.values[across.unsigned_abs() * self.along + along.unsigned_abs()];
        let turned = (self.odd[0] && along < 0) != (self.odd[1] && across < 0);
        if turned { -value } else { value }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::half_space::{
        Rectangle, X_OVER_R2, X_OVER_R3, XX_OVER_R3, XY_OVER_R3, Y_OVER_R2, Y_OVER_R3, YY_OVER_R3,
    };

    const KERNELS: [Kernel; 7] = [
        XX_OVER_R3, YY_OVER_R3, XY_OVER_R3, X_OVER_R2, Y_OVER_R2, X_OVER_R3, Y_OVER_R3,
    ];

    #[test]
    fn integrals_are_those_of_the_rectangle_at_every_lag() {
        let grid = Grid::new(6, 4, 1.2, 0.5);
        let cell = Rectangle {
            half_length: 0.5 * grid.length,
            half_breadth: 0.5 * grid.breadth,
        };
        for (number, kernel) in KERNELS.iter().enumerate() {
            let integrals = CellIntegrals::new(&grid, [7, 5], kernel);
            for lag in (-7..=7).flat_map(|along| (-5..=5).map(move |across| (along, across))) {
                let (x, y) = (lag.0 as f64 * grid.length, lag.1 as f64 * grid.breadth);
                let exact = cell.integral(kernel, x, y);
                // Round-off of corner functions of order 1.
                assert!((integrals.at(lag) - exact).abs() < 1e-14, "{number} {lag:?}");
            }
        }
    }
}
