//! The friction law of each strip by itself, inverted: the preconditioner of the law of all strips together.
//!
//! What a strip does to itself is nearly all that is stiff; what the others do to it is smooth along it. In single precision,
//! which is as much as a preconditioner is good for, and twice as fast.

use super::contact::Contact;
use super::linear_law::LinearLaw;
use crate::numerics::single::{WIDTH, padded, wide, wide_mut};
use crate::numerics::{dense, inverse};

/// Response of the slip of a strip to its own shear: along and across, by the lag along x; the lag 0 is at `origin`. There are values for
/// a vector register beyond the largest lag.
#[derive(Debug, Clone, Copy)]
pub struct StripResponse<'a> {
    /// Slip along x per shear along x.
    pub along: &'a [f32],
    /// Slip along y per shear along y.
    pub across: &'a [f32],
    /// Place of lag 0.
    pub origin: usize,
    /// Lag of the slip behind: −1 for V ≥ 0, 1 else.
    pub behind: isize,
}

/// Inverse blocks of the strips' runs.
#[derive(Debug, Clone)]
pub struct Blocks {
    inverses: Vec<f32>,
    places: Vec<Place>,
    given: Vec<f32>,
    solved: Vec<f32>,
    /// Scratch of an inversion.
    scratch: Vec<f32>,
}

/// Place of a run.
#[derive(Debug, Clone)]
struct Place {
    /// First of its cells among all.
    first: usize,
    /// Number of its cells.
    cells: usize,
    /// First value of its inverse.
    inverse: usize,
}

impl Blocks {
    /// Blocks for strips of up to `cells` cells, `total` cells in all.
    pub fn new(cells: usize, total: usize) -> Blocks {
        // As much as runs of any lengths can take: one of a cell is padded more than a long one.
        let strips = total.div_ceil(cells.max(1));
        let (whole, single) = (padded(2 * cells), padded(2));
        let of_strip = (whole * whole).max(single * single * cells.div_ceil(2));
        Blocks {
            inverses: vec![0.0; strips * of_strip + WIDTH],
            places: Vec::with_capacity(total),
            given: vec![0.0; whole],
            solved: vec![0.0; whole],
            scratch: vec![0.0; inverse::scratch_len(2 * cells)],
        }
    }

    /// Inverts the law of each run. False where a block is singular.
    /// The dependence of a cell's μ on the slip of the cells before it is left out: it would take more time than the iterations that it
    /// would save.
    pub fn invert(&mut self, contact: &Contact, law: &LinearLaw, response: &StripResponse) -> bool {
        self.places.clear();
        let mut first = 0;
        for run in contact.runs() {
            let n = 2 * run.cells;
            let size = padded(n);
            let block = &mut self.inverses[first..first + size * size + WIDTH];
            assemble(law, run.offset, run.cells, response, block);
            if !inverse::invert(&mut block[..size * size], n, &mut self.scratch) {
                return false;
            }
            self.places.push(Place {
                first: run.offset,
                cells: run.cells,
                inverse: first,
            });
            first += size * size;
        }
        true
    }

    /// Solves with the blocks, in place: the x components of all cells, then their y components.
    pub fn solve(&mut self, values: &mut [f32]) {
        let (x, y) = values.split_at_mut(values.len() / 2);
        for place in &self.places {
            let (n, cells) = (place.cells, place.first..place.first + place.cells);
            let given = &mut self.given[..2 * n];
            given[..n].copy_from_slice(&x[cells.clone()]);
            given[n..].copy_from_slice(&y[cells.clone()]);
            let solved = &mut self.solved[..padded(2 * n)];
            inverse::multiply(&self.inverses[place.inverse..], given, solved);
            x[cells.clone()].copy_from_slice(&solved[..n]);
            y[cells].copy_from_slice(&solved[n..2 * n]);
        }
    }
}

