//! Friction that falls with slip, and that remembers.
//!
//! Where all slides at the velocity w = ξ V the law is that of one point: T/N = μ₀ f(w). With a memory of length d_c the coefficient falls
//! along the contact as μ₀ (f + (1 − f) exp(−ξ (a − x)/d_c)), and under Hertz's pressure of a line
//!
//! T/(μ₀N) = f + (1 − f) 2 I₁(κ)/κ exp(−κ),  κ = ξ a/d_c.
//!
//! Where friction falls as fast with slip as a cell unloads by it, a contact without memory has several solutions, or an iteration finds
//! none: what comes out depends on start, step and iteration. With a memory it does not. Friction that falls steeply with temperature is
//! unique here even without one: each column's temperature is solved together with its coefficient.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{ContactModel, FrictionLaw, Parameters};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::simulation::Simulation;
use crate::wheel_rail::Model;
use std::sync::Arc;

const MODELS: [(ContactModel, &str); 2] = [(ContactModel::Line, "line"), (ContactModel::Patch, "patch")];
/// Tolerance of full slip: what elasticity adds at the leading edge, on less than a cell.
const SLIDING_TOLERANCE: f64 = 0.003;
/// Tolerance of the coefficient along the contact: the leading edge falls between two nodes.
const MEMORY_TOLERANCE: f64 = 0.01;
/// The answers of different starts, steps and iterations: their tolerances.
const UNIQUE: f64 = 1e-6;
/// Relative difference above which two values are called different.
const DIFFERENT: f64 = 1e-4;

/// A = 0.3 and B, with d_c.
fn parameters(contact_model: ContactModel, decay: f64, distance: f64) -> Parameters {
    Parameters {
        contact_model,
        friction_slip_share: 0.3,
        friction_slip_decay: decay,
        friction_memory_distance: distance,
        ..mechanics_alone()
    }
}

fn inputs(speed: f64, creepage: f64) -> Inputs {
    Inputs {
        wheel_speed: speed * (1.0 + creepage) / Parameters::default().wheel_radius,
        creepage,
        ..Inputs::default()
    }
}

/// e^{−κ} 2 I₁(κ)/κ by its series.
fn fading(kappa: f64) -> f64 {
    let (mut term, mut sum) = (1.0, 0.0);
    for k in 0..60 {
        sum += term;
        term *= 0.25 * kappa * kappa / (f64::from(k + 1) * f64::from(k + 2));
    }
    (-kappa).exp() * sum
}

/// Speed at which answers are compared, `m/s`.
const SPEED: f64 = 40.0;

/// T/N over μ₀ at [`SPEED`] that different starts, steps and iterations lead to; none for those that lead nowhere.
fn answers(parameters: &Parameters, creepage: f64) -> Result<Vec<Option<f64>>> {
    let mut plain = Settings::strict();
    plain.split.accelerate_after = usize::MAX;
    let mut answers = Vec::new();
    for settings in [Settings::strict(), plain] {
        let model = Arc::new(Model::with_settings(parameters.clone(), settings)?);
        for (step, steps) in [(0.1, 5), (2e-3, 50)] {
            for start in [creepage, 0.2, 1e-4] {
                let end = || -> Result<f64> {
                    let mut run = Simulation::of(model.clone(), &inputs(SPEED, start))?;
                    run.hold(&inputs(SPEED, start), step, steps)?;
                    let outputs = run.hold(&inputs(SPEED, creepage), step, steps)?;
                    Ok(outputs.traction_coefficient / parameters.friction_cold)
                };
                answers.push(end().ok());
            }
        }
    }
    Ok(answers)
}

/// The largest distance of two answers; infinite where there was none.
fn spread(answers: &[Option<f64>]) -> f64 {
    let all = answers.iter().map(|answer| answer.unwrap_or(f64::INFINITY));
    let largest = all.clone().fold(f64::NEG_INFINITY, f64::max);
    largest - all.fold(f64::INFINITY, f64::min)
}

/// Starts that do not lead to the first answer there is.
fn others(answers: &[Option<f64>]) -> f64 {
    let first = answers.iter().flatten().next().copied();
    let same = |answer: &f64| first.is_some_and(|first| (answer - first).abs() < DIFFERENT);
    answers
        .iter()
        .filter(|answer| !answer.as_ref().is_some_and(same))
        .count() as f64
}

/// Full slip, then the memory of a sliding contact, then the answers.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let (speed, creepage) = (10.0, 0.1);
    for (contact_model, name) in MODELS {
        let sliding = |distance: f64| -> Result<f64> {
            let parameters = parameters(contact_model, 0.7, distance);
            let run = set_up::simulation(&parameters, &inputs(speed, creepage))?;
            Ok(run.outputs().traction_coefficient / parameters.friction_cold)
        };
        let slides = speed * creepage;
        let factor = 0.3 + 0.7 * (-0.7 * slides).exp();
        rows.push(Row::absolute(
            format!("{name}: T/(mu N) at a slip of 1 m/s, A = 0.3, B = 0.7 s/m"),
            "1",
            factor,
            sliding(0.0)?,
            SLIDING_TOLERANCE,
            "Polach 2005",
        ));
        if contact_model == ContactModel::Line {
            let distance = 1e-3;
            let half_length = Parameters::default().hertz_half_length(Inputs::default().normal_load);
            rows.push(Row::absolute(
                format!("{name}: the same with a memory of 1 mm"),
                "1",
                factor + (1.0 - factor) * fading(creepage * half_length / distance),
                sliding(distance)?,
                MEMORY_TOLERANCE,
                "closed form",
            ));
        }
    }
    // Twelve answers each: cold, from slip and from stick, by two steps, with and without acceleration.
    for (contact_model, name) in MODELS {
        for creepage in [0.001, 0.003] {
            let case = format!("{name}: B = 20 s/m at {SPEED} m/s, creepage {creepage}");
            let with = answers(&parameters(contact_model, 20.0, 1e-6), creepage)?;
            rows.push(Row::at_most(
                format!("{case}, memory of 1 um: spread of 12 answers"),
                "1",
                UNIQUE,
                spread(&with),
                "unique",
            ));
        }
        // A line's friction is found from every start, memory or not.
        if contact_model == ContactModel::Patch {
            let without = answers(&parameters(contact_model, 20.0, 0.0), 0.002)?;
            rows.push(Row::at_least(
                format!("{name}: the same at creepage 0.002 without memory: answers that differ or fail, of 12"),
                "1",
                1.0,
                others(&without),
                "not unique",
            ));
        }
        // 0.35 within half a kelvin.
        let steep = |distance| Parameters {
            friction_law: FrictionLaw::PiecewiseLinear,
            friction_hot: 0.1,
            friction_temperature_cold: 343.15,
            friction_temperature_hot: 343.65,
            friction_slip_share: 1.0,
            ..parameters(contact_model, 0.0, distance)
        };
        for (distance, memory) in [(1e-7, "memory of 0.1 um"), (0.0, "without memory")] {
            rows.push(Row::at_most(
                format!("{name}: mu falls by 0.35 within 0.5 K, {memory}: spread of 12 answers"),
                "1",
                UNIQUE,
                spread(&answers(&steep(distance), 0.01)?),
                "unique",
            ));
        }
    }
    Ok(rows)
}
