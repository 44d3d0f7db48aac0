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
        // Rows of the cells that are loaded, then of those that are read: the others need no transform. A row fills registers.
        let lanes = T::lanes::<S>();
        let loaded = window.loaded.len().next_multiple_of(lanes);
        let read = window.read.len().next_multiple_of(lanes);
        let size = fourier.size();
        for (rows, load) in [&mut rows.re, &mut rows.im].into_iter().zip(load) {
            // The scratch may be that of a larger transform.
            let rows = &mut rows[..size * loaded];
            rows.fill(T::default());
            for (row, strip) in rows.chunks_exact_mut(loaded.max(1)).zip(strips.clone()) {
                let given = &load[strip * stride..][window.loaded.clone()];
                row[..given.len()].copy_from_slice(given);
            }
        }
        let whole = strips.start * stride..strips.end * stride;
        let real = tables.scalar && load[1][whole].iter().all(|value| *value == T::default());
        fourier.forward(simd, loaded, rows, other);
        let ranges = Ranges {
            cells: window.loaded.len(),
            read,
            origin: stride + window.read.start - window.loaded.start,
        };
        for harmonic in 0..transform.harmonics() {
            let opposite = (size - harmonic) % size;
            let places = |width: usize| [harmonic, opposite].map(|harmonic| harmonic * width..(harmonic + 1) * width);
            let [own, mirror] = places(loaded);
            let [own_out, mirror_out] = places(read);
            let lags = harmonic * transform.lags..(harmonic + 1) * transform.lags;
            if tables.scalar {
                let kernel = &tables.even[0][lags];
                let twice = harmonic != opposite;
                if real && twice {
                    // The product is real as well: what is opposite is the conjugate.
                    let [re, im, ..] = &mut *sums;
                    convolve_one(simd, kernel, [&rows.re[own.clone()], &rows.im[own]], &ranges, [re, im]);
                    other.re[own_out.clone()].copy_from_slice(&re[..read]);
                    other.im[own_out].copy_from_slice(&im[..read]);
                    other.re[mirror_out.clone()].copy_from_slice(&re[..read]);
                    negate(simd, &im[..read], &mut other.im[mirror_out]);
                    continue;
                }
                let places = [(own, own_out), (mirror, mirror_out)];
                for (place, out) in places.into_iter().take(if twice { 2 } else { 1 }) {
                    let values = [&rows.re[place.clone()], &rows.im[place]];
                    let out = [&mut other.re[out.clone()], &mut other.im[out]];
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
                put_together(simd, sums, &own_out, &mirror_out, other);
            }
        }
        fourier.backward(simd, read, other, rows);
        for (component, out) in [&other.re, &other.im].into_iter().zip(out) {
            for (row, strip) in component.chunks_exact(read.max(1)).zip(strips.clone()) {
                out[strip * stride..][window.read.clone()].copy_from_slice(&row[..window.read.len()]);
            }
        }
    }
}

/// Ranges that a convolution runs over.
struct Ranges {
    /// Number of cells with values.
    cells: usize,
    /// Number of places that are read, whole registers.
    read: usize,
    /// Place in a kernel of the lag from the first cell to the first place.
    origin: usize,
}

/// The sums over the cells of kernels a, b, c times values, complex x and y in real and imaginary parts: out_x = Σ a x − i b y,
/// out_y = Σ c y − i b x. Two vectors of places are summed up at a time, in registers.
#[inline(always)]
fn convolve<T: Real, S: Simd>(simd: S, kernels: [&[T]; 3], values: [&[T]; 4], ranges: &Ranges, mut out: [&mut [T]; 4]) {
    let lanes = T::lanes::<S>();
    let mut start = 0;
    while start + 2 * lanes <= ranges.read {
        convolve_block::<T, S, 2>(simd, kernels, values, ranges, start, &mut out);
        start += 2 * lanes;
    }
    if start < ranges.read {
        convolve_block::<T, S, 1>(simd, kernels, values, ranges, start, &mut out);
    }
}

/// The sums of [`convolve`] at so many vectors of places.
#[inline(always)]
fn convolve_block<T: Real, S: Simd, const VECTORS: usize>(
    simd: S,
    [a, b, c]: [&[T]; 3],
    [xr, xi, yr, yi]: [&[T]; 4],
    ranges: &Ranges,
    start: usize,
    out: &mut [&mut [T]; 4],
) {
    let block = VECTORS * T::lanes::<S>();
    let zero = [T::splat(simd, T::default()); VECTORS];
    let (mut sum_xr, mut sum_xi, mut sum_yr, mut sum_yi) = (zero, zero, zero, zero);
    for cell in 0..ranges.cells {
        let lag = ranges.origin + start - cell;
        let [a, b, c] = [a, b, c].map(|kernel| T::vectors::<S>(&kernel[lag..lag + block]));
        let [xr, xi, yr, yi] = [xr, xi, yr, yi].map(|values| T::splat(simd, values[cell]));
        for k in 0..VECTORS {
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
    for (out, sums) in out.iter_mut().zip([sum_xr, sum_xi, sum_yr, sum_yi]) {
        T::vectors_mut::<S>(&mut out[start..start + block]).copy_from_slice(&sums);
    }
}

/// Convolution with the kernel a alone, of one complex value (see [`convolve`]).
#[inline(always)]
fn convolve_one<T: Real, S: Simd>(simd: S, kernel: &[T], values: [&[T]; 2], ranges: &Ranges, mut out: [&mut [T]; 2]) {
    let lanes = T::lanes::<S>();
    let mut start = 0;
    while start + 2 * lanes <= ranges.read {
        convolve_one_block::<T, S, 2>(simd, kernel, values, ranges, start, &mut out);
        start += 2 * lanes;
    }
    if start < ranges.read {
        convolve_one_block::<T, S, 1>(simd, kernel, values, ranges, start, &mut out);
    }
}

/// The sums of [`convolve_one`] at so many vectors of places.
#[inline(always)]
fn convolve_one_block<T: Real, S: Simd, const VECTORS: usize>(
    simd: S,
    kernel: &[T],
    [re, im]: [&[T]; 2],
    ranges: &Ranges,
    start: usize,
    out: &mut [&mut [T]; 2],
) {
    let block = VECTORS * T::lanes::<S>();
    let zero = [T::splat(simd, T::default()); VECTORS];
    let (mut sum_re, mut sum_im) = (zero, zero);
    for cell in 0..ranges.cells {
        let lag = ranges.origin + start - cell;
        let kernel = T::vectors::<S>(&kernel[lag..lag + block]);
        let (re, im) = (T::splat(simd, re[cell]), T::splat(simd, im[cell]));
        for k in 0..VECTORS {
            sum_re[k] = T::multiply_add(simd, kernel[k], re, sum_re[k]);
            sum_im[k] = T::multiply_add(simd, kernel[k], im, sum_im[k]);
        }
    }
    for (out, sums) in out.iter_mut().zip([sum_re, sum_im]) {
        T::vectors_mut::<S>(&mut out[start..start + block]).copy_from_slice(&sums);
    }
}

/// Writes −x.
#[inline(always)]
fn negate<T: Real, S: Simd>(simd: S, values: &[T], out: &mut [T]) {
    let zero = T::splat(simd, T::default());
    for (out, value) in T::vectors_mut::<S>(out).iter_mut().zip(T::vectors::<S>(values)) {
        *out = T::subtract(simd, zero, *value);
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
    // Scratch is as long as a row of the grid, the vectors as the rows that are transformed.
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
    let vectors = own.len() / T::lanes::<S>();
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
