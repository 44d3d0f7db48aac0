//! The tractions of one iteration, temperature and wear as the iteration has them: pressure for the shear there is, then friction
//! for that pressure ([`shear`]).

use super::fields::PatchFields;
use super::problem::PatchProblem;
use super::shear;
use super::solvers::PatchSolvers;
use crate::body::influence::Window;
use crate::contact::interface::Interface;
use crate::error::Result;
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::normal_tangential::TractionChange;
use crate::mechanics::patch::normal::PatchNormalProblem;
use crate::numerics::dense::{self, largest, largest_change};

/// (31): pressure for the shear there is, then friction for that pressure.
pub fn solve(
    problem: &PatchProblem,
    interface: &Interface,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    if problem.is_unloaded() {
        solvers.contact.list(&problem.operators.grid, |_| false);
        lift_off(problem, interface, fields, solvers);
        return Ok(TractionChange::NONE);
    }
    let solved = solve_normal(problem, problem.constraint(), interface, fields, solvers, tolerance);
    if solved.is_err() {
        // Friction must not go on with what it has of the cells that were under pressure before.
        solvers.friction.start_contact();
    }
    let set_changed = solved?;
    follow(problem, interface, fields, solvers, set_changed, tolerance)
}

/// Friction for the pressure that has been solved, with another set of cells under it than before or not.
pub fn follow(
    problem: &PatchProblem,
    interface: &Interface,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
    set_changed: bool,
    tolerance: f64,
) -> Result<TractionChange> {
    if set_changed {
        solvers.friction.start_contact();
    }
    for component in 0..2 {
        solvers.shear_before[component].copy_from_slice(&fields.shear[component]);
    }
    if solvers.contact.cells() == 0 {
        lift_off(problem, interface, fields, solvers);
        return Ok(TractionChange {
            set_changed,
            ..TractionChange::NONE
        });
    }
    shear::solve(problem, interface, fields, solvers, tolerance)?;
    let change = (0..2)
        .map(|component| largest_change(&fields.shear[component], &solvers.shear_before[component]))
        .fold(0.0, f64::max);
    let peak = largest(&fields.pressure);
    Ok(TractionChange {
        shear_change: change / peak,
        set_changed,
        law_residual: solvers.friction.left() / peak,
    })
}

/// Clears the tractions where there is no contact. The displacement that does not come from shear is computed all the same: the one
/// that is left from the contact before would act on the next one.
pub fn lift_off(problem: &PatchProblem, interface: &Interface, fields: &mut PatchFields, solvers: &mut PatchSolvers) {
    fields.pressure.fill(0.0);
    fields.friction.fill(0.0);
    for vectors in [&mut fields.shear, &mut fields.slip] {
        vectors.iter_mut().for_each(|component| component.fill(0.0));
    }
    fields.memory.now.speed.fill(0.0);
    fields.memory.now.flow.fill(0.0);
    fields.penetration = 0.0;
    shear::given_displacement(problem, interface, fields, solvers);
}

/// (37). Returns whether other cells are under pressure than before.
pub fn solve_normal(
    problem: &PatchProblem,
    constraint: Constraint,
    interface: &Interface,
    fields: &mut PatchFields,
    solvers: &mut PatchSolvers,
    tolerance: f64,
) -> Result<bool> {
    let operators = problem.operators;
    let grid = &operators.grid;
    let (gap, undeformed) = (&mut solvers.gap, &solvers.undeformed.gap);
    dense::vectorised(
        #[inline(always)]
        |_| {
            let worn = interface.gap().chunks_exact(grid.cells);
            let surfaces = worn.zip(interface.displacement().chunks_exact(grid.cells));
            for (strip, (worn, raised)) in surfaces.take(grid.strips).enumerate() {
                let row = grid.row(strip);
                let surfaces = undeformed[row.clone()].iter().zip(worn).zip(raised);
                for (gap, ((undeformed, worn), raised)) in gap[row].iter_mut().zip(surfaces) {
                    *gap = undeformed + worn - raised;
                }
            }
        },
    );
    std::mem::swap(&mut solvers.contact, &mut solvers.contact_before);
    let normal_problem = PatchNormalProblem {
        tolerance: tolerance.max(problem.settings.patch.least_tolerance),
        ..problem.normal_problem(&solvers.gap, &solvers.wear_compliance, constraint)
    };
    let solved = solvers
        .normal
        .solve(&normal_problem, &mut solvers.contact, &mut fields.pressure);
    fields.penetration = solved?;
    Ok(solvers.contact != solvers.contact_before)
}

/// Sets the displacement of the fields at the end of the step, and its change. The part that does not come from shear is that which
/// the tractions were solved for.
pub fn finalise_displacement(problem: &PatchProblem, fields: &mut PatchFields, solvers: &mut PatchSolvers) {
    let operators = problem.operators;
    let window = Window {
        loaded: solvers.contact.window(&operators.grid, 0).loaded,
        ..Window::whole(&operators.grid)
    };
    let [x, y] = &mut solvers.shear_displacement;
    let load = [&fields.shear[0][..], &fields.shear[1][..]];
    operators
        .transform
        .apply(&operators.displacement, &window, load, [x, y], &mut solvers.products);
    for component in 0..2 {
        let parts = solvers.given[component]
            .iter()
            .zip(&solvers.shear_displacement[component])
            .zip(&solvers.before[component]);
        let displacements = fields.displacement[component]
            .iter_mut()
            .zip(&mut fields.displacement_change[component]);
        for ((now, change), ((given, by_shear), before)) in displacements.zip(parts) {
            *now = given + by_shear;
            *change = *now - before;
        }
    }
}
