use super::*;
use crate::error::Error;

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

/// Points with noise, of a fixed seed: where that leaves no running surface, the error says so and names what smooths it.
#[test]
fn noise_is_named_as_the_reason() {
    let wheel = built_in("S1002");
    for name in built_in::NAMES {
        let turning = built_in(name).turning();
        assert!(turning < 0.5 * MOST_TURNING, "{name}: {turning}");
    }
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut noise = |size: f64| {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        size * ((state >> 11) as f64 / (1u64 << 52) as f64 - 1.0)
    };
    let mut with_noise = |size: f64, smoothing: f64| {
        let points = wheel.points().into_iter();
        let points: Vec<_> = points.map(|place| place.map(|value| value + noise(size))).collect();
        Profile::from_points(Body::Wheel, "a wheel", "a test", &points, smoothing).unwrap()
    };
    let rough = with_noise(0.2e-3, 0.0);
    assert!(rough.is_rough());
    // Smoothed, or with the noise of a good measurement, a profile is none of these.
    for (size, smoothing) in [(0.2e-3, 10e-3), (5e-6, 0.0)] {
        assert!(!with_noise(size, smoothing).is_rough(), "{size}, {smoothing}");
    }
    let error = Error::Profile(rough.nowhere_flat()).to_string();
    assert_eq!(
        error,
        "a wheel: it is nowhere a function of the lateral position; its direction turns to and fro, as noise does, which smoothing takes off \
         (profile_smoothing; of a Profile in Python its smoothing)"
    );
    let (lateral, yaw) = (0.0, 0.0);
    for rough in [false, true] {
        let beside = ProfileError::WheelBesideRail { lateral, yaw, rough }.to_string();
        assert_eq!(
            beside.contains("; a profile's direction turns to and fro"),
            rough,
            "{beside}"
        );
    }
    let smooth = wheel.nowhere_flat().to_string();
    assert_eq!(smooth, "S1002: it is nowhere a function of the lateral position");
}

/// Height of S1002 in `mm`, downward, by the formulas of EN 13715 as they are printed.
fn s1002(y: f64) -> f64 {
    let root = |v: f64| v.max(0.0).sqrt();
    match y {
        y if y < -62.764705882 => 9.519259302 + root(20.5f64.powi(2) - (y + 49.5).powi(2)),
        y if y < -49.662510381 => 16.0 + root(12f64.powi(2) - (y + 55.0).powi(2)),
        y if y < -39.764473993 => 8.834924130 + root(20f64.powi(2) - (y + 58.558326413).powi(2)),
        y if y < -38.426669071 => -93.576667419 - 2.747477419 * y,
        y if y < -35.0 => 16.446 - root(13f64.powi(2) - (y + 26.210665).powi(2)),
        y if y < -26.0 => {
            let powers = [
                -4.320221063e3,
                -1.038384026e3,
                -1.065501873e2,
                -6.051367875,
                -2.054332446e-1,
                -4.169739389e-3,
                -4.687195829e-5,
                -2.252755540e-7,
            ];
            powers.iter().rev().fold(0.0, |sum, c| c + y * sum)
        }
        y if y < 32.15796 => {
            let powers = [
                0.0,
                -3.358537058e-2,
                1.565681624e-3,
                -2.810427944e-5,
                5.844240864e-8,
                -1.562379023e-8,
                5.309217349e-15,
                -5.957839843e-12,
                2.646656573e-13,
            ];
            powers.iter().rev().fold(0.0, |sum, c| c + y * sum)
        }
        y => 1.364323640 - 0.066666667 * y,
    }
}

/// Formulas of the standard leave steps where their parts meet: of up to 6e-8 mm, by which the parts are shifted, and of 1.2e-4 and 3.7e-5 mm
/// at the ends of the root, which a cubic closes.
#[test]
fn s1002_is_that_of_the_standard() {
    let wheel = built_in("S1002");
    let height = wheel.height_function().unwrap();
    let [first, last] = height.range();
    assert!(first < -69.87e-3 && (last - 60e-3).abs() < 1e-15, "{first} {last}");
    for place in 0..=100_000 {
        let y = first + (last - first) * f64::from(place) / 1e5;
        let [z, slope, _] = height.value_slope_curvature(y);
        let expected = -1e-3 * s1002(1e3 * y);
        let allowed = if (-35e-3..-26e-3).contains(&y) { 1.2e-7 } else { 2e-10 };
        assert!((z - expected).abs() < allowed, "{y}: {z} {expected}");
        // Where the step lies within the difference, the standard has no slope.
        if [-35e-3, -26e-3].iter().any(|joint: &f64| (y - joint).abs() < 2e-6) {
            continue;
        }
        let step = 1e-6;
        let difference = -1e-3 * (s1002(1e3 * (y + step)) - s1002(1e3 * (y - step))) / (2.0 * step);
        // The jumps of curvature within the difference, and its round-off.
        assert!(
            (slope - difference).abs() < 2e-4 * (1.0 + slope * slope),
            "{y}: {slope} {difference}"
        );
    }
}

