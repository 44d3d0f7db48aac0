//! The patch engine from outside: built once, stepped from state to state.

use super::fields::{PatchFields, PatchTrend};
use super::operators::PatchOperators;
use super::problem::Problem;
use super::profiles;
use super::readings::readings;
use super::scratch::Scratch;
use super::sensitivity::{Linearisation, SensitivityScratch};
use super::split;
use crate::contact::outputs::Readings;
use crate::contact::profiles::{ContactNode, Profiles};
use crate::contact::task::{Convergence, Task};
use crate::error::Result;
use crate::parameters::Parameters;
use crate::settings::Settings;
use crate::signals::Outputs;
use serde::{Deserialize, Serialize};

/// A patch: what is computed once.
pub struct Patch {
    operators: PatchOperators,
}

/// The state of a patch.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatchState {
    /// Temperature, wear, tractions.
    pub fields: PatchFields,
    /// How they changed over the last step.
    pub trend: PatchTrend,
}

/// Scratch of a step. What a step leaves in it changes no result of another one.
pub struct PatchWorkspace {
    scratch: Scratch,
    /// The fields that a step works on, its solution until it is committed.
    trial: PatchFields,
    /// For derivatives, from the first that is asked for.
    sensitivity: Option<Box<SensitivityScratch>>,
}

impl PatchWorkspace {
    /// Makes the solution the state.
    pub fn commit(&mut self, state: &mut PatchState, duration: f64) {
        state.trend.update(&state.fields, &self.trial, duration);
        std::mem::swap(&mut state.fields, &mut self.trial);
    }
}

impl Patch {
    /// Grid, influence functions, depth modes.
    ///
    /// # Errors
    /// [`Error::DepthBasis`].
    pub fn new(parameters: &Parameters) -> Result<Patch> {
        Ok(Patch {
            operators: PatchOperators::new(parameters)?,
        })
    }

    /// What was computed once.
    #[cfg(feature = "verification")]
    pub fn operators(&self) -> &PatchOperators {
        &self.operators
    }

    /// Scratch for the steps.
    pub fn workspace(&self, settings: &Settings) -> PatchWorkspace {
        PatchWorkspace {
            scratch: Scratch::new(&self.operators, settings),
            trial: PatchFields::new(&self.operators),
            sensitivity: None,
        }
    }

    /// Length along the rail of the window in which the contact is sought, `m`.
    pub fn window_length(&self) -> f64 {
        2.0 * self.operators.grid.half_length()
    }

    fn problem<'a>(&'a self, task: &Task<'a>) -> Problem<'a> {
        Problem {
            operators: &self.operators,
            parameters: task.parameters,
            settings: task.settings,
            conditions: task.conditions,
        }
    }

    /// Cold and unworn, mechanics solved.
    ///
    /// # Errors
    /// A solver that did not converge.
    pub fn initial_state(&self, task: &Task, workspace: &mut PatchWorkspace) -> Result<PatchState> {
        let mut fields = PatchFields::new(&self.operators);
        fields.wheel_temperature = task.conditions.inputs.ambient_temperature;
        split::solve_mechanics(&self.problem(task), &mut fields, &mut workspace.scratch)?;
        Ok(PatchState {
            fields,
            trend: PatchTrend::new(&self.operators),
        })
    }

    /// One implicit step from `state`, into the workspace. The step before took `last_duration` `s`.
    ///
    /// # Errors
    /// The first solver that did not converge, or a contact that leaves the window.
    pub fn solve(
        &self,
        task: &Task,
        workspace: &mut PatchWorkspace,
        state: &PatchState,
        last_duration: f64,
    ) -> Result<(Convergence, Readings)> {
        let PatchWorkspace { scratch, trial, .. } = workspace;
        trial.copy_contact_from(&state.fields);
        let problem = self.problem(task);
        let ahead = task.conditions.duration.min(last_duration);
        let convergence = split::solve(&problem, &state.fields, (&state.trend, ahead), trial, scratch)?;
        Ok((convergence, readings(&problem, trial)))
    }

    /// What the outputs are made of.
    pub fn readings(&self, task: &Task, state: &PatchState) -> Readings {
        readings(&self.problem(task), &state.fields)
    }

    /// Derivatives of all outputs with respect to each of the given rows of [`crate::signals::INPUTS`].
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn sensitivities(
        &self,
        task: &Task,
        workspace: &mut PatchWorkspace,
        state: &PatchState,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        let scratch = workspace
            .sensitivity
            .get_or_insert_with(|| Box::new(SensitivityScratch::new(&self.operators, task.settings)));
        let mut step = Linearisation::new(self.problem(task), &state.fields, scratch)?;
        inputs.into_iter().map(|input| step.output_sensitivity(input)).collect()
    }

    /// Profiles for plotting.
    pub fn profiles(&self, task: &Task, state: &PatchState, ambient: f64) -> Profiles {
        profiles::profiles(&self.problem(task), &state.fields, ambient)
    }

    /// The fields at the cells of the window, strip by strip.
    pub fn contact_nodes(&self, state: &PatchState) -> Vec<ContactNode> {
        profiles::contact_nodes(&self.operators, &state.fields)
    }

    /// Whether a state (of another source) has the sizes of this patch and finite content.
    pub fn accepts(&self, state: &PatchState) -> bool {
        let expected = PatchFields::new(&self.operators);
        let same = |own: &Vec<f64>, expected: &Vec<f64>| {
            own.len() == expected.len() && own.iter().all(|value| value.is_finite())
        };
        let trend = PatchTrend::new(&self.operators);
        state
            .fields
            .vectors()
            .zip(expected.vectors())
            .all(|(own, expected)| same(own, expected))
            && state
                .trend
                .vectors()
                .iter()
                .zip(trend.vectors())
                .all(|(own, expected)| same(own, expected))
            && state.fields.numbers().iter().all(|number| number.is_finite())
            && state.fields.relaxation_length > 0.0
            && state.fields.heat.breadth > 0.0
            && state.fields.wear.breadth > 0.0
    }
}
