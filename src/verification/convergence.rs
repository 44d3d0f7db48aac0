//! Manufactured solutions: a smooth field is put into the equations, the load that it needs is computed from its exact
//! derivatives, and the discrete solution must approach it at the order of the scheme.
//!
//! All of order 2 in L²: the displacement (P1), the temperature in depth (P1), and temperature and wear along x₁, by steps through a
//! cell with sources linear over it.

use super::row::Row;
use crate::body::elasticity::Elasticity;
use crate::body::forms::{self, Fields};
use crate::body::mesh::Mesh;
use crate::error::Result;
use crate::friction::FrictionState;
use crate::heat::basis::DepthBasis;
use crate::heat::factors::CellFactors;
use crate::heat::march::{HeatMarch, Heated};
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::parameters::Parameters;
use crate::settings::HeatSettings;
use crate::transport::Upwind;
use crate::wear::{WearMarch, WearSteps};
use std::f64::consts::{FRAC_PI_2, PI};

const SOURCE: &str = "order of the scheme, manufactured solution";
/// An observed order differs from that of the scheme by about the coarser spacing over the size of the field.
const TOLERANCE: f64 = 0.15;

/// Observed order of each field.
///
/// # Errors
/// A factorisation or march that failed.
pub fn rows() -> Result<Vec<Row>> {
    let row = |quantity: &str, expected: f64, [coarse, fine]: [f64; 2]| {
        let order = (coarse / fine).log2();
        Row::absolute(
            format!("order of {quantity} (L2)"),
            "1",
            expected,
            order,
            TOLERANCE,
            SOURCE,
        )
    };
    Ok(vec![
        row("displacement", 2.0, [displacement_error(32)?, displacement_error(64)?]),
        row(
            "temperature along x1",
            2.0,
            // So many cells in depth that theirs is not the error that is seen.
            [
                temperature_error(21, 160, HEAT_SPEED)?,
                temperature_error(41, 160, HEAT_SPEED)?,
            ],
        ),
        row(
            "temperature in depth",
            2.0,
            [temperature_error(13, 20, 0.0)?, temperature_error(13, 40, 0.0)?],
        ),
        row("wear along x1", 2.0, [wear_error(100), wear_error(200)]),
    ])
}

// Displacement ----------------------------------------------------------------------------------------------------

/// λ, γ, ρV² and α(3λ+2γ) in units that make the strip's size and its stresses 1.
const LAMBDA: f64 = 1.2;
const SHEAR: f64 = 0.8;
const RHO_V2: f64 = 0.1;
const THERMAL_STRESS: f64 = 0.7;

/// A function of one variable with its first and second derivative.
type Jet = [f64; 3];

/// sin(k t + c) scaled by `size`.
fn wave(size: f64, k: f64, argument: f64) -> Jet {
    let (sine, cosine) = argument.sin_cos();
    [size * sine, size * k * cosine, -size * k * k * sine]
}

