//! Steps that are hard: the state and the workspace that they leave, and the way that they are taken.

use super::*;
use crate::parameters::{ContactModel, NormalSolver, SlipSource, Wheel, WheelHeating};
use crate::settings::TangentialSettings;
use crate::settings::limits::{LIMITS, PATCH_LIMITS};

/// A small model of a rigid wheel, whose normal and tangential problem are coupled, that is heated, and a state from which
/// a jump of the creepage divides the next step.
fn model(normal_solver: NormalSolver, settings: Settings) -> Model {
    let parameters = Parameters {
        normal_solver,
        wheel: Wheel::Rigid,
        wheel_heating: WheelHeating::On,
        contact_nodes: 25,
        depth_nodes: 17,
        ..Parameters::default()
    };
    Model::with_settings(parameters, settings).unwrap()
}

/// A small patch, heated and with a wheel of the same kind.
fn patch(settings: Settings) -> Model {
    let parameters = Parameters {
        contact_model: ContactModel::Patch,
        wheel: Wheel::Rigid,
        wheel_heating: WheelHeating::On,
        patch_nodes: 14,
        patch_strips: 7,
        depth_nodes: 17,
        ..Parameters::default()
    };
    Model::with_settings(parameters, settings).unwrap()
}

/// State and workspace of another contact model are refused, and nothing of them is read.
#[test]
fn contact_models_do_not_mix() {
    let line = model(NormalSolver::ActiveSet, Settings::default());
    let patch = Model::new(Parameters {
        contact_model: ContactModel::Patch,
        ..Parameters::default()
    })
    .unwrap();
    let inputs = Inputs::default();
    let state = line.initial_state(&mut line.workspace(), &inputs).unwrap();
    let mut other = state.clone();
    assert!(line.accepts(&state) && !patch.accepts(&state));
    let step = |model: &Model, workspace: &mut Workspace, state: &mut State| {
        let interrupted = model.step(workspace, state, &inputs, &Inputs::ZERO, 1e-3).unwrap_err();
        assert_eq!(
            (interrupted.committed, interrupted.error),
            (0.0, Error::OtherContactModel)
        );
    };
    step(&patch, &mut patch.workspace(), &mut other);
    step(&patch, &mut line.workspace(), &mut other);
    step(&line, &mut patch.workspace(), &mut other);
    assert!(other == state);
    let foreign = Error::OtherContactModel;
    assert!(
        line.initial_state(&mut patch.workspace(), &inputs)
            .is_err_and(|error| error == foreign)
    );
    let sensitivities = patch.output_sensitivities(&mut patch.workspace(), &state, 0..1);
    assert!(sensitivities.is_err_and(|error| error == foreign));
    assert!(patch.thermal_map_size().is_err() && line.thermal_map_size().is_ok());
    assert!(patch.contact_nodes(&state).is_empty());
    assert_eq!(patch.profiles(&state), Profiles::untouched(inputs.ambient_temperature));
}

const JUMPED: fn() -> Inputs = || Inputs {
    creepage: 0.01,
    ..Inputs::default()
};

fn step(model: &Model, state: &mut State, duration: f64) -> std::result::Result<(), Interrupted> {
    model.step(&mut model.workspace(), state, &JUMPED(), &Inputs::ZERO, duration)
}

