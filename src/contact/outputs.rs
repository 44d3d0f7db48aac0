//! The outputs that follow from the fields of the contact.

use crate::contact::line::fields::Fields;
use crate::contact::line::rail::Rail;
use crate::contact::rim::ContactHeat;
use crate::friction::{self, coulomb};
use crate::parameters::Parameters;
use crate::signals::{Inputs, Outputs};
use crate::transport::Upwind;

/// The outputs that follow from the fields and the inputs at one instant; the totals are 0.
pub fn instantaneous(rail: &Rail, parameters: &Parameters, fields: &Fields, inputs: &Inputs) -> Outputs {
    let motion = inputs.motion(parameters);
    let (spacing, scale) = (rail.mesh.contact_spacing(), rail.scales.pressure);
    let force = parameters.contact_width * spacing * scale;
    let n = rail.mesh.contact_nodes;

    let (mut total, mut moment, mut shear, mut weighted) = (0.0, 0.0, 0.0, 0.0);
    let (mut friction_power, mut heat) = (0.0, 0.0);
    let (mut peak_pressure, mut peak_shear) = (0.0_f64, 0.0_f64);
    let (mut contact_nodes, mut sticking) = (0.0, 0.0);
    for node in 0..n {
        heat += fields.heat_flux[node];
        let (p, tau, slip) = (fields.pressure[node], fields.shear[node], fields.slip[node]);
        if p <= 0.0 {
            continue;
        }
        total += p;
        moment += p * rail.mesh.contact_position(node);
        shear += tau;
        weighted += p * fields.friction[node];
        friction_power += (tau * slip).abs();
        peak_pressure = peak_pressure.max(p);
        peak_shear = peak_shear.max(tau.abs());
        contact_nodes += 1.0;
        if coulomb::saturation(slip, parameters.slip_regularisation).abs() < coulomb::STICK_SATURATION {
            sticking += 1.0;
        }
    }
    let surface = fields.surface_temperature.iter();
    let peak_rise = surface.fold(f64::NEG_INFINITY, |m: f64, t| t.max(m));
    let ambient = inputs.ambient_temperature;
    let load = force * total;
    let traction_force = -force * shear;
    let per_total = |value: f64| if total > 0.0 { value / total } else { 0.0 };
    let offset = per_total(moment);
    let cold = friction::coefficient(parameters, ambient + peak_rise).0 * inputs.friction_scale;
    let outflow = Upwind::new(&rail.mesh.x, motion.rolling_speed).outflow();
    let wheel_rise = fields.wheel_temperature - ambient;
    Outputs {
        traction_force,
        friction_torque: -(traction_force * parameters.wheel_radius + load * offset),
        peak_temperature: ambient + peak_rise,
        traction_coefficient: -per_total(shear),
        slip_creepage: creepage(motion.rolling_speed, motion.rigid_slip),
        penetration: fields.penetration * rail.scales.displacement,
        contact_length: contact_length(rail, fields),
        contact_offset: offset,
        peak_pressure: peak_pressure * scale,
        peak_shear: peak_shear * scale,
        stick_fraction: if contact_nodes > 0.0 {
            sticking / contact_nodes
        } else {
            0.0
        },
        friction_coefficient: if total > 0.0 { weighted / total } else { cold },
        friction_power: force * friction_power,
        rail_heat_flow: parameters.contact_width * spacing * heat,
        wear_depth: wear_left_behind(rail, fields, motion.rolling_speed),
        wear_rate: parameters.wear_coefficient * sliding_power(rail, parameters, fields),
        worn_volume: 0.0,
        friction_energy: 0.0,
        distance: 0.0,
        wheel_temperature: fields.wheel_temperature,
        wheel_heat_flow: ContactHeat::new(rail, parameters, fields).flow(wheel_rise),
        wheel_wear_depth: 0.0,
        leaving_temperature: ambient + rail.incoming.equivalent_rise(&rail.basis, fields.column(rail, outflow)),
        leaving_wear_depth: fields.wear[outflow],
    }
}

/// b ∫ |s| p dx, to which wear is proportional, `W`.
pub fn sliding_power(rail: &Rail, parameters: &Parameters, fields: &Fields) -> f64 {
    let nodes = fields.pressure.iter().zip(&fields.slip);
    let sum: f64 = nodes.map(|(p, slip)| p * slip.abs()).sum();
    parameters.contact_width * rail.mesh.contact_spacing() * rail.scales.pressure * sum
}

/// Distance between the ends of the contact. At an end the pressure falls like the root of the distance, so its
/// square is linear there and its zero is found between the nodes.
fn contact_length(rail: &Rail, fields: &Fields) -> f64 {
    let p = &fields.pressure;
    let beyond = |last: usize, inner: Option<usize>| {
        let (edge, inside) = (p[last], inner.map_or(0.0, |i| p[i]));
        if inside > edge {
            (edge * edge / (inside * inside - edge * edge)).min(1.0)
        } else {
            0.5
        }
    };
    let first = p.iter().position(|&p| p > 0.0);
    let last = p.iter().rposition(|&p| p > 0.0);
    match (first, last) {
        (Some(first), Some(last)) => {
            let nodes = (last - first) as f64;
            let inner = |i| if first < last { Some(i) } else { None };
            (nodes + beyond(first, inner(first + 1)) + beyond(last, inner(last.wrapping_sub(1))))
                * rail.mesh.contact_spacing()
        }
        _ => 0.0,
    }
}

/// Wear depth at the end of the window where material leaves it; at rest the deepest, `m`.
fn wear_left_behind(rail: &Rail, fields: &Fields, rolling_speed: f64) -> f64 {
    let mesh = &rail.mesh;
    let window = &fields.wear[mesh.window()];
    if rolling_speed > 0.0 {
        window[0]
    } else if rolling_speed < 0.0 {
        window[window.len() - 1]
    } else {
        window.iter().fold(0.0, |m, &w| w.max(m))
    }
}

/// (ω r₀ − V)/V. Near rest the divisor is held at 1 mm/s, so that it stays finite.
fn creepage(rolling_speed: f64, rigid_slip: f64) -> f64 {
    let floor = 1e-3_f64;
    if rolling_speed.abs() >= floor {
        rigid_slip / rolling_speed
    } else if rolling_speed < 0.0 {
        -rigid_slip / floor
    } else {
        rigid_slip / floor
    }
}
