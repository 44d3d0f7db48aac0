//! Every function is there, and no argument makes it crash: null pointers, unknown value references, absurd sizes.

use super::importer::{
    Api, Client, DISCARD, ERROR, FUNCTIONS, Journal, Line, OK, callbacks, guid, reference, with_each_contact_model,
};
use std::ffi::{CStr, CString, c_int};
use std::ptr::{null, null_mut};
use wheelrail::fmi2::types::CallbackFunctions;

#[test]
fn all_functions_of_the_header_for_co_simulation_are_exported() {
    assert_eq!(FUNCTIONS.len(), 34);
    Api::load();
}

#[test]
fn version_and_platform_are_those_of_the_standard() {
    let api = Api::load();
    // SAFETY: static strings.
    unsafe {
        assert_eq!(CStr::from_ptr((api.version)()), c"2.0");
        assert_eq!(CStr::from_ptr((api.types_platform)()), c"default");
    }
}

/// Arguments of fmi2Instantiate that a test varies.
struct Instantiation<'a> {
    name: Option<&'a CStr>,
    fmu_type: c_int,
    guid: Option<&'a CStr>,
    location: Option<&'a CStr>,
}

fn is_instantiated(api: &Api, arguments: &Instantiation, callbacks: Option<&CallbackFunctions>) -> bool {
    let pointer = |text: Option<&CStr>| text.map_or(null(), CStr::as_ptr);
    // SAFETY: null or valid pointers; the instance is freed once.
    unsafe {
        let component = (api.instantiate)(
            pointer(arguments.name),
            arguments.fmu_type,
            pointer(arguments.guid),
            pointer(arguments.location),
            callbacks.map_or(null(), |callbacks| &raw const *callbacks),
            0,
            1,
        );
        (api.free_instance)(component);
        !component.is_null()
    }
}

#[test]
fn instantiation_is_refused_with_a_reason() {
    let api = Api::load();
    let guid = guid();
    let upper = CString::new(guid.to_str().unwrap().to_uppercase()).unwrap();
    let good = || Instantiation {
        name: Some(c"a"),
        fmu_type: 1,
        guid: Some(&guid),
        location: None,
    };
    let wrong_guid = c"{00000000-0000-0000-0000-000000000000}";
    let cases = [
        (Instantiation { name: None, ..good() }, "instanceName"),
        (
            Instantiation {
                name: Some(c""),
                ..good()
            },
            "instanceName",
        ),
        (
            Instantiation {
                name: Some(c" \t\n"),
                ..good()
            },
            "instanceName",
        ),
        (Instantiation { fmu_type: 0, ..good() }, "fmuType = 0"),
        (Instantiation { fmu_type: 77, ..good() }, "fmuType = 77"),
        (Instantiation { guid: None, ..good() }, "fmuGUID"),
        (
            Instantiation {
                guid: Some(c""),
                ..good()
            },
            "fmuGUID",
        ),
        (
            Instantiation {
                guid: Some(wrong_guid),
                ..good()
            },
            wrong_guid.to_str().unwrap(),
        ),
        (
            Instantiation {
                guid: Some(&upper),
                ..good()
            },
            "fmuGUID",
        ),
    ];
    for (arguments, reason) in cases {
        let journal = Journal::default();
        assert!(
            !is_instantiated(&api, &arguments, Some(&callbacks(&journal))),
            "{reason}"
        );
        let messages = journal.take();
        assert_eq!(messages.len(), 1);
        assert_eq!(
            (messages[0].status, messages[0].category.as_str()),
            (ERROR, "logStatusError")
        );
        assert!(messages[0].text.contains(reason), "{messages:?}");
    }
    assert!(!is_instantiated(&api, &good(), None), "callbacks are needed");
}

#[test]
fn every_callback_may_be_null_and_every_resource_location_is_taken() {
    let api = Api::load();
    let guid = guid();
    let nothing = CallbackFunctions {
        logger: None,
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: null_mut(),
    };
    for location in [
        None,
        Some(c""),
        Some(c"file:///a%20b"),
        Some(c"file:/a"),
        Some(c"http://x"),
        Some(c"%%%"),
    ] {
        let arguments = Instantiation {
            name: Some(c"a"),
            fmu_type: 1,
            guid: Some(&guid),
            location,
        };
        assert!(is_instantiated(&api, &arguments, Some(&nothing)), "{location:?}");
        // Without a logger a failure is silent, not a crash.
        let wrong = Instantiation {
            guid: None,
            ..arguments
        };
        assert!(!is_instantiated(&api, &wrong, Some(&nothing)));
    }
}

