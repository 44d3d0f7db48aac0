//! Steps at which `make soak` found a derivative and its difference apart: they stay as named tests.

use crate::random_sensitivity::check_where_it_rests;
use crate::setups::{Falling, Layer, line, patch, rolling};
use wheelrail::parameters::{FrictionLaw, Parameters, SlipSource, Wheel, WheelHeating};
use wheelrail::signals::Inputs;

/// Inputs of the cases below, with what all of them have in common.
fn inputs(inputs: Inputs) -> Inputs {
    Inputs {
        incoming_wear_depth: 2e-7,
        ..inputs
    }
}

/// Compares the derivatives of a step that rests.
fn check(parameters: Parameters, inputs: Inputs, step: f64) {
    let compared = check_where_it_rests(parameters, inputs, step);
    assert!(compared.is_some_and(|compared| compared > 0), "{compared:?}");
}

/// The traction hangs on the surroundings by what the wheel has warmed: a derivative of the size of the rounding of the differences.
#[test]
fn a_line_with_constant_friction_in_a_long_step() {
    let parameters = Parameters {
        friction_law: FrictionLaw::Constant,
        wheel_shear_modulus: 4e10,
        wheel_heating: WheelHeating::Off,
        slip_regularisation: 1e-3,
        ..line(SlipSource::Creepage, Wheel::Elastic)
    };
    for friction_law in [FrictionLaw::Constant, FrictionLaw::FlowStress] {
        check(
            Parameters {
                friction_law,
                ..parameters.clone()
            },
            inputs(Inputs {
                wheel_speed: 85.32224005588587,
                normal_load: 46996.135097110666,
                creepage: 0.0006172912094288462,
                vehicle_speed: 39.224017784330755,
                friction_scale: 0.9037492070302907,
                incoming_temperature: 299.74132412167233,
                ..Inputs::default()
            }),
            0.05,
        );
    }
}

/// A wheel that creeps backwards, on friction that remembers as far as the contact is long.
#[test]
fn a_creeping_line_that_remembers() {
    let falling = Falling {
        share: 1.0,
        decay: 0.0,
        distance: 7.848823303474566e-6,
    };
    check(
        falling.on(Parameters {
            friction_law: FrictionLaw::PiecewiseLinear,
            wheel_shear_modulus: 8.2e10,
            wheel_heating: WheelHeating::Off,
            ..line(SlipSource::Creepage, Wheel::Elastic)
        }),
        inputs(Inputs {
            wheel_speed: -0.17420593074857676,
            normal_load: 56236.34956654838,
            creepage: 0.04531863840468597,
            vehicle_speed: -0.07666057525449178,
            friction_scale: 0.38884392561343156,
            incoming_temperature: 284.64603435765724,
            ..Inputs::default()
        }),
        1e-3,
    );
}

/// The number of nodes that stick jumps with a load that the differences move.
#[test]
fn a_creeping_line_whose_nodes_come_to_stick() {
    check(
        Parameters {
            friction_law: FrictionLaw::Table,
            friction_table_points: 5,
            friction_table_temperature: [
                360.6043577036716,
                449.4443547114041,
                609.7284676233264,
                778.2847799628084,
                846.977611396103,
                987.9133153692343,
                1171.2969647853213,
                1305.3596000361383,
                1439.8765338762603,
                1478.5408222855906,
            ],
            friction_table_coefficient: [
                0.5542585161067897,
                0.3765785220913246,
                0.4655677669150975,
                0.3129264215831334,
                0.3065811375477906,
                0.33747008060714545,
                0.3648173117047009,
                0.21312926955107056,
                0.48216313723131443,
                0.4048345604126538,
            ],
            wheel_shear_modulus: 4e10,
            slip_regularisation: 1e-3,
            ..line(SlipSource::VehicleSpeed, Wheel::Elastic)
        },
        inputs(Inputs {
            wheel_speed: -0.17211538542459137,
            normal_load: 39011.04543206026,
            creepage: 0.12685696194218826,
            vehicle_speed: -0.07026009508682779,
            friction_scale: 0.7658089443269789,
            incoming_temperature: 300.4333430365709,
            ..Inputs::default()
        }),
        1e-3,
    );
}

