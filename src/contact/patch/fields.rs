//! The fields of a patch, all that a step changes, and their trend from step to step.

use super::operators::PatchOperators;
use crate::friction::memory::Memory;
use crate::heat::strips::StripTemperature;
use crate::wear::strips::StripWear;
use serde::{Deserialize, Serialize};

/// The fields at one instant. Those of the cells stand on the grid ([`crate::body::grid`]).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatchFields {
    /// Temperature of the rail.
    pub heat: StripTemperature,
    /// Wear depth of the rail.
    pub wear: StripWear,
    /// Pressure, scaled.
    pub pressure: Vec<f64>,
    /// Shear traction on the rail along x and y, scaled.
    pub shear: [Vec<f64>; 2],
    /// Slip velocity, `m/s`, 0 outside the contact.
    pub slip: [Vec<f64>; 2],
    /// Friction coefficient, 0 outside the contact.
    pub friction: Vec<f64>,
    /// Displacement of the rail's surface less that of the wheel's along x and y, scaled.
    pub displacement: [Vec<f64>; 2],
    /// Its change over the last step.
    pub displacement_change: [Vec<f64>; 2],
    /// What friction remembers, of the cells, strip by strip.
    pub memory: Memory,
    /// The way of rolling on which the last step took the displacement to be forgotten, `m`.
    pub relaxation_length: f64,
    /// Penetration δ, scaled; 0 when lifted.
    pub penetration: f64,
    /// Temperature of the wheel's rim, absolute, `K`.
    pub wheel_temperature: f64,
}

impl PatchFields {
    /// A cold, unworn rail without contact; the wheel's temperature is 0 K.
    pub fn new(operators: &PatchOperators) -> PatchFields {
        let on_grid = || vec![0.0; operators.grid.len()];
        let vectors = || [on_grid(), on_grid()];
        PatchFields {
            heat: StripTemperature::new(&operators.strips, operators.basis.len()),
            wear: StripWear::new(&operators.strips),
            pressure: on_grid(),
            shear: vectors(),
            slip: vectors(),
            friction: on_grid(),
            displacement: vectors(),
            displacement_change: vectors(),
            memory: Memory::new(operators.grid.strips * operators.grid.cells),
            relaxation_length: operators.relaxation_length,
            penetration: 0.0,
            wheel_temperature: 0.0,
        }
    }

    /// The vectors of the cells.
    pub fn on_grid(&self) -> [&Vec<f64>; 10] {
        let PatchFields {
            pressure,
            shear: [shear_x, shear_y],
            slip: [slip_x, slip_y],
            friction,
            displacement: [x, y],
            displacement_change: [change_x, change_y],
            ..
        } = self;
        [
            pressure, shear_x, shear_y, slip_x, slip_y, friction, x, y, change_x, change_y,
        ]
    }

    /// The same to change.
    pub fn on_grid_mut(&mut self) -> [&mut Vec<f64>; 10] {
        let PatchFields {
            pressure,
            shear: [shear_x, shear_y],
            slip: [slip_x, slip_y],
            friction,
            displacement: [x, y],
            displacement_change: [change_x, change_y],
            ..
        } = self;
        [
            pressure, shear_x, shear_y, slip_x, slip_y, friction, x, y, change_x, change_y,
        ]
    }

    /// The first of [`PatchFields::read_by_outputs`], of which the outputs are not linear functions.
    pub const OUTPUTS_ARE_NOT_LINEAR: usize = 6;

    /// The vectors that the outputs are made of.
    pub fn read_by_outputs(&self) -> [&Vec<f64>; 13] {
        let ([shear_x, shear_y], [slip_x, slip_y]) = (&self.shear, &self.slip);
        let ([left, right], [worn_left, worn_right]) = (&self.heat.outer, &self.wear.outer);
        let (surface, flux, depth) = (&self.heat.surface, &self.heat.flux, &self.wear.depth);
        [
            &self.pressure,
            shear_x,
            shear_y,
            slip_x,
            slip_y,
            &self.friction,
            surface,
            flux,
            left,
            right,
            depth,
            worn_left,
            worn_right,
        ]
    }

