//! The model description: the table of variables as `modelDescription.xml` of FMI 3.0.
//!
//! [`model_description`] is checked in as `modelDescription/fmi3/modelDescription.xml`; the library reads its instantiation
//! token from there.

use super::references::{Type, of_integer, table};
use super::schema::{
    Attributes, CoSimulation, Dimension, EnumerationType, Item, ModelDescription, ModelStructure, ModelVariables,
    Start, TypeDefinitions, Unknown, Variable,
};
use crate::fmi::schema::{self, document, number};
use crate::fmi::token::hashed;
use crate::fmi::variables::{self as shared, Causality, IntegerVariable, Kind, SURFACE_ROWS, Shape, ValueReference};
use crate::parameters::{INTEGER_PARAMETERS, IntegerKind};
use crate::signals::{CONTACTS, OUTPUTS, OutputKind};
use quick_xml::se::SeError;

/// The complete text of `modelDescription.xml`.
///
/// # Errors
/// What the XML serializer reports.
pub fn model_description() -> Result<String, SeError> {
    let mut description = anonymous();
    description.instantiation_token = hashed(&document("fmiModelDescription", &description)?);
    document("fmiModelDescription", &description)
}

/// The description without its token.
fn anonymous() -> ModelDescription {
    let units = table().filter_map(|(_, variable)| match variable.kind {
        Kind::Real(kind) => Some(kind.unit),
        Kind::Integer { .. } | Kind::Text { .. } => None,
    });
    ModelDescription {
        fmi_version: "3.0",
        model_name: schema::MODEL_NAME,
        instantiation_token: String::new(),
        description: schema::DESCRIPTION,
        author: schema::AUTHOR,
        version: env!("CARGO_PKG_VERSION"),
        copyright: schema::COPYRIGHT,
        license: env!("CARGO_PKG_LICENSE"),
        generation_tool: schema::GENERATION_TOOL,
        generation_date_and_time: schema::GENERATION_DATE_AND_TIME,
        variable_naming_convention: "structured",
        co_simulation: CoSimulation {
            model_identifier: schema::MODEL_IDENTIFIER,
            needs_execution_tool: false,
            can_be_instantiated_only_once_per_process: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivatives: true,
            provides_adjoint_derivatives: true,
            provides_per_element_dependencies: false,
            can_handle_variable_communication_step_size: true,
            max_output_derivative_order: 1,
            provides_intermediate_update: false,
            might_return_early_from_do_step: true,
            can_return_early_after_intermediate_update: false,
            has_event_mode: false,
        },
        unit_definitions: schema::unit_definitions(&units.collect()),
        type_definitions: TypeDefinitions {
            enumerations: enumerations(),
        },
        log_categories: schema::log_categories(),
        default_experiment: schema::default_experiment(),
        model_variables: ModelVariables {
            variables: table()
                .map(|(reference, variable)| element(reference, &variable))
                .collect(),
        },
        model_structure: model_structure(),
    }
}

/// One type for each choice.
fn enumerations() -> Vec<EnumerationType> {
    let choices = INTEGER_PARAMETERS.iter().filter_map(|row| match row.kind {
        IntegerKind::Choice(names) => Some((row.name, names)),
        _ => None,
    });
    choices
        .map(|(name, names)| EnumerationType {
            name: type_name(name),
            items: names
                .iter()
                .zip(1..)
                .map(|(name, value)| Item { name, value })
                .collect(),
        })
        .collect()
}

/// The name of a choice's type: that of the parameter, its words put together.
fn type_name(parameter: &str) -> String {
    let words = parameter.split('_').map(|word| {
        let (first, rest) = word.split_at(1);
        first.to_uppercase() + rest
    });
    words.collect()
}

