//! The parameters, each declared once: field, start value and row of the table.
//!
//! A row reads
//!
//! ```text
//! /// The description: one sentence, on as many lines as it needs.
//! name symbol: type = kind { columns }
//! ```
//!
//! where the symbol is that of the equations, where there is one. The order is that of the table and of a saved state.

use super::choices::{
    ContactModel, Control, FrictionLaw, MeshKind, NormalSolver, PatchGeometry, ProfileWear, Side, SlipSource, WearLaw,
    Wheel, WheelHeating, WheelWearLaw,
};
use super::grids::{PATCH_GRID, PatchGrid};
use super::range::check_range;
use super::text::check_text;
use crate::error::{Error, Result};
use serde::{Deserialize, Serialize};

/// Number of (temperature, coefficient) points that a friction table can hold.
pub const TABLE_POINTS: usize = 10;

/// One row of the table of real parameters: a number, or an array of numbers that share all but their start values.
#[derive(Clone, Copy)]
pub struct RealParameter {
    /// Name, the same in FMI, on the command line and in messages.
    pub name: &'static str,
    /// Whether it is an array.
    pub is_array: bool,
    /// The names of the elements of an array; of a number its own name.
    pub elements: &'static [&'static str],
    /// Unit as written in FMI unit definitions.
    pub unit: &'static str,
    /// Unit in which a person would read the value.
    pub display_unit: Option<&'static str>,
    /// Start value of each element.
    pub start: &'static [f64],
    /// Smallest allowed value.
    pub minimum: f64,
    /// Largest allowed value.
    pub maximum: f64,
    /// May be changed while the simulation runs.
    pub tunable: bool,
    /// One sentence; of an array on one of its elements.
    pub description: &'static str,
    /// The elements.
    pub get: fn(&Parameters) -> &[f64],
    /// The elements, to write what [`RealParameter::check`] has accepted.
    pub get_mut: fn(&mut Parameters) -> &mut [f64],
}

/// Kind of an integer parameter: a count or a choice. FMI 2.0 has an Integer for each, with the meaning of the values
/// of a choice in its description: some of its importers pass over Enumerations. FMI 3.0 has a type for each.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum IntegerKind {
    /// A number of things.
    Count,
    /// A number of things that is also the length of arrays.
    Length,
    /// A choice, by the names of its values.
    Choice(&'static [&'static str]),
    /// A choice between off (1) and on (2).
    Switch,
}

/// One row of the table of integer parameters: counts and choices.
#[derive(Clone, Copy)]
pub struct IntegerParameter {
    /// Name, the same in FMI, on the command line and in messages.
    pub name: &'static str,
    /// Start value.
    pub start: i32,
    /// Smallest allowed value.
    pub minimum: i32,
    /// Largest allowed value.
    pub maximum: i32,
    /// Kind of the parameter: a count or a choice.
    pub kind: IntegerKind,
    /// One sentence, with the meaning of each value of a choice.
    pub description: &'static str,
    /// Reads the value.
    pub get: fn(&Parameters) -> i32,
    /// Writes a value that [`IntegerParameter::check`] has accepted.
    pub set: fn(&mut Parameters, i32),
}

/// One row of the table of texts: names and files.
#[derive(Clone, Copy)]
pub struct TextParameter {
    /// Name, the same in FMI, on the command line and in messages.
    pub name: &'static str,
    /// Start value.
    pub start: &'static str,
    /// One sentence.
    pub description: &'static str,
    /// Reads the text.
    pub get: fn(&Parameters) -> &str,
    /// Writes a text that [`TextParameter::check`] has accepted.
    pub set: fn(&mut Parameters, String),
}

impl RealParameter {
    /// Refuses a value of an element that is not finite or outside the range.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    ///
    /// # Panics
    /// When there is no such element.
    pub fn check(&self, element: usize, value: f64) -> Result<()> {
        check_range(self.elements[element], value, self.minimum, self.maximum, self.unit, "")
    }
}

impl IntegerParameter {
    /// Refuses a value outside the range.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check(&self, value: i32) -> Result<()> {
        self.check_any(f64::from(value))
    }

    /// Checks, as [`IntegerParameter::check`] does, a value that may have more digits.
    ///
    /// # Errors
    /// [`Error::OutOfRange`].
    pub fn check_any(&self, value: f64) -> Result<()> {
        let [minimum, maximum] = [self.minimum, self.maximum].map(f64::from);
        check_range(self.name, value, minimum, maximum, "", "")
    }
}

