//! Torture: wheels with random parameters are driven at random, through braking, spinning on the spot, reversing, standstill,
//! lift-off and jumps. No step may fail, and what a step leaves must be finite and within its bounds.
//!
//! Where the rail gets hotter than the model answers for, or its bulge makes a given penetration take more than the largest
//! load, it is replaced by a cold one.
//!
//! A run follows from a seed and its number: `wheelrail torture --seed S --run R` replays it.

mod bodies;
mod draw;
mod drive;
#[doc(hidden)]
pub mod random;
mod slow;

use crate::error::Error;
use crate::parameters::{ContactModel, Control, Parameters};
use crate::signals::OUTPUTS;
use crate::wheel_rail::{Model, State, Workspace};
use drive::Drive;
use random::Random;
use std::fmt;
use std::ops::Range;
use std::panic::AssertUnwindSafe;
use std::time::Instant;

pub use drive::DriveStep;
pub use slow::{Slow, explain};

/// Consecutive runs that differ in their tunable parameters and their drive share a model: it takes as long to build as many
/// steps.
const RUNS_PER_MODEL: u64 = 4;

/// Absolute temperature up to which no run may fail, `K`. Rail steel is austenite above some 1000 K and melts at 1770 K; its
/// properties are constants here, so that well above 1000 K the model answers for nothing.
pub const LARGEST_TEMPERATURE: f64 = 1373.15;

/// Contact models that are tortured.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Engines {
    /// The line contact.
    Line,
    /// The patch.
    Patch,
    /// Profiles, perturbed and worn ones among them, which may wear on.
    Profiles,
    /// Built-in profiles that stay new.
    NewProfiles,
    /// Line and patch in turn.
    #[default]
    Both,
}

/// Runs of a seed.
#[derive(Debug, Clone, Copy)]
pub struct Torture {
    /// The seed.
    pub seed: u64,
    /// Steps of a run.
    pub steps: usize,
    /// Half-width of the contact window in units of the usual one, at the same spacing of the nodes; at most 3.
    pub window: f64,
    /// The contact models of the runs.
    pub engines: Engines,
}

/// Failure of a run.
#[derive(Debug, Clone, PartialEq)]
pub enum RunFailure {
    /// Error of the model: it could not be built, or had no first state, or a step failed.
    Model(Error),
    /// A step that left the state neither as it was nor as far on as it said.
    Changed,
    /// An output, by its name, that is not finite or out of its bounds.
    Output(&'static str, f64),
    /// A state that the model would not accept.
    State,
    /// A panic.
    Panic,
}

impl fmt::Display for RunFailure {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            RunFailure::Model(error) => write!(f, "{error}"),
            RunFailure::Changed => write!(f, "a step that failed has changed the state"),
            RunFailure::Output(name, value) => write!(f, "the output {name} is {value}"),
            RunFailure::Panic => write!(f, "a panic"),
            RunFailure::State => write!(f, "the model does not accept the state"),
        }
    }
}

impl RunFailure {
    /// Kind of the failure: the name of the error.
    pub fn kind(&self) -> String {
        let text = match self {
            RunFailure::Model(error) => format!("{error:?}"),
            other => format!("{other:?}"),
        };
        let end = text.find([' ', '(', '{']).unwrap_or(text.len());
        text[..end].to_owned()
    }
}

/// Time and iterations that one step took.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepTime {
    /// Number of the run.
    pub run: u64,
    /// Number of the step in its run, from 0.
    pub step: usize,
    /// Time that it took, `s`.
    pub time: f64,
    /// Iterations of the split over all sub-steps.
    pub iterations: usize,
    /// Whether a part of it was taken staggered.
    pub staggered: bool,
    /// Residual of its last part; 1 or more where the pressure of the step before was held.
    pub residual: f64,
}

/// Extent, load and temperature of a run after a step.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Reach {
    /// Outermost node under pressure in units of the Hertz half-length at `largest_load`.
    pub outermost: f64,
    /// Load that the contact carried over `largest_load`.
    pub load: f64,
    /// Largest temperature of the rail's surface, `K`.
    pub temperature: f64,
}

