//! Saved states: the same bits again, and nothing that was tampered with is accepted.

use super::importer::{
    Api, Client, ContactModel, ERROR, Fmi2, Fmi3, Handle, Line, OK, Patch, Profiles, coarse, sideways, with_each,
};
use std::ffi::c_int;
use std::ptr::{dangling_mut, null_mut};

const START: [(&str, f64); 2] = [("creepage", 0.004), ("friction_temperature_cold", 310.0)];

/// What is tried at every byte of a state takes the longer the more bytes it has.
const FEW_CELLS: &[(&str, c_int)] = &[("patch_nodes", 8), ("patch_strips", 3)];

fn running_with_few_cells(api: &Api, contact: ContactModel) -> Client<'_> {
    let client = Client::coarse(api, contact);
    client.expect(OK, client.set_integers(FEW_CELLS));
    client.expect(OK, client.set(&START));
    client.expect(OK, client.set(sideways(contact)));
    client.start();
    client
}

/// Ten steps with moving inputs; the outputs after each as bits.
fn drive(client: &Client, from: u32) -> Vec<Vec<u64>> {
    (from..from + 10)
        .map(|step| {
            let t = 0.01 * f64::from(step);
            client.expect(
                OK,
                client.set(&[("normal_load", 6e4 + 2e4 * (20.0 * t).sin()), ("creepage", 0.1 * t)]),
            );
            if client.api.takes_rates() {
                client.expect(OK, client.set_rates(&[("normal_load", 1, 4e5 * (20.0 * t).cos())]));
            }
            if client.contact == Patch {
                client.expect(
                    OK,
                    client.set(&[("lateral_creepage", 0.05 * t), ("spin_creepage", 0.3 - t)]),
                );
            }
            if client.contact == Patch && client.api.takes_rates() {
                client.expect(
                    OK,
                    client.set_rates(&[("lateral_creepage", 1, 0.05), ("spin_creepage", 1, -1.0)]),
                );
            }
            client.expect(OK, client.step(t, 0.01));
            client.outputs()
        })
        .collect()
}

#[test]
fn restoring_and_repeating_gives_the_same_bits() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        drive(&client, 0);
        let handle = client.save();
        let first = drive(&client, 10);
        drive(&client, 20);
        client.expect(OK, client.restore(handle));
        assert_eq!(drive(&client, 10), first);
        // Saving does not disturb, and a state can be restored more than once.
        client.expect(OK, client.restore(handle));
        client.save();
        assert_eq!(drive(&client, 10), first);
    });
}

/// The wheel's temperature and wear and what comes in with the rail are part of the state.
#[test]
fn the_wheel_and_the_incoming_rail_are_restored() {
    with_each(|api, contact| {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.set_integers(&[("wheel", 2), ("wheel_heating", 2)]));
        client.expect(
            OK,
            client.set(&[
                ("strip_half_length", 0.2),
                ("rim_depth", 1e-3),
                ("wheel_wear_coefficient", 1e-12),
                ("incoming_temperature", 320.0),
                ("incoming_wear_depth", 1e-6),
            ]),
        );
        client.start();
        drive(&client, 0);
        let handle = client.save();
        let wheel = client.get("wheel_temperature");
        let first = drive(&client, 10);
        assert!(wheel > 293.16 && client.get("wheel_temperature") > wheel);
        assert!(client.get("wheel_wear_depth") > 0.0 && client.get("leaving_temperature") > 300.0);
        client.expect(OK, client.set(&[("incoming_temperature", 300.0)]));
        client.expect(OK, client.restore(handle));
        assert_eq!(client.get("wheel_temperature"), wheel);
        assert_eq!(drive(&client, 10), first);
    });
}

#[test]
fn a_state_holds_inputs_tunable_parameters_rates_time_and_mode() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        client.expect(OK, client.step(0.0, 0.01));
        client.expect(OK, client.set(&[("normal_load", 5e4), ("friction_cold", 0.4)]));
        if api.takes_rates() {
            client.expect(OK, client.set_rates(&[("normal_load", 1, 1e6)]));
        }
        let handle = client.save();
        client.expect(OK, client.step(0.01, 0.01));
        let expected = client.outputs();
        client.expect(OK, client.set(&[("normal_load", 1e4), ("friction_cold", 0.3)]));
        client.expect(OK, client.step(0.02, 0.01));
        client.expect(OK, client.terminate());
        client.expect(OK, client.restore(handle));
        assert_eq!((client.get("normal_load"), client.get("friction_cold")), (5e4, 0.4));
        client.expect(OK, client.step(0.01, 0.01));
        assert_eq!(client.outputs(), expected);
    });
}

