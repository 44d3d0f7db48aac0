//! Height of a profile as a function of the lateral position.

use super::CurvePoint;
use super::curve::{CELL, Curve};
use super::divided::Part;
use crate::geometry::quintics::{Quintics, Span};
use std::ops::Range;

/// Height of a flange at least, `m`: its thickness is measured 10 mm below the running circle and its gradient from 2 mm above its tip
/// (EN 15313:2016).
pub(super) const LEAST_FLANGE: f64 = 12e-3;

/// Slope up to which the height counts as a function of the lateral position: 84.3° from the horizontal. Flanges are up to 75° steep
/// where they carry.
const STEEPEST: f64 = 10.0;

/// Parts of a curve's cell for the height, over the square of the slope, and at most: towards the vertical the height's derivatives over y grow
/// with the power of the slope. So the height is right to 1e-10 m up to 80°.
const STEEP_PARTS: f64 = 0.5;
const MOST_PARTS: f64 = 12.0;
/// Length of a cell, `m`, below which it has fewer parts, in proportion.
const SHORT: f64 = 0.5 * CELL;

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
fn span([from, to]: [CurvePoint; 2]) -> Span<1> {
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

/// Cells of that part of a curve which holds an arc length, and where y rises with the arc length, no steeper than 84°. `None` where nothing holds the arc
/// length.
pub(super) fn flat_cells(curve: &Curve, within: f64) -> Option<Range<usize>> {
    let flat = |point: &CurvePoint| point.tangent[0] > 0.0 && slope(point).abs() <= STEEPEST;
    let mut first = 0;
    let mut holds = false;
    for (cell, arcs) in curve.arcs().windows(2).enumerate() {
        if arcs.iter().all(|&arc| flat(&curve.within(cell, arc))) {
            holds |= arcs[0] <= within && within <= arcs[1];
        } else if holds {
            return Some(first..cell);
        } else {
            first = cell + 1;
        }
    }
    holds.then(|| first..curve.arcs().len() - 1)
}

/// Divides parts of a curve for a height function where it is steep.
pub(super) fn steep_parts(curve: &Curve, parts: impl Iterator<Item = Part>) -> Vec<Part> {
    let mut found: Vec<Part> = Vec::new();
    for Part { cells, ends } in parts {
        let length = ends[1] - ends[0];
        let steepest = (0..2)
            .map(|end| slope(&curve.within(cells[end], ends[end])).abs())
            .fold(0.0, f64::max);
        let share = if length < SHORT { length / CELL } else { 1.0 };
        let number = share * (steepest.powi(2) * STEEP_PARTS).min(MOST_PARTS);
        let number = number.ceil().max(1.0) as usize;
        let mut begin = (cells[0], ends[0]);
        for part in 1..=number {
            let end = if part == number {
                (cells[1], ends[1])
            } else {
                let arc = ends[0] + length * part as f64 / number as f64;
                (curve.cell_of(arc).clamp(cells[0], cells[1]), arc)
            };
            found.push(Part {
                cells: [begin.0, end.0],
                ends: [begin.1, end.1],
            });
            begin = end;
        }
    }
    found
}

impl HeightFunction {
    /// Function of that part of a curve which holds an arc length and where y rises with the arc length, no steeper than 84°.
    pub(super) fn of_curve(curve: &Curve, within: f64) -> Option<HeightFunction> {
        let cells = flat_cells(curve, within)?.map(|cell| Part {
            cells: [cell; 2],
            ends: [curve.arcs()[cell], curve.arcs()[cell + 1]],
        });
        HeightFunction::of_parts(curve, &steep_parts(curve, cells))
    }

    /// Function of parts of a curve that follow each other.
    pub(super) fn of_parts(curve: &Curve, parts: &[Part]) -> Option<HeightFunction> {
        let of_part = |part: &Part| span([0, 1].map(|end| curve.within(part.cells[end], part.ends[end])));
        let spans: Vec<_> = parts.iter().map(of_part).collect();
        Some(HeightFunction {
            cells: Quintics::new(&spans)?,
        })
    }

    /// Replaces the function between two of its knots, and the two with it: what lies on either side of them has to follow.
    pub(super) fn replace(&mut self, cell: usize, ends: [CurvePoint; 2]) {
        self.cells.replace(cell, &span(ends));
    }

    /// Lateral positions between which the function is one polynomial each, `m`.
    pub(super) fn knots(&self) -> &[f64] {
        self.cells.knots()
    }

    /// Number of the polynomial that holds a lateral position; the first or the last one beyond the range.
    pub(super) fn cell_of(&self, y: f64) -> usize {
        self.cells.cell_of(y)
    }

    /// Height, `m`, and slope where a polynomial begins.
    pub(super) fn beginning(&self, cell: usize) -> [f64; 2] {
        let [[height, slope, _]] = self.cells.beginning(cell);
        [height, slope]
    }

    /// First and last lateral position, `m`.
    pub fn range(&self) -> [f64; 2] {
        self.cells.range()
    }

    /// Lateral position of a wheel's flange's tip towards its tread, `m`: where the flange is 1 mm higher than at its lowest place, as a wheel
    /// that stands on a rail's crown touches beside that place. Of a wheel without a flange of 12 mm its end.
    pub fn flange_tip(&self) -> f64 {
        /// Distance of the places that are looked at, `m`.
        const STEP: f64 = 0.1e-3;
        /// Height of the tip, `m`.
        const TIP: f64 = 1e-3;
        let height = |place: f64| self.value_slope_curvature(place)[0];
        let places = |from: f64| {
            let places = (0..).map(move |number| from + f64::from(number) * STEP);
            places.take_while(|place| *place < 0.0)
        };
        let first = self.range()[0];
        let lowest = places(first).min_by(|a, b| height(*a).total_cmp(&height(*b)));
        let lowest = lowest.unwrap_or(first);
        let bottom = height(lowest);
        if height(0.0) - bottom < LEAST_FLANGE {
            return first;
        }
        places(lowest)
            .find(|place| height(*place) > bottom + TIP)
            .unwrap_or(lowest)
    }

    /// Height z, `m`, slope dz/dy and second derivative d²z/dy², `1/m`, at a lateral position, `m`; beyond the range on the straight
    /// lines that begin at its ends.
    pub fn value_slope_curvature(&self, y: f64) -> [f64; 3] {
        self.cells.at(y)[0]
    }
}
