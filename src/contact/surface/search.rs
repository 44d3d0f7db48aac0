//! Search of contacts: where the undeformed wheel would overlap the rail.
//!
//! Along the rail's profile, at points half a millimetre from each other, the place along the rail is found at which the wheel comes
//! closest. The overlap of the bodies at a given height of the wheel is a number of regions, each of which may be a contact. The contact
//! itself is smaller than its region: of an ellipse in the ratio of 1 to √2.

use super::bodies::Bodies;
use super::windows::Region;
use crate::geometry::hertz::HertzEllipse;
use crate::geometry::unrolled::{NOWHERE, PlacedWheel, RailPoint, WheelsetPosition};

/// Regions that a search may find.
pub const REGIONS: usize = 8;
/// Limit of the heights that are tried for that at which the bodies touch: a bisection of centimetres, where nothing better helps.
const TOUCH_STEPS: usize = 30;
/// Way over which the distance is linear in the height of the wheel to a thousandth of a micrometre, `m`.
const LINEAR: f64 = 1e-5;
/// Least change of the distance with the height that counts: walls of 84° and more carry nothing of a load. The steepest flanges have 75°.
pub const LEAST_RISE: f64 = 0.1;
/// Most of that at a place where the bodies can touch: there it is the vertical part of the normal, at most 1. Where a line along the rail's normal
/// grazes the wheel it is up to 20.
const MOST_RISE: f64 = 2.0;
/// Size of the region that a window is placed for over that of the overlap.
const REGION_SHARE: f64 = 0.82;
/// Size of a contact over that of the overlap.
const CONTACT_SHARE: f64 = 0.71;
/// Points of the search to either side by which curvatures are found: 1 mm, so that waves of a micrometre of a measured profile do not count.
const CURVED: usize = 2;
/// Depth of the overlap where that region ends, over the largest depth: of a parabola, 1 less the square of the share.
const EDGE_SHARE: f64 = 1.0 - REGION_SHARE * REGION_SHARE;

/// Wheel over one point of the rail's profile, where it is closest along the rail.
#[derive(Debug, Clone, Copy, Default)]
struct Closest {
    arc: f64,
    along: f64,
    distance: f64,
    /// Change of the distance with the height of the wheel.
    rise: f64,
    /// Second derivative of the distance along the rail, `1/m`.
    curvature: f64,
}

impl Closest {
    /// Way that the wheel may be lowered until it touches there, `m`; infinite where the normal does not lead to a place of the wheel that can touch.
    fn room(&self) -> f64 {
        if self.rise > LEAST_RISE {
            self.distance / self.rise
        } else {
            f64::INFINITY
        }
    }

    /// Whether the normal leads to a place of the wheel that can touch.
    fn is_met(&self) -> bool {
        self.distance < NOWHERE
    }
}

/// Region in which the bodies overlap.
#[derive(Debug, Clone, Copy, Default)]
pub struct Overlap {
    /// Extent, shrunk to what a contact needs.
    pub region: Region,
    /// Largest overlap, `m`.
    pub depth: f64,
    /// Change of the distance with the height of the wheel where it is deepest.
    pub rise: f64,
    /// Second derivatives of the distance along and across where it is deepest, `1/m`.
    pub curvatures: [f64; 2],
}

/// Deepest overlap over one point of the rail's profile.
#[derive(Debug, Clone, Copy)]
pub struct Deepest {
    /// Place along the rail and arc length, `m`.
    pub place: [f64; 2],
    /// Overlap, `m`.
    pub depth: f64,
    /// Half of its extent along the rail, shrunk to what a contact needs, `m`.
    pub half_length: f64,
    /// Distance of the points, `m`.
    pub spacing: f64,
}

impl Deepest {
    /// Region about it, to a distance across, `m`.
    pub fn region(&self, half_breadth: f64) -> Region {
        let [along, across] = self.place;
        Region {
            along: [along - self.half_length, along + self.half_length],
            across: [across - half_breadth, across + half_breadth],
            narrowest: 2.0 * half_breadth,
            sharpest: f64::INFINITY,
            is_measured: false,
        }
    }
}

