//! The model description: the table of variables as `modelDescription.xml`.
//!
//! [`model_description`] is checked in as `modelDescription/modelDescription.xml`; the library reads its GUID from there.

use super::schema::{
    CoSimulation, Integer, ModelDescription, ModelStructure, ModelVariables, Real, ScalarVariable, Text, Unknown,
    Unknowns,
};
use super::variables::{Causality, Kind, Variable, variables};
use crate::fmi::schema::{self, document, number};
use crate::fmi::token::hashed;
use quick_xml::se::SeError;

/// The complete text of `modelDescription.xml`.
///
/// # Errors
/// What the XML serializer reports.
pub fn model_description() -> Result<String, SeError> {
    let mut description = anonymous();
    description.guid = hashed(&document("fmiModelDescription", &description)?);
    document("fmiModelDescription", &description)
}

/// The description without its GUID.
fn anonymous() -> ModelDescription {
    let table = variables();
    let units = table.iter().filter_map(|variable| match variable.kind {
        Kind::Real { unit, .. } => Some(unit),
        Kind::Integer { .. } | Kind::Text { .. } => None,
    });
    ModelDescription {
        fmi_version: "2.0",
        model_name: schema::MODEL_NAME,
        guid: String::new(),
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
            can_handle_variable_communication_step_size: true,
            can_interpolate_inputs: true,
            max_output_derivative_order: 1,
            can_run_asynchronously: false,
            can_be_instantiated_only_once_per_process: false,
            can_not_use_memory_management_functions: false,
            can_get_and_set_fmu_state: true,
            can_serialize_fmu_state: true,
            provides_directional_derivative: true,
        },
        unit_definitions: schema::unit_definitions(&units.collect()),
        log_categories: schema::log_categories(),
        default_experiment: schema::default_experiment(),
        model_structure: model_structure(&table),
        model_variables: ModelVariables {
            variables: table.into_iter().map(scalar_variable).collect(),
        },
    }
}

/// A variable as an element.
fn scalar_variable(variable: Variable) -> ScalarVariable {
    let (mut real, mut integer, mut text) = (None, None, None);
    match variable.kind {
        Kind::Real {
            unit,
            display_unit,
            minimum,
            maximum,
            nominal,
            start,
        } => {
            real = Some(Real {
                unit,
                display_unit,
                minimum: minimum.map(number),
                maximum: maximum.map(number),
                nominal: nominal.map(number),
                start: start.map(number),
            });
        }
        Kind::Integer {
            minimum,
            maximum,
            start,
        } => {
            integer = Some(Integer {
                minimum,
                maximum,
                start,
            });
        }
        Kind::Text { start } => text = Some(Text { start }),
    }
    ScalarVariable {
        name: variable.name,
        value_reference: variable.reference,
        description: variable.description,
        causality: variable.causality.name(),
        variability: variable.variability.name(),
        initial: match variable.causality {
            Causality::Parameter => Some("exact"),
            // The standard allows none for these.
            Causality::Input | Causality::Independent => None,
            Causality::Output | Causality::Local => Some("calculated"),
        },
        real,
        integer,
        text,
    }
}

/// The outputs and what each depends on.
fn model_structure(table: &[Variable]) -> ModelStructure {
    // Indices into the table count from 1.
    let indices = |wanted: &[Causality]| {
        let rows = table
            .iter()
            .zip(1_usize..)
            .filter(|(variable, _)| wanted.contains(&variable.causality));
        rows.map(|(_, index)| index.to_string()).collect::<Vec<_>>().join(" ")
    };
    let unknowns = |dependencies: &str| Unknowns {
        unknowns: table
            .iter()
            .zip(1..)
            .filter(|(variable, _)| variable.causality == Causality::Output)
            .map(|(variable, index)| Unknown {
                index,
                dependencies: match variable.is_total {
                    true => String::new(),
                    false => dependencies.to_owned(),
                },
            })
            .collect(),
    };
    ModelStructure {
        outputs: unknowns(&indices(&[Causality::Input])),
        initial_unknowns: unknowns(&indices(&[Causality::Input, Causality::Parameter])),
    }
}
