//! Checks of the results that the model must reproduce, as rows that a test asserts and `wheelrail verify` prints.
//!
//! Each file holds one check: the claim, its formula and source, and the function that computes it. References are
//! closed forms evaluated here, published figures, or identities of the discrete equations; a row says which.

pub mod carter;
pub mod cattaneo;
pub mod chained;
pub mod conformal;
pub mod contact_points;
pub mod convergence;
pub mod creep_curve;
pub mod creepage_jump;
pub mod damage;
pub mod elastic_wheel;
pub mod energy;
pub mod equivalent_conicity;
pub mod explicit_master;
pub mod falling_friction;
pub mod flash_temperature;
pub mod given_geometry;
pub mod groove;
pub mod hertz;
pub mod kalker;
pub mod layer;
pub mod locked_wheel;
pub mod manchester;
pub mod manchester_cases;
pub mod mirrored;
pub mod paper_cases;
pub mod patch_cases;
pub mod patch_creep;
pub mod patch_energy;
pub mod patch_flash;
pub mod patch_hertz;
pub mod patch_jump;
pub mod patch_kalker;
pub mod patch_limits;
pub mod patch_long;
pub mod patch_mirrored;
pub mod patch_power;
pub mod power_balance;
pub mod profile_wear;
pub mod profiles_circle;
pub mod profiles_power;
pub mod rigid_wheel;
pub mod rolling_start;
mod row;
mod set_up;
pub mod standstill;
pub mod wear_laws;
pub mod wheel_temperature;
pub mod yielding_layer;

use crate::error::Result;
pub use row::Row;

/// Curve of a figure: the model beside its closed form, point by point, in SI units.
pub struct Curve {
    /// Name of the figure.
    pub name: &'static str,
    /// Headings of the columns, with units.
    pub columns: &'static [&'static str],
    /// Computes the points.
    pub points: fn() -> Result<Vec<Vec<f64>>>,
}

/// The curves behind some of the rows, computed by the same functions.
pub const CURVES: &[Curve] = &[
    Curve {
        name: "hertz",
        columns: &["load [N]", "x [m]", "pressure [Pa]", "closed form [Pa]"],
        points: hertz::curve,
    },
    Curve {
        name: "carter",
        columns: &["creepage [1]", "T/(mu N) [1]", "closed form [1]"],
        points: carter::curve,
    },
    Curve {
        name: "flash_temperature",
        columns: &["x [m]", "temperature rise [K]", "closed form [K]"],
        points: flash_temperature::curve,
    },
    Curve {
        name: "patch_hertz",
        columns: &["x [m]", "y [m]", "pressure [Pa]", "closed form [Pa]"],
        points: patch_hertz::curve,
    },
    Curve {
        name: "patch_creep",
        columns: &["force [1]", "creepage [1]", "share [1]", "CONTACT [1]"],
        points: patch_creep::curve,
    },
    Curve {
        name: "manchester",
        columns: &[
            "right wheel [1]",
            "displacement to the right [mm]",
            "contacts [1]",
            "F_x [N]",
            "CONTACT's, curved [N]",
            "CONTACT's, in one plane [N]",
            "F_y [N]",
            "CONTACT's, curved [N]",
            "peak pressure [MPa]",
            "CONTACT's [MPa]",
            "area [mm2]",
            "CONTACT's [mm2]",
        ],
        points: manchester::curve,
    },
];

/// A named group of rows.
pub struct Check {
    /// Heading.
    pub name: &'static str,
    /// Computes the rows.
    pub rows: fn() -> Result<Vec<Row>>,
}

