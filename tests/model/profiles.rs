//! Contact of profiles: the Manchester contact benchmark, mirror images, a wheel that is lifted, moves sideways, stands.

use wheelrail::parameters::{ContactModel, Control, FrictionLaw, Parameters, Side, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::{Model, State};

/// Case of the Manchester contact benchmark, a wheel S1002 on a rail UIC60 under 10 kN: of the right wheel or not; lateral displacement to the
/// right, `mm`, roll, yaw and pitch rate, `rad/s`, in axes x forward, y right, z down; normal force, force on the rail along and to the right, `N`,
/// peak pressure, `MPa`, area, `mm²`. Computed with CONTACT (github.com/eve70a/CONTACT) on a curved reference surface, with cells of 0.2 mm, at
/// 20 m/s.
#[rustfmt::skip]
const MANCHESTER: &[(bool, [f64; 4], [f64; 5])] = &[
    (true, [0.0, 0.0, 0.0, -43.481181], [9997.637, -115.2156, 63.56038, 338.3239, 51.56]),
    (true, [0.5, -2.304e-05, 0.0012, -43.474134], [9867.012, -986.9941, -2059.311, 632.5053, 45.88]),
    (true, [1.0, -5.049e-05, 0.0024, -43.465752], [9827.484, -818.1916, -2132.622, 741.2864, 24.24]),
    (true, [1.5, -8.103e-05, 0.0036, -43.46244], [9811.597, -622.7999, -2127.213, 754.1484, 20.56]),
    (true, [2.0, -0.0001128, 0.0048, -43.459197], [9798.86, -519.7574, -2094.729, 744.8091, 20.24]),
    (true, [2.5, -0.0001457, 0.006, -43.455627], [9786.638, -458.4272, -2047.846, 730.387, 20.44]),
    (true, [3.0, -0.0001803, 0.0072, -43.451503], [9773.926, -419.5425, -1989.66, 713.1354, 21.16]),
    (true, [3.5, -0.0002168, 0.0084, -43.446688], [9760.076, -395.0919, -1919.967, 691.456, 21.68]),
    (true, [4.0, -0.0002557, 0.0096, -43.44093], [9744.439, -381.6699, -1835.25, 664.2519, 22.44]),
    (true, [4.5, -0.0002977, 0.0108, -43.433715], [9725.776, -379.2091, -1726.725, 625.2918, 24.12]),
    (true, [5.0, -0.0003554, 0.012, -43.353637], [9575.537, -828.399, -20.87513, 1558.87, 15.56]),
    (true, [5.5, -0.0004777, 0.0132, -43.318864], [9625.018, -852.0088, 561.3128, 1485.317, 10.28]),
    (true, [6.0, -0.0006272, 0.0144, -43.293718], [9695.054, -882.1232, 1367.187, 1149.83, 13.28]),
    (true, [6.5, -0.004376, 0.0156, -42.748834], [15437.89, -1990.358, 12479.07, 2646.356, 10.08]),
    (true, [7.0, -0.006393, 0.0168, -42.635629], [14026.06, -2082.902, 10488.58, 2653.986, 8.64]),
    (true, [7.5, -0.007642, 0.018, -42.575747], [13262.37, -2089.278, 9342.513, 2660.113, 8.04]),
    (true, [8.0, -0.008606, 0.0192, -42.534857], [12723.86, -2073.453, 8491.72, 2659.389, 7.64]),
    (true, [8.5, -0.009408, 0.0204, -42.503245], [12306.48, -2047.195, 7800.176, 2663.845, 7.2]),
    (true, [9.0, -0.01010113, 0.0216, -42.477561], [11967.39, -2016.443, 7211.526, 2667.022, 7.08]),
    (true, [9.5, -0.01071386, 0.0228, -42.455665], [11683.47, -1983.318, 6695.353, 2662.549, 6.84]),
    (true, [10.0, -0.01126431, 0.024, -42.436375], [11440.95, -1949.206, 6233.465, 2665.209, 6.68]),
    (false, [0.0, 0.0, 0.0, -43.481181], [9997.637, -115.2156, -63.56038, 338.3239, 51.56]),
    (false, [1.0, -5.049e-05, 0.0024, -43.465752], [10052.64, 819.8755, -3071.072, 423.9271, 36.64]),
    (false, [2.0, -0.0001128, 0.0048, -43.459197], [10040.71, 543.7172, -3095.121, 465.9402, 33.2]),
    (false, [4.0, -0.0002557, 0.0096, -43.44093], [10028.97, 436.1562, -3071.711, 527.1633, 29.08]),
    (false, [6.0, -0.0006272, 0.0144, -43.293718], [10024.22, 973.1126, -2928.64, 578.5684, 26.32]),
    (false, [8.0, -0.008606, 0.0192, -42.534857], [10015.12, 2310.074, -1997.883, 701.1595, 21.96]),
    (false, [10.0, -0.01126431, 0.024, -42.436375], [10024.22, 2196.074, -2168.869, 744.1567, 20.56]),
];

/// Bodies of the benchmark.
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

/// Inputs of a row of the benchmark, in axes y to the left and z up.
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

/// The forces agree with those of CONTACT to 0.012 of μ F_N, as one problem on the unrolled surface should. Its cells of 0.2 mm are four to
/// the breadth of a contact on the flange.
#[test]
fn forces_of_the_manchester_benchmark() {
    let models = [Side::Left, Side::Right].map(|side| Model::new(bodies(side)).unwrap());
    for &(right, pose, [normal, along, across, peak, area]) in MANCHESTER {
        let model = &models[usize::from(right)];
        let outputs = start(model, &inputs(pose)).outputs;
        let y = pose[0];
        let bound = 0.3 * normal;
        let errors = [outputs.force_x + along, outputs.force_y - across].map(|error| error / bound);
        assert!(
            errors.iter().all(|error| error.abs() < 0.012),
            "right {right}, {y} mm: {errors:?}"
        );
        assert!((outputs.force_z / 10e3 - 1.0).abs() < 1e-6, "{}", outputs.force_z);
        // Where two areas carry CONTACT holds them in one plane.
        if y == 5.0 {
            continue;
        }
        assert_eq!(outputs.contacts, 1.0, "right {right}, {y} mm");
        let contact = &outputs.contact[0];
        assert!(
            (contact.normal_force / normal - 1.0).abs() < 5e-3,
            "{y} mm: {}",
            contact.normal_force
        );
        let tolerance = if peak > 2e3 { 0.04 } else { 0.03 };
        assert!(
            (contact.peak_pressure * 1e-6 / peak - 1.0).abs() < tolerance,
            "{y} mm: {}",
            contact.peak_pressure
        );
        // A row of its cells around.
        let row = 0.2 * (contact.length + contact.breadth) * 1e3;
        assert!(
            (contact.area * 1e6 - area).abs() < 0.04 * area + row,
            "{y} mm: {}",
            contact.area
        );
    }
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
