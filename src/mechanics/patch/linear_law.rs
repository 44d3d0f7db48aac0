//! The linearised law of the cells in single precision, each coefficient an array of its own: what the corrections of Newton's method
//! multiply with and invert. Neighbouring cells then go through one vector instruction.

use super::contact::Contact;
use super::law_arrays::{Components, LawArrays, SpeedArrays};
use crate::body::grid::Grid;
use crate::numerics::dense;
use crate::numerics::single::{WIDTH, wide, wide_mut};

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

/// Magnitude of the cells' slip, linearised, in single precision.
#[derive(Debug, Clone)]
pub struct LinearSpeed {
    /// Derivatives by the cell's own shear: what the leading edge adds to its slip.
    by_shear: [Vec<f32>; 2],
    /// Derivatives by the slip ahead, without what the leading edge adds.
    by_ahead: [Vec<f32>; 2],
    /// Derivatives by the slip behind.
    by_behind: [Vec<f32>; 2],
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
    /// Law of up to so many cells, and values for a vector register beyond them.
    pub fn new(cells: usize) -> LinearLaw {
        let zero = || std::array::from_fn(|_| std::array::from_fn(|_| vec![0.0; cells + WIDTH]));
        LinearLaw {
            by_shear: zero(),
            by_ahead: zero(),
            by_behind: zero(),
        }
    }

    /// Takes the law of so many cells. `edge` is the slip per shear that the leading edge adds to a cell.
    pub fn take(&mut self, law: &LawArrays, edge: &Components, cells: usize) {
        dense::vectorised(
            #[inline(always)]
            |_| {
                for i in 0..2 {
                    for (j, edge) in edge.iter().enumerate() {
                        let (shear, ahead) = (&law.by_shear[i][j][..cells], &law.by_ahead[i][j][..cells]);
                        let sums = shear.iter().zip(ahead).zip(edge);
                        for (out, ((shear, ahead), edge)) in self.by_shear[i][j].iter_mut().zip(sums) {
                            *out = (shear + ahead * edge) as f32;
                        }
                        for (out, ahead) in self.by_ahead[i][j].iter_mut().zip(ahead) {
                            *out = *ahead as f32;
                        }
                        for (out, behind) in self.by_behind[i][j].iter_mut().zip(&law.by_behind[i][j][..cells]) {
                            *out = *behind as f32;
                        }
                    }
                }
            },
        );
    }

    /// Writes the change of the residual of all cells, along x and y, and values without meaning for a vector register beyond them.
    pub fn multiply(&self, contact: &Contact, grid: &Grid, change: &Change, out: [&mut [f32]; 2]) {
        for (component, out) in out.into_iter().enumerate() {
            let by = [&self.by_shear, &self.by_ahead, &self.by_behind].map(|by| &by[component]);
            multiply_row(by, contact, grid, change, out);
        }
    }
}

impl LinearSpeed {
    /// Slip of up to so many cells, and values for a vector register beyond them.
    pub fn new(cells: usize) -> LinearSpeed {
        let zero = || std::array::from_fn(|_| vec![0.0; cells + WIDTH]);
        LinearSpeed {
            by_shear: zero(),
            by_ahead: zero(),
            by_behind: zero(),
        }
    }

    /// Takes the derivatives of so many cells, as [`LinearLaw::take`] does.
    pub fn take(&mut self, speeds: &SpeedArrays, edge: &Components, cells: usize) {
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (j, edge) in edge.iter().enumerate() {
                    let (ahead, behind) = (&speeds.by_ahead[j][..cells], &speeds.by_behind[j][..cells]);
                    for (out, (ahead, edge)) in self.by_shear[j].iter_mut().zip(ahead.iter().zip(edge)) {
                        *out = (ahead * edge) as f32;
                    }
                    for (out, ahead) in self.by_ahead[j].iter_mut().zip(ahead) {
                        *out = *ahead as f32;
                    }
                    for (out, behind) in self.by_behind[j].iter_mut().zip(behind) {
                        *out = *behind as f32;
                    }
                }
            },
        );
    }

    /// Writes the change of all cells, and values without meaning for a vector register beyond them.
    pub fn multiply(&self, contact: &Contact, grid: &Grid, change: &Change, out: &mut [f32]) {
        let by = [&self.by_shear, &self.by_ahead, &self.by_behind];
        multiply_row(by, contact, grid, change, out);
    }
}

/// The change of one quantity of all cells by its derivatives by shear, slip ahead and slip behind.
fn multiply_row(by: [&[Vec<f32>; 2]; 3], contact: &Contact, grid: &Grid, change: &Change, out: &mut [f32]) {
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
                    for component in 0..2 {
                        let slip = change.slip[component];
                        let changes = [
                            wide(change.shear[component], cell),
                            wide(slip, ahead + k),
                            wide(slip, behind + k),
                        ];
                        for (by, change) in by.into_iter().zip(changes) {
                            let by = wide(&by[component], cell);
                            for lane in 0..WIDTH {
                                sum[lane] = fma.multiply_add_single(by[lane], change[lane], sum[lane]);
                            }
                        }
                    }
                    *wide_mut(out, cell) = sum;
                }
            }
        },
    );
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
