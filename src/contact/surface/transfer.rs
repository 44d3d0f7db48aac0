//! Transfer of what a step begins with from windows at one place to windows at another.
//!
//! The rail's surface stays where it is: a cell takes the mean of what it covers of the cells of the windows before. Cells of all windows
//! are whole numbers of each other, so that a window that is shifted takes whole cells, and one whose cells become larger or smaller the
//! mean or the copy of whole cells: heat and worn volume of what it covers are kept.
//!
//! Windows may lie over each other. Each of them has the rail that it carries on as it is, and the rest as if nothing touched it: a place takes
//! what there is from the window that carries there, or carried last, which has left heat. Rail that no window has been over is as the
//! rail beside the contact, displaced by the shear in the windows, and its friction that of rested rail.

use super::apart::ByShear;
use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::operators::PatchOperators;
use crate::numerics::dense::{self, LANES};
use crate::transport::strips::{Side, Strips};

/// Rail under the windows, and how it is where nothing has touched it.
pub struct Rail<'a> {
    /// Operators of the windows.
    pub operators: &'a SurfaceOperators,
    /// Temperature with which the rail comes in, over the ambient, `K`.
    pub rise: f64,
    /// Depth of wear with which it comes in, `m`.
    pub depth: f64,
    /// Static coefficient of friction on a strip of a window at a temperature over the ambient, `K`.
    pub friction: &'a dyn Fn(&Place, usize, f64) -> f64,
}

/// Share of a source in a target.
#[derive(Debug, Clone, Copy)]
struct Share {
    /// Window of the source.
    window: usize,
    /// Strip, cell or column of the source.
    index: usize,
    weight: f64,
}

/// Sources of the strips, cells or columns of a window.
#[derive(Debug, Default)]
struct Sources {
    shares: Vec<Share>,
    /// Beginning of the shares of each target.
    begins: Vec<usize>,
}

impl Sources {
    fn clear(&mut self) {
        self.shares.clear();
        self.begins.clear();
    }

    fn of(&self, target: usize) -> &[Share] {
        let end = self.begins.get(target + 1).copied().unwrap_or(self.shares.len());
        &self.shares[self.begins[target]..end]
    }
}

/// Buffers of a transfer.
pub struct Transfer {
    strips: Sources,
    /// Share of each strip that no window has been over.
    uncovered: Vec<f64>,
    /// Traces of what happened on the strips of the windows before, to compare: pressure, then warmth, then wear.
    traces: [Vec<[f64; 3]>; WINDOWS],
    /// Cells by the window that they come from: of tractions, which are 0 beyond it.
    cells: [Sources; WINDOWS],
    /// Columns of heat and wear, which go on beyond the window as at its end.
    columns: [Sources; WINDOWS],
    /// Displacement by the shear of all windows before: that of rail that no window has been over.
    by_shear: ByShear,
}

impl Transfer {
    /// Buffers for windows of the given operators.
    pub fn new(operators: &SurfaceOperators) -> Transfer {
        let grid = operators.sizes.largest;
        // A cell covers up to 64 cells of a window that is six sizes smaller, in each of the windows.
        let room = |targets: usize| Sources {
            shares: Vec::with_capacity(targets * WINDOWS * 65),
            begins: Vec::with_capacity(targets + 1),
        };
        Transfer {
            strips: room(grid.strips),
            uncovered: Vec::with_capacity(grid.strips),
            traces: std::array::from_fn(|_| Vec::with_capacity(grid.strips)),
            cells: std::array::from_fn(|_| room(grid.cells)),
            columns: std::array::from_fn(|_| room(grid.cells + 2)),
            by_shear: ByShear::new(operators),
        }
    }

    /// Begins transfers from the fields before: finds what has happened on the strips of their windows.
    pub fn begin(&mut self, rail: &Rail, before: &SurfaceFields) {
        for (window, place) in before.used() {
            let grid = &rail.operators.of(&place).grid;
            let own = &before.windows[window];
            let away = |values: &[f64], from: f64| values.iter().map(|value| (value - from).abs()).sum::<f64>();
            let traces = (0..grid.strips).map(|strip| {
                let cells = strip * grid.cells..(strip + 1) * grid.cells;
                [
                    dense::sum(&own.pressure[grid.row(strip)]),
                    away(&own.heat.surface[cells.clone()], rail.rise),
                    away(&own.wear.depth[cells], rail.depth),
                ]
            });
            self.traces[window].clear();
            self.traces[window].extend(traces);
        }
        self.by_shear.set_resultants(rail.operators, before);
    }

