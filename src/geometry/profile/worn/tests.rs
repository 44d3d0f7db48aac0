use super::super::outline::{self, Part};
use super::*;

fn outline_of(body: Body, parts: &[Part]) -> Profile {
    Profile::of_curve(body, "test", "a test", outline::curve(parts).unwrap()).unwrap()
}

/// A depth that rises and falls over 30 mm, `m`.
fn bump(middle: f64, most: f64) -> Vec<[f64; 2]> {
    (-150..=150)
        .map(|k| 1e-4 * f64::from(k))
        .map(|arc| [middle + arc, most * (1.0 - (arc / 15e-3).powi(2)).powi(2)])
        .collect()
}

/// A circle stays one: material inside makes it smaller, material outside larger, on either body; negative depths the other way round.
#[test]
fn a_circle_worn_by_one_depth_is_a_circle() {
    let radius = 50e-3;
    for (body, sign, grows) in [
        (Body::Wheel, 1.0, false),
        (Body::Wheel, -1.0, true),
        (Body::Rail, -1.0, false),
        (Body::Rail, 1.0, true),
    ] {
        let arc = Part::arc([0.0, sign * radius], sign * radius, [-30e-3, 30e-3]);
        // A rail's origin is its highest point: of a trough an end.
        let circle = outline_of(body, &[arc]);
        for depth in [2e-3, -1e-3] {
            let worn = circle.worn_by(&[[0.0, depth]]).unwrap();
            let expected = if grows { radius + depth } else { radius - depth };
            let centre = |arc: f64| {
                let here = worn.at(arc);
                [
                    here.place[0] - sign * expected * here.tangent[1],
                    here.place[1] + sign * expected * here.tangent[0],
                ]
            };
            let first = centre(0.0);
            for place in 0..=1000 {
                let arc = worn.length() * f64::from(place) / 1e3;
                let curvature = worn.at(arc).curvature;
                assert!(
                    (curvature * sign * expected - 1.0).abs() < 1e-8,
                    "{body:?} {depth}: {curvature}"
                );
                let here = centre(arc);
                assert!(
                    (here[0] - first[0]).hypot(here[1] - first[1]) < 1e-11,
                    "{body:?} {depth} {arc}: {here:?}"
                );
            }
            let length = circle.length() * expected / radius;
            assert!((worn.length() - length).abs() < 1e-12, "{} {length}", worn.length());
        }
    }
}

#[test]
fn no_depth_changes_nothing() {
    for name in super::super::built_in::NAMES {
        let profile = Profile::built_in(name).unwrap();
        assert_eq!(profile.worn_by(&[[0.0, 0.0]]).unwrap(), profile);
    }
    // What is not worn stays, to round-off of the joints behind it.
    let wheel = Profile::built_in("S1002").unwrap();
    let worn = wheel.worn_by(&bump(0.03, 1e-3)).unwrap();
    assert_eq!(worn.source(), "EN 13715, worn");
    for arc in wheel.arc_lengths().iter().filter(|&&arc| arc < 0.0148) {
        let [new, old] = [worn.at(*arc), wheel.at(*arc)];
        assert!(
            (0..2).all(|k| (new.place[k] - old.place[k]).abs() < 1e-14),
            "{arc}: {new:?} {old:?}"
        );
        assert!((new.curvature - old.curvature).abs() < 1e-6, "{arc}: {new:?} {old:?}");
    }
}

