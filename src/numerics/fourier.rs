//! The complex discrete Fourier transform of length P down the columns of P rows: X_k = Σ_j exp(−2πi jk/P) x_j, where each x_j is
//! a row of `width` numbers. So `width` transforms run side by side, and every loop runs along a row, where its numbers are adjacent
//! and fill vector registers.
//!
//! P is a power of two or three times one ([`good_size`]): convolutions are filled up with zeros to it. Rows follow each other in
//! memory, real parts in one vector and imaginary parts in another.
//!
//! Stockham's algorithm with factors 4, 3 and 2 (Van Loan, Computational Frameworks for the Fast Fourier Transform, 1992, 1.7): one pass
//! for each factor R of P takes R rows that are P/R apart, combines them and writes them where the next pass wants them, from one
//! buffer into the other. The rows end in their order, without the reordering by reversed digits that a transform in place needs. The
//! inverse is the same transform with real and imaginary part exchanged, without the factor 1/P.

use super::real::Real;
use pulp::Simd;
use std::f64::consts::TAU;

/// A transform of P rows.
#[derive(Debug, Clone)]
pub struct Fourier<T> {
    size: usize,
    /// The factors of P, in the order of the passes.
    factors: Vec<usize>,
    /// exp(−2πi k/P), k = 0 … P − 1.
    roots: Vec<(T, T)>,
}

/// P rows of complex numbers, each `width` long, row by row.
#[derive(Debug, Clone)]
pub struct Rows<T> {
    /// Real parts.
    pub re: Vec<T>,
    /// Imaginary parts.
    pub im: Vec<T>,
}

impl<T: Real> Rows<T> {
    /// Zero.
    pub fn new(rows: usize, width: usize) -> Rows<T> {
        Rows {
            re: vec![T::default(); rows * width],
            im: vec![T::default(); rows * width],
        }
    }
}

/// The smallest product of twos and at most one three that is not below `size`.
pub fn good_size(size: usize) -> usize {
    let two = size.next_power_of_two();
    let three = 3 * size.div_ceil(3).next_power_of_two();
    two.min(three).max(1)
}

impl<T: Real> Fourier<T> {
    /// Transform of P rows, P a [`good_size`].
    pub fn new(size: usize) -> Fourier<T> {
        let (mut rest, mut factors) = (size, Vec::new());
        for factor in [4, 3, 2] {
            while rest > 1 && rest.is_multiple_of(factor) {
                factors.push(factor);
                rest /= factor;
            }
        }
        debug_assert_eq!(rest, 1, "{size} has other factors than 2 and 3");
        let root = |k: usize| {
            let (sine, cosine) = (TAU * k as f64 / size as f64).sin_cos();
            (T::new(cosine), T::new(-sine))
        };
        Fourier {
            size,
            factors,
            roots: (0..size).map(root).collect(),
        }
    }

    /// Number of rows.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Transforms `rows`, each `width` long, a multiple of [`super::real::BLOCK`]. The second half of the rows is 0, which fills up
    /// a convolution; of an odd number the one in the middle belongs to the first half. `scratch` is as large.
    #[inline(always)]
    pub fn forward<S: Simd>(&self, simd: S, width: usize, rows: &mut Rows<T>, scratch: &mut Rows<T>) {
        let (re, im) = (&mut rows.re, &mut rows.im);
        debug_assert!(
            [&*re, &*im].iter().all(|rows| {
                let second = &rows[self.size.div_ceil(2) * width..self.size * width];
                second.iter().all(|value| *value == T::default())
            }),
            "the second half of {} rows is not 0",
            self.size
        );
        self.transform(simd, width, Half::Zero, (re, im), (&mut scratch.re, &mut scratch.im));
    }

    /// Writes the first half of the rows of the inverse times P, as [`Fourier::forward`] counts it. A convolution has no use for
    /// the second half, which is not computed: it holds whatever was left there.
    #[inline(always)]
    pub fn backward<S: Simd>(&self, simd: S, width: usize, rows: &mut Rows<T>, scratch: &mut Rows<T>) {
        let (re, im) = (&mut rows.re, &mut rows.im);
        self.transform(simd, width, Half::Unused, (im, re), (&mut scratch.im, &mut scratch.re));
    }

