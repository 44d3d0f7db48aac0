//! A patch that is long across the rail is a line contact at its middle: its centre strip beside the line engine at the same load per
//! width, p₀ a π/2 of Hertz's ellipse. Normal and tangential coupling, heat march, wear march, thermal bulge and their signs
//! are built anew in the patch, and each is in one of the rows.
//!
//! The middle of an ellipse is a line contact but for (a/b)² ln(b/a): the line gets the radius E* a/(2 p₀) and the width
//! N/(p₀ a π/2), with which its half-length and its peak pressure are the ellipse's, and b/a is so large that what is left of that in the
//! shear is small against the tolerance. The line's load is the strip's own: where it is hot, the bulge draws load from the sides to the
//! middle. Strain by pressure, where the bodies differ, comes from farther away: there it is a/b.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, FrictionLaw, Parameters, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation;
use std::f64::consts::FRAC_PI_2;

const SOURCE: &str = "line engine at the same load per width";
/// Both engines' cells, and (a/b)² ln(b/a).
const TOLERANCE: f64 = 0.01;
/// Transverse curvature, `1/m`: b = 26 a.
const CURVATURE: f64 = 0.012;
/// Curvature with the rigid wheel, b = 250 a: strain by pressure is b/(a + b) of the line's, that of a uniformly loaded
/// ellipse.
const RIGID_CURVATURE: f64 = 2.2e-4;
/// a/(a + b) = 0.004 more, and the slip within a cell, which only the line engine corrects.
const RIGID_TOLERANCE: f64 = 0.014;
const LOAD: f64 = 100e3;
const SPEED: f64 = 20.0;
/// Longer than the rail is in the strip.
const PASSAGE: f64 = 0.5;

/// Fields in the middle of the contact, which are compared.
struct Middle {
    /// T/N.
    traction: f64,
    /// Highest temperature rise, `K`.
    rise: f64,
    /// Depth of wear behind the contact, `m`.
    wear: f64,
    /// Peak pressure, `Pa`.
    pressure: f64,
    /// Load per width, `N/m`.
    load: f64,
}

/// Parameters of the line engine at the middle of the patch's ellipse.
fn line(patch: &Parameters) -> Parameters {
    let ellipse = patch.hertz_ellipse(LOAD);
    Parameters {
        contact_model: ContactModel::Line,
        wheel_radius: 0.5 * patch.contact_modulus() * ellipse.along / ellipse.peak_pressure,
        contact_width: LOAD / (FRAC_PI_2 * ellipse.peak_pressure * ellipse.along),
        contact_nodes: 101,
        largest_load: 1.2 * patch.largest_load,
        ..patch.clone()
    }
}

fn steady(parameters: &Parameters, normal_load: f64, creepage: f64) -> Result<Simulation> {
    let inputs = Inputs {
        wheel_speed: SPEED * (1.0 + creepage) / parameters.wheel_radius,
        normal_load,
        creepage,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(parameters, &inputs)?;
    run.hold(&inputs, PASSAGE, 3)?;
    Ok(run)
}

/// The centre strip of a patch.
fn centre(run: &Simulation) -> Middle {
    let nodes = run.contact_nodes();
    let spacing = nodes[1].position - nodes[0].position;
    let middle = nodes.iter().filter(|node| node.lateral_position.abs() < 1e-9);
    let mut middle = middle.peekable();
    let wear = middle.peek().map_or(f64::NAN, |rear| rear.wear_depth);
    let mut sums = (0.0, 0.0);
    let (mut rise, mut pressure) = (f64::NEG_INFINITY, 0.0_f64);
    for node in middle {
        sums = (sums.0 - node.shear, sums.1 + node.pressure);
        rise = rise.max(node.temperature);
        pressure = pressure.max(node.pressure);
    }
    Middle {
        traction: sums.0 / sums.1,
        rise,
        wear,
        pressure,
        load: spacing * sums.1,
    }
}

fn of_line(run: &Simulation) -> Middle {
    let outputs = &run.state.outputs;
    Middle {
        traction: outputs.traction_coefficient,
        rise: outputs.peak_temperature - run.state.inputs.ambient_temperature,
        wear: outputs.wear_depth,
        pressure: outputs.peak_pressure,
        load: run.state.inputs.normal_load / run.model.parameters().contact_width,
    }
}

/// Both, without and with the thermal bulge and with friction that falls with temperature; the rigid wheel's coupling.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let all = Parameters {
        contact_model: ContactModel::Patch,
        rail_transverse_curvature: CURVATURE,
        friction_temperature_cold: 300.0,
        friction_temperature_hot: 400.0,
        wear_coefficient: 5e-12,
        ..Parameters::default()
    };
    // So hot, and of a material that expands so much, that peak pressure and wear are some per cent others without the bulge.
    let hot = Parameters {
        wear_coefficient: 5e-13,
        thermal_expansion: 1e-4,
        ..all.clone()
    };
    let plain = Parameters {
        friction_law: FrictionLaw::Constant,
        friction_cold: 0.3,
        thermal_expansion: 0.0,
        ..all.clone()
    };
    let rigid = Parameters {
        wheel: Wheel::Rigid,
        rail_transverse_curvature: RIGID_CURVATURE,
        ..plain.clone()
    };
    // Without the line engine's correction of the slip within a cell that its pressure causes.
    let finer = Parameters {
        patch_nodes: 2 * rigid.patch_nodes,
        ..rigid.clone()
    };
    let mut rows = Vec::new();
    for (name, parameters, creepage, quantities, tolerance) in [
        ("constant mu, creepage 0.001", &plain, 0.001, 4, TOLERANCE),
        ("constant mu, creepage 0.01", &plain, 0.01, 4, TOLERANCE),
        ("mu(theta), bulge and wear, creepage 0.003", &all, 0.003, 4, TOLERANCE),
        ("mu(theta), bulge and wear, creepage 0.05", &all, 0.05, 4, TOLERANCE),
        ("mu(theta), large bulge, creepage 0.5", &hot, 0.5, 4, TOLERANCE),
        ("rigid wheel, creepage 0", &rigid, 0.0, 2, RIGID_TOLERANCE),
        ("rigid wheel, creepage -0.004", &rigid, -0.004, 4, TOLERANCE),
        (
            "rigid wheel, creepage 0, twice as many cells along",
            &finer,
            0.0,
            4,
            RIGID_TOLERANCE,
        ),
    ] {
        let patch = centre(&steady(parameters, LOAD, creepage)?);
        let line = line(parameters);
        let line = of_line(&steady(&line, patch.load * line.contact_width, creepage)?);
        let compared = [
            ("peak pressure", "Pa", line.pressure, patch.pressure),
            ("T/N", "1", line.traction, patch.traction),
            ("largest temperature rise", "K", line.rise, patch.rise),
            ("wear depth behind the contact", "m", line.wear, patch.wear),
        ];
        for (quantity, unit, line, patch) in compared.into_iter().take(quantities) {
            let quantity = format!("{quantity} at the middle, {name}");
            rows.push(Row::relative(quantity, unit, line, patch, tolerance, SOURCE));
        }
    }
    Ok(rows)
}
