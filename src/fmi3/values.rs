//! The calls that name variables by value references. An array is one variable; its values follow each other, the last index
//! running fastest.

use super::failures::Failure;
use super::instance::Instance;
use super::references::{self, Type};
use super::types::{Boolean, FALSE, Float64, FmiString, Int32, Int64, TRUE, UInt64, ValueReference};
use crate::fmi::derivatives::{Jacobian, Rows};
use crate::fmi::failures;
use crate::fmi::variables::{Integer, IntegerVariable, Lengths, Real};
use crate::parameters::INTEGER_PARAMETERS;
use std::mem::MaybeUninit;

/// Type in which the importer sees integers of the model, which are 32 bits wide.
pub trait Scalar: Copy {
    /// The type of the variables.
    const TYPE: Type;
    /// The value as the importer sees it.
    fn shown(value: i32) -> Self;
    /// The value as the model sees it; the value itself, as a number, where that cannot be.
    fn read(self) -> Result<i32, f64>;
}

macro_rules! scalar {
    ($($name:ident: $shown:expr, $read:expr;)*) => {$(
        impl Scalar for $name {
            const TYPE: Type = Type::$name;
            fn shown(value: i32) -> $name {
                let shown: fn(i32) -> $name = $shown;
                shown(value)
            }
            fn read(self) -> Result<i32, f64> {
                let read: fn($name) -> Result<i32, f64> = $read;
                read(self)
            }
        }
    )*};
}

scalar! {
    Int32: |value| value, Ok;
    Int64: i64::from, |value: i64| i32::try_from(value).map_err(|_| value as f64);
    // Counts are not negative.
    UInt64: |value: i32| u64::from(value.unsigned_abs()), |value: u64| i32::try_from(value).map_err(|_| value as f64);
    // Off is 1, on is 2.
    Boolean: |value| if value == 2 { TRUE } else { FALSE }, |value| Ok(if value == FALSE { 1 } else { 2 });
}

/// The elements of variables, one after another.
fn elements(
    references: &[ValueReference],
    lengths: Lengths,
) -> impl Iterator<Item = Result<Real, failures::Failure>> + Clone {
    references.iter().flat_map(move |&reference| {
        let number = references::real(reference).map_or(1, |variable| lengths.elements(variable));
        (0..number).map(move |element| {
            let variable = references::real(reference)?;
            Ok(Real {
                reference,
                variable,
                element,
            })
        })
    })
}

/// Checks that the variables are of this type and have as many elements as there are values.
fn check_elements(references: &[ValueReference], lengths: Lengths, given: usize) -> Result<(), Failure> {
    let mut needed = 0_usize;
    for reference in references {
        needed = needed.saturating_add(lengths.elements(references::real(*reference)?));
    }
    check_number(given, needed)
}

/// Checks that there is room for as many values as there are elements.
pub fn check_number(given: usize, needed: usize) -> Result<(), Failure> {
    if given == needed {
        Ok(())
    } else {
        Err(Failure::Values { given, needed })
    }
}