    /// Sets the fields of a window at a place from the fields before, with which the transfers have begun.
    pub fn fill(&mut self, rail: &Rail, before: &SurfaceFields, place: &Place, into: &mut PatchFields, own: usize) {
        self.find(rail.operators, before, place);
        let window = rail.operators.of(place);
        let grid = &window.grid;
        let sources = &before.windows;
        let stride = grid.stride();
        // Tractions and slip on the grid.
        let on_grid: [fn(&PatchFields) -> &Vec<f64>; 6] = [
            |fields| &fields.pressure,
            |fields| &fields.shear[0],
            |fields| &fields.shear[1],
            |fields| &fields.slip[0],
            |fields| &fields.slip[1],
            |fields| &fields.friction,
        ];
        let [x, y] = &mut into.shear;
        let [slip_x, slip_y] = &mut into.slip;
        let targets = [&mut into.pressure, x, y, slip_x, slip_y, &mut into.friction];
        for (target, of) in targets.into_iter().zip(on_grid) {
            self.mean(grid, stride, |share| of(&sources[share.window]), |_, _| 0.0, target);
        }
        self.by_shear.displace_but_for(None, rail.operators, own, place);
        for (component, by_shear) in self.by_shear.displacement[own].iter().enumerate() {
            let of = |share: &Share| &sources[share.window].displacement[component];
            let elsewhere = |strip: usize, cell: usize| by_shear[grid.place(strip, cell)];
            self.mean(grid, stride, of, elsewhere, &mut into.displacement[component]);
            let of = |share: &Share| &sources[share.window].displacement_change[component];
            self.mean(grid, stride, of, |_, _| 0.0, &mut into.displacement_change[component]);
        }
        self.carry_heat_and_wear(rail, before, place, into, own);
        self.carry_memory(rail, before, place, into);
        into.relaxation_length = window.relaxation_length;
        into.wheel_temperature = before.wheel_temperature;
    }

    /// Carries the history of friction along, strip by strip without the rows' ends.
    fn carry_memory(&self, rail: &Rail, before: &SurfaceFields, place: &Place, into: &mut PatchFields) {
        // Of `Memory::vectors`: the coefficients, now and at the beginning of the step, and the share of μ(θ) in them. The others are 0 of rested rail.
        const COEFFICIENTS: [usize; 4] = [0, 2, 4, 6];
        const SHARE: usize = 8;
        let sources = &before.windows;
        let remembers = before.used().any(|(window, _)| sources[window].memory.remembers);
        if !remembers {
            into.memory.forget();
            return;
        }
        into.memory.remembers = true;
        let grid = &rail.operators.of(place).grid;
        let rises = &into.heat.surface;
        for (part, values) in into.memory.vectors_mut().into_iter().enumerate() {
            let of = |share: &Share| sources[share.window].memory.vectors()[part];
            let rested = |strip: usize, cell: usize| {
                if COEFFICIENTS.contains(&part) {
                    (rail.friction)(place, strip, rises[strip * grid.cells + cell])
                } else if part == SHARE {
                    1.0
                } else {
                    0.0
                }
            };
            self.mean(grid, grid.cells, of, rested, values);
        }
    }

    /// Carries heat and wear along.
    fn carry_heat_and_wear(
        &self,
        rail: &Rail,
        before: &SurfaceFields,
        place: &Place,
        into: &mut PatchFields,
        own: usize,
    ) {
        let window = rail.operators.of(place);
        let (grid, strips, modes) = (&window.grid, &window.strips, window.basis.len());
        // The rail beside the contact is that of the window with the same number, or else of the first that is used.
        let source = before.places[own]
            .map(|from| (own, from))
            .or_else(|| before.used().next());
        match source {
            Some((beside, from)) => {
                let [heat, wear]: [fn(&PatchFields) -> &Vec<f64>; 2] =
                    [|fields| &fields.heat.window, |fields| &fields.wear.window];
                self.carry(strips, modes, heat, (before, beside), &mut into.heat.window);
                self.carry(strips, 1, wear, (before, beside), &mut into.wear.window);
                carry_outer(rail.operators, before, (beside, from), place, into);
            }
            None => enter(window, rail, into),
        }
        let (heat, wear) = (&mut into.heat, &mut into.wear);
        for strip in 0..grid.strips {
            for cell in 0..grid.cells {
                let at = strip * grid.cells + cell;
                heat.surface[at] = window.basis.surface_value(heat.amplitudes(strips, strip, cell));
                heat.content[at] = window.basis.content(heat.amplitudes(strips, strip, cell));
                wear.depth[at] = wear.window[place_of(strips, 1, strip, cell + 1)];
            }
        }
        let fluxes = |share: &Share| &before.windows[share.window].heat.flux;
        self.mean(grid, grid.cells, fluxes, |_, _| 0.0, &mut heat.flux);
    }

