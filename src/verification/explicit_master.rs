//! Longest steps of an explicit master at low speed: wheel and contact take turns, each with the other's newest
//! value. Contact and wheel are a spring and a mass in series with a damper, so that the limit is that of the spring, at any speed:
//! an explicit master must be able to take steps of a millisecond.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource};
use crate::signals::Inputs;

const SOURCE: &str = "stability: the swing on the contact's spring dies down";
/// Moment of inertia of a driven wheelset's wheel, `kg m²`.
const INERTIA: f64 = 60.0;
const STEP: f64 = 1e-3;
const STEPS: usize = 400;

/// Largest torque that accelerates the wheel in the last quarter of the run, over that in the first: falls where the steps are
/// stable.
fn growth(speed: f64) -> Result<f64> {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    let inputs = |wheel_speed| Inputs {
        vehicle_speed: speed,
        wheel_speed,
        ..Inputs::default()
    };
    let rolling = speed / parameters.wheel_radius;
    let mut run = set_up::simulation(&parameters, &inputs(rolling))?;
    // A drive that asks for a third of what friction carries.
    let drive = parameters.friction_cold / 3.0 * Inputs::default().normal_load * parameters.wheel_radius;
    let mut wheel_speed = rolling;
    let mut torques = Vec::with_capacity(STEPS);
    for _ in 0..STEPS {
        let torque = drive + run.state.outputs.friction_torque;
        torques.push(torque.abs());
        wheel_speed += STEP * torque / INERTIA;
        run.hold(&inputs(wheel_speed), STEP, 1)?;
    }
    let swing = |part: &[f64]| part.iter().fold(0.0, |largest: f64, torque| largest.max(*torque));
    Ok(swing(&torques[3 * STEPS / 4..]) / swing(&torques[..STEPS / 4]))
}

/// Steps of a millisecond at 1 and at 0.1 m/s.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    [1.0, 0.1]
        .into_iter()
        .map(|speed| {
            Ok(Row::at_most(
                format!("swing after 0.3 s over that at the start, explicit master, 1 ms, {speed} m/s"),
                "1",
                0.5,
                growth(speed)?,
                SOURCE,
            ))
        })
        .collect()
}
