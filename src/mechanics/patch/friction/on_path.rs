//! Friction that depends on slip in the law of the cells: the bound of a cell follows from its slip, and where friction remembers, from
//! that of the cells that its particles have come through.

use crate::body::grid::Grid;
use crate::friction::path::{Link, NodeFriction, Passed, PathLaw, PathNode};
use crate::mechanics::patch::contact::Contact;
use crate::mechanics::patch::law::{Scheme, Vector, dot};
use crate::mechanics::patch::law_arrays::{CellArrays, Components, LawArrays, SpeedArrays};
use crate::mechanics::patch::linear_law::{Change, LinearSpeed};
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
    /// Magnitude linearised in single precision, for corrections; its change with values for a vector register beyond the cells; what links a cell to the
    /// one before, and the derivatives of the law's residual by μ.
    linear: LinearSpeed,
    change_single: Vec<f32>,
    links: Vec<Link<f32>>,
    by_friction: [Vec<f32>; 2],
}

impl OnPath {
    pub(super) fn new(cells: usize) -> OnPath {
        OnPath {
            friction: vec![NodeFriction::default(); cells],
            speeds: SpeedArrays::new(cells),
            change: vec![0.0; cells],
            linear: LinearSpeed::new(cells),
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

    /// Takes for corrections how so many cells follow those before them.
    pub(super) fn take_links(&mut self, path: &PathOfCells, rows: &LawArrays, edge: &Components, count: usize) {
        if !path.law.remembers() {
            return;
        }
        self.linear.take(&self.speeds, edge, count);
        for (link, friction) in self.links[..count].iter_mut().zip(&self.friction) {
            *link = friction.link().single();
        }
        for (out, by_bound) in self.by_friction.iter_mut().zip(&rows.by_bound) {
            for ((out, by_bound), pressure) in out[..count].iter_mut().zip(by_bound).zip(path.pressure) {
                *out = (by_bound * pressure) as f32;
            }
        }
    }

    /// Adds to the change of the residual of so many cells, along x and y, what they take over from the cells before.
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
