//! One instance: what it holds, and its way through the states.
//!
//! A standard's own layer checks whether a call is allowed in the state, calls a method here, and reports a failure with
//! [`Component::fail`].

use super::failures::{Blame, Failure};
use super::logging::{Category, Journal};
use super::modes::Mode;
use super::resources::Resources;
use super::saved_states::SavedStates;
use super::snapshot::Experiment;
use crate::error;
use crate::parameters::{Parameters, ProfileContents, TEXT_PARAMETERS};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::wheel_rail::{ContactNode, Model, ProfileDepths, Profiles, State, SurfaceWindow, Workspace};
use std::ffi::CString;

/// Model that follows from the parameters, and the scratch that goes with it.
pub(super) struct Built {
    pub(super) model: Model,
    pub(super) workspace: Workspace,
}

impl Built {
    /// Computes mesh, compliance and thermal maps.
    pub(super) fn new(parameters: &Parameters, settings: Settings, contents: ProfileContents) -> error::Result<Built> {
        let model = Model::with_contents(parameters.clone(), settings, contents)?;
        let workspace = model.workspace();
        Ok(Built { model, workspace })
    }
}

/// Fields and meshes that are only looked at: computed from a state when they are asked for.
#[derive(Default)]
pub(super) struct Plots {
    profiles: Option<Profiles>,
    /// The cells of a patch.
    nodes: Option<Vec<ContactNode>>,
    /// The windows of profiles; none of another contact model.
    windows: Option<Vec<SurfaceWindow>>,
    /// Wear of the profiles; without places where there are no profiles.
    wear: Option<ProfileDepths>,
}

/// An instance of the component.
pub struct Component {
    /// The resources of the archive.
    resources: Resources,
    /// Limits and tolerances of the solvers: the default ones, but in tests.
    pub(super) settings: Settings,
    pub(super) mode: Mode,
    pub(super) experiment: Option<Experiment>,
    pub(super) parameters: Parameters,
    pub(super) inputs: Inputs,
    /// Rates of change of the inputs in the next step, per second.
    pub(super) rates: Inputs,
    /// The communication point, `s`.
    pub(super) time: f64,
    /// Kept as long as the fixed parameters and the contents of the profiles' files are the same, over a reset too.
    pub(super) built: Option<Built>,
    /// Rail and contact at the communication point. In *initializationMode* computed when it is asked for.
    pub(super) state: Option<State>,
    /// Contents of the profiles' files once the initialisation has read them: the state keeps its profiles when files change. Read anew after a reset,
    /// and where a parameter may name others.
    pub(super) contents: Option<ProfileContents>,
    /// Computed from `state` when they are asked for.
    pub(super) plots: Plots,
    pub(super) saved: SavedStates,
    /// Texts as the importer has read them, by the rows of [`TEXT_PARAMETERS`].
    pub(super) texts: Vec<CString>,
    /// The inputs without effect that were told of, a bit for each.
    pub(super) told: u32,
    /// Whether it was told of a contact that fills its window, since it last did not, and of more contacts than windows and of a load above the largest likewise.
    pub(super) told_of_windows: [bool; 3],
    /// Messages that wait for the end of a call.
    pub journal: Journal,
}

impl Component {
    /// A new instance, in *instantiated*.
    pub fn new(journal: Journal, resources: Resources) -> Component {
        Component {
            resources,
            settings: Settings::default(),
            mode: Mode::Instantiated,
            experiment: None,
            parameters: Parameters::default(),
            inputs: Inputs::default(),
            rates: Inputs::ZERO,
            time: 0.0,
            built: None,
            state: None,
            contents: None,
            plots: Plots::default(),
            saved: SavedStates::default(),
            texts: vec![CString::default(); TEXT_PARAMETERS.len()],
            told: 0,
            told_of_windows: [false; 3],
            journal,
        }
    }

    /// The state of the instance.
    pub fn mode(&self) -> Mode {
        self.mode
    }

    /// The end of the last step that was committed, whole or in part, `s`.
    pub fn time(&self) -> f64 {
        self.time
    }

