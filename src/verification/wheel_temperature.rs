//! The wheel's rim as one heat capacity: under a constant friction power P it warms as
//! T_w = T_a + (1 − ᾱ) P/(h A) (1 − exp(−t/t_w)), t_w = C/(h A), and lifted it cools as T_a + (T_w − T_a) exp(−t/t_w), with
//! C and A of the ring (`rim_depth`, `rim_width`). What it wears is k_w ∫∫ |s| p dA dt, spread over the circumference.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{Parameters, WheelHeating};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::PI;

const SOURCE: &str = "C dT/dt = (1 - alpha) P - h A (T - T_a)";
/// Steps in one time constant of the rim.
const STEPS: usize = 100;

/// A thin ring that cools fast. Nothing but friction warms it, and the friction power is constant: no conduction, and
/// neither heat nor wear in the gap.
fn parameters() -> Parameters {
    Parameters {
        contact_thermal_resistance: 1e12,
        wheel_heating: WheelHeating::On,
        heat_partition: 0.6,
        wheel_density: 7e3,
        wheel_heat_capacity: 500.0,
        rim_depth: 2e-3,
        rim_width: 5e-3,
        wheel_heat_transfer: 200.0,
        ..mechanics_alone()
    }
}

/// C `J/K` and h A `W/K` of the ring with outer radius 0.46 m, written out.
fn ring() -> (f64, f64) {
    let (outer, inner, width) = (0.46_f64, 0.458_f64, 5e-3);
    let section = PI * (outer * outer - inner * inner);
    (
        7e3 * 500.0 * section * width,
        200.0 * (2.0 * PI * outer * width + 2.0 * section),
    )
}

/// Warm-up, cool-down, the order of both in time, and the wear.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    // Implicit Euler lags by half a step, Δt/(2 t_w) of the rise for each time constant: twice that is allowed.
    let tolerance = 1.0 / STEPS as f64;
    for (constants, warmed, cooled) in history(STEPS)? {
        rows.push(Row::relative(
            format!("wheel over ambient, {constants} time constants after the start"),
            "K",
            warmed.0,
            warmed.1,
            tolerance,
            SOURCE,
        ));
        rows.push(Row::relative(
            format!("wheel over ambient, lifted since {constants} time constants"),
            "K",
            cooled.0,
            cooled.1,
            tolerance * constants,
            SOURCE,
        ));
    }
    let error = |steps| -> Result<f64> {
        let (_, warmed, cooled) = history(steps)?[0];
        Ok((warmed.1 / warmed.0 - 1.0).abs() + (cooled.1 / cooled.0 - 1.0).abs())
    };
    rows.push(Row::absolute(
        "order of the wheel's temperature in the step",
        "1",
        1.0,
        (error(STEPS / 4)? / error(STEPS / 2)?).log2(),
        0.15,
        "implicit Euler",
    ));
    rows.push(wear()?);
    Ok(rows)
}

/// Time in constants, and expected and computed rise after it, warming and then cooling, `K`.
type Instant = (f64, (f64, f64), (f64, f64));

/// The rim after 1 and 2 time constants of sliding and as many of being lifted.
fn history(steps: usize) -> Result<Vec<Instant>> {
    let (capacity, convection) = ring();
    let constant = capacity / convection;
    let parameters = parameters();
    let sliding = Inputs {
        creepage: 0.02,
        ..Inputs::default()
    };
    let lifted = Inputs {
        normal_load: 0.0,
        ..sliding
    };
    let mut instants = Vec::new();
    for constants in [1_u8, 2] {
        let count = usize::from(constants) * steps;
        let mut run = set_up::simulation(&parameters, &sliding)?;
        let rise = |run: &Simulation| run.state.outputs.wheel_temperature - sliding.ambient_temperature;
        let power = run.hold(&sliding, constant / steps as f64, count)?.friction_power;
        let limit = (1.0 - parameters.heat_partition) * power / convection;
        let share = (-f64::from(constants)).exp();
        let warm = rise(&run);
        run.hold(&lifted, constant / steps as f64, count)?;
        instants.push((
            f64::from(constants),
            (limit * (1.0 - share), warm),
            (warm * share, rise(&run)),
        ));
    }
    Ok(instants)
}

/// Volume lost by the wheel over one slide whose load and creepage change.
fn wear() -> Result<Row> {
    let parameters = Parameters {
        wheel_wear_coefficient: 2e-13,
        ..Parameters::default()
    };
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let (duration, mut volume) = (1e-3, 0.0);
    let area = parameters.contact_width * run.model.line_operators()?.mesh.contact_spacing();
    for step in 0..50 {
        let inputs = Inputs {
            creepage: 4e-4 * f64::from(step),
            normal_load: 60e3 + 300.0 * f64::from(step % 7),
            ..Inputs::default()
        };
        run.step(&inputs, duration)?;
        let sum: f64 = run
            .contact_nodes()
            .iter()
            .map(|node| node.slip.abs() * node.pressure)
            .sum();
        volume += 2e-13 * area * sum * duration;
    }
    Ok(Row::relative(
        "volume lost by the wheel, 2 pi r0 b wheel_wear_depth",
        "m3",
        volume,
        2.0 * PI * 0.46 * parameters.contact_width * run.state.outputs.wheel_wear_depth,
        1e-12,
        "Archard: k_w times sliding work, summed over the nodes",
    ))
}
