//! An elastic layer between wheel and rail. Where it is far more compliant than the bodies it is a bed of bristles: under the creepage ξ
//! the shear grows from the leading edge as τ = ξ (a − x)/c, c the compliance, up to μp. With Hertz's pressure and k = ξ a/(c μ p₀) the
//! contact sticks ahead of x_s = a (k² − 1)/(k² + 1), on every strip of an ellipse at the same share of its length, and
//!
//! T/(μN) = (k (1 − σ)² + σ √(1 − σ²) + arcsin σ + ½π)/π,  σ = x_s/a.
//!
//! For any layer the slopes of the creep curve at creepage 0 add up as flexibilities do, 1/K = 1/K₀ + 1/K_c with K_c that of the bristles,
//! by Kalker's simplified theory: approximately, for the distributions of the shear differ.

use super::row::Row;
use super::set_up::{self, mechanics_alone};
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters};
use crate::signals::Inputs;
use std::f64::consts::{FRAC_PI_2, PI};

/// c over the compliance of the bodies is some 100.
const BRISTLES: f64 = 4e-12;
/// The layer of CONTACT's user guide, 1.25 mm of 8.2 GPa.
const LAYER: f64 = 1.25e-3 / 8.2e9;
/// Creepages from nearly all stick to nearly all slip.
const CREEPAGES: [f64; 5] = [0.01, 0.05, 0.1, 0.2, 0.4];
/// Tolerance: what the bodies add, 1 % of the layer's displacement, and the cell at the leading edge.
const TOLERANCE: f64 = 0.006;
/// Tolerance of the slopes: what the rule itself is good for.
const SLOPE_TOLERANCE: f64 = 0.05;
/// A creepage at which nearly all sticks.
const SMALL: f64 = 1e-5;

fn parameters(contact_model: ContactModel, layer_compliance: f64) -> Parameters {
    Parameters {
        contact_model,
        layer_compliance,
        ..mechanics_alone()
    }
}

/// Steady rolling: T/(μN), and ξ a/(μ p₀).
fn rolling(parameters: &Parameters, creepage: f64) -> Result<(f64, f64)> {
    let inputs = Inputs {
        creepage,
        ..Inputs::default()
    };
    let run = set_up::simulation(parameters, &inputs)?;
    let (half_length, pressure) = match parameters.contact_model {
        ContactModel::Line => (
            parameters.hertz_half_length(inputs.normal_load),
            parameters.hertz_peak_pressure(inputs.normal_load),
        ),
        ContactModel::Patch | ContactModel::Profiles => {
            let ellipse = parameters.hertz_ellipse(inputs.normal_load);
            (ellipse.along, ellipse.peak_pressure)
        }
    };
    let stretch = creepage * half_length / (parameters.friction_cold * pressure);
    Ok((run.outputs().traction_coefficient / parameters.friction_cold, stretch))
}

/// T/(μN) of the bristles at k.
fn bristles(k: f64) -> f64 {
    let end = (k * k - 1.0) / (k * k + 1.0);
    let slides = end * (1.0 - end * end).sqrt() + end.asin() + FRAC_PI_2;
    (k * (1.0 - end).powi(2) + slides) / PI
}

/// The bristles' creep curve and the slopes of both engines.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (contact_model, name) in [(ContactModel::Line, "line"), (ContactModel::Patch, "patch")] {
        let soft = parameters(contact_model, BRISTLES);
        for creepage in CREEPAGES {
            let (computed, stretch) = rolling(&soft, creepage)?;
            rows.push(Row::absolute(
                format!("{name}: T/(mu N) on a layer of 4e-12 m/Pa at creepage {creepage}"),
                "1",
                bristles(stretch / BRISTLES),
                computed,
                TOLERANCE,
                "bed of bristles, Johnson, Contact Mechanics, 8.6",
            ));
        }
        let (without, stretch) = rolling(&parameters(contact_model, 0.0), SMALL)?;
        let (with, _) = rolling(&parameters(contact_model, LAYER), SMALL)?;
        let flexibilities = 1.0 / without + 1.0 / bristles(stretch / LAYER);
        rows.push(Row::relative(
            format!("{name}: T/(mu N xi) at creepage 0 with a layer of 1.25 mm and 8.2 GPa"),
            "1",
            1.0 / (flexibilities * SMALL),
            with / SMALL,
            SLOPE_TOLERANCE,
            "sum of flexibilities",
        ));
    }
    Ok(rows)
}
