//! Every physical and numerical parameter: unit, default, range, source; validated once.
//!
//! The tables [`REAL_PARAMETERS`] and [`INTEGER_PARAMETERS`] are the only place where a parameter's name, unit
//! and range stand. The FMI variables, the command line and the validation all read them.

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// Number of (temperature, coefficient) points that a friction table can hold.
pub const TABLE_POINTS: usize = 10;

/// What is prescribed in the normal direction.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Control {
    /// The normal load is given, the penetration follows (the component's normal use).
    Load,
    /// The penetration is given, the load follows (the paper's case).
    Penetration,
}

/// Which pair of inputs defines the motion.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum SlipSource {
    /// Wheel speed and creepage: V = ω r₀ / (1 + ξ).
    Creepage,
    /// Wheel speed and vehicle speed.
    VehicleSpeed,
}

/// Method for the normal contact problem (37).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum NormalSolver {
    /// Primal–dual active set (semismooth Newton).
    ActiveSet,
    /// The paper's Pschenichnyj linearisation method.
    Pschenichnyj,
}

/// Which triangulation is used.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum MeshKind {
    /// `contact_nodes` evenly spaced nodes under the wheel, graded outside.
    Graded,
    /// The paper's 12 × 8 cells: 192 triangles, 13 surface nodes.
    Paper,
}

/// The friction law μ(θ).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum FrictionLaw {
    /// μ₀ at every temperature.
    Constant,
    /// Linear between (θ₀, μ₀) and (θ_F, μ_F), constant outside: (12)–(13).
    PiecewiseLinear,
    /// Follows the flow stress of rail steel.
    FlowStress,
    /// Linear between the points of a table, constant outside.
    Table,
}

/// All parameters. Defaults are section 5 of the paper where it gives a number.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// What is prescribed in the normal direction.
    pub control: Control,
    /// Which inputs define the motion.
    pub slip_source: SlipSource,
    /// Penetration δ under [`Control::Penetration`], `m`.
    pub prescribed_penetration: f64,
    /// Load that sizes the contact window, `N`.
    pub largest_load: f64,
    /// Surface nodes in the contact window.
    pub contact_nodes: usize,
    /// Nodes over the depth of the strip.
    pub depth_nodes: usize,
    /// Method for the normal problem.
    pub normal_solver: NormalSolver,
    /// Which triangulation.
    pub mesh: MeshKind,
    /// Wheel radius r₀, `m`.
    pub wheel_radius: f64,
    /// Height h of the strip, `m`.
    pub strip_height: f64,
    /// Half-length L of the strip, `m`.
    pub strip_half_length: f64,
    /// Width b of the equivalent line contact, `m`.
    pub contact_width: f64,
    /// First Lamé coefficient λ, `Pa`.
    pub lame_lambda: f64,
    /// Shear modulus γ (second Lamé coefficient), `Pa`.
    pub shear_modulus: f64,
    /// Density ρ, `kg/m³`.
    pub density: f64,
    /// Heat capacity c_p, `J/(kg K)`.
    pub heat_capacity: f64,
    /// Thermal diffusivity κ, `m²/s`.
    pub thermal_diffusivity: f64,
    /// Coefficient of thermal expansion α, `1/K`; 0 switches the thermal bulge off.
    pub thermal_expansion: f64,
    /// Share ᾱ of the frictional heat that enters the rail, `1`.
    pub heat_partition: f64,
    /// Thermal contact resistance r, `K·N·s/J`; 1e12 switches the conduction into the wheel off.
    pub contact_thermal_resistance: f64,
    /// Archard's coefficient k, `1/Pa`; 0 switches wear off.
    pub wear_coefficient: f64,
    /// Regularisation ε of Coulomb's law (30), `m/s`.
    pub slip_regularisation: f64,
    /// The friction law.
    pub friction_law: FrictionLaw,
    /// Friction coefficient μ₀ of the cold contact, `1`.
    pub friction_cold: f64,
    /// Friction coefficient μ_F of the hot contact, `1`.
    pub friction_hot: f64,
    /// Absolute temperature θ₀ up to which μ = μ₀, `K`.
    pub friction_temperature_cold: f64,
    /// Absolute temperature θ_F from which on μ = μ_F, `K`.
    pub friction_temperature_hot: f64,
    /// Number of valid points of the friction table.
    pub friction_table_points: usize,
    /// Absolute temperatures of the friction table, ascending, `K`.
    pub friction_table_temperature: [f64; TABLE_POINTS],
    /// Friction coefficients of the table, `1`.
    pub friction_table_coefficient: [f64; TABLE_POINTS],
    /// Couple normal and tangential displacement (Dundurs). A rigid wheel on an elastic rail is coupled; the
    /// switch exists for the comparison with Carter's theory, which has identical bodies. Not an FMI parameter.
    pub normal_tangential_coupling: bool,
}

