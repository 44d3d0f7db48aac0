//! The rows of the table of variables, from the tables of the model.

use super::{
    Causality, FIELDS, ITERATIONS, IntegerVariable, Kind, PROFILE_WEAR, PROFILES, RESIDUAL, RealKind, RealVariable,
    SURFACE, Shape, TIME, Variability, Variable,
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

/// A real number without bounds and start value, which the rows below add.
const fn number(variable: RealVariable, unit: &'static str) -> RealKind {
    RealKind {
        variable,
        shape: Shape::Number,
        unit,
        display_unit: None,
        minimum: None,
        maximum: None,
        nominal: None,
        start: &[],
    }
}

/// A variable that may change at any time.
fn continuous(name: &'static str, description: &'static str, causality: Causality, real: RealKind) -> Variable {
    Variable {
        name,
        description,
        causality,
        variability: Variability::Continuous,
        kind: Kind::Real(real),
    }
}

/// Inputs of the model.
fn inputs() -> impl Iterator<Item = Variable> {
    INPUTS.iter().enumerate().map(|(row, signal)| {
        continuous(
            signal.name,
            signal.description,
            Causality::Input,
            RealKind {
                display_unit: signal.display_unit,
                minimum: Some(signal.minimum),
                maximum: Some(signal.maximum),
                nominal: Some(signal.nominal),
                start: std::slice::from_ref(&signal.default),
                ..number(RealVariable::Input(row), signal.unit)
            },
        )
    })
}

/// Outputs of the model; the elements of an array are one variable.
fn outputs() -> impl Iterator<Item = Variable> {
    let rows = OUTPUTS.iter().enumerate();
    let firsts = rows.filter(|(_, signal)| signal.array.is_none_or(|(_, element)| element == 0));
    firsts.map(|(row, signal)| {
        let real = number(
            match signal.array {
                Some(_) => RealVariable::Contacts(row),
                None => RealVariable::Output(row),
            },
            signal.unit,
        );
        continuous(
            signal.array.map_or(signal.name, |(array, _)| array),
            signal.description,
            Causality::Output,
            RealKind {
                shape: match signal.array {
                    Some(_) => Shape::Array(CONTACTS),
                    None => Shape::Number,
                },
                display_unit: signal.display_unit,
                minimum: signal.minimum,
                maximum: signal.maximum,
                nominal: Some(signal.nominal),
                ..real
            },
        )
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
    PROFILES.iter().enumerate().map(|(row, column)| {
        continuous(
            column.name,
            column.description,
            Causality::Local,
            RealKind {
                shape: Shape::Array(column.points),
                display_unit: column.display_unit,
                nominal: Some(column.nominal),
                ..number(RealVariable::Profile(row), column.unit)
            },
        )
    })
}

/// The fields of patch and profiles and the wear of profiles, for versions of FMI that have arrays with lengths of their own.
pub fn fields() -> impl Iterator<Item = Variable> {
    patch_fields().chain(profile_wear()).chain(surface_fields())
}

/// The fields of profiles.
fn surface_fields() -> impl Iterator<Item = Variable> {
    SURFACE.iter().enumerate().map(|(row, column)| {
        continuous(
            column.name,
            column.description,
            Causality::Local,
            RealKind {
                shape: Shape::Surface(column.over),
                display_unit: column.display_unit,
                nominal: Some(column.nominal),
                ..number(RealVariable::Surface(row), column.unit)
            },
        )
    })
}

/// The wear of profiles.
fn profile_wear() -> impl Iterator<Item = Variable> {
    PROFILE_WEAR.iter().enumerate().map(|(row, column)| {
        continuous(
            column.name,
            column.description,
            Causality::Local,
            RealKind {
                shape: Shape::ProfileWear,
                display_unit: Some(column.display_unit),
                nominal: Some(column.nominal),
                ..number(RealVariable::ProfileWear(row), "m")
            },
        )
    })
}

/// The fields of a patch.
fn patch_fields() -> impl Iterator<Item = Variable> {
    FIELDS.iter().enumerate().map(|(row, column)| {
        continuous(
            column.name,
            column.description,
            Causality::Local,
            RealKind {
                shape: Shape::Field(column.over),
                display_unit: column.display_unit,
                nominal: Some(column.nominal),
                ..number(RealVariable::Field(row), column.unit)
            },
        )
    })
}

/// Time, for versions of FMI that have a variable for it.
pub fn time() -> Variable {
    continuous(TIME, "Time", Causality::Independent, number(RealVariable::Time, "s"))
}

/// Variables that say how the last step converged.
fn solver() -> [Variable; 2] {
    [
        continuous(
            RESIDUAL,
            "Last relative change of the operator split in the last step",
            Causality::Local,
            RealKind {
                minimum: Some(0.0),
                nominal: Some(1e-9),
                ..number(RealVariable::Residual, "1")
            },
        ),
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
