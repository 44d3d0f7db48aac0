//! Height of a profile as a function of the lateral position.

use super::CurvePoint;
use super::curve::Curve;
use crate::geometry::quintics::{Quintics, Span};

/// Slope up to which the height counts as a function of the lateral position: 84.3° from the horizontal. Flanges are up to 75° steep
/// where they carry.
const STEEPEST: f64 = 10.0;

/// Parts of a curve's cell for the height, over the square of the slope, and at most: towards the vertical the height's derivatives over y grow
/// with the power of the slope. So the height is right to 1e-10 m up to 80°.
const STEEP_PARTS: f64 = 0.5;
const MOST_PARTS: f64 = 12.0;

/// Height z(y) of a profile over the lateral position, in cells that are found in constant time; nothing is allocated to evaluate it.
///
/// It is as smooth as the profile: twice differentiable, with jumps of the curvature where arcs meet, and of the slope at kinks.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightFunction {
    cells: Quintics<1>,
}

fn slope(point: &CurvePoint) -> f64 {
    point.tangent[1] / point.tangent[0]
}

/// Cell between two points: the second derivative over y is κ (1 + (dz/dy)²)^(3/2).
fn span(points: &[CurvePoint]) -> Span<1> {
    let [from, to] = [points[0], points[1]];
    let jet = |point: CurvePoint| {
        [[
            point.place[1],
            slope(&point),
            point.curvature / point.tangent[0].powi(3),
        ]]
    };
    Span {
        ends: [from.place[0], to.place[0]],
        jets: [jet(from), jet(to)],
    }
}

impl HeightFunction {
    /// Function of that part of a curve which holds an arc length and where y rises with the arc length, no steeper than 84°.
    pub(super) fn of_curve(curve: &Curve, within: f64) -> Option<HeightFunction> {
        let flat = |point: &CurvePoint| point.tangent[0] > 0.0 && slope(point).abs() <= STEEPEST;
        let mut spans: Vec<Span<1>> = Vec::new();
        let mut holds = false;
        for (cell, arcs) in curve.arcs().windows(2).enumerate() {
            let ends = [arcs[0], arcs[1]].map(|arc| curve.within(cell, arc));
            if ends.iter().all(flat) {
                holds |= arcs[0] <= within && within <= arcs[1];
                let steepest = ends.iter().map(|point| slope(point).abs()).fold(0.0, f64::max);
                let parts = (steepest.powi(2) * STEEP_PARTS).ceil().clamp(1.0, MOST_PARTS);
                let place = |part: f64| curve.within(cell, arcs[0] + (arcs[1] - arcs[0]) * part / parts);
                let nodes: Vec<_> = (0..=parts as usize).map(|part| place(part as f64)).collect();
                spans.extend(nodes.windows(2).map(span));
            } else if holds {
                break;
            } else {
                spans.clear();
            }
        }
        Some(HeightFunction {
            cells: Quintics::new(&spans).filter(|_| holds)?,
        })
    }

    /// First and last lateral position, `m`.
    pub fn range(&self) -> [f64; 2] {
        self.cells.range()
    }

    /// Height z, `m`, slope dz/dy and second derivative d²z/dy², `1/m`, at a lateral position, `m`; beyond the range on the straight
    /// lines that begin at its ends.
    pub fn value_slope_curvature(&self, y: f64) -> [f64; 3] {
        self.cells.at(y)[0]
    }
}
