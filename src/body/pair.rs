//! Rail and wheel as a pair: the compliance that gap and slip see, and the rail's thermal displacement.
//!
//! A rigid wheel adds nothing. The rest of this page is the elastic wheel: its compliance adds to the rail's.
//!
//! The wheel's body is the rail's mirror image in x₂ = 0, the same strip with its own material. Near a contact that is small
//! against r₀ both are half-planes (Johnson, Contact Mechanics, 4.1); the
//! size of the body enters the penetration alone, by a logarithm. On the wheel act −τ along x₁ and p upward. In
//! its mirrored frame, x₂ reversed, it is a rail under the shear −τ and the pressure p, so that with the compliances C of
//! [`super::compliance`] (displacement of the rail u₁ = C_tt τ − C_tn p, u₂ = C_nt τ − C_nn p)
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

use super::compliance::{Compliance, RollingCompliance, Scales, ThermalDisplacement};
use super::elasticity::Elasticity;
use super::half_plane::{HalfPlane, HalfPlanes};
use super::mesh::Mesh;
use super::remainder::Remainder;
use super::{thermal, unit_loads};
use crate::error::Result;
use crate::parameters::{MeshKind, Parameters, Wheel};
use nalgebra::DMatrix;

/// Lamé's constants of a body.
type Lame = (f64, f64);

fn rail_material(parameters: &Parameters) -> Lame {
    (parameters.lame_lambda, parameters.shear_modulus)
}

fn wheel_material(parameters: &Parameters) -> Lame {
    (parameters.wheel_lame_lambda, parameters.wheel_shear_modulus)
}

/// Compliance of the pair and thermal displacement of the rail.
///
/// # Errors
/// [`crate::error::Error::StiffnessNotPositiveDefinite`].
pub fn build(
    mesh: &Mesh,
    parameters: &Parameters,
    scales: &Scales,
) -> Result<(RollingCompliance, ThermalDisplacement)> {
    let (pair, mut thermal) = match parameters.mesh {
        MeshKind::Graded => by_half_planes(mesh, parameters, scales)?,
        MeshKind::Paper => by_unit_loads(mesh, parameters, scales)?,
    };
    let thermal_stress = parameters.thermal_expansion * (3.0 * parameters.lame_lambda + 2.0 * parameters.shear_modulus);
    thermal *= thermal_stress / scales.displacement;
    Ok((pair, thermal))
}

/// Half-planes, and the remainder of each body's strip.
fn by_half_planes(
    mesh: &Mesh,
    parameters: &Parameters,
    scales: &Scales,
) -> Result<(RollingCompliance, ThermalDisplacement)> {
    let remainder = |(lambda, shear): Lame| Remainder::new(parameters, lambda, shear);
    let blocks = |displacement: DMatrix<f64>| {
        Compliance::from_blocks(
            &(displacement * scales.compliance(1.0)),
            parameters.normal_tangential_coupling,
        )
    };
    let (n, spacing) = (mesh.contact_nodes, mesh.contact_spacing());
    // A nodal force is the traction times the tributary length.
    let body = |material: &HalfPlane, remainder: &DMatrix<f64>| {
        let at_rest = blocks(HalfPlanes::of_body(material).surface_displacement(n, spacing) + remainder * spacing);
        // The remainder, nearly a rigid shift, is taken to grow with the speed as the rest does.
        let inertia = at_rest.scaled(&material.inertia_factors());
        RollingCompliance { at_rest, inertia }
    };

    let lame = rail_material(parameters);
    let material = HalfPlane::new(lame.0, lame.1);
    let rail_remainder = remainder(lame)?;
    let on_surface = rail_remainder.surface_displacement(mesh);
    let mut pair = body(&material, &on_surface);
    if parameters.wheel == Wheel::Elastic {
        let wheel_lame = wheel_material(parameters);
        let wheel_material = HalfPlane::new(wheel_lame.0, wheel_lame.1);
        // The same strip of the same material is the same body.
        let wheel = if wheel_lame == lame {
            body(&wheel_material, &on_surface)
        } else {
            body(&wheel_material, &remainder(wheel_lame)?.surface_displacement(mesh))
        };
        add_wheel(&mut pair, &wheel, parameters);
    }
    Ok((pair, thermal::displacement(mesh, &material, &rail_remainder)))
}

