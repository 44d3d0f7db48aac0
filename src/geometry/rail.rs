//! The rail in its place in the track, seen from one side, over the arc length of its profile.

use super::profile::{DepthGrid, Profile};
use super::unrolled::RailPoint;
use crate::error::ProfileError;

/// Rail in the track: its profile inclined, its running face at half the gauge.
#[derive(Debug, Clone)]
pub struct PlacedRail {
    profile: Profile,
    /// Lateral position of the profile's origin, `m`.
    offset: f64,
    /// Arc lengths between which the surface is looked at, `m`.
    range: [f64; 2],
    /// Cells of the depth by which it has worn, and their means, `m`; none of a new one.
    worn: Option<(DepthGrid, Vec<f64>)>,
}

/// Steepest inclination of the surface that is looked at, rad: 85°.
const STEEPEST: f64 = 1.483_529_864;

impl PlacedRail {
    /// Rail whose running face, `gauge_depth` `m` below its top, is at half the `gauge` `m` from the track's middle.
    ///
    /// # Errors
    /// [`ProfileError`] for a profile without a running face there.
    pub fn new(profile: Profile, gauge: f64, gauge_depth: f64) -> Result<PlacedRail, ProfileError> {
        let offset = 0.5 * gauge - profile.gauge_point(gauge_depth)?;
        let top = profile.arc_of(0.0).unwrap_or(0.5 * profile.length());
        let cosine = STEEPEST.cos();
        let reach = |direction: f64| {
            const STEP: f64 = 0.25e-3;
            let mut arc = top;
            while (0.0..=profile.length()).contains(&(arc + direction * STEP))
                && profile.at(arc + direction * STEP).tangent[0] > cosine
            {
                arc += direction * STEP;
            }
            arc
        };
        let range = [reach(-1.0), reach(1.0)];
        Ok(PlacedRail {
            profile,
            offset,
            range,
            worn: None,
        })
    }

    /// Arc lengths between which the surface is looked at, `m`.
    pub fn range(&self) -> [f64; 2] {
        self.range
    }

    /// Lateral position of the top, `m`.
    pub fn top(&self) -> f64 {
        self.offset
    }

    /// Gives the rail cells of a depth by which it is worn.
    pub fn collect_wear(&mut self, grid: DepthGrid) {
        self.worn = Some((grid, vec![0.0; grid.cells]));
    }

    /// Depth by which it is worn in each of its cells, to be changed; none of a rail that stays new.
    pub fn depth_mut(&mut self) -> Option<&mut [f64]> {
        self.worn.as_mut().map(|(_, depth)| depth.as_mut_slice())
    }

    /// Surface at an arc length of the new profile, `m`: where it is worn, what has become of it along the normal.
    pub fn at(&self, arc: f64) -> RailPoint {
        let point = match &self.worn {
            Some((grid, depth)) => self.profile.worn_at(arc, grid.at(depth, arc)),
            None => self.profile.at(arc),
        };
        let [y, z] = point.place;
        let [along_y, along_z] = point.tangent;
        RailPoint {
            place: [y + self.offset, z],
            normal: [-along_z, along_y],
        }
    }
}
