//! Curves through points, measured or computed ones.
//!
//! Points that lie on each other are one. Where the way over the points turns back, by more than 150°, the points are averaged. A turn of
//! more than 30° at a single point, with no other one within 2 mm, is a kink and stays one; between kinks the curve is a smoothing
//! spline over the length of the chords.

use super::CurvePoint;
use super::curve::{CELL, Curve, Piece};
use crate::error::{ProfileError, in_thousandths};
use crate::geometry::quintics::Jet;
use crate::geometry::spline::{CubicSpline, penalty};

/// Points at most: a measurement of a micrometre's spacing has a fifth of it.
pub const MOST_POINTS: usize = 1_000_000;
/// Distance below which two points are one, `m`: a fifth of what MiniProf resolves along the profile.
const NEAREST: f64 = 5e-6;
/// Lengths that a profile can have, `m`.
const LENGTHS: [f64; 2] = [5e-3, 0.5];
/// Wavelength of the smoothing at most, `m`, as of the parameter `profile_smoothing`.
const LONGEST_WAVE: f64 = 0.1;
/// Turn, rad, above which the way goes back.
const BACK: f64 = 150.0 / 180.0 * std::f64::consts::PI;
/// Turn, rad, above which a single point is a kink.
const KINK: f64 = 30.0 / 180.0 * std::f64::consts::PI;
/// Distance within which a kink has no other beside it, `m`.
const ALONE: f64 = 2e-3;
/// Gap, `m`, that is refused where it is this many times the median of the distances between points.
const GAP: (f64, f64) = (15e-3, 10.0);
/// Weight of a kink against that of other points: both sides of it meet there.
const KINK_WEIGHT: f64 = 1e6;
/// Shortest cell of the curve, `m`: where half of the points are this far from each other or more, and, however close they are, 10,000 cells for the longest
/// profile.
const SHORTEST_CELL: [f64; 2] = [5e-6, 0.05e-3];
/// Median of the distances of points, `m`, from which on all of them end cells.
const WIDE: f64 = 0.04e-3;

/// A point with its weight in the smoothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Weighted {
    /// Lateral position and height, `m`.
    pub place: [f64; 2],
    /// Weight, 1 of an ordinary point.
    pub weight: f64,
}

fn distance(a: &Weighted, b: &Weighted) -> f64 {
    (b.place[0] - a.place[0]).hypot(b.place[1] - a.place[1])
}

/// Returns the change of direction at the middle one of three points, rad, positive to the left.
fn turn(a: &Weighted, b: &Weighted, c: &Weighted) -> f64 {
    let [uy, uz] = [0, 1].map(|k| b.place[k] - a.place[k]);
    let [vy, vz] = [0, 1].map(|k| c.place[k] - b.place[k]);
    (uy * vz - uz * vy).atan2(uy * vy + uz * vz)
}

fn mean(a: &Weighted, b: &Weighted) -> Weighted {
    let weight = a.weight + b.weight;
    Weighted {
        place: [0, 1].map(|k| (a.weight * a.place[k] + b.weight * b.place[k]) / weight),
        weight: 0.5 * weight,
    }
}

/// Points without duplicates and without ways back, in their order.
pub fn cleaned(points: &[Weighted]) -> Vec<Weighted> {
    let mut kept: Vec<Weighted> = Vec::with_capacity(points.len());
    for point in points {
        kept.push(*point);
        // Each round takes a point away, and may bring to light another way back before it.
        while let [.., last, this] = kept[..] {
            let goes_back = match kept[..] {
                [.., before, last, this] => turn(&before, &last, &this).abs() > BACK,
                _ => false,
            };
            if distance(&last, &this) >= NEAREST && !goes_back {
                break;
            }
            let merged = mean(&last, &this);
            kept.truncate(kept.len() - 2);
            kept.push(merged);
        }
    }
    kept
}

