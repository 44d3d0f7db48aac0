use super::*;
use crate::geometry::profile::tests::steep_flange;

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

fn wheelset(rail: &str, wheel: &str, dimensions: &Dimensions) -> Wheelset {
    let (rail, wheel) = (built_in(rail), built_in(wheel));
    Wheelset::new([&rail; 2], [&wheel; 2], dimensions).unwrap()
}

/// Rows of the Manchester contact benchmark, case A-2.2 (P. Shackleton, S. Iwnicki, *Vehicle System Dynamics* 46, 2008), as CONTACT
/// publishes them: displacement [mm], yaw [rad], roll [rad], then of the right wheel the places on rail and wheel [mm] and the
/// inclination [rad]. Theirs are centres of pressure of elastic bodies under 10 kN, which stand 0.02 to 0.05 mm deeper; where one place
/// carries, they are within 0.1 mm of where rigid ones touch.
const MANCHESTER: [[f64; 6]; 9] = [
    [1.5, 0.0036, -0.00008103, -19.1554, -10.1558, -0.0753],
    [2.0, 0.0048, -0.00011280, -19.6178, -11.1296, -0.0806],
    [3.0, 0.0072, -0.00018030, -20.5627, -13.0963, -0.0923],
    [4.0, 0.0096, -0.00025570, -21.7944, -15.3505, -0.1078],
    [5.5, 0.0132, -0.00047770, -34.4157, -29.5701, -0.3363],
    [6.0, 0.0144, -0.00062720, -35.3954, -31.1222, -0.4176],
    [7.0, 0.0168, -0.00639300, -41.4881, -41.1389, -1.0634],
    [8.0, 0.0192, -0.00860600, -40.7010, -42.3894, -0.9501],
    [10.0, 0.0240, -0.01126431, -39.4446, -44.3815, -0.7992],
];

/// The benchmark has y to the right and z down: displacement and yaw turn their signs, the roll keeps it. Its rolls are within 1e-4 rad of
/// ours: 0.08 mm of height, of the flange on a slope of 60°.
#[test]
fn contacts_are_where_the_manchester_benchmark_has_them() {
    let wheelset = wheelset("UIC60", "S1002", &Dimensions::default());
    for [lateral, yaw, roll, on_rail, on_wheel, inclination] in MANCHESTER {
        let pose = wheelset.at(-1e-3 * lateral, -yaw).unwrap();
        let touch = pose.touches[1];
        assert!((pose.roll - roll).abs() < 1e-4, "{lateral}: {}", pose.roll);
        assert!((1e3 * touch.on_rail - on_rail).abs() < 0.1, "{lateral}: {touch:?}");
        assert!((1e3 * touch.on_wheel - on_wheel).abs() < 0.1, "{lateral}: {touch:?}");
        assert!((touch.inclination + inclination).abs() < 5e-3, "{lateral}: {touch:?}");
    }
}

/// Displacement and yaw of the other sign exchange the sides.
#[test]
fn the_mirror_image_has_the_mirrored_contacts() {
    let wheelset = wheelset("60E1", "S1002", &Dimensions::default());
    for (lateral, yaw) in [(1e-3, 0.0), (3.3e-3, 5e-3), (-7e-3, 20e-3), (5e-3, -30e-3)] {
        let (pose, mirrored) = (wheelset.at(lateral, yaw).unwrap(), wheelset.at(-lateral, -yaw).unwrap());
        assert!((pose.roll + mirrored.roll).abs() < 1e-12);
        assert!((pose.vertical - mirrored.vertical).abs() < 1e-12);
        for side in 0..2 {
            let (touch, other) = (pose.touches[side], mirrored.touches[1 - side]);
            assert!((touch.on_wheel - other.on_wheel).abs() < 1e-9 && (touch.ahead - other.ahead).abs() < 1e-9);
        }
    }
}

