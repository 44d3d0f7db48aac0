//! Lift-off, standstill, reversal: what the contact does where load or speed vanish or change sign.

use crate::by_speeds::{inputs, parameters};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;

#[test]
fn a_lifted_wheel_transmits_nothing_and_the_rail_cools() {
    let sliding = inputs(10.0, 10.5, 60e3);
    let lifted = Inputs {
        normal_load: 0.0,
        ..sliding
    };
    let mut run = Run::new(&parameters(), &sliding).unwrap();
    let hot = *run.hold(&sliding, 1e-3, 100).unwrap();
    let mut peak = hot.peak_temperature;
    for step in 0..50 {
        let outputs = run.hold(&lifted, 1e-4, 1).unwrap();
        for value in [
            outputs.traction_force,
            outputs.friction_torque,
            outputs.traction_coefficient,
            outputs.penetration,
            outputs.contact_length,
            outputs.contact_offset,
            outputs.peak_pressure,
            outputs.peak_shear,
            outputs.stick_fraction,
            outputs.friction_power,
            outputs.rail_heat_flow,
            outputs.wear_rate,
        ] {
            assert_eq!(value, 0.0, "{outputs:?}");
        }
        assert!(outputs.peak_temperature < peak, "step {step}");
        peak = outputs.peak_temperature;
        assert!((outputs.slip_creepage - 0.05).abs() < 1e-12);
        for node in run.contact_nodes() {
            assert_eq!((node.pressure, node.shear, node.slip), (0.0, 0.0, 0.0));
        }
    }
    // It comes down on a rail that has moved on.
    let back = run.hold(&sliding, 1e-3, 1000).unwrap();
    assert!((back.peak_temperature / hot.peak_temperature - 1.0).abs() < 1e-3);
    assert!((back.traction_force / hot.traction_force - 1.0).abs() < 1e-3);
}

#[test]
fn a_wheel_that_was_never_down_leaves_the_rail_as_it_is() {
    let lifted = inputs(10.0, 12.0, 0.0);
    let mut run = Run::new(&parameters(), &lifted).unwrap();
    let outputs = run.hold(&lifted, 1e-2, 10).unwrap();
    assert_eq!(outputs.peak_temperature, lifted.ambient_temperature);
    assert_eq!((outputs.worn_volume, outputs.friction_energy), (0.0, 0.0));
    assert!((outputs.distance - 1.0).abs() < 1e-12);
}

/// Full sliding on the spot for a short time: every node slides at the wheel's speed, T = μN, and the heat stays under the
/// wheel.
#[test]
fn a_wheel_that_spins_on_the_spot_drives_with_full_friction() {
    let parameters = parameters();
    let spinning = inputs(0.0, 0.05, 60e3);
    let mut run = Run::new(&parameters, &spinning).unwrap();
    let outputs = run.hold(&spinning, 1e-3, 20).unwrap();
    let expected = outputs.friction_coefficient;
    assert!((outputs.traction_coefficient - expected).abs() < 1e-9, "{outputs:?}");
    assert_eq!(outputs.stick_fraction, 0.0);
    assert_eq!(outputs.distance, 0.0);
    let power = outputs.traction_force * 0.05;
    // The rail's surface moves with its thermal expansion, some nanometres a millisecond beside 50 µm.
    assert!((outputs.friction_power / power - 1.0).abs() < 1e-4);

    // The hottest node lies under the wheel, and no heat has left it sideways.
    let nodes = run.contact_nodes();
    for node in &nodes {
        assert_eq!(node.pressure == 0.0, node.temperature == 0.0, "{node:?}");
    }
}

#[test]
fn a_wheel_at_rest_carries_its_load_and_nothing_else() {
    let resting = inputs(0.0, 0.0, 60e3);
    let mut run = Run::new(&parameters(), &resting).unwrap();
    let outputs = run.hold(&resting, 0.1, 10).unwrap();
    let hertz = parameters().hertz_peak_pressure(60e3);
    assert!((outputs.peak_pressure / hertz - 1.0).abs() < 0.01);
    assert_eq!((outputs.traction_force, outputs.friction_power), (0.0, 0.0));
    assert_eq!(outputs.slip_creepage, 0.0);
}

#[test]
fn a_locked_wheel_brakes_whichever_way_it_slides() {
    for speed in [10.0, -10.0] {
        let locked = inputs(speed, 0.0, 60e3);
        let mut run = Run::new(&parameters(), &locked).unwrap();
        let outputs = run.hold(&locked, 1e-3, 50).unwrap();
        assert!(outputs.traction_force * speed < 0.0);
        assert_eq!(outputs.slip_creepage, -1.0);
        // All of it slides: P = |T V| but for what the surface strain adds.
        let power = outputs.traction_force.abs() * 10.0;
        assert!((outputs.friction_power / power - 1.0).abs() < 0.02);
    }
}

#[test]
fn traction_reverses_with_slip_and_motion() {
    let mut run = Run::new(&parameters(), &inputs(5.0, 5.0, 60e3)).unwrap();
    // Through zero from +5 m/s to −5 m/s, the wheel always 4 % faster than it rolls.
    for step in 0..=100 {
        let speed = 5.0 - 0.1 * f64::from(step);
        let inputs = inputs(speed, 1.04 * speed, 60e3);
        let outputs = *run.hold(&inputs, 1e-2, 1).unwrap();
        if speed.abs() > 0.5 {
            assert!(outputs.traction_force * speed > 0.0, "{speed} {outputs:?}");
            assert!(outputs.friction_torque * speed < 0.0, "{speed} {outputs:?}");
        }
        assert!(outputs.friction_power >= 0.0 && outputs.wear_rate >= 0.0);
    }
    let backward = run.state.outputs;
    assert!(backward.distance > 0.0);
    // A brake in reverse pushes forward.
    let braking = inputs(-5.0, -4.8, 60e3);
    assert!(run.hold(&braking, 1e-3, 50).unwrap().traction_force > 0.0);
}
