use crate::error::ProfileError;
use crate::geometry::profile::{Body, Profile};

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

fn through(points: &[[f64; 2]], smoothing: f64) -> Result<Profile, ProfileError> {
    Profile::from_points(Body::Wheel, "points", "a test", points, smoothing)
}

/// Points of S1002, 0.25 mm from each other on average, without the back of the flange.
fn wheel_points() -> Vec<[f64; 2]> {
    let exact = built_in("S1002").height_function().unwrap();
    (0..=480)
        .map(|k| -60.0 + 0.25 * f64::from(k))
        .map(|y| 1e-3 * y)
        .map(|y| [y, exact.value_slope_curvature(y)[0]])
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

/// A wave of 1 µm and 2 mm length on the tread, smoothed with 4 mm as it is read or later: 1/17 of it is left.
#[test]
fn waves_are_smoothed_by_their_length() {
    let mut points = wheel_points();
    let wave = |y: f64| 1e-6 * (std::f64::consts::TAU * y / 2e-3).sin();
    for point in &mut points {
        point[1] += wave(point[0]);
    }
    let exact = built_in("S1002").height_function().unwrap();
    let read = through(&points, 0.0).unwrap();
    assert_eq!(read.smoothed(0.0).unwrap(), read);
    for smooth in [through(&points, 4e-3), read.smoothed(4e-3)] {
        let smooth = smooth.unwrap().height_function().unwrap();
        let largest = (0..=200)
            .map(|place| 1e-4 * f64::from(place))
            .map(|y| (smooth.value_slope_curvature(y)[0] - exact.value_slope_curvature(y)[0]).abs())
            .fold(0.0, f64::max);
        assert!((largest / (1e-6 / 17.0) - 1.0).abs() < 0.1, "{largest}");
    }
    let refused = read.smoothed(-1e-3).unwrap_err().to_string();
    assert!(refused.contains("smoothing = -0.001"), "{refused}");
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
