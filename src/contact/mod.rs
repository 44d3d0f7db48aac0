//! The contact of wheel and rail: one implicit step of tractions, temperature and wear.
//!
//! An engine resolves the contact; [`mod@line`] resolves it along the rail. What does not depend on how it is resolved is
//! shared: the [`task`] of a step, [`resultants`] of the fields, [`outputs`] from them, the wheel's [`rim`].
//!
//! The engines stand side by side in enums, not behind a trait, because their states are serialised.

pub mod line;
pub mod outputs;
pub mod resultants;
pub mod rim;
pub mod task;

use crate::error::Result;
use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::Outputs;
use line::engine::{Line, LineState, LineWorkspace};
use line::profiles::Profiles;
use outputs::Readings;
use serde::{Deserialize, Serialize};
use task::{Convergence, Task};

/// What is computed once.
pub enum Engine {
    /// A line contact.
    Line(Line),
}

/// The fields of a contact, all that a step changes.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub enum ContactState {
    /// Of a line contact.
    Line(LineState),
}

/// Scratch of a step.
pub enum ContactWorkspace {
    /// Of a line contact.
    Line(LineWorkspace),
}

impl Engine {
    /// Meshes, compliance, thermal maps.
    ///
    /// # Errors
    /// [`crate::error::Error::StiffnessNotPositiveDefinite`], [`crate::error::Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Engine> {
        Ok(Engine::Line(Line::new(parameters)?))
    }

    /// Scratch for the steps.
    pub fn workspace(&self, settings: &Settings) -> ContactWorkspace {
        let Engine::Line(line) = self;
        ContactWorkspace::Line(line.workspace(settings))
    }

    /// Rail and wheel at ambient and unworn: mechanics solved, no heat and no wear yet, nothing has come in.
    ///
    /// # Errors
    /// A solver that did not converge.
    pub fn initial_state(&self, task: &Task, workspace: &mut ContactWorkspace) -> Result<ContactState> {
        let (Engine::Line(line), ContactWorkspace::Line(workspace)) = (self, workspace);
        Ok(ContactState::Line(line.initial_state(task, workspace)?))
    }

    /// Solves one implicit step from `state`; the solution stays in the workspace until [`Engine::commit`]. The step before
    /// took `last_duration` `s`.
    ///
    /// # Errors
    /// The first solver that did not converge, or a contact that leaves the window.
    pub fn solve(
        &self,
        task: &Task,
        workspace: &mut ContactWorkspace,
        state: &ContactState,
        last_duration: f64,
    ) -> Result<(Convergence, Readings)> {
        let (Engine::Line(line), ContactWorkspace::Line(workspace), ContactState::Line(state)) =
            (self, workspace, state);
        line.solve(task, workspace, state, last_duration)
    }

    /// Makes the solution of [`Engine::solve`] over `duration` `s` the state.
    pub fn commit(&self, workspace: &mut ContactWorkspace, state: &mut ContactState, duration: f64) {
        let (ContactWorkspace::Line(workspace), ContactState::Line(state)) = (workspace, state);
        workspace.commit(state, duration);
    }

    /// What the outputs are made of.
    pub fn readings(&self, task: &Task, state: &ContactState) -> Readings {
        let (Engine::Line(line), ContactState::Line(state)) = (self, state);
        line.readings(task, state)
    }

    /// Derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`], from the linearised
    /// step that ended in `state`.
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn sensitivities(
        &self,
        task: &Task,
        workspace: &mut ContactWorkspace,
        state: &ContactState,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        let (Engine::Line(line), ContactWorkspace::Line(workspace), ContactState::Line(state)) =
            (self, workspace, state);
        line.sensitivities(task, workspace, state, inputs)
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &ContactState, ambient: f64) -> Profiles {
        let (Engine::Line(line), ContactState::Line(state)) = (self, state);
        line.profiles(state, ambient)
    }

    /// Whether a state (of another source) has the sizes of this engine's and finite content.
    pub fn accepts(&self, state: &ContactState) -> bool {
        let (Engine::Line(line), ContactState::Line(state)) = (self, state);
        line.accepts(state)
    }

    /// Length along the rail of the window in which the contact is sought, `m`.
    pub fn window_length(&self) -> f64 {
        let Engine::Line(line) = self;
        2.0 * line.rail().mesh.window_half_width()
    }

    /// The line engine.
    pub fn line(&self) -> &Line {
        let Engine::Line(line) = self;
        line
    }
}

impl ContactState {
    /// The state of the line engine.
    pub fn line(&self) -> &LineState {
        let ContactState::Line(state) = self;
        state
    }

    /// The state of the line engine, for tests that prepare one.
    #[cfg(test)]
    pub fn line_mut(&mut self) -> &mut LineState {
        let ContactState::Line(state) = self;
        state
    }
}
