//! The interface vector x: what the mechanics see of heat and wear. One application of mechanics, heat and wear, a sweep, maps it to
//! G(x), and a step is solved where x = G(x).

use crate::numerics::dense::{LANES, largest, largest_change};
use std::ops::Range;

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
///
/// Of several windows, the nodes of each follow those of the one before. Windows that are not used hold zeros, which are not looked at: of four
/// windows that saves 2 % of a step with one contact.
#[derive(Debug, Clone)]
pub struct Interface {
    values: Vec<f64>,
    nodes: usize,
    /// Number of windows.
    windows: usize,
    /// Windows that may hold something else than zeros, one bit for each.
    held: u32,
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
            windows: 1,
            held: 1,
        }
    }

    /// Zero vector of so many windows with so many nodes each, with one component of the displacement.
    pub fn of_windows(windows: usize, nodes: usize) -> Interface {
        Interface {
            windows,
            held: 0,
            ..Interface::new(windows * nodes, 1)
        }
    }

    /// Places of the nodes of some windows in each of the parts.
    fn stretches(&self, held: u32) -> impl Iterator<Item = Range<usize>> + use<> {
        let (nodes, parts) = (self.nodes, (self.values.len() - 1) / self.nodes.max(1));
        let own = nodes / self.windows;
        let windows = (0..self.windows).filter(move |window| (held >> window) & 1 == 1);
        windows.flat_map(move |window| {
            (0..parts).map(move |part| part * nodes + window * own..part * nodes + (window + 1) * own)
        })
    }

    /// Sets all windows to zeros, and the temperature of the wheel, `K`.
    pub fn clear_windows(&mut self, wheel: f64) {
        for stretch in self.stretches(self.held) {
            self.values[stretch].fill(0.0);
        }
        self.held = 0;
        *self.values.last_mut().expect("the wheel's") = wheel / TEMPERATURE_UNIT;
    }

    /// Takes the values of another one.
    pub fn copy_from(&mut self, other: &Interface) {
        for stretch in self.stretches(self.held | other.held) {
            self.values[stretch.clone()].copy_from_slice(&other.values[stretch]);
        }
        self.held = other.held;
        let wheel = self.values.len() - 1;
        self.values[wheel] = other.values[wheel];
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
        whole.held |= 1 << window;
        whole.values[3 * whole.nodes] = self.values[3 * n];
    }

    /// All values.
    pub fn values(&self) -> &[f64] {
        &self.values
    }

    /// All values, to be changed.
    pub fn values_mut(&mut self) -> &mut [f64] {
        self.held = (1 << self.windows) - 1;
        &mut self.values
    }

    /// Whether all values are finite.
    pub fn is_finite(&self) -> bool {
        // Zeros of each lane, or not a number: the loop has no branch, which saves 1 % of a line's step.
        let mut zeros = [0.0; LANES];
        let mut are_finite = self.values[self.values.len() - 1].is_finite();
        for stretch in self.stretches(self.held) {
            let (lanes, rest) = self.values[stretch].as_chunks::<LANES>();
            for values in lanes {
                for (zero, value) in zeros.iter_mut().zip(values) {
                    *zero += 0.0 * value;
                }
            }
            are_finite &= rest.iter().all(|value| value.is_finite());
        }
        are_finite && zeros.iter().sum::<f64>() == 0.0
    }

    /// Parts, to be written.
    pub fn parts(&mut self) -> Parts<'_> {
        let nodes = self.nodes;
        self.held = (1 << self.windows) - 1;
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
        let wheel = self.values.len() - 1;
        let (mut size, mut temperature) = (least_temperature / TEMPERATURE_UNIT, 0.0);
        let mut rest = (after.values[wheel] - self.values[wheel]).abs();
        for stretch in self.stretches(self.held | after.held) {
            let is_temperature = stretch.start < self.nodes;
            let (before, after) = (&self.values[stretch.clone()], &after.values[stretch]);
            let change = largest_change(after, before);
            if is_temperature {
                size = size.max(largest(after));
                temperature = f64::max(temperature, change);
            } else {
                rest = rest.max(change);
            }
        }
        rest.max(temperature / size)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Vectors of four windows of which others are used each time are compared and copied as those of all their values.
    #[test]
    fn windows_that_hold_nothing_are_zeros() {
        let window = |value: f64| {
            let mut own = Interface::new(3, 1);
            own.parts().displacement.copy_from_slice(&[value, -value, 0.5 * value]);
            own.parts().set_temperatures(&[100.0 * value; 3], 300.0);
            own
        };
        let of_windows = |used: &[usize]| {
            let mut all = Interface::of_windows(4, 3);
            for number in used {
                window(1.0 + *number as f64).put_window(&mut all, *number);
            }
            all
        };
        let (first, second) = (of_windows(&[0, 3]), of_windows(&[1]));
        // The temperature changes by 4 of 2, the largest after it; the displacement by 4.
        assert_eq!(first.change_to(&second, 1.0), 4.0);
        assert_eq!(second.change_to(&first, 1.0), 4.0);
        let mut copy = first.clone();
        copy.copy_from(&second);
        assert_eq!(copy.values(), second.values());
        copy.copy_from(&first);
        assert_eq!(copy.values(), first.values());
        copy.clear_windows(300.0);
        assert_eq!(copy.values()[..36], [0.0; 36]);
        assert_eq!(copy.wheel_temperature(), 300.0);
        window(f64::INFINITY).put_window(&mut copy, 2);
        assert!(!copy.is_finite() && first.is_finite());
    }
}