    /// Changes the instance as a failed call does, depending on who is to blame.
    pub fn fail(&mut self, blame: Blame) {
        match blame {
            // The step itself has set its state.
            Blame::Remark | Blame::Value | Blame::PartOfStep => {}
            Blame::Call => self.mode = Mode::Error,
            Blame::Library => {
                self.mode = Mode::Error;
                // A panic may have left them half-done. The state is only replaced as a whole.
                self.built = None;
                self.plots = Plots::default();
            }
        }
    }

    /// Tells the importer something, where the category is on.
    pub(super) fn inform(&mut self, category: Category, text: impl FnOnce(&Component) -> String) {
        if self.journal.hears(category) {
            let text = text(self);
            self.journal.inform(category, text);
        }
    }

    /// Sets the times of the experiment, `s`. There is no tolerance: the accuracy follows from mesh and passage time.
    ///
    /// # Errors
    /// [`Failure::StartTime`] or [`Failure::StopTime`].
    pub fn set_experiment(&mut self, start: f64, stop: Option<f64>) -> Result<(), Failure> {
        if !start.is_finite() {
            return Err(Failure::StartTime { value: start });
        }
        if let Some(value) = stop {
            // Not a number is not above the start either.
            if value.is_nan() || value < start {
                return Err(Failure::StopTime { value, start });
            }
        }
        self.experiment = Some(Experiment { start, stop });
        self.time = start;
        Ok(())
    }

    /// Whether the times of the experiment are set.
    pub fn has_experiment(&self) -> bool {
        self.experiment.is_some()
    }

    /// Begins to change the lengths of arrays, which only FMI 3.0 has a state for.
    pub fn enter_configuration(&mut self) {
        self.mode = Mode::Configuration;
    }

    /// Back to *instantiated*.
    pub fn exit_configuration(&mut self) {
        self.mode = Mode::Instantiated;
    }

    /// Begins the initialisation.
    pub fn enter_initialization(&mut self) {
        self.mode = Mode::Initialization;
    }

    /// Ends the initialisation: the parameters must make a model, and the contact must have a solution.
    ///
    /// # Errors
    /// [`Failure::Model`].
    pub fn exit_initialization(&mut self) -> Result<(), Failure> {
        self.solution()?;
        for remark in self.parameters.without_effect() {
            self.journal.failure(Blame::Remark, || remark);
        }
        self.mode = Mode::StepComplete;
        self.inform(Category::Events, |component| {
            format!("initialized at t = {} s", component.time)
        });
        Ok(())
    }

    /// Ends the simulation.
    pub fn terminate(&mut self) {
        self.mode = Mode::Terminated;
        self.inform(Category::Events, |component| {
            format!("terminated at t = {} s", component.time)
        });
    }

    /// Everything as in a new instance; saved states and the choice of log categories stay.
    pub fn reset(&mut self) {
        self.mode = Mode::Instantiated;
        self.experiment = None;
        self.parameters = Parameters::default();
        self.inputs = Inputs::default();
        self.rates = Inputs::ZERO;
        self.told = 0;
        self.told_of_windows = [false; 3];
        self.time = 0.0;
        self.forget_profiles();
        self.inform(Category::Events, |_| "reset to the start values".to_owned());
    }

    /// Makes `built` the model of the given parameters, with the profiles of the state; at first, with those that the files hold.
    pub(super) fn prepare(&mut self, parameters: &Parameters) -> error::Result<&mut Built> {
        let located = self.resources.located(parameters);
        let contents = match &self.contents {
            Some(contents) => contents.clone(),
            None => ProfileContents::read_after(self.resources.folder(), &located)?,
        };
        self.prepare_located(contents, &located)
    }

    /// Makes `built` the model of the given parameters, with profiles from these contents of files; no file is read. Nothing is built anew where only tunable
    /// parameters differ.
    pub(super) fn prepare_of(
        &mut self,
        contents: ProfileContents,
        parameters: &Parameters,
    ) -> error::Result<&mut Built> {
        self.prepare_located(contents, &self.resources.located(parameters))
    }