impl TextParameter {
    /// Refuses a text that is blank, too long or has a zero byte in it.
    ///
    /// # Errors
    /// [`Error::Text`].
    pub fn check(&self, text: &str) -> Result<()> {
        check_text(self.name, text)
    }
}

/// A row of any kind, as the list below has them.
#[derive(Clone, Copy)]
enum ParameterRow {
    Real(RealParameter),
    Integer(IntegerParameter),
    Text(TextParameter),
}

parameters! {
    /// What is prescribed in the normal direction: 1 load (input normal_load), 2 penetration (parameter
    /// prescribed_penetration; not where contact_model is profiles), 3 height (input vertical_displacement where
    /// contact_model is profiles, input contact_penetration where it is patch)
    control: Control = choice { Control::Load }
    /// Which inputs define the motion: 1 creepage (wheel_speed and creepage), 2 vehicle_speed (wheel_speed and
    /// vehicle_speed)
    slip_source: SlipSource = choice { SlipSource::Creepage }
    /// Penetration of the undeformed wheel into the undeformed rail, used where control is penetration
    prescribed_penetration "δ": f64 = real { "m" shown in "µm", 1e-4, -1e-2, 1e-2 }
    /// Largest normal load: it sizes the contact window; a larger normal_load is refused, and one that follows from a penetration or a height is
    /// remarked on
    largest_load: f64 = real { "N" shown in "kN", 100e3, 1.0, 1e7 }
    /// Number of evenly spaced surface nodes in the contact window of the graded mesh, used where contact_model is line
    contact_nodes: usize = count { 51, 13, 401 }
    /// Number of nodes over the depth of the strip of the graded mesh
    depth_nodes: usize = count { 41, 9, 161 }
    /// Method for the normal contact problem: 1 active_set (primal-dual active set), 2 pschenichnyj (linearisation
    /// method of the paper)
    normal_solver: NormalSolver = choice { NormalSolver::ActiveSet }
    /// Triangulation: 1 graded (contact_nodes by depth_nodes), 2 paper (192 triangles, 13 surface nodes)
    mesh: MeshKind = choice { MeshKind::Graded }
    /// Rolling radius of the wheel
    wheel_radius "r₀": f64 = real { "m", 0.46, 0.05, 5.0 }
    /// Height of the elastic strip that stands for the rail
    strip_height "h": f64 = real { "m", 1.0, 0.05, 10.0 }
    /// Half-length of the elastic strip that stands for the rail
    strip_half_length "L": f64 = real { "m", 2.0, 0.1, 20.0 }
    /// Width of the equivalent line contact, used where contact_model is line
    contact_width "b": f64 = real { "m" shown in "mm", 0.01, 1e-4, 1.0 }
    /// First Lame coefficient of the rail
    lame_lambda "λ": f64 = real { "Pa" shown in "GPa", 11.66e10, 1e5, 1e13 }
    /// Shear modulus (second Lame coefficient) of the rail
    shear_modulus "γ": f64 = real { "Pa" shown in "GPa", 8.2e10, 1e5, 1e13 }
    /// Density of the rail
    density "ρ": f64 = real { "kg/m3", 7.8e3, 1.0, 1e5 }
    /// Specific heat capacity of the rail
    heat_capacity "c_p": f64 = real { "J/(kg.K)", 460.0, 1.0, 1e5 }
    /// Thermal diffusivity of the rail
    thermal_diffusivity "κ": f64 = real { "m2/s", 1.44e-5, 1e-8, 1e-2 }
    /// Coefficient of linear thermal expansion of the rail; 0 switches the thermal bulge off
    thermal_expansion "α": f64 = real { "1/K", 12e-6, 0.0, 1e-4 }
    /// Share of the frictional heat that enters the rail
    heat_partition "ᾱ": f64 = real { "1", 0.5, 0.0, 1.0 }
    /// Thermal resistance of the contact to the wheel times pressure; 1e12 switches the conduction off
    contact_thermal_resistance "r": f64 = real { "K.N.s/J", 1000.0, 1e-3, 1e12 }
    /// Archard wear coefficient of the rail, used where wear_law is archard; 0 switches its wear off
    wear_coefficient "k": f64 = real { "1/Pa", 0.5e-12, 0.0, 1e-9 }
    /// Slip speed at which the regularised Coulomb law reaches half the friction bound; 0 is Coulomb's law itself
    slip_regularisation "ε": f64 = real { "m/s", 0.0, 0.0, 1.0, tunable }
    /// Friction coefficient against temperature: 1 constant, 2 piecewise_linear, 3 flow_stress, 4 table
    friction_law: FrictionLaw = choice { FrictionLaw::PiecewiseLinear }
    /// Friction coefficient of the cold contact
    friction_cold "μ₀": f64 = real { "1", 0.45, 0.0, 1.0, tunable }
    /// Friction coefficient of the hot contact
    friction_hot "μ_F": f64 = real { "1", 0.25, 0.0, 1.0, tunable }
    /// Absolute temperature up to which the friction coefficient is friction_cold
    friction_temperature_cold "θ₀": f64 = real { "K" shown in "degC", 323.15, 1.0, 5000.0, tunable }
    /// Absolute temperature from which on the friction coefficient is friction_hot
    friction_temperature_hot "θ_F": f64 = real { "K" shown in "degC", 423.15, 1.0, 5000.0, tunable }
    /// Number of points of the friction table that are used
    friction_table_points: usize = count { 2, 2, TABLE_POINTS as i32 }
    /// Absolute temperature of a point of the friction table, ascending from point to point
    friction_table_temperature: [f64; TABLE_POINTS] = reals {
        "friction_table.temperature" [1 2 3 4 5 6 7 8 9 10], "K" shown in "degC", TABLE_TEMPERATURES, 1.0, 5000.0
    }
    /// Friction coefficient of a point of the friction table
    friction_table_coefficient: [f64; TABLE_POINTS] = reals {
        "friction_table.coefficient" [1 2 3 4 5 6 7 8 9 10], "1", TABLE_COEFFICIENTS, 0.0, 1.0
    }
    /// Wheel: 1 rigid (the paper's; it pulls at creepage 0), 2 elastic (wheel_lame_lambda, wheel_shear_modulus and
    /// wheel_density; by default of the rail's material, so that it does not)
    wheel: Wheel = choice { Wheel::Elastic }
    /// First Lame coefficient of the wheel, used where wheel is elastic
    wheel_lame_lambda: f64 = real { "Pa" shown in "GPa", 11.66e10, 1e5, 1e13 }
    /// Shear modulus (second Lame coefficient) of the wheel, used where wheel is elastic
    wheel_shear_modulus: f64 = real { "Pa" shown in "GPa", 8.2e10, 1e5, 1e13 }
    /// Density of the wheel
    wheel_density: f64 = real { "kg/m3", 7.8e3, 1.0, 1e5 }
    /// Whether the contact warms the rim of the wheel, which otherwise has the ambient temperature (the paper's cold wheel)
    wheel_heating: WheelHeating = switch { WheelHeating::Off }
    /// Specific heat capacity of the wheel
    wheel_heat_capacity: f64 = real { "J/(kg.K)", 460.0, 1.0, 1e5 }
    /// Depth of the ring of the wheel that the contact warms, used where wheel_heating is on
    rim_depth: f64 = real { "m" shown in "mm", 0.03, 1e-3, 1.0 }
    /// Width of the ring of the wheel that the contact warms, used where wheel_heating is on
    rim_width: f64 = real { "m" shown in "mm", 0.135, 1e-3, 1.0 }
    /// Heat transfer coefficient from tread and flanks of the ring to the ambient, used where wheel_heating is on
    wheel_heat_transfer: f64 = real { "W/(m2.K)", 30.0, 0.0, 1e5 }
    /// Archard wear coefficient of the wheel; 0 switches its wear off
    wheel_wear_coefficient: f64 = real { "1/Pa", 0.0, 0.0, 1e-9 }
    /// Depth over which incoming_temperature and leaving_temperature spread the rail's heat:
    /// sqrt(pi*thermal_diffusivity*t) for rail that was heated the time t before it enters
    skin_depth: f64 = real { "m" shown in "mm", 5e-3, 1e-4, 0.1 }
    /// How the contact is resolved: 1 line (along the rail, uniform over contact_width: the paper's), 2 patch (along and
    /// across the rail, with lateral force and spin moment), 3 profiles (wherever rail_profile and wheel_profile touch, from
    /// the position and motion of the wheelset)
    contact_model: ContactModel = choice { ContactModel::Line }
    /// Curvature of the rail's head across the rail, used where contact_model is patch; negative is hollow
    rail_transverse_curvature: f64 = real { "1/m", 1.0 / 0.3, -1e3, 1e3 }
    /// Curvature of the wheel's tread across the rail, used where contact_model is patch; negative is hollow, 0 is a cone
    wheel_transverse_curvature: f64 = real { "1/m", 0.0, -1e3, 1e3 }
    /// Number of cells along the contact window, used where contact_model is patch or profiles; with patch_strips it makes a grid,
    /// of which three have a name, patch_grid on the command line, in presets and in Python, here with the largest error in steady
    /// rolling with a spin phi*sqrt(a*b) of up to 0.004, of F_x and F_y over mu*F_N and of M_z over mu*F_N*sqrt(a*b), and the median
    /// time of a patch's step on a rough track: fast 8 x 8 (error 0.011, 0.06 ms), default 34 x 21 (error 0.003, 0.6 ms), fine 48 x 31 (error 0.0019, 1.6 ms)
    patch_nodes: usize = length { 34, 8, 201 }
    /// Number of strips across the contact window, used where contact_model is patch or profiles; of the grids that have a name,
    /// with error and time as at patch_nodes: fast 8 (error 0.011, 0.06 ms), default 21 (error 0.003, 0.6 ms), fine 31 (error
    /// 0.0019, 1.6 ms)
    patch_strips: usize = length { 21, 3, 101 }
    /// Share of the friction coefficient that is left at large slip velocity s: it is multiplied by
    /// friction_slip_share + (1 - friction_slip_share)*exp(-friction_slip_decay*s); 1 switches the law of slip off
    friction_slip_share "A": f64 = real { "1", 1.0, 0.0, 1.0, tunable }
    /// Decay of the friction coefficient with the slip velocity; 0 switches the law of slip off
    friction_slip_decay "B": f64 = real { "s/m", 0.0, 0.0, 1e3, tunable }
    /// Way of slip on which the friction coefficient follows temperature and slip velocity; 0 is at once
    friction_memory_distance "d_c": f64 = real { "m" shown in "µm", 0.0, 0.0, 1e-2, tunable }
    /// Least slip velocity with which the friction coefficient follows, used where friction_memory_distance is not 0
    friction_memory_speed "s₀": f64 = real { "m/s", 1e-3, 1e-9, 1.0, tunable }
    /// Tangential displacement per shear traction of the layer between wheel and rail, its thickness over its shear
    /// modulus; 0 is no layer
    layer_compliance "h/G₃": f64 = real { "m/Pa", 0.0, 0.0, 1e-9 }
    /// Shear traction at which the layer between wheel and rail begins to flow; 0 is a layer that never does
    layer_yield_stress "τ_c0": f64 = real { "Pa" shown in "MPa", 0.0, 0.0, 1e11, tunable }
    /// Rise of the shear traction at which the layer flows with the way that it has flowed, used where layer_yield_stress is
    /// not 0
    layer_hardening "k_τ": f64 = real { "Pa/m", 0.0, 0.0, 1e15, tunable }
    /// Profile of the rail, used where contact_model is profiles: the name of one that is built in, the path or URI of a
    /// file, or the name of a file in the archive's resources
    rail_profile: String = text { "60E1" }
    /// Profile of the wheel, used where contact_model is profiles: the name of one that is built in, the path or URI of a
    /// file, or the name of a file in the archive's resources
    wheel_profile: String = text { "S1002" }
    /// Side of the track that the wheel runs on, used where contact_model is profiles: 1 left, 2 right
    side: Side = choice { Side::Left }
    /// Distance between the running faces of the rails, used where contact_model is profiles
    gauge: f64 = real { "m" shown in "mm", 1.435, 0.3, 3.0 }
    /// Depth below the top of the rail at which the gauge is measured, used where contact_model is profiles
    gauge_depth: f64 = real { "m" shown in "mm", 14e-3, 1e-3, 50e-3 }
    /// Distance between the backs of the wheels' flanges, used where contact_model is profiles
    flange_back_distance: f64 = real { "m" shown in "mm", 1.360, 0.3, 3.0 }
    /// Distance of the running circle from the back of the wheel's flange, used where contact_model is profiles
    flange_back_position: f64 = real { "m" shown in "mm", 70e-3, 10e-3, 200e-3 }
    /// Slope by which the rail leans towards the middle of the track, used where contact_model is profiles; 0 for a profile
    /// that is inclined already
    rail_inclination: f64 = real { "1", 1.0 / 40.0, -0.2, 0.2 }
    /// Wavelength of the waves that smoothing damps to a half in profiles of measured points, used where contact_model is
    /// profiles; 0 goes through the points
    profile_smoothing: f64 = real { "m" shown in "mm", 0.0, 0.0, 0.1 }
    /// Factor on the friction coefficient at the rail's gauge face for its lubrication, used where contact_model is profiles
    gauge_face_friction_scale: f64 = real { "1", 1.0, 0.0, 2.0, tunable }
    /// Inclination of the rail's surface towards the middle of the track from which on gauge_face_friction_scale acts, used
    /// where contact_model is profiles
    gauge_face_angle: f64 = real { "rad" shown in "deg", std::f64::consts::FRAC_PI_4, 0.0, std::f64::consts::FRAC_PI_2 }
    /// Rise of the inclination beyond gauge_face_angle over which gauge_face_friction_scale comes to act in full, used where
    /// contact_model is profiles
    gauge_face_blend: f64 = real { "rad" shown in "deg", std::f64::consts::PI / 18.0, 1e-3, std::f64::consts::FRAC_PI_2 }
    /// Geometry of the bodies, used where contact_model is patch: 1 parameters (wheel_radius, rail_transverse_curvature and
    /// wheel_transverse_curvature), 2 inputs (rolling_radius, longitudinal_curvature and transverse_curvature; the parameters
    /// and largest_load size the contact window)
    patch_geometry: PatchGeometry = choice { PatchGeometry::Parameters }
    /// Damping of the approach, used where control is height: the normal force is multiplied by 1 + normal_damping times the
    /// speed of the approach; friction, heat and wear do not see it
    normal_damping: f64 = real { "s/m", 0.0, 0.0, 1e3, tunable }
    /// Law of the rail's wear: 1 archard (wear_coefficient), 2 archard_map (a coefficient over slip speed and pressure: hardness and
    /// wear_map_mild to wear_map_pressure), 3 energy (the work per area and distance rolled: wear_energy_mild to wear_energy_threshold)
    wear_law: WearLaw = choice { WearLaw::Archard }
    /// Width over which a step or a corner of the law of wear is blended, as a share of where it is, used where wear_law is archard_map or energy
    wear_blend: f64 = real { "1", 0.1, 1e-3, 1.0 }
    /// Hardness of the softer body, used where wear_law is archard_map
    hardness "H": f64 = real { "Pa" shown in "GPa", 3e9, 1e7, 1e12 }
    /// Wear coefficient of mild wear, used where wear_law is archard_map
    wear_map_mild "k₁": f64 = real { "1", 5e-4, 0.0, 1.0 }
    /// Wear coefficient of severe wear, used where wear_law is archard_map
    wear_map_severe "k₂": f64 = real { "1", 35e-4, 0.0, 1.0 }
    /// Wear coefficient at slip speeds past severe wear, used where wear_law is archard_map
    wear_map_fast "k₃": f64 = real { "1", 5e-4, 0.0, 1.0 }
    /// Wear coefficient of catastrophic wear, used where wear_law is archard_map
    wear_map_catastrophic "k₄": f64 = real { "1", 350e-4, 0.0, 1.0 }
    /// Slip speed from which on wear is severe, used where wear_law is archard_map
    wear_map_slip_severe: f64 = real { "m/s", 0.2, 1e-6, 1e3 }
    /// Slip speed from which on wear is no longer severe, used where wear_law is archard_map
    wear_map_slip_fast: f64 = real { "m/s", 0.7, 1e-6, 1e3 }
    /// Pressure from which on wear is catastrophic, as a share of the hardness, used where wear_law is archard_map
    wear_map_pressure: f64 = real { "1", 0.8, 1e-3, 1e3 }
    /// Mass lost per friction work by mild wear, used where wear_law is energy
    wear_energy_mild "a": f64 = real { "kg/J", 5.3e-9, 1e-15, 1e-5 }
    /// Mass lost per area and distance rolled by severe wear, used where wear_law is energy
    wear_energy_severe "R": f64 = real { "kg/m3", 0.055, 1e-9, 1e3 }
    /// Rise of the mass lost with the friction work by catastrophic wear, used where wear_law is energy
    wear_energy_catastrophic "c": f64 = real { "kg/J", 61.9e-9, 0.0, 1e-5 }
    /// Friction work per area and distance rolled from which on wear is catastrophic, used where wear_law is energy
    wear_energy_threshold "x_c": f64 = real { "Pa" shown in "MPa", (55.0 + 4778.7) / 61.9 * 1e6, 1e3, 1e12 }
    /// Law of the wheel's wear: 1 coefficient (wheel_wear_coefficient), 2 wear_law (that of the rail, with the same parameters)
    wheel_wear_law: WheelWearLaw = choice { WheelWearLaw::Coefficient }
    /// Whether the wheel's profile loses what the contact wears off it, spread over the turn, used where contact_model is profiles
    wheel_profile_wear: ProfileWear = switch { ProfileWear::Off }
    /// Whether the rail's profile loses what the contact wears off it, spread over rail_wear_length, used where contact_model is profiles;
    /// otherwise the rail under the wheel is new all the time
    rail_profile_wear: ProfileWear = switch { ProfileWear::Off }
    /// Length of rail that the wheel passes over and over, used where rail_profile_wear is on: a closed track, the circumference of a
    /// roller, or the distance that wheels roll for each of them that passes a place
    rail_wear_length "L_r": f64 = real { "m", 1000.0, 0.0, 1e9 }
    /// Number of cells over each profile in which the depth of its wear is collected, used where contact_model is profiles; by default
    /// they are 0.1 mm long
    profile_wear_points: usize = length { 1500, 50, 20000 }
    /// Factor on what is worn off the profiles, so that a short run stands for a long one, used where contact_model is profiles; heat and totals
    /// do not see it
    wear_acceleration: f64 = real { "1", 1.0, 0.0, 1e9, tunable }
    /// Wear number up to which a contact does no damage by rolling contact fatigue, used where contact_model is patch or profiles
    rcf_threshold: f64 = real { "N", 15.0, 0.0, 1e9 }
    /// Wear number at which damage by rolling contact fatigue is largest, used where contact_model is patch or profiles
    rcf_peak: f64 = real { "N", 65.0, 0.0, 1e9 }
    /// Wear number beyond which more is worn off than fatigue damages: the damage is negative, used where contact_model is patch or profiles
    rcf_balance: f64 = real { "N", 175.0, 0.0, 1e9 }
    /// Largest damage by rolling contact fatigue that one passage of a contact does, 1 being that at which cracks begin, used where contact_model is
    /// patch or profiles; 0 switches the damage off
    rcf_peak_damage: f64 = real { "1", 1e-5, 0.0, 1.0 }
    /// Yield stress in shear of the rail, for surface_fatigue_index
    shear_yield_stress "k": f64 = real { "Pa" shown in "MPa", 300e6, 0.0, 1e12 }
    /// Absolute temperature above which the rail's steel becomes austenite, for austenite_depth
    austenite_temperature: f64 = real { "K" shown in "degC", 1000.15, 1.0, 5000.0 }
}