/// Curve of points in their order, smoothed such that waves of the given length, `m`, are damped to a half; 0 goes through the points.
///
/// # Errors
/// The points are too few, too many or not numbers, the curve they make is too short or too long, or it has a gap.
pub fn curve(name: &str, points: &[Weighted], smoothing: f64) -> Result<Curve, ProfileError> {
    let refused = |reason: String| ProfileError::NoCurve {
        name: name.to_owned(),
        reason,
    };
    if points.len() > MOST_POINTS {
        return Err(refused(format!("{} points, more than {MOST_POINTS}", points.len())));
    }
    if !(0.0..=LONGEST_WAVE).contains(&smoothing) {
        return Err(ProfileError::OutOfRange {
            name: "smoothing",
            value: smoothing,
            minimum: 0.0,
            maximum: LONGEST_WAVE,
            unit: "m",
        });
    }
    for (number, point) in (1..).zip(points) {
        let [y, z] = point.place;
        if !(y.is_finite() && z.is_finite() && point.weight.is_finite() && point.weight > 0.0) {
            return Err(refused(format!(
                "point {number} is ({y}, {z}) with weight {}: not finite",
                point.weight
            )));
        }
    }
    let points = cleaned(points);
    if points.len() < 3 {
        return Err(refused(format!(
            "{} distinct points: at least 3 are needed",
            points.len()
        )));
    }
    let chords: Vec<f64> = points.windows(2).map(|pair| distance(&pair[0], &pair[1])).collect();
    let length: f64 = chords.iter().sum();
    if !(LENGTHS[0]..=LENGTHS[1]).contains(&length) {
        let [shortest, longest] = LENGTHS.map(in_thousandths);
        let found = in_thousandths(length);
        return Err(refused(format!(
            "it is {found} mm long: allowed is {shortest} to {longest} mm"
        )));
    }
    let mut sorted = chords.clone();
    sorted.sort_by(f64::total_cmp);
    let median = sorted[sorted.len() / 2];
    if let Some(gap) = chords.iter().position(|&chord| chord > GAP.0 && chord > GAP.1 * median) {
        let (from, to) = (
            points[gap].place.map(|v| 1e3 * v),
            points[gap + 1].place.map(|v| 1e3 * v),
        );
        return Err(refused(format!(
            "a gap of {:.1} mm between ({:.3}, {:.3}) and ({:.3}, {:.3}) mm: these are two branches, and one is needed",
            1e3 * chords[gap],
            from[0],
            from[1],
            to[0],
            to[1]
        )));
    }
    let shortest = SHORTEST_CELL[usize::from(median < WIDE)];
    let mut pieces = Vec::new();
    let ends = piece_ends(&points, &chords);
    for pair in ends.windows(2) {
        let inner = [pair[0] > 0, pair[1] + 1 < points.len()];
        let piece = piece(&points[pair[0]..=pair[1]], inner, smoothing, shortest);
        pieces.push(piece.ok_or_else(|| refused("its points make no spline".to_owned()))?);
    }
    // A kink below the bound is smooth only by rounding: the ends of pieces are kinks by construction.
    Curve::of_pieces(pieces, 0.0).ok_or_else(|| refused("its points do not follow each other".to_owned()))
}

/// Numbers of the points at which pieces end: the first, the kinks, the last.
fn piece_ends(points: &[Weighted], chords: &[f64]) -> Vec<usize> {
    let mut arcs = vec![0.0];
    for chord in chords {
        arcs.push(arcs[arcs.len() - 1] + chord);
    }
    let sharp: Vec<usize> = (1..points.len() - 1)
        .filter(|&k| turn(&points[k - 1], &points[k], &points[k + 1]).abs() > KINK)
        .collect();
    let alone = |place: usize| {
        let near = |other: Option<&usize>| other.is_some_and(|&k| (arcs[k] - arcs[sharp[place]]).abs() < ALONE);
        !near(place.checked_sub(1).and_then(|before| sharp.get(before))) && !near(sharp.get(place + 1))
    };
    let mut ends = vec![0];
    ends.extend((0..sharp.len()).filter(|&place| alone(place)).map(|place| sharp[place]));
    ends.push(points.len() - 1);
    ends
}

/// Returns place, direction and curvature of a jet over any parameter, and its speed over it.
fn point([[y, dy, ddy], [z, dz, ddz]]: Jet<2>) -> (CurvePoint, f64) {
    let speed = dy.hypot(dz);
    let point = CurvePoint {
        place: [y, z],
        tangent: [dy / speed, dz / speed],
        curvature: (dy * ddz - dz * ddy) / (speed * speed * speed),
    };
    (point, speed)
}

/// Nodes of a smoothing spline through points: at its knots where these are `shortest` or more apart, so that no cell has a jump of the third derivative in it,
/// and between them where they are far apart. `inner` says which of the two ends are kinks.
fn piece(points: &[Weighted], inner: [bool; 2], smoothing: f64, shortest: f64) -> Option<Piece> {
    let mut knots = vec![0.0];
    for pair in points.windows(2) {
        knots.push(knots[knots.len() - 1] + distance(&pair[0], &pair[1]));
    }
    let last = knots.len() - 1;
    let weights: Vec<f64> = (0..=last)
        .map(|k| {
            let spacing = 0.5 * (knots[(k + 1).min(last)] - knots[k.saturating_sub(1)]);
            let pinned = (k == 0 && inner[0]) || (k == last && inner[1]);
            points[k].weight * spacing * if pinned { KINK_WEIGHT } else { 1.0 }
        })
        .collect();
    let places: Vec<_> = points.iter().map(|point| point.place).collect();
    let spline = CubicSpline::new(&knots, &places, &weights, penalty(smoothing))?;

    let end = knots[last];
    let mut nodes = vec![(0.0, point(spline.at(0.0)).0)];
    let (mut node, mut from, mut length) = (0.0, 0.0, 0.0);
    for &knot in &knots[1..] {
        let far = knot == end || (knot - node >= shortest && end - knot >= shortest);
        let parts = if far { ((knot - from) / CELL).ceil() } else { 1.0 };
        let begin = from;
        for part in 1..=parts as usize {
            let to = if part as f64 == parts {
                knot
            } else {
                begin + (knot - begin) * part as f64 / parts
            };
            length += Curve::arc_length(from, to, |t| point(spline.at(t)).1);
            from = to;
            if far {
                nodes.push((length, point(spline.at(to)).0));
                (node, length) = (to, 0.0);
            }
        }
    }
    let regular = |(_, point): &(f64, CurvePoint)| point.tangent[0].is_finite() && point.curvature.is_finite();
    nodes.iter().all(regular).then_some(Piece { nodes })
}

#[cfg(test)]
mod tests;
