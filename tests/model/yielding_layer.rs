//! A layer between wheel and rail that flows: its sensitivities against differences of the step, in named cases, and what it must not change.

use crate::derivatives::check;
use crate::random_sensitivity::check_where_it_rests;
use crate::setups::{Layer, patch, rolling};
use wheelrail::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource, Wheel};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation;

fn yielding((strength, hardening, compliance, falls): (f64, f64, f64, bool), parameters: Parameters) -> Parameters {
    let layer = Layer {
        strength,
        hardening,
        compliance,
        falls,
    };
    layer.on(parameters)
}

/// The slip below which a cell's slip counts as noise changes with the load, and with it what a layer has flowed and how strong it is: left
/// out, peak_temperature by normal_load was off by 6e-4 of itself.
#[test]
fn sensitivities_of_a_patch_on_a_compliant_layer_that_hardens() {
    for (source, wheel, regularisation, layer, speed, creepages) in [
        (
            SlipSource::VehicleSpeed,
            Wheel::Rigid,
            1e-3,
            (2.942e8, 2.048e13, 4.195e-13, false),
            -35.27,
            [0.02318, -2.765e-4, 0.05475],
        ),
        (
            SlipSource::Creepage,
            Wheel::Rigid,
            1e-3,
            (1.832e8, 6.559e12, 6.268e-14, false),
            28.39,
            [3e-4, 1.764e-3, 0.0],
        ),
        (
            SlipSource::Creepage,
            Wheel::Rigid,
            0.0,
            (2.942e8, 2.048e13, 4.195e-13, false),
            2.0,
            [0.02318, 0.0, 0.0],
        ),
        (
            SlipSource::VehicleSpeed,
            Wheel::Elastic,
            1e-3,
            (7.711e7, 2.187e13, 6.958e-13, true),
            5.589,
            [0.01489, 9.754e-4, 0.3899],
        ),
    ] {
        let parameters = Parameters {
            slip_regularisation: regularisation,
            ..patch(source, wheel)
        };
        let compared = check(yielding(layer, parameters), rolling(speed, creepages), 1e-3).unwrap();
        assert!(compared >= 128, "{compared}");
    }
}

/// As the cases of falling friction that rest at the default settings alone.
#[test]
fn patches_on_a_layer_that_rest_at_the_default_settings_alone() {
    for (layer, speed, creepages) in [
        (
            (372028876.4881518, 14383939816692.436, 0.0, true),
            -29.920441930621703,
            [0.023060639935514594, 0.0010144556267709594, 0.7003597771051288],
        ),
        (
            (294739875.33622766, 0.0, 0.0, true),
            35.57674212285076,
            [-0.0015845668314110686, 0.0005215666636398003, 0.5911027021783625],
        ),
    ] {
        let parameters = patch(SlipSource::Creepage, Wheel::Rigid);
        check_where_it_rests(yielding(layer, parameters), rolling(speed, creepages), 1e-3);
    }
}

fn models() -> [Parameters; 2] {
    [ContactModel::Line, ContactModel::Patch].map(|contact_model| Parameters {
        contact_model,
        contact_nodes: 31,
        depth_nodes: 21,
        patch_nodes: 16,
        patch_strips: 9,
        ..Parameters::default()
    })
}

/// A layer that is stronger than friction changes nothing but the last digits, whether or not it would harden.
#[test]
fn a_layer_that_does_not_yield_is_none() {
    for plain in models() {
        let inputs = |creepage| Inputs {
            creepage,
            ..Inputs::default()
        };
        let traction = |parameters: &Parameters| {
            let mut run = Simulation::new(parameters, &inputs(1e-3)).unwrap();
            run.hold(&inputs(0.01), 1e-3, 20).unwrap().traction_force
        };
        let without = traction(&plain);
        for hardening in [0.0, 1e12] {
            let with = traction(&Parameters {
                layer_yield_stress: 1e10,
                layer_hardening: hardening,
                ..plain.clone()
            });
            assert!((with / without - 1.0).abs() < 1e-9, "{with} {without}");
        }
    }
}

/// A wheel that spins on the spot shears the layer until it is as strong as friction: T = min(τ_c0 + k s t, μp) over the contact, where it
/// is far stiffer than it has hardened.
#[test]
fn a_wheel_that_spins_on_the_spot_hardens_the_layer_up_to_the_friction_bound() {
    for plain in models() {
        let parameters = Parameters {
            slip_source: SlipSource::VehicleSpeed,
            friction_law: FrictionLaw::Constant,
            thermal_expansion: 0.0,
            wear_coefficient: 0.0,
            layer_yield_stress: 1e7,
            layer_hardening: 1e11,
            ..plain
        };
        let inputs = Inputs {
            vehicle_speed: 0.0,
            wheel_speed: 0.1 / parameters.wheel_radius,
            ..Inputs::default()
        };
        let mut run = Simulation::new(&parameters, &inputs).unwrap();
        let mut last = run.outputs().traction_force;
        let mut at = Vec::new();
        for _ in 0..100 {
            let traction = run.hold(&inputs, 1e-3, 1).unwrap().traction_force;
            assert!(traction > last * (1.0 - 1e-9), "{traction} {last}");
            (last, at) = (traction, [at, vec![traction]].concat());
        }
        // 100 µm of flow by then would be 10 GPa.
        let bound = parameters.friction_cold * inputs.normal_load;
        assert!((last / bound - 1.0).abs() < 1e-6, "{last} {bound}");
        // After the first millisecond some 20 MPa, on an area that carries 1 GPa.
        assert!(at[0] < 0.2 * bound, "{} {bound}", at[0]);
        // From nothing else than what has slipped: in a hundred steps as in one.
        let mut once = Simulation::new(&parameters, &inputs).unwrap();
        let traction = once.hold(&inputs, 1e-2, 1).unwrap().traction_force;
        assert!((traction / at[9] - 1.0).abs() < 0.01, "{traction} {}", at[9]);
    }
}

/// Rail that leaves the contact forgets how far the layer on it has flowed: a contact that has been left empty begins anew.
#[test]
fn a_wheel_that_was_lifted_begins_anew() {
    for plain in models() {
        let parameters = Parameters {
            thermal_expansion: 0.0,
            wear_coefficient: 0.0,
            friction_law: FrictionLaw::Constant,
            layer_yield_stress: 5e7,
            layer_hardening: 1e13,
            ..plain
        };
        let down = Inputs {
            creepage: 0.01,
            ..Inputs::default()
        };
        let lifted = Inputs {
            normal_load: 0.0,
            ..down
        };
        let after = |steps: usize| {
            let mut run = Simulation::new(&parameters, &down).unwrap();
            run.hold(&down, 1e-3, steps).unwrap();
            run.hold(&lifted, 1e-3, 1).unwrap();
            run.hold(&down, 2e-5, 1).unwrap().traction_force
        };
        let (short, long) = (after(1), after(30));
        assert!((short / long - 1.0).abs() < 1e-9, "{short} {long}");
    }
}
