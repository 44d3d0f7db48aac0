//! The way from a file's coordinates to the profile's frame: unit, direction of y and z, origin of a wheel.
//!
//! What file and options do not say is tried: each way of turning the profile that is left is held against the shape of its body. One
//! way that fits is taken, and named in the profile's source; none, or more than one, is an error that says what was seen.

use super::{Lateral, LengthUnit, Raw, ReadOptions, Weighted};
use crate::error::{ProfileError, in_thousandths};
use crate::geometry::profile::Body;
use crate::geometry::profile::measured::cleaned;

/// Largest extent of a profile, `m`, by which its unit is found: heads of rails, treads with flanges, with all that is measured beside.
const EXTENTS: [f64; 2] = [0.02, 0.3];
/// Distance of the points from which directions are taken, `m`: more than the roughness of a measurement.
const CHORD: f64 = 1e-3;
/// Turn to the left, degrees, of a flange's tip at least, and of a profile without a flange at most.
const HOLLOW: [f64; 2] = [40.0, 30.0];
/// Distance from the flange's tip within which it turns, `m`.
const TIP: f64 = 20e-3;
/// Height of a flange's tip below the tread, `m`.
const FLANGE: [f64; 2] = [12e-3, 45e-3];
/// Part of the profile, from the flange's tip, that is tread in any case, `m`.
const TREAD: [f64; 2] = [35e-3, 55e-3];
/// Breadth of that part at least, and height at most, `m`: it is flat, new or worn.
const FLAT_PART: [f64; 2] = [10e-3, 8e-3];
/// Places of the running circle from the flange's tip that are plausible, `m`.
const DATUM: [f64; 2] = [30e-3, 80e-3];
/// Height of a profile without a flange, and depth of a tread's end below its middle, `m`: at the rim it may rise as it likes.
const FLAT: f64 = 12e-3;
/// Distance of a rail's highest point from its ends, at least, `m`.
const SHOULDER: f64 = 3e-3;
/// Depths below a rail's top between which a head has sides, and a flange that is turned upward the tread beside it, `m`.
const SIDES: [f64; 2] = [12e-3, 45e-3];
/// Breadth of what is flat there, at most, `m`, and the slope up to which it counts: a worn head has a ledge.
const LEDGE: (f64, f64) = (25e-3, 0.3);
/// Deviation up to which a rail is the same from both sides, `m`.
const SYMMETRIC: f64 = 0.05e-3;

/// Points that the shape of a body takes at least: a flange's tip with one on each side of it, and a tread of two.
const SHAPE_POINTS: usize = 5;

/// Points in the profile's frame, and what was found out for that, as the end of a sentence.
///
/// # Errors
/// There are too few points, one is not finite, or they have not the shape of the body.
pub fn framed(
    name: &str,
    body: Body,
    raw: Raw,
    options: &ReadOptions,
) -> Result<(Vec<Weighted>, String), ProfileError> {
    let count = raw.points.len();
    // Fewer may do where all is known of them, as of a rail's top and its two sides; where they do not, their number is the reason.
    turned_to_frame(name, body, raw, options).map_err(|error| match error {
        _ if count < SHAPE_POINTS => ProfileError::NoCurve {
            name: name.to_owned(),
            reason: format!(
                "too few points, {count}: at least {SHAPE_POINTS} show a {}",
                body.name()
            ),
        },
        error => error,
    })
}

