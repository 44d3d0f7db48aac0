//! A sequence of calls of the interface with arbitrary arguments: value references, numbers, counts, handles, bytes, null
//! pointers. Only statuses of the standard come back, no message speaks of an internal error, a damaged state is never
//! accepted, and after fmi2Reset the instance runs with finite outputs.

#![no_main]
// One promise, at the head of `Master::make`, holds for each of its calls.
#![allow(unsafe_op_in_unsafe_fn)]

use arbitrary::Arbitrary;
use libfuzzer_sys::fuzz_target;
use std::cell::{Cell, OnceCell};
use std::ffi::{CStr, CString, c_char, c_int, c_void};
use std::ptr::{null, null_mut};
use wheelrail::fmi2::functions::*;
use wheelrail::fmi2::types::{CallbackFunctions, LoggerCallback, Status};
use wheelrail::fmi2::variables::variables;

/// A value reference: mostly one that exists.
#[derive(Debug, Clone, Copy, Arbitrary)]
enum Reference {
    Known(u16),
    Setting(u8),
    Any(u32),
}

/// A number: any bits, or one of a magnitude that a model may like.
#[derive(Debug, Clone, Copy, Arbitrary)]
enum Number {
    Any(f64),
    Unit(i16),
    Thousands(u16),
    Time(u8),
}

/// A pointer that is null now and then.
#[derive(Debug, Clone, Copy, Arbitrary)]
struct Pointer(u8);

#[derive(Debug, Arbitrary)]
enum Call {
    Instantiate(Option<Vec<u8>>, i32, Option<Vec<u8>>, Option<Vec<u8>>, bool),
    SetDebugLogging(i32, Vec<Option<u8>>, Pointer),
    SetupExperiment(i32, Number, Number, i32, Number),
    Enter,
    Exit,
    Terminate,
    Reset,
    GetReal(Vec<Reference>, Pointer, Pointer),
    SetReal(Vec<(Reference, Number)>, Pointer, Pointer),
    GetInteger(Vec<Reference>, Pointer, Pointer),
    SetInteger(Vec<(Reference, i32)>, Pointer, Pointer),
    Boolean(Vec<Reference>, Pointer, Pointer),
    String(Vec<(Reference, Option<Vec<u8>>)>, Pointer, Pointer),
    GetState(u8, Pointer),
    SetState(u8),
    FreeState(u8, Pointer),
    WildState(usize),
    Serialize(u8, u8, Option<(u16, u8)>),
    Deserialize(Vec<u8>, Pointer),
    Directional(Vec<Reference>, Vec<(Reference, Number)>, Pointer),
    InputDerivatives(Vec<(Reference, i32, Number)>, Pointer),
    OutputDerivatives(Vec<(Reference, i32)>, Pointer),
    Step(Number, Number, i32),
    /// A step as a master does it.
    GoodStep(u8),
    CancelStep,
    Status(i32, Pointer),
    /// More elements than memory holds, or a pointer that is not aligned.
    Absurd(u8, u32),
}

impl Pointer {
    fn is_null(self) -> bool {
        self.0 % 16 == 7
    }

    fn to<T>(self, pointer: *const T) -> *const T {
        if self.is_null() { null() } else { pointer }
    }

    fn to_mut<T>(self, pointer: *mut T) -> *mut T {
        self.to(pointer).cast_mut()
    }
}

impl Number {
    fn value(self) -> f64 {
        match self {
            Number::Any(value) => value,
            Number::Unit(value) => f64::from(value) / 32768.0,
            Number::Thousands(value) => 2.0 * f64::from(value),
            Number::Time(value) => 1e-3 * f64::from(value),
        }
    }
}

/// What the references stand for.
struct Table {
    all: Vec<u32>,
    settings: Vec<u32>,
}

impl Table {
    fn reference(&self, reference: Reference) -> u32 {
        match reference {
            Reference::Known(row) => self.all[usize::from(row) % self.all.len()],
            Reference::Setting(row) => self.settings[usize::from(row) % self.settings.len()],
            Reference::Any(reference) => reference,
        }
    }

