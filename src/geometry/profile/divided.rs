//! Curve divided where a depth of wear has its knots, for the worn curve to be one polynomial between two divisions.
//!
//! Joints of the curve's own cells remain divisions where its curvature jumps, or the slope of that. Others are there because cells have a greatest length:
//! across these the curve is as smooth as within a cell, and they divide only where no knot is near.

use super::curve::Curve;

/// Turn, rad, below which a curve has no kink between two cells.
pub(super) const SMOOTH: f64 = 1e-4;
/// Jumps of the curvature, `1/m`, and of its slope, `1/m²`, below which a joint is smooth: between divisions of a tenth of a millimetre they are heights
/// of less than 1e-13 m.
const SMALLEST_JUMPS: [f64; 2] = [5e-4, 50.0];
/// Longest part, `m`, that a smooth joint does not divide.
const LONGEST: f64 = 0.15e-3;
/// Shortest part, `m`, that a knot cuts off a longer one than [`LONGEST`], and off another one. Readers of files take two points of half the first distance
/// as one; the second is there for a profile that wears often not to have more than 20 nodes a mm.
const SHORTEST: [f64; 2] = [0.01e-3, 0.05e-3];

/// Part of a curve: the cells that its ends belong to, and their arc lengths.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Part {
    pub(super) cells: [usize; 2],
    pub(super) ends: [f64; 2],
}

impl Part {
    /// Cells that the part has a stretch in, with the ends of the stretch.
    pub(super) fn stretches<'c>(&self, curve: &'c Curve) -> impl Iterator<Item = (usize, [f64; 2])> + use<'c> {
        let Part { cells, ends } = *self;
        (cells[0]..=cells[1]).map(move |cell| {
            let [from, to] = [curve.arcs()[cell], curve.arcs()[cell + 1]];
            let begin = if cell == cells[0] { ends[0] } else { from };
            (cell, [begin, if cell == cells[1] { ends[1] } else { to }])
        })
    }
}

/// Kind of a joint between two cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Joint {
    /// The direction jumps.
    Kink,
    /// The curvature jumps, or its slope.
    Sharp,
    /// Nothing jumps.
    Smooth,
}

/// Joint at the beginning of a cell, which is not the first one.
pub(super) fn joint(curve: &Curve, cell: usize) -> Joint {
    let arc = curve.arcs()[cell];
    let [before, after] = [cell - 1, cell].map(|cell| curve.within(cell, arc));
    let turn = before.tangent[0] * after.tangent[1] - before.tangent[1] * after.tangent[0];
    let slopes = [cell - 1, cell].map(|cell| curve.curvature_slope(cell, arc));
    let jumps = [after.curvature - before.curvature, slopes[1] - slopes[0]];
    if turn.abs() >= SMOOTH {
        Joint::Kink
    } else if jumps
        .iter()
        .zip(SMALLEST_JUMPS)
        .any(|(jump, smallest)| jump.abs() > smallest)
    {
        Joint::Sharp
    } else {
        Joint::Smooth
    }
}

/// Divides a curve between the beginning of the first and the end of the last of some cells at the knots of a depth, ascending arc lengths.
pub(super) fn divided(curve: &Curve, cells: std::ops::Range<usize>, knots: &[f64]) -> Vec<Part> {
    let arcs = &curve.arcs()[cells.start..=cells.end];
    // Divisions with the cells before and behind them.
    let (mut sharp, mut smooth) = (Vec::new(), Vec::new());
    for (number, &arc) in arcs.iter().enumerate() {
        let cell = cells.start + number;
        let division = (arc, [cell.saturating_sub(1), cell]);
        if number == 0 || number + 1 == arcs.len() || joint(curve, cell) != Joint::Smooth {
            sharp.push(division);
        } else {
            smooth.push(division);
        }
    }
    let within = |&arc: &f64| {
        let behind = arcs.partition_point(|&joint| joint <= arc);
        (0 < behind && behind < arcs.len()).then(|| (arc, [cells.start + behind - 1; 2]))
    };
    let with_knots = thinned(&sharp, knots.iter().filter_map(within), 0.0);
    let divisions = thinned(&with_knots, smooth.into_iter(), LONGEST);
    let parts = divisions.windows(2).map(|pair| Part {
        cells: [pair[0].1[1], pair[1].1[0]],
        ends: [pair[0].0, pair[1].0],
    });
    parts.collect()
}

/// Division: its arc length, and the cells before and behind it.
type Division = (f64, [usize; 2]);

/// Divisions with further ones between them: where none is near, and the distance of the two kept ones that one lies between is greater than `longest`.
fn thinned(kept: &[Division], more: impl Iterator<Item = Division>, longest: f64) -> Vec<Division> {
    let mut all: Vec<Division> = Vec::with_capacity(2 * kept.len());
    let (mut begin, mut rest) = (f64::NEG_INFINITY, kept.iter().peekable());
    for division in more {
        while let Some(next) = rest.next_if(|next| next.0 <= division.0) {
            all.push(*next);
            begin = next.0;
        }
        let (Some(before), Some(next)) = (all.last(), rest.peek()) else {
            continue;
        };
        let length = next.0 - begin;
        let shortest = SHORTEST[usize::from(length <= LONGEST)];
        let near = division.0 - before.0 < shortest || next.0 - division.0 < shortest;
        if !near && length > longest {
            all.push(division);
        }
    }
    all.extend(rest);
    all
}
