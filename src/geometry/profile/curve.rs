//! Plane curves over their arc length.

use super::CurvePoint;
use crate::geometry::quintics::{Jet, Quintics, Span};
use crate::numerics::gauss::GAUSS;

/// Length of a cell at most, `m`. On the sharpest arc of the profiles that are built in, of 8 mm, the curvature is then right to
/// (h/r)⁴/720, 1e-9 of it, and the place to round-off.
pub const CELL: f64 = 0.25e-3;

/// A curve over its arc length. Within a smooth piece it is twice differentiable; curvature and direction may jump between pieces.
#[derive(Debug, Clone, PartialEq)]
pub struct Curve {
    /// Places y and z over the arc length, `m`.
    cells: Quintics<2>,
}

/// A smooth piece of a curve as nodes that follow each other: the length from the node before, `m` (of the first one it is not
/// used), and the curve there.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Piece {
    /// Nodes from the first end to the last.
    pub nodes: Vec<(f64, CurvePoint)>,
}

/// Returns y and z with their derivatives over the arc length: the second ones are the curvature times the normal.
fn jet(point: &CurvePoint) -> Jet<2> {
    let ([y, z], [ty, tz]) = (point.place, point.tangent);
    [[y, ty, -point.curvature * tz], [z, tz, point.curvature * ty]]
}

/// Returns place, direction and curvature of y and z with their derivatives over a length that is nearly the arc's.
fn point([[y, dy, ddy], [z, dz, ddz]]: Jet<2>) -> CurvePoint {
    let speed = dy.hypot(dz);
    CurvePoint {
        place: [y, z],
        tangent: [dy / speed, dz / speed],
        curvature: (dy * ddz - dz * ddy) / (speed * speed * speed),
    }
}

impl Curve {
    /// A curve of pieces that follow each other. Each is shifted to where the one before ends, by what their sources have rounded; at the
    /// joint both take the mean of their directions, unless these differ by more than `kink`, rad.
    ///
    /// `None` where there is no piece of two nodes.
    pub fn of_pieces(mut pieces: Vec<Piece>, kink: f64) -> Option<Curve> {
        pieces.retain(|piece| piece.nodes.len() > 1);
        for next in 1..pieces.len() {
            let (before, after) = pieces.split_at_mut(next);
            let (Some((_, end)), piece) = (before[next - 1].nodes.last_mut(), &mut after[0].nodes) else {
                continue;
            };
            let begin = piece[0].1;
            let shift = [0, 1].map(|k| end.place[k] - begin.place[k]);
            for (_, point) in piece.iter_mut() {
                point.place = [0, 1].map(|k| point.place[k] + shift[k]);
            }
            let ([ay, az], [by, bz]) = (end.tangent, begin.tangent);
            if (ay * bz - az * by).atan2(ay * by + az * bz).abs() < kink {
                let length = (ay + by).hypot(az + bz);
                let tangent = [(ay + by) / length, (az + bz) / length];
                (end.tangent, piece[0].1.tangent) = (tangent, tangent);
            }
        }
        let mut spans = Vec::new();
        let mut arc = 0.0;
        for pair in pieces.iter().flat_map(|piece| piece.nodes.windows(2)) {
            let end = arc + pair[1].0;
            spans.push(Span {
                ends: [arc, end],
                jets: [jet(&pair[0].1), jet(&pair[1].1)],
            });
            arc = end;
        }
        Some(Curve {
            cells: Quintics::new(&spans)?,
        })
    }

    /// Arc length between two parameters of a curve over which its speed is smooth: the integral of the speed, exact up to degree nine.
    pub fn arc_length(from: f64, to: f64, speed: impl Fn(f64) -> f64) -> f64 {
        let sum: f64 = GAUSS
            .iter()
            .map(|[place, weight]| weight * speed(from + (to - from) * place))
            .sum();
        sum * (to - from)
    }

