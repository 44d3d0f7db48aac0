//! Displacement of the surface by the heat in the rail: that of the cells, and that which the rail holds ahead of and behind the window.
//!
//! A thin hot layer of heat content Θ on a half-space lifts its surface by 2(1+ν)α Θ and draws it along by
//! u = (1+ν)α/π ∫ Θ (x, y)/r³ dA. Outside of the window each strip is taken to hold, up to the ends of the rail, what it holds
//! in its cell at that end: heat that has left the surface goes deeper, but is kept.

use crate::body::cell_integrals::CellIntegrals;
use crate::body::grid::Grid;
use crate::body::half_plane::HalfPlane;
use crate::body::half_space::{Kernel, Rectangle, X_OVER_R3, Y_OVER_R3};
use crate::body::influence::{self, SourceTables, Transform, Window};
use crate::numerics::dense::{self, QUAD, largest};
use crate::parameters::Parameters;
use crate::transport::strips::Side;
use std::f64::consts::PI;

/// Displacement by heat contents.
pub struct Expansion {
    /// Upward displacement by the heat content of a cell, scaled, per `K m`.
    pub bulge: f64,
    /// Displacement u along x and y by the heat content of the cells, scaled, per `K m`.
    cells: SourceTables<f64>,
    /// `cells` in single precision.
    cells_single: SourceTables<f32>,
    /// Displacement u by the heat content of the rail left and right of the window, along x and y, scaled, per `K m`: for a strip
    /// that is 0, 1, … strips to the left of the hot one, a row over its cells.
    outside: [[Vec<f64>; 2]; 2],
}

/// Buffers of [`Expansion::displace`].
pub struct ExpansionBuffers {
    /// Displacement u on the grid, along x and y, scaled.
    pub displacement: [Vec<f64>; 2],
    /// Heat content on the grid, `K m`.
    content: Vec<f64>,
    /// Whether `displacement` is that of `content`.
    known: bool,
    /// Change of the content, `K m`; in single precision, and its displacement.
    change: Vec<f64>,
    change_single: Vec<f32>,
    displacement_single: [Vec<f32>; 2],
    products: influence::ProductScratch<f64>,
    products_single: influence::ProductScratch<f32>,
}

impl ExpansionBuffers {
    /// Buffers for a grid.
    pub fn new(grid: &Grid, transform: &Transform) -> ExpansionBuffers {
        let on_grid = || vec![0.0; grid.len()];
        let single = || vec![0.0; grid.len()];
        ExpansionBuffers {
            displacement: [on_grid(), on_grid()],
            content: on_grid(),
            known: false,
            change: on_grid(),
            change_single: single(),
            displacement_single: [single(), single()],
            products: transform.scratch(),
            products_single: transform.scratch(),
        }
    }

    /// Forgets the displacement of the step before: a step follows from its state alone.
    pub fn start_step(&mut self) {
        self.known = false;
    }
}

impl Expansion {
    /// Displacement of a rail of the given half-length `m`, with displacements in units of `scale` `m`.
    pub fn new(parameters: &Parameters, grid: &Grid, transform: &Transform, rail: f64, scale: f64) -> Expansion {
        let body = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        let swelling = (1.0 + body.poisson_ratio) * parameters.thermal_expansion / scale;
        let displacement = swelling / PI;
        let lags = transform.largest_lags();
        let [along, across] = [X_OVER_R3, Y_OVER_R3].map(|kernel| CellIntegrals::new(grid, lags, &kernel));
        let cells = transform.source_tables(|lag| displacement * along.at(lag), |lag| displacement * across.at(lag));
        let beyond = Rectangle {
            half_length: 0.5 * (rail - grid.half_length()),
            half_breadth: 0.5 * grid.breadth,
        };
        let middle = 0.5 * (rail + grid.half_length());
        let rows = |middle: f64, kernel: &Kernel| {
            let mut rows = vec![0.0; grid.len()];
            for strip in 0..grid.strips {
                for (cell, value) in rows[grid.row(strip)].iter_mut().enumerate() {
                    *value = displacement * beyond.integral(kernel, grid.x(cell) - middle, strip as f64 * grid.breadth);
                }
            }
            rows
        };
        Expansion {
            bulge: 2.0 * swelling,
            cells_single: cells.single(),
            cells,
            outside: [-middle, middle].map(|middle| [X_OVER_R3, Y_OVER_R3].map(|kernel| rows(middle, &kernel))),
        }
    }

