//! Dense kernels in single precision, for preconditioners and the Krylov method around them; column-major.

use super::dense::{self, MultiplyAdd};

/// Interleaved partial sums: two vector registers of AVX2.
const LANES: usize = 16;

/// Scalar product Σ x y.
pub fn dot(x: &[f32], y: &[f32]) -> f32 {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            let mut sums = [0.0_f32; LANES];
            let (x_blocks, x_rest) = x.as_chunks::<LANES>();
            let (y_blocks, y_rest) = y.as_chunks::<LANES>();
            for (x, y) in x_blocks.iter().zip(y_blocks) {
                for lane in 0..LANES {
                    sums[lane] = fma.multiply_add_single(x[lane], y[lane], sums[lane]);
                }
            }
            let tail: f32 = x_rest.iter().zip(y_rest).map(|(x, y)| x * y).sum();
            tail + sums.iter().sum::<f32>()
        },
    )
}

/// Euclidean length.
pub fn norm(x: &[f32]) -> f32 {
    dot(x, x).sqrt()
}

/// Adds a multiple: `out += factor · x`.
pub fn add_multiple(x: &[f32], factor: f32, out: &mut [f32]) {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for (out, x) in out.iter_mut().zip(x) {
                *out = fma.multiply_add_single(factor, *x, *out);
            }
        },
    );
}

/// Values in single precision.
pub fn rounded(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// Values of a vector register of AVX2: a matrix that is factorised has a multiple of as many rows.
pub const WIDTH: usize = 8;
/// Values of a vector register.
pub type Wide = [f32; WIDTH];

/// Share of the largest entry of a column below which the one on the diagonal is not divided by: an exchange of rows goes through
/// all columns, and the factors are those of a preconditioner.
const PIVOT_SHARE: f32 = 0.1;

/// Number of rows of a matrix of `n` rows that is factorised: the next multiple of [`WIDTH`]. What is added has 1 on the diagonal.
pub const fn padded(n: usize) -> usize {
    n.next_multiple_of(WIDTH)
}

/// Adds a product of [`WIDTH`] columns with as many values: `sum + factor · columns · x`.
#[inline(always)]
fn add_product(fma: MultiplyAdd, columns: [&Wide; WIDTH], x: &Wide, factor: f32, sum: Wide) -> Wide {
    let mut sum = sum;
    for (column, x) in columns.iter().zip(x) {
        for lane in 0..WIDTH {
            sum[lane] = fma.multiply_add_single(factor * x, column[lane], sum[lane]);
        }
    }
    sum
}

/// Rows `row` to `row + WIDTH` of the [`WIDTH`] columns of a panel.
#[inline(always)]
fn rows(panel: &[f32], n: usize, row: usize) -> [&Wide; WIDTH] {
    std::array::from_fn(|j| {
        let column = &panel[j * n + row..j * n + row + WIDTH];
        column.first_chunk().expect("a multiple of the width")
    })
}

/// Factorises an n × n matrix in place with row exchanges, n a multiple of [`WIDTH`], in panels of as many columns: L below the
/// diagonal, and in place of the panels' blocks on the diagonal the inverses of their triangles. False where it is singular.
pub fn lu(matrix: &mut [f32], n: usize, pivots: &mut [usize]) -> bool {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for first in (0..n).step_by(WIDTH) {
                let end = first + WIDTH;
                if !factorise_panel(fma, &mut matrix[first * n..end * n], n, first, pivots) {
                    return false;
                }
                if (first..end).any(|k| pivots[k] != k) {
                    for (number, column) in matrix.chunks_exact_mut(n).enumerate() {
                        if !(first..end).contains(&number) {
                            (first..end).for_each(|k| column.swap(k, pivots[k]));
                        }
                    }
                }
                invert_triangles(fma, &mut matrix[first * n..end * n], n, first);
                let (done, rest) = matrix.split_at_mut(end * n);
                let panel = &done[first * n..];
                for column in rest.chunks_exact_mut(n) {
                    let own = wide_mut(column, first);
                    // Stick in one direction does not see the other: many are 0.
                    if *own == [0.0; WIDTH] {
                        continue;
                    }
                    *own = lower_product(fma, rows(panel, n, first), own);
                    let solved = *own;
                    for row in (end..n).step_by(WIDTH) {
                        let values = wide_mut(column, row);
                        *values = add_product(fma, rows(panel, n, row), &solved, -1.0, *values);
                    }
                }
            }
            true
        },
    )
}

