//! The wheel's rim and the rail in exchange: stable at any step, and with the signs that it must have.

use wheelrail::parameters::{FrictionLaw, Parameters, WheelHeating};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;

/// A ring of 1 mm by 1 mm, 10 J/K, that takes from N/r = 60 W/K to 60 MW/K from the rail.
fn thin(contact_thermal_resistance: f64) -> Parameters {
    Parameters {
        wheel_heating: WheelHeating::On,
        rim_depth: 1e-3,
        rim_width: 1e-3,
        contact_thermal_resistance,
        ..Parameters::default()
    }
}

fn sliding() -> Inputs {
    Inputs {
        creepage: 0.02,
        ..Inputs::default()
    }
}

/// However long the step against the time constant of the ring (C r/(ᾱ N): from 0.3 s down to 0.3 µs here), its temperature
/// rises to its limit without overshoot, and the limit does not depend on the step.
#[test]
fn a_long_step_at_a_thin_rim_does_not_oscillate() {
    for resistance in [1000.0, 10.0, 1e-3] {
        let mut limits = Vec::new();
        for (duration, steps) in [(1.0, 60), (10.0, 12), (1000.0, 8)] {
            let mut run = Run::new(&thin(resistance), &sliding()).unwrap();
            let mut last = run.state.outputs.wheel_temperature;
            for _ in 0..steps {
                let now = run.hold(&sliding(), duration, 1).unwrap().wheel_temperature;
                // Round-off: at 60 MW/K, 1e-12 K is 60 µW, some 1e-4 K of the ring.
                assert!(
                    now >= last - 1e-5 * (last - 293.15),
                    "{resistance} {duration}: {last} {now}"
                );
                last = now;
            }
            limits.push(last);
        }
        for limit in &limits {
            assert!((limit / limits[0] - 1.0).abs() < 1e-3, "{resistance}: {limits:?}");
        }
    }
}

/// A warm wheel takes less heat from the rail, which gets hotter; the wheel's share of the friction power is its own.
#[test]
fn a_warm_wheel_cools_the_rail_less() {
    let hot = |wheel_heating| {
        let parameters = Parameters {
            wheel_heating,
            friction_law: FrictionLaw::Constant,
            ..thin(100.0)
        };
        let mut run = Run::new(&parameters, &sliding()).unwrap();
        *run.hold(&sliding(), 0.1, 50).unwrap()
    };
    let (cold, warm) = (hot(WheelHeating::Off), hot(WheelHeating::On));
    assert_eq!(cold.wheel_temperature, 293.15);
    assert!(warm.wheel_temperature > 400.0, "{}", warm.wheel_temperature);
    assert!(warm.peak_temperature > cold.peak_temperature + 10.0);
    assert!(warm.rail_heat_flow > cold.rail_heat_flow);
    assert!(warm.wheel_heat_flow < cold.wheel_heat_flow);
    assert!(cold.wheel_heat_flow > 0.5 * cold.friction_power);
}

/// Without contact the wheel follows the ambient, and the rail does not know of it.
#[test]
fn a_lifted_wheel_follows_the_ambient() {
    let parameters = thin(1000.0);
    let lifted = Inputs {
        normal_load: 0.0,
        ..Inputs::default()
    };
    let mut run = Run::new(&parameters, &lifted).unwrap();
    let warmer = Inputs {
        ambient_temperature: 303.15,
        incoming_temperature: 303.15,
        ..lifted
    };
    let outputs = *run.hold(&warmer, 1e3, 5).unwrap();
    assert!((outputs.wheel_temperature - 303.15).abs() < 1e-3);
    assert_eq!(outputs.wheel_heat_flow, 0.0);
    assert_eq!(outputs.peak_temperature, 303.15);
    // Rail that is colder than the ambient comes in.
    let cold = Inputs {
        incoming_temperature: 290.0,
        ..warmer
    };
    let outputs = *run.hold(&cold, 1.0, 5).unwrap();
    assert!(outputs.leaving_temperature < 291.0, "{}", outputs.leaving_temperature);
}
