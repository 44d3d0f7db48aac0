//! Random sequences of calls with arbitrary arguments (any bits as a double, any value reference, null pointers, absurd
//! sizes, wild handles, noise as states): only statuses of the standard come back, and the instance can always be reset
//! and run, by each standard with each contact model. `cargo test --test fmi sequences -- --nocapture` prints what was tried.

use super::calls::{Call, any_call};
use super::importer::{
    Api, Arguments, Client, Component, ContactModel, DISCARD, ERROR, Fmi2, Fmi3, Handle, Journal, Line, OK, Patch,
    Profiles, RIGHT, WARNING, sideways, with_each_contact_model,
};
use super::odd_calls::odd;
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::TestRunner;
use std::cell::RefCell;
use std::ffi::{CString, c_int};
use std::num::FpCategory;
use std::ptr::{null, null_mut};
use std::time::Instant;

/// By each standard with each contact model.
const SEQUENCES: u32 = 1000;

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
        let (api, c, mut time) = (self.client.api, self.client.component, 0.0);
        // SAFETY: one place. Where the call is not allowed the state is lost anyway.
        unsafe {
            match api.standard {
                Fmi2 => (api.fmi2.fmi2GetRealStatus)(c, 2, &mut time),
                Fmi3 => api.get_real(c, &api.reference("time"), 1, &mut time),
            }
        };
        time
    }

    /// Makes a call; the statuses that came back.
    fn make(&mut self, call: &Call) -> Vec<c_int> {
        let (api, c) = (self.client.api, self.client.component);
        // SAFETY: all pointers are valid, all counts right; handles are never followed.
        unsafe {
            match call {
                Call::Setup(start, stop) => vec![match api.standard {
                    Fmi2 => self.client.setup(*start, *stop),
                    Fmi3 => self.client.begin(*start, *stop),
                }],
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
                    vec![api.set_real(c, references.as_ptr(), references.len(), values.as_ptr())]
                }
                Call::Sideways(values) => {
                    let motion = sideways(Patch).iter().zip(values);
                    let motion: Vec<_> = motion.map(|((name, usual), factor)| (*name, usual * factor)).collect();
                    vec![self.client.set(&motion)]
                }
                Call::GetIntegers(references) => {
                    let mut values = vec![0; references.len()];
                    vec![api.get_integer(c, references.as_ptr(), references.len(), values.as_mut_ptr())]
                }
                Call::SetIntegers(pairs) => {
                    // Large meshes are slow to build, and test nothing more here.
                    let (references, values): (Vec<u32>, Vec<c_int>) = pairs
                        .iter()
                        .copied()
                        .map(|(reference, value)| (reference, value.clamp(-1, 30)))
                        .unzip();
                    vec![api.set_integer(c, references.as_ptr(), references.len(), values.as_ptr())]
                }
                Call::OtherTypes(reference) => vec![
                    api.get_boolean(c, reference, 1, &mut 0),
                    api.set_boolean(c, reference, 1, &1),
                    api.get_string(c, reference, 1, &mut null()),
                    api.set_string(c, reference, 1, &c"%n".as_ptr()),
                ],
                Call::Step(time, size) => vec![self.client.step(*time, *size)],
                Call::GoodStep(size) => vec![self.client.step(self.time(), *size)],
                Call::Cancel => vec![match api.standard {
                    Fmi2 => (api.fmi2.fmi2CancelStep)(c),
                    Fmi3 => (api.fmi3.fmi3EnterEventMode)(c),
                }],
                Call::Rates(rates) => {
                    let references: Vec<u32> = rates.iter().map(|rate| rate.0).collect();
                    let orders: Vec<c_int> = rates.iter().map(|rate| rate.1).collect();
                    let values: Vec<f64> = rates.iter().map(|rate| rate.2).collect();
                    let n = rates.len();
                    vec![(api.fmi2.fmi2SetRealInputDerivatives)(
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
                    vec![api.get_output_derivatives(c, references.as_ptr(), n, orders.as_ptr(), values)]
                }
                Call::Direction(unknowns, knowns) => {
                    let (references, direction): (Vec<u32>, Vec<f64>) = knowns.iter().copied().unzip();
                    let mut values = vec![0.0; unknowns.len()];
                    vec![api.directional_derivative(
                        c,
                        unknowns.as_ptr(),
                        unknowns.len(),
                        references.as_ptr(),
                        references.len(),
                        direction.as_ptr(),
                        values.as_mut_ptr(),
                    )]
                }
                Call::Save(slot) => vec![api.get_state(c, &mut self.slots[*slot])],
                Call::Restore(slot) => vec![self.client.restore(self.slots[*slot])],
                Call::Free(slot) => vec![api.free_state(c, &mut self.slots[*slot])],
                Call::Wild(address) => {
                    let mut handle = *address as Handle;
                    if self.slots.contains(&handle) {
                        return vec![OK];
                    }
                    vec![self.client.restore(handle), api.free_state(c, &mut handle)]
                }
                Call::RoundTrip(slot, flip) => {
                    let (handle, mut size) = (self.slots[*slot], 0);
                    let status = api.serialized_size(c, handle, &mut size);
                    if status != OK {
                        return vec![status];
                    }
                    let mut bytes = vec![0_u8; size];
                    let written = api.serialize(c, handle, bytes.as_mut_ptr(), size);
                    if let Some((at, mask)) = flip {
                        bytes[at % size] ^= mask;
                    }
                    let mut copy = null_mut();
                    let read = self.client.deserialize(&bytes, &mut copy);
                    assert!(flip.is_none() || read == ERROR, "a flipped state was accepted");
                    vec![written, read, api.free_state(c, &mut copy)]
                }
                Call::Noise(bytes) => {
                    let mut handle = null_mut();
                    let status = self.client.deserialize(bytes, &mut handle);
                    assert_eq!(status, ERROR, "noise was accepted");
                    vec![status]
                }
                Call::Status(kind) => vec![
                    (api.fmi2.fmi2GetStatus)(c, *kind, &mut 0),
                    (api.fmi2.fmi2GetRealStatus)(c, *kind, &mut 0.0),
                    (api.fmi2.fmi2GetIntegerStatus)(c, *kind, &mut 0),
                    (api.fmi2.fmi2GetBooleanStatus)(c, *kind, &mut 0),
                    (api.fmi2.fmi2GetStringStatus)(c, *kind, &mut null()),
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
                    vec![api.set_debug_logging(c, c_int::from(*on), names.len(), names.as_ptr())]
                }
                Call::Instantiate(name, kind, other, location) => {
                    let string = |bytes: &Vec<u8>| CString::new(bytes.clone()).expect("no zero");
                    let (name, location, own) = (string(name), string(location), api.standard.token());
                    let other = other.as_ref().map(string);
                    let journal = Journal::default();
                    let arguments = Arguments {
                        name: name.as_ptr(),
                        kind: *kind,
                        token: other.as_ref().map(|token| token.as_ptr()),
                        location: location.as_ptr(),
                        journal: Some(&journal),
                        logging: 1,
                        ..RIGHT
                    };
                    let blank = String::from_utf8_lossy(name.to_bytes()).trim().is_empty();
                    let right = *kind == 1 && other.as_ref().is_none_or(|token| *token == own);
                    assert_eq!(api.instantiates(&arguments), right && !blank);
                    vec![]
                }
                Call::Configuration(on) => vec![if *on {
                    (api.fmi3.fmi3EnterConfigurationMode)(c)
                } else {
                    (api.fmi3.fmi3ExitConfigurationMode)(c)
                }],
                Call::Length(strips, length) => {
                    let name = if *strips { "patch_strips" } else { "patch_nodes" };
                    // Large patches are slow to build, and test nothing more here.
                    let length = if (30..1000).contains(length) { 9 } else { *length };
                    vec![(api.fmi3.fmi3SetUInt64)(c, &api.reference(name), 1, &length, 1)]
                }
                Call::Typed(references, values, kind) => vec![typed(api, c, references, values, *kind)],
                Call::Counted(reference, count) => {
                    let mut values = vec![0.0; *count];
                    vec![
                        self.client.get_references(&[*reference], &mut values),
                        self.client.set_references(&[*reference], &values),
                    ]
                }
                Call::Adjoint(unknowns, knowns) => {
                    let (references, weights): (Vec<u32>, Vec<f64>) = unknowns.iter().copied().unzip();
                    let mut values = vec![0.0; knowns.len()];
                    vec![(api.fmi3.fmi3GetAdjointDerivative)(
                        c,
                        references.as_ptr(),
                        references.len(),
                        knowns.as_ptr(),
                        knowns.len(),
                        weights.as_ptr(),
                        weights.len(),
                        values.as_mut_ptr(),
                        values.len(),
                    )]
                }
                Call::Odd(call) => odd(api, c, &mut self.slots[call.slot], call).into_iter().collect(),
            }
        }
    }
}