fn sum(a: Jet, b: Jet) -> Jet {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

/// The exact displacement A(x₁) B(x₂), C(x₁) D(x₂) on (−1, 1) × (−1, 0), zero on three sides, free at the top.
struct Exact {
    a: Jet,
    b: Jet,
    c: Jet,
    d: Jet,
    /// θ and its gradient.
    temperature: [f64; 3],
}

impl Exact {
    fn at([x, y]: [f64; 2]) -> Exact {
        // cos(πx/2) and sin(πx) vanish at ±1.
        let even = wave(1.0, FRAC_PI_2, FRAC_PI_2 * (x + 1.0));
        let odd = |size| wave(size, PI, PI * x);
        Exact {
            a: sum(even, odd(0.5)),
            b: wave(1.0, 1.2, 1.2 * (1.0 + y)),
            c: sum(even, odd(-0.3)),
            d: wave(1.0, 0.9, 0.9 * (1.0 + y)),
            temperature: [x.cos() * y.exp(), -x.sin() * y.exp(), x.cos() * y.exp()],
        }
    }

    fn displacement(&self) -> [f64; 2] {
        [self.a[0] * self.b[0], self.c[0] * self.d[0]]
    }

    /// f = −div σ(u) + ρV² u,₁₁ + α(3λ+2γ) ∇θ.
    fn body_force(&self) -> [f64; 2] {
        let Exact { a, b, c, d, .. } = self;
        let bulk = LAMBDA + 2.0 * SHEAR;
        let mixed = LAMBDA + SHEAR;
        let divergence = [
            bulk * a[2] * b[0] + SHEAR * a[0] * b[2] + mixed * c[1] * d[1],
            bulk * c[0] * d[2] + SHEAR * c[2] * d[0] + mixed * a[1] * b[1],
        ];
        [
            -divergence[0] + RHO_V2 * a[2] * b[0] + THERMAL_STRESS * self.temperature[1],
            -divergence[1] + RHO_V2 * c[2] * d[0] + THERMAL_STRESS * self.temperature[2],
        ]
    }

    /// (σ(u) − α(3λ+2γ) θ) n with n upward.
    fn surface_traction(&self) -> [f64; 2] {
        let Exact { a, b, c, d, .. } = self;
        [
            SHEAR * (a[0] * b[1] + c[1] * d[0]),
            LAMBDA * a[1] * b[0] + (LAMBDA + 2.0 * SHEAR) * c[0] * d[1] - THERMAL_STRESS * self.temperature[0],
        ]
    }
}

fn middle(p: [f64; 2], q: [f64; 2]) -> [f64; 2] {
    [0.5 * (p[0] + q[0]), 0.5 * (p[1] + q[1])]
}

fn area(points: [[f64; 2]; 3]) -> f64 {
    let [p, q, r] = points;
    0.5 * ((q[0] - p[0]) * (r[1] - p[1]) - (r[0] - p[0]) * (q[1] - p[1]))
}

/// L² error of the displacement on a graded mesh of `cells` by `cells`/2.
fn displacement_error(cells: usize) -> Result<f64> {
    let rows = cells / 2;
    let mesh = Mesh::graded(0.4, cells / 2 + 1, 1.0, cells / 4, 1.0, rows, 0.4 / rows as f64);
    let rail = Elasticity::new(&mesh, LAMBDA, SHEAR, RHO_V2)?;
    let triangles = mesh.triangles();
    let mut loads = Fields::zeros(2 * mesh.nodes(), 1);
    // The rule of the edges' midpoints, exact for quadratics; a hat function is ½ at two of them.
    for triangle in &triangles {
        let points = triangle.nodes.map(|n| mesh.coordinates(n));
        let weight = area(points) * triangle.weight / 3.0;
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let force = Exact::at(middle(points[i], points[j])).body_force();
            for node in [triangle.nodes[i], triangle.nodes[j]] {
                for (direction, force) in force.iter().enumerate() {
                    loads[(2 * node + direction, 0)] += 0.5 * weight * force;
                }
            }
        }
    }
    // Simpson's rule on the edges of the surface.
    for column in 0..mesh.columns() - 1 {
        let nodes = [mesh.node(column, 0), mesh.node(column + 1, 0)];
        let [left, right] = nodes.map(|n| mesh.coordinates(n));
        let length = right[0] - left[0];
        let centre = Exact::at(middle(left, right)).surface_traction();
        for (node, end) in nodes.into_iter().zip([left, right]) {
            let own = Exact::at(end).surface_traction();
            for direction in 0..2 {
                loads[(2 * node + direction, 0)] += length / 6.0 * (own[direction] + 2.0 * centre[direction]);
            }
        }
    }
    for element in forms::elements(&mesh) {
        let temperature = |node: usize| Exact::at(mesh.coordinates(node)).temperature[0];
        let stress = THERMAL_STRESS * element.nodes.map(temperature).iter().sum::<f64>();
        for (node, load) in element.nodes.into_iter().zip(element.thermal_loads()) {
            loads[(2 * node, 0)] += load[0] * stress;
            loads[(2 * node + 1, 0)] += load[1] * stress;
        }
    }
    let solution = rail.solve(&loads);
    let mut square = 0.0;
    for triangle in &triangles {
        let points = triangle.nodes.map(|n| mesh.coordinates(n));
        for (i, j) in [(0, 1), (1, 2), (2, 0)] {
            let exact = Exact::at(middle(points[i], points[j])).displacement();
            for (direction, exact) in exact.iter().enumerate() {
                let value = |node: usize| solution[(2 * node + direction, 0)];
                let error = 0.5 * (value(triangle.nodes[i]) + value(triangle.nodes[j])) - exact;
                square += area(points) * triangle.weight / 3.0 * error * error;
            }
        }
    }
    Ok(square.sqrt())
}

