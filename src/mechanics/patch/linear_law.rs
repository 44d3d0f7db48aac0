//! The linearised law of the cells in single precision, each coefficient an array of its own: what the corrections of Newton's method
//! multiply with and factorise. Neighbouring cells then go through one vector instruction.

use super::law::{CellLawRow, Vector};
use crate::numerics::dense;

/// Coefficients of a cell's law by component of the residual and component of what it is multiplied with.
type Coefficients = [[Vec<f32>; 2]; 2];

/// Linearised law of the cells.
#[derive(Debug, Clone)]
pub struct LinearLaw {
    /// Derivatives by the cell's own shear, what the leading edge adds to its slip included.
    pub by_shear: Coefficients,
    /// Derivatives by the slip ahead, without what the leading edge adds.
    pub by_ahead: Coefficients,
    /// Derivatives by the slip behind.
    pub by_behind: Coefficients,
}

/// Changes of shear and slip at the cells of a run, along x and y.
#[derive(Clone, Copy)]
pub struct RunChange<'a> {
    /// Change of the shear.
    pub shear: [&'a [f32]; 2],
    /// Change of the slip ahead, without what the leading edge adds.
    pub ahead: [&'a [f32]; 2],
    /// Change of the slip behind.
    pub behind: [&'a [f32]; 2],
}

impl LinearLaw {
    /// Law of up to so many cells.
    pub fn new(cells: usize) -> LinearLaw {
        let zero = || std::array::from_fn(|_| std::array::from_fn(|_| vec![0.0; cells]));
        LinearLaw {
            by_shear: zero(),
            by_ahead: zero(),
            by_behind: zero(),
        }
    }

    /// Takes the rows of the law. `edge` is the slip per shear that the leading edge adds to a cell, along x and y.
    pub fn take(&mut self, rows: &[CellLawRow], edge: &[Vector]) {
        for (cell, (row, edge)) in rows.iter().zip(edge).enumerate() {
            for i in 0..2 {
                for (j, edge) in edge.iter().enumerate() {
                    self.by_shear[i][j][cell] = (row.by_shear[i][j] + row.by_ahead[i][j] * edge) as f32;
                    self.by_ahead[i][j][cell] = row.by_ahead[i][j] as f32;
                    self.by_behind[i][j][cell] = row.by_behind[i][j] as f32;
                }
            }
        }
    }

    /// Writes the change of one component of the residual at the cells of a run, of which `first` is the first.
    pub fn multiply(&self, component: usize, first: usize, change: &RunChange, out: &mut [f32]) {
        dense::vectorised(
            #[inline(always)]
            |fma| {
                out.fill(0.0);
                let parts = [
                    (&self.by_shear, change.shear),
                    (&self.by_ahead, change.ahead),
                    (&self.by_behind, change.behind),
                ];
                for (coefficients, changes) in parts {
                    let [by_x, by_y] = &coefficients[component];
                    let coefficients = by_x[first..].iter().zip(&by_y[first..]);
                    let changes = changes[0].iter().zip(changes[1]);
                    for (out, ((by_x, by_y), (x, y))) in out.iter_mut().zip(coefficients.zip(changes)) {
                        let sum = fma.multiply_add_single(*by_x, *x, *out);
                        *out = fma.multiply_add_single(*by_y, *y, sum);
                    }
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::patch::law::{Matrix, multiply};

    /// The change of the residual of a run inside other cells is that of its rows, with the leading edge in the slip ahead.
    #[test]
    fn the_product_is_that_of_the_rows() {
        let wave = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64).sin();
        let matrix =
            |i: usize, k: usize| -> Matrix { [[wave(i, k), wave(i, k + 1)], [wave(i, k + 2), wave(i, k + 3)]] };
        let rows: Vec<CellLawRow> = (0..21)
            .map(|i| CellLawRow {
                by_shear: matrix(i, 0),
                by_ahead: matrix(i, 4),
                by_behind: matrix(i, 8),
                ..CellLawRow::default()
            })
            .collect();
        let edge: Vec<Vector> = (0..21).map(|i| [0.3 * (i % 3) as f64, 0.1 * (i % 2) as f64]).collect();
        let mut law = LinearLaw::new(30);
        law.take(&rows, &edge);
        let (first, cells) = (3, 17);
        let values: Vec<Vec<f32>> = (0..6)
            .map(|k| (0..cells).map(|i| wave(k, i) as f32).collect())
            .collect();
        let pair = |k: usize| [&values[k][..], &values[k + 1][..]];
        let change = RunChange {
            shear: pair(0),
            ahead: pair(2),
            behind: pair(4),
        };
        let mut out = [vec![0.0; cells], vec![0.0; cells]];
        for (component, out) in out.iter_mut().enumerate() {
            law.multiply(component, first, &change, out);
        }
        for i in 0..cells {
            let at = |k: usize| -> Vector { [0, 1].map(|j: usize| f64::from(values[k + j][i])) };
            let (row, edge, shear) = (&rows[first + i], edge[first + i], at(0));
            let ahead = [at(2)[0] + edge[0] * shear[0], at(2)[1] + edge[1] * shear[1]];
            let terms = [
                multiply(row.by_shear, shear),
                multiply(row.by_ahead, ahead),
                multiply(row.by_behind, at(4)),
            ];
            for (component, out) in out.iter().enumerate() {
                let exact: f64 = terms.iter().map(|term| term[component]).sum();
                // Single precision.
                assert!((f64::from(out[i]) - exact).abs() < 1e-6, "{i}: {} {exact}", out[i]);
            }
        }
    }
}
