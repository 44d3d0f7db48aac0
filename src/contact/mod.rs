//! The contact of wheel and rail: one implicit step of tractions, temperature and wear.
//!
//! An engine resolves the contact: [`mod@line`] along the rail, [`patch`] along and across it. What does not depend on how it
//! is resolved is shared: the [`task`] of a step, [`resultants`] of the fields, [`outputs`] from them, [`profiles`] for plotting,
//! the wheel's [`rim`].
//!
//! The engines stand side by side in enums, not behind a trait, because their states are serialised.

pub mod line;
pub mod outputs;
pub mod patch;
pub mod profiles;
pub mod rest;
pub mod resultants;
pub mod rim;
pub mod task;

use crate::error::{Error, Result};
use crate::parameters::{ContactModel, Parameters};
use crate::settings::Settings;
use crate::signals::Outputs;
use line::engine::{Line, LineState, LineWorkspace};
use outputs::Readings;
use patch::engine::{Patch, PatchState, PatchWorkspace};
use profiles::{ContactNode, Profiles};
use serde::{Deserialize, Serialize};
use task::{Convergence, Task};

/// What is computed once.
#[allow(clippy::large_enum_variant, reason = "there are few, and they are not moved")]
pub enum Engine {
    /// A line contact.
    Line(Line),
    /// A patch.
    Patch(Patch),
}

/// The fields of a contact, all that a step changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[allow(
    clippy::large_enum_variant,
    reason = "there are few, and what they hold is elsewhere"
)]
pub enum ContactState {
    /// Of a line contact.
    Line(LineState),
    /// Of a patch.
    Patch(PatchState),
}

/// Scratch of a step.
#[allow(clippy::large_enum_variant, reason = "there are few, and they are not moved")]
pub enum ContactWorkspace {
    /// Of a line contact.
    Line(LineWorkspace),
    /// Of a patch.
    Patch(PatchWorkspace),
}

