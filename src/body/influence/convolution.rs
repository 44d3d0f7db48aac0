//! The product of the tables with a load: transforms over the strips, convolutions along them.

use super::{Precision, ProductScratch, ScalarTables, SourceTables, Tables, Transform, Window};
use crate::numerics::fourier::Rows;
use crate::numerics::real::Real;
use pulp::{Simd, WithSimd};
use std::ops::Range;

/// Tables of kernels, with the product that they stand for.
pub trait Kernels: Sized {
    /// Precision of the tables, and of their product.
    type Real: Precision;
    /// Load on the grid.
    type Load<'a>;
    /// Result on the grid.
    type Out<'a>;

    /// Computes a product by the vectors that a machine has.
    fn multiply<S: Simd>(simd: S, product: Product<'_, Self>);
}

/// A product of tables with a load.
pub struct Product<'a, K: Kernels> {
    pub(super) transform: &'a Transform,
    pub(super) tables: &'a K,
    pub(super) window: &'a Window,
    pub(super) load: K::Load<'a>,
    pub(super) out: K::Out<'a>,
    pub(super) scratch: &'a mut ProductScratch<K::Real>,
}

impl<K: Kernels> WithSimd for Product<'_, K> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        K::multiply(simd, self);
    }
}

impl<T: Precision> Kernels for Tables<T> {
    type Real = T;
    type Load<'a> = [&'a [T]; 2];
    type Out<'a> = [&'a mut [T]; 2];

    #[inline(always)]
    fn multiply<S: Simd>(simd: S, product: Product<'_, Self>) {
        let Product {
            transform,
            tables,
            window,
            load,
            out,
            scratch,
        } = product;
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
        let fourier = T::fourier(transform);
        let size = fourier.size();
        let all = 0..window.loaded.len();
        for (rows, load) in [&mut rows.re, &mut rows.im].into_iter().zip(load) {
            take_load(transform, window, load, all.clone(), &mut rows[..size * loaded], loaded);
        }
        fourier.forward(simd, loaded, rows, other);
        let ranges = Ranges::new(transform, window, read);
        for harmonic in 0..transform.harmonics() {
            let [own, mirror] = places(size, harmonic, loaded);
            let lags = transform.lags_of(harmonic);
            let kernels = [
                &tables.even[0][lags.clone()],
                &tables.odd[lags.clone()],
                &tables.even[1][lags],
            ];
            let [xr, xi, yr, yi] = &mut *parts;
            take_apart(simd, rows, &own, &mirror, [xr, xi, yr, yi]);
            let [sum_xr, sum_xi, sum_yr, sum_yi] = &mut *sums;
            convolve(
                simd,
                kernels,
                [xr, xi, yr, yi],
                &ranges,
                [sum_xr, sum_xi, sum_yr, sum_yi],
            );
            let [own, mirror] = places(size, harmonic, read);
            put_together(simd, [sum_xr, sum_xi, sum_yr, sum_yi], &own, &mirror, other);
        }
        give_both(simd, transform, window, [other, rows], out);
    }
}

/// The load is real: the first half of the cells travels as real part and the other half as imaginary part through a transform that is half
/// as wide, and so does the result.
impl<T: Precision> Kernels for ScalarTables<T> {
    type Real = T;
    type Load<'a> = &'a [T];
    type Out<'a> = &'a mut [T];

