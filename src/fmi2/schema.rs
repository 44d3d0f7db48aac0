//! The elements and attributes of `modelDescription.xml` that are used here, in the order of the standard's schema.

#![allow(missing_docs)]

use crate::fmi::schema::{DefaultExperiment, LogCategories, UnitDefinitions};
use serde::Serialize;

#[derive(Serialize)]
pub struct ModelDescription {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: &'static str,
    #[serde(rename = "@guid")]
    pub guid: String,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "@author")]
    pub author: &'static str,
    #[serde(rename = "@version")]
    pub version: &'static str,
    #[serde(rename = "@copyright")]
    pub copyright: &'static str,
    #[serde(rename = "@license")]
    pub license: &'static str,
    #[serde(rename = "@generationTool")]
    pub generation_tool: &'static str,
    #[serde(rename = "@generationDateAndTime")]
    pub generation_date_and_time: &'static str,
    #[serde(rename = "@variableNamingConvention")]
    pub variable_naming_convention: &'static str,
    #[serde(rename = "CoSimulation")]
    pub co_simulation: CoSimulation,
    #[serde(rename = "UnitDefinitions")]
    pub unit_definitions: UnitDefinitions,
    #[serde(rename = "LogCategories")]
    pub log_categories: LogCategories,
    #[serde(rename = "DefaultExperiment")]
    pub default_experiment: DefaultExperiment,
    #[serde(rename = "ModelVariables")]
    pub model_variables: ModelVariables,
    #[serde(rename = "ModelStructure")]
    pub model_structure: ModelStructure,
}

#[derive(Serialize)]
pub struct CoSimulation {
    #[serde(rename = "@modelIdentifier")]
    pub model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    pub needs_execution_tool: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@canInterpolateInputs")]
    pub can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    // The standard's spelling.
    #[serde(rename = "@canRunAsynchronuously")]
    pub can_run_asynchronously: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    pub can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    pub provides_directional_derivative: bool,
}

#[derive(Serialize)]
pub struct ModelVariables {
    #[serde(rename = "ScalarVariable")]
    pub variables: Vec<ScalarVariable>,
}

#[derive(Serialize)]
pub struct ScalarVariable {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    #[serde(rename = "@description")]
    pub description: String,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    #[serde(rename = "Real", skip_serializing_if = "Option::is_none")]
    pub real: Option<Real>,
    #[serde(rename = "Integer", skip_serializing_if = "Option::is_none")]
    pub integer: Option<Integer>,
    #[serde(rename = "String", skip_serializing_if = "Option::is_none")]
    pub text: Option<Text>,
}

#[derive(Serialize)]
pub struct Real {
    #[serde(rename = "@unit")]
    pub unit: &'static str,
    #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
    pub display_unit: Option<&'static str>,
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub minimum: Option<String>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    pub maximum: Option<String>,
    #[serde(rename = "@nominal", skip_serializing_if = "Option::is_none")]
    pub nominal: Option<String>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<String>,
}

#[derive(Serialize)]
pub struct Integer {
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    pub minimum: Option<i32>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    pub maximum: Option<i32>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<i32>,
}

#[derive(Serialize)]
pub struct Text {
    #[serde(rename = "@start")]
    pub start: &'static str,
}

#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Outputs")]
    pub outputs: Unknowns,
    #[serde(rename = "InitialUnknowns")]
    pub initial_unknowns: Unknowns,
}

#[derive(Serialize)]
pub struct Unknowns {
    #[serde(rename = "Unknown")]
    pub unknowns: Vec<Unknown>,
}

#[derive(Serialize)]
pub struct Unknown {
    #[serde(rename = "@index")]
    pub index: usize,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
}
