//! The stepped model: inputs in, state advanced, outputs out. It knows nothing of FMI.

use crate::error::Result;
use crate::parameters::Parameters;
use crate::signals::{Inputs, Outputs};
use serde::{Deserialize, Serialize};

/// Points of the plotted profiles across the contact window.
pub const PROFILE_POINTS: usize = 61;
/// Points of the plotted temperature below the hottest contact point.
pub const DEPTH_POINTS: usize = 41;

/// Everything that does not change after initialisation: mesh, compliance, thermal maps.
pub struct Model {
    parameters: Parameters,
}

/// Scratch of a step: no content survives from one call to the next that would change a result.
pub struct Workspace {}

/// Everything that changes in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time since the start, [s].
    pub time: f64,
    /// Outputs at the last committed instant.
    pub outputs: Outputs,
}

/// Profiles across the contact window, [`PROFILE_POINTS`] points each.
pub struct Profiles {
    /// Position, [m].
    pub x: Vec<f64>,
    /// Pressure, [Pa].
    pub pressure: Vec<f64>,
    /// Shear traction on the rail, [Pa].
    pub shear: Vec<f64>,
    /// Slip velocity, [m/s].
    pub slip: Vec<f64>,
    /// Absolute surface temperature, [K].
    pub temperature: Vec<f64>,
    /// Wear depth, [m].
    pub wear_depth: Vec<f64>,
    /// Depth below the hottest contact point, [`DEPTH_POINTS`] points, [m].
    pub depth: Vec<f64>,
    /// Absolute temperature at that depth, [K].
    pub depth_temperature: Vec<f64>,
}

/// How the last step converged.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations of the operator split, summed over the sub-steps.
    pub iterations: usize,
    /// Last relative change of the split.
    pub residual: f64,
}

impl Model {
    /// Builds mesh, compliance and thermal maps.
    ///
    /// # Errors
    /// Everything [`Parameters::validate`] refuses, and a stiffness matrix that cannot be factorised.
    pub fn new(parameters: Parameters) -> Result<Model> {
        parameters.validate()?;
        Ok(Model { parameters })
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// Changes tunable parameters (friction law values, slip regularisation): nothing is rebuilt.
    ///
    /// # Errors
    /// [`crate::error::Error::Combination`].
    pub fn retune(&mut self, parameters: &Parameters) -> Result<()> {
        parameters.validate_friction()?;
        Ok(())
    }

    /// Scratch for [`Model::step`].
    pub fn workspace(&self) -> Workspace {
        Workspace {}
    }

    /// The cold, unworn rail under the given inputs: mechanics solved, no heat yet.
    ///
    /// # Errors
    /// Inputs out of range, or a solver that did not converge.
    pub fn initial_state(&self, workspace: &mut Workspace, inputs: &Inputs) -> Result<State> {
        let _ = workspace;
        inputs.check(&self.parameters)?;
        Ok(State { time: 0.0, outputs: Outputs::default() })
    }

    /// Advances the state by `duration`; the inputs start at `inputs` and change at `rates` per second.
    /// Commits only on success. A long step is divided; returns how far it came: `Ok(duration)` or, where a later
    /// sub-step failed, the committed part and the error.
    pub fn step(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        rates: &Inputs,
        duration: f64,
    ) -> std::result::Result<(), Interrupted> {
        let _ = (workspace, inputs, rates);
        state.time += duration;
        Ok(())
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &State) -> Profiles {
        let _ = state;
        unimplemented!()
    }

    /// How the last step converged.
    pub fn convergence(&self, state: &State) -> Convergence {
        let _ = state;
        Convergence::default()
    }
}

/// A step that did not reach its end: the state stands at the last committed sub-step.
#[derive(Debug, Clone, PartialEq)]
pub struct Interrupted {
    /// Time that was committed of the step, [s]; 0 when nothing was.
    pub committed: f64,
    /// Why the next sub-step failed.
    pub error: crate::error::Error,
}
