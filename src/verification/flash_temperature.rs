//! Flash temperature of a semi-elliptic source that slides over the rail, without debris and conduction:
//! θ(t) = 1/(ρc √(πκ)) ∫₀ᵗ q(t′)/√(t − t′) dt′ with q = ᾱ μ p s (Carslaw and Jaeger, Conduction of Heat in Solids, 2.9).
//! And that it falls with the square of the spacing along the rail: the flux-weighted mean temperature, which is what friction
//! power and μ(θ) see. Next to the edges, where the source is √-shaped, single nodes are of a lower order.

use super::row::Row;
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::friction::FrictionState;
use crate::heat::basis::DepthBasis;
use crate::heat::factors::CellFactors;
use crate::heat::march::{HeatMarch, Heated};
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::settings::HeatSettings;
use crate::transport::Upwind;
use std::f64::consts::{FRAC_PI_2, PI};

const SOURCE: &str = "Carslaw and Jaeger, 2.9, by quadrature";
/// The mesh in depth makes 0.2 %, at any spacing along the rail.
const TOLERANCE: f64 = 0.003;
const LOAD: f64 = 60e3;
const ROLLING_SPEED: f64 = 10.0;
const SLIP: f64 = 0.1;

/// All frictional heat enters the rail at constant μ, under the rigid wheel's pressure: the prototype's.
fn parameters() -> Parameters {
    Parameters {
        wheel: Wheel::Rigid,
        friction_law: FrictionLaw::Constant,
        contact_nodes: 61,
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
    let marched = march(&parameters, 0.0)?
        .into_iter()
        .map(|point| point.rise)
        .fold(0.0, f64::max);
    let [coarse, fine] = [61, 121].map(mean_temperature_error);
    let (coarse, fine) = (coarse?, fine?);
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
            "flash temperature, 6e6 N/m, 10 m/s, slip 0.1 m/s, 61 nodes",
            "K",
            reference,
            marched,
            TOLERANCE,
            SOURCE,
        ),
        Row::at_least(
            "order of the flux-weighted mean flash temperature in the spacing, 61 to 121 nodes",
            "1",
            1.8,
            (coarse / fine).log2(),
            "order of the scheme, 2",
        ),
        Row::at_most(
            "error of that temperature at 61 nodes, of itself",
            "1",
            1e-3,
            coarse,
            "the same depth cells at 1/16 of the spacing",
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
    let points = march(&parameters, 0.0)?;
    Ok(points
        .into_iter()
        .map(|SurfaceNode { x, rise, .. }| vec![x, rise, scale * flash_integral(x / half_length)])
        .collect())
}

/// Relative error of the flux-weighted mean temperature with so many contact nodes, against that with 16 times as many: the
/// mean over sources that stand differently between the nodes.
fn mean_temperature_error(contact_nodes: usize) -> Result<f64> {
    const SHIFTS: usize = 4;
    let mean = |contact_nodes: usize, centre: f64| -> Result<f64> {
        let points = march(
            &Parameters {
                contact_nodes,
                ..parameters()
            },
            centre,
        )?;
        let heated: f64 = points.iter().map(|point| point.flux * point.rise).sum();
        Ok(heated / points.iter().map(|point| point.flux).sum::<f64>())
    };
    let intervals = contact_nodes - 1;
    let spacing = 2.0 * parameters().window_half_width() / intervals as f64;
    let mut error = 0.0;
    for shift in 0..SHIFTS {
        let centre = spacing * shift as f64 / SHIFTS as f64;
        let exact = mean(16 * intervals + 1, centre)?;
        error += (mean(contact_nodes, centre)? / exact - 1.0).abs() / SHIFTS as f64;
    }
    Ok(error)
}

/// A surface node of the contact window.
struct SurfaceNode {
    /// Position, `m`.
    x: f64,
    /// Temperature rise, `K`.
    rise: f64,
    /// Heat flux, `W/m²`.
    flux: f64,
}

/// Steady march over the mesh of the parameters under a source that stands at `centre` `m`.
fn march(parameters: &Parameters, centre: f64) -> Result<Vec<SurfaceNode>> {
    let mesh = Mesh::new(parameters);
    let basis = DepthBasis::new(&mesh.depth)?;
    let half_length = parameters.hertz_half_length(LOAD);
    let exchange: Vec<SurfaceExchange> = (0..mesh.contact_nodes)
        .map(|node| {
            // The mean over the node's cell, as the mechanics give it.
            let x = (mesh.contact_position(node) - centre) / half_length;
            let half_cell = 0.5 * mesh.contact_spacing() / half_length;
            let share = (ellipse_area(x + half_cell) - ellipse_area(x - half_cell)) / (2.0 * half_cell);
            let pressure = parameters.hertz_peak_pressure(LOAD) * share;
            SurfaceExchange {
                friction: pressure * SLIP,
                debris: 0.0,
                conduction: 0.0,
                wheel: 0.0,
                ..SurfaceExchange::default()
            }
        })
        .collect();
    let cold = vec![0.0; mesh.columns() * basis.len()];
    let (mut heated, mut surface) = (cold.clone(), vec![0.0; mesh.columns()]);
    let mut flux = vec![0.0; mesh.contact_nodes];
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
            amplitudes: &mut heated,
            surface: &mut surface,
            flux: &mut flux,
        },
        &mut CellFactors::new(&basis, &mesh.x),
    )?;
    Ok((0..mesh.contact_nodes)
        .map(|node| SurfaceNode {
            x: mesh.contact_position(node),
            rise: surface[mesh.contact_column(node)],
            flux: flux[node],
        })
        .collect())
}

/// ∫ √(1 − x²) dx from 0, constant beyond ±1.
fn ellipse_area(x: f64) -> f64 {
    let x = x.clamp(-1.0, 1.0);
    0.5 * (x * (1.0 - x * x).sqrt() + x.asin())
}

/// Factor μ p₀ s √(a/V) / (ρc √(πκ)) on F in θ(X) = factor · F(X), F(X) = ∫ √(1 − Y²)/√(Y − X) dY from the greater of X
/// and −1 to 1, with X = x/a and material entering at X = 1.
fn flash_scale(parameters: &Parameters) -> f64 {
    parameters.friction_cold
        * parameters.hertz_peak_pressure(LOAD)
        * SLIP
        * (parameters.hertz_half_length(LOAD) / ROLLING_SPEED).sqrt()
        / (parameters.volumetric_heat_capacity() * (PI * parameters.thermal_diffusivity).sqrt())
}

/// Largest temperature rise over the contact.
fn largest_flash_temperature(parameters: &Parameters) -> f64 {
    flash_scale(parameters) * largest_flash_integral()
}

/// Largest value of F over the contact.
pub fn largest_flash_integral() -> f64 {
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
    flash_integral(0.5 * (left + right))
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
