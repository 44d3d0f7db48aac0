//! The active-set methods for the normal problem.

use super::normal_problem::{Constraint, NormalProblem, NormalSolution};
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::settings::NormalSettings;
use nalgebra::DMatrix;
use std::cmp::Ordering;

/// Nodes that the inverse follows before it is computed anew: round-off grows with each.
const LARGEST_FOLLOWED: usize = 32;

/// Least pivot by which a row is divided, relative to what it is the difference of.
const LEAST_PIVOT: f64 = 1e-8;

/// Primal–dual active set (Hintermüller, Ito and Kunisch, SIAM J. Optim. 13, 2003) with the load as one more row.
///
/// It exchanges all violated nodes at once and nearly always ends in a few exchanges. On a general matrix it may cycle;
/// then the primal active-set method finishes, which moves one node at a time and cannot cycle, because the energy falls
/// with every move.
///
/// One solver serves one compliance matrix. The inverse on the active nodes is kept from one call to the next as long as
/// the active set stays, so that a solve that changes no node costs two products of a matrix with a vector. Where one node
/// moves at a time, the inverse follows it at the cost of some more.
#[derive(Debug, Clone)]
pub struct ActiveSet {
    settings: NormalSettings,
    active: Vec<usize>,
    /// The active nodes that `inverse` belongs to.
    inverted: Vec<usize>,
    /// C_AA⁻¹, m × m for m active nodes.
    inverse: Vec<f64>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// C_AA⁻¹ 1.
    unit: Vec<f64>,
    /// Column and row by which the inverse changes with one node, m.
    column: Vec<f64>,
    row: Vec<f64>,
    /// Nodes that the inverse has followed since it was computed.
    followed: usize,
    gathered: Vec<f64>,
    particular: Vec<f64>,
    separation: Vec<f64>,
    target: Vec<f64>,
    /// Multiplications and additions in this step.
    work: u64,
}

impl ActiveSet {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize, settings: NormalSettings) -> ActiveSet {
        ActiveSet {
            settings,
            active: Vec::with_capacity(nodes),
            inverted: Vec::with_capacity(nodes),
            inverse: vec![0.0; nodes * nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            unit: vec![0.0; nodes],
            column: vec![0.0; nodes],
            row: vec![0.0; nodes],
            followed: 0,
            gathered: vec![0.0; nodes],
            particular: vec![0.0; nodes],
            separation: vec![0.0; nodes],
            target: vec![0.0; nodes],
            work: 0,
        }
    }

    /// Begins a step.
    pub fn start_step(&mut self) {
        self.work = 0;
    }

    /// Multiplications and additions in this step, about. An inverse of the first set of a solve is not counted: whether it is kept depends
    /// on the steps before.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Adds an exchange among `nodes` nodes to the work, with `inverse` multiplications and additions for the inverse.
    fn count(&mut self, nodes: usize, inverse: usize) {
        let m = self.active.len();
        self.work += (m * m + m * nodes + inverse) as u64;
    }

    /// Multiplications and additions of an inverse on the active nodes.
    fn inversion(&self) -> usize {
        4 * self.active.len().pow(3) / 3
    }

    /// Forgets the inverse: the compliance is another one from now on.
    pub fn forget(&mut self) {
        self.inverted.clear();
    }

    /// The active nodes of the last solve, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// C_AA⁻¹ of the last solve, m × m, and C_AA⁻¹ 1.
    pub fn inverse(&self) -> (&[f64], &[f64]) {
        let m = self.active.len();
        (&self.inverse[..m * m], &self.unit[..m])
    }