fn turned_to_frame(
    name: &str,
    body: Body,
    raw: Raw,
    options: &ReadOptions,
) -> Result<(Vec<Weighted>, String), ProfileError> {
    let not_finite = raw
        .points
        .iter()
        .position(|point| point.place.iter().any(|value| !value.is_finite()));
    if let Some(point) = not_finite {
        let [y, z] = raw.points[point].place;
        return Err(ProfileError::NoCurve {
            name: name.to_owned(),
            reason: format!("point {} is ({y}, {z}): not finite", point + 1),
        });
    }
    let mut found = String::new();
    let unit = match options.unit.map(LengthUnit::metres).or(raw.unit) {
        Some(unit) => unit,
        None => {
            let (unit, called) = unit_by_size(name, &raw.points)?;
            found += &format!(", in {called} by its size");
            unit
        }
    };
    let points: Vec<_> = raw
        .points
        .iter()
        .map(|point| Weighted {
            place: point.place.map(|value| unit * value),
            ..*point
        })
        .collect();
    let (y_to, z_up) = (options.y_to.or(raw.y_to), options.z_up.or(raw.z_up));
    let (mut points, turned) = turned(name, body, &points, y_to, z_up)?;
    found += &turned;
    if body == Body::Wheel {
        if let Some(distance) = options.flange_back_position {
            let back = points.iter().map(|point| point.place[0]).fold(f64::INFINITY, f64::min);
            points.iter_mut().for_each(|point| point.place[0] -= back + distance);
        }
        check_datum(name, &points)?;
    }
    Ok((points, found))
}

