//! The tractions of one iteration: pressure in all windows at the height of the wheel that carries the load, then friction.
//!
//! The wheel is lower by the approach a than where the undeformed bodies touch first. At a height, the normal problem of each window
//! stands by itself; the vertical forces of all windows, of the pressure and of the friction, add up to the load Q:
//!
//! Σ ∫ (p cos δ − τ_s sin δ) dA = Q, with the inclination δ to the track's plane, the roll of the rail included.
//!
//! The friction is that of the iteration before at the temperature that there is by now, in proportion to the pressure: where all slides, that is exact at once. The approach
//! is found in [`super::pressure`]. The friction that follows, in each window for what the shear of the others does to it by then, is a
//! slightly different one, and with it the load is no longer met. Pressure and friction are corrected for that at once, before heat and wear see them.

use super::approach_response::{advance, stiffness};
use super::fields::SurfaceFields;
use super::pressure::{RESPONDS, hold, least_load_error, press};
use super::problem::SurfaceProblem;
use super::solvers::SurfaceSolvers;
use super::windows::Place;
use crate::contact::interface::Interface;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::heat_and_wear::set_friction;
use crate::contact::patch::mechanics;
use crate::contact::problem::Coupling;
use crate::error::Result;
use crate::mechanics::normal_tangential::TractionChange;

/// Largest error of the tractions of a window that is alone, relative to the peak pressure, even if the caller would accept a larger one: what is missing of the load, which is
/// corrected for, is known no better than the friction is. With several windows it saved no iteration, and took more Newton steps.
const ALONE: f64 = 1e-4;

/// (31): pressure for the load and the shear there is, then friction for that pressure.
pub fn solve(
    problem: &SurfaceProblem,
    interface: &Interface,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    let is_alone = fields.used().count() == 1;
    let tolerance = if is_alone { tolerance.min(ALONE) } else { tolerance };
    begin(problem, interface, fields, solvers);
    let unloaded = if problem.is_height_given() {
        solvers.reference <= 0.0
    } else {
        problem.vertical_load() == 0.0
    };
    if unloaded {
        lift_off(problem, fields, solvers);
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
    solvers.followed = true;
    let mut change = rub(problem, fields, solvers, tolerance)?;
    fields.load = carried(problem, fields, solvers);
    if !problem.is_height_given() {
        // The load that the friction has made of it is another one than asked for: so far have the tractions changed.
        let load = problem.vertical_load();
        // The pressure does not carry it better than it is solved.
        let missing = (fields.load / load - 1.0).abs() - 2.0 * least_load_error(problem, load);
        change.shear_change = change.shear_change.max(missing);
        if missing > tolerance && problem.conditions.coupling == Coupling::Implicit {
            carry_load(problem, fields, solvers);
        }
    }
    Ok(change)
}

/// Takes what heat and wear have made of the interface into each window: after the first iteration the friction of the new temperatures too. What the
/// tractions are compared with is kept.
fn begin(problem: &SurfaceProblem, interface: &Interface, fields: &mut SurfaceFields, solvers: &mut SurfaceSolvers) {
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        own.interface.take_window(interface, window);
        if solvers.followed {
            let (patch, contact) = (problem.of(&place), &own.patch.contact);
            let rise = |_: &PatchFields, index: usize| own.interface.temperature(index);
            set_friction(&patch, &mut fields.windows[window], contact, rise);
        }
        let friction_share = friction_share(problem, fields, solvers, window, &place);
        let own = &mut solvers.windows[window];
        own.contact_before.copy_from(&own.patch.contact);
        own.pressure_before.copy_from_slice(&fields.windows[window].pressure);
        own.friction_share = friction_share;
    }
}

/// Takes the tractions off all windows: the wheel stands above the rail, or carries nothing.
fn lift_off(problem: &SurfaceProblem, fields: &mut SurfaceFields, solvers: &mut SurfaceSolvers) {
    fields.load = 0.0;
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        let patch = problem.of(&place);
        own.patch.contact.list(&patch.operators.grid, |_| false);
        mechanics::lift_off(&patch, &own.interface, &mut fields.windows[window], &mut own.patch);
    }
}

/// Friction of each window for its pressure, and for what the shear of the others by then does to it. Returns how far that changes the tractions.
fn rub(
    problem: &SurfaceProblem,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    let is_alone = fields.used().count() == 1;
    let motion = problem.pose().motion;
    let lowered = fields.approach[0] - solvers.reference;
    let mut change = TractionChange::NONE;
    if !is_alone {
        solvers.apart_shear.set_resultants(problem.operators, fields);
    }
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        if !is_alone {
            let apart = &mut solvers.apart_shear;
            apart.displace(problem.operators, window, &place);
            for (beside, by_others) in own.patch.beside.iter_mut().zip(&apart.displacement[window]) {
                beside.copy_from_slice(by_others);
            }
        }
        if !problem.is_height_given() {
            let undeformed = &mut own.patch.undeformed;
            own.geometry
                .raise_slip(problem.operators, &place, &motion, -lowered, undeformed);
        }
        follow_pressure(&own.pressure_before, &mut fields.windows[window]);
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
        solvers
            .apart_shear
            .take_for_others(problem.operators, fields, window, &place);
    }
    Ok(change)
}

/// Changes the shear of each cell in proportion to its pressure: where all slides, that is the shear that follows.
fn follow_pressure(before: &[f64], fields: &mut PatchFields) {
    let [along, across] = &mut fields.shear;
    let pressures = fields.pressure.iter().zip(before);
    for ((along, across), (now, before)) in along.iter_mut().zip(across).zip(pressures) {
        let ratio = if *before > 0.0 { now / before } else { 1.0 };
        (*along, *across) = (ratio * *along, ratio * *across);
    }
}

/// Corrects the pressure, by its response to the approach, so that it carries the load with the friction there is. The shear of each cell
/// changes in proportion to the pressure on it. Most steps on the tread then need two iterations in place of three.
fn carry_load(problem: &SurfaceProblem, fields: &mut SurfaceFields, solvers: &mut SurfaceSolvers) {
    let missing = problem.vertical_load() - fields.load;
    if missing.abs() >= RESPONDS * problem.vertical_load() {
        return;
    }
    for (window, place) in fields.used() {
        solvers.windows[window].friction_share = friction_share(problem, fields, solvers, window, &place);
    }
    let Some(stiffness) = stiffness(problem, fields, solvers) else {
        return;
    };
    let lower = missing / stiffness;
    for (window, place) in fields.used() {
        let per_approach = lower / problem.operators.of(&place).scales.displacement;
        let (own, response) = (&mut fields.windows[window], &solvers.windows[window].response);
        let [along, across] = &mut own.shear;
        let pressures = own.pressure.iter().zip(&response.pressure);
        for ((along, across), (pressure, response)) in along.iter_mut().zip(across).zip(pressures) {
            if *pressure > 0.0 {
                let ratio = (1.0 + per_approach * response / pressure).max(0.0);
                (*along, *across) = (ratio * *along, ratio * *across);
            }
        }
    }
    advance(problem, lower, fields, solvers);
    fields.approach[0] += lower;
}

/// Vertical force of a window's friction over that of its pressure.
fn friction_share(
    problem: &SurfaceProblem,
    fields: &SurfaceFields,
    solvers: &SurfaceSolvers,
    window: usize,
    place: &Place,
) -> f64 {
    let [normal, friction] = problem.vertical_forces(fields, solvers, window, place);
    if normal > 0.0 { friction / normal } else { 0.0 }
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
