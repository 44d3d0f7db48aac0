//! A model with its scratch and state, stepped together.

use crate::error::Result;
use crate::parameters::Parameters;
use crate::signals::{Inputs, Outputs};
use crate::wheel_rail::{Model, State, Workspace};

/// A model, its scratch and its state.
pub struct Run {
    /// The model.
    pub model: Model,
    /// Scratch of its steps.
    pub workspace: Workspace,
    /// Where it stands.
    pub state: State,
}

impl Run {
    /// Builds the model and solves the mechanics of the cold, unworn rail under `inputs`.
    ///
    /// # Errors
    /// Whatever [`Model::new`] and [`Model::initial_state`] return.
    pub fn new(parameters: &Parameters, inputs: &Inputs) -> Result<Run> {
        let model = Model::new(parameters.clone())?;
        let mut workspace = model.workspace();
        let state = model.initial_state(&mut workspace, inputs)?;
        Ok(Run {
            model,
            workspace,
            state,
        })
    }

    /// One communication step of `duration` `s` under constant inputs.
    ///
    /// # Errors
    /// The reason of an interrupted step.
    pub fn step(&mut self, inputs: &Inputs, duration: f64) -> Result<()> {
        self.model
            .step(&mut self.workspace, &mut self.state, inputs, &Inputs::ZERO, duration)
            .map_err(|interrupted| interrupted.error)
    }

    /// Constant inputs, held in `steps` steps of `duration` `s` each. Returns the outputs at the end.
    ///
    /// # Errors
    /// The reason of an interrupted step.
    pub fn hold(&mut self, inputs: &Inputs, duration: f64, steps: usize) -> Result<&Outputs> {
        for _ in 0..steps {
            self.step(inputs, duration)?;
        }
        Ok(&self.state.outputs)
    }

    /// Contact nodes from the rear of the contact to its front for +V: position `m`, pressure `Pa`, shear traction
    /// `Pa`, slip velocity `m/s`.
    pub fn contact_nodes(&self) -> Vec<ContactNode> {
        let (mesh, scale) = (&self.model.rail().mesh, self.model.rail().scales.pressure);
        let fields = self.state.fields();
        (0..mesh.contact_nodes)
            .map(|i| ContactNode {
                position: mesh.contact_position(i),
                pressure: fields.pressure[i] * scale,
                shear: fields.shear[i] * scale,
                slip: fields.slip[i],
                temperature: fields.surface_temperature[mesh.contact_column(i)],
            })
            .collect()
    }
}

/// The fields at one surface node of the contact window.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactNode {
    /// x₁, `m`.
    pub position: f64,
    /// Pressure, `Pa`.
    pub pressure: f64,
    /// Shear traction on the rail, `Pa`.
    pub shear: f64,
    /// Slip velocity, `m/s`; 0 outside the contact.
    pub slip: f64,
    /// Temperature rise, `K`.
    pub temperature: f64,
}