    /// Finds the sources of strips, cells and columns.
    fn find(&mut self, operators: &SurfaceOperators, before: &SurfaceFields, place: &Place) {
        let grid = operators.of(place).grid;
        self.find_strips(operators, before, place);
        let Transfer { cells, columns, .. } = self;
        for (window, source) in before.used() {
            let own = operators.of(&source).grid;
            let begin = f64::from(source.cell) * own.length;
            let (cells, columns) = (&mut cells[window], &mut columns[window]);
            cells.clear();
            columns.clear();
            for column in 0..grid.cells + 2 {
                let from = (f64::from(place.cell) + column as f64 - 1.0) * grid.length - begin;
                if (1..=grid.cells).contains(&column) {
                    cells.begins.push(cells.shares.len());
                    shares(from, grid.length, &own.length, own.cells, |index, weight| {
                        cells.shares.push(Share { window, index, weight });
                    });
                }
                columns.begins.push(columns.shares.len());
                let mut total = 0.0;
                shares(
                    from + own.length,
                    grid.length,
                    &own.length,
                    own.cells + 2,
                    |index, weight| {
                        total += weight;
                        columns.shares.push(Share { window, index, weight });
                    },
                );
                if total < 1.0 - 1e-9 {
                    let middle = from + 0.5 * grid.length;
                    columns.shares.push(Share {
                        window,
                        index: if middle < 0.5 * own.length * own.cells as f64 {
                            0
                        } else {
                            own.cells + 1
                        },
                        weight: 1.0 - total,
                    });
                }
            }
        }
    }

    /// Finds the sources of strips: in pieces that are whole strips of any window, each from the window that has left most there.
    fn find_strips(&mut self, operators: &SurfaceOperators, before: &SurfaceFields, place: &Place) {
        let grid = operators.of(place).grid;
        let Transfer {
            strips,
            uncovered,
            traces,
            ..
        } = self;
        strips.clear();
        uncovered.clear();
        let finest = before
            .used()
            .map(|(_, source)| operators.of(&source).grid.breadth)
            .fold(grid.breadth, f64::min);
        let pieces = (grid.breadth / finest).round() as usize;
        let weight = 1.0 / pieces as f64;
        for strip in 0..grid.strips {
            strips.begins.push(strips.shares.len());
            let first = strips.shares.len();
            let from = (f64::from(place.strip) + strip as f64) * grid.breadth;
            let mut left = 0.0;
            for piece in 0..pieces {
                let middle = from + (piece as f64 + 0.5) * finest;
                let covering = before.used().filter_map(|(window, source)| {
                    let breadth = operators.of(&source).grid.breadth;
                    let index = (middle / breadth - f64::from(source.strip)).floor();
                    let index = (index >= 0.0 && index < grid.strips as f64).then_some(index as usize)?;
                    Some((window, index, traces[window][index]))
                });
                let most = covering.reduce(|most, other| if other.2 > most.2 { other } else { most });
                let Some((window, index, _)) = most else {
                    left += weight;
                    continue;
                };
                let last = strips.shares[first..].last_mut();
                match last.filter(|last| (last.window, last.index) == (window, index)) {
                    Some(last) => last.weight += weight,
                    None => strips.shares.push(Share { window, index, weight }),
                }
            }
            uncovered.push(left);
        }
    }

