//! Measures of a wheel's profile, as those who maintain it have them.
//!
//! They refer to the running circle, which is the origin of a wheel's profile: 70 mm from the back of the flange (EN 15313:2016), or another distance.

use super::curve::Curve;
use super::height::LEAST_FLANGE;
use super::{Body, CurvePoint, HeightFunction, Profile};
use crate::error::{ProfileError, in_thousandths};
use crate::numerics::root::crossing;
use serde::{Deserialize, Serialize};

/// Distance of the running circle from the back of the flange by EN 15313, `m`.
pub const FLANGE_BACK: f64 = 70e-3;
/// Distances that a wheel can have there, `m`, as of the parameter `flange_back_position`.
const FLANGE_BACKS: [f64; 2] = [10e-3, 200e-3];
/// Depth below the running circle at which the flange's thickness is measured, `m`.
const THICKNESS_DEPTH: f64 = 10e-3;
/// Height above the flange's tip at which its gradient begins, `m`.
const GRADIENT_HEIGHT: f64 = 2e-3;

/// Measures of a wheel's profile by EN 15313, all in `m`.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct WheelMeasures {
    /// Height Sh of the flange: of its tip from the running circle.
    pub flange_height: f64,
    /// Thickness Sd of the flange: from its back, by EN 15313 70 mm from the running circle, to its face 10 mm below the running circle.
    pub flange_thickness: f64,
    /// Gradient qR of the flange: the distance along the axle between the face 2 mm above the tip and 10 mm below the running circle.
    pub flange_gradient: f64,
    /// Depth of the tread's hollow: the largest radius to the field side of a place, less the radius there, at the place where that is most; 0
    /// where the radius falls all the way to the field side, as a new wheel's does. From the face 10 mm below the running circle to the profile's end.
    pub hollow_depth: f64,
}

/// Wear of a wheel: the difference of its profile to the new one, both with the flange's back and tip at the same place.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct WheelWear {
    /// Area of the cross-section that is gone, less what has been added, from the tip of the flange to the field side as far as both profiles
    /// reach, `m²`.
    pub area: f64,
    /// Depth at the running circle, along the radius, `m`: by as much the flange has become higher.
    pub tread_depth: f64,
    /// Largest depth along the new profile's normal, `m`.
    pub largest_depth: f64,
    /// Lateral position of that depth on the new profile, `m`.
    pub largest_depth_position: f64,
}

/// Places of a flange, as arc lengths, `m`.
struct Flange {
    /// Tip.
    tip: f64,
    /// Face 2 mm above the tip.
    steep: f64,
    /// Face 10 mm below the running circle.
    thick: f64,
}

impl Profile {
    /// Measures of a wheel: height, thickness and gradient of its flange, depth of its tread's hollow. The flange's back is 70 mm from the running
    /// circle, as EN 15313 has it.
    ///
    /// # Errors
    /// The profile is a rail's, has no flange of 12 mm, or begins on it before its tip.
    pub fn measures(&self) -> Result<WheelMeasures, ProfileError> {
        self.measures_with_back(FLANGE_BACK)
    }

    /// Measures of a wheel whose running circle is another distance `flange_back_position` from the back of its flange, `m`: the thickness of
    /// the flange counts from there.
    ///
    /// # Errors
    /// As [`Profile::measures`], and a distance that is not from 10 to 200 mm.
    pub fn measures_with_back(&self, flange_back_position: f64) -> Result<WheelMeasures, ProfileError> {
        check_flange_back(flange_back_position)?;
        let flange = self.flange()?;
        let [tip, steep, thick] = [flange.tip, flange.steep, flange.thick].map(|arc| self.at(arc).place);
        Ok(WheelMeasures {
            flange_height: -tip[1],
            flange_thickness: flange_back_position + thick[0],
            flange_gradient: thick[0] - steep[0],
            hollow_depth: hollow(&self.curve, flange.thick),
        })
    }

