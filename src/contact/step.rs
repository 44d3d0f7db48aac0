//! One implicit step by the operator split of section 4 of the paper: mechanics for given temperature and wear, then wear and
//! temperature for those tractions. What passes between them is the interface vector x, and one sweep makes G(x) of it. The step
//! is solved where x = G(x): by fixed-point iteration with Anderson's method while that contracts, as it does in most steps in two
//! or three sweeps, otherwise by Newton's method ([`super::newton`]).

use super::convergence::ConvergenceTest;
use super::engine::Engine;
use super::fields::{EngineState, Fields};
use super::interface::Interface;
use super::newton::{self, Newton, Sweeps};
use super::problem::{Convergence, Coupling, Problem};
use super::rail_and_rim;
use super::work::Work;
use crate::error::{Error, Result};
use crate::friction::memory::Memory;
use crate::mechanics::normal_tangential::TractionChange;
use crate::numerics::anderson::Anderson;
use crate::parameters::{ContactModel, Control, Parameters};
use crate::settings::Settings;
use crate::signals::Inputs;

/// Factor on the room for contacts after one has outgrown its window.
pub(super) const MORE_ROOM: f64 = 1.6;

/// Solvers and buffers of a step and of its derivatives. What a step leaves in them changes no result of another one.
pub struct StepWorkspace<E: Engine> {
    pub(super) solvers: E::Solvers,
    /// Fields that a step works on, its solution until it is committed.
    pub(super) trial: E::Fields,
    /// Interface vector that the mechanics see in this sweep.
    pub(super) iterate: Interface,
    /// Image of the interface vector under the sweep.
    pub(super) image: Interface,
    anderson: Anderson,
    work: Work,
    pub(super) newton: Newton<E>,
}

impl<E: Engine> StepWorkspace<E> {
    /// Workspace for the steps of a contact.
    pub fn new(operators: &E, settings: &Settings) -> StepWorkspace<E> {
        let interface = operators.interface();
        StepWorkspace {
            solvers: operators.solvers(settings),
            trial: operators.fields(),
            anderson: Anderson::new(interface.values().len()),
            work: Work::new(settings.step.work),
            newton: Newton::new(operators, settings),
            image: interface.clone(),
            iterate: interface,
        }
    }

    /// Renews the budget of work.
    pub fn renew_budget(&mut self) {
        self.work.restart();
    }

    /// Fields at the end of the step that was solved last.
    pub fn solution(&self) -> &E::Fields {
        &self.trial
    }

    /// Makes the solution of a step of `duration` `s` the state.
    pub fn commit(&mut self, state: &mut EngineState<E::Fields>, duration: f64) {
        state.commit(&mut self.trial, duration);
    }
}

/// Solves the step from `state` into the workspace. The step before took `last_duration` `s`: the first guess is extrapolated over
/// no longer than the rates were observed.
///
/// # Errors
/// The first solver that did not converge, or [`Error::ContactLeavesWindow`].
pub fn solve<E: Engine>(
    problem: &Problem<E>,
    state: &EngineState<E::Fields>,
    last_duration: f64,
    workspace: &mut StepWorkspace<E>,
) -> Result<Convergence> {
    with_room(problem, |problem| {
        solve_in_room(problem, state, last_duration, workspace)
    })
}

/// Tries a step with more and more room for the contacts, as long as one outgrows its window.
fn with_room<E: Engine, T>(problem: &Problem<E>, mut attempt: impl FnMut(&Problem<E>) -> Result<T>) -> Result<T> {
    let mut problem = *problem;
    loop {
        match attempt(&problem) {
            Err(Error::ContactOutgrowsWindow) => problem.conditions.room *= MORE_ROOM,
            other => return other,
        }
    }
}

