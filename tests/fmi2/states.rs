//! The state machine: every function in every state, against the table of the standard (2.0.5, section 4.2.4).

use super::importer::{Api, Client, ContactModel, ERROR, OK, reference, with_each_contact_model};
use std::ffi::c_int;
use std::ptr::{null, null_mut};

#[derive(Debug, Clone, Copy, PartialEq)]
enum State {
    Instantiated,
    Initialization,
    StepComplete,
    StepFailed,
    Terminated,
    Error,
}

use State::{Initialization, Instantiated, StepComplete, StepFailed, Terminated};

const STATES: [State; 6] = [
    Instantiated,
    Initialization,
    StepComplete,
    StepFailed,
    Terminated,
    State::Error,
];

/// A fresh instance of a contact model in a state.
fn in_state(api: &Api, contact: ContactModel, state: State) -> Client<'_> {
    match state {
        Instantiated => {
            let client = Client::coarse(api, contact);
            client.expect(OK, client.setup(0.0, None));
            client
        }
        Initialization => Client::initializing(api, contact),
        StepComplete => Client::running(api, contact, &[]),
        StepFailed => step_failed(api, contact),
        Terminated => {
            let client = Client::running(api, contact, &[]);
            client.expect(OK, client.terminate());
            client
        }
        State::Error => {
            let client = Client::running(api, contact, &[]);
            client.expect(ERROR, client.step(-1.0, 1.0));
            client
        }
    }
}

/// Steps that stop after a committed part are rare (steps.rs looks for them), so *stepFailed* comes from a
/// serialised state that says so.
fn step_failed(api: &Api, contact: ContactModel) -> Client<'_> {
    let client = Client::running(api, contact, &[]);
    let handle = client.save();
    let mut bytes = client.serialize(handle);
    // The payload begins with the number of the state in its enumeration.
    const HEADER: usize = 28;
    assert_eq!(bytes[HEADER], 2);
    bytes[HEADER] = 3;
    let end = bytes.len() - 4;
    let checksum = crc32fast::hash(&bytes[..end]);
    bytes[end..].copy_from_slice(&checksum.to_le_bytes());
    let mut failed = null_mut();
    client.expect(OK, client.deserialize(&bytes, &mut failed));
    client.expect(OK, client.restore(failed));
    client
}

type Call = fn(&Client) -> c_int;

