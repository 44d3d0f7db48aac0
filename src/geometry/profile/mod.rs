//! Profiles of wheels and rails: curves in the plane across the track.
//!
//! # Frames
//!
//! Both bodies have y to the field side, outwards from the track's middle, and z upward, in `m`. A rail's origin is its highest
//! point. A wheel's is on its running circle, where its radius is the nominal one: its flange has y < 0 and hangs down to z < 0, and
//! its tread rises towards the field side. The right and the left side of a track are mirror images.
//!
//! The arc length s begins at the gauge side of a rail, or the flange side of a wheel, and ends on the field side. The curvature is the
//! derivative of the direction's angle over s: it is negative on a rail's crown, which is convex upward, positive on a
//! wheel's flange, which is convex downward, and the gap of a wheel over a rail opens with the difference of the two.

pub mod built_in;
mod curve;
mod depth;
mod divided;
pub mod files;
mod height;
mod measured;
mod measures;
mod norm;
mod outline;
mod worn;
mod worn_height;

pub use depth::DepthGrid;
pub use height::HeightFunction;
pub use measures::{WheelMeasures, WheelWear};
pub use worn_height::WornHeight;

use crate::error::ProfileError;
use curve::Curve;
use measured::Weighted;
use serde::{Deserialize, Serialize};

/// Body that a profile belongs to.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Body {
    /// The rail: material below the curve.
    Rail,
    /// The wheel: material above the curve.
    Wheel,
}

impl Body {
    /// Name of the body, in lower case.
    pub fn name(self) -> &'static str {
        match self {
            Body::Rail => "rail",
            Body::Wheel => "wheel",
        }
    }
}

/// Place, direction and curvature of a profile at an arc length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurvePoint {
    /// Lateral position y, positive to the field side, and height z, `m`.
    pub place: [f64; 2],
    /// Unit tangent with its parts along y and z, in the direction of rising arc length.
    pub tangent: [f64; 2],
    /// Curvature: the derivative of the tangent's angle, from y towards z, over the arc length, `1/m`.
    pub curvature: f64,
}

/// Profile of a wheel or a rail, as a curve over its arc length.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    body: Body,
    name: String,
    source: String,
    curve: Curve,
    /// Arc length about which y rises with it: of a rail's highest point, of a wheel's running circle.
    middle: f64,
}

/// Largest inclination of a rail, rad.
const STEEPEST_INCLINATION: f64 = 0.2;

/// Turn between neighbouring points, rad, that counts for the roughness of a profile: cells are much shorter than the least radius of a wheel or a rail.
const SHARP_TURN: f64 = 10.0 / 180.0 * std::f64::consts::PI;
/// Sum of such turns, rad, above which a profile is rough: many times those at the kinks of a rim and a head's lower edges.
const MOST_TURNING: f64 = 4.0 * std::f64::consts::PI;
/// Height, `m`, that a wheel's profile may still fall by where its height function ends.
const LOST_FLANGE: f64 = 1e-3;

impl Profile {
    /// Profile of a curve in its frame, except for the origin: a rail's is moved to its highest point, a wheel's to the height of its running circle.
    fn of_curve(body: Body, name: &str, source: &str, curve: Curve) -> Result<Profile, ProfileError> {
        let refused = |reason: &str| ProfileError::NoCurve {
            name: name.to_owned(),
            reason: reason.to_owned(),
        };
        let whole = || refused("its points do not follow each other");
        let (curve, middle) = match body {
            Body::Rail => {
                let top = curve.extreme(true);
                let [y, z] = curve.at(top).place;
                (curve.moved(0.0, [-y, -z]).ok_or_else(whole)?, top)
            }
            Body::Wheel => {
                let datum = rising(&curve, 0.0, None);
                let datum = datum.ok_or_else(|| refused("it does not reach the running circle, y = 0"))?;
                let height = curve.at(datum).place[1];
                (curve.moved(0.0, [0.0, -height]).ok_or_else(whole)?, datum)
            }
        };
        Ok(Profile {
            body,
            name: name.to_owned(),
            source: source.to_owned(),
            curve,
            middle,
        })
    }

