//! The normal contact problem (37): a strictly convex quadratic programme with bounds.
//!
//! Find p ≥ 0 with separation w = C p − b − δ ≥ 0 and p·w = 0, where C is the normal compliance and b the profile of
//! the wheel, raised by thermal bulge and friction, lowered by wear. Either δ is given, or Σp is and δ is its Lagrange
//! multiplier. Everything is scaled (see [`crate::compliance::Scales`]).

use crate::dense;
use crate::error::{Error, Result};
use nalgebra::DMatrix;

/// What closes the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Constraint {
    /// Σp, positive.
    Total(f64),
    /// δ.
    Penetration(f64),
}

/// The data of one problem with n nodes.
#[derive(Debug, Clone, Copy)]
pub struct NormalProblem<'a> {
    /// C, n × n, symmetric positive definite.
    pub compliance: &'a DMatrix<f64>,
    /// b, n.
    pub profile: &'a [f64],
    /// Load or penetration.
    pub constraint: Constraint,
}

/// What a solver found besides the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalSolution {
    /// δ.
    pub penetration: f64,
    /// Iterations done.
    pub iterations: usize,
}

/// Separations above −1e-13 count as closed: round-off of w, whose terms are of order 1.
const ROUND_OFF: f64 = 1e-13;
/// Exchanges of all violated nodes at once; two ends of a contact that wait for each other can cycle, and from then on
/// only the worst node is exchanged.
const SET_EXCHANGES: usize = 4;
/// Exchanges altogether before the method that descends takes over.
const EXCHANGES: usize = 40;

/// Primal–dual active set (Hintermüller, Ito and Kunisch, SIAM J. Optim. 13, 2003) with the load as one more row.
///
/// It exchanges all violated nodes at once and nearly always ends in a few exchanges, but may cycle on a general
/// matrix; then the primal active-set method, which moves a node at a time and descends, finishes.
///
/// One solver serves one compliance matrix: the inverse on the active nodes is kept from one call to the next as long
/// as the active set stays, which makes a warm solve two matrix–vector products.
#[derive(Debug, Clone)]
pub struct ActiveSet {
    active: Vec<usize>,
    /// The active nodes that `inverse` belongs to.
    inverted: Vec<usize>,
    /// C_AA⁻¹, m × m for m active nodes.
    inverse: Vec<f64>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// C_AA⁻¹ 1.
    unit: Vec<f64>,
    gathered: Vec<f64>,
    particular: Vec<f64>,
    separation: Vec<f64>,
    target: Vec<f64>,
}