/// Writes the block of a run of `n` cells from cell `first` on: the x components of all of them, then their y components.
/// `block` has values for a vector register beyond it.
fn assemble(law: &LinearLaw, first: usize, n: usize, response: &StripResponse, block: &mut [f32]) {
    let kernels = [response.along, response.across];
    dense::vectorised(
        #[inline(always)]
        |fma| {
            let size = padded(2 * n);
            for number in 0..2 * n {
                let (component, column) = (number / n, number % n);
                // The lag of the first line; those of the others follow.
                let ahead = response.origin - column;
                let behind = ahead.wrapping_add_signed(response.behind);
                let entries = &mut block[number * size..];
                // By whole registers: what one of them writes beyond its part, the next part overwrites, and the next column.
                for residual in 0..2 {
                    let by_ahead = &law.rows[residual].by_ahead[component];
                    let by_behind = &law.rows[residual].by_behind[component];
                    let entries = &mut entries[residual * n..];
                    for line in (0..n).step_by(WIDTH) {
                        let (by_ahead, by_behind) = (wide(by_ahead, first + line), wide(by_behind, first + line));
                        let ahead = wide(kernels[component], ahead + line);
                        let behind = wide(kernels[component], behind + line);
                        // A sum of its own: the compiler does not know that the entries are none of what is read.
                        let mut sum = [0.0; WIDTH];
                        for lane in 0..WIDTH {
                            sum[lane] = by_behind[lane] * behind[lane];
                        }
                        for lane in 0..WIDTH {
                            sum[lane] = fma.multiply_add_single(by_ahead[lane], ahead[lane], sum[lane]);
                        }
                        *wide_mut(entries, line) = sum;
                    }
                    entries[column] += law.rows[residual].by_shear[component][first + column];
                }
                *wide_mut(entries, 2 * n) = [0.0; WIDTH];
            }
            let block = &mut block[..size * size];
            for (number, entries) in block.chunks_exact_mut(size).enumerate().skip(2 * n) {
                entries.fill(0.0);
                entries[number] = 1.0;
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::grid::Grid;
    use crate::mechanics::patch::law::{CellLawRow, Vector};
    use crate::mechanics::patch::law_arrays::tests::arrays;
    use nalgebra::{DMatrix, DVector};

    const CELLS: usize = 9;
    const STRIPS: usize = 4;

    /// Runs of different lengths, one of a single cell.
    fn contact() -> Contact {
        let grid = Grid::new(CELLS, STRIPS, 1.0, 1.0);
        let inside = ["001111100", "000000000", "011010110", "111111111"];
        let mut contact = Contact::new(&grid);
        contact.list(&grid, |place| {
            let (strip, cell) = (place / grid.stride(), place % grid.stride());
            inside[strip].as_bytes()[cell] == b'1'
        });
        contact
    }

    /// Slip along and across at so many cells ahead of a shear there.
    fn kernel(component: usize, lag: isize) -> f64 {
        let x = lag as f64;
        [1.0, 0.8][component] * (-0.3 * x * x).exp() + [0.04, -0.03][component] * x / (1.0 + x * x)
    }

    /// Rows without any structure.
    fn rows(cells: usize) -> Vec<CellLawRow> {
        let wave = |i: usize, k: usize| (1.3 * i as f64 + 2.1 * k as f64).sin();
        let matrix = |i: usize, k: usize, unit: f64| {
            [
                [unit + 0.2 * wave(i, k), 0.2 * wave(i, k + 1)],
                [0.2 * wave(i, k + 2), unit + 0.2 * wave(i, k + 3)],
            ]
        };
        (0..cells)
            .map(|i| CellLawRow {
                by_shear: matrix(i, 0, 0.7),
                by_ahead: matrix(i, 4, 1.0),
                by_behind: matrix(i, 8, -0.2),
                ..CellLawRow::default()
            })
            .collect()
    }

    fn law(rows: &[CellLawRow], edge: &[Vector]) -> LinearLaw {
        let mut law = LinearLaw::new(rows.len());
        let (rows_of_all, edges) = arrays(rows, edge);
        law.take(&rows_of_all, &edges, rows.len());
        law
    }

    /// by_shear + by_ahead (T + edge) + by_behind T′ of one run, T′ that of the cells behind: x components first.
    fn dense(rows: &[CellLawRow], edge: &[[f64; 2]], behind: isize) -> DMatrix<f64> {
        let n = rows.len();
        DMatrix::from_fn(2 * n, 2 * n, |line, column| {
            let ((i, line), (j, component)) = ((line % n, line / n), (column % n, column / n));
            let (lag, row) = (i as isize - j as isize, &rows[i]);
            let own = if i == j { 1.0 } else { 0.0 };
            own * row.by_shear[line][component]
                + row.by_ahead[line][component] * (kernel(component, lag) + own * edge[i][component])
                + row.by_behind[line][component] * kernel(component, lag + behind)
        })
    }

    /// Each run by itself is solved as its whole matrix in double precision is, for either direction of travel.
    #[test]
    fn the_blocks_solve_each_run() {
        let contact = contact();
        let n = contact.cells();
        let rows = rows(n);
        let edge: Vec<[f64; 2]> = (0..n).map(|i| [0.3 * (i % 3) as f64, 0.1 * (i % 2) as f64]).collect();
        let origin = CELLS + 1;
        let table = |component: usize| -> Vec<f32> {
            (0..2 * origin + WIDTH)
                .map(|place| kernel(component, place as isize - origin as isize) as f32)
                .collect()
        };
        let (along, across) = (table(0), table(1));
        let right: Vec<f32> = (0..2 * n).map(|i| (0.9 * i as f64).cos() as f32).collect();
        for behind in [-1, 1] {
            let response = StripResponse {
                along: &along,
                across: &across,
                origin,
                behind,
            };
            let mut blocks = Blocks::new(CELLS, CELLS * STRIPS);
            assert!(blocks.invert(&contact, &law(&rows, &edge), &response));
            let mut solved = right.clone();
            blocks.solve(&mut solved);
            for run in contact.runs() {
                let own = || run.indices().chain(run.indices().map(|cell| n + cell));
                let matrix = dense(&rows[run.indices()], &edge[run.indices()], behind);
                let values: Vec<f64> = own().map(|place| f64::from(right[place])).collect();
                let exact = matrix.lu().solve(&DVector::from_vec(values)).unwrap();
                for (place, exact) in own().zip(exact.iter()) {
                    // Single precision, and a condition of some tens.
                    assert!(
                        (f64::from(solved[place]) - exact).abs() < 1e-5 * exact.abs().max(1.0),
                        "{behind} {place}: {} {exact}",
                        solved[place]
                    );
                }
            }
        }
    }

    #[test]
    fn a_singular_block_is_refused() {
        let contact = contact();
        let n = contact.cells();
        let zero = vec![0.0; 2 * (CELLS + 1) + WIDTH];
        let response = StripResponse {
            along: &zero,
            across: &zero,
            origin: CELLS + 1,
            behind: -1,
        };
        let mut rows = rows(n);
        // Of one cell that sticks without compliance.
        rows[n - 1].by_shear = [[0.0; 2]; 2];
        let mut blocks = Blocks::new(CELLS, CELLS * STRIPS);
        assert!(!blocks.invert(&contact, &law(&rows, &vec![[0.0; 2]; n]), &response));
    }
}