/// Both wheels of a pose touch and neither is below its rail: the silhouettes' smallest height over the rails, between the points of a
/// picture, is 0 to what a curvature of 100 1/m makes of their distance.
#[test]
fn wheels_touch_and_do_not_penetrate() {
    let wheelset = wheelset("60E2", "S1002", &Dimensions::default());
    for lateral in [-8e-3, -5e-3, 0.0, 2e-3, 6e-3] {
        let pose = wheelset.at(lateral, 10e-3).unwrap();
        for side in 0..2 {
            let [rail, wheel] = wheelset.outlines(&pose, side).map(|mut points| {
                points.sort_by(|a, b| a[0].total_cmp(&b[0]));
                points
            });
            let places: Vec<_> = rail.iter().map(|point| point[0]).collect();
            let inside = wheel
                .iter()
                .filter(|point| point[0] > places[0] && point[0] < places[places.len() - 1]);
            let heights = inside.map(|&[y, z]| {
                let (cell, share) = crate::numerics::interpolation::between(&places, y);
                z - rail[cell][1] - share * (rail[cell + 1][1] - rail[cell][1])
            });
            let lowest = heights.fold(f64::INFINITY, f64::min);
            assert!((-1e-6..2e-5).contains(&lowest), "{lateral} {side}: {lowest}");
        }
    }
}

/// A wheel rests on both places of a jump. S1002 on 60E1 inclined 1:40 jumps from the tread to the flange's
/// root at 5.0 mm; its conicity at 3 mm is that of this program, held as it is.
#[test]
fn s1002_on_60e1_has_its_jumps_and_its_conicity() {
    let wheelset = wheelset("60E1", "S1002", &Dimensions::default());
    let sweep = Sweep::new(&wheelset, [-7e-3, 7e-3], 1e-4, 0.0).unwrap();
    assert_eq!(sweep.poses.len(), 141);
    let flange = sweep
        .jumps
        .iter()
        .find(|jump| jump.side == 0 && (jump.lateral - 5e-3).abs() < 0.1e-3);
    let flange = flange.unwrap();
    assert!((flange.on_wheel[0] + 17.7e-3).abs() < 0.2e-3 && (flange.on_wheel[1] + 28.6e-3).abs() < 0.2e-3);
    let mirrored = sweep
        .jumps
        .iter()
        .find(|jump| jump.side == 1 && (jump.lateral + flange.lateral).abs() < 2e-8);
    assert!(mirrored.is_some());
    let conicity = sweep.conicity(3e-3).unwrap();
    assert!((conicity.conicity - 0.1771).abs() < 5e-4, "{conicity:?}");
    assert_eq!(sweep.conicity(8e-3), None);
}

/// Displacements are the numbers that are read, without digits of round-off; those that are given with more digits keep them.
#[test]
fn displacements_of_a_sweep_are_round() {
    let wheelset = wheelset("60E1", "S1002", &Dimensions::default());
    for (range, step, expected) in [
        (
            [-0.0002, 0.0003],
            1e-4,
            &[-0.0002, -0.0001, 0.0, 0.0001, 0.0002, 0.0003][..],
        ),
        ([0.0068, 0.0069], 3e-5, &[0.0068, 0.00683, 0.00686, 0.00689]),
        ([0.001234567890123456, 0.002], 1e-3, &[0.001234567890123456]),
    ] {
        let sweep = Sweep::new(&wheelset, range, step, 0.0).unwrap();
        let found: Vec<_> = sweep.poses.iter().map(|pose| pose.lateral).collect();
        assert_eq!(found, expected);
    }
}

/// Displacements of a table, `mm`: from the first one on, the last one where steps reach it to round-off, and no other.
#[test]
fn a_sweep_begins_at_the_first_displacement() {
    let wheelset = wheelset("60E1", "S1002", &Dimensions::default());
    let swept = |range: [f64; 2], step: f64| {
        let sweep = Sweep::new(&wheelset, range.map(|y| 1e-3 * y), 1e-3 * step, 0.0).unwrap();
        sweep.poses.iter().map(|pose| pose.lateral).collect::<Vec<_>>()
    };
    for (range, step, expected) in [
        ([5.1, 5.3], 1.0, &[5.1][..]),
        ([5.1, 5.3], 0.1, &[5.1, 5.2, 5.3]),
        ([-4.0, 4.0], 3.0, &[-4.0, -1.0, 2.0]),
        ([-4.5, 4.5], 3.0, &[-4.5, -1.5, 1.5, 4.5]),
        ([0.3, 0.99], 0.1, &[0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9]),
        ([2.0, 2.0], 1.0, &[2.0]),
    ] {
        let found = swept(range, step);
        assert_eq!(found.len(), expected.len(), "{range:?}: {found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!((found - 1e-3 * expected).abs() < 1e-15, "{range:?}: {found}");
        }
    }
    // Of multiples of the step 0 is 0, and each one has its mirror image to the bit.
    let found = swept([-0.7, 0.7], 0.1);
    assert_eq!((found.len(), found[7]), (15, 0.0));
    assert!(found.iter().zip(found.iter().rev()).all(|(a, b)| *a == -b));
}

