//! The loops over the columns of a block of strips.

use crate::heat::step::{Crossing, ModeEnds, ModeStep};
use crate::numerics::dense::{LANES, MultiplyAdd};
use std::ops::Range;

/// A value of each strip of a block.
pub type Lanes = [f64; LANES];

/// Factors and heat content of a mode in a column of the window.
#[derive(Debug, Clone, Copy)]
pub struct Mode {
    /// Rate of decay r, `1/s`.
    pub rate: f64,
    /// Factors of the mode but those on the flux.
    pub step: ModeStep,
    /// Source f per heat flux, `K m^½/s / (W/m²)`.
    pub source_per_flux: f64,
    /// Amplitude per flux upstream.
    pub upstream_response: f64,
    /// Amplitude per flux of the column itself.
    pub diagonal_response: f64,
    /// Value φ(0) at the surface, `m^-½`.
    pub surface: f64,
    /// Integral ∫φ over the depth, `m^½`.
    pub content: f64,
}

impl Default for Mode {
    fn default() -> Mode {
        Mode {
            rate: 0.0,
            step: ModeStep {
                advected: 0.0,
                old_upstream: 0.0,
                old: 0.0,
                source_upstream: 0.0,
                source: 0.0,
            },
            source_per_flux: 0.0,
            upstream_response: 0.0,
            diagonal_response: 0.0,
            surface: 0.0,
            content: 0.0,
        }
    }
}

/// Surface temperature and heat content of the columns of a block.
pub struct ColumnSums<'a> {
    /// Temperature rise at the surface, `K`.
    pub surface: &'a mut [Lanes],
    /// Heat content, `K m`.
    pub content: &'a mut [Lanes],
}

/// The order in which rail crosses the columns of a block.
#[derive(Debug, Clone, Copy)]
pub struct Order {
    /// Number of columns.
    pub columns: usize,
    /// Direction of the rail: true towards −x₁.
    pub forward: bool,
}

impl Order {
    /// Range of a block's columns.
    pub fn columns(&self, block: usize) -> Range<usize> {
        block * self.columns..(block + 1) * self.columns
    }

    /// Range of a block's amplitudes, m modes a column.
    pub fn amplitudes(&self, block: usize, m: usize) -> Range<usize> {
        let size = self.columns * m * LANES;
        block * size..(block + 1) * size
    }

    /// The columns after the inflow, each with the one upstream of it.
    #[inline(always)]
    pub fn pairs(self) -> impl Iterator<Item = (usize, usize)> {
        let last = self.columns - 1;
        (1..self.columns).map(move |k| match self.forward {
            true => (last - k, last - k + 1),
            false => (k, k - 1),
        })
    }
}

/// The amplitudes of a column, of that upstream, and of both before the step.
struct Columns<'a> {
    own: &'a mut [Lanes],
    upstream: &'a [Lanes],
    old: &'a [Lanes],
    old_upstream: &'a [Lanes],
}

impl<'a> Columns<'a> {
    #[inline(always)]
    fn of(before: &'a [f64], after: &'a mut [f64], own: usize, upstream: usize, modes: usize) -> Columns<'a> {
        let before = before.as_chunks().0;
        let after = after.as_chunks_mut().0;
        let (own_after, upstream_after) = if own < upstream {
            let (left, right) = after.split_at_mut(upstream * modes);
            (&mut left[own * modes..][..modes], &right[..modes])
        } else {
            let (left, right) = after.split_at_mut(own * modes);
            (&mut right[..modes], &left[upstream * modes..][..modes])
        };
        Columns {
            own: own_after,
            upstream: upstream_after,
            old: &before[own * modes..][..modes],
            old_upstream: &before[upstream * modes..][..modes],
        }
    }

    /// Whether nothing warm is in it or is carried into it.
    #[inline(always)]
    fn is_cold(&self) -> bool {
        [&self.upstream[0], &self.old[0], &self.old_upstream[0]]
            .iter()
            .all(|slowest| is_zero(slowest))
    }
}

#[inline(always)]
pub fn is_zero(block: &Lanes) -> bool {
    block.iter().all(|&value| value == 0.0)
}

/// The march without heat flux, with the surface temperature and the heat content of the columns.
#[inline(always)]
pub fn unheated(
    fma: MultiplyAdd,
    order: Order,
    modes: &[Mode],
    before: &[f64],
    after: &mut [f64],
    sums_of: ColumnSums,
) {
    let fma = |a, b, c| fma.multiply_add(a, b, c);
    for (own, upstream) in order.pairs() {
        let columns = Columns::of(before, after, own, upstream, modes.len());
        let mut sums = [[0.0; LANES]; 2];
        if columns.is_cold() {
            columns.own.fill([0.0; LANES]);
        } else {
            let sources = columns.upstream.iter().zip(columns.old).zip(columns.old_upstream);
            for ((own, ((upstream, old), old_upstream)), mode) in columns.own.iter_mut().zip(sources).zip(modes) {
                let mut values = [0.0; LANES];
                for lane in 0..LANES {
                    let stored = fma(mode.step.old, old[lane], mode.step.old_upstream * old_upstream[lane]);
                    values[lane] = fma(mode.step.advected, upstream[lane], stored);
                }
                *own = values;
                for lane in 0..LANES {
                    sums[0][lane] = fma(mode.surface, values[lane], sums[0][lane]);
                    sums[1][lane] = fma(mode.content, values[lane], sums[1][lane]);
                }
            }
        }
        [sums_of.surface[own], sums_of.content[own]] = sums;
    }
}