impl Default for Parameters {
    fn default() -> Self {
        let mut parameters = Parameters {
            control: Control::Load,
            slip_source: SlipSource::Creepage,
            prescribed_penetration: 0.0,
            largest_load: 0.0,
            contact_nodes: 0,
            depth_nodes: 0,
            normal_solver: NormalSolver::ActiveSet,
            mesh: MeshKind::Graded,
            wheel_radius: 0.0,
            strip_height: 0.0,
            strip_half_length: 0.0,
            contact_width: 0.0,
            lame_lambda: 0.0,
            shear_modulus: 0.0,
            density: 0.0,
            heat_capacity: 0.0,
            thermal_diffusivity: 0.0,
            thermal_expansion: 0.0,
            heat_partition: 0.0,
            contact_thermal_resistance: 0.0,
            wear_coefficient: 0.0,
            slip_regularisation: 0.0,
            friction_law: FrictionLaw::PiecewiseLinear,
            friction_cold: 0.0,
            friction_hot: 0.0,
            friction_temperature_cold: 0.0,
            friction_temperature_hot: 0.0,
            friction_table_points: 0,
            friction_table_temperature: [0.0; TABLE_POINTS],
            friction_table_coefficient: [0.0; TABLE_POINTS],
            normal_tangential_coupling: true,
        };
        for entry in REAL_PARAMETERS {
            (entry.set)(&mut parameters, entry.default);
        }
        for entry in INTEGER_PARAMETERS {
            (entry.set)(&mut parameters, entry.default);
        }
        parameters
    }
}

/// One row of the table of real parameters.
pub struct RealParameter {
    /// Name, the same in FMI, on the command line and in messages.
    pub name: &'static str,
    /// Unit as written in FMI unit definitions.
    pub unit: &'static str,
    /// Start value.
    pub default: f64,
    /// Smallest allowed value.
    pub minimum: f64,
    /// Largest allowed value.
    pub maximum: f64,
    /// May be changed while the simulation runs.
    pub tunable: bool,
    /// One sentence.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Parameters) -> f64,
    /// Writes a value that [`RealParameter::check`] has accepted.
    pub set: fn(&mut Parameters, f64),
}

/// One row of the table of integer parameters: counts and choices.
pub struct IntegerParameter {
    /// Name, the same in FMI, on the command line and in messages.
    pub name: &'static str,
    /// Start value.
    pub default: i32,
    /// Smallest allowed value.
    pub minimum: i32,
    /// Largest allowed value.
    pub maximum: i32,
    /// One sentence, with the meaning of each value of a choice.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Parameters) -> i32,
    /// Writes a value that [`IntegerParameter::check`] has accepted.
    pub set: fn(&mut Parameters, i32),
}

impl RealParameter {
    /// Refuses a value that is not finite or outside the range.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check(&self, value: f64) -> Result<()> {
        check_range(self.name, value, self.minimum, self.maximum, self.unit)
    }
}

impl IntegerParameter {
    /// Refuses a value outside the range.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check(&self, value: i32) -> Result<()> {
        check_range(
            self.name,
            f64::from(value),
            f64::from(self.minimum),
            f64::from(self.maximum),
            "",
        )
    }
}

/// Refuses a value that is not finite or outside `minimum..=maximum`.
///
/// # Errors
/// [`Error::OutOfRange`].
pub fn check_range(name: &'static str, value: f64, minimum: f64, maximum: f64, unit: &'static str) -> Result<()> {
    if value >= minimum && value <= maximum {
        Ok(())
    } else {
        Err(Error::OutOfRange {
            name,
            value,
            minimum,
            maximum,
            unit,
        })
    }
}

