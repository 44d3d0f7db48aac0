//! The two standards are two doors to one component: the same bits for the same drive, the same bytes of a saved state, and a
//! state that is saved by one goes on by the other.

use super::importer::{
    Api, Client, ContactModel, Fmi2, Fmi3, OK, Patch, Standard, coarse, sideways, with_each_contact_model,
};
use std::ptr::null_mut;
use wheelrail::wheel_rail::{DEPTH_POINTS, PROFILE_POINTS};

const START: [(&str, f64); 3] = [
    ("creepage", 0.004),
    ("friction_temperature_cold", 310.0),
    ("friction_table.coefficient[2]", 0.25),
];

/// Parameters of every type that FMI 3.0 has for them.
const CHOSEN: [(&str, i32); 4] = [
    ("friction_law", 3),
    ("wheel_heating", 2),
    ("friction_table_points", 3),
    ("slip_source", 1),
];

fn initializing(api: &Api, contact: ContactModel) -> Client<'_> {
    let mut client = Client::new(api);
    client.contact = contact;
    client.expect(OK, client.set_integers(coarse(contact)));
    client.expect(OK, client.set_integers(&CHOSEN));
    client.expect(OK, client.set(&START));
    client.expect(OK, client.set(sideways(contact)));
    client.expect(OK, client.begin(0.0, Some(10.0)));
    client
}

fn running(api: &Api, contact: ContactModel) -> Client<'_> {
    let client = initializing(api, contact);
    client.expect(OK, client.exit());
    client
}

/// Ten steps with moving inputs; the outputs after each as bits.
fn drive(client: &Client, from: u32) -> Vec<Vec<u64>> {
    (from..from + 10)
        .map(|step| {
            let t = 0.01 * f64::from(step);
            let load = if step % 7 == 3 {
                0.0
            } else {
                6e4 + 2e4 * (20.0 * t).sin()
            };
            client.expect(
                OK,
                client.set(&[
                    ("normal_load", load),
                    ("creepage", 0.1 * t),
                    ("friction_cold", 0.45 - 0.3 * t),
                ]),
            );
            if client.contact == Patch {
                client.expect(
                    OK,
                    client.set(&[("lateral_creepage", 0.05 * t), ("spin_creepage", 0.3 - t)]),
                );
            }
            client.expect(OK, client.step(t, 0.01));
            client.outputs()
        })
        .collect()
}

/// All that is plotted, as bits.
fn plots(client: &Client) -> Vec<u64> {
    let lengths = [
        ("profile.pressure", PROFILE_POINTS),
        ("profile.temperature", PROFILE_POINTS),
        ("depth.temperature", DEPTH_POINTS),
    ];
    let mut bits = Vec::new();
    for (name, length) in lengths {
        let mut values = vec![f64::NAN; length];
        client.expect(OK, client.get_references(&client.api.array(name, length), &mut values));
        bits.extend(values.into_iter().map(f64::to_bits));
    }
    bits
}

fn bytes(client: &Client) -> Vec<u8> {
    client.serialize(client.save())
}

#[test]
fn the_same_drive_has_the_same_bits_and_its_states_the_same_bytes() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    with_each_contact_model(&two, |two, contact| {
        let [first, second] = [two, &three].map(|api| initializing(api, contact));
        assert_eq!(bytes(&first), bytes(&second), "initializing");
        for client in [&first, &second] {
            client.expect(OK, client.exit());
        }
        assert_eq!(bytes(&first), bytes(&second), "initialized");
        for from in [0, 10, 20] {
            assert_eq!(drive(&first, from), drive(&second, from));
            assert_eq!(plots(&first), plots(&second));
            assert_eq!(
                first.get_integer("solver.iterations"),
                second.get_integer("solver.iterations")
            );
            assert_eq!(bytes(&first), bytes(&second), "after {} steps", from + 10);
        }
        for client in [&first, &second] {
            client.expect(OK, client.terminate());
        }
        assert_eq!(bytes(&first), bytes(&second), "terminated");
    });
}

#[test]
fn a_state_goes_on_by_the_other_standard_with_the_same_bits() {
    let apis = Standard::ALL.map(Api::load);
    with_each_contact_model(&apis[0], |_, contact| {
        for (one, other) in [(0, 1), (1, 0)] {
            let client = running(&apis[one], contact);
            drive(&client, 0);
            let saved = bytes(&client);
            let expected = drive(&client, 10);
            let heir = running(&apis[other], contact);
            let mut handle = null_mut();
            heir.expect(OK, heir.deserialize(&saved, &mut handle));
            heir.expect(OK, heir.restore(handle));
            assert_eq!(heir.serialize(handle), saved);
            assert_eq!(drive(&heir, 10), expected);
            // And back again, at another time.
            heir.expect(OK, heir.restore(handle));
            let saved = bytes(&heir);
            let mut back = null_mut();
            client.expect(OK, client.deserialize(&saved, &mut back));
            client.expect(OK, client.restore(back));
            assert_eq!(drive(&client, 10), expected);
        }
    });
}

/// States that only one standard has a name for: *stepFailed* is *Terminated* by FMI 3.0 (states.rs), *Configuration Mode* is
/// *instantiated* by FMI 2.0.
#[test]
fn a_state_of_configuration_mode_is_instantiated_by_fmi2() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    with_each_contact_model(&two, |two, contact| {
        let configuring = Client::coarse(&three, contact);
        // SAFETY: a live instance.
        configuring.expect(OK, unsafe {
            (three.fmi3.fmi3EnterConfigurationMode)(configuring.component)
        });
        let client = Client::coarse(two, contact);
        let mut handle = null_mut();
        client.expect(OK, client.deserialize(&bytes(&configuring), &mut handle));
        client.expect(OK, client.restore(handle));
        client.start();
        client.expect(OK, client.step(0.0, 0.01));
    });
}

/// Rates of change of inputs, which FMI 3.0 cannot set, are in force in a state of FMI 2.0 all the same.
#[test]
fn rates_of_a_state_of_fmi2_act_in_the_next_step() {
    let [two, three] = [Fmi2, Fmi3].map(Api::load);
    with_each_contact_model(&two, |two, contact| {
        let client = running(two, contact);
        client.expect(OK, client.set_rates(&[("normal_load", 1, 1e6)]));
        let heir = running(&three, contact);
        let mut handle = null_mut();
        heir.expect(OK, heir.deserialize(&bytes(&client), &mut handle));
        heir.expect(OK, heir.restore(handle));
        for client in [&client, &heir] {
            client.expect(OK, client.step(0.0, 0.01));
        }
        assert_eq!(client.outputs(), heir.outputs());
        assert_eq!(drive(&client, 1), drive(&heir, 1));
    });
}