/// Fails each solver somewhere in the step: the state is that of the last committed sub-step, bit for bit.
#[test]
fn a_step_that_fails_leaves_the_last_committed_state() {
    let mut later = 0;
    let of_a_line = LIMITS.map(|limit| (ContactModel::Line, limit));
    let of_a_patch = PATCH_LIMITS.map(|limit| (ContactModel::Patch, limit));
    for (contact_model, (words, set_limit)) in of_a_line.into_iter().chain(of_a_patch) {
        let normal_solver = if words.contains("Pschenichnyj") {
            NormalSolver::Pschenichnyj
        } else {
            NormalSolver::ActiveSet
        };
        let model = |settings| match contact_model {
            ContactModel::Line => model(normal_solver, settings),
            ContactModel::Patch | ContactModel::Profiles => patch(settings),
        };
        let sound = model(Settings::default());
        let inputs = Inputs::default();
        let mut before = sound.initial_state(&mut sound.workspace(), &inputs).unwrap();
        sound
            .step(&mut sound.workspace(), &mut before, &inputs, &Inputs::ZERO, 1e-3)
            .unwrap();
        let mut undisturbed = before.clone();
        step(&sound, &mut undisturbed, 2e-3).unwrap();
        let mut failures = 0;
        for limit in 0.. {
            let mut settings = Settings::strict();
            settings.step.retries = 0;
            set_limit(&mut settings, limit);
            let limited = model(settings);
            if words.starts_with("coupling") {
                // The mechanics alone are solved for the initial state only.
                let failed = limited.initial_state(&mut limited.workspace(), &inputs);
                let Err(error) = failed else { break };
                assert!(error.to_string().contains(words), "{error}");
                failures += 1;
                continue;
            }
            let mut state = before.clone();
            let Err(interrupted) = step(&limited, &mut state, 2e-3) else {
                // A step goes on where its tractions fall short for once, and may end with the closest iterate, as its residual
                // says; the friction of a line is solved by another method then.
                let share = state.outputs.traction_force / undisturbed.outputs.traction_force;
                let tolerance = match contact_model {
                    ContactModel::Line => state.convergence.residual.max(1e-9),
                    ContactModel::Patch | ContactModel::Profiles => 1e-5,
                };
                let short = (share - 1.0).abs() < tolerance;
                assert!(state == undisturbed || short, "{words}, limit {limit}: {share}");
                break;
            };
            failures += 1;
            assert!(interrupted.to_string().contains(words), "{interrupted}");
            if interrupted.committed == 0.0 {
                assert!(state == before, "{words}, limit {limit}");
            } else {
                later += 1;
                assert_eq!(state.time, before.time + interrupted.committed);
                // The sub-steps that were committed are those of a sound step, so that going on from them leads where the
                // sound step leads, to the order of its sub-steps.
                assert!(state.contact != before.contact);
                step(&sound, &mut state, 2e-3 - interrupted.committed).unwrap();
                let (resumed, whole) = (state.outputs.traction_force, undisturbed.outputs.traction_force);
                assert!((resumed / whole - 1.0).abs() < 1e-2, "{words}: {resumed} {whole}");
            }
        }
        assert!(failures > 0, "{words}: never failed");
    }
    assert!(later > 0, "no solver failed after a committed sub-step");
}

/// A workspace in which a step has failed gives the bits of a fresh one.
#[test]
fn a_failed_step_leaves_nothing_in_the_workspace() {
    let mut settings = Settings::strict();
    settings.split.iterations = 6;
    settings.step.retries = 0;
    let limited = model(NormalSolver::ActiveSet, settings);
    let mut workspace = limited.workspace();
    let start = limited.initial_state(&mut workspace, &Inputs::default()).unwrap();
    let step = |workspace: &mut Workspace, inputs: &Inputs, duration| {
        let mut state = start.clone();
        let result = limited.step(workspace, &mut state, inputs, &Inputs::ZERO, duration);
        (result, state)
    };
    let easy = Inputs::default();
    let expected = step(&mut limited.workspace(), &easy, 1e-4);
    assert!(expected.0.is_ok());
    // Sliding on the spot with a thousandfold wear needs more iterations than there are.
    let hard = Inputs {
        creepage: 0.9,
        wheel_speed: 400.0,
        ..easy
    };
    let failed = step(&mut workspace, &hard, 1.0);
    assert!(failed.0.is_err());
    assert!(step(&mut workspace, &easy, 1e-4) == expected);
}

/// A step whose coupled equations are not solved, here for want of iterations, is taken staggered. Over a passage friction falls
/// by a part in a thousand a step, by which alone the two differ.
#[test]
fn a_step_that_is_not_solved_is_taken_staggered() {
    let mut unsolved = Settings::default();
    unsolved.split.iterations = 1;
    unsolved.step.retries = 0;
    for model in [
        |settings| model(NormalSolver::ActiveSet, settings),
        |settings| patch(settings),
    ] {
        let (sound, limited) = (model(Settings::default()), model(unsolved));
        let run = |model: &Model, steps: u32| {
            let mut workspace = model.workspace();
            let mut state = sound.initial_state(&mut sound.workspace(), &Inputs::default()).unwrap();
            for _ in 0..steps {
                let duration = 4e-3 / f64::from(steps);
                model
                    .step(&mut workspace, &mut state, &JUMPED(), &Inputs::ZERO, duration)
                    .unwrap();
            }
            state
        };
        for steps in [8, 32, 128] {
            let (implicit, staggered) = (run(&sound, steps), run(&limited, steps));
            assert!(staggered.convergence.staggered && !implicit.convergence.staggered);
            assert!(staggered.convergence.residual > 0.0 && limited.accepts(&staggered));
            let rise = |state: &State| state.outputs.peak_temperature - JUMPED().ambient_temperature;
            let error = (rise(&staggered) / rise(&implicit) - 1.0).abs();
            assert!(error > 0.0 && error < 1e-3, "{steps}: {error}");
        }
    }
}

