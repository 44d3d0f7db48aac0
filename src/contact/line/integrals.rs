//! Integrals over a line contact, its extent, and the profiles' values that the outputs are made of.

use super::fields::LineFields;
use super::mechanics::LineProblem;
use super::operators::LineOperators;
use crate::contact::engine::Engine;
use crate::contact::integrals::Integrals;
use crate::contact::integrals::{Node, NodeSums};
use crate::contact::on_wheelset::OnWheelset;
use crate::contact::rim::ContactHeat;
use crate::damage::{self, PointDamage};
use crate::friction::coulomb;
use crate::heat::isotherm;

/// Integrals of the given fields under the problem's conditions.
pub fn integrals(problem: &LineProblem, fields: &LineFields) -> Integrals {
    let (operators, parameters) = (problem.operators, problem.parameters);
    let transport = problem.upwind();
    let surface = fields.surface_temperature.iter();
    let peak_rise = surface.fold(f64::NEG_INFINITY, |m: f64, t| t.max(m));
    Integrals {
        sums: NodeSums::of(nodes(problem, fields)),
        node_area: operators.node_area(parameters),
        pressure_scale: operators.scales.pressure,
        penetration: fields.penetration * operators.scales.displacement,
        contact_length: contact_length(operators, fields),
        contact_breadth: 0.0,
        contact_area: 0.0,
        peak_rise,
        wear_depth: wear_left_behind(operators, fields, problem.conditions.motion.rolling_speed),
        leaving_rise: operators
            .heat
            .equivalent_rise(fields.column(operators, transport.outflow())),
        leaving_wear_depth: fields.wear[transport.outflow()],
        wheel_heat: ContactHeat::new(
            parameters,
            problem.unit_force(),
            LineOperators::heated_nodes(problem, fields, fields),
        ),
        wheel_temperature: fields.wheel_temperature,
        damage: damage(problem, fields, peak_rise),
        on_wheelset: OnWheelset::default(),
    }
}

/// Damage to the points of the rail, whose surface is at most `peak_rise` `K` over the ambient.
fn damage(problem: &LineProblem, fields: &LineFields, peak_rise: f64) -> PointDamage {
    let (operators, parameters) = (problem.operators, problem.parameters);
    let loaded = (0..fields.pressure.len()).filter(|&node| fields.pressure[node] > 0.0);
    let points = loaded.map(|node| (fields.pressure[node], fields.shear[node].abs()));
    let rise = parameters.austenite_temperature - problem.conditions.inputs.ambient_temperature;
    let columns = (0..operators.mesh.columns()).map(|column| fields.column(operators, column).iter().copied());
    PointDamage {
        surface_fatigue: damage::surface_fatigue_index(
            points,
            parameters.shear_yield_stress / operators.scales.pressure,
        ),
        austenite_depth: if peak_rise > rise {
            isotherm::depth(&operators.heat.basis, &operators.mesh.depth, rise, columns)
        } else {
            0.0
        },
    }
}

fn nodes(problem: &LineProblem, fields: &LineFields) -> impl Iterator<Item = Node> {
    let mesh = &problem.operators.mesh;
    let regularisation = problem.parameters.slip_regularisation;
    let wear = problem.pointwise_wear();
    (0..mesh.contact_nodes).map(move |node| {
        let (pressure, slip) = (fields.pressure[node], fields.slip[node]);
        Node {
            position: mesh.contact_position(node),
            lateral: 0.0,
            pressure,
            shear: fields.shear[node],
            lateral_shear: 0.0,
            slip,
            lateral_slip: 0.0,
            friction: fields.friction[node],
            heat_flux: fields.heat_flux[node],
            wear_rate: wear.map_or(0.0, |law| law.rate(&problem.rubbing(fields, node))),
            sticks: pressure > 0.0 && coulomb::sticks(fields.utilisation[node], regularisation),
        }
    })
}

/// Distance between the ends of the contact. At an end the pressure falls like the root of the distance, so its
/// square is linear there and its zero is found between the nodes.
fn contact_length(operators: &LineOperators, fields: &LineFields) -> f64 {
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
                * operators.mesh.contact_spacing()
        }
        _ => 0.0,
    }
}

/// Wear depth at the end of the window where material leaves it; at rest the deepest, `m`.
fn wear_left_behind(operators: &LineOperators, fields: &LineFields, rolling_speed: f64) -> f64 {
    let mesh = &operators.mesh;
    let window = &fields.wear[mesh.window()];
    if rolling_speed > 0.0 {
        window[0]
    } else if rolling_speed < 0.0 {
        window[window.len() - 1]
    } else {
        window.iter().fold(0.0, |m, &w| w.max(m))
    }
}
