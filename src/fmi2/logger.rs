//! The importer's logger.

#![allow(unsafe_code)]

use super::types::{CallbackFunctions, ComponentEnvironment, LoggerCallback, Status};
use crate::fmi::logging::Message;
use std::ffi::{CStr, CString};
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

    /// Hands messages to the importer.
    pub fn send(&self, messages: &[Message]) {
        let Some(callback) = self.callback else {
            return;
        };
        for message in messages {
            // `#` starts a variable's name in a message of the standard.
            let text = message.text.replace('#', "##").replace('\0', " ");
            let Ok(text) = CString::new(text.trim_end()) else {
                continue;
            };
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
