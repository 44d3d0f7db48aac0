//! What the parts of the operator split hand to each other.
//!
//! The mechanics see of heat and wear: the thermal displacement, the surface temperature (for μ), and that part of the
//! wear that is not in the normal compliance. The heat sees of the wheel its temperature. These are the values on which the
//! split iterates; nothing else passes from one iteration to the next but the tractions as a first guess.

use super::fields::Fields;
use super::operators::LineOperators;
use crate::mechanics::softening::Softening;
use crate::numerics::dense::largest_change;

/// Temperature that counts as much as a displacement of one unit, `K`: a change that matters to the friction law.
const TEMPERATURE_UNIT: f64 = 100.0;

/// The values at n contact nodes, in one vector, because the acceleration takes them as one:
///
/// ```text
/// | along x₁, n | upward, n | temperature, n | wear, n | wheel, 1 |
/// |   thermal displacement  |
/// ```
///
/// Displacements and wear are scaled, temperatures are rises in units of 100 K; the wheel's is absolute.
#[derive(Debug, Clone)]
pub struct Coupling {
    values: Vec<f64>,
    nodes: usize,
}

impl Coupling {
    /// All zero, with n contact nodes.
    pub fn new(nodes: usize) -> Coupling {
        Coupling {
            values: vec![0.0; 4 * nodes + 1],
            nodes,
        }
    }

    /// All values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, for the acceleration.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Thermal displacement, along x₁ and then upward, 2n.
    pub fn displacement(&self) -> &[f64] {
        &self.values[..2 * self.nodes]
    }

    /// Thermal displacement along x₁, n.
    pub fn along(&self) -> &[f64] {
        &self.values[..self.nodes]
    }

    /// Thermal displacement upward, n.
    pub fn upward(&self) -> &[f64] {
        &self.values[self.nodes..2 * self.nodes]
    }

    fn scaled_temperature(&self) -> &[f64] {
        &self.values[2 * self.nodes..3 * self.nodes]
    }

    /// Surface temperature (rise) at the contact nodes, `K`, n.
    pub fn temperature(&self) -> impl Iterator<Item = f64> {
        self.scaled_temperature().iter().map(|value| value * TEMPERATURE_UNIT)
    }

    /// Wear that is not in the normal compliance, n.
    pub fn wear(&self) -> &[f64] {
        &self.values[3 * self.nodes..4 * self.nodes]
    }

    /// Wear and the wheel's temperature: what is compared as it is.
    fn wear_and_wheel(&self) -> &[f64] {
        &self.values[3 * self.nodes..]
    }

    /// Temperature of the wheel, `K`.
    pub fn wheel_temperature(&self) -> f64 {
        self.values[4 * self.nodes] * TEMPERATURE_UNIT
    }

    /// Takes the values from the fields, or the changes of the values from changes of the fields.
    pub fn read(&mut self, operators: &LineOperators, fields: &Fields, softening: &Softening) {
        let n = self.nodes;
        let window = operators.mesh.window();
        self.set_displacement(&fields.thermal_displacement);
        let (_, rest) = self.values.split_at_mut(2 * n);
        let (temperature, rest) = rest.split_at_mut(n);
        let (wear, wheel) = rest.split_at_mut(n);
        for (value, temperature) in temperature.iter_mut().zip(&fields.surface_temperature[window.clone()]) {
            *value = temperature / TEMPERATURE_UNIT;
        }
        for (value, depth) in wear.iter_mut().zip(&fields.wear[window]) {
            *value = depth / operators.scales.displacement;
        }
        softening.subtract_proportional(&fields.pressure, wear);
        wheel[0] = fields.wheel_temperature / TEMPERATURE_UNIT;
    }

    /// Takes a thermal displacement, 2n.
    pub fn set_displacement(&mut self, displacement: &[f64]) {
        self.values[..2 * self.nodes].copy_from_slice(displacement);
    }

    /// Change from one set of values to another: of the temperature relative to the largest one, but at least
    /// `least_temperature` `K`; of displacement and wear relative to the displacement scale; of the wheel's temperature in
    /// units of 100 K.
    pub fn change_to(&self, after: &Coupling, least_temperature: f64) -> f64 {
        let largest = after
            .scaled_temperature()
            .iter()
            .fold(least_temperature / TEMPERATURE_UNIT, |m, t| t.abs().max(m));
        (largest_change(after.scaled_temperature(), self.scaled_temperature()) / largest)
            .max(largest_change(after.displacement(), self.displacement()))
            .max(largest_change(after.wear_and_wheel(), self.wear_and_wheel()))
    }
}