    /// Solves from the active set of `pressure` (its positive entries; all nodes where there is none).
    ///
    /// # Errors
    /// [`Error::NormalNotConverged`].
    pub fn solve(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        self.active.clear();
        self.active.extend(problem.candidates().filter(|&i| pressure[i] > 0.0));
        if self.active.is_empty() {
            self.active.extend(problem.candidates());
        }
        for iterations in 1..=self.settings.exchanges {
            let inverse = if iterations > 1 { self.inversion() } else { 0 };
            self.count(pressure.len(), inverse);
            if self.inverted != self.active {
                self.invert(problem.compliance)?;
            }
            let penetration = self.close_active_nodes(problem);
            pressure.copy_from_slice(&self.target);
            self.update_separation(problem, pressure, penetration);
            let Some(worst) = self.worst_violation(problem, pressure) else {
                return Ok(NormalSolution {
                    penetration,
                    iterations,
                });
            };
            if iterations <= self.settings.set_exchanges {
                self.active.clear();
                self.active.extend(problem.candidates().filter(|&i| match pressure[i] {
                    0.0 => self.separation[i] < -self.settings.round_off,
                    p => p > 0.0,
                }));
            } else {
                match self.active.binary_search(&worst) {
                    Ok(place) => _ = self.active.remove(place),
                    Err(place) => self.active.insert(place, worst),
                }
            }
        }
        self.descend(problem, pressure)
    }

    /// The node whose condition is violated most, by negative pressure or negative separation (both scaled).
    fn worst_violation(&self, problem: &NormalProblem, pressure: &[f64]) -> Option<usize> {
        let violation = |i: usize| match pressure[i] {
            0.0 if self.separation[i] < -self.settings.round_off => -self.separation[i],
            p => -p,
        };
        problem
            .candidates()
            .filter(|&i| violation(i) > 0.0)
            .max_by(|&a, &b| violation(a).total_cmp(&violation(b)))
    }

    /// Primal active-set method: stays feasible, adds or drops one node at a time, decreases the energy (37).
    pub(super) fn descend(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        let solution = self.descend_by_nodes(problem, pressure);
        // Another solve gets the inverse of its nodes whatever way this one came to them.
        if self.followed > 0 {
            self.invert(problem.compliance)?;
        }
        solution
    }

    fn descend_by_nodes(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        let n = pressure.len();
        let start = match problem.constraint {
            Constraint::Total(total) => total / problem.candidates().len() as f64,
            Constraint::Penetration(_) => 0.0,
        };
        pressure.fill(0.0);
        pressure[problem.candidates()].fill(start);
        self.active.clear();
        self.active.extend(problem.candidates().filter(|_| start > 0.0));
        let first = self.settings.exchanges + 1;
        let limit = self.settings.exchanges + self.settings.descents_per_node * n;
        for iterations in first..=limit {
            let inverse = self.follow(problem.compliance)?;
            self.count(n, inverse);
            let penetration = self.close_active_nodes(problem);
            let blocking = (0..n)
                .filter(|&i| self.target[i] < 0.0)
                .map(|i| (pressure[i] / (pressure[i] - self.target[i]), i))
                .min_by(|a, b| a.0.total_cmp(&b.0));
            if let Some((step, node)) = blocking {
                for (p, t) in pressure.iter_mut().zip(&self.target) {
                    *p += step * (t - *p);
                }
                pressure[node] = 0.0;
                self.active.retain(|&i| i != node);
                continue;
            }
            pressure.copy_from_slice(&self.target);
            self.update_separation(problem, pressure, penetration);
            let worst = problem
                .candidates()
                .filter(|i| self.active.binary_search(i).is_err())
                .min_by(|&a, &b| self.separation[a].total_cmp(&self.separation[b]));
            match worst {
                Some(node) if self.separation[node] < -self.settings.round_off => {
                    let place = self.active.partition_point(|&active| active < node);
                    self.active.insert(place, node);
                }
                _ => {
                    return Ok(NormalSolution {
                        penetration,
                        iterations,
                    });
                }
            }
        }
        Err(Error::NormalNotConverged {
            solver: "active set",
            iterations: limit,
            residual: self.separation.iter().fold(0.0, |m, w| m.max(-w)),
            tolerance: self.settings.round_off,
        })
    }

