//! The friction law where Newton's method by itself cycles: with a line search, and along a path of regularisations.
//!
//! Friction that depends on slip, a memory of it and a layer that yields give the law more corners than stick and slip, and Newton's method may
//! jump from one side of them to the other. Written as one equation at each node, with its own compliance 1/r,
//!
//! τ − Π(τ − r s) = 0,
//!
//! the law has a residual that falls along Newton's step. Π holds a shear within the bound of the node (Alart and Curnier 1991); for the
//! regularised law it is the shear t that together with the slip against it is z = τ − r s: t + r σ = |z|, t = μ p (2/π) arctan(σ/ε). That is as
//! well conditioned for a small ε as for a large one, and Coulomb's law for ε → 0.
//!
//! First from the present shear. Where the line search ends at a corner, from no shear at all with an ε as large as the slip, where the law is
//! nearly linear, and in decades down to the one that is asked for.

use super::{Ended, LawRow, Tangential, TangentialProblem};
use crate::friction::coulomb::Resisted;
use crate::numerics::dense::{self, largest};

impl Tangential {
    /// Solves the law after `spent` steps of a method that has stalled.
    pub(super) fn solve_globalised(&mut self, problem: &TangentialProblem, shear: &[f64], spent: usize) -> Ended {
        let m = shear.len();
        // At rest before any time has passed the slip does not depend on the shear, and the residual above is not defined.
        if (0..m).any(|node| self.own_slip(problem, node) <= 0.0) {
            return Ended::Stalled(spent);
        }
        let largest_pressure = largest(problem.pressure);
        let tolerance = problem.tolerance * largest_pressure;
        self.change[..m].fill(0.0);
        let rough = self.settings.continuation_tolerance * largest_pressure;
        // Least ε for which the law was solved.
        let mut regularised = None;
        let mut end = self.search(problem, problem.regularisation, shear, tolerance);
        let mut steps = spent + end.steps();
        if let Ended::Stalled(_) = end {
            for (change, shear) in self.change.iter_mut().zip(shear) {
                *change = -shear;
            }
            self.update_point(problem, shear);
            let mut regularisation = largest(&self.slip[..m]);
            let least = (self.settings.least_regularisation * regularisation).max(problem.regularisation);
            let sought = |solved: Option<f64>| problem.accepts_regularised && solved.is_none();
            while regularisation > least && (self.work <= self.settings.work || sought(regularised)) {
                // A law that is solved to a few digits only, or not quite, still leads closer.
                let part = self.search(problem, regularisation, shear, rough);
                steps += part.steps();
                if let Ended::Converged(_) = part {
                    self.regularised[..m].copy_from_slice(&self.change[..m]);
                    regularised = Some(regularisation);
                }
                regularisation *= self.settings.continuation_ratio;
            }
            end = self.search(problem, problem.regularisation, shear, tolerance);
            steps += end.steps();
        }
        // A sub-step in which all that has cost too much is tried again at a shorter length.
        if matches!(end, Ended::Stalled(_)) && self.work <= self.settings.work {
            steps += self.follow_regularisation(problem, shear);
            end = self.search(problem, problem.regularisation, shear, tolerance);
            steps += end.steps();
        }
        self.forget();
        match (end, regularised) {
            (Ended::Converged(_), _) => self.close_globalised(problem, shear),
            (Ended::Stalled(_), Some(regularisation)) if problem.accepts_regularised => {
                self.change[..m].copy_from_slice(&self.regularised[..m]);
                // What this solution leaves of the law itself.
                self.update_natural_residual(problem, problem.regularisation, shear);
                self.left = largest(&self.residual[..m]);
                let problem = TangentialProblem {
                    regularisation,
                    ..*problem
                };
                // Pressure, slip and μ at that point, which is a solution.
                steps += self.search(&problem, regularisation, shear, rough).steps();
                self.close_globalised(&problem, shear);
            }
            (Ended::Stalled(_), _) => return Ended::Stalled(steps),
        }
        Ended::Converged(steps)
    }