/// The area between new and worn curve is ∫ (d − κ d²/2) ds, with the curvature κ towards the material, and to the first order ∫ d ds. What remains are the
/// rows that lie too near to a node for one of their own.
#[test]
fn the_area_is_the_integral_of_the_depth() {
    for (name, places) in [("S1002", [0.052, 0.075, 0.1]), ("60E1", [0.055, 0.075, 0.1])] {
        let profile = Profile::built_in(name).unwrap();
        for middle in places {
            for most in [1e-6, 1e-3, 3e-3, -1e-3] {
                let rows = bump(middle, most);
                let depths = Depths::Rows(Rows::new(&rows));
                let side = if profile.body() == Body::Wheel { 1.0 } else { -1.0 };
                // Rows and nodes of the curve lie between the parts of it.
                let parts = 300_000;
                let step = profile.length() / f64::from(parts);
                let expected: f64 = (0..parts)
                    .map(|part| {
                        let arc = step * (f64::from(part) + 0.5);
                        let [depth, ..] = depths.at(arc, arc);
                        step * (depth - 0.5 * side * profile.at(arc).curvature * depth * depth)
                    })
                    .sum();
                let worn = profile.worn_by(&rows).unwrap();
                let below = |profile: &Profile| {
                    let end = profile.at(profile.length()).place;
                    // Over the end, which is not worn: the origin has moved.
                    profile.curve.integral(0.0, profile.length(), |point| {
                        (point.place[1] - end[1]) * point.tangent[0]
                    })
                };
                let area = side * (below(&worn) - below(&profile));
                assert!(
                    (area - expected).abs() < 1e-5 * expected.abs() + 1e-15,
                    "{name} {middle} {most}: {area} {expected}"
                );
                let linear: f64 = 16.0 / 15.0 * 15e-3 * most;
                assert!(
                    (expected / linear - 1.0).abs() < 200.0 * most.abs() + 1e-4,
                    "{expected} {linear}"
                );
            }
        }
    }
}

/// Direction and curvature are those of the worn curve, by differences over 1 µm, also where a curve was worn many times; its nodes do not become more
/// than 20 for a mm.
#[test]
fn a_profile_that_wears_often_stays_a_curve() {
    let mut profile = Profile::built_in("S1002").unwrap();
    for turn in 0..40 {
        let middle = 0.06 + 1e-3 * f64::from(turn);
        profile = profile.worn_by(&bump(middle, 0.05e-3)).unwrap();
    }
    assert!((profile.arc_lengths().len() as f64) < 20.0 * 1e3 * profile.length());
    let step = 1e-6;
    for place in 1..5000 {
        let arc = profile.length() * f64::from(place) / 5e3;
        let [before, here, after] = [arc - step, arc, arc + step].map(|arc| profile.at(arc));
        let [y, z] = [0, 1].map(|k| (after.place[k] - before.place[k]) / (2.0 * step));
        let jump = (after.curvature - before.curvature).abs();
        assert!(
            (y - here.tangent[0]).hypot(z - here.tangent[1]) < 2e-6 + step * jump,
            "{arc}: {y} {z} {here:?}"
        );
        let turned = before.tangent[0] * after.tangent[1] - before.tangent[1] * after.tangent[0];
        assert!(
            (turned / (2.0 * step) - here.curvature).abs() < 1e-3 * here.curvature.abs() + jump + 0.05,
            "{arc}: {} {here:?}",
            turned / (2.0 * step)
        );
    }
}

/// One depth and back again is the profile as it was, jumps of its curvature included.
#[test]
fn wear_that_is_taken_back_leaves_the_profile() {
    let wheel = Profile::built_in("S1002").unwrap();
    let again = wheel
        .worn_by(&[[0.01, 2e-3]])
        .unwrap()
        .worn_by(&[[0.01, -2e-3]])
        .unwrap();
    assert!((again.length() - wheel.length()).abs() < 1e-10);
    for arc in wheel.arc_lengths() {
        let [found, expected] = [again.at(*arc).place, wheel.at(*arc).place];
        assert!(
            (found[0] - expected[0]).hypot(found[1] - expected[1]) < 1e-9,
            "{arc}: {found:?} {expected:?}"
        );
    }
}

#[test]
fn wear_that_leaves_no_profile_is_refused() {
    let wheel = Profile::built_in("S1002").unwrap();
    let kinked = Profile::built_in("UIC519A").unwrap();
    for (profile, rows, words) in [
        (&wheel, &[][..], "no depth is given"),
        (&wheel, &[[0.01, f64::NAN]], "row 1 is the depth NaN m"),
        (
            &wheel,
            &[[0.01, 1e-3], [0.3, 1e-3]],
            "row 2 is the depth 0.001 m at the arc length 0.3 m",
        ),
        (
            &wheel,
            &[[0.02, 1e-3], [0.01, 1e-3]],
            "rows 1 and 2 are 0.02 and 0.01 m",
        ),
        (&wheel, &[[0.01, 12e-3]], "where its radius is 12.000 mm"),
        (&kinked, &[[0.01, 1e-3]], "would open the two sides of a kink by"),
    ] {
        let said = profile.worn_by(rows).unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
    }
}