macro_rules! real {
    ($name:literal, $unit:literal, $default:expr, $minimum:expr, $maximum:expr, $tunable:expr, $description:expr, $($field:tt)+) => {
        RealParameter {
            name: $name,
            unit: $unit,
            default: $default,
            minimum: $minimum,
            maximum: $maximum,
            tunable: $tunable,
            description: $description,
            get: |p| p.$($field)+,
            set: |p, value| p.$($field)+ = value,
        }
    };
}

macro_rules! count {
    ($name:literal, $default:expr, $minimum:expr, $maximum:expr, $description:literal, $field:ident) => {
        IntegerParameter {
            name: $name,
            default: $default,
            minimum: $minimum,
            maximum: $maximum,
            description: $description,
            get: |p| p.$field as i32,
            // Negative counts do not pass `check`.
            set: |p, value| p.$field = value.unsigned_abs() as usize,
        }
    };
}

/// A choice is an Integer with the meaning of each value in its description: some importers pass over Enumerations.
macro_rules! choice {
    ($name:literal, $default:expr, $description:literal, $field:ident, [$first:expr $(, $other:expr)*]) => {
        IntegerParameter {
            name: $name,
            default: $default,
            minimum: 1,
            maximum: [$first $(, $other)*].len() as i32,
            description: $description,
            get: |p| {
                let options = [$first $(, $other)*];
                options.iter().position(|o| *o == p.$field).map_or(1, |i| i as i32 + 1)
            },
            set: |p, value| {
                let options = [$first $(, $other)*];
                if let Some(option) = options.get((value - 1) as usize) {
                    p.$field = *option;
                }
            },
        }
    };
}

/// The integer parameters in the order in which they are listed.
pub const INTEGER_PARAMETERS: &[IntegerParameter] = &[
    choice!(
        "control",
        1,
        "What is prescribed in the normal direction: 1 load (input normal_load), 2 penetration (parameter prescribed_penetration)",
        control,
        [Control::Load, Control::Penetration]
    ),
    choice!(
        "slip_source",
        1,
        "Which inputs define the motion: 1 creepage (wheel_speed and creepage), 2 vehicle_speed (wheel_speed and vehicle_speed)",
        slip_source,
        [SlipSource::Creepage, SlipSource::VehicleSpeed]
    ),
    count!(
        "contact_nodes",
        61,
        13,
        401,
        "Number of evenly spaced surface nodes in the contact window of the graded mesh",
        contact_nodes
    ),
    count!(
        "depth_nodes",
        41,
        9,
        161,
        "Number of nodes over the depth of the strip of the graded mesh",
        depth_nodes
    ),
    choice!(
        "normal_solver",
        1,
        "Method for the normal contact problem: 1 active_set (primal-dual active set), 2 pschenichnyj (linearisation method of the paper)",
        normal_solver,
        [NormalSolver::ActiveSet, NormalSolver::Pschenichnyj]
    ),
    choice!(
        "mesh",
        1,
        "Triangulation: 1 graded (contact_nodes by depth_nodes), 2 paper (192 triangles, 13 surface nodes)",
        mesh,
        [MeshKind::Graded, MeshKind::Paper]
    ),
    choice!(
        "friction_law",
        2,
        "Friction coefficient against temperature: 1 constant, 2 piecewise_linear, 3 flow_stress, 4 table",
        friction_law,
        [
            FrictionLaw::Constant,
            FrictionLaw::PiecewiseLinear,
            FrictionLaw::FlowStress,
            FrictionLaw::Table
        ]
    ),
    count!(
        "friction_table_points",
        2,
        2,
        TABLE_POINTS as i32,
        "Number of points of the friction table that are used",
        friction_table_points
    ),
];

/// Start values of the friction table: the default piecewise linear law, then its hot end repeated.
const fn table_temperature(point: usize) -> f64 {
    323.15 + 100.0 * point as f64
}

const fn table_coefficient(point: usize) -> f64 {
    if point == 0 {
        0.45
    } else {
        0.25
    }
}