/// All checks in the order in which they build on each other.
pub const CHECKS: &[Check] = &[
    Check {
        name: "Hertz line contact",
        rows: hertz::rows,
    },
    Check {
        name: "Carter's rolling contact",
        rows: carter::rows,
    },
    Check {
        name: "Creep curve and nodes",
        rows: creep_curve::rows,
    },
    Check {
        name: "Cattaneo's contact at rest",
        rows: cattaneo::rows,
    },
    Check {
        name: "Rolling from rest",
        rows: rolling_start::rows,
    },
    Check {
        name: "Jump of the creepage",
        rows: creepage_jump::rows,
    },
    Check {
        name: "Steps of an explicit master",
        rows: explicit_master::rows,
    },
    Check {
        name: "Stop and hold",
        rows: standstill::rows,
    },
    Check {
        name: "Rigid wheel on elastic rail",
        rows: rigid_wheel::rows,
    },
    Check {
        name: "Elastic wheel",
        rows: elastic_wheel::rows,
    },
    Check {
        name: "Flash temperature",
        rows: flash_temperature::rows,
    },
    Check {
        name: "Heat balance",
        rows: energy::rows,
    },
    Check {
        name: "Wheel temperature and wear",
        rows: wheel_temperature::rows,
    },
    Check {
        name: "Groove of a wheel on the spot",
        rows: groove::rows,
    },
    Check {
        name: "Rail from wheel to wheel",
        rows: chained::rows,
    },
    Check {
        name: "Power balance",
        rows: power_balance::rows,
    },
    Check {
        name: "Manufactured solutions",
        rows: convergence::rows,
    },
    Check {
        name: "Mirrored motion",
        rows: mirrored::rows,
    },
    Check {
        name: "The paper's cases",
        rows: paper_cases::rows,
    },
    Check {
        name: "Locked wheel",
        rows: locked_wheel::rows,
    },
    Check {
        name: "Patch: Hertz's ellipses",
        rows: patch_hertz::rows,
    },
    Check {
        name: "Patch: geometry by inputs",
        rows: given_geometry::rows,
    },
    Check {
        name: "Patch: Kalker's coefficients",
        rows: patch_kalker::rows,
    },
    Check {
        name: "Patch: creep forces",
        rows: patch_creep::rows,
    },
    Check {
        name: "Patch: jump of the creepage",
        rows: patch_jump::rows,
    },
    Check {
        name: "Patch: full slip and power",
        rows: patch_power::rows,
    },
    Check {
        name: "Patch: long across the rail",
        rows: patch_long::rows,
    },
    Check {
        name: "Patch: flash temperature",
        rows: patch_flash::rows,
    },
    Check {
        name: "Patch: balances of heat and wear",
        rows: patch_energy::rows,
    },
    Check {
        name: "Patch: mirrored motion",
        rows: patch_mirrored::rows,
    },
    Check {
        name: "Friction that falls and remembers",
        rows: falling_friction::rows,
    },
    Check {
        name: "Layer between wheel and rail",
        rows: layer::rows,
    },
    Check {
        name: "Layer that flows",
        rows: yielding_layer::rows,
    },
    Check {
        name: "Laws of wear",
        rows: wear_laws::rows,
    },
    Check {
        name: "Damage beside wear",
        rows: damage::rows,
    },
    Check {
        name: "Equivalent conicity",
        rows: equivalent_conicity::rows,
    },
    Check {
        name: "Profiles: cone on a crown",
        rows: profiles_circle::rows,
    },
    Check {
        name: "Profiles: power of friction",
        rows: profiles_power::rows,
    },
    Check {
        name: "Profiles: conformal contact",
        rows: conformal::rows,
    },
    Check {
        name: "Profiles: wear",
        rows: profile_wear::rows,
    },
    Check {
        name: "Profiles: Manchester benchmark",
        rows: manchester::rows,
    },
];

#[cfg(test)]
mod tests {
    use std::path::Path;

    /// A file that nothing declares is not compiled, and a check that no table lists is never asked.
    #[test]
    fn every_file_is_declared_and_listed() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("src/verification");
        let here = std::fs::read_to_string(folder.join("mod.rs")).unwrap();
        for entry in std::fs::read_dir(&folder).unwrap() {
            let path = entry.unwrap().path();
            let name = path.file_stem().unwrap().to_str().unwrap();
            let text = std::fs::read_to_string(&path).unwrap();
            let requires = |line: &str| {
                assert!(
                    here.contains(line),
                    "src/verification/mod.rs lacks `{line}` for src/verification/{name}.rs"
                );
            };
            if name == "mod" {
                continue;
            }
            requires(&format!("mod {name};"));
            if text.contains("\npub fn rows(") {
                requires(&format!("rows: {name}::rows"));
            }
            if text.contains("\npub fn curve(") {
                requires(&format!("points: {name}::curve"));
            }
        }
    }
}
