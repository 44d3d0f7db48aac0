//! Set-ups that several tests of the model share: contacts, motions, laws of friction, a settled state, differences.

use wheelrail::Error;
use wheelrail::parameters::{ContactModel, Parameters, SlipSource, Wheel, WheelHeating};
use wheelrail::signals::{Inputs, OutputSignal};
use wheelrail::wheel_rail::{Model, State, Workspace};

/// A small patch that heats, wears and swells, under a thin rim in good contact with it.
pub fn patch(slip_source: SlipSource, wheel: Wheel) -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        slip_source,
        wheel,
        patch_nodes: 16,
        patch_strips: 9,
        depth_nodes: 17,
        wheel_heating: WheelHeating::On,
        wheel_wear_coefficient: 1e-12,
        rim_depth: 1e-3,
        rim_width: 5e-3,
        contact_thermal_resistance: 200.0,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

/// A line under a warm wheel that is rigid or softer than the rail, so that pressure and shear are coupled, on a short piece of rail.
pub fn line(slip_source: SlipSource, wheel: Wheel) -> Parameters {
    Parameters {
        slip_source,
        wheel,
        wheel_shear_modulus: 6e10,
        wheel_heating: WheelHeating::On,
        rim_depth: 1e-3,
        rim_width: 5e-3,
        contact_thermal_resistance: 200.0,
        strip_half_length: 0.3,
        ..Parameters::default()
    }
}

/// Rolling at V with longitudinal creepage alone, as a line takes it.
pub fn rolling_straight(speed: f64, creepage: f64) -> Inputs {
    Inputs {
        lateral_creepage: 0.0,
        spin_creepage: 0.0,
        lateral_speed: 0.0,
        spin_rate: 0.0,
        ..rolling(speed, [creepage, 0.0, 0.0])
    }
}

/// Rolling at V with all three creepages, by the creepages and by the speeds.
pub fn rolling(speed: f64, [creepage, lateral, spin]: [f64; 3]) -> Inputs {
    Inputs {
        wheel_speed: speed * (1.0 + creepage) / Parameters::default().wheel_radius,
        vehicle_speed: speed,
        creepage,
        lateral_creepage: lateral,
        spin_creepage: spin,
        lateral_speed: lateral * speed,
        spin_rate: spin * speed,
        incoming_temperature: 310.0,
        incoming_wear_depth: 2e-7,
        ..Inputs::default()
    }
}

/// Friction that falls with slip.
#[derive(Debug, Clone, Copy)]
pub struct Falling {
    /// Share of the coefficient that is left at a large slip.
    pub share: f64,
    /// Decay with the slip velocity, `s/m`.
    pub decay: f64,
    /// Distance that it remembers, `m`.
    pub distance: f64,
}

impl Falling {
    /// Parameters with this friction.
    pub fn on(self, parameters: Parameters) -> Parameters {
        Parameters {
            friction_slip_share: self.share,
            friction_slip_decay: self.decay,
            friction_memory_distance: self.distance,
            ..parameters
        }
    }
}

/// Layer between wheel and rail that yields.
#[derive(Debug, Clone, Copy)]
pub struct Layer {
    /// Strength, `Pa`.
    pub strength: f64,
    /// Hardening, `Pa/m`.
    pub hardening: f64,
    /// Compliance, `m/Pa`.
    pub compliance: f64,
    /// Whether friction falls and remembers besides.
    pub falls: bool,
}

impl Layer {
    /// Parameters with this layer.
    pub fn on(self, parameters: Parameters) -> Parameters {
        let parameters = if self.falls {
            let falling = Falling {
                share: 0.5,
                decay: 0.5,
                distance: 2e-6,
            };
            falling.on(parameters)
        } else {
            parameters
        };
        Parameters {
            layer_yield_stress: self.strength,
            layer_hardening: self.hardening,
            layer_compliance: self.compliance,
            ..parameters
        }
    }
}

/// State after twenty steps under the same inputs.
///
/// # Errors
/// That of the first step that fails.
pub fn settle(model: &Model, workspace: &mut Workspace, inputs: &Inputs, step: f64) -> Result<State, Error> {
    let mut state = model.initial_state(workspace, inputs)?;
    for _ in 0..20 {
        state = step_from(model, workspace, &state, inputs, step)?;
    }
    Ok(state)
}

/// State after a step from another one, which stays as it is, under inputs that are held.
///
/// # Errors
/// That of the step.
pub fn step_from(
    model: &Model,
    workspace: &mut Workspace,
    before: &State,
    inputs: &Inputs,
    duration: f64,
) -> Result<State, Error> {
    let mut state = before.clone();
    let stepped = model.step(workspace, &mut state, inputs, &Inputs::ZERO, duration);
    stepped.map(|()| state).map_err(|interrupted| interrupted.error)
}

/// Central difference of an output between two states, `width` apart.
pub fn slope(output: &OutputSignal, [ahead, behind]: [&State; 2], width: f64) -> f64 {
    ((output.get)(&ahead.outputs) - (output.get)(&behind.outputs)) / width
}
