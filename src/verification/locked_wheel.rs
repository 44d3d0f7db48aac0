//! The locked wheel, ω = 0, at 10 m/s with the penetration of the paper. There |s| ≈ V, and heat source and wear law are
//! those that the paper prints. It finds wear "slightly smaller" where μ falls with temperature, and a contact zone moved
//! by thermal expansion.

use super::paper_cases::{CASES, parameters, settled};
use super::row::Row;
use crate::error::Result;
use crate::parameters::Parameters;
use crate::simulation::Simulation;

const PAPER: &str = "the paper, section 5";

/// Sign and order of what the paper says.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let locked = |parameters: &Parameters| settled(parameters, -1.0);
    let constant = locked(&parameters(None))?;
    let wear = |run: &Simulation| run.state.outputs.wear_depth;
    let mut rows = Vec::new();
    for (case, hot) in CASES {
        let run = locked(&parameters(Some(hot)))?;
        let ratio = wear(&run) / wear(&constant);
        rows.push(Row::at_most(
            format!("wear depth over that at constant mu, case {case}: smaller"),
            "1",
            1.0 - 1e-3,
            ratio,
            PAPER,
        ));
        rows.push(Row::at_least(
            format!("wear depth over that at constant mu, case {case}: slightly"),
            "1",
            0.9,
            ratio,
            PAPER,
        ));
    }
    let hot = Some(CASES[0].1);
    let expanding = locked(&parameters(hot))?;
    let rigid = locked(&Parameters {
        thermal_expansion: 0.0,
        ..parameters(hot)
    })?;
    // The rail is hottest behind the middle and bulges there: the zone moves towards the wake.
    rows.push(Row::at_most(
        "middle of the contact zone moved by thermal expansion, case a",
        "m",
        -5e-6,
        middle(&expanding) - middle(&rigid),
        PAPER,
    ));
    Ok(rows)
}

/// Middle of the contact zone by the resultant of the pressure, `m`.
fn middle(run: &Simulation) -> f64 {
    run.state.outputs.contact_offset
}
