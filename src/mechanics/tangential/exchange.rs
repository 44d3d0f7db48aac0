//! Coulomb's law itself: a primal–dual active set of nodes that stick and nodes that slip (semismooth Newton).
//!
//! With the sets held, the law is s = 0 where a node sticks and τ + μ p φ = 0, φ = ±1, where it slips. Then all nodes are
//! exchanged at once that break their condition: a shear beyond the bound, or a slip along the shear. Nearly always a few
//! exchanges settle it. They may cycle; then [`super::path`] finishes, which exchanges one node at a time.

use super::{Ended, LawRow, Tangential, TangentialProblem};
use crate::numerics::dense::largest;

/// A half step of Newton's method on a straight line leaves half the distance; this is as good as half.
const HALVED: f64 = 0.51;

impl Tangential {
    /// Solves Coulomb's law from the nodes in slip that `utilisation` tells.
    pub(super) fn solve_coulomb(&mut self, problem: &TangentialProblem, utilisation: &[f64], shear: &[f64]) -> Ended {
        let m = shear.len();
        let settings = self.settings;
        let tolerance = problem.tolerance * largest(problem.pressure);
        for (sliding, phi) in self.sliding.iter_mut().zip(utilisation) {
            let start = if phi.abs() == 1.0 { *phi } else { 0.0 };
            self.factored &= *sliding == start;
            *sliding = start;
        }
        self.update_point(problem, shear);
        let (mut exchanges, mut last_length, mut cycles) = (0, f64::INFINITY, true);
        for steps in 1..=settings.newton_steps {
            self.set_coulomb_rows(problem);
            self.set_residual(shear);
            let fresh = !self.factored;
            if fresh && !self.factorise(problem) {
                return Ended::Stalled(steps);
            }
            self.find_step(m);
            let length = largest(&self.step[..m]);
            if !length.is_finite() {
                return Ended::Stalled(steps);
            }
            // The corners of a law of slip and memory may send Newton's method to and fro between two points: half a step ends that.
            let damping = match problem.path {
                Some(_) if steps > settings.newton_steps / 3 && cycles => 0.5,
                _ => 1.0,
            };
            for (change, step) in self.change.iter_mut().zip(&self.step[..m]) {
                *change += damping * step;
            }
            self.update_point(problem, shear);
            if self.exchange(problem, shear) {
                self.forget();
                (exchanges, last_length) = (exchanges + 1, f64::INFINITY);
                if exchanges % settings.exchanges.max(1) == 0 && !self.follow_path(problem, shear) {
                    return Ended::Stalled(steps);
                }
                continue;
            }
            if !fresh && last_length.is_finite() {
                self.contraction = (length / last_length).max(settings.least_contraction);
            }
            let left = if damping < 1.0 {
                length
            } else {
                length * self.contraction
            };
            if length.min(left) <= tolerance {
                self.set_saturation(shear);
                return Ended::Converged(steps);
            }
            // The correction at the leading edge is not linear: with a matrix that no longer fits the steps do not get shorter.
            let slow = length > settings.slow_contraction * last_length;
            if slow || damping < 1.0 {
                self.forget();
            }
            // Half a step that halves what is left has left the corners behind: those of a layer, many of which lie far apart.
            if problem.path.is_some_and(|(law, _)| law.yields()) {
                cycles = if damping < 1.0 {
                    length > HALVED * last_length
                } else {
                    slow || cycles && steps <= settings.newton_steps / 3
                };
            }
            last_length = length;
        }
        Ended::Stalled(settings.newton_steps)
    }

    /// The derivatives of τ + μ p φ where a node slips; where it sticks those of s, as a shear.
    pub(super) fn set_coulomb_rows(&mut self, problem: &TangentialProblem) {
        for (i, mu) in self.friction[..problem.friction.len()].iter().enumerate() {
            let phi = self.sliding[i];
            self.rows[i] = if phi == 0.0 {
                let compliance = self.own_slip(problem, i);
                LawRow {
                    // The shear of a node moves nothing at V = 0 before any time has passed: it stays 0.
                    by_shear: if compliance > 0.0 { 0.0 } else { 1.0 },
                    by_slip: if compliance > 0.0 { 1.0 / compliance } else { 0.0 },
                    ..LawRow::default()
                }
            } else {
                LawRow {
                    by_shear: 1.0,
                    by_slip: 0.0,
                    by_pressure: mu * phi,
                    by_friction: self.pressure[i] * phi,
                }
            };
        }
    }

    /// Slip velocity per shear of a node on itself, `m/s`.
    pub(super) fn own_slip(&self, problem: &TangentialProblem, node: usize) -> f64 {
        problem.slip_response[node * problem.pressure.len() + node]
    }

    fn set_residual(&mut self, shear: &[f64]) {
        for (i, shear) in shear.iter().enumerate() {
            let row = &self.rows[i];
            let tau = shear + self.change[i];
            self.residual[i] = if self.sliding[i] == 0.0 {
                row.by_shear * tau + row.by_slip * self.slip[i]
            } else {
                tau + self.friction[i] * self.pressure[i] * self.sliding[i]
            };
        }
    }

    /// Moves the nodes that break their condition to the other set. Returns whether there were any.
    fn exchange(&mut self, problem: &TangentialProblem, shear: &[f64]) -> bool {
        let m = shear.len();
        let friction = &self.friction;
        let bound = |i: usize, pressure: &[f64]| friction[i] * pressure[i];
        let largest_bound = (0..m).fold(0.0, |largest: f64, i| largest.max(bound(i, &self.pressure)));
        let round_off = self.settings.round_off * largest_bound;
        let mut changed = false;
        for (i, shear) in shear.iter().enumerate() {
            let tau = shear + self.change[i];
            let compliance = self.own_slip(problem, i);
            let slip = self.slip[i];
            let held = self.sliding[i];
            let next = if held != 0.0 {
                // The shear that would stop the slip: as long as it is beyond the bound, the node slips on.
                let against = held * slip < 0.0 && slip.abs() > compliance * round_off;
                if against { 0.0 } else { held }
            } else if compliance <= 0.0 {
                if slip == 0.0 { 0.0 } else { slip.signum() }
            } else if tau.abs() > bound(i, &self.pressure) + round_off {
                -tau.signum()
            } else {
                0.0
            };
            changed |= next != held;
            self.sliding[i] = next;
        }
        changed
    }

    /// φ = −τ/(μ p).
    pub(super) fn set_saturation(&mut self, shear: &[f64]) {
        // The largest number below 1: ±1 is slip.
        let stick = 1.0 - f64::EPSILON;
        for (i, shear) in shear.iter().enumerate() {
            let bound = self.friction[i] * self.pressure[i];
            self.utilisation[i] = if self.sliding[i] != 0.0 {
                self.sliding[i]
            } else if bound > 0.0 {
                (-(shear + self.change[i]) / bound).clamp(-stick, stick)
            } else {
                0.0
            };
        }
    }
}
