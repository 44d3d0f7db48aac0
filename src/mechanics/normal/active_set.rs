//! The active-set methods for the normal problem.

use super::active_inverse::{self, ActiveInverse};
use super::normal_problem::{Constraint, NormalProblem, NormalSolution};
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::settings::NormalSettings;

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
    /// C_AA⁻¹ of the active nodes that it was computed for last.
    inverse: ActiveInverse,
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
            inverse: ActiveInverse::new(nodes),
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

    /// Forgets the inverse: the compliance is another one from now on.
    pub fn forget(&mut self) {
        self.inverse.forget();
    }

    /// The active nodes of the last solve, ascending.
    pub fn active(&self) -> &[usize] {
        &self.active
    }

    /// C_AA⁻¹ of the last solve, m × m, and C_AA⁻¹ 1.
    pub fn inverse(&self) -> (&[f64], &[f64]) {
        (self.inverse.values(), self.inverse.unit())
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
            let inverse = if iterations > 1 {
                active_inverse::work(self.active.len())
            } else {
                0
            };
            self.count(pressure.len(), inverse);
            if self.inverse.nodes() != self.active {
                self.inverse.compute(problem.compliance, &self.active)?;
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
        if self.inverse.followed() > 0 {
            self.inverse.compute(problem.compliance, &self.active)?;
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
            let inverse = self.inverse.follow(problem.compliance, &self.active)?;
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
        let unit = self.inverse.unit();
        for (row, &i) in self.active.iter().enumerate() {
            self.gathered[row] = problem.profile[i];
        }
        dense::multiply(self.inverse.values(), m, &self.gathered, &mut self.particular);
        let penetration = match problem.constraint {
            Constraint::Penetration(penetration) => penetration,
            Constraint::Total(total) => {
                let sum = |values: &[f64]| values.iter().sum::<f64>();
                (total - sum(&self.particular[..m])) / sum(unit)
            }
        };
        self.target.fill(0.0);
        for (row, &i) in self.active.iter().enumerate() {
            self.target[i] = self.particular[row] + penetration * unit[row];
        }
        penetration
    }

    /// w = C p − b − δ.
    fn update_separation(&mut self, problem: &NormalProblem, pressure: &[f64], penetration: f64) {
        for (w, b) in self.separation.iter_mut().zip(problem.profile) {
            *w = -b - penetration;
        }
        dense::multiply_add(problem.compliance, pressure, 1.0, &mut self.separation);
    }
}