#[test]
fn callbacks_and_strings_are_copied() {
    let api = Api::load();
    let journal = Journal::default();
    let mut name = *b"wheel\0";
    let mut structure = callbacks(&journal);
    let guid = guid();
    // SAFETY: valid pointers; what they point to is overwritten after the call.
    unsafe {
        let component = (api.instantiate)(name.as_ptr().cast(), 1, guid.as_ptr(), null(), &structure, 0, 0);
        name.fill(b'?');
        structure.logger = None;
        structure.component_environment = null_mut();
        std::hint::black_box((&name, &structure));
        assert_eq!((api.exit_initialization)(component), ERROR);
        (api.free_instance)(component);
    }
    assert_eq!(journal.take()[0].instance_name, "wheel");
}

/// With right arguments, so that the null instance alone is the error; `fmi2_probes` has wrong ones beside it.
#[test]
fn a_null_instance_is_an_error_and_nothing_to_free() {
    let api = Api::load();
    let (mut real, mut integer, mut string, mut handle, mut size) = (0.0, 0, null(), null_mut(), 0);
    let c = null_mut();
    // SAFETY: valid places for results.
    unsafe {
        (api.free_instance)(c);
        let statuses = [
            (api.set_debug_logging)(c, 1, 0, null()),
            (api.setup_experiment)(c, 0, 0.0, 0.0, 0, 0.0),
            (api.enter_initialization)(c),
            (api.exit_initialization)(c),
            (api.terminate)(c),
            (api.reset)(c),
            (api.get_real)(c, null(), 0, null_mut()),
            (api.get_integer)(c, null(), 0, null_mut()),
            (api.get_boolean)(c, null(), 0, null_mut()),
            (api.get_string)(c, null(), 0, null_mut()),
            (api.set_real)(c, null(), 0, null()),
            (api.set_integer)(c, null(), 0, null()),
            (api.set_boolean)(c, null(), 0, null()),
            (api.set_string)(c, null(), 0, null()),
            (api.get_state)(c, &mut handle),
            (api.set_state)(c, handle),
            (api.free_state)(c, &mut handle),
            (api.serialized_size)(c, handle, &mut size),
            (api.serialize)(c, handle, null_mut(), 0),
            (api.deserialize)(c, null(), 0, &mut handle),
            (api.directional_derivative)(c, null(), 0, null(), 0, null(), null_mut()),
            (api.set_input_derivatives)(c, null(), 0, null(), null()),
            (api.get_output_derivatives)(c, null(), 0, null(), null_mut()),
            (api.do_step)(c, 0.0, 1.0, 1),
            (api.cancel_step)(c),
            (api.get_status)(c, 0, &mut integer),
            (api.get_real_status)(c, 2, &mut real),
            (api.get_integer_status)(c, 0, &mut integer),
            (api.get_boolean_status)(c, 3, &mut integer),
            (api.get_string_status)(c, 1, &mut string),
        ];
        assert_eq!(statuses, [ERROR; 30]);
    }
}

/// Runs one call on a fresh instance in *stepComplete* and expects fmi2Error with a message that names the argument.
#[track_caller]
fn expect_error(api: &Api, reason: &str, call: impl FnOnce(&Client) -> c_int) {
    let client = Client::running(api, Line, &[]);
    client.expect(ERROR, call(&client));
    let message = client.last_message();
    assert!(message.contains(reason), "{message}");
}

