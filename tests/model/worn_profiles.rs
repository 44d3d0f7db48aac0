//! Profiles of wheel and rail that wear: what a contact takes off them, where, and what it meets then.

use crate::derivatives::check;
use std::fs;
use std::path::PathBuf;
use wheelrail::Profile;
use wheelrail::parameters::{
    ContactModel, Control, FrictionLaw, Parameters, ProfileWear, Side, SlipSource, WheelWearLaw,
};
use wheelrail::signals::{ContactOutputs, Inputs, Outputs};
use wheelrail::simulation::Simulation;
use wheelrail::wheel_rail::WornPlace;

/// Length of rail over which its wear is spread, `m`: short, so that both bodies wear alike.
const LENGTH: f64 = 3.0;

/// S1002 on 60E1 that both wear, on a coarse grid, without heat.
fn bodies() -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        friction_law: FrictionLaw::Constant,
        friction_cold: 0.3,
        thermal_expansion: 0.0,
        patch_nodes: 14,
        patch_strips: 11,
        depth_nodes: 9,
        strip_half_length: 0.3,
        wheel_profile_wear: ProfileWear::On,
        rail_profile_wear: ProfileWear::On,
        rail_wear_length: LENGTH,
        wheel_wear_coefficient: 1e-12,
        wear_coefficient: 1e-12,
        ..Parameters::default()
    }
}

/// A wheelset that slides, displaced to the left by so much, with yaw.
fn sliding(lateral: f64, yaw: f64) -> Inputs {
    Inputs {
        normal_load: 60e3,
        vehicle_speed: 20.0,
        wheel_speed: 20.1 / 0.46,
        lateral_displacement: lateral,
        yaw_angle: yaw,
        ..Inputs::default()
    }
}

/// Wear of so many steps of 1 ms.
fn worn(parameters: &Parameters, inputs: &Inputs, steps: usize) -> Simulation {
    let mut run = Simulation::new(parameters, inputs).unwrap();
    run.hold(inputs, 1e-3, steps).unwrap();
    run
}

/// Integral of the depth over the arc length, `m²`.
fn area(places: &[WornPlace]) -> f64 {
    let spacing = places[1].arc_length - places[0].arc_length;
    spacing * places.iter().map(|place| place.depth).sum::<f64>()
}

fn largest(places: &[WornPlace]) -> f64 {
    places.iter().fold(0.0, |largest, place| largest.max(place.depth))
}

/// What the profiles have lost is what the law has worn off: the wheel's over its turn, the rail's over its length; and all of it lies in the contact.
#[test]
fn the_profiles_lose_what_the_contact_wears_off() {
    for (law, lateral) in [(WheelWearLaw::Coefficient, 0.0), (WheelWearLaw::WearLaw, 6.6e-3)] {
        let parameters = Parameters {
            wheel_wear_law: law,
            wear_coefficient: 3e-12,
            wear_acceleration: 50.0,
            ..bodies()
        };
        let run = worn(&parameters, &sliding(lateral, 0.01), 20);
        let (outputs, wear) = (run.outputs(), run.profile_wear().unwrap());
        for (places, expected) in [
            (&wear.wheel, outputs.wheel_worn_area),
            (&wear.rail, outputs.rail_worn_area),
        ] {
            assert!(
                (area(places) / expected - 1.0).abs() < 1e-10,
                "{lateral}: {} {expected}",
                area(places)
            );
        }
        let rail = 50.0 * outputs.worn_volume / LENGTH;
        assert!((outputs.rail_worn_area / rail - 1.0).abs() < 1e-10);
        // The radius of the places in contact is that of the running circle to a part in forty.
        let wheel = 50.0 * outputs.wheel_worn_volume / (std::f64::consts::TAU * parameters.wheel_radius);
        assert!((outputs.wheel_worn_area / wheel - 1.0).abs() < 0.05, "{lateral}");
        let share = match law {
            WheelWearLaw::Coefficient => 1e-12 / 3e-12,
            WheelWearLaw::WearLaw => 1.0,
        };
        assert!((outputs.wheel_worn_volume / outputs.worn_volume - share).abs() < 1e-9);
        let contacts = &outputs.contact[..outputs.contacts as usize];
        let positions: [fn(&ContactOutputs) -> f64; 2] =
            [|contact| contact.wheel_position, |contact| contact.rail_position];
        for (places, position) in [&wear.wheel, &wear.rail].into_iter().zip(positions) {
            let deepest = places
                .iter()
                .max_by(|a, b| a.depth.total_cmp(&b.depth))
                .unwrap()
                .position;
            let near = |contact: &ContactOutputs| (deepest - position(contact)).abs() < contact.breadth;
            assert!(contacts.iter().any(near), "{lateral}: {deepest}");
        }
    }
}