macro_rules! table_point {
    (temperature $index:literal $name:literal) => {
        real!(
            $name,
            "K",
            table_temperature($index),
            1.0,
            5000.0,
            false,
            "Absolute temperature of a point of the friction table, ascending from point to point",
            friction_table_temperature[$index]
        )
    };
    (coefficient $index:literal $name:literal) => {
        real!(
            $name,
            "1",
            table_coefficient($index),
            0.0,
            1.0,
            false,
            "Friction coefficient of a point of the friction table",
            friction_table_coefficient[$index]
        )
    };
}

/// The real parameters in the order in which they are listed.
pub const REAL_PARAMETERS: &[RealParameter] = &[
    real!(
        "prescribed_penetration",
        "m",
        1e-4,
        -1e-2,
        1e-2,
        false,
        "Penetration of the undeformed wheel into the undeformed rail where control is penetration",
        prescribed_penetration
    ),
    real!(
        "largest_load",
        "N",
        100e3,
        1.0,
        1e7,
        false,
        "Largest normal load: it sizes the contact window, and a larger load is refused",
        largest_load
    ),
    real!(
        "wheel_radius",
        "m",
        0.46,
        0.05,
        5.0,
        false,
        "Rolling radius of the wheel",
        wheel_radius
    ),
    real!(
        "strip_height",
        "m",
        1.0,
        0.05,
        10.0,
        false,
        "Height of the elastic strip that stands for the rail",
        strip_height
    ),
    real!(
        "strip_half_length",
        "m",
        2.0,
        0.1,
        20.0,
        false,
        "Half-length of the elastic strip that stands for the rail",
        strip_half_length
    ),
    real!(
        "contact_width",
        "m",
        0.01,
        1e-4,
        1.0,
        false,
        "Width of the equivalent line contact",
        contact_width
    ),
    real!(
        "lame_lambda",
        "Pa",
        11.66e10,
        1e5,
        1e13,
        false,
        "First Lame coefficient of the rail",
        lame_lambda
    ),
    real!(
        "shear_modulus",
        "Pa",
        8.2e10,
        1e5,
        1e13,
        false,
        "Shear modulus (second Lame coefficient) of the rail",
        shear_modulus
    ),
    real!(
        "density",
        "kg/m3",
        7.8e3,
        1.0,
        1e5,
        false,
        "Density of the rail",
        density
    ),
    real!(
        "heat_capacity",
        "J/(kg.K)",
        460.0,
        1.0,
        1e5,
        false,
        "Specific heat capacity of the rail",
        heat_capacity
    ),
    real!(
        "thermal_diffusivity",
        "m2/s",
        1.44e-5,
        1e-8,
        1e-2,
        false,
        "Thermal diffusivity of the rail",
        thermal_diffusivity
    ),
    real!(
        "thermal_expansion",
        "1/K",
        12e-6,
        0.0,
        1e-4,
        false,
        "Coefficient of linear thermal expansion of the rail; 0 switches the thermal bulge off",
        thermal_expansion
    ),
    real!(
        "heat_partition",
        "1",
        0.5,
        0.0,
        1.0,
        false,
        "Share of the frictional heat that enters the rail",
        heat_partition
    ),
    real!(
        "contact_thermal_resistance",
        "K.N.s/J",
        1000.0,
        1e-3,
        1e12,
        false,
        "Thermal resistance of the contact to the wheel times pressure; 1e12 switches the conduction off",
        contact_thermal_resistance
    ),
    real!(
        "wear_coefficient",
        "1/Pa",
        0.5e-12,
        0.0,
        1e-9,
        false,
        "Archard wear coefficient; 0 switches wear off",
        wear_coefficient
    ),
    real!(
        "slip_regularisation",
        "m/s",
        1e-3,
        1e-6,
        1.0,
        true,
        "Slip speed at which the regularised Coulomb law reaches half the friction bound",
        slip_regularisation
    ),
    real!(
        "friction_cold",
        "1",
        0.45,
        0.0,
        1.0,
        true,
        "Friction coefficient of the cold contact",
        friction_cold
    ),
    real!(
        "friction_hot",
        "1",
        0.25,
        0.0,
        1.0,
        true,
        "Friction coefficient of the hot contact",
        friction_hot
    ),
    real!(
        "friction_temperature_cold",
        "K",
        323.15,
        1.0,
        5000.0,
        true,
        "Absolute temperature up to which the friction coefficient is friction_cold",
        friction_temperature_cold
    ),
    real!(
        "friction_temperature_hot",
        "K",
        423.15,
        1.0,
        5000.0,
        true,
        "Absolute temperature from which on the friction coefficient is friction_hot",
        friction_temperature_hot
    ),
    table_point!(temperature 0 "friction_table.temperature[1]"),
    table_point!(temperature 1 "friction_table.temperature[2]"),
    table_point!(temperature 2 "friction_table.temperature[3]"),
    table_point!(temperature 3 "friction_table.temperature[4]"),
    table_point!(temperature 4 "friction_table.temperature[5]"),
    table_point!(temperature 5 "friction_table.temperature[6]"),
    table_point!(temperature 6 "friction_table.temperature[7]"),
    table_point!(temperature 7 "friction_table.temperature[8]"),
    table_point!(temperature 8 "friction_table.temperature[9]"),
    table_point!(temperature 9 "friction_table.temperature[10]"),
    table_point!(coefficient 0 "friction_table.coefficient[1]"),
    table_point!(coefficient 1 "friction_table.coefficient[2]"),
    table_point!(coefficient 2 "friction_table.coefficient[3]"),
    table_point!(coefficient 3 "friction_table.coefficient[4]"),
    table_point!(coefficient 4 "friction_table.coefficient[5]"),
    table_point!(coefficient 5 "friction_table.coefficient[6]"),
    table_point!(coefficient 6 "friction_table.coefficient[7]"),
    table_point!(coefficient 7 "friction_table.coefficient[8]"),
    table_point!(coefficient 8 "friction_table.coefficient[9]"),
    table_point!(coefficient 9 "friction_table.coefficient[10]"),
];