/// Result of one run.
#[derive(Debug, Clone)]
pub struct Run {
    /// Number of the run.
    pub number: u64,
    /// The steps that were taken.
    pub steps: Vec<StepTime>,
    /// Extent, load and temperature after each step.
    pub reach: Vec<Reach>,
    /// Number of times that the rail was replaced by a cold one, after a step or because of one that failed.
    pub replaced: usize,
    /// Steps until it ended, those that found the rail too hot included.
    pub length: usize,
    /// Failure that ended the run, unless it ended after all steps.
    pub failure: Option<RunFailure>,
}

impl Torture {
    /// Parameters of a run.
    pub fn parameters(&self, run: u64) -> Parameters {
        let model = run / RUNS_PER_MODEL;
        let contact_model = match self.engines {
            Engines::Line => ContactModel::Line,
            Engines::Patch => ContactModel::Patch,
            Engines::Profiles | Engines::NewProfiles => ContactModel::Profiles,
            Engines::Both if model.is_multiple_of(2) => ContactModel::Line,
            Engines::Both => ContactModel::Patch,
        };
        let mut parameters = draw::parameters(&mut Random::new(self.seed, 2 * model), contact_model);
        draw::tune(&mut self.random(run), &mut parameters);
        if self.engines == Engines::Profiles {
            bodies::draw(self.seed, model, &mut parameters);
        }
        parameters
    }

    /// Random numbers of a run alone.
    fn random(&self, run: u64) -> Random {
        Random::new(self.seed, 2 * run + 1)
    }

    /// The drive of a run with its parameters.
    fn drive<'a>(&self, run: u64, parameters: &'a Parameters) -> Drive<'a> {
        let mut random = self.random(run);
        draw::tune(&mut random, &mut parameters.clone());
        Drive::new(random, parameters, parameters.largest_load)
    }

    /// The runs that share a model, by its number.
    pub fn runs_of_model(model: u64) -> Range<u64> {
        model * RUNS_PER_MODEL..(model + 1) * RUNS_PER_MODEL
    }

    /// Takes runs that share a model, or one of them.
    pub fn runs(&self, numbers: Range<u64>) -> Vec<Run> {
        let first = numbers.start;
        let runs = self.take_runs(numbers);
        self.remove_files(first);
        runs
    }

    /// Removes the files that the parameters of a run name.
    fn remove_files(&self, run: u64) {
        if self.engines == Engines::Profiles {
            bodies::remove(self.seed, run / RUNS_PER_MODEL);
        }
    }

    fn take_runs(&self, numbers: Range<u64>) -> Vec<Run> {
        let fixed = draw::with_window(&self.parameters(numbers.start), self.window);
        let mut built = Model::new(fixed);
        numbers
            .map(|number| {
                let mut run = Run {
                    number,
                    steps: Vec::with_capacity(self.steps),
                    reach: Vec::with_capacity(self.steps),
                    replaced: 0,
                    length: 0,
                    failure: None,
                };
                let outcome = match &mut built {
                    Ok(model) => model
                        .retune(&self.parameters(number))
                        .map_err(RunFailure::Model)
                        .and_then(|()| {
                            // What a panic leaves is not used any more.
                            let follow = AssertUnwindSafe(|| self.follow(model, &mut run));
                            std::panic::catch_unwind(follow).unwrap_or(Err(RunFailure::Panic))
                        }),
                    Err(error) => Err(RunFailure::Model(error.clone())),
                };
                run.failure = outcome.err();
                run
            })
            .collect()
    }

    /// Takes the steps of a run.
    fn follow(&self, model: &Model, run: &mut Run) -> Result<(), RunFailure> {
        let by_place = model.parameters().contact_model == ContactModel::Profiles;
        // Those without the wider window.
        let parameters = self.parameters(run.number);
        let mut drive = self.drive(run.number, &parameters);
        let mut workspace = model.workspace();
        let mut state = loop {
            match model.initial_state(&mut workspace, drive.inputs()) {
                Ok(state) => break state,
                // A wheelset that begins off the rails or deep in them has not begun yet.
                Err(error) if by_place && is_refused(model, &error) => drive.step(),
                Err(error) => return Err(RunFailure::Model(error)),
            };
        };
        for number in 0..self.steps {
            run.length = number;
            let step = drive.step();
            let before = state.clone();
            let start = Instant::now();
            let outcome = take(model, &mut workspace, &mut state, &step);
            let time = start.elapsed().as_secs_f64();
            if let Err((committed, error)) = &outcome {
                let stays = state.time == before.time + committed && (*committed > 0.0 || state == before);
                if !stays {
                    return Err(RunFailure::Changed);
                }
                let excused =
                    is_refused(model, error) || is_worn_too_fast(model, error) || is_too_hot(model, &before, &step);
                if !excused {
                    return Err(RunFailure::Model(error.clone()));
                }
            } else {
                check(model, &state)?;
                run.steps.push(StepTime {
                    run: run.number,
                    step: number,
                    time,
                    iterations: state.convergence.iterations,
                    staggered: state.convergence.staggered,
                    residual: state.convergence.residual,
                });
                run.reach.push(reach(model, &parameters, &state));
            }
            // A wheel that is off the rail, or pressed too deep into it, stays where it was until it can be again where it should.
            let stays = matches!(&outcome, Err((_, error)) if is_refused(model, error));
            if outcome.is_err() && !(stays && by_place) || is_hot(&state) {
                run.replaced += 1;
                match model.initial_state(&mut workspace, drive.inputs()) {
                    Ok(replaced) => state = replaced,
                    Err(error) if by_place && is_refused(model, &error) => {}
                    Err(error) => return Err(RunFailure::Model(error)),
                }
            }
        }
        run.length = self.steps;
        Ok(())
    }
}

