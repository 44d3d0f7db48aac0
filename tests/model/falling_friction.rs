//! Friction that falls with slip and remembers: its sensitivities against differences of the step, in named cases.

use crate::derivatives::check;
use crate::random_sensitivity::check_where_it_rests;
use crate::setups::{Falling, line, patch, rolling, rolling_straight};
use wheelrail::parameters::{FrictionLaw, Parameters, SlipSource, Wheel};

/// Derivatives that are compared at least.
const LEAST: usize = 64;

fn falling([share, decay, distance]: [f64; 3], parameters: Parameters) -> Parameters {
    let falling = Falling { share, decay, distance };
    falling.on(parameters)
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
    assert!(check(falling([0.3, 0.1, 3e-7], parameters), inputs, 1e-3).unwrap() >= LEAST);
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
        let compared = check(falling([1.0, 0.0, distance], parameters), inputs, 1e-3).unwrap();
        assert!(compared >= LEAST, "{compared}");
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
            falling(law, parameters),
            rolling(speed, [creepage, lateral, spin]),
            0.05,
        );
    }
}