    #[inline(always)]
    fn transform<'a, S: Simd>(&self, simd: S, width: usize, half: Half, mut from: Parts<'a, T>, mut to: Parts<'a, T>) {
        let vectors = width / T::lanes::<S>();
        if vectors == 0 {
            // The transform of an empty window.
            return;
        }
        let (mut length, mut stride) = (self.size, 1);
        for &factor in &self.factors {
            let parts = length / factor;
            let pass = Pass {
                parts,
                stride,
                length: stride * vectors,
            };
            // The first pass for a factor 4 takes a row from each quarter of the rows, the last pass for a factor R writes a row into each
            // R-th part: only the first two of four, the first two of three, the first of two concern the first half.
            let zero = half == Half::Zero && stride == 1 && factor == 4;
            let unused = half == Half::Unused && parts == 1;
            {
                let from = (T::vectors::<S>(from.0), T::vectors::<S>(from.1));
                let to = (T::vectors_mut::<S>(to.0), T::vectors_mut::<S>(to.1));
                match (factor, zero, unused) {
                    (2, _, false) => self.pass::<S, 2, 2, 2>(simd, &pass, from, to),
                    (2, _, true) => self.pass::<S, 2, 2, 1>(simd, &pass, from, to),
                    (3, _, false) => self.pass::<S, 3, 3, 3>(simd, &pass, from, to),
                    (3, _, true) => self.pass::<S, 3, 3, 2>(simd, &pass, from, to),
                    (_, true, _) => self.pass::<S, 4, 2, 4>(simd, &pass, from, to),
                    (_, _, false) => self.pass::<S, 4, 4, 4>(simd, &pass, from, to),
                    (_, _, true) => self.pass::<S, 4, 4, 2>(simd, &pass, from, to),
                }
            }
            std::mem::swap(&mut from, &mut to);
            length = parts;
            stride *= factor;
        }
        // After an odd number of passes the result stands in the scratch.
        if self.factors.len() % 2 == 1 {
            std::mem::swap(to.0, from.0);
            std::mem::swap(to.1, from.1);
        }
    }

    /// A pass for a factor R, of which the first `READ` rows are not 0 and the first `WRITTEN` are needed.
    #[inline(always)]
    fn pass<S: Simd, const R: usize, const READ: usize, const WRITTEN: usize>(
        &self,
        simd: S,
        pass: &Pass,
        from: Source<T, S>,
        (to_re, to_im): Target<T, S>,
    ) {
        let length = pass.length;
        let blocks = to_re
            .chunks_exact_mut(R * length)
            .zip(to_im.chunks_exact_mut(R * length));
        for (part, to) in blocks.take(pass.parts).enumerate() {
            let rows = Butterflies {
                length,
                first: part * length,
                apart: pass.parts * length,
            };
            if part == 0 {
                // All roots are 1.
                combine::<T, S, R, READ, WRITTEN, false>(simd, &rows, &[], from, to);
            } else {
                let mut roots = [(T::splat(simd, T::default()), T::splat(simd, T::default())); R];
                for (k, root) in roots.iter_mut().enumerate() {
                    let (re, im) = self.roots[part * pass.stride * k % self.size];
                    *root = (T::splat(simd, re), T::splat(simd, im));
                }
                combine::<T, S, R, READ, WRITTEN, true>(simd, &rows, &roots, from, to);
            }
        }
    }
}

/// Property of the second half of the rows that saves work.
#[derive(Clone, Copy, PartialEq)]
enum Half {
    /// Zero before the transform.
    Zero,
    /// Not needed after the transform.
    Unused,
}

/// Real and imaginary parts of rows.
type Parts<'a, T> = (&'a mut Vec<T>, &'a mut Vec<T>);

/// Rows of vectors, real and imaginary parts.
type Source<'a, T, S> = (&'a [<T as Real>::Vector<S>], &'a [<T as Real>::Vector<S>]);

/// Real and imaginary part of values that are written.
type Target<'a, T, S> = (&'a mut [<T as Real>::Vector<S>], &'a mut [<T as Real>::Vector<S>]);