    /// Closes the gap on the active nodes, zero pressure elsewhere: `self.target`. Returns δ.
    fn close_active_nodes(&mut self, problem: &NormalProblem) -> f64 {
        let m = self.active.len();
        for (row, &i) in self.active.iter().enumerate() {
            self.gathered[row] = problem.profile[i];
        }
        dense::multiply(&self.inverse, m, &self.gathered, &mut self.particular);
        let penetration = match problem.constraint {
            Constraint::Penetration(penetration) => penetration,
            Constraint::Total(total) => {
                let sum = |values: &[f64]| values.iter().sum::<f64>();
                (total - sum(&self.particular[..m])) / sum(&self.unit[..m])
            }
        };
        self.target.fill(0.0);
        for (row, &i) in self.active.iter().enumerate() {
            self.target[i] = self.particular[row] + penetration * self.unit[row];
        }
        penetration
    }

    /// Makes the inverse that of the active nodes: from that before one of them came or went, or anew. Returns the multiplications and
    /// additions that it took.
    fn follow(&mut self, compliance: &DMatrix<f64>) -> Result<usize> {
        let (m, before) = (self.active.len(), self.inverted.len());
        let differs = self.active.iter().zip(&self.inverted).position(|(a, b)| a != b);
        let place = differs.unwrap_or(m.min(before));
        let follows = self.followed < LARGEST_FOLLOWED
            && if m == before + 1 {
                self.active[place + 1..] == self.inverted[place..] && self.insert(compliance, place)
            } else if before == m + 1 {
                self.active[place..] == self.inverted[place + 1..] && self.remove(place)
            } else {
                m == before && differs.is_none()
            };
        if follows {
            return Ok(4 * m * m);
        }
        self.invert(compliance)?;
        Ok(self.inversion())
    }

    /// Takes a node into the inverse, by the Schur complement of its row. False where that is too small to divide by.
    fn insert(&mut self, compliance: &DMatrix<f64>, place: usize) -> bool {
        let (node, k) = (self.active[place], self.inverted.len());
        for (gathered, &i) in self.gathered.iter_mut().zip(&self.inverted) {
            *gathered = compliance[(i, node)];
        }
        // C_AA⁻¹ times the column, and the row times C_AA⁻¹.
        dense::multiply(&self.inverse, k, &self.gathered, &mut self.column);
        let (mut complement, mut size) = (compliance[(node, node)], compliance[(node, node)].abs());
        for (column, &i) in self.column[..k].iter().zip(&self.inverted) {
            complement -= compliance[(node, i)] * column;
            size += (compliance[(node, i)] * column).abs();
        }
        for (gathered, &i) in self.gathered.iter_mut().zip(&self.inverted) {
            *gathered = compliance[(node, i)];
        }
        for (row, column) in self.row.iter_mut().zip(self.inverse[..k * k].chunks_exact(k.max(1))) {
            *row = dense::dot(&self.gathered[..k], column);
        }
        if complement.abs() <= LEAST_PIVOT * size {
            return false;
        }
        // From the last column on, so that nothing is overwritten that is still needed.
        for new in (0..=k).rev() {
            let old = match new.cmp(&place) {
                Ordering::Less => Some(new),
                Ordering::Equal => None,
                Ordering::Greater => Some(new - 1),
            };
            let by_row = old.map_or(-1.0, |old| self.row[old]) / complement;
            for new_row in (0..=k).rev() {
                let old_row = match new_row.cmp(&place) {
                    Ordering::Less => Some(new_row),
                    Ordering::Equal => None,
                    Ordering::Greater => Some(new_row - 1),
                };
                let kept = match (old, old_row) {
                    (Some(old), Some(old_row)) => self.inverse[old * k + old_row],
                    _ => 0.0,
                };
                let by_column = old_row.map_or(-1.0, |old_row| self.column[old_row]);
                self.inverse[new * (k + 1) + new_row] = kept + by_column * by_row;
            }
        }
        self.end_following(place, Some(node));
        true
    }

    /// Takes a node out of the inverse. False where its pivot is too small to divide by.
    fn remove(&mut self, place: usize) -> bool {
        let k = self.inverted.len();
        let pivot = self.inverse[place * k + place];
        let own = &self.inverse[place * k..][..k];
        if pivot.abs() <= LEAST_PIVOT * dense::largest(own) {
            return false;
        }
        self.column[..k].copy_from_slice(own);
        for (row, column) in self.row.iter_mut().zip(self.inverse[..k * k].chunks_exact(k)) {
            *row = column[place];
        }
        let others = || (0..k).filter(move |&other| other != place);
        for (new, old) in others().enumerate() {
            for (new_row, old_row) in others().enumerate() {
                self.inverse[new * (k - 1) + new_row] =
                    self.inverse[old * k + old_row] - self.column[old_row] * self.row[old] / pivot;
            }
        }
        self.end_following(place, None);
        true
    }

