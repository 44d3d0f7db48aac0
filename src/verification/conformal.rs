//! A conformal contact, against CONTACT: its example "Conformal", a rail's corner of 10 mm in a wheel's root of 10.2 mm, under 45° to the track.
//!
//! The contact is 11 mm broad and turns by 60° from one side to the other. CONTACT's case 4 has the distance of the bodies across the rail, creepages that vary
//! over the contact as the inclination does, and the influence of half-spaces. Along the rail it takes the curvature of the middle,
//! cos 45°/r, for all of the contact; that of the wheel is cos δ/r, nearly four times as large on one side as on the other. What this changes is found by a
//! dense solution on CONTACT's own cells with either curvature, its friction along the rigid slip, as nearly all slides: first that solution is compared with CONTACT's,
//! then ours with CONTACT's results and that change.
//!
//! The influence of bodies that are curved is left out here, as everywhere: with it CONTACT (case 5) has a normal force of 99.8 kN in place of 91.8 kN, and
//! 12.7 kN along the rail in place of 10.5 kN.

use super::row::Row;
use super::set_up;
use crate::error::{Error, Result};
use crate::geometry::profile::files::Format;
use crate::geometry::profile::{Body, Profile};
use crate::parameters::{ContactModel, Control, Parameters, ProfileContents, SlipSource};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::wheel_rail::Model;
use nalgebra::{Cholesky, DMatrix, DVector};
use std::f64::consts::{FRAC_PI_4, PI};
use std::sync::Arc;

const SOURCE: &str = "CONTACT's example Conformal, case 4";
const CHANGED: &str = "CONTACT's case 4, and the change by the curvature along the rail";
/// Radii of the rail's corner and of the wheel's root, `m`.
const RADII: [f64; 2] = [10e-3, 10.2e-3];
/// Inclination in the contact's middle, rad.
const INCLINATION: f64 = FRAC_PI_4;
/// Radius of the wheel there, `m`.
const RADIUS: f64 = 0.46;
/// Approach along the normal there, `m`.
const APPROACH: f64 = 0.09089e-3;
/// V, `m/s`, and the excess of the circumference's speed, and the lateral speed, over it.
const SPEED: f64 = 30.0;
const CREEPAGES: [f64; 2] = [4e-3, -0.014];
const FRICTION: f64 = 0.3;
const SHEAR_MODULUS: f64 = 8.2e10;
const POISSON_RATIO: f64 = 0.28;
/// CONTACT's cells: their size, `m`, numbers along and across, and the first corner, `m`.
const CELL: f64 = 0.4e-3;
const CELLS: [usize; 2] = [51, 39];
const CORNER: [f64; 2] = [-10.2e-3, -7.8e-3];
/// CONTACT's results.
const CONTACT: Solution = Solution {
    normal_force: 91.84e3,
    forces: [10.50e3, 22.51e3],
    peak: 1012e6,
    area: 871.0 * CELL * CELL,
};
/// Normal force and peak pressure, relative: of 26 cells from edge to edge, each edge is known to a thirtieth of one; CONTACT's have five digits.
const TOLERANCE: f64 = 6e-3;
/// Area, relative: half a row of cells around it.
const AREA: f64 = 0.04;
/// Forces over μ F_N: as in the [benchmark](super::manchester).
const FORCE: f64 = 0.012;
/// Limit of the sets of cells that are tried.
const SETS: usize = 60;

/// Results for the contact.
#[derive(Debug, Clone, Copy)]
struct Solution {
    /// Normal force, `N`.
    normal_force: f64,
    /// Forces along and across, `N`.
    forces: [f64; 2],
    /// Peak pressure, `Pa`.
    peak: f64,
    /// Area under pressure, `m²`.
    area: f64,
}

/// Displacement of both bodies by a unit pressure on a cell, at a distance along and across, `m/Pa`: Boussinesq's, integrated over the cell.
fn influence([x, y]: [f64; 2]) -> f64 {
    let corner = |x: f64, y: f64| {
        let distance = x.hypot(y);
        x * (y + distance).ln() + y * (x + distance).ln()
    };
    let half = 0.5 * CELL;
    let sum = corner(x + half, y + half) - corner(x - half, y + half) - corner(x + half, y - half)
        + corner(x - half, y - half);
    (1.0 - POISSON_RATIO) / (PI * SHEAR_MODULUS) * sum
}

