//! Vector operations in single precision, for the Krylov method and what it multiplies with.

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

/// Divides values by a number, in place.
pub fn divide(values: &mut [f32], by: f32) {
    dense::vectorised(
        #[inline(always)]
        |_| {
            for value in values {
                *value /= by;
            }
        },
    );
}

/// Values in single precision.
pub fn rounded(values: &[f64]) -> Vec<f32> {
    values.iter().map(|&value| value as f32).collect()
}

/// Values of a vector register of AVX2.
pub const WIDTH: usize = 8;
/// Values of a vector register.
pub type Wide = [f32; WIDTH];

/// Number of values of whole vector registers that hold `n` values.
pub const fn padded(n: usize) -> usize {
    n.next_multiple_of(WIDTH)
}

/// Values from place `first` on, as many as a register holds.
#[inline(always)]
pub fn wide(values: &[f32], first: usize) -> &Wide {
    let values = &values[first..first + WIDTH];
    values.first_chunk().expect("a whole register")
}

/// Places of as many values as a register holds, from place `first` on.
#[inline(always)]
pub fn wide_mut(values: &mut [f32], first: usize) -> &mut Wide {
    let values = &mut values[first..first + WIDTH];
    values.first_chunk_mut().expect("a whole register")
}
