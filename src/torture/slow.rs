//! Search for what makes a step slow: the step is taken again without one of the methods for hard steps at a time.

use super::{DriveStep, StepTime, Torture, draw, is_hot, take};
use crate::error::Result;
use crate::settings::Settings;
use crate::wheel_rail::{Model, State};
use std::time::Instant;

/// A step under the magnifying glass.
#[derive(Debug, Clone)]
pub struct Slow {
    /// Time and iterations that the step took.
    pub taken: StepTime,
    /// Length of the step, `s`.
    pub duration: f64,
    /// Rolling speed at its end, `m/s`.
    pub rolling_speed: f64,
    /// Rigid slip at its end, `m/s`.
    pub rigid_slip: f64,
    /// Load at its end, `N`.
    pub load: f64,
    /// Nodes in the contact window.
    pub nodes: usize,
    /// Nodes under pressure.
    pub pressed: usize,
    /// The least time of a few repetitions, `s`: the first one may have been interrupted.
    pub again: f64,
    /// Methods, and what it takes without them: `None` where it fails.
    pub without: Vec<(&'static str, Option<(f64, usize)>)>,
}

/// A method by what it is for, and how it is switched off.
type Method = (&'static str, fn(&mut Settings));

/// The methods that only hard steps use.
const METHODS: [Method; 6] = [
    ("Newton's method", |settings| {
        settings.split.idle_iterations = usize::MAX;
        settings.split.fixed_point_iterations = usize::MAX;
    }),
    ("sub-steps", |settings| {
        settings.step.jump = f64::INFINITY;
    }),
    ("shorter tries", |settings| settings.step.retries = 0),
    ("continuation in the regularisation", |settings| {
        settings.patch.continuation = 0;
    }),
    ("descent in the normal problem", |settings| {
        settings.normal.descents_per_node = 0;
    }),
    ("Anderson's method", |settings| {
        settings.split.accelerate_after = usize::MAX;
    }),
];

/// Repetitions of a step.
const REPEATS: usize = 3;

/// Least time of a step from a state in some repetitions, `s`, and the state after it.
///
/// # Errors
/// That of the step.
fn repeated(model: &Model, before: &State, step: &DriveStep) -> Result<(f64, State)> {
    let mut workspace = model.workspace();
    let (mut least, mut state) = (f64::INFINITY, before.clone());
    for _ in 0..REPEATS {
        state = before.clone();
        let start = Instant::now();
        take(model, &mut workspace, &mut state, step).map_err(|(_, error)| error)?;
        least = least.min(start.elapsed().as_secs_f64());
    }
    Ok((least, state))
}

/// Takes the step again, with and without these methods.
///
/// # Errors
/// Whatever the run's model or the steps before return.
pub fn explain(torture: &Torture, taken: StepTime) -> Result<Slow> {
    let explained = explained(torture, taken);
    torture.remove_files(taken.run);
    explained
}

fn explained(torture: &Torture, taken: StepTime) -> Result<Slow> {
    let drawn = torture.parameters(taken.run);
    let parameters = draw::with_window(&drawn, torture.window);
    let model = Model::new(parameters.clone())?;
    let mut drive = torture.drive(taken.run, &drawn);
    let mut workspace = model.workspace();
    let mut state = model.initial_state(&mut workspace, drive.inputs())?;
    for _ in 0..taken.step {
        let outcome = take(&model, &mut workspace, &mut state, &drive.step());
        if outcome.is_err() || is_hot(&state) {
            state = model.initial_state(&mut workspace, drive.inputs())?;
        }
    }
    let step = drive.step();
    let before = state;
    let (again, state) = repeated(&model, &before, &step)?;
    let mut without = Vec::with_capacity(METHODS.len());
    for (name, switch_off) in METHODS {
        let mut settings = Settings::default();
        // A step that is not solved fails here.
        settings.step.staggered_substeps = 0;
        switch_off(&mut settings);
        let model = Model::with_settings(parameters.clone(), settings)?;
        let taken = repeated(&model, &before, &step).ok();
        without.push((name, taken.map(|(time, state)| (time, state.convergence.iterations))));
    }
    let motion = state.inputs.motion(&parameters);
    let nodes = model.contact_nodes(&state);
    Ok(Slow {
        taken,
        duration: step.duration,
        rolling_speed: motion.rolling_speed,
        rigid_slip: motion.rigid_slip,
        load: state.inputs.normal_load,
        nodes: nodes.len(),
        pressed: nodes.iter().filter(|node| node.pressure > 0.0).count(),
        again,
        without,
    })
}
