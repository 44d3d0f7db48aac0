//! The regularised law (30): damped Newton, with the factorised matrix as long as it contracts fast.

use super::{Ended, LawRow, Tangential, TangentialProblem};
use crate::friction::coulomb::{utilisation_slope, utilisations};
use crate::numerics::dense::largest;

impl Tangential {
    /// Solves (30).
    pub(super) fn solve_regularised(&mut self, problem: &TangentialProblem, shear: &[f64]) -> Ended {
        let end = self.newton(problem, problem.regularisation, shear);
        match end {
            Ended::Converged(_) => {
                // Stiff bodies need it not, and keep the digits that they had before there was a layer.
                let layer = problem.leading.edge.near_field.layer > 0.0;
                if layer || problem.path.is_some() {
                    self.take_saturation(shear);
                }
            }
            Ended::Stalled(_) => self.forget(),
        }
        end
    }

    /// φ = −τ/(μ p) in place of φ(s), the same at the solution. On compliant bodies with a small ε the step of τ that may be left out is one of
    /// φ(s) that may not.
    pub(super) fn take_saturation(&mut self, shear: &[f64]) {
        for (i, shear) in shear.iter().enumerate() {
            let bound = self.friction[i] * self.pressure[i];
            if bound > 0.0 {
                self.utilisation[i] = (-(shear + self.change[i]) / bound).clamp(-1.0, 1.0);
            }
        }
    }

    /// Damped Newton at one ε.
    fn newton(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) -> Ended {
        let m = shear.len();
        let settings = self.settings;
        let tolerance = problem.tolerance * largest(problem.pressure);
        let mut norm = self.update_residual(problem, regularisation, shear);
        let mut last_length = f64::INFINITY;
        for steps in 1..=settings.newton_steps {
            let fresh = !self.factored;
            if fresh {
                self.set_regularised_rows(problem, regularisation);
                if !self.factorise(problem) {
                    return Ended::Stalled(steps);
                }
            }
            self.find_step(m);
            let length = largest(&self.step[..m]);
            if !fresh && last_length.is_finite() {
                self.contraction = (length / last_length).max(settings.least_contraction);
            }
            let round_off = length <= tolerance;
            let contracts = length <= settings.slow_contraction * last_length || round_off;
            if !fresh && !contracts {
                self.factored = false;
                continue;
            }
            let last = round_off || length * self.contraction <= tolerance;
            self.before[..m].copy_from_slice(&self.change[..m]);
            let mut damping = 1.0;
            for halving in 0..=settings.halvings {
                for ((change, before), step) in self.change.iter_mut().zip(&self.before).zip(&self.step[..m]) {
                    *change = before + damping * step;
                }
                let trial = self.update_residual(problem, regularisation, shear);
                // A step as short as round-off cannot be expected to lower the residual.
                if round_off || trial <= (1.0 - 0.1 * damping) * norm {
                    norm = trial;
                    break;
                }
                if halving == settings.halvings || !fresh {
                    if fresh {
                        return Ended::Stalled(steps);
                    }
                    // The step of a matrix that was factorised elsewhere may raise the residual: go back, and factorise here.
                    self.change[..m].copy_from_slice(&self.before[..m]);
                    norm = self.update_residual(problem, regularisation, shear);
                    self.factored = false;
                    break;
                }
                damping *= 0.5;
            }
            if last && self.factored && damping == 1.0 {
                return Ended::Converged(steps);
            }
            last_length = if damping < 1.0 {
                self.factored = false;
                f64::INFINITY
            } else {
                length
            };
        }
        Ended::Stalled(settings.newton_steps)
    }

    /// The point after `self.change`, φ(s) and the residual τ + μ p φ(s); returns the residual's 2-norm.
    fn update_residual(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) -> f64 {
        let m = shear.len();
        self.update_point(problem, shear);
        utilisations(&self.slip[..m], regularisation, &mut self.utilisation);
        let mut square = 0.0;
        for (i, shear) in shear.iter().enumerate() {
            let bound = self.friction[i] * self.pressure[i];
            self.residual[i] = shear + self.change[i] + bound * self.utilisation[i];
            square += self.residual[i] * self.residual[i];
        }
        square.sqrt()
    }

    /// The derivatives of τ + μ p φ(s).
    pub(super) fn set_regularised_rows(&mut self, problem: &TangentialProblem, regularisation: f64) {
        for (i, mu) in self.friction[..problem.friction.len()].iter().enumerate() {
            let (pressure, phi) = (self.pressure[i], self.utilisation[i]);
            self.rows[i] = LawRow {
                by_shear: 1.0,
                by_slip: mu * pressure * utilisation_slope(self.slip[i], regularisation),
                by_pressure: mu * phi,
                by_friction: pressure * phi,
            };
        }
    }
}
