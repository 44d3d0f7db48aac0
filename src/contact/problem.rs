//! One implicit step as a problem: what a contact has computed once, the parameters, the limits of the methods, the conditions of
//! the step.

use crate::friction::FrictionState;
use crate::parameters::{Parameters, WheelHeating};
use crate::settings::Settings;
use crate::signals::{Inputs, Motion};
use serde::{Deserialize, Serialize};

/// Conditions that one step holds fixed.
#[derive(Debug, Clone, Copy)]
pub struct StepConditions {
    /// Inputs at the end of the step.
    pub inputs: Inputs,
    /// Motion that they make.
    pub motion: Motion,
    /// Length of the step, `s`.
    pub duration: f64,
    /// Coupling of mechanics with heat and wear.
    pub coupling: Coupling,
    /// Room for the windows of a contact of profiles, over what the contacts are expected to need.
    pub room: f64,
}

/// Task of a step, whatever the contact model: the parameters, the limits of the methods, the conditions.
#[derive(Clone, Copy)]
pub struct Task<'a> {
    /// Parameters. Friction, interface and wheel are read here, the rest is in the operators.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// Conditions of the step.
    pub conditions: StepConditions,
}

/// Convergence of a step.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct Convergence {
    /// Iterations on the interface vector, summed over the sub-steps of a step.
    pub iterations: usize,
    /// Last relative change of the interface vector.
    pub residual: f64,
    /// Whether the contact would reach beyond its window: it is held within it. The wheel has worn a groove as wide as the window, or curvatures that are
    /// given make the contact broader than those of the parameters.
    pub fills_window: bool,
    /// Whether profiles have more contacts than windows, so that contacts far apart share one.
    pub crowded: bool,
    /// Whether the contact carries more than `largest_load`, for which its cells and windows are made: by a penetration or a height that is given.
    pub overloaded: bool,
    /// Whether a part of the step was taken staggered: the mechanics for temperature and wear before it, because neither method found
    /// the solution of the coupled equations within the budget of work. The residual is 1 or more where the pressure was held besides.
    pub staggered: bool,
    /// Largest depth that a sub-step has worn off a profile, `m`.
    pub profile_change: f64,
}

impl Convergence {
    /// Remark on a crowded step.
    pub const CROWDED: &str = "wheel and rail touch in more than four places: those next to each other share a window, and count as one contact";

    /// Adds that of the next sub-step.
    pub(crate) fn add(&mut self, next: &Convergence) {
        self.iterations += next.iterations;
        self.residual = next.residual;
        self.fills_window |= next.fills_window;
        self.crowded |= next.crowded;
        self.overloaded |= next.overloaded;
        self.staggered |= next.staggered;
        self.profile_change = self.profile_change.max(next.profile_change);
    }
}

/// Coupling of mechanics with heat and wear over a step.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Coupling {
    /// The mechanics see temperature and wear at the end of the step.
    Implicit,
    /// The mechanics see temperature and wear at its beginning. Where friction has no solution that is found, they take the one for the
    /// least regularisation that has one.
    Staggered,
    /// Staggered, with the pressure of the step before, in proportion to the load: for contacts of profiles whose pressure is not found, as between
    /// surfaces that are worn to grooves narrower than the cells.
    Held,
}

impl Coupling {
    /// Whether the mechanics see temperature and wear at the beginning of the step.
    pub fn is_staggered(self) -> bool {
        self != Coupling::Implicit
    }
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
    pub conditions: StepConditions,
    /// Shares of the strips that belong to the rail's gauge face, of a window on a rail's profile; none else.
    pub gauge_face: &'a [f64],
}

impl<E> Clone for Problem<'_, E> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<E> Copy for Problem<'_, E> {}

impl<'a, E> Problem<'a, E> {
    /// Work of the mechanics after which they are not solved any closer. A first state, in which no time passes, has no such limit.
    pub fn mechanics_budget(&self) -> u64 {
        match self.conditions.coupling {
            _ if !self.conditions.duration.is_finite() => u64::MAX,
            Coupling::Implicit => self.settings.step.work,
            Coupling::Staggered | Coupling::Held => self.settings.step.staggered_work,
        }
    }

    /// Problem of a task for the given operators.
    pub fn new(operators: &'a E, task: &Task<'a>) -> Problem<'a, E> {
        Problem {
            operators,
            parameters: task.parameters,
            settings: task.settings,
            conditions: task.conditions,
            gauge_face: &[],
        }
    }

    /// Problem of the same step under other inputs.
    pub fn under(&self, inputs: Inputs) -> Problem<'a, E> {
        Problem {
            conditions: StepConditions {
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

    /// Friction law on a strip: on the rail's gauge face with that face's own scale.
    pub fn friction_at(&self, strip: usize) -> FrictionState<'a> {
        let law = self.friction();
        FrictionState {
            scale: law.scale * self.gauge_face_factor(strip),
            ..law
        }
    }

    /// Factor on the friction coefficient of a strip, 1 but for the rail's gauge face.
    pub fn gauge_face_factor(&self, strip: usize) -> f64 {
        let share = self.gauge_face.get(strip).copied().unwrap_or(0.0);
        1.0 + share * (self.parameters.gauge_face_friction_scale - 1.0)
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
}