/// The march under the heat flux of the columns.
#[inline(always)]
pub fn heated(fma: MultiplyAdd, order: Order, modes: &[Mode], before: &[f64], after: &mut [f64], flux: &[Lanes]) {
    let fma = |a, b, c| fma.multiply_add(a, b, c);
    for (own, upstream) in order.pairs() {
        let columns = Columns::of(before, after, own, upstream, modes.len());
        let (flux_upstream, flux_own) = (flux[upstream], flux[own]);
        if is_zero(&flux_upstream) && is_zero(&flux_own) && columns.is_cold() {
            columns.own.fill([0.0; LANES]);
            continue;
        }
        let sources = columns.upstream.iter().zip(columns.old).zip(columns.old_upstream);
        for ((own, ((upstream, old), old_upstream)), mode) in columns.own.iter_mut().zip(sources).zip(modes) {
            let mut values = [0.0; LANES];
            for lane in 0..LANES {
                let stored = fma(mode.step.old, old[lane], mode.step.old_upstream * old_upstream[lane]);
                let advected = fma(mode.step.advected, upstream[lane], stored);
                values[lane] = fma(
                    mode.diagonal_response,
                    flux_own[lane],
                    fma(mode.upstream_response, flux_upstream[lane], advected),
                );
            }
            *own = values;
        }
    }
}

/// A step of a block's strips, whose change with |V| is asked for.
pub struct SolvedStrips<'a> {
    /// Amplitudes after it.
    pub amplitudes: &'a [f64],
    /// Amplitudes that stood in the inflow column before the step.
    pub replaced: &'a [f64],
    /// Heat flux of the columns, `W/m²`.
    pub flux: &'a [Lanes],
    /// Cell that the modes cross; their rate r is not in it.
    pub crossing: Crossing,
}

impl SolvedStrips<'_> {
    /// Computes the sources that a change of |V| by `change` `m/s` adds to the amplitudes of each column; `old` holds m
    /// blocks.
    pub fn speed_sources(&self, order: Order, modes: &[Mode], change: f64, old: &mut [Lanes], sources: &mut [f64]) {
        let m = modes.len();
        let amplitudes = self.amplitudes.as_chunks::<LANES>().0;
        let sources = sources.as_chunks_mut::<LANES>().0;
        // The amplitudes before the step follow from its result, column by column.
        old.copy_from_slice(self.replaced.as_chunks().0);
        for (own, upstream) in order.pairs() {
            for (index, mode) in modes.iter().enumerate() {
                let crossing = Crossing {
                    rate: mode.rate,
                    ..self.crossing
                };
                let values = [&amplitudes[upstream * m + index], &amplitudes[own * m + index]];
                for lane in 0..LANES {
                    let mut ends = ModeEnds {
                        value: values.map(|block| block[lane]),
                        old: [old[index][lane], 0.0],
                        source: [upstream, own].map(|column| mode.source_per_flux * self.flux[column][lane]),
                    };
                    ends.old[1] = mode.step.previous(&ends);
                    old[index][lane] = ends.old[1];
                    sources[own * m + index][lane] = change * mode.step.speed_tangent(&crossing, &ends);
                }
            }
        }
    }
}

/// Computes the change of the amplitudes with that of the inflow column of `tangent`, of the heat flux, `flux`, and of the
/// other sources, `sources`; with it, in `sums_of`, the changes of surface temperature and heat content, if asked for.
#[inline(always)]
pub fn tangent(
    fma: MultiplyAdd,
    order: Order,
    modes: &[Mode],
    sources: Option<&[f64]>,
    flux: &[Lanes],
    tangent: &mut [f64],
    mut sums_of: Option<ColumnSums>,
) {
    let m = modes.len();
    let fma = |a, b, c| fma.multiply_add(a, b, c);
    let tangent = tangent.as_chunks_mut::<LANES>().0;
    for (own, upstream) in order.pairs() {
        let mut sums = [[0.0; LANES]; 2];
        for (index, mode) in modes.iter().enumerate() {
            let before = tangent[upstream * m + index];
            let source = match sources {
                Some(sources) => sources.as_chunks::<LANES>().0[own * m + index],
                None => [0.0; LANES],
            };
            let mut values = [0.0; LANES];
            for lane in 0..LANES {
                let heated = fma(
                    mode.upstream_response,
                    flux[upstream][lane],
                    mode.diagonal_response * flux[own][lane],
                );
                values[lane] = fma(mode.step.advected, before[lane], heated + source[lane]);
                sums[0][lane] = fma(mode.surface, values[lane], sums[0][lane]);
                sums[1][lane] = fma(mode.content, values[lane], sums[1][lane]);
            }
            tangent[own * m + index] = values;
        }
        if let Some(sums_of) = &mut sums_of {
            [sums_of.surface[own], sums_of.content[own]] = sums;
        }
    }
}
