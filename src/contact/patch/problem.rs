//! One implicit step of the patch as a problem: its data, and the parts of its equations.

use super::fields::PatchFields;
use super::rail::PatchRail;
use crate::contact::rim::HeatedNode;
use crate::contact::task::Conditions;
use crate::friction::FrictionState;
use crate::friction::coulomb::{self, Sliding};
use crate::heat::strips::StripHeatMarch;
use crate::heat::surface::{SurfaceCondition, SurfaceExchange};
use crate::mechanics::normal::problem::Constraint;
use crate::mechanics::transient::Transient;
use crate::parameters::{Control, Parameters, WheelHeating};
use crate::settings::Settings;
use crate::signals::Inputs;
use crate::wear::strips::StripWearMarch;

/// One implicit step.
#[derive(Clone, Copy)]
pub struct Problem<'a> {
    /// What is computed once.
    pub rail: &'a PatchRail,
    /// The parameters.
    pub parameters: &'a Parameters,
    /// Limits and tolerances.
    pub settings: &'a Settings,
    /// What the step holds fixed.
    pub conditions: Conditions,
}

/// How the slip ahead of a cell follows from displacements, `m/s` per scaled displacement: of u less that of the cell ahead, of u
/// less that of the step before, and of the latter less that of the cell ahead then.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SlipWeights {
    /// Of u less that ahead.
    pub strain: f64,
    /// Of u less that before.
    pub change: f64,
    /// Of that before less that ahead of it.
    pub strain_before: f64,
    /// |V| times the displacement scale over the length of a cell.
    pub strain_speed: f64,
}

impl<'a> Problem<'a> {
    /// The same problem under other inputs.
    pub fn under(&self, inputs: Inputs) -> Problem<'a> {
        Problem {
            conditions: Conditions {
                inputs,
                motion: inputs.motion(self.parameters),
                ..self.conditions
            },
            ..*self
        }
    }

    /// The friction law at this ambient temperature and scale.
    pub fn friction(&self) -> FrictionState<'a> {
        FrictionState {
            parameters: self.parameters,
            ambient: self.conditions.inputs.ambient_temperature,
            scale: self.conditions.inputs.friction_scale,
        }
    }

    /// Load or penetration, scaled.
    pub fn constraint(&self) -> Constraint {
        match self.parameters.control {
            Control::Load => Constraint::Total(self.conditions.inputs.normal_load / self.rail.unit_force()),
            Control::Penetration => {
                Constraint::Penetration(self.parameters.prescribed_penetration / self.rail.scales.displacement)
            }
        }
    }

    /// Whether rail material moves towards −x; V = 0 counts so.
    pub fn is_forward(&self) -> bool {
        self.conditions.motion.rolling_speed >= 0.0
    }

    /// Temperature rise θ_w of the wheel in (23) at the rim's temperature, `K`.
    pub fn wheel_rise(&self, wheel_temperature: f64) -> f64 {
        match self.parameters.wheel_heating {
            WheelHeating::Off => 0.0,
            WheelHeating::On => wheel_temperature - self.conditions.inputs.ambient_temperature,
        }
    }

    /// ∂u/∂t over the step, with the relaxation length of the fields.
    pub fn transient(&self, fields: &PatchFields) -> Transient {
        Transient::new(
            self.conditions.duration,
            self.conditions.motion.rolling_speed.abs(),
            self.rail.grid.length,
            fields.relaxation_length,
            self.rail.scales.displacement,
        )
    }

    /// How the slip follows from displacements.
    pub fn slip_weights(&self, transient: Transient) -> SlipWeights {
        let speed = self.conditions.motion.rolling_speed.abs();
        let strain_speed = speed * self.rail.scales.displacement / self.rail.grid.length;
        let centred = transient.centring * transient.rate;
        SlipWeights {
            strain: strain_speed - centred,
            change: transient.rate,
            strain_before: centred,
            strain_speed,
        }
    }

    /// Relaxation length of a contact under the load that it had in the given fields, `m`: in the ratio of the contact's length.
    pub fn relaxation_length(&self, fields: &PatchFields) -> f64 {
        let load = self.rail.unit_force() * fields.pressure.iter().sum::<f64>();
        let ratio = (load / self.parameters.largest_load).cbrt().min(1.0);
        self.rail.relaxation_length * if load > 0.0 { ratio } else { 1.0 }
    }

    /// Rigid slip of the rail relative to the wheel at a point, `m/s`: w_x = V(ξ + φ y), w_y = −V(η + φ x).
    pub fn rigid_slip(&self, x: f64, y: f64) -> [f64; 2] {
        let motion = &self.conditions.motion;
        [
            motion.rigid_slip + motion.spin_rate * y,
            -(motion.lateral_speed + motion.spin_rate * x),
        ]
    }

    /// The cells as the rim sees them, or with changes of fields their changes.
    pub fn heated_nodes<'f>(&'f self, fields: &'f PatchFields) -> impl Iterator<Item = HeatedNode> + 'f {
        let grid = &self.rail.grid;
        (0..grid.strips).flat_map(move |strip| {
            (0..grid.cells).map(move |cell| {
                let place = grid.place(strip, cell);
                HeatedNode {
                    pressure: fields.pressure[place],
                    shear: [fields.shear[0][place], fields.shear[1][place]],
                    slip: [fields.slip[0][place], fields.slip[1][place]],
                    rise: fields.heat.surface[strip * grid.cells + cell],
                }
            })
        })
    }

    /// The heat march of the step.
    pub fn heat_march(&self) -> StripHeatMarch<'a> {
        StripHeatMarch {
            basis: &self.rail.basis,
            incoming: &self.rail.incoming,
            strips: &self.rail.strips,
            speed: self.conditions.motion.rolling_speed,
            duration: self.conditions.duration,
            surface: SurfaceCondition {
                friction: self.friction(),
                settings: self.settings.heat,
            },
        }
    }

    /// The wear march of the step.
    pub fn wear_march(&self) -> StripWearMarch<'a> {
        StripWearMarch {
            strips: &self.rail.strips,
            speed: self.conditions.motion.rolling_speed,
            duration: self.conditions.duration,
        }
    }

    /// Sliding of a cell, by its place on the grid.
    pub fn sliding(&self, fields: &PatchFields, place: usize) -> Sliding {
        let slip = [fields.slip[0][place], fields.slip[1][place]];
        let bound = fields.friction[place] * fields.pressure[place];
        let saturation = |component: usize| {
            if bound > 0.0 {
                fields.shear[component][place] / bound
            } else {
                0.0
            }
        };
        Sliding {
            speed: coulomb::magnitude(slip),
            power: coulomb::vector_power([saturation(0), saturation(1)], slip),
        }
    }

    /// What heats and cools the surface of the cells, strip by strip, with the wheel at θ_w.
    pub fn exchange(&self, fields: &PatchFields, wheel_rise: f64, exchange: &mut [SurfaceExchange]) {
        let grid = &self.rail.grid;
        for (strip, exchange) in exchange.chunks_exact_mut(grid.cells).enumerate() {
            for (place, exchange) in grid.row(strip).zip(exchange) {
                let pressure = fields.pressure[place] * self.rail.scales.pressure;
                *exchange = if pressure > 0.0 {
                    SurfaceExchange::new(self.parameters, pressure, self.sliding(fields, place), wheel_rise)
                } else {
                    SurfaceExchange::default()
                };
            }
        }
    }

    /// Breadth over which the rail that leaves is averaged, `m`: that of the strips in contact.
    pub fn breadth(&self, fields: &PatchFields) -> f64 {
        super::readings::extent(self.rail, &fields.pressure).breadth
    }
}
