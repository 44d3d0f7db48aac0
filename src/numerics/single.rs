//! Dense kernels in single precision, for preconditioners and the Krylov method around them; column-major.

use super::dense;

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

/// Factorises an n × n matrix in place with row exchanges, L below the diagonal. False where it is singular.
pub fn lu(matrix: &mut [f32], n: usize, pivots: &mut [usize]) -> bool {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for k in 0..n {
                let own = &mut matrix[k * n..(k + 1) * n];
                let mut pivot = k;
                for row in k + 1..n {
                    if own[row].abs() > own[pivot].abs() {
                        pivot = row;
                    }
                }
                pivots[k] = pivot;
                if own[pivot] == 0.0 || own[pivot].is_nan() {
                    return false;
                }
                if pivot != k {
                    for column in matrix.chunks_exact_mut(n) {
                        column.swap(k, pivot);
                    }
                }
                let (done, rest) = matrix.split_at_mut((k + 1) * n);
                let own = &mut done[k * n..];
                let inverse = 1.0 / own[k];
                own[k + 1..].iter_mut().for_each(|value| *value *= inverse);
                let lower = &own[k + 1..];
                for column in rest.chunks_exact_mut(n) {
                    let factor = -column[k];
                    // Stick in one direction does not see the other: many are 0.
                    if factor != 0.0 {
                        for (value, lower) in column[k + 1..].iter_mut().zip(lower) {
                            *value = fma.multiply_add_single(factor, *lower, *value);
                        }
                    }
                }
            }
            true
        },
    )
}

/// Solves with the factors of [`lu`], in place.
pub fn lu_solve(factors: &[f32], n: usize, pivots: &[usize], values: &mut [f32]) {
    dense::vectorised(
        #[inline(always)]
        |fma| {
            for (k, &pivot) in pivots[..n].iter().enumerate() {
                values.swap(k, pivot);
            }
            for k in 0..n {
                let (value, rest) = (-values[k], &mut values[k + 1..n]);
                for (out, lower) in rest.iter_mut().zip(&factors[k * n + k + 1..(k + 1) * n]) {
                    *out = fma.multiply_add_single(value, *lower, *out);
                }
            }
            for k in (0..n).rev() {
                let value = values[k] / factors[k * n + k];
                values[k] = value;
                for (out, upper) in values[..k].iter_mut().zip(&factors[k * n..k * n + k]) {
                    *out = fma.multiply_add_single(-value, *upper, *out);
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
        for n in [1, 2, 5, 17, 40] {
            let matrix: Vec<f32> = (0..n * n)
                .map(|k| ((k * k) as f32 * 0.37).sin() + if k % (n + 1) == 0 { 1.5 } else { 0.0 })
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
        assert!(!lu(&mut [0.0, 0.0, 0.0, 0.0], 2, &mut [0, 0]));
    }
}
