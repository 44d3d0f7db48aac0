//! Tests of the fields of a running simulation: balances, signs, symmetry.

use super::fields::LineFields;
use crate::numerics::dense;
use crate::parameters::{Control, NormalSolver, Parameters, SlipSource, Wheel};
use crate::signals::Inputs;
use crate::simulation::Simulation as Run;
use crate::transport::{CellStep, Upwind};
use proptest::prelude::*;

/// Largest difference, relative to the largest value.
fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    dense::largest_change(a, b) / dense::largest(a)
}

/// Growth of the worn area on the rail in a step, ∫(W − Wⁿ) dx as the march balances it, `m²`.
fn deposited(x: &[f64], speed: f64, duration: f64, before: &[f64], after: &[f64]) -> f64 {
    let transport = Upwind::new(x, speed);
    let growth = |i: usize| after[i] - before[i];
    transport
        .columns()
        .map(|column| {
            let step = CellStep::new(1.0 / duration, column.spacing, transport.speed());
            column.spacing * step.mean(growth(column.upstream), growth(column.index))
        })
        .sum()
}

/// d/dt ∫W dx + |V| W(outflow) = ∫ k|s|p dx: the balances of the cells add up.
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
        let (mut on_the_rail, mut left) = (0.0, 0.0);
        for step in 0..100 {
            let before = run.state.fields().unwrap().wear.clone();
            run.step(&inputs(step), 5e-3).unwrap();
            // The first step after the cold start is no jump: none is divided.
            assert_eq!(run.state.duration, 5e-3);
            let speed = inputs(step).vehicle_speed;
            let (x, after) = (
                &run.model.line_operators().unwrap().mesh.x,
                &run.state.fields().unwrap().wear,
            );
            left += speed.abs() * 5e-3 * after[Upwind::new(x, speed).outflow()];
            on_the_rail += deposited(x, speed, 5e-3, &before, after);
        }
        let volume = parameters.contact_width * (on_the_rail + left);
        let expected = run.state.outputs.worn_volume;
        assert!(
            left > 0.1 * on_the_rail,
            "the wear must have reached the end of the strip"
        );
        assert!((volume / expected - 1.0).abs() < 1e-10, "{volume} {expected}");
        // The depth as it lies there at last, between columns linear, but for the order of the march.
        let (x, wear) = (
            &run.model.line_operators().unwrap().mesh.x,
            &run.state.fields().unwrap().wear,
        );
        let cells = x.windows(2).zip(wear.windows(2));
        let area: f64 = cells.map(|(x, w)| (x[1] - x[0]) * 0.5 * (w[0] + w[1])).sum();
        assert!((area / on_the_rail - 1.0).abs() < 0.01, "{area} {on_the_rail}");
    }
}

fn assert_signs(fields: &LineFields) {
    let power: f64 = fields
        .shear
        .iter()
        .zip(&fields.slip)
        .map(|(tau, slip)| (tau * slip).abs())
        .sum();
    for node in 0..fields.pressure.len() {
        let (p, tau, slip) = (fields.pressure[node], fields.shear[node], fields.slip[node]);
        assert!(p >= 0.0);
        assert!(tau.abs() <= fields.friction[node] * p * (1.0 + 1e-9) + 1e-12);
        // Friction resists slip. That of a node is the mean over its cells, one of which reaches out of the contact at
        // the edges; the little power of the other sign that may come of it is left out.
        assert!(tau * slip <= 0.02 * power + 1e-12, "{tau} {slip} {power}");
        if p == 0.0 {
            assert_eq!((tau, slip), (0.0, 0.0));
        }
    }
    assert!(fields.wear.iter().all(|&w| w >= 0.0));
    // Round-off of the sums over the modes.
    assert!(fields.surface_temperature.iter().all(|&t| t > -1e-9));
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
            assert_signs(run.state.fields().unwrap());
        }
    }
}

/// The two methods for the normal problem give the same fields to 1e-8 in the whole model: with friction, heat and wear, under
/// load and under penetration. The second runs as the reference: tight by itself, and started anew at each step, from no
/// tractions and without extrapolation.
mod solvers {
    use super::*;

    /// Leaves temperature, wear, displacement and load, the state proper, and nothing that a step only starts its iteration
    /// from.
    fn forget_the_start(run: &mut Run) {
        let fields = &mut run.state.contact.line_mut().fields;
        let mean = fields.pressure.iter().sum::<f64>() / fields.pressure.len() as f64;
        fields.pressure.fill(mean);
        for start in [&mut fields.shear, &mut fields.slip, &mut fields.utilisation] {
            start.fill(0.0);
        }
        for rates in &mut run.state.contact.line_mut().rates {
            rates.fill(0.0);
        }
    }

    fn run_with(normal_solver: NormalSolver, control: Control) -> Run {
        let parameters = Parameters {
            // Normal and tangential problem are coupled.
            wheel: Wheel::Rigid,
            normal_solver,
            control,
            slip_source: SlipSource::VehicleSpeed,
            // Both solvers must work in the model; the linearisation takes minutes on the default mesh.
            contact_nodes: 31,
            depth_nodes: 21,
            ..Parameters::default()
        };
        let inputs = |slide: f64, load: f64| Inputs {
            wheel_speed: 10.0 * (1.0 - slide) / parameters.wheel_radius,
            normal_load: load,
            ..Inputs::default()
        };
        let mut run = Run::new(&parameters, &inputs(0.0, 60e3)).unwrap();
        for (slide, load) in [(0.001, 60e3), (0.002, 55e3), (0.01, 50e3), (0.02, 70e3)] {
            for _ in 0..4 {
                if normal_solver == NormalSolver::Pschenichnyj {
                    forget_the_start(&mut run);
                }
                run.hold(&inputs(slide, load), 5e-3, 1).unwrap();
            }
        }
        run
    }

    #[test]
    fn active_set_and_linearisation_give_the_same_fields() {
        for control in [Control::Load, Control::Penetration] {
            let (active, linearised) = (
                run_with(NormalSolver::ActiveSet, control),
                run_with(NormalSolver::Pschenichnyj, control),
            );
            let (a, b) = (active.state.fields().unwrap(), linearised.state.fields().unwrap());
            for (name, a, b) in [
                ("pressure", &a.pressure, &b.pressure),
                ("shear", &a.shear, &b.shear),
                ("temperature", &a.surface_temperature, &b.surface_temperature),
                ("wear", &a.wear, &b.wear),
            ] {
                let difference = largest_difference(a, b);
                assert!(difference <= 1e-8, "{control:?} {name} {difference:e}");
            }
            assert!((a.penetration / b.penetration - 1.0).abs() <= 1e-8);
        }
    }
}
