//! Laws of wear over the contact: derivatives of a step, the worn volume by the law at the nodes, what the debris carries away.

use crate::derivatives::{check, check_within};
use crate::setups::{line, patch, rolling, rolling_straight, step_from};
use wheelrail::parameters::{ContactModel, Control, FrictionLaw, Parameters, Side, SlipSource, WearLaw, Wheel};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation;
use wheelrail::wheel_rail::{ContactNode, Model};

/// Laws other than Archard's with one coefficient.
const LAWS: [WearLaw; 2] = [WearLaw::ArchardMap, WearLaw::Energy];

/// A law whose thresholds lie within a contact that slides at some `slip` `m/s` and a peak pressure of some 1 GPa, and whose blends are as wide as they may be;
/// `amount` times the wear of rail steel.
fn within(parameters: Parameters, wear_law: WearLaw, slip: f64, creepage: f64, amount: f64) -> Parameters {
    let work = 0.35 * 0.5e9 * creepage;
    Parameters {
        wear_law,
        wear_coefficient: 0.5e-12 * amount,
        wear_blend: 1.0,
        hardness: 1e9,
        wear_map_mild: 5e-4 * amount,
        wear_map_severe: 35e-4 * amount,
        wear_map_fast: 10e-4 * amount,
        wear_map_catastrophic: 100e-4 * amount,
        wear_map_slip_severe: 0.6 * slip,
        wear_map_slip_fast: 1.2 * slip,
        wear_energy_mild: 5.3e-9 * amount,
        wear_energy_severe: 5.3e-9 * amount * 0.5 * work,
        wear_energy_catastrophic: 62e-9 * amount,
        wear_energy_threshold: work,
        ..parameters
    }
}

/// The wear of rail steel, and so much that a passage takes off a third of the penetration: it is solved for together with the pressure.
const AMOUNTS: [f64; 2] = [1.0, 30.0];

#[test]
fn steps_of_a_line_have_derivatives_under_each_law() {
    for law in LAWS {
        for (wheel, amount) in [
            (Wheel::Rigid, AMOUNTS[0]),
            (Wheel::Elastic, AMOUNTS[0]),
            (Wheel::Elastic, AMOUNTS[1]),
        ] {
            for creepage in [4e-3, 0.02] {
                let parameters = within(
                    line(SlipSource::VehicleSpeed, wheel),
                    law,
                    15.0 * creepage,
                    creepage,
                    amount,
                );
                let compared = check(parameters, rolling_straight(15.0, creepage), 1e-3).unwrap();
                assert!(compared >= 80, "{law:?} {wheel:?} {amount} {creepage}: {compared}");
            }
        }
    }
}

#[test]
fn steps_of_a_patch_have_derivatives_under_each_law() {
    for law in LAWS {
        for amount in AMOUNTS {
            for (creepages, creepage) in [([4e-3, 1e-3, 0.3], 4e-3), ([0.01, 0.01, 0.1], 0.014)] {
                let parameters = patch(SlipSource::VehicleSpeed, Wheel::Elastic);
                let parameters = within(parameters, law, 15.0 * creepage, creepage, amount);
                let compared = check(parameters, rolling(15.0, creepages), 1e-3).unwrap();
                assert!(compared >= 150, "{law:?} {amount} {creepages:?}: {compared}");
            }
        }
    }
}

/// A wheel that spins on the spot: all of the energy's law is catastrophic.
#[test]
fn steps_of_a_patch_that_stands_have_derivatives_under_each_law() {
    for law in LAWS {
        let inputs = Inputs {
            wheel_speed: 0.05 / Parameters::default().wheel_radius,
            lateral_speed: 0.02,
            ..rolling(0.0, [0.0; 3])
        };
        let parameters = patch(SlipSource::VehicleSpeed, Wheel::Elastic);
        let parameters = within(parameters, law, 0.05, 1e-2, 1.0);
        let compared = check(parameters, inputs, 1e-3).unwrap();
        assert!(compared >= 150, "{law:?}: {compared}");
    }
}

