//! The one table of variables: inputs, outputs, parameters and locals, in the order of the model description.
//!
//! A value reference is 1000 × (number of the block) + (row in the block). Blocks and rows keep their numbers once released:
//! new rows go to the end of a block, new blocks to the end of the list.

use super::types::ValueReference;
use crate::parameters::{INTEGER_PARAMETERS, REAL_PARAMETERS};
use crate::signals::{INPUTS, OUTPUTS};
use crate::wheel_rail::{DEPTH_POINTS, PROFILE_POINTS, Profiles};

const BLOCK: u32 = 1000;
const INPUT_BLOCK: u32 = 0;
const OUTPUT_BLOCK: u32 = 1;
const REAL_PARAMETER_BLOCK: u32 = 2;
const INTEGER_PARAMETER_BLOCK: u32 = 3;
const FIRST_PROFILE_BLOCK: u32 = 4;
const SOLVER_BLOCK: u32 = 12;

/// The last relative change of the operator split.
const RESIDUAL: ValueReference = SOLVER_BLOCK * BLOCK;
/// The iterations of the operator split.
const ITERATIONS: ValueReference = SOLVER_BLOCK * BLOCK + 1;

/// One plotted profile.
pub struct ProfileColumn {
    /// Name without the index.
    pub name: &'static str,
    /// Unit.
    pub unit: &'static str,
    /// Display unit.
    display_unit: Option<&'static str>,
    /// Typical magnitude.
    nominal: f64,
    /// One sentence without its end: "… at point i".
    description: &'static str,
    /// Number of points.
    pub points: usize,
    /// Reads the points.
    pub values: fn(&Profiles) -> &[f64],
}

/// The profiles, one block of value references each, counted from `FIRST_PROFILE_BLOCK`.
#[rustfmt::skip]
pub const PROFILES: [ProfileColumn; 8] = [
    ProfileColumn { name: "profile.x", unit: "m", display_unit: Some("mm"), nominal: 1e-2, points: PROFILE_POINTS,
        description: "Position along the rail ahead of the axle", values: |p| &p.x },
    ProfileColumn { name: "profile.pressure", unit: "Pa", display_unit: Some("MPa"), nominal: 1e9, points: PROFILE_POINTS,
        description: "Contact pressure", values: |p| &p.pressure },
    ProfileColumn { name: "profile.shear", unit: "Pa", display_unit: Some("MPa"), nominal: 1e8, points: PROFILE_POINTS,
        description: "Shear traction on the rail", values: |p| &p.shear },
    ProfileColumn { name: "profile.slip", unit: "m/s", display_unit: None, nominal: 1e-1, points: PROFILE_POINTS,
        description: "Slip velocity of the rail relative to the wheel", values: |p| &p.slip },
    ProfileColumn { name: "profile.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: PROFILE_POINTS,
        description: "Absolute temperature of the rail surface", values: |p| &p.temperature },
    ProfileColumn { name: "profile.wear_depth", unit: "m", display_unit: Some("µm"), nominal: 1e-7, points: PROFILE_POINTS,
        description: "Depth of wear of the rail surface", values: |p| &p.wear_depth },
    ProfileColumn { name: "depth.z", unit: "m", display_unit: Some("mm"), nominal: 1e-3, points: DEPTH_POINTS,
        description: "Depth below the hottest contact point", values: |p| &p.depth },
    ProfileColumn { name: "depth.temperature", unit: "K", display_unit: Some("degC"), nominal: 300.0, points: DEPTH_POINTS,
        description: "Absolute temperature below the hottest contact point", values: |p| &p.depth_temperature },
];

/// Who sets a variable.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Causality {
    /// Set before the simulation, or during it where tunable.
    Parameter,
    /// Set by the importer at communication points.
    Input,
    /// Computed, to be connected.
    Output,
    /// Computed, to be looked at.
    Local,
}

/// When a variable changes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Variability {
    /// Never after the initialisation.
    Fixed,
    /// At communication points, by the importer.
    Tunable,
    /// At communication points.
    Discrete,
    /// At all times.
    Continuous,
}

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
}

/// One row of the table.
#[derive(Debug, Clone, PartialEq)]
pub struct Variable {
    /// Name, by the structured naming convention.
    pub name: String,
    /// Value reference.
    pub reference: ValueReference,
    /// One sentence.
    pub description: String,
    /// Who sets it.
    pub causality: Causality,
    /// When it changes.
    pub variability: Variability,
    /// Type, unit and range.
    pub kind: Kind,
}

