//! Mirrored motion (V, ω → −V, −ω) gives mirrored fields, T → −T: to round-off, because the mesh is its own mirror
//! image, diagonals included.

use super::{Row, Run};
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource};
use crate::signals::Inputs;

const SOURCE: &str = "symmetry of the equations";
/// The solvers rest at 1e-11 of the peak pressure and 1e-10 of the temperature; both runs take the same path to it.
const TOLERANCE: f64 = 1e-10;

/// Largest difference of each field from its mirror image, relative to the field's largest value.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let (forward, backward) = (braking(1.0)?, braking(-1.0)?);
    let (nodes, mut mirrored) = (forward.contact_nodes(), backward.contact_nodes());
    mirrored.reverse();
    let row = |name: &str, pairs: &mut dyn Iterator<Item = (f64, f64)>| {
        let (mut difference, mut largest) = (0.0_f64, 0.0_f64);
        for (a, b) in pairs {
            largest = largest.max(a.abs());
            // f64::max would pass over NaN.
            let own = (a - b).abs();
            difference = if own <= difference { difference } else { own };
        }
        Row::absolute(
            format!("{name}, difference to the mirror image"),
            "1",
            0.0,
            difference / largest,
            TOLERANCE,
            SOURCE,
        )
    };
    let pairs = || nodes.iter().zip(&mirrored);
    let outputs = (&forward.state.outputs, &backward.state.outputs);
    let rail = forward.model.rail();
    let columns = rail.mesh.columns();
    let surface = |run: &Run, column: usize| run.state.fields.surface_temperature[column];
    Ok(vec![
        row("pressure", &mut pairs().map(|(a, b)| (a.pressure, b.pressure))),
        row("shear traction", &mut pairs().map(|(a, b)| (a.shear, -b.shear))),
        row("slip velocity", &mut pairs().map(|(a, b)| (a.slip, -b.slip))),
        row(
            "surface temperature",
            &mut (0..columns).map(|c| (surface(&forward, c), surface(&backward, columns - 1 - c))),
        ),
        row(
            "wear depth",
            &mut (0..columns).map(|c| {
                (
                    forward.state.fields.wear[c],
                    backward.state.fields.wear[columns - 1 - c],
                )
            }),
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
            "contact offset",
            &mut [(outputs.0.contact_offset, -outputs.1.contact_offset)].into_iter(),
        ),
    ])
}

/// From rolling into a slide of 8 %, in the given direction.
fn braking(direction: f64) -> Result<Run> {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    let inputs = |slide: f64| Inputs {
        vehicle_speed: 10.0 * direction,
        wheel_speed: 10.0 * direction * (1.0 - slide) / parameters.wheel_radius,
        ..Inputs::default()
    };
    let mut run = Run::new(&parameters, &inputs(0.0))?;
    for step in 0..40 {
        run.step(&inputs(0.002 * f64::from(step)), 2e-3)?;
    }
    Ok(run)
}
