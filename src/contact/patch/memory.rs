//! Friction that depends on slip, on the strips: what the particles of each strip bring along.

use super::fields::PatchFields;
use super::problem::Problem;
use super::scratch::PathScratch;
use crate::friction::memory::Memory;
use crate::friction::path::PathLaw;
use crate::mechanics::patch::contact::Contact;
use std::ops::Range;

/// The cells of a strip.
fn cells(problem: &Problem, strip: usize) -> Range<usize> {
    let cells = problem.operators.grid.cells;
    strip * cells..(strip + 1) * cells
}

/// The friction law of the cells under pressure at what their particles bring along, with μ(θ) of all cells in the fields.
pub fn prepare(
    problem: &Problem,
    law: &PathLaw,
    (contact, pressure): (&Contact, &[f64]),
    fields: &PatchFields,
    scratch: &mut PathScratch,
) {
    let grid = &problem.operators.grid;
    scratch.index.fill(None);
    for run in contact.runs() {
        for (k, (index, place)) in run.own().zip(run.places(grid)).enumerate() {
            scratch.index[run.strip * grid.cells + run.first + k] = Some(index);
            scratch.pressure[index] = pressure[place];
        }
    }
    let PathScratch { nodes, index, .. } = scratch;
    for strip in 0..grid.strips {
        let own = cells(problem, strip);
        let (index, resting) = (&index[own.clone()], &fields.memory.now.resting[own.clone()]);
        let path = fields.memory.before.path(own);
        law.prepare(
            &path,
            resting,
            |cell| index[cell].is_some(),
            |cell, node| {
                if let Some(index) = index[cell] {
                    nodes[index] = node;
                }
            },
        );
    }
}

/// What the rail brings along from the step before.
pub fn remember(problem: &Problem, before: &PatchFields, fields: &mut PatchFields) {
    let remembers = Memory::is_kept(problem.parameters);
    fields.memory.remembers = remembers;
    if remembers {
        let law = problem.friction();
        let resting = |index: usize| law.coefficient(before.heat.surface[index]).0;
        fields.memory.start_from(&before.memory, resting);
    }
}

/// What the rail takes along into the next step.
pub fn close(problem: &Problem, fields: &mut PatchFields) {
    fields.memory.remembers = Memory::is_kept(problem.parameters);
    let (Some(path_law), true) = (problem.path_law(), fields.memory.remembers) else {
        return;
    };
    let (grid, law) = (&problem.operators.grid, problem.friction());
    let PatchFields {
        memory, pressure, heat, ..
    } = fields;
    for (resting, temperature) in memory.now.resting.iter_mut().zip(&heat.surface) {
        *resting = law.coefficient(*temperature).0;
    }
    for strip in 0..grid.strips {
        let (own, row) = (cells(problem, strip), grid.row(strip));
        let pressure = &pressure[row];
        let before = memory.before.path(own.clone());
        let now = &mut memory.now;
        let touches = |cell: usize| pressure[cell] > 0.0;
        path_law.close(&before, &now.resting[own.clone()], touches, &mut now.friction[own]);
    }
}

/// Change of μ of the cells at unchanged slip, with that of |V| by `speed` `m/s`, with that of μ(θ), strip by strip in `resting`, and with
/// that of the pressure on the grid.
pub fn tangent(
    problem: &Problem,
    law: &PathLaw,
    fields: &PatchFields,
    (speed, resting, pressure_change): (f64, &[f64], &[f64]),
    friction: &mut [f64],
) {
    let grid = &problem.operators.grid;
    for strip in 0..grid.strips {
        let own = cells(problem, strip);
        let (pressure, changes) = (&fields.pressure[grid.row(strip)], &pressure_change[grid.row(strip)]);
        let (before, now) = (&fields.memory.before, &fields.memory.now);
        law.tangent(
            (&before.path(own.clone()), &now.path(own.clone())),
            (pressure, |cell| changes[cell]),
            (speed, &resting[own.clone()]),
            &mut friction[own],
        );
    }
}