/// Places, directions and curvatures belong together on every profile: differences over 2 µm, whose own error is below 1e-6 rad where the
/// curvature is that of 8 mm. A cell with a jump of curvature at its end is left out.
#[test]
fn tangent_and_curvature_are_derivatives_of_the_place() {
    for name in built_in::NAMES {
        let profile = built_in(name);
        let step = 1e-6;
        let count = 5000;
        for place in 1..count {
            let arc = profile.length() * f64::from(place) / f64::from(count);
            let [before, here, after] = [arc - step, arc, arc + step].map(|arc| profile.at(arc));
            let turned = before.tangent[0] * after.tangent[1] - before.tangent[1] * after.tangent[0];
            // A kink lies between: the norm's wheels have one where the tread ends.
            if turned.abs() > 1e-3 {
                continue;
            }
            let jump = (after.curvature - before.curvature).abs();
            let [y, z] = [0, 1].map(|k| (after.place[k] - before.place[k]) / (2.0 * step));
            let [ty, tz] = here.tangent;
            assert!((ty.hypot(tz) - 1.0).abs() < 1e-14, "{name} {arc}");
            assert!(
                (y - ty).abs() + (z - tz).abs() < 2e-6 + step * jump,
                "{name} {arc}: {y} {z} {ty} {tz}"
            );
            let difference = turned / (2.0 * step);
            assert!(
                (difference - here.curvature).abs() < 1e-5 * here.curvature.abs() + jump + 1e-4,
                "{name} {arc}: {difference} {}",
                here.curvature
            );
        }
    }
}

/// Widths of the heads 14 mm below their tops as the drawings of EN 13674-1 have them, and the radii on the way there. The joints of the
/// standard are rounded to 1 µm; its widths follow from the arcs to 0.02 mm.
#[test]
fn heads_of_rails_have_their_widths_and_radii() {
    for (name, width, radii) in [
        ("60E1", 72.0, [(0.0, 300.0), (18.0, 80.0), (30.0, 13.0)]),
        ("60E2", 72.0, [(0.0, 200.0), (18.0, 70.0), (30.0, 16.0)]),
        ("54E1", 70.0, [(0.0, 300.0), (18.0, 80.0), (30.0, 13.0)]),
        ("49E1", 67.0, [(0.0, 300.0), (18.0, 80.0), (30.0, 13.0)]),
        ("UIC60", 72.0, [(0.0, 300.0), (18.0, 80.0), (30.0, 13.0)]),
    ] {
        let rail = built_in(name);
        let gauge = rail.gauge_point(14e-3).unwrap();
        assert!((gauge + 0.5e-3 * width).abs() < 0.025e-3, "{name}: {gauge}");
        for (y, radius) in radii {
            for side in [-1.0, 1.0] {
                let point = rail.at(rail.arc_of(1e-3 * side * y).unwrap());
                assert!((point.place[0] - 1e-3 * side * y).abs() < 1e-15);
                let found = -1e3 / point.curvature;
                assert!((found / radius - 1.0).abs() < 1e-6, "{name} {y}: {found}");
            }
        }
        let point = rail.at(rail.length());
        assert!(point.curvature.abs() < 1e-6 && point.place[1] < -30e-3, "{name}");
        assert!((rail.at(0.0).place[0] + point.place[0]).abs() < 1e-16);
    }
}

/// Arcs about the centres that reproduce the published points to 2e-4 mm, which do not quite touch each other, against arcs that join
/// tangentially and follow these points, but for a shift of 2e-4 mm, to 2e-5 mm on the crown and the shoulders.
#[test]
fn uic60_is_that_of_the_benchmark() {
    let rail = built_in("UIC60").height_function().unwrap();
    for place in 0..=700 {
        let y = 0.05 * f64::from(place);
        let [centre, down, radius]: [f64; 3] = match y {
            y if y <= 10.25 => [0.0, 300.0, 300.0],
            y if y <= 26.04 => [7.7, 80.135, 80.0],
            _ => [23.016, 14.909, 13.0],
        };
        let expected = 1e-3 * ((radius * radius - (y - centre).powi(2)).sqrt() - down);
        for side in [-1.0, 1.0] {
            let z = rail.value_slope_curvature(1e-3 * side * y)[0];
            assert!((z - expected).abs() < 4e-7, "{y}: {z} {expected}");
        }
    }
}

