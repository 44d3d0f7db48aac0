//! The compliance at speed V is carried to first order in V², C(V) ≈ C(0) + ρV² Zᵀ K₁ Z. The next term of the series is
//! (ρV²)² Zᵀ K₁ S⁻¹ K₁ Z, so that the relative error is of order (V/c_R)⁴: 1e-6 at 100 m/s.

use wheelrail::body::compliance::{self, Scales};
use wheelrail::body::elasticity::Elasticity;
use wheelrail::body::mesh::Mesh;
use wheelrail::parameters::{Parameters, Wheel};

/// Largest error of a block relative to its largest entry at speed V [m/s], against the refactorised form.
fn error_at(wheel: Wheel, speed: f64) -> f64 {
    let parameters = parameters(wheel);
    let mesh = Mesh::new(&parameters);
    let scales = Scales::new(&parameters);
    let (rolling, _) = compliance::build(&mesh, &parameters, &scales).unwrap();
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
