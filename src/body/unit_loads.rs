//! The compliance of a body from the fields of nodal unit loads on the same mesh (section 4.1 of the paper): what the
//! paper's mesh has, and what [`super::remainder`] is held against.
//!
//! C(V) = C(0) + ρV² Zᵀ K₁ Z, where the columns of Z are the fields of the unit loads and K₁ is the form of the convective
//! inertia; C_θ is the adjoint of the same fields.

use super::compliance::{Compliance, RollingCompliance, Scales, ThermalDisplacement, symmetrised};
use super::forms::{self, Fields};
use super::mesh::Mesh;
use crate::parameters::Parameters;
use nalgebra::DMatrix;

/// Compliance of a body from its fields of the unit loads.
pub fn rolling_compliance(mesh: &Mesh, parameters: &Parameters, scales: &Scales, fields: &Fields) -> RollingCompliance {
    // A nodal force is the traction times the tributary length.
    let traction = scales.pressure * mesh.contact_spacing() / scales.displacement;
    let blocks = |all: DMatrix<f64>| {
        Compliance::from_blocks(&(symmetrised(&all) * traction), parameters.normal_tangential_coupling)
    };
    RollingCompliance {
        at_rest: blocks(surface_displacement(mesh, fields)),
        inertia: blocks(fields.tr_mul(&forms::convective_inertia(mesh, fields))),
    }
}

/// The fields at the contact nodes: 2n × 2n, along x₁ first.
fn surface_displacement(mesh: &Mesh, fields: &Fields) -> DMatrix<f64> {
    let n = mesh.contact_nodes;
    DMatrix::from_fn(2 * n, fields.ncols(), |i, field| {
        fields[(2 * mesh.node(mesh.contact_column(i % n), 0) + i / n, field)]
    })
}

/// Adjoint of the thermal load: the displacement at a contact node by a unit thermal stress at a node of the mesh is the
/// work of that stress on the contact node's unit-load field. Nodes × 2n, `m/Pa`.
pub fn thermal_displacement(mesh: &Mesh, fields: &Fields) -> ThermalDisplacement {
    forms::thermal_work(mesh, fields)
}
