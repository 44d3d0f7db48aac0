//! Flash temperature of the patch in full slip: each strip is heated by its own part of Hertz's ellipsoid, which is a semi-ellipse of
//! half-length a √(1 − y²/b²) and peak pressure p₀ √(1 − y²/b²), and is as warm as such a source that slides over the rail
//! ([`super::flash_temperature`]). And CONTACT's peak on the circle.

use super::contact_points::{FLASH_TEMPERATURE, FRICTION, LOAD};
use super::flash_temperature::largest_flash_integral;
use super::patch_cases::{self, SPEED};
use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::Parameters;
use crate::simulation::Simulation;
use std::f64::consts::PI;

const CIRCLE: usize = 1;
/// Longer than the rail is in the strip.
const PASSAGE: f64 = 0.5;
/// Elastic slip is 0.3 % of V; against this creepage it is nothing.
const CREEPAGE: f64 = 10.0;

/// Half of the heat into the rail, none to the wheel by conduction.
fn parameters(refinement: usize) -> Parameters {
    Parameters {
        heat_partition: 0.5,
        contact_thermal_resistance: 1e12,
        ..patch_cases::parameters(CIRCLE, refinement)
    }
}

fn steady(parameters: &Parameters, creepage: f64) -> Result<Simulation> {
    let inputs = patch_cases::inputs(parameters, [creepage, 0.0, 0.0]);
    let mut run = set_up::simulation(parameters, &inputs)?;
    run.hold(&inputs, PASSAGE, 3)?;
    Ok(run)
}

/// Highest rise of the strips and the integral's: pairs by |y|/b.
fn strips(refinement: usize) -> Result<Vec<(f64, f64, f64)>> {
    let parameters = parameters(refinement);
    let run = steady(&parameters, CREEPAGE)?;
    let ellipse = parameters.hertz_ellipse(LOAD);
    let mut strips = Vec::new();
    for strip in run.contact_nodes().chunks_exact(parameters.patch_nodes) {
        let place = strip[0].lateral_position / ellipse.across;
        if !(-1e-9..=0.8).contains(&place) {
            continue;
        }
        let share = (1.0 - place * place).sqrt();
        let scale = parameters.heat_partition
            * FRICTION
            * share
            * ellipse.peak_pressure
            * SPEED
            * CREEPAGE
            * (share * ellipse.along / SPEED).sqrt()
            / (parameters.volumetric_heat_capacity() * (PI * parameters.thermal_diffusivity).sqrt());
        let rise = strip.iter().fold(f64::NEG_INFINITY, |m, node| m.max(node.temperature));
        strips.push((place, rise, scale * largest_flash_integral()));
    }
    Ok(strips)
}

/// Strips from the middle outwards, and CONTACT's peak.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (refinement, cells, tolerance) in [(1, "default cells", 0.006), (2, "twice as many each way", 0.003)] {
        for (place, rise, integral) in strips(refinement)?.into_iter().step_by(2 * refinement) {
            rows.push(Row::relative(
                format!("largest temperature rise of the strip at {place:.2} b, full slip, {cells}"),
                "K",
                integral,
                rise,
                tolerance,
                "Carslaw and Jaeger, 2.9, by quadrature",
            ));
        }
    }
    let parameters = parameters(1);
    let run = steady(&parameters, 0.01)?;
    rows.push(Row::relative(
        "largest temperature rise on the circle at creepage 0.01",
        "K",
        FLASH_TEMPERATURE,
        run.state.outputs.peak_temperature - run.state.inputs.ambient_temperature,
        // CONTACT's own weight was corrected; it has 40 elements over the contact.
        0.02,
        "CONTACT, n = 40",
    ));
    Ok(rows)
}
