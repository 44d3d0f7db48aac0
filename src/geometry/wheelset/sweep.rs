//! Contact geometry over the lateral displacement.

use super::conicity::{Conicity, KinematicMotion};
use super::{Pose, Wheelset};
use crate::error::ProfileError;

/// Displacements at most: each takes some milliseconds.
const MOST: usize = 20_000;
/// Way of a contact on the wheel between two displacements above which a jump is looked for, `m`.
const SUSPECT: f64 = 0.3e-3;
/// Way that is a jump where the displacement changes by [`CLOSE`], `m`.
const LEAP: f64 = 0.1e-3;
/// Displacement down to which a jump is found, `m`.
const CLOSE: f64 = 1e-8;
/// Part of a step that is round-off: of 2 million steps of 1e-7 m, which the farthest displacement is away from 0, it is 1e-9.
const ROUNDING: f64 = 1e-9;
/// Round-off of a displacement, which is 0.2 m at most, `m`.
const ROUND_OFF: f64 = 1e-16;
/// Picometres in a metre.
const PICOMETRES: f64 = 1e12;

/// Jump of a contact at a lateral displacement: there the wheel touches at two places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Jump {
    /// Lateral displacement, `m`.
    pub lateral: f64,
    /// Side: 0 left, 1 right.
    pub side: usize,
    /// Place on the wheel at smaller and at larger displacements, `m`.
    pub on_wheel: [f64; 2],
    /// Place on the rail at smaller and at larger displacements, `m`.
    pub on_rail: [f64; 2],
    /// Difference of the rolling radii, left less right, at smaller and at larger displacements, `m`.
    pub radius_difference: [f64; 2],
}

/// Places of a wheelset over its lateral displacement, and what follows from them.
#[derive(Debug, Clone, PartialEq)]
pub struct Sweep {
    /// Places by ascending displacement.
    pub poses: Vec<Pose>,
    /// Jumps by ascending displacement.
    pub jumps: Vec<Jump>,
}

impl Sweep {
    /// Places from the first displacement of a `range` on in steps of `step` as far as the last one, `m`, at a yaw, rad: the last one is among them where it
    /// is a whole number of steps away, to round-off.
    ///
    /// # Errors
    /// The range or the step is none, or a wheel stands beside its rail or on its flange.
    pub fn new(wheelset: &Wheelset, range: [f64; 2], step: f64, yaw: f64) -> Result<Sweep, ProfileError> {
        let refused = |name, value, minimum, maximum| ProfileError::OutOfRange {
            name,
            value,
            minimum,
            maximum,
            unit: "m",
        };
        let [first, last] = range;
        if !(-0.2..=0.2).contains(&first) {
            return Err(refused("first displacement", first, -0.2, 0.2));
        }
        if !(first..=0.2).contains(&last) {
            return Err(refused("last displacement", last, first, 0.2));
        }
        let shortest = ((last - first) / MOST as f64).max(1e-7);
        if !(shortest..=0.1).contains(&step) {
            return Err(refused("step", step, shortest, 0.1));
        }
        let count = ((last - first) / step + ROUNDING).floor() as usize;
        // From a multiple of the step on, all displacements are the nearest numbers to multiples: 0 is 0, and both signs have the same ones.
        let number = (first / step).round();
        let begins_at_multiple = (first / step - number).abs() <= ROUNDING;
        let lateral = |k: usize| {
            let displacement = if begins_at_multiple {
                (number + k as f64) * step
            } else {
                first + k as f64 * step
            };
            without_round_off(displacement)
        };
        let poses = (0..=count)
            .map(|k| wheelset.at(lateral(k), yaw))
            .collect::<Result<Vec<_>, _>>()?;
        let mut jumps = Vec::new();
        for pair in poses.windows(2) {
            for side in 0..2 {
                jumps.extend(jump(wheelset, &pair[0], &pair[1], side)?);
            }
        }
        Ok(Sweep { poses, jumps })
    }

    /// Kinematic motion with the difference of the rolling radii over the displacement: with both values at each jump, a displacement of
    /// 1e-8 m apart, so that lines between the points are as good between the jumps as beside them. `None` of a single displacement.
    pub fn motion(&self) -> Option<KinematicMotion> {
        let poses = self.poses.iter().map(|pose| (pose.lateral, pose.radius_difference()));
        let jumps = self.jumps.iter().flat_map(|jump| {
            let [before, after] = jump.radius_difference;
            [
                (jump.lateral - 0.5 * CLOSE, before),
                (jump.lateral + 0.5 * CLOSE, after),
            ]
        });
        let mut points: Vec<_> = poses.chain(jumps).collect();
        points.sort_by(|a, b| a.0.total_cmp(&b.0));
        // Jumps of both sides at one displacement are one, and one at a displacement of the table is between it and the next one.
        points.dedup_by(|next, last| next.0 - last.0 < 0.1 * CLOSE);
        let (lateral, difference) = points.into_iter().unzip();
        KinematicMotion::new(lateral, difference)
    }

    /// Equivalent conicity of an amplitude, `m`; `None` where no motion of that amplitude lies within the displacements.
    pub fn conicity(&self, amplitude: f64) -> Option<Conicity> {
        self.motion()?.conicity(amplitude)
    }
}

/// Displacement as a table has it, `m`: in whole picometres where it is that to round-off, without the digits of that.
fn without_round_off(displacement: f64) -> f64 {
    let rounded = (PICOMETRES * displacement).round() / PICOMETRES;
    if (rounded - displacement).abs() <= ROUND_OFF {
        rounded
    } else {
        displacement
    }
}

/// Jump of a side's contact between two places, by bisection over the displacement; of several the largest one.
fn jump(wheelset: &Wheelset, from: &Pose, to: &Pose, side: usize) -> Result<Option<Jump>, ProfileError> {
    let way = |a: &Pose, b: &Pose| (b.touches[side].on_wheel - a.touches[side].on_wheel).abs();
    let (mut from, mut to) = (*from, *to);
    if way(&from, &to) < SUSPECT {
        return Ok(None);
    }
    while to.lateral - from.lateral > CLOSE {
        let middle = wheelset.at(0.5 * (from.lateral + to.lateral), from.yaw)?;
        if way(&from, &middle) > way(&middle, &to) {
            to = middle;
        } else {
            from = middle;
        }
        if way(&from, &to) < LEAP {
            return Ok(None);
        }
    }
    let touches = [from.touches[side], to.touches[side]];
    Ok(Some(Jump {
        lateral: 0.5 * (from.lateral + to.lateral),
        side,
        on_wheel: touches.map(|touch| touch.on_wheel),
        on_rail: touches.map(|touch| touch.on_rail),
        radius_difference: [from, to].map(|pose| pose.radius_difference()),
    }))
}