#[test]
fn null_pointers_are_errors() {
    let api = Api::load();
    let vr = [reference("normal_load")];
    let (order, value) = ([1], [1.0]);
    let (mut real, mut integer) = ([0.0], [0]);
    let (vr, order, value) = (vr.as_ptr(), order.as_ptr(), value.as_ptr());
    let (real, integer) = (real.as_mut_ptr(), integer.as_mut_ptr());
    // SAFETY: null or valid pointers.
    unsafe {
        expect_error(&api, "argument vr is a null", |c| {
            (api.get_real)(c.component, null(), 1, real)
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.get_real)(c.component, vr, 1, null_mut())
        });
        expect_error(&api, "argument vr is a null", |c| {
            (api.get_integer)(c.component, null(), 1, integer)
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.get_integer)(c.component, vr, 1, null_mut())
        });
        expect_error(&api, "argument vr is a null", |c| {
            (api.get_boolean)(c.component, null(), 1, integer)
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.get_boolean)(c.component, vr, 1, null_mut())
        });
        expect_error(&api, "argument vr is a null", |c| {
            (api.get_string)(c.component, null(), 1, null_mut())
        });
        expect_error(&api, "argument vr is a null", |c| {
            (api.set_real)(c.component, null(), 1, value)
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.set_real)(c.component, vr, 1, null())
        });
        expect_error(&api, "argument vr is a null", |c| {
            (api.set_integer)(c.component, null(), 1, order)
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.set_integer)(c.component, vr, 1, null())
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.set_boolean)(c.component, vr, 1, null())
        });
        expect_error(&api, "argument value is a null", |c| {
            (api.set_string)(c.component, vr, 1, null())
        });
        expect_error(&api, "FMUstate is a null", |c| (api.get_state)(c.component, null_mut()));
        expect_error(&api, "FMUstate is a null", |c| (api.set_state)(c.component, null_mut()));
        expect_error(&api, "FMUstate is a null", |c| {
            (api.free_state)(c.component, null_mut())
        });
        expect_error(&api, "size is a null", |c| {
            (api.serialized_size)(c.component, c.save(), null_mut())
        });
        expect_error(&api, "FMUstate is a null", |c| {
            (api.serialized_size)(c.component, null_mut(), &mut 0)
        });
        expect_error(&api, "FMUstate is a null", |c| {
            (api.serialize)(c.component, null_mut(), null_mut(), 0)
        });
        expect_error(&api, "serializedState is a null", |c| {
            (api.serialize)(c.component, c.save(), null_mut(), 9)
        });
        expect_error(&api, "serializedState is a null", |c| {
            (api.deserialize)(c.component, null(), 9, &mut null_mut())
        });
        expect_error(&api, "FMUstate is a null", |c| {
            (api.deserialize)(c.component, [0].as_ptr(), 1, null_mut())
        });
        expect_error(&api, "vUnknown_ref is a null", |c| {
            (api.directional_derivative)(c.component, null(), 1, vr, 1, value, real)
        });
        expect_error(&api, "vKnown_ref is a null", |c| {
            (api.directional_derivative)(c.component, vr, 1, null(), 1, value, real)
        });
        expect_error(&api, "dvKnown is a null", |c| {
            (api.directional_derivative)(c.component, vr, 1, vr, 1, null(), real)
        });
        expect_error(&api, "dvUnknown is a null", |c| {
            (api.directional_derivative)(c.component, vr, 1, vr, 1, value, null_mut())
        });
        expect_error(&api, "vr is a null", |c| {
            (api.set_input_derivatives)(c.component, null(), 1, order, value)
        });
        expect_error(&api, "order is a null", |c| {
            (api.set_input_derivatives)(c.component, vr, 1, null(), value)
        });
        expect_error(&api, "value is a null", |c| {
            (api.set_input_derivatives)(c.component, vr, 1, order, null())
        });
        expect_error(&api, "order is a null", |c| {
            (api.get_output_derivatives)(c.component, vr, 1, null(), real)
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_output_derivatives)(c.component, vr, 1, order, null_mut())
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_status)(c.component, 0, null_mut())
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_real_status)(c.component, 2, null_mut())
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_integer_status)(c.component, 0, null_mut())
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_boolean_status)(c.component, 3, null_mut())
        });
        expect_error(&api, "value is a null", |c| {
            (api.get_string_status)(c.component, 1, null_mut())
        });
        expect_error(&api, "categories is a null", |c| {
            (api.set_debug_logging)(c.component, 1, 1, null())
        });
        expect_error(&api, "categories[i] is a null", |c| {
            (api.set_debug_logging)(c.component, 1, 1, [null()].as_ptr())
        });
    }
}

#[test]
fn no_elements_need_no_pointers() {
    let api = Api::load();
    let client = Client::running(&api, Line, &[]);
    let c = client.component;
    // SAFETY: no element is read or written.
    unsafe {
        for status in [
            (api.get_real)(c, null(), 0, null_mut()),
            (api.get_integer)(c, null(), 0, null_mut()),
            (api.get_boolean)(c, null(), 0, null_mut()),
            (api.get_string)(c, null(), 0, null_mut()),
            (api.set_real)(c, null(), 0, null()),
            (api.set_integer)(c, null(), 0, null()),
            (api.set_boolean)(c, null(), 0, null()),
            (api.set_string)(c, null(), 0, null()),
            (api.set_input_derivatives)(c, null(), 0, null(), null()),
            (api.get_output_derivatives)(c, null(), 0, null(), null_mut()),
            (api.directional_derivative)(c, null(), 0, null(), 0, null(), null_mut()),
            (api.set_debug_logging)(c, 1, 0, null()),
        ] {
            client.expect(OK, status);
        }
    }
}