/// Every function that is bound to states, a call that is right in itself, and the states that allow it.
fn table() -> Vec<(&'static str, Call, Vec<State>)> {
    let all = STATES.to_vec();
    let after = vec![Initialization, StepComplete, StepFailed, Terminated, State::Error];
    let setting = vec![Instantiated, Initialization, StepComplete];
    let asking = vec![StepComplete, StepFailed, Terminated];
    // SAFETY: live instances, one element behind each pointer.
    unsafe {
        vec![
            (
                "fmi2SetDebugLogging",
                |c| (c.api.set_debug_logging)(c.component, 0, 0, null()),
                all.clone(),
            ),
            ("fmi2SetupExperiment", |c| c.setup(0.0, None), vec![Instantiated]),
            ("fmi2EnterInitializationMode", |c| c.enter(), vec![Instantiated]),
            ("fmi2ExitInitializationMode", |c| c.exit(), vec![Initialization]),
            ("fmi2Terminate", |c| c.terminate(), vec![StepComplete, StepFailed]),
            ("fmi2Reset", |c| c.reset(), all.clone()),
            (
                "fmi2GetReal",
                |c| (c.api.get_real)(c.component, &reference("peak_pressure"), 1, &mut 0.0),
                after.clone(),
            ),
            (
                "fmi2GetInteger",
                |c| (c.api.get_integer)(c.component, &reference("control"), 1, &mut 0),
                after.clone(),
            ),
            (
                "fmi2GetBoolean",
                |c| (c.api.get_boolean)(c.component, null(), 0, null_mut()),
                after.clone(),
            ),
            (
                "fmi2GetString",
                |c| (c.api.get_string)(c.component, null(), 0, null_mut()),
                after.clone(),
            ),
            ("fmi2SetReal", |c| c.set(&[("normal_load", 5e4)]), setting.clone()),
            (
                "fmi2SetInteger",
                |c| (c.api.set_integer)(c.component, null(), 0, null()),
                setting.clone(),
            ),
            (
                "fmi2SetBoolean",
                |c| (c.api.set_boolean)(c.component, null(), 0, null()),
                setting.clone(),
            ),
            (
                "fmi2SetString",
                |c| (c.api.set_string)(c.component, null(), 0, null()),
                setting.clone(),
            ),
            (
                "fmi2GetFMUstate",
                |c| (c.api.get_state)(c.component, &mut null_mut()),
                all.clone(),
            ),
            ("fmi2SetFMUstate", |c| c.restore(c.save()), all.clone()),
            (
                "fmi2FreeFMUstate",
                |c| (c.api.free_state)(c.component, &mut c.save()),
                all.clone(),
            ),
            (
                "fmi2SerializedFMUstateSize",
                |c| (c.api.serialized_size)(c.component, c.save(), &mut 0),
                all.clone(),
            ),
            (
                "fmi2SerializeFMUstate",
                |c| {
                    c.serialize(c.save());
                    OK
                },
                all.clone(),
            ),
            (
                "fmi2DeSerializeFMUstate",
                |c| c.deserialize(&c.serialize(c.save()), &mut null_mut()),
                all,
            ),
            (
                "fmi2GetDirectionalDerivative",
                |c| {
                    let (unknown, known) = (reference("traction_force"), reference("creepage"));
                    (c.api.directional_derivative)(c.component, &unknown, 1, &known, 1, &1.0, &mut 0.0)
                },
                after,
            ),
            (
                "fmi2SetRealInputDerivatives",
                |c| c.set_rates(&[("normal_load", 1, 1.0)]),
                setting,
            ),
            (
                "fmi2GetRealOutputDerivatives",
                |c| (c.api.get_output_derivatives)(c.component, &reference("traction_force"), 1, &1, &mut 0.0),
                vec![StepComplete, StepFailed, Terminated, State::Error],
            ),
            ("fmi2DoStep", |c| c.step(0.0, 1e-3), vec![StepComplete]),
            ("fmi2CancelStep", |c| (c.api.cancel_step)(c.component), vec![]),
            // Allowed, but there is nothing to tell: fmi2Discard.
            (
                "fmi2GetStatus",
                |c| discarded((c.api.get_status)(c.component, 0, &mut 0)),
                asking.clone(),
            ),
            (
                "fmi2GetRealStatus",
                |c| (c.api.get_real_status)(c.component, 2, &mut 0.0),
                asking.clone(),
            ),
            (
                "fmi2GetIntegerStatus",
                |c| discarded((c.api.get_integer_status)(c.component, 0, &mut 0)),
                asking.clone(),
            ),
            (
                "fmi2GetBooleanStatus",
                |c| (c.api.get_boolean_status)(c.component, 3, &mut 0),
                asking.clone(),
            ),
            (
                "fmi2GetStringStatus",
                |c| discarded((c.api.get_string_status)(c.component, 1, &mut null())),
                asking,
            ),
        ]
    }
}

fn discarded(status: c_int) -> c_int {
    if status == super::importer::DISCARD { OK } else { status }
}

#[test]
fn every_function_in_every_state_is_as_the_standard_says() {
    with_each_contact_model(|api, contact| {
        let table = table();
        // With fmi2GetTypesPlatform, fmi2GetVersion, fmi2Instantiate and fmi2FreeInstance these are all.
        assert_eq!(table.len() + 4, super::importer::FUNCTIONS.len());
        for (name, call, allowed) in &table {
            for state in STATES {
                let client = in_state(api, contact, state);
                client.journal.borrow_mut().clear();
                let expected = if allowed.contains(&state) { OK } else { ERROR };
                assert_eq!(
                    call(&client),
                    expected,
                    "{name} in {state:?}: {:?}",
                    client.journal.borrow()
                );
                if expected == ERROR {
                    let message = client.last_message();
                    assert!(
                        message.starts_with(&format!("{name}: not allowed in state")),
                        "{message}"
                    );
                }
            }
        }
    });
}

#[test]
fn a_refused_call_leads_to_the_error_state_and_reset_leads_out() {
    with_each_contact_model(|api, contact| {
        for state in STATES {
            let client = in_state(api, contact, state);
            // SAFETY: a live instance.
            client.expect(ERROR, unsafe { (api.cancel_step)(client.component) });
            client.expect(ERROR, client.step(0.0, 1e-3));
            assert!(client.last_message().contains("not allowed in state error"));
            client.expect(OK, client.reset());
            client.make_coarse();
            client.start();
            client.expect(OK, client.step(0.0, 1e-3));
        }
    });
}

#[test]
fn initialization_needs_an_experiment() {
    let api = Api::load();
    let client = Client::new(&api);
    client.expect(ERROR, client.enter());
    assert!(client.last_message().contains("fmi2SetupExperiment"));
    client.expect(OK, client.reset());
    client.expect(OK, client.setup(0.0, None));
    client.expect(OK, client.reset());
    client.expect(ERROR, client.enter());
}

#[test]
fn every_state_can_be_freed() {
    with_each_contact_model(|api, contact| {
        for state in STATES {
            let client = in_state(api, contact, state);
            client.save();
            drop(client);
        }
    });
}
