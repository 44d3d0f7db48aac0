//! Rail and wheel as they are worn.
//!
//! What a contact has worn off the profiles is kept as depths of cells of the new profiles ([`crate::geometry::profile::DepthGrid`]), which belong to the bodies: windows
//! may come and go over them. A step takes the shapes at its beginning, by the depths of the fields; what it wears off itself, nanometres, the next
//! one sees. Here the shapes are kept beside the depths that made them, and follow them where they have changed: they are the same whatever way led to
//! the depths.

use super::bodies::{Bodies, RAIL, WHEEL, measures};
use super::operators::SurfaceOperators;
use crate::error::{Error, Result};
use crate::geometry::profile::Profile;
use crate::numerics::dense;
use serde::{Deserialize, Serialize};

/// Names of the bodies, by their numbers.
const NAMES: [&str; 2] = ["wheel", "rail"];

/// Depths by which the profiles are worn, means over their cells, `m`; without cells of a body that stays new.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct ProfileWear {
    /// Depths at the end of the step.
    pub depth: [Vec<f64>; 2],
    /// Depths at its beginning, which the contact saw.
    pub before: [Vec<f64>; 2],
}

impl ProfileWear {
    /// Bodies as they were new.
    pub fn new(operators: &SurfaceOperators) -> ProfileWear {
        let unworn = || [WHEEL, RAIL].map(|body| vec![0.0; operators.wear_cells(body)]);
        ProfileWear {
            depth: unworn(),
            before: unworn(),
        }
    }

    /// Begins a step with the depths that there are.
    pub fn begin(&mut self) {
        for (before, depth) in self.before.iter_mut().zip(&self.depth) {
            before.copy_from_slice(depth);
        }
    }

    /// Takes those of other fields.
    pub fn copy_from(&mut self, other: &ProfileWear) {
        for body in [WHEEL, RAIL] {
            self.depth[body].copy_from_slice(&other.depth[body]);
            self.before[body].copy_from_slice(&other.before[body]);
        }
    }
}

/// Wear of the profiles by a step.
#[derive(Debug, Clone, Copy)]
pub struct WornOff {
    /// Areas per time that both profiles lose, `m²/s`.
    pub area_rates: [f64; 2],
    /// Largest change of a depth, `m`.
    pub change: f64,
}

/// Bodies at depths of wear.
pub struct WornBodies {
    /// Bodies at the depths; none where neither of them wears.
    bodies: Option<Bodies>,
    depths: [Vec<f64>; 2],
}

impl WornBodies {
    /// Bodies as they were new.
    pub fn new(operators: &SurfaceOperators) -> WornBodies {
        let depths = [WHEEL, RAIL].map(|body| vec![0.0; operators.wear_cells(body)]);
        if depths.iter().all(Vec::is_empty) {
            return WornBodies { bodies: None, depths };
        }
        let mut bodies = operators.bodies.clone();
        if !depths[WHEEL].is_empty() {
            bodies.wheel.profile = operators.worn_height.function();
            // As after wear that has gone again, to the last bit.
            bodies.measures = measures(&bodies.wheel, operators.flange_back_position);
        }
        if !depths[RAIL].is_empty() {
            bodies.rail.collect_wear(operators.grids[RAIL]);
        }
        WornBodies {
            bodies: Some(bodies),
            depths,
        }
    }

    /// The bodies as they are.
    pub fn of<'b>(&'b self, operators: &'b SurfaceOperators) -> &'b Bodies {
        self.bodies.as_ref().unwrap_or(&operators.bodies)
    }

    /// Whether the bodies are worn by these depths.
    pub fn has(&self, depths: &[Vec<f64>; 2]) -> bool {
        self.depths
            .iter()
            .zip(depths)
            .all(|(own, depths)| dense::differing(own, depths).is_none())
    }

    /// Wears the bodies by the given depths.
    ///
    /// # Errors
    /// [`Error::WornAway`].
    pub fn set(&mut self, operators: &SurfaceOperators, depths: &[Vec<f64>; 2]) -> Result<()> {
        let WornBodies {
            bodies: Some(bodies),
            depths: own,
        } = self
        else {
            return Ok(());
        };
        if let Some(cells) = dense::differing(&own[WHEEL], &depths[WHEEL]) {
            let (grid, depth) = (&operators.grids[WHEEL], &depths[WHEEL]);
            let reach = grid.reach(cells.clone());
            let folded = operators
                .worn_height
                .wear(&mut bodies.wheel.profile, reach, |arc| grid.at(depth, arc));
            if let Err(arc) = folded {
                // Nothing of the shape is known any more.
                own[WHEEL].fill(f64::NAN);
                return Err(worn_away(operators, WHEEL, grid.at(depth, arc)[0], arc));
            }
            own[WHEEL][cells.clone()].copy_from_slice(&depth[cells]);
            bodies.measures = measures(&bodies.wheel, operators.flange_back_position);
        }
        if let Some(cells) = dense::differing(&own[RAIL], &depths[RAIL]) {
            let (grid, depth) = (&operators.grids[RAIL], &depths[RAIL]);
            let [from, to] = grid.reach(cells.clone());
            if let Some(worn) = bodies.rail.depth_mut() {
                worn[cells.clone()].copy_from_slice(&depth[cells.clone()]);
            }
            for (arc, point) in &mut bodies.scan {
                if from <= *arc && *arc <= to {
                    *point = bodies.rail.at(*arc);
                    if point.normal[1] <= 0.0 {
                        own[RAIL].fill(f64::NAN);
                        return Err(worn_away(operators, RAIL, grid.at(depth, *arc)[0], *arc));
                    }
                }
            }
            own[RAIL][cells.clone()].copy_from_slice(&depth[cells]);
        }
        Ok(())
    }
}

/// Profiles of wheel and rail as they are worn; the rail's is upright. Their origins have moved with the surface ([`Profile::worn_by`]).
///
/// # Errors
/// A profile that is worn beyond its radius of curvature.
pub fn profiles(operators: &SurfaceOperators, worn: &ProfileWear) -> Result<[Profile; 2]> {
    let of = |body: usize| {
        if worn.depth[body].is_empty() {
            return Ok(operators.profiles[body].clone());
        }
        let profile = operators.profiles[body].worn_by_cells(&operators.grids[body], &worn.depth[body]);
        profile.map_err(Error::Profile)
    };
    Ok([of(WHEEL)?, of(RAIL)?])
}

fn worn_away(operators: &SurfaceOperators, body: usize, depth: f64, arc: f64) -> Error {
    Error::WornAway {
        body: NAMES[body],
        depth,
        position: operators.profiles[body].at(arc).place[0],
    }
}
