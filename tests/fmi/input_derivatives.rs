//! A moving load and a moving creepage: with fmi2SetRealInputDerivatives a step of 10 ms follows the inputs to order 2,
//! without it holds them and lags behind to order 1. And fmi2GetRealOutputDerivatives against the outputs themselves.

use super::importer::{
    Api, Client, ContactModel, DISCARD, ERROR, Fmi2, Line, OK, Patch, Profiles, WARNING, with_each,
    with_each_contact_model,
};
use std::f64::consts::TAU;
use std::ffi::c_int;
use wheelrail::parameters::Parameters;
use wheelrail::signals::{INPUTS, Inputs, OUTPUTS, Outputs};
use wheelrail::wheel_rail::Model;

/// Where the comparison begins: the rail has warmed up, several passages of the contact after the start.
const FIRST: f64 = 0.05;
/// Where it ends.
const LAST: f64 = 0.25;
/// Spacing of the points that are compared, and the longest step.
const POINT: f64 = 0.01;
/// Steps in a point for the solution that all others are compared with.
const CONVERGED: usize = 400;

const COMPARED: [&str; 6] = [
    "traction_force",
    "friction_torque",
    "peak_pressure",
    "penetration",
    "peak_temperature",
    "friction_power",
];

/// Inputs and their rates: the load moves by a third at 2 Hz, the creepage between partial slip and sliding at 3 Hz, of a patch the
/// lateral creepage and the spin at 4 Hz.
fn moving(time: f64, contact: ContactModel) -> (Inputs, Inputs) {
    let wave = |mean: f64, amplitude: f64, frequency: f64| {
        let phase = TAU * frequency * time;
        (
            mean + amplitude * phase.sin(),
            amplitude * TAU * frequency * phase.cos(),
        )
    };
    let (load, load_rate) = wave(60e3, 20e3, 2.0);
    let (creepage, creepage_rate) = wave(3e-3, 1e-3, 3.0);
    let sideways = f64::from(u8::from(contact == Patch));
    let (lateral, lateral_rate) = wave(5e-4 * sideways, 5e-4 * sideways, 4.0);
    let (spin, spin_rate) = wave(0.2 * sideways, 0.1 * sideways, 4.0);
    (
        Inputs {
            normal_load: load,
            creepage,
            lateral_creepage: lateral,
            spin_creepage: spin,
            ..Inputs::default()
        },
        Inputs {
            normal_load: load_rate,
            creepage: creepage_rate,
            lateral_creepage: lateral_rate,
            spin_creepage: spin_rate,
            ..Inputs::ZERO
        },
    )
}

/// The start values of a line, and of a patch those with which [`Client::coarse`] makes it.
fn parameters(contact: ContactModel) -> Parameters {
    match contact {
        Line => Parameters::default(),
        Patch | Profiles => Parameters {
            contact_model: contact,
            patch_nodes: 14,
            patch_strips: 7,
            depth_nodes: 17,
            ..Parameters::default()
        },
    }
}

/// The outputs and their rates at the compared points, natively, with `divisions` steps in each.
fn native(model: &Model, divisions: usize, interpolated: bool) -> Vec<(Outputs, Outputs)> {
    let moving = |time: f64| moving(time, model.parameters().contact_model);
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, &moving(0.0).0).unwrap();
    let duration = POINT / divisions as f64;
    let mut points = Vec::new();
    for step in 0..(LAST / duration).round() as usize {
        let (inputs, rates) = moving(step as f64 * duration);
        let rates = if interpolated { rates } else { Inputs::ZERO };
        model
            .step(&mut workspace, &mut state, &inputs, &rates, duration)
            .unwrap();
        if (step + 1) % divisions == 0 {
            points.push((state.outputs, model.output_rates(&state)));
        }
    }
    points.split_off((FIRST / POINT).round() as usize)
}

/// The same through the interface, as bits.
fn through_the_interface(api: &Api, contact: ContactModel, interpolated: bool) -> Vec<Vec<u64>> {
    let moving = |time: f64| moving(time, contact);
    let client = match contact {
        Line => Client::new(api),
        Patch | Profiles => Client::coarse(api, contact),
    };
    let moved = INPUTS.iter().filter(|signal| (signal.get)(&moving(0.0).1) != 0.0);
    let moved: Vec<_> = moved.collect();
    let set = |inputs: Inputs| {
        let values: Vec<_> = moved
            .iter()
            .map(|signal| (signal.name, (signal.get)(&inputs)))
            .collect();
        client.set(&values)
    };
    client.expect(OK, client.begin(0.0, None));
    client.expect(OK, set(moving(0.0).0));
    client.expect(OK, client.exit());
    let mut points = Vec::new();
    for step in 0..(LAST / POINT).round() as usize {
        let time = step as f64 * POINT;
        let (inputs, rates) = moving(time);
        client.expect(OK, set(inputs));
        if interpolated {
            let rates: Vec<_> = moved
                .iter()
                .map(|signal| (signal.name, 1, (signal.get)(&rates)))
                .collect();
            client.expect(OK, client.set_rates(&rates));
        }
        client.expect(OK, client.step(time, POINT));
        points.push(client.outputs());
    }
    points.split_off((FIRST / POINT).round() as usize)
}