/// Buffers of a search, and what the last one has found.
pub struct Search {
    points: Vec<Closest>,
    overlaps: Vec<Overlap>,
    /// Whether the last search for the height at which the bodies touch has found one.
    touches: bool,
}

impl Search {
    /// Buffers for the points of a rail.
    pub fn new(bodies: &Bodies) -> Search {
        Search {
            points: vec![Closest::default(); bodies.scan.len()],
            overlaps: Vec::with_capacity(REGIONS),
            touches: false,
        }
    }

    /// Finds the height of the axle's middle at which the bodies touch first, `m`, from a guess of it. The points are those at that height
    /// after it. Where a flange stands beside the head, the bodies overlap below a height and not above it, and do not touch at any.
    pub fn touch(&mut self, bodies: &Bodies, position: &WheelsetPosition, guess: f64) -> f64 {
        let mut height = guess;
        self.touches = false;
        // Heights that are known to be too low and too high, and the room at the height before.
        let (mut bracket, mut last) = ([f64::NEG_INFINITY, f64::INFINITY], f64::INFINITY);
        for _ in 0..TOUCH_STEPS {
            self.scan(bodies, &WheelsetPosition { height, ..*position });
            let (within, first) = (self.room(), self.first_room());
            // A flange that stands beside the head is closest where the rail is as steep as a wall, at the end of the points, and the wheel is to rise by
            // what it overlaps there.
            let room = if within.is_finite() && first > within.min(0.0) - LINEAR {
                within
            } else {
                first
            };
            if !room.is_finite() {
                break;
            }
            bracket[usize::from(room > 0.0)] = height;
            height -= room;
            if room == within && room.abs() <= LINEAR {
                self.touches = true;
                self.lower(room);
                height -= self.sharpen(bodies, &WheelsetPosition { height, ..*position });
                break;
            }
            // The way along the rail's normals is to another part of the wheel than touches: beside a flange it goes to and fro.
            let [low, high] = bracket;
            let lost = !(low < height && height < high) || room.abs() > 0.5 * last;
            if lost && low.is_finite() && high.is_finite() {
                height = 0.5 * (low + high);
            }
            last = room.abs();
        }
        height
    }

    /// Lowers the wheel over the points by a small way, `m`.
    fn lower(&mut self, way: f64) {
        for point in &mut self.points {
            point.distance -= way * point.rise;
        }
    }

    /// Finds the points exactly about the first one that touches, at the position at which the others are to the first order, and lowers the wheel by what
    /// it may still be lowered, which is returned, `m`.
    fn sharpen(&mut self, bodies: &Bodies, position: &WheelsetPosition) -> f64 {
        let inner = 1..self.points.len() - 1;
        let Some((middle, _)) = self.first().filter(|(point, _)| inner.contains(point)) else {
            return 0.0;
        };
        let wheel = PlacedWheel::new(&bodies.wheel, position);
        for number in middle - 1..=middle + 1 {
            let before = self.points[number];
            if before.is_met() {
                let (arc, point) = &bodies.scan[number];
                self.points[number] = closest(&wheel, *arc, point, (before.along, before.distance));
            }
        }
        let room = self.room();
        if !room.is_finite() {
            return 0.0;
        }
        self.lower(room);
        room
    }

    /// Whether the last search for the height at which the bodies touch has found one.
    pub fn touches(&self) -> bool {
        self.touches
    }

    /// Number of the point of the scan at which the bodies touch first, and its place along the rail, `m`; none where they do not.
    pub fn first(&self) -> Option<(usize, f64)> {
        let rooms = self.points.iter().map(Closest::room).enumerate();
        let least = rooms
            .filter(|(_, room)| room.is_finite())
            .min_by(|(_, a), (_, b)| a.total_cmp(b));
        least.map(|(number, _)| (number, self.points[number].along))
    }

