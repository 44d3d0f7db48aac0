//! The linearised law, diag(a) + diag(b) ∂s/∂τ + diag(c) ∂p/∂τ and what a μ that remembers links: put together, factorised, solved with.

use super::{Tangential, TangentialProblem};
use crate::friction::path::{Passed, PassedTogether, PathLaw};
use crate::numerics::dense;

/// Linearised law of one node, a dτ + b ds + c dp + e dμ.
#[derive(Debug, Clone, Copy, Default)]
pub struct LawRow {
    /// Derivative a by the shear.
    pub by_shear: f64,
    /// Derivative b by the slip velocity, `s/m`.
    pub by_slip: f64,
    /// Derivative c by the pressure.
    pub by_pressure: f64,
    /// Derivative e by μ.
    pub by_friction: f64,
}

/// Columns whose links are followed side by side: each link waits for the one before it in its column. Four at a time saved
/// 3 % of a step with memory.
const LANES: usize = 4;

/// Responses of a node to the shear on some others.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Responded {
    /// Response of the node's slip; later the change of its bound by the slip of the nodes before it.
    slip: [f64; LANES],
    /// Response of the node's pressure.
    pressure: [f64; LANES],
}

impl Tangential {
    /// Linearised law at the point of [`Tangential::linearise`].
    pub fn rows(&self) -> &[LawRow] {
        &self.rows
    }

    /// Factorises at the point of the last solve. False where the matrix is singular.
    pub fn linearise(&mut self, problem: &TangentialProblem) -> bool {
        if problem.regularisation > 0.0 {
            self.set_regularised_rows(problem, problem.regularisation);
        } else {
            self.set_coulomb_rows(problem);
        }
        self.factorise(problem)
    }

    /// Solves with the matrix of [`Tangential::linearise`], in place.
    pub fn solve_linear(&self, values: &mut [f64]) {
        dense::lu_solve(&self.factor, values.len(), &self.pivots, values);
    }

    /// Replaces changes of the slip, in place, by those of μ that follow from them and from changes of the pressure, at the point of
    /// the last solve.
    pub fn friction_tangent(&self, law: &PathLaw, pressure: &[f64], slip: &mut [f64]) {
        let mut before = Passed::default();
        for row in law.order(slip.len()) {
            let (of_slip, speed) = (&self.of_slip[row], self.slip[row].signum() * slip[row]);
            let (linked, passed) = of_slip.change(&before, speed, pressure[row]);
            slip[row] = linked + of_slip.by_speed() * speed + of_slip.by_pressure() * pressure[row];
            before = passed;
        }
    }

    /// Factorises the law's rows at the present point. False where the matrix is singular.
    pub(super) fn factorise(&mut self, problem: &TangentialProblem) -> bool {
        let m = problem.pressure.len();
        self.count(m, 1, 2);
        let rows = &self.rows[..m];
        let (by_slip, by_pressure) = (&mut self.by_slip[..m], &mut self.by_pressure[..m]);
        for (row, law) in rows.iter().enumerate() {
            (by_slip[row], by_pressure[row]) = (law.by_slip, law.by_pressure);
            if problem.path.is_some() {
                let of_slip = &self.of_slip[row];
                by_slip[row] += law.by_friction * of_slip.by_speed() * self.slip[row].signum();
                by_pressure[row] += law.by_friction * of_slip.by_pressure();
            }
        }
        for column in 0..m {
            let range = column * m..(column + 1) * m;
            let slip = &problem.slip_response[range.clone()];
            let pressure = &problem.pressure_response[range.clone()];
            let factor = &mut self.factor[range];
            let laws = by_pressure.iter().zip(&*by_slip);
            for (((entry, (by_pressure, by_slip)), slip), pressure) in
                factor.iter_mut().zip(laws).zip(slip).zip(pressure)
            {
                *entry = by_slip * slip + by_pressure * pressure;
            }
            factor[column] += rows[column].by_shear;
            let corrections = problem
                .leading
                .response(&self.corrections, problem.pressure_response, column);
            for (correction, row) in corrections.iter().zip(problem.leading.rows) {
                factor[row] += by_slip[row] * correction;
            }
        }
        if let Some((law, _)) = &problem.path
            && law.remembers()
        {
            self.add_links(problem, law);
        }
        self.factored = dense::lu(&mut self.factor[..m * m], m, &mut self.pivots);
        self.contraction = self.settings.fresh_contraction;
        self.factored
    }

    /// Adds to the law's rows the derivatives of a node's bound by the slip of the nodes before it.
    fn add_links(&mut self, problem: &TangentialProblem, law: &PathLaw) {
        let m = problem.pressure.len();
        self.count(m, 0, 4);
        for first in (0..m).step_by(LANES) {
            let columns = LANES.min(m - first);
            for lane in 0..columns {
                let column = first + lane;
                let range = column * m..(column + 1) * m;
                let responses = problem.slip_response[range.clone()]
                    .iter()
                    .zip(&problem.pressure_response[range]);
                for (responded, (slip, pressure)) in self.responded.iter_mut().zip(responses) {
                    (responded.slip[lane], responded.pressure[lane]) = (*slip, *pressure);
                }
                let corrections = problem
                    .leading
                    .response(&self.corrections, problem.pressure_response, column);
                for (correction, row) in corrections.iter().zip(problem.leading.rows) {
                    self.responded[row].slip[lane] += correction;
                }
            }
            let mut before = PassedTogether::default();
            for row in law.order(m) {
                let (of_slip, sign) = (&self.of_slip[row], self.slip[row].signum());
                let responded = &mut self.responded[row];
                responded.slip.iter_mut().for_each(|slip| *slip *= sign);
                of_slip.changes(law.flows(), &mut before, &mut responded.slip, &responded.pressure);
            }
            for lane in 0..columns {
                let factor = &mut self.factor[(first + lane) * m..][..m];
                for ((entry, row), responded) in factor.iter_mut().zip(&self.rows).zip(&self.responded) {
                    *entry += row.by_friction * responded.slip[lane];
                }
            }
        }
    }

    /// Newton step −J⁻¹ residual.
    pub(super) fn find_step(&mut self, m: usize) {
        self.count(m, 0, 1);
        for (step, residual) in self.step.iter_mut().zip(&self.residual[..m]) {
            *step = -residual;
        }
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.step[..m]);
    }
}