// Temperature -----------------------------------------------------------------------------------------------------

/// θ = Θ X(x₁) Z(z), X = cos⁴(π x₁/2w), Z = 1 − sin(π z/2h): zero at the bottom, at the ends of the window and beyond.
const PEAK: f64 = 100.0;
const WINDOW: f64 = 0.01;
const DEPTH: f64 = 1e-3;
/// Chosen such that transport over the window, conduction over the depth and one step take about the same time.
const HEAT_SPEED: f64 = 0.1;
const HEAT_STEP: f64 = 0.1;

fn along(x: f64) -> (f64, f64) {
    if x.abs() >= WINDOW {
        return (0.0, 0.0);
    }
    let k = FRAC_PI_2 / WINDOW;
    let (sine, cosine) = (k * x).sin_cos();
    (cosine.powi(4), -4.0 * k * cosine.powi(3) * sine)
}

fn into_depth(z: f64) -> (f64, f64) {
    let k = FRAC_PI_2 / DEPTH;
    (1.0 - (k * z).sin(), k * k * (k * z).sin())
}

/// Relative L² error of one time step of the march. The field at its start, θ − Δt (V θ,₁ + κ θ,₂₂), is what brings θ to
/// its end; it enters by its L² projection. The surface exchange is what makes −κ̄ θ,z the flux at θ, with μ on the
/// falling branch of the default law, a fifth and three tenths of κ̄/h for debris and conduction, and a wheel half as warm.
fn temperature_error(contact_nodes: usize, cells: usize, speed: f64) -> Result<f64> {
    let parameters = Parameters::default();
    let mesh = Mesh::graded(
        WINDOW,
        contact_nodes,
        2.0 * WINDOW,
        2,
        DEPTH,
        cells,
        0.3 * DEPTH / cells as f64,
    );
    let basis = DepthBasis::new(&mesh.depth)?;
    let friction = FrictionState {
        parameters: &parameters,
        ambient: 293.15,
        scale: 1.0,
    };
    let kappa = parameters.thermal_diffusivity;
    let conductivity = kappa * parameters.volumetric_heat_capacity();

    let mut before = vec![0.0; mesh.columns() * basis.len()];
    for (&x, amplitudes) in mesh.x.iter().zip(before.chunks_exact_mut(basis.len())) {
        let (value, slope) = along(x);
        let source = |z: f64| {
            let (depth, bend) = into_depth(z);
            PEAK * (value * depth - HEAT_STEP * (speed * slope * depth + kappa * value * bend))
        };
        for (mode, amplitude) in amplitudes.iter_mut().enumerate() {
            *amplitude = depth_integral(&mesh.depth, |row, weight, z| {
                let mode_value = basis.modes[(row, mode)] * (1.0 - weight) + basis.modes[(row + 1, mode)] * weight;
                source(z) * mode_value
            });
        }
    }
    let (debris, conduction) = (0.2 * conductivity / DEPTH, 0.3 * conductivity / DEPTH);
    let exchange: Vec<SurfaceExchange> = (0..contact_nodes)
        .map(|node| {
            let theta = PEAK * along(mesh.contact_position(node)).0;
            let flux = conductivity * theta * FRAC_PI_2 / DEPTH;
            let wheel = 0.5 * conduction * theta;
            let power = flux / parameters.heat_partition + (debris + conduction) * theta - wheel;
            SurfaceExchange {
                friction: power / friction.coefficient(theta).0,
                debris,
                conduction,
                wheel,
                ..SurfaceExchange::default()
            }
        })
        .collect();
    let mut after = vec![0.0; before.len()];
    HeatMarch {
        basis: &basis,
        transport: Upwind::new(&mesh.x, speed),
        first_contact: mesh.first_contact,
        duration: HEAT_STEP,
        surface: SurfaceCondition {
            friction,
            settings: HeatSettings::default(),
        },
    }
    .advance(
        &before,
        &exchange,
        &mut Heated {
            amplitudes: &mut after,
            surface: &mut vec![0.0; mesh.columns()],
            flux: &mut vec![0.0; contact_nodes],
        },
        &mut CellFactors::new(&basis, &mesh.x),
    )?;

    let (mut square, mut total) = (0.0, 0.0);
    for node in 0..contact_nodes {
        let column = mesh.contact_column(node);
        let amplitudes = &after[column * basis.len()..(column + 1) * basis.len()];
        let rows: Vec<f64> = (0..mesh.rows())
            .map(|row| basis.value(amplitudes.iter().copied(), row))
            .collect();
        let value = along(mesh.x[column]).0;
        square += depth_integral(&mesh.depth, |row, weight, z| {
            let marched = rows[row] * (1.0 - weight) + rows[row + 1] * weight;
            (marched - PEAK * value * into_depth(z).0).powi(2)
        });
        total += depth_integral(&mesh.depth, |_, _, z| (PEAK * value * into_depth(z).0).powi(2));
    }
    Ok((square / total).sqrt())
}

