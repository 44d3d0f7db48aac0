//! Displacement by the pressure of one window of the surface under another.
//!
//! Contacts of one wheel are some millimetres to centimetres from each other, and the surface sinks by a few per cent of the approach
//! about a contact. The pressure of blocks of cells is taken as a force and its moments in the block's middle, which are linear in the pressure, and the
//! displacement found at a few places of the other window and interpolated between them: it is smooth there.
//!
//! At one height of the wheel the windows are solved in turn, each for what the others do to it by then (Gauss and Seidel), until that rests: the
//! pressures minimise one energy together, and each solution lowers it.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::numerics::dense::add_multiple;

/// Strips and cells of a block of the source.
const BLOCK: [usize; 2] = [4, 6];
/// Strips and cells between the places of the target.
const STRIDE: [usize; 2] = [4, 6];

/// Resultant of the pressure on a block: force and its first moments about the block's middle, over the unit of pressure.
#[derive(Debug, Clone, Copy, Default)]
struct Resultant {
    /// Force, `m²`.
    force: f64,
    /// Moments along and across, `m³`.
    moments: [f64; 2],
    /// Place of the middle along the rail and its arc length, `m`.
    middle: [f64; 2],
}

impl Resultant {
    /// ∫ p/r dA at a place, to the first order in the block's size over the distance, which counts as at least so much.
    fn at(&self, along: f64, across: f64, least: f64) -> f64 {
        let [x, y] = [along - self.middle[0], across - self.middle[1]];
        let distance = (x * x + y * y).sqrt().max(least);
        let [moment_x, moment_y] = self.moments;
        (self.force + (moment_x * x + moment_y * y) / (distance * distance)) / distance
    }
}

/// Displacement of the windows by each other.
pub struct Apart {
    resultants: [Vec<Resultant>; WINDOWS],
    /// Displacement at the places of the windows by the pressure of the others, scaled.
    places: [Vec<f64>; WINDOWS],
    /// Rows and columns of the places of a window.
    rows: usize,
    columns: usize,
    /// Displacement by the others on the grid, scaled.
    pub displacement: [Vec<f64>; WINDOWS],
}

fn count(cells: usize, stride: usize) -> usize {
    (cells - 1).div_ceil(stride) + 1
}

impl Apart {
    /// Buffers for windows of the given operators.
    pub fn new(operators: &SurfaceOperators) -> Apart {
        let grid = operators.sizes.largest;
        let blocks = grid.strips.div_ceil(BLOCK[0]) * grid.cells.div_ceil(BLOCK[1]);
        let (rows, columns) = (count(grid.strips, STRIDE[0]), count(grid.cells, STRIDE[1]));
        Apart {
            resultants: std::array::from_fn(|_| Vec::with_capacity(blocks)),
            places: std::array::from_fn(|_| vec![0.0; rows * columns]),
            rows,
            columns,
            displacement: std::array::from_fn(|_| vec![0.0; grid.len()]),
        }
    }

    /// Whether more than one window carries anything: of one contact nothing comes back.
    pub fn is_coupled(&self) -> bool {
        self.resultants.iter().filter(|own| !own.is_empty()).count() > 1
    }

    /// Takes the pressure that a window has now, or its change.
    pub fn take(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields, window: usize, place: &Place) {
        self.take_pressure(operators, &fields.windows[window].pressure, window, place);
    }

    /// Takes a pressure on the grid, or its change, for that of a window.
    pub fn take_pressure(&mut self, operators: &SurfaceOperators, pressure: &[f64], window: usize, place: &Place) {
        resultants(&operators.of(place).grid, place, pressure, &mut self.resultants[window]);
    }

    /// Begins without any.
    pub fn clear(&mut self) {
        self.resultants.iter_mut().for_each(Vec::clear);
        // What follows must not hang on what was solved before.
        self.places.iter_mut().for_each(|places| places.fill(0.0));
    }

    /// Changes the displacement of a window by that of a change of the pressures times a factor.
    pub fn add(&mut self, other: &Apart, factor: f64, window: usize) {
        add_multiple(&other.places[window], factor, &mut self.places[window]);
        add_multiple(&other.displacement[window], factor, &mut self.displacement[window]);
    }

