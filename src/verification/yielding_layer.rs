//! A layer between wheel and rail that flows: the shear is at most min(μp, τ_c0 + k u_pl).
//!
//! Where all slides and the layer does not harden, the shear is μp near the edges of Hertz's contact and τ_c0 between them. With r = τ_c0/(μp₀)
//! and c = √(1 − r²)
//!
//! T/(μN) = (2/π)(c r + arccos c) of a line,  1.5 r − 0.5 r³ of an ellipse.
//!
//! On a layer that is far more compliant than the bodies a particle that came in at the distance y behind it has been sheared by ξ y, under
//! the creepage ξ: by c τ + u_pl as long as the surfaces stick. Hence
//!
//! τ = min(ξ y/c, (τ_c0 + k ξ y)/(1 + k c), μp)
//!
//! on every strip along the rail, summed here over so many points that the sum is exact. A motion that has been rolled into, step by step, ends in
//! the same; and what the tractions work is what heats.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters};
use crate::signals::Inputs;
use std::f64::consts::{FRAC_2_PI, PI};

const MODELS: [(ContactModel, &str); 2] = [(ContactModel::Line, "line"), (ContactModel::Patch, "patch")];
/// τ_c0/(μp₀).
const SHARES: [f64; 4] = [0.2, 0.5, 0.8, 1.2];
/// Tolerances of full slip, line and patch: what elasticity adds at the leading edge, and the corners between two
/// nodes; of a patch besides the share of the edge's cells in its area, on which the shear is uniform.
const SLIDING_TOLERANCES: [f64; 2] = [0.002, 0.006];
/// c over the compliance of the bodies is some 100.
const BRISTLES: f64 = 4e-12;
/// k c of a layer that does not harden, one that hardens by a third of its elastic stiffness, and one that hardly flows.
const HARDENING: [f64; 3] = [0.0, 0.3, 3.0];
const CREEPAGES: [f64; 3] = [0.05, 0.1, 0.3];
/// Tolerance as bristles: what the bodies add, 1 % of the layer's displacement, and the cell at the leading edge.
const BRISTLE_TOLERANCE: f64 = 0.006;
/// A march of steps against steady rolling: the exponential of the rolled way.
const MARCH_TOLERANCE: f64 = 1e-6;
/// The work at the edges between two nodes.
const POWER_TOLERANCE: f64 = 2e-3;
/// Points of the sums, along and across.
const POINTS: usize = 2000;

/// Hertz's half-length and peak pressure.
fn hertz(parameters: &Parameters) -> (f64, f64) {
    let load = Inputs::default().normal_load;
    match parameters.contact_model {
        ContactModel::Line => (parameters.hertz_half_length(load), parameters.hertz_peak_pressure(load)),
        ContactModel::Patch | ContactModel::Profiles => {
            let ellipse = parameters.hertz_ellipse(load);
            (ellipse.along, ellipse.peak_pressure)
        }
    }
}

/// A layer that yields at this share of the surfaces' largest bound.
fn parameters(contact_model: ContactModel, share: f64, compliance: f64, hardening: f64) -> Parameters {
    let plain = Parameters {
        contact_model,
        layer_compliance: compliance,
        ..mechanics_alone()
    };
    let (_, pressure) = hertz(&plain);
    Parameters {
        layer_yield_stress: share * plain.friction_cold * pressure,
        layer_hardening: hardening,
        ..plain
    }
}

fn inputs(creepage: f64) -> Inputs {
    Inputs {
        creepage,
        ..Inputs::default()
    }
}

/// T/(μN) of steady rolling.
fn rolling(parameters: &Parameters, creepage: f64) -> Result<f64> {
    let run = set_up::simulation(parameters, &inputs(creepage))?;
    Ok(run.outputs().traction_coefficient / parameters.friction_cold)
}

/// T/(μN) where all slides, at τ_c0/(μp₀).
fn sliding(contact_model: ContactModel, share: f64) -> f64 {
    let r = share.min(1.0);
    match contact_model {
        ContactModel::Line => {
            let c = (1.0 - r * r).sqrt();
            FRAC_2_PI * (c * r + c.acos())
        }
        ContactModel::Patch | ContactModel::Profiles => 1.5 * r - 0.5 * r * r * r,
    }
}

