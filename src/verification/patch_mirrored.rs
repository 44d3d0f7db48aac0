//! Mirrored motion of a patch gives mirrored fields. In y: v_y and ω_z reversed reverse F_y and M_z and nothing else. In x: V, ω and
//! ω_z reversed reverse T and M_z and nothing else.
//!
//! Grid, influence functions and marches are their own mirror images bit for bit; Fourier transforms and sums over the cells take the
//! same numbers in another order.

use super::row::{Row, largest_difference};
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters, SlipSource, Wheel, WheelHeating};
use crate::signals::{Inputs, Outputs};
use crate::simulation::Simulation;
use crate::wheel_rail::ContactNode;

const SOURCE: &str = "symmetry of the equations";
/// Round-off, through 40 steps: both runs go through the same iterations, so that it does not matter how exactly the solvers solve. Corrections of pressure
/// and shear within a step, up to 0.005 of the fields here, are computed in single precision, with 6e-8 of them as round-off.
const TOLERANCE: f64 = 3e-10;

/// A mirror: in x, in y.
type Mirror = [f64; 2];

/// Largest difference of each field from its mirror image, relative to the field's largest value.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let rigid = Parameters {
        contact_model: ContactModel::Patch,
        wheel: Wheel::Rigid,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    // A softer wheel, so that normal and tangential problem stay coupled; a short strip, so that what comes in arrives.
    let warm = Parameters {
        wheel: Wheel::Elastic,
        wheel_shear_modulus: 0.5 * rigid.wheel_shear_modulus,
        wheel_heating: WheelHeating::On,
        rim_depth: 1e-3,
        rim_width: 1e-3,
        wheel_wear_coefficient: 1e-12,
        strip_half_length: 0.2,
        ..rigid.clone()
    };
    let mut rows = Vec::new();
    for (pair, parameters) in [("rigid cold wheel", &rigid), ("soft warm wheel", &warm)] {
        let original = braking(parameters, [1.0, 1.0])?;
        for (name, mirror) in [("in y", [1.0, -1.0]), ("in x", [-1.0, 1.0])] {
            rows.extend(compared(&format!("mirrored {name}, {pair}"), &original, mirror)?);
        }
    }
    Ok(rows)
}

/// Simulation from rolling into a slide of 8 % and a drift with spin, mirrored.
fn braking(parameters: &Parameters, [x, y]: Mirror) -> Result<Simulation> {
    let inputs = |slide: f64| Inputs {
        vehicle_speed: 10.0 * x,
        wheel_speed: 10.0 * x * (1.0 - slide) / parameters.wheel_radius,
        lateral_speed: 0.02 * y,
        spin_rate: 4.0 * x * y,
        incoming_temperature: 310.0,
        incoming_wear_depth: 1e-7,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(parameters, &inputs(0.0))?;
    for step in 0..40 {
        run.step(&inputs(0.002 * f64::from(step)), 2e-3)?;
    }
    Ok(run)
}

fn compared(name: &str, original: &Simulation, mirror: Mirror) -> Result<Vec<Row>> {
    let parameters = original.model.parameters();
    let image = braking(parameters, mirror)?;
    let [x, y] = mirror;
    let (cells, strips) = (parameters.patch_nodes, parameters.patch_strips);
    let (nodes, images) = (original.contact_nodes(), image.contact_nodes());
    let mirrored = |index: usize| {
        let (strip, cell) = (index / cells, index % cells);
        let strip = if y < 0.0 { strips - 1 - strip } else { strip };
        let cell = if x < 0.0 { cells - 1 - cell } else { cell };
        images[strip * cells + cell]
    };
    let row = |quantity: &str, pairs: &mut dyn Iterator<Item = (f64, f64)>| {
        Row::absolute(
            format!("{quantity}, difference to the image {name}"),
            "1",
            0.0,
            largest_difference(pairs),
            TOLERANCE,
            SOURCE,
        )
    };
    let field = |quantity: &str, sign: f64, value: fn(&ContactNode) -> f64| {
        let mut pairs = nodes
            .iter()
            .enumerate()
            .map(|(index, node)| (value(node), sign * value(&mirrored(index))));
        row(quantity, &mut pairs)
    };
    let output = |quantity: &str, sign: f64, value: fn(&Outputs) -> f64| {
        let pair = (value(&original.state.outputs), sign * value(&image.state.outputs));
        row(quantity, &mut [pair].into_iter())
    };
    Ok(vec![
        field("pressure", 1.0, |node| node.pressure),
        field("shear traction along the rail", x, |node| node.shear),
        field("shear traction across", y, |node| node.lateral_shear),
        field("slip velocity along the rail", x, |node| node.slip),
        field("slip velocity across", y, |node| node.lateral_slip),
        field("surface temperature", 1.0, |node| node.temperature),
        field("wear depth", 1.0, |node| node.wear_depth),
        output("T", x, |outputs| outputs.traction_force),
        output("F_y", y, |outputs| outputs.lateral_force),
        output("M_z", x * y, |outputs| outputs.spin_moment),
        output("wheel temperature", 1.0, |outputs| outputs.wheel_temperature),
        output("leaving temperature", 1.0, |outputs| outputs.leaving_temperature),
        output("leaving wear depth", 1.0, |outputs| outputs.leaving_wear_depth),
    ])
}
