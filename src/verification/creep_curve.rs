//! Accuracy by the number of nodes: the creep curve T/(μN) with Coulomb's law and constant μ, over creepages from −0.5 % to 0.5 %,
//! against the limit of fine nodes, for both kinds of wheel; the creepage at which a rigid wheel rolls freely; and friction that
//! depends on temperature, in partial slip, against the same limit.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::numerics::dense::largest_change;
use crate::parameters::{Parameters, Wheel};
use crate::signals::{Inputs, Outputs};

const SOURCE: &str = "the same on 401 nodes";
/// Nodes of the limit: its own error is a fifth of that at 121.
const FINE: usize = 401;
/// Loads whose contacts end at different places between the nodes, `N`.
const LOADS: [f64; 3] = [45e3, 60e3, 83e3];
/// Longer than any way that a change is remembered on: each step is a steady state of the mechanics.
const PASSAGE: f64 = 0.5;

fn parameters(wheel: Wheel, contact_nodes: usize) -> Parameters {
    Parameters {
        wheel,
        contact_nodes,
        ..mechanics_alone()
    }
}

/// Creepages from −0.5 % to 0.5 %.
fn creepages() -> impl Iterator<Item = f64> {
    (-10..=10).map(|k| 5e-4 * f64::from(k))
}

/// T/(μN) over the creepages, load by load.
fn curves(wheel: Wheel, contact_nodes: usize) -> Result<Vec<f64>> {
    let parameters = parameters(wheel, contact_nodes);
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let mut values = Vec::new();
    for normal_load in LOADS {
        for creepage in creepages() {
            let inputs = Inputs {
                creepage,
                normal_load,
                ..Inputs::default()
            };
            values.push(run.hold(&inputs, PASSAGE, 1)?.traction_coefficient / parameters.friction_cold);
        }
    }
    Ok(values)
}

/// Rows of the whole curve.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    // As measured, rounded up by less than what a change of the correction of the leading edge's strain by a tenth does. Like bodies
    // need that correction alone, and it leaves second order; where a part of the slip is hidden in a cell, it is nearly the first.
    for (wheel, name, tolerances) in [
        (Wheel::Rigid, "rigid wheel", [0.004, 0.0023, 0.0013]),
        (Wheel::Elastic, "elastic wheel", [0.0024, 0.0006, 0.00015]),
    ] {
        let limit = curves(wheel, FINE)?;
        for (nodes, tolerance) in [31, 61, 121].into_iter().zip(tolerances) {
            rows.push(Row::absolute(
                format!("largest error of T/(mu N) at {nodes} nodes, {name}"),
                "1",
                0.0,
                largest_change(&curves(wheel, nodes)?, &limit),
                tolerance,
                SOURCE,
            ));
        }
    }
    let limit = free_rolling(FINE)?;
    rows.push(Row::relative(
        "creepage of free rolling, rigid wheel, default nodes",
        "1",
        limit,
        free_rolling(Parameters::default().contact_nodes)?,
        0.005,
        SOURCE,
    ));
    rows.extend(hot_rows()?);
    Ok(rows)
}

/// The creepage at which a rigid wheel has no traction.
fn free_rolling(contact_nodes: usize) -> Result<f64> {
    let inputs = |creepage| Inputs {
        creepage,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(&parameters(Wheel::Rigid, contact_nodes), &inputs(0.0))?;
    set_up::free_rolling([-0.001, -0.002], |creepage| {
        Ok(run.hold(&inputs(creepage), PASSAGE, 1)?.traction_coefficient)
    })
}

/// Partial slip at 0.5 % with friction that falls with temperature: force and peak temperature.
fn hot_rows() -> Result<Vec<Row>> {
    let settled = |contact_nodes: usize| -> Result<Outputs> {
        let parameters = Parameters {
            contact_nodes,
            wheel: Wheel::Rigid,
            heat_partition: 1.0,
            contact_thermal_resistance: 1e12,
            wear_coefficient: 0.0,
            thermal_expansion: 0.0,
            friction_temperature_cold: 300.0,
            ..Parameters::default()
        };
        let inputs = Inputs {
            creepage: 0.005,
            ..Inputs::default()
        };
        Ok(*set_up::simulation(&parameters, &inputs)?.hold(&inputs, PASSAGE, 30)?)
    };
    let (limit, default) = (settled(FINE)?, settled(Parameters::default().contact_nodes)?);
    let row = |quantity: &str, unit, limit, default| Row::relative(quantity, unit, limit, default, 0.003, SOURCE);
    Ok(vec![
        row(
            "traction force at creepage 0.005 with mu(theta), default nodes",
            "N",
            limit.traction_force,
            default.traction_force,
        ),
        row(
            "largest temperature rise there",
            "K",
            limit.peak_temperature - Inputs::default().ambient_temperature,
            default.peak_temperature - Inputs::default().ambient_temperature,
        ),
    ])
}
