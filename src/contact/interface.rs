//! The interface vector x: what the mechanics see of heat and wear. One application of mechanics, heat and wear, a sweep, maps it to
//! G(x), and a step is solved where x = G(x).

use crate::numerics::dense::{LANES, largest, largest_change};

/// Temperature that counts as much as a displacement of one unit, `K`: a change that matters to the friction law.
const TEMPERATURE_UNIT: f64 = 100.0;

/// Interface vector of n nodes:
///
/// ```text
/// | temperature, n | displacement, n or 2n | gap, n | wheel, 1 |
/// ```
///
/// Temperatures are rises of the surface, the wheel's is absolute; both in units of 100 K. The displacement is that by heat, of a
/// line along x₁ and then upward, with what its convective inertia adds; of a patch upward. The gap is opened by the wear that is not
/// in the wear compliance, and closed by the upward displacement that shear causes between unlike half-spaces. Displacement and gap
/// are scaled.
#[derive(Debug, Clone)]
pub struct Interface {
    values: Vec<f64>,
    nodes: usize,
}

/// Parts of an interface vector, to be written.
pub struct Parts<'a> {
    /// Temperature rise in units of 100 K.
    temperature: &'a mut [f64],
    /// Displacement, scaled.
    pub displacement: &'a mut [f64],
    /// Opening of the gap, scaled.
    pub gap: &'a mut [f64],
    /// Temperature of the wheel in units of 100 K.
    wheel: &'a mut f64,
}

impl Parts<'_> {
    /// Sets the temperature rise of the nodes and the temperature of the wheel, `K`.
    pub fn set_temperatures<'t>(&mut self, rises: impl IntoIterator<Item = &'t f64>, wheel: f64) {
        for (value, rise) in self.temperature.iter_mut().zip(rises) {
            *value = rise / TEMPERATURE_UNIT;
        }
        *self.wheel = wheel / TEMPERATURE_UNIT;
    }
}

impl Interface {
    /// Zero vector of so many nodes with so many components of the displacement.
    pub fn new(nodes: usize, components: usize) -> Interface {
        Interface {
            values: vec![0.0; (2 + components) * nodes + 1],
            nodes,
        }
    }

    /// Takes its values from those of one of several windows in a vector of all: this one has the nodes of a window and one component
    /// of the displacement.
    pub fn take_window(&mut self, whole: &Interface, window: usize) {
        let n = self.nodes;
        for part in 0..3 {
            let from = part * whole.nodes + window * n;
            self.values[part * n..][..n].copy_from_slice(&whole.values[from..][..n]);
        }
        self.values[3 * n] = whole.values[3 * whole.nodes];
    }

    /// Writes its values as those of one of several windows into a vector of all.
    pub fn put_window(&self, whole: &mut Interface, window: usize) {
        let n = self.nodes;
        for part in 0..3 {
            let to = part * whole.nodes + window * n;
            whole.values[to..][..n].copy_from_slice(&self.values[part * n..][..n]);
        }
        whole.values[3 * whole.nodes] = self.values[3 * n];
    }

    /// All values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, to be changed.
    pub fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    /// Whether all values are finite.
    pub fn is_finite(&self) -> bool {
        // Zeros of each lane, or not a number: the loop has no branch, which saves 1 % of a line's step.
        let mut zeros = [0.0; LANES];
        let (lanes, rest) = self.values.as_chunks::<LANES>();
        for values in lanes {
            for (zero, value) in zeros.iter_mut().zip(values) {
                *zero += 0.0 * value;
            }
        }
        zeros.iter().sum::<f64>() == 0.0 && rest.iter().all(|value| value.is_finite())
    }

    /// Parts, to be written.
    pub fn parts(&mut self) -> Parts<'_> {
        let nodes = self.nodes;
        let (temperature, rest) = self.values.split_at_mut(nodes);
        let (rest, wheel) = rest.split_at_mut(rest.len() - 1);
        let (displacement, gap) = rest.split_at_mut(rest.len() - nodes);
        Parts {
            temperature,
            displacement,
            gap,
            wheel: &mut wheel[0],
        }
    }

    /// Temperature rise of a node, `K`.
    pub fn temperature(&self, node: usize) -> f64 {
        TEMPERATURE_UNIT * self.values[node]
    }

    /// Temperature rises of all nodes, `K`.
    pub fn temperatures(&self) -> impl Iterator<Item = f64> {
        self.values[..self.nodes].iter().map(|value| TEMPERATURE_UNIT * value)
    }

    /// Displacement, scaled.
    pub fn displacement(&self) -> &[f64] {
        &self.values[self.nodes..self.values.len() - 1 - self.nodes]
    }

    /// Opening of the gap, scaled.
    pub fn gap(&self) -> &[f64] {
        let end = self.values.len() - 1;
        &self.values[end - self.nodes..end]
    }

    /// Temperature of the wheel, `K`.
    pub fn wheel_temperature(&self) -> f64 {
        TEMPERATURE_UNIT * self.values[self.values.len() - 1]
    }

    /// Change from one vector to another: of the temperature relative to its largest value, but at least to `least_temperature`
    /// `K`; of displacement and gap relative to the displacement scale; of the wheel's temperature in units of 100 K.
    pub fn change_to(&self, after: &Interface, least_temperature: f64) -> f64 {
        let (temperature, rest) = after.values.split_at(self.nodes);
        let size = largest(temperature).max(least_temperature / TEMPERATURE_UNIT);
        (largest_change(temperature, &self.values[..self.nodes]) / size)
            .max(largest_change(rest, &self.values[self.nodes..]))
    }
}
