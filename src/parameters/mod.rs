//! Every physical and numerical parameter: unit, default, range, source; validated once.
//!
//! The tables [`REAL_PARAMETERS`] and [`INTEGER_PARAMETERS`] are the only place where a parameter's name, unit
//! and range stand. The FMI variables, the command line and the validation all read them.

mod table;
mod validation;

use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

pub use table::{INTEGER_PARAMETERS, IntegerParameter, REAL_PARAMETERS, RealParameter};
pub use validation::check_range;

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

/// What the wheel is made of.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum Wheel {
    /// Rigid: the paper's.
    Rigid,
    /// Elastic: its compliance adds to the rail's (`body::pair`).
    Elastic,
}

/// Whether the contact warms the wheel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
pub enum WheelHeating {
    /// The wheel stays at the ambient temperature: the paper's.
    Off,
    /// The contact warms the wheel's rim ([`crate::contact::rim`]).
    On,
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
    /// Rigid or elastic wheel.
    pub wheel: Wheel,
    /// First Lamé coefficient λ of the elastic wheel, `Pa`.
    pub wheel_lame_lambda: f64,
    /// Shear modulus γ of the elastic wheel, `Pa`.
    pub wheel_shear_modulus: f64,
    /// Density of the wheel, `kg/m³`.
    pub wheel_density: f64,
    /// Whether the contact warms the wheel.
    pub wheel_heating: WheelHeating,
    /// Heat capacity of the wheel, `J/(kg K)`.
    pub wheel_heat_capacity: f64,
    /// Depth of the rim that warms, `m`.
    pub rim_depth: f64,
    /// Width of the rim that warms, `m`.
    pub rim_width: f64,
    /// Heat transfer coefficient from the rim to the ambient, `W/(m² K)`.
    pub wheel_heat_transfer: f64,
    /// Archard's coefficient of the wheel, `1/Pa`; 0 switches its wear off.
    pub wheel_wear_coefficient: f64,
    /// Depth over which incoming and leaving temperature spread the rail's heat, `m` (`heat::incoming`).
    pub skin_depth: f64,
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
            wheel: Wheel::Rigid,
            wheel_lame_lambda: 0.0,
            wheel_shear_modulus: 0.0,
            wheel_density: 0.0,
            wheel_heating: WheelHeating::Off,
            wheel_heat_capacity: 0.0,
            rim_depth: 0.0,
            rim_width: 0.0,
            wheel_heat_transfer: 0.0,
            wheel_wear_coefficient: 0.0,
            skin_depth: 0.0,
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

/// Poisson's ratio ν = λ/(2(λ + γ)).
fn poisson_ratio(lambda: f64, shear: f64) -> f64 {
    lambda / (2.0 * (lambda + shear))
}

/// E/(1 − ν²) = 4γ(λ + γ)/(λ + 2γ), `Pa`.
fn plane_strain_modulus(lambda: f64, shear: f64) -> f64 {
    4.0 * shear * (lambda + shear) / (lambda + 2.0 * shear)
}

impl Parameters {
    /// Contact modulus E* of the pair, `Pa`: 1/E* = (1 − ν²)/E of the rail, and the same of an elastic wheel added
    /// (Johnson, Contact Mechanics, 4.20).
    pub fn contact_modulus(&self) -> f64 {
        let wheel = match self.wheel {
            Wheel::Rigid => 0.0,
            Wheel::Elastic => 1.0 / plane_strain_modulus(self.wheel_lame_lambda, self.wheel_shear_modulus),
        };
        1.0 / (1.0 / plane_strain_modulus(self.lame_lambda, self.shear_modulus) + wheel)
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

    /// Rayleigh wave speed c_R ≈ c_s (0.862 + 1.14 ν)/(1 + ν), `m/s` (Viktorov's approximation); the smaller one of rail and
    /// elastic wheel.
    pub fn rayleigh_speed(&self) -> f64 {
        let speed = |lambda: f64, shear: f64, density: f64| {
            let nu = poisson_ratio(lambda, shear);
            (shear / density).sqrt() * (0.862 + 1.14 * nu) / (1.0 + nu)
        };
        let rail = speed(self.lame_lambda, self.shear_modulus, self.density);
        match self.wheel {
            Wheel::Rigid => rail,
            Wheel::Elastic => {
                let wheel = speed(self.wheel_lame_lambda, self.wheel_shear_modulus, self.wheel_density);
                rail.min(wheel)
            }
        }
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

    /// Sets a parameter by its name from text, as `--set name=value` on the command line does.
    ///
    /// # Errors
    /// [`Error::UnknownParameter`], [`Error::NotANumber`] or [`Error::OutOfRange`].
    pub fn set_by_name(&mut self, name: &str, text: &str) -> Result<()> {
        if let Some(entry) = REAL_PARAMETERS.iter().find(|entry| entry.name == name) {
            let value = parse(entry.name, text, "a real number")?;
            entry.check(value)?;
            (entry.set)(self, value);
            return Ok(());
        }
        if let Some(entry) = INTEGER_PARAMETERS.iter().find(|entry| entry.name == name) {
            let value = parse(entry.name, text, "an integer")?;
            entry.check(value)?;
            (entry.set)(self, value);
            return Ok(());
        }
        Err(Error::UnknownParameter { name: name.to_owned() })
    }
}

/// The number that a text holds.
fn parse<T: std::str::FromStr>(name: &'static str, text: &str, expected: &'static str) -> Result<T> {
    text.trim().parse().map_err(|_| Error::NotANumber {
        name,
        text: text.to_owned(),
        expected,
    })
}
