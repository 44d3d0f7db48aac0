//! Wear of profiles: what a wheel that slides loses over its turns, against Archard's law in closed form; that nothing is lost between the contact and
//! the cells of the profiles; that accelerated wear is that of more turns, and that finer grids wear the same.
//!
//! A wheel slides in full where it turns faster than it rolls by more than friction can carry. All points of the contact then slide at nearly the
//! speed s of the rigid bodies at its centre, and with the normal force N the cross-section of the wheel has lost, after n turns in the time t,
//!
//! A = k_w N s t/(2π r),  t = 2π n/ω,
//!
//! with the rolling radius r. What is left is the change of the radius over the contact, the spin by its inclination, and the rate of the
//! elastic displacement.

use super::row::Row;
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters, ProfileWear, SlipSource};
use crate::signals::{Inputs, Outputs};
use crate::simulation::Simulation;
use crate::wheel_rail::WornPlace;
use std::f64::consts::TAU;

const CLOSED: &str = "closed form";
const IDENTITY: &str = "identity";
/// k_w, 1/Pa.
const COEFFICIENT: f64 = 1e-12;
/// V, `m/s`.
const SPEED: f64 = 20.0;
/// Length of rail over which its wear is spread, `m`.
const LENGTH: f64 = 3.0;
/// Time step, `s`.
const STEP: f64 = 1e-3;

/// A cone of 1:40 on a rail's crown, which wears a wheel alone.
fn cone() -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        wheel_profile: "cone40".to_owned(),
        strip_half_length: 0.5,
        depth_nodes: 9,
        wheel_profile_wear: ProfileWear::On,
        wheel_wear_coefficient: COEFFICIENT,
        ..set_up::mechanics_alone()
    }
}

/// S1002 on 60E1, both of which wear, on a coarse grid.
fn both() -> Parameters {
    Parameters {
        wheel_profile: "S1002".to_owned(),
        patch_nodes: 14,
        patch_strips: 11,
        rail_profile_wear: ProfileWear::On,
        rail_wear_length: LENGTH,
        wear_coefficient: COEFFICIENT,
        ..cone()
    }
}

/// A wheelset that turns by a share faster than it rolls, displaced to the left and yawed.
fn sliding(excess: f64, lateral: f64, yaw: f64) -> Inputs {
    Inputs {
        normal_load: 60e3,
        vehicle_speed: SPEED,
        wheel_speed: SPEED * (1.0 + excess) / Parameters::default().wheel_radius,
        lateral_displacement: lateral,
        yaw_angle: yaw,
        ..Inputs::default()
    }
}

fn worn(parameters: &Parameters, inputs: &Inputs, steps: usize) -> Result<Simulation> {
    let mut run = set_up::simulation(parameters, inputs)?;
    run.hold(inputs, STEP, steps)?;
    Ok(run)
}

/// Integral of the depth over the arc length, `m²`.
fn area(places: &[WornPlace]) -> f64 {
    match places {
        [first, second, ..] => {
            (second.arc_length - first.arc_length) * places.iter().map(|place| place.depth).sum::<f64>()
        }
        _ => 0.0,
    }
}

/// Rows of the check.
///
/// # Errors
/// Those of a step.
pub fn rows() -> Result<Vec<Row>> {
    let mut rows = Vec::new();
    for excess in [0.02, -0.1] {
        rows.push(full_slip(excess)?);
    }
    rows.extend(nothing_is_lost()?);
    rows.push(accelerated()?);
    rows.extend(finer()?);
    Ok(rows)
}

/// Area worn off a wheel that slides. What is left of the closed form is 0.1 % of a contact 14 mm broad, and the first step, whose surfaces come to move.
fn full_slip(excess: f64) -> Result<Row> {
    let (inputs, turns) = (sliding(excess, 0.0, 0.0), 2.0);
    let steps = (turns * TAU / (inputs.wheel_speed * STEP)).round();
    let run = worn(&cone(), &inputs, steps as usize)?;
    let outputs = run.outputs();
    let contact = &outputs.contact[0];
    let slip = contact.longitudinal_creepage.abs() * SPEED;
    let radius = Parameters::default().wheel_radius - contact.wheel_position / 40.0;
    let expected = COEFFICIENT * outputs.normal_force * slip * steps * STEP / (TAU * radius);
    Ok(Row::relative(
        format!("area that {turns} turns wear off a wheel that slides, creepage {excess}"),
        "m2",
        expected,
        area(&run.profile_wear()?.wheel),
        5e-3,
        CLOSED,
    ))
}

/// Round-off of a sum over some thousand numbers.
fn nothing_is_lost() -> Result<[Row; 3]> {
    let run = worn(&both(), &sliding(5e-3, 6.6e-3, 0.01), 20)?;
    let (outputs, wear) = (run.outputs(), run.profile_wear()?);
    let row = |what: &str, expected, found| {
        Row::relative(
            format!("area of the {what} on the flange"),
            "m2",
            expected,
            found,
            1e-10,
            IDENTITY,
        )
    };
    Ok([
        row("wheel's depth", outputs.wheel_worn_area, area(&wear.wheel)),
        row("rail's depth", outputs.rail_worn_area, area(&wear.rail)),
        row(
            "rail, worn volume over its length",
            outputs.worn_volume / LENGTH,
            outputs.rail_worn_area,
        ),
    ])
}

/// The contact changes with the depth, of some tens of micrometres; in twelve steps it follows by a twelfth at a time.
fn accelerated() -> Result<Row> {
    let area = |acceleration: f64, steps: usize| -> Result<f64> {
        let parameters = Parameters {
            wear_acceleration: 180.0 * acceleration,
            ..both()
        };
        let run = worn(&parameters, &sliding(5e-3, 2e-3, 2e-3), steps)?;
        Ok(run.outputs().wheel_worn_area)
    };
    Ok(Row::relative(
        "area worn off a wheel's tread, acceleration 100 and a hundredth of the steps",
        "m2",
        area(1.0, 1200)?,
        area(100.0, 12)?,
        0.01,
        IDENTITY,
    ))
}

/// The area is that of the mechanics, the flange's thickness that of where it lies.
fn finer() -> Result<Vec<Row>> {
    let of = |patch_strips: usize, profile_wear_points: usize| -> Result<Outputs> {
        let parameters = Parameters {
            patch_strips,
            profile_wear_points,
            wear_acceleration: 500.0,
            ..both()
        };
        Ok(*worn(&parameters, &sliding(5e-3, 6.6e-3, 0.015), 60)?.outputs())
    };
    let coarse = of(11, 750)?;
    let mut rows = Vec::new();
    for (what, strips, points) in [("strips", 22, 750), ("cells of the profile", 11, 1500)] {
        let fine = of(strips, points)?;
        rows.push(Row::relative(
            format!("area worn off a wheel's flange, twice the {what}"),
            "m2",
            coarse.wheel_worn_area,
            fine.wheel_worn_area,
            0.02,
            IDENTITY,
        ));
        rows.push(Row::absolute(
            format!("thickness Sd of the worn flange, twice the {what}"),
            "m",
            coarse.flange_thickness,
            fine.flange_thickness,
            0.05e-3,
            IDENTITY,
        ));
    }
    Ok(rows)
}
