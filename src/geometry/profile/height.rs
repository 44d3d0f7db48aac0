//! Height of a profile as a function of the lateral position.

use super::curve::Curve;
use crate::geometry::quintics::{Quintics, Span};

/// Slope up to which the height counts as a function of the lateral position: 84.3° from the horizontal. Flanges are up to 75° steep
/// where they carry.
const STEEPEST: f64 = 10.0;

/// Height z(y) of a profile over the lateral position, in cells that are found in constant time; nothing is allocated to evaluate it.
///
/// It is as smooth as the profile: twice differentiable, with jumps of the curvature where arcs meet, and of the slope at kinks.
#[derive(Debug, Clone, PartialEq)]
pub struct HeightFunction {
    cells: Quintics<1>,
}

impl HeightFunction {
    /// Function of that part of a curve which holds an arc length and where y rises with the arc length, no steeper than 84°.
    pub(super) fn of_curve(curve: &Curve, within: f64) -> Option<HeightFunction> {
        let flat = |tangent: [f64; 2]| tangent[0] > 0.0 && tangent[1].abs() <= STEEPEST * tangent[0];
        let mut spans: Vec<Span<1>> = Vec::new();
        let mut holds = false;
        for (arcs, points) in curve.spans() {
            if points.iter().all(|point| flat(point.tangent)) {
                holds |= arcs[0] <= within && within <= arcs[1];
                spans.push(Span {
                    ends: points.map(|point| point.place[0]),
                    jets: points.map(|point| {
                        let [ty, tz] = point.tangent;
                        [[point.place[1], tz / ty, point.curvature / (ty * ty * ty)]]
                    }),
                });
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

    /// Height z [m], slope dz/dy and second derivative d²z/dy² [1/m] at a lateral position, `m`; beyond the range on the straight
    /// lines that begin at its ends.
    pub fn value_slope_curvature(&self, y: f64) -> [f64; 3] {
        self.cells.at(y)[0]
    }
}
