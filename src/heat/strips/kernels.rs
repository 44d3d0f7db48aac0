//! The loops over the columns of a block of strips.

use crate::error::Result;
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

/// Thermal response of the columns downstream to a flux, by the number of columns between: R of the surface temperature
/// and the same of the heat content.
#[derive(Debug, Clone)]
pub struct Responses {
    /// Response R of the surface temperature, `K/(W/m²)`.
    pub surface: Vec<f64>,
    /// Response of the heat content, `K m/(W/m²)`.
    pub content: Vec<f64>,
    /// Response of the modal amplitudes at one distance.
    amplitudes: Vec<f64>,
}

impl Responses {
    /// Responses over the given number of cells, of as many modes; not computed yet.
    pub fn new(cells: usize, modes: usize) -> Responses {
        Responses {
            surface: vec![0.0; cells],
            content: vec![0.0; cells],
            amplitudes: vec![0.0; modes],
        }
    }

    /// Computes the responses of the given modes.
    #[inline(always)]
    pub fn compute(&mut self, fma: MultiplyAdd, modes: &[Mode]) {
        let places = self.surface.iter_mut().zip(&mut self.content).enumerate();
        for (distance, (surface, content)) in places {
            let mut sums = [0.0; 2];
            for (amplitude, mode) in self.amplitudes.iter_mut().zip(modes) {
                *amplitude = match distance {
                    0 => mode.diagonal_response,
                    1 => fma.multiply_add(mode.step.advected, *amplitude, mode.upstream_response),
                    _ => mode.step.advected * *amplitude,
                };
                sums[0] = fma.multiply_add(mode.surface, *amplitude, sums[0]);
                sums[1] = fma.multiply_add(mode.content, *amplitude, sums[1]);
            }
            [*surface, *content] = sums;
        }
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
fn is_zero(block: &Lanes) -> bool {
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

/// Fields of the cells of a block's strips, strip by strip.
pub struct CellFields<'a> {
    /// Heat flux, `W/m²`.
    pub flux: &'a mut [f64],
    /// Temperature rise at the surface, `K`.
    pub surface: &'a mut [f64],
    /// Heat content, `K m`.
    pub content: &'a mut [f64],
    /// Number of the block's lanes that are strips of the patch.
    pub strips: usize,
}

/// Computes flux, surface temperature and heat content of the cells, one after the other along the way of the rail. `flux_at`
/// gives the flux at a place among `cells` and a cell, from the surface temperature without it and a guess of that with it.
#[inline(always)]
pub fn respond(
    fma: MultiplyAdd,
    order: Order,
    responses: &Responses,
    unheated: &ColumnSums,
    flux: &mut [Lanes],
    cells: &mut CellFields,
    mut flux_at: impl FnMut(usize, usize, f64, f64) -> Result<f64>,
) -> Result<()> {
    let count = order.columns - 2;
    // The columns upstream that have a flux are those from the first one with any.
    let mut first = None;
    for (column, upstream) in order.pairs().take(count) {
        let cell = column - 1;
        let heated = match (first, order.forward) {
            (None, _) => 0..0,
            (Some(first), true) => upstream..first + 1,
            (Some(first), false) => first..column,
        };
        let sources = &flux[heated];
        let start = [unheated.surface[column], unheated.content[column]];
        let rise = if order.forward {
            add_responses(fma, sources.iter(), responses, start)
        } else {
            add_responses(fma, sources.iter().rev(), responses, start)
        };
        let mut heat_flux = [0.0; LANES];
        for strip in 0..cells.strips {
            let place = strip * count + cell;
            heat_flux[strip] = flux_at(place, cell, rise[0][strip], cells.surface[place])?;
            cells.flux[place] = heat_flux[strip];
        }
        if !is_zero(&heat_flux) && first.is_none() {
            first = Some(column);
        }
        flux[column] = heat_flux;
        let (surface, content) = (responses.surface[0], responses.content[0]);
        for strip in 0..cells.strips {
            let place = strip * count + cell;
            cells.surface[place] = rise[0][strip] + surface * heat_flux[strip];
            cells.content[place] = rise[1][strip] + content * heat_flux[strip];
        }
    }
    Ok(())
}

/// Adds the thermal responses to the fluxes upstream, `sources`, the next one upstream first, to surface temperature and
/// heat content.
#[inline(always)]
fn add_responses<'a>(
    fma: MultiplyAdd,
    sources: impl Iterator<Item = &'a Lanes>,
    responses: &Responses,
    start: [Lanes; 2],
) -> [Lanes; 2] {
    let [mut rise, mut heat] = start;
    // The response at distance 0 is that to the column's own flux.
    let (surface, content) = (&responses.surface[1..], &responses.content[1..]);
    for ((flux, surface), content) in sources.zip(surface).zip(content) {
        for lane in 0..LANES {
            rise[lane] = fma.multiply_add(*surface, flux[lane], rise[lane]);
            heat[lane] = fma.multiply_add(*content, flux[lane], heat[lane]);
        }
    }
    [rise, heat]
}
