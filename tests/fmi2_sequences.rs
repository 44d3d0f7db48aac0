//! Random sequences of calls with arbitrary arguments: only statuses of the standard come back, and the instance can always be
//! reset and run.

#![allow(unsafe_code)]

mod common;

use common::{Api, Client, Handle, DISCARD, ERROR, OK, WARNING};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ffi::{c_char, c_int};
use std::ptr::{null, null_mut};
use wheelrail::fmi2::variables::variables;

/// One call; numbers are arbitrary unless the function could not bear any others.
#[derive(Debug, Clone)]
enum Call {
    Setup(f64, Option<f64>),
    Enter,
    Exit,
    Terminate,
    Reset,
    GetReals(Vec<u32>),
    SetReals(Vec<(u32, f64)>),
    GetIntegers(Vec<u32>),
    SetIntegers(Vec<(u32, c_int)>),
    OtherTypes(u32),
    Step(f64, f64),
    /// A step as a master would do it.
    GoodStep(f64),
    Cancel,
    Rates(Vec<(u32, c_int, f64)>),
    OutputRates(Vec<(u32, c_int)>),
    Direction(Vec<u32>, Vec<(u32, f64)>),
    Save(usize),
    Restore(usize),
    Free(usize),
    Wild(usize),
    RoundTrip(usize, Option<(usize, u8)>),
    Noise(Vec<u8>),
    Status(c_int),
    Logging(bool, Option<usize>),
}

fn any_reference() -> impl Strategy<Value = u32> {
    let known: Vec<u32> = variables()
        .iter()
        .map(|row| row.reference)
        .filter(|reference| *reference < 4000)
        .collect();
    let all: Vec<u32> = variables().iter().map(|row| row.reference).collect();
    prop_oneof![6 => prop::sample::select(known), 2 => prop::sample::select(all), 1 => any::<u32>()]
}

/// Values that are likely to be legal, and any double at all.
fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0,
        2 => 0.0..1e5,
        1 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE, f64::MAX]),
        1 => prop::num::f64::ANY,
    ]
}

fn any_time() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..0.1, 1 => any_value()]
}

fn any_call() -> impl Strategy<Value = Call> {
    let slot = 0..4_usize;
    prop_oneof![
        2 => (any_time(), prop::option::of(any_time())).prop_map(|(start, stop)| Call::Setup(start, stop)),
        4 => Just(Call::Enter),
        4 => Just(Call::Exit),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
        3 => vec(any_reference(), 0..4).prop_map(Call::GetReals),
        6 => vec((any_reference(), any_value()), 0..3).prop_map(Call::SetReals),
        1 => vec(any_reference(), 0..4).prop_map(Call::GetIntegers),
        1 => vec((any_reference(), prop_oneof![-1..9_i32, any::<i32>()]), 0..3).prop_map(Call::SetIntegers),
        1 => any_reference().prop_map(Call::OtherTypes),
        1 => (any_time(), any_time()).prop_map(|(time, size)| Call::Step(time, size)),
        8 => (1e-4..0.1).prop_map(Call::GoodStep),
        1 => Just(Call::Cancel),
        2 => vec((any_reference(), -1..3_i32, any_value()), 0..3).prop_map(Call::Rates),
        1 => vec((any_reference(), -1..3_i32), 0..3).prop_map(Call::OutputRates),
        1 => (vec(any_reference(), 0..3), vec((any_reference(), any_value()), 0..3))
            .prop_map(|(unknowns, knowns)| Call::Direction(unknowns, knowns)),
        2 => slot.clone().prop_map(Call::Save),
        4 => slot.clone().prop_map(Call::Restore),
        1 => slot.clone().prop_map(Call::Free),
        1 => any::<usize>().prop_map(Call::Wild),
        1 => (slot, prop::option::of((any::<usize>(), 1..=255_u8))).prop_map(|(slot, flip)| Call::RoundTrip(slot, flip)),
        1 => vec(any::<u8>(), 0..200).prop_map(Call::Noise),
        1 => any::<c_int>().prop_map(Call::Status),
        1 => (any::<bool>(), prop::option::of(0..5_usize)).prop_map(|(on, name)| Call::Logging(on, name)),
    ]
}

/// An instance and what a master remembers of it.
struct Master<'a> {
    client: Client<'a>,
    slots: [Handle; 4],
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
            }
        }
    }
}

/// Sequences begin somewhere in the life of an instance: most random ones would not get far.
fn master(api: &Api, begin: u8) -> Master<'_> {
    let client = Client::new(api);
    client.expect(OK, client.set_integers(&[("contact_nodes", 17), ("depth_nodes", 11)]));
    if begin > 0 {
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
    }
    if begin > 1 {
        client.expect(OK, client.set(&[("creepage", 0.003)]));
        client.expect(OK, client.exit());
    }
    Master {
        client,
        slots: [null_mut(); 4],
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 3000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn only_statuses_of_the_standard_come_back(begin in 0..4_u8, calls in vec(any_call(), 1..40)) {
        let api = Api::load();
        let mut master = master(&api, begin);
        for call in &calls {
            for status in master.make(call) {
                prop_assert!([OK, WARNING, DISCARD, ERROR].contains(&status), "{call:?}: {status}");
            }
            for message in master.client.journal.take() {
                prop_assert!(!message.text.contains("internal error"), "{call:?}: {message:?}");
            }
        }
        let client = &master.client;
        client.expect(OK, client.reset());
        client.expect(OK, client.set_integers(&[("contact_nodes", 17), ("depth_nodes", 11)]));
        client.expect(OK, client.setup(0.0, None));
        client.expect(OK, client.enter());
        client.expect(OK, client.exit());
        client.expect(OK, client.step(0.0, 0.01));
        for bits in client.outputs() {
            prop_assert!(f64::from_bits(bits).is_finite());
        }
    }
}