impl ActiveSet {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize) -> ActiveSet {
        ActiveSet {
            active: Vec::with_capacity(nodes),
            inverted: Vec::with_capacity(nodes),
            inverse: vec![0.0; nodes * nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            unit: vec![0.0; nodes],
            gathered: vec![0.0; nodes],
            particular: vec![0.0; nodes],
            separation: vec![0.0; nodes],
            target: vec![0.0; nodes],
        }
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
        self.active.extend((0..pressure.len()).filter(|&i| pressure[i] > 0.0));
        if self.active.is_empty() {
            self.active.extend(0..pressure.len());
        }
        for iterations in 1..=EXCHANGES {
            let penetration = self.close_active_nodes(problem)?;
            pressure.copy_from_slice(&self.target);
            self.update_separation(problem, pressure, penetration);
            let Some(worst) = self.worst_violation(pressure) else {
                return Ok(NormalSolution {
                    penetration,
                    iterations,
                });
            };
            if iterations <= SET_EXCHANGES {
                self.active.clear();
                self.active.extend((0..pressure.len()).filter(|&i| match pressure[i] {
                    0.0 => self.separation[i] < -ROUND_OFF,
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
    fn worst_violation(&self, pressure: &[f64]) -> Option<usize> {
        let violation = |i: usize| match pressure[i] {
            0.0 if self.separation[i] < -ROUND_OFF => -self.separation[i],
            p => -p,
        };
        (0..pressure.len())
            .filter(|&i| violation(i) > 0.0)
            .max_by(|&a, &b| violation(a).total_cmp(&violation(b)))
    }

    /// Primal active-set method: stays feasible, adds or drops one node at a time, decreases the energy (37).
    fn descend(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        let n = pressure.len();
        let start = match problem.constraint {
            Constraint::Total(total) => total / n as f64,
            Constraint::Penetration(_) => 0.0,
        };
        pressure.fill(start);
        self.active.clear();
        self.active.extend((0..n).filter(|_| start > 0.0));
        let limit = EXCHANGES + 20 * n;
        for iterations in EXCHANGES + 1..=limit {
            let penetration = self.close_active_nodes(problem)?;
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
            let worst = (0..n)
                .filter(|i| !self.active.contains(i))
                .min_by(|&a, &b| self.separation[a].total_cmp(&self.separation[b]));
            match worst {
                Some(node) if self.separation[node] < -ROUND_OFF => {
                    self.active.push(node);
                    self.active.sort_unstable();
                }
                _ => {
                    return Ok(NormalSolution {
                        penetration,
                        iterations,
                    })
                }
            }
        }
        Err(Error::NormalNotConverged {
            solver: "active set",
            iterations: limit,
            residual: self.separation.iter().fold(0.0, |m, w| m.max(-w)),
            tolerance: ROUND_OFF,
        })
    }

    /// Closes the gap on the active nodes, zero pressure elsewhere: `self.target`. Returns δ.
    fn close_active_nodes(&mut self, problem: &NormalProblem) -> Result<f64> {
        if self.inverted != self.active {
            self.invert(problem.compliance)?;
        }
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
        Ok(penetration)
    }

    /// C_AA⁻¹ and C_AA⁻¹ 1. An inverse, because a contact compliance has a condition number of about n, and a product has
    /// none of the latency of two triangular solves. By LU: wear makes the matrix unsymmetric.
    fn invert(&mut self, compliance: &DMatrix<f64>) -> Result<()> {
        let m = self.active.len();
        self.inverted.clear();
        for (column, &j) in self.active.iter().enumerate() {
            for (row, &i) in self.active.iter().enumerate() {
                self.factor[column * m + row] = compliance[(i, j)];
            }
        }
        if !dense::lu(&mut self.factor[..m * m], m, &mut self.pivots) {
            return Err(Error::StiffnessNotPositiveDefinite { unknowns: m });
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

/// Pschenichnyj's linearisation method (section 4.1 of the paper; Pschenichnyj, Optimization 18, 1987).
///
/// Each step solves min ∇f·d + ½σ‖d‖² over the linearised constraints, here bounds and load, that is, projects
/// p − ∇f/σ, and moves along d as far as f falls. The penalty function of the paper is f itself, because every iterate
/// is feasible. σ is the curvature along the last step (Barzilai and Borwein), where the paper takes 1: with
/// σ = 1 in any units the method needs as many steps as the condition number of C, a few hundred times more.
#[derive(Debug, Clone)]
pub struct Pschenichnyj {
    gradient: Vec<f64>,
    direction: Vec<f64>,
    image: Vec<f64>,
    sorted: Vec<f64>,
}

/// Limit of the iterations of [`Pschenichnyj`].
const LINEARISATIONS: usize = 200_000;
/// Step ‖d‖_∞ of the linearisation method at which it stops, relative to the largest pressure.
const LINEARISATION_TOLERANCE: f64 = 1e-12;

impl Pschenichnyj {
    /// Scratch for problems with `nodes` nodes.
    pub fn new(nodes: usize) -> Pschenichnyj {
        Pschenichnyj {
            gradient: vec![0.0; nodes],
            direction: vec![0.0; nodes],
            image: vec![0.0; nodes],
            sorted: Vec::with_capacity(nodes),
        }
    }

    /// Solves from `pressure`, made feasible first.
    ///
    /// # Errors
    /// [`Error::NormalNotConverged`].
    pub fn solve(&mut self, problem: &NormalProblem, pressure: &mut [f64]) -> Result<NormalSolution> {
        let offset = match problem.constraint {
            Constraint::Penetration(penetration) => penetration,
            Constraint::Total(_) => 0.0,
        };
        self.project(problem.constraint, pressure);
        let mut curvature = (0..pressure.len()).map(|i| problem.compliance[(i, i)]).sum::<f64>();
        let mut residual = f64::INFINITY;
        for iterations in 1..=LINEARISATIONS {
            // ∇f = C p − b − δ (Step 2 of the paper's algorithm); anew each time, so that round-off does not pile up.
            for (g, b) in self.gradient.iter_mut().zip(problem.profile) {
                *g = -b - offset;
            }
            dense::multiply_add(problem.compliance, pressure, 1.0, &mut self.gradient);
            for ((d, p), g) in self.direction.iter_mut().zip(pressure.iter()).zip(&self.gradient) {
                *d = p - g / curvature;
            }
            let mut direction = std::mem::take(&mut self.direction);
            let multiplier = self.project(problem.constraint, &mut direction) * curvature;
            for (d, p) in direction.iter_mut().zip(pressure.iter()) {
                *d -= p;
            }
            self.direction = direction;

            let largest = pressure.iter().fold(f64::MIN_POSITIVE, |m, p| p.max(m));
            residual = self.direction.iter().fold(0.0, |m: f64, d| d.abs().max(m)) / largest;
            self.image.fill(0.0);
            dense::multiply_add(problem.compliance, &self.direction, 1.0, &mut self.image);
            // Along Σd = 0 the multiplier does not change the slope, but without it round-off of Σd would.
            for g in &mut self.gradient {
                *g -= multiplier;
            }
            let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
            let slope = dot(&self.gradient, &self.direction);
            let bend = dot(&self.image, &self.direction);
            if residual <= LINEARISATION_TOLERANCE || slope >= 0.0 {
                // The projected point: its zeros are exact, where shortened steps leave a trace of pressure.
                for (p, d) in pressure.iter_mut().zip(&self.direction) {
                    *p = (*p + d).max(0.0);
                }
                let penetration = match problem.constraint {
                    Constraint::Penetration(penetration) => penetration,
                    Constraint::Total(_) => multiplier,
                };
                return Ok(NormalSolution {
                    penetration,
                    iterations,
                });
            }
            // Step 3: f is quadratic, the largest decrease along d is known.
            let step = (-slope / bend).min(1.0);
            for (p, d) in pressure.iter_mut().zip(&self.direction) {
                *p = (*p + step * d).max(0.0);
            }
            curvature = bend / dot(&self.direction, &self.direction);
        }
        Err(Error::NormalNotConverged {
            solver: "Pschenichnyj",
            iterations: LINEARISATIONS,
            residual,
            tolerance: LINEARISATION_TOLERANCE,
        })
    }

    /// Projects onto p ≥ 0, and onto Σp where that is given. Returns the shift λ of the projection max(v + λ, 0).
    fn project(&mut self, constraint: Constraint, values: &mut [f64]) -> f64 {
        let mut shift = 0.0;
        if let Constraint::Total(total) = constraint {
            self.sorted.clear();
            self.sorted.extend_from_slice(values);
            self.sorted.sort_unstable_by(|a, b| b.total_cmp(a));
            let mut sum = 0.0;
            for (count, value) in self.sorted.iter().enumerate() {
                sum += value;
                let candidate = (total - sum) / (count + 1) as f64;
                if value + candidate > 0.0 {
                    shift = candidate;
                }
            }
        }
        for value in values {
            *value = (*value + shift).max(0.0);
        }
        shift
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn both(problem: &NormalProblem) -> [(Vec<f64>, NormalSolution); 2] {
        let n = problem.profile.len();
        let mut active = vec![0.0; n];
        let first = ActiveSet::new(n).solve(problem, &mut active).unwrap();
        let mut linearised = vec![0.0; n];
        let second = Pschenichnyj::new(n).solve(problem, &mut linearised).unwrap();
        [(active, first), (linearised, second)]
    }

    fn check(problem: &NormalProblem) {
        let [(p, first), (q, second)] = both(problem);
        let largest = p.iter().fold(1.0_f64, |m, v| v.max(m));
        for (p, q) in p.iter().zip(&q) {
            assert!((p - q).abs() <= 1e-8 * largest, "{p} {q} {first:?} {second:?}");
            assert!(*p >= 0.0);
        }
        assert!(
            (first.penetration - second.penetration).abs() <= 1e-8 * first.penetration.abs().max(1.0),
            "{first:?} {second:?}"
        );
        if let Constraint::Total(total) = problem.constraint {
            assert!((p.iter().sum::<f64>() - total).abs() <= 1e-11 * total);
        }
    }

    proptest! {
        // Random positive definite matrices with a condition number up to some hundreds.
        #[test]
        fn both_methods_agree(
            entries in prop::collection::vec(-1.0..1.0, 225),
            profile in prop::collection::vec(-1.0..1.0, 15),
            value in 0.01..3.0,
            load in any::<bool>(),
        ) {
            let a: DMatrix<f64> = DMatrix::from_vec(15, 15, entries);
            let compliance: DMatrix<f64> = &a * a.transpose() * 0.3 + DMatrix::identity(15, 15) * 0.1;
            let constraint = if load { Constraint::Total(value) } else { Constraint::Penetration(value - 1.5) };
            check(&NormalProblem { compliance: &compliance, profile: &profile, constraint });
        }

        #[test]
        fn the_method_that_moves_one_node_at_a_time_gives_the_same(
            entries in prop::collection::vec(-1.0..1.0, 100),
            profile in prop::collection::vec(-1.0..1.0, 10),
            load in any::<bool>(),
        ) {
            let a: DMatrix<f64> = DMatrix::from_vec(10, 10, entries);
            let compliance: DMatrix<f64> = &a * a.transpose() + DMatrix::identity(10, 10) * 0.1;
            let constraint = if load { Constraint::Total(1.0) } else { Constraint::Penetration(0.1) };
            let problem = NormalProblem { compliance: &compliance, profile: &profile, constraint };
            let mut solver = ActiveSet::new(10);
            let (mut p, mut q) = (vec![0.0; 10], vec![0.0; 10]);
            let first = solver.solve(&problem, &mut p).unwrap();
            let second = solver.descend(&problem, &mut q).unwrap();
            prop_assert!((first.penetration - second.penetration).abs() < 1e-10);
            for (p, q) in p.iter().zip(&q) {
                prop_assert!((p - q).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn a_separated_wheel_has_no_pressure() {
        let compliance = DMatrix::identity(4, 4);
        let problem = NormalProblem {
            compliance: &compliance,
            profile: &[-0.3, -0.1, 0.0, -0.2],
            constraint: Constraint::Penetration(-0.5),
        };
        for (pressure, _) in both(&problem) {
            assert_eq!(pressure, vec![0.0; 4]);
        }
    }
}
