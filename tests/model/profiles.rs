//! Contact of profiles: mirror images, a given height, a wheel that is lifted. Forces are in `wheelrail::verification`.

use wheelrail::parameters::{ContactModel, Control, FrictionLaw, Parameters, Side, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::{Model, State};

/// Bodies of the Manchester contact benchmark.
fn bodies(side: Side) -> Parameters {
    let (shear, poisson) = (82e9, 0.28);
    let lame = 2.0 * shear * poisson / (1.0 - 2.0 * poisson);
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        rail_profile: "UIC60".to_owned(),
        side,
        shear_modulus: shear,
        lame_lambda: lame,
        wheel_shear_modulus: shear,
        wheel_lame_lambda: lame,
        friction_law: FrictionLaw::Constant,
        friction_cold: 0.3,
        ..Parameters::default()
    }
}

/// Inputs of a position to the right, `mm`, roll, yaw and pitch rate of the benchmark, in axes y to the left and z up.
fn inputs([y, roll, yaw, pitch_rate]: [f64; 4]) -> Inputs {
    Inputs {
        normal_load: 10e3,
        wheel_speed: -pitch_rate,
        vehicle_speed: 20.0,
        lateral_displacement: -1e-3 * y,
        roll_angle: roll,
        yaw_angle: -yaw,
        ..Inputs::default()
    }
}

fn start(model: &Model, inputs: &Inputs) -> State {
    model.initial_state(&mut model.workspace(), inputs).unwrap()
}

/// The right wheel is the left one in a mirror, to the last bit.
#[test]
fn the_other_side_is_the_mirror_image() {
    let [left, right] = [Side::Left, Side::Right].map(|side| Model::new(bodies(side)).unwrap());
    let pose = inputs([3.0, -0.0003, 0.009, -43.4]);
    let mirrored = Inputs {
        lateral_displacement: -pose.lateral_displacement,
        roll_angle: -pose.roll_angle,
        yaw_angle: -pose.yaw_angle,
        ..pose
    };
    let (one, other) = (start(&right, &pose).outputs, start(&left, &mirrored).outputs);
    assert_eq!(
        [
            one.force_x,
            -one.force_y,
            one.force_z,
            -one.moment_x,
            one.moment_y,
            -one.moment_z
        ],
        [
            other.force_x,
            other.force_y,
            other.force_z,
            other.moment_x,
            other.moment_y,
            other.moment_z
        ]
    );
    assert_eq!(one.contact[0].inclination, other.contact[0].inclination);
    assert_eq!(one.contact[0].lateral_force, -other.contact[0].lateral_force);
}

/// The wheelset's height under a load carries the load where it is given.
#[test]
fn a_given_height_carries_the_load_that_belongs_to_it() {
    let loaded = Model::new(bodies(Side::Right)).unwrap();
    let lowered = Model::new(Parameters {
        control: Control::Height,
        ..bodies(Side::Right)
    })
    .unwrap();
    let at = |height: f64| {
        let inputs = Inputs {
            vertical_displacement: height,
            ..inputs([3.0, -0.0003, 0.009, -43.4])
        };
        start(&lowered, &inputs).outputs
    };
    let outputs = start(&loaded, &inputs([3.0, -0.0003, 0.009, -43.4])).outputs;
    let approach = outputs.penetration;
    // The height at which the bodies touch is the one from which the approach counts.
    let (mut low, mut high) = (-1e-3, 1e-3);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if at(middle).force_z > 10e3 {
            low = middle;
        } else {
            high = middle;
        }
    }
    let found = at(0.5 * (low + high));
    assert!((found.force_z / 10e3 - 1.0).abs() < 1e-5);
    assert!(
        (found.penetration / approach - 1.0).abs() < 1e-4,
        "{} {approach}",
        found.penetration
    );
    // A lifted wheel.
    let lifted = at(2e-3);
    assert_eq!(
        [lifted.force_x, lifted.force_y, lifted.force_z, lifted.contacts],
        [0.0; 4]
    );
}
