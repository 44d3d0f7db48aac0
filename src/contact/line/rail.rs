//! The rail: everything that is computed once, at initialisation.

use crate::body::compliance::{self, RollingCompliance, Scales};
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::heat::basis::DepthBasis;
use crate::heat::incoming::Incoming;
use crate::heat::thermal_map::{self, ThermalMap};
use crate::parameters::Parameters;

/// The rail and the wheel's profile, built at initialisation.
pub struct Rail {
    /// Triangulation.
    pub mesh: Mesh,
    /// Units of the contact problem.
    pub scales: Scales,
    /// Compliance of the contact nodes.
    pub compliance: RollingCompliance,
    /// Eigenbasis of the depth operator.
    pub basis: DepthBasis,
    /// Thermal displacement of the contact nodes.
    pub thermal_map: ThermalMap,
    /// Profile of the temperature that enters.
    pub incoming: Incoming,
    /// Profile of the wheel √(r₀² − x²) − r₀ at the contact nodes, scaled. The u₁ in (9) is dropped: it moves the contact
    /// by its own size, some µm, against a half-length of some mm.
    pub profile: Vec<f64>,
}

impl Rail {
    /// Mesh, compliance, thermal maps.
    ///
    /// # Errors
    /// [`crate::error::Error::StiffnessNotPositiveDefinite`], [`crate::error::Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Rail> {
        let mesh = Mesh::new(parameters);
        let scales = Scales::new(parameters);
        let (compliance, thermal) = compliance::build(&mesh, parameters, &scales)?;
        let basis = DepthBasis::new(&mesh.depth)?;
        let thermal_map = ThermalMap::new(
            &mesh,
            &basis,
            &thermal,
            parameters.thermal_diffusivity,
            thermal_map::TOLERANCE,
        );
        let incoming = Incoming::new(&mesh.depth, &basis, parameters.skin_depth);
        let r0 = parameters.wheel_radius;
        let profile = (0..mesh.contact_nodes)
            .map(|i| {
                let x = mesh.contact_position(i);
                // √(r₀² − x²) − r₀ without the cancellation.
                -x * x / (r0 + (r0 * r0 - x * x).sqrt()) / scales.displacement
            })
            .collect();
        Ok(Rail {
            mesh,
            scales,
            compliance,
            basis,
            thermal_map,
            incoming,
            profile,
        })
    }

    /// Scaled pressure sum Σp of a normal load `N`.
    pub fn scaled_load(&self, parameters: &Parameters, load: f64) -> f64 {
        load / (parameters.contact_width * self.mesh.contact_spacing() * self.scales.pressure)
    }
}
