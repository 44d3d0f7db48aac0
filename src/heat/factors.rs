//! The factors with which the modes of a column pass from one column to the next.
//!
//! They depend on the length of the cell between the columns, on |V| and on Δt. A step marches several times with the same
//! speed and Δt, all cells of the window are of one length, and those outside it are mirror images: so they are kept by length,
//! and computed for the cells that something warm crosses.

use super::basis::DepthBasis;
use crate::numerics::dense::{Arithmetic, LANES};
use crate::transport::{CellStep, Cells, Column};

/// Factors of all modes in the cells between columns; m modes. What they are depends on nothing that was asked before.
#[derive(Debug, Clone)]
pub struct CellFactors {
    cells: Cells,
    /// The conditions of what is known.
    conditions: Conditions,
    /// Whether the factors of a length are known.
    known: Vec<bool>,
    /// r and 1/r of the modes, m each.
    rates: Vec<f64>,
    durations: Vec<f64>,
    /// E, g ω and g (1 − ω) of the modes, one after the other for each length.
    steps: Vec<f64>,
    /// The length that `passed_on`, `taken` and `response` are of.
    heated: Option<usize>,
    /// What the modes take of a flux upstream and of their column's own, m each, `K m^½ / (W/m²)`.
    passed_on: Vec<f64>,
    taken: Vec<f64>,
    response: f64,
}

/// What the factors depend on beside the length of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// |V|, `m/s`.
    pub speed: f64,
    /// Δt, `s`.
    pub duration: f64,
    /// κ, `m²/s`.
    pub diffusivity: f64,
    /// ρ c_p, `J/(m³ K)`.
    pub capacity: f64,
}

/// What the modes of a column take from the column upstream and from the step before, m each.
#[derive(Debug, Clone, Copy)]
pub struct Factors<'a> {
    /// E.
    pub keep: &'a [f64],
    /// g ω, `s`.
    pub upstream: &'a [f64],
    /// g (1 − ω), `s`.
    pub own: &'a [f64],
}

/// What a column takes of the heat flux, m each.
#[derive(Debug, Clone, Copy)]
pub struct HeatFactors<'a> {
    /// r of the modes, `1/s`.
    pub rates: &'a [f64],
    /// Of the flux upstream.
    pub passed_on: &'a [f64],
    /// Of its own.
    pub taken: &'a [f64],
    /// Surface temperature per own flux, `K/(W/m²)`.
    pub response: f64,
}

/// What feeds the modes of a column but for its own heat flux, m each.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// 1/Δt, `1/s`.
    pub storage: f64,
    /// Amplitudes of the step before in the column upstream.
    pub old_upstream: &'a [f64],
    /// Those in the column itself.
    pub old: &'a [f64],
    /// Heat flux into the column upstream, with what is taken of it.
    pub flux: Option<(f64, &'a [f64])>,
}

impl Factors<'_> {
    /// own = E · upstream + g ω · (sources upstream) + g (1 − ω) · old/Δt, and the surface value of it: as [`Arithmetic::dot`], in
    /// the same pass.
    #[inline(always)]
    pub fn carry_over(
        &self,
        arithmetic: Arithmetic,
        own: &mut [f64],
        upstream: &[f64],
        sources: &Sources,
        surface: &[f64],
    ) -> f64 {
        let fma = |a, b, c| arithmetic.multiply_add(a, b, c);
        let (heat, passed_on) = sources.flux.unwrap_or((0.0, &[]));
        let is_heated = sources.flux.is_some();
        let mut sums = [0.0; LANES];
        let (blocks, rest) = own.as_chunks_mut::<LANES>();
        let whole = LANES * blocks.len();
        let old = chunks(self.own).zip(chunks(sources.old));
        let old_upstream = chunks(self.upstream).zip(chunks(sources.old_upstream));
        let carried = chunks(self.keep).zip(chunks(upstream));
        // Without a flux upstream these are not read.
        let passed = chunks(if is_heated { passed_on } else { surface });
        let inputs = old.zip(old_upstream).zip(carried).zip(passed).zip(chunks(surface));
        for (block, ((((old, old_upstream), carried), passed), surface)) in blocks.iter_mut().zip(inputs) {
            let ((from_own, old), (from_upstream, old_upstream)) = (old, old_upstream);
            let (keep, upstream) = carried;
            // All values are loaded before one is stored: otherwise the compiler must assume that the slices overlap, and does
            // not vectorise.
            let mut values = [0.0; LANES];
            for lane in 0..LANES {
                let stored = fma(from_own[lane], old[lane], from_upstream[lane] * old_upstream[lane]);
                values[lane] = fma(sources.storage, stored, keep[lane] * upstream[lane]);
                if is_heated {
                    values[lane] = fma(heat, passed[lane], values[lane]);
                }
            }
            *block = values;
            for lane in 0..LANES {
                sums[lane] = fma(values[lane], surface[lane], sums[lane]);
            }
        }
        let mut tail = 0.0;
        for (own, mode) in rest.iter_mut().zip(whole..) {
            let stored = self.own[mode] * sources.old[mode] + self.upstream[mode] * sources.old_upstream[mode];
            *own = sources.storage * stored + self.keep[mode] * upstream[mode];
            if is_heated {
                *own += heat * passed_on[mode];
            }
            tail += *own * surface[mode];
        }
        tail + sums.iter().sum::<f64>()
    }
}