    /// Brings what depends on the inverse up to date after a node has come to its place, or gone from it.
    fn end_following(&mut self, place: usize, node: Option<usize>) {
        match node {
            Some(node) => self.inverted.insert(place, node),
            None => _ = self.inverted.remove(place),
        }
        self.followed += 1;
        let m = self.inverted.len();
        self.gathered[..m].fill(1.0);
        dense::multiply(&self.inverse, m, &self.gathered, &mut self.unit);
    }

    /// C_AA⁻¹ and C_AA⁻¹ 1.
    ///
    /// The inverse itself, not only its factors: it is applied several times for each change of the active set, and in a
    /// product no row waits for another as in a triangular solve. With a condition number of about n no accuracy is lost. By LU, because the wear of the step makes the matrix unsymmetric.
    fn invert(&mut self, compliance: &DMatrix<f64>) -> Result<()> {
        let m = self.active.len();
        self.inverted.clear();
        self.followed = 0;
        for (column, &j) in self.active.iter().enumerate() {
            for (row, &i) in self.active.iter().enumerate() {
                self.factor[column * m + row] = compliance[(i, j)];
            }
        }
        if !dense::lu(&mut self.factor[..m * m], m, &mut self.pivots) {
            return Err(Error::SingularContactMatrix {
                matrix: "normal compliance",
                unknowns: m,
            });
        }
        for (column, unit) in self.inverse[..m * m].chunks_exact_mut(m.max(1)).enumerate() {
            unit.fill(0.0);
            unit[column] = 1.0;
            dense::lu_solve(&self.factor, m, &self.pivots, unit);
        }
        self.unit[..m].fill(1.0);
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.unit[..m]);
        self.inverted.extend_from_slice(&self.active);
        Ok(())
    }

    /// w = C p − b − δ.
    fn update_separation(&mut self, problem: &NormalProblem, pressure: &[f64], penetration: f64) {
        for (w, b) in self.separation.iter_mut().zip(problem.profile) {
            *w = -b - penetration;
        }
        dense::multiply_add(problem.compliance, pressure, 1.0, &mut self.separation);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Nodes that come and go one at a time leave the inverse of those that are there, also of a matrix that is not symmetric.
        #[test]
        fn the_inverse_follows_its_nodes(
            entries in prop::collection::vec(-1.0..1.0, 144),
            moves in prop::collection::vec(0..12_usize, 40),
        ) {
            const NODES: usize = 12;
            let compliance: DMatrix<f64> = DMatrix::from_vec(NODES, NODES, entries) + DMatrix::identity(NODES, NODES) * 12.0;
            let mut solver = ActiveSet::new(NODES, NormalSettings::default());
            let mut followed = 0;
            for node in moves {
                match solver.active.binary_search(&node) {
                    Ok(place) => _ = solver.active.remove(place),
                    Err(place) => solver.active.insert(place, node),
                }
                solver.follow(&compliance).unwrap();
                followed = solver.followed.max(followed);
                let (inverse, unit) = solver.inverse();
                let (m, nodes) = (unit.len(), solver.active());
                for (row, &i) in nodes.iter().enumerate() {
                    for column in 0..m {
                        let sum: f64 = (0..m).map(|k| compliance[(i, nodes[k])] * inverse[column * m + k]).sum();
                        let unity = if row == column { 1.0 } else { 0.0 };
                        // Condition numbers below 10, and round-off of 32 changes.
                        prop_assert!((sum - unity).abs() < 1e-12, "{row} {column}: {sum}");
                    }
                    let sum: f64 = (0..m).map(|k| inverse[k * m + row]).sum();
                    prop_assert!((sum - unit[row]).abs() < 1e-12);
                }
            }
            prop_assert_eq!(followed, LARGEST_FOLLOWED);
        }
    }
}
