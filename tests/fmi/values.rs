//! Who is to blame decides the status: a value is discarded, a call or a combination is an error.

use super::importer::{
    Client, DISCARD, ERROR, Fmi2, Fmi3, Line, OK, Patch, Profiles, find, with_each, with_each_standard,
};
use std::ffi::c_int;
use wheelrail::fmi2::variables::{Causality, Kind, Variability, variables};
use wheelrail::fmi3::references::Type;
use wheelrail::parameters::Parameters;
use wheelrail::signals::INPUTS;

const NOT_FINITE: [f64; 3] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY];

/// The name of an array without an index, which FMI 3.0 sets as a whole.
fn base(name: &str) -> &str {
    name.split_once('[').map_or(name, |(base, _)| base)
}

/// A value that cannot be is discarded by a message that names variable, value and range; the old one stays.
#[track_caller]
fn expect_discard(client: &Client, name: &str, value: f64, (minimum, maximum): (f64, f64)) {
    let before = client.get(name);
    client.expect(DISCARD, client.set(&[(name, value)]));
    let message = client.last_message();
    let function = client.api.standard.function("SetReal");
    let expected = format!("{function}: {name} = {value}: allowed is {minimum} to {maximum}");
    let rest = message.strip_prefix(&expected);
    // A unit where there is one, and which parameters set the range.
    assert!(
        rest.is_some_and(|rest| rest.is_empty() || rest.starts_with([' ', ';'])),
        "{message}"
    );
    assert_eq!(client.get(name).to_bits(), before.to_bits());
}

#[test]
fn real_values_outside_their_range_are_discarded_in_initialization() {
    with_each(|api, contact| {
        let client = Client::initializing(api, contact);
        for row in variables() {
            let Kind::Real {
                minimum: Some(minimum),
                maximum: Some(maximum),
                ..
            } = row.kind
            else {
                continue;
            };
            // Parameters narrow the range of an input.
            let input = INPUTS.iter().find(|signal| signal.name == row.name);
            let range = input.map_or((minimum, maximum), |signal| signal.range(&Parameters::default()));
            if matches!(row.causality, Causality::Input | Causality::Parameter) {
                let beyond = [minimum - minimum.abs().max(1.0) * 1e-3, maximum + maximum.abs() * 1e-3];
                for value in NOT_FINITE.into_iter().chain(beyond) {
                    expect_discard(&client, &row.name, value, range);
                }
            }
        }
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 1e-3));
    });
}

#[test]
fn inputs_outside_their_range_are_discarded_while_running() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("largest_load", 1e5)]);
        let parameters = Parameters {
            largest_load: 1e5,
            ..Parameters::default()
        };
        for signal in INPUTS {
            let range = signal.range(&parameters);
            let beyond = |limit: f64, sign: f64| limit + sign * 1e-6 * limit.abs().max(1e-3);
            let outside = [beyond(range.0, -1.0), beyond(range.1, 1.0)];
            for value in NOT_FINITE.into_iter().chain(outside) {
                expect_discard(&client, signal.name, value, range);
            }
        }
        // A constant at its limit that an importer has interpolated.
        client.expect(OK, client.set(&[("normal_load", 1e5_f64.next_up().next_up())]));
        assert_eq!(client.get("normal_load"), 1e5);
        client.expect(OK, client.set(&[("normal_load", 60e3)]));
        // The wheel's speed is within its own range, the rolling speed that it makes is not.
        let (before, fastest) = (client.get("wheel_speed"), parameters.largest_speed());
        client.expect(DISCARD, client.set(&[("wheel_speed", 1.01 * fastest / 0.46)]));
        assert!(client.last_message().contains("rolling speed"));
        assert_eq!(client.get("wheel_speed"), before);

        let untouched = Client::running(api, contact, &[("largest_load", 1e5)]);
        client.expect(OK, client.step(0.0, 1e-3));
        untouched.expect(OK, untouched.step(0.0, 1e-3));
        assert_eq!(client.outputs(), untouched.outputs());
    });
}