    fn references(&self, references: &[Reference]) -> Vec<u32> {
        references.iter().map(|reference| self.reference(*reference)).collect()
    }
}

/// The logger is variadic in C; here its first variadic argument is the last one.
unsafe extern "C" fn log(
    _environment: *mut c_void,
    _name: *const c_char,
    _status: c_int,
    _category: *const c_char,
    format: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the library hands over strings ended by zero.
    let (format, text) = unsafe { (CStr::from_ptr(format), CStr::from_ptr(text)) };
    assert_eq!(format, c"%s");
    let text = text.to_str().expect("UTF-8");
    assert!(!text.contains("internal error"), "{text}");
}

fn callbacks() -> CallbackFunctions {
    type Logger = unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char);
    CallbackFunctions {
        // SAFETY: see `log`.
        logger: Some(unsafe { std::mem::transmute::<Logger, LoggerCallback>(log as Logger) }),
        allocate_memory: None,
        free_memory: None,
        step_finished: None,
        component_environment: null_mut(),
    }
}

/// A string of bytes but for zeros.
fn string(bytes: Option<&[u8]>) -> Option<CString> {
    let bytes = bytes?.iter().copied().filter(|byte| *byte != 0);
    Some(CString::new(bytes.collect::<Vec<_>>()).expect("no zero"))
}

/// An instance and what a master remembers of it.
struct Master {
    component: *mut c_void,
    table: Table,
    slots: [*mut c_void; 4],
    /// The state at the beginning: leads out of every error.
    anchor: *mut c_void,
}

thread_local! {
    /// Whether a call of the sequence has returned fmi2Error.
    static FAILED: Cell<bool> = const { Cell::new(false) };
}

fn expect(status: Status) {
    assert!((0..=3).contains(&status.0), "{status:?}");
    if status == Status::ERROR {
        FAILED.set(true);
    }
}

fn refused(status: Status) {
    assert_eq!(status, Status::ERROR);
    FAILED.set(true);
}

fn ok(status: Status) {
    assert_eq!(status, Status::OK);
}

impl Master {
    /// A coarse mesh: large ones are slow to build, and test nothing more here.
    fn coarsen(&self) {
        let size = |name: &str| {
            variables()
                .into_iter()
                .find(|row| row.name == name)
                .expect(name)
                .reference
        };
        let references = [size("contact_nodes"), size("depth_nodes")];
        // SAFETY: two elements.
        ok(unsafe { fmi2SetInteger(self.component, references.as_ptr(), 2, [17, 11].as_ptr()) });
    }

