//! Every function is there, and no argument makes it crash: null pointers, unknown value references, absurd sizes.

use super::functions::{Function, of_standard};
use super::importer::{
    Api, Arguments, Client, ERROR, FMI2_FUNCTIONS, FMI3_FUNCTIONS, Fmi2, Fmi3, Journal, Line, OK, RIGHT, Standard,
    callbacks, with_each, with_each_standard,
};
use std::ffi::{CStr, CString, c_int};
use std::ptr::{null, null_mut};

#[test]
fn all_functions_of_the_headers_are_exported() {
    assert_eq!((FMI2_FUNCTIONS.len(), FMI3_FUNCTIONS.len()), (34, 75));
    Api::load(Fmi2);
}

#[test]
fn versions_and_platform_are_those_of_the_standards() {
    let api = Api::load(Fmi2);
    // SAFETY: static strings.
    unsafe {
        assert_eq!(CStr::from_ptr((api.fmi2.fmi2GetVersion)()), c"2.0");
        assert_eq!(CStr::from_ptr((api.fmi2.fmi2GetTypesPlatform)()), c"default");
        assert_eq!(CStr::from_ptr((api.fmi3.fmi3GetVersion)()), c"3.0");
    }
}

#[test]
fn instantiation_is_refused_with_a_reason() {
    with_each_standard(|api| {
        let upper = CString::new(api.standard.token().to_str().unwrap().to_uppercase()).unwrap();
        let wrong = c"{00000000-0000-0000-0000-000000000000}";
        let named = |name: &'static CStr| Arguments {
            name: name.as_ptr(),
            ..RIGHT
        };
        let with_token = |token| Arguments {
            token: Some(token),
            ..RIGHT
        };
        let of_kind = |kind| Arguments { kind, ..RIGHT };
        let no_name = Arguments { name: null(), ..RIGHT };
        let mut cases = vec![
            (no_name, "instanceName"),
            (named(c""), "instanceName"),
            (named(c" \t\n"), "instanceName"),
            (with_token(wrong.as_ptr()), wrong.to_str().unwrap()),
        ];
        let token = match api.standard {
            Fmi2 => {
                cases.extend([(of_kind(0), "fmuType = 0"), (of_kind(77), "fmuType = 77")]);
                "fmuGUID"
            }
            Fmi3 => {
                let with_events = Arguments {
                    event_mode: true,
                    ..RIGHT
                };
                let with_update = Arguments {
                    intermediate_variables: usize::MAX,
                    ..RIGHT
                };
                cases.extend([
                    (
                        of_kind(0),
                        "fmi3InstantiateModelExchange: this is a unit for co-simulation",
                    ),
                    (
                        of_kind(2),
                        "fmi3InstantiateScheduledExecution: this is a unit for co-simulation",
                    ),
                    (with_events, "eventModeUsed = true"),
                    (with_update, "nRequiredIntermediateVariables = "),
                ]);
                "instantiationToken"
            }
        };
        cases.extend([null(), c"".as_ptr(), upper.as_ptr()].map(|pointer| (with_token(pointer), token)));
        for (arguments, reason) in cases {
            let journal = Journal::default();
            let arguments = Arguments {
                journal: Some(&journal),
                logging: 1,
                ..arguments
            };
            assert!(!api.instantiates(&arguments), "{reason}");
            let messages = journal.take();
            assert_eq!(messages.len(), 1);
            assert_eq!(
                (messages[0].status, messages[0].category.as_str()),
                (ERROR, "logStatusError")
            );
            assert!(messages[0].text.contains(reason), "{messages:?}");
        }
    });
}

#[test]
fn every_callback_may_be_null_and_every_resource_location_is_taken() {
    with_each_standard(|api| {
        for location in [
            null(),
            c"".as_ptr(),
            c"file:///a%20b".as_ptr(),
            c"file:/a".as_ptr(),
            c"http://x".as_ptr(),
            c"%%%".as_ptr(),
            c"/tmp/resources/".as_ptr(),
        ] {
            let arguments = Arguments {
                location,
                logging: 1,
                ..RIGHT
            };
            assert!(api.instantiates(&arguments), "{location:?}");
            // Without a logger a failure is silent, not a crash.
            let wrong = Arguments {
                token: Some(null()),
                ..arguments
            };
            assert!(!api.instantiates(&wrong));
        }
    });
}