    /// Makes `built` the model of parameters whose profiles are paths where they are files among the resources.
    fn prepare_located(&mut self, contents: ProfileContents, parameters: &Parameters) -> error::Result<&mut Built> {
        let reusable = self.built.take_if(|Built { model, .. }| {
            model.parameters().fixed_part() == parameters.fixed_part() && *model.profile_contents() == contents
        });
        let built = match reusable {
            Some(mut built) => {
                built.model.retune(parameters)?;
                built
            }
            None => Built::new(parameters, self.settings, contents)?,
        };
        Ok(self.built.insert(built))
    }

    /// The state at the communication point. In *initializationMode* it follows from parameters and inputs.
    pub(super) fn solution(&mut self) -> Result<&State, Failure> {
        if self.state.is_none() {
            if self.mode != Mode::Initialization {
                return Err(Failure::NothingComputed);
            }
            let (parameters, inputs) = (self.parameters.clone(), self.inputs);
            inputs.check(&parameters).map_err(Failure::Model)?;
            let Built { model, workspace } = self.prepare(&parameters).map_err(Failure::Model)?;
            let state = model.initial_state(workspace, &inputs).map_err(Failure::Model)?;
            let contents = model.profile_contents().clone();
            self.state = Some(state);
            self.contents = Some(contents);
        }
        self.state.as_ref().ok_or(Failure::NothingComputed)
    }

    /// Model and state at the communication point.
    pub(super) fn solved(&mut self) -> Result<(&mut Built, &State), Failure> {
        self.solution()?;
        match (&mut self.built, &self.state) {
            (Some(built), Some(state)) => Ok((built, state)),
            _ => Err(Failure::NothingComputed),
        }
    }

    /// The profiles at the communication point.
    pub(super) fn profiles(&mut self) -> Result<&Profiles, Failure> {
        if self.plots.profiles.is_none() {
            let (built, state) = self.solved()?;
            let profiles = built.model.profiles(state);
            self.plots.profiles = Some(profiles);
        }
        self.plots.profiles.as_ref().ok_or(Failure::NothingComputed)
    }

    /// The wear of the profiles at the communication point; without places of another contact model.
    pub(super) fn profile_wear(&mut self) -> Result<&ProfileDepths, Failure> {
        if self.plots.wear.is_none() {
            let (built, state) = self.solved()?;
            let none = || ProfileDepths {
                wheel: Vec::new(),
                rail: Vec::new(),
            };
            let wear = built.model.profile_wear(state).unwrap_or_else(|_| none());
            self.plots.wear = Some(wear);
        }
        self.plots.wear.as_ref().ok_or(Failure::NothingComputed)
    }

    /// The windows of profiles with their fields at the communication point; none of another contact model.
    pub(super) fn windows(&mut self) -> Result<&[SurfaceWindow], Failure> {
        if self.plots.windows.is_none() {
            let (built, state) = self.solved()?;
            let windows = built.model.surface_windows(state).unwrap_or_default();
            self.plots.windows = Some(windows);
        }
        self.plots.windows.as_deref().ok_or(Failure::NothingComputed)
    }

    /// The fields at the nodes of the contact at the communication point.
    pub(super) fn nodes(&mut self) -> Result<&[ContactNode], Failure> {
        if self.plots.nodes.is_none() {
            let (built, state) = self.solved()?;
            let nodes = built.model.contact_nodes(state);
            self.plots.nodes = Some(nodes);
        }
        self.plots.nodes.as_deref().ok_or(Failure::NothingComputed)
    }

    /// Forgets the solution, and what has been read for it: the files' contents, after a change of what may name other files.
    pub(super) fn forget_profiles(&mut self) {
        self.forget_solution();
        self.contents = None;
    }

    /// Forgets the solution of the initialisation after a change of what it follows from.
    pub(super) fn forget_solution(&mut self) {
        self.state = None;
        self.plots = Plots::default();
    }
}