/// A patch that creeps without sliding anywhere, but for the edge: the totals of friction and wear are round-off.
#[test]
fn patches_that_creep_backwards() {
    let moves = [
        (
            SlipSource::Creepage,
            WheelHeating::On,
            Inputs {
                wheel_speed: -0.0872813799314936,
                normal_load: 48967.4324977607,
                creepage: -0.001627778549652968,
                vehicle_speed: -0.04021489571310538,
                friction_scale: 0.9213586914244442,
                incoming_temperature: 301.3446773474443,
                lateral_creepage: 0.001997197886005659,
                spin_creepage: -0.7205208293496801,
                lateral_speed: -8.031710470415211e-5,
                spin_rate: 0.028975670011417584,
                ..Inputs::default()
            },
        ),
        (
            SlipSource::VehicleSpeed,
            WheelHeating::Off,
            Inputs {
                wheel_speed: -0.07316021043090752,
                normal_load: 70084.48983667424,
                creepage: -0.0013539877710046495,
                vehicle_speed: -0.03369932527252757,
                friction_scale: 0.37672742806018494,
                incoming_temperature: 320.4686979157103,
                lateral_creepage: 0.0013572937059478129,
                spin_creepage: -0.44785762854229466,
                lateral_speed: -4.5739882087089735e-5,
                spin_rate: 0.015092499900029616,
                ..Inputs::default()
            },
        ),
    ];
    for (source, wheel_heating, moved) in moves {
        let parameters = Parameters {
            friction_law: FrictionLaw::Constant,
            wheel_shear_modulus: 8.2e10,
            wheel_heating,
            ..patch(source, Wheel::Elastic)
        };
        check(parameters, inputs(moved), 1e-3);
    }
}

/// A wheel that creeps and slides: its slip changes with friction by a hundred times its size, by the change of the displacement in a short step, and
/// its pressure by next to nothing.
#[test]
fn a_creeping_line_whose_pressure_hardly_moves() {
    let mut table = Parameters {
        friction_law: FrictionLaw::Table,
        friction_table_points: 3,
        wheel_shear_modulus: 8.2e10,
        wheel_heating: WheelHeating::Off,
        ..line(SlipSource::Creepage, Wheel::Elastic)
    };
    table.friction_table_temperature[..3].copy_from_slice(&[383.82041624920856, 523.8012449076157, 686.6478628140491]);
    table.friction_table_coefficient[..3].copy_from_slice(&[
        0.5735993664360852,
        0.5762115659339716,
        0.25051833012110486,
    ]);
    check(
        table,
        inputs(Inputs {
            wheel_speed: -0.09984146058334009,
            normal_load: 80943.74704979688,
            creepage: -0.15308933796424506,
            vehicle_speed: -0.054228945185244924,
            friction_scale: 0.7735579651606018,
            incoming_temperature: 328.09587504696515,
            ..Inputs::default()
        }),
        1e-3,
    );
}

/// Surfaces that slide in the step before and all but stick in this one: the friction energy that is left hangs on the friction by nothing but the error of the slip.
#[test]
fn a_patch_on_a_layer_that_all_but_sticks() {
    let layer = Layer {
        strength: 239539171.44679347,
        hardening: 952446895265.727,
        compliance: 0.0,
        falls: false,
    };
    let parameters = Parameters {
        friction_law: FrictionLaw::Constant,
        wheel_shear_modulus: 4e10,
        wheel_heating: WheelHeating::Off,
        ..patch(SlipSource::VehicleSpeed, Wheel::Elastic)
    };
    let creepages = [-0.0011396084120291756, 0.0014116958229563625, -0.46517103865598186];
    let inputs = Inputs {
        wheel_speed: 0.05293997372344336,
        normal_load: 20414.850788514817,
        friction_scale: 0.3489397999381116,
        incoming_temperature: 291.86115798061104,
        ..rolling(0.024380171761610198, creepages)
    };
    check(layer.on(parameters), inputs, 1e-3);
}
