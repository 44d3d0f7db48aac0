//! A cone on a rail's crown, as profiles against the patch: the contact of constant curvatures, by both.
//!
//! A rail 60E1 that leans by 1 in 40 has the crown's top, an arc of 300 mm over 20 mm, where a wheel of 1:40 touches it. The patch gets the
//! radius of the cone across its surface, the creepages at the contact's centre, and the normal force.
//!
//! The forces along the rail agree where all slides. Where a part sticks, profiles have one more effect of the second order: the wheel's
//! material moves along its circle, and so by x²/2r₀² of the speed slower forward at a distance x ahead of the axle or behind. The patch takes
//! the rigid slip as uniform. The mean creepage that is lost so is a share of a²/2r₀²: 4/15 with the simplified theory on an ellipse, in which shear
//! grows with the slip from the leading edge on, and 1/2 in a line contact, whose linear theory weighs with √((a + x)/(a − x)).

use super::row::{Row, larger};
use super::set_up;
use crate::error::Result;
use crate::parameters::{ContactModel, Parameters, SlipSource};
use crate::signals::{ContactOutputs, Inputs, Outputs};
use std::f64::consts::PI;

const SOURCE: &str = "contact_model 2";
/// Slope of the cone, and of the rail.
const SLOPE: f64 = 0.025;
/// Radius of the crown, `m`.
const CROWN: f64 = 0.3;
const FRICTION: f64 = 0.3;
/// V, `m/s`.
const SPEED: f64 = 20.0;
/// Vertical load, `N`.
const LOAD: f64 = 60e3;
/// Tolerance of all but F_x where a part sticks: of some 20 cells from edge to edge, each edge is known to a thirtieth of one.
const TOLERANCE: f64 = 3e-3;
/// Yaw, rad, and excess of the circumference's speed: rolling, driving, steering, both, and sliding.
const MOTIONS: [[f64; 2]; 5] = [[0.0, 0.0], [0.0, 1e-3], [1e-3, 0.0], [1e-3, 1e-3], [4e-3, 5e-3]];
/// Change of ξ for the slope of the patch's creep curve.
const STEP: f64 = 2e-5;

/// One motion by both models.
struct Both {
    profiles: Outputs,
    patch: Outputs,
    /// F_x of the patch at a little more creepage.
    ahead: f64,
    radius: f64,
}

impl Both {
    fn contact(&self) -> &ContactOutputs {
        &self.profiles.contact[0]
    }

    /// Difference of F_x, F_y and M_n over μ F_N and μ F_N c.
    fn forces(&self) -> [f64; 3] {
        let (contact, patch) = (self.contact(), &self.patch);
        let bound = FRICTION * contact.normal_force;
        [
            (contact.longitudinal_force - patch.traction_force) / bound,
            (contact.lateral_force - patch.lateral_force) / bound,
            (contact.spin_moment - patch.spin_moment) / (bound * (contact.area / PI).sqrt()),
        ]
        .map(f64::abs)
    }

    /// Relative differences of approach, peak pressure, area, length and breadth.
    fn sizes(&self) -> [f64; 5] {
        let (contact, patch) = (self.contact(), &self.patch);
        [
            (self.profiles.penetration * contact.inclination.cos(), patch.penetration),
            (contact.peak_pressure, patch.peak_pressure),
            (contact.area, patch.contact_area),
            (contact.length, patch.contact_length),
            (contact.breadth, patch.contact_breadth),
        ]
        .map(|(profiles, patch)| (profiles / patch - 1.0).abs())
    }

    /// Creepage by which F_x lags behind that of the patch, over a²/2r₀².
    fn creepage_lost(&self) -> f64 {
        let slope = (self.ahead - self.patch.traction_force) / STEP;
        let lost = (self.patch.traction_force - self.contact().longitudinal_force) / slope;
        let half_length = 0.5 * self.contact().length;
        lost / (0.5 * (half_length / self.radius).powi(2))
    }
}

