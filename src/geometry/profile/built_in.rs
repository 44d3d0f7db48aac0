//! Profiles that are built in: standards' and a benchmark's, from their formulas.
//!
//! | name | profile | source |
//! |---|---|---|
//! | `S1002` | wheel | EN 13715:2020, profile 1/40 of UIC 510-2 (formerly S1002), flange of 28 mm |
//! | `cone20`, `cone40` | wheel without a flange, 1:20 and 1:40 | |
//! | `UIC519A`, `UIC519B`, `UIC519H`, `UIC519I` | wheels A, B, H, I for the comparison of equivalent conicities | UIC 519, EN 15302:2008, annex D; see `norm` |
//! | `60E1`, `60E2`, `54E1`, `49E1` | rail | EN 13674-1:2017 |
//! | `UIC60` | rail 60 of the Manchester contact benchmark, upright | P. Shackleton, S. Iwnicki, *Vehicle System Dynamics* 46 (2008) |
//!
//! Rails stand upright, by their drawings; they are inclined by [`Profile::inclined`].

use super::norm;
use super::outline::{self, Part, bend};
use super::{Body, Profile};
use crate::error::ProfileError;

/// Names of the profiles that are built in.
pub const NAMES: [&str; 12] = [
    "S1002", "cone20", "cone40", "UIC519A", "UIC519B", "UIC519H", "UIC519I", "60E1", "60E2", "54E1", "49E1", "UIC60",
];

/// Names of the profiles of a body that are built in.
pub fn names_of(body: Body) -> Vec<&'static str> {
    let is_of = |name: &&str| Profile::built_in(name).is_ok_and(|profile| profile.body() == body);
    NAMES.into_iter().filter(is_of).collect()
}

const STANDARD_RAIL: &str = "EN 13674-1";

impl Profile {
    /// Profile that is built in; capital letters do not matter.
    ///
    /// # Errors
    /// There is none of this name.
    pub fn built_in(name: &str) -> Result<Profile, ProfileError> {
        match name.to_ascii_uppercase().as_str() {
            "S1002" => s1002(),
            "CONE20" => cone("cone20", 1.0 / 20.0),
            "CONE40" => cone("cone40", 1.0 / 40.0),
            name @ ("UIC519A" | "UIC519B" | "UIC519H" | "UIC519I") => profile(
                Body::Wheel,
                name,
                "EN 15302 (UIC 519)",
                &norm::wheel(name.chars().next_back().unwrap_or_default()),
            ),
            "60E1" => rail("60E1", STANDARD_RAIL, &head_of_60e1()),
            "60E2" => rail("60E2", STANDARD_RAIL, &head_of_60e2()),
            "54E1" => rail("54E1", STANDARD_RAIL, &head_of_54e1()),
            "49E1" => rail("49E1", STANDARD_RAIL, &head_of_49e1()),
            "UIC60" => rail("UIC60", "Manchester contact benchmark", &head_of_uic60()),
            _ => Err(ProfileError::Unknown {
                name: name.to_owned(),
                known: NAMES.join(", "),
            }),
        }
    }
}

/// Head of a rail by its drawing, one half of it, lengths in `mm`.
struct Head<'a> {
    /// Radii of the arcs from the middle outwards, and the distance from the middle at which each ends. They join tangentially.
    arcs: &'a [(f64, f64)],
    /// Radius of the last arc, which ends where it has the side's direction.
    corner: f64,
    /// Drop of the side for each mm outwards.
    side: f64,
    /// Rise of the head's underside for each mm towards the middle, as its inverse, and the height at which it reaches the middle, z
    /// upward: the side ends on it.
    underside: (f64, f64),
}

/// Rail 60E1: EN 13674-1:2017, annex A; head 72 mm wide 14 mm below its top.
fn head_of_60e1() -> Head<'static> {
    Head {
        arcs: &[(300.0, 10.228), (80.0, 26.0265)],
        corner: 13.0,
        side: 20.0,
        underside: (2.75, -51.0),
    }
}

/// Rail 60E2: EN 13674-1:2017, annex A; the head of 60E1 with a lower shoulder.
fn head_of_60e2() -> Head<'static> {
    Head {
        arcs: &[(200.0, 11.889), (70.0, 24.4565), (16.0, 35.387)],
        corner: 8.0,
        side: 20.0,
        underside: (2.75, -51.0),
    }
}

/// Rail 54E1: EN 13674-1:2017, annex A; head 70 mm wide 14 mm below its top.
fn head_of_54e1() -> Head<'static> {
    Head {
        arcs: &[(300.0, 10.012), (80.0, 24.8635)],
        corner: 13.0,
        side: 20.0,
        underside: (2.75, -49.4),
    }
}

/// Rail 49E1: EN 13674-1:2017, annex A; head 67 mm wide 14 mm below its top.
fn head_of_49e1() -> Head<'static> {
    Head {
        arcs: &[(300.0, 7.6335), (80.0, 23.4175)],
        corner: 13.0,
        side: 17.2,
        underside: (3.0, -51.5),
    }
}

/// Rail of the Manchester contact benchmark, which is published as points: arcs of 300, 80 and 13 mm about (0, −300), (7.7, −80.135) and
/// (23.016, −14.909) mm. Arcs that join tangentially there go through these points to 3e-4 mm.
fn head_of_uic60() -> Head<'static> {
    Head {
        arcs: &[(300.0, 10.4997), (80.0, 25.9876)],
        corner: 13.0,
        side: 20.0,
        underside: (2.75, -51.0),
    }
}