/// The start values of the friction table: the default piecewise linear law, its hot end repeated.
const TABLE_TEMPERATURES: [f64; TABLE_POINTS] = [
    323.15, 423.15, 523.15, 623.15, 723.15, 823.15, 923.15, 1023.15, 1123.15, 1223.15,
];
const TABLE_COEFFICIENTS: [f64; TABLE_POINTS] = [0.45, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25, 0.25];

/// The rows of one kind, as a table of their own.
macro_rules! rows_of {
    ($kind:ident: $type:ty) => {{
        const NUMBER: usize = {
            let (mut row, mut number) = (0, 0);
            while row < ROWS.len() {
                number += matches!(ROWS[row], ParameterRow::$kind(_)) as usize;
                row += 1;
            }
            number
        };
        const TABLE: Option<[$type; NUMBER]> = {
            let (mut row, mut filled, mut table) = (0, 0, None);
            while row < ROWS.len() {
                if let ParameterRow::$kind(entry) = ROWS[row] {
                    // An array begins as copies of its first entry.
                    let mut entries = match table {
                        Some(entries) => entries,
                        None => [entry; NUMBER],
                    };
                    entries[filled] = entry;
                    filled += 1;
                    table = Some(entries);
                }
                row += 1;
            }
            table
        };
        match &TABLE {
            Some(table) => table,
            None => &[],
        }
    }};
}

