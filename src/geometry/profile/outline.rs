//! Outlines of arcs, straight lines and polynomials, as drawings and standards give them.

use super::CurvePoint;
use super::curve::{CELL, Curve, Piece};

/// Change of direction, rad, below which two parts of an outline are meant to join tangentially: coefficients of standards are
/// rounded, and 1e-4 rad are far more than that makes.
const TANGENTIAL: f64 = 1e-4;

/// A part of an outline, followed from its first end.
#[derive(Debug, Clone, Copy)]
pub enum Part<'a> {
    /// An arc, or a line where the curvature is 0.
    Bend {
        /// First end, `m`.
        start: [f64; 2],
        /// Direction there: its angle from y towards z, rad.
        angle: f64,
        /// Change of the angle over the length, `1/m`.
        curvature: f64,
        /// Arc length, `m`.
        length: f64,
    },
    /// A polynomial z(y).
    Graph {
        /// Coefficients by ascending power, in powers of `m`.
        coefficients: &'a [f64],
        /// Lateral positions of the two ends, `m`.
        ends: [f64; 2],
    },
}

impl Part<'_> {
    /// A straight line between two points.
    pub fn line(from: [f64; 2], to: [f64; 2]) -> Part<'static> {
        let [dy, dz] = [to[0] - from[0], to[1] - from[1]];
        Part::Bend {
            start: from,
            angle: dz.atan2(dy),
            curvature: 0.0,
            length: dy.hypot(dz),
        }
    }

    /// An arc about a centre, `radius` being positive where its centre lies above, between two lateral positions: the lower half of the
    /// circle then, and the upper half where `radius` is negative.
    pub fn arc(centre: [f64; 2], radius: f64, ends: [f64; 2]) -> Part<'static> {
        let angle_at = |y: f64| ((y - centre[0]) / radius).clamp(-1.0, 1.0).asin();
        let [from, to] = ends.map(angle_at);
        Part::Bend {
            start: [centre[0] + radius * from.sin(), centre[1] - radius * from.cos()],
            angle: from,
            curvature: 1.0 / radius,
            length: (to - from) * radius,
        }
    }

    /// Nodes of the part, as many as its length needs.
    fn piece(&self) -> Piece {
        match *self {
            Part::Bend {
                start,
                angle,
                curvature,
                length,
            } => {
                let cells = (length / CELL).ceil().max(1.0);
                let nodes = (0..=cells as usize).map(|node| {
                    let arc = length * node as f64 / cells;
                    (length / cells, bend(start, angle, curvature, arc))
                });
                Piece { nodes: nodes.collect() }
            }
            Part::Graph { coefficients, ends } => graph(coefficients, ends),
        }
    }
}

/// Returns a point of an arc or line.
pub fn bend(start: [f64; 2], angle: f64, curvature: f64, arc: f64) -> CurvePoint {
    // The chord of an arc has the direction of its middle, and the length 2 r sin(κ s/2), without a centre far away.
    let half = 0.5 * curvature * arc;
    let chord = if half.abs() < 1e-8 {
        arc
    } else {
        arc * half.sin() / half
    };
    let (sine, cosine) = (angle + half).sin_cos();
    let (end_sine, end_cosine) = (angle + 2.0 * half).sin_cos();
    CurvePoint {
        place: [start[0] + chord * cosine, start[1] + chord * sine],
        tangent: [end_cosine, end_sine],
        curvature,
    }
}

/// Returns value, slope and second derivative of a polynomial.
pub fn polynomial(coefficients: &[f64], y: f64) -> [f64; 3] {
    coefficients
        .iter()
        .rev()
        .fold([0.0; 3], |[value, slope, second], &coefficient| {
            [coefficient + y * value, value + y * slope, 2.0 * slope + y * second]
        })
}

/// Returns a polynomial plus the cubic that gives it a value and a slope at each of two places.
pub fn bridge(coefficients: &[f64], [from, to]: [f64; 2], ends: [[f64; 2]; 2]) -> Vec<f64> {
    let missing = |place: f64, [value, slope]: [f64; 2]| {
        let found = polynomial(coefficients, place);
        [value - found[0], slope - found[1]]
    };
    let ([a, b], [value, slope]) = (missing(from, ends[0]), missing(to, ends[1]));
    let length = to - from;
    let (rise, turn) = (value - a - b * length, slope - b);
    let c = (3.0 * rise - turn * length) / (length * length);
    let d = (turn * length - 2.0 * rise) / (length * length * length);
    let cubic = [
        a - from * (b - from * (c - from * d)),
        b - from * (2.0 * c - 3.0 * from * d),
        c - 3.0 * from * d,
        d,
    ];
    let mut sum = coefficients.to_vec();
    sum.resize(sum.len().max(4), 0.0);
    sum.iter_mut().zip(cubic).for_each(|(sum, part)| *sum += part);
    sum
}

/// Nodes of a polynomial z(y), at equal steps of y: where it is no steeper than a wheel's tread, these are about equally long.
fn graph(coefficients: &[f64], [from, to]: [f64; 2]) -> Piece {
    let speed = |y: f64| 1f64.hypot(polynomial(coefficients, y)[1]);
    let steepest = speed(from).max(speed(to));
    let cells = (steepest * (to - from) / CELL).ceil().max(1.0);
    let step = (to - from) / cells;
    let nodes = (0..=cells as usize).map(|node| {
        let y = from + step * node as f64;
        let [value, slope, second] = polynomial(coefficients, y);
        let speed_here = 1f64.hypot(slope);
        let length = Curve::arc_length(y - step, y, speed);
        let point = CurvePoint {
            place: [y, value],
            tangent: [1.0 / speed_here, slope / speed_here],
            curvature: second / speed_here.powi(3),
        };
        (length, point)
    });
    Piece { nodes: nodes.collect() }
}

/// Curve of parts that follow each other.
pub fn curve(parts: &[Part]) -> Option<Curve> {
    Curve::of_pieces(parts.iter().map(Part::piece).collect(), TANGENTIAL)
}
