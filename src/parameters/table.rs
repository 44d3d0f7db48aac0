//! The one table of parameters: name, default, range, whether tunable, description. One row a line.

use super::validation::check_range;
use super::{Control, FrictionLaw, MeshKind, NormalSolver, Parameters, SlipSource, TABLE_POINTS, Wheel, WheelHeating};
use crate::error::Result;

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
    /// [`crate::error::Error::OutOfRange`].
    pub fn check(&self, value: f64) -> Result<()> {
        check_range(self.name, value, self.minimum, self.maximum, self.unit)
    }
}

impl IntegerParameter {
    /// Refuses a value outside the range.
    ///
    /// # Errors
    /// [`crate::error::Error::OutOfRange`].
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
#[rustfmt::skip]
pub const INTEGER_PARAMETERS: &[IntegerParameter] = &[
    choice!("control", 1, "What is prescribed in the normal direction: 1 load (input normal_load), 2 penetration (parameter prescribed_penetration)", control, [Control::Load, Control::Penetration]),
    choice!("slip_source", 1, "Which inputs define the motion: 1 creepage (wheel_speed and creepage), 2 vehicle_speed (wheel_speed and vehicle_speed)", slip_source, [SlipSource::Creepage, SlipSource::VehicleSpeed]),
    count!("contact_nodes", 61, 13, 401, "Number of evenly spaced surface nodes in the contact window of the graded mesh", contact_nodes),
    count!("depth_nodes", 41, 9, 161, "Number of nodes over the depth of the strip of the graded mesh", depth_nodes),
    choice!("normal_solver", 1, "Method for the normal contact problem: 1 active_set (primal-dual active set), 2 pschenichnyj (linearisation method of the paper)", normal_solver, [NormalSolver::ActiveSet, NormalSolver::Pschenichnyj]),
    choice!("mesh", 1, "Triangulation: 1 graded (contact_nodes by depth_nodes), 2 paper (192 triangles, 13 surface nodes)", mesh, [MeshKind::Graded, MeshKind::Paper]),
    choice!("friction_law", 2, "Friction coefficient against temperature: 1 constant, 2 piecewise_linear, 3 flow_stress, 4 table", friction_law, [FrictionLaw::Constant, FrictionLaw::PiecewiseLinear, FrictionLaw::FlowStress, FrictionLaw::Table]),
    count!("friction_table_points", 2, 2, TABLE_POINTS as i32, "Number of points of the friction table that are used", friction_table_points),
    choice!("wheel", 1, "Wheel: 1 rigid (the paper's), 2 elastic (wheel_lame_lambda, wheel_shear_modulus and wheel_density)", wheel, [Wheel::Rigid, Wheel::Elastic]),
    choice!("wheel_heating", 1, "Temperature of the wheel: 1 off (ambient, the paper's cold wheel), 2 on (the contact warms the rim)", wheel_heating, [WheelHeating::Off, WheelHeating::On]),
];

/// Start values of the friction table: the default piecewise linear law, then its hot end repeated.
const fn table_temperature(point: usize) -> f64 {
    323.15 + 100.0 * point as f64
}

const fn table_coefficient(point: usize) -> f64 {
    if point == 0 { 0.45 } else { 0.25 }
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
#[rustfmt::skip]
pub const REAL_PARAMETERS: &[RealParameter] = &[
    real!("prescribed_penetration", "m", 1e-4, -1e-2, 1e-2, false, "Penetration of the undeformed wheel into the undeformed rail where control is penetration", prescribed_penetration),
    real!("largest_load", "N", 100e3, 1.0, 1e7, false, "Largest normal load: it sizes the contact window, and a larger load is refused", largest_load),
    real!("wheel_radius", "m", 0.46, 0.05, 5.0, false, "Rolling radius of the wheel", wheel_radius),
    real!("strip_height", "m", 1.0, 0.05, 10.0, false, "Height of the elastic strip that stands for the rail", strip_height),
    real!("strip_half_length", "m", 2.0, 0.1, 20.0, false, "Half-length of the elastic strip that stands for the rail", strip_half_length),
    real!("contact_width", "m", 0.01, 1e-4, 1.0, false, "Width of the equivalent line contact", contact_width),
    real!("lame_lambda", "Pa", 11.66e10, 1e5, 1e13, false, "First Lame coefficient of the rail", lame_lambda),
    real!("shear_modulus", "Pa", 8.2e10, 1e5, 1e13, false, "Shear modulus (second Lame coefficient) of the rail", shear_modulus),
    real!("density", "kg/m3", 7.8e3, 1.0, 1e5, false, "Density of the rail", density),
    real!("heat_capacity", "J/(kg.K)", 460.0, 1.0, 1e5, false, "Specific heat capacity of the rail", heat_capacity),
    real!("thermal_diffusivity", "m2/s", 1.44e-5, 1e-8, 1e-2, false, "Thermal diffusivity of the rail", thermal_diffusivity),
    real!("thermal_expansion", "1/K", 12e-6, 0.0, 1e-4, false, "Coefficient of linear thermal expansion of the rail; 0 switches the thermal bulge off", thermal_expansion),
    real!("heat_partition", "1", 0.5, 0.0, 1.0, false, "Share of the frictional heat that enters the rail", heat_partition),
    real!("contact_thermal_resistance", "K.N.s/J", 1000.0, 1e-3, 1e12, false, "Thermal resistance of the contact to the wheel times pressure; 1e12 switches the conduction off", contact_thermal_resistance),
    real!("wear_coefficient", "1/Pa", 0.5e-12, 0.0, 1e-9, false, "Archard wear coefficient; 0 switches wear off", wear_coefficient),
    real!("slip_regularisation", "m/s", 1e-3, 1e-6, 1.0, true, "Slip speed at which the regularised Coulomb law reaches half the friction bound", slip_regularisation),
    real!("friction_cold", "1", 0.45, 0.0, 1.0, true, "Friction coefficient of the cold contact", friction_cold),
    real!("friction_hot", "1", 0.25, 0.0, 1.0, true, "Friction coefficient of the hot contact", friction_hot),
    real!("friction_temperature_cold", "K", 323.15, 1.0, 5000.0, true, "Absolute temperature up to which the friction coefficient is friction_cold", friction_temperature_cold),
    real!("friction_temperature_hot", "K", 423.15, 1.0, 5000.0, true, "Absolute temperature from which on the friction coefficient is friction_hot", friction_temperature_hot),
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
    real!("wheel_lame_lambda", "Pa", 11.66e10, 1e5, 1e13, false, "First Lame coefficient of the wheel, used where wheel is elastic", wheel_lame_lambda),
    real!("wheel_shear_modulus", "Pa", 8.2e10, 1e5, 1e13, false, "Shear modulus (second Lame coefficient) of the wheel, used where wheel is elastic", wheel_shear_modulus),
    real!("wheel_density", "kg/m3", 7.8e3, 1.0, 1e5, false, "Density of the wheel", wheel_density),
    real!("wheel_heat_capacity", "J/(kg.K)", 460.0, 1.0, 1e5, false, "Specific heat capacity of the wheel", wheel_heat_capacity),
    real!("rim_depth", "m", 0.03, 1e-3, 1.0, false, "Depth of the ring of the wheel that the contact warms, used where wheel_heating is on", rim_depth),
    real!("rim_width", "m", 0.135, 1e-3, 1.0, false, "Width of the ring of the wheel that the contact warms, used where wheel_heating is on", rim_width),
    real!("wheel_heat_transfer", "W/(m2.K)", 30.0, 0.0, 1e5, false, "Heat transfer coefficient from tread and flanks of the ring to the ambient, used where wheel_heating is on", wheel_heat_transfer),
    real!("wheel_wear_coefficient", "1/Pa", 0.0, 0.0, 1e-9, false, "Archard wear coefficient of the wheel; 0 switches its wear off", wheel_wear_coefficient),
    real!("skin_depth", "m", 5e-3, 1e-4, 0.1, false, "Depth over which incoming_temperature and leaving_temperature spread the rail's heat: sqrt(pi*thermal_diffusivity*t) for rail that was heated the time t before it enters", skin_depth),
];
