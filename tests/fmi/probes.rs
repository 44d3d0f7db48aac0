//! Probes of the interface, one misuse each, by name, by each standard with each contact model. Each runs in a process of its own,
//! so that a crash or a hang is reported under the probe's name and hides no other. The standard's own reference units fail at
//! some of them: they hang on a step that is NaN or infinite, accept an initialisation without fmi2SetupExperiment, blank names, fixed
//! parameters after the initialisation and noise as a state, and crash on null states.

use super::importer::{
    Api, Arguments, Client, ContactModel, DISCARD, ERROR, Fmi2, Fmi3, Handle, Journal, Line, OK, Patch, Profiles,
    RIGHT, Standard, WARNING, sideways,
};
use super::probes_fmi3;
use std::ffi::{CStr, CString, c_int};
use std::ops::Deref;
use std::process::{Command, Stdio};
use std::ptr::{dangling_mut, null, null_mut};
use std::time::{Duration, Instant};

/// Names the probe that a child process is to run.
const CHILD: &str = "WHEELRAIL_PROBE";
/// A probe takes some hundredths of a second; a machine may be loaded.
const PATIENCE: Duration = Duration::from_secs(600);

/// An error with a message; a reset leads on.
#[track_caller]
pub fn refuse(client: &Client, status: c_int) {
    client.expect(ERROR, status);
    assert!(client.last_message().starts_with(&client.api.standard.function("")));
    client.expect(OK, client.reset());
    client.make_coarse();
    client.start();
    advance(client, 0.0);
}

/// A discarded call with a message; the instance goes on as it is.
#[track_caller]
pub fn discard(client: &Client, status: c_int) {
    client.expect(DISCARD, status);
    assert!(client.last_message().contains("allowed is"));
    advance(client, 0.0);
}

/// A step, after which all outputs are finite.
#[track_caller]
pub fn advance(client: &Client, time: f64) {
    client.expect(OK, client.step(time, 0.01));
    assert!(
        client
            .outputs()
            .into_iter()
            .all(|bits| f64::from_bits(bits).is_finite())
    );
}

/// What a probe is given: the library, and the contact model of its instances.
pub struct Given {
    api: Api,
    pub contact: ContactModel,
}

impl Deref for Given {
    type Target = Api;

    fn deref(&self) -> &Api {
        &self.api
    }
}

/// *stepComplete*, with a wheel that slips.
pub fn running(api: &Given) -> Client<'_> {
    Client::running(api, api.contact, &[("creepage", 0.004)])
}

/// A state that has been freed.
fn freed(client: &Client) -> Handle {
    let handle = client.save();
    // SAFETY: a state of the instance.
    client.expect(OK, unsafe {
        client.api.free_state(client.component, &mut handle.clone())
    });
    handle
}

/// Makes a state of bytes; null must remain where nothing was made.
fn deserialize(client: &Client, bytes: &[u8]) -> c_int {
    let mut handle = null_mut();
    let status = client.deserialize(bytes, &mut handle);
    assert_eq!(status == OK, !handle.is_null());
    status
}

fn derivative(client: &Client, unknown: u32, known: u32, direction: f64) -> c_int {
    let (api, c) = (client.api, client.component);
    // SAFETY: one element each.
    unsafe { api.directional_derivative(c, &unknown, 1, &known, 1, &direction, &mut 0.0) }
}

fn output_rate(client: &Client, reference: u32, order: c_int) -> c_int {
    // SAFETY: one element each.
    unsafe {
        client
            .api
            .get_output_derivatives(client.component, &reference, 1, &order, &mut 0.0)
    }
}

/// The five status queries of FMI 2.0.
fn statuses(client: &Client, kind: c_int) -> [c_int; 5] {
    let (api, c) = (&client.api.fmi2, client.component);
    // SAFETY: valid places.
    unsafe {
        [
            (api.fmi2GetStatus)(c, kind, &mut 0),
            (api.fmi2GetRealStatus)(c, kind, &mut 0.0),
            (api.fmi2GetIntegerStatus)(c, kind, &mut 0),
            (api.fmi2GetBooleanStatus)(c, kind, &mut 0),
            (api.fmi2GetStringStatus)(c, kind, &mut null()),
        ]
    }
}