/// FMI 2.0 hands the callbacks over in a structure.
#[test]
fn callbacks_are_needed_and_copied_as_strings_are() {
    let api = Api::load(Fmi2);
    let (journal, guid) = (Journal::default(), Fmi2.token());
    let mut name = *b"wheel\0";
    let mut structure = callbacks(&journal);
    let instantiate = api.fmi2.fmi2Instantiate;
    // SAFETY: valid pointers; what they point to is overwritten after the call.
    unsafe {
        assert!(instantiate(c"a".as_ptr(), 1, guid.as_ptr(), null(), null(), 0, 1).is_null());
        let component = instantiate(name.as_ptr().cast(), 1, guid.as_ptr(), null(), &structure, 0, 0);
        name.fill(b'?');
        structure.logger = None;
        structure.component_environment = null_mut();
        std::hint::black_box((&name, &structure));
        assert_eq!(api.exit_initialization(component), ERROR);
        api.free_instance(component);
    }
    assert_eq!(journal.take()[0].instance_name, "wheel");
}

/// With right arguments, so that the null instance alone is the error; probes.rs has wrong ones beside it.
#[test]
fn a_null_instance_is_an_error_and_nothing_to_free() {
    with_each_standard(|api| {
        // SAFETY: there is nothing to free.
        unsafe { api.free_instance(null_mut()) };
        for Function { name, call, .. } in of_standard(api.standard) {
            assert_eq!(call(api, null_mut(), null_mut()), ERROR, "{name}");
        }
    });
}

