//! Messages: where they go, what they look like, when there are none.

use super::importer::{Api, Client, DISCARD, ERROR, Message, OK, with_each_contact_model};
use std::ffi::{CStr, c_char, c_int};

/// A short life with nothing wrong in it.
fn good_life(client: &Client) {
    client.make_coarse();
    client.start();
    client.expect(OK, client.step(0.0, 1e-3));
    client.expect(OK, client.terminate());
    client.expect(OK, client.reset());
}

fn set_debug_logging(client: &Client, on: bool, categories: &[&CStr]) -> c_int {
    let pointers: Vec<*const c_char> = categories.iter().map(|name| name.as_ptr()).collect();
    // SAFETY: valid strings.
    unsafe { (client.api.set_debug_logging)(client.component, c_int::from(on), pointers.len(), pointers.as_ptr()) }
}

fn categories(messages: &[Message]) -> Vec<&str> {
    let mut names: Vec<_> = messages.iter().map(|message| message.category.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

#[test]
fn nothing_is_logged_when_logging_is_off_and_nothing_is_wrong() {
    let api = Api::load();
    let client = Client::new(&api);
    good_life(&client);
    assert_eq!(client.journal.take(), []);
}

#[test]
fn the_reason_of_a_failed_call_is_told_until_it_is_switched_off() {
    let api = Api::load();
    let client = Client::new(&api);
    client.expect(DISCARD, client.set(&[("normal_load", -1.0)]));
    client.expect(ERROR, client.step(0.0, 1.0));
    let messages = client.journal.take();
    assert_eq!(messages.len(), 2);
    assert_eq!(
        (messages[0].status, messages[0].category.as_str()),
        (DISCARD, "logStatusWarning")
    );
    assert_eq!(
        (messages[1].status, messages[1].category.as_str()),
        (ERROR, "logStatusError")
    );
    client.expect(OK, set_debug_logging(&client, false, &[]));
    client.expect(ERROR, client.step(0.0, 1.0));
    assert_eq!(client.journal.take(), []);
}

#[test]
fn with_logging_on_solver_and_events_are_told_with_ok() {
    with_each_contact_model(|api, contact| {
        let mut client = Client::with_logging(api, true);
        client.contact = contact;
        good_life(&client);
        let messages = client.journal.take();
        assert_eq!(categories(&messages), ["logEvents", "logSolver"]);
        assert!(messages.iter().all(|message| message.status == OK));
    });
}

#[test]
fn categories_are_switched_one_by_one() {
    let api = Api::load();
    for (chosen, name) in [(c"logEvents", "logEvents"), (c"logSolver", "logSolver")] {
        let client = Client::new(&api);
        client.expect(OK, set_debug_logging(&client, true, &[chosen]));
        good_life(&client);
        client.expect(ERROR, client.step(0.0, 1.0));
        assert_eq!(categories(&client.journal.take()), [name]);
    }
    let client = Client::with_logging(&api, true);
    client.expect(OK, set_debug_logging(&client, false, &[c"logSolver"]));
    good_life(&client);
    assert_eq!(categories(&client.journal.take()), ["logEvents"]);
    client.expect(OK, set_debug_logging(&client, true, &[]));
    good_life(&client);
    client.expect(ERROR, client.step(0.0, 1.0));
    assert_eq!(
        categories(&client.journal.take()),
        ["logEvents", "logSolver", "logStatusError"]
    );
}

#[test]
fn an_undeclared_category_is_an_error_and_changes_nothing() {
    let api = Api::load();
    let client = Client::new(&api);
    client.expect(ERROR, set_debug_logging(&client, true, &[c"logSolver", c"logNonsense"]));
    assert!(client.last_message().contains("logNonsense"));
    client.expect(OK, client.reset());
    good_life(&client);
    assert_eq!(client.journal.take(), []);
}

#[test]
fn a_message_is_never_a_format_and_has_no_trailing_newline() {
    let api = Api::load();
    let client = Client::new(&api);
    for name in [c"%s%n%d", c"#r1#", c"a\n"] {
        client.expect(OK, client.reset());
        client.expect(ERROR, set_debug_logging(&client, true, &[name]));
    }
    let messages = client.journal.take();
    assert!(
        messages
            .iter()
            .all(|message| message.format == "%s" && message.instance_name == "wheel")
    );
    assert!(messages.iter().all(|message| !message.text.ends_with('\n')));
    assert!(messages[0].text.contains("%s%n%d"), "{messages:?}");
    assert!(
        messages[1].text.contains("##r1##"),
        "# starts a variable's name: {messages:?}"
    );
}

#[test]
fn the_logger_may_call_back_into_the_instance() {
    use std::cell::Cell;
    use std::ffi::c_void;
    use wheelrail::fmi2::types::{CallbackFunctions, LoggerCallback};

    struct Environment {
        api: Api,
        component: Cell<*mut c_void>,
        seen: Cell<usize>,
    }
    unsafe extern "C" fn logger(
        environment: *mut c_void,
        _: *const c_char,
        _: c_int,
        _: *const c_char,
        _: *const c_char,
    ) {
        // SAFETY: the environment of the test below; the instance is not borrowed while the logger runs.
        unsafe {
            let environment = &*environment.cast::<Environment>();
            environment.seen.set(environment.seen.get() + 1);
            let mut value = 0.0;
            (environment.api.get_real)(environment.component.get(), &0, 1, &mut value);
        }
    }
    type Short = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);
    let environment = Environment {
        api: Api::load(),
        component: Cell::new(std::ptr::null_mut()),
        seen: Cell::new(0),
    };
    let callbacks = CallbackFunctions {
        // SAFETY: arguments beyond the fifth are not looked at.
        logger: Some(unsafe { std::mem::transmute::<Short, LoggerCallback>(logger as Short) }),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: (&raw const environment).cast_mut().cast(),
    };
    let (api, guid) = (&environment.api, super::importer::guid());
    // SAFETY: valid pointers; one live instance.
    unsafe {
        let component = (api.instantiate)(c"a".as_ptr(), 1, guid.as_ptr(), std::ptr::null(), &callbacks, 0, 0);
        environment.component.set(component);
        assert_eq!((api.setup_experiment)(component, 0, 0.0, 0.0, 0, 0.0), OK);
        assert_eq!((api.enter_initialization)(component), OK);
        assert_eq!((api.set_real)(component, &1, 1, &-1.0), DISCARD);
        assert_eq!((api.exit_initialization)(component), OK);
        (api.free_instance)(component);
    }
    assert_eq!(environment.seen.get(), 1);
}
