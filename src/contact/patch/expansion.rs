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
use crate::numerics::dense::{self, largest};
use crate::parameters::Parameters;
use std::f64::consts::PI;

/// Displacement by heat contents.
pub struct Expansion {
    /// Upward displacement by the heat content of a cell, scaled, per `K m`.
    pub bulge: f64,
    /// Displacement u along x and y by the heat content of the cells, scaled, per `K m`; with that of the first and the last cell of a strip, which the
    /// rail holds beyond it.
    content: SourceTables,
}

/// Buffers of [`Expansion::displace`].
pub struct ExpansionBuffers {
    /// Displacement u on the grid, along x and y, scaled.
    pub displacement: [Vec<f64>; 2],
    /// Heat content on the grid, `K m`.
    content: Vec<f64>,
    products: influence::ProductScratch<f64>,
}

impl ExpansionBuffers {
    /// Buffers for a grid.
    pub fn new(grid: &Grid, transform: &Transform) -> ExpansionBuffers {
        let on_grid = || vec![0.0; grid.len()];
        ExpansionBuffers {
            displacement: [on_grid(), on_grid()],
            content: on_grid(),
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
        let beyond = Rectangle {
            half_length: 0.5 * (rail - grid.half_length()),
            half_breadth: 0.5 * grid.breadth,
        };
        let middle = 0.5 * (rail + grid.half_length());
        let ends = [(0, -middle), (grid.cells - 1, middle)].map(|(end, middle)| {
            let kernel = |kernel: &'static Kernel| {
                move |cell: usize, across: isize| {
                    displacement * beyond.integral(kernel, grid.x(cell) - middle, across as f64 * grid.breadth)
                }
            };
            transform.end_tables(end, grid.cells, kernel(&X_OVER_R3), kernel(&Y_OVER_R3))
        });
        let content = transform.source_tables(
            |lag| displacement * along.at(lag),
            |lag| displacement * across.at(lag),
            ends.to_vec(),
        );
        Expansion {
            bulge: 2.0 * swelling,
            content,
        }
    }

    /// Computes into the buffers the displacement u by the heat that displaces the cells upward by `upward`, strip by strip, or the
    /// change of u by a change of `upward`. Returns whether there is any.
    pub fn displace(&self, grid: &Grid, transform: &Transform, upward: &[f64], buffers: &mut ExpansionBuffers) -> bool {
        if self.bulge == 0.0 || largest(upward) == 0.0 {
            return false;
        }
        let ExpansionBuffers {
            displacement: [x, y],
            content,
            products,
        } = buffers;
        let per_displacement = 1.0 / self.bulge;
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (strip, upward) in upward.chunks_exact(grid.cells).enumerate() {
                    for (content, upward) in content[grid.row(strip)].iter_mut().zip(upward) {
                        *content = upward * per_displacement;
                    }
                }
            },
        );
        transform.apply(&self.content, &Window::whole(grid), content, [x, y], products);
        true
    }
}
