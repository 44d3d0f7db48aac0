//! Random sequences of calls with arbitrary arguments (any bits as a double, any value reference, null pointers, absurd
//! sizes, wild handles, noise as states): only statuses of the standard come back, and the instance can always be reset
//! and run, with each contact model. `cargo test --test fmi2 sequences -- --nocapture` prints what was tried.

use super::calls::{Call, Odd, any_call};
use super::importer::{
    Api, Client, ContactModel, DISCARD, ERROR, FUNCTIONS, Handle, Journal, Line, OK, Patch, WARNING, callbacks, guid,
    sideways, with_each_contact_model,
};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::RefCell;
use std::ffi::{CString, c_char, c_int};
use std::num::FpCategory;
use std::ptr::{null, null_mut};
use std::time::Instant;
use wheelrail::fmi2::variables::variables;

/// Of each contact model.
const SEQUENCES: u32 = 2000;

/// Makes meshes still coarser: most calls are no steps.
const COARSER: &[(&str, c_int)] = &[("contact_nodes", 17), ("depth_nodes", 11)];

/// What was tried.
#[derive(Debug, Default)]
struct Tally {
    sequences: u64,
    /// fmi2OK, fmi2Warning, fmi2Discard, fmi2Error.
    statuses: [u64; 4],
    not_a_number: u64,
    infinite: u64,
    subnormal: u64,
    /// Of a magnitude above 1e100.
    huge: u64,
    ordinary: u64,
    known_references: u64,
    unknown_references: u64,
    calls_with_null: u64,
    absurd_counts: u64,
    states_saved: u64,
    states_restored: u64,
    states_refused: u64,
    steps_done: u64,
    /// Times that lateral and spin motion was taken, and refused.
    sideways_taken: u64,
    sideways_refused: u64,
    /// Errors out of which the state saved at the beginning has led.
    recovered: u64,
}

impl Tally {
    fn add(&mut self, call: &Call, statuses: &[c_int], known: &[u32]) {
        for value in call.values() {
            *match value.classify() {
                FpCategory::Nan => &mut self.not_a_number,
                FpCategory::Infinite => &mut self.infinite,
                FpCategory::Subnormal => &mut self.subnormal,
                _ if value.abs() > 1e100 => &mut self.huge,
                _ => &mut self.ordinary,
            } += 1;
        }
        for reference in call.references() {
            *if known.contains(&reference) {
                &mut self.known_references
            } else {
                &mut self.unknown_references
            } += 1;
        }
        for status in statuses {
            self.statuses[*status as usize] += 1;
        }
        let done = statuses.iter().filter(|status| **status == OK).count() as u64;
        match call {
            Call::Save(_) => self.states_saved += done,
            Call::Restore(_) => self.states_restored += done,
            Call::RoundTrip(_, flip) => self.states_refused += u64::from(flip.is_some() && done == 2),
            Call::Noise(_) => self.states_refused += 1,
            Call::Step(..) | Call::GoodStep(_) => self.steps_done += done,
            Call::Sideways(_) => {
                self.sideways_taken += done;
                self.sideways_refused += statuses.iter().filter(|status| **status == DISCARD).count() as u64;
            }
            Call::Odd(odd) => {
                self.calls_with_null += u64::from(odd.nulls != 0);
                self.absurd_counts += u64::from(odd.count > 2);
            }
            _ => {}
        }
    }
}

/// An instance and what a master remembers of it.
struct Master<'a> {
    client: Client<'a>,
    slots: [Handle; 4],
    /// The state at the beginning: leads out of every error.
    anchor: Handle,
}

