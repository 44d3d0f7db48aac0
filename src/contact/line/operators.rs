//! Operators of a line contact: everything that is computed once, at initialisation.

use super::relaxation::Relaxation;
use crate::body::compliance::{RollingCompliance, Scales};
use crate::body::half_plane::HalfPlanes;
use crate::body::mesh::Mesh;
use crate::body::pair;
use crate::error::Result;
use crate::geometry::gap;
use crate::heat::Heat;
use crate::mechanics::leading_edge::NearField;
use crate::parameters::Parameters;

/// Discretised rail and the wheel's profile, built at initialisation.
pub struct LineOperators {
    /// Triangulation.
    pub mesh: Mesh,
    /// Units of the contact problem.
    pub scales: Scales,
    /// Compliance of the contact nodes.
    pub compliance: RollingCompliance,
    /// The half-planes as one cell sees them, scaled.
    pub near_field: NearField,
    /// Relaxation length of the displacement, by the contact's half-length.
    pub relaxation: Relaxation,
    /// Operators of the heat: depth basis, entering profile, thermal displacement.
    pub heat: Heat,
    /// Profile of the wheel √(r₀² − x²) − r₀ at the contact nodes, scaled. The u₁ in (9) is dropped: it moves the contact
    /// by its own size, some µm, against a half-length of some mm.
    pub profile: Vec<f64>,
}

impl LineOperators {
    /// Computes mesh, compliance and thermal maps.
    ///
    /// # Errors
    /// [`crate::error::Error::StiffnessNotPositiveDefinite`], [`crate::error::Error::DepthBasis`].
    pub fn build(parameters: &Parameters) -> Result<LineOperators> {
        let mesh = Mesh::new(parameters);
        let scales = Scales::new(parameters);
        let (mut compliance, thermal) = pair::build(&mesh, parameters, &scales)?;
        let heat = Heat::new(&mesh, &thermal, parameters)?;
        let near_field = NearField::new(&HalfPlanes::of_pair(parameters), mesh.contact_spacing(), &scales);
        let layer = scales.compliance(parameters.layer_compliance);
        let relaxation = Relaxation::new(parameters, &mesh, &compliance.at_rest, layer, near_field);
        let near_field = near_field.with_layer(layer);
        if layer > 0.0 {
            // A node's own shear alone moves the layer over it.
            for node in 0..mesh.contact_nodes {
                compliance.at_rest.tangential_tangential[(node, node)] += layer;
            }
        }
        let r0 = parameters.wheel_radius;
        let profile = (0..mesh.contact_nodes)
            .map(|node| -gap::of_circle(r0, mesh.contact_position(node)) / scales.displacement)
            .collect();
        Ok(LineOperators {
            mesh,
            scales,
            compliance,
            near_field,
            relaxation,
            heat,
            profile,
        })
    }

    /// Area that a contact node stands for, `m²`.
    pub fn node_area(&self, parameters: &Parameters) -> f64 {
        parameters.contact_width * self.mesh.contact_spacing()
    }
}
