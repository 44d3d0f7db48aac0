//! Who is to blame decides the status: a value is discarded, a call or a combination is an error.

use super::importer::{Api, Client, DISCARD, ERROR, OK, find, reference};
use wheelrail::fmi2::variables::{Causality, Kind, Variability, variables};
use wheelrail::parameters::Parameters;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// A value that cannot be is discarded by a message that names variable, value and range; the old one stays.
#[track_caller]
fn expect_discard(client: &Client, name: &str, value: f64) {
    let before = client.get(name);
    client.expect(DISCARD, client.set(&[(name, value)]));
    let message = client.last_message();
    let value = value.to_string();
    assert!(
        message.starts_with("fmi2SetReal: ") && message.contains("allowed is"),
        "{message}"
    );
    assert!(message.contains(name) && message.contains(&value), "{message}");
    assert_eq!(client.get(name).to_bits(), before.to_bits());
}

#[test]
fn real_values_outside_their_range_are_discarded_in_initialization() {
    let api = Api::load();
    let client = Client::initializing(&api);
    for row in variables() {
        let Kind::Real {
            minimum: Some(minimum),
            maximum: Some(maximum),
            ..
        } = row.kind
        else {
            continue;
        };
        if matches!(row.causality, Causality::Input | Causality::Parameter) {
            let beyond = [minimum - minimum.abs().max(1.0) * 1e-3, maximum + maximum.abs() * 1e-3];
            for value in NOT_FINITE.into_iter().chain(beyond) {
                expect_discard(&client, &row.name, value);
            }
        }
    }
    client.expect(OK, client.exit());
    client.expect(OK, client.step(0.0, 1e-3));
}

#[test]
fn inputs_outside_their_range_are_discarded_while_running() {
    let api = Api::load();
    let client = Client::running(&api, &[("largest_load", 1e5)]);
    for name in [
        "wheel_speed",
        "normal_load",
        "creepage",
        "vehicle_speed",
        "friction_scale",
        "ambient_temperature",
        "incoming_temperature",
        "incoming_wear_depth",
        "lateral_creepage",
        "spin_creepage",
        "lateral_speed",
        "spin_rate",
    ] {
        for value in NOT_FINITE {
            expect_discard(&client, name, value);
        }
    }
    let fastest = Parameters::default().largest_speed();
    for (name, value) in [
        ("normal_load", -1.0),
        ("normal_load", 1.000001e5),
        ("creepage", -1.0),
        ("vehicle_speed", 1.01 * fastest),
        ("vehicle_speed", -1.01 * fastest),
        ("friction_scale", -1e-9),
        ("ambient_temperature", 0.0),
        ("incoming_temperature", 0.0),
        ("incoming_wear_depth", -1e-9),
    ] {
        expect_discard(&client, name, value);
    }
    // The wheel's speed is within its own range, the rolling speed that it makes is not.
    let before = client.get("wheel_speed");
    client.expect(DISCARD, client.set(&[("wheel_speed", 1.01 * fastest / 0.46)]));
    assert!(client.last_message().contains("rolling speed"));
    assert_eq!(client.get("wheel_speed"), before);

    let untouched = Client::running(&api, &[("largest_load", 1e5)]);
    client.expect(OK, client.step(0.0, 1e-3));
    untouched.expect(OK, untouched.step(0.0, 1e-3));
    assert_eq!(client.outputs(), untouched.outputs());
}

/// Lateral and spin motion of a line contact: a value that cannot be while running, and a combination with contact_model before,
/// where that may still follow.
#[test]
fn a_line_contact_takes_no_lateral_and_no_spin_motion() {
    let api = Api::load();
    let names = ["lateral_creepage", "spin_creepage", "lateral_speed", "spin_rate"];
    let running = Client::running(&api, &[]);
    let refused = |client: &Client, call: &str, name: &str, value: f64| {
        let message = client.last_message();
        for part in [
            call,
            &format!("{name} = {value}"),
            "contact_model = 1 (line)",
            "contact_model = 2",
        ] {
            assert!(message.contains(part), "{message} lacks {part}");
        }
    };
    for name in names {
        running.expect(DISCARD, running.set(&[("creepage", 0.01), (name, 0.002)]));
        refused(&running, "fmi2SetReal", name, 0.002);
        assert_eq!((running.get(name), running.get("creepage")), (0.0, 0.0));

        let starting = Client::initializing(&api);
        starting.expect(OK, starting.set(&[(name, 0.002)]));
        starting.expect(ERROR, starting.exit());
        refused(&starting, "fmi2ExitInitializationMode", name, 0.002);
    }
    // A rate takes the input there within the step, of which nothing is committed.
    let before = running.outputs();
    running.expect(OK, running.set_rates(&[("lateral_creepage", 1, 1.0)]));
    running.expect(ERROR, running.step(0.0, 1e-3));
    refused(&running, "fmi2DoStep", "lateral_creepage", 1e-3);
    assert_eq!(running.outputs(), before);
}