/// Reads or sets values of a type of FMI 3.0.
fn typed(api: &Api, c: Component, references: &[u32], values: &[i64; 2], kind: u8) -> c_int {
    let (n, r, api) = (references.len(), references.as_ptr(), &api.fmi3);
    // Large meshes are slow to build, and test nothing more here.
    let values = values.map(|value| if (30..1000).contains(&value) { 17 } else { value });
    macro_rules! call {
        ($get:ident, $set:ident, $type:ty) => {{
            let mut values = values.map(|value| value as $type);
            // SAFETY: at most two values.
            unsafe {
                if kind & 1 == 0 {
                    (api.$get)(c, r, n, values.as_mut_ptr(), n)
                } else {
                    (api.$set)(c, r, n, values.as_ptr(), n)
                }
            }
        }};
    }
    match kind / 2 % 11 {
        0 => call!(fmi3GetFloat32, fmi3SetFloat32, f32),
        1 => call!(fmi3GetInt8, fmi3SetInt8, i8),
        2 => call!(fmi3GetUInt8, fmi3SetUInt8, u8),
        3 => call!(fmi3GetInt16, fmi3SetInt16, i16),
        4 => call!(fmi3GetUInt16, fmi3SetUInt16, u16),
        5 => {
            let mut values = values.map(|value| (value as i32).clamp(-1, 30));
            // SAFETY: at most two values.
            unsafe {
                if kind & 1 == 0 {
                    (api.fmi3GetInt32)(c, r, n, values.as_mut_ptr(), n)
                } else {
                    (api.fmi3SetInt32)(c, r, n, values.as_ptr(), n)
                }
            }
        }
        6 => call!(fmi3GetUInt32, fmi3SetUInt32, u32),
        7 => call!(fmi3GetUInt64, fmi3SetUInt64, u64),
        8 => call!(fmi3GetBoolean, fmi3SetBoolean, u8),
        _ => call!(fmi3GetInt64, fmi3SetInt64, i64),
    }
}

