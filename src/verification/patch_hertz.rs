//! Hertz's elliptic contact of the patch without friction: semi-axes a along and b across the rail, p₀ = 3N/(2π a b), the approach, the
//! area π a b (Johnson, Contact Mechanics, 4.24–4.26), for a/b = 0.5, 1 and 2.
//!
//! The cells' pressures are means over cells, and the ends of the contact lie between cells, somewhere else at each load:
//! errors are the largest over loads.

use super::contact_points::LOAD;
use super::patch_cases;
use super::row::{Row, larger};
use super::set_up;
use crate::error::Result;
use crate::parameters::Parameters;
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::PI;
use std::sync::Arc;

const SOURCE: &str = "Johnson, Contact Mechanics, 4.24-4.26";
/// Half a cell is 4 % of a semi-axis along and 7 % across; the ends are interpolated between cells.
const TOLERANCE: f64 = 0.01;
/// Factor that remains of an error with twice as many cells each way; of the first order it would be a half, less or
/// more as the ends lie.
const FALLING: f64 = 0.8;
/// Loads in per cent of the one that the cells are counted for.
const PERCENTS: std::ops::RangeInclusive<u8> = 60..=110;

/// Quantities that are compared.
const QUANTITIES: [&str; 5] = [
    "semi-axis a along the rail",
    "semi-axis b across the rail",
    "peak pressure p0",
    "approach",
    "contact area",
];

fn smooth(ellipse: usize, refinement: usize) -> Parameters {
    Parameters {
        friction_cold: 0.0,
        ..patch_cases::parameters(ellipse, refinement)
    }
}

fn loaded(load: f64) -> Inputs {
    Inputs {
        normal_load: load,
        ..Inputs::default()
    }
}

/// The largest relative error of each quantity over the loads.
fn largest_errors(parameters: Parameters) -> Result<[f64; 5]> {
    let model = Arc::new(set_up::model(parameters)?);
    let mut largest = [0.0; 5];
    for percent in PERCENTS.step_by(5) {
        let load = 0.01 * f64::from(percent) * LOAD;
        let outputs = Simulation::of(model.clone(), &loaded(load))?.state.outputs;
        let hertz = model.parameters().hertz_ellipse(load);
        let ratios = [
            0.5 * outputs.contact_length / hertz.along,
            0.5 * outputs.contact_breadth / hertz.across,
            outputs.peak_pressure / hertz.peak_pressure,
            outputs.penetration / hertz.approach,
            outputs.contact_area / (PI * hertz.along * hertz.across),
        ];
        for (largest, ratio) in largest.iter_mut().zip(ratios) {
            *largest = larger(*largest, (ratio - 1.0).abs());
        }
    }
    Ok(largest)
}

/// The largest error of each quantity over the loads, and what is left of it with twice as many cells each way.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for ellipse in 0..3 {
        let name = patch_cases::name(ellipse);
        let [errors, finer] = [1, 2].map(|refinement| largest_errors(smooth(ellipse, refinement)));
        let (errors, finer) = (errors?, finer?);
        for (quantity, what) in QUANTITIES.into_iter().enumerate() {
            rows.push(Row::absolute(
                format!("largest relative error of the {what} over 11 loads, {name}, default cells"),
                "1",
                0.0,
                errors[quantity],
                TOLERANCE,
                SOURCE,
            ));
            rows.push(Row::at_most(
                format!("of that what is left with twice as many cells each way, {what}, {name}"),
                "1",
                FALLING,
                finer[quantity] / errors[quantity],
                "falls with the size of the cells",
            ));
        }
    }
    Ok(rows)
}

/// Pressure along the middle strip, then across at the middle of the contact, at the load of [`super::contact_points`] on the ellipse
/// with a/b = 0.5: x, y, pressure, Hertz's.
///
/// # Errors
/// A solver that did not converge.
pub fn curve() -> Result<Vec<Vec<f64>>> {
    let parameters = smooth(0, 1);
    let hertz = parameters.hertz_ellipse(LOAD);
    let run = set_up::simulation(&parameters, &loaded(LOAD))?;
    let nodes = run.contact_nodes();
    let nearest = nodes.iter().fold(f64::INFINITY, |m, node| m.min(node.position.abs()));
    let along = nodes.iter().filter(|node| node.lateral_position == 0.0);
    // An even number of cells along: those of one of the two in the middle.
    let across = nodes.iter().filter(|node| node.position == nearest);
    Ok(along
        .chain(across)
        .map(|node| {
            let (x, y) = (node.position / hertz.along, node.lateral_position / hertz.across);
            let closed = hertz.peak_pressure * (1.0 - x * x - y * y).max(0.0).sqrt();
            vec![node.position, node.lateral_position, node.pressure, closed]
        })
        .collect())
}