/// A step without work to solve the law of friction takes the solution of a smoother law, with a part of the shear; its residual is that of the law itself.
#[test]
fn the_residual_of_a_smoother_law_is_that_of_the_law() {
    let mut settings = Settings::default();
    (settings.step.work, settings.step.staggered_work) = (10, 10);
    // Of a line: no exchange of nodes, no other law than the smoothest.
    settings.tangential = TangentialSettings {
        exchanges: 0,
        path_exchanges_per_node: 0,
        newton_steps: 4,
        work: 10,
        ..settings.tangential
    };
    let slipping = Inputs {
        creepage: 4e-3,
        ..Inputs::default()
    };
    for model in [
        |settings| model(NormalSolver::ActiveSet, settings),
        |settings| patch(settings),
    ] {
        let (sound, idle) = (model(Settings::default()), model(settings));
        let step = |model: &Model| {
            let mut state = sound.initial_state(&mut sound.workspace(), &Inputs::default()).unwrap();
            model
                .step(&mut model.workspace(), &mut state, &slipping, &Inputs::ZERO, 1e-3)
                .unwrap();
            state
        };
        let (solved, smoothed) = (step(&sound), step(&idle));
        let [exact, part] = [&solved, &smoothed].map(|state| state.outputs.traction_force / state.outputs.normal_force);
        assert!(smoothed.convergence.staggered && part < 0.5 * exact, "{part} {exact}");
        // Where all of the shear is missing that the law has, the residual is as large as what the forces lack.
        assert!(
            smoothed.convergence.residual > exact - part,
            "{:?}",
            smoothed.convergence
        );
    }
}

/// A step without work to find the pressure of profiles at another place holds the one that there is, in proportion to the load, and says so; it is the same step in a
/// workspace that has been used. Under a load that is many times as large it is refused, and changes nothing.
#[test]
fn a_pressure_that_is_not_found_is_held() {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        slip_source: SlipSource::VehicleSpeed,
        patch_nodes: 16,
        patch_strips: 9,
        ..Parameters::default()
    };
    let sound = Model::new(parameters.clone()).unwrap();
    let mut settings = Settings::default();
    (settings.step.work, settings.step.staggered_work) = (10, 10);
    let idle = Model::with_settings(parameters, settings).unwrap();
    let displaced = |normal_load, lateral_displacement| Inputs {
        normal_load,
        lateral_displacement,
        ..Inputs::default()
    };
    let first = |load| {
        let inputs = displaced(load, 0.0);
        sound.initial_state(&mut sound.workspace(), &inputs).unwrap()
    };
    let moved = displaced(80e3, 5e-3);
    let mut workspace = idle.workspace();
    let step = |workspace: &mut Workspace, inputs: &Inputs| {
        let mut state = first(60e3);
        idle.step(workspace, &mut state, inputs, &Inputs::ZERO, 1e-3).unwrap();
        state
    };
    // A little beside, the first height carries the load; the friction is that of a smoother law, which the residual shows.
    let near = step(&mut workspace, &displaced(60e3, 5e-4));
    let carried = near.outputs.force_z / 60e3;
    assert!((carried - 1.0).abs() < 1e-3, "{carried}");
    let residual = near.convergence.residual;
    assert!(
        near.convergence.staggered && residual > 0.1 && residual < 0.3,
        "{residual}"
    );
    let held = step(&mut workspace, &moved);
    assert!(held.convergence.staggered && held.convergence.residual >= 1.0);
    assert!(idle.accepts(&held));
    let ratio = held.outputs.peak_pressure / first(60e3).outputs.peak_pressure;
    assert!((ratio * 60.0 / 80.0 - 1.0).abs() < 0.02, "{ratio}");
    assert!(step(&mut workspace, &moved) == held);

    let light = first(5e3);
    let mut state = light.clone();
    let refused = idle.step(&mut workspace, &mut state, &moved, &Inputs::ZERO, 1e-3);
    let interrupted = refused.unwrap_err();
    assert!(
        matches!(interrupted.error, Error::TooMuchWork { .. }),
        "{}",
        interrupted.error
    );
    assert!(state == light);
}

/// A sub-step that fails is tried again in quarters, which start closer to their solution: among many limits of the split
/// and lengths of the step there are some where only that leads to the end.
#[test]
fn a_shorter_sub_step_helps() {
    let sound = model(NormalSolver::ActiveSet, Settings::default());
    let start = sound.initial_state(&mut sound.workspace(), &Inputs::default()).unwrap();
    let mut helped = 0;
    for limit in 1..8 {
        let mut without = Settings::strict();
        without.split.iterations = limit;
        without.step.retries = 0;
        let mut with = without;
        with.step.retries = Settings::default().step.retries;
        let [with, without] = [with, without].map(|settings| model(NormalSolver::ActiveSet, settings));
        for k in 0..30 {
            let duration = 1e-6 * 1.4_f64.powi(k);
            let mut state = start.clone();
            let fails = step(&without, &mut start.clone(), duration).is_err();
            if fails && step(&with, &mut state, duration).is_ok() {
                assert_eq!(state.time, duration);
                helped += 1;
            }
        }
    }
    assert!(helped > 0);
}
