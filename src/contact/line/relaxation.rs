//! Relaxation length of the displacement along x₁, the distance of rolling on which a change of it decays: for the fitted step of
//! ∂u₁/∂t ([`crate::mechanics::transient`]).
//!
//! A change of the shear force per width by ΔF changes u₁ in the contact by Λ direct/π ΔF, and rolling brings in material that
//! has not moved, so that the change decays as exp(−x/ℓ). Kalker's transients have ℓ ≈ a/2 ... a for the contact alone; the
//! body's compliance is in series with it, and lengthens ℓ with the logarithm of its size over that of the contact:
//! ℓ = ¾ a Λ. The factor was fitted to transients with short steps, after jumps of the creepage up to saturation, with both
//! kinds of wheel. A layer between wheel and rail adds to the displacement, and to what a creepage needs of it: of compliance c it
//! adds g = π c/(2 a direct) to Λ in units of direct/π, and lowers the slope of the creep curve, π a/direct, by 1 + g, so that
//! ℓ = ¾ a (Λ + g)/(1 + g). How far from them it keeps steps of any length is the verification's "Jump of the creepage".

use crate::body::compliance::Compliance;
use crate::body::mesh::Mesh;
use crate::mechanics::leading_edge::NearField;
use crate::parameters::Parameters;
use std::f64::consts::PI;

/// ℓ/(a Λ), fitted (see the heading).
const FITTED_FACTOR: f64 = 0.75;

/// The relaxation length as a function of the contact's half-length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Relaxation {
    /// Half-length at the largest load, `m`.
    pub half_length: f64,
    /// Λ at the largest load: mean displacement along x₁ in the contact under a shear that is elliptic, per force and width, in
    /// units of direct/π.
    compliance: f64,
    /// g a, `m`.
    layer: f64,
}

impl Relaxation {
    /// Relaxation length of bodies with the given compliance, and of a layer with the compliance `layer`, scaled, between them.
    pub fn new(
        parameters: &Parameters,
        mesh: &Mesh,
        compliance: &Compliance,
        layer: f64,
        near_field: NearField,
    ) -> Relaxation {
        let half_length = parameters.hertz_half_length(parameters.largest_load);
        let shear: Vec<f64> = (0..mesh.contact_nodes)
            .map(|node| {
                (1.0 - (mesh.contact_position(node) / half_length).powi(2))
                    .max(0.0)
                    .sqrt()
            })
            .collect();
        let force: f64 = shear.iter().sum();
        let inside: Vec<usize> = (0..shear.len()).filter(|&node| shear[node] > 0.0).collect();
        let row = |i: usize| {
            inside
                .iter()
                .map(|&j| compliance.tangential_tangential[(i, j)] * shear[j])
                .sum::<f64>()
        };
        let mean = inside.iter().map(|&i| row(i)).sum::<f64>() / inside.len() as f64;
        Relaxation {
            half_length,
            compliance: PI * mean / (force * near_field.direct),
            layer: layer * mesh.contact_spacing() * 0.5 * PI / near_field.direct,
        }
    }

    /// ℓ of a contact of this half-length, `m`. A shorter contact is more compliant by the logarithm of the ratio.
    pub fn length(&self, half_length: f64) -> f64 {
        let layer = self.layer / half_length;
        let body = self.compliance + (self.half_length / half_length).ln();
        FITTED_FACTOR * half_length * ((body + layer) / (1.0 + layer))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::compliance::Scales;
    use crate::body::half_plane::HalfPlanes;
    use crate::parameters::Wheel;

    /// Relaxation length of half-planes alone, their displacement measured against that at 1 m from the load.
    fn of_half_planes(parameters: &Parameters) -> Relaxation {
        let (mesh, scales) = (Mesh::new(parameters), Scales::new(parameters));
        let half_planes = HalfPlanes::of_pair(parameters);
        let displacement = half_planes.surface_displacement(mesh.contact_nodes, mesh.contact_spacing());
        let compliance = Compliance::from_blocks(&(displacement * scales.compliance(1.0)), true);
        let near_field = NearField::new(&half_planes, mesh.contact_spacing(), &scales);
        Relaxation::new(parameters, &mesh, &compliance, 0.0, near_field)
    }

    /// An elliptic shear of force Q per width on a half-plane displaces by direct/π Q (ln(2/a) + ½ − x²/a²) (Johnson, Contact
    /// Mechanics, 2.7): by direct/π Q (ln(2/a) + 1/6) in the mean.
    #[test]
    fn half_planes_have_the_length_of_the_closed_form() {
        for wheel in [Wheel::Rigid, Wheel::Elastic] {
            for largest_load in [20e3, 100e3] {
                let parameters = Parameters {
                    wheel,
                    largest_load,
                    ..Parameters::default()
                };
                let relaxation = of_half_planes(&parameters);
                for load in [0.1 * largest_load, largest_load] {
                    let a = parameters.hertz_half_length(load);
                    let exact = 0.75 * a * ((2.0 / a).ln() + 1.0 / 6.0);
                    let computed = relaxation.length(a);
                    // The mean over the nodes inside is that over the contact but for half a cell at either end.
                    assert!((computed / exact - 1.0).abs() < 5e-3, "{computed} {exact}");
                }
            }
        }
    }
}
