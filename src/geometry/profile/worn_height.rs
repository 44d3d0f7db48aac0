//! Height of a wheel's profile that wears: the function of [`HeightFunction`] with knots that move with the surface.
//!
//! Each knot belongs to an arc length of the new profile: a knot of the depth's spline, or a place where the new profile's curvature jumps (`divided`). It lies
//! where the surface has receded to along the normal there, so that the function is exact at the knots whatever the depth, and of degree five between them,
//! where nothing jumps. What has been computed from the new profile once is kept; to wear changes the function in place.

use super::divided::{Part, divided};
use super::height::{self, HeightFunction};
use super::worn::{side, worn};
use super::{CurvePoint, DepthGrid, Profile};
use crate::error::ProfileError;

/// Distance of two knots, over that of the new profile, below which the surface has folded onto itself.
const LEAST_STRETCH: f64 = 0.02;

/// New profile of a wheel, at the knots of its height function.
#[derive(Debug, Clone)]
pub struct WornHeight {
    /// Cells in which the depth is collected.
    grid: DepthGrid,
    /// Knots: arc length and place.
    knots: Vec<Knot>,
    /// Ends of each polynomial, with direction and curvature as they are on its side.
    ends: Vec<[End; 2]>,
    /// Function of the new profile.
    new: HeightFunction,
}

/// Knot on the new profile.
#[derive(Debug, Clone, Copy)]
struct Knot {
    arc: f64,
    /// Place; the direction is the mean of both sides.
    point: CurvePoint,
    /// Whether the profile is the same on both sides.
    is_smooth: bool,
}

/// End of a polynomial on the new profile.
#[derive(Debug, Clone, Copy, PartialEq)]
struct End {
    point: CurvePoint,
    curvature_slope: f64,
}

impl WornHeight {
    /// Knots of a new profile, and so many cells over them in which a depth is collected.
    ///
    /// # Errors
    /// The profile is nowhere flat.
    pub fn new(profile: &Profile, cells: usize) -> Result<WornHeight, ProfileError> {
        let curve = &profile.curve;
        let flat = height::flat_cells(curve, profile.middle).ok_or_else(|| profile.nowhere_flat())?;
        let grid = DepthGrid::new([flat.start, flat.end].map(|joint| curve.arcs()[joint]), cells);
        let parts = height::steep_parts(curve, divided(curve, flat, &grid.knots()).into_iter());
        let of_part = |Part { cells, ends }: &Part| {
            [0, 1].map(|end| End {
                point: curve.within(cells[end], ends[end]),
                curvature_slope: curve.curvature_slope(cells[end], ends[end]),
            })
        };
        let ends: Vec<[End; 2]> = parts.iter().map(of_part).collect();
        let knots = (0..=parts.len()).map(|knot| {
            let (before, after) = (knot.saturating_sub(1), knot.min(parts.len() - 1));
            let arc = if knot == 0 {
                parts[0].ends[0]
            } else {
                parts[before].ends[1]
            };
            let [left, right] = [
                if knot == 0 { ends[0][0] } else { ends[before][1] },
                ends[after][usize::from(knot == parts.len())],
            ];
            let [y, z] = [0, 1].map(|k| left.point.tangent[k] + right.point.tangent[k]);
            let is_smooth = left == right;
            let tangent = if is_smooth {
                left.point.tangent
            } else {
                [y / y.hypot(z), z / y.hypot(z)]
            };
            Knot {
                arc,
                point: CurvePoint { tangent, ..left.point },
                is_smooth,
            }
        });
        Ok(WornHeight {
            grid,
            knots: knots.collect(),
            new: HeightFunction::of_parts(curve, &parts).ok_or_else(|| profile.nowhere_flat())?,
            ends,
        })
    }

    /// Function of the new profile, for [`WornHeight::wear`] to change.
    pub fn function(&self) -> HeightFunction {
        self.new.clone()
    }

    /// Cells in which a depth is collected, over the arc lengths between which the height is a function.
    pub fn grid(&self) -> DepthGrid {
        self.grid
    }

    /// Wears a function of this wheel between two arc lengths, `m`, where the depth, with two derivatives, is another one than the function
    /// was worn by; nothing is allocated.
    ///
    /// # Errors
    /// The arc length of a place where the worn surface would fold onto itself; the function is of no use then.
    pub fn wear(
        &self,
        function: &mut HeightFunction,
        [from, to]: [f64; 2],
        depth: impl Fn(f64) -> [f64; 3],
    ) -> Result<(), f64> {
        let side = side(super::Body::Wheel);
        let first = self.knots.partition_point(|knot| knot.arc <= from).saturating_sub(1);
        let last = self.knots.partition_point(|knot| knot.arc < to).min(self.ends.len());
        let place = |knot: usize, depth: [f64; 3]| worn(&self.knots[knot].point, 0.0, depth, side).point.place;
        let at = |end: &End, depth: [f64; 3]| worn(&end.point, end.curvature_slope, depth, side).point;
        let mut depth_before = depth(self.knots[first].arc);
        let mut before = place(first, depth_before);
        // Where a knot has but one side, the end of a cell is the beginning of the next one.
        let mut carried: Option<CurvePoint> = None;
        for cell in first..last {
            let [knot, next] = [&self.knots[cell], &self.knots[cell + 1]];
            let depth_after = depth(next.arc);
            let [begin, end] = &self.ends[cell];
            let mut after = at(end, depth_after);
            if !next.is_smooth {
                after.place = place(cell + 1, depth_after);
            }
            if after.place[0] - before[0] < LEAST_STRETCH * (next.point.place[0] - knot.point.place[0]) {
                return Err(knot.arc);
            }
            let begin = carried.unwrap_or_else(|| CurvePoint {
                place: before,
                ..at(begin, depth_before)
            });
            function.replace(cell, [begin, after]);
            carried = next.is_smooth.then_some(after);
            (before, depth_before) = (after.place, depth_after);
        }
        Ok(())
    }

