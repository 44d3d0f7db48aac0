//! The patch in full slip, and the power of friction.
//!
//! In full slip every cell is at Coulomb's bound and none sticks. Under ξ and η alone the forces stand against the slip, F = μN (ξ, −η)/√(ξ² + η²)
//! less what the elastic slip turns aside; under spin alone on the circle the moment is −μ ∫ p r dA = −(3π/16) μ N a.
//!
//! In steady rolling of like bodies friction dissipates what the creep forces supply,
//! ∫ |τ·s| dA = V (F_x ξ − F_y η − M_z φ),
//! because the tractions do no work on the elastic bodies: exactly for continuous fields, to the size of the cells for discrete ones.

use super::patch_cases::{self, Rolling, SPEED};
use super::row::{Row, larger};
use crate::error::Result;
use std::f64::consts::PI;

const CIRCLE: usize = 1;
/// The elastic slip is some 0.3 % of V, against a slip of this share of it.
const FULL_SLIP: f64 = 0.5;
/// Large spin on the ellipse that is long along the rail has the largest: 0.6 %; without spin it is below 0.1 %.
const DEFECT: f64 = 0.008;
/// Creepages at which the power is balanced: ξ, η, φ √(ab), in partial slip and in full slip.
const CREEPAGES: [[f64; 3]; 6] = [
    [0.0005, 0.0, 0.0],
    [0.001, 0.0, 0.0],
    [0.0, 0.001, 0.0],
    [0.0, 0.0, 0.002],
    [0.001, 0.0005, 0.0008],
    [0.01, 0.0, 0.0],
];

/// Rows of all powers.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = full_slip()?;
    for ellipse in 0..3 {
        let [coarse, fine] = [1, 2].map(|refinement| largest_defect(ellipse, refinement));
        let (coarse, fine) = (coarse?, fine?);
        let name = patch_cases::name(ellipse);
        rows.push(Row::absolute(
            format!("largest defect of friction power over creep power, {name}, default cells"),
            "1",
            0.0,
            coarse,
            DEFECT,
            "V (F_x xi - F_y eta - M_z phi)",
        ));
        rows.push(Row::at_least(
            format!("its order in the size of the cells, {name}, to twice as many each way"),
            "1",
            1.8,
            (coarse / fine).log2(),
            "order of the scheme, 2",
        ));
    }
    Ok(rows)
}

/// Forces, moment and adhesion in full slip.
fn full_slip() -> Result<Vec<Row>> {
    let rolling = Rolling::new(patch_cases::parameters(CIRCLE, 1))?;
    let axis = patch_cases::mean_axis(rolling.parameters());
    let mut rows = Vec::new();
    let mut row = |quantity: String, reference, computed, tolerance| {
        rows.push(Row::absolute(
            quantity,
            "1",
            reference,
            computed,
            tolerance,
            "Coulomb's law",
        ));
    };
    for direction in [0.0_f64, 0.25, 0.5] {
        let (sine, cosine) = (PI * direction).sin_cos();
        let creepages = [FULL_SLIP * cosine, FULL_SLIP * sine, 0.0];
        let shares = rolling.shares(creepages)?;
        let at = format!("full slip at {} degrees to the left of the rail", 180.0 * direction);
        row(format!("F_x/(mu N), {at}"), cosine, shares[0], 1e-3);
        row(format!("F_y/(mu N), {at}"), -sine, shares[1], 1e-3);
        row(
            format!("adhesion share, {at}"),
            0.0,
            rolling.outputs(creepages)?.stick_fraction,
            0.0,
        );
    }
    let spin = rolling.shares([0.0, 0.0, 4.0 * FULL_SLIP / axis])?;
    row(
        "M_z/(mu N a) under spin alone, full slip".into(),
        -3.0 * PI / 16.0,
        spin[2],
        2e-3,
    );
    Ok(rows)
}

/// The largest relative defect over all creepages.
fn largest_defect(ellipse: usize, refinement: usize) -> Result<f64> {
    let rolling = Rolling::new(patch_cases::parameters(ellipse, refinement))?;
    let axis = patch_cases::mean_axis(rolling.parameters());
    let mut largest = 0.0;
    for [longitudinal, lateral, spin] in CREEPAGES {
        let outputs = rolling.outputs([longitudinal, lateral, spin / axis])?;
        let supplied = SPEED
            * (outputs.traction_force * longitudinal
                - outputs.lateral_force * lateral
                - outputs.spin_moment * spin / axis);
        largest = larger(largest, (outputs.friction_power / supplied - 1.0).abs());
    }
    Ok(largest)
}
