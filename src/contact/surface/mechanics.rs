//! The tractions of one iteration: pressure in all windows at the height of the wheel that carries the load, then friction.
//!
//! The wheel is lower by the approach a than where the undeformed bodies touch first. At a height, the normal problem of each window
//! stands by itself; the vertical forces of all windows, of the pressure and of the friction, add up to the load Q:
//!
//! Σ ∫ (p cos δ − τ_s sin δ) dA = Q.
//!
//! The friction is that of the iteration before, in proportion to the pressure: where all slides, that is exact at once. The approach
//! is found by the secant method within bounds.

use super::fields::SurfaceFields;
use super::operators::SurfaceOperators;
use super::solvers::{SurfaceSolvers, WindowSolvers};
use super::windows::Place;
use crate::contact::engine::Engine;
use crate::contact::interface::Interface;
use crate::contact::patch::fields::PatchFields;
use crate::contact::patch::mechanics;
use crate::contact::patch::operators::PatchOperators;
use crate::contact::patch::problem::PatchProblem;
use crate::contact::problem::Problem;
use crate::error::{Error, Result};
use crate::mechanics::normal::normal_problem::Constraint;
use crate::mechanics::normal_tangential::TractionChange;
use crate::parameters::Control;

/// Problem of a step of a contact of profiles.
pub type SurfaceProblem<'a> = Problem<'a, SurfaceOperators>;

/// Limit of the approaches that are tried for a load.
const APPROACHES: usize = 40;
/// Error of the load that is not worth another approach, relative: the pressure has more.
const LOAD_TOLERANCE: f64 = 1e-9;
/// Room for windows beyond which a contact is held within them.
pub const LARGEST_ROOM: f64 = 4.0;

impl<'a> SurfaceProblem<'a> {
    /// Problem of one window.
    pub fn of(&self, place: &Place) -> PatchProblem<'a> {
        PatchProblem {
            operators: self.operators.of(place),
            parameters: self.parameters,
            settings: self.settings,
            conditions: self.conditions,
        }
    }

    /// Whether the height of the wheel is given, and the load follows.
    pub fn is_height_given(&self) -> bool {
        self.parameters.control == Control::Height
    }

    /// Vertical load to carry, `N`. A negligible one counts as none.
    pub fn vertical_load(&self) -> f64 {
        let load = self.conditions.inputs.normal_load;
        self.settings.mechanics.carried_load(load, self.parameters.largest_load)
    }
}

/// Vertical forces of a window on the wheel: of the pressure and of the friction, `N`.
pub fn vertical_forces(operators: &PatchOperators, window: &WindowSolvers, fields: &PatchFields) -> [f64; 2] {
    let grid = &operators.grid;
    let mut forces = [0.0; 2];
    for (strip, point) in window.geometry.points.iter().enumerate() {
        let sum = |values: &[f64]| values[grid.row(strip)].iter().sum::<f64>();
        forces[0] += point.normal[1] * sum(&fields.pressure);
        forces[1] -= point.tangent()[1] * sum(&fields.shear[1]);
    }
    forces.map(|force| operators.unit_force() * force)
}

/// (31): pressure for the load and the shear there is, then friction for that pressure.
pub fn solve(
    problem: &SurfaceProblem,
    interface: &Interface,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<TractionChange> {
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        own.interface.take_window(interface, window);
        own.contact_before.clone_from(&own.patch.contact);
        let [normal, friction] = vertical_forces(problem.operators.of(&place), own, &fields.windows[window]);
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
    press(problem, fields, solvers, tolerance)?;
    let mut change = TractionChange::NONE;
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
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
        change.shear_change = change.shear_change.max(if touches { own_change.shear_change } else { 0.0 });
        change.set_changed |= own_change.set_changed;
    }
    if !problem.is_height_given() {
        // The load that the friction has made of it is another one than asked for: so far have the tractions changed.
        let load = problem.vertical_load();
        fields.load = carried(problem, fields, solvers);
        change.shear_change = change.shear_change.max((fields.load / load - 1.0).abs());
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
            let own = &solvers.windows[window];
            let [normal, friction] = vertical_forces(problem.operators.of(&place), own, &fields.windows[window]);
            normal + friction
        })
        .sum()
}

