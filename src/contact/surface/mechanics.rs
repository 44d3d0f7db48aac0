//! The tractions of one iteration: pressure in all windows at the height of the wheel that carries the load, then friction.
//!
//! The wheel is lower by the approach a than where the undeformed bodies touch first. At a height, the normal problem of each window
//! stands by itself; the vertical forces of all windows, of the pressure and of the friction, add up to the load Q:
//!
//! Σ ∫ (p cos δ − τ_s sin δ) dA = Q, with the inclination δ to the track's plane, the roll of the rail included.
//!
//! The friction is that of the iteration before, in proportion to the pressure: where all slides, that is exact at once. The approach
//! is found in [`super::pressure`].

use super::fields::SurfaceFields;
use super::pressure::{hold, least_load_error, press};
use super::problem::SurfaceProblem;
use super::solvers::SurfaceSolvers;
use crate::contact::interface::Interface;
use crate::contact::patch::mechanics;
use crate::contact::problem::Coupling;
use crate::error::Result;
use crate::mechanics::normal_tangential::TractionChange;

/// (31): pressure for the load and the shear there is, then friction for that pressure.
pub fn solve(
    problem: &SurfaceProblem,
    interface: &Interface,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    for (window, place) in fields.used() {
        let [normal, friction] = problem.vertical_forces(fields, solvers, window, &place);
        let own = &mut solvers.windows[window];
        own.interface.take_window(interface, window);
        own.contact_before.copy_from(&own.patch.contact);
        own.friction_share = if normal > 0.0 { friction / normal } else { 0.0 };
    }
    let unloaded = if problem.is_height_given() {
        solvers.reference <= 0.0
    } else {
        problem.vertical_load() == 0.0
    };
    if unloaded {
        fields.load = 0.0;
        for (window, place) in fields.used() {
            let own = &mut solvers.windows[window];
            let patch = problem.of(&place);
            own.patch.contact.list(&patch.operators.grid, |_| false);
            mechanics::lift_off(&patch, &own.interface, &mut fields.windows[window], &mut own.patch);
        }
        return Ok(TractionChange::NONE);
    }
    let pressed = if problem.conditions.coupling == Coupling::Held {
        hold(problem, fields, solvers)
    } else {
        press(problem, fields, solvers, tolerance)
    };
    if pressed.is_err() {
        // Friction must not go on with what it has of the cells that were under pressure before.
        for own in &mut solvers.windows {
            own.patch.friction.start_contact();
        }
    }
    pressed?;
    let motion = problem.pose().motion;
    let lowered = fields.approach[0] - solvers.reference;
    let mut change = TractionChange::NONE;
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        if !problem.is_height_given() {
            let undeformed = &mut own.patch.undeformed;
            own.geometry
                .raise_slip(problem.operators, &place, &motion, -lowered, undeformed);
        }
        let set_changed = own.patch.contact != own.contact_before;
        let patch = problem.of(&place);
        let own_change = mechanics::follow(
            &patch,
            &own.interface,
            &mut fields.windows[window],
            &mut own.patch,
            set_changed,
            tolerance,
        )?;
        let touches = own.patch.contact.cells() > 0;
        change.shear_change = change
            .shear_change
            .max(if touches { own_change.shear_change } else { 0.0 });
        change.set_changed |= own_change.set_changed;
        change.law_residual = change.law_residual.max(own_change.law_residual);
    }
    if !problem.is_height_given() {
        // The load that the friction has made of it is another one than asked for: so far have the tractions changed.
        let load = problem.vertical_load();
        fields.load = carried(problem, fields, solvers);
        // The pressure does not carry it better than it is solved.
        let missing = (fields.load / load - 1.0).abs() - 2.0 * least_load_error(problem, load);
        change.shear_change = change.shear_change.max(missing);
    } else {
        fields.load = carried(problem, fields, solvers);
    }
    Ok(change)
}

/// Vertical force of all windows, `N`.
fn carried(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &SurfaceSolvers) -> f64 {
    fields
        .used()
        .map(|(window, place)| {
            let [normal, friction] = problem.vertical_forces(fields, solvers, window, &place);
            normal + friction
        })
        .sum()
}