/// Dense solution on CONTACT's cells, with the curvature along the rail, `1/m`, at an inclination, rad; the friction is along the rigid slip. None where the cells under pressure
/// do not come to rest.
fn dense(curvature: impl Fn(f64) -> f64) -> Option<Solution> {
    let places: Vec<[f64; 2]> = (0..CELLS[0] * CELLS[1])
        .map(|cell| [cell / CELLS[1], cell % CELLS[1]])
        .map(|index| [0, 1].map(|k| CORNER[k] + CELL * (index[k] as f64 + 0.5)))
        .collect();
    let angle = |y: f64| INCLINATION - y / RADII[0];
    let gap = |[x, y]: [f64; 2]| {
        let turned = (y / RADII[0]).cos();
        (RADII[1] - RADII[0]) * (1.0 - turned) - APPROACH * turned + 0.5 * curvature(angle(y)) * x * x
    };
    let mut cells: Vec<[f64; 2]> = places.iter().copied().filter(|&place| gap(place) < 0.0).collect();
    for _ in 0..SETS {
        let response = DMatrix::from_fn(cells.len(), cells.len(), |a, b| {
            influence([0, 1].map(|k| cells[a][k] - cells[b][k]))
        });
        let overlap = DVector::from_iterator(cells.len(), cells.iter().map(|&place| -gap(place)));
        let pressure = Cholesky::new(response)?.solve(&overlap);
        let kept = cells.iter().zip(&pressure).filter(|(_, pressure)| **pressure > 0.0);
        let kept: Vec<([f64; 2], f64)> = kept.map(|(&place, &pressure)| (place, pressure)).collect();
        let displaced = |[x, y]: [f64; 2]| -> f64 {
            kept.iter()
                .map(|([from_x, from_y], pressure)| pressure * influence([x - from_x, y - from_y]))
                .sum()
        };
        let joining = places.iter().copied().filter(|place| !cells.contains(place));
        let joining: Vec<[f64; 2]> = joining
            .filter(|&place| gap(place) < 0.0 && gap(place) + displaced(place) < 0.0)
            .collect();
        if kept.len() < cells.len() || !joining.is_empty() {
            cells = kept.into_iter().map(|(place, _)| place).chain(joining).collect();
            continue;
        }
        let spin = (1.0 + CREEPAGES[0]) / RADIUS;
        let mut solution = Solution {
            normal_force: 0.0,
            forces: [0.0; 2],
            peak: pressure.max(),
            area: kept.len() as f64 * CELL * CELL,
        };
        for ([x, y], pressure) in kept {
            let force = pressure * CELL * CELL;
            let radius = RADIUS + RADII[1] * (INCLINATION.cos() - angle(y).cos());
            let slip = [
                1.0 - spin * radius,
                CREEPAGES[1] * angle(y).cos() - spin * x * angle(y).sin(),
            ];
            let size = slip[0].hypot(slip[1]);
            solution.normal_force += force;
            for (sum, slip) in solution.forces.iter_mut().zip(slip) {
                *sum -= FRICTION * force * slip / size;
            }
        }
        return Some(solution);
    }
    None
}

/// Points on an arc, and a line of 30 mm on from either end, along the tangent; in the order of the profile. Angles are those of the normal, from upward to the gauge side.
fn points(radius: f64, centre: [f64; 2], [steep, flat]: [f64; 2], line: f64) -> Vec<[f64; 2]> {
    let at = |angle: f64| [centre[0] - radius * angle.sin(), centre[1] + radius * angle.cos()];
    let on_line = |angle: f64, way: f64| {
        let [y, z] = at(angle);
        [y + way * angle.cos(), z + way * angle.sin()]
    };
    let below = (-60..0).map(|step| on_line(steep, f64::from(step) / 60.0 * 5e-3));
    let arc = (0..=400).map(|step| at(steep + (flat - steep) * f64::from(step) / 400.0));
    let beyond = (1..=60).map(|step| on_line(flat, f64::from(step) / 60.0 * line));
    below.chain(arc).chain(beyond).collect()
}

/// Text of a profile's file.
fn text(body: Body, points: &[[f64; 2]]) -> Result<Arc<str>> {
    let profile = Profile::from_points(body, "conformal", "conformal", points, 0.0).map_err(Error::Profile)?;
    Ok(profile.text(Format::Simpack).into())
}