    #[inline(always)]
    fn multiply<S: Simd>(simd: S, product: Product<'_, Self>) {
        let Product {
            transform,
            tables,
            window,
            load,
            out,
            scratch,
        } = product;
        let ProductScratch {
            rows,
            other,
            parts: [re, im, ..],
            sums: [sum_re, sum_im, ..],
        } = scratch;
        let fourier = T::fourier(transform);
        let (size, half) = (fourier.size(), half::<T, S>(&window.read));
        let loaded = transform_halves(simd, transform, window, load, rows, other);
        let ranges = Ranges::new(transform, window, 2 * half);
        for harmonic in 0..transform.harmonics() {
            let [own, mirror] = places(size, harmonic, loaded);
            take_halves_apart(simd, rows, &own, &mirror, [re, im]);
            let kernel = &tables.even[transform.lags_of(harmonic)];
            convolve_one(simd, kernel, [re, im], &ranges, [sum_re, sum_im]);
            let ((first_re, second_re), (first_im, second_im)) = (sum_re.split_at(half), sum_im.split_at(half));
            let [own, mirror] = places(size, harmonic, half);
            put_together(simd, [first_re, first_im, second_re, second_im], &own, &mirror, other);
        }
        fourier.backward(simd, half, other, rows);
        let count = window.read.len();
        give(transform, window, &other.re, half, 0..half.min(count), out);
        give(transform, window, &other.im, half, half.min(count)..count, out);
    }
}

/// The load travels as that of [`ScalarTables`], the result as that of [`Tables`]: out_x = A τ, out_y = B τ. What its ends do besides is added
/// to the transform of the result: a sum over strips and cells for each strip would take longer than all the rest.
impl Kernels for SourceTables {
    type Real = f64;
    type Load<'a> = &'a [f64];
    type Out<'a> = [&'a mut [f64]; 2];

    #[inline(always)]
    fn multiply<S: Simd>(simd: S, product: Product<'_, Self>) {
        let Product {
            transform,
            tables,
            window,
            load,
            out,
            scratch,
        } = product;
        let ProductScratch {
            rows,
            other,
            parts: [re, im, ..],
            sums: [sum_xr, sum_xi, sum_yr, sum_yi],
        } = scratch;
        let size = f64::fourier(transform).size();
        let read = window.read.len().next_multiple_of(f64::lanes::<S>());
        let loaded = transform_halves(simd, transform, window, load, rows, other);
        let ranges = Ranges::new(transform, window, read);
        for harmonic in 0..transform.harmonics() {
            let [own, mirror] = places(size, harmonic, loaded);
            take_halves_apart(simd, rows, &own, &mirror, [re, im]);
            let lags = transform.lags_of(harmonic);
            convolve_one(simd, &tables.even[lags.clone()], [re, im], &ranges, [sum_xr, sum_xi]);
            // The transform of an odd kernel is −i b: the product's is Σ b im − i Σ b re.
            convolve_one(simd, &tables.odd[lags.clone()], [im, re], &ranges, [sum_yr, sum_yi]);
            for end in tables.ends.iter().filter(|end| window.loaded.contains(&end.cell)) {
                let cell = end.cell - window.loaded.start;
                let [even, odd] = [&end.even, &end.odd].map(|table| &table[lags.clone()][window.read.start..][..read]);
                let values = [re[cell], im[cell]];
                add_product(simd, even, values, [sum_xr, sum_xi]);
                add_product(simd, odd, [values[1], values[0]], [sum_yr, sum_yi]);
            }
            negate(simd, &mut sum_yi[..read]);
            let [own, mirror] = places(size, harmonic, read);
            put_together(simd, [sum_xr, sum_xi, sum_yr, sum_yi], &own, &mirror, other);
        }
        give_both(simd, transform, window, [other, rows], out);
    }
}

/// Transforms the product of two components back and copies it from real and imaginary part to where it is read.
#[inline(always)]
fn give_both<T: Precision, S: Simd>(
    simd: S,
    transform: &Transform,
    window: &Window,
    [rows, other]: [&mut Rows<T>; 2],
    out: [&mut [T]; 2],
) {
    let width = window.read.len().next_multiple_of(T::lanes::<S>());
    T::fourier(transform).backward(simd, width, rows, other);
    for (component, out) in [&rows.re, &rows.im].into_iter().zip(out) {
        give(transform, window, component, width, 0..window.read.len(), out);
    }
}

/// Places of a harmonic and of the opposite one in rows of a width.
#[inline(always)]
fn places(size: usize, harmonic: usize, width: usize) -> [Range<usize>; 2] {
    let opposite = (size - harmonic) % size;
    [harmonic, opposite].map(|harmonic| harmonic * width..(harmonic + 1) * width)
}

