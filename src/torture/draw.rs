//! Random parameters in the ranges of engineering, and with some probability at their ends.

use super::random::Random;
use crate::parameters::{
    ContactModel, Control, FrictionLaw, Parameters, Side, SlipSource, TABLE_POINTS, Wheel, WheelHeating,
};

/// Factor by which the contact window may be widened within the limits of [`Parameters::validate`]: for runs with a window wider
/// than usual.
pub const WIDEST_WINDOW: f64 = 3.0;

/// Parameters that can be together. Those that are refused are drawn again.
pub fn parameters(random: &mut Random, contact_model: ContactModel) -> Parameters {
    loop {
        let mut drawn = draw(random);
        match contact_model {
            ContactModel::Line => layer(random, &mut drawn),
            ContactModel::Patch => patch(random, &mut drawn),
            ContactModel::Profiles => profiles(random, &mut drawn),
        }
        if drawn.validate().is_ok() && with_window(&drawn, WIDEST_WINDOW).validate().is_ok() {
            return drawn;
        }
    }
}

/// Parameters with `factor` times the window, at the same spacing of the nodes: the window of a line grows with the root of
/// `largest_load`, that of a patch with its cube root.
pub fn with_window(parameters: &Parameters, factor: f64) -> Parameters {
    let widened = |count: usize| (factor * count as f64).round() as usize;
    match parameters.contact_model {
        ContactModel::Line => Parameters {
            largest_load: factor * factor * parameters.largest_load,
            contact_nodes: widened(parameters.contact_nodes - 1) + 1,
            ..parameters.clone()
        },
        ContactModel::Patch | ContactModel::Profiles => Parameters {
            largest_load: factor * factor * factor * parameters.largest_load,
            patch_nodes: widened(parameters.patch_nodes),
            patch_strips: widened(parameters.patch_strips),
            ..parameters.clone()
        },
    }
}

fn draw(random: &mut Random) -> Parameters {
    let mut parameters = Parameters {
        control: if random.chance(0.1) {
            Control::Penetration
        } else {
            Control::Load
        },
        slip_source: random.one_of(SlipSource::ALL),
        largest_load: random.between(50e3, 150e3),
        contact_nodes: if random.chance(0.5) { 51 } else { random.count(31, 121) },
        depth_nodes: if random.chance(0.5) { 41 } else { random.count(21, 61) },
        wheel_radius: random.between(0.3, 0.6),
        strip_height: random.between(0.2, 1.5),
        strip_half_length: random.between(0.5, 3.0),
        contact_width: random.between(3e-3, 30e-3),
        thermal_expansion: if random.chance(0.1) {
            0.0
        } else {
            random.between(10e-6, 15e-6)
        },
        heat_partition: if random.chance(0.1) {
            1.0
        } else {
            random.between(0.3, 0.7)
        },
        contact_thermal_resistance: if random.chance(0.2) {
            1e12
        } else {
            random.decades(10.0, 1e5)
        },
        // Archard's coefficient over the hardness, 3 GPa: from mild (1e-4) to severe wear (1e-2).
        wear_coefficient: if random.chance(0.25) {
            0.0
        } else {
            random.decades(0.03e-12, 3e-12)
        },
        friction_law: random.one_of(FrictionLaw::ALL),
        wheel: random.one_of(Wheel::ALL),
        wheel_heating: random.one_of(WheelHeating::ALL),
        wheel_wear_coefficient: random.between(0.0, 1e-12),
        skin_depth: random.decades(1e-3, 2e-2),
        ..Parameters::default()
    };
    // A part of what the largest load sinks in, some 1e-11 m per N/m: the bulge of a hot rail adds to the load.
    parameters.prescribed_penetration =
        2e-9 * random.between(0.1, 0.5) * parameters.largest_load / (parameters.contact_width / 0.01);
    if random.chance(0.5) {
        parameters.wheel_lame_lambda *= random.between(0.5, 2.0);
        parameters.wheel_shear_modulus *= random.between(0.5, 2.0);
        parameters.wheel_density *= random.between(0.5, 1.5);
    }
    table(random, &mut parameters);
    tune(random, &mut parameters);
    falling(random, &mut parameters);
    layer(random, &mut parameters);
    parameters
}

/// Draws the parameters that a patch has besides: transverse curvatures, of hollow wheels among them, a layer, cells and strips.
fn patch(random: &mut Random, parameters: &mut Parameters) {
    parameters.contact_model = ContactModel::Patch;
    // B/A, from a contact four times as long as broad to one seven times as broad as long.
    let sum = random.decades(0.05, 20.0) / parameters.wheel_radius;
    parameters.wheel_transverse_curvature = match random.count(0, 2) {
        0 => 0.0,
        1 => random.between(0.0, 1.0) * sum,
        _ => -random.decades(0.1, 10.0),
    };
    parameters.rail_transverse_curvature = sum - parameters.wheel_transverse_curvature;
    cells(random, parameters);
    // The bulge of a hot rail adds to the load here, too.
    let approach = parameters.hertz_ellipse(parameters.largest_load).approach;
    parameters.prescribed_penetration = random.between(0.1, 0.3) * approach;
}