    /// Takes the mean of values at cells, whose strips are `stride` values apart, with the value that a cell has where no window has been.
    fn mean<'f>(
        &self,
        grid: &Grid,
        stride: usize,
        of: impl Fn(&Share) -> &'f Vec<f64>,
        elsewhere: impl Fn(usize, usize) -> f64,
        into: &mut [f64],
    ) {
        for strip in 0..grid.strips {
            for cell in 0..grid.cells {
                let (mut sum, mut covered) = (0.0, 0.0);
                for share in self.strips.of(strip) {
                    let values = of(share);
                    for part in self.cells[share.window].of(cell) {
                        let weight = share.weight * part.weight;
                        sum += weight * values[share.index * stride + part.index];
                        covered += weight;
                    }
                }
                if covered < 1.0 - 1e-9 {
                    sum += (1.0 - covered) * elsewhere(strip, cell);
                }
                into[strip * stride + cell] = sum;
            }
        }
    }

    /// Carries amplitudes of so many modes in the columns of the strips, and of the rail beside the contact, along. Rail that no window has been over has those of the rail
    /// beside the contact in the given window.
    fn carry(
        &self,
        strips: &Strips,
        modes: usize,
        of: fn(&PatchFields) -> &Vec<f64>,
        (before, beside): (&SurfaceFields, usize),
        into: &mut [f64],
    ) {
        into.fill(0.0);
        let mut add = |strip: usize, share: &Share| {
            let from = of(&before.windows[share.window]);
            let sources = &self.columns[share.window];
            for column in 0..strips.columns() {
                for part in sources.of(column) {
                    let weight = share.weight * part.weight;
                    let to = place_of(strips, modes, strip, column);
                    let source = place_of(strips, modes, share.index, part.index);
                    for mode in 0..modes {
                        into[to + mode * LANES] += weight * from[source + mode * LANES];
                    }
                }
            }
        };
        for strip in 0..strips.strips {
            self.strips.of(strip).iter().for_each(|share| add(strip, share));
        }
        for strip in 0..strips.blocks() * LANES {
            let weight = self.uncovered.get(strip).copied().unwrap_or(1.0);
            if weight > 0.0 {
                let (window, index) = (beside, strips.strips);
                add(strip, &Share { window, index, weight });
            }
        }
    }
}

/// Index of a strip's first mode in a column, of values that are kept in blocks of [`LANES`] strips with so many modes.
fn place_of(strips: &Strips, modes: usize, strip: usize, column: usize) -> usize {
    (strip / LANES * strips.columns() + column) * modes * LANES + strip % LANES
}

/// Sets rail that has come in and nothing has touched in all of a window and on either side of it.
fn enter(window: &PatchOperators, rail: &Rail, into: &mut PatchFields) {
    let (modes, strips) = (window.basis.len(), &window.strips);
    let [left, right] = &mut into.heat.outer;
    for column in left.chunks_exact_mut(modes).chain(right.chunks_exact_mut(modes)) {
        window.incoming.enter(rail.rise, column, &mut 0.0);
    }
    for column in into.heat.window.chunks_exact_mut(modes * LANES) {
        for (lanes, amplitude) in column.chunks_exact_mut(LANES).zip(&left[..modes]) {
            lanes.fill(*amplitude);
        }
    }
    into.wear.window.fill(rail.depth);
    into.wear.outer.iter_mut().for_each(|outer| outer.fill(rail.depth));
    into.heat.breadth = strips.breadth * strips.strips as f64;
    into.wear.breadth = into.heat.breadth;
}

/// Carries the rail on either side of the window along, from the given window.
fn carry_outer(
    operators: &SurfaceOperators,
    before: &SurfaceFields,
    (window, from): (usize, Place),
    place: &Place,
    into: &mut PatchFields,
) {
    let modes = operators.of(place).basis.len();
    let strips = &operators.of(place).strips;
    for side in [Side::Left, Side::Right] {
        let k = side as usize;
        let before = &before.windows[window];
        into.heat.breadth = before.heat.breadth;
        into.wear.breadth = before.wear.breadth;
        if from.length == place.length {
            into.heat.outer[k].copy_from_slice(&before.heat.outer[k]);
            into.wear.outer[k].copy_from_slice(&before.wear.outer[k]);
            continue;
        }
        let (to, from) = (
            strips.outer_positions(side),
            operators.of(&from).strips.outer_positions(side),
        );
        for (column, x) in to.iter().enumerate() {
            let after = from.partition_point(|place| place < x).clamp(1, from.len() - 1);
            let share = ((x - from[after - 1]) / (from[after] - from[after - 1])).clamp(0.0, 1.0);
            let between = |values: &[f64], mode: usize, modes: usize| {
                (1.0 - share) * values[(after - 1) * modes + mode] + share * values[after * modes + mode]
            };
            for mode in 0..modes {
                into.heat.outer[k][column * modes + mode] = between(&before.heat.outer[k], mode, modes);
            }
            into.wear.outer[k][column] = between(&before.wear.outer[k], 0, 1);
        }
    }
}

/// Finds the shares of cells of a size, counted from 0, in a stretch from a place on.
fn shares(from: f64, length: f64, size: &f64, count: usize, mut found: impl FnMut(usize, f64)) {
    let to = from + length;
    let first = (from / size - 1e-6).floor().max(0.0) as usize;
    for index in first..count {
        let begin = index as f64 * size;
        let covered = to.min(begin + size) - from.max(begin);
        if begin >= to - 1e-6 * size {
            break;
        }
        if covered > 1e-6 * size.min(length) {
            found(index, covered / length);
        }
    }
}

#[cfg(test)]
mod tests;
