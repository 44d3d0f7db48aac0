//! Calls of the interface with arbitrary arguments, for sequences.rs.

use super::importer::{FMI2_FUNCTIONS, FMI3_FUNCTIONS, Fmi2, Fmi3, Standard};
use proptest::collection::vec;
use proptest::prelude::*;
use std::ffi::c_int;

/// One call; numbers are arbitrary unless the function could not bear any others.
#[derive(Debug, Clone)]
pub enum Call {
    /// The times of the experiment: fmi2SetupExperiment, or fmi3EnterInitializationMode.
    Setup(f64, Option<f64>),
    Enter,
    Exit,
    Terminate,
    Reset,
    GetReals(Vec<u32>),
    SetReals(Vec<(u32, f64)>),
    /// Lateral and spin motion as a master would set it: factors of the usual values.
    Sideways([f64; 4]),
    GetIntegers(Vec<u32>),
    SetIntegers(Vec<(u32, c_int)>),
    OtherTypes(u32),
    Step(f64, f64),
    /// A step as a master would do it.
    GoodStep(f64),
    /// What a standard has alone and no state allows: fmi2CancelStep, fmi3EnterEventMode.
    Cancel,
    /// fmi2SetRealInputDerivatives.
    Rates(Vec<(u32, c_int, f64)>),
    OutputRates(Vec<(u32, c_int)>),
    Direction(Vec<u32>, Vec<(u32, f64)>),
    Save(usize),
    Restore(usize),
    Free(usize),
    Wild(usize),
    RoundTrip(usize, Option<(usize, u8)>),
    Noise(Vec<u8>),
    /// The queries of FMI 2.0.
    Status(c_int),
    /// Into configuration mode of FMI 3.0 or out of it.
    Configuration(bool),
    /// A length of an array, in whatever state: patch_strips or patch_nodes.
    Length(bool, u64),
    /// Reads or sets values of a type, whatever the variables are: fmi3GetInt32 and so on.
    Typed(Vec<u32>, [i64; 2], u8),
    /// Real values with another count than variables have elements.
    Counted(u32, usize),
    /// fmi3GetAdjointDerivative.
    Adjoint(Vec<(u32, f64)>, Vec<u32>),
    Logging(bool, Option<usize>),
    /// Name, type, token (the right one where there is none), location.
    Instantiate(Vec<u8>, c_int, Option<Vec<u8>>, Vec<u8>),
    Odd(Odd),
}

/// A call whose pointers are null where `nulls` has a bit, with a count that memory may not hold.
#[derive(Debug, Clone)]
pub struct Odd {
    /// Place in the functions of the standard.
    pub function: usize,
    pub nulls: u8,
    pub count: usize,
    pub references: [u32; 2],
    pub values: [f64; 2],
    pub slot: usize,
}

impl Call {
    /// The doubles that it hands over.
    pub fn values(&self) -> Vec<f64> {
        match self {
            Call::Setup(start, stop) => [Some(*start), *stop].into_iter().flatten().collect(),
            Call::SetReals(pairs) | Call::Direction(_, pairs) | Call::Adjoint(pairs, _) => {
                pairs.iter().map(|pair| pair.1).collect()
            }
            Call::Step(time, size) => vec![*time, *size],
            Call::Sideways(values) => values.to_vec(),
            Call::Rates(rates) => rates.iter().map(|rate| rate.2).collect(),
            Call::Odd(odd) => odd.values.to_vec(),
            _ => Vec::new(),
        }
    }

    /// The value references that it hands over.
    pub fn references(&self) -> Vec<u32> {
        match self {
            Call::GetReals(references) | Call::GetIntegers(references) => references.clone(),
            Call::SetReals(pairs) => pairs.iter().map(|pair| pair.0).collect(),
            Call::SetIntegers(pairs) => pairs.iter().map(|pair| pair.0).collect(),
            Call::OtherTypes(reference) | Call::Counted(reference, _) => vec![*reference],
            Call::Typed(references, ..) => references.clone(),
            Call::Adjoint(pairs, knowns) => pairs.iter().map(|p| p.0).chain(knowns.iter().copied()).collect(),
            Call::Rates(rates) => rates.iter().map(|rate| rate.0).collect(),
            Call::OutputRates(rates) => rates.iter().map(|rate| rate.0).collect(),
            Call::Direction(unknowns, pairs) => unknowns.iter().copied().chain(pairs.iter().map(|p| p.0)).collect(),
            Call::Odd(odd) => odd.references.to_vec(),
            _ => Vec::new(),
        }
    }
}

/// Most of them of variables that are no elements of a profile, or profiles.
fn any_reference(standard: Standard) -> impl Strategy<Value = u32> {
    let all = standard.references();
    let first_profile = match standard {
        Fmi2 => 4000,
        Fmi3 => 5000,
    };
    let known: Vec<u32> = all
        .iter()
        .copied()
        .filter(|reference| *reference < first_profile)
        .collect();
    prop_oneof![6 => prop::sample::select(known), 2 => prop::sample::select(all), 2 => any::<u32>()]
}

