//! The stepped model: inputs in, state advanced, outputs out. It knows nothing of FMI.

use crate::contact::line::fields::{Fields, Trend};
use crate::contact::line::rail::Rail;
use crate::contact::line::sensitivity::Linearisation;
use crate::contact::line::split::{Conditions, Contact, Scratch};
use crate::contact::outputs;
use crate::contact::rim;
use crate::error::{Error, Result};
use crate::friction;
use crate::parameters::Parameters;
use crate::signals::{Inputs, OUTPUTS, Outputs};
use serde::{Deserialize, Serialize};

pub use crate::contact::line::profiles::{DEPTH_POINTS, PROFILE_POINTS, Profiles};
pub use crate::contact::line::split::Convergence;

/// A change of the inputs by more than this share of their scale is a jump: the step that follows it is divided.
const JUMP: f64 = 0.2;
/// Length of the first sub-step after a jump, in passages of the contact window; each further one doubles.
const FIRST_SUBSTEP: f64 = 0.25;
/// Largest number of sub-steps of equal length while the inputs change at given rates.
const RAMP_SUBSTEPS: f64 = 50.0;
/// Shortest time that a step takes, `s`: rates of change over less would overflow, and no quantity can tell the difference.
const SHORTEST_STEP: f64 = 1e-100;
/// Times that a sub-step which does not converge is quartered, in one step.
const RETRIES: usize = 4;

/// Everything that does not change after initialisation: the rail, and the parameters (but for the tunable ones).
pub struct Model {
    parameters: Parameters,
    rail: Rail,
}

/// Scratch of a step: no content survives from one call to the next that would change a result.
pub struct Workspace {
    scratch: Scratch,
    trial: Fields,
}

/// Everything that changes in time.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct State {
    /// Time since the start, `s`.
    pub time: f64,
    /// Inputs at the last committed instant.
    pub inputs: Inputs,
    /// Length of the last committed sub-step, `s`; 0 before the first.
    pub duration: f64,
    /// Temperature, wear, tractions.
    pub fields: Fields,
    /// How they changed over the last sub-step.
    pub trend: Trend,
    /// Outputs at the last committed instant, totals included.
    pub outputs: Outputs,
    /// Rates of change of the outputs over the last committed sub-step, per second.
    pub output_rates: Outputs,
    /// How the last step converged.
    pub convergence: Convergence,
}

/// A step that did not reach its end: the state stands at the last committed sub-step.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("the step ended after {committed} s: {error}")]
pub struct Interrupted {
    /// Time that was committed of the step, `s`; 0 when nothing was.
    pub committed: f64,
    /// Why the next sub-step failed.
    #[source]
    pub error: Error,
}

impl Model {
    /// Builds mesh, compliance and thermal maps.
    ///
    /// # Errors
    /// Everything [`Parameters::validate`] refuses, and a stiffness matrix that cannot be factorised.
    pub fn new(parameters: Parameters) -> Result<Model> {
        parameters.validate()?;
        let rail = Rail::new(&parameters)?;
        Ok(Model { parameters, rail })
    }

    /// The parameters.
    pub fn parameters(&self) -> &Parameters {
        &self.parameters
    }

    /// The rail: mesh, compliance, thermal maps.
    pub fn rail(&self) -> &Rail {
        &self.rail
    }

    /// Takes the tunable parameters (slip regularisation and friction coefficients) from `parameters`; the others stay.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Combination`]; nothing is changed then.
    pub fn retune(&mut self, parameters: &Parameters) -> Result<()> {
        let mut tuned = self.parameters.clone();
        for entry in crate::parameters::REAL_PARAMETERS.iter().filter(|entry| entry.tunable) {
            let value = (entry.get)(parameters);
            entry.check(value)?;
            (entry.set)(&mut tuned, value);
        }
        tuned.validate_friction()?;
        self.parameters = tuned;
        Ok(())
    }

    /// Scratch for [`Model::step`].
    pub fn workspace(&self) -> Workspace {
        Workspace {
            scratch: Scratch::new(&self.rail),
            trial: Fields::new(&self.rail),
        }
    }

