//! The derivative of the mechanics: how the tractions change with the data of the problem, at an unchanged active set.
//!
//! The implicit function theorem on (37) and (30). With dp and ds at unchanged shear, and the responses ∂p/∂τ and ∂s/∂τ,
//!
//! (1 + μ p φ′ ∂s/∂τ + μ φ ∂p/∂τ) dτ = −(dμ p φ + μ φ dp + μ p φ′ ds).

use super::problem::{MechanicsProblem, ProblemTangent, Tractions, node_ahead};
use super::sweep::{Mechanics, tangential_problem};
use crate::error::{Error, Result};
use crate::friction::coulomb::{saturation, saturation_slope};
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
        let m = self.nodes.len();
        let local = &self.local;
        let tangential = tangential_problem(
            &problem,
            &self.response,
            (&local.pressure[..m], &local.strain[..m], &local.friction[..m]),
            tolerance,
        );
        if self.tangential.linearise(&tangential) {
            Ok(())
        } else {
            Err(Error::SingularContactMatrix {
                matrix: "friction",
                unknowns: m,
            })
        }
    }

    /// Change of the tractions with the data of the problem, at the point of [`Mechanics::linearise`].
    pub fn tangent(&mut self, problem: &MechanicsProblem, change: &ProblemTangent, tractions: &mut Tractions) {
        let m = self.nodes.len();
        let compliance = problem.compliance;
        let load_given = problem.load_is_given();
        let speed = problem.strain_speed.abs();
        let local = &mut self.local;
        // dp at unchanged shear.
        for (row, &node) in self.nodes.iter().enumerate() {
            local.profile[row] = change.profile[node];
        }
        let (inverse, unit) = self.active_set.inverse();
        dense::multiply(inverse, m, &local.profile, &mut local.pressure);
        if load_given {
            let lift = (change.total - local.pressure[..m].iter().sum::<f64>()) / unit.iter().sum::<f64>();
            dense::add_multiple(unit, lift, &mut local.pressure[..m]);
        }
        // ds at unchanged shear.
        tractions.pressure.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
        }
        self.displacement.copy_from_slice(change.displacement);
        dense::multiply_add(
            &compliance.tangential_normal,
            tractions.pressure,
            -1.0,
            &mut self.displacement,
        );
        let point = self.tangential.point();
        for (row, &node) in self.nodes.iter().enumerate() {
            let strain = self.displacement[node] - self.displacement[node_ahead(node, problem.is_forward())];
            // The strain itself: s = rigid slip + speed · strain.
            let stretched = if speed > 0.0 {
                (point.slip[row] - problem.rigid_slip) / speed
            } else {
                0.0
            };
            local.strain[row] = change.rigid_slip + change.strain_speed * stretched + speed * strain;
            let (phi, slope) = (
                saturation(point.slip[row], problem.regularisation),
                saturation_slope(point.slip[row], problem.regularisation),
            );
            local.shear[row] = -(change.friction[node] * point.pressure[row] * phi
                + problem.friction[node] * phi * local.pressure[row]
                + problem.friction[node] * point.pressure[row] * slope * local.strain[row]);
        }
        self.tangential.solve_linear(&mut local.shear[..m]);

        // What follows the change of the shear.
        dense::multiply(self.response.pressure(), m, &local.shear, &mut local.following);
        dense::add_multiple(&local.following[..m], 1.0, &mut local.pressure[..m]);
        dense::multiply(self.response.strain(), m, &local.shear, &mut local.following);
        dense::add_multiple(&local.following[..m], speed, &mut local.strain[..m]);
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = local.pressure[row];
            tractions.shear[node] = local.shear[row];
            tractions.slip[node] = local.strain[row];
        }
        // δ from any closed node: dδ = (C dp − db) there.
        *tractions.penetration = match self.nodes.first() {
            Some(&node) if load_given => {
                self.profile.copy_from_slice(change.profile);
                dense::multiply_add(&compliance.normal_tangential, tractions.shear, 1.0, &mut self.profile);
                for profile in &mut self.profile {
                    *profile = -*profile;
                }
                dense::multiply_add(problem.normal_compliance, tractions.pressure, 1.0, &mut self.profile);
                self.profile[node]
            }
            _ => 0.0,
        };
    }
}
