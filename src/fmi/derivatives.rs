//! Derivatives of inputs and outputs.

use super::component::{Built, Component};
use super::failures::Failure;
use super::variables::ValueReference;
use crate::signals::{INPUTS, Inputs, OUTPUTS, Outputs};
use std::collections::{BTreeMap, BTreeSet};
use std::mem::MaybeUninit;
use std::ops::Range;

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

    /// The rates of change of outputs at the communication point, per second, of an array those of its elements; 0 for orders
    /// above 1, as the standards have it.
    ///
    /// # Errors
    /// What `outputs` refuses, [`Failure::Order`], [`Failure::NothingComputed`].
    pub fn output_derivatives(
        &mut self,
        outputs: OutputRows,
        references: &[ValueReference],
        orders: &[i32],
        values: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        for (reference, order) in references.iter().zip(orders) {
            let name = OUTPUTS[outputs(*reference)?.start].name;
            if *order < 1 {
                return Err(Failure::Order { name, order: *order });
            }
        }
        let rates = self.output_rates()?;
        let mut places = values.iter_mut();
        for (reference, order) in references.iter().zip(orders) {
            for (row, place) in outputs(*reference)?.zip(&mut places) {
                let rate = (OUTPUTS[row].get)(&rates);
                place.write(if *order == 1 { rate } else { 0.0 });
            }
        }
        Ok(())
    }

    /// The derivatives of all outputs with respect to the inputs of the given rows.
    fn sensitivities(&mut self, inputs: impl IntoIterator<Item = usize>) -> Result<Vec<Outputs>, Failure> {
        let (Built { model, workspace }, state) = self.solved()?;
        let sensitivities = model.output_sensitivities(workspace, state, inputs);
        sensitivities.map_err(Failure::Model)
    }

    /// The derivatives of outputs in a direction of the inputs: v = J s, J the derivatives of the unknowns with respect to the
    /// knowns.
    ///
    /// # Errors
    /// What `rows` refuses; [`Failure::Seed`], [`Failure::NothingComputed`], or [`Failure::Model`] where the linearised
    /// equations have no solution.
    pub fn directional_derivative(
        &mut self,
        jacobian: &Jacobian,
        seed: &[f64],
        derivatives: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let Jacobian { unknowns, knowns, rows } = jacobian;
        for unknown in *unknowns {
            (rows.outputs)(*unknown)?;
        }
        // Each input once, however often it is named.
        let mut direction = BTreeMap::new();
        for (known, value) in knowns.iter().zip(seed) {
            let row = (rows.input)(*known)?;
            finite(rows.seed, INPUTS[row].name, *value)?;
            *direction.entry(row).or_insert(0.0) += value;
        }
        let sensitivities = self.sensitivities(direction.keys().copied())?;
        for (row, place) in rows.of(unknowns).zip(derivatives) {
            let output = &OUTPUTS[row?];
            let terms = sensitivities.iter().zip(direction.values());
            place.write(
                terms
                    .map(|(sensitivity, change)| (output.get)(sensitivity) * change)
                    .sum(),
            );
        }
        Ok(())
    }

    /// The derivatives of a weighted sum of outputs with respect to inputs: v = Jᵀ s, J the derivatives of the unknowns with
    /// respect to the knowns. There are fewer inputs than outputs, so that J itself, by one factorisation, costs little more
    /// than a transposed solution would.
    ///
    /// # Errors
    /// As [`Component::directional_derivative`].
    pub fn adjoint_derivative(
        &mut self,
        jacobian: &Jacobian,
        seed: &[f64],
        derivatives: &mut [MaybeUninit<f64>],
    ) -> Result<(), Failure> {
        let Jacobian { unknowns, knowns, rows } = jacobian;
        for (row, value) in rows.of(unknowns).zip(seed) {
            finite(rows.seed, OUTPUTS[row?].name, *value)?;
        }
        // Each input once, however often it is named.
        let inputs = knowns.iter().map(|known| (rows.input)(*known));
        let inputs = inputs.collect::<Result<BTreeSet<_>, _>>()?;
        let sensitivities = self.sensitivities(inputs.iter().copied())?;
        let sensitivities: BTreeMap<_, _> = inputs.into_iter().zip(sensitivities).collect();
        for (known, place) in knowns.iter().zip(derivatives) {
            let mut sum = 0.0;
            if let Some(sensitivity) = sensitivities.get(&(rows.input)(*known)?) {
                for (row, weight) in rows.of(unknowns).zip(seed) {
                    sum += (OUTPUTS[row?].get)(sensitivity) * weight;
                }
            }
            place.write(sum);
        }
        Ok(())
    }
}

/// Derivatives that a call asks for: those of the unknowns with respect to the knowns.
pub struct Jacobian<'a> {
    /// Value references of outputs.
    pub unknowns: &'a [ValueReference],
    /// Value references of inputs.
    pub knowns: &'a [ValueReference],
    /// Names of outputs and inputs in a version of FMI.
    pub rows: Rows,
}

/// Rows of [`OUTPUTS`] that a value reference stands for: several where it is an array.
pub type OutputRows = fn(ValueReference) -> Result<Range<usize>, Failure>;

/// Numbering of outputs and inputs in a version of FMI.
pub struct Rows {
    /// The rows of [`OUTPUTS`].
    pub outputs: OutputRows,
    /// The row of [`INPUTS`].
    pub input: fn(ValueReference) -> Result<usize, Failure>,
    /// The argument that holds the direction or the weights.
    pub seed: &'static str,
}

impl Rows {
    /// The rows of outputs one after another; one that is none ends them.
    fn of(&self, unknowns: &[ValueReference]) -> impl Iterator<Item = Result<usize, Failure>> {
        unknowns.iter().flat_map(|unknown| {
            let (rows, refused) = match (self.outputs)(*unknown) {
                Ok(rows) => (rows, None),
                Err(refused) => (0..0, Some(Err(refused))),
            };
            rows.map(Ok).chain(refused)
        })
    }
}

fn finite(argument: &'static str, name: &'static str, value: f64) -> Result<(), Failure> {
    if value.is_finite() {
        Ok(())
    } else {
        Err(Failure::Seed { argument, name, value })
    }
}
