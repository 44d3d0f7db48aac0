//! Displacement of the surface by the heat in the rail: that of the cells, and that which the rail holds ahead of and behind the window.
//!
//! A thin hot layer of heat content Θ on a half-space lifts its surface by 2(1+ν)α Θ and draws it along by
//! u = (1+ν)α/π ∫ Θ (x, y)/r³ dA. Outside of the window each strip is taken to hold, up to the ends of the rail, what it holds
//! in its cell at that end: heat that has left the surface goes deeper, but is kept.

use crate::body::grid::Grid;
use crate::body::half_plane::HalfPlane;
use crate::body::half_space::Rectangle;
use crate::body::influence::{self, Tables, Transform, Window};
use crate::numerics::dense::{add_multiple, largest};
use crate::parameters::Parameters;
use crate::transport::strips::Side;
use std::f64::consts::PI;

/// The displacement by heat contents.
pub struct Expansion {
    /// Lift by the heat content of a cell, scaled, per `K m`.
    pub bulge: f64,
    /// u by the heat content of the cells, scaled, per `K m`.
    cells: Tables<f64>,
    /// The same by that of the rail left and right of the window, along x and y: for a strip that is 0, 1, … strips to the left of
    /// the hot one a row over its cells.
    outside: [[Vec<f64>; 2]; 2],
}

/// Buffers.
pub struct Scratch {
    /// u on the grid, along x and y.
    pub displacement: [Vec<f64>; 2],
    content: Vec<f64>,
    nothing: Vec<f64>,
    products: influence::ProductScratch<f64>,
}

impl Scratch {
    /// For a grid.
    pub fn new(grid: &Grid, transform: &Transform) -> Scratch {
        let on_grid = || vec![0.0; grid.len()];
        Scratch {
            displacement: [on_grid(), on_grid()],
            content: on_grid(),
            nothing: on_grid(),
            products: transform.scratch(),
        }
    }
}

impl Expansion {
    /// For a rail of the given half-length `m`, with displacements in units of `scale` `m`.
    pub fn new(parameters: &Parameters, grid: &Grid, transform: &Transform, rail: f64, scale: f64) -> Expansion {
        let body = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        let swelling = (1.0 + body.poisson_ratio) * parameters.thermal_expansion / scale;
        let pull = swelling / PI;
        let cell = Rectangle {
            half_length: 0.5 * grid.length,
            half_breadth: 0.5 * grid.breadth,
        };
        let place = |(along, across): (isize, isize)| (along as f64 * grid.length, across as f64 * grid.breadth);
        let cells = transform.tables(
            |lag| pull * cell.x_over_r3(place(lag).0, place(lag).1),
            |lag| pull * cell.y_over_r3(place(lag).0, place(lag).1),
            |_| 0.0,
        );
        let beyond = Rectangle {
            half_length: 0.5 * (rail - grid.half_length()),
            half_breadth: 0.5 * grid.breadth,
        };
        let middle = 0.5 * (rail + grid.half_length());
        let rows = |middle: f64, kernel: fn(&Rectangle, f64, f64) -> f64| {
            let mut rows = vec![0.0; grid.len()];
            for strip in 0..grid.strips {
                for (cell, value) in rows[grid.row(strip)].iter_mut().enumerate() {
                    *value = pull * kernel(&beyond, grid.x(cell) - middle, strip as f64 * grid.breadth);
                }
            }
            rows
        };
        Expansion {
            bulge: 2.0 * swelling,
            cells,
            outside: [-middle, middle]
                .map(|middle| [Rectangle::x_over_r3, Rectangle::y_over_r3].map(|kernel| rows(middle, kernel))),
        }
    }

    /// u by the heat that lifts the cells by `lift`, strip by strip, or its change by that of the lift. Returns whether there is any; it is in
    /// the scratch.
    pub fn displace(&self, grid: &Grid, transform: &Transform, lift: &[f64], scratch: &mut Scratch) -> bool {
        if self.bulge == 0.0 || largest(lift) == 0.0 {
            return false;
        }
        for (strip, lifts) in lift.chunks_exact(grid.cells).enumerate() {
            for (content, lift) in scratch.content[grid.row(strip)].iter_mut().zip(lifts) {
                *content = lift / self.bulge;
            }
        }
        let [x, y] = &mut scratch.displacement;
        transform.apply(
            &self.cells,
            &Window::whole(grid),
            [&scratch.content, &scratch.nothing],
            [x, y],
            &mut scratch.products,
        );
        for (side, end) in [(Side::Left, 0), (Side::Right, grid.cells - 1)] {
            let [along, across] = &self.outside[side as usize];
            for hot in 0..grid.strips {
                let content = scratch.content[grid.place(hot, end)];
                if content == 0.0 {
                    continue;
                }
                for strip in 0..grid.strips {
                    let (kernel, own) = (grid.row(strip.abs_diff(hot)), grid.row(strip));
                    // u_y is odd across the strips.
                    let sideways = if strip >= hot { content } else { -content };
                    add_multiple(
                        &along[kernel.clone()],
                        content,
                        &mut scratch.displacement[0][own.clone()],
                    );
                    add_multiple(&across[kernel], sideways, &mut scratch.displacement[1][own]);
                }
            }
        }
        true
    }
}
