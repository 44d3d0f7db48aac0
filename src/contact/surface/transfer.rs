//! Transfer of what a step begins with from windows at one place to windows at another.
//!
//! The rail's surface stays where it is: a cell takes the mean of what it covers of the cells of the windows before. Cells of all windows
//! are whole numbers of each other, so that a window that is shifted takes whole cells, and one whose cells become larger or smaller the
//! mean or the copy of whole cells: heat and worn volume are kept.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::windows::{Place, WINDOWS};
use crate::body::grid::Grid;
use crate::contact::patch::fields::PatchFields;
use crate::numerics::dense::LANES;
use crate::transport::strips::{Side, Strips};

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
    /// Cells by the window that they come from: of tractions, which are 0 beyond it.
    cells: [Sources; WINDOWS],
    /// Columns of heat and wear, which go on beyond the window as at its end.
    columns: [Sources; WINDOWS],
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
            cells: std::array::from_fn(|_| room(grid.cells)),
            columns: std::array::from_fn(|_| room(grid.cells + 2)),
        }
    }

    /// Sets the fields of a window at a place from the fields before.
    pub fn fill(
        &mut self,
        operators: &SurfaceOperators,
        before: &SurfaceFields,
        place: &Place,
        into: &mut PatchFields,
        own: usize,
    ) {
        self.find(operators, before, place);
        let window = operators.of(place);
        let (grid, modes) = (&window.grid, window.basis.len());
        let sources = &before.windows;
        let stride = grid.stride();
        // Tractions, slip and displacement on the grid.
        let on_grid: [fn(&PatchFields) -> &Vec<f64>; 10] = [
            |fields| &fields.pressure,
            |fields| &fields.shear[0],
            |fields| &fields.shear[1],
            |fields| &fields.slip[0],
            |fields| &fields.slip[1],
            |fields| &fields.friction,
            |fields| &fields.displacement[0],
            |fields| &fields.displacement[1],
            |fields| &fields.displacement_change[0],
            |fields| &fields.displacement_change[1],
        ];
        let [x, y] = &mut into.shear;
        let [slip_x, slip_y] = &mut into.slip;
        let [u_x, u_y] = &mut into.displacement;
        let [change_x, change_y] = &mut into.displacement_change;
        let targets = [
            &mut into.pressure,
            x,
            y,
            slip_x,
            slip_y,
            &mut into.friction,
            u_x,
            u_y,
            change_x,
            change_y,
        ];
        for (target, of) in targets.into_iter().zip(on_grid) {
            self.mean(grid, stride, |share| of(&sources[share.window]), target);
        }
        // The memory of friction, strip by strip without the rows' ends.
        into.memory.remembers = before.used().any(|(window, _)| sources[window].memory.remembers);
        for part in 0..10 {
            let of = |share: &Share| sources[share.window].memory.vectors()[part];
            let mut values = std::mem::take(into.memory.vectors_mut()[part]);
            self.mean(grid, grid.cells, of, &mut values);
            *into.memory.vectors_mut()[part] = values;
        }
        self.carry(
            &window.strips,
            modes,
            |fields| &fields.heat.window,
            before,
            &mut into.heat.window,
        );
        self.carry(
            &window.strips,
            1,
            |fields| &fields.wear.window,
            before,
            &mut into.wear.window,
        );
        let of_cells: [fn(&PatchFields) -> &Vec<f64>; 4] = [
            |fields| &fields.heat.surface,
            |fields| &fields.heat.flux,
            |fields| &fields.heat.content,
            |fields| &fields.wear.depth,
        ];
        let targets = [
            &mut into.heat.surface,
            &mut into.heat.flux,
            &mut into.heat.content,
            &mut into.wear.depth,
        ];
        for (target, of) in targets.into_iter().zip(of_cells) {
            for strip in 0..grid.strips {
                for cell in 0..grid.cells {
                    // The first column is the one beside the window.
                    let sum = self.sum(
                        strip,
                        |from| (&self.columns[from], cell + 1),
                        |share, column| {
                            let (cells, column) = (grid.cells, column.clamp(1, grid.cells) - 1);
                            of(&sources[share.window])[share.index * cells + column]
                        },
                    );
                    target[strip * grid.cells + cell] = sum;
                }
            }
        }
        self.carry_outer(operators, before, place, into, own);
        into.relaxation_length = window.relaxation_length;
        into.wheel_temperature = before.wheel_temperature;
    }

    /// Finds the sources of strips, cells and columns.
    fn find(&mut self, operators: &SurfaceOperators, before: &SurfaceFields, place: &Place) {
        let grid = operators.of(place).grid;
        let Transfer { strips, cells, columns } = self;
        strips.clear();
        for strip in 0..grid.strips {
            strips.begins.push(strips.shares.len());
            let first = strips.shares.len();
            let from = (f64::from(place.strip) + strip as f64) * grid.breadth;
            for (window, source) in before.used() {
                let own = operators.of(&source).grid;
                let begin = f64::from(source.strip) * own.breadth;
                shares(from - begin, grid.breadth, &own.breadth, own.strips, |index, weight| {
                    strips.shares.push(Share { window, index, weight });
                });
            }
            // Windows that lie over each other share what both cover.
            let total: f64 = strips.shares[first..].iter().map(|share| share.weight).sum();
            if total > 1.0 {
                strips.shares[first..]
                    .iter_mut()
                    .for_each(|share| share.weight /= total);
            }
        }
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

    /// Sum over the sources of a strip, and along the rail over those that `along` names: the sources and the target among them.
    fn sum<'a>(
        &'a self,
        strip: usize,
        along: impl Fn(usize) -> (&'a Sources, usize),
        value: impl Fn(&Share, usize) -> f64,
    ) -> f64 {
        let mut sum = 0.0;
        for share in self.strips.of(strip) {
            let (sources, target) = along(share.window);
            for part in sources.of(target) {
                sum += share.weight * part.weight * value(share, part.index);
            }
        }
        sum
    }

    /// Takes the mean of values at cells, whose strips are `stride` values apart.
    fn mean<'f>(&self, grid: &Grid, stride: usize, of: impl Fn(&Share) -> &'f Vec<f64>, into: &mut [f64]) {
        for strip in 0..grid.strips {
            for cell in 0..grid.cells {
                into[strip * stride + cell] = self.sum(
                    strip,
                    |from| (&self.cells[from], cell),
                    |share, cell| of(share)[share.index * stride + cell],
                );
            }
        }
    }

    /// Carries amplitudes of so many modes in the columns of the strips along.
    fn carry(
        &self,
        strips: &Strips,
        modes: usize,
        of: fn(&PatchFields) -> &Vec<f64>,
        before: &SurfaceFields,
        into: &mut [f64],
    ) {
        into.fill(0.0);
        let columns = strips.columns();
        let at = |strip: usize, column: usize| (strip / LANES * columns + column) * modes * LANES + strip % LANES;
        for strip in 0..strips.strips {
            for share in self.strips.of(strip) {
                let from = of(&before.windows[share.window]);
                let sources = &self.columns[share.window];
                for column in 0..columns {
                    for part in sources.of(column) {
                        let weight = share.weight * part.weight;
                        let (to, source) = (at(strip, column), at(share.index, part.index));
                        for mode in 0..modes {
                            into[to + mode * LANES] += weight * from[source + mode * LANES];
                        }
                    }
                }
            }
        }
    }

    /// Carries the rail on either side of the window along: that of the window with the same number, or else of the first that is used.
    fn carry_outer(
        &self,
        operators: &SurfaceOperators,
        before: &SurfaceFields,
        place: &Place,
        into: &mut PatchFields,
        own: usize,
    ) {
        let source = before.places[own]
            .map(|from| (own, from))
            .or_else(|| before.used().next());
        let modes = operators.of(place).basis.len();
        let strips = &operators.of(place).strips;
        for side in [Side::Left, Side::Right] {
            let k = side as usize;
            let Some((window, from)) = source else {
                into.heat.breadth = strips.breadth * strips.strips as f64;
                into.wear.breadth = into.heat.breadth;
                into.heat.outer[k].fill(0.0);
                into.wear.outer[k].fill(0.0);
                continue;
            };
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