    /// Integral of a function of the curve between two arc lengths, cell by cell: exact for products of two coordinates or derivatives of them.
    pub fn integral(&self, from: f64, to: f64, function: impl Fn(&CurvePoint) -> f64) -> f64 {
        let arcs = self.arcs();
        let inner = arcs.partition_point(|&arc| arc <= from)..arcs.partition_point(|&arc| arc < to);
        let mut ends = vec![from];
        ends.extend(arcs.get(inner).unwrap_or_default());
        ends.push(to);
        let part = |pair: &[f64]| Curve::arc_length(pair[0], pair[1], |arc| function(&self.at(arc)));
        ends.windows(2).map(part).sum()
    }

    /// Arc length from end to end, `m`.
    pub fn length(&self) -> f64 {
        self.cells.range()[1]
    }

    /// Curve at an arc length, `m`; beyond the ends on the straight lines that begin there.
    pub fn at(&self, arc: f64) -> CurvePoint {
        point(self.cells.at(arc))
    }

    /// Arc lengths of the nodes.
    pub fn arcs(&self) -> &[f64] {
        self.cells.knots()
    }

    /// Number of the cell that holds an arc length.
    pub fn cell_of(&self, arc: f64) -> usize {
        self.cells.cell_of(arc)
    }

    /// Curve in a cell at an arc length, at the cell's ends as it is within the cell.
    pub fn within(&self, cell: usize, arc: f64) -> CurvePoint {
        point(self.cells.within(cell, arc))
    }

    /// Slope of the curvature over the arc length, as it is within a cell, `1/m²`.
    pub fn curvature_slope(&self, cell: usize, arc: f64) -> f64 {
        let step = 1e-3 * (self.arcs()[cell + 1] - self.arcs()[cell]);
        let [before, after] = [-step, step].map(|step| self.within(cell, arc + step).curvature);
        (after - before) / (2.0 * step)
    }

    /// Curve turned about the origin by an angle, from y towards z, and then shifted.
    pub fn moved(&self, angle: f64, shift: [f64; 2]) -> Option<Curve> {
        let (sine, cosine) = angle.sin_cos();
        let turned = |[y, z]: Jet<2>| {
            let mut jet: Jet<2> = [[0.0; 3]; 2];
            for order in 0..3 {
                jet[0][order] = cosine * y[order] - sine * z[order];
                jet[1][order] = sine * y[order] + cosine * z[order];
            }
            jet[0][0] += shift[0];
            jet[1][0] += shift[1];
            jet
        };
        let spans: Vec<_> = self
            .cells
            .spans()
            .map(|span| Span {
                jets: span.jets.map(turned),
                ..span
            })
            .collect();
        Some(Curve {
            cells: Quintics::new(&spans)?,
        })
    }

    /// Returns the arc length between `low` and `high` at which a function of the curve that rises, or falls, through 0 there does so:
    /// by bisection, down to round-off.
    pub fn root(&self, mut low: f64, mut high: f64, function: impl Fn(&CurvePoint) -> f64) -> f64 {
        let rises = function(&self.at(high)) >= function(&self.at(low));
        // Each halves the interval: below 1e-18 m after 48 of a cell, 60 of a profile.
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if (function(&self.at(middle)) < 0.0) == rises {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }

    /// Arc length of the highest point, or of the lowest one.
    pub fn extreme(&self, highest: bool) -> f64 {
        let sign = if highest { 1.0 } else { -1.0 };
        let arcs = self.arcs();
        let best = (0..arcs.len())
            .max_by(|&a, &b| (sign * self.at(arcs[a]).place[1]).total_cmp(&(sign * self.at(arcs[b]).place[1])))
            .unwrap_or(0);
        let (low, high) = (arcs[best.saturating_sub(1)], arcs[(best + 1).min(arcs.len() - 1)]);
        let slope = |arc: f64| self.at(arc).tangent[1];
        if slope(low) * slope(high) < 0.0 {
            self.root(low, high, |point| point.tangent[1])
        } else {
            arcs[best]
        }
    }
}
