//! Profiles of a line contact for plotting, and its fields node by node.

use super::fields::LineFields;
use super::operators::LineOperators;
use crate::contact::profiles::{self, ContactNode, PROFILE_POINTS, Profiles, StripProfiles};
use crate::numerics::interpolation::between;

/// Samples the fields, linear between the nodes.
pub fn profiles(operators: &LineOperators, fields: &LineFields, ambient: f64) -> Profiles {
    let mesh = &operators.mesh;
    let n = mesh.contact_nodes;
    let surface: Vec<f64> = (0..n)
        .map(|node| ambient + fields.surface_temperature[mesh.contact_column(node)])
        .collect();
    let sample = |values: &[f64]| profiles::sample(values, PROFILE_POINTS);
    let positions: Vec<f64> = (0..n).map(|node| mesh.contact_position(node)).collect();
    let pascal = |values: &[f64]| -> Vec<f64> { values.iter().map(|v| v * operators.scales.pressure).collect() };
    let hottest = (0..n).max_by(|&a, &b| surface[a].total_cmp(&surface[b])).unwrap_or(0);
    let column = fields.column(operators, mesh.contact_column(hottest));
    let depth = profiles::depths(mesh.depth[mesh.rows() - 1]);
    let depth_temperature = depth
        .iter()
        .map(|&z| {
            let (upper, weight) = between(&mesh.depth, z);
            let value = |row| operators.heat.basis.value(column.iter().copied(), row);
            ambient + value(upper) * (1.0 - weight) + value(upper + 1) * weight
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
        strips: StripProfiles::none(ambient),
    }
}

/// The fields at the nodes of the contact window, from the rear to the front for V > 0.
pub fn contact_nodes(operators: &LineOperators, fields: &LineFields) -> Vec<ContactNode> {
    let (mesh, scale) = (&operators.mesh, operators.scales.pressure);
    (0..mesh.contact_nodes)
        .map(|i| ContactNode {
            position: mesh.contact_position(i),
            lateral_position: 0.0,
            lateral_shear: 0.0,
            lateral_slip: 0.0,
            wear_depth: fields.wear[mesh.contact_column(i)],
            pressure: fields.pressure[i] * scale,
            shear: fields.shear[i] * scale,
            slip: fields.slip[i],
            utilisation: fields.utilisation[i],
            friction_coefficient: fields.friction[i],
            temperature: fields.surface_temperature[mesh.contact_column(i)],
        })
        .collect()
}
