//! Derivatives of inputs and outputs.

use super::component::{Built, Component};
use super::failures::Failure;
use crate::signals::{Inputs, OUTPUTS, Outputs};
use std::collections::BTreeMap;

impl Component {
    /// The rates at which the inputs change in the next step, per second.
    pub fn rates(&self) -> Inputs {
        self.rates
    }

    /// Sets the rates at which the inputs change in the next step, per second: finite numbers. After it they are 0 again.
    pub fn set_rates(&mut self, rates: Inputs) {
        self.rates = rates;
    }

    /// Rates of change of the outputs at the communication point, per second.
    ///
    /// # Errors
    /// [`Failure::NothingComputed`].
    pub fn output_rates(&mut self) -> Result<Outputs, Failure> {
        let (built, state) = self.solved()?;
        Ok(built.model.output_rates(state))
    }

    /// The derivatives of all outputs in a direction of the inputs: row of [`crate::signals::INPUTS`] and change of that
    /// input, a finite number.
    ///
    /// # Errors
    /// [`Failure::NothingComputed`], or [`Failure::Model`] where the linearised equations have no solution.
    pub fn directional_derivative(&mut self, direction: &BTreeMap<usize, f64>) -> Result<Outputs, Failure> {
        let (Built { model, workspace }, state) = self.solved()?;
        let sensitivities = model
            .output_sensitivities(workspace, state, direction.keys().copied())
            .map_err(Failure::Model)?;
        let mut derivative = Outputs::default();
        for signal in OUTPUTS {
            let terms = sensitivities.iter().zip(direction.values());
            let sum = terms.fold(0.0, |sum, (sensitivity, change)| {
                sum + (signal.get)(sensitivity) * change
            });
            (signal.set)(&mut derivative, sum);
        }
        Ok(derivative)
    }
}