/// The real parameters in the order in which they are listed.
pub const REAL_PARAMETERS: &[RealParameter] = rows_of!(Real: RealParameter);

/// The integer parameters in the order in which they are listed.
pub const INTEGER_PARAMETERS: &[IntegerParameter] = rows_of!(Integer: IntegerParameter);

/// The texts in the order in which they are listed.
pub const TEXT_PARAMETERS: &[TextParameter] = rows_of!(Text: TextParameter);

impl Parameters {
    /// Takes the tunable parameters from `source`; the others stay.
    ///
    /// # Errors
    /// [`Error::OutOfRange`]; some may have been taken then.
    pub fn retune(&mut self, source: &Parameters) -> Result<()> {
        for entry in REAL_PARAMETERS.iter().filter(|entry| entry.tunable) {
            let values = (entry.get)(source).iter().zip((entry.get_mut)(self));
            for (element, (value, place)) in values.enumerate() {
                entry.check(element, *value)?;
                *place = *value;
            }
        }
        Ok(())
    }

    /// Parameters with every tunable one at its start value: what a model is built for.
    pub fn fixed_part(&self) -> Parameters {
        let mut fixed = self.clone();
        for entry in REAL_PARAMETERS.iter().filter(|entry| entry.tunable) {
            (entry.get_mut)(&mut fixed).copy_from_slice(entry.start);
        }
        fixed
    }