/// Outline of a head from the gauge side to the field side.
fn rail(name: &str, source: &str, head: &Head) -> Result<Profile, ProfileError> {
    let mut half: Vec<(f64, f64)> = Vec::new();
    let (mut angle, mut place, mut from) = (0f64, [0.0; 2], 0.0);
    let mut add = |curvature: f64, length: f64| {
        let end = bend(place, angle, curvature, length);
        (place, angle) = (end.place, angle + curvature * length);
        half.push((curvature, length));
        end.place
    };
    // Angles are counted downward here.
    let mut down = 0f64;
    for &(radius, to) in head.arcs {
        let next = (down.sin() + (to - from) / radius).asin();
        add(-1e3 / radius, 1e-3 * radius * (next - down));
        (down, from) = (next, to);
    }
    let steepest = head.side.atan();
    let [y, z] = add(-1e3 / head.corner, 1e-3 * head.corner * (steepest - down));
    let (inverse, middle) = head.underside;
    // Along the side: z − s sin = middle + (y + s cos)/inverse.
    let drop = z - 1e-3 * middle - y / inverse;
    add(0.0, drop / (steepest.sin() + steepest.cos() / inverse));

    let end = [-place[0], place[1]];
    let mut parts = Vec::new();
    let (mut start, mut angle) = (end, -angle);
    for (curvature, length) in half.iter().rev().chain(&half).copied() {
        parts.push(Part::Bend {
            start,
            angle,
            curvature,
            length,
        });
        start = bend(start, angle, curvature, length).place;
        angle += curvature * length;
    }
    profile(Body::Rail, name, source, &parts)
}

/// Coefficients of S1002 between −26 and 32.158 mm, by ascending power of y in `mm`, z down in `mm`.
const TREAD: [f64; 9] = [
    0.0,
    -3.358_537_058e-2,
    1.565_681_624e-3,
    -2.810_427_944e-5,
    5.844_240_864e-8,
    -1.562_379_023e-8,
    5.309_217_349e-15,
    -5.957_839_843e-12,
    2.646_656_573e-13,
];

/// Coefficients of S1002 between −35 and −26 mm.
const ROOT: [f64; 8] = [
    -4.320_221_063e3,
    -1.038_384_026e3,
    -1.065_501_873e2,
    -6.051_367_875,
    -2.054_332_446e-1,
    -4.169_739_389e-3,
    -4.687_195_829e-5,
    -2.252_755_540e-7,
];

/// Wheel S1002: EN 13715, with the coefficients and the joints of the standard, y from the running circle to the field side.
///
/// The coefficients of the root between −35 and −26 mm are rounded such that it lies 1.2e-4 and 3.7e-5 mm off its neighbours at its ends: a
/// step in the tread. A cubic is added to it that closes both steps, and changes its curvature by less than 1e-3 of it.
fn s1002() -> Result<Profile, ProfileError> {
    // From mm downward to m upward.
    let metres = |coefficients: &[f64]| -> Vec<f64> {
        let powers = coefficients.iter().enumerate();
        powers
            .map(|(power, value)| -1e-3 * value * 1e3f64.powi(power as i32))
            .collect()
    };
    let arc = |centre: [f64; 2], radius: f64, ends: [f64; 2]| {
        Part::arc(
            [1e-3 * centre[0], -1e-3 * centre[1]],
            1e-3 * radius,
            ends.map(|end| 1e-3 * end),
        )
    };
    let straight = |[intercept, slope]: [f64; 2], ends: [f64; 2]| {
        let [from, to] = ends.map(|y| [1e-3 * y, -1e-3 * (intercept + slope * y)]);
        Part::line(from, to)
    };
    let (ends, tread) = ([-35e-3, -26e-3], metres(&TREAD));
    let centre = [-26.210_665e-3, -16.446e-3];
    let across = ends[0] - centre[0];
    let down = (13e-3f64.powi(2) - across * across).sqrt();
    let hollow = [centre[1] + down, -across / down];
    let [height, slope, _] = outline::polynomial(&tread, ends[1]);
    let root = outline::bridge(&metres(&ROOT), ends, [hollow, [height, slope]]);
    let parts = [
        arc([-49.5, 9.519_259_302], 20.5, [-70.0, -62.764_705_882]),
        arc([-55.0, 16.0], 12.0, [-62.764_705_882, -49.662_510_381]),
        arc(
            [-58.558_326_413, 8.834_924_130],
            20.0,
            [-49.662_510_381, -39.764_473_993],
        ),
        straight([-93.576_667_419, -2.747_477_419], [-39.764_473_993, -38.426_669_071]),
        arc([-26.210_665, 16.446], -13.0, [-38.426_669_071, -35.0]),
        Part::Graph {
            coefficients: &root,
            ends,
        },
        Part::Graph {
            coefficients: &tread,
            ends: [-26e-3, 32.157_96e-3],
        },
        straight([1.364_323_640, -0.066_666_667], [32.157_96, 60.0]),
    ];
    profile(Body::Wheel, "S1002", "EN 13715", &parts)
}

/// Wheel with a conical tread and no flange, from −70 to 60 mm.
fn cone(name: &str, slope: f64) -> Result<Profile, ProfileError> {
    let [from, to] = [-70e-3, 60e-3].map(|y| [y, slope * y]);
    profile(Body::Wheel, name, "a straight line", &[Part::line(from, to)])
}

fn profile(body: Body, name: &str, source: &str, parts: &[Part]) -> Result<Profile, ProfileError> {
    let curve = outline::curve(parts).ok_or_else(|| ProfileError::NoCurve {
        name: name.to_owned(),
        reason: "its outline has no length".to_owned(),
    })?;
    Profile::of_curve(body, name, source, curve)
}
