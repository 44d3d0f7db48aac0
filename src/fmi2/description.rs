//! The model description: the table of variables as `modelDescription.xml`.
//!
//! [`model_description`] is checked in as `modelDescription/modelDescription.xml`; the library reads its GUID from there.

use super::guid::hashed;
use super::schema::{
    BaseUnit, CoSimulation, DefaultExperiment, DisplayUnit, Integer, LogCategories, LogCategory, ModelDescription,
    ModelStructure, ModelVariables, Real, ScalarVariable, Unit, UnitDefinitions, Unknown, Unknowns,
};
use super::variables::{Causality, Kind, Variability, Variable, variables};
use crate::fmi::logging::Category;
use crate::fmi::units::UNITS;
use quick_xml::se::{SeError, Serializer};
use serde::Serialize;

/// The complete text of `modelDescription.xml`.
///
/// # Errors
/// What the XML serializer reports.
pub fn model_description() -> Result<String, SeError> {
    let mut description = anonymous();
    description.guid = hashed(&xml(&description)?);
    xml(&description)
}

fn xml(description: &ModelDescription) -> Result<String, SeError> {
    let mut body = String::new();
    let mut serializer = Serializer::with_root(&mut body, Some("fmiModelDescription"))?;
    serializer.indent(' ', 2);
    description.serialize(serializer)?;
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{body}\n"))
}

/// The shortest decimal number that reads back as the same value.
fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// The description without its GUID.
fn anonymous() -> ModelDescription {
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
        unit_definitions: unit_definitions(),
        log_categories: LogCategories {
            categories: Category::ALL
                .iter()
                .map(|category| LogCategory {
                    name: category.name().to_string_lossy().into_owned(),
                    description: description_of(*category),
                })
                .collect(),
        },
        default_experiment: DefaultExperiment {
            start_time: number(0.0),
            stop_time: number(1.0),
            step_size: number(1e-3),
        },
        model_structure: model_structure(&table),
        model_variables: ModelVariables {
            variables: table.into_iter().map(scalar_variable).collect(),
        },
    }
}

/// What the messages of a category tell.
fn description_of(category: Category) -> &'static str {
    match category {
        Category::StatusError => "Why a call returned fmi2Error",
        Category::StatusWarning => "Why a call returned fmi2Warning or fmi2Discard",
        Category::Solver => "Iterations and residual of each step",
        Category::Events => "Initialization, restored states, termination and reset",
    }
}

fn unit_definitions() -> UnitDefinitions {
    let units = UNITS.iter().map(|unit| Unit {
        name: unit.name,
        base_unit: BaseUnit {
            kg: unit.powers.kg,
            m: unit.powers.m,
            s: unit.powers.s,
            k: unit.powers.k,
            rad: unit.powers.rad,
        },
        display_units: unit
            .display_units
            .iter()
            .map(|display| DisplayUnit {
                name: display.name,
                factor: number(display.factor),
                offset: (display.offset != 0.0).then(|| number(display.offset)),
            })
            .collect(),
    });
    UnitDefinitions { units: units.collect() }
}

/// A variable as an element.
fn scalar_variable(variable: Variable) -> ScalarVariable {
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
