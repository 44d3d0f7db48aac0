//! The patch engine from outside: built once, stepped from state to state.

use crate::contact::outputs::Readings;
use crate::contact::profiles::{ContactNode, Profiles};
use crate::contact::resultants::Resultants;
use crate::contact::rim::ContactHeat;
use crate::contact::task::{Convergence, Task};
use crate::error::{Error, Result};
use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::Outputs;
use serde::{Deserialize, Serialize};

/// A patch: what is computed once.
pub struct Patch {
    /// Half-length of the window along the rail, `m`.
    half_length: f64,
}

/// The state of a patch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatchState {
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

/// Scratch of a step. What a step leaves in it changes no result of another one.
pub struct PatchWorkspace {}

impl PatchWorkspace {
    /// Makes the solution the state.
    pub fn commit(&mut self, _state: &mut PatchState, _duration: f64) {}
}

impl Patch {
    /// Grid, influence functions, depth modes.
    ///
    /// # Errors
    /// None yet.
    pub fn new(parameters: &Parameters) -> Result<Patch> {
        Ok(Patch {
            half_length: parameters.patch_window().0,
        })
    }

    /// Scratch for the steps.
    pub fn workspace(&self, _settings: &Settings) -> PatchWorkspace {
        PatchWorkspace {}
    }

    /// Length along the rail of the window in which the contact is sought, `m`.
    pub fn window_length(&self) -> f64 {
        2.0 * self.half_length
    }

    /// Cold and unworn, mechanics solved.
    ///
    /// # Errors
    /// [`Error::PatchMissing`].
    pub fn initial_state(&self, _task: &Task, _workspace: &mut PatchWorkspace) -> Result<PatchState> {
        Err(Error::PatchMissing)
    }

    /// One implicit step from `state`, into the workspace. The step before took `last_duration` `s`.
    ///
    /// # Errors
    /// [`Error::PatchMissing`].
    pub fn solve(
        &self,
        _task: &Task,
        _workspace: &mut PatchWorkspace,
        _state: &PatchState,
        _last_duration: f64,
    ) -> Result<(Convergence, Readings)> {
        Err(Error::PatchMissing)
    }

    /// What the outputs are made of.
    pub fn readings(&self, _task: &Task, state: &PatchState) -> Readings {
        Readings {
            resultants: Resultants::default(),
            node_area: 0.0,
            pressure_scale: 1.0,
            penetration: 0.0,
            contact_length: 0.0,
            contact_breadth: 0.0,
            contact_area: 0.0,
            peak_rise: 0.0,
            wear_depth: 0.0,
            leaving_rise: 0.0,
            leaving_wear_depth: 0.0,
            wheel_heat: ContactHeat::default(),
            wheel_temperature: state.wheel_temperature,
        }
    }

    /// Derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`].
    ///
    /// # Errors
    /// [`Error::PatchMissing`].
    pub fn sensitivities(
        &self,
        _task: &Task,
        _workspace: &mut PatchWorkspace,
        _state: &PatchState,
        _inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        Err(Error::PatchMissing)
    }

    /// Profiles for plotting.
    pub fn profiles(&self, _state: &PatchState, ambient: f64) -> Profiles {
        Profiles::untouched(ambient)
    }

    /// The fields at the nodes of the contact window.
    pub fn contact_nodes(&self, _state: &PatchState) -> Vec<ContactNode> {
        Vec::new()
    }

    /// Whether a state (of another source) has the sizes of this patch and finite content.
    pub fn accepts(&self, state: &PatchState) -> bool {
        state.wheel_temperature.is_finite()
    }
}
