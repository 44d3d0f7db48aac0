//! Value references. One is 1000 × (number of the block) + (row in the block); an array has one for all its elements. Blocks
//! and rows keep their numbers once released: new ones go to the end.

use crate::fmi::failures::Failure;
use crate::fmi::variables::{
    FIELDS, Integer, IntegerVariable, Kind, PROFILE_WEAR, PROFILES, RealVariable, SURFACE, Text, ValueReference,
    Variable,
};
use crate::fmi::variables::{fields, time, variables};
use crate::parameters::{INTEGER_PARAMETERS, IntegerKind, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{INPUTS, OUTPUTS};
use std::ops::Range;

const BLOCK: u32 = 1000;
const TIME: ValueReference = 0;
const INPUT_BLOCK: u32 = 1;
const OUTPUT_BLOCK: u32 = 2;
const REAL_PARAMETER_BLOCK: u32 = 3;
const INTEGER_PARAMETER_BLOCK: u32 = 4;
const PROFILE_BLOCK: u32 = 5;
const FIELD_BLOCK: u32 = 6;
const SOLVER_BLOCK: u32 = 7;
const TEXT_PARAMETER_BLOCK: u32 = 8;
const PROFILE_WEAR_BLOCK: u32 = 9;
const SURFACE_BLOCK: u32 = 10;
const RESIDUAL: ValueReference = SOLVER_BLOCK * BLOCK;
const ITERATIONS: ValueReference = SOLVER_BLOCK * BLOCK + 1;

/// The types of the standard that variables have here.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Type {
    /// Real numbers and arrays of them.
    Float64,
    /// Counts.
    Int32,
    /// Choices, as the numbers of their values.
    Int64,
    /// Lengths of arrays.
    UInt64,
    /// Choices between off and on.
    Boolean,
    /// Texts.
    String,
}

impl Type {
    /// Type of an integer of the model.
    pub fn of(kind: IntegerKind) -> Type {
        match kind {
            IntegerKind::Count => Type::Int32,
            IntegerKind::Length => Type::UInt64,
            IntegerKind::Choice(_) => Type::Int64,
            IntegerKind::Switch => Type::Boolean,
        }
    }

    /// Name of the type in messages.
    fn words(self) -> &'static str {
        match self {
            Type::Float64 => "a Float64 variable",
            Type::Int32 => "an Int32 variable",
            Type::Int64 => "an Enumeration variable",
            Type::UInt64 => "a UInt64 variable",
            Type::Boolean => "a Boolean variable",
            Type::String => "a String variable",
        }
    }
}

/// The table of variables as FMI 3.0 has it, each with its value reference.
pub fn table() -> impl Iterator<Item = (ValueReference, Variable)> {
    let rows = std::iter::once(time()).chain(variables()).chain(fields());
    rows.map(|row| (reference(&row), row))
}

fn reference(variable: &Variable) -> ValueReference {
    match variable.kind {
        Kind::Real(kind) => of_real(kind.variable),
        Kind::Integer { variable, .. } => of_integer(variable),
        Kind::Text { row, .. } => TEXT_PARAMETER_BLOCK * BLOCK + row as u32,
    }
}

fn of_real(variable: RealVariable) -> ValueReference {
    match variable {
        RealVariable::Time => TIME,
        RealVariable::Input(row) => INPUT_BLOCK * BLOCK + row as u32,
        // An array has that of its first element.
        RealVariable::Output(row) | RealVariable::Contacts(row) => OUTPUT_BLOCK * BLOCK + row as u32,
        RealVariable::Parameter(row) => REAL_PARAMETER_BLOCK * BLOCK + row as u32,
        RealVariable::Profile(row) => PROFILE_BLOCK * BLOCK + row as u32,
        RealVariable::Field(row) => FIELD_BLOCK * BLOCK + row as u32,
        RealVariable::ProfileWear(row) => PROFILE_WEAR_BLOCK * BLOCK + row as u32,
        RealVariable::Surface(row) => SURFACE_BLOCK * BLOCK + row as u32,
        RealVariable::Residual => RESIDUAL,
    }
}

/// The value reference of an integer variable.
pub fn of_integer(variable: IntegerVariable) -> ValueReference {
    match variable {
        IntegerVariable::Parameter(row) => INTEGER_PARAMETER_BLOCK * BLOCK + row as u32,
        IntegerVariable::Iterations => ITERATIONS,
    }
}