#[test]
fn unknown_value_references_are_errors() {
    let api = Api::load();
    let (input, parameter, output) = (
        reference("normal_load"),
        reference("control"),
        reference("traction_force"),
    );
    // SAFETY: one element each.
    unsafe {
        for unknown in [u32::MAX, 999, 1999, 1 << 31, parameter] {
            let reason = format!("value reference {unknown}");
            expect_error(&api, &reason, |c| (api.get_real)(c.component, &unknown, 1, &mut 0.0));
            expect_error(&api, &reason, |c| (api.set_real)(c.component, &unknown, 1, &0.0));
            expect_error(&api, &reason, |c| {
                (api.set_input_derivatives)(c.component, &unknown, 1, &1, &0.0)
            });
            expect_error(&api, &reason, |c| {
                (api.get_output_derivatives)(c.component, &unknown, 1, &1, &mut 0.0)
            });
            expect_error(&api, &reason, |c| {
                (api.directional_derivative)(c.component, &unknown, 1, &input, 1, &1.0, &mut 0.0)
            });
            expect_error(&api, &reason, |c| {
                (api.directional_derivative)(c.component, &output, 1, &unknown, 1, &1.0, &mut 0.0)
            });
        }
        for unknown in [u32::MAX, input, output, 3999] {
            let reason = format!("value reference {unknown}");
            expect_error(&api, &reason, |c| (api.get_integer)(c.component, &unknown, 1, &mut 0));
            expect_error(&api, &reason, |c| (api.set_integer)(c.component, &unknown, 1, &0));
        }
        for unknown in [0, input, output, parameter, u32::MAX] {
            let reason = format!("value reference {unknown}");
            expect_error(&api, &reason, |c| (api.get_boolean)(c.component, &unknown, 1, &mut 0));
            expect_error(&api, &reason, |c| (api.set_boolean)(c.component, &unknown, 1, &0));
            expect_error(&api, &reason, |c| {
                (api.get_string)(c.component, &unknown, 1, &mut null())
            });
            expect_error(&api, &reason, |c| {
                (api.set_string)(c.component, &unknown, 1, &c"".as_ptr())
            });
        }
        // Inputs are no outputs, and the other way round.
        expect_error(&api, "an output", |c| {
            (api.get_output_derivatives)(c.component, &input, 1, &1, &mut 0.0)
        });
        expect_error(&api, "an input", |c| {
            (api.set_input_derivatives)(c.component, &output, 1, &1, &0.0)
        });
    }
}

#[test]
fn absurd_sizes_and_misaligned_pointers_are_errors() {
    let api = Api::load();
    let vr = [0_u32; 2];
    let mut values = [0.0; 2];
    let pointer = values.as_mut_ptr();
    // SAFETY: nothing is read or written where the check holds.
    unsafe {
        for count in [usize::MAX, usize::MAX / 2, isize::MAX as usize] {
            expect_error(&api, "do not fit", |c| {
                (api.get_real)(c.component, vr.as_ptr(), count, pointer)
            });
            expect_error(&api, "do not fit", |c| {
                (api.set_real)(c.component, vr.as_ptr(), count, pointer)
            });
        }
        expect_error(&api, "aligned", |c| {
            (api.get_real)(c.component, vr.as_ptr(), 1, pointer.byte_add(1))
        });
        expect_error(&api, "aligned", |c| {
            (api.set_real)(c.component, vr.as_ptr().byte_add(1), 1, pointer)
        });
    }
}

#[test]
fn status_queries_answer_what_there_is_and_discard_the_rest() {
    let api = Api::load();
    let client = Client::running(&api, Line, &[]);
    client.expect(OK, client.step(0.0, 0.01));
    let c = client.component;
    let (mut real, mut integer, mut string) = (0.0, 7, null());
    // SAFETY: valid places.
    unsafe {
        client.expect(OK, (api.get_real_status)(c, 2, &mut real));
        assert_eq!(real, 0.01);
        client.expect(OK, (api.get_boolean_status)(c, 3, &mut integer));
        assert_eq!(integer, 0);
        for kind in [-1, 0, 1, 2, 3, 4, c_int::MAX] {
            client.expect(DISCARD, (api.get_status)(c, kind, &mut integer));
            client.expect(DISCARD, (api.get_integer_status)(c, kind, &mut integer));
            client.expect(DISCARD, (api.get_string_status)(c, kind, &mut string));
            if kind != 2 {
                client.expect(DISCARD, (api.get_real_status)(c, kind, &mut real));
            }
            if kind != 3 {
                client.expect(DISCARD, (api.get_boolean_status)(c, kind, &mut integer));
            }
        }
    }
    assert!(client.last_message().contains("status kind"));
    client.expect(OK, client.step(0.01, 0.01));
}

#[test]
fn instances_are_independent() {
    with_each_contact_model(|api, contact| {
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
    with_each_contact_model(|api, contact| {
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
