//! Discrete Fourier transform of rows: element by element over rows of numbers, so that the loops run along the rows.
//!
//! Stockham's algorithm with factors 4, 3 and 2: it sorts itself. The inverse is the same transform with real and imaginary
//! part exchanged, without the factor 1/P.

use super::dense::Arithmetic;
use super::real::Real;
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
    /// Of P rows, P a [`good_size`].
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

    /// Transforms `rows`, each `width` long; `scratch` is as large.
    #[inline(always)]
    pub fn forward(&self, arithmetic: Arithmetic, width: usize, rows: &mut Rows<T>, scratch: &mut Rows<T>) {
        let (re, im) = (&mut rows.re, &mut rows.im);
        self.transform(arithmetic, width, (re, im), (&mut scratch.re, &mut scratch.im));
    }

    /// The inverse times P.
    #[inline(always)]
    pub fn backward(&self, arithmetic: Arithmetic, width: usize, rows: &mut Rows<T>, scratch: &mut Rows<T>) {
        let (re, im) = (&mut rows.re, &mut rows.im);
        self.transform(arithmetic, width, (im, re), (&mut scratch.im, &mut scratch.re));
    }

    #[inline(always)]
    fn transform<'a>(
        &self,
        arithmetic: Arithmetic,
        width: usize,
        mut from: (&'a mut Vec<T>, &'a mut Vec<T>),
        mut to: (&'a mut Vec<T>, &'a mut Vec<T>),
    ) {
        let (mut length, mut stride) = (self.size, 1);
        for &factor in &self.factors {
            let pass = Pass {
                parts: length / factor,
                stride,
                width,
            };
            match factor {
                2 => self.pass::<2>(arithmetic, &pass, &from, &mut to),
                3 => self.pass::<3>(arithmetic, &pass, &from, &mut to),
                _ => self.pass::<4>(arithmetic, &pass, &from, &mut to),
            }
            std::mem::swap(&mut from, &mut to);
            length /= factor;
            stride *= factor;
        }
        // After an odd number of passes the result stands in the scratch.
        if self.factors.len() % 2 == 1 {
            std::mem::swap(to.0, from.0);
            std::mem::swap(to.1, from.1);
        }
    }

    #[inline(always)]
    fn pass<const R: usize>(
        &self,
        arithmetic: Arithmetic,
        pass: &Pass,
        from: &(&mut Vec<T>, &mut Vec<T>),
        to: &mut (&mut Vec<T>, &mut Vec<T>),
    ) {
        let Pass { parts, stride, width } = *pass;
        for part in 0..parts {
            let twiddles: [(T, T); R] = std::array::from_fn(|k| self.roots[part * stride * k % self.size]);
            for place in 0..stride {
                let source = |j: usize| (place + stride * (part + parts * j)) * width;
                let target = |k: usize| (place + stride * (R * part + k)) * width;
                let inputs: [(&[T], &[T]); R] = std::array::from_fn(|j| {
                    let start = source(j);
                    (&from.0[start..start + width], &from.1[start..start + width])
                });
                let first = target(0);
                // The R rows of the result stand `stride` rows apart.
                let (re, im) = (&mut to.0[first..], &mut to.1[first..]);
                for column in 0..width {
                    let values: [(T, T); R] = std::array::from_fn(|j| (inputs[j].0[column], inputs[j].1[column]));
                    let sums = butterfly(arithmetic, values);
                    for (k, (sum, twiddle)) in sums.into_iter().zip(twiddles).enumerate() {
                        let (a, b) = if k == 0 { sum } else { product(arithmetic, sum, twiddle) };
                        re[k * stride * width + column] = a;
                        im[k * stride * width + column] = b;
                    }
                }
            }
        }
    }
}

/// One pass: what is left to transform in so many parts, what is done in runs of `stride`.
struct Pass {
    parts: usize,
    stride: usize,
    width: usize,
}

#[inline(always)]
fn product<T: Real>(arithmetic: Arithmetic, (a, b): (T, T), (c, d): (T, T)) -> (T, T) {
    (
        T::multiply_add(arithmetic, a, c, -(b.times(d))),
        T::multiply_add(arithmetic, a, d, b.times(c)),
    )
}

#[inline(always)]
fn add<T: Real>((a, b): (T, T), (c, d): (T, T)) -> (T, T) {
    (a.plus(c), b.plus(d))
}

#[inline(always)]
fn subtract<T: Real>((a, b): (T, T), (c, d): (T, T)) -> (T, T) {
    (a.plus(-c), b.plus(-d))
}

/// −i z.
#[inline(always)]
fn turned<T: Real>((a, b): (T, T)) -> (T, T) {
    (b, -a)
}

/// The transform of 2, 3 or 4 numbers.
#[inline(always)]
fn butterfly<T: Real, const R: usize>(arithmetic: Arithmetic, v: [(T, T); R]) -> [(T, T); R] {
    let mut out = v;
    match R {
        2 => (out[0], out[1]) = (add(v[0], v[1]), subtract(v[0], v[1])),
        3 => {
            let (sum, difference) = (add(v[1], v[2]), subtract(v[1], v[2]));
            let half = T::new(-0.5);
            let middle = (
                T::multiply_add(arithmetic, half, sum.0, v[0].0),
                T::multiply_add(arithmetic, half, sum.1, v[0].1),
            );
            let height = T::new(0.75_f64.sqrt());
            let across = turned((difference.0.times(height), difference.1.times(height)));
            out[0] = add(v[0], sum);
            out[1] = add(middle, across);
            out[2] = subtract(middle, across);
        }
        _ => {
            let (even, odd) = (add(v[0], v[2]), subtract(v[0], v[2]));
            let (sum, difference) = (add(v[1], v[3]), turned(subtract(v[1], v[3])));
            out[0] = add(even, sum);
            out[1] = add(odd, difference);
            out[2] = subtract(even, sum);
            out[3] = subtract(odd, difference);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_transform_is_the_sum_and_its_inverse_leads_back() {
        let width = 3;
        for size in [1, 2, 3, 4, 6, 8, 12, 16, 24, 32, 48, 64, 96] {
            assert_eq!(good_size(size), size);
            let fourier = Fourier::<f64>::new(size);
            let mut rows = Rows::new(size, width);
            for (i, (re, im)) in rows.re.iter_mut().zip(&mut rows.im).enumerate() {
                (*re, *im) = ((1.7 * i as f64).sin(), (0.3 * (i * i) as f64).cos());
            }
            let given = rows.clone();
            let mut scratch = Rows::new(size, width);
            fourier.forward(Arithmetic::SEPARATE, width, &mut rows, &mut scratch);
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
            fourier.backward(Arithmetic::SEPARATE, width, &mut rows, &mut scratch);
            for (now, given) in rows.re.iter().zip(&given.re).chain(rows.im.iter().zip(&given.im)) {
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
