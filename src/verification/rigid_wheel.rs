//! A rigid wheel on an elastic rail couples normal and tangential displacement (Dundurs): pressure stretches the rail's
//! surface, so that the wheel pulls at creepage 0 and rolls freely at a small negative creepage.
//!
//! The references are those of an independent prototype (61 nodes over ±6 mm, 6e6 N/m, constant μ = 0.45).

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::signals::Inputs;

const SOURCE: &str = "independent prototype, 61 nodes over 12 mm";

/// T/(μN) at creepage 0, and the creepage at which T = 0.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let parameters = Parameters {
        wheel: Wheel::Rigid,
        friction_law: FrictionLaw::Constant,
        ..Parameters::default()
    };
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let mut traction = |creepage| -> Result<f64> {
        let inputs = Inputs {
            creepage,
            ..Inputs::default()
        };
        // Two seconds clear the strip of what an earlier creepage left.
        let outputs = run.hold(&inputs, 1e-2, 200)?;
        Ok(outputs.traction_coefficient / parameters.friction_cold)
    };
    let at_zero = traction(0.0)?;
    let free = set_up::free_rolling([-0.001, -0.002], &mut traction)?;
    Ok(vec![
        // The prototype's figure has two digits.
        Row::absolute("T/(mu N) at creepage 0", "1", 0.59, at_zero, 0.01, SOURCE),
        Row::absolute("creepage of free rolling (T = 0)", "1", -0.0016, free, 5e-5, SOURCE),
    ])
}
