//! Displacement of all cells of a grid by uniform loads on all cells, as a product.
//!
//! The influence of a cell on another depends on the difference of their places only. Across the strips the product is
//! therefore a discrete convolution, which Fourier's transform over the strips makes a product of each harmonic with its own: exact
//! to round-off, and its work grows as the strips times their logarithm. Along the strips it is summed directly, cell by cell: at
//! some 24 cells that is quicker than a second transform.
//!
//! A kernel that is even in y has real harmonics K̂ = Σ K cos, one that is odd has −i times the real Ŝ = Σ K sin. All products
//! that a contact needs have the form
//!
//! out_x = A τ_x + B τ_y,  out_y = B τ_x + C τ_y,  A and C even, B odd in y,
//!
//! so that the two components travel as real and imaginary part through one transform, and there is one product:
//! A, B, C are those of displacement by shear; displacement by pressure has p for τ_x and nothing for τ_y; lift by
//! shear is out_x of the same tables; approach by pressure has A alone.

mod convolution;

use super::grid::Grid;
use crate::numerics::dense;
use crate::numerics::fourier::{Fourier, Rows, good_size};
use crate::numerics::real::{BLOCK, Real};
use crate::numerics::single::rounded;
use convolution::{Kernels, Product};
use std::f64::consts::TAU;
use std::ops::Range;

/// A place in a grid relative to another: cells ahead and strips to the left.
type Lag = (isize, isize);

/// The harmonics of the three kernels of a product: row by row over the harmonics, each with the lags along x.
#[derive(Debug, Clone)]
pub struct Tables<T> {
    /// Kernels A and C.
    even: [Vec<T>; 2],
    /// Kernel B.
    odd: Vec<T>,
}

/// The harmonics of the kernel A alone, as those of [`Tables`]: a product of one component.
#[derive(Debug, Clone)]
pub struct ScalarTables<T> {
    even: Vec<T>,
}

/// The harmonics of the kernels A and B alone, as those of [`Tables`]: a product whose load has no y component, and which needs no C.
#[derive(Debug, Clone)]
pub struct SourceTables {
    even: Vec<f64>,
    odd: Vec<f64>,
    ends: Vec<EndTables>,
}

/// Further effects of the load of one cell of each strip, in proportion to it: the harmonics of the kernels A and B of that, row by row with the
/// cells that it acts on.
#[derive(Debug, Clone)]
pub struct EndTables {
    cell: usize,
    even: Vec<f64>,
    odd: Vec<f64>,
}

/// Everything that products on a grid share for one number of harmonics.
#[derive(Debug, Clone)]
pub struct Transform {
    /// Lags along x in a row of a table, of which that with number `stride` is 0.
    lags: usize,
    stride: usize,
    single: Fourier<f32>,
    double: Fourier<f64>,
}

/// ProductScratch of a product.
#[derive(Debug, Clone)]
pub struct ProductScratch<T> {
    rows: Rows<T>,
    other: Rows<T>,
    /// Transforms of the x and of the y component at one harmonic, real and imaginary part.
    parts: [Vec<T>; 4],
    /// Transforms of the product at one harmonic, in the order of `parts`.
    sums: [Vec<T>; 4],
}

/// The part of a grid that a product reads and writes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Window {
    /// Strips that are loaded and read.
    pub strips: Range<usize>,
    /// Cells that are loaded in any of them.
    pub loaded: Range<usize>,
    /// Cells that are read in any of them.
    pub read: Range<usize>,
}

impl Window {
    /// Window over all of a grid.
    pub fn whole(grid: &Grid) -> Window {
        Window {
            strips: 0..grid.strips,
            loaded: 0..grid.cells,
            read: 0..grid.cells,
        }
    }

    /// Places on the grid of the cells that are read, strip by strip.
    pub fn rows(&self, grid: &Grid) -> impl Iterator<Item = Range<usize>> {
        let (stride, read) = (grid.stride(), self.read.clone());
        let strips = self.strips.clone();
        strips.map(move |strip| strip * stride + read.start..strip * stride + read.end)
    }
}