/// Solves the step in windows that leave as much room as the conditions say.
fn solve_in_room<E: Engine>(
    problem: &Problem<E>,
    state: &EngineState<E::Fields>,
    last_duration: f64,
    workspace: &mut StepWorkspace<E>,
) -> Result<Convergence> {
    let settings = E::split_settings(problem.settings);
    let before = &state.fields;
    let StepWorkspace {
        solvers,
        trial: now,
        iterate,
        image,
        anderson,
        work,
        newton,
    } = workspace;
    begin(problem, before, now, solvers)?;
    E::extrapolate(state, problem.conditions.duration.min(last_duration), now, solvers);
    E::limit_guess(before, now);
    E::read(problem, now, solvers, iterate);
    anderson.restart();
    newton.restart();
    let mut test = ConvergenceTest::new(settings);
    let mut newton_sweeps = None;
    // Whether the iterate is as good as the methods get it: one more sweep ends the step.
    let mut ends = false;
    for iterations in 1..=settings.iterations {
        let before_mechanics = E::mechanics_work(solvers);
        let tractions = E::solve_mechanics(problem, iterate, now, solvers, test.mechanics_tolerance());
        work.add(problem.operators.sweep_work() + E::mechanics_work(solvers).saturating_sub(before_mechanics))?;
        let tractions = tractions?;
        E::march_wear(problem, before, now, solvers);
        rail_and_rim::march_heat(problem, before, iterate, now, solvers)?;
        let renewals = problem.settings.wear_compliance.sweeps;
        if iterations <= renewals {
            E::update_wear_compliance(problem, now, solvers);
        }
        // The first sweep does not end the step: the mechanics have not seen yet what it changed.
        let pending = if iterations > 1 {
            E::pending_displacement(problem, now, solvers)
        } else {
            E::map_displacement(problem, now, solvers);
            f64::INFINITY
        };
        E::read(problem, now, solvers, image);
        // A wheel that digs and glows may lead to numbers that overflow.
        if !image.is_finite() {
            return Err(test.error(iterations));
        }
        let change = iterate.change_to(image, settings.least_temperature);
        let passes = test.is_passed(change.max(pending), &tractions);
        if passes || ends && change.max(pending) <= settings.stalled_tolerance {
            let iterations = iterations + newton_sweeps.unwrap_or(0);
            return finish(problem, before, iterate, now, solvers, iterations, test.change());
        }
        if iterations == 1 {
            test.amend(change);
        } else if pending > settings.negligible * settings.tolerance {
            E::map_displacement(problem, now, solvers);
            E::read(problem, now, solvers, image);
            test.amend(iterate.change_to(image, settings.least_temperature));
        }
        if iterations - 1 <= renewals {
            // Earlier iterates hold the wear beside another wear compliance: swept again, they would have other images.
            newton.forget_closest();
        }
        let idle = newton.keep(iterate, test.change());
        let hard = idle >= settings.idle_iterations || iterations >= settings.fixed_point_iterations;
        if hard && newton.is_close(settings.accepted_change) {
            newton.take_closest(iterate);
            ends = true;
            continue;
        }
        if hard && newton_sweeps.is_none() {
            let sweeps = Sweeps {
                before,
                now: &mut *now,
                solvers: &mut *solvers,
                iterate: &mut *iterate,
                image: &mut *image,
            };
            // Where Newton's method gets no further either, the fixed point goes on from the closest iterate.
            let (count, solved) = newton::solve(problem, newton, sweeps, &mut test, work)?;
            (newton_sweeps, ends) = (Some(count), solved);
            anderson.restart();
            continue;
        }
        ends = iterations + 1 == settings.iterations && newton.is_close(settings.stalled_tolerance);
        if ends {
            newton.take_closest(iterate);
            continue;
        }
        if iterations > settings.accelerate_after && !test.contracts() {
            anderson.next(iterate.values(), image.values_mut());
        }
        std::mem::swap(iterate, image);
    }
    Err(test.error(settings.iterations))
}

/// Takes the step staggered: the mechanics for temperature and wear as the step finds them, then heat and wear for those tractions, once.
/// For a step whose interface vector is not found: of first order as the implicit one, with an error that its residual shows.
///
/// # Errors
/// The first solver that did not converge, or [`Error::ContactLeavesWindow`].
#[cold]
#[inline(never)]
pub fn solve_staggered<E: Engine>(
    problem: &Problem<E>,
    state: &EngineState<E::Fields>,
    workspace: &mut StepWorkspace<E>,
) -> Result<Convergence> {
    with_room(problem, |problem| solve_staggered_in_room(problem, state, workspace))
}