    /// Profile through points, or smoothed; `points` are in the profile's frame, in either order, in `m`.
    ///
    /// `smoothing` is a wavelength, `m`: waves of this length are damped to a half, longer ones less (1/(1 + (smoothing/length)⁴)). 0 goes
    /// through the points. A turn of more than 30° at a single point stays a kink, and points that go back are averaged.
    ///
    /// # Errors
    /// The points are too few, too many or not finite, their curve is not 5 to 500 mm long, has a gap, or does not reach the running
    /// circle of a wheel.
    pub fn from_points(
        body: Body,
        name: &str,
        source: &str,
        points: &[[f64; 2]],
        smoothing: f64,
    ) -> Result<Profile, ProfileError> {
        let points: Vec<_> = points.iter().map(|&place| Weighted { place, weight: 1.0 }).collect();
        Profile::from_weighted(body, name, source, points, smoothing)
    }

    fn from_weighted(
        body: Body,
        name: &str,
        source: &str,
        mut points: Vec<Weighted>,
        smoothing: f64,
    ) -> Result<Profile, ProfileError> {
        let lateral = |point: Option<&Weighted>| point.map_or(0.0, |point| point.place[0]);
        if lateral(points.first()) > lateral(points.last()) {
            points.reverse();
        }
        let curve = measured::curve(name, &points, smoothing)?;
        Profile::of_curve(body, name, source, curve)
    }

    /// Profile whose waves of a length `smoothing`, `m`, are damped to a half, as [`Profile::from_points`] does through the
    /// [points](Profile::points) of this one: after it has worn, for example. 0 changes nothing.
    ///
    /// # Errors
    /// `smoothing` is not from 0 to 0.1 m; or a wheel that is smoothed does not reach its running circle.
    pub fn smoothed(&self, smoothing: f64) -> Result<Profile, ProfileError> {
        if smoothing == 0.0 {
            return Ok(self.clone());
        }
        Profile::from_points(self.body, &self.name, &self.source, &self.points(), smoothing)
    }

    /// Body that the profile belongs to.
    pub fn body(&self) -> Body {
        self.body
    }

    /// Name of the profile.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Source of the profile: a standard, a publication, a file.
    pub fn source(&self) -> &str {
        &self.source
    }

    /// Arc length from the gauge or flange side to the field side, `m`.
    pub fn length(&self) -> f64 {
        self.curve.length()
    }

    /// Profile at an arc length, `m`; beyond the ends on the straight lines that begin there. Takes constant time and allocates nothing.
    pub fn at(&self, arc: f64) -> CurvePoint {
        self.curve.at(arc)
    }

    /// Points of the profile, from the gauge or flange side to the field side, no farther than 0.25 mm from each other, `m`.
    pub fn points(&self) -> Vec<[f64; 2]> {
        self.curve.arcs().iter().map(|&arc| self.at(arc).place).collect()
    }

    /// Arc lengths of the [points](Profile::points), ascending, `m`: among them are those at which the curvature jumps.
    pub fn arc_lengths(&self) -> &[f64] {
        self.curve.arcs()
    }

    /// Arc length at which the running surface has a lateral position y, `m`: where more than one place has it, the one that is
    /// connected with a rail's highest point or a wheel's running circle without turning back. `None` where it does not reach y.
    pub fn arc_of(&self, y: f64) -> Option<f64> {
        rising(&self.curve, y, Some(self.middle))
    }

    /// Height z(y) of the running surface over the lateral position, from where it is 84° steep, if it is, at the one side to there on
    /// the other: for a wheel from the back of the flange to the field side.
    ///
    /// # Errors
    /// The profile is nowhere flat; a wheel's flange begins with a wall of 84° or more, and no height leads to its tip.
    pub fn height_function(&self) -> Result<HeightFunction, ProfileError> {
        let function = HeightFunction::of_curve(&self.curve, self.middle).ok_or_else(|| self.nowhere_flat())?;
        if self.body == Body::Wheel {
            self.check_flange(&function)?;
        }
        Ok(function)
    }

    /// Refuses a wheel whose height ends on the face of its flange: contacts would be missed beyond that place.
    fn check_flange(&self, function: &HeightFunction) -> Result<(), ProfileError> {
        let first = function.range()[0];
        let [end, ..] = function.value_slope_curvature(first);
        let tip = self.at(self.curve.extreme(false)).place;
        if first <= tip[0] || end - tip[1] <= LOST_FLANGE {
            return Ok(());
        }
        Err(ProfileError::SteepFlange {
            name: self.name.clone(),
            place: [first, end],
            tip: tip[1],
            rough: self.is_rough(),
        })
    }

    /// Error of a profile that is nowhere flat.
    fn nowhere_flat(&self) -> ProfileError {
        ProfileError::NowhereFlat {
            name: self.name.clone(),
            rough: self.is_rough(),
        }
    }

