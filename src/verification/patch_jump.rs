//! The creepage of a rolling patch jumps from 0, along the rail or across it: in steps of any length its force goes the way that it
//! goes in short steps, because the step of ∂u/∂t is fitted to the exponential by which rolling forgets a change
//! ([`super::creepage_jump`] for the line). Like bodies, constant μ; few cells, to be quick: on the default
//! ones the errors are of the same size.

use super::contact_points::{ELLIPSES, FRICTION, LOAD, SHEAR_MODULUS};
use super::patch_cases::{self, SPEED};
use super::row::{Row, larger};
use super::set_up;
use crate::error::Result;
use crate::parameters::Parameters;
use crate::simulation::Simulation;
use crate::wheel_rail::Model;
use std::sync::Arc;

const SOURCE: &str = "the same in steps of a fortieth of the half-length";
/// Cells along the rail and strips across it.
const CELLS: (usize, usize) = (25, 13);
/// Half-lengths that the contact rolls after the jump: little of the change is then left.
const WAY: usize = 4;
/// Steps a half-length of the reference: of twice as many it differs by less than 0.002.
const FINE: usize = 40;
/// Kalker's coefficients are about 4 (C₁₁ and C₂₂ of these ellipses).
const STIFFNESS: f64 = 4.0;
/// Creepages to which it jumps, over μN/(G a b C): full slip is at some 3.
const JUMPS: [f64; 3] = [0.1, 1.0, 3.0];
/// Steps in an interval, intervals in all, and tolerance: as measured, rounded up. Worst in steps of one half-length, which end where the
/// force still changes most. A relaxation length that is off by a quarter, either way, fails.
const STEPS: [(usize, usize, f64); 5] = [(10, 4, 0.008), (2, 4, 0.02), (1, 4, 0.03), (1, 2, 0.015), (1, 1, 0.006)];
/// Names of ξ and η.
const DIRECTIONS: [&str; 2] = ["along", "across"];

/// A patch on which the creepage jumps.
struct Jump {
    model: Arc<Model>,
    creepages: [f64; 3],
    direction: usize,
}

impl Jump {
    /// Force over μN at the end of each of `intervals`, one of which is `way` half-lengths in so many steps.
    fn transient(&self, way: f64, steps: usize, intervals: usize) -> Result<Vec<f64>> {
        let parameters = self.model.parameters();
        let mut run = Simulation::of(self.model.clone(), &patch_cases::inputs(parameters, [0.0; 3]))?;
        let inputs = patch_cases::inputs(parameters, self.creepages);
        let step = way * parameters.hertz_ellipse(LOAD).along / SPEED / steps as f64;
        (0..intervals)
            .map(|_| {
                let outputs = run.hold(&inputs, step, steps)?;
                let force = [outputs.traction_force, outputs.lateral_force][self.direction];
                Ok(force.abs() / (parameters.friction_cold * LOAD))
            })
            .collect()
    }
}

/// The jumps on every ellipse, along and across.
fn jumps(direction: usize) -> Result<Vec<Jump>> {
    let mut jumps = Vec::new();
    for ellipse in 0..ELLIPSES.len() {
        let parameters = Parameters {
            patch_nodes: CELLS.0,
            patch_strips: CELLS.1,
            ..patch_cases::parameters(ellipse, 1)
        };
        let axis = patch_cases::mean_axis(&parameters);
        let unit = FRICTION * LOAD / (SHEAR_MODULUS * axis * axis * STIFFNESS);
        let model = Arc::new(set_up::model(parameters)?);
        jumps.extend(JUMPS.map(|jump| {
            let mut creepages = [0.0; 3];
            creepages[direction] = jump * unit;
            Jump {
                model: model.clone(),
                creepages,
                direction,
            }
        }));
    }
    Ok(jumps)
}

/// Steps from a tenth of the half-length up to four.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for (direction, name) in DIRECTIONS.into_iter().enumerate() {
        let mut worst = [0.0_f64; STEPS.len()];
        for jump in jumps(direction)? {
            let reference = jump.transient(1.0, FINE, WAY)?;
            for ((steps, intervals, _), worst) in STEPS.into_iter().zip(&mut worst) {
                let way = WAY / intervals;
                let values = jump.transient(way as f64, steps, intervals)?;
                for (value, reference) in values.iter().zip(reference.iter().skip(way - 1).step_by(way)) {
                    *worst = larger(*worst, (value - reference).abs());
                }
            }
        }
        for ((steps, intervals, tolerance), worst) in STEPS.into_iter().zip(worst) {
            let way = (WAY / intervals) as f64 / steps as f64;
            rows.push(Row::absolute(
                format!("largest error of the force over mu N after jumps of the creepage {name}, steps of {way} half-lengths"),
                "1",
                0.0,
                worst,
                tolerance,
                SOURCE,
            ));
        }
    }
    Ok(rows)
}
