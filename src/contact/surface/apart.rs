//! What the pressure of one window does to the surface under another.
//!
//! Contacts of one wheel are some millimetres to centimetres from each other, and the surface sinks by a few per cent of the approach
//! about a contact. The pressure of blocks of cells is taken as that of points in their centres of force, and the displacement found at
//! a few places of the other window and interpolated between them: it is smooth there.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::fields::PatchFields;

/// Strips and cells of a block of the source.
const BLOCK: [usize; 2] = [4, 6];
/// Strips and cells between the places of the target.
const STRIDE: [usize; 2] = [4, 6];

/// Resultant of the pressure on a block.
#[derive(Debug, Clone, Copy, Default)]
struct Resultant {
    force: f64,
    along: f64,
    across: f64,
}

/// Buffers.
pub struct Apart {
    resultants: [Vec<Resultant>; WINDOWS],
    /// Displacement at the places of a window, scaled.
    places: Vec<f64>,
    /// Displacement of the windows by the pressure of the others, on the grid, scaled.
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
        Apart {
            resultants: std::array::from_fn(|_| Vec::with_capacity(blocks)),
            places: vec![0.0; count(grid.strips, STRIDE[0]) * count(grid.cells, STRIDE[1])],
            displacement: std::array::from_fn(|_| vec![0.0; grid.len()]),
        }
    }

    /// Sets the displacement to that by the pressure of the fields, or to its change with a change of them. Returns whether there is any: of
    /// one contact there is none.
    pub fn set(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) -> bool {
        let mut loaded = 0;
        for (window, place) in fields.used() {
            let grid = operators.of(&place).grid;
            resultants(&grid, &place, &fields.windows[window], &mut self.resultants[window]);
            loaded += usize::from(!self.resultants[window].is_empty());
        }
        for (window, place) in fields.used() {
            self.displacement[window].fill(0.0);
            if loaded > usize::from(!self.resultants[window].is_empty()) {
                self.displace(operators, fields, window, &place);
            }
        }
        loaded > 1
    }

    /// Computes the displacement of a window by the others.
    fn displace(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields, window: usize, place: &Place) {
        let patch = operators.of(place);
        let grid = patch.grid;
        let middle = place.middle_along(&grid);
        let (rows, columns) = (count(grid.strips, STRIDE[0]), count(grid.cells, STRIDE[1]));
        // Of a point force F, (1 − ν)/(π G) F/r.
        let unit = operators.pair.normal() * patch.scales.pressure / patch.scales.displacement;
        for row in 0..rows {
            for column in 0..columns {
                let across = place.arc(&grid, row * STRIDE[0]);
                let along = middle + grid.x(0) + (column * STRIDE[1]) as f64 * grid.length;
                let mut sum = 0.0;
                for (other, _) in fields.used().filter(|(other, _)| *other != window) {
                    for from in &self.resultants[other] {
                        let distance = (along - from.along).hypot(across - from.across);
                        sum += from.force / distance.max(0.5 * grid.breadth);
                    }
                }
                self.places[row * columns + column] = unit * sum;
            }
        }
        for strip in 0..grid.strips {
            let (row, up) = ((strip / STRIDE[0]).min(rows - 2), strip as f64 / STRIDE[0] as f64);
            let up = up - row as f64;
            for (cell, at) in grid.row(strip).enumerate() {
                let column = (cell / STRIDE[1]).min(columns - 2);
                let right = cell as f64 / STRIDE[1] as f64 - column as f64;
                let at_place = |row: usize, column: usize| self.places[row * columns + column];
                let low = at_place(row, column) + right * (at_place(row, column + 1) - at_place(row, column));
                let high =
                    at_place(row + 1, column) + right * (at_place(row + 1, column + 1) - at_place(row + 1, column));
                self.displacement[window][at] = low + up * (high - low);
            }
        }
    }
}

/// Finds the resultants of the blocks of a window that carry anything, the forces over the unit of pressure, `m²`.
fn resultants(grid: &Grid, place: &Place, fields: &PatchFields, found: &mut Vec<Resultant>) {
    found.clear();
    let middle = place.middle_along(grid);
    for strips in (0..grid.strips).step_by(BLOCK[0]) {
        for cells in (0..grid.cells).step_by(BLOCK[1]) {
            let (mut force, mut size, mut along, mut across) = (0.0, 0.0, 0.0, 0.0);
            for strip in strips..(strips + BLOCK[0]).min(grid.strips) {
                let arc = place.arc(grid, strip);
                for cell in cells..(cells + BLOCK[1]).min(grid.cells) {
                    let pressure = fields.pressure[grid.place(strip, cell)];
                    force += pressure;
                    size += pressure.abs();
                    along += pressure.abs() * (middle + grid.x(cell));
                    across += pressure.abs() * arc;
                }
            }
            if size > 0.0 {
                found.push(Resultant {
                    force: force * grid.cell_area(),
                    along: along / size,
                    across: across / size,
                });
            }
        }
    }
}
