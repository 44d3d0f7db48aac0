//! The units of all variables, as data: powers of the base units, and the units in which a person would read the values.
//! Who uses which is a column of the tables of [`crate::signals`], [`crate::parameters`] and [`super::variables`].

/// A unit.
pub struct Unit {
    /// Name, as the variables have it.
    pub name: &'static str,
    /// Powers of the base units.
    pub powers: Powers,
    /// Units in which a person would read a value.
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

/// A unit in which a person would read a value: value there = factor × value in the unit + offset.
pub struct DisplayUnit {
    /// Name.
    pub name: &'static str,
    /// Factor.
    pub factor: f64,
    /// Offset.
    pub offset: f64,
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

// Name, powers of the base units, display units with their factors; degrees Celsius have an offset.
units! {
    "1" [];
    "s" [s 1];
    "m" [m 1] "mm" = 1e3, "µm" = 1e6, "km" = 1e-3;
    "1/m" [m -1];
    "m2" [m 2] "mm2" = 1e6;
    "m/s" [m 1 s -1] "km/h" = 3.6;
    "s/m" [s 1 m -1];
    "rad/s" [rad 1 s -1] "rpm" = 30.0 / std::f64::consts::PI;
    "N" [kg 1 m 1 s -2] "kN" = 1e-3;
    "N.m" [kg 1 m 2 s -2] "kN.m" = 1e-3;
    "Pa" [kg 1 m -1 s -2] "MPa" = 1e-6, "GPa" = 1e-9;
    "1/Pa" [kg -1 m 1 s 2];
    "m/Pa" [kg -1 m 2 s 2];
    "Pa/m" [kg 1 m -2 s -2];
    "J" [kg 1 m 2 s -2] "kJ" = 1e-3;
    "W" [kg 1 m 2 s -3] "kW" = 1e-3;
    "W/m" [kg 1 m 1 s -3] "kW/m" = 1e-3;
    "K" [k 1] "degC" = 1.0 => -273.15;
    "1/K" [k -1];
    "kg/m3" [kg 1 m -3];
    "J/(kg.K)" [m 2 s -2 k -1];
    "m2/s" [m 2 s -1];
    "K.N.s/J" [m -1 s 1 k 1];
    "W/(m2.K)" [kg 1 s -3 k -1];
    "m3" [m 3] "mm3" = 1e9;
    "m3/s" [m 3 s -1] "mm3/s" = 1e9;
}

#[cfg(test)]
mod tests {
    use super::{Powers, UNITS};
    use crate::fmi::variables::{Kind, RealKind, time, variables};

    /// The powers of a name such as `J/(kg.K)`, from those of its parts.
    fn powers(name: &str) -> Powers {
        let (above, below) = name.split_once('/').unwrap_or((name, "1"));
        let mut sum = [0; 5];
        for (factors, sign) in [(above, 1), (below, -1)] {
            for factor in factors.trim_matches(['(', ')']).split('.') {
                let (symbol, power) = match factor.find(|c: char| c.is_ascii_digit() && factor != "1") {
                    Some(digit) => (&factor[..digit], factor[digit..].parse::<i32>().unwrap()),
                    None => (factor, 1),
                };
                let of_symbol = match symbol {
                    "1" => [0; 5],
                    "kg" => [1, 0, 0, 0, 0],
                    "m" => [0, 1, 0, 0, 0],
                    "s" => [0, 0, 1, 0, 0],
                    "K" => [0, 0, 0, 1, 0],
                    "rad" => [0, 0, 0, 0, 1],
                    "N" => [1, 1, -2, 0, 0],
                    "Pa" => [1, -1, -2, 0, 0],
                    "J" => [1, 2, -2, 0, 0],
                    "W" => [1, 2, -3, 0, 0],
                    other => panic!("{other} in {name}"),
                };
                for (sum, own) in sum.iter_mut().zip(of_symbol) {
                    *sum += sign * power * own;
                }
            }
        }
        let [kg, m, s, k, rad] = sum;
        Powers { kg, m, s, k, rad }
    }

    #[test]
    fn the_powers_are_those_of_the_name() {
        for unit in UNITS {
            assert_eq!(unit.powers, powers(unit.name), "{}", unit.name);
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