/// Whether a step that fails would heat the rail to more than [`LARGEST_TEMPERATURE`]: taken by a rail that does not bulge,
/// whose contact stays in its window. What that one cannot either is not excused.
fn is_too_hot(model: &Model, before: &State, step: &DriveStep) -> bool {
    let flat = Parameters {
        thermal_expansion: 0.0,
        ..model.parameters().clone()
    };
    let Ok(flat) = Model::new(flat) else { return false };
    let mut state = before.clone();
    let outcome = take(&flat, &mut flat.workspace(), &mut state, step);
    outcome.is_ok() && is_hot(&state)
}

/// Whether a step has worn a profile away whose wear is accelerated. The acceleration has made the profile that the step began with, too.
fn is_worn_too_fast(model: &Model, error: &Error) -> bool {
    matches!(error, Error::WornAway { .. }) && model.parameters().wear_acceleration > 1.0
}

/// Whether the step was one to be refused: the bulge of a hot rail makes a given penetration take more than the largest load, or a wheelset is
/// pressed into the rails as deep, or until their profiles are worn away; or the wheel has climbed over the rail or fallen off it.
fn is_refused(model: &Model, error: &Error) -> bool {
    match error {
        Error::ContactLeavesWindow { .. } | Error::ContactOutgrowsWindow | Error::WornAway { .. } => {
            model.parameters().control != Control::Load
        }
        Error::WheelOffRail { .. } => true,
        _ => false,
    }
}

/// Whether the rail is hotter than the model answers for.
fn is_hot(state: &State) -> bool {
    state.outputs.peak_temperature > LARGEST_TEMPERATURE
}

/// One step; the error has the time that was committed before it.
fn take(model: &Model, workspace: &mut Workspace, state: &mut State, step: &DriveStep) -> Result<(), (f64, Error)> {
    model
        .step(workspace, state, &step.inputs, &step.rates, step.duration)
        .map_err(|interrupted| (interrupted.committed, interrupted.error))
}

/// Outputs within their bounds, a state that can be saved and resumed.
fn check(model: &Model, state: &State) -> Result<(), RunFailure> {
    for signal in OUTPUTS {
        let value = (signal.get)(&state.outputs);
        let above = signal.minimum.is_none_or(|minimum| value >= minimum);
        let below = signal.maximum.is_none_or(|maximum| value <= maximum);
        if !(value.is_finite() && above && below) {
            return Err(RunFailure::Output(signal.name, value));
        }
    }
    if model.accepts(state) {
        Ok(())
    } else {
        Err(RunFailure::State)
    }
}

/// Extent of the contact along the rail, its load and its temperature.
fn reach(model: &Model, parameters: &Parameters, state: &State) -> Reach {
    let nodes = model.contact_nodes(state);
    let pressed = nodes.iter().filter(|node| node.pressure > 0.0);
    let outermost = pressed.map(|node| node.position.abs()).fold(0.0, f64::max);
    let (half_length, _) = parameters.contact_half_axes(parameters.largest_load);
    Reach {
        outermost: outermost / half_length,
        load: state.outputs.normal_force / parameters.largest_load,
        temperature: state.outputs.peak_temperature,
    }
}