    /// Newton's method with a line search at one ε, from the present change of the shear.
    fn search(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64], tolerance: f64) -> Ended {
        let m = shear.len();
        let settings = self.settings;
        let mut norm = self.update_natural_residual(problem, regularisation, shear);
        for steps in 1..=settings.newton_steps {
            if largest(&self.residual[..m]) <= tolerance {
                return Ended::Converged(steps);
            }
            if !self.factorise(problem) {
                return Ended::Stalled(steps);
            }
            self.find_step(m);
            let length = largest(&self.step[..m]);
            if !length.is_finite() {
                return Ended::Stalled(steps);
            }
            self.before[..m].copy_from_slice(&self.change[..m]);
            let mut damping = 1.0;
            for halving in 0..=settings.halvings {
                for ((change, before), step) in self.change.iter_mut().zip(&self.before).zip(&self.step[..m]) {
                    *change = before + damping * step;
                }
                let trial = self.update_natural_residual(problem, regularisation, shear);
                // A step as short as round-off cannot be expected to lower the residual.
                if length <= tolerance {
                    return Ended::Converged(steps);
                }
                if trial <= (1.0 - settings.least_decrease * damping) * norm {
                    norm = trial;
                    break;
                }
                if halving == settings.halvings {
                    return Ended::Stalled(steps);
                }
                damping *= 0.5;
            }
        }
        Ended::Stalled(settings.newton_steps)
    }

    /// Follows the solution from an ε as large as the slip, where there is one only, to the ε that is asked for, by the length of its arc in the
    /// shear and in ln ε: where friction falls with slip it may turn back and come again. Returns the steps that it took.
    fn follow_regularisation(&mut self, problem: &TangentialProblem, shear: &[f64]) -> usize {
        let m = shear.len();
        let settings = self.settings;
        let largest_pressure = largest(problem.pressure);
        for (change, shear) in self.change.iter_mut().zip(shear) {
            *change = -shear;
        }
        self.update_point(problem, shear);
        let first = largest(&self.slip[..m]);
        let last = (settings.least_regularisation * first).max(problem.regularisation).ln();
        let rough = settings.continuation_tolerance * largest_pressure;
        let mut steps = self.search(problem, first, shear, rough).steps();
        // A unit of the shear is the largest pressure, one of ln ε a decade.
        let units = [largest_pressure, std::f64::consts::LN_10];
        let (mut logarithm, mut arc) = (first.ln(), settings.first_arc);
        self.tangent[..m].fill(0.0);
        let mut tangent_by_logarithm = -1.0;
        for _ in 0..settings.arcs {
            if self.work > settings.work {
                break;
            }
            // Back where it began: it has lost the path.
            if logarithm <= last || logarithm > first.ln() || arc < settings.least_arc {
                break;
            }
            // The tangent that leads on.
            self.update_natural_residual(problem, logarithm.exp(), shear);
            if !self.factorise(problem) {
                break;
            }
            steps += 1;
            self.solve_for_logarithm(problem, logarithm.exp(), shear);
            let (mut along, mut square) = (tangent_by_logarithm, 1.0);
            for (new, old) in self.by_logarithm[..m].iter_mut().zip(&self.tangent) {
                *new *= units[1] / units[0];
                along += *new * old;
                square += *new * *new;
            }
            tangent_by_logarithm = f64::copysign(1.0 / square.sqrt(), along);
            for (tangent, new) in self.tangent.iter_mut().zip(&self.by_logarithm[..m]) {
                *tangent = tangent_by_logarithm * new;
            }
            self.before[..m].copy_from_slice(&self.change[..m]);
            // A step along it, and back to the solution across it.
            let mut arrived = None;
            while arrived.is_none() && arc >= settings.least_arc {
                for ((change, start), tangent) in self.change.iter_mut().zip(&self.before[..m]).zip(&self.tangent) {
                    *change = start + arc * units[0] * tangent;
                }
                let mut now = logarithm + arc * units[1] * tangent_by_logarithm;
                for correction in 0..settings.arc_corrections {
                    self.update_natural_residual(problem, now.exp(), shear);
                    if largest(&self.residual[..m]) <= settings.arc_tolerance * largest_pressure {
                        arrived = Some((now, correction));
                        break;
                    }
                    if !self.factorise(problem) {
                        break;
                    }
                    steps += 1;
                    self.find_step(m);
                    self.solve_for_logarithm(problem, now.exp(), shear);
                    // tᵀ(Δτ + dτ/dlnε Δlnε) + t Δlnε = 0.
                    let (mut across, mut slope) = (0.0, tangent_by_logarithm / units[1]);
                    for i in 0..m {
                        across += self.tangent[i] * self.step[i] / units[0];
                        slope += self.tangent[i] * self.by_logarithm[i] / units[0];
                    }
                    let change = -across / slope;
                    if !change.is_finite() || change.abs() > 2.0 * units[1] {
                        break;
                    }
                    now += change;
                    for i in 0..m {
                        self.change[i] += self.step[i] + change * self.by_logarithm[i];
                    }
                }
                if arrived.is_none() {
                    arc *= 0.25;
                }
            }
            match arrived {
                Some((now, corrections)) => {
                    logarithm = now;
                    if corrections <= settings.arc_corrections / 2 {
                        arc = (2.0 * arc).min(settings.largest_arc);
                    }
                }
                None => {
                    self.change[..m].copy_from_slice(&self.before[..m]);
                    break;
                }
            }
        }
        steps
    }

    /// dτ/d ln ε at a solution, with the matrix that is factorised.
    fn solve_for_logarithm(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) {
        let m = shear.len();
        self.count(m, 0, 1);
        for (i, shear) in shear.iter().enumerate() {
            let scale = 1.0 / self.own_slip(problem, i);
            let pulled = shear + self.change[i] - scale * self.slip[i];
            let bound = self.friction[i] * self.pressure[i];
            let resisted = Resisted::new(bound, scale, regularisation, pulled.abs());
            // r σ = |z| − t; the residual has −t.
            self.by_logarithm[i] = -pulled.signum() * (pulled.abs() - resisted.shear) * resisted.by_length;
        }
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.by_logarithm[..m]);
    }

    /// The point after `self.change`, the residual τ − Π(τ − r s) and its derivatives; returns the residual's 2-norm.
    fn update_natural_residual(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) -> f64 {
        self.update_point(problem, shear);
        let mut square = 0.0;
        for (i, shear) in shear.iter().enumerate() {
            let scale = 1.0 / self.own_slip(problem, i);
            let (friction, pressure) = (self.friction[i], self.pressure[i]);
            let bound = friction * pressure;
            let tau = shear + self.change[i];
            let pulled = tau - scale * self.slip[i];
            let (length, sign) = (pulled.abs(), pulled.signum());
            // |Π|, and its derivatives by |z| and by the bound.
            let (share, by_length, by_bound) = if regularisation > 0.0 {
                let resisted = Resisted::new(bound, scale, regularisation, length);
                (resisted.shear, resisted.by_length, resisted.by_bound)
            } else if length <= bound {
                (length, 1.0, 0.0)
            } else {
                (bound, 0.0, 1.0)
            };
            self.residual[i] = tau - sign * share;
            self.rows[i] = LawRow {
                by_shear: 1.0 - by_length,
                by_slip: by_length * scale,
                // A pressure that has fallen to 0 stays there.
                by_pressure: if pressure > 0.0 {
                    -sign * by_bound * friction
                } else {
                    0.0
                },
                by_friction: -sign * by_bound * pressure,
            };
            square += self.residual[i] * self.residual[i];
        }
        square.sqrt()
    }

    /// φ = −τ/(μ p), and with Coulomb's law the nodes that slip, at the solution.
    fn close_globalised(&mut self, problem: &TangentialProblem, shear: &[f64]) {
        let coulomb = problem.regularisation == 0.0;
        for (i, shear) in shear.iter().enumerate() {
            let tau = shear + self.change[i];
            let pulled = tau - self.slip[i] / self.own_slip(problem, i);
            self.sliding[i] = if coulomb && pulled.abs() > self.friction[i] * self.pressure[i] {
                -pulled.signum()
            } else {
                0.0
            };
        }
        if coulomb {
            self.set_saturation(shear);
        } else {
            self.take_saturation(shear);
        }
    }
}
