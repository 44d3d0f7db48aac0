//! The mechanics of the line (31) for an interface vector: the data of the problem, its solution, the displacement that follows.

use super::fields::LineFields;
use super::operators::LineOperators;
use super::solvers::LineSolvers;
use super::solvers::MechanicsData;
use crate::contact::engine::Engine;
use crate::contact::interface::Interface;
use crate::error::Result;
use crate::mechanics::normal_tangential::TractionChange;
use crate::mechanics::traction_problem::{TractionProblem, Tractions};
use crate::mechanics::wear_compliance::WearCompliance;

/// Tractions of the fields, or of a change of them. A macro, because a function would borrow the other fields as well.
macro_rules! tractions {
    ($fields:expr) => {
        Tractions {
            pressure: &mut $fields.pressure,
            shear: &mut $fields.shear,
            slip: &mut $fields.slip,
            utilisation: &mut $fields.utilisation,
            friction: &mut $fields.friction,
            surfaces: &mut $fields.memory.now.friction,
            flow: &mut $fields.memory.now.flow,
            speed: &mut $fields.memory.now.speed,
            share: &mut $fields.memory.share,
            layer_bound: &mut $fields.memory.layer_bound,
            penetration: &mut $fields.penetration,
        }
    };
}
pub(super) use tractions;

/// Problem of a step of the line.
pub type LineProblem<'a> = crate::contact::problem::Problem<'a, LineOperators>;

impl LineProblem<'_> {
    /// Strain of a scaled displacement over the node spacing.
    pub fn strain_scale(&self) -> f64 {
        self.operators.scales.displacement / self.operators.spacing()
    }

    /// ρ V², `Pa`.
    pub fn rho_v2(&self) -> f64 {
        self.parameters.density * self.conditions.motion.rolling_speed.powi(2)
    }

    /// Adds the displacement along x₁ and upward that the convective inertia of the given tractions causes.
    pub fn add_inertia(&self, rho_v2: f64, pressure: &[f64], shear: &[f64], along: &mut [f64], upward: &mut [f64]) {
        let inertia = &self.operators.compliance.inertia;
        inertia.add_upward(rho_v2, pressure, shear, upward);
        inertia.add_along(rho_v2, pressure, shear, along);
    }
}

/// Solves the mechanics once for the interface vector. Without load there is nothing to solve.
///
/// # Errors
/// The first solver that does not converge.
pub fn solve(
    problem: &LineProblem,
    interface: &Interface,
    now: &mut LineFields,
    solvers: &mut LineSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    if problem.is_unloaded() {
        for values in [
            &mut now.pressure,
            &mut now.shear,
            &mut now.slip,
            &mut now.utilisation,
            &mut now.memory.now.speed,
            &mut now.memory.now.flow,
        ] {
            values.fill(0.0);
        }
        now.penetration = 0.0;
        return Ok(TractionChange::NONE);
    }
    set_data(problem, interface, &mut solvers.data);
    let (data, wear_compliance) = (&solvers.data, &solvers.wear_compliance);
    let (mechanics, mut tractions) = mechanics_problem(problem, interface, now, data, wear_compliance);
    let of_slip = mechanics.path.is_some();
    let change = solvers.mechanics.iterate(&mechanics, &mut tractions, tolerance)?;
    if of_slip {
        now.memory.now.static_friction.copy_from_slice(&solvers.data.friction);
    }
    Ok(change)
}

/// Factorises the mechanics at fields that were solved for the interface vector.
///
/// # Errors
/// Mechanics that do not converge, or a singular matrix.
pub fn linearise(
    problem: &LineProblem,
    interface: &Interface,
    fields: &mut LineFields,
    solvers: &mut LineSolvers,
) -> Result<()> {
    set_data(problem, interface, &mut solvers.data);
    let (data, wear_compliance) = (&solvers.data, &solvers.wear_compliance);
    let (mechanics, mut tractions) = mechanics_problem(problem, interface, fields, data, wear_compliance);
    solvers.mechanics.linearise(&mechanics, &mut tractions)
}

/// Sets friction coefficient and profile to those of the interface vector.
fn set_data(problem: &LineProblem, interface: &Interface, data: &mut MechanicsData) {
    let friction = problem.friction();
    for (mu, temperature) in data.friction.iter_mut().zip(interface.temperatures()) {
        *mu = friction.coefficient(temperature).0;
    }
    let (_, upward) = interface.displacement().split_at(data.profile.len());
    let gap = problem.operators.profile.iter().zip(interface.gap()).zip(upward);
    for (profile, ((wheel, worn), upward)) in data.profile.iter_mut().zip(gap) {
        *profile = wheel - worn + upward;
    }
}

/// Mechanics problem over its data, and the tractions that it is solved from.
pub fn mechanics_problem<'s>(
    problem: &LineProblem<'s>,
    interface: &'s Interface,
    fields: &'s mut LineFields,
    data: &'s MechanicsData,
    wear_compliance: &'s WearCompliance,
) -> (TractionProblem<'s>, Tractions<'s>) {
    let (operators, motion) = (problem.operators, &problem.conditions.motion);
    let (along, _) = interface.displacement().split_at(data.profile.len());
    let mechanics = TractionProblem {
        compliance: &operators.compliance.at_rest,
        normal_compliance: wear_compliance.compliance(),
        profile: &data.profile,
        displacement: along,
        displacement_before: &data.displacement_before,
        friction: &data.friction,
        path: problem
            .path_law()
            .map(|law| (law, fields.memory.before.path(0..data.friction.len()))),
        constraint: problem.constraint(),
        normal_solver: problem.parameters.normal_solver,
        rigid_slip: motion.rigid_slip,
        strain_speed: motion.rolling_speed * problem.strain_scale(),
        transient: problem.transient(fields.relaxation_length),
        near_field: operators.near_field,
        regularisation: problem.parameters.slip_regularisation,
        accepts_regularised: problem.conditions.coupling.is_staggered(),
    };
    let tractions = tractions!(fields);
    (mechanics, tractions)
}

/// Sets the displacement along x₁ at the end of the step, and its change over the step.
pub fn finalise_displacement(problem: &LineProblem, interface: &Interface, now: &mut LineFields, data: &MechanicsData) {
    let nodes = now.displacement.len();
    now.displacement.copy_from_slice(&interface.displacement()[..nodes]);
    let compliance = &problem.operators.compliance.at_rest;
    compliance.add_along(1.0, &now.pressure, &now.shear, &mut now.displacement);
    let values = now.displacement.iter().zip(&data.displacement_before);
    for (change, (now, before)) in now.displacement_change.iter_mut().zip(values) {
        *change = now - before;
    }
}
