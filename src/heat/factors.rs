//! The factors with which the modes of a column pass from one column to the next.
//!
//! They depend on the length of the cell between the columns, on |V| and on Δt. A step marches several times with the same
//! speed and Δt, all cells of the window are of one length, and those outside it are mirror images: so they are kept by length,
//! and computed for the cells that something warm crosses.

use super::basis::DepthBasis;
use super::step::{DecayRate, ModeStep, Transit};
use crate::numerics::dense::{LANES, MultiplyAdd};
use crate::transport::{Cells, Column};

/// The fields of [`ModeStep`], in their order, of as many modes as are computed at once.
type StepLanes = [[f64; LANES]; 5];

/// Factors of all modes in the cells between columns; m modes. What they are depends on nothing that was asked before.
#[derive(Debug, Clone)]
pub struct CellFactors {
    cells: Cells,
    /// Conditions under which the known factors were computed.
    conditions: Conditions,
    /// Whether the factors of a length are known.
    known: Vec<bool>,
    /// r and 1/r of the modes, in blocks, the last one filled up.
    rates: Vec<[[f64; LANES]; 2]>,
    /// Blocks of the factors: as many as `rates` has for each length, one length after the other.
    blocks: Vec<StepLanes>,
    /// Length that the responses to a flux are of.
    heated: Option<usize>,
    /// Source of a mode per heat flux, and the amplitudes that a flux upstream and the column's own flux cause, m each,
    /// `K m^½ / (W/m²)`.
    source_per_flux: Vec<f64>,
    upstream_response: Vec<f64>,
    diagonal_response: Vec<f64>,
    response: f64,
    /// Buffer of the linearised march: amplitudes of a column before the step, m.
    pub(super) old: Vec<f64>,
}

/// Conditions that the factors depend on beside the length of a cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Speed |V|, `m/s`.
    pub speed: f64,
    /// Step Δt, `s`.
    pub duration: f64,
    /// Diffusivity κ, `m²/s`.
    pub diffusivity: f64,
    /// Volumetric heat capacity ρ c_p, `J/(m³ K)`.
    pub capacity: f64,
}

/// The steps of all modes through a cell.
#[derive(Debug, Clone, Copy)]
pub struct Factors<'a> {
    blocks: &'a [StepLanes],
}

/// Factors on the heat flux of a column and of the one upstream, m each.
#[derive(Debug, Clone, Copy)]
pub struct HeatFactors<'a> {
    /// Source f of a mode per heat flux, φ(0)/(ρ c_p).
    pub source_per_flux: &'a [f64],
    /// Amplitude per flux upstream.
    pub upstream_response: &'a [f64],
    /// Amplitude per flux of the column itself.
    pub diagonal_response: &'a [f64],
    /// Surface temperature per flux of the column itself, `K/(W/m²)`.
    pub response: f64,
}

/// Sources of the modes of a column but for its own heat flux, m each.
#[derive(Debug, Clone, Copy)]
pub struct Sources<'a> {
    /// Amplitudes in the column upstream.
    pub upstream: &'a [f64],
    /// Amplitudes of the step before in the column upstream.
    pub old_upstream: &'a [f64],
    /// Amplitudes of the step before in the column itself.
    pub old: &'a [f64],
    /// Heat flux into the column upstream, with the amplitudes per flux there.
    pub flux: Option<(f64, &'a [f64])>,
}

