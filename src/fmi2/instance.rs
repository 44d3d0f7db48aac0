//! Target of a fmi2Component pointer: the component and the importer's logger.

use super::GUID;
use super::failures::Failure;
use super::logger::Logger;
use super::states::Function;
use super::types::{CO_SIMULATION, CallbackFunctions, LAST_SUCCESSFUL_TIME, Real, Status, StatusKind};
use crate::fmi::call::{self, Logger as _};
use crate::fmi::component::Component;
use crate::fmi::failures::Blame;
use crate::fmi::logging::{Category, Journal, Rules};
use crate::fmi::resources::Resources;
use crate::parameters::path_of;
use std::ffi::CStr;

/// Rules of logging: at first the reasons of failed calls are told, and a list of categories is the whole list.
const LOGGING: Rules = Rules {
    at_first: &[Category::StatusError, Category::StatusWarning],
    always: &[],
    adds: false,
};

/// An instance.
pub struct Instance {
    /// The instance as every version of FMI has it.
    pub component: Component,
    logger: Logger,
}

/// The arguments of fmi2Instantiate that matter, copied from C.
pub struct Instantiation<'a> {
    /// Name of the instance.
    pub name: Option<&'a CStr>,
    /// Model exchange or co-simulation.
    pub fmu_type: i32,
    /// GUID of the importer's model description.
    pub guid: Option<&'a CStr>,
    /// URI of the resources.
    pub resource_location: Option<&'a CStr>,
    /// The importer's functions.
    pub callbacks: CallbackFunctions,
    /// Whether all log categories are on. Otherwise only the reasons of failed calls are told, until fmi2SetDebugLogging.
    pub logging_on: bool,
}

/// Reason why there is no instance.
#[derive(Debug, thiserror::Error)]
enum Refusal {
    #[error("instanceName is null or blank")]
    Name,
    #[error("fmuType = {0}: this is a unit for co-simulation (1)")]
    Type(i32),
    #[error("fmuGUID is a null pointer; the library's is {GUID}")]
    NoGuid,
    #[error("fmuGUID = {0}: the library's is {GUID}; description and library are not of one build")]
    Guid(String),
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

impl Instance {
    /// fmi2Instantiate; `None` after a logged refusal.
    pub fn new(arguments: &Instantiation<'_>) -> Option<Instance> {
        let logger = Logger::new(&arguments.callbacks, arguments.name.unwrap_or_default());
        let mut journal = Journal::new(logger.is_there(), arguments.logging_on, LOGGING);
        let checked = arguments.check();
        match &checked {
            Ok(()) => journal.inform(Category::Events, arguments.greeting()),
            Err(refusal) => journal.failure(Blame::Call, || format!("fmi2Instantiate: {refusal}")),
        }
        logger.send(&journal.take());
        checked.is_ok().then(|| Instance {
            component: Component::new(journal, arguments.resources()),
            logger,
        })
    }

    /// fmi2EnterInitializationMode.
    pub fn enter_initialization(&mut self) -> Result<(), Failure> {
        if !self.component.has_experiment() {
            return Err(Failure::NoExperiment);
        }
        self.component.enter_initialization();
        Ok(())
    }

    /// fmi2GetRealStatus: the end of the last step that was committed, whole or in part.
    pub fn last_successful_time(&self, kind: StatusKind) -> Result<Real, Failure> {
        if kind == LAST_SUCCESSFUL_TIME {
            Ok(self.component.time())
        } else {
            Err(Failure::StatusKind { kind })
        }
    }
}

impl Instantiation<'_> {
    fn check(&self) -> Result<(), Refusal> {
        let name = self.name.unwrap_or_default().to_string_lossy();
        if name.trim().is_empty() {
            return Err(Refusal::Name);
        }
        if self.fmu_type != CO_SIMULATION {
            return Err(Refusal::Type(self.fmu_type));
        }
        let guid = self.guid.ok_or(Refusal::NoGuid)?;
        if guid.to_bytes() != GUID.as_bytes() {
            return Err(Refusal::Guid(guid.to_string_lossy().into_owned()));
        }
        Ok(())
    }

    /// The resources of the archive. A location that is no folder's is that of none.
    fn resources(&self) -> Resources {
        let location = self.resource_location.and_then(|location| location.to_str().ok());
        let folder = location.filter(|location| !location.is_empty());
        Resources::new(folder.and_then(|folder| path_of(folder).ok()))
    }

    /// The location of the resources as it was given.
    fn greeting(&self) -> String {
        let location = self.resource_location.unwrap_or_default().to_string_lossy();
        if location.is_empty() {
            "instantiated".to_owned()
        } else {
            format!("instantiated; resources at {location}")
        }
    }
}
