//! Displacement by the pressure of one window of the surface under another.
//!
//! Contacts of one wheel are some millimetres to centimetres from each other, and the surface sinks by a few per cent of the approach
//! about a contact. The pressure of blocks of cells is taken as a force and its moments in the block's middle, which are linear in the pressure, and the
//! displacement found at a few places of the other window and interpolated between them: it is smooth there. Contacts that are nearer to each other than such
//! blocks are large have smaller blocks and more places.
//!
//! At one height of the wheel the windows are solved in turn, each for what the others do to it by then (Gauss and Seidel), until that rests: the
//! pressures minimise one energy together, and each solution lowers it.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::numerics::dense::{self, LANES, add_multiple};

/// Strips and cells of a block of the source, and between the places of the target.
pub type Grain = [usize; 2];

/// Blocks across and along a window whose contact is far from the others, to rounding. With the blocks of close contacts a step of two contacts takes 1.3 times the
/// time, and its forces differ by 1e-4 of the load.
const FAR_BLOCKS: [usize; 2] = [8, 6];
/// Least and largest number of strips, and of cells, in such a block.
const FAR_SIZES: [[usize; 2]; 2] = [[2, 4], [2, 6]];
/// Factors by which blocks of close contacts have fewer strips and cells. Found with the larger blocks, what one contact does to the surface beside it was so
/// far off that pressure appeared where nothing touches.
const CLOSE_FACTORS: [usize; 2] = [2, 3];

/// The grain of a window.
pub fn grain(grid: &Grid, are_close: bool) -> Grain {
    let counts = [grid.strips, grid.cells];
    std::array::from_fn(|way| {
        let (blocks, [least, largest]) = (FAR_BLOCKS[way], FAR_SIZES[way]);
        let far = ((counts[way] + blocks / 2) / blocks).clamp(least, largest);
        if are_close {
            (far / CLOSE_FACTORS[way]).max(1)
        } else {
            far
        }
    })
}

/// Size of the larger blocks in a window, `m`: a contact that is nearer to this window's than that is close to it.
pub fn block_size(grid: &Grid) -> f64 {
    let [strips, cells] = grain(grid, false).map(|count| count as f64);
    f64::max(strips * grid.breadth, cells * grid.length)
}

/// Rows and columns of the places in a window: every so many strips and cells, the last at the window's end or beyond.
fn places_of(grid: &Grid, [strips, cells]: Grain) -> [usize; 2] {
    [(grid.strips, strips), (grid.cells, cells)].map(|(count, stride)| (count - 1).div_ceil(stride) + 1)
}

/// A value of each of [`LANES`] blocks side by side.
type Lanes = [f64; LANES];

/// Resultants of the pressure on [`LANES`] blocks side by side: forces and their first moments about the blocks' middles, over the unit of
/// pressure. Those that are not taken have no force and are far away.
#[derive(Debug, Clone, Copy)]
struct Resultants {
    /// Forces, `m²`.
    force: Lanes,
    /// Moments along and across, `m³`.
    moments: [Lanes; 2],
    /// Places of the middles along the rail and their arc lengths, `m`.
    middle: [Lanes; 2],
}

impl Resultants {
    const NONE: Resultants = Resultants {
        force: [0.0; LANES],
        moments: [[0.0; LANES]; 2],
        middle: [[1e9; LANES]; 2],
    };

    /// Adds ∫ p/r dA of the blocks at a place to their sums, to the first order in the block's size over the distance, which counts as at
    /// least so much.
    #[inline(always)]
    fn add_at(&self, [along, across]: [f64; 2], least: f64, sums: &mut Lanes) {
        let ([middle_x, middle_y], [moment_x, moment_y]) = (&self.middle, &self.moments);
        for lane in 0..LANES {
            let [x, y] = [along - middle_x[lane], across - middle_y[lane]];
            let inverse = 1.0 / (x * x + y * y).sqrt().max(least);
            let moments = moment_x[lane] * x + moment_y[lane] * y;
            sums[lane] += (self.force[lane] + moments * inverse * inverse) * inverse;
        }
    }
}

/// Displacement of the windows by each other.
pub struct Apart {
    resultants: [Vec<Resultants>; WINDOWS],
    grain: Grain,
    /// Displacement at the places of the windows by the pressure of the others, scaled: with room for the finest grain.
    places: [Vec<f64>; WINDOWS],
    /// Displacement at the height of a strip between the rows, one value for each column.
    line: Vec<f64>,
    /// Buffers of [`resultants`].
    columns_of_cells: [Vec<f64>; 2],
    /// Displacement by the others on the grid, scaled.
    pub displacement: [Vec<f64>; WINDOWS],
}

