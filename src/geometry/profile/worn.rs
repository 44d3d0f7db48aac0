//! Profiles that have worn, by a depth over the arc length that is measured along the normal.
//!
//! With the normal n into the material and the depth d(s), the worn curve is P + d n. Its derivatives over the arc length of the old curve
//! follow from those of the old one, with the curvature κ towards n:
//!
//! P′ = (1 − κ d) t + d′ n, P″ = −(κ′ d + 2 κ d′) t + ((1 − κ d) κ + d″) n
//!
//! Each part between two knots of the depth (`divided`) keeps its curvature at either end, so that what jumps there still jumps at one place. Where the
//! curvature jumps by Δκ and the depth has a slope, the worn curve has a kink of d d′ Δκ; the cells on either side of it take the mean direction. The area
//! between the two curves is ∫ (d − κ d²/2) ds.

use super::curve::{Curve, Piece};
use super::divided::{Joint, Part, divided, joint};
use super::{Body, CurvePoint, DepthGrid, Profile};
use crate::error::{ProfileError, in_thousandths};

/// Part of its length that a place must keep where the profile is convex: beyond its radius of curvature an outline crosses itself.
const LEAST_STRETCH: f64 = 0.02;
/// Distance, `m`, that the two sides of a kink may move apart by wear at it; the curve closes it.
const WIDEST_GAP: f64 = 1e-6;

/// Depth over the arc length.
enum Depths<'a> {
    /// A monotone cubic through rows.
    Rows(Rows<'a>),
    /// The spline of cells with their means, and the arc lengths of its knots and half way between.
    Cells(&'a DepthGrid, &'a [f64], Vec<f64>),
}

impl Depths<'_> {
    /// Depth with its first and second derivative at an arc length, the second one as in the piece that holds another arc length, `within`.
    fn at(&self, arc: f64, within: f64) -> [f64; 3] {
        match self {
            Depths::Rows(rows) => rows.at(arc, within),
            Depths::Cells(grid, means, _) => grid.at(means, arc),
        }
    }

    /// Whether nothing is worn between two arc lengths.
    fn is_zero(&self, from: f64, to: f64) -> bool {
        match self {
            Depths::Rows(rows) => rows.is_zero(from, to),
            Depths::Cells(grid, means, _) => grid.is_zero(means, [from, to]),
        }
    }

    /// Arc lengths, ascending, at which the curve is divided.
    fn knots(&self) -> Vec<f64> {
        match self {
            Depths::Rows(rows) => rows.rows.iter().map(|row| row[0]).collect(),
            Depths::Cells(_, _, places) => places.clone(),
        }
    }
}

/// Depth over the arc length: piecewise cubic through rows, once differentiable and without overshoot, by the slopes of F. N. Fritsch
/// and J. Butland (*SIAM Journal on Scientific and Statistical Computing* 5, 1984). Before the first row and behind the last it is constant.
struct Rows<'a> {
    rows: &'a [[f64; 2]],
    slopes: Vec<f64>,
}

