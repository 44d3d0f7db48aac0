//! Integrals over a patch, its extent, and the profiles' values that the outputs are made of.

use super::extent::extent;
use super::fields::PatchFields;
use super::operators::PatchOperators;
use super::problem::PatchProblem;
use crate::contact::engine::Engine;
use crate::contact::integrals::Integrals;
use crate::contact::integrals::{Node, NodeSums};
use crate::contact::on_wheelset::OnWheelset;
use crate::contact::rim::ContactHeat;
use crate::damage::{self, PointDamage};
use crate::friction::coulomb;
use crate::heat::isotherm;

/// Distance from the bound, relative, within which a cell slides: the bound is that at the final temperature of a step, to whose tolerance, 1e-5, it is the
/// one that the shear was solved for.
const SLIDES: f64 = 1e-4;

/// Integrals of the given fields under the problem's conditions.
pub fn integrals(problem: &PatchProblem, fields: &PatchFields) -> Integrals {
    let operators = problem.operators;
    let extent = extent(operators, &fields.pressure);
    let heat = problem.heat_march();
    let peak_rise = fields.heat.surface.iter().fold(f64::NEG_INFINITY, |m: f64, t| t.max(m));
    Integrals {
        sums: NodeSums::of(nodes(problem, fields)),
        node_area: operators.grid.cell_area(),
        pressure_scale: operators.scales.pressure,
        penetration: fields.penetration * operators.scales.displacement,
        contact_length: extent.length,
        contact_breadth: extent.breadth,
        contact_area: extent.area,
        peak_rise,
        wear_depth: (0..operators.grid.strips)
            .map(|strip| wear_left_behind(problem, fields, strip))
            .fold(0.0, f64::max),
        leaving_rise: operators
            .incoming
            .equivalent_rise(&operators.basis, heat.leaving(&fields.heat)),
        leaving_wear_depth: problem.wear_march().leaving(&fields.wear),
        wheel_heat: ContactHeat::new(
            problem.parameters,
            operators.unit_force(),
            PatchOperators::heated_nodes(problem, fields, fields),
        ),
        wheel_temperature: fields.wheel_temperature,
        damage: damage(problem, fields, peak_rise),
        on_wheelset: OnWheelset::default(),
    }
}

/// Damage to the points of the rail, whose surface is at most `peak_rise` `K` over the ambient.
pub fn damage(problem: &PatchProblem, fields: &PatchFields, peak_rise: f64) -> PointDamage {
    let (operators, parameters) = (problem.operators, problem.parameters);
    let loaded = (0..fields.pressure.len()).filter(|&place| fields.pressure[place] > 0.0);
    let points = loaded.map(|place| {
        let shear = [fields.shear[0][place], fields.shear[1][place]];
        (fields.pressure[place], coulomb::magnitude(shear))
    });
    let rise = parameters.austenite_temperature - problem.conditions.inputs.ambient_temperature;
    let strips = &operators.strips;
    let columns = (0..strips.strips)
        .flat_map(|strip| (0..strips.cells).map(move |cell| fields.heat.amplitudes(strips, strip, cell)));
    PointDamage {
        surface_fatigue: damage::surface_fatigue_index(
            points,
            parameters.shear_yield_stress / operators.scales.pressure,
        ),
        austenite_depth: if peak_rise > rise {
            isotherm::depth(&operators.basis, &operators.depth, rise, columns)
        } else {
            0.0
        },
    }
}

/// Cells that carry or that heat passes through: the others add nothing.
fn nodes<'f>(problem: &'f PatchProblem, fields: &'f PatchFields) -> impl Iterator<Item = Node> + 'f {
    let grid = &problem.operators.grid;
    let regularisation = problem.parameters.slip_regularisation;
    let wear = problem.pointwise_wear();
    (0..grid.strips).flat_map(move |strip| {
        let flux = &fields.heat.flux[strip * grid.cells..][..grid.cells];
        let adds = move |cell: &usize| fields.pressure[grid.place(strip, *cell)] > 0.0 || flux[*cell] != 0.0;
        (0..grid.cells).filter(adds).map(move |cell| {
            let place = grid.place(strip, cell);
            let pressure = fields.pressure[place];
            let shear = [fields.shear[0][place], fields.shear[1][place]];
            let bound = fields.friction[place] * pressure;
            let utilisation = if bound > 0.0 {
                coulomb::magnitude(shear) / bound
            } else {
                1.0
            };
            Node {
                position: grid.x(cell),
                lateral: grid.y(strip),
                pressure,
                shear: shear[0],
                lateral_shear: shear[1],
                slip: fields.slip[0][place],
                lateral_slip: fields.slip[1][place],
                friction: fields.friction[place],
                heat_flux: flux[cell],
                wear_rate: wear.map_or(0.0, |law| law.rate(&problem.rubbing(fields, place))),
                sticks: pressure > 0.0 && coulomb::sticks(utilisation * (1.0 + SLIDES), regularisation),
            }
        })
    })
}

/// Wear depth of a strip at the end of the window where material leaves it; at rest the deepest, `m`.
pub fn wear_left_behind(problem: &PatchProblem, fields: &PatchFields, strip: usize) -> f64 {
    let cells = problem.operators.grid.cells;
    let depth = &fields.wear.depth[strip * cells..(strip + 1) * cells];
    let speed = problem.conditions.motion.rolling_speed;
    if speed > 0.0 {
        depth[0]
    } else if speed < 0.0 {
        depth[cells - 1]
    } else {
        depth.iter().fold(0.0, |m, &w| w.max(m))
    }
}