/// Complex numbers side by side, real and imaginary parts.
type Complex<T, S> = (<T as Real>::Vector<S>, <T as Real>::Vector<S>);

/// One pass: `parts` butterflies on rows that are `parts` times `stride` apart, each for the `stride` rows that earlier passes have
/// combined, which are `length` registers in all.
struct Pass {
    parts: usize,
    stride: usize,
    length: usize,
}

/// Butterflies of one part: from rows of `length` registers, of which the first begins at `first` and the others are `apart`.
struct Butterflies {
    length: usize,
    first: usize,
    apart: usize,
}

/// Combines R rows into R rows that follow each other, and multiplies these by the roots where they are `TURNED`, that is, where the
/// roots are not all 1. Each row is cut to its length before the loop, which then needs no check of its bounds.
#[inline(always)]
fn combine<T: Real, S: Simd, const R: usize, const READ: usize, const WRITTEN: usize, const TURNED: bool>(
    simd: S,
    rows: &Butterflies,
    roots: &[Complex<T, S>],
    (from_re, from_im): Source<T, S>,
    (to_re, to_im): Target<T, S>,
) {
    let length = rows.length;
    let mut from: [Source<T, S>; R] = [(&[], &[]); R];
    for (j, from) in from.iter_mut().enumerate().take(READ) {
        let first = rows.first + j * rows.apart;
        *from = (&from_re[first..first + length], &from_im[first..first + length]);
    }
    let (to_re, to_im) = (split::<_, R>(to_re, length), split::<_, R>(to_im, length));
    let zero = T::splat(simd, T::default());
    for i in 0..length {
        let mut values = [(zero, zero); R];
        for j in 0..READ {
            values[j] = (from[j].0[i], from[j].1[i]);
        }
        let sums = butterfly::<T, S, R, READ>(simd, values);
        for k in 0..WRITTEN {
            (to_re[k][i], to_im[k][i]) = if TURNED && k > 0 {
                product::<T, S>(simd, sums[k], roots[k])
            } else {
                sums[k]
            };
        }
    }
}

/// Splits off R parts of a length, 4 at most; the other parts are empty.
#[inline(always)]
fn split<V, const R: usize>(values: &mut [V], length: usize) -> [&mut [V]; 4] {
    let (first, rest) = values.split_at_mut(length);
    let (second, rest) = rest.split_at_mut(if R > 1 { length } else { 0 });
    let (third, rest) = rest.split_at_mut(if R > 2 { length } else { 0 });
    [
        first,
        second,
        third,
        rest.split_at_mut(if R > 3 { length } else { 0 }).0,
    ]
}

#[inline(always)]
fn product<T: Real, S: Simd>(simd: S, (a, b): Complex<T, S>, (c, d): Complex<T, S>) -> Complex<T, S> {
    (
        T::multiply_subtract(simd, b, d, T::multiply(simd, a, c)),
        T::multiply_add(simd, a, d, T::multiply(simd, b, c)),
    )
}

#[inline(always)]
fn add<T: Real, S: Simd>(simd: S, (a, b): Complex<T, S>, (c, d): Complex<T, S>) -> Complex<T, S> {
    (T::add(simd, a, c), T::add(simd, b, d))
}

#[inline(always)]
fn subtract<T: Real, S: Simd>(simd: S, (a, b): Complex<T, S>, (c, d): Complex<T, S>) -> Complex<T, S> {
    (T::subtract(simd, a, c), T::subtract(simd, b, d))
}

/// u − i f v.
#[inline(always)]
fn turn_and_add<T: Real, S: Simd>(simd: S, u: Complex<T, S>, factor: T, v: Complex<T, S>) -> Complex<T, S> {
    let factor = T::splat(simd, factor);
    (
        T::multiply_add(simd, factor, v.1, u.0),
        T::multiply_subtract(simd, factor, v.0, u.1),
    )
}

