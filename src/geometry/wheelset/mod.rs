//! Contact geometry of a wheelset on its track, without forces: where rigid wheels touch rigid rails.
//!
//! The track's frame has x forward, y to the left and z upward; its origin is in the middle, at the height of the rails' tops. The
//! wheelset's centre stands at (`lateral`, r₀ + `vertical`), turned by `roll` about x and then by `yaw` about z, anticlockwise seen from
//! ahead and from above. For a given lateral position and yaw, `vertical` and `roll` follow from both wheels touching.
//!
//! Each wheel is a surface of revolution. Where it touches a straight rail its normal has no part along the rail; per station along the
//! axle there is one such point on its lower half, and together they are the wheel's silhouette across the track. The smallest vertical
//! distance from the silhouette to the rail is where they touch.

mod conicity;
mod side;
mod sweep;

pub use conicity::{Conicity, KinematicMotion};
pub use side::Touch;
pub use sweep::{Jump, Sweep};

use super::profile::{Body, Profile};
use crate::error::ProfileError;
use side::{Attitude, Pair};

/// Dimensions of a wheelset and its track, `m`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dimensions {
    /// Distance of the rails' running faces.
    pub gauge: f64,
    /// Depth below the rails' tops at which the gauge is measured.
    pub gauge_depth: f64,
    /// Inclination of the rails, rad: 0 for profiles that are inclined already.
    pub rail_inclination: f64,
    /// Distance between the backs of the two flanges.
    pub flange_back_distance: f64,
    /// Distance of the running circle from the back of its flange.
    pub flange_back_position: f64,
    /// Radii of the running circles, of the left and the right wheel.
    pub wheel_radii: [f64; 2],
}

impl Default for Dimensions {
    /// Standard gauge, rails inclined 1:40, wheels of 0.92 m.
    fn default() -> Dimensions {
        Dimensions {
            gauge: 1.435,
            gauge_depth: 14e-3,
            rail_inclination: (1.0f64 / 40.0).atan(),
            flange_back_distance: 1.360,
            flange_back_position: 70e-3,
            wheel_radii: [0.46; 2],
        }
    }
}

impl Dimensions {
    /// Refuses dimensions that no track or wheelset has.
    fn validate(&self) -> Result<(), ProfileError> {
        for (name, value, minimum, maximum) in [
            ("gauge", self.gauge, 0.3, 3.0),
            ("gauge_depth", self.gauge_depth, 1e-3, 50e-3),
            ("flange_back_distance", self.flange_back_distance, 0.2, 3.0),
            ("flange_back_position", self.flange_back_position, 0.0, 0.2),
            ("wheel_radius of the left wheel", self.wheel_radii[0], 0.05, 5.0),
            ("wheel_radius of the right wheel", self.wheel_radii[1], 0.05, 5.0),
        ] {
            if !(minimum..=maximum).contains(&value) {
                return Err(ProfileError::OutOfRange {
                    name,
                    value,
                    minimum,
                    maximum,
                    unit: "m",
                });
            }
        }
        Ok(())
    }

    /// Distance of the running circles from the wheelset's middle, `m`.
    pub fn running_circle(&self) -> f64 {
        0.5 * self.flange_back_distance + self.flange_back_position
    }
}

/// Place of a wheelset whose wheels both touch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Pose {
    /// Lateral displacement of the wheelset's centre, to the left, `m`.
    pub lateral: f64,
    /// Yaw, anticlockwise seen from above, rad.
    pub yaw: f64,
    /// Roll about the direction of travel, the left wheel upward, rad; 0 of a wheelset that stays level.
    pub roll: f64,
    /// Height of the wheelset's centre above the nominal radius, the mean of both wheels', `m`.
    pub vertical: f64,
    /// Contacts of the left and the right wheel.
    pub touches: [Touch; 2],
}

impl Pose {
    /// Difference of the rolling radii, left less right, `m`: positive where the wheelset has moved to the left and its wheels steer back.
    pub fn radius_difference(&self) -> f64 {
        self.touches[0].rolling_radius - self.touches[1].rolling_radius
    }
}

/// Rigid wheelset on a rigid track.
#[derive(Debug, Clone)]
pub struct Wheelset {
    sides: [Pair; 2],
    radius: f64,
    /// Whether the axle stays level.
    level: bool,
    /// Whether the direction of a profile turns to and fro, as noise does.
    rough: bool,
}

/// Largest yaw, rad.
const LARGEST_YAW: f64 = 0.2;
/// Largest roll, rad: a wheel would have climbed by 150 mm.
const LARGEST_ROLL: f64 = 0.1;
/// Roll that is tried first on either side, rad.
const FIRST_ROLL: f64 = 1e-4;
/// Difference of the heights of both wheels that is round-off, `m`.
const LEVEL: f64 = 1e-13;

impl Wheelset {
    /// Wheelset of two wheels on two rails, each the left one first, as profiles with y to the field side.
    ///
    /// # Errors
    /// A profile is that of the other body or does not reach the gauge's depth; a dimension is out of its range.
    pub fn new(rails: [&Profile; 2], wheels: [&Profile; 2], dimensions: &Dimensions) -> Result<Wheelset, ProfileError> {
        dimensions.validate()?;
        let pair = |side: usize| {
            rails[side].require(Body::Rail)?;
            wheels[side].require(Body::Wheel)?;
            let rail = rails[side].inclined(dimensions.rail_inclination)?;
            Pair::new(&rail, wheels[side], dimensions, dimensions.wheel_radii[side])
        };
        Ok(Wheelset {
            sides: [pair(0)?, pair(1)?],
            radius: 0.5 * (dimensions.wheel_radii[0] + dimensions.wheel_radii[1]),
            level: false,
            rough: rails.iter().chain(&wheels).any(|profile| profile.is_rough()),
        })
    }

