//! Messages: where they go, what they look like, when there are none.

use super::importer::{
    Api, Client, Component, ContactModel, DISCARD, ERROR, Fmi2, Fmi3, Message, NO_CALLBACKS, OK, RIGHT, Standard,
    WARNING, with_each, with_each_standard,
};
use std::cell::Cell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{null, null_mut};
use wheelrail::fmi2::types::{CallbackFunctions, LoggerCallback};
use wheelrail::fmi3::types::{LogMessageCallback, Status};

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
    unsafe {
        client
            .api
            .set_debug_logging(client.component, c_int::from(on), pointers.len(), pointers.as_ptr())
    }
}

fn categories(messages: &[Message]) -> Vec<&str> {
    let mut names: Vec<_> = messages.iter().map(|message| message.category.as_str()).collect();
    names.sort_unstable();
    names.dedup();
    names
}

#[test]
fn nothing_is_logged_when_logging_is_off_and_nothing_is_wrong() {
    with_each_standard(|api| {
        let client = Client::given(api, RIGHT);
        good_life(&client);
        assert_eq!(client.journal.take(), []);
    });
}

/// Without being asked for, FMI 3.0 tells the reasons of errors alone, but those always.
#[test]
fn without_logging_errors_are_told() {
    let api = Api::load(Fmi3);
    let client = Client::given(&api, RIGHT);
    client.expect(DISCARD, client.set(&[("normal_load", -1.0)]));
    assert_eq!(client.journal.take(), []);
    client.expect(OK, set_debug_logging(&client, false, &[]));
    client.expect(ERROR, client.step(0.0, 1.0));
    assert_eq!(categories(&client.journal.take()), ["logStatusError"]);
}

#[test]
fn the_reason_of_a_failed_call_is_told_until_it_is_switched_off() {
    with_each_standard(|api| {
        let client = Client::new(api);
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
        client.expect(OK, client.reset());
        client.expect(DISCARD, client.set(&[("normal_load", -1.0)]));
        assert_eq!(client.journal.take(), []);
        client.expect(ERROR, client.step(0.0, 1.0));
        // FMI 3.0 tells the reasons of errors always.
        let told = client.journal.take().len();
        assert_eq!(told, usize::from(api.standard == Fmi3));
    });
}

#[test]
fn with_logging_on_solver_and_events_are_told_with_ok() {
    with_each(|api, contact| {
        let mut client = Client::with_logging(api, true);
        client.contact = contact;
        good_life(&client);
        let messages = client.journal.take();
        assert_eq!(categories(&messages), ["logEvents", "logSolver"]);
        assert!(messages.iter().all(|message| message.status == OK));
    });
}

/// A value that the chosen slip_source does not use is told of once, at the first step that has it, with a warning; the step is
/// as it would be without.
#[test]
fn inputs_without_effect_are_told_of_once() {
    with_each(|api, contact| {
        for (number, used, unused) in [
            (
                1,
                [("creepage", 0.004), ("wheel_speed", 22.0)],
                [("vehicle_speed", 30.0), ("spin_rate", 0.5)],
            ),
            (
                2,
                [("vehicle_speed", 11.0), ("wheel_speed", 22.0)],
                [("creepage", 0.02), ("spin_creepage", 0.5)],
            ),
        ] {
            // A line takes no spin at all.
            let unused = &unused[..if contact == ContactModel::Patch { 2 } else { 1 }];
            let life = |unused: &[(&str, f64)]| {
                let mut client = Client::new(api);
                client.contact = contact;
                client.make_coarse();
                client.expect(OK, client.set_integers(&[("slip_source", number)]));
                client.start();
                client.expect(OK, client.set(&used));
                client.expect(OK, client.step(0.0, 1e-3));
                assert_eq!(client.journal.take(), []);
                client.expect(OK, client.set(unused));
                for step in 1..4 {
                    client.expect(OK, client.step(f64::from(step) * 1e-3, 1e-3));
                }
                let told = client.journal.take();
                let outputs = client.outputs();
                // As new after a reset: told of again.
                client.expect(OK, client.reset());
                client.make_coarse();
                client.expect(OK, client.set_integers(&[("slip_source", number)]));
                client.expect(OK, client.set(unused));
                client.start();
                client.expect(OK, client.step(0.0, 1e-3));
                assert_eq!(client.journal.take().len(), unused.len());
                (told, outputs)
            };
            let (told, outputs) = life(unused);
            assert_eq!(told.len(), unused.len());
            for (message, (name, value)) in told.iter().zip(unused) {
                assert_eq!(
                    (message.status, message.category.as_str()),
                    (WARNING, "logStatusWarning")
                );
                let (chosen, other) = (
                    format!("slip_source = {number} ("),
                    format!("slip_source = {} (", 3 - number),
                );
                for part in ["t = 0.001 s", &format!("{name} = {value}"), &chosen, &other] {
                    assert!(message.text.contains(part), "{} lacks {part}", message.text);
                }
            }
            let (silence, undisturbed) = life(&[]);
            assert_eq!((silence.len(), undisturbed), (0, outputs));
        }
    });
}

/// An importer that interpolates constant columns rounds their last bits, as FMPy does: nothing is told of them. A change of the
/// value is.
#[test]
fn start_values_that_an_importer_has_rounded_are_not_told_of() {
    with_each(|api, contact| {
        let mut client = Client::new(api);
        client.contact = contact;
        client.make_coarse();
        client.start();
        let rounded = [
            ("rolling_radius", 0.4600000000000001),
            ("transverse_curvature", 3.333333333333334),
        ];
        client.expect(OK, client.set(&rounded));
        client.expect(OK, client.step(0.0, 1e-3));
        assert_eq!(client.journal.take(), []);
        client.expect(OK, client.set(&[("rolling_radius", 0.4601)]));
        client.expect(OK, client.step(1e-3, 1e-3));
        let told = client.journal.take();
        assert_eq!(told.len(), 1);
        assert!(told[0].text.contains("rolling_radius = 0.4601 has no effect"));
    });
}