fn chunks(values: &[f64]) -> impl Iterator<Item = &[f64; LANES]> {
    values.as_chunks::<LANES>().0.iter()
}

impl CellFactors {
    /// For columns at `x` `m`.
    pub fn new(basis: &DepthBasis, x: &[f64]) -> CellFactors {
        let m = basis.len();
        let cells = Cells::new(x);
        let lengths = cells.lengths.len();
        CellFactors {
            conditions: Conditions {
                speed: f64::NAN,
                duration: f64::NAN,
                diffusivity: f64::NAN,
                capacity: f64::NAN,
            },
            known: vec![false; lengths],
            rates: vec![0.0; m],
            durations: vec![0.0; m],
            steps: vec![0.0; 3 * m * lengths],
            cells,
            heated: None,
            passed_on: vec![0.0; m],
            taken: vec![0.0; m],
            response: 0.0,
        }
    }

    /// Forgets what was computed under other conditions.
    #[inline(always)]
    pub fn adapt(&mut self, basis: &DepthBasis, conditions: Conditions) {
        if self.conditions == conditions {
            return;
        }
        self.conditions = conditions;
        self.known.fill(false);
        self.heated = None;
        let modes = self.rates.iter_mut().zip(&mut self.durations).zip(&basis.eigenvalues);
        for ((rate, duration), eigenvalue) in modes {
            *rate = 1.0 / conditions.duration + conditions.diffusivity * eigenvalue;
            *duration = 1.0 / *rate;
        }
    }

    /// The place of the length of the cell upstream of a column.
    pub fn length_of(&self, column: &Column) -> usize {
        self.cells.length_of(column)
    }