/// Profiles: small windows, on the tread and where tread and gauge corner carry.
fn profiles() -> Parameters {
    Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        side: Side::Right,
        control: Control::Load,
        friction_law: FrictionLaw::PiecewiseLinear,
        friction_cold: 0.4,
        patch_nodes: 18,
        patch_strips: 11,
        depth_nodes: 13,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

fn on_profiles(lateral: f64) -> Inputs {
    Inputs {
        normal_load: 40e3,
        wheel_speed: 20.1 / 0.46,
        vehicle_speed: 20.0,
        lateral_displacement: -lateral,
        yaw_angle: 1e-3,
        incoming_temperature: 310.0,
        incoming_wear_depth: 2e-7,
        ..Inputs::default()
    }
}

#[test]
fn steps_of_profiles_have_derivatives_under_each_law() {
    for law in LAWS {
        for lateral in [1e-3, 5e-3] {
            let parameters = within(profiles(), law, 0.1, 5e-3, 1.0);
            let compared = check_within(parameters, on_profiles(lateral), 1e-3, [1e-4, 4e-6], &[]).unwrap();
            assert!(compared > 100, "{law:?} {lateral}: {compared}");
        }
    }
}

/// The laws as docs/model.md has them, at a node.
fn law(parameters: &Parameters, node: &ContactNode, speed: f64) -> f64 {
    let slip = node.slip.hypot(node.lateral_slip);
    let power = -(node.shear * node.slip + node.lateral_shear * node.lateral_slip).min(0.0);
    let blend = parameters.wear_blend;
    let step = |value: f64, place: f64| {
        let t = ((value / place - 1.0) / blend + 0.5).clamp(0.0, 1.0);
        3.0 * t.powi(2) - 2.0 * t.powi(3)
    };
    let ramp = |work: f64, place: f64| {
        let (t, h) = (work - place, 0.5 * blend * place);
        if t.abs() < h {
            (t + h).powi(2) / (4.0 * h)
        } else {
            t.max(0.0)
        }
    };
    match parameters.wear_law {
        WearLaw::Archard => parameters.wear_coefficient * slip * node.pressure,
        WearLaw::ArchardMap => {
            let severe = step(slip, parameters.wear_map_slip_severe);
            let past = step(slip, parameters.wear_map_slip_fast);
            let catastrophic = step(node.pressure / parameters.hardness, parameters.wear_map_pressure);
            let mut k = parameters.wear_map_mild;
            k += severe * (parameters.wear_map_severe - parameters.wear_map_mild);
            k += past * (parameters.wear_map_fast - parameters.wear_map_severe);
            k += catastrophic * (parameters.wear_map_catastrophic - k);
            k * slip * node.pressure / parameters.hardness
        }
        WearLaw::Energy => {
            let (work, mild) = (power / speed, parameters.wear_energy_mild);
            let mass = mild * work - mild * ramp(work, parameters.wear_energy_severe / mild)
                + parameters.wear_energy_catastrophic * ramp(work, parameters.wear_energy_threshold);
            mass * speed / parameters.density
        }
    }
}

/// Worn volume of a run whose slip passes through all of a law's branches, against the sum of the law over nodes and steps.
#[test]
fn the_worn_volume_is_the_law_over_area_and_time() {
    let width = Parameters::default().contact_width;
    for wear_law in WearLaw::ALL.iter().copied() {
        for base in [
            line(SlipSource::VehicleSpeed, Wheel::Elastic),
            patch(SlipSource::VehicleSpeed, Wheel::Elastic),
        ] {
            let parameters = within(base, wear_law, 0.15, 0.01, 1.0);
            let model = Model::new(parameters.clone()).unwrap();
            let mut workspace = model.workspace();
            let at = |creepage: f64| rolling_straight(15.0, creepage);
            let mut state = model.initial_state(&mut workspace, &at(1e-3)).unwrap();
            let (mut worn, mut debris) = (0.0, 0.0);
            for step in 0..20 {
                state = step_from(&model, &mut workspace, &state, &at(1e-3 * f64::from(step)), 1e-3).unwrap();
                assert_eq!(state.duration, 1e-3, "the step must not be divided");
                let nodes = model.contact_nodes(&state);
                let along = nodes[1].position - nodes[0].position;
                let across = match parameters.contact_model {
                    ContactModel::Line => width,
                    _ => nodes[parameters.patch_nodes].lateral_position - nodes[0].lateral_position,
                };
                for node in nodes.iter().filter(|node| node.pressure > 0.0) {
                    let rate = law(&parameters, node, 15.0);
                    worn += 1e-3 * along * across * rate;
                    debris += rate * node.temperature;
                }
            }
            let found = state.outputs.worn_volume;
            assert!(
                (found / worn - 1.0).abs() < 1e-10,
                "{wear_law:?} {:?}: {found} {worn}",
                parameters.contact_model
            );
            assert!(debris > 0.0);
        }
    }
}

/// In the steady state what leaves is what is worn, under each law, as [`super::wear`] has it for Archard's.
#[test]
fn what_leaves_is_what_is_worn() {
    for wear_law in LAWS {
        let parameters = within(Parameters::default(), wear_law, 0.15, 0.01, 1.0);
        let inputs = Inputs {
            creepage: 0.01,
            ..Inputs::default()
        };
        let mut run = Simulation::new(&parameters, &inputs).unwrap();
        let outputs = run.hold(&inputs, 1e-2, 200).unwrap();
        let speed = inputs.motion(&parameters).rolling_speed;
        let expected = outputs.wear_rate / (speed * parameters.contact_width);
        assert!((outputs.wear_depth / expected - 1.0).abs() < 1e-9, "{wear_law:?}");
    }
}

/// The coefficient of Archard's law has no say in the others.
#[test]
fn each_law_has_parameters_of_its_own() {
    for wear_law in LAWS {
        let run = |wear_coefficient: f64| {
            let parameters = Parameters {
                wear_law,
                wear_coefficient,
                ..Parameters::default()
            };
            let inputs = Inputs {
                creepage: 0.02,
                ..Inputs::default()
            };
            *Simulation::new(&parameters, &inputs)
                .unwrap()
                .hold(&inputs, 1e-3, 5)
                .unwrap()
        };
        let outputs = run(0.0);
        assert!(outputs.wear_rate > 0.0, "{wear_law:?}");
        assert_eq!(outputs, run(1e-11), "{wear_law:?}");
    }
}

/// Thresholds that do not ascend are refused with both values.
#[test]
fn thresholds_ascend() {
    for (parameters, name) in [
        (
            Parameters {
                wear_law: WearLaw::ArchardMap,
                wear_map_slip_fast: 0.1,
                ..Parameters::default()
            },
            "wear_map_slip_fast = 0.1",
        ),
        (
            Parameters {
                wear_law: WearLaw::Energy,
                wear_energy_threshold: 1e6,
                ..Parameters::default()
            },
            "wear_energy_threshold = 1000000",
        ),
    ] {
        let refused = parameters.validate().unwrap_err().to_string();
        assert!(refused.contains(name), "{refused}");
        let unused = Parameters {
            wear_law: WearLaw::Archard,
            ..parameters
        };
        assert_eq!(unused.validate(), Ok(()));
    }
}

/// Long steps of a patch in which some cells wear mildly and others seven times as fast, up to twelve times as much as rail steel: what the pressure sees of the
/// wear jumps with the slip of a cell, and the steps are solved all the same.
#[test]
fn long_steps_under_a_law_that_jumps_are_solved() {
    for (amount, grid) in [(1.0, [10, 7]), (4.0, [16, 9]), (12.0, [10, 7]), (12.0, [16, 9])] {
        let [patch_nodes, patch_strips] = grid;
        let contact = patch(SlipSource::VehicleSpeed, Wheel::Rigid);
        let model = Model::new(Parameters {
            wear_blend: 0.1,
            patch_nodes,
            patch_strips,
            friction_law: FrictionLaw::Constant,
            ..within(contact, WearLaw::ArchardMap, 0.2, 0.01, amount)
        })
        .unwrap();
        let mut workspace = model.workspace();
        for creepage in [0.0, 2e-3, 6e-3, 10e-3, 14e-3] {
            for spin in [0.0, 0.4, 0.8, 1.2] {
                let inputs = rolling(20.0, [creepage, 1e-3, spin]);
                let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
                for _ in 0..3 {
                    state = step_from(&model, &mut workspace, &state, &inputs, 0.5).unwrap();
                    assert!(!state.convergence.staggered, "{amount} {grid:?} {creepage} {spin}");
                }
            }
        }
    }
}

/// A wheel that spins on the spot and wears thirty times as much as by default: the contact yields to the wear of a step as much as to the load, and the steps are
/// solved as the normal problem takes that wear.
#[test]
fn steps_of_a_wheel_that_digs_are_solved() {
    for contact in [
        line(SlipSource::VehicleSpeed, Wheel::Rigid),
        patch(SlipSource::VehicleSpeed, Wheel::Rigid),
    ] {
        let model = Model::new(Parameters {
            friction_law: FrictionLaw::Constant,
            wear_coefficient: 30.0 * contact.wear_coefficient,
            ..contact
        })
        .unwrap();
        let mut workspace = model.workspace();
        for creepage in [5.0, 10.0, 20.0, 40.0] {
            let inputs = rolling_straight(0.05, creepage);
            let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
            for _ in 0..3 {
                state = step_from(&model, &mut workspace, &state, &inputs, 1e-3).unwrap();
                assert!(!state.convergence.staggered, "{creepage}");
            }
        }
    }
}
