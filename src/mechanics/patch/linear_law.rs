//! The linearised law of the cells in single precision, each coefficient an array of its own: what the corrections of Newton's method
//! multiply with and invert. Neighbouring cells then go through one vector instruction.

use super::contact::Contact;
use super::law_arrays::{Components, LawArrays};
use crate::body::grid::Grid;
use crate::numerics::dense;
use crate::numerics::single::{WIDTH, wide, wide_mut};

/// Linearised law of the cells, by component of the residual.
#[derive(Debug, Clone)]
pub struct LinearLaw {
    /// The components along x and y.
    pub rows: [LinearRow; 2],
}

/// A quantity of the cells, linearised: its derivatives along x and y, with values for a vector register beyond the cells.
#[derive(Debug, Clone)]
pub struct LinearRow {
    /// Derivatives by the cell's own shear, what the leading edge adds to its slip included.
    pub by_shear: [Vec<f32>; 2],
    /// Derivatives by the slip ahead, without what the leading edge adds.
    pub by_ahead: [Vec<f32>; 2],
    /// Derivatives by the slip behind.
    pub by_behind: [Vec<f32>; 2],
}

/// Changes of shear and slip, along x and y.
#[derive(Clone, Copy)]
pub struct Change<'a> {
    /// Change of the shear, cells, and values for a vector register beyond them.
    pub shear: [&'a [f32]; 2],
    /// Change of the slip on the grid, ahead of the cells and behind, without what the leading edge adds; and values for a vector
    /// register beyond it.
    pub slip: [&'a [f32]; 2],
    /// Lag of the slip behind: −1 for V ≥ 0, 1 else.
    pub behind: isize,
}

impl LinearLaw {
    /// Law of up to so many cells.
    pub fn new(cells: usize) -> LinearLaw {
        LinearLaw {
            rows: std::array::from_fn(|_| LinearRow::new(cells)),
        }
    }

    /// Takes the law of so many cells. `edge` is the slip per shear that the leading edge adds to a cell.
    pub fn take(&mut self, law: &LawArrays, edge: &Components, cells: usize) {
        for (i, row) in self.rows.iter_mut().enumerate() {
            row.take(Some(&law.by_shear[i]), &law.by_ahead[i], &law.by_behind[i], edge, cells);
        }
    }

    /// Writes the change of the residual of all cells, along x and y, as [`LinearRow::multiply`] does.
    pub fn multiply(&self, contact: &Contact, grid: &Grid, change: &Change, out: [&mut [f32]; 2]) {
        for (row, out) in self.rows.iter().zip(out) {
            row.multiply(contact, grid, change, out);
        }
    }
}

impl LinearRow {
    /// Derivatives of up to so many cells.
    pub fn new(cells: usize) -> LinearRow {
        let zero = || std::array::from_fn(|_| vec![0.0; cells + WIDTH]);
        LinearRow {
            by_shear: zero(),
            by_ahead: zero(),
            by_behind: zero(),
        }
    }

    /// Takes the derivatives of so many cells; none by the shear are 0. `edge` is the slip per shear that the leading edge adds to a cell.
    pub fn take(
        &mut self,
        by_shear: Option<&Components>,
        by_ahead: &Components,
        by_behind: &Components,
        edge: &Components,
        cells: usize,
    ) {
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (j, edge) in edge.iter().enumerate() {
                    let (ahead, behind) = (&by_ahead[j][..cells], &by_behind[j][..cells]);
                    let at_edge = ahead.iter().zip(edge).map(|(ahead, edge)| ahead * edge);
                    let outs = self.by_shear[j].iter_mut();
                    match by_shear {
                        Some(by_shear) => outs
                            .zip(at_edge.zip(&by_shear[j]))
                            .for_each(|(out, (at_edge, shear))| *out = (shear + at_edge) as f32),
                        None => outs.zip(at_edge).for_each(|(out, at_edge)| *out = at_edge as f32),
                    }
                    for (out, values) in [(&mut self.by_ahead[j], ahead), (&mut self.by_behind[j], behind)] {
                        for (out, value) in out.iter_mut().zip(values) {
                            *out = *value as f32;
                        }
                    }
                }
            },
        );
    }

    /// Writes the change of the quantity of all cells, and values without meaning for a vector register beyond them.
    pub fn multiply(&self, contact: &Contact, grid: &Grid, change: &Change, out: &mut [f32]) {
        dense::vectorised(
            #[inline(always)]
            |fma| {
                for run in contact.runs() {
                    let ahead = run.places(grid).start;
                    let behind = ahead.wrapping_add_signed(change.behind);
                    // By whole registers: what one of them writes beyond the end of its run, the next run overwrites.
                    for k in (0..run.cells).step_by(WIDTH) {
                        let cell = run.offset + k;
                        let mut sum = [0.0; WIDTH];
                        for by in 0..2 {
                            let slip = change.slip[by];
                            let parts = [
                                (&self.by_shear[by], wide(change.shear[by], cell)),
                                (&self.by_ahead[by], wide(slip, ahead + k)),
                                (&self.by_behind[by], wide(slip, behind + k)),
                            ];
                            for (derivatives, change) in parts {
                                let derivatives = wide(derivatives, cell);
                                for lane in 0..WIDTH {
                                    sum[lane] = fma.multiply_add_single(derivatives[lane], change[lane], sum[lane]);
                                }
                            }
                        }
                        *wide_mut(out, cell) = sum;
                    }
                }
            },
        );
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mechanics::patch::law::{CellLawRow, Matrix, Vector, multiply};
    use crate::mechanics::patch::law_arrays::tests::arrays;

    /// The change of the residual of every cell is that of its row, with the leading edge in the slip ahead.
    #[test]
    fn the_product_is_that_of_the_rows() {
        let wave = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64).sin();
        let matrix =
            |i: usize, k: usize| -> Matrix { [[wave(i, k), wave(i, k + 1)], [wave(i, k + 2), wave(i, k + 3)]] };
        let grid = Grid::new(21, 3, 1.0, 1.0);
        let mut contact = Contact::new(&grid);
        // Runs longer and shorter than a register.
        contact.list(&grid, |place| {
            let (strip, cell) = (place / grid.stride(), place % grid.stride());
            [3..20, 0..0, 9..12][strip].contains(&cell) || (strip == 1 && (cell % 10 == 4 || cell == 5))
        });
        let n = contact.cells();
        let rows: Vec<CellLawRow> = (0..n)
            .map(|i| CellLawRow {
                by_shear: matrix(i, 0),
                by_ahead: matrix(i, 4),
                by_behind: matrix(i, 8),
                ..CellLawRow::default()
            })
            .collect();
        let edge: Vec<Vector> = (0..n).map(|i| [0.3 * (i % 3) as f64, 0.1 * (i % 2) as f64]).collect();
        let mut law = LinearLaw::new(n);
        let (rows_of_all, edges) = arrays(&rows, &edge);
        law.take(&rows_of_all, &edges, n);
        let values = |k: usize, number: usize| -> Vec<f32> { (0..number).map(|i| wave(k, i) as f32).collect() };
        let shear = [0, 1].map(|k| values(k, n + WIDTH));
        let slip = [2, 3].map(|k| values(k, grid.len() + WIDTH));
        for behind in [-1, 1] {
            let change = Change {
                shear: [&shear[0], &shear[1]],
                slip: [&slip[0], &slip[1]],
                behind,
            };
            let mut out = [vec![f32::NAN; n + WIDTH], vec![f32::NAN; n + WIDTH]];
            let [along, across] = &mut out;
            law.multiply(&contact, &grid, &change, [along, across]);
            for (i, place) in contact.places(&grid).enumerate() {
                let at = |values: &[Vec<f32>; 2], place: usize| -> Vector {
                    [0, 1].map(|j: usize| f64::from(values[j][place]))
                };
                let (own, mut ahead) = (at(&shear, i), at(&slip, place));
                ahead[0] += edge[i][0] * own[0];
                ahead[1] += edge[i][1] * own[1];
                let terms = [
                    multiply(rows[i].by_shear, own),
                    multiply(rows[i].by_ahead, ahead),
                    multiply(rows[i].by_behind, at(&slip, place.wrapping_add_signed(behind))),
                ];
                for (component, out) in out.iter().enumerate() {
                    let exact: f64 = terms.iter().map(|term| term[component]).sum();
                    // Single precision.
                    assert!((f64::from(out[i]) - exact).abs() < 1e-6, "{i}: {} {exact}", out[i]);
                }
            }
        }
    }
}
