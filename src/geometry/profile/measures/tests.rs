use super::super::outline::{self, Part};
use super::*;

fn built_in(name: &str) -> Profile {
    Profile::built_in(name).unwrap()
}

/// Wheel of straight lines and arcs, `mm`, from points that follow each other.
fn wheel(points: &[[f64; 2]]) -> Profile {
    let parts: Vec<_> = points
        .windows(2)
        .map(|pair| Part::line(pair[0].map(|value| 1e-3 * value), pair[1].map(|value| 1e-3 * value)))
        .collect();
    Profile::of_curve(Body::Wheel, "lines", "a test", outline::curve(&parts).unwrap()).unwrap()
}

/// Flange of 30 mm with a face of 60°, from its tip at −60 mm, and a level tread.
fn flange(tread: f64) -> Vec<[f64; 2]> {
    let slope = 60f64.to_radians().tan();
    let root = -60.0 + (30.0 + tread) / slope;
    vec![[-70.0, -10.0], [-60.0, -30.0], [root, tread], [60.0, tread]]
}

/// EN 13715 has a flange of 28 mm in height and 32.5 mm in thickness on S1002. Its formulas give the rest: 10 mm below the running circle is an arc of 13 mm about
/// (−26.210665, 16.446) mm, 2 mm above the tip one of 20 mm about (−58.558326, 8.834924) mm, z downward.
#[test]
fn s1002_has_the_flange_of_the_standard() {
    let measures = built_in("S1002").measures().unwrap();
    let thick = -26.210_665 - (13f64.powi(2) - 6.446f64.powi(2)).sqrt();
    let steep = -58.558_326_413 + (20f64.powi(2) - (26.0 - 8.834_924_130f64).powi(2)).sqrt();
    for (found, expected, nominal) in [
        (measures.flange_height, 28.0, 28.0),
        (measures.flange_thickness, 70.0 + thick, 32.5),
        (measures.flange_gradient, thick - steep, 10.794),
    ] {
        // The formulas leave steps of 1.6e-4 mm in the root, which is between the two.
        assert!((1e3 * found - expected).abs() < 2e-4, "{found} {expected}");
        assert!((expected - nominal).abs() < 5e-4, "{expected} {nominal}");
    }
    assert_eq!(measures.hollow_depth, 0.0);
}

/// A flange of straight lines: height 30 mm; 10 mm below the tread the face is 20 mm above the tip, 20/tan 60° from it.
#[test]
fn lines_have_measures_in_closed_form() {
    let slope = 60f64.to_radians().tan();
    let measures = wheel(&flange(0.0)).measures().unwrap();
    for (found, expected) in [
        (measures.flange_height, 30.0),
        (measures.flange_thickness, 10.0 + 20.0 / slope),
        (measures.flange_gradient, 18.0 / slope),
        (measures.hollow_depth, 0.0),
    ] {
        assert!((1e3 * found - expected).abs() < 1e-11, "{found} {expected}");
    }
}

/// The thickness counts from the back of the flange: with the running circle 72 mm from it, it is 2 mm more than with 70 mm, and nothing else is another.
#[test]
fn the_flange_is_as_thick_as_its_back_is_far() {
    let s1002 = built_in("S1002");
    let (usual, far) = (s1002.measures().unwrap(), s1002.measures_with_back(72e-3).unwrap());
    assert!((far.flange_thickness - usual.flange_thickness - 2e-3).abs() < 1e-15);
    let flange_thickness = usual.flange_thickness;
    assert_eq!(
        WheelMeasures {
            flange_thickness,
            ..far
        },
        usual
    );
    let found = WheelMeasures::of_height(&s1002.height_function().unwrap(), 72e-3).unwrap();
    assert!((found.flange_thickness - far.flange_thickness).abs() < 1e-9);
    for wrong in [0.0, 0.3, f64::NAN] {
        let said = s1002.measures_with_back(wrong).unwrap_err().to_string();
        assert!(said.contains("flange_back_position = "), "{said}");
    }
}

