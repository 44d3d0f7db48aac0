//! The contact of wheel and rail: one implicit step of tractions, temperature and wear.
//!
//! [`engine`] says what a contact offers, [`mod@line`], [`patch`] and [`surface`] offer it: a contact resolved along the rail, one
//! along and across it, and those of profiles, with a patch for each. All else is written once: the [`problem`] of a step, its
//! [`fields`], the [`interface`] vector between mechanics and heat, the [`step`], [`newton`] for the hard ones, [`sensitivity`] and
//! its [`linear`] system, [`integrals`] of the fields and [`outputs`] from them, [`profiles`] for plotting, the [`memory`] of
//! friction, the wheel's [`rim`].

pub mod convergence;
pub mod engine;
mod equations;
pub mod fields;
pub mod integrals;
pub mod interface;
pub mod line;
pub mod linear;
pub mod memory;
pub mod newton;
pub mod on_wheelset;
pub mod outputs;
pub mod patch;
pub mod problem;
pub mod profiles;
mod rail_and_rim;
pub mod rim;
pub mod sensitivity;
pub mod step;
pub mod surface;
pub mod work;

use crate::error::{Error, Result};
#[cfg(feature = "verification")]
use crate::friction::memory::Memory;
use crate::geometry::profile::Profile;
use crate::parameters::{ContactModel, Parameters, ProfileContents};
use crate::settings::Settings;
use crate::signals::Outputs;
use engine::Engine;
use fields::EngineState;
#[cfg(feature = "verification")]
use fields::Fields;
use integrals::Integrals;
use line::fields::LineFields;
use line::operators::LineOperators;
use patch::fields::PatchFields;
use patch::operators::PatchOperators;
use problem::{Convergence, Coupling, Problem, Task};
use profiles::{ContactNode, ProfileDepths, Profiles, SurfaceWindow};
use serde::{Deserialize, Serialize};
#[cfg(feature = "verification")]
use std::cmp::Ordering;
use step::StepWorkspace;
use surface::fields::SurfaceFields;
use surface::operators::SurfaceOperators;
use work::Iterations;

/// Operators of a contact, computed once.
#[allow(clippy::large_enum_variant, reason = "there are few, and they are not moved")]
pub enum Operators {
    /// Line contact.
    Line(LineOperators),
    /// Patch.
    Patch(PatchOperators),
    /// Profiles.
    Surface(SurfaceOperators),
}

/// State of a contact: its fields, all that a step changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(
    clippy::large_enum_variant,
    reason = "there are few, and what they hold is elsewhere"
)]
pub enum ContactState {
    /// Line contact.
    Line(EngineState<LineFields>),
    /// Patch.
    Patch(EngineState<PatchFields>),
    /// Profiles.
    Surface(EngineState<SurfaceFields>),
}

/// Solvers and buffers of a step.
#[allow(clippy::large_enum_variant, reason = "there are few, and they are not moved")]
pub enum ContactWorkspace {
    /// Line contact.
    Line(StepWorkspace<LineOperators>),
    /// Patch.
    Patch(StepWorkspace<PatchOperators>),
    /// Profiles.
    Surface(StepWorkspace<SurfaceOperators>),
}

/// Runs an expression with operators and state, and a workspace where one is given, of the same contact model. Those of different
/// models make it [`Error::OtherContactModel`].
macro_rules! with_model {
    ($operators:expr, $state:expr, |$o:ident, $s:ident| $body:expr) => {
        match ($operators, $state) {
            (Operators::Line($o), ContactState::Line($s)) => Ok($body),
            (Operators::Patch($o), ContactState::Patch($s)) => Ok($body),
            (Operators::Surface($o), ContactState::Surface($s)) => Ok($body),
            _ => Err(Error::OtherContactModel),
        }
    };
    ($operators:expr, $workspace:expr, $state:expr, |$o:ident, $w:ident, $s:ident| $body:expr) => {
        match ($operators, $workspace, $state) {
            (Operators::Line($o), ContactWorkspace::Line($w), ContactState::Line($s)) => $body,
            (Operators::Patch($o), ContactWorkspace::Patch($w), ContactState::Patch($s)) => $body,
            (Operators::Surface($o), ContactWorkspace::Surface($w), ContactState::Surface($s)) => $body,
            _ => Err(Error::OtherContactModel),
        }
    };
}

impl Operators {
    /// Computes meshes, compliance, thermal maps; of profiles in files from the contents of these.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`], [`Error::DepthBasis`], a profile that does not serve.
    pub fn new(parameters: &Parameters, contents: &ProfileContents) -> Result<Operators> {
        Ok(match parameters.contact_model {
            ContactModel::Line => Operators::Line(LineOperators::build(parameters)?),
            ContactModel::Patch => Operators::Patch(PatchOperators::build(parameters)?),
            ContactModel::Profiles => Operators::Surface(SurfaceOperators::build(parameters, contents)?),
        })
    }