/// The table.
pub fn variables() -> Vec<Variable> {
    let mut table = Vec::new();
    table.extend((INPUT_BLOCK * BLOCK..).zip(INPUTS).map(|(reference, row)| Variable {
        name: row.name.to_owned(),
        reference,
        description: row.description.to_owned(),
        causality: Causality::Input,
        variability: Variability::Continuous,
        kind: Kind::Real {
            unit: row.unit,
            display_unit: display_unit(row.name, row.unit),
            minimum: Some(row.minimum),
            maximum: Some(row.maximum),
            nominal: Some(row.nominal),
            start: Some(row.default),
        },
    }));
    table.extend((OUTPUT_BLOCK * BLOCK..).zip(OUTPUTS).map(|(reference, row)| Variable {
        name: row.name.to_owned(),
        reference,
        description: row.description.to_owned(),
        causality: Causality::Output,
        variability: Variability::Continuous,
        kind: Kind::Real {
            unit: row.unit,
            display_unit: display_unit(row.name, row.unit),
            minimum: row.minimum,
            maximum: row.maximum,
            nominal: Some(row.nominal),
            start: None,
        },
    }));
    table.extend(
        (INTEGER_PARAMETER_BLOCK * BLOCK..)
            .zip(INTEGER_PARAMETERS)
            .map(|(reference, row)| Variable {
                name: row.name.to_owned(),
                reference,
                description: row.description.to_owned(),
                causality: Causality::Parameter,
                variability: Variability::Fixed,
                kind: Kind::Integer {
                    minimum: Some(row.minimum),
                    maximum: Some(row.maximum),
                    start: Some(row.default),
                },
            }),
    );
    table.extend(
        (REAL_PARAMETER_BLOCK * BLOCK..)
            .zip(REAL_PARAMETERS)
            .map(|(reference, row)| Variable {
                name: row.name.to_owned(),
                reference,
                description: row.description.to_owned(),
                causality: Causality::Parameter,
                variability: if row.tunable {
                    Variability::Tunable
                } else {
                    Variability::Fixed
                },
                kind: Kind::Real {
                    unit: row.unit,
                    display_unit: display_unit(row.name, row.unit),
                    minimum: Some(row.minimum),
                    maximum: Some(row.maximum),
                    nominal: Some(row.default.abs()).filter(|nominal| *nominal > 0.0),
                    start: Some(row.default),
                },
            }),
    );
    for (block, column) in (FIRST_PROFILE_BLOCK..).zip(&PROFILES) {
        table.extend(
            (block * BLOCK..)
                .zip(1..=column.points)
                .map(|(reference, point)| Variable {
                    name: format!("{}[{point}]", column.name),
                    reference,
                    description: format!("{} at point {point}", column.description),
                    causality: Causality::Local,
                    variability: Variability::Continuous,
                    kind: Kind::Real {
                        unit: column.unit,
                        display_unit: column.display_unit,
                        minimum: None,
                        maximum: None,
                        nominal: Some(column.nominal),
                        start: None,
                    },
                }),
        );
    }
    table.push(Variable {
        name: "solver.residual".to_owned(),
        reference: RESIDUAL,
        description: "Last relative change of the operator split in the last step".to_owned(),
        causality: Causality::Local,
        variability: Variability::Continuous,
        kind: Kind::Real {
            unit: "1",
            display_unit: None,
            minimum: Some(0.0),
            maximum: None,
            nominal: Some(1e-9),
            start: None,
        },
    });
    table.push(Variable {
        name: "solver.iterations".to_owned(),
        reference: ITERATIONS,
        description: "Iterations of the operator split in the last step".to_owned(),
        causality: Causality::Local,
        variability: Variability::Discrete,
        kind: Kind::Integer {
            minimum: Some(0),
            maximum: None,
            start: None,
        },
    });
    table
}

/// The unit in which a person would read a variable.
fn display_unit(name: &str, unit: &str) -> Option<&'static str> {
    match (name, unit) {
        ("penetration" | "prescribed_penetration" | "wear_depth" | "wheel_wear_depth", _) => Some("µm"),
        ("incoming_wear_depth" | "leaving_wear_depth", _) => Some("µm"),
        ("wheel_radius" | "strip_height" | "strip_half_length", _) => None,
        ("lame_lambda" | "shear_modulus" | "wheel_lame_lambda" | "wheel_shear_modulus", _) => Some("GPa"),
        ("vehicle_speed", _) => Some("km/h"),
        ("distance", _) => Some("km"),
        (_, "m") => Some("mm"),
        (_, "Pa") => Some("MPa"),
        (_, "K") => Some("degC"),
        (_, "N") => Some("kN"),
        (_, "N.m") => Some("kN.m"),
        (_, "W") => Some("kW"),
        (_, "J") => Some("kJ"),
        (_, "m3") => Some("mm3"),
        (_, "m3/s") => Some("mm3/s"),
        (_, "rad/s") => Some("rpm"),
        _ => None,
    }
}

