//! The power that friction dissipates is what wheel and vehicle supply,
//! P = b ∫ |τ s| dx₁ = T (ω r₀ − V) + V N e/r₀,
//! with the pressure's resultant a distance e ahead of the axle. With the slip of a node as the mean of those in its two
//! cells, the work of the tractions on the elastic bodies vanishes in the sum, but for the nodes at the edges.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{Parameters, Wheel};
use crate::signals::Inputs;

const SOURCE: &str = "T(w r0 - V) + V N e/r0";

/// Relative defect of the balance on default nodes and under refinement.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let default = Parameters::default().contact_nodes;
    let mut rows = Vec::new();
    for (wheel, name, cases) in [
        (Wheel::Rigid, "rigid wheel", [(0.0, 0.003), (0.01, 0.001)]),
        (Wheel::Elastic, "elastic wheel", [(0.002, 0.003), (0.01, 0.001)]),
    ] {
        for (creepage, tolerance) in cases {
            let mut row = |nodes: usize, tolerance: f64| -> Result<()> {
                rows.push(Row::absolute(
                    format!("defect of friction power over power supplied, creepage {creepage}, {nodes} nodes, {name}"),
                    "1",
                    0.0,
                    defect(wheel, nodes, creepage)?,
                    tolerance,
                    SOURCE,
                ));
                Ok(())
            };
            row(default, tolerance)?;
            // What is left stands at the edges, which lie differently between the nodes of each mesh.
            row(2 * default - 1, 0.5 * tolerance)?;
        }
    }
    Ok(rows)
}

/// |P − supplied| / supplied on `contact_nodes` nodes, without the small work of thermal expansion and wear.
fn defect(wheel: Wheel, contact_nodes: usize, creepage: f64) -> Result<f64> {
    let parameters = Parameters {
        contact_nodes,
        wheel,
        ..mechanics_alone()
    };
    let inputs = Inputs {
        creepage,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(&parameters, &inputs)?;
    let outputs = run.hold(&inputs, 0.5, 1)?;
    let motion = inputs.motion(&parameters);
    let supplied = outputs.traction_force * motion.rigid_slip
        + motion.rolling_speed * inputs.normal_load * outputs.contact_offset / parameters.wheel_radius;
    Ok(((outputs.friction_power - supplied) / supplied).abs())
}
