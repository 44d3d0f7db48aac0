//! Friction that depends on slip in the law of the cells: the bound of a cell follows from its slip, and where friction remembers, from
//! that of the cells that its particles have come through.

use crate::body::grid::Grid;
use crate::friction::path::{Link, NodeFriction, Passed, PathLaw, PathNode};
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::law::{Scheme, Vector, dot};
use crate::mechanics::patch::law_arrays::{CellArrays, Components, LawArrays, SpeedArrays};
use crate::mechanics::patch::linear_law::{Change, LinearRow};
use crate::numerics::single::WIDTH;

/// Law of μ of all cells, where it depends on slip.
#[derive(Clone, Copy)]
pub struct PathOfCells<'a> {
    /// Law that the cells have in common.
    pub law: PathLaw,
    /// Constants of the law of the cells under pressure, strip by strip; the first in contact on a path takes nothing from another.
    pub nodes: &'a [PathNode],
    /// Pressure of the cells under pressure, scaled.
    pub pressure: &'a [f64],
}

/// Coefficients μ of the cells, with the changes of μ and of the slip velocity.
pub struct OnPath {
    pub(super) friction: Vec<NodeFriction>,
    /// Magnitudes of the law's slip.
    pub(super) speeds: SpeedArrays,
    /// Change of the magnitude.
    change: Vec<f64>,
    /// Magnitude in single precision, for corrections: linearised.
    linear: LinearRow,
    /// Change of the magnitude in a correction, in single precision, with values for a vector register beyond the cells.
    change_single: Vec<f32>,
    /// Derivatives by which a correction of μ follows from that of the cell before.
    links: Vec<Link<f32>>,
    /// Derivatives of the law's residual by μ, along x and y.
    by_friction: [Vec<f32>; 2],
}

impl OnPath {
    pub(super) fn new(cells: usize) -> OnPath {
        OnPath {
            friction: vec![NodeFriction::default(); cells],
            speeds: SpeedArrays::new(cells),
            change: vec![0.0; cells],
            linear: LinearRow::new(cells),
            change_single: vec![0.0; cells + WIDTH],
            links: vec![Link::default(); cells],
            by_friction: std::array::from_fn(|_| vec![0.0; cells]),
        }
    }

    /// Finds the bounds of so many cells, which follow from their slip, in the order in which particles come to them. Their dependence on the slip of
    /// the cells before is not in the bound's derivative.
    pub(super) fn find_bounds(&mut self, path: &PathOfCells, scheme: &Scheme, count: usize, cells: &mut CellArrays) {
        cells.speeds(scheme, count, &mut self.speeds);
        let mut before = Passed::default();
        for index in path.law.order(count) {
            let (speed, pressure) = (self.speeds.speed[index], path.pressure[index]);
            let friction = path.law.friction(&path.nodes[index], &before, speed, pressure);
            before = friction.passed(speed);
            cells.bound[index] = friction.coefficient * pressure;
            self.speeds.bound_by_speed[index] = pressure * friction.by_speed();
            self.friction[index] = friction;
        }
    }

    /// Takes for corrections the law by which so many cells follow those before them, where friction remembers.
    pub(super) fn take_links(&mut self, path: &PathOfCells, rows: &LawArrays, edge: &Components, count: usize) {
        if !path.law.remembers() {
            return;
        }
        let SpeedArrays {
            by_ahead, by_behind, ..
        } = &self.speeds;
        self.linear.take(None, by_ahead, by_behind, edge, count);
        for (link, friction) in self.links[..count].iter_mut().zip(&self.friction) {
            *link = friction.link().single();
        }
        for (out, by_bound) in self.by_friction.iter_mut().zip(&rows.by_bound) {
            for ((out, by_bound), pressure) in out[..count].iter_mut().zip(by_bound).zip(path.pressure) {
                *out = (by_bound * pressure) as f32;
            }
        }
    }

