//! One wheel over its rail, seen with y outwards from the track's middle.

use super::Dimensions;
use crate::error::ProfileError;
use crate::geometry::profile::{HeightFunction, Profile};

/// Distance of the stations along the axle at which the distance is computed first, `m`.
const STATION: f64 = 0.25e-3;
/// Local minima this much above the lowest station may be the lowest ones, `m`: across half a station, the height of an arc of 13 mm where it is 84° steep.
const NEAR: f64 = 0.5e-3;
/// Steps to the place between two stations at which the rail ends.
const EDGE_STEPS: usize = 40;

/// Place where a rigid wheel touches its rail; lateral places are positive to the field side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Touch {
    /// Lateral place on the rail's profile as it is inclined, from its highest point, `m`.
    pub on_rail: f64,
    /// Lateral place on the wheel's profile, from its running circle, `m`.
    pub on_wheel: f64,
    /// Place along the track, ahead of the wheelset's centre, `m`.
    pub ahead: f64,
    /// Inclination of the common tangent across the track, from outwards to upwards, rad: positive where the contact's normal on the
    /// wheel points towards the track's middle.
    pub inclination: f64,
    /// Distance from the axle, `m`.
    pub rolling_radius: f64,
}

/// Position of the wheelset as one side sees it, with y outwards.
#[derive(Debug, Clone, Copy)]
pub struct Attitude {
    lateral: f64,
    /// Direction of the axle, outwards.
    axle: [f64; 3],
}

impl Attitude {
    pub fn new(lateral: f64, yaw: f64, roll: f64) -> Attitude {
        Attitude {
            lateral,
            axle: [-yaw.sin() * roll.cos(), yaw.cos() * roll.cos(), roll.sin()],
        }
    }
}

/// A wheel and its rail.
#[derive(Debug, Clone)]
pub struct Pair {
    rail: HeightFunction,
    wheel: HeightFunction,
    /// Place of the rail's highest point, from the track's middle, `m`.
    rail_place: f64,
    /// Place of the running circle, from the wheelset's middle, `m`.
    wheel_place: f64,
    radius: f64,
    /// Place of the flange's tip towards the tread, from the running circle, `m`.
    flange_tip: f64,
}

/// Point of the silhouette, from the wheelset's centre.
#[derive(Debug, Clone, Copy)]
struct Station {
    /// Place along the wheel's profile, from its running circle.
    along: f64,
    place: [f64; 3],
    /// Slope of the silhouette across the track.
    slope: f64,
    radius: f64,
}

/// A wheel's point over the rail.
#[derive(Debug, Clone, Copy)]
struct Above {
    station: Station,
    /// Height of the wheel's point over the rail's, where the wheelset's centre is at the height of the rail's top.
    height: f64,
    /// Slope of that height over the way across the track.
    opening: f64,
    rail_slope: f64,
    on_rail: f64,
}

impl Pair {
    pub fn new(rail: &Profile, wheel: &Profile, dimensions: &Dimensions, radius: f64) -> Result<Pair, ProfileError> {
        let rail_place = 0.5 * dimensions.gauge - rail.gauge_point(dimensions.gauge_depth)?;
        let (rail, wheel) = (rail.height_function()?, wheel.height_function()?);
        Ok(Pair {
            rail_place,
            wheel_place: dimensions.running_circle(),
            flange_tip: wheel.flange_tip(),
            rail,
            wheel,
            radius,
        })
    }

    /// Place of the flange's tip on the wheel towards its tread, `m`, where a contact is on it or beyond it.
    pub fn tip_under(&self, touch: &Touch) -> Option<f64> {
        (touch.on_wheel <= self.flange_tip).then_some(self.flange_tip)
    }

    /// Silhouette at a place along the wheel's profile; `None` where the surface is turned so far that it has none.
    ///
    /// With the axle's direction e and the surface's outward normal u − R′e, u ⊥ e of length 1, the normal has no part along the track where
    /// u_x = R′ e_x.
    fn station(&self, attitude: &Attitude, along: f64) -> Option<Station> {
        let [height, slope, _] = self.wheel.value_slope_curvature(along);
        let (radius, growth) = (self.radius - height, -slope);
        let [ex, ey, ez] = attitude.axle;
        let across = ey.hypot(ez);
        let ux = growth * ex;
        let down = 1.0 - (ux / across).powi(2);
        if down <= 0.0 {
            return None;
        }
        let (parallel, normal) = (-ux * ex / across, -down.sqrt());
        let uy = (parallel * ey - normal * ez) / across;
        let uz = (parallel * ez + normal * ey) / across;
        let station = self.wheel_place + along;
        let (ny, nz) = (uy - growth * ey, uz - growth * ez);
        Some(Station {
            along,
            place: [
                station * ex + radius * ux,
                attitude.lateral + station * ey + radius * uy,
                station * ez + radius * uz,
            ],
            slope: -ny / nz,
            radius,
        })
    }