#[test]
fn categories_are_switched_one_by_one() {
    with_each_standard(|api| {
        for (chosen, name) in [(c"logEvents", "logEvents"), (c"logSolver", "logSolver")] {
            let client = Client::given(api, RIGHT);
            client.expect(OK, set_debug_logging(&client, true, &[chosen]));
            good_life(&client);
            client.expect(ERROR, client.step(0.0, 1.0));
            let expected: &[_] = match api.standard {
                // What is switched on excludes the rest.
                Fmi2 => &[name],
                Fmi3 => &[name, "logStatusError"],
            };
            assert_eq!(categories(&client.journal.take()), expected);
        }
        let client = Client::with_logging(api, true);
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
    });
}

#[test]
fn an_undeclared_category_is_an_error_and_changes_nothing() {
    with_each_standard(|api| {
        let client = Client::new(api);
        client.expect(ERROR, set_debug_logging(&client, true, &[c"logSolver", c"logNonsense"]));
        assert!(client.last_message().contains("logNonsense"));
        client.expect(OK, client.reset());
        good_life(&client);
        assert_eq!(client.journal.take(), []);
    });
}

#[test]
fn a_message_is_never_a_format_and_has_no_trailing_newline() {
    with_each_standard(|api| {
        let client = Client::new(api);
        for name in [c"%s%n%d", c"#r1#", c"a\n"] {
            client.expect(OK, client.reset());
            client.expect(ERROR, set_debug_logging(&client, true, &[name]));
        }
        let messages = client.journal.take();
        // FMI 3.0 hands over neither.
        let (format, name) = match api.standard {
            Fmi2 => ("%s", "wheel"),
            Fmi3 => ("", ""),
        };
        assert!(
            messages
                .iter()
                .all(|message| message.format == format && message.instance_name == name)
        );
        assert!(messages.iter().all(|message| !message.text.ends_with('\n')));
        assert!(messages[0].text.contains("%s%n%d"), "{messages:?}");
        assert!(
            messages[1].text.contains("##r1##"),
            "# starts a variable's name: {messages:?}"
        );
    });
}

/// FMI 3.0: a category that is switched on is on beside the others.
#[test]
fn categories_add_up() {
    let api = Api::load(Fmi3);
    let client = Client::new(&api);
    client.expect(OK, set_debug_logging(&client, true, &[c"logSolver"]));
    client.expect(OK, set_debug_logging(&client, true, &[c"logEvents"]));
    good_life(&client);
    assert_eq!(categories(&client.journal.take()), ["logEvents", "logSolver"]);
}

/// An importer whose logger reads a variable.
struct Host {
    api: Api,
    component: Cell<Component>,
    seen: Cell<usize>,
}

impl Host {
    fn read(&self) {
        self.seen.set(self.seen.get() + 1);
        let (reference, mut value) = (self.api.reference("normal_load"), 0.0);
        // SAFETY: one element; the instance is not borrowed while the logger runs.
        let status = unsafe { self.api.get_real(self.component.get(), &reference, 1, &mut value) };
        assert_eq!((status, value), (OK, 6e4));
    }
}

unsafe extern "C" fn logger(host: *mut c_void, _: *const c_char, _: c_int, _: *const c_char, _: *const c_char) {
    // SAFETY: the environment is the host of the test below.
    unsafe { &*host.cast::<Host>() }.read();
}

unsafe extern "C" fn log_message(host: *mut c_void, _: Status, _: *const c_char, _: *const c_char) {
    // SAFETY: as above.
    unsafe { &*host.cast::<Host>() }.read();
}

#[test]
fn the_logger_may_call_back_into_the_instance() {
    type Short = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char);
    for standard in Standard::ALL {
        let host = Host {
            api: Api::load(standard),
            component: Cell::new(null_mut()),
            seen: Cell::new(0),
        };
        let (api, token, environment) = (&host.api, standard.token(), (&raw const host).cast_mut().cast());
        let (name, token) = (c"a".as_ptr(), token.as_ptr());
        let callbacks = CallbackFunctions {
            // SAFETY: arguments beyond the fifth are not looked at.
            logger: Some(unsafe { std::mem::transmute::<Short, LoggerCallback>(logger as Short) }),
            component_environment: environment,
            ..NO_CALLBACKS
        };
        let log_message: LogMessageCallback = log_message;
        // SAFETY: valid pointers; one live instance.
        unsafe {
            let component = match standard {
                Fmi2 => (api.fmi2.fmi2Instantiate)(name, 1, token, null(), &callbacks, 0, 0),
                Fmi3 => (api.fmi3.fmi3InstantiateCoSimulation)(
                    name,
                    token,
                    null(),
                    0,
                    0,
                    0,
                    0,
                    null(),
                    0,
                    environment,
                    Some(log_message),
                    None,
                ),
            };
            host.component.set(component);
            if standard == Fmi2 {
                assert_eq!((api.fmi2.fmi2SetupExperiment)(component, 0, 0.0, 0.0, 0, 0.0), OK);
            }
            assert_eq!(api.enter_initialization(component), OK);
            // Any call that is an error.
            assert_eq!(api.reset(component), OK);
            assert_eq!(api.exit_initialization(component), ERROR);
            api.free_instance(component);
        }
        assert_eq!(host.seen.get(), 1);
    }
}
