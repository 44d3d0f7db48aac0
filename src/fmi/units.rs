//! The units of all variables, as data: powers of the base units, and the units in which a person would read or write the
//! values. Who uses which is a column of the tables of [`crate::signals`], [`crate::parameters`] and [`super::variables`].
//!
//! This one table converts everywhere: the command line reads it for the headings of its tables, an importer and the Python
//! package read it as `UnitDefinitions` of `modelDescription.xml`. [`canonical`] says which spellings are the same unit; a
//! reader of the XML needs these rules too.

/// A unit.
pub struct Unit {
    /// Name, as the variables have it.
    pub name: &'static str,
    /// Powers of the base units.
    pub powers: Powers,
    /// Units in which a person would read or write a value.
    pub display_units: &'static [DisplayUnit],
}

/// Powers of kilogram, metre, second, kelvin and radian.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Powers {
    /// Kilogram.
    pub kg: i32,
    /// Metre.
    pub m: i32,
    /// Second.
    pub s: i32,
    /// Kelvin.
    pub k: i32,
    /// Radian.
    pub rad: i32,
}

/// A unit in which a person would read or write a value: value there = factor × value in the unit + offset.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DisplayUnit {
    /// Name.
    pub name: &'static str,
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
}

impl DisplayUnit {
    /// A value in the unit of the variable, from one in this unit.
    pub fn to_unit(&self, shown: f64) -> f64 {
        (shown - self.offset) / self.factor
    }
}

impl Unit {
    /// The unit of a variable by its name.
    pub fn named(name: &str) -> Option<&'static Unit> {
        UNITS.iter().find(|unit| unit.name == name)
    }

    /// Returns the conversion of a value that a person gives in a unit spelled like this: the unit itself, or one of
    /// its display units.
    pub fn spelled(&self, text: &str) -> Option<DisplayUnit> {
        let name = canonical(text);
        let itself = DisplayUnit {
            name: self.name,
            factor: 1.0,
            offset: 0.0,
        };
        let all = std::iter::once(&itself).chain(self.display_units);
        all.copied().find(|unit| unit.name == name)
    }

    /// The names of the unit and its display units, for a message.
    pub fn names(&self) -> String {
        let displays = self.display_units.iter().map(|unit| unit.name);
        let names: Vec<_> = std::iter::once(self.name).chain(displays).collect();
        names.join(", ")
    }
}

/// The spelling of a unit that the table has, from others of the same unit:
///
/// 1. spaces are dropped;
/// 2. nothing, `-` and `–` are `1`;
/// 3. `²` and `³` are `2` and `3`, and `^` is dropped;
/// 4. `·`, `⋅` and `*` are `.`;
/// 5. `u` and the Greek letter `μ` (U+03BC) are the sign `µ` (U+00B5): no unit of the table has a `u`;
/// 6. `°` is `deg`: `°C` is `degC`, `°/s` is `deg/s`;
/// 7. `Nm` is `N.m`: `kNm` is `kN.m`, `Nmm` is `N.mm`.
///
/// Capitals count: `mN` is no `MN`.
pub fn canonical(text: &str) -> String {
    let mut name = String::new();
    for letter in text.chars().filter(|letter| !letter.is_whitespace()) {
        match letter {
            '²' => name.push('2'),
            '³' => name.push('3'),
            '^' => {}
            '·' | '⋅' | '*' => name.push('.'),
            'u' | 'μ' => name.push('µ'),
            '°' => name.push_str("deg"),
            other => name.push(other),
        }
    }
    match name.as_str() {
        "" | "-" | "–" => "1".to_owned(),
        _ => name.replace("Nm", "N.m"),
    }
}

macro_rules! units {
    ($($name:literal [$($base:ident $power:literal)*] $($display:literal = $factor:expr $(=> $offset:literal)?),*;)+) => {
        /// Every unit that a variable may have, in the order in which they are listed.
        pub const UNITS: &[Unit] = &[$(
            Unit {
                name: $name,
                powers: Powers { $($base: $power,)* ..ONE },
                display_units: &[$(DisplayUnit { name: $display, factor: $factor, offset: 0.0 $(+ $offset)? }),*],
            },
        )+];
    };
}

/// A number without a unit.
const ONE: Powers = Powers {
    kg: 0,
    m: 0,
    s: 0,
    k: 0,
    rad: 0,
};

/// Revolutions per minute of one radian per second.
const RPM: f64 = 30.0 / std::f64::consts::PI;