/// Returns the variable that a value reference of type Float64 stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn real(reference: ValueReference) -> Result<RealVariable, Failure> {
    let row = (reference % BLOCK) as usize;
    let in_block = |rows: usize, variable: RealVariable| (row < rows).then_some(variable);
    let found = match reference / BLOCK {
        INPUT_BLOCK => in_block(INPUTS.len(), RealVariable::Input(row)),
        OUTPUT_BLOCK => match OUTPUTS.get(row).map(|signal| signal.array) {
            Some(None) => Some(RealVariable::Output(row)),
            Some(Some((_, 0))) => Some(RealVariable::Contacts(row)),
            _ => None,
        },
        REAL_PARAMETER_BLOCK => in_block(REAL_PARAMETERS.len(), RealVariable::Parameter(row)),
        PROFILE_BLOCK => in_block(PROFILES.len(), RealVariable::Profile(row)),
        FIELD_BLOCK => in_block(FIELDS.len(), RealVariable::Field(row)),
        PROFILE_WEAR_BLOCK => in_block(PROFILE_WEAR.len(), RealVariable::ProfileWear(row)),
        SURFACE_BLOCK => in_block(SURFACE.len(), RealVariable::Surface(row)),
        SOLVER_BLOCK => (reference == RESIDUAL).then_some(RealVariable::Residual),
        _ => (reference == TIME).then_some(RealVariable::Time),
    };
    found.ok_or(unknown(reference, Type::Float64.words()))
}

/// Returns the variable that a value reference of an integer of the model stands for, where the variable has the given
/// type.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn integer(reference: ValueReference, expected: Type) -> Result<Integer, Failure> {
    let (block, row) = (reference / BLOCK, (reference % BLOCK) as usize);
    let found = match block {
        INTEGER_PARAMETER_BLOCK => INTEGER_PARAMETERS
            .get(row)
            .map(|entry| (IntegerVariable::Parameter(row), Type::of(entry.kind))),
        _ => (reference == ITERATIONS).then_some((IntegerVariable::Iterations, Type::Int32)),
    };
    match found {
        Some((variable, found)) if found == expected => Ok(Integer { reference, variable }),
        _ => Err(unknown(reference, expected.words())),
    }
}

/// Returns the variable that a value reference of type String stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn text(reference: ValueReference) -> Result<Text, Failure> {
    let row = (reference % BLOCK) as usize;
    if reference / BLOCK == TEXT_PARAMETER_BLOCK && row < TEXT_PARAMETERS.len() {
        Ok(Text { reference, row })
    } else {
        Err(unknown(reference, Type::String.words()))
    }
}

/// The row of the input that a value reference stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn input(reference: ValueReference) -> Result<usize, Failure> {
    match real(reference)? {
        RealVariable::Input(row) => Ok(row),
        _ => Err(unknown(reference, "an input")),
    }
}

/// The rows of the output that a value reference stands for: of an array those of its elements.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn outputs(reference: ValueReference) -> Result<Range<usize>, Failure> {
    let rows = real(reference)?.outputs();
    rows.ok_or(unknown(reference, "an output"))
}

fn unknown(reference: ValueReference, expected: &'static str) -> Failure {
    Failure::UnknownReference { reference, expected }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    const INTEGER_TYPES: [Type; 4] = [Type::Int32, Type::Int64, Type::UInt64, Type::Boolean];

    /// The name of what a reference resolves to, and how many types it resolves in.
    fn resolved(reference: ValueReference) -> (Option<String>, usize) {
        let real = real(reference).ok().map(|variable| {
            crate::fmi::variables::Real {
                reference,
                variable,
                element: 0,
            }
            .name()
        });
        let integers = INTEGER_TYPES
            .iter()
            .filter_map(|expected| integer(reference, *expected).ok());
        let texts = text(reference).ok().map(|text| text.name().to_owned());
        let names: Vec<String> = real
            .into_iter()
            .chain(integers.map(|integer| integer.name().to_owned()))
            .chain(texts)
            .collect();
        (names.first().cloned(), names.len())
    }

    #[test]
    fn every_value_reference_resolves_to_its_variable_in_one_type_and_nothing_else_resolves() {
        let mut references = HashSet::new();
        for (reference, variable) in table() {
            let (name, types) = resolved(reference);
            // The first element of an array has an index.
            let name = name.expect(variable.name);
            assert_eq!((name.trim_end_matches("[1]"), types), (variable.name, 1));
            assert!(references.insert(reference), "{}", variable.name);
        }
        for reference in (0..10_000).chain([u32::MAX, u32::MAX - 1, 1 << 31]) {
            assert_eq!(
                resolved(reference).1 == 1,
                references.contains(&reference),
                "{reference}"
            );
        }
        assert!(references.len() < 250, "{}", references.len());
    }
}
