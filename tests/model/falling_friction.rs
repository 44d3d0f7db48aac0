//! Friction that falls with slip and remembers: its sensitivities against differences of the step.

use crate::sensitivity::{check, patch, rolling};
use proptest::prelude::*;
use wheelrail::Error;
use wheelrail::parameters::{FrictionLaw, Parameters, SlipSource, Wheel, WheelHeating};

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
        let parameters = Parameters {
            slip_source: if vehicle { SlipSource::VehicleSpeed } else { SlipSource::Creepage },
            friction_law,
            wheel,
            wheel_shear_modulus: 6e10,
            wheel_heating: WheelHeating::On,
            slip_regularisation: regularisation,
            rim_depth: 1e-3,
            rim_width: 5e-3,
            contact_thermal_resistance: 200.0,
            strip_half_length: 0.3,
            ..Parameters::default()
        };
        let direction = if reverse { -1.0 } else { 1.0 };
        let mut inputs = rolling(direction * speed, [creepage, 0.0, 0.0]);
        (inputs.lateral_creepage, inputs.spin_creepage, inputs.lateral_speed, inputs.spin_rate) = (0.0, 0.0, 0.0, 0.0);
        let step = if long { 0.05 } else { 1e-3 };
        let compared = check(falling(parameters, law), inputs, step).unwrap();
        prop_assert!(compared >= 96, "{compared}");
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
        let compared = check(falling(parameters, law), inputs, step);
        // Settings this tight are no promise of the solver of the friction law.
        prop_assume!(!matches!(compared, Err(Error::TangentialNotConverged { .. } | Error::SplitNotConverged { .. })));
        prop_assert!(compared.unwrap() >= 150);
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
    let mut inputs = rolling(2.0, [-0.005, 0.0, 0.0]);
    (
        inputs.lateral_creepage,
        inputs.spin_creepage,
        inputs.lateral_speed,
        inputs.spin_rate,
    ) = (0.0, 0.0, 0.0, 0.0);
    assert!(check(falling(parameters, [0.3, 0.1, 3e-7]), inputs, 1e-3).unwrap() >= 96);
}