    /// Place along the rail and arc length, `m`, of the point at which the bodies touch first; none where they do not.
    pub fn first_place(&self) -> Option<[f64; 2]> {
        self.first().map(|(number, along)| [along, self.points[number].arc])
    }

    /// Region about the point at which the bodies touch first, to the ones beside it, that a wheel lower by `approach` `m` may press on.
    pub fn about_first(&self, approach: f64) -> Option<Region> {
        let point = &self.points[self.first()?.0];
        let deepest = self.deepest_over(point, approach * point.rise);
        Some(deepest.region(deepest.spacing))
    }

    /// Change of the height at which the bodies touch first, with a change of the position at an unchanged height, `m`. The points are those at the
    /// position, at that height: the least room of the parabola through three of them stays 0.
    pub fn touch_change(&self, bodies: &Bodies, position: &WheelsetPosition, change: &WheelsetPosition) -> f64 {
        let Some((middle, _)) = self
            .first()
            .filter(|(point, _)| (1..self.points.len() - 1).contains(point))
        else {
            return 0.0;
        };
        if !self.points[middle - 1..=middle + 1]
            .iter()
            .all(|point| point.room().is_finite())
        {
            return 0.0;
        }
        let wheel = PlacedWheel::new(&bodies.wheel, position);
        let three = [middle - 1, middle, middle + 1].map(|point| {
            let Closest {
                along, distance, rise, ..
            } = self.points[point];
            let at = wheel.distance(along, &bodies.scan[point].1, distance);
            (distance / rise, wheel.distance_change(&at, change) / rise)
        });
        let [(before, before_change), (here, here_change), (after, after_change)] = three;
        let ratio = 0.5 * (before - after) / (before + after - 2.0 * here);
        let sides = [0.5 * (ratio * ratio - ratio), 0.5 * (ratio * ratio + ratio)];
        -((1.0 - ratio * ratio) * here_change + sides[0] * before_change + sides[1] * after_change)
    }

    /// Way that the wheel may be lowered until one of the points touches, `m`.
    fn first_room(&self) -> f64 {
        self.first()
            .map_or(f64::INFINITY, |(number, _)| self.points[number].room())
    }

    /// Way that the wheel may be lowered until it touches, `m`: the smallest at the points, and on the parabolas through three of them.
    fn room(&self) -> f64 {
        let room = |point: usize| self.points[point].room();
        let mut least = f64::INFINITY;
        for point in 1..self.points.len().saturating_sub(1) {
            let [before, here, after] = [point - 1, point, point + 1].map(room);
            if here > least + 1e-4 || here > before || here > after || !(before + after).is_finite() {
                continue;
            }
            let second = before + after - 2.0 * here;
            let slope = 0.5 * (before - after);
            let below = if second > 0.0 {
                0.5 * slope * slope / second
            } else {
                0.0
            };
            least = least.min(here - below);
        }
        least
    }

    /// Finds the closest places of all points.
    fn scan(&mut self, bodies: &Bodies, position: &WheelsetPosition) {
        let wheel = PlacedWheel::new(&bodies.wheel, position);
        let mut guess = (0.0, 0.0);
        for (found, (arc, point)) in self.points.iter_mut().zip(&bodies.scan) {
            *found = closest(&wheel, *arc, point, guess);
            if found.is_met() {
                guess = (found.along, found.distance);
            }
        }
    }

    /// Finds the regions of overlap of a wheel that is lower by `approach` `m` than the height at which the points are.
    pub fn overlaps(&mut self, approach: f64) -> &[Overlap] {
        let Search { points, overlaps, .. } = self;
        overlaps.clear();
        let depth = |point: usize| approach * points[point].rise - points[point].distance;
        let last = points.len() - 1;
        let mut point = 1;
        while point < last && overlaps.len() < REGIONS {
            let is_deepest = depth(point) >= depth(point - 1) && depth(point) > depth(point + 1);
            if !is_deepest {
                point += 1;
                continue;
            }
            let overlap = about(points, point, &depth);
            if overlap.depth <= 0.0 {
                point += 1;
                continue;
            }
            // Two that grow into each other are one.
            match overlaps.last_mut() {
                Some(before) if before.region.across[0] <= overlap.region.across[1] => before.join(&overlap),
                _ => overlaps.push(overlap),
            }
            point += 1;
        }
        overlaps
    }