/// Sequences begin somewhere in the life of an instance: most random ones would not get far.
fn master(api: &Api, contact: ContactModel, slip_source: c_int, begin: u8) -> Master<'_> {
    let client = Client::coarse(api, contact);
    client.expect(OK, client.set_integers(COARSER));
    client.expect(OK, client.set_integers(&[("slip_source", slip_source)]));
    if begin > 0 {
        client.expect(OK, client.begin(0.0, None));
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
    try_sequences(&Api::load(Fmi2));
}

#[test]
fn only_statuses_of_the_standard_come_back_by_fmi3() {
    try_sequences(&Api::load(Fmi3));
}

fn try_sequences(api: &Api) {
    with_each_contact_model(api, |api, contact| {
        let known = api.standard.references();
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
            &(
                1..3,
                0..4_u8,
                prop::bool::weighted(0.8),
                vec(any_call(api.standard), 1..40),
            ),
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
            Patch | Profiles => tally.sideways_taken,
        };
        assert!(sideways >= 200, "{tally:#?}");
        for status in [OK, DISCARD, ERROR] {
            // Of FMI 3.0 there are no queries to discard.
            let least = if (status, api.standard) == (DISCARD, Fmi3) {
                100
            } else {
                200
            };
            assert!(tally.statuses[status as usize] >= least, "{tally:#?}");
        }
    });
}