/// Unit with which the points are as large as a profile.
fn unit_by_size(name: &str, points: &[Weighted]) -> Result<(f64, &'static str), ProfileError> {
    let extent = |k: usize| {
        let values = || points.iter().map(|point| point.place[k]);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let size = extent(0).max(extent(1));
    let fits = |unit: f64| (EXTENTS[0]..=EXTENTS[1]).contains(&(unit * size));
    match (fits(1e-3), fits(1.0)) {
        (true, false) => Ok((1e-3, "mm")),
        (false, true) => Ok((1.0, "m")),
        _ => Err(ProfileError::NotSaid {
            name: name.to_owned(),
            seen: format!("it is {size} long or high, in an unknown unit"),
            option: "unit",
        }),
    }
}

/// The points turned such that they have the shape of their body, and how that was found.
fn turned(
    name: &str,
    body: Body,
    points: &[Weighted],
    y_to: Option<Lateral>,
    z_up: Option<bool>,
) -> Result<(Vec<Weighted>, String), ProfileError> {
    let mut fitting: Vec<([f64; 2], Vec<Weighted>)> = Vec::new();
    let mut seen = String::new();
    let mut symmetric = false;
    for z in [1.0, -1.0] {
        for y in [1.0, -1.0] {
            let excluded = y_to.is_some_and(|y_to| (y_to == Lateral::ToField) != (y > 0.0));
            if excluded || z_up.is_some_and(|up| up != (z > 0.0)) {
                continue;
            }
            let candidate = ordered(points, [y, z]);
            let shape = Shape::of(&candidate);
            let verdict = match body {
                Body::Rail => shape.is_rail(),
                Body::Wheel => shape.is_wheel(y_to.is_some() && z_up.is_some()),
            };
            match verdict {
                Ok(()) => {
                    symmetric |= body == Body::Rail && shape.is_symmetric();
                    fitting.push(([y, z], candidate));
                }
                Err(reason) if seen.is_empty() => seen = reason,
                Err(_) => {}
            }
        }
    }
    let asked = |seen: &str, option| ProfileError::NotSaid {
        name: name.to_owned(),
        seen: seen.to_owned(),
        option,
    };
    match fitting.len() {
        0 => Err(ProfileError::Orientation {
            name: name.to_owned(),
            body: body.name(),
            seen,
        }),
        1 => {
            let ([y, z], points) = fitting.remove(0);
            let turns = [
                (
                    y_to.is_none(),
                    y < 0.0,
                    ", y to the gauge side by its shape",
                    ", y to the field side by its shape",
                ),
                (
                    z_up.is_none(),
                    z < 0.0,
                    ", z downward by its shape",
                    ", z upward by its shape",
                ),
            ];
            let said = turns
                .iter()
                .filter(|turn| turn.0)
                .map(|turn| if turn.1 { turn.2 } else { turn.3 });
            Ok((points, said.collect()))
        }
        _ if fitting.iter().any(|(signs, _)| signs[1] != fitting[0].0[1]) => {
            Err(asked("its shape does not tell whether z points upward", "z_up"))
        }
        _ if symmetric => Ok((fitting.remove(0).1, ", the same from both sides".to_owned())),
        _ if body == Body::Rail => Err(asked(
            "its shape does not tell the gauge side from the field side",
            "y_to",
        )),
        _ => Err(asked(
            "its shape does not tell the flange side from the field side",
            "y_to",
        )),
    }
}

/// Points with turned signs, from the gauge side to the field side.
fn ordered(points: &[Weighted], signs: [f64; 2]) -> Vec<Weighted> {
    let turned = points.iter().map(|point| Weighted {
        place: [0, 1].map(|k| signs[k] * point.place[k]),
        ..*point
    });
    let mut turned: Vec<_> = turned.collect();
    let lateral = |point: Option<&Weighted>| point.map_or(0.0, |point| point.place[0]);
    if lateral(turned.first()) > lateral(turned.last()) {
        turned.reverse();
    }
    turned
}

/// Refuses a wheel whose running circle is not on its tread.
fn check_datum(name: &str, points: &[Weighted]) -> Result<(), ProfileError> {
    let Some(tip) = points.iter().min_by(|a, b| a.place[1].total_cmp(&b.place[1])) else {
        return Ok(());
    };
    let [y, z] = tip.place;
    let tread = points
        .iter()
        .map(|point| point.place[1])
        .fold(f64::NEG_INFINITY, f64::max);
    let has_flange = tread - z >= FLANGE[0];
    if has_flange && !(DATUM[0]..=DATUM[1]).contains(&-y) {
        return Err(ProfileError::NotSaid {
            name: name.to_owned(),
            seen: format!(
                "its running circle is to be at y = 0, {} to {} mm from the tip of the flange, which is at y = {:.2} mm",
                in_thousandths(DATUM[0]),
                in_thousandths(DATUM[1]),
                1e3 * y
            ),
            option: "flange_back_position",
        });
    }
    Ok(())
}

/// Outline of a profile in steps of a millimetre, from the gauge side to the field side.
struct Shape {
    points: Vec<[f64; 2]>,
}

fn in_mm(value: f64) -> f64 {
    (1e5 * value).round() / 1e2
}

impl Shape {
    fn of(points: &[Weighted]) -> Shape {
        let mut kept: Vec<[f64; 2]> = Vec::new();
        for point in cleaned(points) {
            let [y, z] = point.place;
            if kept.last().is_none_or(|last| (y - last[0]).hypot(z - last[1]) >= CHORD) {
                kept.push(point.place);
            }
        }
        Shape { points: kept }
    }

    /// Largest turn to the left between two chords, degrees, over points that follow each other and that a predicate takes: of a rough
    /// profile the turns back and forth do not count.
    fn left_turn(&self, takes: impl Fn([f64; 2]) -> bool) -> f64 {
        let (mut angle, mut lowest, mut largest) = (0.0f64, 0.0f64, 0.0f64);
        for three in self.points.windows(3) {
            let [u, v] = [0, 1].map(|k| [0, 1].map(|c| three[k + 1][c] - three[k][c]));
            if takes(three[1]) {
                angle += (u[0] * v[1] - u[1] * v[0]).atan2(u[0] * v[0] + u[1] * v[1]);
            } else {
                (angle, lowest) = (0.0, 0.0);
            }
            lowest = lowest.min(angle);
            largest = largest.max(angle - lowest);
        }
        largest.to_degrees()
    }

    fn extreme(&self, highest: bool) -> Option<[f64; 2]> {
        let sign = if highest { 1.0 } else { -1.0 };
        self.points
            .iter()
            .copied()
            .max_by(|a, b| (sign * a[1]).total_cmp(&(sign * b[1])))
    }

    /// Whether this is a tread with its flange, at smaller y and below it; or without, where its directions are `known`.
    fn is_wheel(&self, known: bool) -> Result<(), String> {
        let few = || "it has too few points".to_owned();
        let ([y, z], [_, top]) = (
            self.extreme(false).ok_or_else(few)?,
            self.extreme(true).ok_or_else(few)?,
        );
        let hollow = self.left_turn(|point| (point[0] - y).abs() < TIP);
        if top - z < FLAT && hollow < HOLLOW[1] && known {
            return Ok(());
        }
        let beyond = || self.points.iter().filter(|p| p[0] >= y + TREAD[0]);
        let mut tread: Vec<_> = beyond().filter(|p| p[0] <= y + TREAD[1]).copied().collect();
        let place = format!("its lowest point is at ({}, {}) mm", in_mm(y), in_mm(z));
        let extent = |k: usize| {
            let values = || tread.iter().map(|p| p[k]);
            values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
        };
        if tread.is_empty() || extent(0) < FLAT_PART[0] || extent(1) > FLAT_PART[1] {
            let [from, to] = TREAD.map(in_mm);
            return Err(format!(
                "{place}, and there is no tread {from} to {to} mm beside it towards larger y"
            ));
        }
        tread.sort_by(|a, b| a[1].total_cmp(&b[1]));
        let level = tread[tread.len() / 2][1];
        let height = level - z;
        if !(FLANGE[0]..=FLANGE[1]).contains(&height) {
            let [low, high] = FLANGE.map(in_mm);
            return Err(format!(
                "{place}, {} mm below a tread; a flange is {low} to {high} mm high",
                in_mm(height)
            ));
        }
        if let Some(far) = beyond().find(|p| p[1] < level - FLAT) {
            let depth = in_mm(level - far[1]);
            return Err(format!(
                "{place}, and beyond a tread the profile falls by {depth} mm at y = {} mm",
                in_mm(far[0])
            ));
        }
        if hollow < HOLLOW[0] {
            return Err(format!(
                "{place}, and no flange turns about it, by {} degrees or more",
                HOLLOW[0]
            ));
        }
        Ok(())
    }

    /// Whether this is a head that is convex upward, with shoulders on both sides.
    fn is_rail(&self) -> Result<(), String> {
        let few = || "it has too few points".to_owned();
        let [y, z] = self.extreme(true).ok_or_else(few)?;
        let (first, last) = (self.points[0][0], self.points[self.points.len() - 1][0]);
        let place = format!("its highest point is at ({}, {}) mm", in_mm(y), in_mm(z));
        if y - first < SHOULDER || last - y < SHOULDER {
            return Err(format!("{place}, within {} mm of its end", in_mm(SHOULDER)));
        }
        let [from, to] = SIDES;
        let ledges = self
            .points
            .windows(2)
            .filter(|pair| (from..=to).contains(&(z - pair[0][1])));
        let steps = ledges.map(|pair| [0, 1].map(|k| (pair[1][k] - pair[0][k]).abs()));
        let flat: f64 = steps
            .filter(|step| step[1] < LEDGE.1 * step[0])
            .map(|step| step[0])
            .sum();
        if flat > LEDGE.0 {
            let [from, to, flat] = [from, to, flat].map(in_mm);
            return Err(format!(
                "{place}, and it is flat over {flat} mm, {from} to {to} mm below"
            ));
        }
        Ok(())
    }

    /// Whether a rail is its own mirror image, down to 14 mm below its top.
    fn is_symmetric(&self) -> bool {
        let Some([_, top]) = self.extreme(true) else {
            return false;
        };
        let middles: Option<Vec<f64>> = (1..=7)
            .map(|step| {
                let level = top - 2e-3 * f64::from(step);
                let crossing = |pair: &[[f64; 2]]| {
                    let [a, b] = [pair[0], pair[1]];
                    (a[1] - level) * (b[1] - level) <= 0.0 && a[1] != b[1]
                };
                let place = |pair: &[[f64; 2]]| {
                    let share = (level - pair[0][1]) / (pair[1][1] - pair[0][1]);
                    pair[0][0] + share * (pair[1][0] - pair[0][0])
                };
                let mut crossings = self.points.windows(2).filter(|pair| crossing(pair)).map(place);
                let first = crossings.next()?;
                Some(0.5 * (first + crossings.next_back()?))
            })
            .collect();
        middles.is_some_and(|middles| {
            let (low, high) = middles
                .iter()
                .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), &middle| {
                    (low.min(middle), high.max(middle))
                });
            high - low < SYMMETRIC
        })
    }
}