/// The largest amplitude is half the way from the first displacement to the last one, and has its conicity, which round-off of the potentials at both ends
/// took away: it is what a longer table has. An amplitude beyond it has none; nor has
/// the largest one where wheels of two radii go about another middle.
#[test]
fn the_largest_amplitude_has_its_conicity() {
    for (rail, wheel) in [
        ("UIC60", "cone20"),
        ("60E1", "S1002"),
        ("UIC60", "S1002"),
        ("54E1", "S1002"),
    ] {
        let wheelset = wheelset(rail, wheel, &Dimensions::default());
        for (reach, step) in [
            (3e-3, 1e-3),
            (3e-3, 1e-4),
            (4e-3, 1e-4),
            (4.5e-3, 1e-3),
            (4.55e-3, 1e-4),
        ] {
            let sweep = |reach: f64| Sweep::new(&wheelset, [-reach, reach], step, 0.0).unwrap();
            let (found, longer) = (sweep(reach).conicity(reach), sweep(reach + step).conicity(reach));
            let [found, longer] = [found, longer].map(|found| found.unwrap().conicity);
            assert!(
                (found / longer - 1.0).abs() < 1e-9,
                "{rail} {wheel} {reach} {step}: {found} {longer}"
            );
            assert_eq!(sweep(reach).conicity(1.001 * reach), None);
        }
    }
    let (rail, wheel) = (built_in("60E1"), built_in("S1002"));
    let other = Dimensions {
        wheel_radii: [0.46, 0.4601],
        ..Dimensions::default()
    };
    let unequal = Wheelset::new([&rail; 2], [&wheel; 2], &other).unwrap();
    let sweep = Sweep::new(&unequal, [-3e-3, 3e-3], 1e-4, 0.0).unwrap();
    assert_eq!(sweep.conicity(3e-3), None);
}

#[test]
fn what_is_no_wheelset_is_refused() {
    let (rail, wheel) = (built_in("60E1"), built_in("S1002"));
    let narrow = Dimensions {
        gauge: -1.0,
        ..Dimensions::default()
    };
    let deep = Dimensions {
        gauge_depth: 45e-3,
        ..Dimensions::default()
    };
    let large = Dimensions {
        wheel_radii: [0.46, 5.5],
        ..Dimensions::default()
    };
    let good = Dimensions::default();
    let tight = Dimensions { gauge: 1.3, ..good };
    let on_flanges = wheelset("60E1", "S1002", &tight);
    let wheelset = wheelset("60E1", "S1002", &good);
    for (error, said) in [
        (
            Wheelset::new([&wheel; 2], [&wheel; 2], &good).unwrap_err(),
            "a rail is needed",
        ),
        (
            Wheelset::new([&rail; 2], [&rail; 2], &good).unwrap_err(),
            "a wheel is needed",
        ),
        (
            Wheelset::new([&rail; 2], [&wheel; 2], &narrow).unwrap_err(),
            "gauge = -1",
        ),
        (
            Wheelset::new([&rail; 2], [&wheel; 2], &large).unwrap_err(),
            "wheel_radius of the right wheel = 5.5: allowed is 0.05 to 5 m",
        ),
        (
            Wheelset::new([&rail; 2], [&wheel; 2], &deep).unwrap_err(),
            "depth of the gauge",
        ),
        (wheelset.at(0.1, 0.0).unwrap_err(), "lateral displacement 100 mm"),
        (
            wheelset.at(0.03, 0.0).unwrap_err(),
            "at the lateral displacement 30 mm and the yaw 0 mrad the left wheel stands on its flange: it touches at -53.44 mm on its profile, and the tip of the flange \
             reaches to -50.18 mm",
        ),
        (
            wheelset.at(-0.018, 0.0).unwrap_err(),
            "at the lateral displacement -18 mm and the yaw 0 mrad the right wheel stands on its flange",
        ),
        (on_flanges.clone().at(0.0, 0.0).unwrap_err(), "stands on its flange"),
        (on_flanges.level().at(2e-3, 0.0).unwrap_err(), "stands on its flange"),
        (wheelset.at(f64::NAN, 0.0).unwrap_err(), "lateral displacement NaN"),
        (wheelset.at(0.0, 1.0).unwrap_err(), "yaw = 1"),
        (Sweep::new(&wheelset, [-1e-3, 1e-3], 0.0, 0.0).unwrap_err(), "step = 0"),
        (
            Sweep::new(&wheelset, [-1e-3, f64::NAN], 1e-4, 0.0).unwrap_err(),
            "last displacement = NaN",
        ),
    ] {
        assert!(error.to_string().contains(said), "{error}");
    }
}

