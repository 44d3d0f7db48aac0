//! The stepped model: inputs in, state advanced, outputs out. It knows nothing of FMI.

use crate::contact::{Conditions, Contact, Fields, Rail, Scratch};
use crate::error::{Error, Result};
use crate::friction;
use crate::parameters::Parameters;
use crate::signals::{Inputs, Outputs, OUTPUTS};
use serde::{Deserialize, Serialize};

pub use crate::contact::Convergence;
pub use crate::profiles::{Profiles, DEPTH_POINTS, PROFILE_POINTS};

/// A change of the inputs by more than this share of their scale is a jump: the step that follows it is divided.
const JUMP: f64 = 0.2;
/// Length of the first sub-step after a jump, in passages of the contact window; each further one doubles.
const FIRST_SUBSTEP: f64 = 0.25;
/// Largest number of sub-steps of equal length while the inputs change at given rates.
const RAMP_SUBSTEPS: f64 = 50.0;

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
    /// Time since the start, [s].
    pub time: f64,
    /// Inputs at the last committed instant.
    pub inputs: Inputs,
    /// Length of the last committed sub-step, [s]; 0 before the first.
    pub duration: f64,
    /// Temperature, wear, tractions.
    pub fields: Fields,
    /// Outputs at the last committed instant, totals included.
    pub outputs: Outputs,
    /// Rates of change of the outputs over the last committed sub-step, per second.
    pub output_rates: Outputs,
    /// How the last step converged.
    pub convergence: Convergence,
}

/// A step that did not reach its end: the state stands at the last committed sub-step.
#[derive(Debug, Clone, PartialEq)]
pub struct Interrupted {
    /// Time that was committed of the step, [s]; 0 when nothing was.
    pub committed: f64,
    /// Why the next sub-step failed.
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

    /// The cold, unworn rail under the given inputs: mechanics solved, no heat and no wear yet.
    ///
    /// # Errors
    /// Inputs out of range, or a solver that did not converge.
    pub fn initial_state(&self, workspace: &mut Workspace, inputs: &Inputs) -> Result<State> {
        inputs.check(&self.parameters)?;
        let mut fields = Fields::new(&self.rail);
        let contact = self.contact(inputs, f64::INFINITY);
        contact.solve_mechanics(&mut fields, &mut workspace.scratch)?;
        let mut state = State {
            time: 0.0,
            inputs: *inputs,
            duration: 0.0,
            fields,
            outputs: Outputs::default(),
            output_rates: Outputs::default(),
            convergence: Convergence::default(),
        };
        state.outputs = self.instant_outputs(&state.fields, inputs);
        Ok(state)
    }

    /// Whether a state (of another source) has the sizes of this model and finite content.
    pub fn accepts(&self, state: &State) -> bool {
        let expected = Fields::new(&self.rail);
        let fields = &state.fields;
        let pairs = [
            (&fields.temperature, &expected.temperature),
            (&fields.wear, &expected.wear),
            (&fields.pressure, &expected.pressure),
            (&fields.shear, &expected.shear),
            (&fields.slip, &expected.slip),
            (&fields.friction, &expected.friction),
            (&fields.heat_flux, &expected.heat_flux),
        ];
        pairs
            .iter()
            .all(|(own, expected)| own.len() == expected.len() && own.iter().all(|v| v.is_finite()))
            && OUTPUTS.iter().all(|signal| (signal.get)(&state.outputs).is_finite())
            && fields.penetration.is_finite()
            && state.time.is_finite()
            && state.duration >= 0.0
            && state.inputs.check(&self.parameters).is_ok()
    }

    /// Advances the state by `duration` [s]; the inputs start at `inputs` and change at `rates` per second.
    ///
    /// The step is implicit in time, of order 1. It is divided after a jump of the inputs, from a quarter of the
    /// passage of the contact window on with doubling sub-steps, and where the rates change the inputs by more
    /// than a fifth of their scale.
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
        let start = state.time;
        let mut committed = 0.0;
        let interrupted = |committed, error| Interrupted { committed, error };
        inputs
            .check(&self.parameters)
            .and_then(|()| inputs.advanced(rates, duration).check(&self.parameters))
            .map_err(|error| interrupted(0.0, error))?;