    /// Begins with the resultants of the pressure of the fields, or of its change.
    pub fn set_resultants(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) {
        self.clear();
        for (window, place) in fields.used() {
            self.take(operators, fields, window, &place);
        }
    }

    /// Displacement by the resultants at a place along the rail and an arc length, `m`.
    pub fn sinking(&self, operators: &SurfaceOperators, [along, across]: [f64; 2]) -> f64 {
        let unit = operators.pair.normal() * operators.shapes[0].scales.pressure;
        let sum: f64 = self
            .resultants
            .iter()
            .flatten()
            .map(|from| from.at(along, across, 0.0))
            .sum();
        unit * sum
    }

    /// Computes the displacement of a window by the others. Returns by how much it has changed at most, scaled.
    pub fn displace(&mut self, operators: &SurfaceOperators, window: usize, place: &Place) -> f64 {
        let patch = operators.of(place);
        let grid = &patch.grid;
        let middle = place.middle_along(grid);
        // Of a point force F, (1 − ν)/(π G) F/r.
        let unit = operators.pair.normal() * patch.scales.pressure / patch.scales.displacement;
        let mut change = 0.0;
        for (number, displacement) in self.places[window].iter_mut().enumerate() {
            let (row, column) = (number / self.columns, number % self.columns);
            let across = place.arc(grid, row * STRIDE[0]);
            let along = middle + grid.x(0) + (column * STRIDE[1]) as f64 * grid.length;
            let others = self.resultants.iter().enumerate().filter(|(other, _)| *other != window);
            let sum: f64 = others
                .flat_map(|(_, others)| others)
                .map(|from| from.at(along, across, 0.5 * grid.breadth))
                .sum();
            change = f64::max(change, (unit * sum - *displacement).abs());
            *displacement = unit * sum;
        }
        self.interpolate(grid, window);
        change
    }

    /// Interpolates the displacement of a window between the places.
    fn interpolate(&mut self, grid: &Grid, window: usize) {
        let (rows, columns, places) = (self.rows, self.columns, &self.places[window]);
        let at_place = |row: usize, column: usize| places[row * columns + column];
        for strip in 0..grid.strips {
            let (row, up) = ((strip / STRIDE[0]).min(rows - 2), strip as f64 / STRIDE[0] as f64);
            let up = up - row as f64;
            for (cell, at) in grid.row(strip).enumerate() {
                let column = (cell / STRIDE[1]).min(columns - 2);
                let right = cell as f64 / STRIDE[1] as f64 - column as f64;
                let low = at_place(row, column) + right * (at_place(row, column + 1) - at_place(row, column));
                let high =
                    at_place(row + 1, column) + right * (at_place(row + 1, column + 1) - at_place(row + 1, column));
                self.displacement[window][at] = low + up * (high - low);
            }
        }
    }
}

/// Finds the resultants of the blocks of a window that carry anything, the forces over the unit of pressure, `m²`.
fn resultants(grid: &Grid, place: &Place, pressure: &[f64], found: &mut Vec<Resultant>) {
    found.clear();
    let middle = place.middle_along(grid);
    for strips in (0..grid.strips).step_by(BLOCK[0]) {
        let strips = strips..(strips + BLOCK[0]).min(grid.strips);
        let across = 0.5 * (place.arc(grid, strips.start) + place.arc(grid, strips.end - 1));
        for cells in (0..grid.cells).step_by(BLOCK[1]) {
            let cells = cells..(cells + BLOCK[1]).min(grid.cells);
            let along = middle + 0.5 * (grid.x(cells.start) + grid.x(cells.end - 1));
            let mut own = Resultant {
                middle: [along, across],
                ..Resultant::default()
            };
            let mut acts = false;
            for strip in strips.clone() {
                let y = place.arc(grid, strip) - across;
                for cell in cells.clone() {
                    let force = pressure[grid.place(strip, cell)] * grid.cell_area();
                    acts |= force != 0.0;
                    own.force += force;
                    own.moments[0] += force * (middle + grid.x(cell) - along);
                    own.moments[1] += force * y;
                }
            }
            if acts {
                found.push(own);
            }
        }
    }
}