/// Inclined by 1:40 the crown of 300 mm has its highest point 300 sin(atan(1/40)) mm to the field side.
#[test]
fn an_inclined_rail_has_its_origin_at_its_highest_point() {
    let upright = built_in("60E1");
    let angle = 0.025f64.atan();
    let rail = upright.inclined(angle).unwrap();
    let top = rail.at(rail.arc_of(0.0).unwrap());
    assert!(top.place[1].abs() < 1e-15 && top.tangent[1].abs() < 1e-9);
    assert!(rail.points().iter().all(|[_, z]| *z <= 1e-15));
    let crown = upright.arc_of(0.0).unwrap();
    let moved = rail.at(crown);
    assert!((moved.place[0] + 0.3 * angle.sin()).abs() < 1e-12);
    assert!((moved.tangent[1] - angle.sin()).abs() < 1e-12);
    assert!((moved.curvature - upright.at(crown).curvature).abs() < 1e-8);
    // Its side leans 1:20 − 1:40 from the vertical.
    let start = rail.at(0.0);
    assert!((start.tangent[0] / start.tangent[1] - (0.05f64.atan() - angle).tan()).abs() < 1e-9);
}

#[test]
fn arc_length_and_lateral_position_belong_together() {
    for name in built_in::NAMES {
        let profile = built_in(name);
        let [first, last] = profile.height_function().unwrap().range();
        for place in 1..1000 {
            let y = first + (last - first) * f64::from(place) / 1e3;
            let arc = profile.arc_of(y).unwrap();
            assert!((profile.at(arc).place[0] - y).abs() < 1e-15, "{name} {y}");
        }
        assert_eq!(profile.arc_of(0.2), None);
        assert_eq!(profile.arc_of(-0.2), None);
        assert_eq!(profile.arc_of(f64::NAN), None);
        let beyond = profile.at(profile.length() + 1e-3);
        let end = profile.at(profile.length());
        assert!((beyond.place[0] - end.place[0] - 1e-3 * end.tangent[0]).abs() < 1e-15);
        assert_eq!(beyond.curvature, 0.0);
    }
}

#[test]
fn what_a_profile_has_not_is_refused() {
    let (wheel, rail) = (built_in("S1002"), built_in("60E1"));
    for error in [
        Profile::built_in("60E9").unwrap_err(),
        wheel.inclined(0.025).unwrap_err(),
        wheel.gauge_point(14e-3).unwrap_err(),
        rail.gauge_point(60e-3).unwrap_err(),
        rail.gauge_point(0.0).unwrap_err(),
        rail.gauge_point(f64::NAN).unwrap_err(),
        rail.inclined(0.3).unwrap_err(),
        rail.inclined(f64::NAN).unwrap_err(),
    ] {
        println!("{error}");
    }
    assert!(Profile::built_in("s1002").is_ok());
}

/// Rows of the norm's points, `mm`, to 1.5e-3 mm. Their parts meet: no chord between nodes is shorter than the arc by more than the arc of a
/// circle is, and directions jump only where the tread ends.
#[test]
fn wheels_of_the_norm_are_those_of_its_points() {
    for (name, rows) in [
        (
            "UIC519A",
            [(-28.96, -4.04775), (-16.0, -1.328), (8.3, 0.34374), (24.5, 0.49201)],
        ),
        (
            "UIC519B",
            [(-28.96, -4.17712), (-16.0, -1.412), (8.3, 0.2075), (24.5, 0.6125)],
        ),
        (
            "UIC519H",
            [(-28.96, -4.01811), (-16.0, -1.41), (8.3, 0.2075), (24.5, 0.6125)],
        ),
        (
            "UIC519I",
            [(-28.96, -4.8013), (-16.0, -1.748), (8.3, 0.104), (24.5, 0.10401)],
        ),
    ] {
        let wheel = built_in(name);
        for pair in wheel.arc_lengths().windows(2) {
            let [a, b] = [wheel.at(pair[0]), wheel.at(pair[1])];
            let chord = (b.place[0] - a.place[0]).hypot(b.place[1] - a.place[1]);
            assert!(
                (0.99..=1.0 + 1e-9).contains(&(chord / (pair[1] - pair[0]))),
                "{name} {pair:?}"
            );
            let turned = (a.tangent[0] * b.tangent[1] - a.tangent[1] * b.tangent[0]).abs();
            let curved = a.curvature.abs().max(b.curvature.abs()) * (pair[1] - pair[0]);
            let is_end = (b.place[0] - 30e-3).abs() < 0.3e-3;
            assert!(
                is_end || turned < 1.01 * curved + 1e-4,
                "{name} {pair:?}: {turned} {curved}"
            );
        }
        let height = wheel.height_function().unwrap();
        for (y, expected) in rows {
            let z = 1e3 * height.value_slope_curvature(1e-3 * y)[0];
            assert!((z - expected).abs() < 1.5e-3, "{name} {y}: {z} {expected}");
        }
    }
}

