//! Inputs and parameters at the edge of what the iterations can bear, with either wheel: each of these once failed.

use crate::by_speeds::{inputs, wheels};
use crate::setups::{line, patch, rolling, rolling_straight, settle, step_from};
use wheelrail::Error;
use wheelrail::parameters::{Parameters, SlipSource, Wheel};
use wheelrail::settings::Settings;
use wheelrail::signals::{Inputs, OUTPUTS};
use wheelrail::simulation::Simulation as Run;
use wheelrail::wheel_rail::Model;

/// Wear in the gap by fixed-point iteration would diverge where k|s|Δt, or k|s|Δx/V when rolling, exceeds the
/// smallest eigenvalue of the compliance, some 1.5e-15 m/Pa on the default mesh: there the normal problem takes it in.
#[test]
fn a_wheel_spins_on_the_spot() {
    let spinning = inputs(0.0, 1.0, 60e3);
    for parameters in wheels() {
        let mut run = Run::new(&parameters, &spinning).unwrap();
        run.hold(&spinning, 1e-2, 1).unwrap();
    }
}

#[test]
fn a_wheel_spins_at_walking_pace() {
    let spinning = inputs(0.1, 5.1, 60e3);
    for parameters in wheels() {
        let mut run = Run::new(&parameters, &spinning).unwrap();
        run.hold(&spinning, 1e-3, 1).unwrap();
    }
}

#[test]
fn a_soft_rail_wears_at_speed() {
    for (wear_coefficient, creepage) in [(1e-11, 1.0), (1e-10, 0.1), (1e-9, 0.01)] {
        for parameters in wheels() {
            let parameters = Parameters {
                wear_coefficient,
                ..parameters
            };
            let sliding = inputs(10.0, 10.0 * (1.0 + creepage), 60e3);
            let mut run = Run::new(&parameters, &sliding).unwrap();
            // So much wear widens the contact beyond its window within the step, where it is held.
            run.hold(&sliding, 1e-3, 1).unwrap();
        }
    }
}

#[test]
fn a_rail_of_large_thermal_expansion_slides() {
    for (thermal_expansion, creepage) in [(1e-4, 1.0), (1e-4, 0.1), (1e-4, -1.0)] {
        for parameters in wheels() {
            let parameters = Parameters {
                thermal_expansion,
                ..parameters
            };
            let sliding = inputs(10.0, 10.0 * (1.0 + creepage), 60e3);
            let mut run = Run::new(&parameters, &sliding).unwrap();
            run.hold(&sliding, 1e-3, 1).unwrap();
        }
    }
}

/// The end of the ramp, 53 211.7 N − (53 211.7 N/Δt) Δt, is −7e-12 N by rounding and refused as a negative load.
#[test]
fn a_load_is_ramped_to_zero() {
    for (load, duration) in [
        (53_211.7, 1.1e-3),
        (61_234.5, 7e-4),
        (48_765.4, 1.3e-2),
        (99_999.9, 3e-3),
    ] {
        let rolling = inputs(10.0, 10.0, load);
        let rates = Inputs {
            normal_load: -load / duration,
            ..Inputs::ZERO
        };
        for parameters in wheels() {
            let mut run = Run::new(&parameters, &rolling).unwrap();
            run.model
                .step(&mut run.workspace, &mut run.state, &rolling, &rates, duration)
                .unwrap();
            assert_eq!(run.state.outputs.traction_force, 0.0);
        }
    }
}

/// What round-off leaves of the larger tractions before is more than the tolerance of a load some 1e-9 times as large.
#[test]
fn a_load_nearly_vanishes() {
    let rolling = inputs(10.0, 10.01, 60e3);
    for parameters in wheels() {
        let mut run = Run::new(&parameters, &rolling).unwrap();
        run.hold(&rolling, 1e-3, 5).unwrap();
        run.hold(&inputs(10.0, 10.01, 1e-6), 1e-3, 1).unwrap();
    }
}

