//! Kalker's coefficients of the patch by small creepages, where nothing slips but at the edge,
//! F_x = G ab C₁₁ ξ, F_y = −G ab (C₂₂ η + √(ab) C₂₃ φ), M_z = G (ab)^{3/2} C₂₃ η − G (ab)² C₃₃ φ, for a/b = 0.5, 1 and 2 at Poisson's ratio ¼,
//! an entry of the table ([`super::kalker`]).
//!
//! C₂₃ comes out twice: as the force by spin and, −C₃₂, as the moment by lateral creepage. C₃₃ is compared on the circle only: away
//! from it it converges slowly, also in CONTACT.

use super::contact_points::{LOAD, SHEAR_MODULUS};
use super::kalker::CreepCoefficients;
use super::patch_cases::{self, Rolling};
use super::row::Row;
use crate::error::Result;
use crate::parameters::Parameters;

const SOURCE: &str = "Kalker 1990, table E.3";
/// Digits of the table: half a unit of the third is 0.2 % and less; the rest is the cells' first order.
const TOLERANCE: f64 = 0.02;
/// Creepage: what slips takes off a share of it over the one of full slip, some 0.01 with μ = 1.
const CREEPAGE: f64 = 1e-5;

fn parameters(ellipse: usize, refinement: usize) -> Parameters {
    Parameters {
        friction_cold: 1.0,
        // λ = G makes Poisson's ratio ¼.
        lame_lambda: SHEAR_MODULUS,
        wheel_lame_lambda: SHEAR_MODULUS,
        ..patch_cases::parameters(ellipse, refinement)
    }
}

/// C₁₁, C₂₂, C₂₃ by spin, −C₃₂ by lateral creepage, and C₃₃.
fn coefficients(rolling: &Rolling) -> Result<[f64; 5]> {
    let axis = patch_cases::mean_axis(rolling.parameters());
    let unit = SHEAR_MODULUS * axis * axis / LOAD;
    let by_slip = rolling.shares([CREEPAGE, 0.0, 0.0])?;
    let by_lateral = rolling.shares([0.0, CREEPAGE, 0.0])?;
    let by_spin = rolling.shares([0.0, 0.0, CREEPAGE / axis])?;
    Ok([by_slip[0], -by_lateral[1], -by_spin[1], by_lateral[2], -by_spin[2]].map(|share| share / (unit * CREEPAGE)))
}

/// The coefficients at the default number of cells and at twice as many each way.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (ellipse, ratio) in [0.5, 1.0, 2.0].into_iter().enumerate() {
        let name = patch_cases::name(ellipse);
        let kalker = CreepCoefficients::of(ratio, 0.25).map_or([f64::NAN; 5], |of| {
            [of.longitudinal, of.lateral, of.lateral_spin, of.lateral_spin, of.spin]
        });
        let coarse = coefficients(&Rolling::new(parameters(ellipse, 1))?)?;
        let fine = coefficients(&Rolling::new(parameters(ellipse, 2))?)?;
        for (index, coefficient) in ["C11", "C22", "C23", "-C32", "C33"].into_iter().enumerate() {
            if coefficient == "C33" && ratio != 1.0 {
                continue;
            }
            let mut row = |cells: &str, computed| {
                let quantity = format!("{coefficient}, {name}, {cells}");
                rows.push(Row::relative(quantity, "1", kalker[index], computed, TOLERANCE, SOURCE));
            };
            row("default cells", coarse[index]);
            row("twice as many each way", fine[index]);
        }
    }
    Ok(rows)
}
