//! The step: its times, the status of one that fails, derivatives of inputs and outputs.

use super::importer::{
    Client, ContactModel, DISCARD, ERROR, Fmi2, Fmi3, Line, OK, Patch, Profiles, sideways, with_each,
    with_each_standard,
};
use std::ptr::null_mut;

#[test]
fn a_step_size_that_cannot_be_is_refused_at_once() {
    with_each(|api, contact| {
        for size in [0.0, -0.0, -1.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            let client = Client::running(api, contact, &[]);
            client.expect(ERROR, client.step(0.0, size));
            let message = client.last_message();
            assert!(
                message.contains("communicationStepSize") && message.contains("above 0"),
                "{message}"
            );
        }
    });
}

#[test]
fn a_communication_point_other_than_the_last_is_refused() {
    with_each(|api, contact| {
        for point in [0.011, 0.0, -0.01, 1e300, f64::NAN, f64::INFINITY] {
            let client = Client::running(api, contact, &[]);
            client.expect(OK, client.step(0.0, 0.01));
            client.expect(ERROR, client.step(point, 0.01));
            let message = client.last_message();
            assert!(
                message.contains("currentCommunicationPoint") && message.contains("0.01"),
                "{message}"
            );
        }
    });
}

#[test]
fn the_start_time_is_the_first_communication_point() {
    with_each(|api, contact| {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.begin(-2.5, Some(-2.4)));
        client.expect(OK, client.exit());
        client.expect(OK, client.step(-2.5, 0.05));
        client.expect(OK, client.step(-2.45, 0.05));
        client.expect(ERROR, client.step(-2.4, 0.05));
    });
}

#[test]
fn times_of_the_experiment_are_checked() {
    with_each_standard(|api| {
        for (start, stop) in [
            (f64::NAN, None),
            (f64::INFINITY, None),
            (0.0, Some(f64::NAN)),
            (0.0, Some(-1.0)),
            (1.0, Some(0.999)),
        ] {
            let client = Client::new(api);
            client.expect(ERROR, client.begin(start, stop));
            assert!(client.last_message().contains("Time"), "{start} {stop:?}");
        }
    });
}

#[test]
fn a_step_beyond_the_stop_time_is_an_error_with_room_for_rounding() {
    with_each(|api, contact| {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.begin(0.0, Some(0.3)));
        client.expect(OK, client.exit());
        // 0.1 + 0.1 + 0.1 is more than 0.3 in floating point.
        let mut time = 0.0;
        for _ in 0..3 {
            client.expect(OK, client.step(time, 0.1));
            time += 0.1;
        }
        assert!(time > 0.3);
        client.expect(ERROR, client.step(time, 1e-3));
        let message = client.last_message();
        assert!(message.contains("stopTime") && message.contains("0.3"), "{message}");
    });
}

#[test]
fn a_master_may_add_up_time_or_multiply() {
    with_each(|api, contact| {
        let (added, multiplied) = (Client::running(api, contact, &[]), Client::running(api, contact, &[]));
        let mut time = 0.0;
        for step in 0..1000 {
            added.expect(OK, added.step(time, 1e-4));
            time += 1e-4;
            multiplied.expect(OK, multiplied.step(f64::from(step) * 1e-4, 1e-4));
        }
        assert_eq!(added.outputs(), multiplied.outputs());
    });
}

#[test]
fn extreme_step_sizes_come_back() {
    with_each(|api, contact| {
        for size in [f64::MIN_POSITIVE, 1e-300, 1e-30, 1e-12, 1e3, 1e9, 1e30, 1e300] {
            let client = Client::running(api, contact, &[("creepage", 0.01)]);
            let status = client.step(0.0, size);
            assert!([OK, DISCARD, ERROR].contains(&status), "{size}");
            if status == OK {
                for bits in client.outputs() {
                    assert!(f64::from_bits(bits).is_finite(), "{size}");
                }
                client.expect(OK, client.step(size, size));
            }
        }
    });
}

/// All that an instance holds, but for the state that the call has left it in.
fn content(client: &Client) -> Vec<u8> {
    let bytes = client.serialize(client.save());
    // Between the header with the number of the state, and the checksum.
    bytes[29..bytes.len() - 4].to_vec()
}