    /// Overlap at each point where there is one, of a wheel that is lower by `approach` `m` than the height at which the points are; from the
    /// field side to the gauge side.
    pub fn deepest(&self, approach: f64) -> impl Iterator<Item = Deepest> + '_ {
        self.points.iter().filter_map(move |point| {
            let depth = approach * point.rise - point.distance;
            (depth > 0.0).then(|| self.deepest_over(point, depth))
        })
    }

    /// Overlap of the given depth, `m`, over a point.
    fn deepest_over(&self, point: &Closest, depth: f64) -> Deepest {
        Deepest {
            place: [point.along, point.arc],
            depth,
            half_length: REGION_SHARE * half_length(point, depth),
            spacing: self.spacing(),
        }
    }

    /// Distance of two points, `m`: they go from the field side to the gauge side.
    fn spacing(&self) -> f64 {
        self.points[0].arc - self.points[1].arc
    }

    /// Whether the bodies overlap anywhere between two arc lengths, of a wheel that is lower by `approach` `m` than the height at which the points are.
    pub fn is_near(&self, across: [f64; 2], approach: f64) -> bool {
        let spacing = self.spacing();
        let between = |arc: f64| across[0] - spacing <= arc && arc <= across[1] + spacing;
        let mut points = self.points.iter();
        points.any(|point| between(point.arc) && approach * point.rise > point.distance)
    }

    /// Breadth of a contact under the same approach whose bodies are curved against each other all over as these are at their sharpest place, `m`: of the places
    /// between two arc lengths, or no farther from them than the points are from each other, at which they overlap. `approach` as in [`Search::is_near`].
    pub fn sharpest(&self, across: [f64; 2], approach: f64) -> f64 {
        let spacing = self.spacing();
        let chord = CURVED as f64 * spacing;
        let breadth = |number: usize| {
            let [before, here, after] = [number - CURVED, number, number + CURVED].map(|number| self.points[number]);
            let deep = approach * here.rise;
            let carries =
                deep > here.distance.max(0.0) && across[0] - spacing <= here.arc && here.arc <= across[1] + spacing;
            let curvature = (before.distance + after.distance - 2.0 * here.distance) / (chord * chord);
            if carries && before.is_met() && after.is_met() && curvature > 0.0 {
                2.0 * CONTACT_SHARE * (2.0 * deep / curvature).sqrt()
            } else {
                f64::INFINITY
            }
        };
        let numbers = CURVED..self.points.len().saturating_sub(CURVED);
        numbers.map(breadth).fold(f64::INFINITY, f64::min)
    }

    /// Approach under a vertical load, `m`, about: that of Hertz's ellipses in place of the contacts. `modulus` is the contact modulus.
    pub fn approach(&mut self, load: f64, modulus: f64) -> f64 {
        let mut carried = |approach: f64| -> f64 {
            let overlaps = self.overlaps(approach).iter();
            overlaps
                .map(|overlap| overlap.rise * hertz_load(overlap, modulus))
                .sum()
        };
        let (mut low, mut high) = (0.0, 1e-5);
        while carried(high) < load && high < 1e-2 {
            (low, high) = (high, 2.0 * high);
        }
        for _ in 0..6 {
            let middle = 0.5 * (low + high);
            if carried(middle) < load {
                low = middle;
            } else {
                high = middle;
            }
        }
        0.5 * (low + high)
    }
}

/// Wheel over a point of the rail's profile, where it is closest along the rail, from a guess of the place and the distance.
fn closest(wheel: &PlacedWheel, arc: f64, point: &RailPoint, guess: (f64, f64)) -> Closest {
    let rise = WheelsetPosition {
        height: 1.0,
        ..WheelsetPosition::default()
    };
    let (along, at) = wheel.closest(point, guess);
    let rise = wheel.distance_change(&at, &rise);
    let found = Closest {
        arc,
        along,
        distance: at.distance,
        rise,
        curvature: at.curvature_along,
    };
    if rise < MOST_RISE {
        found
    } else {
        Closest {
            distance: NOWHERE,
            rise: 0.0,
            ..found
        }
    }
}