    /// Chooses a grid of the patch by its name.
    pub fn set_patch_grid(&mut self, grid: PatchGrid) {
        self.patch_nodes = grid.nodes();
        self.patch_strips = grid.strips();
    }

    /// Sets a parameter, or an element of an array, by its name from text, as `--set name=value` on the command line does; a choice by its
    /// number or by its name. [`PATCH_GRID`] sets `patch_nodes` and `patch_strips` to those of a [`PatchGrid`].
    ///
    /// # Errors
    /// [`Error::UnknownParameter`], [`Error::NotANumber`], [`Error::OutOfRange`], [`Error::Text`] or [`Error::UnknownChoice`].
    pub fn set_by_name(&mut self, name: &str, text: &str) -> Result<()> {
        if name == PATCH_GRID {
            self.set_patch_grid(PatchGrid::of(text.trim())?);
            return Ok(());
        }
        for entry in REAL_PARAMETERS {
            let Some(element) = entry.elements.iter().position(|element| *element == name) else {
                continue;
            };
            let value = parse(entry.elements[element], text, "a real number")?;
            entry.check(element, value)?;
            (entry.get_mut)(self)[element] = value;
            return Ok(());
        }
        if let Some(entry) = INTEGER_PARAMETERS.iter().find(|entry| entry.name == name) {
            let names: &[&str] = match entry.kind {
                IntegerKind::Choice(names) => names,
                IntegerKind::Switch => &["off", "on"],
                IntegerKind::Count | IntegerKind::Length => &[],
            };
            let value = match names.iter().position(|name| *name == text.trim()) {
                Some(place) => place as i32 + 1,
                None => parse(entry.name, text, "an integer")?,
            };
            entry.check(value)?;
            (entry.set)(self, value);
            return Ok(());
        }
        if let Some(entry) = TEXT_PARAMETERS.iter().find(|entry| entry.name == name) {
            let text = text.trim();
            entry.check(text)?;
            (entry.set)(self, text.to_owned());
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::error::LONGEST_TEXT;

    #[test]
    fn every_row_has_its_start_values_its_names_and_its_field() {
        for entry in REAL_PARAMETERS {
            let mut parameters = Parameters::default();
            assert_eq!((entry.get)(&parameters), entry.start, "{}", entry.name);
            assert_eq!(entry.elements.len(), entry.start.len(), "{}", entry.name);
            assert_eq!(entry.is_array, entry.elements != [entry.name], "{}", entry.name);
            for element in 0..entry.start.len() {
                (entry.get_mut)(&mut parameters)[element] = entry.maximum;
                assert_eq!((entry.get)(&parameters)[element], entry.maximum, "{}", entry.name);
            }
        }
        for entry in INTEGER_PARAMETERS {
            let mut parameters = Parameters::default();
            assert_eq!((entry.get)(&parameters), entry.start, "{}", entry.name);
            for value in entry.minimum..=entry.maximum {
                (entry.set)(&mut parameters, value);
                assert_eq!((entry.get)(&parameters), value, "{}", entry.name);
            }
        }
        for entry in TEXT_PARAMETERS {
            let mut parameters = Parameters::default();
            assert_eq!((entry.get)(&parameters), entry.start, "{}", entry.name);
            assert_eq!(entry.check(entry.start), Ok(()));
            (entry.set)(&mut parameters, "other".to_owned());
            assert_eq!((entry.get)(&parameters), "other", "{}", entry.name);
        }
    }

    #[test]
    fn grids_are_set_by_name_and_others_refused() {
        let mut parameters = Parameters::default();
        assert_eq!(PatchGrid::NAMES, PatchGrid::ALL.map(PatchGrid::name));
        for grid in PatchGrid::ALL {
            parameters.set_by_name(PATCH_GRID, grid.name()).unwrap();
            assert_eq!(
                (parameters.patch_nodes, parameters.patch_strips),
                (grid.nodes(), grid.strips())
            );
            assert_eq!(parameters.validate(), Ok(()));
        }
        parameters.set_by_name(PATCH_GRID, " default ").unwrap();
        assert_eq!(parameters, Parameters::default());
        let refused = parameters.set_by_name(PATCH_GRID, "34").unwrap_err().to_string();
        assert_eq!(refused, "patch_grid = \"34\": allowed is fast, default or fine");
        assert_eq!(parameters, Parameters::default());
    }

    #[test]
    fn texts_are_set_by_name_and_refused_with_what_is_allowed() {
        let mut parameters = Parameters::default();
        parameters.set_by_name("rail_profile", " worn/räil.prr ").unwrap();
        assert_eq!(parameters.rail_profile, "worn/räil.prr");
        let longest = "a".repeat(LONGEST_TEXT);
        parameters.set_by_name("rail_profile", &longest).unwrap();
        assert_eq!(parameters.validate(), Ok(()));
        for (text, words) in [
            ("", "is blank"),
            (" ", "is blank"),
            ("a\0b", "zero byte behind 1"),
            (&format!("{longest}a"), "too long"),
        ] {
            let refused = parameters.set_by_name("rail_profile", text).unwrap_err().to_string();
            assert!(
                refused.starts_with("rail_profile ") && refused.contains(words),
                "{refused}"
            );
            assert!(
                refused.ends_with("allowed is UTF-8 of 1 to 4096 bytes, none of them zero"),
                "{refused}"
            );
            assert_eq!(parameters.rail_profile, longest);
        }
        let other = Parameters {
            wheel_profile: String::new(),
            ..parameters
        };
        assert!(matches!(
            other.validate(),
            Err(Error::Text {
                name: "wheel_profile",
                ..
            })
        ));
    }

    /// The names of a choice in the way of Rust, `PiecewiseLinear`, in that of FMI: `piecewise_linear`.
    fn lower<T: std::fmt::Debug>(values: &[T]) -> Vec<String> {
        let name = |value: &T| {
            let mut words = String::new();
            for (place, letter) in format!("{value:?}").char_indices() {
                if letter.is_uppercase() && place > 0 {
                    words.push('_');
                }
                words.extend(letter.to_lowercase());
            }
            words
        };
        values.iter().map(name).collect()
    }

    #[test]
    fn every_choice_is_in_the_description_of_its_row() {
        for row in INTEGER_PARAMETERS {
            if let IntegerKind::Choice(names) = row.kind {
                for (number, name) in (1..).zip(names) {
                    let value = format!("{number} {name}");
                    assert!(
                        row.description.contains(&value),
                        "src/parameters/table.rs: the description of {} lacks \"{value}\"",
                        row.name
                    );
                }
            }
        }
    }

    #[test]
    fn choices_have_the_same_names_in_rust_and_in_fmi() {
        assert_eq!(lower(ContactModel::ALL), ContactModel::NAMES);
        assert_eq!(lower(Control::ALL), Control::NAMES);
        assert_eq!(lower(SlipSource::ALL), SlipSource::NAMES);
        assert_eq!(lower(NormalSolver::ALL), NormalSolver::NAMES);
        assert_eq!(lower(MeshKind::ALL), MeshKind::NAMES);
        assert_eq!(lower(FrictionLaw::ALL), FrictionLaw::NAMES);
        assert_eq!(lower(Wheel::ALL), Wheel::NAMES);
        assert_eq!(lower(WheelHeating::ALL), WheelHeating::NAMES);
        assert_eq!(lower(Side::ALL), Side::NAMES);
        assert_eq!(lower(PatchGeometry::ALL), PatchGeometry::NAMES);
        assert_eq!(lower(WearLaw::ALL), WearLaw::NAMES);
        assert_eq!(lower(WheelWearLaw::ALL), WheelWearLaw::NAMES);
        assert_eq!(lower(ProfileWear::ALL), ProfileWear::NAMES);
    }

    #[test]
    fn elements_of_an_array_are_set_by_their_names() {
        let mut parameters = Parameters::default();
        parameters.set_by_name("friction_table.temperature[3]", "600").unwrap();
        assert_eq!(parameters.friction_table_temperature[2], 600.0);
        assert!(parameters.set_by_name("friction_table.temperature", "600").is_err());
        assert!(parameters.set_by_name("friction_table.temperature[11]", "600").is_err());
    }

    #[test]
    fn only_tunable_parameters_are_retuned_and_left_out_of_the_fixed_part() {
        let other = Parameters {
            friction_cold: 0.3,
            wheel_radius: 0.5,
            ..Parameters::default()
        };
        let mut parameters = Parameters::default();
        parameters.retune(&other).unwrap();
        assert_eq!(
            parameters,
            Parameters {
                friction_cold: 0.3,
                ..Parameters::default()
            }
        );
        assert_eq!(parameters.fixed_part(), Parameters::default());
        assert_ne!(other.fixed_part(), Parameters::default());
    }
}
