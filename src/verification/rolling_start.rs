//! A contact that has stood still begins to roll at a creepage: from Cattaneo's distribution to Carter's, over some contact
//! lengths (Kalker, Three-Dimensional Elastic Bodies in Rolling Contact, 1990, chapter 5). Like bodies, constant μ. Against
//! the same on twice the nodes in steps of an eightieth of the half-length, and Carter's limit at its end.

use super::carter;
use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::numerics::dense::largest_change;
use crate::parameters::{Parameters, SlipSource, Wheel};
use crate::signals::Inputs;

const SOURCE: &str = "the same in finer steps on finer nodes";
const SPEED: f64 = 1.0;
/// Half-lengths that the contact rolls.
const WAY: usize = 30;

fn parameters(contact_nodes: usize) -> Parameters {
    Parameters {
        wheel: Wheel::Elastic,
        slip_source: SlipSource::VehicleSpeed,
        contact_nodes,
        ..mechanics_alone()
    }
}

/// Half the creepage of saturation.
fn creepage(parameters: &Parameters, load: f64) -> f64 {
    0.5 * parameters.friction_cold * parameters.hertz_half_length(load) / parameters.wheel_radius
}

/// T/(μN) after each half-length, in so many steps a half-length.
fn transient(contact_nodes: usize, steps: usize) -> Result<Vec<f64>> {
    let parameters = parameters(contact_nodes);
    let rest = Inputs {
        wheel_speed: 0.0,
        vehicle_speed: 0.0,
        ..Inputs::default()
    };
    let rolling = Inputs {
        vehicle_speed: SPEED,
        wheel_speed: SPEED * (1.0 + creepage(&parameters, rest.normal_load)) / parameters.wheel_radius,
        ..rest
    };
    let half_length = parameters.hertz_half_length(rest.normal_load);
    let step = half_length / SPEED / steps as f64;
    let mut run = set_up::simulation(&parameters, &rest)?;
    let mut values = Vec::new();
    for _ in 0..WAY {
        let outputs = run.hold(&rolling, step, steps)?;
        values.push(outputs.traction_coefficient / parameters.friction_cold);
    }
    Ok(values)
}

/// The transient in steps of a tenth and a half of the half-length, and its end.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let default = Parameters::default().contact_nodes;
    let fine = transient(2 * default - 1, 80)?;
    let mut rows = Vec::new();
    for (steps, tolerance) in [(10, 0.01), (2, 0.02)] {
        rows.push(Row::absolute(
            format!("largest error of T/(mu N) while rolling begins, {steps} steps a half-length"),
            "1",
            0.0,
            largest_change(&transient(default, steps)?, &fine),
            tolerance,
            SOURCE,
        ));
    }
    let parameters = parameters(default);
    let load = Inputs::default().normal_load;
    let stick = carter::stick_share(&parameters, load, creepage(&parameters, load));
    rows.push(Row::absolute(
        "T/(mu N) after 30 half-lengths",
        "1",
        1.0 - stick * stick,
        fine[WAY - 1],
        carter::TRACTION_TOLERANCE,
        "Carter 1926",
    ));
    Ok(rows)
}
