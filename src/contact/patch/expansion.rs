//! Displacement of the surface by the heat in the rail: that of the cells, and that which the rail holds ahead of and behind the window.
//!
//! A thin hot layer of heat content Θ on a half-space lifts its surface by 2(1+ν)α Θ and draws it along by
//! u = (1+ν)α/π ∫ Θ (x, y)/r³ dA. Outside of the window each strip is taken to hold, up to the ends of the rail, what it holds
//! in its cell at that end: heat that has left the surface goes deeper, but is kept.

use crate::body::cell_integrals::CellIntegrals;
use crate::body::grid::Grid;
use crate::body::half_plane::HalfPlane;
use crate::body::half_space::{Kernel, Rectangle, X_OVER_R3, Y_OVER_R3};
use crate::body::influence::{self, Tables, Transform, Window};
use crate::numerics::dense::{self, QUAD, largest};
use crate::parameters::Parameters;
use crate::transport::strips::Side;
use std::f64::consts::PI;

/// Displacement by heat contents.
pub struct Expansion {
    /// Upward displacement by the heat content of a cell, scaled, per `K m`.
    pub bulge: f64,
    /// Displacement u along x and y by the heat content of the cells, scaled, per `K m`.
    cells: Tables<f64>,
    /// Displacement u by the heat content of the rail left and right of the window, along x and y, scaled, per `K m`: for a strip
    /// that is 0, 1, … strips to the left of the hot one, a row over its cells.
    outside: [[Vec<f64>; 2]; 2],
}

/// Buffers of [`Expansion::displace`].
pub struct ExpansionBuffers {
    /// Displacement u on the grid, along x and y, scaled.
    pub displacement: [Vec<f64>; 2],
    content: Vec<f64>,
    nothing: Vec<f64>,
    products: influence::ProductScratch<f64>,
}

impl ExpansionBuffers {
    /// Buffers for a grid.
    pub fn new(grid: &Grid, transform: &Transform) -> ExpansionBuffers {
        let on_grid = || vec![0.0; grid.len()];
        ExpansionBuffers {
            displacement: [on_grid(), on_grid()],
            content: on_grid(),
            nothing: on_grid(),
            products: transform.scratch(),
        }
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
        let cells = transform.tables(
            |lag| displacement * along.at(lag),
            |lag| displacement * across.at(lag),
            |_| 0.0,
        );
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
            cells,
            outside: [-middle, middle].map(|middle| [X_OVER_R3, Y_OVER_R3].map(|kernel| rows(middle, &kernel))),
        }
    }

    /// Computes into the buffers the displacement u by the heat that displaces the cells upward by `upward`, strip by strip, or the
    /// change of u by a change of `upward`. Returns whether there is any.
    pub fn displace(&self, grid: &Grid, transform: &Transform, upward: &[f64], buffers: &mut ExpansionBuffers) -> bool {
        if self.bulge == 0.0 || largest(upward) == 0.0 {
            return false;
        }
        let (content, bulge) = (&mut buffers.content, self.bulge);
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (strip, upward) in upward.chunks_exact(grid.cells).enumerate() {
                    for (content, upward) in content[grid.row(strip)].iter_mut().zip(upward) {
                        *content = upward / bulge;
                    }
                }
            },
        );
        let [x, y] = &mut buffers.displacement;
        transform.apply(
            &self.cells,
            &Window::whole(grid),
            [&buffers.content, &buffers.nothing],
            [x, y],
            &mut buffers.products,
        );
        for (side, end) in [(Side::Left, 0), (Side::Right, grid.cells - 1)] {
            let content = |strip: usize| buffers.content[grid.place(strip, end)];
            if (0..grid.strips).any(|strip| content(strip) != 0.0) {
                self.add_outside(grid, side, content, &mut buffers.displacement);
            }
        }
        true
    }

    /// Adds the displacement u by the heat of the rail on one side of the window, where each strip holds what `content` says.
    fn add_outside(&self, grid: &Grid, side: Side, content: impl Fn(usize) -> f64, displacement: &mut [Vec<f64>; 2]) {
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