impl Transform {
    /// Transform for loads and displacements on up to so many neighbouring strips of a grid.
    pub fn new(grid: &Grid, strips: usize) -> Transform {
        let (stride, size) = (grid.stride(), good_size(2 * strips - 1));
        Transform {
            lags: 2 * stride + BLOCK,
            stride,
            single: Fourier::new(size),
            double: Fourier::new(size),
        }
    }

    /// Number of neighbouring strips that it serves.
    pub fn strips(&self) -> usize {
        self.double.size().div_ceil(2)
    }

    /// Harmonics 0 … P/2.
    fn harmonics(&self) -> usize {
        self.double.size() / 2 + 1
    }

    /// ProductScratch for products in single or double precision.
    pub fn scratch<T: Real>(&self) -> ProductScratch<T> {
        let rows = Rows::new(self.double.size(), self.stride);
        ProductScratch {
            other: rows.clone(),
            rows,
            parts: std::array::from_fn(|_| vec![T::default(); self.stride]),
            sums: std::array::from_fn(|_| vec![T::default(); self.stride]),
        }
    }

    /// Values of one of a table's kernels.
    pub fn table_len(&self) -> usize {
        self.harmonics() * self.lags
    }

    /// Largest lags along and across that a table is made of.
    pub fn largest_lags(&self) -> [usize; 2] {
        [self.lags - self.stride, (self.double.size() - 1) / 2]
    }

    /// The tables of the kernels A, B and C, as functions of the lag.
    pub fn tables(&self, a: impl Fn(Lag) -> f64, b: impl Fn(Lag) -> f64, c: impl Fn(Lag) -> f64) -> Tables<f64> {
        Tables {
            even: [self.table(f64::cos, a), self.table(f64::cos, c)],
            odd: self.table(f64::sin, b),
        }
    }

    /// The tables of a kernel A alone.
    pub fn scalar_tables(&self, a: impl Fn(Lag) -> f64) -> ScalarTables<f64> {
        ScalarTables {
            even: self.table(f64::cos, a),
        }
    }

    /// The tables of kernels A and B alone, and of what else some cells do.
    pub fn source_tables(&self, a: impl Fn(Lag) -> f64, b: impl Fn(Lag) -> f64, ends: Vec<EndTables>) -> SourceTables {
        SourceTables {
            even: self.table(f64::cos, a),
            odd: self.table(f64::sin, b),
            ends,
        }
    }

    /// The tables of kernels A and B with which a cell does something else than by its lag, as functions of the cell that it acts on and the
    /// strips to the left; along x there are so many cells.
    pub fn end_tables(
        &self,
        cell: usize,
        cells: usize,
        a: impl Fn(usize, isize) -> f64,
        b: impl Fn(usize, isize) -> f64,
    ) -> EndTables {
        let table = |wave, kernel: &dyn Fn(usize, isize) -> f64| {
            self.table(wave, |(lag, across)| match lag.checked_add_unsigned(self.stride) {
                Some(on) if (on as usize) < cells => kernel(on as usize, across),
                _ => 0.0,
            })
        };
        EndTables {
            cell,
            even: table(f64::cos, &a),
            odd: table(f64::sin, &b),
        }
    }

    /// Harmonics of a kernel that is even across the strips, for cosines, or odd, for sines.
    fn table(&self, wave: fn(f64) -> f64, kernel: impl Fn(Lag) -> f64) -> Vec<f64> {
        let size = self.double.size();
        // The inverse transform lacks 1/P.
        let share = 1.0 / size as f64;
        let waves: Vec<f64> = (0..size)
            .map(|turn| share * wave(TAU * turn as f64 / size as f64))
            .collect();
        let mut table = vec![0.0; self.table_len()];
        let mut values = vec![0.0; self.lags];
        for across in 0..=self.largest_lags()[1] {
            for (lag, value) in values.iter_mut().enumerate() {
                *value = kernel((lag as isize - self.stride as isize, across as isize));
            }
            // To the left and to the right.
            let both = if across == 0 { 1.0 } else { 2.0 };
            for (harmonic, row) in table.chunks_exact_mut(self.lags).enumerate() {
                dense::add_multiple(&values, both * waves[harmonic * across % size], row);
            }
        }
        table
    }