#[test]
fn integer_values_outside_their_range_are_discarded() {
    let api = Api::load();
    let client = Client::initializing(&api);
    for row in variables() {
        let (
            Kind::Integer {
                minimum: Some(minimum),
                maximum: Some(maximum),
                ..
            },
            Causality::Parameter,
        ) = (row.kind, row.causality)
        else {
            continue;
        };
        for value in [minimum - 1, maximum + 1, i32::MIN, i32::MAX] {
            client.expect(DISCARD, client.set_integers(&[(&row.name, value)]));
            let message = client.last_message();
            assert!(
                message.contains(&row.name) && message.contains(&value.to_string()),
                "{message}"
            );
        }
    }
    client.expect(OK, client.exit());
}

#[test]
fn a_vector_is_set_as_a_whole_or_not_at_all() {
    let api = Api::load();
    let client = Client::initializing(&api);
    let before = client.get("wheel_speed");
    client.expect(
        DISCARD,
        client.set(&[("wheel_speed", 1.0), ("friction_cold", 0.3), ("normal_load", f64::NAN)]),
    );
    assert_eq!((client.get("wheel_speed"), client.get("friction_cold")), (before, 0.45));
    client.expect(DISCARD, client.set_integers(&[("friction_law", 1), ("control", 3)]));
    let mut value = 0;
    // SAFETY: one element.
    client.expect(OK, unsafe {
        (api.get_integer)(client.component, &reference("friction_law"), 1, &mut value)
    });
    assert_eq!(value, 2);
    // A larger load is allowed together with a larger largest load, in either order.
    client.expect(OK, client.set(&[("normal_load", 1.5e5), ("largest_load", 2e5)]));
    client.expect(OK, client.exit());
}

#[test]
fn only_inputs_and_tunable_parameters_are_set_while_running() {
    let api = Api::load();
    for row in variables() {
        let client = Client::running(&api, &[]);
        let settable = row.causality == Causality::Input || row.variability == Variability::Tunable;
        match row.kind {
            Kind::Real { start, .. } => {
                let status = client.set(&[(&row.name, start.unwrap_or(0.0))]);
                client.expect(if settable { OK } else { ERROR }, status);
            }
            Kind::Integer { start, .. } => {
                client.expect(ERROR, client.set_integers(&[(&row.name, start.unwrap_or(0))]));
            }
        }
        if !settable {
            let message = client.last_message();
            assert!(message.contains(&row.name) && message.contains("tunable"), "{message}");
        }
    }
}

#[test]
fn outputs_and_locals_are_never_set() {
    let api = Api::load();
    for name in [
        "traction_force",
        "profile.pressure[31]",
        "depth.z[1]",
        "solver.residual",
    ] {
        let client = Client::initializing(&api);
        client.expect(ERROR, client.set(&[(name, 0.0)]));
        assert!(client.last_message().contains(name));
    }
}