/// What a value reference of type Real stands for; rows are those of the tables of the model.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum RealVariable {
    /// Row of [`INPUTS`].
    Input(usize),
    /// Row of [`OUTPUTS`].
    Output(usize),
    /// Row of [`REAL_PARAMETERS`].
    Parameter(usize),
    /// Column of [`PROFILES`] and point.
    Profile(usize, usize),
    /// `solver.residual`.
    Residual,
}

/// What a value reference of type Integer stands for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntegerVariable {
    /// Row of [`INTEGER_PARAMETERS`].
    Parameter(usize),
    /// `solver.iterations`.
    Iterations,
}

/// Resolves a value reference of type Real.
pub fn real(reference: ValueReference) -> Option<RealVariable> {
    if reference == RESIDUAL {
        return Some(RealVariable::Residual);
    }
    let (block, row) = (reference / BLOCK, (reference % BLOCK) as usize);
    match block {
        INPUT_BLOCK => (row < INPUTS.len()).then_some(RealVariable::Input(row)),
        OUTPUT_BLOCK => (row < OUTPUTS.len()).then_some(RealVariable::Output(row)),
        REAL_PARAMETER_BLOCK => (row < REAL_PARAMETERS.len()).then_some(RealVariable::Parameter(row)),
        FIRST_PROFILE_BLOCK.. => {
            let column = (block - FIRST_PROFILE_BLOCK) as usize;
            let points = PROFILES.get(column)?.points;
            (row < points).then_some(RealVariable::Profile(column, row))
        }
        _ => None,
    }
}

/// Resolves a value reference of type Integer.
pub fn integer(reference: ValueReference) -> Option<IntegerVariable> {
    if reference == ITERATIONS {
        return Some(IntegerVariable::Iterations);
    }
    let (block, row) = (reference / BLOCK, (reference % BLOCK) as usize);
    (block == INTEGER_PARAMETER_BLOCK && row < INTEGER_PARAMETERS.len()).then_some(IntegerVariable::Parameter(row))
}

/// The name of a variable, for messages; made only when something is wrong.
pub fn name(reference: ValueReference) -> String {
    variables()
        .into_iter()
        .find(|variable| variable.reference == reference)
        .map_or_else(|| format!("value reference {reference}"), |variable| variable.name)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn every_variable_resolves_to_its_own_value() {
        for variable in variables() {
            match variable.kind {
                Kind::Real { .. } => {
                    let expected = match real(variable.reference).expect(&variable.name) {
                        RealVariable::Input(row) => INPUTS[row].name.to_owned(),
                        RealVariable::Output(row) => OUTPUTS[row].name.to_owned(),
                        RealVariable::Parameter(row) => REAL_PARAMETERS[row].name.to_owned(),
                        RealVariable::Profile(column, point) => format!("{}[{}]", PROFILES[column].name, point + 1),
                        RealVariable::Residual => "solver.residual".to_owned(),
                    };
                    assert_eq!(variable.name, expected);
                    assert_eq!(integer(variable.reference), None);
                }
                Kind::Integer { .. } => {
                    let expected = match integer(variable.reference).expect(&variable.name) {
                        IntegerVariable::Parameter(row) => INTEGER_PARAMETERS[row].name,
                        IntegerVariable::Iterations => "solver.iterations",
                    };
                    assert_eq!(variable.name, expected);
                    assert_eq!(real(variable.reference), None);
                }
            }
        }
    }

    #[test]
    fn names_and_references_are_unique_and_nothing_else_resolves() {
        let table = variables();
        let names: HashSet<_> = table.iter().map(|variable| &variable.name).collect();
        let references: HashSet<_> = table.iter().map(|variable| variable.reference).collect();
        assert_eq!((names.len(), references.len()), (table.len(), table.len()));
        for reference in (0..20_000).chain([u32::MAX, u32::MAX - 1, 1 << 31]) {
            let resolves = real(reference).is_some() || integer(reference).is_some();
            assert_eq!(resolves, references.contains(&reference), "{reference}");
        }
    }
}
