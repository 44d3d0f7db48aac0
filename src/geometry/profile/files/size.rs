//! Size of a profile that has been read: of a file in another unit than it is taken for, or scaled, it is that of no rail or wheel.

use crate::error::ProfileError;
use crate::geometry::profile::{Body, Profile};

/// Depth below a rail's top down to which the breadth of its head counts, `m`: there the gauge is measured.
const DEPTH: f64 = 14e-3;
/// Breadth of a rail's head at most, `m`: those of railways are 50 to 80 mm broad.
const BROADEST_HEAD: f64 = 0.12;
/// Breadth of a wheel at most, `m`: those of railways are up to 150 mm broad.
const BROADEST_WHEEL: f64 = 0.2;

/// Refuses a rail or a wheel that is broader than any.
///
/// # Errors
/// [`ProfileError::TooBroad`].
pub fn check(profile: &Profile) -> Result<(), ProfileError> {
    let (part, breadth, most) = match profile.body {
        Body::Rail => ("its head, down to 14 mm below its top,", head(profile), BROADEST_HEAD),
        Body::Wheel => ("the wheel", extent(&profile.points()), BROADEST_WHEEL),
    };
    if breadth <= most {
        return Ok(());
    }
    Err(ProfileError::TooBroad {
        name: profile.name.clone(),
        part,
        breadth,
        most,
    })
}

/// Breadth of a rail's head, `m`: of what lies about its top, without a break, above the depth.
fn head(profile: &Profile) -> f64 {
    let points = profile.points();
    let top = profile.arc_lengths().partition_point(|&arc| arc < profile.middle);
    let is_deep = |point: &[f64; 2]| point[1] < -DEPTH;
    let from = points[..top].iter().rposition(is_deep).map_or(0, |deep| deep + 1);
    let to = points[top..]
        .iter()
        .position(is_deep)
        .map_or(points.len(), |deep| top + deep);
    extent(&points[from..to])
}

/// Extent of points across the track, `m`.
fn extent(points: &[[f64; 2]]) -> f64 {
    let lateral = || points.iter().map(|point| point[0]);
    lateral().fold(f64::NEG_INFINITY, f64::max) - lateral().fold(f64::INFINITY, f64::min)
}