#[test]
fn every_mode_can_be_saved_and_restored() {
    with_each(|api, contact| {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.set(&[("friction_cold", 0.4)]));
        client.expect(OK, client.set(sideways(contact)));
        let instantiated = client.save();
        client.expect(OK, client.begin(0.0, None));
        let initialization = client.save();
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 0.01));
        let expected = client.outputs();
        client.expect(OK, client.terminate());
        for (handle, enter) in [(instantiated, true), (initialization, false)] {
            client.expect(OK, client.restore(handle));
            if enter {
                client.expect(OK, client.begin(0.0, None));
            }
            client.expect(OK, client.exit());
            client.expect(OK, client.step(0.0, 0.01));
            assert_eq!(client.outputs(), expected);
        }
    });
}

#[test]
fn a_state_leads_out_of_an_error_and_over_a_reset_with_other_parameters() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        drive(&client, 0);
        let handle = client.save();
        let expected = drive(&client, 10);
        client.expect(ERROR, client.step(-1.0, 1.0));
        client.expect(OK, client.restore(handle));
        assert_eq!(drive(&client, 10), expected);
        for other in [Line, Patch] {
            client.expect(OK, client.reset());
            client.expect(OK, client.set_integers(coarse(other)));
            client.expect(OK, client.set_integers(&[("contact_nodes", 31), ("patch_nodes", 16)]));
            client.start();
            client.expect(OK, client.restore(handle));
            assert_eq!(drive(&client, 10), expected);
        }
    });
}

#[test]
fn a_state_that_is_handed_in_is_reused_and_freeing_sets_null() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let mut handle = client.save();
        let before = handle;
        drive(&client, 0);
        // SAFETY: a live instance and a variable.
        unsafe {
            client.expect(OK, api.get_state(client.component, &mut handle));
            assert_eq!(handle, before);
            let expected = drive(&client, 10);
            client.expect(OK, client.restore(handle));
            assert_eq!(drive(&client, 10), expected);
            client.expect(OK, api.free_state(client.component, &mut handle));
            assert!(handle.is_null());
            client.expect(OK, api.free_state(client.component, &mut handle));
        }
    });
}

#[test]
fn a_pointer_that_is_no_state_of_the_instance_is_refused() {
    with_each(|api, contact| {
        let other = Client::running(api, contact, &START);
        let foreign = other.save();
        let freed = {
            let client = Client::running(api, contact, &[]);
            client.save()
        };
        let wild: Handle = dangling_mut::<u64>().cast();
        for handle in [foreign, freed, wild, usize::MAX as Handle] {
            let client = Client::running(api, contact, &START);
            let mut variable = handle;
            // SAFETY: handles are never followed.
            unsafe {
                client.expect(ERROR, client.restore(handle));
                client.expect(ERROR, api.get_state(client.component, &mut variable));
                client.expect(ERROR, api.free_state(client.component, &mut variable));
                client.expect(ERROR, api.serialized_size(client.component, handle, &mut 0));
                client.expect(ERROR, api.serialize(client.component, handle, null_mut(), 0));
            }
            assert_eq!(variable, handle);
            assert!(client.last_message().contains("not a saved state of this instance"));
        }
    });
}

#[test]
fn a_serialized_state_continues_in_another_instance_with_the_same_bits() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        drive(&client, 0);
        let bytes = client.serialize(client.save());
        let expected = drive(&client, 10);
        for running in [false, true] {
            let other = if running {
                Client::running(api, contact, &[])
            } else {
                Client::initializing(api, contact)
            };
            let mut handle = null_mut();
            other.expect(OK, other.deserialize(&bytes, &mut handle));
            other.expect(OK, other.restore(handle));
            assert_eq!(other.serialize(handle), bytes, "serialized again, the same bytes");
            assert_eq!(drive(&other, 10), expected);
        }
    });
}

#[test]
fn deserializing_does_not_disturb_the_simulation() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let bytes = client.serialize(client.save());
        client.expect(OK, client.set(&[("friction_cold", 0.3)]));
        let other = Client::running(api, contact, &START);
        other.expect(OK, other.set(&[("friction_cold", 0.3)]));
        let mut handle = null_mut();
        client.expect(OK, client.deserialize(&bytes, &mut handle));
        assert_eq!(drive(&client, 0), drive(&other, 0));
    });
}

