//! Laws of wear in full slip on a straight, constant friction: the volume that they wear off per time in closed form.
//!
//! Every point slides at τ = μp, the pressure is Hertz's, p₀ √(1 − t²) over |t| = |x|/a < 1, and like bodies slip at s = V (ξ − μ x/r₀) by the shear's own
//! strain: of the mean V ξ, with a part that is odd in x.
//!
//! - Where K of the map is k₂ throughout, Ẇ = k₂ P/(μ H), P the friction power, to round-off; where wear is catastrophic for p > p_c as well,
//!   with t_c = √(1 − (p_c/p₀)²),  Ẇ = V ξ N/H (k₂ + (k₄ − k₂) (2/π) (t_c √(1 − t_c²) + arcsin t_c)).
//! - Where the energy's law is mild throughout, Ẇ = a P/ρ, in stick and slip, to round-off; where it is severe for x > R/a as well, with X = μ p₀ ξ and
//!   t_s = √(1 − (R/(a X))²),  Ẇ = 2 a_H b V/ρ (R t_s + a X (π/2 − arcsin t_s − t_s √(1 − t_s²))/2), a_H Hertz's half-length; the odd part of the slip adds
//!   (μ a_H/(r₀ ξ))² of it.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters, WearLaw};
use crate::signals::{Inputs, Outputs};
use std::f64::consts::{FRAC_2_PI, FRAC_PI_2};

const SOURCE: &str = "law of wear integrated over Hertz's pressure in full slip";
const FRICTION: f64 = 0.3;
const LOAD: f64 = 50e3;
/// Sum over nodes of an integrand with a corner or a jump between two of them, and what the odd part of the slip adds.
const MESH: f64 = 1e-3;
/// Share of the wear of rail steel: so little that the pressure stays Hertz's.
const LITTLE: f64 = 1e-3;
/// Sums of some hundred terms.
const ROUND_OFF: f64 = 1e-12;
/// The patch reaches τ = μp against the slip to the tolerance of its solver, of which the power has the square.
const SOLVER: f64 = 1e-9;

fn parameters(wear_law: WearLaw) -> Parameters {
    let steel = Parameters::default();
    Parameters {
        wear_law,
        wear_map_mild: LITTLE * steel.wear_map_mild,
        wear_map_severe: LITTLE * steel.wear_map_severe,
        wear_map_fast: LITTLE * steel.wear_map_fast,
        wear_map_catastrophic: LITTLE * steel.wear_map_catastrophic,
        wear_energy_mild: LITTLE * steel.wear_energy_mild,
        wear_energy_severe: LITTLE * steel.wear_energy_severe,
        wear_energy_catastrophic: LITTLE * steel.wear_energy_catastrophic,
        // Next to none, so that the closed form is that of a law with steps.
        wear_blend: 1e-3,
        friction_cold: FRICTION,
        contact_nodes: 201,
        largest_load: LOAD,
        ..set_up::mechanics_alone()
    }
}

/// Outputs and speed of rolling at a creepage.
fn roll(parameters: &Parameters, creepage: f64) -> Result<(Outputs, f64)> {
    let inputs = Inputs {
        normal_load: LOAD,
        creepage,
        ..Inputs::default()
    };
    let mut run = set_up::simulation(parameters, &inputs)?;
    // Until the transient of the first slip has passed through the contact.
    for _ in 0..20 {
        run.step(&inputs, 1e-3)?;
    }
    Ok((run.state.outputs, inputs.motion(parameters).rolling_speed))
}

/// A patch with the same parameters.
fn patch(parameters: Parameters) -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        ..parameters
    }
}

fn map() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let parameters = parameters(WearLaw::ArchardMap);
    for (quantity, parameters, tolerance) in [
        ("line: severe wear by the map", parameters.clone(), ROUND_OFF),
        ("patch: severe wear by the map", patch(parameters.clone()), SOLVER),
    ] {
        let (outputs, _) = roll(&parameters, 0.035)?;
        let closed = parameters.wear_map_severe * outputs.friction_power / (FRICTION * parameters.hardness);
        rows.push(Row::relative(
            quantity,
            "m3/s",
            closed,
            outputs.wear_rate,
            tolerance,
            SOURCE,
        ));
    }
    // Catastrophic in some 60 % of the contact.
    let peak = parameters.hertz_peak_pressure(LOAD);
    let soft = Parameters {
        hardness: peak,
        ..parameters
    };
    let (outputs, speed) = roll(&soft, 0.035)?;
    let share = soft.wear_map_pressure;
    let end = (1.0 - share * share).sqrt();
    let catastrophic = FRAC_2_PI * (end * share + end.asin());
    let mean = soft.wear_map_severe + (soft.wear_map_catastrophic - soft.wear_map_severe) * catastrophic;
    rows.push(Row::relative(
        "line: severe and catastrophic wear by the map",
        "m3/s",
        speed * 0.035 * LOAD / soft.hardness * mean,
        outputs.wear_rate,
        MESH,
        SOURCE,
    ));
    Ok(rows)
}

fn energy() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    let parameters = parameters(WearLaw::Energy);
    for (quantity, parameters, creepage) in [
        (
            "line: mild wear by the energy, stick and slip",
            parameters.clone(),
            2e-3,
        ),
        ("line: mild wear by the energy, full slip", parameters.clone(), 0.01),
        (
            "patch: mild wear by the energy, stick and slip",
            patch(parameters.clone()),
            2e-3,
        ),
    ] {
        let (outputs, _) = roll(&parameters, creepage)?;
        let closed = parameters.wear_energy_mild * outputs.friction_power / parameters.density;
        rows.push(Row::relative(
            quantity,
            "m3/s",
            closed,
            outputs.wear_rate,
            ROUND_OFF,
            SOURCE,
        ));
    }
    let creepage = 0.2;
    let (outputs, speed) = roll(&parameters, creepage)?;
    let (mild, severe) = (parameters.wear_energy_mild, parameters.wear_energy_severe);
    let work = FRICTION * parameters.hertz_peak_pressure(LOAD) * creepage;
    let share = severe / (mild * work);
    let end = (1.0 - share * share).sqrt();
    let beside = 0.5 * (FRAC_PI_2 - end.asin() - end * share);
    let area = 2.0 * parameters.hertz_half_length(LOAD) * parameters.contact_width;
    rows.push(Row::relative(
        "line: mild and severe wear by the energy",
        "m3/s",
        area * speed / parameters.density * (severe * end + mild * work * beside),
        outputs.wear_rate,
        MESH,
        SOURCE,
    ));
    Ok(rows)
}

/// Volumes worn per time.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = map()?;
    rows.extend(energy()?);
    Ok(rows)
}