/// T/(μN) of bristles.
fn bristles(parameters: &Parameters, creepage: f64) -> f64 {
    let (half_length, pressure) = hertz(parameters);
    let bound = parameters.friction_cold * pressure;
    let (compliance, hardening) = (parameters.layer_compliance, parameters.layer_hardening);
    // The mean over a strip at a share `width` of the half-breadth, over that of the bound on a strip through the middle.
    let strip = |across: f64| {
        let width = (1.0 - across * across).sqrt();
        let mean = (0..POINTS).map(|i| {
            let behind = 2.0 * (i as f64 + 0.5) / POINTS as f64;
            let moved = creepage * half_length * width * behind;
            let flows = (parameters.layer_yield_stress + hardening * moved) / (1.0 + hardening * compliance);
            let slides = bound * width * (behind * (2.0 - behind)).sqrt();
            (moved / compliance).min(flows).min(slides) / bound
        });
        width * mean.sum::<f64>() * 2.0 / POINTS as f64
    };
    match parameters.contact_model {
        ContactModel::Line => FRAC_2_PI * strip(0.0),
        ContactModel::Patch | ContactModel::Profiles => {
            let strips = (0..POINTS).map(|i| strip((i as f64 + 0.5) / POINTS as f64));
            // The integral over half the breadth, of which there are two, over ⅔π.
            2.0 * strips.sum::<f64>() / POINTS as f64 * 1.5 / PI
        }
    }
}

/// Both engines against the closed forms.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for ((contact_model, name), sliding_tolerance) in MODELS.into_iter().zip(SLIDING_TOLERANCES) {
        for share in SHARES {
            rows.push(Row::absolute(
                format!("{name}: T/(mu N) where all slides, tau_c/(mu p0) = {share}"),
                "1",
                sliding(contact_model, share),
                rolling(&parameters(contact_model, share, 0.0, 0.0), 0.2)?,
                sliding_tolerance,
                "closed form",
            ));
        }
        for relative in HARDENING {
            let layer = parameters(contact_model, 0.3, BRISTLES, relative / BRISTLES);
            for creepage in CREEPAGES {
                rows.push(Row::absolute(
                    format!("{name}: T/(mu N) of bristles that yield, k c = {relative}, creepage {creepage}"),
                    "1",
                    bristles(&layer, creepage),
                    rolling(&layer, creepage)?,
                    BRISTLE_TOLERANCE,
                    "bed of elastic-plastic bristles",
                ));
            }
        }
        rows.extend(rolled_into(contact_model, name)?);
    }
    Ok(rows)
}

/// Steady rolling by steps, and its power.
fn rolled_into(contact_model: ContactModel, name: &str) -> Result<Vec<Row>> {
    let layer = parameters(contact_model, 0.3, 1.5e-13, 2e12);
    let creepage = 0.02;
    let steady = rolling(&layer, creepage)?;
    let mut rows = Vec::new();
    // Some three cells and a third of one in a step.
    for (duration, steps) in [(1e-4, 300), (1e-5, 3000)] {
        let mut run = set_up::simulation(&layer, &inputs(1e-3))?;
        run.hold(&inputs(creepage), duration, steps)?;
        let outputs = run.outputs();
        rows.push(Row::absolute(
            format!("{name}: T/(mu N) after 30 ms in steps of {duration} s on a layer that hardens"),
            "1",
            steady,
            outputs.traction_coefficient / layer.friction_cold,
            MARCH_TOLERANCE,
            "steady rolling",
        ));
        let inputs = inputs(creepage);
        let motion = inputs.motion(&layer);
        let work = outputs.traction_force * motion.rigid_slip;
        rows.push(Row::relative(
            format!("{name}: friction power in steps of {duration} s on a layer that hardens"),
            "W",
            work,
            outputs.friction_power,
            POWER_TOLERANCE,
            "T times the slip of the wheel",
        ));
    }
    Ok(rows)
}
