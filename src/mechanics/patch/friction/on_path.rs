//! Friction that depends on slip in the law of the cells: the bound of a cell follows from its slip, and where friction remembers, from
//! that of the cells that its particles have come through.

use crate::friction::path::{NodeFriction, Passed, PathLaw, PathNode};
use crate::mechanics::patch::law::{Cell, CellLawRow, Scheme, Vector, dot, outer};

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
    /// Magnitude of the law's slip, `m/s`.
    pub(super) speed: Vec<f64>,
    /// Derivatives of the magnitude by the slip ahead and behind.
    by_slip: Vec<[Vector; 2]>,
    /// Derivative of the magnitude by the slip w below which the law takes all slip ahead.
    by_noise: Vec<f64>,
    /// Change of the magnitude.
    change: Vec<f64>,
    /// Cell before, of those that [`OnPath::row`] has gone through.
    before: Passed,
}

impl OnPath {
    pub(super) fn new(cells: usize) -> OnPath {
        OnPath {
            friction: vec![NodeFriction::default(); cells],
            speed: vec![0.0; cells],
            by_slip: vec![[[0.0; 2]; 2]; cells],
            by_noise: vec![0.0; cells],
            change: vec![0.0; cells],
            before: Passed::default(),
        }
    }

    /// Begins a round over the cells.
    pub(super) fn start(&mut self) {
        self.before = Passed::default();
    }

    /// Law of a cell, to be asked for in the order in which particles come to the cells of a run. The cell's bound follows from its slip;
    /// its dependence on the slip of the cells before is not in the row.
    #[inline(always)]
    pub(super) fn row(&mut self, path: &PathOfCells, scheme: &Scheme, index: usize, mut cell: Cell) -> CellLawRow {
        let slip_of_law = scheme.slip(&cell);
        let (slip, by_ahead, by_behind, slip_by_noise) = slip_of_law;
        let speed = dot(slip, slip).sqrt();
        // sᵀ/|s| times the slip's derivatives.
        let along = |matrix: [Vector; 2]| {
            [0, 1].map(|column: usize| {
                if speed > 0.0 {
                    (slip[0] * matrix[0][column] + slip[1] * matrix[1][column]) / speed
                } else {
                    0.0
                }
            })
        };
        let by_slip = [along(by_ahead), along(by_behind)];
        let by_noise = if speed > 0.0 {
            dot(slip, slip_by_noise) / speed
        } else {
            0.0
        };
        let pressure = path.pressure[index];
        let friction = path.law.friction(&path.nodes[index], &self.before, speed, pressure);
        self.before = friction.passed(speed);
        (self.friction[index], self.speed[index]) = (friction, speed);
        (self.by_slip[index], self.by_noise[index]) = (by_slip, by_noise);
        cell.bound = friction.coefficient * pressure;
        let mut row = scheme.row_at_slip(&cell, slip_of_law);
        let own = row.by_bound.map(|by_bound| by_bound * pressure * friction.by_speed());
        for (matrix, by_slip) in [&mut row.by_ahead, &mut row.by_behind].into_iter().zip(by_slip) {
            for (line, added) in matrix.iter_mut().zip(outer(own, by_slip)) {
                line[0] += added[0];
                line[1] += added[1];
            }
        }
        for (total, own) in row.by_noise.iter_mut().zip(own) {
            *total += own * by_noise;
        }
        row
    }

    /// Keeps the change of a cell's slip velocity with that of the slip ahead and behind.
    pub(super) fn keep_slip_change(&mut self, path: &PathOfCells, index: usize, ahead: Vector, behind: Vector) {
        if path.law.remembers() {
            let [by_ahead, by_behind] = self.by_slip[index];
            self.change[index] = dot(by_ahead, ahead) + dot(by_behind, behind);
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
        let [by_ahead, by_behind] = self.by_slip[index];
        self.change[index] = dot(by_ahead, ahead) + dot(by_behind, behind) + self.by_noise[index] * noise;
    }
}