/// Coupling of pressure and shear times μ is strong.
#[test]
fn a_rail_is_extremely_rough() {
    for (speed, circumferential, normal_load, friction_scale) in [(0.1, 0.0, 15e3, 2.0), (60.0, 60.6, 40e3, 2.0)] {
        let rough = Inputs {
            friction_scale,
            ..inputs(speed, circumferential, normal_load)
        };
        for parameters in wheels() {
            let mut run = Run::new(&parameters, &rough).unwrap();
            run.hold(&rough, 1e-3, 5).unwrap();
        }
    }
}

/// Rail that was worn and heated by others comes in with a front; the contact goes over it.
#[test]
fn a_front_of_worn_and_hot_rail_passes_the_contact() {
    for (wear, temperature, load) in [
        (1e-6, 320.0, 60e3),
        (1e-4, 293.15, 60e3),
        (0.0, 900.0, 60e3),
        (1e-5, 250.0, 10e3),
    ] {
        for duration in [1e-3_f64, 2e-2, 1.0] {
            let rolling = inputs(10.0, 10.1, load);
            let front = Inputs {
                incoming_temperature: temperature,
                incoming_wear_depth: wear,
                ..rolling
            };
            let steps = (1.0 / duration).ceil().min(200.0) as usize;
            for parameters in wheels() {
                let mut run = Run::new(&parameters, &rolling).unwrap();
                run.hold(&rolling, duration, 3).unwrap();
                let sunk = run.state.outputs.penetration;
                let outputs = *run
                    .hold(&front, duration, 4 * steps)
                    .unwrap_or_else(|error| panic!("{front:?}: {error}"));
                if duration > 1e-2 {
                    // All of the contact is on the new rail: the wheel has sunk by the wear, but for the thermal bulge.
                    assert!(outputs.leaving_wear_depth > 0.99 * wear);
                    if temperature == 293.15 {
                        assert!((outputs.penetration - sunk - wear).abs() < 0.01 * wear);
                    }
                }
            }
        }
    }
}

/// A step whose budget of work is spent ends: staggered, in a few sub-steps, near what the coupled equations say; or with an error that says
/// how much it was, where no step may be staggered.
#[test]
fn a_step_ends_where_its_budget_of_work_is_spent() {
    for (parameters, inputs) in [
        (line(SlipSource::Creepage, Wheel::Elastic), rolling_straight(15.0, 4e-3)),
        (
            patch(SlipSource::Creepage, Wheel::Elastic),
            rolling(15.0, [4e-3, 1e-3, 0.3]),
        ),
    ] {
        let solved = Model::new(parameters.clone()).unwrap();
        let mut workspace = solved.workspace();
        let before = settle(&solved, &mut workspace, &inputs, 1e-3).unwrap();
        let harder = Inputs {
            normal_load: 1.2 * inputs.normal_load,
            ..inputs
        };
        let implicit = step_from(&solved, &mut workspace, &before, &harder, 1e-3).unwrap();
        assert!(!implicit.convergence.staggered);

        let mut settings = Settings::default();
        settings.step.work = 1;
        let bounded = Model::with_settings(parameters.clone(), settings).unwrap();
        let mut workspace = bounded.workspace();
        let staggered = step_from(&bounded, &mut workspace, &before, &harder, 1e-3).unwrap();
        assert!(staggered.convergence.staggered);
        // One sweep tells that the budget is spent, and each of the sub-steps takes one.
        assert!(staggered.convergence.iterations <= settings.step.staggered_substeps);
        for name in ["traction_force", "peak_temperature"] {
            let output = OUTPUTS.iter().find(|output| output.name == name).unwrap();
            let [close, exact] = [&staggered, &implicit].map(|state| (output.get)(&state.outputs));
            // Staggered coupling is of first order in the sub-step: a fourth of a step that changes the temperature by a few per cent.
            assert!((close / exact - 1.0).abs() < 0.02, "{name}: {close} {exact}");
        }

        settings.step.staggered_substeps = 0;
        let refusing = Model::with_settings(parameters, settings).unwrap();
        let mut workspace = refusing.workspace();
        let refused = step_from(&refusing, &mut workspace, &before, &harder, 1e-3).unwrap_err();
        assert!(matches!(refused, Error::TooMuchWork { limit: 1, .. }), "{refused}");
    }
}