    /// Wheelset whose axle stays level: each wheel touches by itself, at a height of its own. The reference results of EN 15302 are those
    /// without roll.
    pub fn level(self) -> Wheelset {
        Wheelset { level: true, ..self }
    }

    /// Attitudes of both sides as each sees them: the right one in the mirror.
    fn attitudes(lateral: f64, yaw: f64, roll: f64) -> [Attitude; 2] {
        [1.0, -1.0].map(|sign| Attitude::new(sign * lateral, sign * yaw, sign * roll))
    }

    /// Place of the wheelset at a lateral displacement of its centre, `m`, to the left, and a yaw, rad, anticlockwise from above.
    ///
    /// # Errors
    /// The yaw is not within ± 0.2 rad; at that displacement a wheel stands beside its rail, on the edge of its profile, or on the tip of its flange.
    pub fn at(&self, lateral: f64, yaw: f64) -> Result<Pose, ProfileError> {
        if !(-LARGEST_YAW..=LARGEST_YAW).contains(&yaw) {
            return Err(ProfileError::OutOfRange {
                name: "yaw",
                value: yaw,
                minimum: -LARGEST_YAW,
                maximum: LARGEST_YAW,
                unit: "rad",
            });
        }
        let rough = self.rough;
        let beside = || ProfileError::WheelBesideRail { lateral, yaw, rough };
        // Height of the left wheel's lowest point over its rail, less that of the right one's: rises with the roll.
        let tilt = |roll: f64| -> Option<f64> {
            let [left, right] = Self::attitudes(lateral, yaw, roll);
            Some(self.sides[0].clearance(&left)? - self.sides[1].clearance(&right)?)
        };
        let roll = if self.level { Some(0.0) } else { root(tilt) };
        let roll = roll.ok_or_else(beside)?;
        let attitudes = Self::attitudes(lateral, yaw, roll);
        let left = self.sides[0].touch(&attitudes[0]).ok_or_else(beside)?;
        let right = self.sides[1].touch(&attitudes[1]).ok_or_else(beside)?;
        for (side, pair, touch) in [("left", &self.sides[0], left.0), ("right", &self.sides[1], right.0)] {
            if let Some(tip) = pair.tip_under(&touch) {
                return Err(ProfileError::WheelOnFlange {
                    side,
                    lateral,
                    yaw,
                    on_wheel: touch.on_wheel,
                    tip,
                    rough,
                });
            }
        }
        Ok(Pose {
            lateral,
            yaw,
            roll,
            vertical: -0.5 * (left.1 + right.1) - self.radius,
            touches: [left.0, right.0],
        })
    }

    /// Outlines of the rail and of the wheel's silhouette, for a picture: places (y, z) in the track's frame, `m`, the rail's first, of side 0,
    /// the left one, or 1, the right one.
    pub fn outlines(&self, pose: &Pose, side: usize) -> [Vec<[f64; 2]>; 2] {
        let attitude = Self::attitudes(pose.lateral, pose.yaw, pose.roll)[side];
        let sign = if side == 0 { 1.0 } else { -1.0 };
        let [rail, wheel] = self.sides[side].outlines(&attitude, self.radius + pose.vertical);
        [rail, wheel].map(|points| points.into_iter().map(|[y, z]| [sign * y, z]).collect())
    }
}

/// Root of a function that rises through 0: bracketed from 0 on, then by Ridders' method, which needs no derivative and halves its bracket
/// in any case. `None` where there is none within the largest roll.
fn root(tilt: impl Fn(f64) -> Option<f64>) -> Option<f64> {
    let here = tilt(0.0)?;
    if here.abs() <= LEVEL {
        return Some(0.0);
    }
    let sign = -here.signum();
    let (mut near, mut far) = ((0.0, here), None);
    let mut roll = sign * FIRST_ROLL;
    while roll.abs() <= LARGEST_ROLL {
        let value = tilt(roll)?;
        if value * here <= 0.0 {
            far = Some((roll, value));
            break;
        }
        near = (roll, value);
        roll *= 2.0;
    }
    let mut far = far?;
    for _ in 0..60 {
        let middle = 0.5 * (near.0 + far.0);
        let value = tilt(middle)?;
        let root = (value * value - near.1 * far.1).sqrt();
        let guess = middle + (middle - near.0) * (near.1 - far.1).signum() * value / root;
        let guess_value = tilt(guess)?;
        if guess_value.abs() <= LEVEL || (far.0 - near.0).abs() <= 1e-15 {
            return Some(guess);
        }
        for point in [(middle, value), (guess, guess_value)] {
            let inside = (point.0 - near.0) * (point.0 - far.0) < 0.0;
            if inside && point.1 * near.1 > 0.0 {
                near = point;
            } else if inside {
                far = point;
            }
        }
    }
    Some(0.5 * (near.0 + far.0))
}

#[cfg(test)]
mod tests;
