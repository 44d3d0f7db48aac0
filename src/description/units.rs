//! Units: powers of the base units, and the units in which a person would read the values.

use super::number;
use serde::Serialize;

#[derive(Serialize)]
pub struct UnitDefinitions {
    #[serde(rename = "Unit")]
    units: Vec<Unit>,
}

#[derive(Serialize)]
struct Unit {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "BaseUnit")]
    base_unit: BaseUnit,
    #[serde(rename = "DisplayUnit")]
    display_units: Vec<DisplayUnit>,
}

/// Powers of kilogram, metre, second, kelvin and radian.
#[derive(Serialize, Clone, Copy, Default)]
struct BaseUnit {
    #[serde(rename = "@kg", skip_serializing_if = "is_zero")]
    kg: i32,
    #[serde(rename = "@m", skip_serializing_if = "is_zero")]
    m: i32,
    #[serde(rename = "@s", skip_serializing_if = "is_zero")]
    s: i32,
    #[serde(rename = "@K", skip_serializing_if = "is_zero")]
    k: i32,
    #[serde(rename = "@rad", skip_serializing_if = "is_zero")]
    rad: i32,
}

fn is_zero(power: &i32) -> bool {
    *power == 0
}

/// Value in the display unit = factor × value in the unit + offset.
#[derive(Serialize)]
struct DisplayUnit {
    #[serde(rename = "@name")]
    name: &'static str,
    #[serde(rename = "@factor")]
    factor: String,
    #[serde(rename = "@offset", skip_serializing_if = "Option::is_none")]
    offset: Option<String>,
}

/// Every unit that a variable may have.
pub fn definitions() -> UnitDefinitions {
    let one = BaseUnit::default();
    let newton = BaseUnit {
        kg: 1,
        m: 1,
        s: -2,
        ..one
    };
    let joule = BaseUnit {
        kg: 1,
        m: 2,
        s: -2,
        ..one
    };
    let pascal = BaseUnit {
        kg: 1,
        m: -1,
        s: -2,
        ..one
    };
    let revolutions_per_minute = 30.0 / std::f64::consts::PI;
    UnitDefinitions {
        units: vec![
            unit("1", one, &[]),
            unit("m", BaseUnit { m: 1, ..one }, &[("mm", 1e3), ("µm", 1e6), ("km", 1e-3)]),
            unit("m/s", BaseUnit { m: 1, s: -1, ..one }, &[("km/h", 3.6)]),
            unit(
                "rad/s",
                BaseUnit { rad: 1, s: -1, ..one },
                &[("rpm", revolutions_per_minute)],
            ),
            unit("N", newton, &[("kN", 1e-3)]),
            unit("N.m", joule, &[("kN.m", 1e-3)]),
            unit("Pa", pascal, &[("MPa", 1e-6), ("GPa", 1e-9)]),
            unit(
                "1/Pa",
                BaseUnit {
                    kg: -1,
                    m: 1,
                    s: 2,
                    ..one
                },
                &[],
            ),
            unit("J", joule, &[("kJ", 1e-3)]),
            unit(
                "W",
                BaseUnit {
                    kg: 1,
                    m: 2,
                    s: -3,
                    ..one
                },
                &[("kW", 1e-3)],
            ),
            kelvin(),
            unit("1/K", BaseUnit { k: -1, ..one }, &[]),
            unit("kg/m3", BaseUnit { kg: 1, m: -3, ..one }, &[]),
            unit(
                "J/(kg.K)",
                BaseUnit {
                    m: 2,
                    s: -2,
                    k: -1,
                    ..one
                },
                &[],
            ),
            unit("m2/s", BaseUnit { m: 2, s: -1, ..one }, &[]),
            unit(
                "K.N.s/J",
                BaseUnit {
                    m: -1,
                    s: 1,
                    k: 1,
                    ..one
                },
                &[],
            ),
            unit(
                "W/(m2.K)",
                BaseUnit {
                    kg: 1,
                    s: -3,
                    k: -1,
                    ..one
                },
                &[],
            ),
            unit("m3", BaseUnit { m: 3, ..one }, &[("mm3", 1e9)]),
            unit("m3/s", BaseUnit { m: 3, s: -1, ..one }, &[("mm3/s", 1e9)]),
        ],
    }
}

fn unit(name: &'static str, base_unit: BaseUnit, display_units: &[(&'static str, f64)]) -> Unit {
    let display_units = display_units
        .iter()
        .map(|(name, factor)| DisplayUnit {
            name,
            factor: number(*factor),
            offset: None,
        })
        .collect();
    Unit {
        name,
        base_unit,
        display_units,
    }
}

fn kelvin() -> Unit {
    let celsius = DisplayUnit {
        name: "degC",
        factor: number(1.0),
        offset: Some(number(-273.15)),
    };
    let base_unit = BaseUnit {
        k: 1,
        ..BaseUnit::default()
    };
    Unit {
        name: "K",
        base_unit,
        display_units: vec![celsius],
    }
}
