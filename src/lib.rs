//! Thermoelastic rolling contact of a wheel on a rail, with friction that depends on temperature, frictional heat and
//! wear: the library behind the co-simulation unit `WheelRailContact.fmu` for FMI 2.0 and 3.0.
//!
//! The model is that of A. Chudzikiewicz and A. Myśliński, *Thermoelastic wheel–rail contact problem with temperature
//! dependent friction coefficient*, stepped in time. Numbers in parentheses, here and all over the code, are its
//! equations.
//!
//! ```
//! use wheelrail::{Inputs, Parameters, Simulation};
//!
//! let inputs = Inputs { wheel_speed: 40.0, creepage: 0.01, normal_load: 60e3, ..Inputs::default() };
//! let mut simulation = Simulation::new(&Parameters::default(), &inputs)?;
//! let outputs = simulation.hold(&inputs, 1e-3, 10)?;
//! assert!(outputs.peak_temperature > 300.0);
//! # Ok::<(), wheelrail::Error>(())
//! ```
//!
//! [`Simulation`] drives one wheel, by a table of inputs over time or step by step. It is made of a [`Model`], which does not
//! change, a [`State`], which holds all that does, and a [`Workspace`], which is scratch. One model serves any number
//! of wheels with its parameters, on any number of threads: a wheel has its state, a thread its workspace.
//!
//! [`Inputs`], [`Outputs`] and [`Parameters`] are plain structs. [`INPUTS`], [`OUTPUTS`], [`REAL_PARAMETERS`],
//! [`INTEGER_PARAMETERS`] and [`TEXT_PARAMETERS`] list their fields by name, with unit, range and description.
//!
//! # Features
//!
//! `fmi` exports the C functions of FMI, `verification` has the checks against closed forms and published figures, `cli` is the
//! command line and brings both. With `default-features = false` there is the model alone.
//!
//! # The equations
//!
//! Units are SI throughout. x₁ points along the rail in the direction of travel, x₂ upward; the observer moves with the
//! wheel (14). Ω = (−L, L) × (0, h) is the rail, Γ_C its top, Γ₀ the rest of its boundary, clamped.
//!
//! | | equation | what | unit | where |
//! |---|---|---|---|---|
//! | (12), (13) | μ = μ₀ up to θ₀, linear to μ_F at θ_F, μ_F beyond | friction coefficient (the default law) | 1 | `friction` |
//! | (16) | s = ∂u₁/∂t − V ∂u₁/∂x₁ + (ω r₀ − V) | slip velocity of the rail relative to the wheel; the paper drops ∂u₁/∂t | m/s | `mechanics::kinematics`, `mechanics::transient` |
//! | (18), (27) | div σ(u) − ρV² u,₁₁ − α(3λ+2γ) ∇θ = 0 in Ω, u = 0 on Γ₀ | displacement of the rail | N/m³ | `body`, `heat::thermal_map` |
//! | (16) of a patch | s = (V(ξ + φ y), −V(η + φ x)) − V ∂u/∂x + ∂u/∂t | the same across the rail too, with lateral creepage η and spin φ | m/s | `mechanics::kinematics`, `contact::patch::problem` |
//! | (18) of a patch | u = ∫ Boussinesq's and Cerruti's influence · (τ, p) dA | displacement of half-spaces, rail against wheel | m | `body::half_space`, `body::influence` |
//! | (9), (22) | u₂ + g − W ≤ 0, p ≥ 0, p (u₂ + g − W) = 0, g = δ − r₀ + √(r₀² − x₁²) | contact; of a patch g = δ − x²/2r₀ − ½(κ_r + κ_w) y² | m, Pa | `contact::line`, `contact::patch` |
//! | (9) of profiles | f(P + h n) = 0, −g = h from the rail's point P(x, s) along its normal n(s) to the wheel f = 0 | undeformed distance over the rail's arc length s | m | `geometry::unrolled`, `contact::surface` |
//! | load of profiles | Σ ∫ (p cos δ − τ_s sin δ) dA = Q | vertical equilibrium of all contacts, inclined by δ(s) | N | `contact::surface::mechanics` |
//! | (37) | min ½ pᵀC p − (b + δ)ᵀp, p ≥ 0 | the discrete contact problem | scaled | `mechanics::normal`, `mechanics::patch::normal` |
//! | (10), (30) | Coulomb's law, or τ = −μ(θ) p (2/π) arctan(s/ε) | friction; of a patch with vectors | Pa | `friction::coulomb`, `mechanics::tangential`, `mechanics::patch` |
//! | (31) | (37) for given τ ↔ (30) for given p | mechanics for given temperature and wear | | `mechanics::normal_tangential` |
//! | (19) | ∂θ/∂t − V ∂θ/∂x₁ = κ ∂²θ/∂x₂² in Ω | temperature rise of the rail; of a patch in each strip | K/s | `heat::march`, `heat::strips` |
//! | (23) | κ ρ c_p ∂θ/∂n = ᾱ (\|τ s\| − k ρ c_p θ \|s\| p − (θ − θ_w) p / r) on Γ_C | friction power, heat carried off by debris, conduction into the wheel at θ_w | W/m² | `heat::march` |
//! | (11), (24) | ∂W/∂t − V ∂W/∂x₁ = k \|s\| p | Archard wear | m/s | `wear` |
//!
//! Where the paper is silent or wrong as printed, the code differs from it: wear W ≥ 0 is positive; the bracket of (23) is
//! closed such that conduction cools a hot rail; the local slip speed \|s\| stands where (23) and (24) print V; (30) has the
//! factor 2/π; (13) ends at μ_F; heat has no condition on the outflow side. The u₁ of (9) is dropped: some µm against a
//! contact of some mm. And the default wheel is elastic, of the rail's material, where the paper's is rigid ([`Wheel`]): on an
//! elastic rail a rigid wheel pulls at creepage 0.
//!
//! # Signs
//!
//! | quantity | positive |
//! |---|---|
//! | position x₁ | ahead of the axle, in the direction of travel: the leading edge for V > 0 |
//! | pressure p | compression |
//! | shear traction τ | on the rail along x₁ |
//! | traction force T = −b ∫ τ dx₁ | on the wheel along x₁: drives the vehicle |
//! | friction torque −(T r₀ + N e) | about the axle in the sense of ω for travel along +x₁ |
//! | offset e of the pressure's resultant | ahead of the axle |
//! | creepage ξ = (ω r₀ − V)/V | the wheel turns faster than it rolls |
//! | lateral force F_y = −∫ τ_y dA | on the wheel, to the left (y, with z upward) |
//! | spin moment M_z = −∫ (x τ_y − y τ_x) dA | on the wheel about the upward normal |
//! | lateral creepage η = v_y/V | the wheel moves to the left |
//! | spin creepage φ = ω_z/V | the wheel turns anticlockwise seen from above |
//! | slip velocity s | of the rail's surface relative to the wheel's, as V and ω r₀ count |
//! | penetration δ | into the rail; of profiles the way by which the wheel is lower than where it touches first |
//! | force, moment of profiles | on the wheelset about its centre: x forward, y to the left, z upward |
//! | arc length s of a rail's profile | from the gauge face to the field side |
//! | inclination of a contact | towards the gauge face: its normal force pushes the wheel to the track's middle |
//! | displacement u₂ | upward: the thermal bulge closes the gap |
//! | wear depth W | material lost: opens the gap |
//! | heat flux | into the rail |
//!
//! # Reading order
//!
//! 1. `parameters` and `signals`: every quantity that goes in and out, with unit, default, range and source. `settings`: limits and
//!    tolerances of the methods, each with its reason.
//! 2. `geometry`: undeformed surfaces; `geometry::profile`, wheels and rails as they are ([`Profile`]), and `geometry::wheelset`
//!    ([`contact_geometry`]), where they touch. `body`: compliance of rail and wheel, the near field in closed form and the rest by finite elements. What is computed once;
//!    after it, no sparse system is solved.
//! 3. `friction`: the laws of μ(θ), and Coulomb's law. `mechanics`: tractions for given temperature and wear.
//! 4. `transport`, `heat`, `wear`: temperature and wear of the rail for given tractions; `heat::incoming`: the rail that the
//!    wheel ahead has left. `damage`: what fatigue and heat do beside wear.
//! 5. `contact`: one implicit step. `contact::engine` says what a contact offers to it, `contact::interface` what passes between
//!    mechanics and heat; `contact::step` iterates on that vector, `contact::newton` where this does not converge, and
//!    `contact::sensitivity` is the derivative. `contact::line` is the paper's contact; `contact::patch` resolves the contact across
//!    the rail as well: read `body::half_space` and `body::influence` for its displacements, `mechanics::patch` for its tractions,
//!    `transport::strips` and `heat::strips` for what its strips carry along. `contact::surface` is the contact of profiles: patches on the
//!    unrolled surface of the rail, in windows that follow the contacts, and the height of the wheel that carries the load. `contact::rim` is the wheel's temperature and wear,
//!    `contact::integrals` and `contact::outputs` are the results.
//! 6. `wheel_rail`: the stepped model. `simulation`: a wheel's way through time.
//! 7. `verification`: the closed forms and published numbers that all this is held against.
//!    `torture`: random parameters and drives, which no step may fail.
//! 8. `fmi`: the same model as a co-simulation unit; `fmi2` and `fmi3`: the C functions and the description of a version of
//!    FMI. Nothing above knows of FMI.
//!
//! `numerics` holds methods that know nothing of contact, `error` what can go wrong.

