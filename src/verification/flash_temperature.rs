//! Flash temperature of a semi-elliptic source that slides over the rail, without debris and conduction:
//! θ(t) = 1/(ρc √(πκ)) ∫₀ᵗ q(t′)/√(t − t′) dt′ with q = ᾱ μ p s (Carslaw and Jaeger, Conduction of Heat in Solids, 2.9).

use super::row::Row;
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::friction::FrictionState;
use crate::heat::basis::DepthBasis;
use crate::heat::march::{HeatMarch, Heated};
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::settings::HeatSettings;
use crate::transport::Upwind;
use std::f64::consts::{FRAC_PI_2, PI};

const SOURCE: &str = "Carslaw and Jaeger, 2.9, by quadrature";
/// First order in x₁: half a spacing of 0.2 mm in a contact of 7.7 mm.
const TOLERANCE: f64 = 0.005;
const LOAD: f64 = 60e3;
const ROLLING_SPEED: f64 = 10.0;
const SLIP: f64 = 0.1;

/// All frictional heat enters the rail at constant μ, under the rigid wheel's pressure: the prototype's.
fn parameters() -> Parameters {
    Parameters {
        wheel: Wheel::Rigid,
        friction_law: FrictionLaw::Constant,
        heat_partition: 1.0,
        ..Parameters::default()
    }
}

/// Peak of the marched surface temperature against that of the integral, and the integral against its published value.
///
/// # Errors
/// A march that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let parameters = parameters();
    let reference = largest_flash_temperature(&parameters);
    let marched = march(&parameters)?
        .into_iter()
        .map(|(_, rise)| rise)
        .fold(0.0, f64::max);
    Ok(vec![
        Row::absolute(
            "flash temperature integral, 6e6 N/m, 10 m/s, slip 0.1 m/s",
            "K",
            79.02,
            reference,
            // The quoted figure has two decimals.
            0.005,
            "figure of an independent prototype",
        ),
        Row::relative(
            "flash temperature, 6e6 N/m, 10 m/s, slip 0.1 m/s",
            "K",
            reference,
            marched,
            TOLERANCE,
            SOURCE,
        ),
    ])
}

/// The surface from the rear of the contact window to its front: position, temperature rise, the integral.
///
/// # Errors
/// A march that did not converge.
pub fn curve() -> Result<Vec<Vec<f64>>> {
    let parameters = parameters();
    let (scale, half_length) = (flash_scale(&parameters), parameters.hertz_half_length(LOAD));
    let points = march(&parameters)?;
    Ok(points
        .into_iter()
        .map(|(x, rise)| vec![x, rise, scale * flash_integral(x / half_length)])
        .collect())
}

/// Steady march over the default mesh: position and temperature rise of each surface node of the contact window.
fn march(parameters: &Parameters) -> Result<Vec<(f64, f64)>> {
    let mesh = Mesh::new(parameters);
    let basis = DepthBasis::new(&mesh.depth)?;
    let half_length = parameters.hertz_half_length(LOAD);
    let exchange: Vec<SurfaceExchange> = (0..mesh.contact_nodes)
        .map(|node| {
            let x = mesh.contact_position(node) / half_length;
            let pressure = parameters.hertz_peak_pressure(LOAD) * (1.0 - x * x).max(0.0).sqrt();
            SurfaceExchange {
                friction: pressure * SLIP,
                debris: 0.0,
                conduction: 0.0,
                wheel: 0.0,
            }
        })
        .collect();
    let cold = vec![0.0; mesh.columns() * basis.len()];
    let (mut heated, mut surface) = (cold.clone(), vec![0.0; mesh.columns()]);
    HeatMarch {
        basis: &basis,
        transport: Upwind::new(&mesh.x, ROLLING_SPEED),
        first_contact: mesh.first_contact,
        duration: f64::INFINITY,
        surface: SurfaceCondition {
            friction: FrictionState {
                parameters,
                ambient: 293.15,
                scale: 1.0,
            },
            settings: HeatSettings::default(),
        },
    }
    .advance(
        &cold,
        &exchange,
        &mut Heated {
            temperature: &mut heated,
            surface: &mut surface,
            flux: &mut vec![0.0; mesh.contact_nodes],
        },
        &mut vec![0.0; HeatMarch::scratch_len(&basis)],
    )?;
    Ok((0..mesh.contact_nodes)
        .map(|node| (mesh.contact_position(node), surface[mesh.contact_column(node)]))
        .collect())
}

/// With X = x/a and material entering at X = 1, θ(X) = μ p₀ s √(a/V) / (ρc √(πκ)) F(X), F(X) = ∫ √(1 − Y²)/√(Y − X) dY
/// from the greater of X and −1 to 1. This is the factor of F.
fn flash_scale(parameters: &Parameters) -> f64 {
    parameters.friction_cold
        * parameters.hertz_peak_pressure(LOAD)
        * SLIP
        * (parameters.hertz_half_length(LOAD) / ROLLING_SPEED).sqrt()
        / (parameters.volumetric_heat_capacity() * (PI * parameters.thermal_diffusivity).sqrt())
}

/// Largest value of the integral over the contact.
fn largest_flash_temperature(parameters: &Parameters) -> f64 {
    // F rises to one maximum and falls again: ternary search.
    let (mut left, mut right) = (-1.0, 1.0);
    for _ in 0..100 {
        let third = (right - left) / 3.0;
        if flash_integral(left + third) < flash_integral(right - third) {
            left += third;
        } else {
            right -= third;
        }
    }
    flash_scale(parameters) * flash_integral(0.5 * (left + right))
}

/// F(X). In the contact, Y = X + (1 − X) sin²φ removes both roots: F = 2 (1 − X) ∫₀^{π/2} √(1 + Y) cos²φ dφ, whose integrand is
/// smooth and even about both ends, so that the midpoint rule converges faster than any power. Behind it, Y = cos φ:
/// F = ∫₀^π sin²φ/√(cos φ − X) dφ, likewise.
fn flash_integral(x: f64) -> f64 {
    const POINTS: usize = 64;
    if x >= 1.0 {
        return 0.0;
    }
    if x < -1.0 {
        let width = PI / (8 * POINTS) as f64;
        let sum: f64 = (0..8 * POINTS)
            .map(|i| {
                let (sine, cosine) = ((i as f64 + 0.5) * width).sin_cos();
                sine * sine / (cosine - x).sqrt()
            })
            .sum();
        return sum * width;
    }
    let width = FRAC_PI_2 / POINTS as f64;
    let sum: f64 = (0..POINTS)
        .map(|i| {
            let (sine, cosine) = ((i as f64 + 0.5) * width).sin_cos();
            (1.0 + x + (1.0 - x) * sine * sine).sqrt() * cosine * cosine
        })
        .sum();
    2.0 * (1.0 - x) * sum * width
}