/// Functions that take an instance, called with a null pointer instead, and with other arguments that are wrong.
fn without_instance(api: &Api) -> Vec<c_int> {
    let (c, n) = (null_mut(), null());
    // SAFETY: the library follows no pointer without an instance.
    unsafe {
        api.free_instance(c);
        let mut statuses = vec![
            api.set_debug_logging(c, 1, 1, n),
            api.enter_initialization(c),
            api.exit_initialization(c),
            api.terminate(c),
            api.reset(c),
            api.get_real(c, null(), 1, null_mut()),
            api.get_integer(c, null(), 1, null_mut()),
            api.get_boolean(c, null(), 1, null_mut()),
            api.get_string(c, null(), 1, null_mut()),
            api.set_real(c, null(), 1, null()),
            api.set_integer(c, null(), 1, null()),
            api.set_boolean(c, null(), 1, null()),
            api.set_string(c, null(), 1, null()),
            api.get_state(c, null_mut()),
            api.set_state(c, null_mut()),
            api.free_state(c, null_mut()),
            api.serialized_size(c, null_mut(), null_mut()),
            api.serialize(c, null_mut(), null_mut(), 1),
            api.deserialize(c, null(), 1, null_mut()),
            api.directional_derivative(c, null(), 1, null(), 1, null(), null_mut()),
            api.get_output_derivatives(c, null(), 1, null(), null_mut()),
        ];
        statuses.extend(match api.standard {
            Fmi2 => {
                let api = &api.fmi2;
                [
                    (api.fmi2SetupExperiment)(c, 0, 0.0, 0.0, 0, 0.0),
                    (api.fmi2SetRealInputDerivatives)(c, null(), 1, null(), null()),
                    (api.fmi2DoStep)(c, 0.0, f64::NAN, 1),
                    (api.fmi2CancelStep)(c),
                    (api.fmi2GetStatus)(c, 0, null_mut()),
                    (api.fmi2GetRealStatus)(c, 2, null_mut()),
                    (api.fmi2GetIntegerStatus)(c, 0, null_mut()),
                    (api.fmi2GetBooleanStatus)(c, 3, null_mut()),
                    (api.fmi2GetStringStatus)(c, 1, null_mut()),
                ]
            }
            Fmi3 => {
                let (api, none) = (&api.fmi3, null_mut());
                [
                    (api.fmi3DoStep)(c, 0.0, f64::NAN, 1, null_mut(), null_mut(), null_mut(), null_mut()),
                    (api.fmi3GetAdjointDerivative)(c, null(), 1, null(), 1, null(), 1, null_mut(), 1),
                    (api.fmi3EnterConfigurationMode)(c),
                    (api.fmi3ExitConfigurationMode)(c),
                    (api.fmi3GetBinary)(c, null(), 1, none, null_mut(), 1),
                    (api.fmi3SetBinary)(c, null(), 1, null(), null(), 1),
                    (api.fmi3GetClock)(c, null(), 1, null_mut()),
                    (api.fmi3UpdateDiscreteStates)(
                        c,
                        null_mut(),
                        null_mut(),
                        null_mut(),
                        null_mut(),
                        null_mut(),
                        null_mut(),
                    ),
                    (api.fmi3GetVariableDependencies)(c, 0, none, null_mut(), none, null_mut(), 1),
                ]
            }
        });
        statuses
    }
}

/// A misuse, by each standard or by one alone.
pub struct Probe {
    pub name: &'static str,
    pub standard: Option<Standard>,
    pub run: fn(&Given),
}

macro_rules! probes {
    (@standard) => { None };
    (@standard $standard:ident) => { Some($standard) };
    ($($name:literal $(of $standard:ident)?: |$api:ident| $body:block)*) => {
        pub const PROBES: &[$crate::probes::Probe] = &[$($crate::probes::Probe {
            name: $name,
            standard: $crate::probes::probes!(@standard $($standard)?),
            run: |$api| {
                #[allow(unused_unsafe)]
                // SAFETY: pointers are null, or valid for the counts beside them but where a count cannot be; states are never
                // followed.
                unsafe { $body }
            },
        }),*];
    };
}
pub(crate) use probes;