    /// Rail and wheel at ambient and unworn under the given inputs: mechanics solved, no heat and no wear yet, nothing has
    /// come in.
    ///
    /// # Errors
    /// Inputs out of range, or a solver that did not converge.
    pub fn initial_state(&self, workspace: &mut Workspace, inputs: &Inputs) -> Result<State> {
        inputs.check(&self.parameters)?;
        let mut fields = Fields::new(&self.rail);
        fields.wheel_temperature = inputs.ambient_temperature;
        let contact = self.contact(inputs, f64::INFINITY);
        contact.solve_mechanics(&mut fields, &mut workspace.scratch)?;
        let mut state = State {
            time: 0.0,
            inputs: *inputs,
            duration: 0.0,
            fields,
            trend: Trend::new(&self.rail),
            outputs: Outputs::default(),
            output_rates: Outputs::default(),
            convergence: Convergence::default(),
        };
        state.outputs = outputs::instantaneous(&self.rail, &self.parameters, &state.fields, inputs);
        Ok(state)
    }

    /// Whether a state (of another source) has the sizes of this model and finite content.
    pub fn accepts(&self, state: &State) -> bool {
        let expected = Fields::new(&self.rail);
        let fields = &state.fields;
        let expected_trend = Trend::new(&self.rail);
        let pairs = fields.vectors().into_iter().zip(expected.vectors());
        let trends = state.trend.vectors().into_iter().zip(expected_trend.vectors());
        pairs
            .chain(trends)
            .all(|(own, expected)| own.len() == expected.len() && own.iter().all(|v| v.is_finite()))
            && OUTPUTS.iter().all(|signal| (signal.get)(&state.outputs).is_finite())
            && fields.penetration.is_finite()
            && fields.wheel_temperature.is_finite()
            && state.time.is_finite()
            && state.duration >= 0.0
            && state.inputs.check(&self.parameters).is_ok()
    }

    /// Advances the state by `duration` `s`; the inputs start at `inputs` and change at `rates` per second.
    ///
    /// The step is implicit in time, of order 1. It is divided after a jump of the inputs, from a quarter of the
    /// passage of the contact window on with doubling sub-steps, and where the rates change the inputs by more
    /// than a fifth of their scale. A sub-step that does not converge is tried again in quarters.
    ///
    /// # Errors
    /// [`Interrupted`]: the state stands at the last committed sub-step, bit for bit.
    pub fn step(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        rates: &Inputs,
        duration: f64,
    ) -> std::result::Result<(), Interrupted> {
        let duration = if duration > 0.0 {
            duration.max(SHORTEST_STEP)
        } else {
            duration
        };
        let start = state.time;
        let mut committed = 0.0;
        let interrupted = |committed, error| Interrupted { committed, error };
        inputs
            .check(&self.parameters)
            .and_then(|()| self.inputs_at(inputs, rates, duration).check(&self.parameters))
            .map_err(|error| interrupted(0.0, error))?;

        let jump = self.change(&state.inputs, inputs);
        let ramp = self.change(inputs, &self.inputs_at(inputs, rates, duration));
        let mut substep = duration / (ramp / JUMP).ceil().clamp(1.0, RAMP_SUBSTEPS);
        let largest_substep = substep;
        if jump > JUMP {
            substep = substep.min(FIRST_SUBSTEP * self.passage_time(inputs));
        }
        let mut convergence = Convergence::default();
        let mut retries = 0;
        while committed < duration {
            // The last sub-step takes the rest, so that no sliver is left over by rounding.
            let remaining = duration - committed;
            let length = if remaining < 1.5 * substep { remaining } else { substep };
            let end = if length == remaining {
                duration
            } else {
                committed + length
            };
            let at_end = self.inputs_at(inputs, rates, end);
            let solved = match self.advance(workspace, state, &at_end, length) {
                Ok(solved) => solved,
                // A shorter sub-step starts closer to its solution; what the window cannot hold no step can.
                Err(error) if !matches!(error, Error::ContactLeavesWindow { .. }) && retries < RETRIES => {
                    retries += 1;
                    substep = 0.25 * length;
                    continue;
                }
                Err(error) => return Err(interrupted(committed, error)),
            };
            committed = end;
            state.time = start + committed;
            convergence.iterations += solved.iterations;
            convergence.residual = solved.residual;
            state.convergence = convergence;
            substep = (2.0 * substep).min(largest_substep);
        }
        Ok(())
    }

