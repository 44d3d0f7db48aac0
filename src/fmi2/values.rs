//! The calls that name variables by value references.

use super::failures::Failure;
use super::instance::Instance;
use super::references;
use super::types::{Integer, Real, ValueReference};
use crate::signals::{INPUTS, OUTPUTS};
use std::collections::BTreeMap;
use std::mem::MaybeUninit;

impl Instance {
    /// fmi2GetReal: all values or none.
    pub fn get_real(&mut self, references: &[ValueReference], values: &mut [MaybeUninit<Real>]) -> Result<(), Failure> {
        for reference in references {
            references::real(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(self.component.real(references::real(*reference)?)?);
        }
        Ok(())
    }

    /// fmi2GetInteger: all values or none.
    pub fn get_integer(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<Integer>],
    ) -> Result<(), Failure> {
        for reference in references {
            references::integer(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(self.component.integer(references::integer(*reference)?)?);
        }
        Ok(())
    }

    /// fmi2SetReal: all values or none.
    pub fn set_real(&mut self, references: &[ValueReference], values: &[Real]) -> Result<(), Failure> {
        let entries = references.iter().zip(values);
        let entries = entries.map(|(reference, value)| Ok((references::real(*reference)?, *value)));
        Ok(self.component.set_reals(entries)?)
    }

    /// fmi2SetInteger: all values or none.
    pub fn set_integer(&mut self, references: &[ValueReference], values: &[Integer]) -> Result<(), Failure> {
        let entries = references.iter().zip(values);
        let entries = entries.map(|(reference, value)| Ok((references::integer(*reference)?, *value)));
        Ok(self.component.set_integers(entries)?)
    }

    /// fmi2SetRealInputDerivatives: all values or none.
    pub fn set_input_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &[Real],
    ) -> Result<(), Failure> {
        let mut rates = self.component.rates();
        let mut unused = None;
        for ((reference, order), value) in references.iter().zip(orders).zip(values) {
            let (row, order, value) = (&INPUTS[references::input(*reference)?], *order, *value);
            let name = row.name;
            match order {
                ..=0 => return Err(Failure::Order { name, order }),
                _ if !value.is_finite() => return Err(Failure::Rate { name, value }),
                1 => (row.set)(&mut rates, value),
                _ => unused = Some(Failure::HigherOrder { name, order }),
            }
        }
        self.component.set_rates(rates);
        unused.map_or(Ok(()), Err)
    }

    /// fmi2GetRealOutputDerivatives; 0 for orders above 1, as the standard has it.
    pub fn get_output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        for (reference, order) in references.iter().zip(orders) {
            let name = OUTPUTS[references::output(*reference)?].name;
            if *order < 1 {
                return Err(Failure::Order { name, order: *order });
            }
        }
        let rates = self.component.output_rates()?;
        for ((reference, order), place) in references.iter().zip(orders).zip(values) {
            let rate = (OUTPUTS[references::output(*reference)?].get)(&rates);
            place.write(if *order == 1 { rate } else { 0.0 });
        }
        Ok(())
    }

    /// fmi2GetDirectionalDerivative: of outputs, in a direction of the inputs.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[Real],
        derivatives: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        for unknown in unknowns {
            references::output(*unknown)?;
        }
        // Each input once, however often it is named.
        let mut directions = BTreeMap::new();
        for (known, value) in knowns.iter().zip(direction) {
            let row = references::input(*known)?;
            if !value.is_finite() {
                let name = INPUTS[row].name;
                return Err(Failure::Direction { name, value: *value });
            }
            *directions.entry(row).or_insert(0.0) += value;
        }
        let derivative = self.component.directional_derivative(&directions)?;
        for (unknown, place) in unknowns.iter().zip(derivatives) {
            place.write((OUTPUTS[references::output(*unknown)?].get)(&derivative));
        }
        Ok(())
    }
}
