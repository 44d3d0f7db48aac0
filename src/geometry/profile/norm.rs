//! Wheels with which programs for the equivalent conicity are compared: A, B, H and I of UIC 519, which EN 15302 has taken over.
//!
//! Both publish them as 1000 rows of points, of which the files of the open program A_WRCC (GitHub, criogenox) have the numbers. The arcs and
//! lines here are what these points lie on, to 1e-3 mm from the flange's root to 28 mm (H to 0.011 mm about the corner of its two lines, which its
//! points round off); they join tangentially. Flange and side are those of S1002. The norm's rail A is `UIC60` inclined by 1:20, to
//! 4e-4 mm: the gauge of 1435 mm, measured from the height of the running circle, is 1435.16 mm 14 mm below the rail's top.

use super::outline::Part;

/// Side of the flange, z = slope·y + height, `mm`, upward.
const SIDE: [f64; 2] = [2.747_477_419, 93.576_667_419];
/// Radius of the flange's root, `mm`.
const ROOT: f64 = 14.0;
/// End of the tread, where a steeper line begins, and end of the profile, `mm`.
const ENDS: [f64; 2] = [30.0, 60.0];

/// An arc, convex downward in the wheel's material where the radius is negative, by its centre, in `mm` with z upward.
#[derive(Clone, Copy)]
struct Circle {
    centre: [f64; 2],
    radius: f64,
}

impl Circle {
    /// Part of the circle's upper half between two lateral positions.
    fn part(&self, ends: [f64; 2]) -> Part<'static> {
        Part::arc(
            self.centre.map(|v| 1e-3 * v),
            -1e-3 * self.radius,
            ends.map(|v| 1e-3 * v),
        )
    }

    /// Circle within this one that touches it at a lateral position from inside, or contains it, where its radius is larger.
    fn touching(&self, y: f64, radius: f64) -> Circle {
        let across = y - self.centre[0];
        let up = (self.radius * self.radius - across * across).sqrt();
        let share = 1.0 - radius / self.radius;
        Circle {
            centre: [self.centre[0] + share * across, self.centre[1] + share * up],
            radius,
        }
    }
}

fn line([slope, height]: [f64; 2], ends: [f64; 2]) -> Part<'static> {
    let [from, to] = ends.map(|y| [1e-3 * y, 1e-3 * (slope * y + height)]);
    Part::line(from, to)
}

/// Circle of a radius below two lines.
fn corner(radius: f64, first: [f64; 2], second: [f64; 2]) -> Circle {
    let [a, b] = [first, second].map(|[slope, height]| [slope, height - radius * 1f64.hypot(slope)]);
    let y = (b[1] - a[1]) / (a[0] - b[0]);
    Circle {
        centre: [y, a[0] * y + a[1]],
        radius,
    }
}

/// Lateral position at which a circle touches a line of this slope from below.
fn touch(circle: &Circle, slope: f64) -> f64 {
    circle.centre[0] - circle.radius * slope / 1f64.hypot(slope)
}

/// Root of the flange between its side and a circle of the tread, and the lateral position at which they touch.
fn root(tread: &Circle) -> (Circle, f64) {
    let [slope, height] = SIDE;
    let lift = height - ROOT * 1f64.hypot(slope) - tread.centre[1];
    // On the line ROOT below the side, at the distance of the radii's difference from the tread's centre.
    let (a, b) = (1.0 + slope * slope, slope * lift - tread.centre[0]);
    let c = tread.centre[0].powi(2) + lift * lift - (tread.radius - ROOT).powi(2);
    let y = (-b + (b * b - a * c).max(0.0).sqrt()) / a;
    let centre = [y, slope * y + lift + tread.centre[1]];
    let share = ROOT / (tread.radius - ROOT);
    let touches = centre[0] + share * (centre[0] - tread.centre[0]);
    (Circle { centre, radius: ROOT }, touches)
}