/// Off, or on a wheel with a coefficient of 0, nothing is worn; off, the outputs are to the bit those of a wear that is not asked for.
#[test]
fn profiles_that_do_not_wear_stay_as_they_are() {
    let off = Parameters {
        wheel_profile_wear: ProfileWear::Off,
        rail_profile_wear: ProfileWear::Off,
        ..bodies()
    };
    let inputs = sliding(6.6e-3, 0.01);
    let (run, other) = (
        worn(&off, &inputs, 3),
        worn(
            &Parameters {
                profile_wear_points: 300,
                ..off.clone()
            },
            &inputs,
            3,
        ),
    );
    assert_eq!(run.outputs(), other.outputs());
    assert_eq!(
        (run.outputs().wheel_worn_area, run.outputs().rail_worn_area),
        (0.0, 0.0)
    );
    assert_eq!(largest(&run.profile_wear().unwrap().wheel), 0.0);
    assert!(
        (run.outputs().flange_height - 28e-3).abs() < 1e-6 && (run.outputs().flange_thickness - 32.5e-3).abs() < 1e-6
    );
    let without = Parameters {
        wheel_wear_coefficient: 0.0,
        rail_profile_wear: ProfileWear::Off,
        ..bodies()
    };
    let unworn = worn(&without, &inputs, 3);
    assert_eq!(largest(&unworn.profile_wear().unwrap().wheel), 0.0);
    // Its height has more knots, and the round-off of them.
    let difference = unworn.outputs().force_y / run.outputs().force_y - 1.0;
    assert!(difference.abs() < 1e-7, "{difference:e}");
}

/// The flange's thickness is measured from where `flange_back_position` has its back, of new wheels and of wheels that wear. The wheel is as far from the middle
/// of the track as with the default.
#[test]
fn the_flange_is_as_thick_as_its_back_is_far() {
    for wear in [ProfileWear::Off, ProfileWear::On] {
        let of = |back: f64| {
            let usual = bodies();
            let parameters = Parameters {
                wheel_profile_wear: wear,
                flange_back_position: back,
                flange_back_distance: usual.flange_back_distance + 2.0 * (usual.flange_back_position - back),
                ..usual
            };
            worn(&parameters, &sliding(2e-3, 0.0), 2).outputs().flange_thickness
        };
        let difference = of(72e-3) - of(70e-3);
        assert!((difference - 2e-3).abs() < 1e-8, "{difference}");
    }
}

/// The wheels of a wheelset on a mirrored way are the mirror images of those on the way, to the last bit.
#[test]
fn a_mirrored_way_wears_mirrored_wheels() {
    let of = |side: Side, sign: f64| {
        let parameters = Parameters {
            side,
            wear_acceleration: 1e3,
            ..bodies()
        };
        let inputs = |lateral: f64| sliding(sign * lateral, sign * 0.01);
        let mut run = Simulation::new(&parameters, &inputs(5e-3)).unwrap();
        for step in 0..12 {
            run.step(&inputs(5e-3 + 2e-4 * f64::from(step)), 1e-3).unwrap();
        }
        let mut depths = run.profile_wear().unwrap();
        for place in depths.wheel.iter_mut().chain(&mut depths.rail) {
            place.in_track[0] *= sign;
        }
        (depths, run.outputs().flange_thickness)
    };
    // As a truth value: the places of a difference would fill pages.
    assert!(of(Side::Left, 1.0) == of(Side::Right, -1.0));
}

/// Directory of a test's own files.
fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("wheelrail-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
}

/// A worn wheel as a file of any format makes the forces of the component that has worn it; read and written once more, it is the same.
///
/// At these places the windows of both have the same cells: those of other cells have other forces.
#[test]
fn a_worn_wheel_in_a_file_makes_the_same_forces() {
    let parameters = Parameters {
        rail_profile_wear: ProfileWear::Off,
        wear_coefficient: 0.0,
        wear_acceleration: 2e3,
        ..bodies()
    };
    for (name, lateral) in [("tread", 2e-3), ("flange", 6.6e-3)] {
        let inputs = sliding(lateral, 0.01);
        let run = worn(&parameters, &inputs, 30);
        let depth = largest(&run.profile_wear().unwrap().wheel);
        assert!(depth > 5e-6, "{name}: {depth}");
        let [wheel, _] = run.worn_profiles().unwrap();
        let new = Profile::built_in("S1002").unwrap();
        let wear = wheel.worn_against(&new).unwrap();
        assert!(
            (wear.area / run.outputs().wheel_worn_area - 1.0).abs() < 0.01,
            "{name}: {} {}",
            wear.area,
            run.outputs().wheel_worn_area
        );
        // What is on goes on without wear until it is steady.
        let still = Parameters {
            wear_acceleration: 0.0,
            ..parameters.clone()
        };
        let model = std::sync::Arc::new(wheelrail::Model::new(still).unwrap());
        let mut going_on = Simulation::of(model, &inputs).unwrap();
        going_on.state = run.state.clone();
        let expected = *going_on.hold(&inputs, 0.1, 6).unwrap();
        let folder = folder(&format!("worn-{name}"));
        let of_file = |path: &PathBuf| {
            let parameters = Parameters {
                wheel_profile: path.to_str().unwrap().to_owned(),
                wheel_radius: parameters.wheel_radius - wear.tread_depth,
                wheel_profile_wear: ProfileWear::Off,
                ..parameters.clone()
            };
            let mut run = Simulation::new(&parameters, &inputs).unwrap();
            *run.hold(&inputs, 0.1, 6).unwrap()
        };
        let check = |file: &str, expected: &Outputs, tolerance: f64| {
            let found = of_file(&folder.join(file));
            for get in [
                |o: &Outputs| o.force_x,
                |o: &Outputs| o.force_y,
                |o: &Outputs| o.moment_z,
            ] {
                let [own, other] = [expected, &found].map(get);
                let bound = 0.3 * inputs.normal_load;
                assert!((other - own).abs() < tolerance * bound, "{file}: {other} {own}");
            }
            found
        };
        // Points lie at the knots of the depth: to what a spline through points makes of a curvature that jumps, in the root of the flange.
        let tolerance = if name == "tread" { 1e-7 } else { 1e-6 };
        for file in ["worn.prw", "worn.whl", "worn.mpt", "worn.whe", "worn.csv"] {
            wheel.write(&folder.join(file)).unwrap();
            check(file, &expected, tolerance);
        }
        let once = check("worn.prw", &expected, tolerance);
        let options = wheelrail::profile_files::ReadOptions::default();
        let again = Profile::read(&folder.join("worn.prw"), &options).unwrap();
        again.write(&folder.join("again.prw")).unwrap();
        check("again.prw", &once, 1e-7);
        fs::remove_dir_all(&folder).unwrap();
    }
}

