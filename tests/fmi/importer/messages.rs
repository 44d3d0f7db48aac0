//! The importer's loggers and what a new instance is given.

use super::api::{Api, Component};
use super::standard::Standard::{Fmi2, Fmi3};
use std::cell::RefCell;
use std::ffi::{CStr, c_char, c_int, c_void};
use std::ptr::{null, null_mut};
use wheelrail::fmi2::types::{CallbackFunctions, LoggerCallback};
use wheelrail::fmi3::types::{LogMessageCallback, Status};

/// One message at the logger. FMI 3.0 hands over no name and no format.
#[derive(Debug, Clone, PartialEq)]
pub struct Message {
    pub instance_name: String,
    pub status: c_int,
    pub category: String,
    pub format: String,
    pub text: String,
}

/// What an importer hands over as its environment: collects the messages.
pub type Journal = RefCell<Vec<Message>>;

/// # Safety
/// A string ended by zero.
unsafe fn owned(text: *const c_char) -> String {
    // SAFETY: the caller's promise.
    unsafe { CStr::from_ptr(text) }.to_str().expect("UTF-8").to_owned()
}

/// The logger of FMI 2.0 is variadic in C. Where arguments are passed in registers, as here, one that is declared with one more
/// argument receives the first variadic one.
unsafe extern "C" fn collect(
    environment: *mut c_void,
    instance_name: *const c_char,
    status: c_int,
    category: *const c_char,
    format: *const c_char,
    text: *const c_char,
) {
    // SAFETY: the library hands over strings ended by zero, of the name whatever bytes the importer gave; the environment is
    // the journal of the client, which outlives its instance.
    unsafe {
        (*environment.cast::<Journal>()).borrow_mut().push(Message {
            instance_name: CStr::from_ptr(instance_name).to_string_lossy().into_owned(),
            status,
            category: owned(category),
            format: owned(format),
            text: owned(text),
        });
    }
}

/// The logger of FMI 3.0.
unsafe extern "C" fn collect_message(
    environment: *mut c_void,
    status: Status,
    category: *const c_char,
    text: *const c_char,
) {
    // SAFETY: as above.
    unsafe {
        (*environment.cast::<Journal>()).borrow_mut().push(Message {
            instance_name: String::new(),
            status: status.0,
            category: owned(category),
            format: String::new(),
            text: owned(text),
        });
    }
}

/// Callbacks of FMI 2.0 that write into a journal.
pub fn callbacks(journal: &Journal) -> CallbackFunctions {
    type Collector =
        unsafe extern "C" fn(*mut c_void, *const c_char, c_int, *const c_char, *const c_char, *const c_char);
    CallbackFunctions {
        // SAFETY: see `collect`.
        logger: Some(unsafe { std::mem::transmute::<Collector, LoggerCallback>(collect as Collector) }),
        component_environment: (&raw const *journal).cast_mut().cast(),
        ..NO_CALLBACKS
    }
}

pub const NO_CALLBACKS: CallbackFunctions = CallbackFunctions {
    logger: None,
    allocate_memory: None,
    free_memory: None,
    step_finished: None,
    component_environment: null_mut(),
};

/// Arguments of a new instance; what is not given is right.
#[derive(Clone, Copy)]
pub struct Arguments<'a> {
    pub name: *const c_char,
    /// `fmi2Type`: model exchange (0), co-simulation (1). Of FMI 3.0 everything else stands for scheduled execution.
    pub kind: c_int,
    /// The GUID or the instantiation token, the library's own where there is none.
    pub token: Option<*const c_char>,
    /// URI or path of the resources.
    pub location: *const c_char,
    /// No logger where there is none.
    pub journal: Option<&'a Journal>,
    pub logging: c_int,
    /// The rest is of FMI 3.0.
    pub event_mode: bool,
    pub early_return: bool,
    pub intermediate_variables: usize,
}

pub const RIGHT: Arguments = Arguments {
    name: c"wheel".as_ptr(),
    kind: 1,
    token: None,
    location: c"file:///tmp/resources".as_ptr(),
    journal: None,
    logging: 0,
    event_mode: false,
    early_return: false,
    intermediate_variables: 0,
};

impl Api {
    /// A new instance, or null.
    ///
    /// # Safety
    /// Null or valid pointers; the journal must outlive the instance.
    pub unsafe fn instantiate(&self, arguments: &Arguments) -> Component {
        let token = self.standard.token();
        let (name, location) = (arguments.name, arguments.location);
        let token = arguments.token.unwrap_or(token.as_ptr());
        // SAFETY: the caller's promise.
        unsafe {
            match self.standard {
                Fmi2 => {
                    let callbacks = arguments.journal.map_or(NO_CALLBACKS, callbacks);
                    let (kind, logging) = (arguments.kind, arguments.logging);
                    (self.fmi2.fmi2Instantiate)(name, kind, token, location, &callbacks, 0, logging)
                }
                Fmi3 => {
                    let logger = arguments.journal.map(|_| collect_message as LogMessageCallback);
                    let environment = arguments
                        .journal
                        .map_or(null_mut(), |journal| (&raw const *journal).cast_mut().cast());
                    let logging = arguments.logging as u8;
                    let api = &self.fmi3;
                    match arguments.kind {
                        0 => (api.fmi3InstantiateModelExchange)(name, token, location, 0, logging, environment, logger),
                        1 => (api.fmi3InstantiateCoSimulation)(
                            name,
                            token,
                            location,
                            0,
                            logging,
                            arguments.event_mode.into(),
                            arguments.early_return.into(),
                            null(),
                            arguments.intermediate_variables,
                            environment,
                            logger,
                            None,
                        ),
                        _ => (api.fmi3InstantiateScheduledExecution)(
                            name,
                            token,
                            location,
                            0,
                            logging,
                            environment,
                            logger,
                            None,
                            None,
                            None,
                        ),
                    }
                }
            }
        }
    }

    /// Whether there is an instance, which is freed.
    pub fn instantiates(&self, arguments: &Arguments) -> bool {
        // SAFETY: null or valid pointers; the instance is freed once.
        unsafe {
            let component = self.instantiate(arguments);
            self.free_instance(component);
            !component.is_null()
        }
    }
}