fn both([yaw, excess]: [f64; 2]) -> Result<Both> {
    let common = Parameters {
        friction_cold: FRICTION,
        ..set_up::mechanics_alone()
    };
    let profiles = set_up::model(Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        wheel_profile: "cone40".to_owned(),
        rail_inclination: SLOPE,
        ..common.clone()
    })?;
    let inputs = Inputs {
        normal_load: LOAD,
        vehicle_speed: SPEED,
        wheel_speed: SPEED * (1.0 + excess) / common.wheel_radius,
        yaw_angle: yaw,
        ..Inputs::default()
    };
    let of_profiles = profiles.initial_state(&mut profiles.workspace(), &inputs)?.outputs;
    let contact = &of_profiles.contact[0];
    let radius = (common.wheel_radius - SLOPE * contact.wheel_position) / SLOPE.atan().cos();
    let patch = set_up::model(Parameters {
        contact_model: ContactModel::Patch,
        wheel_radius: radius,
        rail_transverse_curvature: 1.0 / CROWN,
        wheel_transverse_curvature: 0.0,
        ..common
    })?;
    let of_patch = |creepage: f64| -> Result<Outputs> {
        let inputs = Inputs {
            normal_load: contact.normal_force,
            wheel_speed: SPEED * (1.0 + creepage) / radius,
            creepage,
            lateral_creepage: contact.lateral_creepage,
            spin_creepage: contact.spin_creepage,
            ..Inputs::default()
        };
        Ok(patch.initial_state(&mut patch.workspace(), &inputs)?.outputs)
    };
    Ok(Both {
        patch: of_patch(contact.longitudinal_creepage)?,
        ahead: of_patch(contact.longitudinal_creepage + STEP)?.traction_force,
        profiles: of_profiles,
        radius,
    })
}

/// Rows of the check.
pub fn rows() -> Result<Vec<Row>> {
    let motions = MOTIONS.into_iter().map(both).collect::<Result<Vec<_>>>()?;
    let largest = |value: &dyn Fn(&Both) -> f64| motions.iter().map(value).fold(0.0, larger);
    let mut rows = Vec::new();
    for (size, name) in ["approach", "peak pressure", "area", "length", "breadth"]
        .into_iter()
        .enumerate()
    {
        let quantity = format!("cone on a crown, largest difference of the {name}, relative");
        let difference = largest(&|motion| motion.sizes()[size]);
        rows.push(Row::absolute(quantity, "1", 0.0, difference, TOLERANCE, SOURCE));
    }
    for (force, name) in [(1, "F_y/(mu F_N)"), (2, "M_n/(mu F_N c)")] {
        let quantity = format!("cone on a crown, largest difference of {name}");
        let difference = largest(&|motion| motion.forces()[force]);
        rows.push(Row::absolute(quantity, "1", 0.0, difference, TOLERANCE, SOURCE));
    }
    let [sticking @ .., sliding] = &motions[..] else {
        return Ok(rows);
    };
    let quantity = "cone on a crown, sliding, difference of F_x/(mu F_N)";
    rows.push(Row::absolute(
        quantity,
        "1",
        0.0,
        sliding.forces()[0],
        TOLERANCE,
        SOURCE,
    ));
    let lost = sticking.iter().map(Both::creepage_lost);
    let (least, most) = (lost.clone().fold(f64::INFINITY, f64::min), lost.fold(0.0, larger));
    let quantity = |which: &str| format!("cone on a crown, rolling, {which} creepage lost over a^2/(2 r0^2)");
    rows.push(Row::at_least(
        quantity("least"),
        "1",
        4.0 / 15.0,
        least,
        "simplified theory",
    ));
    rows.push(Row::at_most(
        quantity("largest"),
        "1",
        0.5,
        most,
        "line contact, linear theory",
    ));
    Ok(rows)
}
