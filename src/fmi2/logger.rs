//! The importer's logger.

#![allow(unsafe_code)]

use super::types::{CallbackFunctions, ComponentEnvironment, LoggerCallback, Status};
use crate::fmi::call;
use crate::fmi::logging::{Message, escaped};
use std::ffi::CStr;
use std::rc::Rc;

/// The importer's logger, with what it is to be given. Cheap to clone.
#[derive(Clone)]
pub struct Logger {
    callback: Option<LoggerCallback>,
    environment: ComponentEnvironment,
    instance_name: Rc<CStr>,
}

impl Logger {
    /// Copies what is needed of the callbacks: the structure is valid only during fmi2Instantiate.
    pub fn new(callbacks: &CallbackFunctions, instance_name: &CStr) -> Logger {
        Logger {
            callback: callbacks.logger,
            environment: callbacks.component_environment,
            instance_name: Rc::from(instance_name),
        }
    }

    /// Whether there is a callback.
    pub fn is_there(&self) -> bool {
        self.callback.is_some()
    }
}

impl call::Logger for Logger {
    fn send(&self, messages: &[Message]) {
        let Some(callback) = self.callback else {
            return;
        };
        for message in messages {
            let text = escaped(&message.text);
            // SAFETY: the importer's logger is called as fmi2CallbackLogger is declared; all strings end with zero and live
            // to the end of the call. The text is an argument of "%s", never a format.
            unsafe {
                callback(
                    self.environment,
                    self.instance_name.as_ptr(),
                    Status::of(message.blame),
                    message.category.name().as_ptr(),
                    c"%s".as_ptr(),
                    text.as_ptr(),
                );
            }
        }
    }
}
