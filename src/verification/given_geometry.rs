//! A patch of given geometry, whose window is that of the parameters: its contact is Hertz's of the geometry that the inputs have, and its creep
//! forces are those of a patch whose parameters have that geometry, with a window of its own. The narrower the contact is in its window, the fewer strips
//! it has.

use super::contact_points::{FRICTION, LOAD};
use super::patch_cases::{self, Rolling};
use super::row::{Row, larger};
use crate::error::Result;
use crate::parameters::{Parameters, PatchGeometry};
use crate::signals::{Inputs, Outputs};
use crate::simulation::Simulation;
use std::sync::Arc;

/// Ellipse of the window, [`super::contact_points::ELLIPSES`]: twice as broad as long.
const ELLIPSE: usize = 0;
/// Transverse curvature over that of the window, with the tolerances of Hertz's approach and peak pressure, relative, and of the forces over μN and the moment
/// over μN√(ab). What few strips leave falls with their number.
const CURVATURES: [(f64, [f64; 2]); 4] = [
    (1.0, [2e-3, 1e-6]),
    (2.0, [2e-3, 2e-3]),
    (4.0, [3e-3, 4e-3]),
    (8.0, [5e-3, 1e-2]),
];
/// ξ, η and φ: forces at some two thirds of the friction bound along, across and by spin, and all of them.
const CREEPAGES: [[f64; 3]; 4] = [[1e-3, 0.0, 0.0], [0.0, 1e-3, 0.0], [0.0, 0.0, 0.2], [7e-4, 7e-4, 0.1]];

/// F_x, F_y over μN and M_z over μN√(ab).
fn shares(outputs: &Outputs, geometry: &Parameters) -> [f64; 3] {
    let bound = FRICTION * LOAD;
    let axis = patch_cases::mean_axis(geometry);
    [
        outputs.traction_force / bound,
        outputs.lateral_force / bound,
        outputs.spin_moment / (bound * axis),
    ]
}

/// Errors at each curvature.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let window = patch_cases::parameters(ELLIPSE, 1);
    let strip = 2.0 * window.patch_window().1 / window.patch_strips as f64;
    let given = Rolling::new(Parameters {
        patch_geometry: PatchGeometry::Inputs,
        ..window.clone()
    })?;
    let mut rows = Vec::new();
    for (times, [hertz_tolerance, tolerance]) in CURVATURES {
        let geometry = Parameters {
            rail_transverse_curvature: times * window.rail_transverse_curvature,
            ..window.clone()
        };
        let own = Rolling::new(geometry.clone())?;
        let hertz = geometry.hertz_ellipse(LOAD);
        let (mut of_hertz, mut of_forces, mut strips) = (0.0, 0.0, 0.0);
        for creepages in CREEPAGES {
            let inputs = Inputs {
                rolling_radius: window.wheel_radius,
                longitudinal_curvature: 1.0 / window.wheel_radius,
                transverse_curvature: geometry.rail_transverse_curvature,
                ..patch_cases::inputs(&window, creepages)
            };
            let outputs = Simulation::of(Arc::clone(given.model()), &inputs)?.state.outputs;
            strips = outputs.contact_breadth / strip;
            for ratio in [
                outputs.penetration / hertz.approach,
                outputs.peak_pressure / hertz.peak_pressure,
            ] {
                of_hertz = larger(of_hertz, (ratio - 1.0).abs());
            }
            let (found, expected) = (shares(&outputs, &geometry), own.shares(creepages)?);
            for (found, expected) in found.into_iter().zip(expected) {
                of_forces = larger(of_forces, (found - expected).abs());
            }
        }
        rows.push(Row::absolute(
            format!("largest relative error of approach and peak pressure, {times} times the window's transverse curvature, {strips:.1} strips in contact"),
            "1",
            0.0,
            of_hertz,
            hertz_tolerance,
            "Johnson, Contact Mechanics, 4.24-4.26",
        ));
        rows.push(Row::absolute(
            format!("largest error of F_x, F_y over mu N and M_z over mu N sqrt(ab) at four creepages, {times} times, {strips:.1} strips"),
            "1",
            0.0,
            of_forces,
            tolerance,
            "patch with that geometry as parameters",
        ));
    }
    Ok(rows)
}
