//! Friction of the cells under pressure where it depends on slip, for the history that the particles of their strip bring along.

use super::fields::PatchFields;
use super::problem::PatchProblem;
use super::solvers::PathScratch;
use crate::friction::path::PathLaw;
use crate::mechanics::patch::contact::Contact;
use std::ops::Range;

/// Cells of a strip.
fn cells(problem: &PatchProblem, strip: usize) -> Range<usize> {
    let cells = problem.operators.grid.cells;
    strip * cells..(strip + 1) * cells
}

/// Sets the friction law of the cells under pressure for the history that their particles bring along, with μ(θ) of all cells in
/// the fields.
pub fn prepare(
    problem: &PatchProblem,
    law: &PathLaw,
    contact: &Contact,
    pressure: &[f64],
    fields: &PatchFields,
    scratch: &mut PathScratch,
) {
    let grid = &problem.operators.grid;
    scratch.index.fill(None);
    for run in contact.runs() {
        for (k, (index, place)) in run.indices().zip(run.places(grid)).enumerate() {
            scratch.index[run.strip * grid.cells + run.first + k] = Some(index);
            scratch.pressure[index] = pressure[place];
        }
    }
    let PathScratch { nodes, index, .. } = scratch;
    for strip in 0..grid.strips {
        let range = cells(problem, strip);
        let (index, static_friction) = (&index[range.clone()], &fields.memory.now.static_friction[range.clone()]);
        let path = fields.memory.before.path(range);
        law.prepare(
            &path,
            static_friction,
            |cell| index[cell].is_some(),
            |cell, node| {
                if let Some(index) = index[cell] {
                    nodes[index] = node;
                }
            },
        );
    }
}