impl<'a> Rows<'a> {
    fn new(rows: &'a [[f64; 2]]) -> Rows<'a> {
        let mut slopes = vec![0.0; rows.len()];
        for (slope, three) in slopes.iter_mut().skip(1).zip(rows.windows(3)) {
            let [before, after] = [0, 1].map(|k| three[k + 1][0] - three[k][0]);
            let [left, right] = [(0, before), (1, after)].map(|(k, length)| (three[k + 1][1] - three[k][1]) / length);
            if left * right > 0.0 {
                // Harmonic mean, weighted by the lengths.
                let [first, second] = [before + 2.0 * after, 2.0 * before + after];
                *slope = (first + second) / (first / right + second / left);
            }
        }
        Rows { rows, slopes }
    }

    /// Depth with its first and second derivative at an arc length, the second one as in the piece that holds another arc length, `within`.
    fn at(&self, arc: f64, within: f64) -> [f64; 3] {
        let [depth, slope, _] = self.piece(arc, arc);
        [depth, slope, self.piece(arc, within)[2]]
    }

    /// Depth with its derivatives at an arc length, by the cubic of the piece that holds another one.
    fn piece(&self, arc: f64, within: f64) -> [f64; 3] {
        let next = self.rows.partition_point(|row| row[0] <= within);
        if next == 0 || next == self.rows.len() {
            return [self.rows[next.saturating_sub(1)][1], 0.0, 0.0];
        }
        let [[from, first], [to, second]] = [self.rows[next - 1], self.rows[next]];
        let [a, b] = [self.slopes[next - 1], self.slopes[next]];
        let length = to - from;
        let (part, mean) = ((arc - from) / length, (second - first) / length);
        // The depth is first + length (a part + c part² + e part³).
        let (c, e) = (3.0 * mean - 2.0 * a - b, a + b - 2.0 * mean);
        [
            first + length * part * (a + part * (c + part * e)),
            a + part * (2.0 * c + 3.0 * part * e),
            (2.0 * c + 6.0 * part * e) / length,
        ]
    }

    /// Whether nothing is worn between two arc lengths.
    fn is_zero(&self, from: f64, to: f64) -> bool {
        let first = self.rows.partition_point(|row| row[0] <= from).saturating_sub(1);
        let last = self.rows.partition_point(|row| row[0] < to).min(self.rows.len() - 1);
        self.rows[first..=last].iter().all(|row| row[1] == 0.0)
    }
}

/// Worn curve at an arc length of the old one, with its length there over that of the old one.
pub(super) struct Worn {
    pub(super) point: CurvePoint,
    pub(super) stretch: f64,
    speed: f64,
}

/// Wears a place of a curve, whose curvature has a slope there; `side` is 1 where the material is to the left of the curve, −1 where it is to the right.
pub(super) fn worn(here: &CurvePoint, curvature_slope: f64, depth: [f64; 3], side: f64) -> Worn {
    // To the left of the curve, as its curvature.
    let [left, slope, second] = depth.map(|value| side * value);
    let (curvature, [ty, tz]) = (here.curvature, here.tangent);
    let stretch = 1.0 - curvature * left;
    let (along, across) = (
        -(curvature_slope * left + 2.0 * curvature * slope),
        stretch * curvature + second,
    );
    // Neither is small or large, as `hypot` would have to look at.
    let speed = (stretch * stretch + slope * slope).sqrt();
    Worn {
        point: CurvePoint {
            place: [here.place[0] - left * tz, here.place[1] + left * ty],
            tangent: [(stretch * ty - slope * tz) / speed, (stretch * tz + slope * ty) / speed],
            curvature: (stretch * across - slope * along) / speed.powi(3),
        },
        stretch,
        speed,
    }
}

/// Side of a profile's curve on which the material of a body is: 1 to the left, −1 to the right.
pub(super) fn side(body: Body) -> f64 {
    match body {
        Body::Wheel => 1.0,
        Body::Rail => -1.0,
    }
}

impl Profile {
    /// Profile that has worn by depths along its normal: `rows` of arc length and depth, both in `m`, ascending by arc length. A positive
    /// depth removes material, a negative one adds some.
    ///
    /// Between the rows the depth is a monotone cubic, which does not overshoot; before the first row and behind the last it is theirs, so that a
    /// single row wears all of the profile by one depth. The origin moves with the surface: a rail's to its new highest point, a
    /// wheel's to the new height of its running circle. A place at which nothing is worn stays as it is.
    ///
    /// # Errors
    /// There is no row, or one is not finite, beyond the profile or not in order; the depth reaches the radius of curvature where material
    /// is convex; more than a micrometre would open at a kink; or a wheel is worn beyond its running circle.
    pub fn worn_by(&self, rows: &[[f64; 2]]) -> Result<Profile, ProfileError> {
        check(rows, self.length()).map_err(|reason| self.no_wear(reason))?;
        if rows.iter().all(|row| row[1] == 0.0) {
            return Ok(self.clone());
        }
        self.worn_at_depths(&Depths::Rows(Rows::new(rows)))
    }

    /// Profile that has worn by the depth of cells with their means, `m`, as a contact has collected it.
    ///
    /// # Errors
    /// As [`Profile::worn_by`], but for the rows.
    pub fn worn_by_cells(&self, grid: &DepthGrid, means: &[f64]) -> Result<Profile, ProfileError> {
        if means.iter().all(|&mean| mean == 0.0) {
            return Ok(self.clone());
        }
        let places = (0..2 * grid.cells).map(|half| grid.middle(0) + 0.5 * half as f64 * grid.spacing);
        self.worn_at_depths(&Depths::Cells(grid, means, places.collect()))
    }

