//! The creepage of a rolling wheel jumps: in steps of any length T/(μN) goes the way that it goes in short steps, because the
//! step of ∂u₁/∂t is fitted to the exponential by which rolling forgets a change. Constant μ.

use super::row::{Row, larger};
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{Parameters, SlipSource, Wheel};
use crate::signals::Inputs;

const SOURCE: &str = "the same in steps of a fortieth of the half-length";
const SPEED: f64 = 1.0;
/// Half-lengths that the contact rolls after the jump.
const WAY: usize = 60;
/// Steps a half-length of the reference: of twice as many it differs by less than 0.001.
const FINE: usize = 40;
/// Creepages to which it jumps from 0, over that of saturation. The elastic wheel's mirror images give the same.
const JUMPS: [(Wheel, &[f64]); 2] = [
    (Wheel::Elastic, &[0.05, 0.5, 1.0]),
    (Wheel::Rigid, &[-1.0, -0.5, -0.05, 0.05, 0.5, 1.0]),
];

/// T/(μN) after the jump, at the end of every `half_lengths`, which take `steps`.
fn transient(wheel: Wheel, jump: f64, half_lengths: usize, steps: usize) -> Result<Vec<f64>> {
    let parameters = Parameters {
        wheel,
        slip_source: SlipSource::VehicleSpeed,
        ..mechanics_alone()
    };
    let half_length = parameters.hertz_half_length(Inputs::default().normal_load);
    let saturation = parameters.friction_cold * half_length / parameters.wheel_radius;
    let inputs = |creepage: f64| Inputs {
        vehicle_speed: SPEED,
        wheel_speed: SPEED * (1.0 + creepage) / parameters.wheel_radius,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(&parameters, &inputs(0.0))?;
    // Steady: nothing is left of the state before it.
    run.hold(&inputs(0.0), 1e3 * half_length / SPEED, 1)?;
    let step = half_lengths as f64 * half_length / SPEED / steps as f64;
    (0..WAY / half_lengths)
        .map(|_| {
            let outputs = run.hold(&inputs(jump * saturation), step, steps)?;
            Ok(outputs.traction_coefficient / parameters.friction_cold)
        })
        .collect()
}

/// Largest error of a wheel's T/(μN) after a jump, in steps of so many half-lengths.
fn error(wheel: Wheel, jump: f64, reference: &[f64], half_lengths: usize) -> Result<f64> {
    let values = transient(wheel, jump, half_lengths, 1)?;
    let at_the_same = reference.iter().skip(half_lengths - 1).step_by(half_lengths);
    Ok(values.iter().zip(at_the_same).fold(0.0, |worst, (value, reference)| {
        larger(worst, (value - reference).abs())
    }))
}

/// Steps from one half-length up to thirty.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut references = Vec::new();
    for (wheel, jumps) in JUMPS {
        for &jump in jumps {
            references.push((wheel, jump, transient(wheel, jump, 1, FINE)?));
        }
    }
    let mut rows = Vec::new();
    // As measured, rounded up. Worst where a step ends on the way to sliding, which comes sooner than the exponential says.
    for (half_lengths, tolerance) in [(1, 0.02), (2, 0.025), (6, 0.035), (10, 0.01), (30, 0.002)] {
        let mut worst: f64 = 0.0;
        for (wheel, jump, reference) in &references {
            worst = larger(worst, error(*wheel, *jump, reference, half_lengths)?);
        }
        rows.push(Row::absolute(
            format!("largest error of T/(mu N) after jumps of the creepage, steps of {half_lengths} half-lengths"),
            "1",
            0.0,
            worst,
            tolerance,
            SOURCE,
        ));
    }
    // Here a relaxation length that is off by a tenth, either way, is seen.
    for (wheel, jump, reference) in &references {
        if (*wheel, *jump) == (Wheel::Elastic, 0.5) {
            rows.push(Row::absolute(
                "the same, elastic wheel to half of saturation, steps of 2 half-lengths",
                "1",
                0.0,
                error(*wheel, *jump, reference, 2)?,
                0.005,
                SOURCE,
            ));
        }
    }
    Ok(rows)
}
