//! A solver that diverges leaves the state as it was. Built with the feature `divergence-injection`:
//! `cargo test --features divergence-injection --test divergence`.

#![allow(unsafe_code)]

mod common;

use common::{Api, Client, DISCARD, ERROR, OK, library_path};
use libloading::Library;
use wheelrail::injection::{Solver, diverge};
use wheelrail::parameters::{NormalSolver, Parameters};
use wheelrail::signals::Inputs;
use wheelrail::wheel_rail::Model;

/// What each solver's message says.
fn words(solver: Solver) -> &'static str {
    match solver {
        Solver::ActiveSet => "normal contact solver (active set)",
        Solver::Pschenichnyj => "normal contact solver (Pschenichnyj)",
        Solver::Tangential => "tangential Newton solver",
        Solver::Mechanics => "coupling of normal and tangential contact",
        Solver::Split => "thermo-mechanical operator split",
        Solver::SurfaceHeat => "surface heat condition",
        Solver::WheelHeat => "temperature of the wheel",
    }
}

fn normal_solver(solver: Solver) -> NormalSolver {
    match solver {
        Solver::Pschenichnyj => NormalSolver::Pschenichnyj,
        _ => NormalSolver::ActiveSet,
    }
}

/// Natively: the state is that before the step, or after the last committed sub-step, bit for bit, and the workspace
/// that saw the failure gives the bits of a fresh one.
#[test]
fn a_step_that_diverges_leaves_the_last_committed_state() {
    let mut failures = 0;
    for solver in Solver::ALL {
        let parameters = Parameters {
            normal_solver: normal_solver(solver),
            contact_nodes: 25,
            depth_nodes: 17,
            ..Parameters::default()
        };
        let model = Model::new(parameters).unwrap();
        let mut workspace = model.workspace();
        let inputs = Inputs {
            creepage: 0.01,
            ..Inputs::default()
        };
        let mut state = model.initial_state(&mut workspace, &Inputs::default()).unwrap();
        model
            .step(&mut workspace, &mut state, &Inputs::default(), &Inputs::ZERO, 1e-3)
            .unwrap();
        let before = state;
        // The jump of the creepage divides the step, so that some calls come after a committed sub-step.
        let duration = 2e-3;
        let mut undisturbed = before.clone();
        model
            .step(
                &mut model.workspace(),
                &mut undisturbed,
                &inputs,
                &Inputs::ZERO,
                duration,
            )
            .unwrap();
        let (mut first, mut later) = (0, 0);
        for after in 0.. {
            let mut state = before.clone();
            diverge(solver, after, usize::MAX);
            let Err(interrupted) = model.step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, duration) else {
                assert!(state == undisturbed, "{solver:?} {after}");
                diverge(solver, 0, 0);
                break;
            };
            failures += 1;
            assert_eq!(interrupted.error, solver.divergence());
            if interrupted.committed == 0.0 {
                first += 1;
                assert!(state == before, "{solver:?} {after}");
            } else {
                later += 1;
                assert_eq!(state.time, before.time + interrupted.committed);
                // What was committed is what a run without the failure had committed by then.
                let mut replay = before.clone();
                diverge(solver, after, usize::MAX);
                let again = model.step(&mut model.workspace(), &mut replay, &inputs, &Inputs::ZERO, duration);
                assert_eq!(again, Err(interrupted));
                assert!(replay == state && state.fields != before.fields);
            }
            diverge(solver, 0, 0);
            // The workspace carries nothing over.
            let mut state = before.clone();
            model
                .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, duration)
                .unwrap();
            assert!(state == undisturbed, "{solver:?} {after}");
            // A solver that diverges once is helped by a shorter sub-step.
            let mut state = before.clone();
            diverge(solver, after, 1);
            model
                .step(&mut workspace, &mut state, &inputs, &Inputs::ZERO, duration)
                .unwrap();
            let (helped, exact) = (state.outputs.traction_force, undisturbed.outputs.traction_force);
            assert!((helped / exact - 1.0).abs() < 1e-3, "{helped} {exact}");
        }
        assert!(first > 0 && later > 0, "{solver:?}: {first} {later}");
    }
    println!("{failures} steps that diverged, natively");
}

/// Through the interface: fmi2Error before a committed sub-step, fmi2Discard after one; the last committed state stands, and
/// fmi2SetFMUstate or fmi2Reset lead on.
#[test]
fn a_step_that_diverges_through_the_interface() {
    let api = Api::load();
    // SAFETY: the library is loaded already, the function has this signature.
    let library = unsafe { Library::new(library_path()).unwrap() };
    // SAFETY: as above.
    let diverge: unsafe extern "C" fn(u32, u32, u32) = unsafe { *library.get(b"wheelrail_diverge\0").unwrap() };
    let (mut errors, mut discards) = (0, 0);
    for (index, solver) in (0..).zip(Solver::ALL) {
        let client = Client::initializing(&api);
        client.expect(
            OK,
            client.set_integers(&[("normal_solver", normal_solver(solver) as i32 + 1)]),
        );
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 1e-3));
        let (handle, before) = (client.save(), client.outputs());
        let jump = || client.expect(OK, client.set(&[("creepage", 0.01)]));
        jump();
        client.expect(OK, client.step(1e-3, 2e-3));
        let undisturbed = client.outputs();
        let mut seen = [false; 2];
        for after in 0.. {
            client.expect(OK, client.restore(handle));
            jump();
            // SAFETY: the function takes three numbers.
            unsafe { diverge(index, after, u32::MAX) };
            let status = client.step(1e-3, 2e-3);
            // SAFETY: the function takes three numbers.
            unsafe { diverge(index, 0, 0) };
            if status == OK {
                assert_eq!(client.outputs(), undisturbed);
                break;
            }
            let message = client.last_message();
            assert!(message.contains(words(solver)), "{message}");
            match status {
                ERROR => {
                    seen[0] = true;
                    errors += 1;
                    assert_eq!(client.outputs(), before);
                    client.expect(ERROR, client.step(1e-3, 2e-3));
                    assert!(client.last_message().contains("state error"));
                }
                DISCARD => {
                    seen[1] = true;
                    discards += 1;
                    let mut reached = f64::NAN;
                    // SAFETY: one place.
                    client.expect(OK, unsafe { (api.get_real_status)(client.component, 2, &mut reached) });
                    assert!(reached > 1e-3 && reached < 3e-3, "{reached}");
                    assert_ne!(client.outputs(), before);
                    client.expect(ERROR, client.step(reached, 1e-3));
                    assert!(client.last_message().contains("stepFailed"));
                }
                other => panic!("status {other}"),
            }
        }
        assert_eq!(seen, [true; 2], "{solver:?}");
        // The other way on.
        client.expect(OK, client.restore(handle));
        jump();
        // SAFETY: the function takes three numbers.
        unsafe { diverge(index, 0, u32::MAX) };
        client.expect(ERROR, client.step(1e-3, 2e-3));
        // SAFETY: the function takes three numbers.
        unsafe { diverge(index, 0, 0) };
        client.expect(OK, client.reset());
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 1e-3));
    }
    println!("{errors} steps that diverged at once, {discards} after a committed part, through the interface");
}
