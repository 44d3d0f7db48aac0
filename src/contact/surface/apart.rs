//! Displacement by the tractions of one window of the surface under another: down by its pressure, and along the surface by its shear.
//!
//! Contacts of one wheel are some millimetres to centimetres from each other, and the surface sinks by a few per cent of the approach
//! about a contact. The traction of blocks of cells is taken as a force and its moments in the block's middle, which are linear in the traction, and the
//! displacement found at a few places of the other window and interpolated between them: it is smooth there. Contacts that are nearer to each other than such
//! blocks are large have smaller blocks and more places.
//!
//! At one height of the wheel the windows are solved in turn, each for what the others do to it by then (Gauss and Seidel), until that rests: the
//! pressures minimise one energy together, and each solution lowers it. What shear does is far less of the slip: the next iteration of the
//! tractions takes it up.
//!
//! Displacements along the surface by pressure, and up by shear, which there are between unlike bodies, are left out.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::fields::PatchFields;
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

/// Resultants of N components of the traction on [`LANES`] blocks side by side: forces and their first moments about the blocks' middles, over the unit of
/// pressure. Those that are not taken have no force and are far away.
#[derive(Debug, Clone, Copy)]
pub struct Resultants<const N: usize> {
    /// Forces, `m²`.
    force: [Lanes; N],
    /// Moments of each force along and across, `m³`.
    moments: [[Lanes; 2]; N],
    /// Places of the middles along the rail and their arc lengths, `m`.
    middle: [Lanes; 2],
}

impl<const N: usize> Resultants<N> {
    const NONE: Resultants<N> = Resultants {
        force: [[0.0; LANES]; N],
        moments: [[[0.0; LANES]; 2]; N],
        middle: [[1e9; LANES]; 2],
    };
}

/// Influence of a traction of N components on the surface beside it.
pub trait Influence<const N: usize> {
    /// The traction in the fields of a window, on the grid, scaled.
    fn traction(fields: &PatchFields) -> [&[f64]; N];

    /// Adds the displacement at a place, over (1 − ν)/(πG), by the blocks to their sums, to the first order in the block's size over the distance, which
    /// counts as at least so much. `poisson` is ν/(1 − ν).
    fn add_at(&self, poisson: f64, place: [f64; 2], least: f64, sums: &mut [Lanes; N]);
}

/// Sinking by pressure: ∫ p/r dA.
impl Influence<1> for Resultants<1> {
    fn traction(fields: &PatchFields) -> [&[f64]; 1] {
        [&fields.pressure]
    }

    #[inline(always)]
    fn add_at(&self, _poisson: f64, [along, across]: [f64; 2], least: f64, [sums]: &mut [Lanes; 1]) {
        let [middle_x, middle_y] = &self.middle;
        let ([force], [[moment_x, moment_y]]) = (&self.force, &self.moments);
        for lane in 0..LANES {
            let [x, y] = [along - middle_x[lane], across - middle_y[lane]];
            let inverse = 1.0 / (x * x + y * y).sqrt().max(least);
            let moments = moment_x[lane] * x + moment_y[lane] * y;
            sums[lane] += (force[lane] + moments * inverse * inverse) * inverse;
        }
    }
}

/// Displacement along the surface by shear τ: with d the way from the shear to the place and e = d/r,
/// ∫ (τ + ν/(1 − ν) e (e·τ))/r dA (Cerruti; [`crate::body::half_space`]).
impl Influence<2> for Resultants<2> {
    fn traction(fields: &PatchFields) -> [&[f64]; 2] {
        [&fields.shear[0], &fields.shear[1]]
    }

    /// The part of the moments, M_ij that of component i along j, is
    /// (M e + ν/(1 − ν) (3 e (e·M e) − Mᵀe − e tr M))/r².
    #[inline(always)]
    fn add_at(&self, poisson: f64, [along, across]: [f64; 2], least: f64, [along_sums, across_sums]: &mut [Lanes; 2]) {
        let [middle_x, middle_y] = &self.middle;
        let ([force_x, force_y], [[xx, xy], [yx, yy]]) = (&self.force, &self.moments);
        for lane in 0..LANES {
            let [x, y] = [along - middle_x[lane], across - middle_y[lane]];
            let inverse = 1.0 / (x * x + y * y).sqrt().max(least);
            let [x, y] = [x * inverse, y * inverse];
            let moments = [xx[lane] * x + xy[lane] * y, yx[lane] * x + yy[lane] * y];
            let transposed = [xx[lane] * x + yx[lane] * y, xy[lane] * x + yy[lane] * y];
            let trace = xx[lane] + yy[lane];
            let radial_force = force_x[lane] * x + force_y[lane] * y;
            let radial = radial_force + (3.0 * (moments[0] * x + moments[1] * y) - trace) * inverse;
            let component = |force: f64, moment: f64, transposed: f64, e: f64| {
                (force + moment * inverse + poisson * (e * radial - transposed * inverse)) * inverse
            };
            along_sums[lane] += component(force_x[lane], moments[0], transposed[0], x);
            across_sums[lane] += component(force_y[lane], moments[1], transposed[1], y);
        }
    }
}