/// Reads a value of a point.
type Read<'a> = &'a dyn Fn(&(Outputs, Outputs)) -> f64;

/// Largest difference over the points, relative to the largest magnitude.
fn error(read: Read, points: &[(Outputs, Outputs)], converged: &[(Outputs, Outputs)]) -> f64 {
    let scale = converged.iter().fold(0.0, |m: f64, point| read(point).abs().max(m));
    let differences = points.iter().zip(converged).map(|(a, b)| (read(a) - read(b)).abs());
    differences.fold(0.0, f64::max) / scale
}

/// Observed order between steps of 10 ms and 2.5 ms.
fn order(errors: [f64; 3]) -> f64 {
    0.5 * (errors[0] / errors[2]).log2()
}

#[test]
fn input_derivatives_act_on_one_step() {
    with_each_contact_model(&Api::load(Fmi2), |api, contact| {
        let step = |rate: Option<f64>| {
            let client = Client::running(api, contact, &[("normal_load", 5e4)]);
            if let Some(rate) = rate {
                client.expect(OK, client.set_rates(&[("normal_load", 1, rate)]));
            }
            client.expect(OK, client.step(0.0, 0.01));
            let first = client.get("peak_pressure");
            client.expect(OK, client.step(0.01, 0.01));
            (first, client.get("peak_pressure"))
        };
        let (held, rising) = (step(None), step(Some(1e6)));
        // Hertz, of a line and of an ellipse.
        let expected = match contact {
            Line => (6.0_f64 / 5.0).sqrt(),
            Patch | Profiles => (6.0_f64 / 5.0).cbrt(),
        };
        assert!((rising.0 / held.0 - expected).abs() < 0.02, "{rising:?} {held:?}");
        // The derivative is used up, the input is what was set.
        assert!((rising.1 / held.1 - 1.0).abs() < 1e-6, "{rising:?} {held:?}");
    });
}

#[test]
fn input_derivatives_are_checked() {
    with_each_contact_model(&Api::load(Fmi2), |api, contact| {
        for value in [f64::NAN, f64::INFINITY] {
            let client = Client::running(api, contact, &[]);
            client.expect(
                DISCARD,
                client.set_rates(&[("creepage", 1, 1.0), ("normal_load", 1, value)]),
            );
            assert!(client.last_message().contains("normal_load"));
            let fresh = Client::running(api, contact, &[]);
            client.expect(OK, client.step(0.0, 0.01));
            fresh.expect(OK, fresh.step(0.0, 0.01));
            assert_eq!(client.outputs(), fresh.outputs(), "nothing was set");
        }
        for order in [0, -1, c_int::MIN] {
            let client = Client::running(api, contact, &[]);
            client.expect(ERROR, client.set_rates(&[("normal_load", order, 1.0)]));
            assert!(client.last_message().contains("order"));
        }
        // Nothing forbids a master a higher order; it is told that it has no effect.
        let client = Client::running(api, contact, &[]);
        client.expect(WARNING, client.set_rates(&[("normal_load", 2, 1.0)]));
        assert!(client.last_message().contains("order 2"));
        client.expect(OK, client.step(0.0, 0.01));
        // Inputs have derivatives, outputs and parameters have none that could be set.
        client.expect(ERROR, client.set_rates(&[("friction_cold", 1, 1.0)]));
    });
}

#[test]
fn an_extrapolated_input_that_leaves_its_range_stops_the_step() {
    with_each_contact_model(&Api::load(Fmi2), |api, contact| {
        let client = Client::running(api, contact, &[]);
        client.expect(OK, client.step(0.0, 0.01));
        let before = client.outputs();
        let handle = client.save();
        for (name, rate) in [
            ("normal_load", -1e9),
            ("lateral_creepage", 1e4),
            ("spin_creepage", -1e6),
            ("lateral_speed", 1e6),
            ("spin_rate", -1e6),
        ] {
            client.expect(OK, client.set_rates(&[(name, 1, rate)]));
            client.expect(ERROR, client.step(0.01, 0.01));
            assert!(client.last_message().contains(&format!("{name} = ")));
            assert_eq!(client.outputs(), before);
            client.expect(OK, client.restore(handle));
        }
    });
}

