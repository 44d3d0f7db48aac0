//! Inverses of small matrices in single precision, for preconditioners; column-major.
//!
//! A product with an inverse reads as many values as a solution with factors, but no sum in it waits for another one, as the sums of
//! a triangular solution do. That makes it the faster one.

use super::dense::{self, MultiplyAdd};
use super::single::{WIDTH, Wide, padded, wide, wide_mut};

/// Columns that share what is read of a panel: with two registers of each, their sums fill half of the registers.
const GROUP: usize = 4;

/// Share of the largest entry of a block on the diagonal that a pivot has at least: a smaller one is replaced by it. That loses
/// up to four of the seven digits, and changes the matrix by no more than a preconditioner may be off.
const LEAST_PIVOT: f32 = 1e-4;

/// Rows of the unit matrix.
const UNIT: [Wide; WIDTH] = {
    let mut unit = [[0.0; WIDTH]; WIDTH];
    let mut k = 0;
    while k < WIDTH {
        unit[k][k] = 1.0;
        k += 1;
    }
    unit
};

/// Number of values of scratch that the inversion of a matrix of `n` rows takes.
pub const fn scratch_len(n: usize) -> usize {
    WIDTH * padded(n)
}

/// Inverts a matrix of `n` rows in place, padded to whole registers with a unit matrix; of the inverse, the first `n` columns count. False where
/// a column of a block of eight on its diagonal is 0, or no number. `scratch` has [`scratch_len`] values.
///
/// Gauss and Jordan's elimination by panels of eight columns. Rows are not exchanged: the friction law of a strip has its largest
/// entries on the diagonal.
pub fn invert(matrix: &mut [f32], n: usize, scratch: &mut [f32]) -> bool {
    let rows = padded(n);
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for first in (0..rows).step_by(WIDTH) {
                let (before, rest) = matrix.split_at_mut(first * rows);
                let (panel, after) = rest.split_at_mut(WIDTH * rows);
                // Columns of the padding have 0 in the rows of other panels: eliminating these changes nothing there.
                let after_inside = n.next_multiple_of(GROUP).saturating_sub(first + WIDTH);
                let after = &mut after[..after_inside * rows];
                let mut block = [[0.0; WIDTH]; WIDTH];
                for (column, block) in panel.chunks_exact(rows).zip(&mut block) {
                    *block = *wide(column, first);
                }
                if !invert_block(fma, &mut block) {
                    return false;
                }
                for columns in [before, after] {
                    eliminate(fma, &block, panel, first, columns, scratch);
                }
                for row in (0..rows).step_by(WIDTH).filter(|&row| row != first) {
                    let mut sums = [[0.0; WIDTH]; WIDTH];
                    for (k, column) in panel.chunks_exact(rows).enumerate() {
                        let values = wide(column, row);
                        for (sum, block) in sums.iter_mut().zip(&block) {
                            add_multiple(fma, values, -block[k % WIDTH], sum);
                        }
                    }
                    for (column, sum) in panel.chunks_exact_mut(rows).zip(&sums) {
                        *wide_mut(column, row) = *sum;
                    }
                }
                for (column, block) in panel.chunks_exact_mut(rows).zip(&block) {
                    *wide_mut(column, first) = *block;
                }
            }
            true
        },
    )
}

/// Multiplies an inverse with `x`, of as many values as columns count; `out` has as many as the inverse has rows.
pub fn multiply(inverse: &[f32], x: &[f32], out: &mut [f32]) {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            let rows = out.len();
            let mut row = 0;
            while row + 4 * WIDTH <= rows {
                multiply_rows::<4>(fma, inverse, rows, row, x, out);
                row += 4 * WIDTH;
            }
            while row + 2 * WIDTH <= rows {
                multiply_rows::<2>(fma, inverse, rows, row, x, out);
                row += 2 * WIDTH;
            }
            if row < rows {
                multiply_rows::<1>(fma, inverse, rows, row, x, out);
            }
        },
    );
}