/// Displacement of the windows by the pressure of each other.
pub type ByPressure = Apart<1>;
/// Displacement of the windows by the shear of each other.
pub type ByShear = Apart<2>;

/// Displacement of the windows by each other's tractions of N components, as many components of its own.
pub struct Apart<const N: usize> {
    resultants: [Vec<Resultants<N>>; WINDOWS],
    grain: Grain,
    /// Displacement at the places of the windows by the tractions of the others, scaled: with room for the finest grain.
    places: [[Vec<f64>; N]; WINDOWS],
    /// Displacement at the height of a strip between the rows, one value for each column.
    line: Vec<f64>,
    /// Buffers of [`resultants`].
    columns_of_cells: [[Vec<f64>; 2]; N],
    /// Displacement by the others on the grid, scaled.
    pub displacement: [[Vec<f64>; N]; WINDOWS],
}

impl<const N: usize> Apart<N>
where
    Resultants<N>: Influence<N>,
{
    /// Buffers for windows of the given operators.
    pub fn new(operators: &SurfaceOperators) -> Apart<N> {
        let grid = operators.sizes.largest;
        let finest = grain(&grid, true);
        let [strips, cells] = finest;
        let blocks = grid.strips.div_ceil(strips) * grid.cells.div_ceil(cells);
        let [rows, columns] = places_of(&grid, finest);
        let components = |length: usize| std::array::from_fn(|_| vec![0.0; length]);
        Apart {
            resultants: std::array::from_fn(|_| Vec::with_capacity(blocks.div_ceil(LANES))),
            grain: finest,
            places: std::array::from_fn(|_| components(rows * columns)),
            line: vec![0.0; columns],
            columns_of_cells: std::array::from_fn(|_| std::array::from_fn(|_| vec![0.0; grid.cells])),
            displacement: std::array::from_fn(|_| components(grid.len())),
        }
    }

    /// Whether more than one window carries anything: of one contact nothing comes back.
    pub fn is_coupled(&self) -> bool {
        self.resultants.iter().filter(|own| !own.is_empty()).count() > 1
    }

    /// Takes the traction that a window has now, or its change, where there are others that it displaces.
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

    /// Takes the traction that a window has now, or its change.
    fn take(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields, window: usize, place: &Place) {
        self.take_traction(
            operators,
            Resultants::<N>::traction(&fields.windows[window]),
            window,
            place,
        );
    }

    /// Takes a traction on the grid, or its change, for that of a window.
    pub fn take_traction(&mut self, operators: &SurfaceOperators, traction: [&[f64]; N], window: usize, place: &Place) {
        let found = &mut self.resultants[window];
        resultants(
            (&operators.of(place).grid, self.grain),
            place,
            traction,
            &mut self.columns_of_cells,
            found,
        );
    }

    /// Begins without any, for contacts that are close or far apart.
    pub fn clear(&mut self, operators: &SurfaceOperators, are_close: bool) {
        self.grain = grain(&operators.sizes.largest, are_close);
        self.resultants.iter_mut().for_each(Vec::clear);
        // What follows must not hang on what was solved before.
        self.places.iter_mut().flatten().for_each(|places| places.fill(0.0));
    }

    /// Changes the displacement of a window by that of a change of the tractions times a factor.
    pub fn add(&mut self, other: &Apart<N>, factor: f64, window: usize) {
        for component in 0..N {
            add_multiple(
                &other.places[window][component],
                factor,
                &mut self.places[window][component],
            );
            add_multiple(
                &other.displacement[window][component],
                factor,
                &mut self.displacement[window][component],
            );
        }
    }

    /// Begins with what the tractions of the fields do to each other's windows: of one window, nothing.
    pub fn begin(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) {
        if fields.used().count() > 1 {
            self.set_resultants(operators, fields);
            for (window, place) in fields.used() {
                self.displace(operators, window, &place);
            }
        } else {
            self.clear(operators, fields.are_close);
            for (window, _) in fields.used() {
                self.displacement[window]
                    .iter_mut()
                    .for_each(|component| component.fill(0.0));
            }
        }
    }

    /// Begins with the resultants of the traction of the fields, or of its change.
    pub fn set_resultants(&mut self, operators: &SurfaceOperators, fields: &SurfaceFields) {
        self.clear(operators, fields.are_close);
        for (window, place) in fields.used() {
            self.take(operators, fields, window, &place);
        }
    }

    /// Computes the displacement of a window by the others. Returns by how much it has changed at most, scaled.
    pub fn displace(&mut self, operators: &SurfaceOperators, window: usize, place: &Place) -> f64 {
        self.displace_but_for(Some(window), operators, window, place)
    }

    /// Computes the displacement of a window by all tractions that have been taken but for those of one window, or by all. Returns by how much it has changed at most, scaled.
    pub fn displace_but_for(
        &mut self,
        left_out: Option<usize>,
        operators: &SurfaceOperators,
        window: usize,
        place: &Place,
    ) -> f64 {
        let patch = operators.of(place);
        let grid = &patch.grid;
        let middle = place.middle_along(grid);
        let unit = operators.pair.normal() * patch.scales.pressure / patch.scales.displacement;
        let poisson = operators.pair.lateral / operators.pair.normal();
        let (resultants, [strips, cells]) = (&self.resultants, self.grain);
        let [rows, columns] = places_of(grid, self.grain);
        let least = 0.5 * grid.breadth;
        let places = &mut self.places[window];
        let change = dense::vectorised(
            #[inline(always)]
            |_| {
                let mut change = 0.0;
                for row in 0..rows {
                    let across = place.arc(grid, row * strips);
                    for column in 0..columns {
                        let along = middle + grid.x(0) + (column * cells) as f64 * grid.length;
                        let mut sums = [[0.0; LANES]; N];
                        for (other, others) in resultants.iter().enumerate() {
                            if Some(other) != left_out {
                                for from in others {
                                    from.add_at(poisson, [along, across], least, &mut sums);
                                }
                            }
                        }
                        for (places, sums) in places.iter_mut().zip(&sums) {
                            let displacement = &mut places[row * columns + column];
                            let now = unit * sums.iter().sum::<f64>();
                            change = f64::max(change, (now - *displacement).abs());
                            *displacement = now;
                        }
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
        let line = &mut self.line[..columns];
        let components = self.places[window].iter().zip(&mut self.displacement[window]);
        dense::vectorised(
            #[inline(always)]
            |_| {
                for (places, displacement) in components {
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
                }
            },
        );
    }
}

impl ByPressure {
    /// Displacement by the resultants at a place along the rail and an arc length, `m`.
    pub fn sinking(&self, operators: &SurfaceOperators, [along, across]: [f64; 2]) -> f64 {
        let unit = operators.pair.normal() * operators.shapes[0].scales.pressure;
        let mut sums = [[0.0; LANES]];
        for from in self.resultants.iter().flatten() {
            from.add_at(0.0, [along, across], f64::MIN_POSITIVE, &mut sums);
        }
        unit * sums.iter().flatten().sum::<f64>()
    }
}

/// Finds the resultants of the blocks of a window, of a grain, that carry anything, the forces over the unit of pressure, `m²`. The buffers have room for the
/// cells of a strip.
fn resultants<const N: usize>(
    (grid, [of_strips, of_cells]): (&Grid, Grain),
    place: &Place,
    traction: [&[f64]; N],
    buffers: &mut [[Vec<f64>; 2]; N],
    found: &mut Vec<Resultants<N>>,
) {
    found.clear();
    let mut count = 0;
    let (middle, area) = (place.middle_along(grid), grid.cell_area());
    for strips in (0..grid.strips).step_by(of_strips) {
        let strips = strips..(strips + of_strips).min(grid.strips);
        let across = 0.5 * (place.arc(grid, strips.start) + place.arc(grid, strips.end - 1));
        // Of the cells beside each other across the block: their sum, and its moment across.
        for ([sums, moments], traction) in buffers.iter_mut().zip(traction) {
            sums.fill(0.0);
            moments.fill(0.0);
            for strip in strips.clone() {
                let row = &traction[grid.row(strip)];
                add_multiple(row, 1.0, sums);
                add_multiple(row, place.arc(grid, strip) - across, moments);
            }
        }
        for first in (0..grid.cells).step_by(of_cells) {
            let cells = first..(first + of_cells).min(grid.cells);
            let along = 0.5 * (grid.x(cells.start) + grid.x(cells.end - 1));
            // Of each component: its force, and the moments along and across.
            let own = buffers.each_ref().map(|[sums, moments]| {
                let mut own = [0.0; 3];
                for cell in cells.clone() {
                    own[0] += sums[cell];
                    own[1] += sums[cell] * (grid.x(cell) - along);
                    own[2] += moments[cell];
                }
                own
            });
            if own == [[0.0; 3]; N] {
                continue;
            }
            let lane = count % LANES;
            if lane == 0 {
                found.push(Resultants::NONE);
            }
            count += 1;
            let block = found.last_mut().expect("one has been added");
            for (component, [force, moment_along, moment_across]) in own.into_iter().enumerate() {
                block.force[component][lane] = area * force;
                block.moments[component][0][lane] = area * moment_along;
                block.moments[component][1][lane] = area * moment_across;
            }
            block.middle[0][lane] = middle + along;
            block.middle[1][lane] = across;
        }
    }
}
