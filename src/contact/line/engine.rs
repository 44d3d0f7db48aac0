//! The line engine from outside: built once, stepped from state to state.

use super::fields::{Fields, Trend};
use super::problem::Problem;
use super::profiles::Profiles;
use super::rail::Rail;
use super::readings::readings;
use super::sensitivity::Linearisation;
use super::split::{self, Scratch};
use crate::contact::outputs::Readings;
use crate::contact::task::{Convergence, Task};
use crate::error::Result;
use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::Outputs;
use serde::{Deserialize, Serialize};

/// A line contact: what is computed once.
pub struct Line {
    rail: Rail,
}

/// The state of a line contact.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct LineState {
    /// Temperature, wear, tractions.
    pub fields: Fields,
    /// How they changed over the last step.
    pub trend: Trend,
}

/// Scratch of a step. What a step leaves in it changes no result of another one.
pub struct LineWorkspace {
    scratch: Scratch,
    /// The fields that a step works on, its solution until it is committed.
    trial: Fields,
}

impl LineWorkspace {
    /// Makes the solution the state.
    pub fn commit(&mut self, state: &mut LineState, duration: f64) {
        state.trend.update(&state.fields, &self.trial, duration);
        std::mem::swap(&mut state.fields, &mut self.trial);
    }
}

impl Line {
    /// Mesh, compliance, thermal maps.
    ///
    /// # Errors
    /// [`crate::error::Error::StiffnessNotPositiveDefinite`], [`crate::error::Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Line> {
        Ok(Line {
            rail: Rail::new(parameters)?,
        })
    }

    /// What was computed once.
    pub fn rail(&self) -> &Rail {
        &self.rail
    }

    /// Scratch for the steps.
    pub fn workspace(&self, settings: &Settings) -> LineWorkspace {
        LineWorkspace {
            scratch: Scratch::new(&self.rail, settings),
            trial: Fields::new(&self.rail),
        }
    }

    fn problem<'a>(&'a self, task: &Task<'a>) -> Problem<'a> {
        Problem {
            rail: &self.rail,
            parameters: task.parameters,
            settings: task.settings,
            conditions: task.conditions,
        }
    }

    /// Cold and unworn, mechanics solved.
    ///
    /// # Errors
    /// A solver that did not converge.
    pub fn initial_state(&self, task: &Task, workspace: &mut LineWorkspace) -> Result<LineState> {
        let mut fields = Fields::new(&self.rail);
        fields.wheel_temperature = task.conditions.inputs.ambient_temperature;
        split::solve_mechanics(&self.problem(task), &mut fields, &mut workspace.scratch)?;
        Ok(LineState {
            fields,
            trend: Trend::new(&self.rail),
        })
    }

    /// One implicit step from `state`, into the workspace. The step before took `last_duration` `s`.
    ///
    /// # Errors
    /// The first solver that did not converge, or a contact that leaves the window.
    pub fn solve(
        &self,
        task: &Task,
        workspace: &mut LineWorkspace,
        state: &LineState,
        last_duration: f64,
    ) -> Result<(Convergence, Readings)> {
        let LineWorkspace { scratch, trial } = workspace;
        // The first guess is extrapolated, over no longer than the trend was observed. The temperature below the surface is
        // left out: the march computes it anew from that of the step before.
        trial.copy_surface_from(&state.fields);
        state
            .trend
            .extrapolate(trial, task.conditions.duration.min(last_duration));
        let problem = self.problem(task);
        let convergence = split::solve(&problem, &state.fields, trial, scratch)?;
        Ok((convergence, readings(&problem, trial)))
    }

    /// What the outputs are made of.
    pub fn readings(&self, task: &Task, state: &LineState) -> Readings {
        readings(&self.problem(task), &state.fields)
    }

    /// Derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`].
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn sensitivities(
        &self,
        task: &Task,
        workspace: &mut LineWorkspace,
        state: &LineState,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        let LineWorkspace { scratch, trial } = workspace;
        trial.copy_from(&state.fields);
        let mut step = Linearisation::new(self.problem(task), trial, scratch)?;
        inputs.into_iter().map(|input| step.output_sensitivity(input)).collect()
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &LineState, ambient: f64) -> Profiles {
        Profiles::new(&self.rail, &state.fields, ambient)
    }

    /// Whether a state (of another source) has the sizes of this rail and finite content.
    pub fn accepts(&self, state: &LineState) -> bool {
        let same = |own: &[&Vec<f64>], expected: &[&Vec<f64>]| {
            own.iter()
                .zip(expected)
                .all(|(own, expected)| own.len() == expected.len() && own.iter().all(|value| value.is_finite()))
        };
        same(&state.fields.vectors(), &Fields::new(&self.rail).vectors())
            && same(&state.trend.vectors(), &Trend::new(&self.rail).vectors())
            && state.fields.penetration.is_finite()
            && state.fields.wheel_temperature.is_finite()
    }
}
