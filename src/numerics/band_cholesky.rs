//! The Cholesky factor of a band matrix, and its solve for many right-hand sides at once.
//!
//! A mesh that is numbered column by column couples each node to the next column and no further: its stiffness has its entries within a band
//! about the diagonal, and so has the factor L of A = L Lᵀ. What lies within the band is computed, zeros among it.

use super::dense::{self, MultiplyAdd, QUAD};

/// A symmetric positive definite matrix of which the lower triangle has entries within `width` below the diagonal, or its factor L.
#[derive(Debug)]
pub struct Band {
    n: usize,
    width: usize,
    /// Columns one after the other, each from the diagonal down, behind each as many zeros as let [`QUAD`] columns reach equally far down.
    values: Vec<f64>,
}

impl Band {
    /// The zero matrix with n rows.
    pub fn new(n: usize, width: usize) -> Band {
        let mut band = Band {
            n,
            width,
            values: Vec::new(),
        };
        band.values = vec![0.0; n * band.stride()];
        band
    }

    fn stride(&self) -> usize {
        self.width + QUAD
    }

    /// Adds to an entry of the lower triangle.
    ///
    /// # Panics
    /// If the entry lies outside the band.
    pub fn add(&mut self, row: usize, column: usize, value: f64) {
        assert!(row - column <= self.width, "({row}, {column}) is outside the band");
        let place = column * self.stride() + row - column;
        self.values[place] += value;
    }

    /// Replaces the matrix by its factor, column by column: less the columns before that reach down to it, times their entries in its row, over
    /// the root of its diagonal. `None` where that is not positive.
    pub fn factorised(mut self) -> Option<Band> {
        let (n, width, stride) = (self.n, self.width, self.stride());
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for column in 0..n {
                    let (before, rest) = self.values.split_at_mut(column * stride);
                    let own = &mut rest[..=width];
                    // Of a column before, from this row down.
                    let from = |other: usize| &before[other * stride + column - other..(other + 1) * stride];
                    let mut other = column.saturating_sub(width);
                    while other + QUAD <= column {
                        let four = [from(other), from(other + 1), from(other + 2), from(other + 3)];
                        let reach = width + other + QUAD - column;
                        let four = four.map(|values| &values[..reach.min(values.len())]);
                        arithmetic.add_quad(four, four.map(|values| -values[0]), &mut own[..reach]);
                        other += QUAD;
                    }
                    for other in other..column {
                        let values = &from(other)[..=width + other - column];
                        arithmetic.add_multiple(values, -values[0], &mut own[..values.len()]);
                    }
                    if own[0].is_nan() || own[0] <= 0.0 {
                        return None;
                    }
                    let scale = 1.0 / own[0].sqrt();
                    own.iter_mut().for_each(|value| *value *= scale);
                }
                Some(())
            },
        )?;
        Some(self)
    }

    /// Solves A X = B in place with the factor: forward with L, backward with Lᵀ. Where there are many right-hand sides, 32 at a time are
    /// quickest: eight vector registers of AVX2.
    pub fn solve_in_place<const SIDES: usize>(&self, rows: &mut [[f64; SIDES]]) {
        let (n, width, stride) = (self.n, self.width, self.stride());
        // What is above the first load stays 0.
        let first = rows
            .iter()
            .position(|row| row.iter().any(|&value| value != 0.0))
            .unwrap_or(n);
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for row in first..n {
                    let mut sum = rows[row];
                    let start = row.saturating_sub(width).max(first);
                    for (column, solved) in (start..).zip(&rows[start..row]) {
                        subtract(
                            arithmetic,
                            &mut sum,
                            self.values[column * stride + row - column],
                            solved,
                        );
                    }
                    rows[row] = sum.map(|value| value / self.values[row * stride]);
                }
                for row in (0..n).rev() {
                    let own = &self.values[row * stride..][..=width];
                    let mut sum = rows[row];
                    for (factor, below) in own[1..].iter().zip(&rows[row + 1..]) {
                        subtract(arithmetic, &mut sum, *factor, below);
                    }
                    rows[row] = sum.map(|value| value / own[0]);
                }
            },
        );
    }
}

#[inline(always)]
fn subtract<const SIDES: usize>(arithmetic: MultiplyAdd, sum: &mut [f64; SIDES], factor: f64, row: &[f64; SIDES]) {
    for (sum, value) in sum.iter_mut().zip(row) {
        *sum = arithmetic.multiply_add(-factor, *value, *sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// A matrix that is dominated by its diagonal, some of its entries 0, and the same as a band.
    fn matrix(n: usize, width: usize) -> (DMatrix<f64>, Band) {
        let (mut matrix, mut band) = (DMatrix::zeros(n, n), Band::new(n, width));
        for column in 0..n {
            for row in column..n.min(column + width + 1) {
                let value = if row == column {
                    2.0 * width as f64 + 1.0
                } else {
                    ((7 * row + 13 * column) % 11) as f64 / 5.0 - 1.0
                };
                matrix[(row, column)] = value;
                matrix[(column, row)] = value;
                // In two parts, as of two elements.
                band.add(row, column, 0.25 * value);
                band.add(row, column, 0.75 * value);
            }
        }
        (matrix, band)
    }

    /// Compares solutions with those of the whole matrix: bands narrower than a quad of columns and wider, and of fewer rows than that.
    #[test]
    fn the_solution_is_that_of_the_whole_matrix() {
        for (n, width) in [(1, 0), (3, 5), (17, 1), (40, 3), (61, 4), (90, 13), (200, 83)] {
            let (whole, band) = matrix(n, width);
            let factor = band.factorised().unwrap();
            let mut rows = vec![[0.0; 5]; n];
            // The loads of a field begin at some row, as those of a mesh do.
            let right = |row: usize, field: usize| {
                if row < n / 3 {
                    0.0
                } else {
                    ((3 * row + field) % 7) as f64 - 3.0
                }
            };
            for (row, values) in rows.iter_mut().enumerate() {
                *values = std::array::from_fn(|field| right(row, field));
            }
            factor.solve_in_place(&mut rows);
            let expected = whole.cholesky().unwrap().solve(&DMatrix::from_fn(n, 5, right));
            for row in 0..n {
                for field in 0..5 {
                    let (found, expected) = (rows[row][field], expected[(row, field)]);
                    assert!((found - expected).abs() < 1e-13, "{n} {width}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn an_indefinite_matrix_is_refused() {
        let mut band = Band::new(2, 1);
        for (row, column, value) in [(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)] {
            band.add(row, column, value);
        }
        assert!(band.factorised().is_none());
        let mut band = Band::new(1, 0);
        band.add(0, 0, f64::NAN);
        assert!(band.factorised().is_none());
    }
}
