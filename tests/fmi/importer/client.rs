//! An instance with its journal; calls take slices and names.

use super::api::{Api, Component, Handle};
use super::dispatch::Answer;
use super::messages::{Arguments, Journal, RIGHT};
use super::standard::Standard::{Fmi2, Fmi3};
use super::{ContactModel, Line, OK, coarse, sideways};
use std::cell::Cell;
use std::ffi::{CStr, CString, c_int};
use wheelrail::signals::OUTPUTS;

pub struct Client<'a> {
    pub api: &'a Api,
    pub component: Component,
    pub journal: Box<Journal>,
    /// The contact model that [`Client::make_coarse`] chooses.
    pub contact: ContactModel,
    /// How the last step ended, where the standard has it said by the step.
    pub answer: Cell<Answer>,
}

impl Drop for Client<'_> {
    fn drop(&mut self) {
        // SAFETY: the instance is freed once.
        unsafe { self.api.free_instance(self.component) }
    }
}

impl<'a> Client<'a> {
    /// In *instantiated*, with logging off.
    pub fn new(api: &'a Api) -> Client<'a> {
        let client = Client::given(api, RIGHT);
        client.hear_refusals();
        client
    }

    /// Has the reasons of refused values told: in FMI 3.0 only those of errors are without being asked for.
    #[track_caller]
    pub fn hear_refusals(&self) {
        if self.api.standard == Fmi3 {
            let warnings = c"logStatusWarning".as_ptr();
            // SAFETY: a live instance, a valid string.
            let status = unsafe { self.api.set_debug_logging(self.component, 1, 1, &warnings) };
            self.expect(OK, status);
        }
    }

    pub fn with_logging(api: &'a Api, on: bool) -> Client<'a> {
        let logging = c_int::from(on);
        Client::given(api, Arguments { logging, ..RIGHT })
    }

    /// In *instantiated*; the journal is the client's own.
    pub fn given(api: &'a Api, arguments: Arguments) -> Client<'a> {
        let journal = Box::<Journal>::default();
        let arguments = Arguments {
            journal: Some(&journal),
            ..arguments
        };
        // SAFETY: all pointers are valid during the call, the journal longer than the instance.
        let component = unsafe { api.instantiate(&arguments) };
        assert!(!component.is_null(), "{:?}", journal.borrow());
        Client {
            api,
            component,
            journal,
            contact: Line,
            answer: Cell::new(Answer::NONE),
        }
    }

    /// In *instantiated*, with a coarse grid of a contact model.
    pub fn coarse(api: &'a Api, contact: ContactModel) -> Client<'a> {
        let mut client = Client::new(api);
        client.contact = contact;
        client.make_coarse();
        client
    }

    /// In *initializationMode*, with a coarse grid of a contact model.
    pub fn initializing(api: &'a Api, contact: ContactModel) -> Client<'a> {
        let client = Client::coarse(api, contact);
        client.expect(OK, client.begin(0.0, None));
        client
    }

    /// In *stepComplete*, moving sideways where the contact model takes it, after the given changes of start values.
    pub fn running(api: &'a Api, contact: ContactModel, start: &[(&str, f64)]) -> Client<'a> {
        let client = Client::initializing(api, contact);
        client.expect(OK, client.set(sideways(contact)));
        client.expect(OK, client.set(start));
        client.expect(OK, client.exit());
        client
    }

    /// Chooses the contact model with a coarse grid, as after a reset.
    #[track_caller]
    pub fn make_coarse(&self) {
        self.expect(OK, self.set_integers(coarse(self.contact)));
    }

    /// Begins to run from *instantiated* with the values as they are.
    #[track_caller]
    pub fn start(&self) {
        self.expect(OK, self.begin(0.0, None));
        self.expect(OK, self.exit());
    }

    /// Asserts a status, with the messages in the failure.
    #[track_caller]
    pub fn expect(&self, expected: c_int, status: c_int) {
        assert_eq!(status, expected, "{:#?}", self.journal.borrow());
    }

    /// The text of the last message, which is taken away with all others.
    #[track_caller]
    pub fn last_message(&self) -> String {
        let message = self.journal.borrow_mut().drain(..).next_back();
        message.expect("a message").text
    }

    /// fmi2SetupExperiment.
    #[track_caller]
    pub fn setup(&self, start: f64, stop: Option<f64>) -> c_int {
        assert_eq!(self.api.standard, Fmi2);
        let (defined, stop) = (c_int::from(stop.is_some()), stop.unwrap_or_default());
        // SAFETY: a live instance.
        unsafe { (self.api.fmi2.fmi2SetupExperiment)(self.component, 0, 0.0, start, defined, stop) }
    }

    /// The initialisation with the times of the experiment, which FMI 2.0 takes in a call before.
    pub fn begin(&self, start: f64, stop: Option<f64>) -> c_int {
        match self.api.standard {
            Fmi2 => match self.setup(start, stop) {
                OK => self.enter(),
                status => status,
            },
            Fmi3 => {
                let (defined, stop) = (u8::from(stop.is_some()), stop.unwrap_or_default());
                // SAFETY: a live instance.
                unsafe { (self.api.fmi3.fmi3EnterInitializationMode)(self.component, 0, 0.0, start, defined, stop) }
            }
        }
    }

    /// The initialisation; see [`Api::enter_initialization`].
    pub fn enter(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { self.api.enter_initialization(self.component) }
    }

    pub fn exit(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { self.api.exit_initialization(self.component) }
    }

    pub fn step(&self, time: f64, size: f64) -> c_int {
        let mut answer = Answer::NONE;
        // SAFETY: a live instance.
        let status = unsafe { self.api.do_step(self.component, time, size, &mut answer) };
        self.answer.set(answer);
        status
    }

    /// How far the last step came.
    #[track_caller]
    pub fn last_successful_time(&self) -> f64 {
        match self.api.standard {
            Fmi2 => {
                let mut time = f64::NAN;
                // SAFETY: a live instance and one place.
                self.expect(OK, unsafe {
                    (self.api.fmi2.fmi2GetRealStatus)(self.component, 2, &mut time)
                });
                time
            }
            Fmi3 => self.answer.get().last_successful_time,
        }
    }

    pub fn terminate(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { self.api.terminate(self.component) }
    }

    pub fn reset(&self) -> c_int {
        // SAFETY: a live instance.
        unsafe { self.api.reset(self.component) }
    }

    /// Sets values in one call, elements of arrays too.
    #[track_caller]
    pub fn set(&self, values: &[(&str, f64)]) -> c_int {
        let (mut references, mut flat) = (Vec::<u32>::new(), Vec::new());
        // Where the elements of the arrays begin.
        let mut arrays = Vec::new();
        for (name, value) in values {
            let (entry, element) = self.api.standard.find(name);
            let Some(element) = element else {
                references.push(entry.reference);
                flat.push(*value);
                continue;
            };
            let known = arrays.iter().find(|(reference, _)| *reference == entry.reference);
            let begin = known.map_or(flat.len(), |(_, begin)| *begin);
            if begin == flat.len() {
                arrays.push((entry.reference, begin));
                references.push(entry.reference);
                flat.resize(begin + entry.elements, f64::NAN);
                self.expect(OK, self.get_references(&[entry.reference], &mut flat[begin..]));
            }
            flat[begin + element] = *value;
        }
        self.set_references(&references, &flat)
    }

    /// Sets integers: in one call where all have one type.
    #[track_caller]
    pub fn set_integers(&self, values: &[(&str, c_int)]) -> c_int {
        let (api, standard) = (self.api, self.api.standard);
        let mut entries: Vec<_> = values
            .iter()
            .map(|(name, value)| (standard.find(name).0, *value))
            .collect();
        // By types, otherwise in the order given.
        entries.sort_by_key(|(entry, _)| entry.kind as u8);
        for group in entries.chunk_by(|(a, _), (b, _)| a.kind == b.kind) {
            let references: Vec<u32> = group.iter().map(|(entry, _)| entry.reference).collect();
            let values: Vec<c_int> = group.iter().map(|(_, value)| *value).collect();
            // SAFETY: as many values as references.
            let status =
                unsafe { api.set_integer(self.component, references.as_ptr(), references.len(), values.as_ptr()) };
            if status != OK {
                return status;
            }
        }
        OK
    }

    /// One integer variable.
    #[track_caller]
    pub fn get_integer(&self, name: &str) -> c_int {
        let mut value = c_int::MIN;
        // SAFETY: one element.
        self.expect(OK, unsafe {
            self.api
                .get_integer(self.component, &self.api.reference(name), 1, &mut value)
        });
        value
    }

    /// fmi2SetRealInputDerivatives.
    #[track_caller]
    pub fn set_rates(&self, rates: &[(&str, c_int, f64)]) -> c_int {
        assert!(self.api.takes_rates());
        let references: Vec<u32> = rates.iter().map(|(name, _, _)| self.api.reference(name)).collect();
        let orders: Vec<c_int> = rates.iter().map(|(_, order, _)| *order).collect();
        let values: Vec<f64> = rates.iter().map(|(_, _, value)| *value).collect();
        let (references, orders, values) = (references.as_ptr(), orders.as_ptr(), values.as_ptr());
        // SAFETY: as many values as references.
        unsafe { (self.api.fmi2.fmi2SetRealInputDerivatives)(self.component, references, rates.len(), orders, values) }
    }

    /// Values that follow each other, more than references where these are arrays.
    pub fn set_references(&self, references: &[u32], values: &[f64]) -> c_int {
        let (c, n) = (self.component, references.len());
        let (references, n_values, values) = (references.as_ptr(), values.len(), values.as_ptr());
        // SAFETY: as many values as are counted.
        unsafe {
            match self.api.standard {
                Fmi2 => (self.api.fmi2.fmi2SetReal)(c, references, n, values),
                Fmi3 => (self.api.fmi3.fmi3SetFloat64)(c, references, n, values, n_values),
            }
        }
    }

    /// Values that follow each other, more than references where these are arrays.
    #[track_caller]
    pub fn get_references(&self, references: &[u32], values: &mut [f64]) -> c_int {
        let (c, n) = (self.component, references.len());
        let (references, n_values, values) = (references.as_ptr(), values.len(), values.as_mut_ptr());
        // SAFETY: as many values as are counted.
        unsafe {
            match self.api.standard {
                Fmi2 => {
                    assert_eq!(n, n_values);
                    (self.api.fmi2.fmi2GetReal)(c, references, n, values)
                }
                Fmi3 => (self.api.fmi3.fmi3GetFloat64)(c, references, n, values, n_values),
            }
        }
    }

    /// The derivatives of outputs in a direction of inputs; more values than unknowns where these are arrays.
    #[track_caller]
    pub fn directional(&self, unknowns: &[u32], knowns: &[u32], seed: &[f64], values: &mut [f64]) -> c_int {
        assert_eq!(seed.len(), knowns.len());
        let (c, n_unknowns, n_knowns, n_values) = (self.component, unknowns.len(), knowns.len(), values.len());
        let (unknowns, knowns) = (unknowns.as_ptr(), knowns.as_ptr());
        let (seed, values) = (seed.as_ptr(), values.as_mut_ptr());
        // SAFETY: as many elements as are counted.
        unsafe {
            match self.api.standard {
                Fmi2 => {
                    assert_eq!(n_unknowns, n_values);
                    let derivative = self.api.fmi2.fmi2GetDirectionalDerivative;
                    derivative(c, unknowns, n_unknowns, knowns, n_knowns, seed, values)
                }
                Fmi3 => {
                    let derivative = self.api.fmi3.fmi3GetDirectionalDerivative;
                    derivative(
                        c, unknowns, n_unknowns, knowns, n_knowns, seed, n_knowns, values, n_values,
                    )
                }
            }
        }
    }

    /// The rates of change of all outputs.
    #[track_caller]
    pub fn output_rates(&self) -> Vec<f64> {
        let references = self.api.standard.outputs();
        let (c, n, orders) = (self.component, references.len(), vec![1; references.len()]);
        let mut values = vec![f64::NAN; OUTPUTS.len()];
        let (references, orders, n_values) = (references.as_ptr(), orders.as_ptr(), values.len());
        // SAFETY: as many elements as are counted.
        self.expect(OK, unsafe {
            match self.api.standard {
                Fmi2 => (self.api.fmi2.fmi2GetRealOutputDerivatives)(c, references, n, orders, values.as_mut_ptr()),
                Fmi3 => {
                    (self.api.fmi3.fmi3GetOutputDerivatives)(c, references, n, orders, values.as_mut_ptr(), n_values)
                }
            }
        });
        values
    }

    /// Sets a text.
    #[track_caller]
    pub fn set_text(&self, name: &str, text: &CStr) -> c_int {
        let reference = self.api.reference(name);
        // SAFETY: one element.
        unsafe { self.api.set_string(self.component, &reference, 1, &text.as_ptr()) }
    }

    /// A text.
    #[track_caller]
    pub fn get_text(&self, name: &str) -> CString {
        let (reference, mut text) = (self.api.reference(name), std::ptr::null());
        // SAFETY: one element, and a string that stays until the next call.
        unsafe {
            self.expect(OK, self.api.get_string(self.component, &reference, 1, &mut text));
            CStr::from_ptr(text).to_owned()
        }
    }

    /// One real variable, or an element of an array.
    #[track_caller]
    pub fn get(&self, name: &str) -> f64 {
        let (entry, element) = self.api.standard.find(name);
        let mut values = vec![f64::NAN; entry.elements];
        self.expect(OK, self.get_references(&[entry.reference], &mut values));
        values[element.unwrap_or(0)]
    }

    /// All outputs, as bits.
    #[track_caller]
    pub fn outputs(&self) -> Vec<u64> {
        let mut values = vec![f64::NAN; OUTPUTS.len()];
        self.expect(OK, self.get_references(&self.api.standard.outputs(), &mut values));
        values.into_iter().map(f64::to_bits).collect()
    }

    #[track_caller]
    pub fn save(&self) -> Handle {
        let mut handle = std::ptr::null_mut();
        // SAFETY: a live instance and a variable.
        self.expect(OK, unsafe { self.api.get_state(self.component, &mut handle) });
        assert!(!handle.is_null());
        handle
    }

    pub fn restore(&self, handle: Handle) -> c_int {
        // SAFETY: a live instance.
        unsafe { self.api.set_state(self.component, handle) }
    }

    #[track_caller]
    pub fn serialize(&self, handle: Handle) -> Vec<u8> {
        let mut size = 0;
        // SAFETY: a live instance and room for the bytes.
        unsafe {
            self.expect(OK, self.api.serialized_size(self.component, handle, &mut size));
            let mut bytes = vec![0_u8; size];
            let status = self.api.serialize(self.component, handle, bytes.as_mut_ptr(), size);
            self.expect(OK, status);
            bytes
        }
    }

    pub fn deserialize(&self, bytes: &[u8], handle: &mut Handle) -> c_int {
        // SAFETY: a live instance and valid bytes.
        unsafe {
            self.api
                .deserialize(self.component, bytes.as_ptr(), bytes.len(), handle)
        }
    }
}