/// Values that are likely to be legal, and any double at all.
fn any_value() -> impl Strategy<Value = f64> {
    prop_oneof![
        4 => -1.0..1.0,
        2 => 0.0..1e5,
        2 => prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MIN_POSITIVE, f64::MAX]),
        // All bit patterns, quiet and signalling NaN included.
        2 => any::<u64>().prop_map(f64::from_bits),
        2 => prop::num::f64::SUBNORMAL | prop::num::f64::INFINITE | prop::num::f64::QUIET_NAN,
    ]
}

fn any_time() -> impl Strategy<Value = f64> {
    prop_oneof![4 => 0.0..0.1, 1 => any_value()]
}

/// Each of them.
pub fn any_call(standard: Standard) -> impl Strategy<Value = Call> {
    prop_oneof![12 => shared_call(standard), 1 => own_call(standard)]
}

/// Those of FMI 3.0 that FMI 2.0 does not have, and the other way round.
fn own_call(standard: Standard) -> BoxedStrategy<Call> {
    let any_reference = move || any_reference(standard);
    match standard {
        Fmi2 => prop_oneof![
            2 => vec((any_reference(), -1..3_i32, any_value()), 0..3).prop_map(Call::Rates),
            1 => any::<c_int>().prop_map(Call::Status),
        ]
        .boxed(),
        Fmi3 => prop_oneof![
            2 => any::<bool>().prop_map(Call::Configuration),
            2 => (any::<bool>(), prop_oneof![3 => 0..15_u64, 1 => any::<u64>()])
                .prop_map(|(strips, length)| Call::Length(strips, length)),
            2 => (vec(any_reference(), 0..3), (any::<i64>(), -1..5_i64), any::<u8>())
                .prop_map(|(references, (wide, small), kind)| Call::Typed(references, [small, wide], kind)),
            1 => (any_reference(), 0..80_usize).prop_map(|(reference, count)| Call::Counted(reference, count)),
            2 => (vec((any_reference(), any_value()), 0..3), vec(any_reference(), 0..3))
                .prop_map(|(unknowns, knowns)| Call::Adjoint(unknowns, knowns)),
        ]
        .boxed(),
    }
}

fn shared_call(standard: Standard) -> impl Strategy<Value = Call> {
    let any_reference = move || any_reference(standard);
    let slot = 0..4_usize;
    prop_oneof![
        2 => (any_time(), prop::option::of(any_time())).prop_map(|(start, stop)| Call::Setup(start, stop)),
        4 => Just(Call::Enter),
        4 => Just(Call::Exit),
        1 => Just(Call::Terminate),
        1 => Just(Call::Reset),
        3 => vec(any_reference(), 0..4).prop_map(Call::GetReals),
        6 => vec((any_reference(), any_value()), 0..3).prop_map(Call::SetReals),
        4 => prop::array::uniform4(-5.0..5.0).prop_map(Call::Sideways),
        1 => vec(any_reference(), 0..4).prop_map(Call::GetIntegers),
        1 => vec((any_reference(), prop_oneof![-1..9_i32, any::<i32>()]), 0..3).prop_map(Call::SetIntegers),
        1 => any_reference().prop_map(Call::OtherTypes),
        1 => (any_time(), any_time()).prop_map(|(time, size)| Call::Step(time, size)),
        8 => (1e-4..0.1).prop_map(Call::GoodStep),
        1 => Just(Call::Cancel),
        1 => vec((any_reference(), -1..3_i32), 0..3).prop_map(Call::OutputRates),
        1 => (vec(any_reference(), 0..3), vec((any_reference(), any_value()), 0..3))
            .prop_map(|(unknowns, knowns)| Call::Direction(unknowns, knowns)),
        2 => slot.clone().prop_map(Call::Save),
        18 => slot.clone().prop_map(Call::Restore),
        1 => slot.clone().prop_map(Call::Free),
        1 => any::<usize>().prop_map(Call::Wild),
        1 => (slot, prop::option::of((any::<usize>(), 1..=255_u8))).prop_map(|(slot, flip)| Call::RoundTrip(slot, flip)),
        2 => vec(any::<u8>(), 0..200).prop_map(Call::Noise),
        1 => (any::<bool>(), prop::option::of(0..5_usize)).prop_map(|(on, name)| Call::Logging(on, name)),
        1 => (vec(1..=255_u8, 0..20), prop_oneof![0..3, any::<c_int>()], prop::option::of(vec(1..=255_u8, 0..50)), vec(1..=255_u8, 0..50))
            .prop_map(|(name, kind, guid, location)| Call::Instantiate(name, kind, guid, location)),
        6 => any_odd(standard).prop_map(Call::Odd),
    ]
}

fn any_odd(standard: Standard) -> impl Strategy<Value = Odd> {
    let count = prop_oneof![0..=2_usize, (usize::MAX - 1000)..=usize::MAX];
    let functions = match standard {
        Fmi2 => FMI2_FUNCTIONS.len(),
        Fmi3 => FMI3_FUNCTIONS.len(),
    };
    let references = [any_reference(standard), any_reference(standard)];
    let values = [any_value(), any_value()];
    (0..functions, any::<u8>(), count, references, values, 0..4_usize).prop_map(
        |(function, nulls, count, references, values, slot)| Odd {
            function,
            nulls,
            count,
            references,
            values,
            slot,
        },
    )
}