/// A circular hollow in a level tread is as deep as its circle, r − √(r² − c²) with half the chord c; on a cone that rises to the field side
/// it is less: the largest radius to its field side lies below the circle's end by the cone. A false flange beyond counts.
#[test]
fn a_hollow_is_as_deep_as_its_circle() {
    let (radius, half) = (200e-3, 20e-3);
    let depth = radius - f64::sqrt(radius * radius - half * half);
    let middle = depth - radius;
    let begin = flange(0.0)[..3]
        .iter()
        .map(|point| point.map(|value| 1e-3 * value))
        .collect::<Vec<_>>();
    let parts = [
        Part::line(begin[0], begin[1]),
        Part::line(begin[1], begin[2]),
        Part::line(begin[2], [-half, 0.0]),
        Part::arc([0.0, middle], -radius, [-half, half]),
        Part::line([half, 0.0], [50e-3, 0.0]),
        Part::line([50e-3, 0.0], [60e-3, 5e-3]),
    ];
    let hollow = |parts: &[Part]| {
        let wheel = Profile::of_curve(Body::Wheel, "hollow", "a test", outline::curve(parts).unwrap()).unwrap();
        wheel.measures().unwrap()
    };
    let found = hollow(&parts);
    assert!(
        (found.hollow_depth - depth).abs() < 1e-14,
        "{} {depth}",
        found.hollow_depth
    );
    // The running circle is in the hollow's middle.
    assert!((found.flange_height - 30e-3 - depth).abs() < 1e-14);
    let mut falls = parts;
    falls[4] = Part::line([half, 0.0], [50e-3, -1e-3]);
    falls[5] = Part::line([50e-3, -1e-3], [60e-3, 5e-3]);
    let found = hollow(&falls).hollow_depth;
    assert!((found - depth - 1e-3).abs() < 1e-14, "{found} {depth}");
}

/// A tread that is 2 mm lower than the new one, by lines: what is gone is a strip, its end along the face.
#[test]
fn wear_of_lines_is_that_of_closed_forms() {
    let slope = 60f64.to_radians().tan();
    let (new, old) = (wheel(&flange(0.0)), wheel(&flange(2.0)));
    let wear = old.worn_against(&new).unwrap();
    let begin = -60.0 + 30.0 / slope;
    let area = 2.0 * (60.0 - begin) - 0.5 * 2.0 * 2.0 / slope;
    assert!((1e6 * wear.area - area).abs() < 1e-9, "{wear:?} {area}");
    assert!((1e3 * wear.tread_depth - 2.0).abs() < 1e-12, "{wear:?}");
    assert!((1e3 * wear.largest_depth - 2.0).abs() < 1e-9, "{wear:?}");
    assert_eq!(old.worn_area(&new).unwrap(), wear.area);
    let back = new.worn_against(&old).unwrap();
    assert!((back.area + wear.area).abs() < 1e-15 && (back.tread_depth + wear.tread_depth).abs() < 1e-15);
}