#[test]
fn every_flipped_byte_every_truncation_and_every_extension_is_refused() {
    with_each(|api, contact| {
        let client = running_with_few_cells(api, contact);
        drive(&client, 0);
        let bytes = client.serialize(client.save());
        println!("a serialized state has {} bytes", bytes.len());
        let mut handle = null_mut();
        let mut refused = 0;
        let mut refuse = |bytes: &[u8], what: &str, at: usize| {
            assert_eq!(client.deserialize(bytes, &mut handle), ERROR, "{what} {at}");
            assert!(handle.is_null());
            assert!(client.last_message().contains("serialized state is refused"));
            refused += 1;
        };
        for at in 0..bytes.len() {
            for mask in [0x01, 0x80, 0xff] {
                let mut flipped = bytes.clone();
                flipped[at] ^= mask;
                refuse(&flipped, "flipped", at);
            }
        }
        for length in 1..bytes.len() {
            refuse(&bytes[..length], "truncated", length);
        }
        refuse(&[&bytes[..], &[0]].concat(), "extended", 1);
        refuse(&[&bytes[..], &bytes[..]].concat(), "doubled", 2);
        println!("{refused} corrupted states refused");
        client.expect(OK, client.deserialize(&bytes, &mut handle));
    });
}

#[test]
fn empty_noisy_and_foreign_bytes_are_refused() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let mut handle = null_mut();
        let mut seed = 1_u64;
        for length in 0..2000 {
            let noise: Vec<u8> = (0..length)
                .map(|_| {
                    // Knuth's MMIX generator.
                    seed = seed
                        .wrapping_mul(6_364_136_223_846_793_005)
                        .wrapping_add(1_442_695_040_888_963_407);
                    (seed >> 56) as u8
                })
                .collect();
            assert_eq!(client.deserialize(&noise, &mut handle), ERROR);
        }
        assert!(handle.is_null());
    });
}

#[test]
fn lies_under_a_right_checksum_are_refused() {
    with_each(|api, contact| {
        let client = running_with_few_cells(api, contact);
        drive(&client, 0);
        let bytes = client.serialize(client.save());
        let mut accepted = 0;
        // A step out of a state with an absurd number in it takes the longest of all: of a patch every eighth byte of a number comes
        // in turn.
        let stride = match contact {
            Line => 1,
            Patch | Profiles => 5,
        };
        // The other standard reads by the same function.
        let stride = match api.standard {
            Fmi2 => stride,
            Fmi3 => 9 * stride,
        };
        for at in (0..bytes.len() - 4).step_by(stride) {
            let mut lie = bytes.clone();
            lie[at] = 0xff;
            let end = lie.len() - 4;
            let checksum = crc32fast::hash(&lie[..end]).to_le_bytes();
            lie[end..].copy_from_slice(&checksum);
            // A changed digit of a number cannot be told from a true state; what is accepted must lead to no crash.
            let mut handle = null_mut();
            let status = client.deserialize(&lie, &mut handle);
            if status == OK {
                accepted += 1;
                if client.restore(handle) == OK {
                    client.step(0.1, 0.01);
                }
            }
            client.expect(OK, client.reset());
            client.make_coarse();
            client.expect(OK, client.set_integers(FEW_CELLS));
            // SAFETY: a state of this instance or null.
            client.expect(OK, unsafe { api.free_state(client.component, &mut handle) });
        }
        println!("{accepted} of {} still were states", (bytes.len() - 4) / stride);
    });
}

#[test]
fn a_state_made_with_other_fixed_parameters_is_refused() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let bytes = client.serialize(client.save());
        let other = Client::running(api, contact, &[("wheel_radius", 0.45)]);
        let mut handle = null_mut();
        let other_model = Client::running(api, if contact == Line { Patch } else { Line }, &[]);
        for other in [other, other_model] {
            other.expect(ERROR, other.deserialize(&bytes, &mut handle));
            assert!(other.last_message().contains("other fixed parameters"));
        }
    });
}

#[test]
fn a_buffer_of_the_wrong_size_is_refused() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let handle = client.save();
        let mut bytes = client.serialize(handle);
        for size in [0, 1, bytes.len() - 1] {
            // SAFETY: room for `size` bytes.
            let status = unsafe { api.serialize(client.component, handle, bytes.as_mut_ptr().cast(), size) };
            client.expect(ERROR, status);
            assert!(client.last_message().contains("size"));
        }
    });
}

#[test]
fn locals_are_those_of_the_restored_state() {
    with_each(|api, contact| {
        let client = Client::running(api, contact, &START);
        let handle = client.save();
        let names: &[&str] = match contact {
            Line => &["profile.temperature[31]"],
            Patch | Profiles => &["profile.temperature[31]", "strip.temperature[11]"],
        };
        let read = || names.iter().map(|name| client.get(name)).collect::<Vec<_>>();
        let cold = read();
        drive(&client, 0);
        assert!(read().iter().zip(&cold).all(|(warm, cold)| warm > cold));
        client.expect(OK, client.restore(handle));
        assert_eq!(read(), cold);
    });
}