    /// Wear of a wheel against its new profile. Back and tip of the flange are where both agree: no rail touches them.
    ///
    /// # Errors
    /// One of both is a rail's, has no flange of 12 mm, or begins on it before its tip.
    pub fn worn_against(&self, new: &Profile) -> Result<WheelWear, ProfileError> {
        let tips = [self.flange()?.tip, new.flange()?.tip];
        let [own, other] = [self.at(tips[0]).place[1], new.at(tips[1]).place[1]];
        let ends = [self, new].map(|profile| profile.at(profile.length()).place[0]);
        let last = ends[0].min(ends[1]);
        // Area over the tip's height, from the tip to where both reach: what differs is gone.
        let over_tip = |profile: &Profile, tip: f64, lowest: f64| {
            let end = profile.arc_of(last).unwrap_or_else(|| profile.length());
            let strip = |point: &CurvePoint| (point.place[1] - lowest) * point.tangent[0];
            profile.curve.integral(tip, end, strip)
        };
        let area = over_tip(self, tips[0], own) - over_tip(new, tips[1], other);

        let places: Vec<_> = (self.curve.arcs().iter())
            .map(|&arc| (arc, self.at(arc).place))
            .filter(|(arc, _)| *arc >= tips[0])
            .collect();
        let shift = other - own;
        let (mut largest_depth, mut largest_depth_position) = (f64::NEG_INFINITY, 0.0);
        for &arc in new.curve.arcs().iter().filter(|&&arc| arc >= tips[1]) {
            let here = new.at(arc);
            if let Some(depth) = self.depth_below(&here, shift, &places)
                && depth > largest_depth
            {
                (largest_depth, largest_depth_position) = (depth, here.place[0]);
            }
        }
        Ok(WheelWear {
            area,
            tread_depth: shift,
            largest_depth,
            largest_depth_position,
        })
    }

    /// Way from a place of the new profile along its normal into the material to this one, shifted upward: the nearest of `places`, its arc lengths and
    /// nodes, between which it crosses the normal.
    fn depth_below(&self, here: &CurvePoint, shift: f64, places: &[(f64, [f64; 2])]) -> Option<f64> {
        let ([y, z], [ty, tz]) = (here.place, here.tangent);
        let along = |place: [f64; 2]| (place[0] - y) * ty + (place[1] + shift - z) * tz;
        let depth = |place: [f64; 2]| (place[1] + shift - z) * ty - (place[0] - y) * tz;
        let crossing = places
            .windows(2)
            .filter(|pair| (along(pair[0].1) <= 0.0) != (along(pair[1].1) <= 0.0))
            .min_by(|a, b| depth(a[0].1).abs().total_cmp(&depth(b[0].1).abs()))?;
        let arc = self
            .curve
            .root(crossing[0].0, crossing[1].0, |point| along(point.place));
        Some(depth(self.at(arc).place))
    }

    /// Area of the cross-section that a wheel has lost against its new profile, `m²`: that of [`Profile::worn_against`].
    ///
    /// # Errors
    /// As [`Profile::worn_against`].
    pub fn worn_area(&self, new: &Profile) -> Result<f64, ProfileError> {
        Ok(self.worn_against(new)?.area)
    }

    fn flange(&self) -> Result<Flange, ProfileError> {
        self.require(Body::Wheel)?;
        let refused = |reason: String| ProfileError::NotMeasured {
            name: self.name.clone(),
            reason,
        };
        let (arcs, tip) = (self.curve.arcs(), self.curve.extreme(false));
        let [y, lowest] = self.at(tip).place;
        if tip >= self.middle || -lowest < LEAST_FLANGE {
            return Err(refused(format!(
                "it has no flange of {} mm: its lowest place is {:.3} mm below the running circle, at y = {:.3} mm",
                in_thousandths(LEAST_FLANGE),
                -1e3 * lowest,
                1e3 * y
            )));
        }
        if tip <= arcs[0] {
            return Err(refused(format!(
                "it begins at y = {:.3} mm on the flange, before its tip",
                1e3 * y
            )));
        }
        // From the running circle to the flange, and from its tip to the tread: the heights pass between the two.
        let crossing = |node: Option<usize>, z: f64| -> Result<f64, ProfileError> {
            let node = node.ok_or_else(|| refused(format!("it does not pass the height {} mm", in_thousandths(z))))?;
            let [from, to] = [arcs[node].max(tip), arcs[node + 1].min(self.middle)];
            Ok(self.curve.root(from, to, |point| point.place[1] - z))
        };
        let height = |node: usize| self.at(arcs[node].clamp(tip, self.middle)).place[1];
        let (begin, end) = (
            arcs.partition_point(|&arc| arc <= tip).saturating_sub(1),
            arcs.partition_point(|&arc| arc < self.middle),
        );
        let steep = (begin..end).find(|&node| height(node + 1) >= lowest + GRADIENT_HEIGHT);
        let thick = (begin..end).rev().find(|&node| height(node) <= -THICKNESS_DEPTH);
        Ok(Flange {
            tip,
            steep: crossing(steep, lowest + GRADIENT_HEIGHT)?,
            thick: crossing(thick, -THICKNESS_DEPTH)?,
        })
    }
}