/// Worn by one depth d along its normal, a level tread is lower by d, and a face at the angle β, 10 mm below it, is d tan(β/2) nearer to the back. The rest of it is
/// found again: a depth of 1.5 mm in the tread of S1002, and as much on its flange.
#[test]
fn wear_along_the_normal_is_measured() {
    let depth = 1e-3;
    let round = |tread: f64| {
        // A root of 13 mm, which is no kink, and a tip of 5 mm.
        let (angle, radius, tip) = (60f64.to_radians(), 13e-3, 12e-3);
        let root = [-30e-3, tread - radius];
        let [sine, cosine] = [angle.sin(), angle.cos()];
        let steep = [root[0] - radius * sine, root[1] + radius * cosine];
        let length = 12e-3;
        let low = [steep[0] - length * cosine, steep[1] - length * sine];
        let centre = [low[0] - tip * sine, low[1] + tip * cosine];
        let parts = [
            Part::arc(centre, tip, [centre[0] - 8e-3, low[0]]),
            Part::line(low, steep),
            Part::arc(root, -radius, [steep[0], root[0]]),
            Part::line([root[0], tread], [60e-3, tread]),
        ];
        Profile::of_curve(Body::Wheel, "round", "a test", outline::curve(&parts).unwrap()).unwrap()
    };
    let new = round(0.0);
    let worn = new.worn_by(&[[0.0, depth]]).unwrap();
    let [before, after] = [&new, &worn].map(|wheel| wheel.measures().unwrap());
    let lost = before.flange_thickness - after.flange_thickness;
    assert!((lost - depth * 30f64.to_radians().tan()).abs() < 1e-10, "{lost}");
    assert!((before.flange_height - after.flange_height).abs() < 1e-10);

    let new = built_in("S1002");
    let most = 1.5e-3;
    for y in [10e-3, -38e-3] {
        let middle = new.arc_of(y).unwrap();
        let rows: Vec<_> = (-60..=60)
            .map(|k| 1e-4 * f64::from(k))
            .map(|arc| [middle + arc, most * (1.0 - (arc / 6e-3).powi(2)).powi(2)])
            .collect();
        let worn = new.worn_by(&rows).unwrap();
        let wear = worn.worn_against(&new).unwrap();
        // Nodes of the new profile are 0.25 mm from each other: the largest depth lies between two, and a monotone cubic is narrow at its top.
        assert!((wear.largest_depth - most).abs() < 4e-6, "{y}: {wear:?}");
        assert!((wear.largest_depth_position - y).abs() < 0.26e-3, "{y}: {wear:?}");
        let linear = 16.0 / 15.0 * 6e-3 * most;
        assert!((wear.area / linear - 1.0).abs() < 0.06, "{y}: {wear:?} {linear}");
        assert!(wear.tread_depth.abs() < 1e-15, "{y}: {wear:?}");
        let measures = worn.measures().unwrap();
        if y > 0.0 {
            assert!(measures.hollow_depth > 1e-3, "{measures:?}");
        } else {
            assert!(measures.flange_thickness < 31.6e-3, "{measures:?}");
            assert_eq!(measures.hollow_depth, 0.0);
        }
    }
}

#[test]
fn what_is_no_wheel_with_a_flange_is_refused() {
    let slope = 60f64.to_radians().tan();
    let headless = wheel(&[[-55.0, -30.0 + 5.0 * slope], [-60.0 + 30.0 / slope, 0.0], [60.0, 0.0]]);
    for (profile, words) in [
        (&built_in("60E1"), "60E1 is the profile of a rail; a wheel is needed"),
        (
            &built_in("cone20"),
            "cone20 cannot be measured: it has no flange of 12 mm: its lowest place is 3.500 mm below the running circle, at y = -70.000 mm",
        ),
        (&headless, "it begins at y = -55.000 mm on the flange, before its tip"),
    ] {
        let said = profile.measures().unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
        assert!(profile.worn_against(&built_in("S1002")).is_err());
        assert!(built_in("S1002").worn_against(profile).is_err());
    }
}

/// The function of the height has the same measures as the curve, but for round-off and what a steep flange leaves of the function.
#[test]
fn the_height_has_the_same_measures() {
    let s1002 = built_in("S1002");
    let arcs = [0.0, 75e-3, 85e-3, 105e-3, 115e-3, s1002.length()];
    let depths = [0.0, 0.0, 2e-3, 2e-3, 0.0, 0.0];
    let rows: Vec<_> = arcs.into_iter().zip(depths).map(|(arc, depth)| [arc, depth]).collect();
    for profile in [s1002.worn_by(&rows).unwrap(), s1002, wheel(&flange(0.0))] {
        let expected = profile.measures().unwrap();
        let found = WheelMeasures::of_height(&profile.height_function().unwrap(), FLANGE_BACK).unwrap();
        for (expected, found) in [
            (expected.flange_height, found.flange_height),
            (expected.flange_thickness, found.flange_thickness),
            (expected.flange_gradient, found.flange_gradient),
            (expected.hollow_depth, found.hollow_depth),
        ] {
            assert!(
                (expected - found).abs() < 1e-9,
                "{}: {expected} {found}",
                profile.source()
            );
        }
    }
    assert!(WheelMeasures::of_height(&built_in("cone40").height_function().unwrap(), FLANGE_BACK).is_none());
}
