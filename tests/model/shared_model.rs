//! One model for several wheels and threads: each wheel as if it had a model of its own.

use wheelrail::parameters::Parameters;
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
