//! Beginning of a step of one window of cells, for the gap and the rigid slip of the undeformed bodies that its solvers hold.

use super::extent::extent;
use super::fields::PatchFields;
use super::heat_and_wear;
use super::operators::relaxation_length;
use super::problem::PatchProblem;
use super::solvers::PatchSolvers;
use crate::body::half_space::HalfSpaces;
use crate::contact::memory;
use crate::error::Result;

/// Begins a step from the fields before it; without any the mechanics stand alone. The relaxation length is that of the fields.
///
/// # Errors
/// Heat that cannot be carried along.
pub fn begin(
    problem: &PatchProblem,
    before: Option<&PatchFields>,
    now: &mut PatchFields,
    solvers: &mut PatchSolvers,
) -> Result<()> {
    for component in 0..2 {
        match before {
            Some(before) => solvers.before[component].copy_from_slice(&before.displacement[component]),
            None => solvers.before[component].fill(0.0),
        }
    }
    if let Some(before) = before {
        memory::begin(problem, before, now);
    }
    solvers.start_step();
    solvers.wear_compliance.fill(0.0);
    let grid = &problem.operators.grid;
    solvers.contact.list(grid, |place| now.pressure[place] > 0.0);
    let strips = solvers.contact.window(grid, 0).strips.len();
    let weights = problem.slip_weights(problem.transient(now.relaxation_length));
    solvers.respond(problem, weights, strips);
    if let Some(before) = before {
        let rise = problem.incoming_rise();
        let march = problem.heat_march();
        march.start(&before.heat, rise, &mut now.heat, &mut solvers.heat)?;
    }
    Ok(())
}

/// Prepares the solvers for the linearisation of a step that has ended with the given fields.
pub fn begin_linearisation(problem: &PatchProblem, fields: &PatchFields, solvers: &mut PatchSolvers) {
    for component in 0..2 {
        let nodes = fields.displacement[component]
            .iter()
            .zip(&fields.displacement_change[component]);
        for (before, (now, change)) in solvers.before[component].iter_mut().zip(nodes) {
            *before = now - change;
        }
    }
    heat_and_wear::take_all_wear(problem, fields, solvers);
}

/// Relaxation length of the contact of the given pressure, `m`; that of the largest load where there is none.
pub fn relaxation_length_of(problem: &PatchProblem, pair: &HalfSpaces, pressure: &[f64]) -> f64 {
    let extent = extent(problem.operators, pressure);
    if extent.length > 0.0 && extent.breadth > 0.0 {
        let half_axes = (0.5 * extent.length, 0.5 * extent.breadth);
        relaxation_length(pair, problem.parameters.layer_compliance, half_axes)
    } else {
        problem.operators.relaxation_length
    }
}