#[inline(always)]
fn wide_mut(values: &mut [f32], first: usize) -> &mut Wide {
    let values = &mut values[first..first + WIDTH];
    values.first_chunk_mut().expect("a whole register")
}

/// Multiplies by the inverse of the lower triangle of a block on the diagonal, whose diagonal is 1.
#[inline(always)]
fn lower_product(fma: MultiplyAdd, block: [&Wide; WIDTH], x: &Wide) -> Wide {
    let mut sum = *x;
    for (j, (column, x)) in block.iter().zip(x).enumerate() {
        for lane in 0..WIDTH {
            let entry = if lane > j { column[lane] } else { 0.0 };
            sum[lane] = fma.multiply_add_single(*x, entry, sum[lane]);
        }
    }
    sum
}

/// Multiplies by the inverse of the upper triangle of a block on the diagonal.
#[inline(always)]
fn upper_product(fma: MultiplyAdd, block: [&Wide; WIDTH], x: &Wide) -> Wide {
    let mut sum = [0.0; WIDTH];
    for (j, (column, x)) in block.iter().zip(x).enumerate() {
        for lane in 0..WIDTH {
            let entry = if lane <= j { column[lane] } else { 0.0 };
            sum[lane] = fma.multiply_add_single(*x, entry, sum[lane]);
        }
    }
    sum
}

/// Factorises the columns of a panel, of which the diagonal begins in row `first`, with the exchanges of its own rows.
#[inline(always)]
fn factorise_panel(fma: MultiplyAdd, panel: &mut [f32], n: usize, first: usize, pivots: &mut [usize]) -> bool {
    for k in 0..WIDTH {
        let row = first + k;
        let own = &panel[k * n..(k + 1) * n];
        let largest = largest_from(&own[first..], k);
        let mut pivot = row;
        // Not a number is neither.
        if !(own[row].abs() >= PIVOT_SHARE * largest && largest > 0.0) {
            pivot = (row..n).find(|&row| own[row].abs() == largest).unwrap_or(row);
            if own[pivot].is_nan() || own[pivot] == 0.0 {
                return false;
            }
        }
        pivots[row] = pivot;
        if pivot != row {
            panel.chunks_exact_mut(n).for_each(|column| column.swap(row, pivot));
        }
        let (done, rest) = panel.split_at_mut((k + 1) * n);
        let own = &mut done[k * n..];
        let inverse = 1.0 / own[row];
        // Of the register with the diagonal only what is below it.
        let mut lower = *wide_mut(own, first);
        for (lane, value) in lower.iter_mut().enumerate() {
            *value = if lane > k { inverse * *value } else { 0.0 };
        }
        let own_first = wide_mut(own, first);
        for lane in 0..WIDTH {
            own_first[lane] = if lane > k { lower[lane] } else { own_first[lane] };
        }
        for at in (first + WIDTH..n).step_by(WIDTH) {
            let values = wide_mut(own, at);
            *values = values.map(|value| inverse * value);
        }
        for column in rest.chunks_exact_mut(n) {
            let factor = -column[row];
            if factor == 0.0 {
                continue;
            }
            let values = wide_mut(column, first);
            for lane in 0..WIDTH {
                values[lane] = fma.multiply_add_single(factor, lower[lane], values[lane]);
            }
            for at in (first + WIDTH..n).step_by(WIDTH) {
                let (values, lower) = (wide_mut(column, at), &own[at..at + WIDTH]);
                for lane in 0..WIDTH {
                    values[lane] = fma.multiply_add_single(factor, lower[lane], values[lane]);
                }
            }
        }
    }
    true
}

/// Largest magnitude from place `from` of the first register on.
#[inline(always)]
fn largest_from(values: &[f32], from: usize) -> f32 {
    // Without the order of numbers and those that are none, which takes three instructions in place of one.
    let larger = |a: f32, b: f32| if a > b { a } else { b };
    let mut largest = [0.0_f32; WIDTH];
    for (number, values) in values.as_chunks::<WIDTH>().0.iter().enumerate() {
        for lane in 0..WIDTH {
            let value = if number > 0 || lane >= from {
                values[lane].abs()
            } else {
                0.0
            };
            largest[lane] = larger(value, largest[lane]);
        }
    }
    let [a, b, c, d, e, f, g, h] = largest;
    larger(larger(larger(a, e), larger(b, f)), larger(larger(c, g), larger(d, h)))
}