/// ∫ f dz by three Gauss points a cell; f gets the row above, the weight of the row below, and z.
fn depth_integral(depth: &[f64], f: impl Fn(usize, f64, f64) -> f64) -> f64 {
    let offset = 0.5 * 0.6_f64.sqrt();
    let rule = [
        (0.5 - offset, 5.0 / 18.0),
        (0.5, 8.0 / 18.0),
        (0.5 + offset, 5.0 / 18.0),
    ];
    depth
        .windows(2)
        .enumerate()
        .map(|(row, ends)| {
            let length = ends[1] - ends[0];
            let cell: f64 = rule
                .iter()
                .map(|&(at, weight)| weight * f(row, at, ends[0] + at * length))
                .sum();
            length * cell
        })
        .sum()
}

// Wear ------------------------------------------------------------------------------------------------------------

/// L² error of one time step of the wear march towards W = (1 − sin(πx/2))/2 on (−1, 1), from half of it, at V = 1.
fn wear_error(cells: usize) -> f64 {
    let (speed, duration) = (1.0, 0.5);
    let x: Vec<f64> = (0..=cells).map(|i| 2.0 * i as f64 / cells as f64 - 1.0).collect();
    let exact = |x: f64| 0.5 * (1.0 - (FRAC_PI_2 * x).sin());
    let slope = |x: f64| -0.5 * FRAC_PI_2 * (FRAC_PI_2 * x).cos();
    // ∂W/∂t − V ∂W/∂x₁ = k |s| p
    let rate: Vec<f64> = x
        .iter()
        .map(|&x| 0.5 * exact(x) / duration - speed * slope(x))
        .collect();
    let before: Vec<f64> = x.iter().map(|&x| 0.5 * exact(x)).collect();
    let mut after = vec![0.0; x.len()];
    let march = WearMarch {
        transport: Upwind::new(&x, speed),
        duration,
        first_contact: 0,
    };
    march.advance(&rate, &before, &mut after, &mut WearSteps::new(&x));
    let square: f64 = x.iter().zip(&after).map(|(&x, w)| (w - exact(x)).powi(2)).sum();
    (square * 2.0 / cells as f64).sqrt()
}
