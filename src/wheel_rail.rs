//! The stepped model: inputs in, state advanced, outputs out. It knows nothing of FMI.

#[cfg(feature = "verification")]
use crate::contact::line::fields::LineFields;
use crate::contact::line::operators::LineOperators;
#[cfg(feature = "verification")]
use crate::contact::patch::fields::PatchFields;
#[cfg(feature = "verification")]
use crate::contact::patch::operators::PatchOperators;
use crate::contact::problem::{Coupling, StepConditions, Task};
use crate::contact::{ContactState, ContactWorkspace, Operators};
use crate::error::{Error, Result};
use crate::friction;
use crate::numerics::dense;
use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::{Inputs, Motion, OUTPUTS, Outputs, Totals};
use serde::{Deserialize, Serialize};

pub use crate::contact::problem::Convergence;
pub use crate::contact::profiles::{ContactNode, DEPTH_POINTS, PROFILE_POINTS, Profiles, STRIP_POINTS, StripProfiles};
pub use crate::contact::work::Iterations;

/// Everything that does not change after initialisation: the contact engine, the parameters (but for the tunable ones), the
/// limits of the methods.
pub struct Model {
    parameters: Parameters,
    settings: Settings,
    operators: Operators,
}

/// Scratch of a step. What a step leaves in it changes no result of another one.
pub struct Workspace {
    contact: ContactWorkspace,
}

impl Workspace {
    /// Iterations of the mechanics since the workspace was made.
    pub fn iterations(&self) -> Iterations {
        self.contact.iterations()
    }
}

/// Everything that changes in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time since the start, `s`.
    pub time: f64,
    /// Inputs at the last committed instant.
    pub inputs: Inputs,
    /// Length of the last committed sub-step, `s`; 0 before the first.
    pub duration: f64,
    /// Temperature, wear, tractions.
    pub(crate) contact: ContactState,
    /// Sums over the steps until then.
    pub totals: Totals,
    /// Outputs at the last committed instant: of the fields, the inputs and the totals.
    pub outputs: Outputs,
    /// Rates of change of the outputs over the last committed sub-step, per second.
    pub output_rates: Outputs,
    /// Convergence of the last step.
    pub convergence: Convergence,
}

impl State {
    /// The fields of the line engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub(crate) fn fields(&self) -> Result<&LineFields> {
        Ok(&self.contact.line()?.fields)
    }

    /// The fields of the patch engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub(crate) fn patch_fields(&self) -> Result<&PatchFields> {
        Ok(&self.contact.patch()?.fields)
    }
}

/// A step that did not reach its end: the state stands at the last committed sub-step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the step ended after {committed} s: {error}")]
pub struct Interrupted {
    /// Time that was committed of the step, `s`; 0 when nothing was.
    pub committed: f64,
    /// Error of the next sub-step.
    #[source]
    pub error: Error,
}

impl Model {
    /// Builds mesh, compliance and thermal maps.
    ///
    /// # Errors
    /// Everything [`Parameters::validate`] refuses, and a stiffness matrix that cannot be factorised.
    pub fn new(parameters: Parameters) -> Result<Model> {
        Model::with_settings(parameters, Settings::default())
    }

    /// Builds the model as [`Model::new`] does, with other limits and tolerances than the default ones.
    ///
    /// # Errors
    /// As [`Model::new`].
    pub fn with_settings(parameters: Parameters, settings: Settings) -> Result<Model> {
        parameters.validate()?;
        let operators = Operators::new(&parameters)?;
        Ok(Model {
            parameters,
            settings,
            operators,
        })
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Sizes of the line engine's compressed map from temperature to displacement: moments a column, far moments, values of
    /// all responses.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    pub fn thermal_map_size(&self) -> Result<(usize, usize, usize)> {
        Ok(self.line_operators()?.heat.displacement.size())
    }