/// Motion that a line contact does not take: a value that cannot be while running, and a combination with contact_model before,
/// where that may still follow.
#[test]
fn a_line_contact_takes_no_lateral_and_no_spin_motion_and_no_position() {
    with_each_standard(|api| {
        let names = [
            ("lateral_creepage", "= 2 (patch)"),
            ("spin_creepage", "= 2 (patch)"),
            ("lateral_speed", "= 2 (patch) and 3 (profiles)"),
            ("spin_rate", "= 2 (patch)"),
            ("yaw_angle", "= 3 (profiles)"),
            ("rail_roll_angle", "= 3 (profiles)"),
        ];
        let running = Client::running(api, Line, &[]);
        let refused = |client: &Client, call: &str, name: &str, value: f64, taker: &str| {
            let message = client.last_message();
            for part in [
                call,
                &format!("{name} = {value}"),
                "contact_model = 1 (line)",
                &format!("contact_model {taker}"),
            ] {
                assert!(message.contains(part), "{message} lacks {part}");
            }
        };
        for (name, taker) in names {
            running.expect(DISCARD, running.set(&[("creepage", 0.01), (name, 0.002)]));
            refused(&running, &api.standard.function("SetReal"), name, 0.002, taker);
            assert_eq!((running.get(name), running.get("creepage")), (0.0, 0.0));

            let starting = Client::initializing(api, Line);
            starting.expect(OK, starting.set(&[(name, 0.002)]));
            starting.expect(ERROR, starting.exit());
            let exit = api.standard.function("ExitInitializationMode");
            refused(&starting, &exit, name, 0.002, taker);
        }
        if !api.takes_rates() {
            return;
        }
        // A rate takes the input there within the step, of which nothing is committed.
        let before = running.outputs();
        running.expect(OK, running.set_rates(&[("lateral_creepage", 1, 1.0)]));
        running.expect(ERROR, running.step(0.0, 1e-3));
        let step = api.standard.function("DoStep");
        refused(&running, &step, "lateral_creepage", 1e-3, "= 2 (patch)");
        assert_eq!(running.outputs(), before);
    });
}

#[test]
fn integer_values_outside_their_range_are_discarded() {
    with_each(|api, contact| {
        // Lengths of arrays are not set after the initialisation has begun in FMI 3.0.
        let client = match api.standard {
            Fmi2 => Client::initializing(api, contact),
            Fmi3 => Client::coarse(api, contact),
        };
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
            let kind = api.standard.find(&row.name).0.kind;
            if kind == Type::Boolean {
                continue;
            }
            for value in [minimum - 1, maximum + 1, i32::MIN, i32::MAX] {
                client.expect(DISCARD, client.set_integers(&[(&row.name, value)]));
                let message = client.last_message();
                // A length is never negative.
                let told = kind == Type::UInt64 && value < 0 || message.contains(&value.to_string());
                assert!(message.contains(&row.name) && told, "{message}");
            }
        }
        if api.standard == Fmi3 {
            client.expect(OK, client.begin(0.0, None));
        }
        client.expect(OK, client.exit());
    });
}

#[test]
fn a_vector_is_set_as_a_whole_or_not_at_all() {
    with_each(|api, contact| {
        let client = Client::initializing(api, contact);
        let before = client.get("wheel_speed");
        client.expect(
            DISCARD,
            client.set(&[("wheel_speed", 1.0), ("friction_cold", 0.3), ("normal_load", f64::NAN)]),
        );
        assert_eq!((client.get("wheel_speed"), client.get("friction_cold")), (before, 0.45));
        client.expect(DISCARD, client.set_integers(&[("friction_law", 1), ("control", 4)]));
        assert_eq!(client.get_integer("friction_law"), 2);
        // A larger load is allowed together with a larger largest load, in either order.
        client.expect(OK, client.set(&[("normal_load", 1.5e5), ("largest_load", 2e5)]));
        client.expect(OK, client.exit());
    });
}

#[test]
fn only_inputs_and_tunable_parameters_are_set_while_running() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[]);
        let running = client.save();
        for row in variables() {
            let settable = row.causality == Causality::Input || row.variability == Variability::Tunable;
            match row.kind {
                Kind::Real { start, .. } => {
                    let status = client.set(&[(&row.name, start.unwrap_or(0.0))]);
                    client.expect(if settable { OK } else { ERROR }, status);
                }
                Kind::Integer { start, .. } => {
                    client.expect(ERROR, client.set_integers(&[(&row.name, start.unwrap_or(0))]));
                }
                Kind::Text { .. } => client.expect(ERROR, client.set_text(&row.name, c"60E2")),
            }
            if !settable {
                let message = client.last_message();
                let name = base(&row.name);
                let told = match api.standard.find(&row.name).0.kind {
                    Type::UInt64 => message.contains("not allowed in state Step Mode"),
                    _ => message.contains(name) && message.contains("tunable"),
                };
                assert!(told, "{message}");
                // Out of *error*.
                client.expect(OK, client.restore(running));
            }
        }
    });
}

#[test]
fn outputs_and_locals_are_never_set() {
    with_each(|api, contact| {
        for name in [
            "traction_force",
            "profile.pressure[31]",
            "depth.z[1]",
            "solver.residual",
        ] {
            let client = Client::initializing(api, contact);
            client.expect(ERROR, client.set(&[(name, 0.0)]));
            assert!(client.last_message().contains(base(name)));
        }
    });
}

/// Integer and Real parameters, and what the message about them names.
type Case = (
    &'static [(&'static str, c_int)],
    &'static [(&'static str, f64)],
    &'static str,
);

