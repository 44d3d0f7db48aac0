//! Archard wear (24): the volume worn is the wear depth on the rail and what it took out of the window, and each
//! field of the contact has the sign that it must have.

use proptest::prelude::*;
use wheelrail::contact::line::fields::Fields;
use wheelrail::parameters::{Parameters, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation as Run;
use wheelrail::transport::Upwind;
use wheelrail::wear;

/// ∫W dx on the march's own weights, the spacing upstream of each column, [m²].
fn worn_area(x: &[f64], speed: f64, depth: &[f64]) -> f64 {
    let columns = Upwind::new(x, speed).columns();
    columns.map(|column| column.spacing * depth[column.index]).sum()
}

/// d/dt ∫W dx + |V| W(outflow) = ∫ k|s|p dx: upwind differences telescope.
#[test]
fn worn_volume_is_the_depth_on_the_rail_and_what_left_it() {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    for direction in [1.0, -1.0] {
        let inputs = |step: i32| {
            let speed = direction * (10.0 + 0.05 * f64::from(step));
            Inputs {
                vehicle_speed: speed,
                wheel_speed: 1.03 * speed / parameters.wheel_radius,
                normal_load: 60e3 + 500.0 * f64::from(step % 3),
                ..Inputs::default()
            }
        };
        let mut run = Run::new(&parameters, &inputs(0)).unwrap();
        let mut left = 0.0;
        for step in 0..100 {
            run.step(&inputs(step), 5e-3).unwrap();
            // The first step after the cold start is no jump: none is divided.
            assert_eq!(run.state.duration, 5e-3);
            let speed = inputs(step).vehicle_speed;
            let outflow = Upwind::new(&run.model.rail().mesh.x, speed).outflow();
            left += speed.abs() * 5e-3 * run.state.fields().wear[outflow];
        }
        let x = &run.model.rail().mesh.x;
        let on_the_rail = worn_area(x, direction, &run.state.fields().wear);
        let volume = parameters.contact_width * (on_the_rail + left);
        let expected = run.state.outputs.worn_volume;
        assert!(
            left > 0.1 * on_the_rail,
            "the wear must have reached the end of the strip"
        );
        assert!((volume / expected - 1.0).abs() < 1e-10, "{volume} {expected}");
    }
}

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

fn assert_signs(fields: &Fields) {
    for node in 0..fields.pressure.len() {
        let (p, tau, slip) = (fields.pressure[node], fields.shear[node], fields.slip[node]);
        assert!(p >= 0.0);
        assert!(tau.abs() <= fields.friction[node] * p * (1.0 + 1e-9) + 1e-12);
        // Friction resists slip.
        assert!(tau * slip <= 1e-12, "{tau} {slip}");
        if p == 0.0 {
            assert_eq!((tau, slip), (0.0, 0.0));
        }
    }
    assert!(fields.wear.iter().all(|&w| w >= 0.0));
    // P1 with consistent mass undershoots ahead of a front, by far less than a kelvin.
    assert!(fields.surface_temperature.iter().all(|&t| t > -1.0));
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(12))]
    #[test]
    fn every_field_has_its_sign(
        steps in prop::collection::vec((1.0..30.0_f64, -0.05..0.05_f64, 5e3..95e3_f64), 1..6),
        backward in any::<bool>(),
    ) {
        let parameters = Parameters { slip_source: SlipSource::VehicleSpeed, ..Parameters::default() };
        let direction = if backward { -1.0 } else { 1.0 };
        let inputs = |(speed, creepage, load): (f64, f64, f64)| Inputs {
            vehicle_speed: direction * speed,
            wheel_speed: direction * speed * (1.0 + creepage) / parameters.wheel_radius,
            normal_load: load,
            ..Inputs::default()
        };
        let mut run = Run::new(&parameters, &inputs(steps[0])).unwrap();
        for &step in &steps {
            run.hold(&inputs(step), 2e-3, 5).unwrap();
            assert_signs(run.state.fields());
        }
    }

    /// The march is a weighted mean: it creates no extremes and keeps what it is given.
    #[test]
    fn the_march_without_rate_keeps_within_its_bounds(
        before in prop::collection::vec(0.0..1.0, 30),
        speed in -20.0..20.0,
        duration in 1e-5..1.0,
    ) {
        let x: Vec<f64> = (0..30).map(|i| 1e-3 * f64::from(i)).collect();
        let mut after = vec![0.0; 30];
        wear::advance(&Upwind::new(&x, speed), duration, 0, &[], &before, &mut after);
        let largest = before.iter().fold(0.0, |m: f64, w| w.max(m));
        prop_assert!(after.iter().all(|&w| (0.0..=largest).contains(&w)));
    }
}
