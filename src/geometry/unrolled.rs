//! A wheel over the unrolled surface of a rail: the undeformed distance along the rail's normal, and the velocity of the wheel's
//! material there, with their derivatives.
//!
//! One side of the track is looked at: x forward, y from the track's middle to the field side, z up from the height of the rail's
//! top. A wheel on the right is the mirror image of one on the left. The wheel is a surface of revolution about its axle. With C the
//! axle's middle, R the turn of the wheelset by roll and then yaw, then back by the roll of the rail, q = Rᵀ(Q − C) and η = q_y − b the distance
//! from the running circle along the axle, a point Q lies outside of the wheel where
//!
//! f(Q) = √(q_x² + q_z²) − (r₀ − z_w(η)) > 0.
//!
//! The distance h from the rail's point P along its normal n solves f(P + h n) = 0; it is negative where the bodies overlap. A change
//! of the wheelset's position by dC and a turn dΘ changes it by dh = g·(dC + dΘ × (Q − C))/(g·n), with the gradient g of f.

use super::profile::HeightFunction;
use crate::numerics::root::crossing;

/// Point of the rail's surface and its normal, across the track.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct RailPoint {
    /// Place y, z, `m`.
    pub place: [f64; 2],
    /// Unit normal y, z, out of the rail.
    pub normal: [f64; 2],
}

impl RailPoint {
    /// Unit tangent y, z, towards the field side.
    pub fn tangent(&self) -> [f64; 2] {
        [self.normal[1], -self.normal[0]]
    }
}

/// Position of a wheelset over a rail, or a change of it. Of one side: y points to the field side, and is turned with a rolled rail. A wheel that
/// rises under a load does so along the vertical of the track: this is the direction of the height, so that `lateral` says all else of the place.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelsetPosition {
    /// Lateral position of the axle's middle, `m`: where the track's vertical through it meets the line across the rail at the height of its top.
    pub lateral: f64,
    /// Height of the axle's middle over that line along the track's vertical, `m`.
    pub height: f64,
    /// Roll about the forward axis, rad.
    pub roll: f64,
    /// Yaw about the vertical axis of the track, rad.
    pub yaw: f64,
    /// Roll of the rail in the track, rad: the vertical of the track is turned back by it.
    pub rail_roll: f64,
}

/// Motion of a wheelset over a rail, or a change of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct WheelsetMotion {
    /// Forward, lateral and vertical velocity of the axle's middle, `m/s`.
    pub velocity: [f64; 3],
    /// Roll rate, `rad/s`.
    pub roll_rate: f64,
    /// Yaw rate about the vertical axis of the track, `rad/s`.
    pub yaw_rate: f64,
    /// Angular velocity about the axle, positive in forward rolling, `rad/s`.
    pub spin: f64,
}

/// Shape of a wheel on its axle.
#[derive(Debug, Clone)]
pub struct Wheel {
    /// Height of the profile over the running circle, as a function of the distance η from it to the field side, `m`.
    pub profile: HeightFunction,
    /// Radius r₀ of the running circle, `m`.
    pub radius: f64,
    /// Distance b of the running circle from the axle's middle, `m`.
    pub offset: f64,
}

/// Wheel in its position.
pub struct PlacedWheel<'a> {
    wheel: &'a Wheel,
    /// Place of the axle's middle, `m`.
    pub centre: [f64; 3],
    /// Height of the axle's middle along the track's vertical, `m`.
    height: f64,
    /// R by rows.
    turn: [[f64; 3]; 3],
    /// Axis of the roll: forward, turned by the yaw.
    roll_axis: [f64; 3],
    /// Axis of the yaw: the vertical of the track.
    yaw_axis: [f64; 3],
}

/// Point of the wheel's surface over a point of the rail.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Distance {
    /// Undeformed distance h along the rail's normal, `m`; negative where the bodies overlap.
    pub distance: f64,
    /// Place Q − C on the wheel relative to the axle's middle, `m`.
    pub arm: [f64; 3],
    /// Gradient g of f at Q over its component g·n along the normal.
    pub gradient: [f64; 3],
    /// Second derivative of the distance along the rail, `1/m`.
    pub curvature_along: f64,
}

impl Distance {
    /// Distance a small way farther along the rail, `m`, to the second order.
    pub fn farther_along(&self, way: f64) -> f64 {
        // dh/dx = −g_x/(g·n).
        self.distance + way * (0.5 * way * self.curvature_along - self.gradient[0])
    }
}