    /// Arc length of the new profile whose material is at the surface at a lateral position of a worn function, `m`.
    pub fn arc_of(&self, function: &HeightFunction, y: f64) -> f64 {
        let cell = function.cell_of(y);
        let knots = function.knots();
        let [from, to] = [self.knots[cell].arc, self.knots[cell + 1].arc];
        let share = (y - knots[cell]) / (knots[cell + 1] - knots[cell]);
        from + share.clamp(0.0, 1.0) * (to - from)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::profile::{Body, DepthGrid};

    /// Arc lengths of all cells.
    fn everywhere(grid: &DepthGrid) -> [f64; 2] {
        [grid.first, grid.first + grid.spacing * grid.cells as f64]
    }

    /// Wheel and a depth of 60 µm over its flange and its tread.
    fn worn_wheel() -> (Profile, WornHeight, DepthGrid, Vec<f64>) {
        let new = Profile::built_in("S1002").unwrap();
        let height = WornHeight::new(&new, 1500).unwrap();
        let grid = height.grid();
        let bump = |arc: f64, middle: f64, half: f64| {
            let t = ((arc - middle) / half).clamp(-1.0, 1.0);
            60e-6 * (1.0 - t * t).powi(3)
        };
        let [flange, tread] = [-0.038, 0.004].map(|y| new.arc_of(y).unwrap());
        let means = (0..grid.cells)
            .map(|cell| bump(grid.middle(cell), flange, 5e-3) + bump(grid.middle(cell), tread, 8e-3))
            .collect();
        (new, height, grid, means)
    }

    /// Unworn it is the profile's height function, to what that has of error itself.
    #[test]
    fn without_depth_it_is_the_new_profile() {
        let (new, height, grid, _) = worn_wheel();
        let mut function = height.function();
        height.wear(&mut function, everywhere(&grid), |_| [0.0; 3]).unwrap();
        let own = new.height_function().unwrap();
        for place in 0..1000 {
            let y = -0.055 + 1e-4 * f64::from(place);
            let [expected, found] = [&own, &function].map(|function| function.value_slope_curvature(y)[0]);
            assert!((expected - found).abs() < 2e-10, "{y}: {expected} {found}");
            let arc = height.arc_of(&function, y);
            assert!((new.at(arc).place[0] - y).abs() < 1e-6, "{y}");
        }
        assert!(grid.spacing < 0.12e-3);
    }

    /// The worn function is the height of the profile that `worn_by_cells` makes of the same depths, on tread and flange, and a change of
    /// some of them leaves the same bits as one of all.
    #[test]
    fn it_is_the_profile_worn_by_the_same_depth() {
        let (new, height, grid, means) = worn_wheel();
        let mut function = height.function();
        height
            .wear(&mut function, everywhere(&grid), |arc| grid.at(&means, arc))
            .unwrap();
        let worn = new.worn_by_cells(&grid, &means).unwrap();
        // Its origin is the worn running circle.
        let shift = function.value_slope_curvature(0.0)[0];
        let expected = worn.height_function().unwrap();
        let mut largest: f64 = 0.0;
        for place in 0..2000 {
            let y = -0.05 + 5e-5 * f64::from(place);
            let [at, own] = [&expected, &function].map(|function| function.value_slope_curvature(y));
            largest = largest.max(((at[0] + shift - own[0]) / own[1].hypot(1.0)).abs());
        }
        // Cells of the two differ: what either leaves between its nodes.
        assert!(largest < 1e-9, "{largest:e}");

        let mut twice = height.function();
        let flange = 0..grid.cells / 2;
        let mut some = means.clone();
        some[flange.end..].fill(0.0);
        height
            .wear(&mut twice, everywhere(&grid), |arc| grid.at(&some, arc))
            .unwrap();
        height
            .wear(&mut twice, grid.reach(flange.end..grid.cells), |arc| {
                grid.at(&means, arc)
            })
            .unwrap();
        assert_eq!(twice, function);
    }

    #[test]
    fn a_fold_is_refused_with_its_place() {
        let (new, height, grid, mut means) = worn_wheel();
        let arc = new.arc_of(-0.038).unwrap();
        means[((arc - grid.first) / grid.spacing) as usize] += 1e-3;
        let mut function = height.function();
        let refused = height
            .wear(&mut function, everywhere(&grid), |arc| grid.at(&means, arc))
            .unwrap_err();
        assert!((refused - arc).abs() < 1e-3, "{refused} {arc}");
        assert_eq!(new.body(), Body::Wheel);
    }
}
