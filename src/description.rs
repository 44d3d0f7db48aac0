//! The model description: the variable table as `modelDescription.xml` of FMI 2.0.
//!
//! [`model_description`] is checked in as `modelDescription/modelDescription.xml`; the library reads its GUID from there. The GUID is
//! a hash of everything else in the description.

use crate::fmi2::logging::Category;
use crate::fmi2::variables::{Causality, Kind, Variability, Variable, variables};
use quick_xml::se::{SeError, Serializer};
use serde::Serialize;

mod units;

/// Outputs that add up over the steps: at a communication point they depend on no input, and they begin at 0.
const TOTALS: [&str; 4] = ["worn_volume", "friction_energy", "distance", "wheel_wear_depth"];

/// The complete text of `modelDescription.xml`.
///
/// # Errors
/// What the XML serializer reports.
pub fn model_description() -> Result<String, SeError> {
    let mut description = ModelDescription::new();
    let anonymous = xml(&description)?;
    description.guid = guid(&anonymous);
    xml(&description)
}

fn xml(description: &ModelDescription) -> Result<String, SeError> {
    let mut body = String::new();
    let mut serializer = Serializer::with_root(&mut body, Some("fmiModelDescription"))?;
    serializer.indent(' ', 2);
    description.serialize(serializer)?;
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{body}\n"))
}

/// FNV-1a, 128 bits (Fowler, Noll and Vo), written as a GUID.
fn guid(text: &str) -> String {
    let hash = text
        .bytes()
        .fold(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d_u128, |hash, byte| {
            (hash ^ u128::from(byte)).wrapping_mul(0x0000_0000_0100_0000_0000_0000_0000_013b)
        });
    let digits = format!("{hash:032x}");
    format!(
        "{{{}-{}-{}-{}-{}}}",
        &digits[..8],
        &digits[8..12],
        &digits[12..16],
        &digits[16..20],
        &digits[20..]
    )
}

/// The shortest decimal number that reads back as the same value.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

#[derive(Serialize)]
struct ModelDescription {
    #[serde(rename = "@fmiVersion")]
    fmi_version: &'static str,
    #[serde(rename = "@modelName")]
    model_name: &'static str,
    #[serde(rename = "@guid")]
    guid: String,
    #[serde(rename = "@description")]
    description: &'static str,
    #[serde(rename = "@version")]
    version: &'static str,
    #[serde(rename = "@license")]
    license: &'static str,
    #[serde(rename = "@generationTool")]
    generation_tool: &'static str,
    #[serde(rename = "@variableNamingConvention")]
    variable_naming_convention: &'static str,
    #[serde(rename = "CoSimulation")]
    co_simulation: CoSimulation,
    #[serde(rename = "UnitDefinitions")]
    unit_definitions: units::UnitDefinitions,
    #[serde(rename = "LogCategories")]
    log_categories: LogCategories,
    #[serde(rename = "DefaultExperiment")]
    default_experiment: DefaultExperiment,
    #[serde(rename = "ModelVariables")]
    model_variables: ModelVariables,
    #[serde(rename = "ModelStructure")]
    model_structure: ModelStructure,
}

#[derive(Serialize)]
struct CoSimulation {
    #[serde(rename = "@modelIdentifier")]
    model_identifier: &'static str,
    #[serde(rename = "@needsExecutionTool")]
    needs_execution_tool: bool,
    #[serde(rename = "@canHandleVariableCommunicationStepSize")]
    can_handle_variable_communication_step_size: bool,
    #[serde(rename = "@canInterpolateInputs")]
    can_interpolate_inputs: bool,
    #[serde(rename = "@maxOutputDerivativeOrder")]
    max_output_derivative_order: u32,
    // The standard's spelling.
    #[serde(rename = "@canRunAsynchronuously")]
    can_run_asynchronously: bool,
    #[serde(rename = "@canBeInstantiatedOnlyOncePerProcess")]
    can_be_instantiated_only_once_per_process: bool,
    #[serde(rename = "@canNotUseMemoryManagementFunctions")]
    can_not_use_memory_management_functions: bool,
    #[serde(rename = "@canGetAndSetFMUstate")]
    can_get_and_set_fmu_state: bool,
    #[serde(rename = "@canSerializeFMUstate")]
    can_serialize_fmu_state: bool,
    #[serde(rename = "@providesDirectionalDerivative")]
    provides_directional_derivative: bool,
}

#[derive(Serialize)]
struct LogCategories {
    #[serde(rename = "Category")]
    categories: Vec<LogCategory>,
}

#[derive(Serialize)]
struct LogCategory {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@description")]
    description: &'static str,
}

#[derive(Serialize)]
struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    start_time: String,
    #[serde(rename = "@stopTime")]
    stop_time: String,
    #[serde(rename = "@stepSize")]
    step_size: String,
}

#[derive(Serialize)]
struct ModelVariables {
    #[serde(rename = "ScalarVariable")]
    variables: Vec<ScalarVariable>,
}

