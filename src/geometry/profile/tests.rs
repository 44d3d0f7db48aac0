use super::*;

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
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

fn through(points: &[[f64; 2]], smoothing: f64) -> Result<Profile, ProfileError> {
    Profile::from_points(Body::Wheel, "points", "a test", points, smoothing)
}

/// Points of S1002, 0.25 mm from each other on average, without the back of the flange.
fn wheel_points() -> Vec<[f64; 2]> {
    (0..=480)
        .map(|k| -60.0 + 0.25 * f64::from(k))
        .map(|y| [1e-3 * y, -1e-3 * s1002(y)])
        .collect()
}

/// A spline through exact points against the formulas: within 3 µm of height where an arc of 13 mm ends on a slope of 70°, and 0.002 µm on the tread; its
/// curvature is that of the formulas on the tread to 1e-3.
#[test]
fn points_of_a_formula_give_its_curve() {
    let (exact, mut points) = (built_in("S1002"), wheel_points());
    for reversed in [false, true] {
        if reversed {
            points.reverse();
        }
        let found = through(&points, 0.0).unwrap().height_function().unwrap();
        let exact = exact.height_function().unwrap();
        for place in 0..=1100 {
            let y = 1e-3 * (-57.0 + 0.1 * f64::from(place));
            let ([z, _, second], [expected, _, curved]) =
                (found.value_slope_curvature(y), exact.value_slope_curvature(y));
            let (allowed, tread) = if (-20e-3..30e-3).contains(&y) {
                (2e-9, true)
            } else {
                (3e-6, false)
            };
            assert!((z - expected).abs() < allowed, "{y}: {z} {expected}");
            assert!(
                !tread || (second - curved).abs() < 1e-3 * curved.abs() + 2e-2,
                "{y}: {second} {curved}"
            );
        }
    }
}

/// A wave of 1 µm and 2 mm length on the tread, smoothed with 4 mm: 1/17 of it is left.
#[test]
fn waves_are_smoothed_by_their_length() {
    let mut points = wheel_points();
    let wave = |y: f64| 1e-6 * (std::f64::consts::TAU * y / 2e-3).sin();
    for point in &mut points {
        point[1] += wave(point[0]);
    }
    let (smooth, exact) = (through(&points, 4e-3).unwrap(), built_in("S1002"));
    let [smooth, exact] = [smooth, exact].map(|profile| profile.height_function().unwrap());
    let largest = (0..=200)
        .map(|place| 1e-4 * f64::from(place))
        .map(|y| (smooth.value_slope_curvature(y)[0] - exact.value_slope_curvature(y)[0]).abs())
        .fold(0.0, f64::max);
    assert!((largest / (1e-6 / 17.0) - 1.0).abs() < 0.1, "{largest}");
}

/// A roof of 40° keeps its ridge, whatever is smoothed; one of 20° is rounded.
#[test]
fn a_kink_stays_a_kink() {
    for (angle, sharp) in [(40f64, true), (20.0, false)] {
        let slope = (0.5 * angle).to_radians().tan();
        let roof: Vec<_> = (-100..=100)
            .map(|k| 2e-4 * f64::from(k))
            .map(|y| [y, -slope * y.abs()])
            .collect();
        let rail = Profile::from_points(Body::Rail, "roof", "a test", &roof, 2e-3).unwrap();
        let height = rail.height_function().unwrap();
        let [before, after] = [-1e-6, 1e-6].map(|y| height.value_slope_curvature(y)[1]);
        let turned = (before.atan() - after.atan()).to_degrees();
        assert!(
            if sharp {
                (turned - angle).abs() < 0.1
            } else {
                turned.abs() < 1.0
            },
            "{angle}: {turned}"
        );
    }
}

/// Doubled points, and a measurement that goes back by 0.1 mm as a feeler does that is set down twice.
#[test]
fn doubled_points_and_ways_back_are_averaged() {
    let (plain, mut points) = (wheel_points(), Vec::new());
    for (place, point) in plain.iter().enumerate() {
        points.push(*point);
        if place % 7 == 3 {
            points.push(*point);
        }
        if place % 50 == 20 {
            points.push([point[0] - 1e-4, point[1] + 1e-7]);
        }
    }
    let found = through(&points, 1e-3).unwrap().height_function().unwrap();
    let exact = built_in("S1002").height_function().unwrap();
    for place in -200..=550 {
        let y = 1e-4 * f64::from(place);
        let [z, expected] = [&found, &exact].map(|height| height.value_slope_curvature(y)[0]);
        assert!((z - expected).abs() < 1e-5, "{y}: {z} {expected}");
    }
}

#[test]
fn points_that_make_no_profile_are_refused() {
    let points = wheel_points();
    let with = |change: &dyn Fn(&mut Vec<[f64; 2]>)| {
        let mut changed = points.clone();
        change(&mut changed);
        through(&changed, 0.0).unwrap_err().to_string()
    };
    for (error, said) in [
        (with(&|points| points.clear()), "0 distinct points"),
        (with(&|points| points.truncate(2)), "2 distinct points"),
        (with(&|points| points[17][1] = f64::NAN), "point 18 is (-0.05575, NaN)"),
        (with(&|points| points[17][0] = f64::INFINITY), "is (inf"),
        (with(&|points| points.extend(wheel_points())), "two branches"),
        (
            with(&|points| points.iter_mut().flatten().for_each(|v| *v *= 1e3)),
            "mm long",
        ),
        (
            with(&|points| points.iter_mut().flatten().for_each(|v| *v *= 1e-3)),
            "distinct points",
        ),
        (
            with(&|points| points.retain(|point| point[0] > 1e-3)),
            "the running circle",
        ),
    ] {
        assert!(error.contains(said), "{error}");
    }
    let wrong = through(&points, -1.0).unwrap_err().to_string();
    assert!(wrong.contains("smoothing = -1"), "{wrong}");
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
