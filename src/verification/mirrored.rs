//! Mirrored motion (V, ω → −V, −ω) gives mirrored fields, T → −T: to round-off, because the mesh is its own mirror
//! image, diagonals included.

use super::row::{Row, largest_difference};
use super::set_up;
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource, Wheel, WheelHeating};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const SOURCE: &str = "symmetry of the equations";
/// Round-off alone: both runs go through the same iterations, so that it does not matter how exactly the solvers solve.
const TOLERANCE: f64 = 1e-10;

/// Largest difference of each field from its mirror image, relative to the field's largest value.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let paper = Parameters {
        wheel: Wheel::Rigid,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    // A softer wheel, so that normal and tangential problem stay coupled; a short strip, so that what comes in arrives.
    let warm = Parameters {
        wheel: Wheel::Elastic,
        wheel_shear_modulus: 0.5 * paper.wheel_shear_modulus,
        wheel_heating: WheelHeating::On,
        rim_depth: 1e-3,
        rim_width: 1e-3,
        wheel_wear_coefficient: 1e-12,
        strip_half_length: 0.2,
        ..paper.clone()
    };
    let mut rows = pair("rigid cold wheel", &paper)?;
    rows.extend(pair("elastic warm wheel", &warm)?);
    Ok(rows)
}

/// One pair, rolling both ways.
fn pair(pair: &str, parameters: &Parameters) -> Result<Vec<Row>> {
    let (forward, backward) = (braking(parameters, 1.0)?, braking(parameters, -1.0)?);
    let (nodes, mut mirrored) = (forward.contact_nodes(), backward.contact_nodes());
    mirrored.reverse();
    let row = |name: &str, pairs: &mut dyn Iterator<Item = (f64, f64)>| {
        Row::absolute(
            format!("{name}, difference to the mirror image, {pair}"),
            "1",
            0.0,
            largest_difference(pairs),
            TOLERANCE,
            SOURCE,
        )
    };
    let pairs = || nodes.iter().zip(&mirrored);
    let outputs = (&forward.state.outputs, &backward.state.outputs);
    let columns = forward.model.line_operators()?.mesh.columns();
    let fields = (forward.state.fields()?, backward.state.fields()?);
    Ok(vec![
        row("pressure", &mut pairs().map(|(a, b)| (a.pressure, b.pressure))),
        row("shear traction", &mut pairs().map(|(a, b)| (a.shear, -b.shear))),
        row("slip velocity", &mut pairs().map(|(a, b)| (a.slip, -b.slip))),
        row(
            "surface temperature",
            &mut (0..columns).map(|c| {
                (
                    fields.0.surface_temperature[c],
                    fields.1.surface_temperature[columns - 1 - c],
                )
            }),
        ),
        row(
            "wear depth",
            &mut (0..columns).map(|c| (fields.0.wear[c], fields.1.wear[columns - 1 - c])),
        ),
        row(
            "traction force and friction torque",
            &mut [
                (outputs.0.traction_force, -outputs.1.traction_force),
                (outputs.0.friction_torque, -outputs.1.friction_torque),
            ]
            .into_iter(),
        ),
        row(
            "contact offset over contact length",
            &mut [
                (outputs.0.contact_offset, -outputs.1.contact_offset),
                (outputs.0.contact_length, outputs.1.contact_length),
            ]
            .into_iter(),
        ),
        row(
            "wheel temperature",
            &mut [(outputs.0.wheel_temperature, outputs.1.wheel_temperature)].into_iter(),
        ),
        row(
            "leaving temperature",
            &mut [(outputs.0.leaving_temperature, outputs.1.leaving_temperature)].into_iter(),
        ),
        row(
            "leaving wear depth",
            &mut [(outputs.0.leaving_wear_depth, outputs.1.leaving_wear_depth)].into_iter(),
        ),
    ])
}

/// Simulation from rolling into a slide of 8 %, in the given direction.
fn braking(parameters: &Parameters, direction: f64) -> Result<Simulation> {
    let inputs = |slide: f64| Inputs {
        vehicle_speed: 10.0 * direction,
        wheel_speed: 10.0 * direction * (1.0 - slide) / parameters.wheel_radius,
        incoming_temperature: 310.0,
        incoming_wear_depth: 1e-7,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(parameters, &inputs(0.0))?;
    for step in 0..40 {
        run.step(&inputs(0.002 * f64::from(step)), 2e-3)?;
    }
    Ok(run)
}
