//! Coulomb's law by following a path: one node is exchanged at a time, and none of the exchanges is taken back.
//!
//! With the leading edge linearised, slip and pressure are affine in the shear. A deviation d of the slip is chosen such that the
//! present nodes in stick and slip are the solution for s + λ d at λ = 1. As λ falls to 0 the solution moves along
//! straight lines, and where a node reaches its bound, or its slip comes to rest, that node changes sides. The slip's
//! response to the shear is a P-matrix, so that the path is unique and has an end. A μ that depends on slip is held as it is
//! on the way.

use super::{Tangential, TangentialProblem};
use crate::numerics::dense;

/// Buffers of the exchanges along the path, for m nodes.
#[derive(Debug, Clone)]
pub struct ExchangePath {
    /// ∂s/∂τ with the leading edge, m × m.
    slip_response: Vec<f64>,
    /// Slip at no change of the shear, and the deviation.
    slip: [Vec<f64>; 2],
    /// Solution at λ = 0 and its slope in λ: of the change of the shear, the slip, the pressure.
    change_on: [Vec<f64>; 2],
    slip_on: [Vec<f64>; 2],
    pressure_on: [Vec<f64>; 2],
    /// Part of the law that depends on neither the shear nor the slip nor the pressure.
    constant: Vec<f64>,
}

impl ExchangePath {
    /// Buffers for up to so many nodes.
    pub fn new(nodes: usize) -> ExchangePath {
        let vector = || vec![0.0; nodes];
        let pair = || [vector(), vector()];
        ExchangePath {
            slip_response: vec![0.0; nodes * nodes],
            slip: pair(),
            change_on: pair(),
            slip_on: pair(),
            pressure_on: pair(),
            constant: vector(),
        }
    }
}

/// Slip against its shear that the deviation gives a node that would slip along it, over the largest slip.
const PUSH: f64 = 1e-3;

impl Tangential {
    /// Follows the path from the present shear, held within its bounds, to the solution with the leading edge linearised here.
    /// False where the limit of the exchanges is reached or a matrix is singular.
    pub(super) fn follow_path(&mut self, problem: &TangentialProblem, shear: &[f64]) -> bool {
        let m = shear.len();
        self.linearise_slip(problem, m);
        if !self.start_path(problem, shear) {
            return false;
        }
        let (mut lambda, mut last) = (1.0, m);
        for _ in 0..self.settings.path_exchanges_per_node * m {
            if !self.solve_on_path(problem, shear) {
                return false;
            }
            let Some((node, at, phi)) = self.next_exchange(problem, shear, lambda, last) else {
                self.change[..m].copy_from_slice(&self.path.change_on[0][..m]);
                self.update_point(problem, shear);
                return true;
            };
            (lambda, last) = (at, node);
            self.sliding[node] = phi;
        }
        false
    }

    /// Linearises the slip at the present point, s = `slip[0]` + response · change.
    fn linearise_slip(&mut self, problem: &TangentialProblem, m: usize) {
        self.path.slip_response[..m * m].copy_from_slice(&problem.slip_response[..m * m]);
        for column in 0..m {
            let corrections = problem
                .leading
                .response(&self.corrections, problem.pressure_response, column);
            for (correction, row) in corrections.iter().zip(problem.leading.rows) {
                self.path.slip_response[column * m + row] += correction;
            }
        }
        let ExchangePath {
            slip_response, slip, ..
        } = &mut self.path;
        dense::multiply(slip_response, m, &self.change, &mut slip[0]);
        for (start, slip) in slip[0].iter_mut().zip(&self.slip[..m]) {
            *start = slip - *start;
        }
    }

