//! The friction law of each strip by itself, factorised: the preconditioner of the law of all strips together.
//!
//! What a strip does to itself is nearly all that is stiff; what the others do to it is smooth along it. In single precision,
//! which is as much as a preconditioner is good for, and twice as fast.

use super::contact::Contact;
use super::law::Row;
use crate::numerics::single;

/// The strip's own response of the slip: along and across, by the lag along x; the lag 0 is at `origin`.
#[derive(Debug, Clone, Copy)]
pub struct OwnResponse<'a> {
    /// Slip along x per shear along x.
    pub along: &'a [f32],
    /// Slip along y per shear along y.
    pub across: &'a [f32],
    /// Place of lag 0.
    pub origin: usize,
    /// Lag of the slip behind: −1 for V ≥ 0, 1 else.
    pub behind: isize,
}

/// The factorised blocks.
#[derive(Debug, Clone)]
pub struct Blocks {
    factors: Vec<f32>,
    pivots: Vec<usize>,
    /// Of each run: its unknowns among all, its factors.
    places: Vec<(usize, usize, usize)>,
    values: Vec<f32>,
}

impl Blocks {
    /// For strips of up to `cells` cells, `total` cells in all.
    pub fn new(cells: usize, total: usize) -> Blocks {
        Blocks {
            factors: vec![0.0; 4 * cells * total],
            pivots: vec![0; 2 * total],
            places: Vec::with_capacity(total),
            values: vec![0.0; 2 * cells],
        }
    }

    /// Factorises the law's rows. `edge` is what the leading edge adds to the slip of a cell per its own shear, along x and y. False
    /// where a block is singular.
    pub fn factorise(&mut self, contact: &Contact, rows: &[Row], edge: &[[f64; 2]], response: &OwnResponse) -> bool {
        self.places.clear();
        let mut start = 0;
        for run in contact.runs() {
            let n = run.cells;
            let size = 2 * n;
            let rows = &rows[run.own()];
            let block = &mut self.factors[start..start + size * size];
            for (column, edge) in (0..n).zip(&edge[run.own()]) {
                for component in 0..2 {
                    let table = [response.along, response.across][component];
                    let entries = &mut block[(component * n + column) * size..][..size];
                    let (first, second) = entries.split_at_mut(n);
                    for (line, (row, (first, second))) in
                        rows.iter().zip(first.iter_mut().zip(second.iter_mut())).enumerate()
                    {
                        let lag = response.origin + line - column;
                        let ahead = f64::from(table[lag]);
                        let behind = f64::from(table[lag.wrapping_add_signed(response.behind)]);
                        *first = (row.by_ahead[0][component] * ahead + row.by_behind[0][component] * behind) as f32;
                        *second = (row.by_ahead[1][component] * ahead + row.by_behind[1][component] * behind) as f32;
                    }
                    let row = &rows[column];
                    first[column] += (row.by_shear[0][component] + row.by_ahead[0][component] * edge[component]) as f32;
                    second[column] +=
                        (row.by_shear[1][component] + row.by_ahead[1][component] * edge[component]) as f32;
                }
            }
            if !single::lu(block, size, &mut self.pivots[2 * run.offset..]) {
                return false;
            }
            self.places.push((run.offset, n, start));
            start += size * size;
        }
        true
    }

    /// Solves with the blocks, in place: the x components of all cells, then their y components.
    pub fn solve(&mut self, values: &mut [f32]) {
        let (x, y) = values.split_at_mut(values.len() / 2);
        for &(offset, n, start) in &self.places {
            let own = &mut self.values[..2 * n];
            own[..n].copy_from_slice(&x[offset..offset + n]);
            own[n..].copy_from_slice(&y[offset..offset + n]);
            single::lu_solve(&self.factors[start..], 2 * n, &self.pivots[2 * offset..], own);
            x[offset..offset + n].copy_from_slice(&own[..n]);
            y[offset..offset + n].copy_from_slice(&own[n..]);
        }
    }
}