    /// Places of a harmonic in a table.
    fn lags_of(&self, harmonic: usize) -> Range<usize> {
        harmonic * self.lags..(harmonic + 1) * self.lags
    }

    /// The product: `out` = tables · `load` on the grid, with x and y components of those that the tables have two of. What is not read stays.
    pub fn apply<'a, K: Kernels>(
        &'a self,
        tables: &'a K,
        window: &'a Window,
        load: K::Load<'a>,
        out: K::Out<'a>,
        scratch: &'a mut ProductScratch<K::Real>,
    ) {
        dense::with_vectors(Product {
            transform: self,
            tables,
            window,
            load,
            out,
            scratch,
        });
    }
}

/// A precision that products are computed in.
pub trait Precision: Real + 'static {
    /// Transform over the strips in this precision.
    fn fourier(transform: &Transform) -> &Fourier<Self>;
}

impl Precision for f32 {
    fn fourier(transform: &Transform) -> &Fourier<f32> {
        &transform.single
    }
}

impl Precision for f64 {
    fn fourier(transform: &Transform) -> &Fourier<f64> {
        &transform.double
    }
}

/// Combination `here` · K(lag) + `ahead` · K(lag + `shift`) of a kernel with itself.
#[derive(Debug, Clone, Copy)]
pub struct ShiftedKernels {
    /// Weight of the kernel as it is.
    pub here: f64,
    /// Weight of the shifted kernel.
    pub ahead: f64,
    /// Shift of the lag along x, in cells.
    pub shift: isize,
}

impl Tables<f64> {
    /// Combines each kernel with itself at a shifted lag, in double and single precision.
    pub fn combine(
        &self,
        transform: &Transform,
        combination: ShiftedKernels,
        double: &mut Tables<f64>,
        single: &mut Tables<f32>,
    ) {
        let ShiftedKernels { here, ahead, shift } = combination;
        let from = [&self.even[0], &self.even[1], &self.odd];
        let [first, second] = &mut double.even;
        let [first_single, second_single] = &mut single.even;
        let to = [
            (first, first_single),
            (second, second_single),
            (&mut double.odd, &mut single.odd),
        ];
        for (from, (double, single)) in from.into_iter().zip(to) {
            let rows = from.chunks_exact(transform.lags);
            let outs = double
                .chunks_exact_mut(transform.lags)
                .zip(single.chunks_exact_mut(transform.lags));
            for (from, (double, single)) in rows.zip(outs) {
                let count = transform.lags;
                for lag in 0..count {
                    let shifted = (lag as isize + shift).clamp(0, count as isize - 1) as usize;
                    double[lag] = here * from[lag] + ahead * from[shifted];
                    single[lag] = double[lag] as f32;
                }
            }
        }
    }

    /// Tables in single precision.
    pub fn single(&self) -> Tables<f32> {
        Tables {
            even: [rounded(&self.even[0]), rounded(&self.even[1])],
            odd: rounded(&self.odd),
        }
    }
}