    /// Operators of a line contact, computed once: mesh, compliance, thermal maps.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    pub(crate) fn line_operators(&self) -> Result<&LineOperators> {
        self.operators.line()
    }

    /// Operators of a patch, computed once: grid, influence functions, depth modes.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub(crate) fn patch_operators(&self) -> Result<&PatchOperators> {
        self.operators.patch()
    }

    /// Takes the tunable parameters (slip regularisation and friction coefficients) from `parameters`; the others stay.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Combination`]; nothing is changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<()> {
        let mut tuned = self.parameters.clone();
        tuned.retune(parameters)?;
        tuned.validate_friction()?;
        self.parameters = tuned;
        Ok(())
    }

    /// Scratch for [`Model::step`].
    pub fn workspace(&self) -> Workspace {
        Workspace {
            contact: self.operators.workspace(&self.settings),
        }
    }

    /// Rail and wheel at ambient and unworn under the given inputs: mechanics solved, no heat and no wear yet, nothing has
    /// come in.
    ///
    /// # Errors
    /// Inputs out of range, or a solver that did not converge.
    pub fn initial_state(&self, workspace: &mut Workspace, inputs: &Inputs) -> Result<State> {
        inputs.check(&self.parameters)?;
        let first = |coupling, workspace: &mut Workspace| {
            let task = self.task(inputs, f64::INFINITY, coupling);
            self.operators.initial_state(&task, &mut workspace.contact)
        };
        let (contact, convergence, integrals) = first(Coupling::Implicit, workspace).or_else(|error| match error {
            Error::ContactLeavesWindow { .. } | Error::OtherContactModel => Err(error),
            _ if self.settings.step.staggered_substeps == 0 => Err(error),
            _ => first(Coupling::Staggered, workspace).map_err(|_| error),
        })?;
        let totals = Totals::default();
        let outputs = integrals.outputs(&self.parameters, inputs, &totals);
        Ok(State {
            time: 0.0,
            inputs: *inputs,
            duration: 0.0,
            contact,
            totals,
            outputs,
            output_rates: Outputs::default(),
            convergence,
        })
    }

    /// Whether a state (of another source) has the sizes of this model and finite content.
    pub fn accepts(&self, state: &State) -> bool {
        self.operators.accepts(&state.contact)
            && OUTPUTS.iter().all(|signal| (signal.get)(&state.outputs).is_finite())
            && state.totals.is_finite()
            && state.time.is_finite()
            && state.duration >= 0.0
            && state.inputs.check(&self.parameters).is_ok()
    }

    /// Advances the state by `duration` `s`; the inputs start at `inputs` and change at `rates` per second.
    ///
    /// The step is implicit in time, of order 1. It is divided after a jump of the inputs, from a quarter of the
    /// passage of the contact window on with doubling sub-steps, and where the rates change the inputs by more
    /// than a fifth of their scale. A sub-step that does not converge is tried again in quarters. Where that does not help, or the
    /// budget of work is spent, the rest of the step is taken staggered, and [`Convergence::staggered`] says so.
    ///
    /// # Errors
    /// [`Interrupted`]: the state stands at the last committed sub-step, bit for bit.
    pub fn step(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        rates: &Inputs,
        duration: f64,
    ) -> std::result::Result<(), Interrupted> {
        let settings = &self.settings.step;
        let duration = if duration > 0.0 {
            duration.max(settings.shortest)
        } else {
            duration
        };
        workspace.contact.renew_budget();
        let start = state.time;
        let mut committed = 0.0;
        let interrupted = |committed, error| Interrupted { committed, error };
        inputs
            .check(&self.parameters)
            .and_then(|()| self.inputs_at(inputs, rates, duration).check(&self.parameters))
            .map_err(|error| interrupted(0.0, error))?;

        let jump = self.change(&state.inputs, inputs);
        let ramp = self.change(inputs, &self.inputs_at(inputs, rates, duration));
        let mut substep = duration / (ramp / settings.jump).ceil().clamp(1.0, settings.ramp_substeps);
        let planned = substep;
        let mut largest_substep = planned;
        if jump > settings.jump {
            substep = substep.min(settings.first_substep * self.passage_time(inputs));
        }
        let mut convergence = Convergence::default();
        let (mut retries, mut at_limit) = (0, 0);
        let mut failure = None;
        while committed < duration {
            // The last sub-step takes the rest, so that no sliver is left over by rounding.
            let remaining = duration - committed;
            let length = if remaining < 1.5 * substep { remaining } else { substep };
            let end = if length == remaining {
                duration
            } else {
                committed + length
            };
            let at_end = self.inputs_at(inputs, rates, end);
            let coupling = match failure {
                None => Coupling::Implicit,
                Some(_) => Coupling::Staggered,
            };
            let solved = match self.advance(workspace, state, &at_end, length, coupling) {
                Ok(solved) => solved,
                // What the window cannot hold no step can.
                Err(error @ (Error::ContactLeavesWindow { .. } | Error::OtherContactModel)) => {
                    return Err(interrupted(committed, error));
                }
                Err(error) => {
                    // Of two failures the first says why.
                    if let Some(first) = failure {
                        return Err(interrupted(committed, first));
                    }
                    if retries < settings.retries && !matches!(error, Error::TooMuchWork { .. }) {
                        // A shorter sub-step starts closer to its solution.
                        retries += 1;
                        substep = 0.25 * length;
                        largest_substep = largest_substep.min(0.5 * length);
                    } else if settings.staggered_substeps > 0 {
                        substep = remaining / settings.staggered_substeps as f64;
                        largest_substep = substep;
                        failure = Some(error);
                    } else {
                        return Err(interrupted(committed, error));
                    }
                    continue;
                }
            };
            committed = end;
            state.time = start + committed;
            // The budget is that of a step which is hard, not of one with many sub-steps: each has it anew until one fails.
            if retries == 0 && failure.is_none() {
                workspace.contact.renew_budget();
            }
            convergence.iterations += solved.iterations;
            convergence.residual = solved.residual;
            convergence.fills_window |= solved.fills_window;
            convergence.staggered |= solved.staggered;
            state.convergence = convergence;
            // After some sub-steps at the limit that a failure has set, longer ones are tried.
            at_limit = if length >= largest_substep { at_limit + 1 } else { 0 };
            if at_limit >= settings.substeps_at_limit && failure.is_none() {
                (largest_substep, at_limit) = ((2.0 * largest_substep).min(planned), 0);
            }
            substep = (2.0 * substep).min(largest_substep);
        }
        Ok(())
    }

    /// One step of `duration` to the given inputs; commits only on success.
    fn advance(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        duration: f64,
        coupling: Coupling,
    ) -> Result<Convergence> {
        let task = self.task(inputs, duration, coupling);
        let (convergence, integrals) =
            self.operators
                .solve(&task, &mut workspace.contact, &state.contact, state.duration)?;
        let totals = integrals.totals_after(&self.parameters, &task.conditions, &state.totals);
        let outputs = integrals.outputs(&self.parameters, inputs, &totals);
        for signal in OUTPUTS {
            let rate = ((signal.get)(&outputs) - (signal.get)(&state.outputs)) / duration;
            (signal.set)(&mut state.output_rates, rate);
        }
        workspace.contact.commit(&mut state.contact, duration);
        state.inputs = *inputs;
        state.duration = duration;
        state.totals = totals;
        state.outputs = outputs;
        Ok(convergence)
    }

    /// The inputs `time` after the beginning of a step.
    fn inputs_at(&self, inputs: &Inputs, rates: &Inputs, time: f64) -> Inputs {
        inputs.advanced(rates, time).snapped(&self.parameters)
    }

    fn task(&self, inputs: &Inputs, duration: f64, coupling: Coupling) -> Task<'_> {
        Task {
            parameters: &self.parameters,
            settings: &self.settings,
            conditions: StepConditions {
                inputs: *inputs,
                motion: inputs.motion(&self.parameters),
                duration,
                coupling,
            },
        }
    }

    /// Largest change between two sets of inputs, each relative to what changes the contact appreciably.
    fn change(&self, from: &Inputs, to: &Inputs) -> f64 {
        let (before, after) = (from.motion(&self.parameters), to.motion(&self.parameters));
        let speed = before.rolling_speed.abs().max(after.rolling_speed.abs());
        // Creepage at which the whole contact slides, μ a / r₀.
        let load = from.normal_load.max(to.normal_load);
        let (half_length, half_breadth) = self.parameters.contact_half_axes(load);
        let saturation = friction::largest_coefficient(&self.parameters) * half_length / self.parameters.wheel_radius;
        // Slip along and across the rail, and that of the spin at the contact's side.
        let slips = |motion: &Motion| [motion.rigid_slip, motion.lateral_speed, half_breadth * motion.spin_rate];
        let (slips_before, slips_after) = (slips(&before), slips(&after));
        let slip = dense::largest(&slips_before).max(dense::largest(&slips_after));
        let relative = |change: f64, scale: f64| dense::relative(change.abs(), scale);
        relative(after.rolling_speed - before.rolling_speed, speed)
            .max(relative(
                dense::largest_change(&slips_after, &slips_before),
                (saturation * speed).max(slip),
            ))
            .max(relative(to.normal_load - from.normal_load, load))
            .max(relative(
                to.friction_scale - from.friction_scale,
                from.friction_scale.max(to.friction_scale),
            ))
    }

    /// Time in which rail material crosses the contact window, `s`; infinite at rest.
    fn passage_time(&self, inputs: &Inputs) -> f64 {
        self.operators.window_length() / inputs.motion(&self.parameters).rolling_speed.abs()
    }

    /// Rates of change of the outputs at the communication point, per second: over the last sub-step.
    pub fn output_rates(&self, state: &State) -> Outputs {
        state.output_rates
    }

    /// Derivatives of the outputs with respect to inputs at the communication point, from the linearised discrete equations
    /// of the last sub-step: one entry for each of the given rows of [`crate::signals::INPUTS`].
    ///
    /// Held fixed are temperature, wear and totals at the beginning of that sub-step and its length; after
    /// initialisation, where no time has passed yet, temperature and wear themselves.
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn output_sensitivities(
        &self,
        workspace: &mut Workspace,
        state: &State,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        let task = self.task(&state.inputs, state.duration, Coupling::Implicit);
        self.operators
            .sensitivities(&task, &mut workspace.contact, &state.contact, inputs)
    }

    /// Convergence of the last step.
    pub fn convergence(&self, state: &State) -> Convergence {
        state.convergence
    }

    /// The fields at the nodes of the contact window, from the rear to the front for V > 0.
    pub fn contact_nodes(&self, state: &State) -> Vec<ContactNode> {
        self.operators.contact_nodes(&state.contact)
    }

    /// Side of the corners of a layer's law that the nodes are on, for tests of the derivatives: whether its strength is less or more than what the
    /// surfaces carry, or as much, which it hardens up to; none without a layer, and for a state of another contact model.
    #[cfg(feature = "verification")]
    pub fn layer_sides(&self, state: &State) -> Vec<Option<std::cmp::Ordering>> {
        self.operators.layer_sides(&state.contact)
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &State) -> Profiles {
        self.operators.profiles(
            &self.task(&state.inputs, state.duration, Coupling::Implicit),
            &state.contact,
        )
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::parameters::{ContactModel, NormalSolver, Wheel, WheelHeating};
    use crate::settings::limits::{LIMITS, PATCH_LIMITS};

    /// A small model of a rigid wheel, whose normal and tangential problem are coupled, that is heated, and a state from which
    /// a jump of the creepage divides the next step.
    fn model(normal_solver: NormalSolver, settings: Settings) -> Model {
        let parameters = Parameters {
            normal_solver,
            wheel: Wheel::Rigid,
            wheel_heating: WheelHeating::On,
            contact_nodes: 25,
            depth_nodes: 17,
            ..Parameters::default()
        };
        Model::with_settings(parameters, settings).unwrap()
    }

    /// A small patch, heated and with a wheel of the same kind.
    fn patch(settings: Settings) -> Model {
        let parameters = Parameters {
            contact_model: ContactModel::Patch,
            wheel: Wheel::Rigid,
            wheel_heating: WheelHeating::On,
            patch_nodes: 14,
            patch_strips: 7,
            depth_nodes: 17,
            ..Parameters::default()
        };
        Model::with_settings(parameters, settings).unwrap()
    }

    /// State and workspace of another contact model are refused, and nothing of them is read.
    #[test]
    fn contact_models_do_not_mix() {
        let line = model(NormalSolver::ActiveSet, Settings::default());
        let patch = Model::new(Parameters {
            contact_model: ContactModel::Patch,
            ..Parameters::default()
        })
        .unwrap();
        let inputs = Inputs::default();
        let state = line.initial_state(&mut line.workspace(), &inputs).unwrap();
        let mut other = state.clone();
        assert!(line.accepts(&state) && !patch.accepts(&state));
        let step = |model: &Model, workspace: &mut Workspace, state: &mut State| {
            let interrupted = model.step(workspace, state, &inputs, &Inputs::ZERO, 1e-3).unwrap_err();
            assert_eq!(
                (interrupted.committed, interrupted.error),
                (0.0, Error::OtherContactModel)
            );
        };
        step(&patch, &mut patch.workspace(), &mut other);
        step(&patch, &mut line.workspace(), &mut other);
        step(&line, &mut patch.workspace(), &mut other);
        assert!(other == state);
        let foreign = Error::OtherContactModel;
        assert!(
            line.initial_state(&mut patch.workspace(), &inputs)
                .is_err_and(|error| error == foreign)
        );
        let sensitivities = patch.output_sensitivities(&mut patch.workspace(), &state, 0..1);
        assert!(sensitivities.is_err_and(|error| error == foreign));
        assert!(patch.thermal_map_size().is_err() && line.thermal_map_size().is_ok());
        assert!(patch.contact_nodes(&state).is_empty());
        assert_eq!(patch.profiles(&state), Profiles::untouched(inputs.ambient_temperature));
    }

    const JUMPED: fn() -> Inputs = || Inputs {
        creepage: 0.01,
        ..Inputs::default()
    };

    fn step(model: &Model, state: &mut State, duration: f64) -> std::result::Result<(), Interrupted> {
        model.step(&mut model.workspace(), state, &JUMPED(), &Inputs::ZERO, duration)
    }

    /// Fails each solver somewhere in the step: the state is that of the last committed sub-step, bit for bit.
    #[test]
    fn a_step_that_fails_leaves_the_last_committed_state() {
        let mut later = 0;
        let of_a_line = LIMITS.map(|limit| (ContactModel::Line, limit));
        let of_a_patch = PATCH_LIMITS.map(|limit| (ContactModel::Patch, limit));
        for (contact_model, (words, set_limit)) in of_a_line.into_iter().chain(of_a_patch) {
            let normal_solver = if words.contains("Pschenichnyj") {
                NormalSolver::Pschenichnyj
            } else {
                NormalSolver::ActiveSet
            };
            let model = |settings| match contact_model {
                ContactModel::Line => model(normal_solver, settings),
                ContactModel::Patch => patch(settings),
            };
            let sound = model(Settings::default());
            let inputs = Inputs::default();
            let mut before = sound.initial_state(&mut sound.workspace(), &inputs).unwrap();
            sound
                .step(&mut sound.workspace(), &mut before, &inputs, &Inputs::ZERO, 1e-3)
                .unwrap();
            let mut undisturbed = before.clone();
            step(&sound, &mut undisturbed, 2e-3).unwrap();
            let mut failures = 0;
            for limit in 0.. {
                let mut settings = Settings::strict();
                settings.step.retries = 0;
                set_limit(&mut settings, limit);
                let limited = model(settings);
                if words.starts_with("coupling") {
                    // The mechanics alone are solved for the initial state only.
                    let failed = limited.initial_state(&mut limited.workspace(), &inputs);
                    let Err(error) = failed else { break };
                    assert!(error.to_string().contains(words), "{error}");
                    failures += 1;
                    continue;
                }
                let mut state = before.clone();
                let Err(interrupted) = step(&limited, &mut state, 2e-3) else {
                    // A step goes on where its tractions fall short for once, and may end with the closest iterate, as its residual
                    // says; the friction of a line is solved by another method then.
                    let share = state.outputs.traction_force / undisturbed.outputs.traction_force;
                    let tolerance = match contact_model {
                        ContactModel::Line => state.convergence.residual.max(1e-9),
                        ContactModel::Patch => 1e-5,
                    };
                    let short = (share - 1.0).abs() < tolerance;
                    assert!(state == undisturbed || short, "{words}, limit {limit}: {share}");
                    break;
                };
                failures += 1;
                assert!(interrupted.to_string().contains(words), "{interrupted}");
                if interrupted.committed == 0.0 {
                    assert!(state == before, "{words}, limit {limit}");
                } else {
                    later += 1;
                    assert_eq!(state.time, before.time + interrupted.committed);
                    // The sub-steps that were committed are those of a sound step, so that going on from them leads where the
                    // sound step leads, to the order of its sub-steps.
                    assert!(state.contact != before.contact);
                    step(&sound, &mut state, 2e-3 - interrupted.committed).unwrap();
                    let (resumed, whole) = (state.outputs.traction_force, undisturbed.outputs.traction_force);
                    assert!((resumed / whole - 1.0).abs() < 1e-2, "{words}: {resumed} {whole}");
                }
            }
            assert!(failures > 0, "{words}: never failed");
        }
        assert!(later > 0, "no solver failed after a committed sub-step");
    }

    /// A workspace in which a step has failed gives the bits of a fresh one.
    #[test]
    fn a_failed_step_leaves_nothing_in_the_workspace() {
        let mut settings = Settings::strict();
        settings.split.iterations = 6;
        settings.step.retries = 0;
        let limited = model(NormalSolver::ActiveSet, settings);
        let mut workspace = limited.workspace();
        let start = limited.initial_state(&mut workspace, &Inputs::default()).unwrap();
        let step = |workspace: &mut Workspace, inputs: &Inputs, duration| {
            let mut state = start.clone();
            let result = limited.step(workspace, &mut state, inputs, &Inputs::ZERO, duration);
            (result, state)
        };
        let easy = Inputs::default();
        let expected = step(&mut limited.workspace(), &easy, 1e-4);
        assert!(expected.0.is_ok());
        // Sliding on the spot with a thousandfold wear needs more iterations than there are.
        let hard = Inputs {
            creepage: 0.9,
            wheel_speed: 400.0,
            ..easy
        };
        let failed = step(&mut workspace, &hard, 1.0);
        assert!(failed.0.is_err());
        assert!(step(&mut workspace, &easy, 1e-4) == expected);
    }

    /// A step whose coupled equations are not solved, here for want of iterations, is taken staggered. Over a passage friction falls
    /// by a part in a thousand a step, by which alone the two differ.
    #[test]
    fn a_step_that_is_not_solved_is_taken_staggered() {
        let mut unsolved = Settings::default();
        unsolved.split.iterations = 1;
        unsolved.step.retries = 0;
        for model in [
            |settings| model(NormalSolver::ActiveSet, settings),
            |settings| patch(settings),
        ] {
            let (sound, limited) = (model(Settings::default()), model(unsolved));
            let run = |model: &Model, steps: u32| {
                let mut workspace = model.workspace();
                let mut state = sound.initial_state(&mut sound.workspace(), &Inputs::default()).unwrap();
                for _ in 0..steps {
                    let duration = 4e-3 / f64::from(steps);
                    model
                        .step(&mut workspace, &mut state, &JUMPED(), &Inputs::ZERO, duration)
                        .unwrap();
                }
                state
            };
            for steps in [8, 32, 128] {
                let (implicit, staggered) = (run(&sound, steps), run(&limited, steps));
                assert!(staggered.convergence.staggered && !implicit.convergence.staggered);
                assert!(staggered.convergence.residual > 0.0 && limited.accepts(&staggered));
                let rise = |state: &State| state.outputs.peak_temperature - JUMPED().ambient_temperature;
                let error = (rise(&staggered) / rise(&implicit) - 1.0).abs();
                assert!(error > 0.0 && error < 1e-3, "{steps}: {error}");
            }
        }
    }

    /// A sub-step that fails is tried again in quarters, which start closer to their solution: among many limits of the split
    /// and lengths of the step there are some where only that leads to the end.
    #[test]
    fn a_shorter_sub_step_helps() {
        let sound = model(NormalSolver::ActiveSet, Settings::default());
        let start = sound.initial_state(&mut sound.workspace(), &Inputs::default()).unwrap();
        let mut helped = 0;
        for limit in 1..8 {
            let mut without = Settings::strict();
            without.split.iterations = limit;
            without.step.retries = 0;
            let mut with = without;
            with.step.retries = Settings::default().step.retries;
            let [with, without] = [with, without].map(|settings| model(NormalSolver::ActiveSet, settings));
            for k in 0..30 {
                let duration = 1e-6 * 1.4_f64.powi(k);
                let mut state = start.clone();
                let fails = step(&without, &mut start.clone(), duration).is_err();
                if fails && step(&with, &mut state, duration).is_ok() {
                    assert_eq!(state.time, duration);
                    helped += 1;
                }
            }
        }
        assert!(helped > 0);
    }
}