/// A variable as an element.
fn element(value_reference: ValueReference, variable: &shared::Variable) -> Variable {
    let mut attributes = Attributes {
        name: variable.name,
        value_reference,
        description: variable.description,
        causality: variable.causality.name(),
        variability: variable.variability.name(),
        initial: match variable.causality {
            Causality::Parameter | Causality::Input => Some("exact"),
            Causality::Output | Causality::Local => Some("calculated"),
            Causality::Independent => None,
        },
        declared_type: None,
        unit: None,
        display_unit: None,
        minimum: None,
        maximum: None,
        nominal: None,
        start: None,
        dimensions: Vec::new(),
        texts: Vec::new(),
    };
    match variable.kind {
        Kind::Real(kind) => {
            let start: Vec<_> = kind.start.iter().map(|value| number(*value)).collect();
            attributes.unit = Some(kind.unit);
            attributes.display_unit = kind.display_unit;
            attributes.minimum = kind.minimum.map(number);
            attributes.maximum = kind.maximum.map(number);
            attributes.nominal = kind.typical_magnitude(0).map(number);
            attributes.start = (!start.is_empty()).then(|| start.join(" "));
            attributes.dimensions = dimensions(kind.shape);
            Variable::Float64(attributes)
        }
        Kind::Integer {
            kind,
            minimum,
            maximum,
            start,
            ..
        } => {
            let text = |value: Option<i32>| value.map(|value| value.to_string());
            (attributes.minimum, attributes.maximum, attributes.start) = (text(minimum), text(maximum), text(start));
            match Type::of(kind) {
                Type::Boolean => {
                    (attributes.minimum, attributes.maximum) = (None, None);
                    attributes.start = start.map(|value| (value == 2).to_string());
                    Variable::Boolean(attributes)
                }
                Type::UInt64 => {
                    attributes.causality = "structuralParameter";
                    Variable::UInt64(attributes)
                }
                Type::Int64 => {
                    attributes.declared_type = Some(type_name(variable.name));
                    Variable::Enumeration(attributes)
                }
                Type::Int32 | Type::Float64 | Type::String => Variable::Int32(attributes),
            }
        }
        Kind::Text { start, .. } => {
            attributes.texts = vec![Start { value: start }];
            Variable::String(attributes)
        }
    }
}

fn dimensions(shape: Shape) -> Vec<Dimension> {
    let number = |start| Dimension {
        start: Some(start),
        value_reference: None,
    };
    let length = |name: &str| Dimension {
        start: None,
        value_reference: INTEGER_PARAMETERS
            .iter()
            .position(|row| row.name == name)
            .map(|row| of_integer(IntegerVariable::Parameter(row))),
    };
    match shape {
        Shape::Number => Vec::new(),
        Shape::Array(elements) => vec![number(elements)],
        // Strips first, then cells along a strip: the last index runs fastest.
        Shape::Field(over) => {
            let lengths = ["patch_strips", "patch_nodes"].into_iter().zip(over);
            let given = lengths.filter(|(_, is_index)| *is_index);
            given.map(|(name, _)| length(name)).collect()
        }
        // Windows, two halves of their strips, strips of a half, cells along a strip: lengths are numbers or parameters, no multiples of them.
        Shape::Surface([strips, cells]) => {
            let halves = strips.then(|| [number(SURFACE_ROWS), length("patch_strips")]);
            let along = cells.then(|| length("patch_nodes"));
            std::iter::once(number(CONTACTS))
                .chain(halves.into_iter().flatten())
                .chain(along)
                .collect()
        }
        Shape::ProfileWear => vec![length("profile_wear_points")],
    }
}

/// The outputs and what each depends on.
fn model_structure() -> ModelStructure {
    let references = |wanted: &[Causality]| {
        let rows = table().filter(|(_, variable)| wanted.contains(&variable.causality));
        rows.map(|(reference, _)| reference.to_string())
            .collect::<Vec<_>>()
            .join(" ")
    };
    let is_total = |name: &str| {
        OUTPUTS
            .iter()
            .any(|row| row.name == name && row.kind == OutputKind::Total)
    };
    let unknowns = |dependencies: String| {
        let outputs = table().filter(|(_, variable)| variable.causality == Causality::Output);
        let unknowns = outputs.map(|(value_reference, variable)| Unknown {
            value_reference,
            dependencies: match is_total(variable.name) {
                true => String::new(),
                false => dependencies.clone(),
            },
        });
        unknowns.collect()
    };
    ModelStructure {
        outputs: unknowns(references(&[Causality::Input])),
        initial_unknowns: unknowns(references(&[Causality::Input, Causality::Parameter])),
    }
}