    /// Factors at a length.
    #[inline(always)]
    pub fn at(&mut self, arithmetic: Arithmetic, length: usize) -> Factors<'_> {
        if !self.known[length] {
            self.known[length] = true;
            self.compute(arithmetic, length);
        }
        self.known_at(length)
    }

    #[inline(always)]
    fn known_at(&self, length: usize) -> Factors<'_> {
        let m = self.rates.len();
        let steps = &self.steps[3 * m * length..][..3 * m];
        Factors {
            keep: &steps[..m],
            upstream: &steps[m..2 * m],
            own: &steps[2 * m..],
        }
    }

    /// Factors at a length, and those of the flux.
    #[inline(always)]
    pub fn heated_at(
        &mut self,
        arithmetic: Arithmetic,
        basis: &DepthBasis,
        length: usize,
    ) -> (Factors<'_>, HeatFactors<'_>) {
        self.at(arithmetic, length);
        if self.heated != Some(length) {
            self.heated = Some(length);
            let m = self.rates.len();
            let steps = &self.steps[3 * m * length..][..3 * m];
            for mode in 0..m {
                let heating = basis.surface[mode] / self.conditions.capacity;
                self.passed_on[mode] = heating * steps[m + mode];
                self.taken[mode] = heating * steps[2 * m + mode];
            }
            self.response = arithmetic.dot(&basis.surface, &self.taken);
        }
        let heat = HeatFactors {
            rates: &self.rates,
            passed_on: &self.passed_on,
            taken: &self.taken,
            response: self.response,
        };
        (self.known_at(length), heat)
    }

    /// [`CellStep`] of every mode.
    #[inline(always)]
    fn compute(&mut self, arithmetic: Arithmetic, length: usize) {
        let m = self.rates.len();
        let (length_of_cell, speed) = (self.cells.lengths[length], self.conditions.speed);
        let passage = (length_of_cell / speed, speed / length_of_cell);
        let steps = &mut self.steps[3 * m * length..][..3 * m];
        let (keep, rest) = steps.split_at_mut(m);
        let (upstream, own) = rest.split_at_mut(m);
        let (rates, rest_of_rates) = self.rates.as_chunks::<LANES>();
        let (durations, rest_of_durations) = self.durations.as_chunks::<LANES>();
        let (keep, rest_of_keep) = keep.as_chunks_mut::<LANES>();
        let (upstream, rest_of_upstream) = upstream.as_chunks_mut::<LANES>();
        let (own, rest_of_own) = own.as_chunks_mut::<LANES>();
        let out = keep.iter_mut().zip(upstream).zip(own);
        for ((rates, durations), ((keep, upstream), own)) in rates.iter().zip(durations).zip(out) {
            // All values are loaded before one is stored: as in the march itself.
            let (rates, durations) = (*rates, *durations);
            let mut steps = [[0.0; LANES]; 3];
            for lane in 0..LANES {
                let step = CellStep::at(arithmetic, (rates[lane], durations[lane]), passage);
                steps[0][lane] = step.keep;
                steps[1][lane] = step.upstream;
                steps[2][lane] = step.own;
            }
            [*keep, *upstream, *own] = steps;
        }
        let rest = rest_of_rates.iter().zip(rest_of_durations);
        let out = rest_of_keep.iter_mut().zip(rest_of_upstream).zip(rest_of_own);
        for ((rate, duration), ((keep, upstream), own)) in rest.zip(out) {
            let step = CellStep::at(arithmetic, (*rate, *duration), passage);
            (*keep, *upstream, *own) = (step.keep, step.upstream, step.own);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Whatever was asked before: columns on either side, under other conditions, with heat or without.
    #[test]
    fn what_is_kept_is_the_step_of_the_cell() {
        let x = [-0.1, -0.01, -0.004, -0.002, 0.0, 0.002, 0.004, 0.01, 0.1];
        let depth: Vec<f64> = (0..12).map(|row| 1e-5 * (1.8_f64.powi(row) - 1.0)).collect();
        let basis = DepthBasis::new(&depth).unwrap();
        let mut cells = CellFactors::new(&basis, &x);
        assert_eq!(cells.cells.lengths.len(), 3);
        for (speed, duration) in [
            (10.0, 1e-3),
            (10.0, 1e-4),
            (0.0, 1e-3),
            (3.0, f64::INFINITY),
            (10.0, 1e-3),
        ] {
            let conditions = Conditions {
                speed,
                duration,
                diffusivity: 1.4e-5,
                capacity: 3.6e6,
            };
            cells.adapt(&basis, conditions);
            for (index, spacing) in [(0, 0.09), (3, 0.002), (6, 0.006), (4, 0.002), (7, 0.09)] {
                let column = Column {
                    index,
                    upstream: index + 1,
                    spacing,
                };
                let length = cells.length_of(&column);
                let (factors, heat) = cells.heated_at(Arithmetic::SEPARATE, &basis, length);
                let mut response = 0.0;
                for mode in 0..basis.len() {
                    let rate = 1.0 / duration + 1.4e-5 * basis.eigenvalues[mode];
                    let step = CellStep::new(rate, spacing, speed);
                    let heating = basis.surface[mode] / 3.6e6;
                    response += basis.surface[mode] * heating * step.own;
                    for (kept, exact) in [
                        (factors.keep[mode], step.keep),
                        (factors.upstream[mode], step.upstream),
                        (factors.own[mode], step.own),
                        (heat.passed_on[mode], heating * step.upstream),
                        (heat.taken[mode], heating * step.own),
                    ] {
                        // The lengths differ by round-off.
                        assert!(
                            (kept - exact).abs() <= 1e-12 * exact.abs(),
                            "{speed} {index} {mode}: {kept:e} {exact:e}"
                        );
                    }
                }
                assert!((heat.response / response - 1.0).abs() < 1e-12);
            }
        }
    }
}