    /// # Safety
    /// The instance must be live. Every pointer is null or points to as many elements as the count beside it says.
    unsafe fn make(&mut self, call: &Call) {
        let c = self.component;
        match call {
            Call::Instantiate(name, fmu_type, guid, location, logging) => {
                let pointer = |text: &Option<CString>| text.as_ref().map_or(null(), |text| text.as_ptr());
                let [name, guid, location] = [name, guid, location].map(|bytes| string(bytes.as_deref()));
                let instance = fmi2Instantiate(
                    pointer(&name),
                    *fmu_type,
                    pointer(&guid),
                    pointer(&location),
                    &callbacks(),
                    0,
                    c_int::from(*logging),
                );
                fmi2FreeInstance(instance);
            }
            Call::SetDebugLogging(on, names, pointer) => {
                let known = [
                    c"logSolver",
                    c"logEvents",
                    c"logStatusError",
                    c"logStatusWarning",
                    c"%s%n#",
                    c"",
                ];
                let names: Vec<_> = names
                    .iter()
                    .map(|name| name.map_or(null(), |name| known[usize::from(name) % known.len()].as_ptr()))
                    .collect();
                expect(fmi2SetDebugLogging(c, *on, names.len(), pointer.to(names.as_ptr())));
            }
            Call::SetupExperiment(tolerance_defined, tolerance, start, stop_defined, stop) => {
                expect(fmi2SetupExperiment(
                    c,
                    *tolerance_defined,
                    tolerance.value(),
                    start.value(),
                    *stop_defined,
                    stop.value(),
                ))
            }
            Call::Enter => expect(fmi2EnterInitializationMode(c)),
            Call::Exit => expect(fmi2ExitInitializationMode(c)),
            Call::Terminate => expect(fmi2Terminate(c)),
            Call::Reset => {
                ok(fmi2Reset(c));
                self.coarsen();
            }
            Call::GetReal(references, first, second) => {
                let references = self.table.references(references);
                let mut values = vec![0.0; references.len()];
                expect(fmi2GetReal(
                    c,
                    first.to(references.as_ptr()),
                    references.len(),
                    second.to_mut(values.as_mut_ptr()),
                ));
            }
            Call::SetReal(pairs, first, second) => {
                let references: Vec<_> = pairs.iter().map(|pair| self.table.reference(pair.0)).collect();
                let values: Vec<_> = pairs.iter().map(|pair| pair.1.value()).collect();
                expect(fmi2SetReal(
                    c,
                    first.to(references.as_ptr()),
                    references.len(),
                    second.to(values.as_ptr()),
                ));
            }
            Call::GetInteger(references, first, second) => {
                let references = self.table.references(references);
                let mut values = vec![0; references.len()];
                expect(fmi2GetInteger(
                    c,
                    first.to(references.as_ptr()),
                    references.len(),
                    second.to_mut(values.as_mut_ptr()),
                ));
            }
            Call::SetInteger(pairs, first, second) => {
                let references: Vec<_> = pairs.iter().map(|pair| self.table.reference(pair.0)).collect();
                let values: Vec<_> = pairs
                    .iter()
                    .map(|pair| {
                        if (31..=1000).contains(&pair.1) {
                            pair.1 % 31
                        } else {
                            pair.1
                        }
                    })
                    .collect();
                expect(fmi2SetInteger(
                    c,
                    first.to(references.as_ptr()),
                    references.len(),
                    second.to(values.as_ptr()),
                ));
            }
            Call::Boolean(references, first, second) => {
                let references = self.table.references(references);
                let (n, mut values) = (references.len(), vec![0; references.len()]);
                let references = first.to(references.as_ptr());
                expect(fmi2GetBoolean(c, references, n, second.to_mut(values.as_mut_ptr())));
                expect(fmi2SetBoolean(c, references, n, second.to(values.as_ptr())));
            }
            Call::String(pairs, first, second) => {
                // Any bytes without a zero, ended by one, and null pointers.
                let texts: Vec<Option<CString>> = pairs.iter().map(|(_, text)| string(text.as_deref())).collect();
                let values: Vec<_> = texts
                    .iter()
                    .map(|text| text.as_ref().map_or(null(), |text| text.as_ptr()))
                    .collect();
                let references: Vec<u32> = pairs.iter().map(|(known, _)| self.table.reference(*known)).collect();
                let (n, references) = (references.len(), first.to(references.as_ptr()));
                expect(fmi2SetString(c, references, n, second.to(values.as_ptr())));
                let mut read = values.clone();
                let status = fmi2GetString(c, references, n, second.to_mut(read.as_mut_ptr()));
                expect(status);
                if status == Status::OK && n > 0 {
                    for text in read {
                        assert!(CStr::from_ptr(text).to_str().is_ok_and(|text| text.len() <= 4096));
                    }
                }
            }
            Call::GetState(slot, pointer) => {
                expect(fmi2GetFMUstate(
                    c,
                    pointer.to_mut(&mut self.slots[usize::from(slot % 4)]),
                ));
            }
            Call::SetState(slot) => expect(fmi2SetFMUstate(c, self.slots[usize::from(slot % 4)])),
            Call::FreeState(slot, pointer) => {
                expect(fmi2FreeFMUstate(
                    c,
                    pointer.to_mut(&mut self.slots[usize::from(slot % 4)]),
                ));
            }
            Call::WildState(address) => {
                let mut handle = *address as *mut c_void;
                if !handle.is_null() && handle != self.anchor && !self.slots.contains(&handle) {
                    let mut size = 0;
                    refused(fmi2SetFMUstate(c, handle));
                    refused(fmi2SerializedFMUstateSize(c, handle, &mut size));
                    refused(fmi2FreeFMUstate(c, &mut handle));
                }
            }
            Call::Serialize(from, to, damage) => {
                let (handle, mut size) = (self.slots[usize::from(from % 4)], 0);
                let status = fmi2SerializedFMUstateSize(c, handle, &mut size);
                expect(status);
                if status == Status::OK {
                    let mut bytes = vec![0_u8; size];
                    ok(fmi2SerializeFMUstate(c, handle, bytes.as_mut_ptr().cast(), size));
                    if let Some((at, mask)) = damage {
                        bytes[usize::from(*at) % size] ^= mask;
                    }
                    let slot = &mut self.slots[usize::from(to % 4)];
                    let status = fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), size, slot);
                    expect(status);
                    let damaged = damage.is_some_and(|(_, mask)| mask != 0);
                    assert!(!damaged || status == Status::ERROR, "a damaged state was accepted");
                }
            }
            Call::Deserialize(bytes, pointer) => {
                let mut handle = null_mut();
                let status =
                    fmi2DeSerializeFMUstate(c, bytes.as_ptr().cast(), bytes.len(), pointer.to_mut(&mut handle));
                // Noise is no state.
                refused(status);
            }
            Call::Directional(unknowns, knowns, pointer) => {
                let unknowns = self.table.references(unknowns);
                let references: Vec<_> = knowns.iter().map(|pair| self.table.reference(pair.0)).collect();
                let direction: Vec<_> = knowns.iter().map(|pair| pair.1.value()).collect();
                let mut values = vec![0.0; unknowns.len()];
                expect(fmi2GetDirectionalDerivative(
                    c,
                    unknowns.as_ptr(),
                    unknowns.len(),
                    references.as_ptr(),
                    references.len(),
                    pointer.to(direction.as_ptr()),
                    values.as_mut_ptr(),
                ));
            }
            Call::InputDerivatives(rates, pointer) => {
                let references: Vec<_> = rates.iter().map(|rate| self.table.reference(rate.0)).collect();
                let orders: Vec<_> = rates.iter().map(|rate| rate.1).collect();
                let values: Vec<_> = rates.iter().map(|rate| rate.2.value()).collect();
                expect(fmi2SetRealInputDerivatives(
                    c,
                    references.as_ptr(),
                    rates.len(),
                    pointer.to(orders.as_ptr()),
                    values.as_ptr(),
                ));
            }
            Call::OutputDerivatives(rates, pointer) => {
                let references: Vec<_> = rates.iter().map(|rate| self.table.reference(rate.0)).collect();
                let orders: Vec<_> = rates.iter().map(|rate| rate.1).collect();
                let mut values = vec![0.0; rates.len()];
                expect(fmi2GetRealOutputDerivatives(
                    c,
                    references.as_ptr(),
                    rates.len(),
                    pointer.to(orders.as_ptr()),
                    values.as_mut_ptr(),
                ));
            }
            Call::Step(time, size, new) => expect(fmi2DoStep(c, time.value(), size.value(), *new)),
            Call::GoodStep(size) => {
                let mut time = 0.0;
                fmi2GetRealStatus(c, 2, &mut time);
                expect(fmi2DoStep(c, time, 1e-4 * f64::from(size + 1), 1));
            }
            Call::CancelStep => expect(fmi2CancelStep(c)),
            Call::Status(kind, pointer) => {
                let mut status = Status::OK;
                expect(fmi2GetStatus(c, *kind, pointer.to_mut(&mut status)));
                expect(fmi2GetRealStatus(c, *kind, pointer.to_mut(&mut 0.0)));
                expect(fmi2GetIntegerStatus(c, *kind, pointer.to_mut(&mut 0)));
                expect(fmi2GetBooleanStatus(c, *kind, pointer.to_mut(&mut 0)));
                expect(fmi2GetStringStatus(c, *kind, pointer.to_mut(&mut null())));
            }
            Call::Absurd(function, count) => {
                let count = usize::MAX - *count as usize;
                let (references, mut values) = ([0_u32; 2], [0.0_f64; 2]);
                let values = values.as_mut_ptr();
                let status = match function % 4 {
                    0 => fmi2GetReal(c, references.as_ptr(), count, values),
                    1 => fmi2SetReal(c, references.as_ptr(), count, values),
                    2 => fmi2GetReal(c, references.as_ptr(), 1, values.byte_add(1)),
                    _ => fmi2SetReal(c, references.as_ptr().byte_add(1), 1, values),
                };
                refused(status);
            }
        }
    }
}

