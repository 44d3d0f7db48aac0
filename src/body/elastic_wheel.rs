//! The elastic wheel: its compliance adds to the rail's.
//!
//! The wheel's body is the rail's mirror image in x₂ = 0, the same strip with its own material, and comes from the same
//! finite elements. Near a contact that is small against r₀ both are half-planes (Johnson, Contact Mechanics, 4.1); the
//! size of the body enters the penetration alone, by a logarithm. On the wheel act −τ along x₁ and p upward. In
//! its mirrored frame, x₂ reversed, it is a rail under the shear −τ and the pressure p, so that with the compliances C of
//! [`crate::body::compliance`] (displacement of the rail u₁ = C_tt τ − C_tn p, u₂ = C_nt τ − C_nn p)
//!
//! u₁ʷ = −C_ttʷ τ − C_tnʷ p,  u₂ʷ = −(−C_ntʷ τ − C_nnʷ p) = C_ntʷ τ + C_nnʷ p.
//!
//! Gap and slip see the differences
//!
//! u₁ − u₁ʷ = (C_tt + C_ttʷ) τ − (C_tn − C_tnʷ) p,  u₂ − u₂ʷ = (C_nt − C_ntʷ) τ − (C_nn + C_nnʷ) p:
//!
//! the direct compliances add, the mixed ones subtract. Like materials have E*/2 and no coupling (Dundurs' second constant
//! is 0).
//!
//! Convective inertia: the tread streams through the contact at ω r₀ as the rail does at V, and the first-order term
//! is that of the rail with the wheel's density, ρ_w (ω r₀)² in place of ρ V². Here ω r₀ is taken as V: one scalar
//! ρV² then multiplies both, with the density ratio in the matrix. What is dropped is ρ_w (V² − (ω r₀)²) times the
//! compliance's derivative: 2ξ of a term of relative size (V/c_R)² (1e-3 at 100 m/s), and that term itself for a
//! locked wheel. The strain in the slip is likewise convected at V on both bodies, an error of ξ ∂u₁ʷ/∂x₁, that is ξ
//! times a strain of 1e-3 beside the rigid slip ξ.
//!
//! Neglected: the curvature of the wheel's body, centrifugal and thermal expansion of the wheel. The latter's bulge is
//! of the size of the rail's; the rail's is kept, because its temperature field is what the model resolves.

use crate::body::compliance::{Compliance, RollingCompliance, Scales, rolling_compliance};
use crate::body::elasticity::Elasticity;
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::parameters::Parameters;

/// Adds the wheel's compliance to the rail's.
///
/// # Errors
/// [`crate::error::Error::StiffnessNotPositiveDefinite`].
pub fn add(pair: &mut RollingCompliance, mesh: &Mesh, parameters: &Parameters, scales: &Scales) -> Result<()> {
    let body = Elasticity::new(mesh, parameters.wheel_lame_lambda, parameters.wheel_shear_modulus, 0.0)?;
    let fields = body.unit_load_fields(mesh);
    let wheel = rolling_compliance(mesh, parameters, scales, &body, &fields);
    combine(&mut pair.at_rest, &wheel.at_rest, 1.0);
    combine(
        &mut pair.inertia,
        &wheel.inertia,
        parameters.wheel_density / parameters.density,
    );
    Ok(())
}

/// Direct compliances add, mixed ones subtract.
fn combine(rail: &mut Compliance, wheel: &Compliance, factor: f64) {
    rail.normal_normal += &wheel.normal_normal * factor;
    rail.tangential_tangential += &wheel.tangential_tangential * factor;
    rail.normal_tangential -= &wheel.normal_tangential * factor;
    rail.tangential_normal -= &wheel.tangential_normal * factor;
}