/// Steps for the distance. Newton's method is quadratic from a guess that is better than the radius of the flange's tip.
const STEPS: usize = 12;
/// Distance that two steps may differ by at the end, `m`: round-off of a radius.
const TOLERANCE: f64 = 2e-16;
/// Step after which the distance is known to round-off, `m`, and what has been found of the wheel before it is carried on to the first order: at
/// most places one look at the profile in place of two.
const SHORT_STEP: f64 = 1e-8;
/// Way along the rail, `m`, over which the distance is known to the second order to much less than a nanometre, and its derivatives are the same to
/// 1e-4: on the tread, the way to the closest place over the next point, which is not looked at again. Without yaw there is none.
const SHORT_WAY: f64 = 1e-5;
/// Longest step, `m`: less than the radii of a flange.
const LONGEST_STEP: f64 = 3e-3;
/// Value of f, `m`, above which Newton's method has not found the wheel.
const LARGEST_ERROR: f64 = 1e-8;
/// Distance from the guess within which the wheel is then looked for in steps, and their length, `m`: worn grooves are broader.
const FARTHEST: f64 = 5e-3;
const GROOVE: f64 = 1e-4;
/// Way from the guess, `m`, after which the wheel has not been found as it is so far off.
const ON_THE_WAY: f64 = 0.9 * STEPS as f64 * LONGEST_STEP;
/// Distance where a rail's normal passes the wheel by, as below its flange, `m`: far more than any approach.
pub const NOWHERE: f64 = 0.1;
/// Least slope of f along the normal in a step: the wheel's surface may be seen from the side.
const LEAST_SLOPE: f64 = 0.05;

