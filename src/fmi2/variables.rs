//! The table of variables as FMI 2.0 has it: an array is listed element by element, each with its value reference.

use super::references;
use crate::fmi::variables as shared;
use crate::parameters::IntegerKind;
use crate::signals::{OUTPUTS, OutputKind};

pub use shared::{Causality, Variability};

/// Type of a variable and what belongs to it.
#[derive(Debug, Clone, PartialEq)]
pub enum Kind {
    /// `fmi2Real`.
    Real {
        /// Unit.
        unit: &'static str,
        /// Unit in which a person would read the value.
        display_unit: Option<&'static str>,
        /// Smallest value.
        minimum: Option<f64>,
        /// Largest value.
        maximum: Option<f64>,
        /// Typical magnitude.
        nominal: Option<f64>,
        /// Start value of what is set from outside.
        start: Option<f64>,
    },
    /// `fmi2Integer`.
    Integer {
        /// Smallest value.
        minimum: Option<i32>,
        /// Largest value.
        maximum: Option<i32>,
        /// Start value of what is set from outside.
        start: Option<i32>,
    },
    /// `fmi2String`.
    Text {
        /// Start value.
        start: &'static str,
    },
}

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name, by the structured naming convention.
    pub name: String,
    /// Value reference.
    pub reference: shared::ValueReference,
    /// One sentence.
    pub description: String,
    /// Causality: who sets it.
    pub causality: Causality,
    /// Variability: when it changes.
    pub variability: Variability,
    /// Whether it is a sum over the steps, which at a communication point depends on no input.
    pub is_total: bool,
    /// Type, unit and range.
    pub kind: Kind,
}

/// The table.
pub fn variables() -> Vec<Variable> {
    shared::variables().iter().flat_map(elements).collect()
}

/// A variable, or the elements of an array.
fn elements(variable: &shared::Variable) -> Vec<Variable> {
    match variable.kind {
        shared::Kind::Real(kind) => {
            let elements = match kind.shape {
                shared::Shape::Array(elements) => elements,
                _ => 1,
            };
            (0..elements).map(|element| real(variable, &kind, element)).collect()
        }
        shared::Kind::Integer {
            variable: row,
            kind,
            minimum,
            maximum,
            start,
        } => vec![Variable {
            name: variable.name.to_owned(),
            reference: references::of_integer(row),
            description: match kind {
                IntegerKind::Switch => format!("{}: 1 off, 2 on", variable.description),
                _ => variable.description.to_owned(),
            },
            causality: variable.causality,
            variability: variable.variability,
            is_total: false,
            kind: Kind::Integer {
                minimum,
                maximum,
                start,
            },
        }],
        shared::Kind::Text { row, start } => vec![Variable {
            name: variable.name.to_owned(),
            reference: references::of_text(row),
            description: variable.description.to_owned(),
            causality: variable.causality,
            variability: variable.variability,
            is_total: false,
            kind: Kind::Text { start },
        }],
    }
}

/// An element of a real variable.
fn real(variable: &shared::Variable, kind: &shared::RealKind, element: usize) -> Variable {
    let reference = references::of_real(kind.variable, element);
    let named = shared::Real {
        reference,
        variable: kind.variable,
        element,
    };
    let start = kind.start.get(element).copied();
    // The description of a parameter's array is on any one of its elements.
    let description = match (variable.causality, kind.shape) {
        (Causality::Local, shared::Shape::Array(_)) => format!("{} at point {}", variable.description, element + 1),
        (Causality::Output, shared::Shape::Array(_)) => {
            format!("{}, this is number {}", variable.description, element + 1)
        }
        _ => variable.description.to_owned(),
    };
    Variable {
        name: named.name(),
        reference,
        description,
        causality: variable.causality,
        variability: variable.variability,
        is_total: matches!(kind.variable, shared::RealVariable::Output(row) if OUTPUTS[row].kind == OutputKind::Total),
        kind: Kind::Real {
            unit: kind.unit,
            display_unit: kind.display_unit,
            minimum: kind.minimum,
            maximum: kind.maximum,
            nominal: kind.typical_magnitude(element),
            start,
        },
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_value_reference_resolves_to_its_variable() {
        for variable in variables() {
            let (real, integer) = (
                references::real(variable.reference),
                references::integer(variable.reference),
            );
            let name = match variable.kind {
                Kind::Real { .. } => real.map(|real| real.name()),
                Kind::Integer { .. } => integer.map(|integer| integer.name().to_owned()),
                Kind::Text { .. } => references::text(variable.reference).map(|text| text.name().to_owned()),
            };
            assert_eq!(name.expect(&variable.name), variable.name);
        }
    }

    #[test]
    fn names_and_references_are_unique_and_nothing_else_resolves() {
        let table = variables();
        let names: HashSet<_> = table.iter().map(|variable| &variable.name).collect();
        let references: HashSet<_> = table.iter().map(|variable| variable.reference).collect();
        assert_eq!((names.len(), references.len()), (table.len(), table.len()));
        for reference in (0..20_000).chain([u32::MAX, u32::MAX - 1, 1 << 31]) {
            let (real, integer) = (references::real(reference), references::integer(reference));
            let text = references::text(reference);
            let types = [real.is_ok(), integer.is_ok(), text.is_ok()];
            let found = types.into_iter().filter(|found| *found).count();
            assert_eq!(found, usize::from(references.contains(&reference)), "{reference}");
        }
    }

    #[test]
    fn an_array_is_one_variable_and_its_elements_follow_each_other() {
        let table = shared::variables();
        let array = table
            .iter()
            .find(|row| row.name == "friction_table.coefficient")
            .expect("a row");
        let elements = elements(array);
        assert_eq!(elements.len(), 10);
        assert_eq!(elements[9].name, "friction_table.coefficient[10]");
        assert_eq!(elements[9].reference, elements[0].reference + 9);
        let element = table.iter().find(|row| row.name.contains('['));
        assert!(element.is_none(), "{:?}", element.map(|row| row.name));
    }
}