/// A penetration that is given under a rail that swells with heat takes more and more load, until the contact reaches the end of
/// its window: penetrations and creepages of which some stop such a step.
pub fn stops(contact: ContactModel) -> impl Iterator<Item = (f64, f64)> {
    let penetrations: &[f64] = match contact {
        Line => &[1.8e-4, 1.9e-4, 1.95e-4, 2e-4, 2.03e-4, 2.06e-4],
        Patch | Profiles => &[4e-5, 5e-5, 6e-5, 6.4e-5, 6.47e-5, 6.48e-5],
    };
    penetrations
        .iter()
        .flat_map(|penetration| [0.05, 0.5, 5.0, 50.0].map(|creepage| (*penetration, creepage)))
}

/// Brings an instance in *instantiated* before such a step, at 1 ms.
pub fn swell(client: &Client, penetration: f64, creepage: f64) {
    client.expect(OK, client.begin(0.0, None));
    client.expect(OK, client.set_integers(&[("wheel", 1), ("control", 2)]));
    let start = [("prescribed_penetration", penetration), ("thermal_expansion", 1e-4)];
    client.expect(OK, client.set(&start));
    client.expect(OK, client.set(sideways(client.contact)));
    client.expect(OK, client.exit());
    client.expect(OK, client.step(0.0, 1e-3));
    client.expect(OK, client.set(&[("creepage", creepage)]));
}

/// The jump of the creepage divides the step: where a part of it is committed FMI 2.0 discards it and FMI 3.0, by which that would
/// mean that nothing has changed, calls it an error; otherwise it is an error in one and discarded in the other.
#[test]
fn a_step_that_cannot_be_completed_tells_whether_a_part_of_it_was_committed() {
    with_each(|api, contact| {
        let (mut in_part, mut failed) = (0, 0);
        let [of_part, of_nothing] = match api.standard {
            Fmi2 => [DISCARD, ERROR],
            Fmi3 => [ERROR, DISCARD],
        };
        for (penetration, creepage) in stops(contact) {
            let client = Client::coarse(api, contact);
            swell(&client, penetration, creepage);
            let (handle, before) = (client.save(), content(&client));
            let status = client.step(1e-3, 10.0);
            if status == OK {
                continue;
            }
            let message = client.last_message();
            assert!(message.contains("the last committed state stands: "), "{message}");
            if let Fmi3 = api.standard {
                assert_eq!(client.answer.get().early_return, 0);
            }
            let mut shorter = 1e-3;
            if status == of_part {
                in_part += 1;
                let reached = client.last_successful_time();
                assert!(reached > 1e-3 && reached < 10.001, "{reached}");
                shorter = (0.25 * (reached - 1e-3)).min(1e-3);
                assert_ne!(content(&client), before, "the committed part stands");
            } else {
                failed += 1;
                assert_eq!(status, of_nothing);
                assert!(content(&client) == before, "something has changed");
            }
            // The standard's way on: back, and a shorter step. It has the bits of an instance in which no step has failed.
            let other = Client::coarse(api, contact);
            swell(&other, penetration, 0.0);
            let (bytes, mut copy) = (client.serialize(handle), null_mut());
            other.expect(OK, other.deserialize(&bytes, &mut copy));
            for (client, handle) in [(&client, handle), (&other, copy)] {
                client.expect(OK, client.restore(handle));
                assert!(content(client) == before, "not restored");
                if status == of_nothing {
                    client.expect(OK, client.set(&[("creepage", 0.0)]));
                }
                client.expect(OK, client.step(1e-3, shorter));
            }
            assert_eq!(client.outputs(), other.outputs());
        }
        println!("{in_part} steps came part of their way, {failed} failed");
        assert!(in_part > 0 && failed > 0);
    });
}

#[test]
fn output_derivatives_are_the_slope_of_the_outputs() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("creepage", 0.01)]);
        client.expect(OK, client.step(0.0, 0.01));
        let before = client.get("distance");
        client.expect(OK, client.step(0.01, 0.01));
        let slope = (client.get("distance") - before) / 0.01;
        let (distance, mut value) = (api.reference("distance"), f64::NAN);
        // SAFETY: one element each.
        unsafe {
            client.expect(
                OK,
                api.get_output_derivatives(client.component, &distance, 1, &1, &mut value),
            );
            assert!((value / slope - 1.0).abs() < 1e-9, "{value} {slope}");
            client.expect(
                OK,
                api.get_output_derivatives(client.component, &distance, 1, &2, &mut value),
            );
            assert_eq!(value, 0.0, "the standard: 0 above the highest order");
            client.expect(
                ERROR,
                api.get_output_derivatives(client.component, &distance, 1, &0, &mut value),
            );
        }
        assert!(client.last_message().contains("order 0"));
    });
}

