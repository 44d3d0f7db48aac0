//! Friction that falls with slip and remembers: its sensitivities against differences of the step.

use crate::sensitivity::{
    LEAST_OF_A_LINE, LEAST_OF_A_PATCH, check, check_where_it_rests, line, patch, rolling, rolling_straight,
};
use proptest::prelude::*;
use wheelrail::parameters::{FrictionLaw, Parameters, SlipSource, Wheel};

fn falling(parameters: Parameters, [share, decay, distance]: [f64; 3]) -> Parameters {
    Parameters {
        friction_slip_share: share,
        friction_slip_decay: decay,
        friction_memory_distance: distance,
        ..parameters
    }
}

fn laws() -> impl Strategy<Value = [f64; 3]> {
    prop_oneof![
        (0.3..0.9_f64, 0.1..2.0_f64, Just(0.0)),
        (0.3..0.9_f64, 0.1..5.0_f64, 0.3e-6..1e-5),
        (Just(1.0), Just(0.0), 0.1e-6..1e-5),
    ]
    .prop_map(|(share, decay, distance)| [share, decay, distance])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 10, ..ProptestConfig::default() })]

    #[test]
    fn sensitivities_of_a_line(
        law in laws(),
        creepage in prop_oneof![0.0005..0.003, 0.005..0.2, -0.2..-0.005],
        speed in prop_oneof![0.01..0.1_f64, 2.0..40.0],
        reverse in any::<bool>(),
        vehicle in any::<bool>(),
        wheel in prop_oneof![Just(Wheel::Rigid), Just(Wheel::Elastic)],
        regularisation in prop_oneof![3 => Just(0.0), 1 => Just(1e-3)],
        long in any::<bool>(),
        friction_law in prop_oneof![Just(FrictionLaw::Constant), Just(FrictionLaw::PiecewiseLinear), Just(FrictionLaw::FlowStress)],
    ) {
        let source = if vehicle { SlipSource::VehicleSpeed } else { SlipSource::Creepage };
        let parameters = Parameters { friction_law, slip_regularisation: regularisation, ..line(source, wheel) };
        let direction = if reverse { -1.0 } else { 1.0 };
        let inputs = rolling_straight(direction * speed, creepage);
        let step = if long { 0.05 } else { 1e-3 };
        if let Some(compared) = check_where_it_rests(falling(parameters, law), inputs, step) {
            prop_assert!(compared >= LEAST_OF_A_LINE, "{compared}");
        }
    }

    #[test]
    fn sensitivities_of_a_patch(
        law in laws(),
        creepage in prop_oneof![-0.003..-0.0003, 0.0003..0.003, 0.005..0.05],
        lateral in -0.002..0.002,
        spin in -0.8..0.8,
        speed in 2.0..40.0,
        reverse in any::<bool>(),
        vehicle in any::<bool>(),
        wheel in prop_oneof![Just(Wheel::Rigid), Just(Wheel::Elastic)],
        regularisation in prop_oneof![3 => Just(0.0), 1 => Just(1e-3)],
        long in any::<bool>(),
    ) {
        let source = if vehicle { SlipSource::VehicleSpeed } else { SlipSource::Creepage };
        let parameters = Parameters { slip_regularisation: regularisation, ..patch(source, wheel) };
        let direction = if reverse { -1.0 } else { 1.0 };
        let inputs = rolling(direction * speed, [creepage, lateral, spin]);
        let step = if long { 0.05 } else { 1e-3 };
        if let Some(compared) = check_where_it_rests(falling(parameters, law), inputs, step) {
            prop_assert!(compared >= LEAST_OF_A_PATCH, "{compared}");
        }
    }
}

/// What the rail ahead of the contact remembers is carried in by more of it at a higher speed.
#[test]
fn sensitivities_of_a_line_to_what_the_rail_ahead_remembers() {
    let parameters = Parameters {
        friction_law: FrictionLaw::Constant,
        wheel: Wheel::Rigid,
        strip_half_length: 0.3,
        ..Parameters::default()
    };
    let inputs = rolling_straight(2.0, -0.005);
    assert!(check(falling(parameters, [0.3, 0.1, 3e-7]), inputs, 1e-3).unwrap() >= LEAST_OF_A_LINE);
}

/// A wheel that creeps on rail that remembers. Many of its nodes are about to slide, and the totals were once judged smooth beside rates that
/// were not: 0.1124 against 0.1161 for friction_energy by wheel_speed.
#[test]
fn sensitivities_of_a_line_that_creeps() {
    for (source, wheel, distance, speed, creepage) in [
        (
            SlipSource::Creepage,
            Wheel::Rigid,
            1.8864e-6,
            0.058442287171977615,
            0.03125463210280818,
        ),
        (
            SlipSource::VehicleSpeed,
            Wheel::Elastic,
            6.11e-7,
            -0.03348305920024387,
            0.1601771063551135,
        ),
    ] {
        let parameters = Parameters {
            friction_law: FrictionLaw::PiecewiseLinear,
            ..line(source, wheel)
        };
        let inputs = rolling_straight(speed, creepage);
        let compared = check(falling(parameters, [1.0, 0.0, distance]), inputs, 1e-3).unwrap();
        assert!(compared >= LEAST_OF_A_LINE, "{compared}");
    }
}

/// Patches whose steps do not rest at the settings of the derivatives' test; at those that everybody has they do.
#[test]
fn patches_that_rest_at_the_default_settings_alone() {
    for (law, [speed, creepage, lateral, spin], regularisation) in [
        (
            [0.8615657523183528, 4.64662276398982, 2.128061775053741e-6],
            [
                36.566419090195375,
                0.04687035439839771,
                0.0005171840819864108,
                0.46811048007767264,
            ],
            1e-3,
        ),
        (
            [0.4372345784342552, 2.7536793688126058, 3.3617640740945357e-6],
            [
                -13.279710717221239,
                0.013562336753096474,
                -0.00020815261715437607,
                -0.7622403697322072,
            ],
            0.0,
        ),
    ] {
        let parameters = Parameters {
            slip_regularisation: regularisation,
            ..patch(SlipSource::Creepage, Wheel::Rigid)
        };
        check_where_it_rests(
            falling(parameters, law),
            rolling(speed, [creepage, lateral, spin]),
            0.05,
        );
    }
}