impl Factors<'_> {
    /// The step of one mode.
    pub fn step(&self, mode: usize) -> ModeStep {
        let block = &self.blocks[mode / LANES];
        let [advected, old_upstream, old, source_upstream, source] =
            std::array::from_fn(|which| block[which][mode % LANES]);
        ModeStep {
            advected,
            old_upstream,
            old,
            source_upstream,
            source,
        }
    }

    /// Advances the modes but for their own heat flux, and returns the surface value of the result: as
    /// [`MultiplyAdd::dot`], in the same pass.
    #[inline(always)]
    pub fn advance(&self, fma: MultiplyAdd, own: &mut [f64], sources: &Sources, surface: &[f64]) -> f64 {
        let fma = |a, b, c| fma.multiply_add(a, b, c);
        let Sources {
            upstream,
            old_upstream,
            old,
            flux,
        } = *sources;
        let (heat, upstream_response) = flux.unwrap_or((0.0, surface));
        let mut sums = [0.0; LANES];
        let (blocks, rest) = own.as_chunks_mut::<LANES>();
        let whole = LANES * blocks.len();
        let sources = chunks(upstream)
            .zip(chunks(old_upstream))
            .zip(chunks(old))
            .zip(chunks(upstream_response));
        let inputs = self.blocks.iter().zip(sources).zip(chunks(surface));
        for (own, ((factors, (((upstream, old_upstream), old), upstream_response)), surface)) in
            blocks.iter_mut().zip(inputs)
        {
            let [advected, old_upstream_factor, old_factor, ..] = factors;
            // All values are loaded before one is stored: otherwise the compiler must assume that the slices overlap, and does
            // not vectorise.
            let mut values = [0.0; LANES];
            for lane in 0..LANES {
                // The term with the column upstream comes last: only this waits for that column.
                let stored = fma(
                    old_factor[lane],
                    old[lane],
                    old_upstream_factor[lane] * old_upstream[lane],
                );
                values[lane] = fma(advected[lane], upstream[lane], stored);
                if flux.is_some() {
                    values[lane] = fma(heat, upstream_response[lane], values[lane]);
                }
            }
            *own = values;
            for lane in 0..LANES {
                sums[lane] = fma(values[lane], surface[lane], sums[lane]);
            }
        }
        let mut tail = 0.0;
        for (own, mode) in rest.iter_mut().zip(whole..) {
            let step = self.step(mode);
            *own = step.advected * upstream[mode] + step.old_upstream * old_upstream[mode] + step.old * old[mode];
            if flux.is_some() {
                *own += heat * upstream_response[mode];
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
    /// Factors, none known yet, for columns at `x` `m`.
    pub fn new(basis: &DepthBasis, x: &[f64]) -> CellFactors {
        let m = basis.len();
        let cells = Cells::new(x);
        let (lengths, blocks) = (cells.lengths.len(), m.div_ceil(LANES));
        CellFactors {
            cells,
            conditions: Conditions {
                speed: f64::NAN,
                duration: f64::NAN,
                diffusivity: f64::NAN,
                capacity: f64::NAN,
            },
            known: vec![false; lengths],
            rates: vec![[[1.0; LANES]; 2]; blocks],
            blocks: vec![StepLanes::default(); blocks * lengths],
            heated: None,
            source_per_flux: vec![0.0; m],
            upstream_response: vec![0.0; m],
            diagonal_response: vec![0.0; m],
            response: 0.0,
            old: vec![0.0; m],
        }
    }

    /// Forgets what was computed under other conditions.
    pub fn adapt(&mut self, basis: &DepthBasis, conditions: Conditions) {
        if self.conditions == conditions {
            return;
        }
        self.conditions = conditions;
        self.known.fill(false);
        self.heated = None;
        for (mode, eigenvalue) in basis.eigenvalues.iter().enumerate() {
            let rate = conditions.diffusivity * eigenvalue;
            let [rates, lifetimes] = &mut self.rates[mode / LANES];
            (rates[mode % LANES], lifetimes[mode % LANES]) = (rate, 1.0 / rate);
            self.source_per_flux[mode] = basis.surface[mode] / conditions.capacity;
        }
    }

    /// The place of the length of the cell upstream of a column.
    pub fn length_of(&self, column: &Column) -> usize {
        self.cells.length_of(column)
    }

    /// Factors at a length.
    #[inline(always)]
    pub fn at(&mut self, fma: MultiplyAdd, length: usize) -> Factors<'_> {
        if !self.known[length] {
            self.known[length] = true;
            self.compute(fma, length);
        }
        self.known_at(length)
    }

    #[inline(always)]
    fn known_at(&self, length: usize) -> Factors<'_> {
        let count = self.rates.len();
        Factors {
            blocks: &self.blocks[count * length..][..count],
        }
    }

    /// Factors at a length, and those of the flux.
    #[inline(always)]
    pub fn heated_at(&mut self, fma: MultiplyAdd, basis: &DepthBasis, length: usize) -> (Factors<'_>, HeatFactors<'_>) {
        self.at(fma, length);
        if self.heated != Some(length) {
            self.heated = Some(length);
            for mode in 0..basis.len() {
                let step = self.known_at(length).step(mode);
                self.upstream_response[mode] = self.source_per_flux[mode] * step.source_upstream;
                self.diagonal_response[mode] = self.source_per_flux[mode] * step.source;
            }
            self.response = fma.dot(&basis.surface, &self.diagonal_response);
        }
        let heat = HeatFactors {
            source_per_flux: &self.source_per_flux,
            upstream_response: &self.upstream_response,
            diagonal_response: &self.diagonal_response,
            response: self.response,
        };
        (self.known_at(length), heat)
    }

    /// [`ModeStep`] of every mode.
    #[inline(always)]
    fn compute(&mut self, fma: MultiplyAdd, length: usize) {
        let (length_of_cell, speed) = (self.cells.lengths[length], self.conditions.speed);
        let transit = Transit::new(length_of_cell, speed);
        let storage = 1.0 / self.conditions.duration;
        let count = self.rates.len();
        for (block, [rates, lifetimes]) in self.blocks[count * length..].iter_mut().zip(&self.rates) {
            let mut factors = StepLanes::default();
            for lane in 0..LANES {
                let rate = DecayRate {
                    rate: rates[lane],
                    lifetime: lifetimes[lane],
                };
                let step = ModeStep::at(fma, rate, storage, transit);
                let step = [
                    step.advected,
                    step.old_upstream,
                    step.old,
                    step.source_upstream,
                    step.source,
                ];
                for (factors, factor) in factors.iter_mut().zip(step) {
                    factors[lane] = factor;
                }
            }
            *block = factors;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Factors do not depend on what was asked before: columns on either side, under other conditions, with heat or
    /// without.
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
                let (factors, heat) = cells.heated_at(MultiplyAdd::SEPARATE, &basis, length);
                let mut response = 0.0;
                for mode in 0..basis.len() {
                    let rate = 1.4e-5 * basis.eigenvalues[mode];
                    let (rate, transit) = (DecayRate::new(rate), Transit::new(spacing, speed));
                    let step = ModeStep::at(MultiplyAdd::SEPARATE, rate, 1.0 / duration, transit);
                    let kept = factors.step(mode);
                    let source_per_flux = basis.surface[mode] / 3.6e6;
                    response += basis.surface[mode] * source_per_flux * step.source;
                    for (kept, exact) in [
                        (kept.advected, step.advected),
                        (kept.old_upstream, step.old_upstream),
                        (kept.old, step.old),
                        (heat.upstream_response[mode], source_per_flux * step.source_upstream),
                        (heat.diagonal_response[mode], source_per_flux * step.source),
                    ] {
                        // The lengths differ by round-off.
                        assert!(
                            (kept - exact).abs() <= 1e-12 * exact.abs() + 1e-20,
                            "{speed} {index} {mode}: {kept:e} {exact:e}"
                        );
                    }
                }
                assert!((heat.response / response - 1.0).abs() < 1e-12);
            }
        }
    }
}
