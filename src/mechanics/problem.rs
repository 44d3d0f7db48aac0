//! The data of the mechanics problem and its unknowns.

use super::front::NearField;
use super::normal::problem::Constraint;
use super::transient::Transient;
use crate::body::compliance::Compliance;
use crate::friction::memory::ParticlePath;
use crate::friction::path::PathLaw;
use crate::parameters::NormalSolver;
use nalgebra::DMatrix;

/// The data of one mechanics problem with n contact nodes, scaled.
#[derive(Debug, Clone, Copy)]
pub struct MechanicsProblem<'a> {
    /// Compliance at rest.
    pub compliance: &'a Compliance,
    /// Its C_nn, softened by the wear of the step where that is treated implicitly.
    pub normal_compliance: &'a DMatrix<f64>,
    /// Profile of the wheel, less wear, plus the upward displacement that heat and inertia cause, n.
    pub profile: &'a [f64],
    /// Displacement along x₁ that heat and inertia cause, n.
    pub displacement: &'a [f64],
    /// Displacement along x₁ at the end of the step before, n.
    pub displacement_before: &'a [f64],
    /// μ, n; where it depends on more than the temperature, that without slip.
    pub friction: &'a [f64],
    /// How it depends on slip and on what was before; none where it does not.
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
    /// The half-planes as one cell sees them.
    pub near_field: NearField,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
}

/// Change of a [`MechanicsProblem`]'s data in one direction, n contact nodes.
#[derive(Debug, Clone, Copy)]
pub struct ProblemTangent<'a> {
    /// Of the profile.
    pub profile: &'a [f64],
    /// Of the displacement along x₁.
    pub displacement: &'a [f64],
    /// Of μ without slip.
    pub friction: &'a [f64],
    /// Of μ at unchanged slip: the same where it does not depend on slip.
    pub friction_of_slip: &'a [f64],
    /// Of Σp; without effect where the penetration is given.
    pub total: f64,
    /// Of ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// Of the strain speed's magnitude, `m/s`.
    pub strain_speed: f64,
    /// Of ∂u₁/∂t.
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
    /// Share −τ/(μ p) of Coulomb's bound, with the sign of the slip: between −1 and 1.
    pub saturation: &'a mut [f64],
    /// μ; where a layer flows, its bound over the pressure.
    pub friction: &'a mut [f64],
    /// Where μ depends on more than the temperature: μ of the surfaces, of the nodes in contact; that of the others stays.
    pub surfaces: &'a mut [f64],
    /// u_pl of a layer that flows, `m`, 0 outside the contact.
    pub flow: &'a mut [f64],
    /// Where μ depends on slip: the magnitude of the law's slip velocity, `m/s`, 0 outside the contact.
    pub speed: &'a mut [f64],
    /// The derivative of `surfaces` by the μ without slip.
    pub share: &'a mut [f64],
    /// And the bound of a layer over the pressure, 0 without one.
    pub cap: &'a mut [f64],
    /// Penetration, scaled.
    pub penetration: &'a mut f64,
}

impl MechanicsProblem<'_> {
    /// The weights with which strain and displacement of a node enter its slip: of u₁ less that of the node ahead, and of u₁ less
    /// that of the step before, `m/s`.
    pub fn slip_weights(&self) -> (f64, f64) {
        let Transient { rate, centring } = self.transient;
        (self.strain_speed.abs() - centring * rate, rate)
    }

    /// Whether the leading side is towards +x₁: V ≥ 0.
    pub fn is_forward(&self) -> bool {
        self.strain_speed >= 0.0
    }

    /// Whether the load is given, and the penetration an unknown.
    pub fn load_is_given(&self) -> bool {
        matches!(self.constraint, Constraint::Total(_))
    }
}

/// The nodes under pressure. The ends of the window have no neighbour on one side; a contact that reaches them is an error
/// of the step.
pub fn under_pressure(pressure: &[f64]) -> impl Iterator<Item = usize> + '_ {
    (1..pressure.len() - 1).filter(|&i| pressure[i] > 0.0)
}

/// The next node on the leading side.
pub fn node_ahead(node: usize, forward: bool) -> usize {
    if forward { node + 1 } else { node - 1 }
}
