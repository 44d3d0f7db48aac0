//! The importer's logger.

#![allow(unsafe_code)]

use super::types::{InstanceEnvironment, LogMessageCallback, Status};
use crate::fmi::call;
use crate::fmi::logging::{Message, escaped};

/// The importer's logger, with what it is to be given.
#[derive(Clone)]
pub struct Logger {
    /// The function; none where the importer wants no messages.
    pub callback: Option<LogMessageCallback>,
    /// Handed back to it.
    pub environment: InstanceEnvironment,
}

impl call::Logger for Logger {
    fn send(&self, messages: &[Message]) {
        let Some(callback) = self.callback else {
            return;
        };
        for message in messages {
            let text = escaped(&message.text);
            // SAFETY: the importer's logger is called as fmi3LogMessageCallback is declared; all strings end with zero and
            // live to the end of the call.
            unsafe {
                callback(
                    self.environment,
                    Status::of(message.blame),
                    message.category.name().as_ptr(),
                    text.as_ptr(),
                );
            }
        }
    }
}