        let jump = self.change(&state.inputs, inputs);
        let ramp = self.change(inputs, &inputs.advanced(rates, duration));
        let mut substep = duration / (ramp / JUMP).ceil().clamp(1.0, RAMP_SUBSTEPS);
        let largest_substep = substep;
        if jump > JUMP {
            substep = substep.min(FIRST_SUBSTEP * self.passage_time(inputs));
        }
        let mut convergence = Convergence::default();
        while committed < duration {
            // The last sub-step takes the rest, so that no sliver is left over by rounding.
            let remaining = duration - committed;
            let length = if remaining < 1.5 * substep { remaining } else { substep };
            let end = if length == remaining {
                duration
            } else {
                committed + length
            };
            let at_end = inputs.advanced(rates, end);
            let solved = self
                .advance(workspace, state, &at_end, length)
                .map_err(|error| interrupted(committed, error))?;
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
        trial.copy_from(&state.fields);
        let contact = self.contact(inputs, duration);
        let convergence = contact.operator_split(&state.fields, trial, scratch)?;

        let mut outputs = self.instant_outputs(trial, inputs);
        outputs.worn_volume = state.outputs.worn_volume + outputs.wear_rate * duration;
        outputs.friction_energy = state.outputs.friction_energy + outputs.friction_power * duration;
        outputs.distance = state.outputs.distance + contact.conditions.motion.rolling_speed.abs() * duration;
        for signal in OUTPUTS {
            let rate = ((signal.get)(&outputs) - (signal.get)(&state.outputs)) / duration;
            (signal.set)(&mut state.output_rates, rate);
        }
        std::mem::swap(&mut state.fields, trial);
        state.inputs = *inputs;
        state.duration = duration;
        state.outputs = outputs;
        Ok(convergence)
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

    /// Time in which rail material crosses the contact window, [s]; infinite at rest.
    fn passage_time(&self, inputs: &Inputs) -> f64 {
        2.0 * self.rail.mesh.window_half_width() / inputs.motion(&self.parameters).rolling_speed.abs()
    }

    /// The outputs that follow from the fields and the inputs; the totals are 0.
    fn instant_outputs(&self, fields: &Fields, inputs: &Inputs) -> Outputs {
        let (rail, parameters) = (&self.rail, &self.parameters);
        let motion = inputs.motion(parameters);
        let (spacing, scale) = (rail.mesh.contact_spacing(), rail.scales.pressure);
        let force = parameters.contact_width * spacing * scale;
        let n = rail.mesh.contact_nodes;

        let (mut total, mut moment, mut shear, mut weighted) = (0.0, 0.0, 0.0, 0.0);
        let (mut friction_power, mut wear, mut heat) = (0.0, 0.0, 0.0);
        let (mut peak_pressure, mut peak_shear) = (0.0_f64, 0.0_f64);
        let (mut contact_nodes, mut sticking) = (0.0, 0.0);
        for node in 0..n {
            heat += fields.heat_flux[node];
            let (p, tau, slip) = (fields.pressure[node], fields.shear[node], fields.slip[node]);
            if p <= 0.0 {
                continue;
            }
            total += p;
            moment += p * rail.mesh.contact_position(node);
            shear += tau;
            weighted += p * fields.friction[node];
            friction_power += (tau * slip).abs();
            wear += p * slip.abs();
            peak_pressure = peak_pressure.max(p);
            peak_shear = peak_shear.max(tau.abs());
            contact_nodes += 1.0;
            if friction::saturation(slip, parameters.slip_regularisation).abs() < friction::STICK_SATURATION {
                sticking += 1.0;
            }
        }
        let peak_rise = (0..rail.mesh.columns())
            .map(|column| fields.surface_temperature(rail, column))
            .fold(0.0, f64::max);
        let ambient = inputs.ambient_temperature;
        let load = force * total;
        let traction_force = -force * shear;
        let per_total = |value: f64| if total > 0.0 { value / total } else { 0.0 };
        let offset = per_total(moment);
        let cold = friction::coefficient(parameters, ambient + peak_rise).0 * inputs.friction_scale;
        Outputs {
            traction_force,
            friction_torque: -(traction_force * parameters.wheel_radius + load * offset),
            peak_temperature: ambient + peak_rise,
            traction_coefficient: -per_total(shear),
            slip_creepage: creepage(motion.rolling_speed, motion.rigid_slip),
            penetration: fields.penetration * rail.scales.displacement,
            contact_length: self.contact_length(fields),
            contact_offset: offset,
            peak_pressure: peak_pressure * scale,
            peak_shear: peak_shear * scale,
            stick_fraction: if contact_nodes > 0.0 {
                sticking / contact_nodes
            } else {
                0.0
            },
            friction_coefficient: if total > 0.0 { weighted / total } else { cold },
            friction_power: force * friction_power,
            rail_heat_flow: parameters.contact_width * spacing * heat,
            wear_depth: self.wear_left_behind(fields, motion.rolling_speed),
            wear_rate: force * parameters.wear_coefficient * wear,
            worn_volume: 0.0,
            friction_energy: 0.0,
            distance: 0.0,
        }
    }

    /// Distance between the ends of the contact. At an end the pressure falls like the root of the distance, so its
    /// square is linear there and its zero is found between the nodes.
    fn contact_length(&self, fields: &Fields) -> f64 {
        let p = &fields.pressure;
        let beyond = |last: usize, inner: Option<usize>| {
            let (edge, inside) = (p[last], inner.map_or(0.0, |i| p[i]));
            if inside > edge {
                (edge * edge / (inside * inside - edge * edge)).min(1.0)
            } else {
                0.5
            }
        };
        let first = p.iter().position(|&p| p > 0.0);
        let last = p.iter().rposition(|&p| p > 0.0);
        match (first, last) {
            (Some(first), Some(last)) => {
                let nodes = (last - first) as f64;
                let inner = |i| if first < last { Some(i) } else { None };
                (nodes + beyond(first, inner(first + 1)) + beyond(last, inner(last.wrapping_sub(1))))
                    * self.rail.mesh.contact_spacing()
            }
            _ => 0.0,
        }
    }

    /// Wear depth at the end of the window where material leaves it; at rest the deepest, [m].
    fn wear_left_behind(&self, fields: &Fields, rolling_speed: f64) -> f64 {
        let mesh = &self.rail.mesh;
        let window = &fields.wear[mesh.first_contact..mesh.first_contact + mesh.contact_nodes];
        if rolling_speed > 0.0 {
            window[0]
        } else if rolling_speed < 0.0 {
            window[window.len() - 1]
        } else {
            window.iter().fold(0.0, |m, &w| w.max(m))
        }
    }

    /// Rates of change of the outputs at the communication point, per second: over the last sub-step.
    pub fn output_rates(&self, state: &State) -> Outputs {
        state.output_rates
    }

    /// d(output)/d(each input) at the communication point: one entry per row of [`OUTPUTS`], whose fields hold the
    /// derivatives with respect to the inputs.
    ///
    /// # Errors
    /// A linear system that could not be solved.
    pub fn output_sensitivities(&self, workspace: &mut Workspace, state: &State) -> Result<Vec<Inputs>> {
        let _ = (workspace, state);
        Ok(vec![Inputs::ZERO; OUTPUTS.len()])
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

/// (ω r₀ − V)/V. Near rest the divisor is held at 1 mm/s, so that it stays finite.
fn creepage(rolling_speed: f64, rigid_slip: f64) -> f64 {
    let floor = 1e-3_f64;
    if rolling_speed.abs() >= floor {
        rigid_slip / rolling_speed
    } else if rolling_speed < 0.0 {
        -rigid_slip / floor
    } else {
        rigid_slip / floor
    }
}
