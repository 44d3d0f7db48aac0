//! Carter's theory of the rolling line contact with constant μ (Carter 1926; Johnson, Contact Mechanics, section 8.3):
//! a stick zone of length 2a(1 − ξ r₀/(μ a)) at the leading edge, and
//! T/(μN) = 1 − (1 − ξ r₀/(μ a))² up to ξ = μ a/r₀, 1 beyond.
//!
//! Carter's bodies are alike, so that pressure moves no surface along x₁: the mixed compliances are switched off. The
//! rigid wheel takes the part of its mirror image, which makes the creepage of two like bodies that of a rigid wheel.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::friction::coulomb;
use crate::parameters::{Parameters, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const SOURCE: &str = "Carter 1926; Johnson, Contact Mechanics, 8.3";
/// Creepages of the curve.
pub const CREEPAGES: [f64; 8] = [0.0, 0.0005, 0.001, 0.002, 0.003, 0.004, 0.006, 0.01];
/// The leading edge is resolved within its cell; the end of the stick zone falls between two nodes.
pub const TRACTION_TOLERANCE: f64 = 0.004;
/// A step after which nothing is left of the state before it: each is a steady state.
pub const PASSAGE: f64 = 0.5;
/// Creepage at which the stick zone is measured.
const STICK_CREEPAGE: f64 = 0.002;

/// Constant μ, the rigid wheel without coupling, no heat or wear in the gap.
pub fn parameters() -> Parameters {
    Parameters {
        wheel: Wheel::Rigid,
        normal_tangential_coupling: false,
        ..mechanics_alone()
    }
}

/// c/a = 1 − ξ r₀/(μ a), at least 0: the half-length of the stick zone over that of the contact.
pub fn stick_share(parameters: &Parameters, load: f64, creepage: f64) -> f64 {
    let saturation = parameters.friction_cold * parameters.hertz_half_length(load) / parameters.wheel_radius;
    (1.0 - creepage / saturation).max(0.0)
}

/// Carter's T/(μN).
fn traction_share(parameters: &Parameters, load: f64, creepage: f64) -> f64 {
    1.0 - stick_share(parameters, load, creepage).powi(2)
}

/// The creep curve in steps of 1e-4: creepage, T/(μN), Carter's.
///
/// # Errors
/// A solver that did not converge.
pub fn curve() -> Result<Vec<Vec<f64>>> {
    let parameters = parameters();
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let mut points = Vec::new();
    for step in 0..=60 {
        let inputs = Inputs {
            creepage: 1e-4 * f64::from(step),
            ..Inputs::default()
        };
        let computed = run.hold(&inputs, PASSAGE, 1)?.traction_coefficient / parameters.friction_cold;
        let carter = traction_share(&parameters, inputs.normal_load, inputs.creepage);
        points.push(vec![inputs.creepage, computed, carter]);
    }
    Ok(points)
}

/// The creep curve, then length and position of the stick zone.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let parameters = parameters();
    let inputs = |creepage| Inputs {
        creepage,
        ..Inputs::default()
    };
    let load = inputs(0.0).normal_load;
    let mut run = set_up::simulation(&parameters, &inputs(0.0))?;
    let mut rows = Vec::new();
    for creepage in CREEPAGES {
        let outputs = run.hold(&inputs(creepage), PASSAGE, 1)?;
        rows.push(Row::absolute(
            format!("T/(mu N) at creepage {creepage}"),
            "1",
            traction_share(&parameters, load, creepage),
            outputs.traction_coefficient / parameters.friction_cold,
            TRACTION_TOLERANCE,
            SOURCE,
        ));
    }
    rows.extend(stick_zone(&mut run, &inputs(STICK_CREEPAGE))?);
    Ok(rows)
}

/// Length and ends of the zone in which the nodes stick; each node stands for one spacing. Were there two zones, length and
/// ends would contradict each other.
fn stick_zone(run: &mut Simulation, inputs: &Inputs) -> Result<Vec<Row>> {
    run.hold(inputs, PASSAGE, 1)?;
    let parameters = run.model.parameters();
    let spacing = run.model.line_operators()?.mesh.contact_spacing();
    let half_length = parameters.hertz_half_length(inputs.normal_load);
    let expected = 2.0 * half_length * stick_share(parameters, inputs.normal_load, inputs.creepage);

    let nodes = run.contact_nodes();
    let sticks: Vec<f64> = nodes
        .iter()
        .filter(|node| node.pressure > 0.0)
        .filter(|node| coulomb::sticks(node.utilisation, parameters.slip_regularisation))
        .map(|node| node.position)
        .collect();
    let rear = sticks.first().copied().unwrap_or(f64::NAN) - 0.5 * spacing;
    let front = sticks.last().copied().unwrap_or(f64::NAN) + 0.5 * spacing;
    let row = |quantity: &str, reference, computed| {
        let quantity = format!("{quantity} at creepage {STICK_CREEPAGE}");
        Row::absolute(quantity, "m", reference, computed, spacing, SOURCE)
    };
    Ok(vec![
        row(
            "length of the stick zone (number of nodes by spacing)",
            expected,
            sticks.len() as f64 * spacing,
        ),
        row("leading end of the stick zone", half_length, front),
        row("trailing end of the stick zone", half_length - expected, rear),
    ])
}