#[derive(Serialize)]
struct ScalarVariable {
    #[serde(rename = "@name")]
    name: String,
    #[serde(rename = "@valueReference")]
    value_reference: u32,
    #[serde(rename = "@description")]
    description: String,
    #[serde(rename = "@causality")]
    causality: &'static str,
    #[serde(rename = "@variability")]
    variability: &'static str,
    #[serde(rename = "@initial", skip_serializing_if = "Option::is_none")]
    initial: Option<&'static str>,
    #[serde(rename = "Real", skip_serializing_if = "Option::is_none")]
    real: Option<Real>,
    #[serde(rename = "Integer", skip_serializing_if = "Option::is_none")]
    integer: Option<Integer>,
}

#[derive(Serialize)]
struct Real {
    #[serde(rename = "@unit")]
    unit: &'static str,
    #[serde(rename = "@displayUnit", skip_serializing_if = "Option::is_none")]
    display_unit: Option<&'static str>,
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    minimum: Option<String>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    maximum: Option<String>,
    #[serde(rename = "@nominal", skip_serializing_if = "Option::is_none")]
    nominal: Option<String>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    start: Option<String>,
}

#[derive(Serialize)]
struct Integer {
    #[serde(rename = "@min", skip_serializing_if = "Option::is_none")]
    minimum: Option<i32>,
    #[serde(rename = "@max", skip_serializing_if = "Option::is_none")]
    maximum: Option<i32>,
    #[serde(rename = "@start", skip_serializing_if = "Option::is_none")]
    start: Option<i32>,
}

#[derive(Serialize)]
struct ModelStructure {
    #[serde(rename = "Outputs")]
    outputs: Unknowns,
    #[serde(rename = "InitialUnknowns")]
    initial_unknowns: Unknowns,
}

#[derive(Serialize)]
struct Unknowns {
    #[serde(rename = "Unknown")]
    unknowns: Vec<Unknown>,
}

#[derive(Serialize)]
struct Unknown {
    #[serde(rename = "@index")]
    index: usize,
    #[serde(rename = "@dependencies")]
    dependencies: String,
}

impl ModelDescription {
    /// The description without its GUID.
    fn new() -> ModelDescription {
        let table = variables();
        ModelDescription {
            fmi_version: "2.0",
            model_name: "WheelRailContact",
            guid: String::new(),
            description: "Thermoelastic wheel-rail rolling contact with temperature-dependent friction, frictional heat and Archard wear",
            version: env!("CARGO_PKG_VERSION"),
            license: env!("CARGO_PKG_LICENSE"),
            generation_tool: concat!("wheelrail ", env!("CARGO_PKG_VERSION")),
            variable_naming_convention: "structured",
            co_simulation: CoSimulation {
                model_identifier: "wheelrail",
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
            unit_definitions: units::definitions(),
            log_categories: LogCategories {
                categories: Category::ALL
                    .iter()
                    .map(|category| LogCategory {
                        name: category.name().to_string_lossy().into_owned(),
                        description: category.description(),
                    })
                    .collect(),
            },
            default_experiment: DefaultExperiment {
                start_time: number(0.0),
                stop_time: number(1.0),
                step_size: number(1e-3),
            },
            model_structure: ModelStructure::of(&table),
            model_variables: ModelVariables {
                variables: table.into_iter().map(ScalarVariable::from).collect(),
            },
        }
    }
}

impl From<Variable> for ScalarVariable {
    fn from(variable: Variable) -> ScalarVariable {
        let (real, integer) = match variable.kind {
            Kind::Real {
                unit,
                display_unit,
                minimum,
                maximum,
                nominal,
                start,
            } => {
                let real = Real {
                    unit,
                    display_unit,
                    minimum: minimum.map(number),
                    maximum: maximum.map(number),
                    nominal: nominal.map(number),
                    start: start.map(number),
                };
                (Some(real), None)
            }
            Kind::Integer {
                minimum,
                maximum,
                start,
            } => (
                None,
                Some(Integer {
                    minimum,
                    maximum,
                    start,
                }),
            ),
        };
        ScalarVariable {
            name: variable.name,
            value_reference: variable.reference,
            description: variable.description,
            causality: match variable.causality {
                Causality::Parameter => "parameter",
                Causality::Input => "input",
                Causality::Output => "output",
                Causality::Local => "local",
            },
            variability: match variable.variability {
                Variability::Fixed => "fixed",
                Variability::Tunable => "tunable",
                Variability::Discrete => "discrete",
                Variability::Continuous => "continuous",
            },
            initial: match variable.causality {
                Causality::Parameter => Some("exact"),
                // The standard allows none for inputs.
                Causality::Input => None,
                Causality::Output | Causality::Local => Some("calculated"),
            },
            real,
            integer,
        }
    }
}

impl ModelStructure {
    fn of(table: &[Variable]) -> ModelStructure {
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
                    dependencies: match TOTALS.contains(&variable.name.as_str()) {
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
}