    /// The same to change.
    pub fn read_by_outputs_mut(&mut self) -> [&mut Vec<f64>; 13] {
        let ([shear_x, shear_y], [slip_x, slip_y]) = (&mut self.shear, &mut self.slip);
        let ([left, right], [worn_left, worn_right]) = (&mut self.heat.outer, &mut self.wear.outer);
        let (surface, flux, depth) = (&mut self.heat.surface, &mut self.heat.flux, &mut self.wear.depth);
        [
            &mut self.pressure,
            shear_x,
            shear_y,
            slip_x,
            slip_y,
            &mut self.friction,
            surface,
            flux,
            left,
            right,
            depth,
            worn_left,
            worn_right,
        ]
    }

    /// All vectors.
    pub fn vectors(&self) -> impl Iterator<Item = &Vec<f64>> {
        let operators = self.heat.vectors().into_iter().chain(self.wear.vectors());
        operators.chain(self.on_grid()).chain(self.memory.vectors())
    }

    /// The numbers.
    pub fn numbers(&self) -> [f64; 5] {
        [
            self.heat.breadth,
            self.wear.breadth,
            self.relaxation_length,
            self.penetration,
            self.wheel_temperature,
        ]
    }

    /// Overwrites these fields with others of the same sizes, but for the rail's temperature and wear, most of all values.
    pub fn copy_contact_from(&mut self, other: &PatchFields) {
        for (own, other) in self.on_grid_mut().into_iter().zip(other.on_grid()) {
            own.copy_from_slice(other);
        }
        self.memory.copy_from(&other.memory);
        self.relaxation_length = other.relaxation_length;
        self.penetration = other.penetration;
        self.wheel_temperature = other.wheel_temperature;
    }
}

/// Rates of change of what a step starts its iteration from, per second: the first guess is extrapolated.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct PatchTrend {
    /// Of the shear, on the grid.
    pub shear: [Vec<f64>; 2],
    /// Of the pressure, on the grid.
    pub pressure: Vec<f64>,
    /// Of the surface temperature of the cells, strip by strip.
    pub surface: Vec<f64>,
    /// Of their heat content.
    pub content: Vec<f64>,
    /// Of their wear depth.
    pub depth: Vec<f64>,
}

impl PatchTrend {
    /// No change.
    pub fn new(operators: &PatchOperators) -> PatchTrend {
        let on_grid = || vec![0.0; operators.grid.len()];
        let cells = || vec![0.0; operators.grid.strips * operators.grid.cells];
        PatchTrend {
            shear: [on_grid(), on_grid()],
            pressure: on_grid(),
            surface: cells(),
            content: cells(),
            depth: cells(),
        }
    }

    /// The vectors, in the order of their declaration.
    pub fn vectors(&self) -> [&Vec<f64>; 6] {
        let [x, y] = &self.shear;
        [x, y, &self.pressure, &self.surface, &self.content, &self.depth]
    }

    /// The trend between two fields `duration` `s` apart.
    pub fn update(&mut self, before: &PatchFields, after: &PatchFields, duration: f64) {
        let update = |trend: &mut [f64], before: &[f64], after: &[f64]| {
            for ((trend, before), after) in trend.iter_mut().zip(before).zip(after) {
                *trend = (after - before) / duration;
            }
        };
        for component in 0..2 {
            update(
                &mut self.shear[component],
                &before.shear[component],
                &after.shear[component],
            );
        }
        update(&mut self.pressure, &before.pressure, &after.pressure);
        update(&mut self.surface, &before.heat.surface, &after.heat.surface);
        update(&mut self.content, &before.heat.content, &after.heat.content);
        update(&mut self.depth, &before.wear.depth, &after.wear.depth);
    }
}
