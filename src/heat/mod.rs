//! Temperature of the rail (19), (23), and the displacement that it causes.
//!
//! [`basis`] takes the depth apart into modes, [`march`] carries them through the columns, by [`factors`], under the condition of
//! [`surface`], [`incoming`] is the rail that the wheel ahead has left, [`thermal_map`] the displacement of the contact
//! nodes, compressed by [`compression`]. [`Heat`] holds what of this is computed once.

pub mod basis;
pub mod compression;
pub mod factors;
pub mod incoming;
pub mod march;
pub mod surface;
pub mod thermal_map;

use crate::body::compliance::ThermalDisplacement;
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::parameters::Parameters;
use basis::DepthBasis;
use incoming::Incoming;
use march::Heated;
use thermal_map::ThermalMap;

/// What the heat of a rail needs and what does not change after initialisation.
pub struct Heat {
    /// Eigenbasis of the depth operator.
    pub basis: DepthBasis,
    /// Profile of the temperature that enters.
    pub incoming: Incoming,
    /// Displacement of the contact nodes.
    pub displacement: ThermalMap,
}

impl Heat {
    /// For a mesh, with the exact map from temperature to displacement on it.
    ///
    /// # Errors
    /// [`crate::error::Error::DepthBasis`].
    pub fn new(mesh: &Mesh, exact: &ThermalDisplacement, parameters: &Parameters) -> Result<Heat> {
        let basis = DepthBasis::new(&mesh.depth)?;
        let displacement = ThermalMap::new(
            mesh,
            &basis,
            exact,
            parameters.thermal_diffusivity,
            thermal_map::TOLERANCE,
        );
        let incoming = Incoming::new(&mesh.depth, &basis, parameters.skin_depth);
        Ok(Heat {
            basis,
            incoming,
            displacement,
        })
    }

    /// Fills the inflow column of a field with rail that enters at `rise` `K` over the ambient.
    pub fn enter(&self, rise: f64, inflow: usize, field: &mut Heated) {
        let m = self.basis.len();
        self.incoming.enter(
            rise,
            &mut field.temperature[inflow * m..(inflow + 1) * m],
            &mut field.surface[inflow],
        );
    }

    /// Temperature rise over the skin depth that holds the heat of a column given by its modal amplitudes, `K`.
    pub fn equivalent_rise(&self, amplitudes: &[f64]) -> f64 {
        self.incoming.equivalent_rise(&self.basis, amplitudes)
    }
}