impl Parameters {
    /// Young's modulus E, `Pa`.
    pub fn youngs_modulus(&self) -> f64 {
        let (lambda, shear) = (self.lame_lambda, self.shear_modulus);
        shear * (3.0 * lambda + 2.0 * shear) / (lambda + shear)
    }

    /// Poisson's ratio ν, `1`.
    pub fn poisson_ratio(&self) -> f64 {
        self.lame_lambda / (2.0 * (self.lame_lambda + self.shear_modulus))
    }

    /// Contact modulus E* = E / (1 − ν²) of the rigid wheel on the elastic rail, `Pa`.
    pub fn contact_modulus(&self) -> f64 {
        self.youngs_modulus() / (1.0 - self.poisson_ratio().powi(2))
    }

    /// Hertz half-length a = √(4 N r₀ / (π b E*)) of a line contact, `m` (Johnson, Contact Mechanics, 4.43).
    pub fn hertz_half_length(&self, load: f64) -> f64 {
        (4.0 * load * self.wheel_radius / (std::f64::consts::PI * self.contact_width * self.contact_modulus())).sqrt()
    }

    /// Hertz peak pressure p₀ = 2 N / (π a b), `Pa` (Johnson, Contact Mechanics, 4.45).
    pub fn hertz_peak_pressure(&self, load: f64) -> f64 {
        2.0 * load / (std::f64::consts::PI * self.hertz_half_length(load) * self.contact_width)
    }

    /// Volumetric heat capacity ρ c_p, `J/(m³ K)`.
    pub fn volumetric_heat_capacity(&self) -> f64 {
        self.density * self.heat_capacity
    }

    /// Rayleigh wave speed c_R ≈ c_s (0.862 + 1.14 ν)/(1 + ν), `m/s` (Viktorov's approximation).
    pub fn rayleigh_speed(&self) -> f64 {
        let nu = self.poisson_ratio();
        (self.shear_modulus / self.density).sqrt() * (0.862 + 1.14 * nu) / (1.0 + nu)
    }

    /// Largest rolling speed |V|, 5 % of the Rayleigh speed, `m/s`: the compliance is used to first order in V²,
    /// with an error of (V/c_R)⁴ ≤ 6e-6.
    pub fn largest_speed(&self) -> f64 {
        0.05 * self.rayleigh_speed()
    }