/// Fields of unit loads: the paper's method, on its mesh.
fn by_unit_loads(
    mesh: &Mesh,
    parameters: &Parameters,
    scales: &Scales,
) -> Result<(RollingCompliance, ThermalDisplacement)> {
    let fields = |(lambda, shear): Lame| Ok(Elasticity::new(mesh, lambda, shear, 0.0)?.unit_load_fields(mesh));
    let rail = fields(rail_material(parameters))?;
    let mut pair = unit_loads::rolling_compliance(mesh, parameters, scales, &rail);
    if parameters.wheel == Wheel::Elastic {
        let wheel = fields(wheel_material(parameters))?;
        let wheel = unit_loads::rolling_compliance(mesh, parameters, scales, &wheel);
        add_wheel(&mut pair, &wheel, parameters);
    }
    Ok((pair, unit_loads::thermal_displacement(mesh, &rail)))
}

fn add_wheel(pair: &mut RollingCompliance, wheel: &RollingCompliance, parameters: &Parameters) {
    pair.at_rest.add_wheel(&wheel.at_rest, 1.0);
    pair.inertia
        .add_wheel(&wheel.inertia, parameters.wheel_density / parameters.density);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parameters(wheel: Wheel) -> Parameters {
        Parameters {
            contact_nodes: 31,
            depth_nodes: 31,
            wheel,
            // Softer and lighter than the rail; its Rayleigh speed is the smaller one.
            wheel_lame_lambda: 5e10,
            wheel_shear_modulus: 2.6e10,
            wheel_density: 5e3,
            ..Parameters::default()
        }
    }

    /// The blocks of a compliance with their names.
    fn blocks(compliance: &Compliance) -> [(&'static str, &DMatrix<f64>); 4] {
        [
            ("nn", &compliance.normal_normal),
            ("nt", &compliance.normal_tangential),
            ("tn", &compliance.tangential_normal),
            ("tt", &compliance.tangential_tangential),
        ]
    }

    /// Compliance by nodal unit loads, on a mesh that is fine around the contact and away from it. Linear triangles
    /// under a nodal force are wrong at the nodes next to it at any fineness, and further off by the square of the
    /// cells over the distance.
    #[test]
    fn finite_elements_have_the_same_compliance_away_from_the_force() {
        for wheel in [Wheel::Rigid, Wheel::Elastic] {
            let parameters = parameters(wheel);
            let scales = Scales::new(&parameters);
            let (half_width, n) = (parameters.window_half_width(), 41);
            let spacing = 2.0 * half_width / (n - 1) as f64;
            let (length, height) = (parameters.strip_half_length, parameters.strip_height);
            let mesh = Mesh::graded(half_width, n, length, 60, height, 80, spacing);
            let (closed, _) = by_half_planes(&mesh, &parameters, &scales).unwrap();
            let (elements, _) = by_unit_loads(&mesh, &parameters, &scales).unwrap();
            for (what, closed, elements, shift_tolerance, strip_tolerance) in [
                ("at rest", &closed.at_rest, &elements.at_rest, 1e-3, 0.0),
                // At speed the strip is not in proportion to what it is at rest: most of it a shift, which moves the
                // penetration alone.
                ("inertia", &closed.inertia, &elements.inertia, 0.15, 1e-3),
            ] {
                let size = elements.normal_normal.amax();
                for ((block, closed), (_, elements)) in blocks(closed).into_iter().zip(blocks(elements)) {
                    let error = |i: usize, j: usize| (closed[(i, j)] - elements[(i, j)]) / size;
                    let shift = 0.5 * (error(0, n - 1) + error(n - 1, 0));
                    assert!(shift.abs() < shift_tolerance, "{wheel:?} {what} {block}: {shift:e}");
                    for cells in [5, 10, 20] {
                        let worst = (0..n - cells)
                            .flat_map(|i| [error(i, i + cells), error(i + cells, i)])
                            .map(|error| (error - shift).abs())
                            .fold(0.0, f64::max);
                        let tolerance = 0.1 / (cells * cells) as f64 + strip_tolerance;
                        assert!(worst < tolerance, "{wheel:?} {what} {block} {cells}: {worst:e}");
                    }
                }
            }
        }
    }

    /// The near field of the pair is that of its half-planes: what the two bodies add up to.
    #[test]
    fn neighbours_see_the_half_planes_of_the_pair() {
        for wheel in [Wheel::Rigid, Wheel::Elastic] {
            let parameters = parameters(wheel);
            let (mesh, scales) = (Mesh::new(&parameters), Scales::new(&parameters));
            let (pair, _) = build(&mesh, &parameters, &scales).unwrap();
            let planes = HalfPlanes::of_pair(&parameters);
            let (h, scale) = (mesh.contact_spacing(), scales.compliance(1.0));
            let along = (planes.along(0.0, h) - planes.along(h, h)) * scale;
            let across = planes.across(h, h) * scale;
            let c = &pair.at_rest;
            for block in [&c.normal_normal, &c.tangential_tangential] {
                // Of the remainder, nearly constant, there is hardly anything in it.
                assert!(((block[(15, 15)] - block[(16, 15)]) / along - 1.0).abs() < 1e-4);
            }
            let step = c.tangential_normal[(16, 15)] - c.tangential_normal[(14, 15)];
            // The remainder turns the surface by 0.4/h.
            assert!((step / (2.0 * across) - 1.0).abs() < 3e-3, "{step} {across}");
        }
    }

    /// The pair is as fast as the slower of the two waves allows.
    #[test]
    fn a_soft_wheel_lowers_the_largest_speed() {
        let (rigid, elastic) = (parameters(Wheel::Rigid), parameters(Wheel::Elastic));
        // c_R of λ = 5e10, γ = 2.6e10, ρ = 5e3: ν = 0.329, c_s = 2280.4 m/s, times 0.9308.
        assert!(
            (elastic.rayleigh_speed() - 2122.6).abs() < 1.0,
            "{}",
            elastic.rayleigh_speed()
        );
        assert!(elastic.largest_speed() < rigid.largest_speed());
    }

    #[test]
    fn beyond_the_rayleigh_speed_the_form_is_not_coercive() {
        let parameters = Parameters::default();
        let mesh = Mesh::new(&parameters);
        let rho_v2 = parameters.density * (1.1 * parameters.rayleigh_speed()).powi(2);
        assert!(Elasticity::new(&mesh, parameters.lame_lambda, parameters.shear_modulus, rho_v2).is_err());
    }

    /// Reciprocity: the displacement at i along a by a force at j along b is that at j along b by a force at i along a. And like
    /// bodies are not coupled.
    #[test]
    fn the_compliance_is_reciprocal_and_like_bodies_are_not_coupled() {
        for wheel in [Wheel::Rigid, Wheel::Elastic] {
            let parameters = Parameters {
                contact_nodes: 21,
                depth_nodes: 15,
                wheel,
                ..Parameters::default()
            };
            let mesh = Mesh::new(&parameters);
            let (pair, _) = build(&mesh, &parameters, &Scales::new(&parameters)).unwrap();
            for c in [&pair.at_rest, &pair.inertia] {
                let size = c.normal_normal.amax();
                assert!((&c.tangential_normal - c.normal_tangential.transpose()).amax() < 1e-12 * size);
                assert!((&c.normal_normal - c.normal_normal.transpose()).amax() < 1e-12 * size);
                // The mirror image turns u₁ and τ round.
                for (block, sign) in [
                    (&c.normal_normal, 1.0),
                    (&c.tangential_tangential, 1.0),
                    (&c.tangential_normal, -1.0),
                ] {
                    let image = DMatrix::from_fn(21, 21, |i, j| sign * block[(20 - i, 20 - j)]);
                    assert!((block - image).amax() < 1e-12 * size);
                }
                let coupled = c.normal_tangential.amax() / size;
                assert_eq!(wheel == Wheel::Rigid, coupled > 1e-2, "{coupled}");
                assert!(wheel == Wheel::Rigid || coupled < 1e-12, "{coupled}");
            }
            assert!((0..21).all(|i| pair.at_rest.normal_normal[(i, i)] > 0.0));
        }
    }
}