/// Writes some registers of a product's rows. Two sums each: one would wait for itself.
#[inline(always)]
fn multiply_rows<const REGISTERS: usize>(
    fma: MultiplyAdd,
    inverse: &[f32],
    rows: usize,
    row: usize,
    x: &[f32],
    out: &mut [f32],
) {
    let mut sums = [[[0.0; WIDTH]; REGISTERS]; 2];
    let (pairs, odd) = x.as_chunks::<2>();
    for (columns, x) in inverse.chunks_exact(2 * rows).zip(pairs) {
        for (half, (sums, x)) in sums.iter_mut().zip(x).enumerate() {
            for (register, sum) in sums.iter_mut().enumerate() {
                add_multiple(fma, wide(columns, half * rows + row + register * WIDTH), *x, sum);
            }
        }
    }
    if let [x] = odd {
        let column = &inverse[(2 * pairs.len()) * rows..];
        for (register, sum) in sums[0].iter_mut().enumerate() {
            add_multiple(fma, wide(column, row + register * WIDTH), *x, sum);
        }
    }
    let [even, odd] = &sums;
    for (register, (even, odd)) in even.iter().zip(odd).enumerate() {
        let out = wide_mut(out, row + register * WIDTH);
        for lane in 0..WIDTH {
            out[lane] = even[lane] + odd[lane];
        }
    }
}

/// Adds a multiple: `sum += factor · x`. By index: of two iterators over arrays the compiler makes slower code here.
#[inline(always)]
fn add_multiple(fma: MultiplyAdd, x: &Wide, factor: f32, sum: &mut Wide) {
    for lane in 0..WIDTH {
        sum[lane] = fma.multiply_add_single(factor, x[lane], sum[lane]);
    }
}

/// Inverts a block on the diagonal by Gauss and Jordan's elimination. A step takes the pivot's column, with its sign turned and 1 in
/// place of the pivot, and adds it to every column, times that column's entry in the pivot's row over the pivot.
#[inline(always)]
fn invert_block(fma: MultiplyAdd, block: &mut [Wide; WIDTH]) -> bool {
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let largest = block.as_flattened().iter().fold(0.0, |m, value| larger(value.abs(), m));
    let least = LEAST_PIVOT * largest;
    let mut regular = true;
    for (k, unit) in UNIT.iter().enumerate() {
        let own = block[k];
        let pivot = own[k];
        regular &= own != [0.0; WIDTH] && !pivot.is_nan();
        let inverse = if pivot.abs() > least {
            1.0 / pivot
        } else {
            (1.0 / least).copysign(pivot)
        };
        let (mut others, mut change) = ([0.0; WIDTH], [0.0; WIDTH]);
        for lane in 0..WIDTH {
            others[lane] = 1.0 - unit[lane];
            change[lane] = unit[lane] - others[lane] * own[lane];
        }
        block[k] = *unit;
        for column in block.iter_mut() {
            let share = column[k] * inverse;
            for lane in 0..WIDTH {
                column[lane] = fma.multiply_add_single(share, change[lane], others[lane] * column[lane]);
            }
        }
    }
    regular
}

/// Eliminates a panel, the inverse of whose block on the diagonal is `block`, from other columns: their values in the panel's rows are
/// multiplied with that block; the panel's other rows, multiplied with what this gives, are taken off the columns' other rows. `reduced` is
/// scratch for it, with the sign turned.
#[inline(always)]
fn eliminate(
    fma: MultiplyAdd,
    block: &[Wide; WIDTH],
    panel: &[f32],
    first: usize,
    columns: &mut [f32],
    reduced: &mut [f32],
) {
    let rows = panel.len() / WIDTH;
    for (column, reduced) in columns.chunks_exact_mut(rows).zip(reduced.as_chunks_mut::<WIDTH>().0) {
        let values = wide_mut(column, first);
        let mut sum = [0.0; WIDTH];
        for k in 0..WIDTH {
            add_multiple(fma, &block[k], values[k], &mut sum);
        }
        *values = sum;
        for (reduced, sum) in reduced.iter_mut().zip(sum) {
            *reduced = -sum;
        }
    }
    for range in [0..first, first + WIDTH..rows] {
        let mut row = range.start;
        while row + 2 * WIDTH <= range.end {
            update_rows::<2>(fma, panel, row, columns, reduced);
            row += 2 * WIDTH;
        }
        if row < range.end {
            update_rows::<1>(fma, panel, row, columns, reduced);
        }
    }
}

