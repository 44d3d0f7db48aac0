//! The power that friction dissipates is what wheel and vehicle supply,
//! P = b ∫ |τ s| dx₁ = T (ω r₀ − V) + V N e/r₀,
//! with the pressure's resultant a distance e ahead of the axle. The discrete fields keep it to first order in the node
//! spacing: |∂u₁/∂x₁| is taken upwind.

use super::row::Row;
use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;

const SOURCE: &str = "T(w r0 - V) + V N e/r0";
/// Each halves the spacing of the one before it.
const NODES: [usize; 4] = [31, 61, 121, 241];

/// Relative defect of the balance at the default mesh and under refinement, and its order.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    // What is claimed is the order. For the size there is no theory: 4.0 % and 0.91 % were measured at the default mesh.
    for (creepage, tolerance) in [(0.0, 0.06), (0.01, 0.01)] {
        let defects = NODES
            .iter()
            .map(|&nodes| defect(Wheel::Rigid, nodes, creepage))
            .collect::<Result<Vec<f64>>>()?;
        let default = defect(Wheel::Rigid, Parameters::default().contact_nodes, creepage)?;
        rows.push(Row::absolute(
            format!("defect of friction power over power supplied, creepage {creepage}, default mesh"),
            "1",
            0.0,
            default,
            tolerance,
            SOURCE,
        ));
        for (pair, nodes) in defects.windows(2).zip(NODES.windows(2)) {
            rows.push(Row::at_most(
                format!(
                    "defect at {} nodes over that at {}, creepage {creepage}",
                    nodes[1], nodes[0]
                ),
                "1",
                0.75,
                pair[1] / pair[0],
                "falls under refinement",
            ));
        }
        rows.push(Row::absolute(
            format!("order of the defect in the spacing, creepage {creepage}"),
            "1",
            1.0,
            (defects[0] / defects[3]).log2() / 3.0,
            // The ends of the contact lie differently between the nodes of each mesh: 0.84 and 0.93 were measured.
            0.25,
            "upwind differences, order 1",
        ));
    }
    // With a wheel of the rail's material e = 0, and the upwind difference of u₁ is all that is left: 6.2 % and 1.3 % were
    // measured.
    for (creepage, tolerance) in [(0.002, 0.08), (0.01, 0.02)] {
        let [default, fine] = [61, 121].map(|nodes| defect(Wheel::Elastic, nodes, creepage));
        let (default, fine) = (default?, fine?);
        rows.push(Row::absolute(
            format!("defect of friction power over power supplied, creepage {creepage}, elastic wheel"),
            "1",
            0.0,
            default,
            tolerance,
            SOURCE,
        ));
        rows.push(Row::at_most(
            format!("defect at 121 nodes over that at 61, creepage {creepage}, elastic wheel"),
            "1",
            0.75,
            fine / default,
            "falls under refinement",
        ));
    }
    Ok(rows)
}

/// |P − supplied| / supplied on `contact_nodes` nodes, without the small work of thermal expansion and wear.
fn defect(wheel: Wheel, contact_nodes: usize, creepage: f64) -> Result<f64> {
    let parameters = Parameters {
        friction_law: FrictionLaw::Constant,
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        contact_nodes,
        wheel,
        ..Parameters::default()
    };
    let inputs = Inputs {
        creepage,
        ..Inputs::default()
    };
    let mut run = Simulation::new(&parameters, &inputs)?;
    let outputs = run.hold(&inputs, 1e-3, 1)?;
    let motion = inputs.motion(&parameters);
    let supplied = outputs.traction_force * motion.rigid_slip
        + motion.rolling_speed * inputs.normal_load * outputs.contact_offset / parameters.wheel_radius;
    Ok(((outputs.friction_power - supplied) / supplied).abs())
}