    fn above(&self, attitude: &Attitude, along: f64) -> Option<Above> {
        let station = self.station(attitude, along)?;
        let on_rail = station.place[1] - self.rail_place;
        let [first, last] = self.rail.range();
        if on_rail < first || on_rail > last {
            return None;
        }
        let [height, rail_slope, _] = self.rail.value_slope_curvature(on_rail);
        Some(Above {
            station,
            height: station.place[2] - height,
            opening: station.slope - rail_slope,
            rail_slope,
            on_rail,
        })
    }

    /// Lowest place of the wheel over the rail.
    fn lowest(&self, attitude: &Attitude) -> Option<Above> {
        let [first, last] = self.wheel.range();
        let count = ((last - first) / STATION).ceil();
        let at = |k: f64| self.above(attitude, first + (last - first) * k / count);
        let mut window: [Option<Above>; 3] = [None; 3];
        let mut minima: Vec<[Above; 3]> = Vec::new();
        let mut lowest = f64::INFINITY;
        let mut visit = |next: Option<Above>| {
            window = [window[1], window[2], next];
            if let Some(here) = next {
                lowest = lowest.min(here.height);
            }
            if let [Some(before), Some(here), Some(after)] = window
                && here.height <= before.height
                && here.height <= after.height
            {
                minima.push([before, here, after]);
            }
        };
        let mut last: Option<Above> = None;
        let mut at_edges = Vec::new();
        for k in 0..=count as usize {
            let next = at(k as f64);
            // A steep flange touches within less than a station of where the rail ends.
            if k > 0 && last.is_some() != next.is_some() {
                let end = edge(at, [k - 1, k].map(|k| k as f64), last.is_some());
                visit(end);
                let between = if last.is_some() { [last, end] } else { [end, next] };
                if let [Some(from), Some(to)] = between
                    && from.opening < 0.0
                    && to.opening > 0.0
                {
                    at_edges.push([from, if from.height < to.height { from } else { to }, to]);
                }
            }
            visit(next);
            last = next;
        }
        minima.append(&mut at_edges);
        let near = minima.iter().filter(|[_, here, _]| here.height <= lowest + NEAR);
        let found = near.map(|minimum| self.refined(attitude, minimum));
        // Where the lowest station is the first or the last one, no minimum between stations is as low.
        found
            .min_by(|a, b| a.height.total_cmp(&b.height))
            .filter(|found| found.height <= lowest)
    }

    /// Place about the lowest of three stations at which wheel and rail have the same slope, by bisection down to round-off. Between the
    /// stations of a rough profile there may be none that is lower: then it is the station.
    fn refined(&self, attitude: &Attitude, [before, here, after]: &[Above; 3]) -> Above {
        let (low, high) = if here.opening < 0.0 {
            (here, after)
        } else {
            (before, here)
        };
        let (mut low, mut high) = (low.station.along, high.station.along);
        for _ in 0..44 {
            let middle = 0.5 * (low + high);
            if self.above(attitude, middle).is_some_and(|above| above.opening < 0.0) {
                low = middle;
            } else {
                high = middle;
            }
        }
        match self.above(attitude, 0.5 * (low + high)) {
            Some(found) if found.height < here.height => found,
            _ => *here,
        }
    }

    /// Height of the wheel's lowest point over the rail, with the wheelset's centre at the height of the rail's top. `None` where the lowest
    /// point is on an edge of a profile.
    pub fn clearance(&self, attitude: &Attitude) -> Option<f64> {
        self.lowest(attitude).map(|lowest| lowest.height)
    }

    /// Place where the wheel touches, and that height.
    pub fn touch(&self, attitude: &Attitude) -> Option<(Touch, f64)> {
        let lowest = self.lowest(attitude)?;
        let touch = Touch {
            on_rail: lowest.on_rail,
            on_wheel: lowest.station.along,
            ahead: lowest.station.place[0],
            inclination: lowest.rail_slope.atan(),
            rolling_radius: lowest.station.radius,
        };
        Some((touch, lowest.height))
    }

    /// Rail and silhouette of the wheel in the track's frame, with y outwards.
    pub fn outlines(&self, attitude: &Attitude, centre: f64) -> [Vec<[f64; 2]>; 2] {
        let along = |range: [f64; 2]| {
            let count = ((range[1] - range[0]) / STATION).ceil();
            (0..=count as usize).map(move |k| range[0] + (range[1] - range[0]) * k as f64 / count)
        };
        let rail = along(self.rail.range()).map(|y| [self.rail_place + y, self.rail.value_slope_curvature(y)[0]]);
        let wheel = along(self.wheel.range()).filter_map(|y| {
            let station = self.station(attitude, y)?;
            Some([station.place[1], station.place[2] + centre])
        });
        [rail.collect(), wheel.collect()]
    }
}

/// Last place over the rail between two stations, of which one is over it: the first one or the other.
fn edge(at: impl Fn(f64) -> Option<Above>, stations: [f64; 2], is_first: bool) -> Option<Above> {
    let [mut over, mut beside] = if is_first { stations } else { [stations[1], stations[0]] };
    for _ in 0..EDGE_STEPS {
        let middle = 0.5 * (over + beside);
        *(if at(middle).is_some() { &mut over } else { &mut beside }) = middle;
    }
    at(over)
}
