//! What wear and heat hand to the mechanics, as one vector: on it Anderson's method works, and its change says whether a step rests.

use super::fields::PatchFields;
use super::operators::PatchOperators;
use crate::numerics::dense::{largest, largest_change};

/// Temperature that counts as much as a displacement of one unit, `K`: a change that matters to the friction law.
const TEMPERATURE_UNIT: f64 = 100.0;

/// What wear and heat hand to the mechanics: of n cells the surface temperature in units of 100 K, the lift by heat and the wear
/// that is not in the normal problem, both scaled; then the wheel's temperature.
#[derive(Debug, Clone)]
pub struct Coupling {
    /// All values.
    pub values: Vec<f64>,
    cells: usize,
}

impl Coupling {
    /// All zero.
    pub fn new(operators: &PatchOperators) -> Coupling {
        let cells = operators.grid.strips * operators.grid.cells;
        Coupling {
            values: vec![0.0; 3 * cells + 1],
            cells,
        }
    }

    /// Temperature rise of a cell, `K`.
    pub fn temperature(&self, cell: usize) -> f64 {
        TEMPERATURE_UNIT * self.values[cell]
    }

    /// Lift by heat.
    pub fn lift(&self) -> &[f64] {
        &self.values[self.cells..2 * self.cells]
    }

    /// Wear that is not in the normal problem.
    pub fn wear(&self) -> &[f64] {
        &self.values[2 * self.cells..3 * self.cells]
    }

    /// To change the wear that is not in the normal problem: whatever else acts on the gap alone may be handed over with it.
    pub fn wear_mut(&mut self) -> &mut [f64] {
        &mut self.values[2 * self.cells..3 * self.cells]
    }

    /// The wheel's temperature, `K`.
    pub fn wheel_temperature(&self) -> f64 {
        TEMPERATURE_UNIT * self.values[3 * self.cells]
    }

    /// From the fields, with the wear that is proportional to the pressure, `softness` times it, taken off.
    pub fn read(&mut self, operators: &PatchOperators, fields: &PatchFields, softness: &[f64]) {
        let cells = self.cells;
        self.values[3 * cells] = fields.wheel_temperature / TEMPERATURE_UNIT;
        for strip in 0..operators.grid.strips {
            for cell in 0..operators.grid.cells {
                let index = strip * operators.grid.cells + cell;
                let place = operators.grid.place(strip, cell);
                self.values[index] = fields.heat.surface[index] / TEMPERATURE_UNIT;
                self.values[cells + index] = operators.expansion.bulge * fields.heat.content[index];
                self.values[2 * cells + index] =
                    fields.wear.depth[index] / operators.scales.displacement - softness[place] * fields.pressure[place];
            }
        }
    }

    /// Change from one set of values to another, each kind relative to its largest value, but at least to `least_temperature` `K` or
    /// a displacement of one unit.
    pub fn change_to(&self, after: &Coupling, least_temperature: f64) -> f64 {
        let cells = self.cells;
        let temperature = &after.values[..cells];
        let size = largest(temperature).max(least_temperature / TEMPERATURE_UNIT);
        (largest_change(temperature, &self.values[..cells]) / size)
            .max(largest_change(&after.values[cells..], &self.values[cells..]))
    }
}
