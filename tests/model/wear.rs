//! Archard wear (24): what a passage leaves behind, and what wear does to the contact.

use wheelrail::parameters::{Parameters, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;

/// In the steady state one passage leaves W = (k/V) ∫|s|p dx behind: the depth by the volume per distance and width.
#[test]
fn the_depth_left_behind_is_the_volume_worn_per_distance_and_width() {
    let parameters = Parameters::default();
    let inputs = Inputs {
        creepage: 0.01,
        ..Inputs::default()
    };
    let mut run = Run::new(&parameters, &inputs).unwrap();
    let outputs = run.hold(&inputs, 1e-2, 200).unwrap();
    let speed = inputs.motion(&parameters).rolling_speed;
    let expected = outputs.wear_rate / (speed * parameters.contact_width);
    assert!((outputs.wear_depth / expected - 1.0).abs() < 1e-9);
}

/// Archard's law is linear in k where wear is too small to change the gap.
#[test]
fn wear_is_proportional_to_its_coefficient() {
    let inputs = Inputs {
        creepage: 0.02,
        ..Inputs::default()
    };
    let rate = |wear_coefficient: f64| {
        let parameters = Parameters {
            wear_coefficient,
            ..Parameters::default()
        };
        let mut run = Run::new(&parameters, &inputs).unwrap();
        run.hold(&inputs, 1e-3, 50).unwrap().wear_rate
    };
    assert_eq!(rate(0.0), 0.0);
    assert!((rate(2e-15) / rate(1e-15) - 2.0).abs() < 1e-6);
}

/// Wear opens the gap: a locked wheel sinks in under its load.
#[test]
fn wear_lets_the_wheel_sink_in() {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        thermal_expansion: 0.0,
        wear_coefficient: 5e-12,
        ..Parameters::default()
    };
    let locked = Inputs {
        wheel_speed: 0.0,
        ..Inputs::default()
    };
    let mut run = Run::new(&parameters, &locked).unwrap();
    let before = run.state.outputs;
    let after = *run.hold(&locked, 1e-3, 50).unwrap();
    // Half the depth is gone in the middle of the contact.
    let sunk = after.penetration - before.penetration;
    assert!(
        sunk > 0.2 * after.wear_depth && sunk < after.wear_depth,
        "{sunk} {}",
        after.wear_depth
    );
    // The resultant moves to the unworn, leading side.
    assert!(after.contact_offset > before.contact_offset);
}