    /// One implicit step of `duration` to the given inputs; commits only on success.
    fn advance(
        &self,
        workspace: &mut Workspace,
        state: &mut State,
        inputs: &Inputs,
        duration: f64,
    ) -> Result<Convergence> {
        let Workspace { scratch, trial } = workspace;
        // The march makes the temperature anew.
        trial.copy_surface_from(&state.fields);
        // Not further than it was observed.
        state.trend.extrapolate(trial, duration.min(state.duration));
        let contact = self.contact(inputs, duration);
        let convergence = contact.operator_split(&state.fields, trial, scratch)?;

        let mut outputs = outputs::instantaneous(&self.rail, &self.parameters, trial, inputs);
        outputs.worn_volume = state.outputs.worn_volume + outputs.wear_rate * duration;
        outputs.friction_energy = state.outputs.friction_energy + outputs.friction_power * duration;
        outputs.distance = state.outputs.distance + contact.conditions.motion.rolling_speed.abs() * duration;
        outputs.wheel_wear_depth = state.outputs.wheel_wear_depth
            + rim::wear_rate(
                &self.parameters,
                outputs::sliding_power(&self.rail, &self.parameters, trial),
            ) * duration;
        for signal in OUTPUTS {
            let rate = ((signal.get)(&outputs) - (signal.get)(&state.outputs)) / duration;
            (signal.set)(&mut state.output_rates, rate);
        }
        state.trend.update(&state.fields, trial, duration);
        std::mem::swap(&mut state.fields, trial);
        state.inputs = *inputs;
        state.duration = duration;
        state.outputs = outputs;
        Ok(convergence)
    }

    /// The inputs `time` after the beginning of a step.
    fn inputs_at(&self, inputs: &Inputs, rates: &Inputs, time: f64) -> Inputs {
        inputs.advanced(rates, time).snapped(&self.parameters)
    }

    fn contact(&self, inputs: &Inputs, duration: f64) -> Contact<'_> {
        Contact {
            rail: &self.rail,
            parameters: &self.parameters,
            conditions: Conditions {
                inputs: *inputs,
                motion: inputs.motion(&self.parameters),
                duration,
            },
        }
    }

    /// Largest change between two sets of inputs, each relative to what changes the contact appreciably.
    fn change(&self, from: &Inputs, to: &Inputs) -> f64 {
        let (before, after) = (from.motion(&self.parameters), to.motion(&self.parameters));
        let speed = before.rolling_speed.abs().max(after.rolling_speed.abs());
        // Creepage at which the whole contact slides, μ a / r₀.
        let load = from.normal_load.max(to.normal_load);
        let saturation = friction::largest_coefficient(&self.parameters) * self.parameters.hertz_half_length(load)
            / self.parameters.wheel_radius;
        let relative = |change: f64, scale: f64| if change == 0.0 { 0.0 } else { change.abs() / scale };
        relative(after.rolling_speed - before.rolling_speed, speed)
            .max(relative(
                after.rigid_slip - before.rigid_slip,
                (saturation * speed)
                    .max(after.rigid_slip.abs())
                    .max(before.rigid_slip.abs()),
            ))
            .max(relative(to.normal_load - from.normal_load, load))
            .max(relative(
                to.friction_scale - from.friction_scale,
                from.friction_scale.max(to.friction_scale),
            ))
    }

    /// Time in which rail material crosses the contact window, `s`; infinite at rest.
    fn passage_time(&self, inputs: &Inputs) -> f64 {
        2.0 * self.rail.mesh.window_half_width() / inputs.motion(&self.parameters).rolling_speed.abs()
    }

    /// Rates of change of the outputs at the communication point, per second: over the last sub-step.
    pub fn output_rates(&self, state: &State) -> Outputs {
        state.output_rates
    }

    /// Derivatives of the outputs with respect to inputs at the communication point, from the linearised discrete equations
    /// of the last sub-step ([`crate::contact::line::sensitivity`]): one entry for each of the given rows of [`crate::signals::INPUTS`].
    ///
    /// Held fixed are temperature, wear and totals at the beginning of that sub-step and its length; after
    /// initialisation, where no time has passed yet, temperature and wear themselves.
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn output_sensitivities(
        &self,
        workspace: &mut Workspace,
        state: &State,
        inputs: impl IntoIterator<Item = usize>,
    ) -> Result<Vec<Outputs>> {
        let Workspace { scratch, trial } = workspace;
        trial.copy_from(&state.fields);
        let mut step = Linearisation::new(self.contact(&state.inputs, state.duration), trial, scratch)?;
        inputs.into_iter().map(|input| step.output_sensitivity(input)).collect()
    }

    /// How the last step converged.
    pub fn convergence(&self, state: &State) -> Convergence {
        state.convergence
    }

    /// Profiles for plotting.
    pub fn profiles(&self, state: &State) -> Profiles {
        Profiles::new(&self.rail, &state.fields, state.inputs.ambient_temperature)
    }
}
