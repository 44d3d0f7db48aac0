//! The way into every call on an instance: null check, state check, panic fence, status, messages.

#![allow(unsafe_code)]

use super::component::Component;
use super::failures::{self, Blame};
use super::fence;
use super::logging::Message;
use super::modes::Mode;
use std::ffi::c_void;
use std::fmt::Display;

/// A function of a standard that is bound to states.
pub trait Function: Copy {
    /// The exported name.
    fn name(self) -> &'static str;
    /// Whether the standard allows the call in a state.
    fn is_allowed(self, mode: Mode) -> bool;
    /// The standard's name of a state.
    fn name_of(mode: Mode) -> &'static str;
    /// The states in which the call is allowed, for messages.
    fn allowed_modes(self) -> String;
}

/// Refusal of a call that did not do all it was asked for, with its reason.
pub trait Refusal: Display + From<failures::Failure> {
    /// Party to blame.
    fn blame(&self) -> Blame;
}

/// The importer's logger, with what it is to be given.
pub trait Logger: Clone {
    /// Hands messages to the importer.
    fn send(&self, messages: &[Message]);
}

/// An instance as a version of FMI has it.
pub trait Instance: Sized {
    /// The functions on an instance.
    type Function: Function;
    /// Reason why a call failed.
    type Failure: Refusal;
    /// The importer's logger.
    type Logger: Logger;
    /// Status that a call returns.
    type Status;

    /// The instance as every version has it.
    fn component(&mut self) -> &mut Component;
    /// The importer's logger.
    fn logger(&self) -> &Self::Logger;
    /// The status that follows from who is to blame.
    fn status(blame: Option<Blame>) -> Self::Status;

    /// State check, panic fence, and what a failure does to the instance. The messages wait to be taken.
    fn guarded(
        &mut self,
        function: Self::Function,
        body: impl FnOnce(&mut Self) -> Result<(), Self::Failure>,
    ) -> Option<Blame> {
        let result = fence::fenced(|| {
            let mode = self.component().mode();
            if !function.is_allowed(mode) {
                let state = Self::Function::name_of(mode);
                let allowed = function.allowed_modes();
                return Err(failures::Failure::NotAllowed { state, allowed }.into());
            }
            body(self)
        });
        // The fence's own failure is one like the others.
        let failure = result
            .unwrap_or_else(|panic| Err(failures::Failure::Panic { message: panic.message }.into()))
            .err()?;
        let blame = failure.blame();
        let component = self.component();
        component.fail(blame);
        // Inside the fence as well: the reason may compute a number in the unit that it is told in.
        let journal = &mut component.journal;
        let told = fence::fenced(|| journal.failure(blame, || format!("{}: {failure}", function.name())));
        if let Err(panic) = told {
            journal.failure(blame, || format!("{}: {}", function.name(), panic.message));
        }
        Some(blame)
    }
}

/// Every call on an instance.
///
/// # Safety
/// `instance` must be null or an instance of this version of FMI that was not freed, and is not used by another thread.
pub unsafe fn call<I: Instance>(
    instance: *mut c_void,
    function: I::Function,
    body: impl FnOnce(&mut I) -> Result<(), I::Failure>,
) -> I::Status {
    // SAFETY: null or a live instance that nobody else uses (the caller's promise).
    let Some(instance) = (unsafe { instance.cast::<I>().as_mut() }) else {
        return I::status(Some(Blame::Call));
    };
    let blame = instance.guarded(function, body);
    let (messages, logger) = (instance.component().journal.take(), instance.logger().clone());
    // From here on the instance is not touched: the logger may call back into it, or free it.
    logger.send(&messages);
    I::status(blame)
}