    /// The nodes in stick and slip, and the deviation that makes them a solution.
    fn start_path(&mut self, problem: &TangentialProblem, shear: &[f64]) -> bool {
        let m = shear.len();
        for (i, shear) in shear.iter().enumerate() {
            let (constant, slope) = self.bound(problem, i);
            let bound = constant + slope * self.pressure[i];
            let tau = shear + self.change[i];
            self.sliding[i] = if tau.abs() >= bound { -tau.signum() } else { 0.0 };
        }
        // The shear of the nodes that slip is put on the bound of the pressure that follows it, that of the others is kept.
        for column in 0..m {
            for row in 0..m {
                let unit = if row == column { 1.0 } else { 0.0 };
                let follows =
                    self.bound(problem, row).1 * self.sliding[row] * problem.pressure_response[column * m + row];
                self.factor[column * m + row] = unit + follows;
            }
        }
        self.factored = false;
        self.count(m, 1, 3);
        if !dense::lu(&mut self.factor[..m * m], m, &mut self.pivots) {
            return false;
        }
        for (i, shear) in shear.iter().enumerate() {
            if self.sliding[i] != 0.0 {
                let (constant, slope) = self.bound(problem, i);
                self.change[i] = -shear - slope * self.sliding[i] * problem.pressure[i] - constant * self.sliding[i];
            }
        }
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.change[..m]);
        let ExchangePath {
            slip_response,
            slip: [slip, deviation],
            slip_on: [here, _],
            ..
        } = &mut self.path;
        dense::multiply(slip_response, m, &self.change, here);
        for (here, slip) in here.iter_mut().zip(&slip[..m]) {
            *here += slip;
        }
        let push = PUSH * dense::largest(&here[..m]);
        for ((deviation, here), phi) in deviation.iter_mut().zip(&here[..m]).zip(&self.sliding) {
            *deviation = if *phi == 0.0 {
                -here
            } else if here * phi > 0.0 {
                0.0
            } else {
                phi * push - here
            };
        }
        true
    }

    /// The solution for the present sets as a function of λ.
    fn solve_on_path(&mut self, problem: &TangentialProblem, shear: &[f64]) -> bool {
        let m = shear.len();
        self.count(m, 1, 8);
        self.set_coulomb_rows(problem);
        for (i, row) in self.rows[..m].iter().enumerate() {
            let (constant, slope) = self.bound(problem, i);
            (self.path.constant[i], self.by_pressure[i]) = if self.sliding[i] == 0.0 {
                (0.0, row.by_pressure)
            } else {
                (constant * self.sliding[i], slope * self.sliding[i])
            };
        }
        for column in 0..m {
            for row in 0..m {
                let law = &self.rows[row];
                let place = column * m + row;
                let unit = if row == column { law.by_shear } else { 0.0 };
                self.factor[place] = unit
                    + law.by_slip * self.path.slip_response[place]
                    + self.by_pressure[row] * problem.pressure_response[place];
            }
        }
        if !dense::lu(&mut self.factor[..m * m], m, &mut self.pivots) {
            return false;
        }
        let ExchangePath {
            slip_response,
            slip,
            change_on,
            slip_on,
            pressure_on,
            constant,
        } = &mut self.path;
        for part in 0..2 {
            let change = &mut change_on[part][..m];
            for (i, change) in change.iter_mut().enumerate() {
                let law = &self.rows[i];
                let fixed = if part == 0 {
                    law.by_shear * shear[i] + self.by_pressure[i] * problem.pressure[i] + constant[i]
                } else {
                    0.0
                };
                *change = -(fixed + law.by_slip * slip[part][i]);
            }
            dense::lu_solve(&self.factor, m, &self.pivots, change);
            dense::multiply(slip_response, m, change, &mut slip_on[part]);
            dense::multiply(problem.pressure_response, m, change, &mut pressure_on[part]);
            for i in 0..m {
                slip_on[part][i] += slip[part][i];
                if part == 0 {
                    pressure_on[part][i] += problem.pressure[i];
                }
            }
        }
        true
    }

    /// The node that changes sides next as λ falls, the λ at which it does, and its φ after it; None where λ = 0 is reached
    /// first. The node exchanged `last` is at its corner and stays.
    fn next_exchange(
        &self,
        problem: &TangentialProblem,
        shear: &[f64],
        lambda: f64,
        last: usize,
    ) -> Option<(usize, f64, f64)> {
        let ExchangePath {
            change_on: [change, change_slope],
            slip_on: [slip, slip_slope],
            pressure_on: [pressure, pressure_slope],
            ..
        } = &self.path;
        let mut next: Option<(usize, f64, f64)> = None;
        // A margin that is positive at λ and negative at 0.
        let mut consider = |node: usize, margin: f64, slope: f64, phi: f64| {
            if slope > 0.0 && margin < 0.0 {
                let at = (-margin / slope).min(lambda);
                if next.is_none_or(|(_, best, _)| at > best) {
                    next = Some((node, at, phi));
                }
            }
        };
        for i in (0..shear.len()).filter(|&i| i != last) {
            let phi = self.sliding[i];
            if phi != 0.0 {
                consider(i, phi * slip[i], phi * slip_slope[i], 0.0);
            } else {
                let (constant, by_pressure) = self.bound(problem, i);
                for phi in [1.0, -1.0] {
                    // Distance of τ from −μ p φ.
                    let margin = constant + by_pressure * pressure[i] + phi * (shear[i] + change[i]);
                    consider(i, margin, by_pressure * pressure_slope[i] + phi * change_slope[i], phi);
                }
            }
        }
        next
    }
}