/// Takes the step staggered in windows that leave as much room as the conditions say.
fn solve_staggered_in_room<E: Engine>(
    problem: &Problem<E>,
    state: &EngineState<E::Fields>,
    workspace: &mut StepWorkspace<E>,
) -> Result<Convergence> {
    let settings = E::split_settings(problem.settings);
    let before = &state.fields;
    let StepWorkspace {
        solvers,
        trial: now,
        iterate,
        image,
        ..
    } = workspace;
    begin(problem, before, now, solvers)?;
    E::read(problem, now, solvers, iterate);
    let mut tractions = TractionChange::NONE;
    for _ in 0..problem.settings.interface.mechanics_sweeps {
        // Any of them may be the last; the temperature is a guess in all of them.
        tractions = E::solve_mechanics(problem, iterate, now, solvers, settings.largest_mechanics_tolerance)?;
        let rests = !tractions.set_changed && tractions.shear_change <= settings.largest_mechanics_tolerance;
        if rests || E::mechanics_work(solvers) > problem.mechanics_budget() {
            break;
        }
    }
    E::march_wear(problem, before, now, solvers);
    rail_and_rim::march_heat(problem, before, iterate, now, solvers)?;
    E::map_displacement(problem, now, solvers);
    E::read(problem, now, solvers, image);
    if !image.is_finite() {
        return Err(ConvergenceTest::new(settings).error(1));
    }
    // A pressure that is held solves nothing.
    let least = if problem.conditions.coupling == Coupling::Held {
        1.0
    } else {
        tractions.residual()
    };
    let residual = iterate.change_to(image, settings.least_temperature).max(least);
    finish(problem, before, iterate, now, solvers, 1, residual)
}

/// Begins a step from the fields before it, which are the first guess.
fn begin<E: Engine>(
    problem: &Problem<E>,
    before: &E::Fields,
    now: &mut E::Fields,
    solvers: &mut E::Solvers,
) -> Result<()> {
    now.guess_from(before);
    E::begin(problem, Some(before), now, solvers)
}

/// Ends a step with the fields of its last sweep, in which the interface vector has changed by the residual.
fn finish<E: Engine>(
    problem: &Problem<E>,
    before: &E::Fields,
    interface: &Interface,
    now: &mut E::Fields,
    solvers: &mut E::Solvers,
    iterations: usize,
    residual: f64,
) -> Result<Convergence> {
    let fills_window = fills_window(problem, now, solvers)?;
    let overloaded = is_overloaded(problem, now);
    E::finalise_friction(problem, now, solvers);
    E::end_memory(problem, now);
    E::finalise_displacement(problem, interface, now, solvers);
    E::finalise(problem, before, now, solvers)?;
    rail_and_rim::warm_wheel(problem, before, now);
    Ok(Convergence {
        iterations,
        residual,
        fills_window,
        crowded: E::is_crowded(solvers),
        overloaded,
        staggered: problem.conditions.coupling.is_staggered(),
        profile_change: E::profile_change(solvers),
    })
}

/// Solves the mechanics alone: rail and wheel at ambient and unworn, no time passes. With the staggered coupling the tractions need not
/// rest.
///
/// # Errors
/// The first solver that did not converge, or [`Error::ContactLeavesWindow`].
pub fn initial_state<E: Engine>(
    problem: &Problem<E>,
    workspace: &mut StepWorkspace<E>,
) -> Result<(EngineState<E::Fields>, Convergence)> {
    with_room(problem, |problem| initial_state_in_room(problem, workspace))
}

