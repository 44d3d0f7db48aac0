//! The stepped model: inputs in, state advanced, outputs out. It knows nothing of FMI.

mod division;
mod jumps;

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
use crate::geometry::hertz::HertzEllipse;
use crate::geometry::profile::Profile;
use crate::parameters::{ContactModel, Control, Parameters, ProfileContents};
use crate::settings::Settings;
use crate::signals::{Inputs, OUTPUTS, Outputs, Totals};
use division::{Division, SubStep};
use serde::{Deserialize, Serialize};

pub use crate::contact::problem::Convergence;
pub use crate::contact::profiles::{
    ContactNode, DEPTH_POINTS, PROFILE_POINTS, ProfileDepths, Profiles, STRIP_POINTS, StripProfiles, SurfaceStrip,
    SurfaceWindow, WornPlace,
};
pub use crate::contact::work::Iterations;

/// Everything that does not change after initialisation: the contact engine, the parameters (but for the tunable ones), the
/// limits of the methods.
pub struct Model {
    parameters: Parameters,
    settings: Settings,
    operators: Operators,
    /// Contents of the files that hold the profiles.
    contents: ProfileContents,
    /// Contact ellipse under the largest load; none with a line.
    largest_ellipse: Option<HertzEllipse>,
}

/// Scratch of a step. What a step leaves in it changes no result of another one.
pub struct Workspace {
    pub(crate) contact: ContactWorkspace,
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
        // First, so that what is read is named by parameters that can be.
        parameters.validate()?;
        let contents = ProfileContents::read(&parameters)?;
        Model::with_contents(parameters, settings, contents)
    }

    /// Builds the model as [`Model::with_settings`] does, but for profiles in files, which are made of these contents; no file is read.
    ///
    /// # Errors
    /// As [`Model::new`], and [`Error::NamedProfile`] where a parameter names a file and there is no content of it.
    pub fn with_contents(parameters: Parameters, mut settings: Settings, contents: ProfileContents) -> Result<Model> {
        parameters.validate()?;
        settings.step = settings.step.for_cells(&parameters);
        let operators = Operators::new(&parameters, &contents)?;
        let is_line = parameters.contact_model == ContactModel::Line;
        let largest_ellipse = (!is_line).then(|| parameters.hertz_ellipse(parameters.largest_load));
        Ok(Model {
            parameters,
            settings,
            operators,
            contents,
            largest_ellipse,
        })
    }

    /// Contents of the files that hold its profiles, to be kept with a [`State`] that outlives the process: with them [`Model::with_contents`] makes the model
    /// again that the state belongs to, whatever has become of the files.
    pub fn profile_contents(&self) -> &ProfileContents {
        &self.contents
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
            Error::ContactLeavesWindow { .. } | Error::WheelOffRail { .. } | Error::OtherContactModel => Err(error),
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
        let interrupted = |committed, error| Interrupted { committed, error };
        let end = self.inputs_at(inputs, rates, duration);
        inputs
            .check(&self.parameters)
            .and_then(|()| end.check(&self.parameters))
            .map_err(|error| interrupted(0.0, error))?;

        let jump = self.change(&state.inputs, inputs);
        let ramp = self.change(inputs, &end);
        let planned = duration / (ramp / settings.jump).ceil().clamp(1.0, settings.ramp_substeps);
        let first = if jump > settings.jump {
            settings.first_substep * self.passage_time(inputs)
        } else {
            f64::INFINITY
        };
        // At a height that is given, the pressure is that of the height.
        let may_hold =
            self.parameters.contact_model == ContactModel::Profiles && self.parameters.control != Control::Height;
        let mut division = Division::new(settings, duration, [planned, first], may_hold);
        let mut convergence = Convergence::default();
        while let Some(part) = division.next() {
            let at_end = if part.end == duration {
                end
            } else {
                self.inputs_at(inputs, rates, part.end)
            };
            let solved = match self.advance(workspace, state, &at_end, part) {
                Ok(solved) => solved,
                Err(error) => {
                    let shortened = division.shorten(part, error);
                    shortened.map_err(|error| interrupted(division.committed(), error))?;
                    continue;
                }
            };
            division.commit(part);
            state.time = start + division.committed();
            if division.has_not_failed() {
                workspace.contact.renew_budget();
            }
            convergence.add(&solved);
            state.convergence = convergence;
        }
        Ok(())
    }

    /// Takes one sub-step to the given inputs; commits only on success.
    fn advance(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        part: SubStep,
    ) -> Result<Convergence> {
        let duration = part.length;
        let task = self.task(inputs, duration, part.coupling);
        let (convergence, integrals) =
            self.operators
                .solve(&task, &mut workspace.contact, &state.contact, state.duration)?;
        let totals = integrals.totals_after(&self.parameters, &task.conditions, &state.totals);
        let outputs = integrals.outputs(&self.parameters, inputs, &totals);
        state.output_rates = outputs.rates(&state.outputs, duration);
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
                room: 1.0,
            },
        }
    }

    /// Task of the last step.
    fn task_of(&self, state: &State) -> Task<'_> {
        self.task(&state.inputs, state.duration, Coupling::Implicit)
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
        self.operators
            .sensitivities(&self.task_of(state), &mut workspace.contact, &state.contact, inputs)
    }

    /// Convergence of the last step.
    pub fn convergence(&self, state: &State) -> Convergence {
        state.convergence
    }

    /// The fields at the nodes of the contact window, from the rear to the front for V > 0.
    pub fn contact_nodes(&self, state: &State) -> Vec<ContactNode> {
        self.operators.contact_nodes(&self.task_of(state), &state.contact)
    }

    /// Windows of a contact of profiles with the fields at their cells: first those that carry, in the order of the contacts in the outputs, then those
    /// that do not.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]: there are none of a line contact or a patch.
    pub fn surface_windows(&self, state: &State) -> Result<Vec<SurfaceWindow>> {
        self.operators.surface_windows(&self.task_of(state), &state.contact)
    }

    /// Side of the corners of a layer's law that the nodes are on, for tests of the derivatives: whether its strength is less or more than what the
    /// surfaces carry, or as much, which it hardens up to; none without a layer, and for a state of another contact model.
    #[cfg(feature = "verification")]
    pub fn layer_sides(&self, state: &State) -> Vec<Option<std::cmp::Ordering>> {
        self.operators.layer_sides(&state.contact)
    }

    /// Depths by which the profiles of wheel and rail are worn.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]: there are none of a line contact or a patch.
    pub fn profile_wear(&self, state: &State) -> Result<ProfileDepths> {
        self.operators.profile_wear(&self.task_of(state), &state.contact)
    }

    /// Profiles of wheel and rail as they are worn, the rail's upright. Their origins have moved with the surface, a wheel's to its worn running
    /// circle: a model of them has a smaller `wheel_radius`, and a rail of a smaller height and width.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]; a profile that is worn beyond its radius of curvature.
    pub fn worn_profiles(&self, state: &State) -> Result<[Profile; 2]> {
        self.operators.worn_profiles(&state.contact)
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &State) -> Profiles {
        self.operators.profiles(&self.task_of(state), &state.contact)
    }
}

#[cfg(test)]
mod tests;
