//! Profiles for plotting, sampled at fixed numbers of points whatever the mesh is.

use crate::contact::line::fields::Fields;
use crate::contact::line::rail::Rail;

/// Points across the contact window.
pub const PROFILE_POINTS: usize = 61;
/// Points below the hottest contact point.
pub const DEPTH_POINTS: usize = 41;
/// Depth of the lowest of them, `m`; their spacing grows with the square of the depth index: most lie in the heated skin.
const LARGEST_DEPTH: f64 = 10e-3;

/// Profiles across the contact window, [`PROFILE_POINTS`] points each, and the temperature in depth.
#[derive(Debug, Clone, PartialEq)]
pub struct Profiles {
    /// Position, `m`.
    pub x: Vec<f64>,
    /// Pressure, `Pa`.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, `Pa`.
    pub shear: Vec<f64>,
    /// Slip velocity, `m/s`, 0 outside the contact.
    pub slip: Vec<f64>,
    /// Absolute surface temperature, `K`.
    pub temperature: Vec<f64>,
    /// Wear depth, `m`.
    pub wear_depth: Vec<f64>,
    /// Depth below the hottest contact point, [`DEPTH_POINTS`] points, `m`.
    pub depth: Vec<f64>,
    /// Absolute temperature at that depth, `K`.
    pub depth_temperature: Vec<f64>,
}

impl Profiles {
    /// Samples the fields, linear between the nodes.
    pub fn new(rail: &Rail, fields: &Fields, ambient: f64) -> Profiles {
        let mesh = &rail.mesh;
        let n = mesh.contact_nodes;
        let surface: Vec<f64> = (0..n)
            .map(|node| ambient + fields.surface_temperature[mesh.contact_column(node)])
            .collect();
        let sample = |values: &[f64]| -> Vec<f64> {
            (0..PROFILE_POINTS)
                .map(|i| {
                    let position = i as f64 * (n - 1) as f64 / (PROFILE_POINTS - 1) as f64;
                    let left = (position as usize).min(n - 2);
                    let weight = position - left as f64;
                    values[left] * (1.0 - weight) + values[left + 1] * weight
                })
                .collect()
        };
        let positions: Vec<f64> = (0..n).map(|node| mesh.contact_position(node)).collect();
        let pascal = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v * rail.scales.pressure).collect() };
        let hottest = (0..n).max_by(|&a, &b| surface[a].total_cmp(&surface[b])).unwrap_or(0);
        let column = fields.column(rail, mesh.contact_column(hottest));
        let depth: Vec<f64> = (0..DEPTH_POINTS)
            .map(|i| {
                LARGEST_DEPTH.min(0.5 * mesh.depth[mesh.rows() - 1]) * (i as f64 / (DEPTH_POINTS - 1) as f64).powi(3)
            })
            .collect();
        let depth_temperature = depth
            .iter()
            .map(|&z| {
                let below = mesh.depth.partition_point(|&d| d <= z).clamp(1, mesh.rows() - 1);
                let (upper, lower) = (mesh.depth[below - 1], mesh.depth[below]);
                let weight = (z - upper) / (lower - upper);
                ambient
                    + rail.heat.basis.value(column, below - 1) * (1.0 - weight)
                    + rail.heat.basis.value(column, below) * weight
            })
            .collect();
        Profiles {
            x: sample(&positions),
            pressure: sample(&pascal(&fields.pressure)),
            shear: sample(&pascal(&fields.shear)),
            slip: sample(&fields.slip),
            temperature: sample(&surface),
            wear_depth: sample(&fields.wear[mesh.window()]),
            depth,
            depth_temperature,
        }
    }
}

/// The fields at one surface node of the contact window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactNode {
    /// x₁, `m`.
    pub position: f64,
    /// Pressure, `Pa`.
    pub pressure: f64,
    /// Shear traction on the rail, `Pa`.
    pub shear: f64,
    /// Slip velocity, `m/s`; 0 outside the contact.
    pub slip: f64,
    /// Share −τ/(μ p) of Coulomb's bound.
    pub saturation: f64,
    /// Temperature rise over the ambient, `K`.
    pub temperature: f64,
}

/// The fields at the nodes of the contact window, from the rear to the front for V > 0.
pub fn contact_nodes(rail: &Rail, fields: &Fields) -> Vec<ContactNode> {
    let (mesh, scale) = (&rail.mesh, rail.scales.pressure);
    (0..mesh.contact_nodes)
        .map(|i| ContactNode {
            position: mesh.contact_position(i),
            pressure: fields.pressure[i] * scale,
            shear: fields.shear[i] * scale,
            slip: fields.slip[i],
            saturation: fields.saturation[i],
            temperature: fields.surface_temperature[mesh.contact_column(i)],
        })
        .collect()
}