    /// Workspace for the steps.
    pub fn workspace(&self, settings: &Settings) -> ContactWorkspace {
        match self {
            Operators::Line(operators) => ContactWorkspace::Line(StepWorkspace::new(operators, settings)),
            Operators::Patch(operators) => ContactWorkspace::Patch(StepWorkspace::new(operators, settings)),
            Operators::Surface(operators) => ContactWorkspace::Surface(StepWorkspace::new(operators, settings)),
        }
    }

    /// State of rail and wheel at ambient and unworn: mechanics solved, no heat and no wear yet, nothing has come in. With it the
    /// integrals that its outputs are made of.
    ///
    /// # Errors
    /// A solver that did not converge, or [`Error::OtherContactModel`].
    pub fn initial_state(
        &self,
        task: &Task,
        workspace: &mut ContactWorkspace,
    ) -> Result<(ContactState, Convergence, Integrals)> {
        fn initial<E: Engine>(
            operators: &E,
            task: &Task,
            workspace: &mut StepWorkspace<E>,
            wrap: fn(EngineState<E::Fields>) -> ContactState,
        ) -> Result<(ContactState, Convergence, Integrals)> {
            let problem = Problem::new(operators, task);
            let (state, convergence) = step::initial_state(&problem, workspace)?;
            let integrals = E::integrals(&problem, &state.fields, &workspace.solvers);
            Ok((wrap(state), convergence, integrals))
        }
        match (self, workspace) {
            (Operators::Line(operators), ContactWorkspace::Line(workspace)) => {
                initial(operators, task, workspace, ContactState::Line)
            }
            (Operators::Patch(operators), ContactWorkspace::Patch(workspace)) => {
                initial(operators, task, workspace, ContactState::Patch)
            }
            (Operators::Surface(operators), ContactWorkspace::Surface(workspace)) => {
                initial(operators, task, workspace, ContactState::Surface)
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Solves one step from `state`; the solution stays in the workspace until [`ContactWorkspace::commit`]. The step
    /// before took `last_duration` `s`.
    ///
    /// # Errors
    /// The first solver that did not converge, a contact that leaves the window, or [`Error::OtherContactModel`].
    pub fn solve(
        &self,
        task: &Task,
        workspace: &mut ContactWorkspace,
        state: &ContactState,
        last_duration: f64,
    ) -> Result<(Convergence, Integrals)> {
        fn solve<E: Engine>(
            problem: &Problem<E>,
            workspace: &mut StepWorkspace<E>,
            state: &EngineState<E::Fields>,
            last_duration: f64,
        ) -> Result<(Convergence, Integrals)> {
            let convergence = match problem.conditions.coupling {
                Coupling::Implicit => step::solve(problem, state, last_duration, workspace)?,
                Coupling::Staggered | Coupling::Held => step::solve_staggered(problem, state, workspace)?,
            };
            let integrals = E::integrals(problem, workspace.solution(), &workspace.solvers);
            Ok((convergence, integrals))
        }
        with_model!(self, workspace, state, |operators, workspace, state| {
            solve(&Problem::new(operators, task), workspace, state, last_duration)
        })
    }

    /// Computes the derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`], from the
    /// linearised step that ended in `state`.
    ///
    /// # Errors
    /// A linear system that could not be solved, or [`Error::OtherContactModel`].
    pub fn sensitivities(
        &self,
        task: &Task,
        workspace: &mut ContactWorkspace,
        state: &ContactState,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        with_model!(self, workspace, state, |operators, workspace, state| {
            sensitivity::outputs(&Problem::new(operators, task), &state.fields, workspace, inputs)
        })
    }

    /// Profiles for plotting; those of an untouched rail for a state of another contact model.
    pub fn profiles(&self, task: &Task, state: &ContactState) -> Profiles {
        let profiles: Result<Profiles> = with_model!(self, state, |operators, state| {
            Engine::profiles(&Problem::new(operators, task), &state.fields)
        });
        profiles.unwrap_or_else(|_| Profiles::untouched(task.conditions.inputs.ambient_temperature))
    }

    /// Fields at the nodes of the contact window; none for a state of another contact model.
    pub fn contact_nodes(&self, task: &Task, state: &ContactState) -> Vec<ContactNode> {
        let nodes: Result<_> = with_model!(self, state, |operators, state| {
            Engine::contact_nodes(&Problem::new(operators, task), &state.fields)
        });
        nodes.unwrap_or_default()
    }

    /// Windows of a contact of profiles with the fields at their cells: first those that carry, in the order of the contacts.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]: there are none of a line contact or a patch.
    pub fn surface_windows(&self, task: &Task, state: &ContactState) -> Result<Vec<SurfaceWindow>> {
        match (self, state) {
            (Operators::Surface(operators), ContactState::Surface(state)) => {
                Ok(SurfaceOperators::windows(&Problem::new(operators, task), &state.fields))
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Depths by which the profiles of wheel and rail are worn.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]: there are none of a line contact or a patch.
    pub fn profile_wear(&self, task: &Task, state: &ContactState) -> Result<ProfileDepths> {
        match (self, state) {
            (Operators::Surface(operators), ContactState::Surface(state)) => {
                Ok(SurfaceOperators::depths(&Problem::new(operators, task), &state.fields))
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Profiles of wheel and rail as they are worn.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`]; a profile that is worn beyond its radius of curvature.
    pub fn worn_profiles(&self, state: &ContactState) -> Result<[Profile; 2]> {
        match (self, state) {
            (Operators::Surface(operators), ContactState::Surface(state)) => {
                surface::worn_bodies::profiles(operators, &state.fields.worn)
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Side of the corners of a layer's law that the nodes are on; none for a state of another contact model.
    #[cfg(feature = "verification")]
    pub fn layer_sides(&self, state: &ContactState) -> Vec<Option<Ordering>> {
        let sides: Result<_> = with_model!(self, state, |_operators, state| {
            state.fields.memories().flat_map(Memory::layer_sides).collect()
        });
        sides.unwrap_or_default()
    }

    /// Whether a state (of another source) has the sizes of these operators and finite content.
    pub fn accepts(&self, state: &ContactState) -> bool {
        with_model!(self, state, |operators, state| state
            .is_valid(&EngineState::at_rest(operators.fields())))
        .unwrap_or(false)
    }

    /// Length along the rail of the window in which the contact is sought, `m`.
    pub fn window_length(&self) -> f64 {
        match self {
            Operators::Line(operators) => operators.window_length(),
            Operators::Patch(operators) => operators.window_length(),
            Operators::Surface(operators) => operators.window_length(),
        }
    }

    /// Operators of a line contact.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    pub fn line(&self) -> Result<&LineOperators> {
        match self {
            Operators::Line(operators) => Ok(operators),
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Operators of a patch.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn patch(&self) -> Result<&PatchOperators> {
        match self {
            Operators::Patch(operators) => Ok(operators),
            _ => Err(Error::OtherContactModel),
        }
    }
}

impl ContactWorkspace {
    /// Iterations of the mechanics since the workspace was made.
    pub fn iterations(&self) -> Iterations {
        match self {
            ContactWorkspace::Line(workspace) => LineOperators::iterations(&workspace.solvers),
            ContactWorkspace::Patch(workspace) => PatchOperators::iterations(&workspace.solvers),
            ContactWorkspace::Surface(workspace) => SurfaceOperators::iterations(&workspace.solvers),
        }
    }

    /// Renews the budget of work.
    pub fn renew_budget(&mut self) {
        match self {
            ContactWorkspace::Line(workspace) => workspace.renew_budget(),
            ContactWorkspace::Patch(workspace) => workspace.renew_budget(),
            ContactWorkspace::Surface(workspace) => workspace.renew_budget(),
        }
    }

    /// Makes the solution of [`Operators::solve`] over `duration` `s` the state. What that has refused as of another contact model
    /// stays as it is.
    pub fn commit(&mut self, state: &mut ContactState, duration: f64) {
        match (self, state) {
            (ContactWorkspace::Line(workspace), ContactState::Line(state)) => workspace.commit(state, duration),
            (ContactWorkspace::Patch(workspace), ContactState::Patch(state)) => workspace.commit(state, duration),
            (ContactWorkspace::Surface(workspace), ContactState::Surface(state)) => workspace.commit(state, duration),
            _ => {}
        }
    }
}

impl ContactState {
    /// State of a line contact.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn line(&self) -> Result<&EngineState<LineFields>> {
        match self {
            ContactState::Line(state) => Ok(state),
            _ => Err(Error::OtherContactModel),
        }
    }

    /// State of a patch.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn patch(&self) -> Result<&EngineState<PatchFields>> {
        match self {
            ContactState::Patch(state) => Ok(state),
            _ => Err(Error::OtherContactModel),
        }
    }

    /// State of a line contact, for tests that prepare one.
    #[cfg(test)]
    pub fn line_mut(&mut self) -> &mut EngineState<LineFields> {
        match self {
            ContactState::Line(state) => state,
            _ => panic!("the state of another model"),
        }
    }
}
