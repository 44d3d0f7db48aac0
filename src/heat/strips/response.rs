//! The thermal response of the cells to their heat flux, and the flux that satisfies the surface condition.

use super::kernels::{ColumnSums, Lanes, Mode, Order, is_zero};
use crate::error::Result;
use crate::numerics::dense::{LANES, MultiplyAdd};

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