impl Engine {
    /// Meshes, compliance, thermal maps.
    ///
    /// # Errors
    /// [`Error::StiffnessNotPositiveDefinite`], [`Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Engine> {
        Ok(match parameters.contact_model {
            ContactModel::Line => Engine::Line(Line::new(parameters)?),
            ContactModel::Patch => Engine::Patch(Patch::new(parameters)?),
        })
    }

    /// Scratch for the steps.
    pub fn workspace(&self, settings: &Settings) -> ContactWorkspace {
        match self {
            Engine::Line(line) => ContactWorkspace::Line(line.workspace(settings)),
            Engine::Patch(patch) => ContactWorkspace::Patch(patch.workspace(settings)),
        }
    }

    /// Rail and wheel at ambient and unworn: mechanics solved, no heat and no wear yet, nothing has come in. With it what its
    /// outputs are made of.
    ///
    /// # Errors
    /// A solver that did not converge, or [`Error::OtherContactModel`].
    pub fn initial_state(&self, task: &Task, workspace: &mut ContactWorkspace) -> Result<(ContactState, Readings)> {
        match (self, workspace) {
            (Engine::Line(line), ContactWorkspace::Line(workspace)) => {
                let state = line.initial_state(task, workspace)?;
                let readings = line.readings(task, &state);
                Ok((ContactState::Line(state), readings))
            }
            (Engine::Patch(patch), ContactWorkspace::Patch(workspace)) => {
                let state = patch.initial_state(task, workspace)?;
                let readings = patch.readings(task, &state);
                Ok((ContactState::Patch(state), readings))
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Solves one implicit step from `state`; the solution stays in the workspace until [`ContactWorkspace::commit`]. The step
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
    ) -> Result<(Convergence, Readings)> {
        match (self, workspace, state) {
            (Engine::Line(line), ContactWorkspace::Line(workspace), ContactState::Line(state)) => {
                line.solve(task, workspace, state, last_duration)
            }
            (Engine::Patch(patch), ContactWorkspace::Patch(workspace), ContactState::Patch(state)) => {
                patch.solve(task, workspace, state, last_duration)
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`], from the linearised
    /// step that ended in `state`.
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
        match (self, workspace, state) {
            (Engine::Line(line), ContactWorkspace::Line(workspace), ContactState::Line(state)) => {
                line.sensitivities(task, workspace, state, inputs)
            }
            (Engine::Patch(patch), ContactWorkspace::Patch(workspace), ContactState::Patch(state)) => {
                patch.sensitivities(task, workspace, state, inputs)
            }
            _ => Err(Error::OtherContactModel),
        }
    }

    /// Profiles for plotting; those of an untouched rail for a state of another contact model.
    pub fn profiles(&self, task: &Task, state: &ContactState) -> Profiles {
        let ambient = task.conditions.inputs.ambient_temperature;
        match (self, state) {
            (Engine::Line(line), ContactState::Line(state)) => line.profiles(state, ambient),
            (Engine::Patch(patch), ContactState::Patch(state)) => patch.profiles(task, state, ambient),
            _ => Profiles::untouched(ambient),
        }
    }

    /// The fields at the nodes of the contact window; none for a state of another contact model.
    pub fn contact_nodes(&self, state: &ContactState) -> Vec<ContactNode> {
        match (self, state) {
            (Engine::Line(line), ContactState::Line(state)) => line.contact_nodes(state),
            (Engine::Patch(patch), ContactState::Patch(state)) => patch.contact_nodes(state),
            _ => Vec::new(),
        }
    }

    /// Whether a state (of another source) has the sizes of this engine's and finite content.
    pub fn accepts(&self, state: &ContactState) -> bool {
        match (self, state) {
            (Engine::Line(line), ContactState::Line(state)) => line.accepts(state),
            (Engine::Patch(patch), ContactState::Patch(state)) => patch.accepts(state),
            _ => false,
        }
    }

    /// Length along the rail of the window in which the contact is sought, `m`.
    pub fn window_length(&self) -> f64 {
        match self {
            Engine::Line(line) => line.window_length(),
            Engine::Patch(patch) => patch.window_length(),
        }
    }

    /// The line engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    pub fn line(&self) -> Result<&Line> {
        match self {
            Engine::Line(line) => Ok(line),
            Engine::Patch(_) => Err(Error::OtherContactModel),
        }
    }

    /// The patch engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn patch(&self) -> Result<&Patch> {
        match self {
            Engine::Patch(patch) => Ok(patch),
            Engine::Line(_) => Err(Error::OtherContactModel),
        }
    }
}

impl ContactWorkspace {
    /// Makes the solution of [`Engine::solve`] over `duration` `s` the state. What that has refused as of another contact model
    /// stays as it is.
    pub fn commit(&mut self, state: &mut ContactState, duration: f64) {
        match (self, state) {
            (ContactWorkspace::Line(workspace), ContactState::Line(state)) => workspace.commit(state, duration),
            (ContactWorkspace::Patch(workspace), ContactState::Patch(state)) => workspace.commit(state, duration),
            _ => {}
        }
    }
}

impl ContactState {
    /// The state of the line engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn line(&self) -> Result<&LineState> {
        match self {
            ContactState::Line(state) => Ok(state),
            ContactState::Patch(_) => Err(Error::OtherContactModel),
        }
    }

    /// The state of the patch engine.
    ///
    /// # Errors
    /// [`Error::OtherContactModel`].
    #[cfg(feature = "verification")]
    pub fn patch(&self) -> Result<&PatchState> {
        match self {
            ContactState::Patch(state) => Ok(state),
            ContactState::Line(_) => Err(Error::OtherContactModel),
        }
    }

    /// The state of the line engine, for tests that prepare one.
    #[cfg(test)]
    pub fn line_mut(&mut self) -> &mut LineState {
        match self {
            ContactState::Line(state) => state,
            ContactState::Patch(_) => panic!("the state of a patch"),
        }
    }
}