#[test]
fn directional_derivatives_are_linear_in_the_direction() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("creepage", 5e-4)]);
        client.expect(OK, client.step(0.0, 0.01));
        let unknowns = ["traction_force", "peak_pressure"].map(|name| api.reference(name));
        let knowns = ["creepage", "normal_load"].map(|name| api.reference(name));
        let derivative = |direction: [f64; 2]| {
            let mut values = [f64::NAN; 2];
            // SAFETY: two elements each.
            let status = unsafe {
                api.directional_derivative(
                    client.component,
                    unknowns.as_ptr(),
                    2,
                    knowns.as_ptr(),
                    2,
                    direction.as_ptr(),
                    values.as_mut_ptr(),
                )
            };
            client.expect(OK, status);
            values
        };
        let (first, second, both) = (derivative([1.0, 0.0]), derivative([0.0, 1.0]), derivative([2.0, -3.0]));
        for row in 0..2 {
            let expected = 2.0 * first[row] - 3.0 * second[row];
            assert!((both[row] - expected).abs() <= 1e-12 * (first[row].abs() + second[row].abs()));
        }
        // An input that is named again and again counts as often, and is solved for once.
        let (often, direction) = ([knowns[0]; 1000], [1e-3; 1000]);
        let mut value = f64::NAN;
        // SAFETY: as many elements as are counted.
        let status = unsafe {
            api.directional_derivative(
                client.component,
                &unknowns[0],
                1,
                often.as_ptr(),
                often.len(),
                direction.as_ptr(),
                &mut value,
            )
        };
        client.expect(OK, status);
        // A thousand roundings.
        assert!((value - first[0]).abs() <= 1e-12 * first[0].abs());
        // A direction that is not finite is refused.
        // SAFETY: one element each.
        let status = unsafe {
            api.directional_derivative(client.component, &unknowns[0], 1, &knowns[0], 1, &f64::NAN, &mut value)
        };
        client.expect(ERROR, status);
        let seed = match api.standard {
            Fmi2 => "dvKnown of creepage",
            Fmi3 => "seed of creepage",
        };
        assert!(client.last_message().contains(seed));
    });
}

/// The model's own tests compare over many operating points; this one compares through the interface.
#[test]
fn directional_derivatives_are_the_differences_of_a_rolled_back_step() {
    with_each(|api, contact| {
        let start = [("creepage", 5e-4), ("normal_load", 6e4)];
        // Relative change of an input, and what the solvers leave of an output: those of a patch 1e-5 of its pressure, and what
        // follows from it.
        let (change, left) = match contact {
            Line => (1e-4, 1e-10),
            Patch | Profiles => (3e-3, 2e-5),
        };
        let client = Client::running(api, contact, &start);
        for step in 0..3 {
            client.expect(OK, client.step(0.01 * f64::from(step), 0.01));
        }
        let handle = client.save();
        let outputs = ["traction_force", "peak_pressure", "friction_power", "wear_rate"];
        let step = |name: &str, value: f64| {
            client.expect(OK, client.restore(handle));
            client.expect(OK, client.set(&[(name, value)]));
            client.expect(OK, client.step(0.03, 0.01));
            outputs.map(|output| client.get(output))
        };
        for (name, value) in start {
            let small = change * value;
            let (above, below) = (step(name, value + small), step(name, value - small));
            let here = step(name, value);
            for (row, output) in outputs.into_iter().enumerate() {
                let (unknown, known, mut derivative) = (api.reference(output), api.reference(name), f64::NAN);
                // SAFETY: one element each.
                let status = unsafe {
                    api.directional_derivative(client.component, &unknown, 1, &known, 1, &1.0, &mut derivative)
                };
                client.expect(OK, status);
                let difference = (above[row] - below[row]) / (2.0 * small);
                // The differences' own error is of the order of the square of the change, and of a patch that of a cell which begins to
                // slip between them.
                let allowed = 1e-3 * difference.abs() + left * here[row] / small;
                assert!(
                    (derivative - difference).abs() <= allowed,
                    "d {output} / d {name} = {derivative}, by differences {difference} to {allowed}"
                );
            }
        }
    });
}
