//! Target of a fmi3Instance pointer: the component and the importer's logger.

use super::INSTANTIATION_TOKEN;
use super::failures::Failure;
use super::logger::Logger;
use super::states::Function;
use super::types::{self, InstanceEnvironment, LogMessageCallback, Status};
use crate::fmi::call::{self, Logger as _};
use crate::fmi::component::Component;
use crate::fmi::failures::{self, Blame};
use crate::fmi::logging::{Category, Journal, Rules};
use crate::fmi::resources::Resources;
use std::ffi::CStr;

/// Rules of logging: without logging the reasons of errors are told, and nothing else is. Each list of categories
/// switches its own (section 2.2.3 of the standard).
const LOGGING: Rules = Rules {
    at_first: &[],
    always: &[Category::StatusError],
    adds: true,
};

/// An instance.
pub struct Instance {
    /// The instance as every version of FMI has it.
    pub component: Component,
    logger: Logger,
    /// Whether a step may end before its end.
    early_return_allowed: bool,
}

/// The arguments of fmi3InstantiateCoSimulation that matter, copied from C.
pub struct Instantiation<'a> {
    /// Name of the instance.
    pub name: Option<&'a CStr>,
    /// Token of the importer's model description.
    pub token: Option<&'a CStr>,
    /// The resources of the archive.
    pub resources: Resources,
    /// Whether the importer wants events.
    pub event_mode_used: bool,
    /// Whether the importer can handle a step that ends before its end.
    pub early_return_allowed: bool,
    /// The number of variables that the importer wants to set or read between communication points.
    pub intermediate_variables: usize,
    /// Destination of messages.
    pub messages: Messages,
}

/// Destination of messages.
pub struct Messages {
    logger: Logger,
    journal: Journal,
}

impl Messages {
    /// Messages to the importer's logger, if there is one; all log categories are on, or only that of errors.
    pub fn new(environment: InstanceEnvironment, callback: Option<LogMessageCallback>, all: bool) -> Messages {
        Messages {
            journal: Journal::new(callback.is_some(), all, LOGGING),
            logger: Logger { callback, environment },
        }
    }

    /// Tells why there is no instance.
    pub fn refuse(mut self, function: &str, refusal: &Refusal) {
        self.journal.failure(Blame::Call, || format!("{function}: {refusal}"));
        self.logger.send(&self.journal.take());
    }
}

/// Reason why there is no instance.
#[derive(Debug, thiserror::Error)]
pub enum Refusal {
    /// Model exchange, or scheduled execution.
    #[error("this is a unit for co-simulation: use fmi3InstantiateCoSimulation")]
    InterfaceType,
    /// No name.
    #[error("instanceName is null or blank")]
    Name,
    /// No token.
    #[error("instantiationToken is a null pointer; the library's is {INSTANTIATION_TOKEN}")]
    NoToken,
    /// Another token.
    #[error(
        "instantiationToken = {0}: the library's is {INSTANTIATION_TOKEN}; description and library are not of one build"
    )]
    Token(String),
    /// Event mode.
    #[error("eventModeUsed = true: this unit has no event mode")]
    EventMode,
    /// Intermediate update.
    #[error("nRequiredIntermediateVariables = {0}: this unit has no intermediate update")]
    IntermediateVariables(usize),
}

impl call::Instance for Instance {
    type Function = Function;
    type Failure = Failure;
    type Logger = Logger;
    type Status = Status;

    fn component(&mut self) -> &mut Component {
        &mut self.component
    }

    fn logger(&self) -> &Logger {
        &self.logger
    }

    fn status(blame: Option<Blame>) -> Status {
        Status::of(blame)
    }
}

/// Results of fmi3DoStep beside its status.
pub struct StepResult {
    /// Whether the step ended before its end.
    pub early_return: types::Boolean,
    /// The communication point that was reached, `s`.
    pub last_successful_time: types::Float64,
}

impl Instance {
    /// fmi3InstantiateCoSimulation; `None` after a logged refusal.
    pub fn new(arguments: Instantiation<'_>) -> Option<Instance> {
        if let Err(refusal) = arguments.check() {
            arguments.messages.refuse("fmi3InstantiateCoSimulation", &refusal);
            return None;
        }
        let Messages { logger, mut journal } = arguments.messages;
        journal.inform(Category::Events, "instantiated".to_owned());
        logger.send(&journal.take());
        Some(Instance {
            component: Component::new(journal, arguments.resources),
            logger,
            early_return_allowed: arguments.early_return_allowed,
        })
    }

    /// fmi3DoStep: where the step ended, and why it did not end where it should.
    pub fn do_step(&mut self, current: f64, size: f64) -> (StepResult, Result<(), Failure>) {
        let result = self.component.do_step(current, size);
        let early = matches!(result, Err(failures::Failure::Interrupted { .. })) && self.early_return_allowed;
        let answer = StepResult {
            early_return: types::Boolean::from(early),
            last_successful_time: self.component.time(),
        };
        match result {
            Err(failures::Failure::Interrupted { reached, error, .. }) if early => {
                self.component.accept_part_of_step();
                (answer, Err(Failure::ReturnedEarly { reached, error }))
            }
            result => (answer, result.map_err(Failure::from)),
        }
    }
}

impl Instantiation<'_> {
    fn check(&self) -> Result<(), Refusal> {
        let name = self.name.unwrap_or_default().to_string_lossy();
        if name.trim().is_empty() {
            return Err(Refusal::Name);
        }
        let token = self.token.ok_or(Refusal::NoToken)?;
        if token.to_bytes() != INSTANTIATION_TOKEN.as_bytes() {
            return Err(Refusal::Token(token.to_string_lossy().into_owned()));
        }
        if self.event_mode_used {
            return Err(Refusal::EventMode);
        }
        match self.intermediate_variables {
            0 => Ok(()),
            number => Err(Refusal::IntermediateVariables(number)),
        }
    }
}