/// The names of arguments in FMI 3.0 of those of FMI 2.0.
fn argument(standard: Standard, name: &'static str) -> &'static str {
    let names = [
        ("argument vr", "argument valueReferences"),
        ("argument value", "argument values"),
        ("vr", "valueReferences"),
        ("value", "values"),
        ("order", "orders"),
        ("vUnknown_ref", "unknowns"),
        ("vKnown_ref", "knowns"),
        ("dvKnown", "seed"),
        ("dvUnknown", "sensitivity"),
    ];
    match (standard, names.iter().find(|(fmi2, _)| *fmi2 == name)) {
        (Fmi3, Some((_, fmi3))) => fmi3,
        _ => name,
    }
}

/// Runs one call on a fresh instance in *stepComplete* and expects fmi2Error with a message that names the argument.
#[track_caller]
pub fn expect_error(api: &Api, reason: &str, call: impl FnOnce(&Client) -> c_int) {
    let client = Client::running(api, Line, &[]);
    client.expect(ERROR, call(&client));
    let message = client.last_message();
    assert!(message.contains(reason), "{message}");
}

/// The same where the argument is a null pointer.
#[track_caller]
pub fn expect_null(api: &Api, name: &'static str, call: impl FnOnce(&Client) -> c_int) {
    expect_error(api, &format!("{} is a null", argument(api.standard, name)), call);
}

#[test]
fn null_pointers_are_errors() {
    with_each_standard(|api| {
        let vr = [api.reference("normal_load")];
        let (order, value) = ([1], [1.0]);
        let (mut real, mut integer) = ([0.0], [0]);
        let (vr, order, value) = (vr.as_ptr(), order.as_ptr(), value.as_ptr());
        let (real, integer) = (real.as_mut_ptr(), integer.as_mut_ptr());
        // SAFETY: null or valid pointers.
        unsafe {
            expect_null(api, "argument vr", |c| api.get_real(c.component, null(), 1, real));
            expect_null(api, "argument value", |c| api.get_real(c.component, vr, 1, null_mut()));
            expect_null(api, "argument vr", |c| api.get_integer(c.component, null(), 1, integer));
            expect_null(api, "argument value", |c| {
                api.get_integer(c.component, vr, 1, null_mut())
            });
            expect_null(api, "argument vr", |c| api.get_boolean(c.component, null(), 1, integer));
            expect_null(api, "argument value", |c| {
                api.get_boolean(c.component, vr, 1, null_mut())
            });
            expect_null(api, "argument vr", |c| {
                api.get_string(c.component, null(), 1, null_mut())
            });
            expect_null(api, "argument vr", |c| api.set_real(c.component, null(), 1, value));
            expect_null(api, "argument value", |c| api.set_real(c.component, vr, 1, null()));
            expect_null(api, "argument vr", |c| api.set_integer(c.component, null(), 1, order));
            expect_null(api, "argument value", |c| api.set_integer(c.component, vr, 1, null()));
            expect_null(api, "argument value", |c| api.set_boolean(c.component, vr, 1, null()));
            expect_null(api, "argument value", |c| api.set_string(c.component, vr, 1, null()));
            expect_null(api, "FMUstate", |c| api.get_state(c.component, null_mut()));
            expect_null(api, "FMUstate", |c| api.set_state(c.component, null_mut()));
            expect_null(api, "FMUstate", |c| api.free_state(c.component, null_mut()));
            expect_null(api, "size", |c| api.serialized_size(c.component, c.save(), null_mut()));
            expect_null(api, "FMUstate", |c| {
                api.serialized_size(c.component, null_mut(), &mut 0)
            });
            expect_null(api, "FMUstate", |c| {
                api.serialize(c.component, null_mut(), null_mut(), 0)
            });
            expect_null(api, "serializedState", |c| {
                api.serialize(c.component, c.save(), null_mut(), 9)
            });
            expect_null(api, "serializedState", |c| {
                api.deserialize(c.component, null(), 9, &mut null_mut())
            });
            expect_null(api, "FMUstate", |c| {
                api.deserialize(c.component, [0].as_ptr(), 1, null_mut())
            });
            expect_null(api, "vUnknown_ref", |c| {
                api.directional_derivative(c.component, null(), 1, vr, 1, value, real)
            });
            expect_null(api, "vKnown_ref", |c| {
                api.directional_derivative(c.component, vr, 1, null(), 1, value, real)
            });
            expect_null(api, "dvKnown", |c| {
                api.directional_derivative(c.component, vr, 1, vr, 1, null(), real)
            });
            expect_null(api, "dvUnknown", |c| {
                api.directional_derivative(c.component, vr, 1, vr, 1, value, null_mut())
            });
            expect_null(api, "order", |c| {
                api.get_output_derivatives(c.component, vr, 1, null(), real)
            });
            expect_null(api, "value", |c| {
                api.get_output_derivatives(c.component, vr, 1, order, null_mut())
            });
            expect_null(api, "categories", |c| api.set_debug_logging(c.component, 1, 1, null()));
            expect_error(api, "categories[i] is a null", |c| {
                api.set_debug_logging(c.component, 1, 1, [null()].as_ptr())
            });
        }
    });
}

#[test]
fn no_elements_need_no_pointers() {
    with_each_standard(|api| {
        let client = Client::running(api, Line, &[]);
        let c = client.component;
        // SAFETY: no element is read or written.
        unsafe {
            for status in [
                api.get_real(c, null(), 0, null_mut()),
                api.get_integer(c, null(), 0, null_mut()),
                api.get_boolean(c, null(), 0, null_mut()),
                api.get_string(c, null(), 0, null_mut()),
                api.set_real(c, null(), 0, null()),
                api.set_integer(c, null(), 0, null()),
                api.set_boolean(c, null(), 0, null()),
                api.set_string(c, null(), 0, null()),
                api.get_output_derivatives(c, null(), 0, null(), null_mut()),
                api.directional_derivative(c, null(), 0, null(), 0, null(), null_mut()),
                api.set_debug_logging(c, 1, 0, null()),
            ] {
                client.expect(OK, status);
            }
        }
    });
}

#[test]
fn unknown_value_references_are_errors() {
    with_each_standard(|api| {
        let (input, parameter, output) = (
            api.reference("normal_load"),
            api.reference("control"),
            api.reference("traction_force"),
        );
        // SAFETY: one element each.
        unsafe {
            for unknown in [u32::MAX, 999, 1999, 1 << 31, parameter] {
                let reason = format!("value reference {unknown}");
                expect_error(api, &reason, |c| api.get_real(c.component, &unknown, 1, &mut 0.0));
                expect_error(api, &reason, |c| api.set_real(c.component, &unknown, 1, &0.0));
                expect_error(api, &reason, |c| {
                    api.get_output_derivatives(c.component, &unknown, 1, &1, &mut 0.0)
                });
                expect_error(api, &reason, |c| {
                    api.directional_derivative(c.component, &unknown, 1, &input, 1, &1.0, &mut 0.0)
                });
                expect_error(api, &reason, |c| {
                    api.directional_derivative(c.component, &output, 1, &unknown, 1, &1.0, &mut 0.0)
                });
            }
            for unknown in [u32::MAX, input, output, 3999] {
                let reason = format!("value reference {unknown}");
                expect_error(api, &reason, |c| api.get_integer(c.component, &unknown, 1, &mut 0));
                expect_error(api, &reason, |c| api.set_integer(c.component, &unknown, 1, &0));
            }
            for unknown in [0, input, output, parameter, u32::MAX] {
                let reason = format!("value reference {unknown}");
                expect_error(api, &reason, |c| api.get_boolean(c.component, &unknown, 1, &mut 0));
                expect_error(api, &reason, |c| api.set_boolean(c.component, &unknown, 1, &0));
                expect_error(api, &reason, |c| api.get_string(c.component, &unknown, 1, &mut null()));
                expect_error(api, &reason, |c| {
                    api.set_string(c.component, &unknown, 1, &c"".as_ptr())
                });
            }
            // Inputs are no outputs, and the other way round.
            expect_error(api, "an output", |c| {
                api.get_output_derivatives(c.component, &input, 1, &1, &mut 0.0)
            });
        }
    });
}

#[test]
fn absurd_sizes_and_misaligned_pointers_are_errors() {
    with_each_standard(|api| {
        let vr = [0_u32; 2];
        let mut values = [0.0; 2];
        let pointer = values.as_mut_ptr();
        // SAFETY: nothing is read or written where the check holds.
        unsafe {
            for count in [usize::MAX, usize::MAX / 2, isize::MAX as usize] {
                expect_error(api, "do not fit", |c| {
                    api.get_real(c.component, vr.as_ptr(), count, pointer)
                });
                expect_error(api, "do not fit", |c| {
                    api.set_real(c.component, vr.as_ptr(), count, pointer)
                });
            }
            expect_error(api, "aligned", |c| {
                api.get_real(c.component, vr.as_ptr(), 1, pointer.byte_add(1))
            });
            expect_error(api, "aligned", |c| {
                api.set_real(c.component, vr.as_ptr().byte_add(1), 1, pointer)
            });
        }
    });
}

#[test]
fn instances_are_independent() {
    with_each(|api, contact| {
        let alone = Client::running(api, contact, &[("creepage", 0.01)]);
        alone.expect(OK, alone.step(0.0, 0.01));
        let (first, second) = (
            Client::running(api, contact, &[("creepage", 0.01)]),
            Client::running(api, contact, &[("creepage", -0.01)]),
        );
        second.expect(OK, second.step(0.0, 0.01));
        first.expect(OK, first.step(0.0, 0.01));
        assert_eq!(first.outputs(), alone.outputs());
        assert_ne!(second.outputs(), alone.outputs());
        // One instance's error is not another's.
        first.expect(ERROR, first.step(-1.0, 0.01));
        second.expect(OK, second.step(0.01, 0.01));
    });
}

#[test]
fn a_hundred_instances_in_two_threads_give_the_bits_of_one() {
    with_each(|api, contact| {
        let creepage = |k: usize| 1e-3 * (k % 7) as f64;
        let run = |k: usize| {
            let client = Client::running(api, contact, &[("creepage", creepage(k))]);
            client.expect(OK, client.step(0.0, 0.01));
            client.outputs()
        };
        let alone: Vec<_> = (0..7).map(run).collect();
        std::thread::scope(|scope| {
            for half in 0..2 {
                let (run, alone, api) = (&run, &alone, api);
                scope.spawn(move || {
                    let _ = run;
                    let clients: Vec<_> = (0..50)
                        .map(|k| Client::running(api, contact, &[("creepage", creepage(50 * half + k))]))
                        .collect();
                    for client in &clients {
                        client.expect(OK, client.step(0.0, 0.01));
                    }
                    for (k, client) in clients.iter().enumerate() {
                        assert_eq!(client.outputs(), alone[(50 * half + k) % 7]);
                    }
                });
            }
        });
    });
}
