//! One implicit step as a problem: what a contact has computed once, the parameters, the limits of the methods, the conditions of
//! the step.

use super::engine::Engine;
use crate::friction::FrictionState;
use crate::friction::path::{PathLaw, PathStep};
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::transient::Transient;
use crate::parameters::{Control, Parameters, WheelHeating};
use crate::settings::Settings;
use crate::signals::{Inputs, Motion};
use serde::{Deserialize, Serialize};

/// Conditions that one implicit step holds fixed.
#[derive(Debug, Clone, Copy)]
pub struct Conditions {
    /// Inputs at the end of the step.
    pub inputs: Inputs,
    /// Motion that they make.
    pub motion: Motion,
    /// Length of the step, `s`.
    pub duration: f64,
}

/// Task of a step, whatever the contact model: the parameters, the limits of the methods, the conditions.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// Parameters. Friction, interface and wheel are read here, the rest is in the operators.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// Conditions of the step.
    pub conditions: Conditions,
}

/// Convergence of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations on the interface vector, summed over the sub-steps of a step.
    pub iterations: usize,
    /// Last relative change of the interface vector.
    pub residual: f64,
    /// Whether the contact would reach beyond its window: it is held within it, and the groove that the wheel has worn is as wide
    /// as the window.
    pub fills_window: bool,
}

/// Problem of one implicit step of a contact model.
pub struct Problem<'a, E> {
    /// Operators of the contact, computed once.
    pub operators: &'a E,
    /// Parameters.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// Conditions of the step.
    pub conditions: Conditions,
}

impl<E> Clone for Problem<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Problem<'_, E> {}

impl<'a, E: Engine> Problem<'a, E> {
    /// Problem of a task for the given operators.
    pub fn new(operators: &'a E, task: &Task<'a>) -> Problem<'a, E> {
        Problem {
            operators,
            parameters: task.parameters,
            settings: task.settings,
            conditions: task.conditions,
        }
    }

    /// The same problem under other inputs.
    pub fn under(&self, inputs: Inputs) -> Problem<'a, E> {
        Problem {
            conditions: Conditions {
                inputs,
                motion: inputs.motion(self.parameters),
                ..self.conditions
            },
            ..*self
        }
    }

    /// Friction law at the ambient temperature and the friction scale of the step.
    pub fn friction(&self) -> FrictionState<'a> {
        FrictionState {
            parameters: self.parameters,
            ambient: self.conditions.inputs.ambient_temperature,
            scale: self.conditions.inputs.friction_scale,
        }
    }

    /// Law by which friction depends on slip and on what a particle has met before; none where it does not.
    pub fn path_law(&self) -> Option<PathLaw> {
        let operators = self.operators;
        PathLaw::new(
            self.parameters,
            &PathStep {
                duration: self.conditions.duration,
                spacing: operators.spacing(),
                speed: self.conditions.motion.rolling_speed,
                displacement: operators.own_displacement(self.parameters),
                pressure: operators.pressure_scale(),
            },
        )
    }

    /// Load or penetration, scaled. A load too small to be felt counts as none.
    pub fn constraint(&self) -> Constraint {
        match self.parameters.control {
            Control::Load => {
                let load = self.conditions.inputs.normal_load;
                let load = self.settings.mechanics.felt(load, self.parameters.largest_load);
                Constraint::Total(load / self.unit_force())
            }
            Control::Penetration => {
                Constraint::Penetration(self.parameters.prescribed_penetration / self.operators.displacement_scale())
            }
        }
    }

    /// Whether there is no load to carry.
    pub fn is_unloaded(&self) -> bool {
        self.constraint() == Constraint::Total(0.0)
    }

    /// Force of a scaled traction of 1 on a node, `N`.
    pub fn unit_force(&self) -> f64 {
        self.operators.unit_force(self.parameters)
    }

    /// Load that the pressure of the fields carries, `N`.
    pub fn load(&self, fields: &E::Fields) -> f64 {
        self.unit_force() * E::pressure(fields).iter().sum::<f64>()
    }

    /// Whether rail material moves towards −x; V = 0 counts so.
    pub fn is_forward(&self) -> bool {
        self.conditions.motion.rolling_speed >= 0.0
    }

    /// Temperature rise of the rail that comes in, `K`.
    pub fn incoming_rise(&self) -> f64 {
        let inputs = &self.conditions.inputs;
        inputs.incoming_temperature - inputs.ambient_temperature
    }

    /// Temperature rise θ_w of the wheel in (23) at the rim's temperature, `K`.
    pub fn wheel_rise(&self, wheel_temperature: f64) -> f64 {
        match self.parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_temperature - self.conditions.inputs.ambient_temperature,
        }
    }

    /// Wear depth per time at a slip of 1 m/s under a scaled pressure of 1.
    pub fn wear_per_slip(&self) -> f64 {
        self.parameters.wear_coefficient * self.operators.pressure_scale()
    }

    /// ∂u/∂t over the step, for a displacement that is forgotten over `relaxation_length` `m` of rolling.
    pub fn transient(&self, relaxation_length: f64) -> Transient {
        Transient::new(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.spacing(),
            relaxation_length,
            self.operators.displacement_scale(),
        )
    }

    /// Change of [`Problem::transient`] per |V|.
    pub fn transient_per_speed(&self, relaxation_length: f64) -> Transient {
        self.transient(relaxation_length).tangent(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.operators.spacing(),
            relaxation_length,
        )
    }
}