// Name, powers of the base units, display units with their factors; degrees Celsius have an offset.
units! {
    "1" [] "%" = 1e2, "‰" = 1e3;
    "s" [s 1] "ms" = 1e3, "µs" = 1e6, "min" = 1.0 / 60.0, "h" = 1.0 / 3600.0;
    "m" [m 1] "mm" = 1e3, "cm" = 1e2, "µm" = 1e6, "nm" = 1e9, "km" = 1e-3;
    "1/m" [m -1] "1/mm" = 1e-3, "1/km" = 1e3;
    "m2" [m 2] "mm2" = 1e6, "cm2" = 1e4;
    "m/s" [m 1 s -1] "mm/s" = 1e3, "km/h" = 3.6;
    "s/m" [s 1 m -1] "s/mm" = 1e-3, "s/km" = 1e3;
    "rad" [rad 1] "deg" = 180.0 / std::f64::consts::PI, "mrad" = 1e3;
    "rad/s" [rad 1 s -1] "rpm" = RPM, "1/min" = RPM, "deg/s" = 180.0 / std::f64::consts::PI, "mrad/s" = 1e3;
    "N" [kg 1 m 1 s -2] "kN" = 1e-3, "MN" = 1e-6;
    "N.m" [kg 1 m 2 s -2] "kN.m" = 1e-3, "MN.m" = 1e-6, "N.mm" = 1e3;
    "Pa" [kg 1 m -1 s -2] "kPa" = 1e-3, "MPa" = 1e-6, "GPa" = 1e-9, "N/mm2" = 1e-6, "N/m2" = 1.0;
    "1/Pa" [kg -1 m 1 s 2] "1/MPa" = 1e6, "1/GPa" = 1e9, "m2/N" = 1.0, "mm2/N" = 1e6, "m3/(N.m)" = 1.0, "mm3/(N.m)" = 1e9;
    "m/Pa" [kg -1 m 2 s 2] "mm/MPa" = 1e9, "µm/MPa" = 1e12, "m3/N" = 1.0, "mm3/N" = 1e9;
    "Pa/m" [kg 1 m -2 s -2] "MPa/m" = 1e-6, "GPa/m" = 1e-9, "MPa/mm" = 1e-9, "N/m3" = 1.0, "N/mm3" = 1e-9;
    "J" [kg 1 m 2 s -2] "kJ" = 1e-3, "MJ" = 1e-6;
    "W" [kg 1 m 2 s -3] "kW" = 1e-3, "MW" = 1e-6;
    "W/m" [kg 1 m 1 s -3] "kW/m" = 1e-3, "MW/m" = 1e-6, "W/mm" = 1e-3;
    "K" [k 1] "degC" = 1.0 => -273.15;
    "1/K" [k -1] "µm/(m.K)" = 1e6;
    "kg/m3" [kg 1 m -3] "g/cm3" = 1e-3, "kg/dm3" = 1e-3, "t/m3" = 1e-3;
    "kg/J" [m -2 s 2] "mg/J" = 1e6, "µg/J" = 1e9;
    "J/(kg.K)" [m 2 s -2 k -1] "kJ/(kg.K)" = 1e-3;
    "m2/s" [m 2 s -1] "mm2/s" = 1e6, "cm2/s" = 1e4;
    "K.N.s/J" [m -1 s 1 k 1];
    "W/(m2.K)" [kg 1 s -3 k -1] "kW/(m2.K)" = 1e-3;
    "m3" [m 3] "mm3" = 1e9, "cm3" = 1e6;
    "m3/s" [m 3 s -1] "mm3/s" = 1e9, "cm3/s" = 1e6;
}

#[cfg(test)]
mod tests {
    use super::{Powers, UNITS, Unit, canonical};
    use crate::fmi::variables::{Kind, RealKind, time, variables};
    use std::f64::consts::PI;

    /// Size in SI units and powers of a symbol without a prefix.
    fn symbol(name: &str) -> Option<(f64, [i32; 5])> {
        Some(match name {
            "1" => (1.0, [0; 5]),
            "%" => (1e-2, [0; 5]),
            "‰" => (1e-3, [0; 5]),
            "g" => (1e-3, [1, 0, 0, 0, 0]),
            "t" => (1e3, [1, 0, 0, 0, 0]),
            "m" => (1.0, [0, 1, 0, 0, 0]),
            "s" => (1.0, [0, 0, 1, 0, 0]),
            "min" => (60.0, [0, 0, 1, 0, 0]),
            "h" => (3600.0, [0, 0, 1, 0, 0]),
            "K" | "degC" => (1.0, [0, 0, 0, 1, 0]),
            "rad" => (1.0, [0, 0, 0, 0, 1]),
            "deg" => (PI / 180.0, [0, 0, 0, 0, 1]),
            "N" => (1.0, [1, 1, -2, 0, 0]),
            "Pa" => (1.0, [1, -1, -2, 0, 0]),
            "J" => (1.0, [1, 2, -2, 0, 0]),
            "W" => (1.0, [1, 2, -3, 0, 0]),
            _ => return None,
        })
    }

