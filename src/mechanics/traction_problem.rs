//! Data of the mechanics problem of a line and its unknowns, the tractions.

use super::leading_edge::NearField;
use super::normal::normal_problem::Constraint;
use super::transient::Transient;
use crate::body::compliance::Compliance;
use crate::friction::memory::ParticlePath;
use crate::friction::path::PathLaw;
use crate::parameters::NormalSolver;
use nalgebra::DMatrix;

/// Data of one mechanics problem with n contact nodes, scaled.
#[derive(Debug, Clone, Copy)]
pub struct TractionProblem<'a> {
    /// Compliance at rest.
    pub compliance: &'a Compliance,
    /// Normal compliance C_nn, with the wear compliance of the step where wear is treated implicitly.
    pub normal_compliance: &'a DMatrix<f64>,
    /// Profile of the wheel, less wear, plus the upward displacement that heat and inertia cause, n.
    pub profile: &'a [f64],
    /// Displacement along x₁ that heat and inertia cause, n.
    pub displacement: &'a [f64],
    /// Displacement along x₁ at the end of the step before, n.
    pub displacement_before: &'a [f64],
    /// μ, n; where it depends on more than the temperature, that without slip.
    pub friction: &'a [f64],
    /// Law by which μ depends on slip and on history, with the history; none where it does not.
    pub path: Option<(PathLaw, ParticlePath<'a>)>,
    /// Load or penetration.
    pub constraint: Constraint,
    /// Method for the normal problem.
    pub normal_solver: NormalSolver,
    /// ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// V times the displacement scale over the node spacing, `m/s`; its sign gives the leading side.
    pub strain_speed: f64,
    /// ∂u₁/∂t.
    pub transient: Transient,
    /// Compliance of the half-planes within one cell.
    pub near_field: NearField,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
    /// Whether a solution for a larger ε will do where the law has none that is found.
    pub accepts_regularised: bool,
}

/// Change of a [`TractionProblem`]'s data in one direction, n contact nodes.
#[derive(Debug, Clone, Copy)]
pub struct TractionProblemTangent<'a> {
    /// Change of the profile.
    pub profile: &'a [f64],
    /// Change of the displacement along x₁ that heat and inertia cause.
    pub displacement: &'a [f64],
    /// Change of μ without slip.
    pub friction: &'a [f64],
    /// Change of μ at unchanged slip: that of μ without slip where μ does not depend on slip.
    pub friction_of_slip: &'a [f64],
    /// Change of Σp; without effect where the penetration is given.
    pub total: f64,
    /// Change of ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// Change of the strain speed's magnitude, `m/s`.
    pub strain_speed: f64,
    /// Change of ∂u₁/∂t.
    pub transient: Transient,
}

/// Tractions and what belongs to them, or a change of them, n contact nodes.
pub struct Tractions<'a> {
    /// Pressure, scaled.
    pub pressure: &'a mut [f64],
    /// Shear traction on the rail, scaled.
    pub shear: &'a mut [f64],
    /// Slip velocity, `m/s`, 0 outside the contact: the mean of those in the middle of the two cells beside a node.
    pub slip: &'a mut [f64],
    /// Traction utilisation −τ/(μ p), with the sign of the slip: between −1 and 1.
    pub utilisation: &'a mut [f64],
    /// μ; where a layer flows, its bound over the pressure.
    pub friction: &'a mut [f64],
    /// Coefficient μ of the surfaces of the nodes in contact, where μ depends on more than the temperature; that of the others stays.
    pub surfaces: &'a mut [f64],
    /// Flow u_pl of a layer, `m`, 0 outside the contact.
    pub flow: &'a mut [f64],
    /// Magnitude of the law's slip velocity where μ depends on slip, `m/s`, 0 outside the contact.
    pub speed: &'a mut [f64],
    /// Derivative of `surfaces` by the μ without slip.
    pub share: &'a mut [f64],
    /// Bound of a layer over the pressure, 0 without one.
    pub layer_bound: &'a mut [f64],
    /// Penetration, scaled.
    pub penetration: &'a mut f64,
}

impl TractionProblem<'_> {
    /// Whether the leading side is towards +x₁: V ≥ 0.
    pub fn is_forward(&self) -> bool {
        self.strain_speed >= 0.0
    }

    /// Whether the load is given, and the penetration an unknown.
    pub fn load_is_given(&self) -> bool {
        matches!(self.constraint, Constraint::Total(_))
    }
}

/// Nodes under pressure. The ends of the window have no neighbour on one side; a contact that reaches them is an error
/// of the step.
pub fn under_pressure(pressure: &[f64]) -> impl Iterator<Item = usize> + '_ {
    (1..pressure.len() - 1).filter(|&i| pressure[i] > 0.0)
}

/// Next node on the leading side.
pub fn node_ahead(node: usize, forward: bool) -> usize {
    if forward { node + 1 } else { node - 1 }
}