    /// Adds to the change of the residual of all cells, along x and y, what they take over from the cells before, where friction remembers.
    pub(super) fn add_linked(
        &mut self,
        path: &PathOfCells,
        (contact, grid): (&Contact, &Grid),
        change: &Change,
        [along, across]: [&mut [f32]; 2],
    ) {
        if !path.law.remembers() {
            return;
        }
        self.linear.multiply(contact, grid, change, &mut self.change_single);
        let mut before = Passed::default();
        for index in path.law.order(contact.cells()) {
            let linked;
            (linked, before) = self.links[index].change(&before, self.change_single[index]);
            along[index] += self.by_friction[0][index] * linked;
            across[index] += self.by_friction[1][index] * linked;
        }
    }

    /// Changes of μ of n cells by the kept changes of the slip velocities of the cells before them.
    pub(super) fn follow(&self, path: &PathOfCells, n: usize, mut take: impl FnMut(usize, f64)) {
        if !path.law.remembers() {
            return;
        }
        let mut before = Passed::default();
        for index in path.law.order(n) {
            let friction = &self.friction[index];
            let (by_before, passed) = friction.change(&before, self.change[index], 0.0);
            take(index, by_before);
            before = passed;
        }
    }

    /// Changes of μ of n cells by the kept changes of all slip velocities, their own included.
    pub(super) fn changes(&self, path: &PathOfCells, n: usize, mut take: impl FnMut(usize, f64)) {
        let mut before = Passed::default();
        for index in path.law.order(n) {
            let (friction, speed) = (&self.friction[index], self.change[index]);
            let (by_before, passed) = friction.change(&before, speed, 0.0);
            take(index, by_before + friction.by_speed() * speed);
            before = passed;
        }
    }