mod body;
mod contact;
mod damage;
pub mod error;
#[cfg(feature = "fmi")]
pub mod fmi;
#[cfg(feature = "fmi")]
pub mod fmi2;
#[cfg(feature = "fmi")]
pub mod fmi3;
mod friction;
mod geometry;
mod heat;
mod mechanics;
mod numerics;
pub mod parameters;
pub mod settings;
pub mod signals;
pub mod simulation;
#[cfg(feature = "verification")]
pub mod torture;
mod transport;
#[cfg(feature = "verification")]
pub mod verification;
mod wear;
pub mod wheel_rail;

pub use error::{Error, ProfileError};
pub use geometry::profile::built_in as built_in_profiles;
pub use geometry::profile::files as profile_files;
pub use geometry::profile::{Body, CurvePoint, HeightFunction, Profile, WheelMeasures, WheelWear};
pub use geometry::wheelset as contact_geometry;
pub use parameters::{
    ContactModel, Control, FrictionLaw, INTEGER_PARAMETERS, MeshKind, NormalSolver, Parameters, PatchGeometry,
    ProfileContents, REAL_PARAMETERS, Side, SlipSource, TEXT_PARAMETERS, Wheel, WheelHeating,
};
pub use settings::Settings;
pub use signals::{ContactOutputs, INPUTS, Inputs, OUTPUTS, Outputs};
pub use simulation::Simulation;
pub use wheel_rail::{Interrupted, Model, Profiles, State, Workspace};

/// README's lines of Rust are compiled and run as a documentation test.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