/// Worn and rough profiles at random displacements and yaws, with a fixed seed: a place where both wheels touch and neither is lower, to the
/// roughness between stations, or an error, and no panic.
#[test]
fn rough_profiles_do_no_harm() {
    let mut state = 0x9e37_79b9_7f4a_7c15u64;
    let mut draw = move |from: f64, to: f64| {
        // Marsaglia's xorshift.
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        from + (to - from) * (state >> 11) as f64 / (1u64 << 53) as f64
    };
    let mut touched = 0;
    for round in 0..40 {
        let mut worn = |name: &str| {
            let profile = built_in(name);
            let (depth, rough) = (draw(0.0, 2e-3), draw(0.0, 2e-5));
            let (place, breadth) = (draw(-40e-3, 20e-3), draw(3e-3, 20e-3));
            let sign = if profile.body() == Body::Rail { -1.0 } else { 1.0 };
            let points: Vec<_> = profile
                .points()
                .into_iter()
                .map(|[y, z]| {
                    [
                        y,
                        z + sign * depth * (-((y - place) / breadth).powi(2)).exp() + draw(-rough, rough),
                    ]
                })
                .collect();
            let smoothing = if round % 2 == 0 { 0.0 } else { 3e-3 };
            Profile::from_points(profile.body(), name, "a test", &points, smoothing)
        };
        let (Ok(rail), Ok(wheel)) = (worn("60E1"), worn("S1002")) else {
            continue;
        };
        let Ok(wheelset) = Wheelset::new([&rail; 2], [&wheel; 2], &Dimensions::default()) else {
            continue;
        };
        for _ in 0..5 {
            let (lateral, yaw) = (draw(-12e-3, 12e-3), draw(-60e-3, 60e-3));
            let Ok(pose) = wheelset.at(lateral, yaw) else {
                continue;
            };
            touched += 1;
            for touch in pose.touches {
                let values = [
                    touch.on_rail,
                    touch.on_wheel,
                    touch.ahead,
                    touch.inclination,
                    touch.rolling_radius,
                ];
                assert!(values.iter().all(|value| value.is_finite()));
                assert!((touch.rolling_radius - 0.46).abs() < 0.05);
            }
            assert!(pose.roll.abs() < LARGEST_ROLL && pose.vertical.abs() < 0.05);
        }
    }
    assert!(touched > 80, "{touched}");
}

/// A flange whose face is 80° or 82° steep touches the rail within a quarter of a millimetre of where the rail is too steep to be looked at, of 82° in a
/// hundredth of that: all the same it is found, by a level wheelset and by one that rolls.
#[test]
fn a_steep_flange_touches_close_to_the_rails_edge() {
    for degrees in [80.0, 82.0_f64] {
        touches_close_to_the_rails_edge(degrees);
    }
}

fn touches_close_to_the_rails_edge(degrees: f64) {
    let steep = degrees.to_radians();
    let wheel = steep_flange(degrees);
    let rail = Profile::built_in("60E1").unwrap();
    let rolling = Wheelset::new([&rail; 2], [&wheel; 2], &Dimensions::default()).unwrap();
    let wheelset = rolling.clone().level();
    let mut steepest = 0f64;
    for step in 10..90 {
        let lateral = 1e-4 * f64::from(step);
        rolling.at(lateral, 0.0).unwrap();
        steepest = steepest.max(wheelset.at(lateral, 0.0).unwrap().touches[0].inclination);
    }
    // At the jump from the tread both places are as high, and the wheelset as it passes from one to the other.
    let sweep = Sweep::new(&wheelset, [-5e-3, 5e-3], 1e-4, 0.0).unwrap();
    let jump = sweep.jumps.iter().find(|jump| jump.side == 0).unwrap();
    let [before, after] = [-1e-8, 1e-8].map(|way| wheelset.at(jump.lateral + way, 0.0).unwrap().vertical);
    assert!((before - after).abs() < 1e-6, "{before} {after}");
    // On the face itself, as the rail is steeper only beyond.
    assert!((steepest - steep).abs() < 1e-3, "{steepest}");
}
