//! The power of friction of profiles against that of force and moment on the wheelset.
//!
//! In steady rolling friction dissipates what the resultants take out of the wheelset's motion,
//! ∫ |τ·s| dA = −(F·v + M·ω),
//! v that of the middle of the axle and ω the turning about the axle and by the yaw rate: friction acts on the same surface of the wheel that the slip
//! is taken on, and does no work on the elastic bodies. This holds exactly for continuous fields, to the size of the cells for discrete ones. The
//! wheelset keeps its height and its place across the track, so that vertical and lateral forces have no power. It turns or is yawed, not both: the
//! contact of a yawed wheel lies ahead of the axle or behind it, and a yaw rate moves it along its normal, where pressure has power as well.

use super::row::{Row, larger};
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters, SlipSource};
use crate::signals::Inputs;
use crate::wheel_rail::Model;

/// V, `m/s`.
const SPEED: f64 = 20.0;
/// Vertical load, `N`.
const LOAD: f64 = 60e3;
/// Lateral displacement, `m`: on the tread, beside it, there and in the gauge corner, in the gauge corner alone, on the flange.
const PLACES: [f64; 5] = [0.0, 4e-3, 5.4e-3, 6.6e-3, 7.5e-3];
/// Yaw, rad, yaw rate, rad/s, and excess of the circumference's speed: driving, braking, turning to either side, yawed.
const MOTIONS: [[f64; 3]; 5] = [
    [0.0, 0.0, 2.5e-3],
    [0.0, 0.0, -0.01],
    [0.0, 0.1, 2.5e-3],
    [0.0, -0.1, 5e-3],
    [3e-3, 0.0, 5e-3],
];
/// Tolerance of the same balance of the patch.
const DEFECT: f64 = 0.008;

/// The largest relative defect over all places and motions.
fn largest_defect(refinement: usize) -> Result<f64> {
    let default = Parameters::default();
    let model = set_up::model(Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        patch_nodes: refinement * default.patch_nodes,
        patch_strips: (refinement * default.patch_strips) | 1,
        ..set_up::mechanics_alone()
    })?;
    let mut largest = 0.0;
    for lateral in PLACES {
        for motion in MOTIONS {
            largest = larger(largest, defect(&model, lateral, motion)?.abs());
        }
    }
    Ok(largest)
}

/// Relative defect of a state.
fn defect(model: &Model, lateral: f64, [yaw, yaw_rate, excess]: [f64; 3]) -> Result<f64> {
    let inputs = Inputs {
        normal_load: LOAD,
        vehicle_speed: SPEED,
        wheel_speed: SPEED * (1.0 + excess) / model.parameters().wheel_radius,
        lateral_displacement: lateral,
        yaw_angle: yaw,
        yaw_rate,
        ..Inputs::default()
    };
    let outputs = model.initial_state(&mut model.workspace(), &inputs)?.outputs;
    let supplied =
        -(outputs.force_x * SPEED + outputs.friction_torque * inputs.wheel_speed + outputs.moment_z * inputs.yaw_rate);
    Ok(outputs.friction_power / supplied - 1.0)
}

/// Rows of the check.
///
/// # Errors
/// A solver that did not converge.
pub fn rows() -> Result<Vec<Row>> {
    let (coarse, fine) = (largest_defect(1)?, largest_defect(2)?);
    Ok(vec![
        Row::absolute(
            "largest defect of friction power over the wheelset's power, default cells",
            "1",
            0.0,
            coarse,
            DEFECT,
            "-(F v + M omega)",
        ),
        Row::at_least(
            "its order in the size of the cells, to twice as many each way",
            "1",
            1.8,
            (coarse / fine).log2(),
            "order of the scheme, 2",
        ),
    ])
}