impl ScalarTables<f64> {
    /// Tables in single precision.
    pub fn single(&self) -> ScalarTables<f32> {
        ScalarTables {
            even: rounded(&self.even),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Kernels without symmetry along x, even and odd across.
    fn kernels() -> [fn(Lag) -> f64; 3] {
        [
            |(x, y)| 1.0 / (2.0 + (x as f64 - 0.3).powi(2) + (y * y) as f64),
            |(x, y)| y as f64 / (1.0 + (x as f64 + 0.7).powi(2) + (y * y) as f64),
            |(x, y)| (-(0.1 * x as f64 - 0.2).powi(2)).exp() / (1.0 + y.abs() as f64),
        ]
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(30))]
        /// Product against the whole matrix, in both precisions, for any part of any grid.
        #[test]
        fn the_product_is_that_of_the_whole_matrix(
            cells in 3_usize..30, strips in 1_usize..14, from in 0.0..0.5_f64, to in 0.5..1.0_f64, seed in 0.0..6.0_f64,
        ) {
            let grid = Grid::new(cells, strips, 1.0, 1.0);
            let part = |count: usize| -> Range<usize> {
                let size = count as f64;
                let (first, end): (f64, f64) = (from * size, to * size);
                first as usize..(end.ceil() as usize).max(1)
            };
            let seen = if seed < 3.0 { 0..cells } else { cells / 3..cells - cells / 4 };
            let window = Window { strips: part(strips), loaded: part(cells), read: seen };
            let transform = Transform::new(&grid, window.strips.len());
            let [a, b, c] = kernels();
            let tables = transform.tables(a, b, c);
            let (at_end, odd_at_end) = (|on: usize, across: isize| a((2 * on as isize, across)), |on: usize, across: isize| b((on as isize, across)));
            let ends = [0, cells - 1].map(|end| transform.end_tables(end, cells, at_end, odd_at_end));
            let (scalar, source) = (transform.scalar_tables(a), transform.source_tables(a, b, ends.to_vec()));
            let loaded = |strip: usize, cell: usize| window.strips.contains(&strip) && window.loaded.contains(&cell);
            let mut load = [vec![0.0; grid.len()], vec![0.0; grid.len()]];
            for strip in 0..strips {
                for cell in (0..cells).filter(|&cell| loaded(strip, cell)) {
                    let place = grid.place(strip, cell);
                    load[0][place] = (seed + place as f64).sin();
                    load[1][place] = (2.0 * seed + 1.3 * place as f64).cos();
                }
            }
            let mut out = [vec![f64::NAN; grid.len()], vec![f64::NAN; grid.len()]];
            let (mut scalars, mut sources) = (out.clone(), out.clone());
            let mut singles = [vec![f32::NAN; grid.len()], vec![f32::NAN; grid.len()]];
            let given = load.clone().map(|load| load.iter().map(|&value| value as f32).collect::<Vec<f32>>());
            {
                let [x, y] = &mut out;
                transform.apply(&tables, &window, [&load[0], &load[1]], [x, y], &mut transform.scratch());
                for (scalar_out, load) in scalars.iter_mut().zip(&load) {
                    transform.apply(&scalar, &window, load, scalar_out, &mut transform.scratch());
                }
                let [x, y] = &mut sources;
                transform.apply(&source, &window, &load[0], [x, y], &mut transform.scratch());
                let [x, y] = &mut singles;
                transform.apply(&tables.single(), &window, [&given[0], &given[1]], [x, y], &mut transform.scratch());
            }
            for strip in window.strips.clone() {
                for cell in window.read.clone() {
                    let (mut sum, mut alone, mut of_source) = ([0.0; 2], [0.0; 2], [0.0; 2]);
                    for strip_loaded in 0..strips {
                        for cell_loaded in 0..cells {
                            let lag = (cell as isize - cell_loaded as isize, strip as isize - strip_loaded as isize);
                            let place = grid.place(strip_loaded, cell_loaded);
                            let (x, y) = (load[0][place], load[1][place]);
                            sum[0] += a(lag) * x + b(lag) * y;
                            sum[1] += b(lag) * x + c(lag) * y;
                            alone[0] += a(lag) * x;
                            alone[1] += a(lag) * y;
                            of_source[0] += a(lag) * x;
                            of_source[1] += b(lag) * x;
                            if cell_loaded == 0 || cell_loaded == cells - 1 {
                                of_source[0] += at_end(cell, lag.1) * x;
                                of_source[1] += odd_at_end(cell, lag.1) * x;
                            }
                        }
                    }
                    let place = grid.place(strip, cell);
                    for component in 0..2 {
                        // Round-off of sums over a few hundred terms of order 1.
                        prop_assert!((out[component][place] - sum[component]).abs() < 1e-12);
                        prop_assert!((scalars[component][place] - alone[component]).abs() < 1e-12);
                        prop_assert!((sources[component][place] - of_source[component]).abs() < 1e-12);
                        prop_assert!((f64::from(singles[component][place]) - sum[component]).abs() < 1e-4);
                    }
                }
            }
        }
    }
}
