//! The derivative of the mechanics: how the tractions change with the data of the problem, at unchanged sets of nodes
//! under pressure and, by Coulomb's law, of nodes that slip.
//!
//! The implicit function theorem on (37) and the friction law, a dτ + b ds + c dp + e dμ = 0 at each node. With dp and ds at
//! unchanged shear, and the responses ∂p/∂τ and ∂s/∂τ,
//!
//! (a + b ∂s/∂τ + c ∂p/∂τ) dτ = −(e dμ + c dp + b ds).

use super::front::Edge;
use super::problem::{MechanicsProblem, ProblemTangent, Tractions, node_ahead};
use super::sweep::Mechanics;
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::parameters::NormalSolver;

impl Mechanics {
    /// Solves from tractions at rest and factorises there, for [`Mechanics::tangent`].
    ///
    /// # Errors
    /// As [`Mechanics::solve`], and [`Error::SingularContactMatrix`].
    pub fn linearise(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions) -> Result<()> {
        let problem = MechanicsProblem {
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
    pub fn tangent(&mut self, problem: &MechanicsProblem, change: &ProblemTangent, tractions: &mut Tractions) {
        let m = self.nodes.len();
        let lift = self.pressure_tangent(problem, change, tractions);
        self.shear_tangent(problem, change, tractions, lift);

        // What follows the change of the shear.
        let local = &mut self.local;
        dense::multiply(self.response.pressure(), m, &local.shear, &mut local.following);
        dense::add_multiple(&local.following[..m], 1.0, &mut local.pressure[..m]);
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        tractions.saturation.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
            tractions.shear[node] = local.shear[row];
        }
        self.displacement_tangent(problem, change, tractions);
        for &node in &self.nodes {
            tractions.slip[node] = self.mean_slip_tangent(problem, change, node);
        }
        self.friction_tangent(problem, change, tractions.friction);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.saturation[node] = self.saturation_tangent(problem, tractions.friction, row);
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

    /// dp at unchanged shear, on the nodes under pressure and as tractions; returns dδ.
    fn pressure_tangent(
        &mut self,
        problem: &MechanicsProblem,
        change: &ProblemTangent,
        tractions: &mut Tractions,
    ) -> f64 {
        let m = self.nodes.len();
        let local = &mut self.local;
        for (row, &node) in self.nodes.iter().enumerate() {
            local.profile[row] = change.profile[node];
        }
        let (inverse, unit) = self.active_set.inverse();
        dense::multiply(inverse, m, &local.profile, &mut local.pressure);
        let mut lift = 0.0;
        if problem.load_is_given() {
            lift = (change.total - local.pressure[..m].iter().sum::<f64>()) / unit.iter().sum::<f64>();
            dense::add_multiple(unit, lift, &mut local.pressure[..m]);
        }
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
        }
        lift
    }

    /// dτ.
    fn shear_tangent(
        &mut self,
        problem: &MechanicsProblem,
        change: &ProblemTangent,
        tractions: &mut Tractions,
        lift: f64,
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
            lowered - change.profile[ahead] - lift
        });
        for (row, &node) in self.nodes.iter().enumerate() {
            self.local.slip[row] = self.law_slip_tangent(problem, change, node);
        }
        let edge = self.leading_edge(problem);
        let point = self.tangential.point(m);
        let edge_change = Edge {
            pressure: edge.rows.map(|row| self.local.pressure[row]),
            shear: [0.0; 3],
            friction: self.nodes.get(edge.rows[0]).map_or(0.0, |&node| change.friction[node]),
            gap,
        };
        let speed = problem.strain_speed.abs();
        for (added, row) in point.added.iter().zip(edge.rows) {
            // What is added is proportional to the strain speed.
            let per_speed = if speed > 0.0 { added.slip / speed } else { 0.0 };
            self.local.slip[row] += added.change(&edge_change) + change.strain_speed * per_speed;
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

    /// dμ, with the law's slip and the pressure under the change of the shear.
    fn friction_tangent(&mut self, problem: &MechanicsProblem, change: &ProblemTangent, friction: &mut [f64]) {
        friction.copy_from_slice(change.friction_of_slip);
        let Some((law, _)) = &problem.path else {
            return;
        };
        let m = self.nodes.len();
        // That at unchanged shear is still there.
        let mut slip = std::mem::take(&mut self.local.slip);
        dense::multiply_columns(&self.slip_response, m, &self.local.shear[..m], &mut slip);
        let edge = self.leading_edge(problem);
        let added = self.tangential.point(m).added;
        for (column, shear) in self.local.shear[..m].iter().enumerate() {
            let response = edge.response(added, self.response.pressure(), column);
            for (response, row) in response.iter().zip(edge.rows) {
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

    /// du₁ of the changes of pressure and shear, n.
    fn displacement_tangent(&mut self, problem: &MechanicsProblem, change: &ProblemTangent, tractions: &Tractions) {
        self.moved.copy_from_slice(change.displacement);
        problem
            .compliance
            .add_along(1.0, tractions.pressure, tractions.shear, &mut self.moved);
    }

    /// Change of the law's slip with the data and with du₁, without what the leading edge adds.
    fn law_slip_tangent(&self, problem: &MechanicsProblem, change: &ProblemTangent, node: usize) -> f64 {
        let ahead = node_ahead(node, problem.is_forward());
        let strain = |u: &[f64]| u[node] - u[ahead];
        let (by_strain, by_displacement) = problem.slip_weights();
        let since = |i: usize| self.displacement[i] - problem.displacement_before[i];
        let (now, change_of) = (problem.transient, change.transient);
        let centred = change_of.centring * now.rate + now.centring * change_of.rate;
        change.rigid_slip
            + change.strain_speed * strain(&self.displacement)
            + by_strain * strain(&self.moved)
            + by_displacement * self.moved[node]
            + change_of.rate * since(node)
            - centred * (since(node) - since(ahead))
    }

    /// Change of the mean slip with the data and with du₁.
    fn mean_slip_tangent(&self, problem: &MechanicsProblem, change: &ProblemTangent, node: usize) -> f64 {
        let sign = if problem.is_forward() { 1.0 } else { -1.0 };
        let strain = |u: &[f64]| 0.5 * (u[node - 1] - u[node + 1]);
        change.rigid_slip
            + sign * change.strain_speed * strain(&self.displacement)
            + problem.strain_speed * strain(&self.moved)
            + change.transient.rate * (self.displacement[node] - problem.displacement_before[node])
            + problem.transient.rate * self.moved[node]
    }

    /// dφ of φ = −τ/(μ p); none where a node slips by Coulomb's law.
    fn saturation_tangent(&self, problem: &MechanicsProblem, friction: &[f64], row: usize) -> f64 {
        let point = self.tangential.point(self.nodes.len());
        let node = self.nodes[row];
        let (mu, pressure, phi) = (point.friction[row], point.pressure[row], point.saturation[row]);
        let slips = problem.regularisation == 0.0 && phi.abs() == 1.0;
        if slips || mu * pressure == 0.0 {
            return 0.0;
        }
        let bound = friction[node] * pressure + mu * self.local.pressure[row];
        -(self.local.shear[row] + phi * bound) / (mu * pressure)
    }
}