impl Master<'_> {
    fn time(&self) -> f64 {
        let mut time = 0.0;
        // SAFETY: one place. Where the query is not allowed the state is lost anyway.
        unsafe { (self.client.api.get_real_status)(self.client.component, 2, &mut time) };
        time
    }

    /// Makes a call; the statuses that came back.
    fn make(&mut self, call: &Call) -> Vec<c_int> {
        let (api, c) = (self.client.api, self.client.component);
        // SAFETY: all pointers are valid, all counts right; handles are never followed.
        unsafe {
            match call {
                Call::Setup(start, stop) => vec![self.client.setup(*start, *stop)],
                Call::Enter => vec![self.client.enter()],
                Call::Exit => vec![self.client.exit()],
                Call::Terminate => vec![self.client.terminate()],
                Call::Reset => vec![self.client.reset()],
                Call::GetReals(references) => {
                    let mut values = vec![0.0; references.len()];
                    vec![self.client.get_references(references, &mut values)]
                }
                Call::SetReals(pairs) => {
                    let (references, values): (Vec<u32>, Vec<f64>) = pairs.iter().copied().unzip();
                    vec![(api.set_real)(
                        c,
                        references.as_ptr(),
                        references.len(),
                        values.as_ptr(),
                    )]
                }
                Call::Sideways(values) => {
                    let motion = sideways(Patch).iter().zip(values);
                    let motion: Vec<_> = motion.map(|((name, usual), factor)| (*name, usual * factor)).collect();
                    vec![self.client.set(&motion)]
                }
                Call::GetIntegers(references) => {
                    let mut values = vec![0; references.len()];
                    vec![(api.get_integer)(
                        c,
                        references.as_ptr(),
                        references.len(),
                        values.as_mut_ptr(),
                    )]
                }
                Call::SetIntegers(pairs) => {
                    // Large meshes are slow to build, and test nothing more here.
                    let (references, values): (Vec<u32>, Vec<c_int>) = pairs
                        .iter()
                        .copied()
                        .map(|(reference, value)| (reference, value.clamp(-1, 30)))
                        .unzip();
                    vec![(api.set_integer)(
                        c,
                        references.as_ptr(),
                        references.len(),
                        values.as_ptr(),
                    )]
                }
                Call::OtherTypes(reference) => vec![
                    (api.get_boolean)(c, reference, 1, &mut 0),
                    (api.set_boolean)(c, reference, 1, &1),
                    (api.get_string)(c, reference, 1, &mut null()),
                    (api.set_string)(c, reference, 1, &c"%n".as_ptr()),
                ],
                Call::Step(time, size) => vec![self.client.step(*time, *size)],
                Call::GoodStep(size) => vec![self.client.step(self.time(), *size)],
                Call::Cancel => vec![(api.cancel_step)(c)],
                Call::Rates(rates) => {
                    let references: Vec<u32> = rates.iter().map(|rate| rate.0).collect();
                    let orders: Vec<c_int> = rates.iter().map(|rate| rate.1).collect();
                    let values: Vec<f64> = rates.iter().map(|rate| rate.2).collect();
                    let n = rates.len();
                    vec![(api.set_input_derivatives)(
                        c,
                        references.as_ptr(),
                        n,
                        orders.as_ptr(),
                        values.as_ptr(),
                    )]
                }
                Call::OutputRates(rates) => {
                    let (references, orders): (Vec<u32>, Vec<c_int>) = rates.iter().copied().unzip();
                    let mut values = vec![0.0; rates.len()];
                    let (n, values) = (rates.len(), values.as_mut_ptr());
                    vec![(api.get_output_derivatives)(
                        c,
                        references.as_ptr(),
                        n,
                        orders.as_ptr(),
                        values,
                    )]
                }
                Call::Direction(unknowns, knowns) => {
                    let (references, direction): (Vec<u32>, Vec<f64>) = knowns.iter().copied().unzip();
                    let mut values = vec![0.0; unknowns.len()];
                    vec![(api.directional_derivative)(
                        c,
                        unknowns.as_ptr(),
                        unknowns.len(),
                        references.as_ptr(),
                        references.len(),
                        direction.as_ptr(),
                        values.as_mut_ptr(),
                    )]
                }
                Call::Save(slot) => vec![(api.get_state)(c, &mut self.slots[*slot])],
                Call::Restore(slot) => vec![self.client.restore(self.slots[*slot])],
                Call::Free(slot) => vec![(api.free_state)(c, &mut self.slots[*slot])],
                Call::Wild(address) => {
                    let mut handle = *address as Handle;
                    if self.slots.contains(&handle) {
                        return vec![OK];
                    }
                    vec![self.client.restore(handle), (api.free_state)(c, &mut handle)]
                }
                Call::RoundTrip(slot, flip) => {
                    let (handle, mut size) = (self.slots[*slot], 0);
                    let status = (api.serialized_size)(c, handle, &mut size);
                    if status != OK {
                        return vec![status];
                    }
                    let mut bytes = vec![0_u8; size];
                    let written = (api.serialize)(c, handle, bytes.as_mut_ptr().cast::<c_char>(), size);
                    if let Some((at, mask)) = flip {
                        bytes[at % size] ^= mask;
                    }
                    let mut copy = null_mut();
                    let read = self.client.deserialize(&bytes, &mut copy);
                    assert!(flip.is_none() || read == ERROR, "a flipped state was accepted");
                    vec![written, read, (api.free_state)(c, &mut copy)]
                }
                Call::Noise(bytes) => {
                    let mut handle = null_mut();
                    let status = self.client.deserialize(bytes, &mut handle);
                    assert_eq!(status, ERROR, "noise was accepted");
                    vec![status]
                }
                Call::Status(kind) => vec![
                    (api.get_status)(c, *kind, &mut 0),
                    (api.get_real_status)(c, *kind, &mut 0.0),
                    (api.get_integer_status)(c, *kind, &mut 0),
                    (api.get_boolean_status)(c, *kind, &mut 0),
                    (api.get_string_status)(c, *kind, &mut null()),
                ],
                Call::Logging(on, name) => {
                    let names = [
                        c"logSolver",
                        c"logEvents",
                        c"logStatusError",
                        c"logStatusWarning",
                        c"%s#",
                    ];
                    let names: Vec<_> = name.iter().map(|name| names[*name].as_ptr()).collect();
                    vec![(api.set_debug_logging)(
                        c,
                        c_int::from(*on),
                        names.len(),
                        names.as_ptr(),
                    )]
                }
                Call::Instantiate(name, kind, other, location) => {
                    let string = |bytes: &Vec<u8>| CString::new(bytes.clone()).expect("no zero");
                    let (name, location) = (string(name), string(location));
                    let other = other.as_ref().map_or_else(guid, string);
                    let journal = Journal::default();
                    let instance = (api.instantiate)(
                        name.as_ptr(),
                        *kind,
                        other.as_ptr(),
                        location.as_ptr(),
                        &callbacks(&journal),
                        0,
                        1,
                    );
                    assert!(instance.is_null() || (*kind == 1 && other == guid()));
                    (api.free_instance)(instance);
                    vec![]
                }
                Call::Odd(odd) => self.odd(odd).into_iter().collect(),
            }
        }
    }

    /// A call with null pointers and absurd counts; its status, where it has one.
    fn odd(&mut self, odd: &Odd) -> Option<c_int> {
        fn or_null<T>(odd: &Odd, bit: u8, pointer: *const T) -> *const T {
            if odd.nulls >> bit & 1 == 1 { null() } else { pointer }
        }
        fn or_null_mut<T>(odd: &Odd, bit: u8, place: &mut T) -> *mut T {
            or_null(odd, bit, place).cast_mut()
        }
        let (api, n) = (self.client.api, odd.count);
        let c = or_null(odd, 7, self.client.component).cast_mut();
        let references = or_null(odd, 0, odd.references.as_ptr());
        let values = or_null(odd, 1, odd.values.as_ptr());
        let (mut real, mut integer, mut string) = ([0.0; 2], [0; 2], [c"%n".as_ptr(); 2]);
        let orders = [1, 2];
        // Large meshes are slow to build, and test nothing more here.
        let integers = odd.values.map(|value| (value as c_int).clamp(-1, 30));
        let handle = or_null(odd, 2, self.slots[odd.slot]).cast_mut();
        let state = &mut self.slots[odd.slot];
        // SAFETY: as for the functions of the standard, but for null pointers and for counts above usize::MAX - 1000, which
        // the library refuses; handles are never followed.
        let status = unsafe {
            match FUNCTIONS[odd.function] {
                "fmi2GetTypesPlatform" | "fmi2GetVersion" => return None,
                "fmi2Instantiate" => {
                    let journal = Journal::default();
                    let (name, guid) = (c"odd", guid());
                    let instance = (api.instantiate)(
                        or_null(odd, 0, name.as_ptr()),
                        1,
                        or_null(odd, 1, guid.as_ptr()),
                        or_null(odd, 2, name.as_ptr()),
                        or_null(odd, 3, &callbacks(&journal)),
                        0,
                        1,
                    );
                    (api.free_instance)(instance);
                    return None;
                }
                "fmi2FreeInstance" => {
                    (api.free_instance)(null_mut());
                    return None;
                }
                "fmi2SetDebugLogging" => (api.set_debug_logging)(c, 1, n, or_null(odd, 0, string.as_ptr())),
                "fmi2SetupExperiment" => (api.setup_experiment)(c, 1, odd.values[1], odd.values[0], 1, odd.values[1]),
                "fmi2EnterInitializationMode" => (api.enter_initialization)(c),
                "fmi2ExitInitializationMode" => (api.exit_initialization)(c),
                "fmi2Terminate" => (api.terminate)(c),
                "fmi2Reset" => (api.reset)(c),
                "fmi2GetReal" => (api.get_real)(c, references, n, or_null_mut(odd, 1, &mut real).cast()),
                "fmi2GetInteger" => (api.get_integer)(c, references, n, or_null_mut(odd, 1, &mut integer).cast()),
                "fmi2GetBoolean" => (api.get_boolean)(c, references, n, or_null_mut(odd, 1, &mut integer).cast()),
                "fmi2GetString" => (api.get_string)(c, references, n, or_null_mut(odd, 1, &mut string).cast()),
                "fmi2SetReal" => (api.set_real)(c, references, n, values),
                "fmi2SetInteger" => (api.set_integer)(c, references, n, or_null(odd, 1, integers.as_ptr())),
                "fmi2SetBoolean" => (api.set_boolean)(c, references, n, or_null(odd, 1, integers.as_ptr())),
                "fmi2SetString" => (api.set_string)(c, references, n, or_null(odd, 1, string.as_ptr())),
                "fmi2GetFMUstate" => (api.get_state)(c, or_null_mut(odd, 0, state)),
                "fmi2SetFMUstate" => (api.set_state)(c, handle),
                "fmi2FreeFMUstate" => (api.free_state)(c, or_null_mut(odd, 0, state)),
                "fmi2SerializedFMUstateSize" => (api.serialized_size)(c, handle, or_null_mut(odd, 0, &mut 0)),
                // Two bytes are never the size of a state.
                "fmi2SerializeFMUstate" => (api.serialize)(c, handle, or_null_mut(odd, 0, &mut [0_i8; 2]).cast(), n),
                "fmi2DeSerializeFMUstate" => (api.deserialize)(
                    c,
                    or_null(odd, 0, [1_i8; 2].as_ptr().cast()),
                    n,
                    or_null_mut(odd, 1, state),
                ),
                "fmi2GetDirectionalDerivative" => (api.directional_derivative)(
                    c,
                    references,
                    n,
                    or_null(odd, 2, odd.references.as_ptr()),
                    n,
                    values,
                    or_null_mut(odd, 3, &mut real).cast(),
                ),
                "fmi2SetRealInputDerivatives" => {
                    (api.set_input_derivatives)(c, references, n, or_null(odd, 2, orders.as_ptr()), values)
                }
                "fmi2GetRealOutputDerivatives" => (api.get_output_derivatives)(
                    c,
                    references,
                    n,
                    or_null(odd, 2, orders.as_ptr()),
                    or_null_mut(odd, 1, &mut real).cast(),
                ),
                "fmi2DoStep" => (api.do_step)(c, odd.values[0], odd.values[1], n as c_int),
                "fmi2CancelStep" => (api.cancel_step)(c),
                "fmi2GetStatus" => (api.get_status)(c, n as c_int, or_null_mut(odd, 0, &mut 0)),
                "fmi2GetRealStatus" => (api.get_real_status)(c, n as c_int, or_null_mut(odd, 0, &mut 0.0)),
                "fmi2GetIntegerStatus" => (api.get_integer_status)(c, n as c_int, or_null_mut(odd, 0, &mut 0)),
                "fmi2GetBooleanStatus" => (api.get_boolean_status)(c, n as c_int, or_null_mut(odd, 0, &mut 0)),
                "fmi2GetStringStatus" => (api.get_string_status)(c, n as c_int, or_null_mut(odd, 0, &mut null())),
                other => unreachable!("{other}"),
            }
        };
        Some(status)
    }
}