impl Instance {
    /// fmi3GetFloat64: all values or none.
    pub fn get_float(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<Float64>],
    ) -> Result<(), Failure> {
        let lengths = self.component.lengths();
        check_elements(references, lengths, values.len())?;
        for (real, place) in elements(references, lengths).zip(values) {
            place.write(self.component.real(real?)?);
        }
        Ok(())
    }

    /// fmi3SetFloat64: all values or none.
    pub fn set_float(&mut self, references: &[ValueReference], values: &[Float64]) -> Result<(), Failure> {
        let lengths = self.component.lengths();
        check_elements(references, lengths, values.len())?;
        let entries = elements(references, lengths).zip(values);
        let entries = entries.map(|(real, value)| Ok((real?, *value)));
        Ok(self.component.set_reals(entries)?)
    }

    /// fmi3GetInt32, fmi3GetInt64, fmi3GetUInt64, fmi3GetBoolean: all values or none.
    pub fn get_integer<T: Scalar>(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<T>],
    ) -> Result<(), Failure> {
        check_number(values.len(), references.len())?;
        for reference in references {
            references::integer(*reference, T::TYPE)?;
        }
        for (reference, place) in references.iter().zip(values) {
            let integer = references::integer(*reference, T::TYPE)?;
            place.write(T::shown(self.component.integer(integer)?));
        }
        Ok(())
    }

    /// fmi3SetInt32, fmi3SetInt64, fmi3SetUInt64, fmi3SetBoolean: all values or none.
    pub fn set_integer<T: Scalar>(&mut self, references: &[ValueReference], values: &[T]) -> Result<(), Failure> {
        check_number(values.len(), references.len())?;
        let entries = references.iter().zip(values).map(|(reference, value)| {
            let integer = references::integer(*reference, T::TYPE)?;
            let value = value.read().or_else(|value| too_wide(&integer, value))?;
            Ok((integer, value))
        });
        Ok(self.component.set_integers(entries)?)
    }

    /// fmi3GetString: all values or none.
    pub fn get_string(
        &mut self,
        references: &[ValueReference],
        values: &mut [MaybeUninit<FmiString>],
    ) -> Result<(), Failure> {
        check_number(values.len(), references.len())?;
        for reference in references {
            references::text(*reference)?;
        }
        for (reference, place) in references.iter().zip(values) {
            place.write(self.component.text(references::text(*reference)?).as_ptr());
        }
        Ok(())
    }

    /// fmi3SetString: all values or none. A value is `None` where the pointer is null.
    pub fn set_string<'a>(
        &mut self,
        references: &[ValueReference],
        values: impl ExactSizeIterator<Item = Option<&'a [u8]>>,
    ) -> Result<(), Failure> {
        check_number(values.len(), references.len())?;
        let entries = references.iter().zip(values);
        let entries = entries.map(|(reference, value)| Ok((references::text(*reference)?, value)));
        Ok(self.component.set_texts("values[i]", entries)?)
    }

    /// fmi3GetOutputDerivatives.
    pub fn get_output_derivatives(
        &mut self,
        references: &[ValueReference],
        orders: &[Int32],
        values: &mut [MaybeUninit<Float64>],
    ) -> Result<(), Failure> {
        check_number(values.len(), outputs_in(references))?;
        let component = &mut self.component;
        Ok(component.output_derivatives(references::outputs, references, orders, values)?)
    }

    /// fmi3GetDirectionalDerivative: of outputs, in a direction of the inputs.
    pub fn get_directional_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        seed: &[Float64],
        sensitivity: &mut [MaybeUninit<Float64>],
    ) -> Result<(), Failure> {
        let jacobian = jacobian(unknowns, knowns);
        check_lengths(seed.len(), knowns.len(), sensitivity.len(), outputs_in(unknowns))?;
        Ok(self.component.directional_derivative(&jacobian, seed, sensitivity)?)
    }

    /// fmi3GetAdjointDerivative: of a weighted sum of outputs, with respect to inputs.
    pub fn get_adjoint_derivative(
        &mut self,
        unknowns: &[ValueReference],
        knowns: &[ValueReference],
        seed: &[Float64],
        sensitivity: &mut [MaybeUninit<Float64>],
    ) -> Result<(), Failure> {
        let jacobian = jacobian(unknowns, knowns);
        check_lengths(seed.len(), outputs_in(unknowns), sensitivity.len(), knowns.len())?;
        Ok(self.component.adjoint_derivative(&jacobian, seed, sensitivity)?)
    }
}

/// Number of outputs, each element of an array counted; what is none is one, and refused later.
fn outputs_in(references: &[ValueReference]) -> usize {
    let rows = references.iter().map(|reference| references::outputs(*reference));
    rows.map(|rows| rows.map_or(1, |rows| rows.len())).sum()
}

fn check_lengths(seeds: usize, seeded: usize, sensitivities: usize, wanted: usize) -> Result<(), Failure> {
    for (argument, given, needed) in [("nSeed", seeds, seeded), ("nSensitivity", sensitivities, wanted)] {
        if given != needed {
            return Err(Failure::Derivatives {
                argument,
                given,
                needed,
            });
        }
    }
    Ok(())
}

fn jacobian<'a>(unknowns: &'a [ValueReference], knowns: &'a [ValueReference]) -> Jacobian<'a> {
    let rows = Rows {
        outputs: references::outputs,
        input: references::input,
        seed: "seed",
    };
    Jacobian { unknowns, knowns, rows }
}

/// A number that the model's integers cannot hold is out of every parameter's range; of what is no parameter no value can be
/// set.
fn too_wide(integer: &Integer, value: f64) -> Result<i32, failures::Failure> {
    if let IntegerVariable::Parameter(row) = integer.variable {
        INTEGER_PARAMETERS[row]
            .check_any(value)
            .map_err(failures::Failure::Value)?;
    }
    Ok(i32::MAX)
}