/// One instance for all sequences: fmi2Reset keeps a model whose fixed parameters are the same, and building one takes
/// longer than most sequences. Other instances come and go with [`Call::Instantiate`].
fn component() -> *mut c_void {
    thread_local! {
        static COMPONENT: OnceCell<*mut c_void> = const { OnceCell::new() };
    }
    COMPONENT.with(|component| {
        *component.get_or_init(|| {
            let guid = CString::new(wheelrail::fmi2::GUID).expect("no zero");
            // SAFETY: valid pointers.
            let component = unsafe { fmi2Instantiate(c"wheel".as_ptr(), 1, guid.as_ptr(), null(), &callbacks(), 0, 1) };
            assert!(!component.is_null());
            component
        })
    })
}

fuzz_target!(|input: (u8, Vec<Call>)| {
    let (begin, calls) = input;
    let component = component();
    // SAFETY: valid pointers, a live instance.
    unsafe {
        ok(fmi2Reset(component));
        ok(fmi2SetDebugLogging(component, 1, 0, null()));
        let all: Vec<u32> = variables().iter().map(|row| row.reference).collect();
        let settings = all
            .iter()
            .copied()
            .filter(|reference| *reference < 1000 || (2000..4000).contains(reference));
        let mut master = Master {
            component,
            table: Table {
                settings: settings.collect(),
                all,
            },
            slots: [null_mut(); 4],
            anchor: null_mut(),
        };
        master.coarsen();
        // Most sequences would not get far by chance.
        if begin % 4 > 0 {
            ok(fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0));
            ok(fmi2EnterInitializationMode(component));
        }
        if begin % 4 > 1 {
            ok(fmi2ExitInitializationMode(component));
        }
        ok(fmi2GetFMUstate(component, &mut master.anchor));
        FAILED.set(false);
        for call in &calls {
            master.make(call);
            // As a master does that rolls back: most calls of a random sequence would be refused in *error*.
            if FAILED.take() && begin & 4 == 0 {
                ok(fmi2SetFMUstate(component, master.anchor));
            }
        }
        ok(fmi2FreeFMUstate(component, &mut master.anchor));
        ok(fmi2Reset(component));
        master.coarsen();
        ok(fmi2SetupExperiment(component, 0, 0.0, 0.0, 0, 0.0));
        ok(fmi2EnterInitializationMode(component));
        ok(fmi2ExitInitializationMode(component));
        ok(fmi2DoStep(component, 0.0, 0.01, 1));
        let outputs: Vec<u32> = master
            .table
            .all
            .iter()
            .copied()
            .filter(|r| (1000..2000).contains(r))
            .collect();
        let mut values = vec![f64::NAN; outputs.len()];
        ok(fmi2GetReal(
            component,
            outputs.as_ptr(),
            outputs.len(),
            values.as_mut_ptr(),
        ));
        assert!(values.iter().all(|value| value.is_finite()));
        for slot in &mut master.slots {
            ok(fmi2FreeFMUstate(component, slot));
        }
    }
});