#[test]
fn a_combination_that_cannot_be_is_an_error_at_the_end_of_the_initialization() {
    let api = Api::load();
    let cases: [(&[(&str, f64)], &str); 6] = [
        (&[("friction_hot", 0.5)], "friction_hot"),
        (&[("friction_temperature_hot", 323.0)], "friction_temperature_hot"),
        (&[("largest_load", 5e4)], "normal_load"),
        (&[("largest_load", 1e7)], "largest_load"),
        (
            &[("strip_half_length", 0.1), ("largest_load", 1e6), ("normal_load", 1e5)],
            "strip_half_length",
        ),
        (&[("wheel_radius", 5.0)], "rolling speed"),
    ];
    for (values, name) in cases {
        let client = Client::initializing(&api);
        if name == "rolling speed" {
            client.expect(OK, client.set(&[("wheel_speed", 200.0)]));
        }
        client.expect(OK, client.set(values));
        client.expect(ERROR, client.exit());
        let message = client.last_message();
        assert!(
            message.starts_with("fmi2ExitInitializationMode: ") && message.contains(name),
            "{message}"
        );
    }
    // The points of a table must ascend, where the table is used.
    let client = Client::initializing(&api);
    client.expect(
        OK,
        client.set_integers(&[("friction_law", 4), ("friction_table_points", 3)]),
    );
    client.expect(OK, client.set(&[("friction_table.temperature[3]", 300.0)]));
    client.expect(ERROR, client.exit());
    assert!(client.last_message().contains("friction_table.temperature"));
}

#[test]
fn a_tunable_parameter_acts_from_the_next_step_on() {
    let api = Api::load();
    let client = Client::running(&api, &[("creepage", 0.05)]);
    client.expect(OK, client.step(0.0, 0.01));
    let before = client.get("traction_coefficient");
    client.expect(OK, client.set(&[("friction_cold", 0.3)]));
    client.expect(OK, client.step(0.01, 0.01));
    let after = client.get("traction_coefficient");
    assert!(before > 0.35 && after < 0.3, "{before} {after}");
    // A combination that cannot be is a value that cannot be: discarded.
    client.expect(DISCARD, client.set(&[("friction_cold", 0.1)]));
    assert!(client.last_message().contains("friction_hot"));
    assert_eq!(client.get("friction_cold"), 0.3);
    client.expect(OK, client.set(&[("friction_cold", 0.1), ("friction_hot", 0.1)]));
    client.expect(OK, client.step(0.02, 0.01));
    assert!(client.get("traction_coefficient") < 0.11);
}

#[test]
fn outputs_follow_the_inputs_in_initialization() {
    let api = Api::load();
    let client = Client::initializing(&api);
    client.expect(OK, client.set(&[("normal_load", 3e4)]));
    let light = client.get("peak_pressure");
    client.expect(OK, client.set(&[("normal_load", 6e4)]));
    let heavy = client.get("peak_pressure");
    assert!((heavy / light - 2.0_f64.sqrt()).abs() < 0.05, "{heavy} {light}");
    client.expect(OK, client.exit());
    assert_eq!(client.get("peak_pressure"), heavy);
}

#[test]
fn a_lifted_wheel_is_no_error() {
    let api = Api::load();
    let client = Client::running(&api, &[("normal_load", 0.0)]);
    for step in 0..5 {
        client.expect(OK, client.step(0.01 * f64::from(step), 0.01));
    }
    for name in [
        "traction_force",
        "friction_torque",
        "friction_power",
        "contact_length",
        "peak_pressure",
    ] {
        assert_eq!(client.get(name), 0.0, "{name}");
    }
}

#[test]
fn reset_brings_back_the_start_values() {
    let api = Api::load();
    let client = Client::running(
        &api,
        &[("friction_cold", 0.3), ("normal_load", 1e4), ("creepage", 0.01)],
    );
    client.expect(OK, client.step(0.0, 0.1));
    client.expect(OK, client.reset());
    client.expect(OK, client.setup(0.0, None));
    client.expect(OK, client.enter());
    for row in variables() {
        if let Kind::Real { start: Some(start), .. } = row.kind {
            assert_eq!(client.get(&row.name), start, "{}", row.name);
        }
    }
    client.expect(OK, client.exit());
    assert_eq!(client.get("worn_volume"), 0.0);
    assert!(matches!(
        find("contact_nodes").kind,
        Kind::Integer { start: Some(51), .. }
    ));
    let fresh = Client::new(&api);
    fresh.expect(OK, fresh.setup(0.0, None));
    fresh.expect(OK, fresh.enter());
    fresh.expect(OK, fresh.exit());
    client.expect(OK, client.step(0.0, 0.01));
    fresh.expect(OK, fresh.step(0.0, 0.01));
    assert_eq!(client.outputs(), fresh.outputs());
}