impl Apart {
    /// Buffers for windows of the given operators.
    pub fn new(operators: &SurfaceOperators) -> Apart {
        let grid = operators.sizes.largest;
        let finest = grain(&grid, true);
        let [strips, cells] = finest;
        let blocks = grid.strips.div_ceil(strips) * grid.cells.div_ceil(cells);
        let [rows, columns] = places_of(&grid, finest);
        Apart {
            resultants: std::array::from_fn(|_| Vec::with_capacity(blocks.div_ceil(LANES))),
            grain: finest,
            places: std::array::from_fn(|_| vec![0.0; rows * columns]),
            line: vec![0.0; columns],
            columns_of_cells: std::array::from_fn(|_| vec![0.0; grid.cells]),
            displacement: std::array::from_fn(|_| vec![0.0; grid.len()]),
        }
    }

    /// Whether more than one window carries anything: of one contact nothing comes back.
    pub fn is_coupled(&self) -> bool {
        self.resultants.iter().filter(|own| !own.is_empty()).count() > 1
    }

    /// Takes the pressure that a window has now, or its change, where there are others that it displaces.
    pub fn take_for_others(
        &mut self,
        operators: &SurfaceOperators,
        fields: &SurfaceFields,
        window: usize,
        place: &Place,
    ) {
        if fields.used().count() > 1 {
            self.take(operators, fields, window, place);
        }
    }

    /// Takes the pressure that a window has now, or its change.
    fn take(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields, window: usize, place: &Place) {
        self.take_pressure(operators, &fields.windows[window].pressure, window, place);
    }

    /// Takes a pressure on the grid, or its change, for that of a window.
    pub fn take_pressure(&mut self, operators: &SurfaceOperators, pressure: &[f64], window: usize, place: &Place) {
        let found = &mut self.resultants[window];
        resultants(
            (&operators.of(place).grid, self.grain),
            place,
            pressure,
            &mut self.columns_of_cells,
            found,
        );
    }

    /// Begins without any, for contacts that are close or far apart.
    pub fn clear(&mut self, operators: &SurfaceOperators, are_close: bool) {
        self.grain = grain(&operators.sizes.largest, are_close);
        self.resultants.iter_mut().for_each(Vec::clear);
        // What follows must not hang on what was solved before.
        self.places.iter_mut().for_each(|places| places.fill(0.0));
    }

    /// Changes the displacement of a window by that of a change of the pressures times a factor.
    pub fn add(&mut self, other: &Apart, factor: f64, window: usize) {
        add_multiple(&other.places[window], factor, &mut self.places[window]);
        add_multiple(&other.displacement[window], factor, &mut self.displacement[window]);
    }

    /// Begins with what the pressures of the fields do to each other's windows: of one window, nothing.
    pub fn begin(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) {
        if fields.used().count() > 1 {
            self.set_resultants(operators, fields);
            for (window, place) in fields.used() {
                self.displace(operators, window, &place);
            }
        } else {
            self.clear(operators, fields.are_close);
            for (window, _) in fields.used() {
                self.displacement[window].fill(0.0);
            }
        }
    }

    /// Begins with the resultants of the pressure of the fields, or of its change.
    pub fn set_resultants(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) {
        self.clear(operators, fields.are_close);
        for (window, place) in fields.used() {
            self.take(operators, fields, window, &place);
        }
    }

    /// Displacement by the resultants at a place along the rail and an arc length, `m`.
    pub fn sinking(&self, operators: &SurfaceOperators, [along, across]: [f64; 2]) -> f64 {
        let unit = operators.pair.normal() * operators.shapes[0].scales.pressure;
        let mut sums = [0.0; LANES];
        for from in self.resultants.iter().flatten() {
            from.add_at([along, across], f64::MIN_POSITIVE, &mut sums);
        }
        unit * sums.iter().sum::<f64>()
    }