    /// Half-width of the contact window, `m`: the Hertz half-length at the largest load and a margin of a fifth for
    /// thermal bulge, friction coupling and wear.
    pub fn window_half_width(&self) -> f64 {
        1.2 * self.hertz_half_length(self.largest_load)
    }

    /// Checks every value against its range, then the values against each other.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Combination`].
    pub fn validate(&self) -> Result<()> {
        for entry in REAL_PARAMETERS {
            entry.check((entry.get)(self))?;
        }
        for entry in INTEGER_PARAMETERS {
            entry.check((entry.get)(self))?;
        }
        self.validate_friction()?;
        let window = self.window_half_width();
        let combination = |second, second_value, requirement| Error::Combination {
            first: "largest_load",
            first_value: self.largest_load,
            second,
            second_value,
            requirement,
        };
        if window > 0.1 * self.wheel_radius {
            return Err(combination(
                "wheel_radius",
                self.wheel_radius,
                "the contact of the largest load must stay below a tenth of the wheel radius (small displacements)",
            ));
        }
        if window > 0.1 * self.strip_half_length {
            return Err(combination(
                "strip_half_length",
                self.strip_half_length,
                "the contact window of the largest load must stay below a tenth of the strip's half-length",
            ));
        }
        if window > 0.5 * self.strip_height {
            return Err(combination(
                "strip_height",
                self.strip_height,
                "the contact window of the largest load must stay below half the strip's height",
            ));
        }
        Ok(())
    }

    /// The part of [`Parameters::validate`] that tunable parameters can violate.
    ///
    /// # Errors
    /// [`Error::Combination`].
    pub fn validate_friction(&self) -> Result<()> {
        let combination = |first, first_value, second, second_value, requirement| {
            Err(Error::Combination {
                first,
                first_value,
                second,
                second_value,
                requirement,
            })
        };
        let falls = matches!(
            self.friction_law,
            FrictionLaw::PiecewiseLinear | FrictionLaw::FlowStress
        );
        if falls && self.friction_hot > self.friction_cold {
            return combination(
                "friction_hot",
                self.friction_hot,
                "friction_cold",
                self.friction_cold,
                "the hot contact's friction coefficient must not exceed the cold one's",
            );
        }
        if self.friction_law == FrictionLaw::PiecewiseLinear
            && self.friction_temperature_hot <= self.friction_temperature_cold
        {
            return combination(
                "friction_temperature_hot",
                self.friction_temperature_hot,
                "friction_temperature_cold",
                self.friction_temperature_cold,
                "the hot temperature must lie above the cold one",
            );
        }
        if self.friction_law == FrictionLaw::Table {
            let points = &self.friction_table_temperature[..self.friction_table_points];
            for pair in points.windows(2) {
                if pair[1] <= pair[0] {
                    return combination(
                        "friction_table.temperature",
                        pair[0],
                        "the next friction_table.temperature",
                        pair[1],
                        "the temperatures of the friction table must ascend",
                    );
                }
            }
        }
        Ok(())
    }

    /// Sets a parameter by its name from text, as `--set name=value` on the command line does.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`], [`Error::NotANumber`] or [`Error::OutOfRange`].
    pub fn set_by_name(&mut self, name: &str, text: &str) -> Result<()> {
        if let Some(entry) = REAL_PARAMETERS.iter().find(|entry| entry.name == name) {
            let value = text.trim().parse().map_err(|_| Error::NotANumber {
                name: entry.name,
                text: text.to_owned(),
                expected: "a real number",
            })?;
            entry.check(value)?;
            (entry.set)(self, value);
            return Ok(());
        }
        if let Some(entry) = INTEGER_PARAMETERS.iter().find(|entry| entry.name == name) {
            let value = text.trim().parse().map_err(|_| Error::NotANumber {
                name: entry.name,
                text: text.to_owned(),
                expected: "an integer",
            })?;
            entry.check(value)?;
            (entry.set)(self, value);
            return Ok(());
        }
        Err(Error::UnknownParameter { name: name.to_owned() })
    }
}
