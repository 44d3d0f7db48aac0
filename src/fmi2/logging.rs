//! Messages to the importer's logger.

use super::failure::Failure;
use super::types::{CallbackFunctions, ComponentEnvironment, LoggerCallback, Status};
use std::ffi::{CStr, CString};
use std::rc::Rc;

/// The declared log categories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Category {
    /// Why a call returned fmi2Error.
    StatusError,
    /// Why a call returned fmi2Warning or fmi2Discard.
    StatusWarning,
    /// Iterations and residuals.
    Solver,
    /// What happens in the life of an instance.
    Events,
}

impl Category {
    /// All categories, in the order in which they are declared.
    pub const ALL: [Category; 4] = [
        Category::StatusError,
        Category::StatusWarning,
        Category::Solver,
        Category::Events,
    ];

    /// The declared name.
    pub fn name(self) -> &'static CStr {
        match self {
            Category::StatusError => c"logStatusError",
            Category::StatusWarning => c"logStatusWarning",
            Category::Solver => c"logSolver",
            Category::Events => c"logEvents",
        }
    }

    /// One sentence for the model description.
    pub fn description(self) -> &'static str {
        match self {
            Category::StatusError => "Why a call returned fmi2Error",
            Category::StatusWarning => "Why a call returned fmi2Warning or fmi2Discard",
            Category::Solver => "Iterations and residual of each step",
            Category::Events => "Initialization, restored states, termination and reset",
        }
    }

    fn bit(self) -> u8 {
        1 << self as u8
    }

    /// The category of the message that goes with a status.
    fn of(status: Status) -> Category {
        match status {
            Status::WARNING | Status::DISCARD => Category::StatusWarning,
            _ => Category::StatusError,
        }
    }
}

/// A message that waits for the end of the call: the logger may call back into the instance.
pub struct Message {
    status: Status,
    category: Category,
    text: String,
}

/// The importer's logger and the categories that are on. Cheap to clone.
///
/// With `loggingOn = fmi2False` at instantiation only the reasons of failed calls are told; fmi2SetDebugLogging then
/// decides alone.
#[derive(Clone)]
pub struct Logger {
    callback: Option<LoggerCallback>,
    environment: ComponentEnvironment,
    instance_name: Rc<CStr>,
    enabled: u8,
}

impl Logger {
    /// Copies what is needed of the callbacks: the structure is valid only during fmi2Instantiate.
    pub fn new(callbacks: &CallbackFunctions, instance_name: &CStr, logging_on: bool) -> Logger {
        let mut logger = Logger {
            callback: callbacks.logger,
            environment: callbacks.component_environment,
            instance_name: Rc::from(instance_name),
            enabled: Category::StatusError.bit() | Category::StatusWarning.bit(),
        };
        if logging_on {
            logger.switch(true, &Category::ALL);
        }
        logger
    }

    /// fmi2SetDebugLogging. Switched on, exactly the given categories are; an empty list stands for all.
    pub fn switch(&mut self, on: bool, categories: &[Category]) {
        let all = if categories.is_empty() {
            &Category::ALL[..]
        } else {
            categories
        };
        let bits = all.iter().fold(0, |bits, category| bits | category.bit());
        self.enabled = if on { bits } else { self.enabled & !bits };
    }

    /// The category of this name.
    ///
    /// # Errors
    /// [`Failure::UnknownCategory`].
    pub fn category(name: &CStr) -> Result<Category, Failure> {
        Category::ALL
            .into_iter()
            .find(|category| category.name() == name)
            .ok_or_else(|| Failure::UnknownCategory {
                name: name.to_string_lossy().into_owned(),
            })
    }

    /// A message on a failed call, where its category is on.
    pub fn failure(&self, function: &str, failure: &Failure) -> Option<Message> {
        let status = failure.status();
        self.message(status, Category::of(status), || format!("{function}: {failure}"))
    }

    /// Why fmi2Instantiate returned null, where errors are told.
    pub fn refusal(&self, text: impl FnOnce() -> String) -> Option<Message> {
        self.message(Status::ERROR, Category::StatusError, text)
    }

    /// Information, where its category is on; otherwise the text is not even put together.
    pub fn information(&self, category: Category, text: impl FnOnce() -> String) -> Option<Message> {
        self.message(Status::OK, category, text)
    }

    fn message(&self, status: Status, category: Category, text: impl FnOnce() -> String) -> Option<Message> {
        let wanted = self.callback.is_some() && self.enabled & category.bit() != 0;
        wanted.then(|| Message {
            status,
            category,
            text: text(),
        })
    }

    /// Hands a message to the logger.
    pub fn send(&self, message: &Message) {
        let Some(callback) = self.callback else {
            return;
        };
        // `#` starts a variable's name in a message of the standard.
        let text = message.text.replace('#', "##").replace('\0', " ");
        let Ok(text) = CString::new(text.trim_end()) else {
            return;
        };
        // SAFETY: the importer's logger is called as fmi2CallbackLogger is declared; all strings end with zero and live
        // to the end of the call. The text is an argument of "%s", never a format.
        unsafe {
            callback(
                self.environment,
                self.instance_name.as_ptr(),
                message.status,
                message.category.name().as_ptr(),
                c"%s".as_ptr(),
                text.as_ptr(),
            );
        }
    }
}
