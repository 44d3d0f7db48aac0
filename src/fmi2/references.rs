//! Value references. One is 1000 × (number of the block) + (place in the block); an array takes as many places as it has
//! elements. Blocks and places keep their numbers once released: new ones go to the end.

use crate::fmi::failures::Failure;
use crate::fmi::variables::{Integer, IntegerVariable, PROFILES, Real, RealVariable, Text, ValueReference};
use crate::parameters::{INTEGER_PARAMETERS, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{INPUTS, OUTPUTS};
use std::ops::Range;

const BLOCK: u32 = 1000;
const INPUT_BLOCK: u32 = 0;
const OUTPUT_BLOCK: u32 = 1;
const REAL_PARAMETER_BLOCK: u32 = 2;
const INTEGER_PARAMETER_BLOCK: u32 = 3;
/// One block for each profile, those between them that are not passed over.
const FIRST_PROFILE_BLOCK: u32 = 4;
const SOLVER_BLOCK: u32 = 12;
const TEXT_PARAMETER_BLOCK: u32 = 18;
/// The blocks that are passed over, in their order.
const BETWEEN_PROFILES: [u32; 2] = [SOLVER_BLOCK, TEXT_PARAMETER_BLOCK];

/// The block of a row of [`PROFILES`].
fn profile_block(row: usize) -> u32 {
    let block = FIRST_PROFILE_BLOCK + row as u32;
    BETWEEN_PROFILES
        .iter()
        .fold(block, |block, between| block + u32::from(block >= *between))
}

/// The row of [`PROFILES`] of a block that is neither below theirs nor passed over.
fn profile_row(block: u32) -> usize {
    let passed = BETWEEN_PROFILES.iter().filter(|between| **between < block).count();
    (block - FIRST_PROFILE_BLOCK) as usize - passed
}

/// Value reference of variables that this version does not have.
const UNLISTED: ValueReference = ValueReference::MAX;
const RESIDUAL: ValueReference = SOLVER_BLOCK * BLOCK;
const ITERATIONS: ValueReference = SOLVER_BLOCK * BLOCK + 1;

/// Number of real parameters, each element of an array counted.
const REAL_PARAMETER_PLACES: usize = {
    let (mut row, mut places) = (0, 0);
    while row < REAL_PARAMETERS.len() {
        places += REAL_PARAMETERS[row].start.len();
        row += 1;
    }
    places
};

/// Row and element of the real parameters, by their place in the block.
const REAL_PARAMETER_ELEMENTS: [(usize, usize); REAL_PARAMETER_PLACES] = {
    let mut elements = [(0, 0); REAL_PARAMETER_PLACES];
    let (mut row, mut place) = (0, 0);
    while row < REAL_PARAMETERS.len() {
        let mut element = 0;
        while element < REAL_PARAMETERS[row].start.len() {
            elements[place] = (row, element);
            place += 1;
            element += 1;
        }
        row += 1;
    }
    elements
};

/// The value reference of an element of a real variable.
pub fn of_real(variable: RealVariable, element: usize) -> ValueReference {
    match variable {
        RealVariable::Input(row) => INPUT_BLOCK * BLOCK + row as u32,
        RealVariable::Output(row) => OUTPUT_BLOCK * BLOCK + row as u32,
        RealVariable::Contacts(row) => OUTPUT_BLOCK * BLOCK + (row + element) as u32,
        RealVariable::Parameter(row) => {
            let before: usize = REAL_PARAMETERS[..row].iter().map(|entry| entry.start.len()).sum();
            REAL_PARAMETER_BLOCK * BLOCK + (before + element) as u32
        }
        RealVariable::Profile(row) => profile_block(row) * BLOCK + element as u32,
        RealVariable::Residual => RESIDUAL,
        RealVariable::Field(_) | RealVariable::Surface(_) | RealVariable::ProfileWear(_) | RealVariable::Time => {
            UNLISTED
        }
    }
}

/// The value reference of an integer variable.
pub fn of_integer(variable: IntegerVariable) -> ValueReference {
    match variable {
        IntegerVariable::Parameter(row) => INTEGER_PARAMETER_BLOCK * BLOCK + row as u32,
        IntegerVariable::Iterations => ITERATIONS,
    }
}

/// The value reference of a row of [`TEXT_PARAMETERS`].
pub fn of_text(row: usize) -> ValueReference {
    TEXT_PARAMETER_BLOCK * BLOCK + row as u32
}

/// Returns the variable that a value reference of type Real stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn real(reference: ValueReference) -> Result<Real, Failure> {
    let (block, place) = (reference / BLOCK, (reference % BLOCK) as usize);
    let found = match block {
        INPUT_BLOCK if place < INPUTS.len() => Some((RealVariable::Input(place), 0)),
        OUTPUT_BLOCK if place < OUTPUTS.len() => Some((RealVariable::Output(place), 0)),
        REAL_PARAMETER_BLOCK => REAL_PARAMETER_ELEMENTS
            .get(place)
            .map(|(row, element)| (RealVariable::Parameter(*row), *element)),
        SOLVER_BLOCK => (reference == RESIDUAL).then_some((RealVariable::Residual, 0)),
        TEXT_PARAMETER_BLOCK => None,
        FIRST_PROFILE_BLOCK.. => {
            let row = profile_row(block);
            let points = PROFILES.get(row).map_or(0, |column| column.points);
            (place < points).then_some((RealVariable::Profile(row), place))
        }
        _ => None,
    };
    let unknown = Failure::UnknownReference {
        reference,
        expected: "a Real variable",
    };
    found.ok_or(unknown).map(|(variable, element)| Real {
        reference,
        variable,
        element,
    })
}

/// Returns the variable that a value reference of type Integer stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn integer(reference: ValueReference) -> Result<Integer, Failure> {
    let (block, row) = (reference / BLOCK, (reference % BLOCK) as usize);
    let found = match block {
        INTEGER_PARAMETER_BLOCK if row < INTEGER_PARAMETERS.len() => Some(IntegerVariable::Parameter(row)),
        SOLVER_BLOCK if reference == ITERATIONS => Some(IntegerVariable::Iterations),
        _ => None,
    };
    let unknown = Failure::UnknownReference {
        reference,
        expected: "an Integer variable",
    };
    found.ok_or(unknown).map(|variable| Integer { reference, variable })
}

/// Returns the variable that a value reference of type String stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn text(reference: ValueReference) -> Result<Text, Failure> {
    let (block, row) = (reference / BLOCK, (reference % BLOCK) as usize);
    if block == TEXT_PARAMETER_BLOCK && row < TEXT_PARAMETERS.len() {
        return Ok(Text { reference, row });
    }
    Err(Failure::UnknownReference {
        reference,
        expected: "a String variable",
    })
}

/// The row of the input that a value reference stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn input(reference: ValueReference) -> Result<usize, Failure> {
    match real(reference)?.variable {
        RealVariable::Input(row) => Ok(row),
        _ => Err(Failure::UnknownReference {
            reference,
            expected: "an input",
        }),
    }
}

/// The row of the output that a value reference stands for.
///
/// # Errors
/// [`Failure::UnknownReference`].
pub fn outputs(reference: ValueReference) -> Result<Range<usize>, Failure> {
    let rows = real(reference)?.variable.outputs();
    rows.ok_or(Failure::UnknownReference {
        reference,
        expected: "an output",
    })
}