/// Adds the product of some registers of a panel's rows with what [`eliminate`] has `reduced` to other columns.
#[inline(always)]
fn update_rows<const REGISTERS: usize>(
    fma: MultiplyAdd,
    panel: &[f32],
    row: usize,
    columns: &mut [f32],
    reduced: &[f32],
) {
    let rows = panel.len() / WIDTH;
    let groups = reduced.as_chunks::<{ GROUP * WIDTH }>().0;
    for (columns, reduced) in columns.chunks_exact_mut(GROUP * rows).zip(groups) {
        let mut sums = [[[0.0; WIDTH]; GROUP]; REGISTERS];
        for (register, sums) in sums.iter_mut().enumerate() {
            for (c, sum) in sums.iter_mut().enumerate() {
                *sum = *wide(columns, c * rows + row + register * WIDTH);
            }
        }
        for (k, panel) in panel.chunks_exact(rows).enumerate() {
            // The remainder tells the compiler that the index is in range. A loop over 0..WIDTH would tell it too, but that one it unrolls,
            // reads all values at once, and has no registers for them.
            let k = k % WIDTH;
            for (register, sums) in sums.iter_mut().enumerate() {
                let values = wide(panel, row + register * WIDTH);
                for (c, sum) in sums.iter_mut().enumerate() {
                    add_multiple(fma, values, reduced[c * WIDTH + k], sum);
                }
            }
        }
        for (register, sums) in sums.iter().enumerate() {
            for (c, sum) in sums.iter().enumerate() {
                *wide_mut(columns, c * rows + row + register * WIDTH) = *sum;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DMatrix;

    /// A matrix whose largest entries are on its diagonal, padded.
    fn matrix(n: usize) -> Vec<f32> {
        let rows = padded(n);
        let mut matrix = vec![0.0; rows * rows];
        for (column, values) in matrix.chunks_exact_mut(rows).enumerate() {
            for (row, value) in values.iter_mut().enumerate() {
                let own = if row == column { 1.0 } else { 0.0 };
                let wave = ((row * 7 + column * column + 1) as f32 * 0.37).sin();
                *value = if row < n && column < n {
                    0.3 * wave + 2.0 * own
                } else {
                    own
                };
            }
        }
        matrix
    }

    fn inside(matrix: &[f32], n: usize) -> DMatrix<f64> {
        DMatrix::from_fn(n, n, |row, column| f64::from(matrix[column * padded(n) + row]))
    }

    #[test]
    fn the_inverse_is_that_of_double_precision() {
        for n in [1, 2, 5, 8, 13, 17, 28, 40, 44] {
            let mut inverse = matrix(n);
            let exact = inside(&inverse, n).try_inverse().unwrap();
            assert!(invert(&mut inverse, n, &mut vec![0.0; scratch_len(n)]));
            let off = (inside(&inverse, n) - &exact).amax();
            // Single precision, times a condition of some tens.
            assert!(off < 1e-5 * exact.amax(), "{n}: {off:e}");
            let x: Vec<f32> = (0..n).map(|i| 1.0 + (i % 5) as f32).collect();
            let mut product = vec![f32::NAN; padded(n)];
            multiply(&inverse, &x, &mut product);
            for (row, product) in product[..n].iter().enumerate() {
                let exact: f64 = (0..n).map(|column| exact[(row, column)] * f64::from(x[column])).sum();
                assert!(
                    (f64::from(*product) - exact).abs() < 1e-5 * exact.abs().max(1.0),
                    "{n} {row}: {product} {exact}"
                );
            }
            assert!(product[n..].iter().all(|&padding| padding == 0.0));
        }
    }

    /// A pivot of 0 is replaced by a small one, and the inverse is off by as much; a block with a column of zeros is refused, and one that is
    /// no number.
    #[test]
    fn a_pivot_of_zero_is_replaced() {
        let swap = |n: usize| {
            let mut values = matrix(n);
            values[0] = 0.0;
            values
        };
        let n = 8;
        let mut inverse = swap(n);
        let exact = inside(&inverse, n).try_inverse().unwrap();
        assert!(invert(&mut inverse, n, &mut [0.0; WIDTH * WIDTH]));
        let off = (inside(&inverse, n) - &exact).amax();
        // The change of the matrix, and the digits that the small pivot loses, times a condition of some tens.
        assert!(off < 30.0 * f64::from(LEAST_PIVOT) * exact.amax(), "{off:e}");
        let mut values = matrix(n);
        values[3 * WIDTH..4 * WIDTH].fill(0.0);
        assert!(!invert(&mut values, n, &mut [0.0; WIDTH * WIDTH]));
        let mut values = swap(n);
        values[9] = f32::NAN;
        assert!(!invert(&mut values, n, &mut [0.0; WIDTH * WIDTH]));
    }
}