probes! {
    // fmi2GetVersion, fmi2GetTypesPlatform
    "the version is 2.0, without an instance" of Fmi2: |api| { assert_eq!(CStr::from_ptr((api.fmi2.fmi2GetVersion)()), c"2.0") }
    "the types platform is default, without an instance" of Fmi2: |api| {
        assert_eq!(CStr::from_ptr((api.fmi2.fmi2GetTypesPlatform)()), c"default");
    }

    // Instantiation
    "right arguments make an instance": |api| { assert!(api.instantiates(&RIGHT)) }
    "a null name makes none": |api| { assert!(!api.instantiates(&Arguments { name: null(), ..RIGHT })) }
    "an empty name makes none": |api| { assert!(!api.instantiates(&Arguments { name: c"".as_ptr(), ..RIGHT })) }
    "a blank name makes none": |api| { assert!(!api.instantiates(&Arguments { name: c" \t\r\n".as_ptr(), ..RIGHT })) }
    "a name of a million letters makes one": |api| {
        let name = CString::new(vec![b'x'; 1_000_000]).unwrap();
        assert!(api.instantiates(&Arguments { name: name.as_ptr(), ..RIGHT }));
    }
    "a name that is not UTF-8 makes one": |api| {
        assert!(api.instantiates(&Arguments { name: c"\xff\xfe".as_ptr(), ..RIGHT }));
    }
    "a null token makes none": |api| { assert!(!api.instantiates(&Arguments { token: Some(null()), ..RIGHT })) }
    "an empty token makes none": |api| { assert!(!api.instantiates(&Arguments { token: Some(c"".as_ptr()), ..RIGHT })) }
    "a token with a letter more makes none": |api| {
        let longer = CString::new([api.standard.token().as_bytes(), b"}"].concat()).unwrap();
        assert!(!api.instantiates(&Arguments { token: Some(longer.as_ptr()), ..RIGHT }));
    }
    "a token without braces makes none": |api| {
        let token = api.standard.token();
        let inner = CString::new(token.to_str().unwrap().trim_matches(['{', '}'])).unwrap();
        assert!(!api.instantiates(&Arguments { token: Some(inner.as_ptr()), ..RIGHT }));
    }
    "the token of the other standard makes none": |api| {
        let other = api.standard.other().token();
        assert!(!api.instantiates(&Arguments { token: Some(other.as_ptr()), ..RIGHT }));
    }
    "model exchange makes none": |api| { assert!(!api.instantiates(&Arguments { kind: 0, ..RIGHT })) }
    "a type that the standard does not know makes none" of Fmi2: |api| {
        assert!(!api.instantiates(&Arguments { kind: c_int::MIN, ..RIGHT }));
    }
    "null callbacks make none" of Fmi2: |api| {
        let instance = (api.fmi2.fmi2Instantiate)(c"probe".as_ptr(), 1, Fmi2.token().as_ptr(), null(), null(), 0, 1);
        assert!(instance.is_null());
    }
    "callbacks that are all null make one": |api| {
        assert!(api.instantiates(&Arguments { logging: 1, ..RIGHT }));
        assert!(!api.instantiates(&Arguments { logging: 1, name: null(), ..RIGHT }));
    }
    "a null resource location makes one": |api| { assert!(api.instantiates(&Arguments { location: null(), ..RIGHT })) }
    "a resource location that is none makes one": |api| {
        let journal = Journal::default();
        for location in [c"", c"%", c"%zz%f", c"file:", c"file://", c"\xff", c"http://a/b"] {
            let arguments = Arguments { location: location.as_ptr(), logging: 1, journal: Some(&journal), ..RIGHT };
            assert!(api.instantiates(&arguments));
        }
    }
    "booleans other than 0 and 1 are true": |api| { assert!(api.instantiates(&Arguments { logging: -7, ..RIGHT })) }
    "a name with % and # is no format": |api| {
        let journal = Journal::default();
        let token = Some(c"%s%n#r1#".as_ptr());
        assert!(!api.instantiates(&Arguments { token, journal: Some(&journal), ..RIGHT }));
        let message = journal.take().pop().unwrap();
        assert_eq!(message.format, if api.standard == Fmi2 { "%s" } else { "" });
        assert!(message.text.contains("%s%n##r1##"), "{message:?}");
    }
    "two instances may have one name": |api| {
        let (first, second) = (running(api), running(api));
        advance(&first, 0.0);
        advance(&second, 0.0);
        assert_eq!(first.outputs(), second.outputs());
    }

    // A null instance, fmi2FreeInstance
    "no function crashes on a null instance": |api| {
        assert_eq!(without_instance(api), [ERROR; 30]);
    }
    "an instance in error can be freed, with states": |api| {
        let client = running(api);
        client.save();
        client.expect(ERROR, client.enter());
        client.save();
    }

    // fmi2SetDebugLogging
    "null log categories are refused": |api| {
        let client = running(api);
        refuse(&client, api.set_debug_logging(client.component, 1, 1, null()));
    }
    "a log category that is null is refused": |api| {
        let client = running(api);
        refuse(&client, api.set_debug_logging(client.component, 1, 1, [null()].as_ptr()));
    }
    "a log category that is not declared is refused": |api| {
        let client = running(api);
        refuse(&client, api.set_debug_logging(client.component, 1, 1, [c"logAll%n".as_ptr()].as_ptr()));
    }
    "no log categories need no pointer": |api| {
        let client = running(api);
        client.expect(OK, api.set_debug_logging(client.component, 1, 0, null()));
    }

    // fmi2SetupExperiment
    "a start time that is NaN is refused": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.begin(f64::NAN, None));
    }
    "a start time that is infinite is refused": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.begin(f64::NEG_INFINITY, None));
    }
    "a stop time that is NaN is refused": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.begin(0.0, Some(f64::NAN)));
    }
    "a stop time before the start time is refused": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.begin(1.0, Some(0.5)));
    }
    "a tolerance that is NaN does no harm": |api| {
        let client = Client::coarse(api, api.contact);
        client.expect(OK, match api.standard {
            Fmi2 => match (api.fmi2.fmi2SetupExperiment)(client.component, 1, f64::NAN, 0.0, 0, f64::NAN) {
                OK => client.enter(),
                status => status,
            },
            Fmi3 => (api.fmi3.fmi3EnterInitializationMode)(client.component, 1, f64::NAN, 0.0, 0, f64::NAN),
        });
        client.expect(OK, client.exit());
        advance(&client, 0.0);
    }
    "a start time other than 0 is where the steps begin": |api| {
        let client = Client::coarse(api, api.contact);
        client.expect(OK, client.begin(-1e3, Some(1e3)));
        client.expect(OK, client.exit());
        advance(&client, -1e3);
    }
    "an experiment is not set up twice over the initialisation" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, client.setup(0.0, None));
    }

    // fmi2EnterInitializationMode, fmi2ExitInitializationMode
    "no initialisation without fmi2SetupExperiment" of Fmi2: |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.enter());
    }
    "fmi2Reset forgets the experiment" of Fmi2: |api| {
        let client = Client::initializing(api, api.contact);
        client.expect(OK, client.reset());
        refuse(&client, client.enter());
    }
    "the initialisation is not entered twice": |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, client.enter());
    }
    "the initialisation is not entered after a step": |api| {
        let client = running(api);
        advance(&client, 0.0);
        refuse(&client, client.enter());
    }
    "the initialisation does not end before it begins": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.exit());
    }
    "the initialisation does not end twice": |api| {
        let client = running(api);
        refuse(&client, client.exit());
    }
    "parameters that do not fit together end no initialisation": |api| {
        let client = Client::initializing(api, api.contact);
        client.expect(OK, client.set(&[("friction_hot", 0.9)]));
        refuse(&client, client.exit());
    }

    // fmi2GetXXX, fmi2SetXXX
    "nothing is read before the initialisation" of Fmi2: |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.get_references(&[api.reference("normal_load")], &mut [0.0]));
    }
    "an unknown Real is not read": |api| {
        let client = running(api);
        refuse(&client, client.get_references(&[u32::MAX], &mut [0.0]));
    }
    "an unknown Real among known ones is not read": |api| {
        let client = running(api);
        refuse(&client, client.get_references(&[api.reference("normal_load"), 999_999], &mut [0.0; 2]));
    }
    "an unknown Integer is not read": |api| {
        let client = running(api);
        refuse(&client, api.get_integer(client.component, &u32::MAX, 1, &mut 0));
    }
    "an unknown Boolean is not read": |api| {
        let client = running(api);
        refuse(&client, api.get_boolean(client.component, &0, 1, &mut 0));
    }
    "an unknown String is not read": |api| {
        let client = running(api);
        refuse(&client, api.get_string(client.component, &0, 1, &mut null()));
    }
    "an Integer is not read as a Real": |api| {
        let client = running(api);
        refuse(&client, client.get_references(&[api.reference("control")], &mut [0.0]));
    }
    "an unknown Real is not set": |api| {
        let client = running(api);
        refuse(&client, api.set_real(client.component, &u32::MAX, 1, &0.0));
    }
    "an unknown Integer is not set": |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, api.set_integer(client.component, &u32::MAX, 1, &0));
    }
    "an unknown Boolean is not set": |api| {
        let client = running(api);
        refuse(&client, api.set_boolean(client.component, &0, 1, &1));
    }
    "an unknown String is not set": |api| {
        let client = running(api);
        refuse(&client, api.set_string(client.component, &0, 1, &null()));
    }
    "null value references are not read": |api| {
        let client = running(api);
        refuse(&client, api.get_real(client.component, null(), 1, &mut 0.0));
    }
    "nothing is read to a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.get_real(client.component, &api.reference("normal_load"), 1, null_mut()));
    }
    "null value references are not set": |api| {
        let client = running(api);
        refuse(&client, api.set_real(client.component, null(), 1, &0.0));
    }
    "nothing is set from a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.set_real(client.component, &api.reference("normal_load"), 1, null()));
    }
    "more values than memory holds are not read": |api| {
        let client = running(api);
        refuse(&client, api.get_real(client.component, [0].as_ptr(), usize::MAX, [0.0].as_mut_ptr()));
    }
    "more values than memory holds are not set": |api| {
        let client = running(api);
        refuse(&client, api.set_integer(client.component, [0].as_ptr(), usize::MAX, [0].as_ptr()));
    }
    "no values need no pointers": |api| {
        let client = running(api);
        client.expect(OK, api.get_real(client.component, null(), 0, null_mut()));
        client.expect(OK, api.set_string(client.component, null(), 0, null()));
        advance(&client, 0.0);
    }
    "of a variable that is set twice the last value counts": |api| {
        let client = running(api);
        client.expect(OK, client.set(&[("normal_load", 3e4), ("normal_load", 4e4)]));
        assert_eq!(client.get("normal_load"), 4e4);
    }
    "an output is not set": |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, client.set(&[("traction_force", 0.0)]));
    }
    "a local variable is not set": |api| {
        let client = running(api);
        refuse(&client, client.set(&[("profile.pressure[31]", 0.0)]));
    }
    "a fixed Real parameter is not set after the initialisation": |api| {
        let client = running(api);
        refuse(&client, client.set(&[("wheel_radius", 0.46)]));
    }
    "a fixed Integer parameter is not set after the initialisation": |api| {
        let client = running(api);
        refuse(&client, client.set_integers(&[("control", 1)]));
    }
    "a tunable parameter is set after the initialisation": |api| {
        let client = running(api);
        client.expect(OK, client.set(&[("friction_cold", 0.4)]));
        advance(&client, 0.0);
    }
    "nothing is set after the end": |api| {
        let client = running(api);
        client.expect(OK, client.terminate());
        refuse(&client, client.set(&[("normal_load", 5e4)]));
    }
    "an input that is NaN is discarded": |api| {
        let client = running(api);
        discard(&client, client.set(&[("normal_load", f64::NAN)]));
    }
    "an input that is infinite is discarded": |api| {
        let client = running(api);
        discard(&client, client.set(&[("wheel_speed", f64::INFINITY)]));
    }
    "an input beyond its range is discarded": |api| {
        let client = running(api);
        discard(&client, client.set(&[("creepage", f64::MAX)]));
    }
    "lateral or spin motion that is not finite or beyond its range is discarded": |api| {
        for (name, _) in sideways(Patch) {
            for value in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -1001.0] {
                let client = running(api);
                discard(&client, client.set(&[("creepage", 0.01), (name, value)]));
                assert_eq!(client.get("creepage"), 0.004);
            }
        }
    }
    "lateral and spin motion is discarded by a line contact and taken by a patch": |api| {
        for (name, value) in sideways(Patch) {
            let client = running(api);
            let status = client.set(&[(name, 2.0 * value)]);
            match api.contact {
                Line => {
                    client.expect(DISCARD, status);
                    assert!(client.last_message().contains(&format!("{name} = {}: must be 0", 2.0 * value)));
                }
                Patch | Profiles => client.expect(OK, status),
            }
            advance(&client, 0.0);
        }
    }
    "the contact model is not changed after the initialisation": |api| {
        let client = running(api);
        refuse(&client, client.set_integers(&[("contact_model", 1)]));
    }
    "a state of the other contact model is none": |api| {
        let other = Client::running(api, if api.contact == Line { Patch } else { Line }, &[]);
        let client = running(api);
        refuse(&client, deserialize(&client, &other.serialize(other.save())));
    }
    "a parameter that is NaN is discarded": |api| {
        let client = running(api);
        discard(&client, client.set(&[("friction_cold", f64::NAN)]));
    }
    "an Integer beyond its range is discarded": |api| {
        let client = Client::initializing(api, api.contact);
        client.expect(DISCARD, client.set_integers(&[("contact_nodes", c_int::MAX)]));
        client.expect(OK, client.exit());
        advance(&client, 0.0);
    }
    "of a vector with a value that cannot be nothing is set": |api| {
        let client = running(api);
        discard(&client, client.set(&[("normal_load", 1e4), ("creepage", f64::NAN)]));
        assert_eq!(client.get("normal_load"), 6e4);
    }
    "subnormal inputs lead to finite outputs": |api| {
        let client = running(api);
        let both = ["creepage", "wheel_speed", "friction_scale", "normal_load"];
        for name in sideways(api.contact).iter().map(|(name, _)| *name).chain(both) {
            client.expect(OK, client.set(&[(name, 5e-324)]));
        }
        advance(&client, 0.0);
    }

    // fmi2DoStep
    "a step that is NaN is refused": |api| { let client = running(api); refuse(&client, client.step(0.0, f64::NAN)); }
    "a step that is infinite is refused": |api| {
        let client = running(api);
        refuse(&client, client.step(0.0, f64::INFINITY));
    }
    "a step that is minus infinity is refused": |api| {
        let client = running(api);
        refuse(&client, client.step(0.0, f64::NEG_INFINITY));
    }
    "a step of 0 is refused": |api| { let client = running(api); refuse(&client, client.step(0.0, 0.0)); }
    "a negative step is refused": |api| { let client = running(api); refuse(&client, client.step(0.0, -1e-3)); }
    "a step of 1e300 s comes to an end": |api| {
        let client = running(api);
        client.expect(OK, client.step(0.0, 1e300));
        assert!(client.outputs().into_iter().all(|bits| f64::from_bits(bits).is_finite()));
    }
    "a jump within a subnormal step leaves finite rates and a state that can be kept": |api| {
        let client = running(api);
        client.expect(OK, client.set(&[("creepage", -0.1), ("normal_load", 2e4)]));
        client.expect(OK, client.step(0.0, 5e-324));
        let mut rate = f64::NAN;
        let force = api.reference("traction_force");
        client.expect(OK, api.get_output_derivatives(client.component, &force, 1, &1, &mut rate));
        assert!(rate.is_finite());
        client.expect(OK, deserialize(&client, &client.serialize(client.save())));
        advance(&client, 0.0);
    }
    "a communication point that is NaN is refused": |api| {
        let client = running(api);
        refuse(&client, client.step(f64::NAN, 0.01));
    }
    "a communication point that is infinite is refused": |api| {
        let client = running(api);
        refuse(&client, client.step(f64::INFINITY, 0.01));
    }
    "a communication point ahead is refused": |api| { let client = running(api); refuse(&client, client.step(0.5, 0.01)); }
    "a communication point behind is refused": |api| {
        let client = running(api);
        advance(&client, 0.0);
        refuse(&client, client.step(0.0, 0.01));
    }
    "a step beyond the stop time is refused": |api| {
        let client = Client::coarse(api, api.contact);
        client.expect(OK, client.begin(0.0, Some(0.02)));
        client.expect(OK, client.exit());
        refuse(&client, client.step(0.0, 0.03));
    }
    "no step before the initialisation": |api| { let client = Client::coarse(api, api.contact); refuse(&client, client.step(0.0, 0.01)); }
    "no step during the initialisation": |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, client.step(0.0, 0.01));
    }
    "no step after the end": |api| {
        let client = running(api);
        client.expect(OK, client.terminate());
        refuse(&client, client.step(0.0, 0.01));
    }
    "no step after an error": |api| {
        let client = running(api);
        client.expect(ERROR, client.enter());
        refuse(&client, client.step(0.0, 0.01));
    }

    // fmi2GetFMUstate, fmi2SetFMUstate, fmi2FreeFMUstate
    "nothing is saved to a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.get_state(client.component, null_mut()));
    }
    "nothing is saved to a wild state": |api| {
        let client = running(api);
        refuse(&client, api.get_state(client.component, &mut dangling_mut::<u64>().cast()));
    }
    "a null state is not restored": |api| { let client = running(api); refuse(&client, client.restore(null_mut())); }
    "a wild state is not restored": |api| {
        let client = running(api);
        refuse(&client, client.restore(usize::MAX as Handle));
    }
    "a state that was freed is not restored": |api| {
        let client = running(api);
        refuse(&client, client.restore(freed(&client)));
    }
    "another instance's state is not restored": |api| {
        let (client, other) = (running(api), running(api));
        refuse(&client, client.restore(other.save()));
    }
    "nothing is freed at a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.free_state(client.component, null_mut()));
    }
    "a null state is freed without effect": |api| {
        let client = running(api);
        client.expect(OK, api.free_state(client.component, &mut null_mut()));
        advance(&client, 0.0);
    }
    "a state is not freed twice": |api| {
        let client = running(api);
        refuse(&client, api.free_state(client.component, &mut freed(&client)));
    }
    "a wild state is not freed": |api| {
        let client = running(api);
        refuse(&client, api.free_state(client.component, &mut dangling_mut::<u64>().cast()));
    }
    "a state outlives error and reset": |api| {
        let client = running(api);
        let handle = client.save();
        refuse(&client, client.enter());
        client.expect(OK, client.restore(handle));
        advance(&client, 0.0);
    }

    // fmi2SerializedFMUstateSize, fmi2SerializeFMUstate, fmi2DeSerializeFMUstate
    "a null state has no size": |api| {
        let client = running(api);
        refuse(&client, api.serialized_size(client.component, null_mut(), &mut 0));
    }
    "a size has no place at a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.serialized_size(client.component, client.save(), null_mut()));
    }
    "a null state is not serialized": |api| {
        let client = running(api);
        refuse(&client, api.serialize(client.component, null_mut(), [0].as_mut_ptr(), 1));
    }
    "nothing is serialized to a null pointer": |api| {
        let client = running(api);
        refuse(&client, api.serialize(client.component, client.save(), null_mut(), 1));
    }
    "nothing is serialized to a place that is too small": |api| {
        let client = running(api);
        refuse(&client, api.serialize(client.component, client.save(), [0].as_mut_ptr(), 1));
    }
    "null bytes are no state": |api| {
        let client = running(api);
        refuse(&client, api.deserialize(client.component, null(), 1, &mut null_mut()));
    }
    "bytes are not deserialized to a null pointer": |api| {
        let client = running(api);
        let bytes = client.serialize(client.save());
        refuse(&client, api.deserialize(client.component, bytes.as_ptr().cast(), bytes.len(), null_mut()));
    }
    "no bytes are no state": |api| { let client = running(api); refuse(&client, deserialize(&client, &[])); }
    "noise is no state": |api| {
        let client = running(api);
        let noise: Vec<u8> = (0..4000_u32).map(|k| (k.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
        refuse(&client, deserialize(&client, &noise));
    }
    "zeros as long as a state are no state": |api| {
        let client = running(api);
        let length = client.serialize(client.save()).len();
        refuse(&client, deserialize(&client, &vec![0; length]));
    }
    "a state without its last byte is none": |api| {
        let client = running(api);
        let bytes = client.serialize(client.save());
        refuse(&client, deserialize(&client, &bytes[..bytes.len() - 1]));
    }
    "a state with a byte more is none": |api| {
        let client = running(api);
        let bytes = client.serialize(client.save());
        refuse(&client, deserialize(&client, &[&bytes[..], &[0]].concat()));
    }
    "a state with a bit flipped is none": |api| {
        let client = running(api);
        let mut bytes = client.serialize(client.save());
        let middle = bytes.len() / 2;
        bytes[middle] ^= 1;
        refuse(&client, deserialize(&client, &bytes));
    }
    "a state of other fixed parameters is none": |api| {
        let other = Client::running(api, api.contact, &[("wheel_radius", 0.45)]);
        let client = running(api);
        refuse(&client, deserialize(&client, &other.serialize(other.save())));
    }

    // fmi2GetDirectionalDerivative
    "there is no derivative of an input": |api| {
        let client = running(api);
        let input = api.reference("creepage");
        refuse(&client, derivative(&client, input, input, 1.0));
    }
    "there is no derivative with respect to a parameter": |api| {
        let client = running(api);
        refuse(&client, derivative(&client, api.reference("traction_force"), api.reference("friction_cold"), 1.0));
    }
    "a direction that is NaN is refused": |api| {
        let client = running(api);
        refuse(&client, derivative(&client, api.reference("traction_force"), api.reference("creepage"), f64::NAN));
    }
    "a null direction is refused": |api| {
        let client = running(api);
        let (output, input) = (api.reference("traction_force"), api.reference("creepage"));
        refuse(&client, api.directional_derivative(client.component, &output, 1, &input, 1, null(), &mut 0.0));
    }
    "there is no derivative before the initialisation": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, derivative(&client, api.reference("traction_force"), api.reference("creepage"), 1.0));
    }
    "a derivative in no direction is 0": |api| {
        let client = running(api);
        let mut value = f64::NAN;
        let output = api.reference("traction_force");
        client.expect(OK, api.directional_derivative(client.component, &output, 1, null(), 0, null(), &mut value));
        assert_eq!(value, 0.0);
    }

    // fmi2SetRealInputDerivatives, fmi2GetRealOutputDerivatives
    "an input derivative of order 0 is refused" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, client.set_rates(&[("creepage", 0, 1.0)]));
    }
    "an input derivative of order 2 is warned of" of Fmi2: |api| {
        let client = running(api);
        client.expect(WARNING, client.set_rates(&[("creepage", 2, 1.0)]));
        advance(&client, 0.0);
    }
    "an input derivative that is NaN is discarded" of Fmi2: |api| {
        let client = running(api);
        discard(&client, client.set_rates(&[("creepage", 1, f64::NAN)]));
    }
    "an input derivative that leads out of the range fails the step alone" of Fmi2: |api| {
        let client = running(api);
        let handle = client.save();
        client.expect(OK, client.set_rates(&[("normal_load", 1, 1e300)]));
        client.expect(ERROR, client.step(0.0, 0.01));
        client.expect(OK, client.restore(handle));
        advance(&client, 0.0);
    }
    "an input derivative of lateral or spin motion that leads out of the range fails the step alone" of Fmi2: |api| {
        for (name, _) in sideways(Patch) {
            let client = running(api);
            let (handle, before) = (client.save(), client.outputs());
            client.expect(OK, client.set_rates(&[(name, 1, -1e300)]));
            client.expect(ERROR, client.step(0.0, 0.01));
            assert!(client.last_message().contains(&format!("{name} = ")));
            assert_eq!(client.outputs(), before);
            client.expect(OK, client.restore(handle));
            advance(&client, 0.0);
        }
    }
    "an output has no input derivative" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, client.set_rates(&[("traction_force", 1, 1.0)]));
    }
    "null orders are refused" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, (api.fmi2.fmi2SetRealInputDerivatives)(client.component, &api.reference("creepage"), 1, null(), &0.0));
    }
    "an output derivative of order 0 is refused": |api| {
        let client = running(api);
        refuse(&client, output_rate(&client, api.reference("traction_force"), 0));
    }
    "an input has no output derivative": |api| {
        let client = running(api);
        refuse(&client, output_rate(&client, api.reference("creepage"), 1));
    }
    "there are no output derivatives during the initialisation": |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, output_rate(&client, api.reference("traction_force"), 1));
    }

    // fmi2CancelStep, fmi2GetStatus and relatives
    "there is no step to cancel" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, (api.fmi2.fmi2CancelStep)(client.component));
    }
    "unknown status kinds are discarded" of Fmi2: |api| {
        let client = running(api);
        for kind in [c_int::MIN, -1, 4, c_int::MAX] {
            assert_eq!(statuses(&client, kind), [DISCARD; 5]);
        }
        advance(&client, 0.0);
    }
    "no step is ever pending" of Fmi2: |api| {
        let client = running(api);
        assert_eq!(statuses(&client, 0), [DISCARD; 5]);
        assert_eq!(statuses(&client, 1), [DISCARD; 5]);
    }
    "the last successful time is that of the last step" of Fmi2: |api| {
        let client = running(api);
        advance(&client, 0.0);
        let mut time = f64::NAN;
        client.expect(OK, (api.fmi2.fmi2GetRealStatus)(client.component, 2, &mut time));
        assert_eq!(time, 0.01);
    }
    "a status has no place at a null pointer" of Fmi2: |api| {
        let client = running(api);
        refuse(&client, (api.fmi2.fmi2GetRealStatus)(client.component, 2, null_mut()));
    }
    "there is no status before the first step is possible" of Fmi2: |api| {
        let client = Client::initializing(api, api.contact);
        refuse(&client, (api.fmi2.fmi2GetRealStatus)(client.component, 2, &mut 0.0));
    }

    // fmi2Terminate, fmi2Reset
    "nothing is terminated before the initialisation": |api| {
        let client = Client::coarse(api, api.contact);
        refuse(&client, client.terminate());
    }
    "nothing is terminated twice": |api| {
        let client = running(api);
        client.expect(OK, client.terminate());
        refuse(&client, client.terminate());
    }
    "a reset twice does no harm": |api| {
        let client = running(api);
        client.expect(OK, client.reset());
        client.expect(OK, client.reset());
        client.expect(OK, client.begin(0.0, None));
        client.expect(OK, client.exit());
        advance(&client, 0.0);
    }
}

