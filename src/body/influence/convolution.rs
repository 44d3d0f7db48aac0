//! The product of the tables with a load: transforms over the strips, convolutions along them.

use super::{ProductScratch, Tables, Transform, Window};
use crate::numerics::fourier::{Fourier, Rows};
use crate::numerics::real::Real;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// A product, for the vectors that a machine has.
pub(super) struct Product<'a, T> {
    pub(super) transform: &'a Transform,
    pub(super) fourier: &'a Fourier<T>,
    pub(super) tables: &'a Tables<T>,
    pub(super) window: &'a Window,
    pub(super) load: [&'a [T]; 2],
    pub(super) out: [&'a mut [T]; 2],
    pub(super) scratch: &'a mut ProductScratch<T>,
}

impl<T: Real> WithSimd for Product<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Product {
            transform,
            fourier,
            tables,
            window,
            load,
            out,
            scratch,
        } = self;
        let stride = transform.stride;
        let strips = window.strips.clone();
        let ProductScratch {
            rows,
            other,
            parts,
            sums,
        } = scratch;
        for (rows, load) in [&mut rows.re, &mut rows.im].into_iter().zip(load) {
            // The scratch may be that of a larger transform.
            let (given, rest) = rows[..fourier.size() * stride].split_at_mut(strips.len() * stride);
            given.copy_from_slice(&load[strips.start * stride..strips.end * stride]);
            rest.fill(T::default());
        }
        fourier.forward(simd, stride, rows, other);
        let size = fourier.size();
        let ranges = Ranges {
            cells: window.loaded.clone(),
            read: window.read.clone(),
            origin: stride,
        };
        for harmonic in 0..transform.harmonics() {
            let own = harmonic * stride..(harmonic + 1) * stride;
            let opposite = (size - harmonic) % size * stride;
            let lags = harmonic * transform.lags..(harmonic + 1) * transform.lags;
            let mirror = opposite..opposite + stride;
            if tables.scalar {
                let kernel = &tables.even[0][lags];
                let places = [own.clone(), mirror.clone()];
                let both = if own == mirror { 1 } else { 2 };
                for place in places.into_iter().take(both) {
                    let values = [&rows.re[place.clone()], &rows.im[place.clone()]];
                    let out = [&mut other.re[place.clone()], &mut other.im[place]];
                    convolve_one(simd, kernel, values, &ranges, out);
                }
            } else {
                let kernels = [
                    &tables.even[0][lags.clone()],
                    &tables.odd[lags.clone()],
                    &tables.even[1][lags],
                ];
                take_apart(simd, rows, &own, &mirror, parts);
                let [xr, xi, yr, yi] = &*parts;
                let [sum_xr, sum_xi, sum_yr, sum_yi] = &mut *sums;
                convolve(
                    simd,
                    kernels,
                    [xr, xi, yr, yi],
                    &ranges,
                    [sum_xr, sum_xi, sum_yr, sum_yi],
                );
                put_together(simd, sums, &own, &mirror, other);
            }
        }
        fourier.backward(simd, stride, other, rows);
        for (component, out) in [&other.re, &other.im].into_iter().zip(out) {
            for (row, strip) in component.chunks_exact(stride).zip(strips.clone()) {
                let read = window.read.clone();
                out[strip * stride..][read.clone()].copy_from_slice(&row[read]);
            }
        }
    }
}

/// Ranges that a convolution runs over.
struct Ranges {
    /// Cells with values.
    cells: Range<usize>,
    /// Places that are read.
    read: Range<usize>,
    /// Place of lag 0 in a kernel.
    origin: usize,
}

/// The sums over the cells of kernels a, b, c times values, complex x and y in real and imaginary parts: out_x = Σ a x − i b y,
/// out_y = Σ c y − i b x. Two vectors of places are summed up at a time, in registers.
#[inline(always)]
fn convolve<T: Real, S: Simd>(
    simd: S,
    [a, b, c]: [&[T]; 3],
    [xr, xi, yr, yi]: [&[T]; 4],
    ranges: &Ranges,
    [out_xr, out_xi, out_yr, out_yi]: [&mut [T]; 4],
) {
    let block = 2 * T::lanes::<S>();
    let zero = T::splat(simd, T::default());
    for start in (ranges.read.start / block * block..ranges.read.end).step_by(block) {
        let (mut sum_xr, mut sum_xi, mut sum_yr, mut sum_yi) = ([zero; 2], [zero; 2], [zero; 2], [zero; 2]);
        for cell in ranges.cells.clone() {
            let lag = ranges.origin + start - cell;
            let [a, b, c] = [a, b, c].map(|kernel| T::vectors::<S>(&kernel[lag..lag + block]));
            let [xr, xi, yr, yi] = [xr, xi, yr, yi].map(|values| T::splat(simd, values[cell]));
            for k in 0..2 {
                sum_xr[k] = T::multiply_add(simd, a[k], xr, sum_xr[k]);
                sum_xi[k] = T::multiply_add(simd, a[k], xi, sum_xi[k]);
                sum_yr[k] = T::multiply_add(simd, c[k], yr, sum_yr[k]);
                sum_yi[k] = T::multiply_add(simd, c[k], yi, sum_yi[k]);
                sum_xr[k] = T::multiply_add(simd, b[k], yi, sum_xr[k]);
                sum_xi[k] = T::multiply_subtract(simd, b[k], yr, sum_xi[k]);
                sum_yr[k] = T::multiply_add(simd, b[k], xi, sum_yr[k]);
                sum_yi[k] = T::multiply_subtract(simd, b[k], xr, sum_yi[k]);
            }
        }
        let end = start + block;
        T::vectors_mut::<S>(&mut out_xr[start..end]).copy_from_slice(&sum_xr);
        T::vectors_mut::<S>(&mut out_xi[start..end]).copy_from_slice(&sum_xi);
        T::vectors_mut::<S>(&mut out_yr[start..end]).copy_from_slice(&sum_yr);
        T::vectors_mut::<S>(&mut out_yi[start..end]).copy_from_slice(&sum_yi);
    }
}