/// Derivatives of a step on worn profiles, worn within it as well, are those of its differences.
#[test]
fn steps_on_worn_profiles_have_derivatives() {
    for (control, side) in [(Control::Load, Side::Left), (Control::Height, Side::Right)] {
        let parameters = Parameters {
            control,
            side,
            rail_profile: "UIC60".to_owned(),
            wear_acceleration: 1e3,
            ..bodies()
        };
        let inputs = Inputs {
            vertical_displacement: if control == Control::Height { -0.12e-3 } else { 0.0 },
            incoming_wear_depth: 2e-7,
            ..sliding(1e-3, 2e-3)
        };
        let compared = check(parameters, inputs, 1e-3).unwrap();
        assert!(compared >= 100, "{control:?}: {compared}");
    }
}

/// A state goes on from its bytes with the same bits.
#[test]
fn a_saved_state_takes_the_worn_profiles_along() {
    let parameters = Parameters {
        wear_acceleration: 500.0,
        ..bodies()
    };
    let inputs = |step: u32| sliding(4e-3 + 5e-4 * f64::from(step), 0.01);
    let mut run = Simulation::new(&parameters, &inputs(0)).unwrap();
    let mut saved = None;
    for step in 0..8 {
        if step == 4 {
            saved = Some(run.state.clone());
        }
        run.step(&inputs(step), 1e-3).unwrap();
    }
    let mut resumed = Simulation::resume(run.model.clone(), saved.unwrap()).unwrap();
    for step in 4..8 {
        resumed.step(&inputs(step), 1e-3).unwrap();
    }
    assert_eq!(resumed.state, run.state);
    // The workspace of another state leads to the same.
    let other = worn(&parameters, &inputs(2), 2);
    let mut elsewhere = Simulation {
        state: run.state.clone(),
        ..other
    };
    elsewhere.step(&inputs(8), 1e-3).unwrap();
    run.step(&inputs(8), 1e-3).unwrap();
    assert_eq!(elsewhere.state, run.state);
}

#[test]
fn a_profile_that_is_worn_away_is_refused_with_its_place() {
    let parameters = Parameters {
        wear_acceleration: 1e8,
        ..bodies()
    };
    let inputs = sliding(6.5e-3, 0.01);
    let mut run = Simulation::new(&parameters, &inputs).unwrap();
    // The first contact slides into its place: a tenth of a millimetre in any step as short.
    run.step(&inputs, 1e-8).unwrap();
    let change = run.state.convergence.profile_change;
    // That of a cell's mean, which the spline smooths.
    let depth = largest(&run.profile_wear().unwrap().wheel);
    assert!(
        change > 1e-6 && (0.9..1.3).contains(&(change / depth)),
        "{change} {depth}"
    );
    let refused = (0..5).find_map(|_| run.step(&inputs, 1e-3).err()).unwrap().to_string();
    assert!(
        refused.contains("profile is worn by") && refused.contains("wear_acceleration"),
        "{refused}"
    );
    let no_length = Parameters {
        rail_wear_length: 0.0,
        ..bodies()
    };
    let refused = no_length.validate().unwrap_err().to_string();
    assert!(
        refused.contains("rail_wear_length = 0") && refused.contains("must be positive"),
        "{refused}"
    );
    assert_eq!(
        Parameters {
            rail_profile_wear: ProfileWear::Off,
            ..no_length
        }
        .validate(),
        Ok(())
    );
}
