//! Division of a step into sub-steps: after a jump, along a ramp, and where a sub-step fails.

use crate::contact::problem::Coupling;
use crate::error::Error;
use crate::settings::StepSettings;

/// Division of a step: how far it is, and how long the next sub-step is.
pub(super) struct Division<'a> {
    settings: &'a StepSettings,
    /// Length of the step, `s`.
    duration: f64,
    /// Time that is committed of it, `s`.
    committed: f64,
    /// Length of the next sub-step, of the longest one, and of the longest one unless one fails, `s`.
    substep: f64,
    largest: f64,
    planned: f64,
    /// Sub-steps that failed, implicit and staggered ones.
    retries: usize,
    staggered_retries: usize,
    /// Sub-steps at the limit that a failure has set, since it was set.
    at_limit: usize,
    /// Coupling of the sub-steps that follow.
    coupling: Coupling,
    /// Failure for which the rest of the step is not taken implicitly.
    failure: Option<Error>,
    /// Whether the pressure may be held where a staggered sub-step fails as well.
    may_hold: bool,
}

/// Part of a step.
#[derive(Clone, Copy)]
pub(super) struct SubStep {
    /// Length, `s`.
    pub length: f64,
    /// Time from the beginning of the step to its end, `s`.
    pub end: f64,
    /// Coupling of mechanics with heat and wear.
    pub coupling: Coupling,
}

impl<'a> Division<'a> {
    /// Division of a step into sub-steps of `planned` `s`, the first of which takes at most `first` `s`. With `may_hold` the contact can go on with the pressure
    /// that it has.
    pub fn new(settings: &'a StepSettings, duration: f64, [planned, first]: [f64; 2], may_hold: bool) -> Division<'a> {
        Division {
            settings,
            duration,
            committed: 0.0,
            substep: planned.min(first),
            largest: planned,
            planned,
            retries: 0,
            staggered_retries: 0,
            at_limit: 0,
            coupling: Coupling::Implicit,
            failure: None,
            may_hold,
        }
    }

    /// Time that is committed, `s`.
    pub fn committed(&self) -> f64 {
        self.committed
    }

    /// The next sub-step; none at the end of the step.
    pub fn next(&self) -> Option<SubStep> {
        (self.committed < self.duration).then(|| {
            // The last sub-step takes the rest, so that no sliver is left over by rounding.
            let remaining = self.remaining();
            let length = if remaining < 1.5 * self.substep {
                remaining
            } else {
                self.substep
            };
            SubStep {
                length,
                end: if length == remaining {
                    self.duration
                } else {
                    self.committed + length
                },
                coupling: self.coupling,
            }
        })
    }

    fn remaining(&self) -> f64 {
        self.duration - self.committed
    }

    /// Commits a sub-step.
    pub fn commit(&mut self, part: SubStep) {
        self.committed = part.end;
        // After some sub-steps at the limit that a failure has set, longer ones are tried.
        self.at_limit = if part.length >= self.largest {
            self.at_limit + 1
        } else {
            0
        };
        if self.at_limit >= self.settings.substeps_at_limit && self.failure.is_none() {
            (self.largest, self.at_limit) = ((2.0 * self.largest).min(self.planned), 0);
        }
        self.substep = (2.0 * self.substep).min(self.largest);
    }

    /// Whether no sub-step has failed. The budget is that of a step which is hard, not of one with many sub-steps: each has it anew until one fails.
    pub fn has_not_failed(&self) -> bool {
        self.retries == 0 && self.failure.is_none()
    }

    /// Chooses what follows a sub-step that fails: a shorter one, or the rest of the step staggered, or with the pressure held.
    ///
    /// # Errors
    /// The failure that ends the step.
    pub fn shorten(&mut self, part: SubStep, error: Error) -> Result<(), Error> {
        // What the window cannot hold no step can; a surface that a step wears away is worn away by shorter ones as well.
        if let Error::ContactLeavesWindow { .. }
        | Error::WheelOffRail { .. }
        | Error::WornAway { .. }
        | Error::OtherContactModel = error
        {
            return Err(error);
        }
        let StepSettings {
            retries,
            staggered_retries,
            staggered_substeps,
            ..
        } = *self.settings;
        if let Some(first) = &self.failure {
            let tried = self.staggered_retries;
            let gives_up = match error {
                // Shorter sub-steps take as much work each: one is tried.
                Error::TooMuchWork { .. } => tried >= staggered_retries.min(1),
                Error::NormalNotConverged { .. } => tried == staggered_retries,
                _ => false,
            };
            if self.may_hold && gives_up && self.coupling == Coupling::Staggered {
                self.go_on(Coupling::Held);
                return Ok(());
            }
            // Of two failures the first says why.
            if self.coupling == Coupling::Held || tried == staggered_retries {
                return Err(first.clone());
            }
            self.staggered_retries += 1;
            self.substep = 0.25 * part.length;
            self.largest = 0.5 * part.length;
        } else if self.retries < retries && !matches!(error, Error::TooMuchWork { .. }) {
            // A shorter sub-step starts closer to its solution.
            self.retries += 1;
            self.substep = 0.25 * part.length;
            self.largest = self.largest.min(0.5 * part.length);
        } else if staggered_substeps > 0 {
            self.go_on(Coupling::Staggered);
            self.failure = Some(error);
        } else {
            return Err(error);
        }
        Ok(())
    }

    /// Takes the rest of the step with another coupling, in as many sub-steps as are taken staggered.
    fn go_on(&mut self, coupling: Coupling) {
        self.coupling = coupling;
        self.substep = self.remaining() / self.settings.staggered_substeps as f64;
        self.largest = self.substep;
    }
}
