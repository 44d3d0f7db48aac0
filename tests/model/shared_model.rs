//! One model for several wheels and threads: each wheel as if it had a model of its own.

use crate::setups::{Layer, patch, rolling};
use wheelrail::parameters::{ContactModel, Control, Parameters, ProfileWear, SlipSource, Wheel};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::{Model, State};

const STEP: f64 = 1e-3;

fn model() -> Model {
    Model::new(Parameters {
        contact_nodes: 25,
        depth_nodes: 21,
        ..Parameters::default()
    })
    .unwrap()
}

fn inputs(normal_load: f64) -> Inputs {
    Inputs {
        creepage: 0.01,
        normal_load,
        ..Inputs::default()
    }
}

/// Twenty steps of a wheel under the given load.
fn run(model: &Model, normal_load: f64) -> State {
    let inputs = inputs(normal_load);
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, &inputs).unwrap();
    for _ in 0..20 {
        model
            .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, STEP)
            .unwrap();
    }
    state
}

#[test]
fn wheels_on_two_threads_share_a_model() {
    let shared = model();
    let loads = [30e3, 60e3];
    let together = std::thread::scope(|scope| {
        loads
            .map(|load| {
                let shared = &shared;
                scope.spawn(move || run(shared, load))
            })
            .map(|thread| thread.join().unwrap())
    });
    assert_eq!(together, loads.map(|load| run(&model(), load)));
}

#[test]
fn wheels_in_turn_share_model_and_workspace() {
    let shared = model();
    let mut workspace = shared.workspace();
    let loads = [30e3, 60e3];
    let inputs = loads.map(inputs);
    let mut states = inputs.map(|inputs| shared.initial_state(&mut workspace, &inputs).unwrap());
    for _ in 0..20 {
        for (state, inputs) in states.iter_mut().zip(&inputs) {
            shared.step(&mut workspace, state, inputs, &Inputs::ZERO, STEP).unwrap();
        }
    }
    assert_eq!(states, loads.map(|load| run(&model(), load)));
}

/// Three wheels that jump, each to its own displacement and load in each step: their contacts outgrow windows, appear, part and go. A step from a
/// state is the same, bit by bit, in a workspace in which another wheel has stepped as in one that nothing was in.
#[test]
fn a_step_finds_nothing_of_another_wheel_in_its_workspace() {
    let small = patch(SlipSource::VehicleSpeed, Wheel::Elastic);
    let profiles = Parameters {
        contact_model: ContactModel::Profiles,
        rail_profile: "UIC60".to_owned(),
        patch_nodes: 24,
        patch_strips: 15,
        ..small.clone()
    };
    let worn = Parameters {
        wheel_profile_wear: ProfileWear::On,
        rail_profile_wear: ProfileWear::On,
        ..profiles.clone()
    };
    let layer = Layer {
        strength: 2e7,
        hardening: 1e12,
        compliance: 1e-14,
        falls: true,
    };
    let given_height = Parameters {
        control: Control::Height,
        ..profiles.clone()
    };
    let with_layer = [layer.on(small.clone()), layer.on(profiles.clone())];
    for parameters in [small, profiles, worn, given_height].into_iter().chain(with_layer) {
        let model = Model::new(parameters).unwrap();
        let mut shared = model.workspace();
        let has_profiles = model.parameters().contact_model == ContactModel::Profiles;
        let at = |step: usize, wheel: usize| {
            let inputs = Inputs {
                normal_load: [10e3, 100e3, 0.0, 60e3][(step + wheel) % 4],
                ..rolling(20.0, [0.003, 0.002, 0.1])
            };
            if !has_profiles {
                return inputs;
            }
            let given_height = model.parameters().control == Control::Height;
            Inputs {
                normal_load: if given_height { 0.0 } else { inputs.normal_load },
                vertical_displacement: if given_height {
                    [0.1e-3, -0.02e-3, 0.3e-3][(step + wheel) % 3]
                } else {
                    0.0
                },
                lateral_displacement: [-2e-3, 5e-3, 6.4e-3, 5.85e-3, 0.0][(2 * step + wheel) % 5],
                lateral_speed: 0.04,
                creepage: 0.0,
                lateral_creepage: 0.0,
                spin_creepage: 0.0,
                spin_rate: 0.0,
                ..inputs
            }
        };
        let mut states: [State; 3] =
            std::array::from_fn(|wheel| model.initial_state(&mut model.workspace(), &at(0, wheel)).unwrap());
        // Twenty rounds of displacements and loads, in which the rail warms and wears.
        for step in 1..400 {
            for (wheel, state) in states.iter_mut().enumerate() {
                let inputs = at(step, wheel);
                let mut alone = state.clone();
                model.step(&mut shared, state, &inputs, &Inputs::ZERO, STEP).unwrap();
                let mut workspace = model.workspace();
                model
                    .step(&mut workspace, &mut alone, &inputs, &Inputs::ZERO, STEP)
                    .unwrap();
                assert_eq!(*state, alone, "step {step} of wheel {wheel}");
            }
        }
    }
}