    fn worn_at_depths(&self, depths: &Depths) -> Result<Profile, ProfileError> {
        let side = side(self.body);
        let mut pieces: Vec<Piece> = Vec::new();
        for part in divided(&self.curve, 0..self.curve.arcs().len() - 1, &depths.knots()) {
            let mut piece = worn_piece(&self.curve, &part, depths, side).map_err(|reason| self.no_wear(reason))?;
            if let Some(before) = pieces.last_mut() {
                let [cell, _] = part.cells;
                let begins = part.ends[0] == self.curve.arcs()[cell];
                let gap = meet(before, &mut piece, !begins || joint(&self.curve, cell) != Joint::Kink);
                if gap > WIDEST_GAP {
                    return Err(self.no_wear(format!(
                        "at the arc length {:.3} mm it would open the two sides of a kink by {:.3} mm",
                        1e3 * part.ends[0],
                        1e3 * gap
                    )));
                }
            }
            pieces.push(piece);
        }
        let curve = Curve::of_pieces(pieces, 0.0);
        let curve = curve.ok_or_else(|| self.no_wear("nothing is left of a part of it".to_owned()))?;
        let source = format!("{}{WORN}", self.source.strip_suffix(WORN).unwrap_or(&self.source));
        Profile::of_curve(self.body, &self.name, &source, curve)
    }

    /// Profile at an arc length, `m`, after wear of a depth, `m`, with its first and second derivative. The slope of the new profile's curvature counts as 0,
    /// which place and direction do without.
    pub fn worn_at(&self, arc: f64, depth: [f64; 3]) -> CurvePoint {
        worn(&self.at(arc), 0.0, depth, side(self.body)).point
    }

    fn no_wear(&self, reason: String) -> ProfileError {
        ProfileError::NoWear {
            name: self.name.clone(),
            reason,
        }
    }
}

/// Refuses rows of arc length and depth that do not serve on a profile of a length, `m`, with the reason.
fn check(rows: &[[f64; 2]], length: f64) -> Result<(), String> {
    if rows.is_empty() {
        return Err("no depth is given".to_owned());
    }
    // Round-off of a table that was written in mm.
    let allowed = -1e-9..=length + 1e-9;
    for (number, &[arc, depth]) in (1..).zip(rows) {
        if !allowed.contains(&arc) || !depth.is_finite() {
            return Err(format!(
                "row {number} is the depth {depth} m at the arc length {arc} m: allowed are finite depths between 0 and {length} m"
            ));
        }
    }
    match rows.windows(2).position(|pair| pair[1][0] <= pair[0][0]) {
        Some(row) => Err(format!(
            "the arc lengths of rows {} and {} are {} and {} m: they must ascend",
            row + 1,
            row + 2,
            rows[row][0],
            rows[row + 1][0]
        )),
        None => Ok(()),
    }
}

/// Wears a part of a curve; else the reason why nothing is left of it.
fn worn_piece(curve: &Curve, part: &Part, depths: &Depths, side: f64) -> Result<Piece, String> {
    let within = 0.5 * (part.ends[0] + part.ends[1]);
    let place = |cell: usize, arc: f64| {
        let here = curve.within(cell, arc);
        worn(&here, curve.curvature_slope(cell, arc), depths.at(arc, within), side)
    };
    let mut nodes = Vec::with_capacity(2);
    let length = if depths.is_zero(part.ends[0], part.ends[1]) {
        part.ends[1] - part.ends[0]
    } else {
        let stretches = part.stretches(curve);
        stretches
            .map(|(cell, [from, to])| Curve::arc_length(from, to, |arc| place(cell, arc).speed))
            .sum()
    };
    for (cell, arc) in part.cells.into_iter().zip(part.ends) {
        let worn = place(cell, arc);
        if worn.stretch < LEAST_STRETCH {
            return Err(format!(
                "{} mm are worn at the arc length {:.3} mm, where its radius is {:.3} mm: nothing is left of it",
                in_thousandths(depths.at(arc, within)[0]),
                1e3 * arc,
                1e3 / curve.within(cell, arc).curvature.abs()
            ));
        }
        nodes.push((length, worn.point));
    }
    Ok(Piece { nodes })
}

/// Distance of two pieces that follow each other, `m`. Both get the mean of their directions where they are `smooth`.
fn meet(before: &mut Piece, after: &mut Piece, smooth: bool) -> f64 {
    let (Some((_, end)), Some((_, begin))) = (before.nodes.last_mut(), after.nodes.first_mut()) else {
        return 0.0;
    };
    if smooth && end.tangent != begin.tangent {
        let [y, z] = [0, 1].map(|k| end.tangent[k] + begin.tangent[k]);
        end.tangent = [y / y.hypot(z), z / y.hypot(z)];
        begin.tangent = end.tangent;
    }
    (begin.place[0] - end.place[0]).hypot(begin.place[1] - end.place[1])
}

/// End of the source of a worn profile.
const WORN: &str = ", worn";

#[cfg(test)]
mod tests;
