//! The step, and derivatives of inputs and outputs.

use super::failure::Failure;
use super::instance::{Built, Instance, real};
use super::logging::Category;
use super::modes::Mode;
use super::types::{Integer, LAST_SUCCESSFUL_TIME, Real, StatusKind, ValueReference};
use super::variables::RealVariable;
use crate::signals::{INPUTS, Inputs, OUTPUTS};
use std::collections::BTreeMap;
use std::mem::MaybeUninit;

/// Room for rounding in times that a master adds up step by step: relative, some 10⁶ roundings.
const TIME_TOLERANCE: f64 = 1e-9;

impl Instance {
    /// fmi2DoStep.
    pub(super) fn do_step(&mut self, current: Real, size: Real) -> Result<(), Failure> {
        let end = current + size;
        if size.is_nan() || size <= 0.0 || !size.is_finite() {
            return Err(Failure::StepSize { value: size });
        }
        let start = self.experiment.map_or(0.0, |experiment| experiment.start);
        let room = TIME_TOLERANCE * self.time.abs().max(start.abs()).max(size);
        // Not a number is not close either.
        if !((current - self.time).abs() <= room && end.is_finite()) {
            return Err(Failure::CommunicationPoint {
                value: current,
                expected: self.time,
            });
        }
        if let Some(stop) = self.experiment.and_then(|experiment| experiment.stop) {
            if end > stop + TIME_TOLERANCE * stop.abs().max(start.abs()).max(size) {
                return Err(Failure::BeyondStop {
                    time: current,
                    size,
                    stop,
                });
            }
        }
        let (Some(Built { model, workspace }), Some(state)) = (&mut self.built, &mut self.state) else {
            return Err(Failure::NothingComputed);
        };
        let outcome = model.step(workspace, state, &self.inputs, &self.rates, size);
        self.profiles = None;
        match outcome {
            Ok(()) => {
                self.time = end;
                // Derivatives hold from the beginning of one step to its end.
                self.rates = Inputs::ZERO;
                self.inform_about_step();
                Ok(())
            }
            Err(interrupted) if interrupted.committed > 0.0 => {
                self.time = current + interrupted.committed;
                self.rates = Inputs::ZERO;
                self.mode = Mode::StepFailed;
                let (reached, committed) = (self.time, interrupted.committed);
                Err(Failure::Interrupted {
                    reached,
                    committed,
                    error: interrupted.error,
                })
            }
            Err(interrupted) => Err(Failure::Step {
                time: self.time,
                error: interrupted.error,
            }),
        }
    }

    fn inform_about_step(&mut self) {
        self.inform(Category::Solver, |instance| {
            let convergence = match (&instance.built, &instance.state) {
                (Some(built), Some(state)) => built.model.convergence(state),
                _ => Default::default(),
            };
            let (iterations, residual) = (convergence.iterations, convergence.residual);
            format!(
                "t = {} s: {iterations} iterations, residual {residual:e}",
                instance.time
            )
        });
    }

    /// The end of the last step that was committed, whole or in part, for fmi2GetRealStatus.
    pub(super) fn last_successful_time(&self, kind: StatusKind) -> Result<Real, Failure> {
        if kind == LAST_SUCCESSFUL_TIME {
            Ok(self.time)
        } else {
            Err(Failure::StatusKind { kind })
        }
    }

    /// fmi2SetRealInputDerivatives: all values or none.
    pub(super) fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &[Real],
    ) -> Result<(), Failure> {
        let mut rates = self.rates;
        let mut unused = None;
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let RealVariable::Input(row) = real(*reference)? else {
                return Err(Failure::UnknownReference {
                    reference: *reference,
                    expected: "an input",
                });
            };
            let (row, order, value) = (&INPUTS[row], *order, *value);
            let name = row.name;
            match order {
                ..=0 => return Err(Failure::Order { name, order }),
                _ if !value.is_finite() => return Err(Failure::Rate { name, value }),
                1 => (row.set)(&mut rates, value),
                _ => unused = Some(Failure::HigherOrder { name, order }),
            }
        }
        self.rates = rates;
        unused.map_or(Ok(()), Err)
    }

    /// fmi2GetRealOutputDerivatives; 0 for orders above 1, as the standard has it.
    pub(super) fn get_output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        for (reference, order) in references.iter().zip(orders) {
            let name = OUTPUTS[output(*reference)?].name;
            if *order < 1 {
                return Err(Failure::Order { name, order: *order });
            }
        }
        let (built, state) = self.solved()?;
        let rates = built.model.output_rates(state);
        for ((reference, order), place) in references.iter().zip(orders).zip(values) {
            let rate = (OUTPUTS[output(*reference)?].get)(&rates);
            place.write(if *order == 1 { rate } else { 0.0 });
        }
        Ok(())
    }

    /// fmi2GetDirectionalDerivative: of outputs, in a direction of the inputs.
    pub(super) fn get_directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[Real],
        derivatives: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        for unknown in unknowns {
            output(*unknown)?;
        }
        // Each input once, however often it is named.
        let mut directions = BTreeMap::new();
        for (known, value) in knowns.iter().zip(direction) {
            let row = input(*known)?;
            if !value.is_finite() {
                let name = INPUTS[row].name;
                return Err(Failure::Direction { name, value: *value });
            }
            *directions.entry(row).or_insert(0.0) += value;
        }
        let (Built { model, workspace }, state) = self.solved()?;
        let sensitivities = model
            .output_sensitivities(workspace, state, directions.keys().copied())
            .map_err(Failure::Model)?;
        for (unknown, place) in unknowns.iter().zip(derivatives) {
            let output = &OUTPUTS[output(*unknown)?];
            let derivative = sensitivities
                .iter()
                .zip(directions.values())
                .fold(0.0, |sum, (sensitivity, value)| sum + (output.get)(sensitivity) * value);
            place.write(derivative);
        }
        Ok(())
    }
}

fn output(reference: ValueReference) -> Result<usize, Failure> {
    match real(reference)? {
        RealVariable::Output(row) => Ok(row),
        _ => Err(Failure::UnknownReference {
            reference,
            expected: "an output",
        }),
    }
}

fn input(reference: ValueReference) -> Result<usize, Failure> {
    match real(reference)? {
        RealVariable::Input(row) => Ok(row),
        _ => Err(Failure::UnknownReference {
            reference,
            expected: "an input",
        }),
    }
}
