//! The paper's cases, section 5: penetration 0.1 mm, 10 m/s, constant μ and the temperature-dependent μ of the cases a,
//! b, c (θ_F = 150, 125, 100 °C), steady. The paper gives no slip and no heat partition; creepage 0.04 and ᾱ = 0.5 make
//! its temperatures. It finds peaks "lower up to 5–20 °C" in a–c, the pressure "highest in the middle", shear
//! that differs in front and behind, a temperature that falls fast with depth, and slower cooling behind the contact.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{Control, FrictionLaw, Parameters, SlipSource, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const PROTOTYPE: &str = "independent prototype, 61 nodes over 12 mm";
const PAPER: &str = "the paper, section 5";
/// Two discretisations of first order along x₁ with some 40 nodes in contact.
const TOLERANCE: f64 = 0.03;
/// 0 °C, the paper's ambient, `K`.
const AMBIENT: f64 = 273.15;

/// Name and hot temperature θ_F `°C` of the cases with a temperature-dependent coefficient.
pub const CASES: [(&str, f64); 3] = [("a", 150.0), ("b", 125.0), ("c", 100.0)];

/// Parameters of a case, the rigid wheel's: constant μ without a hot temperature `°C`.
pub fn parameters(hot: Option<f64>) -> Parameters {
    let mut parameters = Parameters {
        wheel: Wheel::Rigid,
        control: Control::Penetration,
        slip_source: SlipSource::VehicleSpeed,
        friction_law: FrictionLaw::Constant,
        slip_regularisation: 1e-3,
        ..Parameters::default()
    };
    if let Some(celsius) = hot {
        parameters.friction_law = FrictionLaw::PiecewiseLinear;
        parameters.friction_temperature_hot = AMBIENT + celsius;
        parameters.friction_temperature_cold = AMBIENT + 50.0;
    }
    parameters
}

/// Inputs at 10 m/s with the given creepage; −1 is the locked wheel.
pub fn inputs(creepage: f64) -> Inputs {
    Inputs {
        vehicle_speed: 10.0,
        wheel_speed: 10.0 * (1.0 + creepage) / Parameters::default().wheel_radius,
        ambient_temperature: AMBIENT,
        incoming_temperature: AMBIENT,
        ..Inputs::default()
    }
}

/// A case after two seconds, five passages of the strip.
///
/// # Errors
/// A solver that did not converge.
pub fn settled(parameters: &Parameters, creepage: f64) -> Result<Simulation> {
    let inputs = inputs(creepage);
    let mut run = set_up::simulation(parameters, &inputs)?;
    run.hold(&inputs, 1e-2, 200)?;
    Ok(run)
}

/// Peaks and drops, then what the paper says of the fields.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let constant = settled(&parameters(None), 0.04)?;
    let peak = |run: &Simulation| run.state.outputs.peak_temperature - AMBIENT;
    let mut rows = vec![Row::relative(
        "peak temperature rise, constant mu",
        "K",
        94.9,
        peak(&constant),
        TOLERANCE,
        PROTOTYPE,
    )];
    rows.extend(fields(&constant));
    for ((case, hot), drop) in CASES.into_iter().zip([11.6, 14.2, 18.5]) {
        let run = settled(&parameters(Some(hot)), 0.04)?;
        rows.push(Row::relative(
            format!("peak lower than at constant mu, case {case}"),
            "K",
            drop,
            peak(&constant) - peak(&run),
            TOLERANCE,
            PROTOTYPE,
        ));
        rows.push(Row::at_least(
            format!("temperature 5 mm behind the axle over peak, case {case}: not less than at constant mu"),
            "1",
            wake_share(&constant),
            wake_share(&run),
            PAPER,
        ));
    }
    Ok(rows)
}

/// Pressure, shear and depth profile of a settled case.
fn fields(run: &Simulation) -> Vec<Row> {
    let nodes = run.contact_nodes();
    let half_length = 0.5 * run.state.outputs.contact_length;
    let pressed: Vec<_> = nodes.iter().filter(|node| node.pressure > 0.0).collect();
    let crest = pressed.iter().fold((0.0, 0.0), |(x, p), node| {
        if node.pressure > p {
            (node.position, node.pressure)
        } else {
            (x, p)
        }
    });
    let resultant = |front: bool| -> f64 {
        let side = pressed
            .iter()
            .filter(|node| (node.position > 0.0) == front && node.position != 0.0);
        side.map(|node| node.shear.abs()).sum()
    };
    let profiles = run.model.profiles(&run.state);
    let rise = |i: usize| profiles.depth_temperature[i] - AMBIENT;
    let half = (0..profiles.depth.len()).find(|&i| rise(i) < 0.5 * rise(0));
    let half_depth = half.map_or(f64::NAN, |i| profiles.depth[i]);
    vec![
        Row::at_most(
            "distance of the peak pressure from the middle over half-length",
            "1",
            0.2,
            (crest.0 / half_length).abs(),
            PAPER,
        ),
        Row::at_least(
            "shear in front over shear behind, difference from 1",
            "1",
            0.05,
            (resultant(true) / resultant(false) - 1.0).abs(),
            PAPER,
        ),
        Row::at_most(
            "depth at which the temperature has halved",
            "m",
            0.2e-3,
            half_depth,
            PAPER,
        ),
        Row::at_most(
            "temperature 10 mm down over peak",
            "1",
            1e-3,
            rise(profiles.depth.len() - 1) / rise(0),
            PAPER,
        ),
    ]
}

/// Surface temperature 5 mm behind the axle, some 1 mm behind the contact, over the peak.
fn wake_share(run: &Simulation) -> f64 {
    let nodes = run.contact_nodes();
    let peak = nodes.iter().fold(0.0, |m: f64, node| node.temperature.max(m));
    let behind = nodes.iter().rev().find(|node| node.position <= -5e-3);
    behind.map_or(f64::NAN, |node| node.temperature) / peak
}