/// Load of the ellipse that has the overlap as its approach, `N`.
fn hertz_load(overlap: &Overlap, modulus: f64) -> f64 {
    let [along, across] = overlap.curvatures;
    let unit = HertzEllipse::new(1.0, (0.5 * along, 0.5 * across), modulus);
    (overlap.depth / unit.approach).powf(1.5)
}

/// Half-length of the overlap at a point where it is `depth` deep, `m`.
fn half_length(point: &Closest, depth: f64) -> f64 {
    (2.0 * depth.max(0.0) / point.curvature.max(0.2)).sqrt()
}

impl Overlap {
    /// Takes another one into its region; it keeps what the deeper one is.
    fn join(&mut self, other: &Overlap) {
        let region = self.region.union(&other.region);
        if other.depth > self.depth {
            *self = *other;
        }
        self.region = region;
    }
}

/// Region about a point at which the overlap is deepest: as far as it is deeper than where a contact ends, and no farther than to where it is
/// least on the way to the next one.
fn about(points: &[Closest], deepest: usize, depth: &impl Fn(usize) -> f64) -> Overlap {
    let step = points[deepest - 1].arc - points[deepest].arc;
    // The parabola through the three points: a small contact may lie between them.
    let slope = 0.5 * (depth(deepest - 1) - depth(deepest + 1)) / step;
    let second = (2.0 * depth(deepest) - depth(deepest - 1) - depth(deepest + 1)) / (step * step);
    // Beside a point whose normal passes the wheel by there is no parabola.
    let is_between = [deepest - 1, deepest + 1].iter().all(|&point| points[point].is_met());
    let shift = if is_between && second > 0.0 {
        (slope / second).clamp(-step, step)
    } else {
        0.0
    };
    let most = depth(deepest) + 0.5 * slope * shift;
    let middle = points[deepest].arc + shift;
    let end = EDGE_SHARE * most;
    let mut along = [points[deepest].along; 2];
    let mut widen = |point: usize| {
        let half = REGION_SHARE * half_length(&points[point], depth(point));
        along = [
            along[0].min(points[point].along - half),
            along[1].max(points[point].along + half),
        ];
    };
    let half = REGION_SHARE * half_length(&points[deepest], most);
    let mut reach = |direction: isize| {
        let mut point = deepest;
        loop {
            let Some(next) = point.checked_add_signed(direction).filter(|&next| next < points.len()) else {
                return points[point].arc;
            };
            // Beyond the place where the overlap is least another region begins.
            if point != deepest && depth(next) > depth(point) {
                return points[point].arc;
            }
            if depth(next) <= end {
                let share = (depth(point) - end) / (depth(point) - depth(next));
                return points[point].arc + share.clamp(0.0, 1.0) * (points[next].arc - points[point].arc);
            }
            point = next;
            widen(point);
        }
    };
    // The points go from the field side to the gauge side.
    let mut across = [reach(1), reach(-1)];
    if is_between && second > 0.0 && across[1] - across[0] < 2.0 * step {
        let half_breadth = REGION_SHARE * (2.0 * most.max(0.0) / second).sqrt();
        across = [middle - half_breadth, middle + half_breadth];
    }
    let breadth = 0.5 * (across[1] - across[0]) / REGION_SHARE;
    let place = points[deepest].along;
    Overlap {
        region: Region {
            along: [along[0].min(place - half), along[1].max(place + half)],
            across,
            narrowest: across[1] - across[0],
            sharpest: f64::INFINITY,
            is_measured: false,
        },
        depth: most,
        rise: points[deepest].rise,
        curvatures: [
            points[deepest].curvature.max(0.2),
            (2.0 * most / (breadth * breadth)).max(0.2),
        ],
    }
}
