//! Rail and wheel as a pair: the compliance that gap and slip see, and the rail's thermal displacement.
//!
//! A rigid wheel adds nothing. The rest of this page is the elastic wheel: its compliance adds to the rail's.
//!
//! The wheel's body is the rail's mirror image in x₂ = 0, the same strip with its own material, and comes from the same
//! finite elements. Near a contact that is small against r₀ both are half-planes (Johnson, Contact Mechanics, 4.1); the
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

use super::compliance::{
    Compliance, RollingCompliance, Scales, ThermalDisplacement, rolling_compliance, thermal_displacement,
};
use super::elasticity::Elasticity;
use super::mesh::Mesh;
use crate::error::Result;
use crate::parameters::{Parameters, Wheel};

/// Compliance of the pair and thermal displacement of the rail, from the unit-load fields at the contact nodes.
///
/// # Errors
/// [`crate::error::Error::StiffnessNotPositiveDefinite`].
pub fn build(
    mesh: &Mesh,
    parameters: &Parameters,
    scales: &Scales,
) -> Result<(RollingCompliance, ThermalDisplacement)> {
    let rail = Elasticity::new(mesh, parameters.lame_lambda, parameters.shear_modulus, 0.0)?;
    let fields = rail.unit_load_fields(mesh);
    let mut pair = rolling_compliance(mesh, parameters, scales, &rail, &fields);
    if parameters.wheel == Wheel::Elastic {
        add_wheel(&mut pair, mesh, parameters, scales)?;
    }
    let thermal_stress = parameters.thermal_expansion * (3.0 * parameters.lame_lambda + 2.0 * parameters.shear_modulus);
    let mut thermal = thermal_displacement(mesh, &rail, &fields);
    thermal *= thermal_stress / scales.displacement;
    Ok((pair, thermal))
}

fn add_wheel(pair: &mut RollingCompliance, mesh: &Mesh, parameters: &Parameters, scales: &Scales) -> Result<()> {
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

#[cfg(test)]
mod tests {
    use super::*;

    // The compliance at speed V is carried to first order in V², C(V) ≈ C(0) + ρV² Zᵀ K₁ Z. The next term of the series is
    // (ρV²)² Zᵀ K₁ S⁻¹ K₁ Z, so that the relative error is of order (V/c_R)⁴: 1e-6 at 100 m/s.

    /// Largest error of a block relative to its largest entry at speed V [m/s], against the refactorised form.
    fn error_at(wheel: Wheel, speed: f64) -> f64 {
        let parameters = parameters(wheel);
        let mesh = Mesh::new(&parameters);
        let scales = Scales::new(&parameters);
        let (rolling, _) = build(&mesh, &parameters, &scales).unwrap();
        let rho_v2 = parameters.density * speed * speed;
        let n = mesh.contact_nodes;
        let fields = |lambda, shear, density: f64| {
            let moving = Elasticity::new(&mesh, lambda, shear, density * speed * speed).unwrap();
            moving.unit_load_fields(&mesh)
        };
        let rail = fields(parameters.lame_lambda, parameters.shear_modulus, parameters.density);
        let body = (wheel == Wheel::Elastic).then(|| {
            fields(
                parameters.wheel_lame_lambda,
                parameters.wheel_shear_modulus,
                parameters.wheel_density,
            )
        });
        let traction = scales.pressure * mesh.contact_spacing() / scales.displacement;
        // Direct compliances add, mixed ones subtract.
        let exact = |direction: usize, i: usize, load: usize| {
            let dof = 2 * mesh.node(mesh.contact_column(i), 0) + direction;
            let sign = if (direction == 1) == (load >= n) { 1.0 } else { -1.0 };
            traction * (rail[(dof, load)] + sign * body.as_ref().map_or(0.0, |body| body[(dof, load)]))
        };
        let (rest, inertia) = (&rolling.at_rest, &rolling.inertia);
        let mut worst = 0.0_f64;
        for (rest, inertia, direction, offset) in [
            (&rest.normal_normal, &inertia.normal_normal, 1, n),
            (&rest.normal_tangential, &inertia.normal_tangential, 1, 0),
            (&rest.tangential_normal, &inertia.tangential_normal, 0, n),
            (&rest.tangential_tangential, &inertia.tangential_tangential, 0, 0),
        ] {
            let mut error = 0.0_f64;
            for i in 0..n {
                for j in 0..n {
                    let first_order = rest[(i, j)] + rho_v2 * inertia[(i, j)];
                    error = error.max((first_order - exact(direction, i, offset + j)).abs());
                }
            }
            assert!(error.is_finite());
            worst = worst.max(error / rest.amax());
        }
        worst
    }

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

    #[test]
    fn the_error_of_the_compliance_is_of_fourth_order_in_the_speed() {
        for wheel in [Wheel::Rigid, Wheel::Elastic] {
            let parameters = parameters(wheel);
            let largest = parameters.largest_speed();
            let fourth = |speed: f64| (speed / parameters.rayleigh_speed()).powi(4);
            let (at_80, at_largest) = (error_at(wheel, 80.0), error_at(wheel, largest));
            // The series' constants are of order 1: the tangential compliance at the edge of the window has the largest, about 3.
            assert!(at_80 < 5.0 * fourth(80.0), "{at_80:e} {:e}", fourth(80.0));
            assert!(
                at_largest < 5.0 * fourth(largest),
                "{at_largest:e} {:e}",
                fourth(largest)
            );
            let order = (at_largest / at_80).ln() / (largest / 80.0).ln();
            assert!((order - 4.0).abs() < 0.1, "{wheel:?}: {order}");
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
                let coupled = c.normal_tangential.amax() / size;
                assert_eq!(wheel == Wheel::Rigid, coupled > 1e-2, "{coupled}");
                assert!(wheel == Wheel::Rigid || coupled < 1e-12, "{coupled}");
            }
            assert!((0..21).all(|i| pair.at_rest.normal_normal[(i, i)] > 0.0));
        }
    }
}
