//! Derivative of the mechanics: the change of the tractions with the data of the problem, at unchanged sets of nodes
//! under pressure and, by Coulomb's law, of nodes that slip.
//!
//! The implicit function theorem on (37) and the friction law, a dτ + b ds + c dp + e dμ = 0 at each node. With dp and ds at
//! unchanged shear, and the responses ∂p/∂τ and ∂s/∂τ,
//!
//! (a + b ∂s/∂τ + c ∂p/∂τ) dτ = −(e dμ + c dp + b ds).

use super::leading_edge::EdgeValues;
use super::normal_tangential::Mechanics;
use super::traction_problem::{TractionProblem, TractionProblemTangent, Tractions};
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::parameters::NormalSolver;

impl Mechanics {
    /// Solves from converged tractions and factorises there, for [`Mechanics::tangent`].
    ///
    /// # Errors
    /// Those of [`Mechanics::solve`], and [`Error::SingularContactMatrix`].
    pub fn linearise(&mut self, problem: &TractionProblem, tractions: &mut Tractions) -> Result<()> {
        let problem = TractionProblem {
            normal_solver: NormalSolver::ActiveSet,
            ..*problem
        };
        let tolerance = self.settings.linearisation_tolerance;
        self.solve(&problem, tractions, tolerance)?;
        let unknowns = self.nodes.len();
        if self.factorise_friction(&problem, tolerance) {
            Ok(())
        } else {
            Err(Error::SingularContactMatrix {
                matrix: "friction",
                unknowns,
            })
        }
    }