/// Solves the mechanics alone in windows that leave as much room as the conditions say.
fn initial_state_in_room<E: Engine>(
    problem: &Problem<E>,
    workspace: &mut StepWorkspace<E>,
) -> Result<(EngineState<E::Fields>, Convergence)> {
    let settings = E::split_settings(problem.settings);
    let tolerance = settings.mechanics_alone_tolerance;
    let StepWorkspace { solvers, iterate, .. } = workspace;
    let mut now = problem.operators.fields();
    E::set_wheel_temperature(&mut now, problem.conditions.inputs.ambient_temperature);
    now.memories_mut().for_each(Memory::start_steady);
    E::begin(problem, None, &mut now, solvers)?;
    let staggered = problem.conditions.coupling.is_staggered();
    let mut tractions = TractionChange::NONE;
    let limit = if staggered {
        settings.iterations.min(problem.settings.interface.mechanics_sweeps)
    } else {
        settings.iterations
    };
    for iterations in 1..=limit {
        E::read(problem, &now, solvers, iterate);
        tractions = E::solve_mechanics(problem, iterate, &mut now, solvers, tolerance)?;
        let rests = tractions.has_converged(tolerance);
        if rests || staggered && iterations == limit {
            let convergence = Convergence {
                iterations: if rests { 0 } else { iterations },
                residual: if rests { 0.0 } else { tractions.residual() },
                fills_window: fills_window(problem, &now, solvers)?,
                crowded: E::is_crowded(solvers),
                overloaded: is_overloaded(problem, &now),
                staggered: !rests,
                profile_change: 0.0,
            };
            E::finalise_displacement(problem, iterate, &mut now, solvers);
            E::end_memory(problem, &mut now);
            return Ok((EngineState::at_rest(now), convergence));
        }
    }
    Err(Error::MechanicsNotConverged {
        iterations: settings.iterations,
        residual: tractions.shear_change,
        tolerance,
    })
}

/// Variable that says how deep the wheel is, with its value and unit, and what it becomes where the wheel is a way deeper, `m`: the load, which no such way changes, where
/// the load says it.
fn depth(parameters: &Parameters, inputs: &Inputs, way: f64) -> (&'static str, f64, &'static str, f64) {
    let load = inputs.normal_load;
    let (name, value, deeper) = match (parameters.control, parameters.contact_model) {
        (Control::Load, _) => return ("normal_load", load, "N", load),
        (Control::Penetration, _) => ("prescribed_penetration", parameters.prescribed_penetration, way),
        (Control::Height, ContactModel::Profiles) => ("vertical_displacement", inputs.vertical_displacement, -way),
        (Control::Height, _) => ("contact_penetration", inputs.contact_penetration, way),
    };
    (name, value, "m", value + deeper)
}

/// Whether the contact is held within its window. Under a load that the window was made for it may be: a wheel that spins on the
/// spot digs a groove that no window holds, and the groove is as wide as the window then. A load beyond that, by a penetration
/// that is given, is an error.
fn fills_window<E: Engine>(problem: &Problem<E>, now: &E::Fields, solvers: &E::Solvers) -> Result<bool> {
    let cut_off = E::is_cut_off(problem, now, solvers);
    if cut_off && is_overloaded(problem, now) {
        let (parameters, load) = (problem.parameters, problem.load(now));
        // Hertz's law, of a line and of a patch, from what the contact carries now.
        let exponent = if parameters.contact_model == ContactModel::Line {
            1.0
        } else {
            2.0 / 3.0
        };
        let penetration = E::integrals(problem, now, solvers).penetration;
        let way = penetration * ((parameters.largest_load / load).powf(exponent) - 1.0);
        let (name, value, unit, about) = depth(parameters, &problem.conditions.inputs, way);
        return Err(Error::ContactLeavesWindow {
            name,
            value,
            unit,
            half_width: 0.5 * problem.operators.window_length(),
            about,
            load,
            largest_load: parameters.largest_load,
        });
    }
    Ok(cut_off)
}

/// Whether the contact carries more than the load that its cells and windows are made for.
fn is_overloaded<E: Engine>(problem: &Problem<E>, now: &E::Fields) -> bool {
    problem.load(now) > problem.parameters.largest_load * (1.0 + 1e-9)
}