    /// Computes the displacement of a window by the others. Returns by how much it has changed at most, scaled.
    pub fn displace(&mut self, operators: &SurfaceOperators, window: usize, place: &Place) -> f64 {
        let patch = operators.of(place);
        let grid = &patch.grid;
        let middle = place.middle_along(grid);
        // Of a point force F, (1 − ν)/(π G) F/r.
        let unit = operators.pair.normal() * patch.scales.pressure / patch.scales.displacement;
        let (resultants, [strips, cells]) = (&self.resultants, self.grain);
        let [rows, columns] = places_of(grid, self.grain);
        let least = 0.5 * grid.breadth;
        let places = &mut self.places[window][..rows * columns];
        let change = dense::vectorised(
            #[inline(always)]
            |_| {
                let mut change = 0.0;
                for (row, places) in places.chunks_exact_mut(columns).enumerate() {
                    let across = place.arc(grid, row * strips);
                    for (column, displacement) in places.iter_mut().enumerate() {
                        let along = middle + grid.x(0) + (column * cells) as f64 * grid.length;
                        let mut sums = [0.0; LANES];
                        for (other, others) in resultants.iter().enumerate() {
                            if other != window {
                                for from in others {
                                    from.add_at([along, across], least, &mut sums);
                                }
                            }
                        }
                        let now = unit * sums.iter().sum::<f64>();
                        change = f64::max(change, (now - *displacement).abs());
                        *displacement = now;
                    }
                }
                change
            },
        );
        self.interpolate(grid, window);
        change
    }

    /// Interpolates the displacement of a window between the places.
    fn interpolate(&mut self, grid: &Grid, window: usize) {
        let ([rows, columns], [strips, cells]) = (places_of(grid, self.grain), self.grain);
        let (places, line) = (&self.places[window], &mut self.line[..columns]);
        let displacement = &mut self.displacement[window];
        dense::vectorised(
            #[inline(always)]
            |_| {
                for strip in 0..grid.strips {
                    let row = (strip / strips).min(rows - 2);
                    let up = strip as f64 / strips as f64 - row as f64;
                    let (low, high) = places[row * columns..(row + 2) * columns].split_at(columns);
                    for ((line, low), high) in line.iter_mut().zip(low).zip(high) {
                        *line = low + up * (high - low);
                    }
                    let stretches = displacement[grid.row(strip)].chunks_mut(cells);
                    for (column, stretch) in stretches.enumerate() {
                        // A last stretch may end at the last place.
                        let left = column.min(columns - 2);
                        let (from, slope) = (line[left], line[left + 1] - line[left]);
                        for (cell, displacement) in stretch.iter_mut().enumerate() {
                            let right = (column - left) as f64 + cell as f64 / cells as f64;
                            *displacement = from + right * slope;
                        }
                    }
                }
            },
        );
    }
}

/// Finds the resultants of the blocks of a window, of a grain, that carry anything, the forces over the unit of pressure, `m²`. The buffers have room for the
/// cells of a strip.
fn resultants(
    (grid, [of_strips, of_cells]): (&Grid, Grain),
    place: &Place,
    pressure: &[f64],
    [sums, moments]: &mut [Vec<f64>; 2],
    found: &mut Vec<Resultants>,
) {
    found.clear();
    let mut count = 0;
    let (middle, area) = (place.middle_along(grid), grid.cell_area());
    for strips in (0..grid.strips).step_by(of_strips) {
        let strips = strips..(strips + of_strips).min(grid.strips);
        let across = 0.5 * (place.arc(grid, strips.start) + place.arc(grid, strips.end - 1));
        // Of the cells beside each other across the block: their sum, and its moment across.
        sums.fill(0.0);
        moments.fill(0.0);
        for strip in strips {
            let row = &pressure[grid.row(strip)];
            add_multiple(row, 1.0, sums);
            add_multiple(row, place.arc(grid, strip) - across, moments);
        }
        for first in (0..grid.cells).step_by(of_cells) {
            let cells = first..(first + of_cells).min(grid.cells);
            let along = 0.5 * (grid.x(cells.start) + grid.x(cells.end - 1));
            let (mut force, mut moment_along, mut moment_across) = (0.0, 0.0, 0.0);
            for cell in cells {
                force += sums[cell];
                moment_along += sums[cell] * (grid.x(cell) - along);
                moment_across += moments[cell];
            }
            if [force, moment_along, moment_across] == [0.0; 3] {
                continue;
            }
            let lane = count % LANES;
            if lane == 0 {
                found.push(Resultants::NONE);
            }
            count += 1;
            let own = found.last_mut().expect("one has been added");
            own.force[lane] = area * force;
            for (own, value) in own.moments.iter_mut().zip([moment_along, moment_across]) {
                own[lane] = area * value;
            }
            for (own, value) in own.middle.iter_mut().zip([middle + along, across]) {
                own[lane] = value;
            }
        }
    }
}