/// Draws the cells of a patch: few more often than many, because they are the hard ones, and fast.
fn cells(random: &mut Random, parameters: &mut Parameters) {
    (parameters.patch_nodes, parameters.patch_strips) = match random.count(0, 5) {
        0 => (Parameters::default().patch_nodes, Parameters::default().patch_strips),
        1 => (random.count(20, 60), random.count(9, 31)),
        _ => (random.count(8, 26), random.count(3, 15)),
    };
}

/// Draws the parameters of profiles: those that are built in on both sides of the track, gauges and inclinations beyond what is usual, under a load and at a
/// height.
fn profiles(random: &mut Random, parameters: &mut Parameters) {
    parameters.contact_model = ContactModel::Profiles;
    parameters.slip_source = SlipSource::VehicleSpeed;
    parameters.control = if random.chance(0.2) {
        Control::Height
    } else {
        Control::Load
    };
    parameters.rail_profile = (*random.one_of(&RAILS)).to_owned();
    parameters.wheel_profile = (*random.one_of(&WHEELS)).to_owned();
    parameters.side = random.one_of(Side::ALL);
    parameters.gauge = random.between(1.430, 1.450);
    parameters.flange_back_distance = random.between(1.357, 1.363);
    parameters.rail_inclination = random.one_of(&[0.0, 1.0 / 40.0, 1.0 / 20.0]);
    parameters.gauge_face_friction_scale = random.one_of(&[1.0, 0.3]);
    parameters.gauge_face_angle = random.between(0.3, 1.0);
    parameters.normal_damping = random.one_of(&[0.0, 0.3]);
    cells(random, parameters);
}

/// Rails and wheels of the runs with profiles.
const RAILS: [&str; 5] = ["60E1", "60E2", "54E1", "49E1", "UIC60"];
const WHEELS: [&str; 6] = ["S1002", "S1002", "cone20", "UIC519A", "UIC519B", "UIC519H"];

/// The steepest friction of a table, `1/K`: the paper's. Where the coefficient rises much faster, a contact has several temperatures, and a
/// step of any length may have to jump from one to another.
const STEEPEST: f64 = 0.002;

/// The steepest fall of friction between two temperatures, `1/K`: from 0.53 to 0.18 within 18 K.
const STEEPEST_FALL: f64 = 0.02;

/// A table of friction coefficients that rise or fall between temperatures some degrees to some hundred degrees apart.
fn table(random: &mut Random, parameters: &mut Parameters) {
    parameters.friction_table_points = random.count(2, TABLE_POINTS);
    let mut temperature = random.between(250.0, 400.0);
    let points = parameters.friction_table_temperature.iter_mut();
    let mut before = None;
    for (point, coefficient) in points.zip(&mut parameters.friction_table_coefficient) {
        *coefficient = random.between(0.05, 0.7);
        if let Some(before) = before {
            let change: f64 = *coefficient - before;
            temperature += random.decades(3.0, 300.0).max(change.abs() / STEEPEST);
        }
        *point = temperature;
        before = Some(*coefficient);
    }
}

/// Friction that falls with slip, then with a memory: without one a contact has several solutions where it falls fast.
fn falling(random: &mut Random, parameters: &mut Parameters) {
    if random.chance(0.5) {
        return;
    }
    parameters.friction_memory_distance = random.decades(1e-6, 1e-4);
    if random.chance(0.7) {
        parameters.friction_slip_share = random.between(0.2, 1.0);
        parameters.friction_slip_decay = random.decades(0.05, 5.0);
    }
}

/// Draws a layer between wheel and rail, elastic, plastic or both: of a strength far below the friction bound to above it, and of a hardening
/// from negligible within the contact to so large that it hardly flows.
fn layer(random: &mut Random, parameters: &mut Parameters) {
    if random.chance(0.3) {
        parameters.layer_compliance = random.decades(1e-14, 1e-12);
    }
    if random.chance(0.3) {
        parameters.layer_yield_stress = random.decades(1e7, 1e9);
        if random.chance(0.7) {
            parameters.layer_hardening = random.decades(1e11, 1e14);
        }
    }
}

/// Draws the tunable parameters.
pub fn tune(random: &mut Random, parameters: &mut Parameters) {
    // Both ends of the range, and what lies between.
    parameters.slip_regularisation = match random.count(0, 9) {
        // Coulomb's law, the default.
        0..=4 => 0.0,
        5 => 1e-6,
        6 => random.decades(1e-2, 1.0),
        _ => random.decades(1e-6, 1e-2),
    };
    parameters.friction_cold = random.between(0.05, 0.7);
    parameters.friction_hot = parameters.friction_cold * random.between(0.3, 1.0);
    parameters.friction_temperature_cold = random.between(290.0, 600.0);
    let range = (parameters.friction_cold - parameters.friction_hot) / STEEPEST_FALL;
    parameters.friction_temperature_hot = parameters.friction_temperature_cold + random.decades(10.0, 500.0).max(range);
}