/// Convolution with the kernel a alone, of one complex value (see [`convolve`]).
#[inline(always)]
fn convolve_one<T: Real, S: Simd>(
    simd: S,
    kernel: &[T],
    [re, im]: [&[T]; 2],
    ranges: &Ranges,
    [out_re, out_im]: [&mut [T]; 2],
) {
    let block = 2 * T::lanes::<S>();
    let zero = T::splat(simd, T::default());
    for start in (ranges.read.start / block * block..ranges.read.end).step_by(block) {
        let (mut sum_re, mut sum_im) = ([zero; 2], [zero; 2]);
        for cell in ranges.cells.clone() {
            let lag = ranges.origin + start - cell;
            let kernel = T::vectors::<S>(&kernel[lag..lag + block]);
            let (re, im) = (T::splat(simd, re[cell]), T::splat(simd, im[cell]));
            for k in 0..2 {
                sum_re[k] = T::multiply_add(simd, kernel[k], re, sum_re[k]);
                sum_im[k] = T::multiply_add(simd, kernel[k], im, sum_im[k]);
            }
        }
        let end = start + block;
        T::vectors_mut::<S>(&mut out_re[start..end]).copy_from_slice(&sum_re);
        T::vectors_mut::<S>(&mut out_im[start..end]).copy_from_slice(&sum_im);
    }
}

/// Separates the transforms of the real X and Y from that of Z = X + iY: (Z + Z̄')/2 and (Z − Z̄')/2i, with Z' at the
/// opposite harmonic.
#[inline(always)]
fn take_apart<T: Real, S: Simd>(
    simd: S,
    rows: &Rows<T>,
    own: &Range<usize>,
    mirror: &Range<usize>,
    [xr, xi, yr, yi]: &mut [Vec<T>; 4],
) {
    let half = T::splat(simd, T::new(0.5));
    let (a, b) = (
        T::vectors::<S>(&rows.re[own.clone()]),
        T::vectors::<S>(&rows.im[own.clone()]),
    );
    let (c, d) = (
        T::vectors::<S>(&rows.re[mirror.clone()]),
        T::vectors::<S>(&rows.im[mirror.clone()]),
    );
    let (xr, xi) = (T::vectors_mut::<S>(xr), T::vectors_mut::<S>(xi));
    let (yr, yi) = (T::vectors_mut::<S>(yr), T::vectors_mut::<S>(yi));
    for k in 0..a.len() {
        let (a, b, c, d) = (a[k], b[k], c[k], d[k]);
        xr[k] = T::multiply(simd, half, T::add(simd, a, c));
        xi[k] = T::multiply(simd, half, T::subtract(simd, b, d));
        yr[k] = T::multiply(simd, half, T::add(simd, b, d));
        yi[k] = T::multiply(simd, half, T::subtract(simd, c, a));
    }
}

/// Z = X + iY and Z' at the opposite harmonic, X̄ + iȲ; a harmonic that is its own opposite has real X and Y, and Z = Z'.
#[inline(always)]
fn put_together<T: Real, S: Simd>(
    simd: S,
    parts: &[Vec<T>; 4],
    own: &Range<usize>,
    mirror: &Range<usize>,
    rows: &mut Rows<T>,
) {
    let [xr, xi, yr, yi] = [0, 1, 2, 3].map(|k| T::vectors::<S>(&parts[k]));
    let vectors = xr.len();
    let (re, im) = (T::vectors_mut::<S>(&mut rows.re), T::vectors_mut::<S>(&mut rows.im));
    let (own, mirror) = (own.start / T::lanes::<S>(), mirror.start / T::lanes::<S>());
    for k in 0..vectors {
        let (xr, xi, yr, yi) = (xr[k], xi[k], yr[k], yi[k]);
        re[mirror + k] = T::add(simd, xr, yi);
        im[mirror + k] = T::subtract(simd, yr, xi);
        re[own + k] = T::subtract(simd, xr, yi);
        im[own + k] = T::add(simd, xi, yr);
    }
}