/// All probes.
pub fn all() -> impl Iterator<Item = &'static Probe> {
    PROBES.iter().chain(probes_fmi3::PROBES)
}

/// Runs a probe by the standards that it is of, with each contact model.
pub fn run(probe: &Probe) {
    for standard in Standard::ALL {
        if probe.standard.is_some_and(|own| own != standard) {
            continue;
        }
        for contact in [Line, Patch] {
            println!("{standard:?}, {contact:?}: {}", probe.name);
            (probe.run)(&Given {
                api: Api::load(standard),
                contact,
            });
        }
    }
}

/// How a probe ended that did not pass.
fn failure(name: &str) -> Option<String> {
    let mut child = Command::new(std::env::current_exe().expect("a path"))
        .args(["--exact", "probes::every_probe_passes", "--nocapture"])
        .env(CHILD, name)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the child runs");
    let start = Instant::now();
    while child.try_wait().expect("the child's status").is_none() {
        if start.elapsed() > PATIENCE {
            child.kill().expect("the child ends");
            return Some(format!("{name}: hangs"));
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    let output = child.wait_with_output().expect("the child's output");
    let message = String::from_utf8_lossy(&output.stderr);
    let told = String::from_utf8_lossy(&output.stdout);
    // Were this test renamed, the child would run none and succeed.
    let ran = told.contains("1 passed");
    (!output.status.success() || !ran).then(|| format!("{name}: {}: {told}{message}", output.status))
}

#[test]
fn every_probe_passes() {
    if let Ok(name) = std::env::var(CHILD) {
        run(all().find(|probe| probe.name == name).expect("a probe"));
        return;
    }
    let mut names: Vec<&str> = all().map(|probe| probe.name).collect();
    names.sort_unstable();
    names.dedup();
    assert_eq!(names.len(), all().count(), "two probes have one name");
    let failures: Vec<String> = all().filter_map(|probe| failure(probe.name)).collect();
    let of = |standard| {
        all()
            .filter(|probe| probe.standard.is_none_or(|own| own == standard))
            .count()
    };
    println!("{} of {} probes passed", names.len() - failures.len(), names.len());
    println!("{} by FMI 2.0, {} by FMI 3.0", of(Fmi2), of(Fmi3));
    assert!(failures.is_empty(), "{}", failures.join("\n"));
}
