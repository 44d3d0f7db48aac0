//! The elements and attributes of `modelDescription.xml` that FMI 2.0 and 3.0 have alike, and what fills them.

#![allow(missing_docs)]

use super::logging::Category;
use super::units::UNITS;
use quick_xml::se::{SeError, Serializer};
use serde::Serialize;
use std::collections::HashSet;

pub const MODEL_NAME: &str = "WheelRailContact";
pub const MODEL_IDENTIFIER: &str = "wheelrail";
pub const DESCRIPTION: &str =
    "Thermoelastic wheel-rail rolling contact with temperature-dependent friction, frictional heat and wear";
pub const AUTHOR: &str = "the wheelrail authors";
pub const COPYRIGHT: &str = "Copyright (c) the wheelrail authors";
pub const GENERATION_TOOL: &str = concat!("wheelrail ", env!("CARGO_PKG_VERSION"));
/// Date and time of generation: that of the version in Cargo.toml, and changed with it, so that the same sources give
/// the same bytes on any day.
pub const GENERATION_DATE_AND_TIME: &str = "2026-11-22T00:00:00Z";

#[derive(Serialize)]
pub struct LogCategories {
    #[serde(rename = "Category")]
    pub categories: Vec<LogCategory>,
}

#[derive(Serialize)]
pub struct LogCategory {
    #[serde(rename = "@name")]
    pub name: String,
    #[serde(rename = "@description")]
    pub description: &'static str,
}

#[derive(Serialize)]
pub struct DefaultExperiment {
    #[serde(rename = "@startTime")]
    pub start_time: String,
    #[serde(rename = "@stopTime")]
    pub stop_time: String,
    #[serde(rename = "@stepSize")]
    pub step_size: String,
}

#[derive(Serialize)]
pub struct UnitDefinitions {
    #[serde(rename = "Unit")]
    pub units: Vec<Unit>,
}

#[derive(Serialize)]
pub struct Unit {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "BaseUnit")]
    pub base_unit: BaseUnit,
    #[serde(rename = "DisplayUnit")]
    pub display_units: Vec<DisplayUnit>,
}

#[derive(Serialize)]
pub struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    pub kg: i32,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    pub m: i32,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    pub s: i32,
    #[serde(rename = "@K", skip_serializing_if = "is_zero")]
    pub k: i32,
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    pub rad: i32,
}

fn is_zero(power: &i32) -> bool {
    *power == 0
}

#[derive(Serialize)]
pub struct DisplayUnit {
    #[serde(rename = "@name")]
    pub name: &'static str,
    #[serde(rename = "@factor")]
    pub factor: String,
    #[serde(rename = "@offset", skip_serializing_if = "Option::is_none")]
    pub offset: Option<String>,
}

/// A document of the given root element.
///
/// # Errors
/// What the XML serializer reports.
pub fn document(root: &str, content: &impl Serialize) -> Result<String, SeError> {
    let mut body = String::new();
    let mut serializer = Serializer::with_root(&mut body, Some(root))?;
    serializer.indent(' ', 2);
    content.serialize(serializer)?;
    Ok(format!("<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n{body}\n"))
}

/// The shortest decimal number that reads back as the same value.
pub fn number(value: f64) -> String {
    let text = format!("{value:?}");
    text.strip_suffix(".0").map_or(text.clone(), str::to_owned)
}

/// All log categories.
pub fn log_categories() -> LogCategories {
    let categories = Category::ALL.iter().map(|category| LogCategory {
        name: category.name().to_string_lossy().into_owned(),
        description: match category {
            Category::StatusError => "Why a call failed",
            Category::StatusWarning => "Why a call did less than it was asked for, with the instance going on",
            Category::Solver => "Iterations and residual of each step",
            Category::Events => "Initialization, restored states, termination and reset",
        },
    });
    LogCategories {
        categories: categories.collect(),
    }
}

/// A second in steps of a millisecond.
pub fn default_experiment() -> DefaultExperiment {
    DefaultExperiment {
        start_time: number(0.0),
        stop_time: number(1.0),
        step_size: number(1e-3),
    }
}

/// The units that variables have, and that of time, which FMI 2.0 lists among no variables: who reads a table of inputs needs it.
pub fn unit_definitions(used: &HashSet<&str>) -> UnitDefinitions {
    let units = UNITS.iter().filter(|unit| unit.name == "s" || used.contains(unit.name));
    let units = units.map(|unit| Unit {
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