/// The contact of the profiles.
///
/// # Errors
/// Those of the model.
fn profiles() -> Result<Solution> {
    let [corner, root] = RADII;
    // The rail's origin is the highest point of its corner; its head falls off beyond that.
    let rail = points(corner, [0.0, -corner], [90f64.to_radians(), -10f64.to_radians()], 30e-3);
    // The wheel's origin is 20 mm beyond its root.
    let flat: f64 = 5f64.to_radians();
    let end = [-20e-3, -20e-3 * flat.tan()];
    let centre = [end[0] + root * flat.sin(), end[1] - root * flat.cos()];
    // Where the undeformed bodies overlap but do not touch, beyond 80°, the flange recedes: over a height of the wheel a rail as steep as that is not defined.
    let mut wheel = points(root, centre, [80f64.to_radians(), flat], 50e-3);
    wheel.drain(..60);
    let steep = 65f64.to_radians();
    let end = wheel[0];
    let face = (-60..0).map(|step| 5e-3 * f64::from(step) / 60.0);
    let face: Vec<[f64; 2]> = face
        .map(|way| [end[0] + way * steep.cos(), end[1] + way * steep.sin()])
        .collect();
    wheel.splice(0..0, face);
    // It goes on to a tip about which it turns.
    let (tip, from) = (8e-3, wheel[0]);
    let around = [from[0] - tip * steep.sin(), from[1] + tip * steep.cos()];
    let turn = (0..100).map(|step| -1.0 + (steep + 1.0) * f64::from(step) / 100.0);
    let flange = turn.map(|angle| [around[0] + tip * angle.sin(), around[1] - tip * angle.cos()]);
    wheel.splice(0..0, flange);
    let contents = ProfileContents {
        wheel: Some(text(Body::Wheel, &wheel)?),
        rail: Some(text(Body::Rail, &rail)?),
    };
    let (sine, cosine) = INCLINATION.sin_cos();
    let on_rail = [-corner * sine, -corner + corner * cosine];
    let on_wheel = [centre[0] - root * sine, centre[1] + root * cosine];
    let common = Parameters {
        friction_cold: FRICTION,
        shear_modulus: SHEAR_MODULUS,
        lame_lambda: 2.0 * SHEAR_MODULUS * POISSON_RATIO / (1.0 - 2.0 * POISSON_RATIO),
        ..set_up::mechanics_alone()
    };
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        control: Control::Height,
        rail_profile: "conformal.prr".to_owned(),
        wheel_profile: "conformal.prw".to_owned(),
        rail_inclination: 0.0,
        wheel_radius: RADIUS + on_wheel[1],
        // The side of the rail, 10 mm beside its top, is its running face: where both touch, the wheelset stands in the middle.
        gauge: 2.0 * (common.running_circle() + on_wheel[0] - on_rail[0] - corner),
        wheel_shear_modulus: SHEAR_MODULUS,
        wheel_lame_lambda: common.lame_lambda,
        largest_load: 110e3,
        ..common
    };
    let model = Model::with_contents(parameters, Settings::strict(), contents)?;
    let inputs = Inputs {
        lateral_displacement: APPROACH * sine,
        vertical_displacement: on_rail[1] - on_wheel[1] - APPROACH * cosine,
        vehicle_speed: SPEED,
        lateral_speed: CREEPAGES[1] * SPEED,
        wheel_speed: (1.0 + CREEPAGES[0]) * SPEED / RADIUS,
        ..Inputs::default()
    };
    let outputs = model.initial_state(&mut model.workspace(), &inputs)?.outputs;
    let contact = &outputs.contact[0];
    Ok(Solution {
        normal_force: contact.normal_force,
        forces: [contact.longitudinal_force, contact.lateral_force],
        peak: contact.peak_pressure,
        area: contact.area,
    })
}

/// Rows of the table.
///
/// # Errors
/// Those of the model.
pub fn rows() -> Result<Vec<Row>> {
    let ours = profiles()?;
    let none = Solution {
        normal_force: f64::NAN,
        forces: [f64::NAN; 2],
        peak: f64::NAN,
        area: f64::NAN,
    };
    let constant = dense(|_| INCLINATION.cos() / RADIUS).unwrap_or(none);
    let varying = dense(|inclination| inclination.cos() / RADIUS).unwrap_or(none);
    let changed = Solution {
        normal_force: CONTACT.normal_force + varying.normal_force - constant.normal_force,
        forces: [0, 1].map(|k| CONTACT.forces[k] + varying.forces[k] - constant.forces[k]),
        peak: CONTACT.peak + varying.peak - constant.peak,
        area: CONTACT.area + varying.area - constant.area,
    };
    let mut rows = Vec::new();
    for (whose, reference, computed, source) in [
        ("dense, one curvature along the rail", CONTACT, constant, SOURCE),
        ("profiles", changed, ours, CHANGED),
    ] {
        let mut relative = |quantity: &str, unit, [reference, computed]: [f64; 2], tolerance| {
            let quantity = format!("{quantity}, {whose}");
            rows.push(Row::relative(quantity, unit, reference, computed, tolerance, source));
        };
        let normal_forces = [reference.normal_force, computed.normal_force];
        relative("normal force", "N", normal_forces, TOLERANCE);
        relative("peak pressure", "Pa", [reference.peak, computed.peak], TOLERANCE);
        relative("area", "m²", [reference.area, computed.area], AREA);
    }
    let bound = FRICTION * changed.normal_force;
    for (direction, k) in [("along the rail", 0), ("across it", 1)] {
        let [reference, computed] = [changed, ours].map(|solution| solution.forces[k] / bound);
        let quantity = format!("force {direction} over μ F_N, profiles");
        rows.push(Row::absolute(quantity, "1", reference, computed, FORCE, CHANGED));
    }
    Ok(rows)
}