/// Height, slope and second derivative over y are those of the curve over its arc length, up to 80°: the second derivative to 1e-4 of it, but
/// in the cells beside a jump of the curvature.
#[test]
fn the_height_is_that_of_the_curve() {
    for name in built_in::NAMES {
        let profile = built_in(name);
        let height = profile.height_function().unwrap();
        let [first, last] = height.range();
        for place in 1..5000 {
            let arc = profile.length() * f64::from(place) / 5e3;
            let here = profile.at(arc);
            let ([y, z], [ty, tz]) = (here.place, here.tangent);
            let near = [-0.26e-3, 0.26e-3].map(|step| profile.at(arc + step).curvature);
            if ty < 0.17 || y <= first || y >= last || (near[0] - near[1]).abs() > 2.0 {
                continue;
            }
            let [value, slope, second] = height.value_slope_curvature(y);
            assert!(
                (value - z).abs() < 1e-10 && (slope - tz / ty).abs() < 1e-6 * (1.0 + slope * slope),
                "{name} {y}"
            );
            let expected = here.curvature / ty.powi(3);
            assert!(
                (second - expected).abs() < 1e-4 * expected.abs() + 1e-4,
                "{name} {y}: {second} {expected}"
            );
        }
    }
}

/// A wheel whose flange has a groove with a wall cannot be touched beyond it: no height leads there, and it is refused with the place; its measures are there.
#[test]
fn a_wall_on_the_flange_is_refused() {
    let rows = [[45e-3, 0.0], [49e-3, 2e-3], [57e-3, 2e-3], [62e-3, 0.0]];
    let grooved = built_in("S1002").worn_by(&rows).unwrap();
    assert!(grooved.measures().is_ok());
    let said = grooved.height_function().unwrap_err().to_string();
    for part in [
        "the face of its flange is 84 degrees steep or more at y = -41.",
        "above its tip at z = -28.00 mm",
    ] {
        assert!(said.contains(part), "{said}");
    }
    for name in built_in::NAMES {
        assert!(built_in(name).height_function().is_ok(), "{name}");
    }
}

/// A crowned roller has no flange to stand on: its lowest place is where it runs.
#[test]
fn a_crowned_roller_has_no_tip() {
    let points: Vec<_> = (-60..=120)
        .map(|k| {
            let y = 0.5e-3 * f64::from(k);
            [y, y * y / 0.8]
        })
        .collect();
    let roller = Profile::from_points(Body::Wheel, "a roller", "a test", &points, 0.0).unwrap();
    let height = roller.height_function().unwrap();
    assert_eq!(height.flange_tip(), height.range()[0]);
}

/// Lengths in messages have no digits of round-off: 1e3 times 4.1e-3 is 4.1000000000000005.
#[test]
fn lengths_in_messages_are_round() {
    let (value, maximum) = (4.1e-3, 0.3e-3);
    assert_ne!((1e3 * value).to_string(), "4.1");
    let error = ProfileError::NotReached {
        name: "a rail".to_owned(),
        what: "depth of the gauge below the top",
        value,
        minimum: 0.0,
        maximum,
    };
    assert_eq!(
        error.to_string(),
        "a rail: depth of the gauge below the top = 4.1 mm: the profile reaches from 0 to 0.3 mm"
    );
}

/// A wheel with a flat tread, a root of 10 mm, a face of a steepness in degrees down to 18.5 mm below the tread, and a tip of 11.5 mm.
pub fn steep_flange(degrees: f64) -> Profile {
    let (root, tip, steep) = (10.0, 11.5, degrees.to_radians());
    let (sine, cosine) = steep.sin_cos();
    // Millimetres, from the field side to the flange's back: tread, root, face, tip.
    let mut points: Vec<[f64; 2]> = (0..85).map(|k| [60.0 - f64::from(k), 0.0]).collect();
    let arc = |[y, z]: [f64; 2], radius: f64, angle: f64| [y + radius * angle.sin(), z - radius * angle.cos()];
    let parts = |k: i32| 0.01 * f64::from(k);
    points.extend((0..=100).map(|k| arc([-25.0, -root], -root, parts(k) * steep)));
    let [y, z] = points[points.len() - 1];
    let length = (z + 18.5) / sine;
    points.extend(
        (1..=40)
            .map(|k| 0.025 * f64::from(k) * length)
            .map(|way| [y - way * cosine, z - way * sine]),
    );
    let [y, z] = points[points.len() - 1];
    let centre = [y - tip * sine, z + tip * cosine];
    points.extend((1..=100).map(|k| arc(centre, tip, steep - parts(k) * (steep + 1.5))));
    let points: Vec<_> = points
        .into_iter()
        .rev()
        .map(|place| place.map(|value| 1e-3 * value))
        .collect();
    Profile::from_points(Body::Wheel, "steep", "a test", &points, 0.0).unwrap()
}