    /// Computes into the buffers the displacement u by the heat that displaces the cells upward by `upward`, strip by strip, or the
    /// change of u by a change of `upward`. Returns whether there is any.
    ///
    /// Where `upward` has changed by no more than `small` since the last call, the change of u is added in single precision, at half the cost.
    pub fn displace(
        &self,
        grid: &Grid,
        transform: &Transform,
        upward: &[f64],
        small: f64,
        buffers: &mut ExpansionBuffers,
    ) -> bool {
        if self.bulge == 0.0 || largest(upward) == 0.0 {
            return false;
        }
        let window = Window::whole(grid);
        let ExpansionBuffers {
            displacement,
            content,
            known,
            change,
            change_single,
            displacement_single,
            products,
            products_single,
        } = buffers;
        let per_displacement = 1.0 / self.bulge;
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (strip, upward) in upward.chunks_exact(grid.cells).enumerate() {
                    let row = grid.row(strip);
                    let contents = content[row.clone()].iter_mut().zip(upward);
                    let changes = change[row.clone()].iter_mut().zip(&mut change_single[row]);
                    for ((content, upward), (change, single)) in contents.zip(changes) {
                        let now = upward * per_displacement;
                        *change = now - *content;
                        *single = *change as f32;
                        *content = now;
                    }
                }
            },
        );
        if *known && self.bulge * largest(change) <= small {
            let [x, y] = &mut *displacement_single;
            transform.apply(&self.cells_single, &window, change_single, [x, y], products_single);
            dense::vectorised(
                #[inline(always)]
                |arithmetic| {
                    for (displacement, change) in displacement.iter_mut().zip(&*displacement_single) {
                        arithmetic.add_multiple_of_single(change, 1.0, displacement);
                    }
                },
            );
            self.add_outside(grid, change, displacement);
        } else {
            let [x, y] = &mut *displacement;
            transform.apply(&self.cells, &window, content, [x, y], products);
            self.add_outside(grid, content, displacement);
            *known = true;
        }
        true
    }

    /// Adds the displacement u by the heat of the rail outside of the window, where each strip holds what it holds in its cell at that end.
    fn add_outside(&self, grid: &Grid, content: &[f64], displacement: &mut [Vec<f64>; 2]) {
        for (side, end) in [(Side::Left, 0), (Side::Right, grid.cells - 1)] {
            let content = |strip: usize| content[grid.place(strip, end)];
            if (0..grid.strips).any(|strip| content(strip) != 0.0) {
                self.add_side(grid, side, content, displacement);
            }
        }
    }

    /// Adds the displacement u by the heat of the rail on one side of the window, where each strip holds what `content` says.
    fn add_side(&self, grid: &Grid, side: Side, content: impl Fn(usize) -> f64, displacement: &mut [Vec<f64>; 2]) {
        let [along, across] = &self.outside[side as usize];
        let [x, y] = displacement;
        dense::vectorised(
            #[inline(always)]
            |arithmetic| {
                for strip in 0..grid.strips {
                    let (x, y) = (&mut x[grid.row(strip)], &mut y[grid.row(strip)]);
                    for first in (0..grid.strips).step_by(QUAD) {
                        // The last of them may be fewer: the others hold nothing.
                        let hot: [usize; QUAD] = std::array::from_fn(|k| (first + k).min(grid.strips - 1));
                        let own = std::array::from_fn(|k| if first + k < grid.strips { content(hot[k]) } else { 0.0 });
                        if own == [0.0; QUAD] {
                            continue;
                        }
                        let kernels = hot.map(|hot| grid.row(strip.abs_diff(hot)));
                        arithmetic.add_quad(kernels.clone().map(|row| &along[row]), own, x);
                        // u_y is odd across the strips.
                        let sideways = std::array::from_fn(|k| if strip >= hot[k] { own[k] } else { -own[k] });
                        arithmetic.add_quad(kernels.map(|row| &across[row]), sideways, y);
                    }
                }
            },
        );
    }
}