    /// Change of the tractions with the data of the problem, at the point of [`Mechanics::linearise`].
    pub fn tangent(&mut self, problem: &TractionProblem, change: &TractionProblemTangent, tractions: &mut Tractions) {
        let m = self.nodes.len();
        let penetration = self.pressure_tangent(problem, change, tractions);
        self.shear_tangent(problem, change, tractions, penetration);

        // The pressure follows the change of the shear.
        let local = &mut self.local;
        dense::multiply(self.response.pressure(), m, &local.shear, &mut local.following);
        dense::add_multiple(&local.following[..m], 1.0, &mut local.pressure[..m]);
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        tractions.utilisation.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
            tractions.shear[node] = local.shear[row];
        }
        self.displacement_tangent(problem, change, tractions);
        for &node in &self.nodes {
            tractions.slip[node] = problem.mean_slip_tangent(change, &self.displacement, &self.moved, node);
        }
        self.friction_tangent(problem, change, tractions.friction);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.utilisation[node] = self.utilisation_tangent(problem, tractions.friction, row);
        }
        // δ from any closed node: dδ = (C dp − db) there.
        *tractions.penetration = match self.nodes.first() {
            Some(&node) if problem.load_is_given() => {
                self.profile.copy_from_slice(change.profile);
                dense::multiply_add(
                    &problem.compliance.normal_tangential,
                    tractions.shear,
                    1.0,
                    &mut self.profile,
                );
                for profile in &mut self.profile {
                    *profile = -*profile;
                }
                dense::multiply_add(problem.normal_compliance, tractions.pressure, 1.0, &mut self.profile);
                self.profile[node]
            }
            _ => 0.0,
        };
    }

    /// Computes dp at unchanged shear, on the nodes under pressure and as tractions. Returns dδ.
    fn pressure_tangent(
        &mut self,
        problem: &TractionProblem,
        change: &TractionProblemTangent,
        tractions: &mut Tractions,
    ) -> f64 {
        let m = self.nodes.len();
        let local = &mut self.local;
        for (row, &node) in self.nodes.iter().enumerate() {
            local.profile[row] = change.profile[node];
        }
        let (inverse, unit) = self.active_set.inverse();
        dense::multiply(inverse, m, &local.profile, &mut local.pressure);
        let mut penetration = 0.0;
        if problem.load_is_given() {
            penetration = (change.total - local.pressure[..m].iter().sum::<f64>()) / unit.iter().sum::<f64>();
            dense::add_multiple(unit, penetration, &mut local.pressure[..m]);
        }
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
        }
        penetration
    }

    /// Computes dτ.
    fn shear_tangent(
        &mut self,
        problem: &TractionProblem,
        change: &TractionProblemTangent,
        tractions: &mut Tractions,
        penetration: f64,
    ) {
        let m = self.nodes.len();
        self.displacement_tangent(problem, change, tractions);
        let gap = self.response.node_ahead_of_the_contact().map_or(0.0, |ahead| {
            let row = problem.normal_compliance.row(ahead);
            let lowered: f64 = self
                .nodes
                .iter()
                .map(|&node| row[node] * tractions.pressure[node])
                .sum();
            lowered - change.profile[ahead] - penetration
        });
        for (row, &node) in self.nodes.iter().enumerate() {
            self.local.slip[row] = problem.law_slip_tangent(change, &self.displacement, &self.moved, node);
        }
        let leading = self.leading_rows(problem);
        let point = self.tangential.point(m);
        let edge_change = EdgeValues {
            pressure: leading.rows.map(|row| self.local.pressure[row]),
            shear: [0.0; 3],
            friction: self
                .nodes
                .get(leading.rows[0])
                .map_or(0.0, |&node| change.friction[node]),
            gap,
        };
        let speed = problem.strain_speed.abs();
        for (correction, row) in point.corrections.iter().zip(leading.rows) {
            // The correction is proportional to the strain speed.
            let per_speed = if speed > 0.0 { correction.slip / speed } else { 0.0 };
            self.local.slip[row] += correction.change(&edge_change) + change.strain_speed * per_speed;
        }
        for (row, &node) in self.nodes.iter().enumerate() {
            self.local.friction[row] = change.friction_of_slip[node];
        }
        if let Some((law, _)) = &problem.path {
            let local = &mut self.local;
            local.following[..m].copy_from_slice(&local.slip[..m]);
            self.tangential
                .friction_tangent(law, &local.pressure[..m], &mut local.following[..m]);
            dense::add_multiple(&local.following[..m], 1.0, &mut local.friction[..m]);
        }
        for (row, law) in self.tangential.rows()[..m].iter().enumerate() {
            self.local.shear[row] = -(law.by_friction * self.local.friction[row]
                + law.by_pressure * self.local.pressure[row]
                + law.by_slip * self.local.slip[row]);
        }
        self.tangential.solve_linear(&mut self.local.shear[..m]);
    }

    /// Computes dμ, with the law's slip and the pressure under the change of the shear.
    fn friction_tangent(&mut self, problem: &TractionProblem, change: &TractionProblemTangent, friction: &mut [f64]) {
        friction.copy_from_slice(change.friction_of_slip);
        let Some((law, _)) = &problem.path else {
            return;
        };
        let m = self.nodes.len();
        // The change of the slip at unchanged shear is still there.
        let mut slip = std::mem::take(&mut self.local.slip);
        dense::multiply_columns(&self.slip_response, m, &self.local.shear[..m], &mut slip);
        let leading = self.leading_rows(problem);
        let corrections = self.tangential.point(m).corrections;
        for (column, shear) in self.local.shear[..m].iter().enumerate() {
            let response = leading.response(corrections, self.response.pressure(), column);
            for (response, row) in response.iter().zip(leading.rows) {
                slip[row] += response * shear;
            }
        }
        self.tangential
            .friction_tangent(law, &self.local.pressure[..m], &mut slip[..m]);
        for (&node, slip) in self.nodes.iter().zip(&slip) {
            friction[node] += slip;
        }
        self.local.slip = slip;
    }

    /// Computes du₁ by the changes of pressure and shear, n.
    fn displacement_tangent(
        &mut self,
        problem: &TractionProblem,
        change: &TractionProblemTangent,
        tractions: &Tractions,
    ) {
        self.moved.copy_from_slice(change.displacement);
        problem
            .compliance
            .add_along(1.0, tractions.pressure, tractions.shear, &mut self.moved);
    }

    /// Change of the traction utilisation φ = −τ/(μ p); none where a node slips by Coulomb's law.
    fn utilisation_tangent(&self, problem: &TractionProblem, friction: &[f64], row: usize) -> f64 {
        let point = self.tangential.point(self.nodes.len());
        let node = self.nodes[row];
        let (mu, pressure, phi) = (point.friction[row], point.pressure[row], point.utilisation[row]);
        let slips = problem.regularisation == 0.0 && phi.abs() == 1.0;
        if slips || mu * pressure == 0.0 {
            return 0.0;
        }
        let bound = friction[node] * pressure + mu * self.local.pressure[row];
        -(self.local.shear[row] + phi * bound) / (mu * pressure)
    }
}
