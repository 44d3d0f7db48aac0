//! The calls that name variables by value references.

use super::failures::Failure;
use super::instance::Instance;
use super::references;
use super::types::{FmiString, Integer, Real, ValueReference};
use crate::fmi::derivatives::{Jacobian, Rows};
use crate::fmi::failures;
use crate::signals::INPUTS;
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

    /// fmi2GetString: all values or none.
    pub fn get_string(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<FmiString>],
    ) -> Result<(), Failure> {
        for reference in references {
            references::text(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(self.component.text(references::text(*reference)?).as_ptr());
        }
        Ok(())
    }

    /// fmi2SetString: all values or none. A value is `None` where the pointer is null.
    pub fn set_string<'a>(
        &mut self,
        references: &[ValueReference],
        values: impl Iterator<Item = Option<&'a [u8]>>,
    ) -> Result<(), Failure> {
        let entries = references.iter().zip(values);
        let entries = entries.map(|(reference, value)| Ok((references::text(*reference)?, value)));
        Ok(self.component.set_texts("value[i]", entries)?)
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
                ..=0 => return Err(failures::Failure::Order { name, order }.into()),
                _ if !value.is_finite() => return Err(Failure::Rate { name, value }),
                1 => (row.set)(&mut rates, value),
                _ => unused = Some(Failure::HigherOrder { name, order }),
            }
        }
        self.component.set_rates(rates);
        unused.map_or(Ok(()), Err)
    }

    /// fmi2GetRealOutputDerivatives.
    pub fn get_output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Integer],
        values: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        let component = &mut self.component;
        Ok(component.output_derivatives(references::outputs, references, orders, values)?)
    }

    /// fmi2GetDirectionalDerivative: of outputs, in a direction of the inputs.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        direction: &[Real],
        derivatives: &mut [MaybeUninit<Real>],
    ) -> Result<(), Failure> {
        let rows = Rows {
            outputs: references::outputs,
            input: references::input,
            seed: "dvKnown",
        };
        let jacobian = Jacobian { unknowns, knowns, rows };
        Ok(self
            .component
            .directional_derivative(&jacobian, direction, derivatives)?)
    }
}