/// Half of the cells, in whole registers.
#[inline(always)]
fn half<T: Real, S: Simd>(cells: &Range<usize>) -> usize {
    cells.len().div_ceil(2).next_multiple_of(T::lanes::<S>())
}

/// Copies some of the cells that are loaded into rows of a width, filled up with zeros. The scratch may be that of a larger transform.
#[inline(always)]
fn take_load<T: Real>(
    transform: &Transform,
    window: &Window,
    load: &[T],
    cells: Range<usize>,
    rows: &mut [T],
    width: usize,
) {
    rows.fill(T::default());
    for (row, strip) in rows.chunks_exact_mut(width.max(1)).zip(window.strips.clone()) {
        let given = &load[strip * transform.stride..][window.loaded.clone()][cells.clone()];
        row[..given.len()].copy_from_slice(given);
    }
}

/// Copies some of the cells that are read from rows of a width.
#[inline(always)]
fn give<T: Real>(transform: &Transform, window: &Window, rows: &[T], width: usize, cells: Range<usize>, out: &mut [T]) {
    for (row, strip) in rows.chunks_exact(width.max(1)).zip(window.strips.clone()) {
        let out = &mut out[strip * transform.stride..][window.read.clone()][cells.clone()];
        out.copy_from_slice(&row[..cells.len()]);
    }
}

/// Transforms a load of one component, its halves as real and imaginary parts. Returns the width of the rows.
#[inline(always)]
fn transform_halves<T: Precision, S: Simd>(
    simd: S,
    transform: &Transform,
    window: &Window,
    load: &[T],
    rows: &mut Rows<T>,
    other: &mut Rows<T>,
) -> usize {
    let fourier = T::fourier(transform);
    let (half, count) = (half::<T, S>(&window.loaded), window.loaded.len());
    let size = fourier.size() * half;
    let halves = [0..half.min(count), half.min(count)..count];
    for (rows, cells) in [&mut rows.re, &mut rows.im].into_iter().zip(halves) {
        take_load(transform, window, load, cells, &mut rows[..size], half);
    }
    fourier.forward(simd, half, rows, other);
    half
}

/// Separates the transforms of the two halves of a load, and writes them one after the other.
#[inline(always)]
fn take_halves_apart<T: Real, S: Simd>(
    simd: S,
    rows: &Rows<T>,
    own: &Range<usize>,
    mirror: &Range<usize>,
    [re, im]: [&mut Vec<T>; 2],
) {
    let ((first_re, second_re), (first_im, second_im)) = (re.split_at_mut(own.len()), im.split_at_mut(own.len()));
    take_apart(simd, rows, own, mirror, [first_re, first_im, second_re, second_im]);
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

impl Ranges {
    #[inline(always)]
    fn new(transform: &Transform, window: &Window, read: usize) -> Ranges {
        Ranges {
            cells: window.loaded.len(),
            read,
            origin: transform.stride + window.read.start - window.loaded.start,
        }
    }
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

/// Adds a kernel times a complex value.
#[inline(always)]
fn add_product<T: Real, S: Simd>(simd: S, kernel: &[T], value: [T; 2], out: [&mut [T]; 2]) {
    for (value, out) in value.into_iter().zip(out) {
        let value = T::splat(simd, value);
        for (out, kernel) in T::vectors_mut::<S>(out).iter_mut().zip(T::vectors::<S>(kernel)) {
            *out = T::multiply_add(simd, *kernel, value, *out);
        }
    }
}

/// Changes the sign.
#[inline(always)]
fn negate<T: Real, S: Simd>(simd: S, values: &mut [T]) {
    let zero = T::splat(simd, T::default());
    for value in T::vectors_mut::<S>(values) {
        *value = T::subtract(simd, zero, *value);
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
    [xr, xi, yr, yi]: [&mut [T]; 4],
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
    parts: [&[T]; 4],
    own: &Range<usize>,
    mirror: &Range<usize>,
    rows: &mut Rows<T>,
) {
    let [xr, xi, yr, yi] = parts.map(|part| T::vectors::<S>(part));
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