/// Sequences begin somewhere in the life of an instance: most random ones would not get far.
fn master(api: &Api, contact: ContactModel, slip_source: c_int, begin: u8) -> Master<'_> {
    let client = Client::coarse(api, contact);
    client.expect(OK, client.set_integers(COARSER));
    client.expect(OK, client.set_integers(&[("slip_source", slip_source)]));
    if begin > 0 {
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
    }
    if begin > 1 {
        client.expect(OK, client.set(&[("creepage", 0.003)]));
        client.expect(OK, client.set(sideways(contact)));
        client.expect(OK, client.exit());
    }
    let anchor = client.save();
    Master {
        client,
        slots: [null_mut(); 4],
        anchor,
    }
}

/// The call came back with a status, and no message speaks of a panic.
fn check(master: &Master, call: &Call, statuses: &[c_int]) -> Result<(), TestCaseError> {
    for status in statuses {
        prop_assert!([OK, WARNING, DISCARD, ERROR].contains(status), "{call:?}: {status}");
    }
    for message in master.client.journal.take() {
        prop_assert!(!message.text.contains("internal error"), "{call:?}: {message:?}");
    }
    Ok(())
}

#[test]
fn only_statuses_of_the_standard_come_back() {
    with_each_contact_model(|api, contact| {
        let known: Vec<u32> = variables().iter().map(|row| row.reference).collect();
        let tally = RefCell::new(Tally::default());
        let start = Instant::now();
        let configuration = ProptestConfig {
            cases: SEQUENCES,
            failure_persistence: None,
            ..ProptestConfig::default()
        };
        let sequence = |(slip_source, begin, recover, calls): (c_int, u8, bool, Vec<Call>)| {
            let mut master = master(api, contact, slip_source, begin);
            for call in &calls {
                let statuses = master.make(call);
                check(&master, call, &statuses)?;
                tally.borrow_mut().add(call, &statuses, &known);
                // As a master does that rolls back: most calls of a random sequence would be refused in *error*.
                if recover && statuses.contains(&ERROR) {
                    master.client.expect(OK, master.client.restore(master.anchor));
                    tally.borrow_mut().recovered += 1;
                }
            }
            let client = &master.client;
            client.expect(OK, client.reset());
            client.make_coarse();
            client.expect(OK, client.set_integers(COARSER));
            client.start();
            client.expect(OK, client.step(0.0, 0.01));
            for bits in client.outputs() {
                prop_assert!(f64::from_bits(bits).is_finite());
            }
            tally.borrow_mut().sequences += 1;
            Ok(())
        };
        let result = TestRunner::new(configuration).run(
            &(1..3, 0..4_u8, prop::bool::weighted(0.8), vec(any_call(), 1..40)),
            sequence,
        );
        if let Err(failure) = result {
            panic!("{failure}");
        }
        let tally = tally.into_inner();
        println!("{:.0} s: {tally:#?}", start.elapsed().as_secs_f64());
        // Nothing of what this test is for was left out by chance.
        assert_eq!(tally.sequences, u64::from(SEQUENCES));
        for count in [
            tally.not_a_number,
            tally.infinite,
            tally.subnormal,
            tally.huge,
            tally.unknown_references,
            tally.calls_with_null,
            tally.absurd_counts,
            tally.states_restored,
            tally.states_refused,
            tally.steps_done,
        ] {
            assert!(count >= 200, "{tally:#?}");
        }
        // Taken by the contact model that it is of, refused by the other one.
        let sideways = match contact {
            Line => tally.sideways_refused,
            Patch => tally.sideways_taken,
        };
        assert!(sideways >= 200, "{tally:#?}");
        for status in [OK, DISCARD, ERROR] {
            assert!(tally.statuses[status as usize] >= 200, "{tally:#?}");
        }
    });
}
