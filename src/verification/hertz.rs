//! Hertz's line contact of the rigid wheel on the elastic rail: a = √(4 N r₀/(π b E*)), p₀ = 2N/(π a b),
//! E* = E/(1 − ν²) (Johnson, Contact Mechanics, 4.43 and 4.45).
//!
//! Without friction, heat and wear the contact is Hertz's but for the strip's finite size, the mesh, and the circle in
//! place of its parabola (a²/r₀² ≈ 1e-4).

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{FrictionLaw, Parameters, Wheel};
use crate::signals::Inputs;

const SOURCE: &str = "Johnson, Contact Mechanics, 4.43 and 4.45";
/// Half a node spacing is 6 % of the smallest half-length; because the ends are interpolated between nodes, about 1 % is left.
const HALF_LENGTH_TOLERANCE: f64 = 0.02;
/// The mean over the crest's cell is (Δx/a)²/24 less than the crest, 0.07 % at 10 % load, and the ends of the contact lie
/// between cells, which does as much.
const PRESSURE_TOLERANCE: f64 = 0.002;
/// Displacement of the middle of a strip of 4 m by 1 m, clamped but for its surface, beside that of the half-plane under the
/// same force and without the shift at 1 m from it, in 2/(πE*) times the force: an independent program's linear triangles,
/// extrapolated from 7 503 and 29 403 nodes.
const STRIP: f64 = -0.5215;
/// Tolerance of the penetration: what a remainder on a thousand nodes leaves.
const PENETRATION_TOLERANCE: f64 = 0.001;

/// Half-length and peak pressure over 10–100 % of the largest load.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = contact("rigid wheel", rigid(), &[10, 20, 35, 50, 75, 100])?;
    let inputs = Inputs::default();
    let mut run = set_up::simulation(&smooth(rigid()), &inputs)?;
    // The penetration of a line contact depends on the size of the body, by a logarithm.
    let parameters = rigid();
    let (load, modulus) = (
        inputs.normal_load / parameters.contact_width,
        parameters.contact_modulus(),
    );
    let half_plane = (2.0 / parameters.hertz_half_length(inputs.normal_load)).ln() + 0.5;
    rows.push(Row::relative(
        "penetration at 60 kN, rigid wheel",
        "m",
        2.0 * load / (std::f64::consts::PI * modulus) * (half_plane + STRIP),
        run.hold(&inputs, 1e-3, 1)?.penetration,
        PENETRATION_TOLERANCE,
        "half-plane under Hertz's pressure, and finite elements of an independent program for the strip",
    ));
    Ok(rows)
}

/// The rigid wheel; the elastic one's rows are in [`super::elastic_wheel`].
fn rigid() -> Parameters {
    Parameters {
        wheel: Wheel::Rigid,
        ..Parameters::default()
    }
}

/// Parameters without friction, heat and wear.
fn smooth(parameters: Parameters) -> Parameters {
    Parameters {
        friction_law: FrictionLaw::Constant,
        friction_cold: 0.0,
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        ..parameters
    }
}

/// Pressure across the contact window at 20, 50 and 100 % of the largest load: load, position, pressure, Hertz's.
///
/// # Errors
/// A solver that did not converge.
pub fn curve() -> Result<Vec<Vec<f64>>> {
    let parameters = smooth(rigid());
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let mut points = Vec::new();
    for share in [0.2, 0.5, 1.0] {
        let load = share * parameters.largest_load;
        let inputs = Inputs {
            normal_load: load,
            ..Inputs::default()
        };
        run.hold(&inputs, 1e-3, 1)?;
        let (half_length, peak) = (parameters.hertz_half_length(load), parameters.hertz_peak_pressure(load));
        points.extend(run.contact_nodes().iter().map(|node| {
            let hertz = peak * (1.0 - (node.position / half_length).powi(2)).max(0.0).sqrt();
            vec![load, node.position, node.pressure, hertz]
        }));
    }
    Ok(points)
}

/// Half-length and peak pressure of the given pair at loads in percent of the largest.
///
/// # Errors
/// A solver that did not converge.
pub fn contact(pair: &str, parameters: Parameters, percents: &[u8]) -> Result<Vec<Row>> {
    let parameters = smooth(parameters);
    let mut run = set_up::simulation(&parameters, &Inputs::default())?;
    let mut rows = Vec::new();
    for &percent in percents {
        let load = 0.01 * f64::from(percent) * parameters.largest_load;
        let inputs = Inputs {
            normal_load: load,
            ..Inputs::default()
        };
        let outputs = run.hold(&inputs, 1e-3, 1)?;
        rows.push(Row::relative(
            format!("contact half-length a at {percent} % of the largest load, {pair}"),
            "m",
            parameters.hertz_half_length(load),
            0.5 * outputs.contact_length,
            HALF_LENGTH_TOLERANCE,
            SOURCE,
        ));
        rows.push(Row::relative(
            format!("peak pressure p0 at {percent} % of the largest load, {pair}"),
            "Pa",
            parameters.hertz_peak_pressure(load),
            outputs.peak_pressure,
            PRESSURE_TOLERANCE,
            SOURCE,
        ));
    }
    Ok(rows)
}