/// Solves the pressure of all windows, at the approach that carries the load or at the given one.
fn press(
    problem: &SurfaceProblem,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<()> {
    if problem.is_height_given() {
        return press_at(problem, solvers.reference, fields, solvers, tolerance).map(|_| ());
    }
    let load = problem.vertical_load();
    let mut approach = fields.approach[0].max(0.05 * solvers.reference);
    let mut bounds = [0.0, f64::INFINITY];
    let mut last: Option<[f64; 2]> = None;
    let mut left = f64::INFINITY;
    for _ in 0..APPROACHES {
        let excess = press_at(problem, approach, fields, solvers, tolerance)? - load;
        left = (excess / load).abs();
        bounds[usize::from(excess > 0.0)] = approach;
        let stiffness = match last {
            Some([before, excess_before]) if before != approach && excess != excess_before => {
                (excess - excess_before) / (approach - before)
            }
            _ if fields.stiffness > 0.0 => fields.stiffness,
            _ => 1.5 * (excess + load).max(0.1 * load) / approach,
        };
        if stiffness > 0.0 && stiffness.is_finite() && last.is_some() {
            fields.stiffness = stiffness;
        }
        if left <= tolerance.max(LOAD_TOLERANCE) {
            fields.approach[0] = approach;
            return check_room(problem, fields, solvers);
        }
        last = Some([approach, excess]);
        let next = approach - excess / stiffness;
        let inside = next > bounds[0] && next < bounds[1] && stiffness > 0.0;
        approach = if inside {
            next.min(2.0 * approach)
        } else if bounds[1].is_finite() {
            0.5 * (bounds[0] + bounds[1])
        } else {
            2.0 * approach
        };
    }
    Err(Error::NormalNotConverged {
        solver: "height of the wheel",
        iterations: APPROACHES,
        residual: left,
        tolerance,
    })
}

/// Solves the pressure of all windows at an approach. Returns the vertical force with the friction in proportion, `N`.
fn press_at(
    problem: &SurfaceProblem,
    approach: f64,
    fields: &mut SurfaceFields,
    solvers: &mut SurfaceSolvers,
    tolerance: f64,
) -> Result<f64> {
    let lowered = approach - solvers.reference;
    let mut force = 0.0;
    for (window, place) in fields.used() {
        let own = &mut solvers.windows[window];
        let patch = problem.of(&place);
        let scale = patch.operators.scales.displacement;
        let gaps = own.patch.undeformed.gap.iter_mut().zip(&own.gap);
        for ((gap, reference), rise) in gaps.zip(&own.geometry.rise) {
            *gap = reference - lowered * rise / scale;
        }
        mechanics::solve_normal(
            &patch,
            Constraint::Penetration(0.0),
            &own.interface,
            &mut fields.windows[window],
            &mut own.patch,
            tolerance,
        )?;
        let [normal, _] = vertical_forces(patch.operators, own, &fields.windows[window]);
        force += normal * (1.0 + own.friction_share);
    }
    Ok(force)
}

/// Refuses a contact that has become larger than its window, as long as there are larger ones.
fn check_room(problem: &SurfaceProblem, fields: &SurfaceFields, solvers: &SurfaceSolvers) -> Result<()> {
    if problem.conditions.room >= LARGEST_ROOM {
        return Ok(());
    }
    for (window, place) in fields.used() {
        if PatchOperators::is_cut_off(&problem.of(&place), &fields.windows[window], &solvers.windows[window].patch) {
            return Err(Error::ContactOutgrowsWindow);
        }
    }
    Ok(())
}