#[test]
fn input_derivatives_bring_a_long_step_closer_to_the_converged_solution() {
    with_each_contact_model(&Api::load(Fmi2), |_, contact| {
        let model = Model::new(parameters(contact)).unwrap();
        let converged = native(&model, CONVERGED, true);
        // Some cells of a coarse patch join the contact, or begin to slip, within a step.
        let (shrinks, of_order) = match contact {
            Line => (0.5, 0.15),
            Patch | Profiles => (0.75, 0.3),
        };

        let [held, interpolated] =
            [false, true].map(|interpolated| [1, 2, 4].map(|divisions| native(&model, divisions, interpolated)));
        println!("| output | held, 10 ms | order | with derivatives, 10 ms | order |\n|---|---|---|---|---|");
        for name in COMPARED {
            let output = OUTPUTS.iter().find(|row| row.name == name).unwrap();
            let errors = |runs: &[Vec<_>; 3]| {
                [0, 1, 2].map(|run| error(&|point| (output.get)(&point.0), &runs[run], &converged))
            };
            let (held, interpolated) = (errors(&held), errors(&interpolated));
            println!(
                "| {name} | {:.2e} | {:.2} | {:.2e} | {:.2} |",
                held[0],
                order(held),
                interpolated[0],
                order(interpolated)
            );
            assert!((order(held) - 1.0).abs() < 0.15, "{name}: {held:?}");
            if !["peak_pressure", "penetration"].contains(&name) {
                // The displacement of the step before makes the shear, and what it heats, a state, whose step is of first order.
                assert!(
                    interpolated[0] < 0.3 * held[0] && interpolated[2] < shrinks * interpolated[0],
                    "{name}"
                );
            } else {
                assert!(interpolated[0] < 0.15 * held[0], "{name}");
                assert!((order(interpolated) - 2.0).abs() < of_order, "{name}: {interpolated:?}");
            }
        }
    });
}

/// What a master uses them for: outputs extrapolated over the next step of 10 ms miss it by less than held ones.
#[test]
fn output_derivatives_extrapolate_the_outputs() {
    with_each_contact_model(&Api::load(Fmi2), |_, contact| {
        let model = Model::new(parameters(contact)).unwrap();
        let points = native(&model, 1, true);
        // The peak of a coarse patch jumps from cell to cell.
        let share = match contact {
            Line => 0.4,
            Patch | Profiles => 0.5,
        };
        println!("| output | held over 10 ms | extrapolated over 10 ms |\n|---|---|---|");
        for name in COMPARED {
            let output = OUTPUTS.iter().find(|row| row.name == name).unwrap();
            let next = &points[1..];
            let predicted: Vec<_> = points
                .iter()
                .map(|(outputs, rates)| {
                    let mut later = *outputs;
                    (output.set)(&mut later, (output.get)(outputs) + (output.get)(rates) * POINT);
                    (later, *rates)
                })
                .collect();
            let miss = |points: &[_]| error(&|point| (output.get)(&point.0), &points[..next.len()], next);
            let (held, extrapolated) = (miss(&points), miss(&predicted));
            println!("| {name} | {held:.2e} | {extrapolated:.2e} |");
            assert!(extrapolated < share * held, "{name}: {extrapolated} {held}");
        }
    });
}

#[test]
fn output_derivatives_are_differences_of_the_outputs() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("creepage", 3e-3)]);
        let read = || client.outputs().into_iter().map(f64::from_bits).collect::<Vec<_>>();
        let mut before = read();
        for step in 0..20 {
            let time = f64::from(step) * 1e-3;
            let (inputs, rates) = moving(time, contact);
            client.expect(OK, client.set(&[("normal_load", inputs.normal_load)]));
            if api.takes_rates() {
                client.expect(OK, client.set_rates(&[("normal_load", 1, rates.normal_load)]));
            }
            client.expect(OK, client.step(time, 1e-3));
            let after = read();
            for (column, (row, derivative)) in OUTPUTS.iter().zip(client.output_rates()).enumerate() {
                let difference = (after[column] - before[column]) / 1e-3;
                // Round-off of the difference.
                let tolerance = 1e-12 * (after[column].abs() + before[column].abs()) / 1e-3;
                assert!(
                    (derivative - difference).abs() <= tolerance,
                    "{}: {derivative} {difference}",
                    row.name
                );
            }
            before = after;
        }
    });
}

#[test]
fn the_interface_gives_the_bits_of_the_model() {
    with_each(|api, contact| {
        let model = Model::new(parameters(contact)).unwrap();
        for interpolated in [false, api.takes_rates()] {
            let bits = |outputs: &Outputs| {
                OUTPUTS
                    .iter()
                    .map(|row| (row.get)(outputs).to_bits())
                    .collect::<Vec<_>>()
            };
            let points: Vec<_> = native(&model, 1, interpolated)
                .iter()
                .map(|point| bits(&point.0))
                .collect();
            assert_eq!(through_the_interface(api, contact, interpolated), points);
        }
    });
}
