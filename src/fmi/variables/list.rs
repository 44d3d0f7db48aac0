//! The rows of the table of variables, from the tables of the model.

use super::{
    Causality, FIELDS, ITERATIONS, IntegerVariable, Kind, PROFILES, RESIDUAL, RealKind, RealVariable, Shape, TIME,
    Variability, Variable,
};
use crate::parameters::{INTEGER_PARAMETERS, IntegerKind, REAL_PARAMETERS, TEXT_PARAMETERS};
use crate::signals::{CONTACTS, INPUTS, OUTPUTS};

/// The table.
pub fn variables() -> Vec<Variable> {
    inputs()
        .chain(outputs())
        .chain(integer_parameters())
        .chain(real_parameters())
        .chain(text_parameters())
        .chain(profiles())
        .chain(solver())
        .collect()
}

/// Inputs of the model.
fn inputs() -> impl Iterator<Item = Variable> {
    INPUTS.iter().enumerate().map(|(row, signal)| Variable {
        name: signal.name,
        description: signal.description,
        causality: Causality::Input,
        variability: Variability::Continuous,
        kind: Kind::Real(RealKind {
            variable: RealVariable::Input(row),
            shape: Shape::Number,
            unit: signal.unit,
            display_unit: signal.display_unit,
            minimum: Some(signal.minimum),
            maximum: Some(signal.maximum),
            nominal: Some(signal.nominal),
            start: std::slice::from_ref(&signal.default),
        }),
    })
}

/// Outputs of the model; the elements of an array are one variable.
fn outputs() -> impl Iterator<Item = Variable> {
    let rows = OUTPUTS.iter().enumerate();
    let firsts = rows.filter(|(_, signal)| signal.array.is_none_or(|(_, element)| element == 0));
    firsts.map(|(row, signal)| Variable {
        name: signal.array.map_or(signal.name, |(array, _)| array),
        description: signal.description,
        causality: Causality::Output,
        variability: Variability::Continuous,
        kind: Kind::Real(RealKind {
            variable: match signal.array {
                Some(_) => RealVariable::Contacts(row),
                None => RealVariable::Output(row),
            },
            shape: match signal.array {
                Some(_) => Shape::Array(CONTACTS),
                None => Shape::Number,
            },
            unit: signal.unit,
            display_unit: signal.display_unit,
            minimum: signal.minimum,
            maximum: signal.maximum,
            nominal: Some(signal.nominal),
            start: &[],
        }),
    })
}

/// Parameters that are counts or choices.
fn integer_parameters() -> impl Iterator<Item = Variable> {
    INTEGER_PARAMETERS.iter().enumerate().map(|(row, entry)| Variable {
        name: entry.name,
        description: entry.description,
        causality: Causality::Parameter,
        variability: Variability::Fixed,
        kind: Kind::Integer {
            variable: IntegerVariable::Parameter(row),
            kind: entry.kind,
            minimum: Some(entry.minimum),
            maximum: Some(entry.maximum),
            start: Some(entry.start),
        },
    })
}

/// Parameters that are real numbers, or tables of them.
fn real_parameters() -> impl Iterator<Item = Variable> {
    REAL_PARAMETERS.iter().enumerate().map(|(row, entry)| Variable {
        name: entry.name,
        description: entry.description,
        causality: Causality::Parameter,
        variability: if entry.tunable {
            Variability::Tunable
        } else {
            Variability::Fixed
        },
        kind: Kind::Real(RealKind {
            variable: RealVariable::Parameter(row),
            shape: if entry.is_array {
                Shape::Array(entry.elements.len())
            } else {
                Shape::Number
            },
            unit: entry.unit,
            display_unit: entry.display_unit,
            minimum: Some(entry.minimum),
            maximum: Some(entry.maximum),
            nominal: None,
            start: entry.start,
        }),
    })
}

/// Parameters that are texts.
fn text_parameters() -> impl Iterator<Item = Variable> {
    TEXT_PARAMETERS.iter().enumerate().map(|(row, entry)| Variable {
        name: entry.name,
        description: entry.description,
        causality: Causality::Parameter,
        variability: Variability::Fixed,
        kind: Kind::Text {
            row,
            start: entry.start,
        },
    })
}

/// Profiles that are plotted.
fn profiles() -> impl Iterator<Item = Variable> {
    PROFILES.iter().enumerate().map(|(row, column)| Variable {
        name: column.name,
        description: column.description,
        causality: Causality::Local,
        variability: Variability::Continuous,
        kind: Kind::Real(RealKind {
            variable: RealVariable::Profile(row),
            shape: Shape::Array(column.points),
            unit: column.unit,
            display_unit: column.display_unit,
            minimum: None,
            maximum: None,
            nominal: Some(column.nominal),
            start: &[],
        }),
    })
}

/// The fields of a patch, for versions of FMI that have arrays with lengths of their own.
pub fn fields() -> impl Iterator<Item = Variable> {
    FIELDS.iter().enumerate().map(|(row, column)| Variable {
        name: column.name,
        description: column.description,
        causality: Causality::Local,
        variability: Variability::Continuous,
        kind: Kind::Real(RealKind {
            variable: RealVariable::Field(row),
            shape: Shape::Field(column.over),
            unit: column.unit,
            display_unit: column.display_unit,
            minimum: None,
            maximum: None,
            nominal: Some(column.nominal),
            start: &[],
        }),
    })
}

/// Time, for versions of FMI that have a variable for it.
pub fn time() -> Variable {
    Variable {
        name: TIME,
        description: "Time",
        causality: Causality::Independent,
        variability: Variability::Continuous,
        kind: Kind::Real(RealKind {
            variable: RealVariable::Time,
            shape: Shape::Number,
            unit: "s",
            display_unit: None,
            minimum: None,
            maximum: None,
            nominal: None,
            start: &[],
        }),
    }
}

/// Variables that say how the last step converged.
fn solver() -> [Variable; 2] {
    [
        Variable {
            name: RESIDUAL,
            description: "Last relative change of the operator split in the last step",
            causality: Causality::Local,
            variability: Variability::Continuous,
            kind: Kind::Real(RealKind {
                variable: RealVariable::Residual,
                shape: Shape::Number,
                unit: "1",
                display_unit: None,
                minimum: Some(0.0),
                maximum: None,
                nominal: Some(1e-9),
                start: &[],
            }),
        },
        Variable {
            name: ITERATIONS,
            description: "Iterations of the operator split in the last step",
            causality: Causality::Local,
            variability: Variability::Discrete,
            kind: Kind::Integer {
                variable: IntegerVariable::Iterations,
                kind: IntegerKind::Count,
                minimum: Some(0),
                maximum: None,
                start: None,
            },
        },
    ]
}