    /// Sum of the sharp turns of the direction over the whole profile, to either side, rad.
    fn turning(&self) -> f64 {
        let curve = &self.curve;
        let tangents = curve.arcs().iter().map(|&arc| curve.at(arc).tangent);
        let next = tangents.clone().skip(1);
        let turn = |([uy, uz], [vy, vz]): ([f64; 2], [f64; 2])| (uy * vz - uz * vy).atan2(uy * vy + uz * vz).abs();
        tangents.zip(next).map(turn).filter(|&angle| angle > SHARP_TURN).sum()
    }

    /// Whether the profile turns to and fro by more than any wheel or rail does, as one that is measured and not smoothed may.
    pub fn is_rough(&self) -> bool {
        self.turning() > MOST_TURNING
    }

    /// Rail that is inclined by an angle, rad, its head towards the track's middle where that is positive, with the origin at its new
    /// highest point.
    ///
    /// # Errors
    /// The profile is a wheel's; the angle is not within ± 0.2 rad.
    pub fn inclined(&self, angle: f64) -> Result<Profile, ProfileError> {
        self.require(Body::Rail)?;
        if !(-STEEPEST_INCLINATION..=STEEPEST_INCLINATION).contains(&angle) {
            return Err(ProfileError::OutOfRange {
                name: "inclination of the rail",
                value: angle,
                minimum: -STEEPEST_INCLINATION,
                maximum: STEEPEST_INCLINATION,
                unit: "rad",
            });
        }
        let turned = self.curve.moved(angle, [0.0; 2]).ok_or_else(|| ProfileError::NoCurve {
            name: self.name.clone(),
            reason: "its points do not follow each other".to_owned(),
        })?;
        Profile::of_curve(Body::Rail, &self.name, &self.source, turned)
    }

    /// Lateral position of the rail's gauge face at a depth below its highest point, `m`: where the gauge is measured. It is
    /// negative.
    ///
    /// # Errors
    /// The profile is a wheel's, or does not reach that depth on its gauge side.
    pub fn gauge_point(&self, depth: f64) -> Result<f64, ProfileError> {
        self.require(Body::Rail)?;
        let arcs = self.curve.arcs();
        let top = arcs.partition_point(|&arc| arc < self.middle);
        let below = (0..top).rev().find(|&node| self.at(arcs[node]).place[1] <= -depth);
        match below {
            Some(node) if depth > 0.0 => {
                let next = arcs[node + 1].min(self.middle);
                let arc = self.curve.root(arcs[node], next, |point| point.place[1] + depth);
                Ok(self.at(arc).place[0])
            }
            _ => {
                let lowest = arcs[..top].iter().map(|&arc| self.at(arc).place[1]).fold(0.0, f64::min);
                Err(ProfileError::NotReached {
                    name: self.name.clone(),
                    what: "depth of the gauge below the top",
                    value: depth,
                    minimum: 0.0,
                    maximum: -lowest,
                })
            }
        }
    }

    /// Refuses the profile of the other body.
    ///
    /// # Errors
    /// The profile is that of the other body.
    pub fn require(&self, body: Body) -> Result<(), ProfileError> {
        if self.body == body {
            return Ok(());
        }
        Err(ProfileError::OtherBody {
            name: self.name.clone(),
            found: self.body.name(),
            needed: body.name(),
        })
    }
}

/// Returns the arc length at which y has a value, where y rises without a break from there to an arc length `about`; without that, the
/// first one at which it rises through the value.
fn rising(curve: &Curve, y: f64, about: Option<f64>) -> Option<f64> {
    let arcs = curve.arcs();
    let at = |node: usize| curve.at(arcs[node]).place[0];
    let node = match about {
        None => (0..arcs.len() - 1).find(|&node| at(node) <= y && y <= at(node + 1))?,
        Some(about) => {
            let start = (arcs.partition_point(|&arc| arc <= about).max(1) - 1).min(arcs.len() - 2);
            let mut node = start;
            while y < at(node) {
                node = node.checked_sub(1).filter(|&before| at(before) < at(before + 1))?;
            }
            while y > at(node + 1) {
                node += 1;
                if node + 1 == arcs.len() || at(node + 1) <= at(node) {
                    return None;
                }
            }
            node
        }
    };
    (y.is_finite()).then(|| curve.root(arcs[node], arcs[node + 1], |point| point.place[0] - y))
}

#[cfg(test)]
pub mod tests;