    /// Keeps the change of a cell's slip velocity with that of the slip ahead and behind and with that of w, whether or not friction
    /// remembers.
    pub(super) fn keep_slip_and_noise_change(&mut self, index: usize, ahead: Vector, behind: Vector, noise: f64) {
        let by = self.speeds.change(index);
        self.change[index] = dot(by.by_ahead, ahead) + dot(by.by_behind, behind) + by.by_noise * noise;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::memory::Memory;
    use crate::friction::path::PathStep;
    use crate::parameters::Parameters;

    const CELLS: usize = 12;
    const STRIPS: usize = 3;
    const PRESSURE: f64 = 1e9;

    fn wave(i: usize, k: usize) -> f64 {
        (1.3 * i as f64 + 2.1 * k as f64).sin()
    }

    /// Friction that follows slip and remembers, with a layer that flows in some of the cells and without.
    fn law(forward: bool, flows: bool) -> PathLaw {
        let parameters = Parameters {
            friction_slip_share: 0.4,
            friction_slip_decay: 0.7,
            friction_memory_distance: 1e-5,
            layer_yield_stress: if flows { 0.1 * PRESSURE } else { 0.0 },
            layer_hardening: if flows { 2e4 * PRESSURE } else { 0.0 },
            ..Parameters::default()
        };
        let step = PathStep {
            // Particles pass several cells in the step.
            duration: 1e-4,
            spacing: 2e-4,
            speed: if forward { 10.0 } else { -10.0 },
            displacement: 2e-6,
            pressure: PRESSURE,
        };
        PathLaw::new(&parameters, &step).expect("friction follows slip")
    }

    /// Corrections take over from the cells before what the linearised law in double precision takes over, whichever way particles come.
    #[test]
    fn corrections_follow_as_the_linearised_law_does() {
        let grid = Grid::new(CELLS, STRIPS, 1.0, 1.0);
        let mut contact = Contact::new(&grid);
        // Two contacts on the second strip.
        contact.list(&grid, |place| {
            let (strip, cell) = (place / grid.stride(), place % grid.stride());
            (1..11).contains(&cell) && (strip != 1 || cell % 5 != 0)
        });
        let n = contact.cells();
        let index_of = |wanted: usize| contact.places(&grid).position(|place| place == wanted);
        for forward in [true, false] {
            for flows in [false, true] {
                let law = law(forward, flows);
                let mut memory = Memory::new(CELLS * STRIPS);
                let brought = &mut memory.before;
                for i in 0..CELLS * STRIPS {
                    brought.friction[i] = 0.3 + 0.05 * wave(i, 0);
                    brought.speed[i] = 0.02 + 0.01 * wave(i, 1);
                    brought.static_friction[i] = 0.35;
                    brought.flow[i] = 1e-6;
                }
                let mut nodes = vec![PathNode::default(); n];
                for strip in 0..STRIPS {
                    let at = |cell: usize| index_of(grid.place(strip, cell));
                    let path = memory.before.path(strip * CELLS..(strip + 1) * CELLS);
                    law.prepare(
                        &path,
                        &[0.35; CELLS],
                        |cell| at(cell).is_some(),
                        |cell, node| {
                            if let Some(index) = at(cell) {
                                nodes[index] = node;
                            }
                        },
                    );
                }
                let pressure: Vec<f64> = (0..n).map(|i| 0.5 + 0.3 * wave(i, 2)).collect();
                let path = PathOfCells {
                    law,
                    nodes: &nodes,
                    pressure: &pressure,
                };
                let (mut cells, mut rows, mut on_path) = (CellArrays::new(n), LawArrays::new(n), OnPath::new(n));
                for i in 0..n {
                    for j in 0..2 {
                        cells.shear[j][i] = 0.4 * wave(i, 3 + j);
                        cells.ahead[j][i] = 0.3 * wave(i, 5 + j);
                        cells.behind[j][i] = 0.3 * wave(i, 7 + j);
                    }
                    cells.scale[i] = 0.8;
                }
                let scheme = Scheme {
                    scale: f64::NAN,
                    noise: 1e-3,
                    regularisation: 0.0,
                };
                on_path.find_bounds(&path, &scheme, n, &mut cells);
                rows.take(&cells, &scheme, n, Some(&mut on_path.speeds));
                let edge: Components = [0, 1].map(|k| {
                    (0..n)
                        .map(|i| if i % 9 == 0 { 0.2 + 0.1 * k as f64 } else { 0.0 })
                        .collect()
                });
                on_path.take_links(&path, &rows, &edge, n);
                let values = |k: usize, number: usize| -> Vec<f32> { (0..number).map(|i| wave(i, k) as f32).collect() };
                let shear = [9, 10].map(|k| values(k, n + WIDTH));
                let slip = [11, 12].map(|k| values(k, grid.len() + WIDTH));
                let behind = if forward { -1 } else { 1 };
                let change = Change {
                    shear: [&shear[0], &shear[1]],
                    slip: [&slip[0], &slip[1]],
                    behind,
                };
                let (mut along, mut across) = (vec![0.0; n], vec![0.0; n]);
                on_path.add_linked(&path, (&contact, &grid), &change, [&mut along, &mut across]);
                for (index, place) in contact.places(&grid).enumerate() {
                    let at = |values: &[Vec<f32>; 2], place: usize| -> Vector {
                        [0, 1].map(|j: usize| f64::from(values[j][place]))
                    };
                    let (own, mut ahead) = (at(&shear, index), at(&slip, place));
                    ahead[0] += edge[0][index] * own[0];
                    ahead[1] += edge[1][index] * own[1];
                    on_path.keep_slip_and_noise_change(index, ahead, at(&slip, place.wrapping_add_signed(behind)), 0.0);
                }
                let mut largest = 0.0_f64;
                on_path.follow(&path, n, |index, friction| {
                    let exact = [0, 1].map(|j: usize| rows.by_bound[j][index] * pressure[index] * friction);
                    largest = largest.max(exact[0].abs());
                    for (found, exact) in [along[index], across[index]].into_iter().zip(exact) {
                        // Single precision.
                        assert!((f64::from(found) - exact).abs() < 1e-5, "{index}: {found} {exact}");
                    }
                });
                assert!(largest > 1e-2, "nothing follows: {largest}");
            }
        }
    }
}