#[test]
fn a_combination_that_cannot_be_is_an_error_at_the_end_of_the_initialization() {
    with_each(|api, contact| {
        let common: &[Case] = &[
            (&[], &[("friction_hot", 0.5)], "friction_hot"),
            (&[], &[("friction_temperature_hot", 323.0)], "friction_temperature_hot"),
            (&[], &[("largest_load", 5e4)], "normal_load"),
            (
                &[],
                &[("strip_half_length", 0.1), ("largest_load", 1e6), ("normal_load", 1e5)],
                "strip_half_length",
            ),
            (&[], &[("wheel_speed", 200.0), ("wheel_radius", 5.0)], "rolling speed"),
            (&[("contact_model", 1), ("control", 3)], &[], "control = 3"),
            (
                &[("contact_model", 1), ("patch_geometry", 2)],
                &[],
                "patch_geometry = 2",
            ),
            (&[("contact_model", 3), ("slip_source", 1)], &[], "slip_source = 1"),
            (
                &[("contact_model", 3), ("slip_source", 2), ("control", 2)],
                &[],
                "control = 2",
            ),
            (
                &[("contact_model", 3), ("slip_source", 2)],
                &[("spin_rate", 0.1)],
                "spin_rate = 0.1",
            ),
            (&[], &[("lateral_displacement", 1e-3)], "lateral_displacement = 0.001"),
        ];
        let own: &[Case] = match contact {
            Line => &[(&[], &[("largest_load", 1e7)], "largest_load")],
            Patch | Profiles => &[
                (
                    &[],
                    &[("rail_transverse_curvature", -1.0)],
                    "rail_transverse_curvature = -1",
                ),
                (
                    &[],
                    &[("wheel_transverse_curvature", -5.0)],
                    "wheel_transverse_curvature = -5",
                ),
                (&[("mesh", 2)], &[], "mesh = 2"),
                (&[("normal_solver", 2)], &[], "normal_solver = 2"),
                (&[], &[("wheel_radius", 0.05), ("largest_load", 1e6)], "largest_load"),
            ],
        };
        for (integers, values, name) in common.iter().chain(own) {
            let client = Client::initializing(api, contact);
            client.expect(OK, client.set_integers(integers));
            for value in *values {
                client.expect(OK, client.set(&[*value]));
            }
            client.expect(ERROR, client.exit());
            let message = client.last_message();
            let function = api.standard.function("ExitInitializationMode: ");
            assert!(message.starts_with(&function) && message.contains(name), "{message}");
        }
        // The points of a table must ascend, where the table is used.
        let client = Client::initializing(api, contact);
        client.expect(
            OK,
            client.set_integers(&[("friction_law", 4), ("friction_table_points", 3)]),
        );
        client.expect(OK, client.set(&[("friction_table.temperature[3]", 300.0)]));
        client.expect(ERROR, client.exit());
        assert!(client.last_message().contains("friction_table.temperature"));
    });
}

#[test]
fn a_tunable_parameter_acts_from_the_next_step_on() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("creepage", 0.05)]);
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
    });
}

#[test]
fn outputs_follow_the_inputs_in_initialization() {
    with_each(|api, contact| {
        let client = Client::initializing(api, contact);
        client.expect(OK, client.set(&[("normal_load", 3e4)]));
        let light = client.get("peak_pressure");
        client.expect(OK, client.set(&[("normal_load", 6e4)]));
        let heavy = client.get("peak_pressure");
        // Hertz, of a line and of an ellipse.
        let expected: f64 = match contact {
            Line => 2.0_f64.sqrt(),
            Patch | Profiles => 2.0_f64.cbrt(),
        };
        assert!((heavy / light - expected).abs() < 0.05, "{heavy} {light}");
        client.expect(OK, client.exit());
        assert_eq!(client.get("peak_pressure"), heavy);
    });
}

#[test]
fn a_lifted_wheel_is_no_error() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &[("normal_load", 0.0)]);
        for step in 0..5 {
            client.expect(OK, client.step(0.01 * f64::from(step), 0.01));
        }
        for name in [
            "traction_force",
            "friction_torque",
            "friction_power",
            "contact_length",
            "peak_pressure",
            "lateral_force",
            "spin_moment",
            "contact_area",
        ] {
            assert_eq!(client.get(name), 0.0, "{name}");
        }
    });
}

#[test]
fn reset_brings_back_the_start_values() {
    with_each(|api, contact| {
        let client = Client::running(
            api,
            contact,
            &[("friction_cold", 0.3), ("normal_load", 1e4), ("creepage", 0.01)],
        );
        client.expect(OK, client.step(0.0, 0.1));
        client.expect(OK, client.reset());
        client.expect(OK, client.begin(0.0, None));
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
        let fresh = Client::new(api);
        fresh.start();
        client.expect(OK, client.step(0.0, 0.01));
        fresh.expect(OK, fresh.step(0.0, 0.01));
        assert_eq!(client.outputs(), fresh.outputs());
    });
}