/// The transform of 2, 3 or 4 numbers, of which those from number `READ` on are 0.
#[inline(always)]
fn butterfly<T: Real, S: Simd, const R: usize, const READ: usize>(
    simd: S,
    v: [Complex<T, S>; R],
) -> [Complex<T, S>; R] {
    let mut out = v;
    match (R, READ) {
        (4, 2) => {
            out[0] = add::<T, S>(simd, v[0], v[1]);
            out[1] = turn_and_add::<T, S>(simd, v[0], T::new(1.0), v[1]);
            out[2] = subtract::<T, S>(simd, v[0], v[1]);
            out[3] = turn_and_add::<T, S>(simd, v[0], T::new(-1.0), v[1]);
        }
        (2, _) => {
            out[0] = add::<T, S>(simd, v[0], v[1]);
            out[1] = subtract::<T, S>(simd, v[0], v[1]);
        }
        (3, _) => {
            let sum = add::<T, S>(simd, v[1], v[2]);
            let difference = subtract::<T, S>(simd, v[1], v[2]);
            let half = T::splat(simd, T::new(0.5));
            let middle = (
                T::multiply_subtract(simd, half, sum.0, v[0].0),
                T::multiply_subtract(simd, half, sum.1, v[0].1),
            );
            let height = 0.75_f64.sqrt();
            out[0] = add::<T, S>(simd, v[0], sum);
            out[1] = turn_and_add::<T, S>(simd, middle, T::new(height), difference);
            out[2] = turn_and_add::<T, S>(simd, middle, T::new(-height), difference);
        }
        _ => {
            let (even, odd) = (add::<T, S>(simd, v[0], v[2]), subtract::<T, S>(simd, v[0], v[2]));
            let (sum, difference) = (add::<T, S>(simd, v[1], v[3]), subtract::<T, S>(simd, v[1], v[3]));
            out[0] = add::<T, S>(simd, even, sum);
            out[1] = turn_and_add::<T, S>(simd, odd, T::new(1.0), difference);
            out[2] = subtract::<T, S>(simd, even, sum);
            out[3] = turn_and_add::<T, S>(simd, odd, T::new(-1.0), difference);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_and_its_inverse_leads_back() {
        let width = crate::numerics::real::BLOCK;
        for size in [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96] {
            assert_eq!(good_size(size), size);
            let fourier = Fourier::<f64>::new(size);
            let mut rows = Rows::new(size, width);
            // The first half of the rows.
            let filled = size.div_ceil(2) * width;
            for (i, (re, im)) in rows.re.iter_mut().zip(&mut rows.im).enumerate().take(filled) {
                (*re, *im) = ((1.7 * i as f64).sin(), (0.3 * (i * i) as f64).cos());
            }
            let given = rows.clone();
            let mut scratch = Rows::new(size, width);
            fourier.forward(pulp::Scalar, width, &mut rows, &mut scratch);
            for row in 0..size {
                for column in 0..width {
                    let mut sum = (0.0, 0.0);
                    for j in 0..size {
                        let (sine, cosine) = (TAU * (j * row % size) as f64 / size as f64).sin_cos();
                        let (a, b) = (given.re[j * width + column], given.im[j * width + column]);
                        sum.0 += a * cosine + b * sine;
                        sum.1 += b * cosine - a * sine;
                    }
                    let place = row * width + column;
                    let error = (rows.re[place] - sum.0).hypot(rows.im[place] - sum.1);
                    // Round-off of P terms of order 1.
                    assert!(error < 1e-14 * size as f64, "{size} {row}: {error:e}");
                }
            }
            fourier.backward(pulp::Scalar, width, &mut rows, &mut scratch);
            let filled = |values: &[f64]| values[..filled].to_vec();
            let (now, given) = (
                [&rows.re, &rows.im].map(|v| filled(v)),
                [&given.re, &given.im].map(|v| filled(v)),
            );
            for (now, given) in now.iter().flatten().zip(given.iter().flatten()) {
                assert!((now / size as f64 - given).abs() < 1e-14 * size as f64);
            }
        }
    }

    #[test]
    fn a_good_size_is_the_next_one() {
        let expected = [
            (1, 1),
            (5, 6),
            (7, 8),
            (9, 12),
            (13, 16),
            (17, 24),
            (25, 32),
            (33, 48),
            (41, 48),
            (49, 64),
        ];
        for (least, size) in expected {
            assert_eq!(good_size(least), size);
        }
    }
}
