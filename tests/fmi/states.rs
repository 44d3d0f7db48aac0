//! The state machines: every function in every state, against the tables of the standards (functions.rs).

use super::functions::{Function, of_standard, states_of};
use super::importer::{
    Api, Client, ContactModel, ERROR, FMI2_FUNCTIONS, FMI3_FUNCTIONS, Fmi2, Fmi3, OK, with_each,
    with_each_contact_model,
};
use std::ptr::null_mut;

/// A fresh instance of a contact model in a state, by the name that its standard has for it.
fn in_state<'a>(api: &'a Api, contact: ContactModel, state: &str) -> Client<'a> {
    match state {
        "instantiated" => {
            let client = Client::coarse(api, contact);
            client.expect(OK, client.setup(0.0, None));
            client
        }
        "Instantiated" => Client::coarse(api, contact),
        "Configuration Mode" => {
            let client = Client::coarse(api, contact);
            // SAFETY: a live instance.
            client.expect(OK, unsafe { (api.fmi3.fmi3EnterConfigurationMode)(client.component) });
            client
        }
        "initializationMode" | "Initialization Mode" => Client::initializing(api, contact),
        "stepComplete" | "Step Mode" => Client::running(api, contact, &[]),
        "stepFailed" => step_failed(api, contact),
        "terminated" | "Terminated" => {
            let client = Client::running(api, contact, &[]);
            client.expect(OK, client.terminate());
            client
        }
        "error" => {
            let client = Client::running(api, contact, &[]);
            client.expect(ERROR, client.step(-1.0, 1.0));
            client
        }
        other => unreachable!("{other}"),
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

/// Takes every call in a state. A row of the table says what is allowed there.
fn every_function<'a>(api: &'a Api, fresh: impl Fn() -> Client<'a>, state: &str, column: usize) -> usize {
    let table = of_standard(api.standard);
    for Function { name, call, allowed } in table {
        let client = fresh();
        client.journal.borrow_mut().clear();
        let expected = if allowed[column] { OK } else { ERROR };
        let status = call(api, client.component, client.save());
        assert_eq!(status, expected, "{name} in {state}: {:?}", client.journal.borrow());
        if expected == ERROR {
            let message = client.last_message();
            let told = format!("{name}: not allowed in state {}", states_of(api.standard)[column]);
            assert!(message.starts_with(&told), "{message}");
        }
    }
    table.len()
}

#[test]
fn every_function_in_every_state_is_as_the_standard_says() {
    with_each(|api, contact| {
        // With those that need no instance, make one, or free it, these are all.
        let (others, exported) = match api.standard {
            Fmi2 => (4, FMI2_FUNCTIONS),
            Fmi3 => (5, FMI3_FUNCTIONS),
        };
        let table = of_standard(api.standard);
        assert_eq!(table.len() + others, exported.len());
        assert!(table.iter().all(|function| exported.contains(&function.name)));
        let mut calls = 0;
        for (column, state) in states_of(api.standard).iter().enumerate() {
            calls += every_function(api, || in_state(api, contact, state), state, column);
        }
        println!("{} functions, {calls} calls", table.len());
    });
}

/// A call that fails leads to *Terminated* in FMI 3.0, as a step of FMI 2.0 does that came part of its way.
#[test]
fn after_an_error_fmi3_allows_what_it_allows_in_terminated() {
    let api = &Api::load(Fmi3);
    with_each_contact_model(api, |api, contact| {
        let column = states_of(Fmi3).iter().position(|state| *state == "Terminated").unwrap();
        let error = || in_state(api, contact, "error");
        every_function(api, error, "Terminated after an error", column);
        every_function(api, || step_failed(api, contact), "a state of FMI 2.0", column);
    });
}

#[test]
fn a_refused_call_leads_to_the_error_state_and_reset_leads_out() {
    with_each(|api, contact| {
        let error = match api.standard {
            Fmi2 => "error",
            Fmi3 => "Terminated",
        };
        for state in states_of(api.standard) {
            let client = in_state(api, contact, state);
            // SAFETY: a live instance.
            let status = unsafe {
                match api.standard {
                    Fmi2 => (api.fmi2.fmi2CancelStep)(client.component),
                    Fmi3 => (api.fmi3.fmi3EnterEventMode)(client.component),
                }
            };
            client.expect(ERROR, status);
            client.expect(ERROR, client.step(0.0, 1e-3));
            let told = format!("not allowed in state {error}");
            assert!(client.last_message().contains(&told));
            client.expect(OK, client.reset());
            client.make_coarse();
            client.start();
            client.expect(OK, client.step(0.0, 1e-3));
        }
    });
}

#[test]
fn initialization_needs_an_experiment() {
    let api = Api::load(Fmi2);
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
    with_each(|api, contact| {
        for state in states_of(api.standard) {
            let client = in_state(api, contact, state);
            client.save();
            drop(client);
        }
    });
}