impl<'a> PlacedWheel<'a> {
    /// Wheel of a wheelset in a position.
    pub fn new(wheel: &'a Wheel, position: &WheelsetPosition) -> PlacedWheel<'a> {
        let ((sin_roll, cos_roll), (sin_yaw, cos_yaw)) = (position.roll.sin_cos(), position.yaw.sin_cos());
        let (sine, cosine) = position.rail_roll.sin_cos();
        // Rows of the turn in the axes of the track, and those of the rail's axes made of them.
        let lateral = [sin_yaw, cos_yaw * cos_roll, -cos_yaw * sin_roll];
        let upward = [0.0, sin_roll, cos_roll];
        let in_rail = |k: usize| {
            [
                cosine * lateral[k] + sine * upward[k],
                cosine * upward[k] - sine * lateral[k],
            ]
        };
        let rows = [0, 1, 2].map(in_rail);
        PlacedWheel {
            wheel,
            centre: [0.0, position.lateral + sine * position.height, cosine * position.height],
            height: position.height,
            turn: [
                [cos_yaw, -sin_yaw * cos_roll, sin_yaw * sin_roll],
                rows.map(|[lateral, _]| lateral),
                rows.map(|[_, upward]| upward),
            ],
            roll_axis: [cos_yaw, cosine * sin_yaw, -sine * sin_yaw],
            yaw_axis: [0.0, sine, cosine],
        }
    }

    /// Place across the track of a point of the wheel's profile, given from its running circle, where it stands below the axle.
    pub fn below_axle(&self, [position, height]: [f64; 2]) -> [f64; 2] {
        let [_, y, z] = self.to_track([0.0, self.wheel.offset + position, height - self.wheel.radius]);
        [self.centre[1] + y, self.centre[2] + z]
    }

    /// Distance from a rail's point at `x` `m` along its normal, from a guess of it, `m`. Where the normal passes the wheel by it is [`NOWHERE`], and nothing
    /// changes it.
    pub fn distance(&self, x: f64, point: &RailPoint, guess: f64) -> Distance {
        let normal = [0.0, point.normal[0], point.normal[1]];
        let from = sub([x, point.place[0], point.place[1]], self.centre);
        let (base, along) = (self.to_wheel(from), self.to_wheel(normal));
        let mut distance = guess;
        let mut found = self.at(base, along, distance);
        let mut leapt = false;
        for _ in 0..STEPS {
            let slope = found.gradient[0] * along[0] + found.gradient[1] * along[1] + found.gradient[2] * along[2];
            let slope = if slope.abs() < LEAST_SLOPE { -LEAST_SLOPE } else { slope };
            let step = (found.outside / slope).clamp(-LONGEST_STEP, LONGEST_STEP);
            leapt |= step.abs() == LONGEST_STEP;
            distance -= step;
            // The error after a step is that before, squared, over a radius of at least some millimetres.
            if step.abs() <= SHORT_STEP {
                found.go_on(along, -step);
                break;
            }
            found = self.at(base, along, distance);
            if found.outside.abs() <= TOLERANCE {
                break;
            }
        }
        // The wheel begins where f falls along the normal. Between the steep walls of a groove Newton's method goes to and fro, leaps over another wall, or
        // finds where the normal leaves the wheel.
        let missed = found.outside.abs() > LARGEST_ERROR || dot(found.gradient, along) >= 0.0;
        if missed || leapt && (distance - guess).abs() < FARTHEST {
            match self.nearest_crossing(base, along, guess) {
                Some(nearest) => {
                    distance = nearest;
                    found = self.at(base, along, distance);
                }
                // All steps went the same way to a wheel that is far off, or the normal passes the wheel by.
                None if missed && (distance - guess).abs() < ON_THE_WAY => {
                    return Distance {
                        distance: NOWHERE,
                        arm: add(from, normal, NOWHERE),
                        ..Distance::default()
                    };
                }
                None => {}
            }
        }
        let gradient = found.gradient;
        let slope = dot(gradient, along);
        let slope = if slope.abs() < LEAST_SLOPE { -LEAST_SLOPE } else { slope };
        // Along the wheel's surface over the rail's line: forward by dx, along the normal by dh.
        let forward = self.to_wheel([1.0, 0.0, 0.0]);
        let [tx, ty, tz] = add(forward, along, -dot(gradient, forward) / slope);
        let [qx, _, qz] = found.place;
        // Second derivative of f in this direction.
        let across = (qz * tx - qx * tz) / found.radius;
        let second = across * across / found.radius + found.second * ty * ty;
        Distance {
            distance,
            arm: add(from, normal, distance),
            gradient: self.to_track(gradient).map(|part| part / slope),
            curvature_along: -second / slope,
        }
    }

    /// Distance at which the wheel begins along the normal that is nearest to a guess of it, `m`; none where it begins nowhere near.
    #[cold]
    fn nearest_crossing(&self, base: [f64; 3], along: [f64; 3], guess: f64) -> Option<f64> {
        let outside = |distance: f64| self.at(base, along, distance).outside;
        // The values of f at the ends of the stretch that has been searched, which grows by a step on either side.
        let [mut low, mut high] = [outside(guess); 2];
        for step in 1..=(FARTHEST / GROOVE) as usize {
            let way = step as f64 * GROOVE;
            let (lower, higher) = (outside(guess - way), outside(guess + way));
            if high > 0.0 && higher <= 0.0 {
                return Some(crossing([guess + way - GROOVE, guess + way], outside));
            }
            if lower > 0.0 && low <= 0.0 {
                return Some(crossing([guess - way, guess - way + GROOVE], outside));
            }
            (low, high) = (lower, higher);
        }
        None
    }

    /// Change of the distance with that of the position.
    pub fn distance_change(&self, at: &Distance, change: &WheelsetPosition) -> f64 {
        let moved = self.displacement(at, change);
        dot(at.gradient, moved)
    }

    /// Displacement of the wheel's material at a point by a change of the position, `m`.
    fn displacement(&self, at: &Distance, change: &WheelsetPosition) -> [f64; 3] {
        let turned = cross(self.turn_vector(change), at.arm);
        add(self.centre_change(change), turned, 1.0)
    }

    /// Displacement of the axle's middle by a change of the position, `m`.
    fn centre_change(&self, change: &WheelsetPosition) -> [f64; 3] {
        // The axis of the yaw is the track's vertical, in the plane across the track.
        let [_, sine, cosine] = self.yaw_axis;
        let turned = self.height * change.rail_roll;
        [
            0.0,
            change.lateral + sine * change.height + cosine * turned,
            cosine * change.height - sine * turned,
        ]
    }

    /// Turn by a change of roll and yaw, and of the roll of the rail.
    fn turn_vector(&self, change: &WheelsetPosition) -> [f64; 3] {
        let roll = self.roll_axis.map(|part| part * change.roll);
        let [x, y, z] = add(roll, self.yaw_axis, change.yaw);
        [x - change.rail_roll, y, z]
    }

    /// Angular velocity.
    fn angular_velocity(&self, motion: &WheelsetMotion) -> [f64; 3] {
        let yaw = self.yaw_axis.map(|part| part * motion.yaw_rate);
        let roll = add(yaw, self.roll_axis, motion.roll_rate);
        add(roll, self.axle(), motion.spin)
    }

    /// Direction of the axle, to the field side: the wheel of the left side rolls forward about it.
    fn axle(&self) -> [f64; 3] {
        [self.turn[0][1], self.turn[1][1], self.turn[2][1]]
    }

    /// Distance η of a point from the running circle along the axle, to the field side, `m`.
    pub fn profile_position(&self, at: &Distance) -> f64 {
        dot(self.axle(), at.arm) - self.wheel.offset
    }

    /// Moment about the axle of a moment about the axle's middle.
    pub fn about_axle(&self, moment: [f64; 3]) -> f64 {
        dot(self.axle(), moment)
    }

    /// Angular velocity about the normal of a rail's point, out of the rail, `rad/s`.
    pub fn spin(&self, point: &RailPoint, motion: &WheelsetMotion) -> f64 {
        dot(self.angular_velocity(motion), [0.0, point.normal[0], point.normal[1]])
    }

    /// Velocity of the wheel's material at a point, `m/s`.
    pub fn velocity(&self, at: &Distance, motion: &WheelsetMotion) -> [f64; 3] {
        add(motion.velocity, cross(self.angular_velocity(motion), at.arm), 1.0)
    }

    /// Speed at which the wheelset approaches a rail's point along its normal, `m/s`: its turning about the axle moves no surface.
    pub fn approach_speed(&self, at: &Distance, point: &RailPoint, motion: &WheelsetMotion) -> f64 {
        let [_, across, up] = self.velocity(at, &WheelsetMotion { spin: 0.0, ..*motion });
        -(across * point.normal[0] + up * point.normal[1])
    }

    /// Change of that velocity over a rail's point with those of position and motion, `m/s`.
    pub fn velocity_change(
        &self,
        at: &Distance,
        point: &RailPoint,
        motion: &WheelsetMotion,
        change: (&WheelsetPosition, &WheelsetMotion),
    ) -> [f64; 3] {
        let (position, motion_change) = change;
        // The place Q moves along the normal, the axle's middle with the wheelset.
        let normal = [0.0, point.normal[0], point.normal[1]];
        let arm = sub(
            normal.map(|part| part * self.distance_change(at, position)),
            self.centre_change(position),
        );
        let turn = self.turn_vector(position);
        let axle = cross(turn, self.axle());
        let back = [-position.rail_roll, 0.0, 0.0];
        let roll_axis = cross(add(back, self.yaw_axis, position.yaw), self.roll_axis);
        let yaw_axis = cross(back, self.yaw_axis);
        let mut rate = self.angular_velocity(motion_change);
        rate = add(rate, axle, motion.spin);
        rate = add(rate, roll_axis, motion.roll_rate);
        rate = add(rate, yaw_axis, motion.yaw_rate);
        let turned = add(cross(rate, at.arm), cross(self.angular_velocity(motion), arm), 1.0);
        add(motion_change.velocity, turned, 1.0)
    }

    /// Places x along the rail, `m`, at which the distance over a rail's point is smallest, and the distance there: by Newton's method
    /// from a guess of both.
    pub fn closest(&self, point: &RailPoint, guess: (f64, f64)) -> (f64, Distance) {
        let (mut x, distance) = guess;
        let mut at = self.distance(x, point, distance);
        for _ in 0..STEPS {
            // dh/dx = −g_x/(g·n).
            let slope = -at.gradient[0];
            if at.curvature_along <= 0.0 {
                break;
            }
            let step = (slope / at.curvature_along).clamp(-LONGEST_STEP * 10.0, LONGEST_STEP * 10.0);
            x -= step;
            let distance = at.farther_along(-step);
            if step.abs() < SHORT_WAY {
                at.distance = distance;
                break;
            }
            at = self.distance(x, point, distance);
        }
        (x, at)
    }

    /// f and its gradient in the wheel's own axes, at a distance along the normal.
    fn at(&self, base: [f64; 3], along: [f64; 3], distance: f64) -> Outside {
        let [qx, qy, qz] = add(base, along, distance);
        // `hypot`, which takes longer, would keep squares from overflow: none is near.
        let radius = (qx * qx + qz * qz).sqrt();
        let [height, slope, second] = self.wheel.profile.value_slope_curvature(qy - self.wheel.offset);
        Outside {
            outside: radius - self.wheel.radius + height,
            gradient: [qx / radius, slope, qz / radius],
            place: [qx, qy, qz],
            radius,
            second,
        }
    }

    fn to_wheel(&self, vector: [f64; 3]) -> [f64; 3] {
        let turn = &self.turn;
        [0, 1, 2].map(|k| turn[0][k] * vector[0] + turn[1][k] * vector[1] + turn[2][k] * vector[2])
    }

    fn to_track(&self, vector: [f64; 3]) -> [f64; 3] {
        [0, 1, 2].map(|k| dot(self.turn[k], vector))
    }
}

/// f, its gradient in the wheel's axes, and where they were taken.
struct Outside {
    outside: f64,
    gradient: [f64; 3],
    place: [f64; 3],
    radius: f64,
    /// Second derivative of the profile's height.
    second: f64,
}

impl Outside {
    /// Goes on by a short way in a direction, `m`, to the first order.
    fn go_on(&mut self, direction: [f64; 3], way: f64) {
        self.outside += way * dot(self.gradient, direction);
        self.place = add(self.place, direction, way);
        let [qx, _, qz] = self.place;
        self.radius = (qx * qx + qz * qz).sqrt();
        let slope = self.gradient[1] + way * direction[1] * self.second;
        self.gradient = [qx / self.radius, slope, qz / self.radius];
    }
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn sub(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// a + factor b.
fn add(a: [f64; 3], b: [f64; 3], factor: f64) -> [f64; 3] {
    [a[0] + factor * b[0], a[1] + factor * b[1], a[2] + factor * b[2]]
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}