impl WheelMeasures {
    /// Measures of a wheel by the function of its height, whose running circle is at y = 0, wherever its surface is there, and a distance
    /// `flange_back_position` from the back of the flange, `m`; `None` where the wheel has no flange of 12 mm or begins on it before its tip. Nothing is allocated.
    pub fn of_height(function: &HeightFunction, flange_back_position: f64) -> Option<WheelMeasures> {
        let height = |y: f64| function.value_slope_curvature(y)[0];
        let slope = |y: f64| function.value_slope_curvature(y)[1];
        let (knots, begins) = (function.knots(), |cell: usize| function.beginning(cell)[0]);
        let (datum, middle, last) = (height(0.0), function.cell_of(0.0), knots.len() - 2);
        let lower = |(lowest, least): (usize, f64), cell: usize| {
            let height = begins(cell);
            if height < least {
                (cell, height)
            } else {
                (lowest, least)
            }
        };
        let (lowest, _) = (0..=middle).fold((0, f64::INFINITY), lower);
        if lowest == 0 || datum - begins(lowest) < LEAST_FLANGE {
            return None;
        }
        let tip = crossing([knots[lowest - 1], knots[lowest + 1]], slope);
        let bottom = height(tip);
        let (steep_height, thick_height) = (bottom + GRADIENT_HEIGHT, datum - THICKNESS_DEPTH);
        let steep = (lowest..=middle).find(|&cell| begins(cell + 1) >= steep_height)?;
        let thick = (lowest..=middle).rev().find(|&cell| begins(cell) <= thick_height)?;
        let steep = crossing([knots[steep].max(tip), knots[steep + 1]], |y| height(y) - steep_height);
        let thick_place = crossing([knots[thick].max(tip), knots[thick + 1]], |y| height(y) - thick_height);
        let (mut highest, mut deepest) = (thick_height, 0f64);
        let mut visit = |height: f64| {
            highest = highest.max(height);
            deepest = deepest.max(highest - height);
        };
        let mut next = function.beginning((thick + 1).min(last));
        for cell in thick + 1..last {
            let [here, rises] = next;
            next = function.beginning(cell + 1);
            let [_, rises_next] = next;
            visit(here);
            if rises * rises_next < 0.0 {
                visit(height(crossing([knots[cell], knots[cell + 1]], slope)));
            }
        }
        visit(begins(last));
        visit(height(knots[last + 1]));
        Some(WheelMeasures {
            flange_height: datum - bottom,
            flange_thickness: flange_back_position + thick_place,
            flange_gradient: thick_place - steep,
            hollow_depth: deepest,
        })
    }
}

/// Refuses a distance of the running circle from the back of the flange, `m`, that no wheel has.
///
/// # Errors
/// [`ProfileError::OutOfRange`].
pub fn check_flange_back(value: f64) -> Result<(), ProfileError> {
    let [minimum, maximum] = FLANGE_BACKS;
    if (minimum..=maximum).contains(&value) {
        return Ok(());
    }
    Err(ProfileError::OutOfRange {
        name: "flange_back_position",
        value,
        minimum,
        maximum,
        unit: "m",
    })
}

/// Largest fall of a curve's height from a place to one behind it, from an arc length on.
fn hollow(curve: &Curve, from: f64) -> f64 {
    let arcs = curve.arcs();
    let (mut highest, mut deepest) = (curve.at(from).place[1], 0f64);
    let mut visit = |arc: f64| {
        let height = curve.at(arc).place[1];
        highest = highest.max(height);
        deepest = deepest.max(highest - height);
    };
    for pair in arcs.windows(2).filter(|pair| pair[1] > from) {
        let [low, high] = [pair[0].max(from), pair[1]];
        if curve.at(low).tangent[1] * curve.at(high).tangent[1] < 0.0 {
            visit(curve.root(low, high, |point| point.tangent[1]));
        }
        visit(high);
    }
    deepest
}

#[cfg(test)]
mod tests;
