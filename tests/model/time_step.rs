//! What the communication step does to the results: nothing once settled, first order while the inputs change, nothing at
//! all where a step fails.

use wheelrail::error::Error;
use wheelrail::parameters::{Control, Parameters, SlipSource, Wheel};
use wheelrail::signals::{Inputs, OUTPUTS, Outputs};
use wheelrail::simulation::Simulation as Run;

/// Outputs but for the totals, which grow, and the slip, which is an input.
fn settled_outputs(outputs: &Outputs) -> Vec<(&'static str, f64)> {
    let totals = ["worn_volume", "friction_energy", "distance", "wheel_wear_depth"];
    let rest = OUTPUTS.iter().filter(|signal| !totals.contains(&signal.name));
    rest.map(|signal| (signal.name, (signal.get)(outputs))).collect()
}

#[test]
fn the_settled_result_does_not_depend_on_the_step() {
    let inputs = Inputs {
        creepage: 0.01,
        ..Inputs::default()
    };
    let settle = |duration: f64, steps: usize| {
        let mut run = Run::new(&Parameters::default(), &inputs).unwrap();
        settled_outputs(run.hold(&inputs, duration, steps).unwrap())
    };
    // Material crosses the strip in 0.4 s; implicit steps longer than that need some dozens to forget the start.
    let expected = settle(1e-3, 3000);
    for (duration, steps) in [(1e-4, 15_000), (1e-2, 400), (0.1, 150)] {
        for ((name, expected), (_, computed)) in expected.iter().zip(settle(duration, steps)) {
            // Of the offset the half-length: like bodies have next to none.
            let scale = expected.abs().max(if *name == "contact_offset" {
                5e-3
            } else {
                f64::MIN_POSITIVE
            });
            // The split rests at 1e-9, and ∂u₁/∂t divides what is left of it by the step.
            assert!(
                (computed - expected).abs() <= 1e-8 * scale,
                "{name} at {duration}: {computed} {expected}"
            );
        }
    }
}

#[test]
fn a_run_repeats_bit_for_bit() {
    let ramp = |step: u32| Inputs {
        creepage: 1e-4 * f64::from(step),
        normal_load: 60e3 + 300.0 * f64::from(step),
        ..Inputs::default()
    };
    let run = || {
        let mut run = Run::new(&Parameters::default(), &ramp(0)).unwrap();
        for step in 0..60 {
            run.step(&ramp(step), 2e-3).unwrap();
        }
        run.state
    };
    assert!(run() == run());
}

/// A state that is restored goes on with the same bits only if the workspace adds nothing.
#[test]
fn a_workspace_carries_nothing_from_step_to_step() {
    let inputs = |step: u32| Inputs {
        creepage: 0.02 * f64::from(step % 2),
        ..Inputs::default()
    };
    let mut kept = Run::new(&Parameters::default(), &inputs(0)).unwrap();
    let mut fresh = Run::new(&Parameters::default(), &inputs(0)).unwrap();
    for step in 0..20 {
        kept.step(&inputs(step), 1e-3).unwrap();
        fresh.workspace = fresh.model.workspace();
        fresh.step(&inputs(step), 1e-3).unwrap();
        assert!(kept.state == fresh.state, "{step}");
    }
}

/// A smooth slide: the creepage rises like sin² to 2 % in 20 ms. The observed order of each output is
/// log₂ of the ratio of successive differences over halved steps.
#[test]
fn the_scheme_is_of_first_order_in_time() {
    const END: f64 = 0.02;
    let inputs = |time: f64| Inputs {
        creepage: 0.02 * (0.5 * std::f64::consts::PI * time / END).sin().powi(2),
        ..Inputs::default()
    };
    let slide = |steps: u32| {
        let mut run = Run::new(&Parameters::default(), &inputs(0.0)).unwrap();
        let duration = END / f64::from(steps);
        for step in 1..=steps {
            run.step(&inputs(f64::from(step) * duration), duration).unwrap();
        }
        run.state.outputs
    };
    let outputs = [slide(100), slide(200), slide(400)];
    for name in ["friction_energy", "worn_volume", "wear_depth"] {
        let signal = OUTPUTS.iter().find(|signal| signal.name == name).unwrap();
        let [coarse, middle, fine] = outputs.map(|outputs| (signal.get)(&outputs));
        let order = ((coarse - middle) / (middle - fine)).log2();
        // Of steps of 200, 100 and 50 µs, which the transient of the shear is not long against.
        assert!((order - 1.0).abs() < 0.2, "{name}: order {order}");
    }
}

/// At this penetration the contact of a rigid wheel just fits the window; heat makes it grow beyond.
#[test]
fn a_failed_step_leaves_the_state_as_it_was() {
    let parameters = Parameters {
        wheel: Wheel::Rigid,
        control: Control::Penetration,
        prescribed_penetration: 2.05e-4,
        slip_source: SlipSource::VehicleSpeed,
        thermal_expansion: 1e-4,
        ..Parameters::default()
    };
    let rolling = Inputs::default();
    let locked = Inputs {
        wheel_speed: 0.0,
        ..rolling
    };
    let mut run = Run::new(&parameters, &rolling).unwrap();
    run.hold(&rolling, 1e-3, 5).unwrap();
    let before = run.state.clone();

    // The first sub-step after the jump is the one that fails: nothing is committed.
    let step = |run: &mut Run, inputs: &Inputs, duration: f64| {
        run.model
            .step(&mut run.workspace, &mut run.state, inputs, &Inputs::ZERO, duration)
    };
    let interrupted = step(&mut run, &locked, 0.1).unwrap_err();
    if interrupted.committed == 0.0 {
        assert_eq!(run.state, before);
    } else {
        assert_eq!(run.state.time, before.time + interrupted.committed);
        // From the last committed sub-step the same failure, and now nothing at all changes.
        let committed = run.state.clone();
        let again = step(&mut run, &locked, 0.1).unwrap_err();
        assert_eq!(again.committed, 0.0);
        assert_eq!(run.state, committed);
    }
    assert!(
        matches!(interrupted.error, Error::ContactLeavesWindow { .. }),
        "{interrupted:?}"
    );
    let message = interrupted.error.to_string();
    for part in [
        "prescribed_penetration = 0.000205 m is too much",
        "largest_load = 100000 N",
    ] {
        assert!(message.contains(part), "{message}");
    }

    // The way on, and the same one as if the failure had not been.
    let mut fresh = Run::new(&parameters, &rolling).unwrap();
    fresh.state = run.state.clone();
    for run in [&mut run, &mut fresh] {
        run.hold(&rolling, 1e-3, 5).unwrap();
    }
    assert_eq!(run.state, fresh.state);
}