/// Flange of S1002 down to its side, which ends at a lateral position, `mm`.
fn flange(end: f64) -> Vec<Part<'static>> {
    let arc = |centre: [f64; 2], radius: f64, ends: [f64; 2]| {
        Part::arc(centre.map(|v| 1e-3 * v), 1e-3 * radius, ends.map(|v| 1e-3 * v))
    };
    vec![
        arc([-49.5, -9.519_259_302], 20.5, [-70.0, -62.764_705_882]),
        arc([-55.0, -16.0], 12.0, [-62.764_705_882, -49.662_510_381]),
        arc(
            [-58.558_326_413, -8.834_924_130],
            20.0,
            [-49.662_510_381, -39.764_473_993],
        ),
        line(SIDE, [-39.764_473_993, end]),
    ]
}

/// Line from the end of the tread on, by the tread's height there.
fn rim(slope: f64, height: f64) -> Part<'static> {
    line([slope, height - slope * ENDS[0]], ENDS)
}

/// Parts of the wheel of a letter; empty for one that there is not.
pub fn wheel(letter: char) -> Vec<Part<'static>> {
    match letter {
        'A' => {
            // Flat from 18.419 mm on; through the running circle.
            let (flat, radius) = (18.418_851, 345.057_258f64);
            let height = radius - (radius * radius - flat * flat).sqrt();
            let crown = Circle {
                centre: [flat, height - radius],
                radius,
            };
            let shoulder = crown.touching(-10.870_907, 96.769_965);
            let (root, touches) = root(&shoulder);
            let side = touch(&root, SIDE[0]);
            let mut parts = flange(side);
            parts.extend([root.part([side, touches]), shoulder.part([touches, -10.870_907])]);
            parts.extend([crown.part([-10.870_907, flat]), line([0.0, height], [flat, ENDS[0]])]);
            parts.push(rim(1.0 / 15.0, height));
            parts
        }
        'B' => {
            // A cone of 1:40 that an arc of 120 mm touches.
            let cone = 0.025f64;
            let y = 2.520_684;
            let arc = Circle {
                centre: [y, cone * y - 120.0 * 1f64.hypot(cone)],
                radius: 120.0,
            };
            let (root, touches) = root(&arc);
            let (side, end) = (touch(&root, SIDE[0]), touch(&arc, cone));
            let mut parts = flange(side);
            parts.extend([root.part([side, touches]), arc.part([touches, end])]);
            parts.extend([line([cone, 0.0], [end, ENDS[0]]), rim(0.05, cone * ENDS[0])]);
            parts
        }
        'H' => {
            // A cone of 1:40 and one of 1:5.
            let (flat, steep) = ([0.025, 0.0], [0.2, 1.789_939]);
            let (root, fillet) = (corner(ROOT, SIDE, steep), corner(5.0, steep, flat));
            let side = touch(&root, SIDE[0]);
            let joints = [
                touch(&root, steep[0]),
                touch(&fillet, steep[0]),
                touch(&fillet, flat[0]),
            ];
            let mut parts = flange(side);
            parts.extend([root.part([side, joints[0]]), line(steep, [joints[0], joints[1]])]);
            parts.extend([fillet.part([joints[1], joints[2]]), line(flat, [joints[2], ENDS[0]])]);
            parts.push(rim(1.0 / 15.0, flat[0] * ENDS[0]));
            parts
        }
        'I' => {
            // Flat from 5 mm on; through the running circle.
            let (flat, radius) = (5.0, 120.0f64);
            let height = radius - (radius * radius - flat * flat).sqrt();
            let arc = Circle {
                centre: [flat, height - radius],
                radius,
            };
            let (root, touches) = root(&arc);
            let side = touch(&root, SIDE[0]);
            let mut parts = flange(side);
            parts.extend([root.part([side, touches]), arc.part([touches, flat])]);
            parts.extend([line([0.0, height], [flat, ENDS[0]]), rim(1.0 / 15.0, height)]);
            parts
        }
        _ => Vec::new(),
    }
}
