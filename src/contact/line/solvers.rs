//! Solvers and buffers of a step of the line, made once, so that a step allocates nothing.

use super::operators::LineOperators;
use crate::heat::factors::CellFactors;
use crate::heat::surface::SurfaceExchange;
use crate::mechanics::normal_tangential::Mechanics;
use crate::mechanics::wear_compliance::WearCompliance;
use crate::settings::Settings;
use crate::wear::WearSteps;

/// Solvers and buffers of a step; n contact nodes.
pub struct LineSolvers {
    pub(super) wear_compliance: WearCompliance,
    pub(super) mechanics: Mechanics,
    pub(super) data: MechanicsData,
    pub(super) exchange: Vec<SurfaceExchange>,
    pub(super) wear_rate: Vec<f64>,
    pub(super) wear_steps: WearSteps,
    /// Factors of the heat march.
    pub(super) cells: CellFactors,
    /// Moments of the thermal map.
    pub(super) moments: Vec<f64>,
    /// Heat flux that the thermal map was last applied to, n.
    pub(super) mapped_flux: Vec<f64>,
    /// Surface temperature at the contact nodes then, n.
    pub(super) mapped_temperature: Vec<f64>,
}

/// Data of the mechanics at n contact nodes, scaled.
pub struct MechanicsData {
    /// Profile of the wheel, less wear, plus the upward displacement that heat and inertia cause, n.
    pub(super) profile: Vec<f64>,
    /// Displacement along x₁ at the end of the step before, n.
    pub(super) displacement_before: Vec<f64>,
    /// μ without slip, n.
    pub(super) friction: Vec<f64>,
}

impl LineSolvers {
    /// Solvers for the given operators.
    pub fn new(operators: &LineOperators, settings: &Settings) -> LineSolvers {
        let n = operators.mesh.contact_nodes;
        LineSolvers {
            wear_compliance: WearCompliance::new(&operators.compliance.at_rest.normal_normal, settings.wear_compliance),
            mechanics: Mechanics::new(n, settings),
            data: MechanicsData {
                profile: vec![0.0; n],
                displacement_before: vec![0.0; n],
                friction: vec![0.0; n],
            },
            exchange: vec![SurfaceExchange::default(); n],
            wear_rate: vec![0.0; n],
            wear_steps: WearSteps::new(&operators.mesh.x),
            cells: CellFactors::new(&operators.heat.basis, &operators.mesh.x),
            moments: vec![0.0; operators.heat.displacement.scratch_len()],
            mapped_flux: vec![0.0; n],
            mapped_temperature: vec![0.0; n],
        }
    }
}