/// Replaces the triangles of the block on the diagonal of a panel by their inverses X: from X L = 1 and X U = 1, column by column.
#[inline(always)]
fn invert_triangles(fma: MultiplyAdd, panel: &mut [f32], n: usize, first: usize) {
    let mut block = [[0.0_f32; WIDTH]; WIDTH];
    for (j, column) in block.iter_mut().enumerate() {
        *column = *wide_mut(&mut panel[j * n..], first);
    }
    let (mut lower, mut upper) = ([[0.0_f32; WIDTH]; WIDTH], [[0.0_f32; WIDTH]; WIDTH]);
    for j in (0..WIDTH).rev() {
        let mut sum = [0.0; WIDTH];
        sum[j] = 1.0;
        for m in j + 1..WIDTH {
            for lane in 0..WIDTH {
                sum[lane] = fma.multiply_add_single(-block[j][m], lower[m][lane], sum[lane]);
            }
        }
        lower[j] = sum;
    }
    for j in 0..WIDTH {
        let inverse = 1.0 / block[j][j];
        let mut sum = [0.0; WIDTH];
        sum[j] = 1.0;
        for m in 0..j {
            for lane in 0..WIDTH {
                sum[lane] = fma.multiply_add_single(-block[j][m], upper[m][lane], sum[lane]);
            }
        }
        upper[j] = sum.map(|value| inverse * value);
    }
    for j in 0..WIDTH {
        let column = wide_mut(&mut panel[j * n..], first);
        *column = std::array::from_fn(|lane| if lane > j { lower[j][lane] } else { upper[j][lane] });
    }
}

/// Solves with the factors of [`lu`], in place.
pub fn lu_solve(factors: &[f32], n: usize, pivots: &[usize], values: &mut [f32]) {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for (k, &pivot) in pivots[..n].iter().enumerate() {
                values.swap(k, pivot);
            }
            for first in (0..n).step_by(WIDTH) {
                let panel = &factors[first * n..];
                let own = wide_mut(values, first);
                *own = lower_product(fma, rows(panel, n, first), own);
                let solved = *own;
                for row in (first + WIDTH..n).step_by(WIDTH) {
                    let values = wide_mut(values, row);
                    *values = add_product(fma, rows(panel, n, row), &solved, -1.0, *values);
                }
            }
            for first in (0..n).step_by(WIDTH).rev() {
                let panel = &factors[first * n..];
                let own = wide_mut(values, first);
                *own = upper_product(fma, rows(panel, n, first), own);
                let solved = *own;
                for row in (0..first).step_by(WIDTH) {
                    let values = wide_mut(values, row);
                    *values = add_product(fma, rows(panel, n, row), &solved, -1.0, *values);
                }
            }
        },
    );
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_factors_solve_the_system() {
        let sizes = [1, 2, 5, 17, 40];
        for (n, shift) in sizes.into_iter().flat_map(|n| [(n, 1.5), (n, 0.0)]) {
            // Padded by a unit matrix. The diagonal is small enough that rows are exchanged.
            let (inside, n) = (n, padded(n));
            let matrix: Vec<f32> = (0..n * n)
                .map(|k| {
                    let (row, column) = (k % n, k / n);
                    let own = if row == column { 1.0 } else { 0.0 };
                    let inner = row < inside && column < inside;
                    if inner {
                        ((k * k + 1) as f32 * 0.37).sin() + shift * own
                    } else {
                        own
                    }
                })
                .collect();
            let rhs: Vec<f32> = (0..n).map(|i| 1.0 + i as f32).collect();
            let (mut factors, mut pivots, mut x) = (matrix.clone(), vec![0; n], rhs.clone());
            assert!(lu(&mut factors, n, &mut pivots));
            lu_solve(&factors, n, &pivots, &mut x);
            let mut product = vec![0.0; n];
            for (column, x) in matrix.chunks_exact(n).zip(&x) {
                add_multiple(column, *x, &mut product);
            }
            let size = dense::largest(&x.iter().map(|&x| f64::from(x)).collect::<Vec<_>>()) as f32;
            for (product, rhs) in product.iter().zip(&rhs) {
                // Round-off times the growth of the factors.
                assert!((product - rhs).abs() < 1e-4 * (1.0 + size), "{n}: {product} {rhs}");
            }
        }
        assert!(!lu(&mut [0.0; WIDTH * WIDTH], WIDTH, &mut [0; WIDTH]));
    }
}