    /// The size in SI units and the powers of a name such as `kJ/(kg.K)`, from those of its parts.
    fn meaning(name: &str) -> (f64, Powers) {
        let (above, below) = name.split_once('/').unwrap_or((name, "1"));
        let (mut size, mut sum) = (1.0, [0; 5]);
        for (factors, sign) in [(above, 1), (below, -1)] {
            for factor in factors.trim_matches(['(', ')']).split('.') {
                let (part, power) = match factor.find(|c: char| c.is_ascii_digit() && factor != "1") {
                    Some(digit) => (&factor[..digit], factor[digit..].parse::<i32>().unwrap()),
                    None => (factor, 1),
                };
                let (of_part, powers) = symbol(part).unwrap_or_else(|| {
                    let prefix = part.chars().next().unwrap();
                    let prefixes = [
                        ('n', 1e-9),
                        ('µ', 1e-6),
                        ('m', 1e-3),
                        ('c', 1e-2),
                        ('d', 1e-1),
                        ('k', 1e3),
                        ('M', 1e6),
                        ('G', 1e9),
                    ];
                    let (_, scale) = prefixes.iter().find(|(letter, _)| *letter == prefix).expect(name);
                    let (size, powers) = symbol(&part[prefix.len_utf8()..]).expect(name);
                    (scale * size, powers)
                });
                size *= of_part.powi(sign * power);
                for (sum, own) in sum.iter_mut().zip(powers) {
                    *sum += sign * power * own;
                }
            }
        }
        let [kg, m, s, k, rad] = sum;
        (size, Powers { kg, m, s, k, rad })
    }

    #[test]
    fn powers_and_factors_are_those_of_the_names() {
        for unit in UNITS {
            assert_eq!(meaning(unit.name), (1.0, unit.powers), "{}", unit.name);
            for display in unit.display_units {
                // A revolution is 2π radians; the radian has a power of its own.
                let revolutions = ["rpm", "1/min"].contains(&display.name);
                let (size, powers) = if revolutions {
                    (2.0 * PI / 60.0, unit.powers)
                } else {
                    meaning(display.name)
                };
                assert_eq!(powers, unit.powers, "{} as {}", unit.name, display.name);
                // Round-off of a few products.
                assert!(
                    (size * display.factor - 1.0).abs() < 1e-15 * 8.0,
                    "{} as {}: {size}",
                    unit.name,
                    display.name
                );
                assert_eq!(display.offset, if display.name == "degC" { -273.15 } else { 0.0 });
            }
        }
    }

    #[test]
    fn a_name_is_its_own_spelling_and_no_display_unit_is_there_twice() {
        for unit in UNITS {
            let mut names = vec![unit.name];
            names.extend(unit.display_units.iter().map(|display| display.name));
            for (index, name) in names.iter().enumerate() {
                assert_eq!(canonical(name), *name);
                assert!(!names[..index].contains(name), "{name} twice");
                assert_eq!(unit.spelled(name).unwrap().name, *name);
            }
        }
    }

    #[test]
    fn other_spellings_are_read() {
        for (unit, spelled, shown, value) in [
            ("N", "kN", 60.0, 60e3),
            ("N", " k N ", 60.0, 60e3),
            ("1", "", 0.5, 0.5),
            ("1", "-", 0.5, 0.5),
            ("1", "%", 0.5, 0.005),
            ("m", "um", 2.0, 2e-6),
            ("m", "μm", 2.0, 2e-6),
            ("s", "us", 2.0, 2e-6),
            ("K", "°C", 20.0, 293.15),
            ("rad/s", "°/s", 180.0, PI),
            ("m2", "mm^2", 3.0, 3e-6),
            ("m3", "mm³", 3.0, 3e-9),
            ("N.m", "kNm", 1.5, 1500.0),
            ("N.m", "N mm", 1.5, 1.5e-3),
            ("N.m", "N·m", 1.5, 1.5),
            ("W/(m2.K)", "W/(m²*K)", 1.5, 1.5),
            ("1/Pa", "mm3/(Nm)", 1.5, 1.5e-9),
        ] {
            let display = Unit::named(unit).unwrap().spelled(spelled).expect(spelled);
            let read = display.to_unit(shown);
            assert!((read - value).abs() <= 4.0 * f64::EPSILON * value, "{spelled}: {read}");
        }
        for (unit, spelled) in [("N", "mN"), ("N", "mm"), ("K", "C"), ("m", "M"), ("s", "min2")] {
            assert!(Unit::named(unit).unwrap().spelled(spelled).is_none(), "{spelled}");
        }
    }

    #[test]
    fn every_variable_has_a_unit_that_is_listed_and_every_unit_is_used() {
        let mut used = Vec::new();
        for variable in variables().into_iter().chain([time()]) {
            if let Kind::Real(RealKind { unit, display_unit, .. }) = variable.kind {
                let unit = UNITS.iter().find(|row| row.name == unit).expect(variable.name);
                let names: Vec<_> = unit.display_units.iter().map(|row| row.name).collect();
                assert!(
                    display_unit.is_none_or(|name| names.contains(&name)),
                    "{}",
                    variable.name
                );
                used.push(unit.name);
            }
        }
        assert!(UNITS.iter().all(|unit| used.contains(&unit.name)));
    }
}
