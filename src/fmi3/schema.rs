//! The elements and attributes of `modelDescription.xml` and `terminalsAndIcons.xml` that are used here, in the order of the
//! standard's schemas.

#![allow(missing_docs)]

use crate::fmi::schema::{DefaultExperiment, LogCategories, UnitDefinitions};
use serde::Serialize;

#[derive(Serialize)]
pub struct ModelDescription {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    pub model_name: &'static str,
    #[serde(rename = "@instantiationToken")]
    pub instantiation_token: String,
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
    #[serde(rename = "TypeDefinitions")]
    pub type_definitions: TypeDefinitions,
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
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    pub can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canGetAndSetFMUState")]
    pub can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUState")]
    pub can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivatives")]
    pub provides_directional_derivatives: bool,
    #[serde(rename = "@providesAdjointDerivatives")]
    pub provides_adjoint_derivatives: bool,
    #[serde(rename = "@providesPerElementDependencies")]
    pub provides_per_element_dependencies: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    pub can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    pub max_output_derivative_order: u32,
    #[serde(rename = "@providesIntermediateUpdate")]
    pub provides_intermediate_update: bool,
    #[serde(rename = "@mightReturnEarlyFromDoStep")]
    pub might_return_early_from_do_step: bool,
    #[serde(rename = "@canReturnEarlyAfterIntermediateUpdate")]
    pub can_return_early_after_intermediate_update: bool,
    #[serde(rename = "@hasEventMode")]
    pub has_event_mode: bool,
}

#[derive(Serialize)]
pub struct TypeDefinitions {
    #[serde(rename = "EnumerationType")]
    pub enumerations: Vec<EnumerationType>,
}

#[derive(Serialize)]
pub struct EnumerationType {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "Item")]
    pub items: Vec<Item>,
}

#[derive(Serialize)]
pub struct Item {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@value")]
    pub value: usize,
}

#[derive(Serialize)]
pub struct ModelVariables {
    #[serde(rename = "$value")]
    pub variables: Vec<Variable>,
}

/// A variable, by its type.
#[derive(Serialize)]
pub enum Variable {
    Float64(Attributes),
    Int32(Attributes),
    UInt64(Attributes),
    Boolean(Attributes),
    Enumeration(Attributes),
    String(Attributes),
}

#[derive(Serialize)]
pub struct Attributes {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "@causality")]
    pub causality: &'static str,
    #[serde(rename = "@variability")]
    pub variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    pub initial: Option<&'static str>,
    #[serde(rename = "@declaredType", skip_serializing_if = "Option::is_none")]
    pub declared_type: Option<String>,
    #[serde(rename = "@unit", skip_serializing_if = "Option::is_none")]
    pub unit: Option<&'static str>,
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
    #[serde(rename = "Dimension")]
    pub dimensions: Vec<Dimension>,
    #[serde(rename = "Start")]
    pub texts: Vec<Start>,
}

/// The start value of a text.
#[derive(Serialize)]
pub struct Start {
    #[serde(rename = "@value")]
    pub value: &'static str,
}

/// The length of an array in one of its indices: a number, or the variable that gives it.
#[derive(Serialize)]
pub struct Dimension {
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    pub start: Option<usize>,
    #[serde(rename = "@valueReference", skip_serializing_if = "Option::is_none")]
    pub value_reference: Option<u32>,
}

#[derive(Serialize)]
pub struct ModelStructure {
    #[serde(rename = "Output")]
    pub outputs: Vec<Unknown>,
    #[serde(rename = "InitialUnknown")]
    pub initial_unknowns: Vec<Unknown>,
}

#[derive(Serialize)]
pub struct Unknown {
    #[serde(rename = "@valueReference")]
    pub value_reference: u32,
    #[serde(rename = "@dependencies")]
    pub dependencies: String,
}

#[derive(Serialize)]
pub struct TerminalsAndIcons {
    #[serde(rename = "@fmiVersion")]
    pub fmi_version: &'static str,
    #[serde(rename = "Terminals")]
    pub terminals: Terminals,
}

#[derive(Serialize)]
pub struct Terminals {
    #[serde(rename = "Terminal")]
    pub terminals: Vec<Terminal>,
}

#[derive(Serialize)]
pub struct Terminal {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@matchingRule")]
    pub matching_rule: &'static str,
    #[serde(rename = "@description")]
    pub description: &'static str,
    #[serde(rename = "TerminalMemberVariable")]
    pub members: Vec<TerminalMemberVariable>,
}

#[derive(Serialize)]
pub struct TerminalMemberVariable {
    #[serde(rename = "@variableName")]
    pub variable_name: &'static str,
    #[serde(rename = "@memberName")]
    pub member_name: &'static str,
    #[serde(rename = "@variableKind")]
    pub variable_kind: &'static str,
}
