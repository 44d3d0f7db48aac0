//! The temperature of the strips of a patch: the march of [`super::march`] in all strips at once.
//!
//! All strips have the same columns, |V| and Δt, so the same factors: amplitudes are kept in blocks of [`LANES`] strips side by
//! side, and each factor is loaded once for a block.
//!
//! A step needs the march several times, with another exchange but from the same temperature. Columns are evenly spaced,
//! and the march is linear in the heat flux q: at the surface of a column, counted from the inflow,
//!
//! θ_c = θ⁰_c + Σ_j R_j q_{c−j},  R_0 = φ·h,  R_j = Σ φ E^{j−1} (E h + g),
//!
//! θ⁰ without flux, E the fraction of a mode that is left at the next column, h its amplitude per flux of the column itself and g that per flux
//! upstream, φ its value at the surface; and with ∫φ for φ the heat content Θ = ∫ θ dz. So the modes are marched twice a step only, whatever the
//! number of iterations:
//!
//! 1. [`StripHeatMarch::start`]: the rail ahead; θ⁰ and Θ⁰ of the cells.
//! 2. [`StripHeatMarch::heat`], as often as the exchange changes: flux, surface temperature and heat content of the cells.
//! 3. [`StripHeatMarch::finalise`]: the modes under that flux, and the rail behind.
//!
//! Each has its tangent; a direction in which neither |V| nor the incoming temperature changes has no modes to march in the first.
//! What strips have in common with the rail ahead and behind is in [`crate::transport::strips`].
//!
//! Fields of cells are strip by strip: `strip * cells + cell`, cells towards +x₁.

mod kernels;
mod response;
mod tangent;
mod temperature;
#[cfg(test)]
mod tests;

use super::basis::DepthBasis;
use super::factors::{CellFactors, Conditions};
use super::incoming::Incoming;
use super::march::{HeatMarch, Heated};
use super::surface::{SurfaceCondition, SurfaceExchange, SurfaceRise};
use crate::error::Result;
use crate::numerics::dense::{self, LANES};
use crate::transport::strips::{Side, Strips};
use kernels::{ColumnSums, Lanes, Mode, Order};
use response::{CellFields, Responses};

pub use tangent::{CarriageChange, StripHeatChange};
pub use temperature::StripTemperature;

/// One implicit time step of the strips.
pub struct StripHeatMarch<'a> {
    /// Eigenbasis of the depth operator.
    pub basis: &'a DepthBasis,
    /// Profile of the temperature that enters.
    pub incoming: &'a Incoming,
    /// The strips.
    pub strips: &'a Strips,
    /// Speed V, `m/s`; 0 counts as forward.
    pub speed: f64,
    /// Step Δt, `s`; infinite for the steady field.
    pub duration: f64,
    /// The surface condition.
    pub surface: SurfaceCondition<'a>,
}

/// Buffers of a march. Its results do not depend on their contents before its start.
#[derive(Debug, Clone)]
pub struct StripHeatScratch {
    /// Factors in the window and on either side of it.
    cells: CellFactors,
    outer_cells: [CellFactors; 2],
    /// Conditions under which `modes` and `responses` were computed.
    conditions: Option<Conditions>,
    modes: Vec<Mode>,
    responses: Responses,
    /// Surface temperature θ⁰ and heat content Θ⁰ without flux and heat flux q, or their changes, blocks × columns.
    unheated: Vec<Lanes>,
    unheated_content: Vec<Lanes>,
    flux: Vec<Lanes>,
    /// Sources that a change of |V| adds to the amplitudes of the strips, and, m blocks, the amplitudes of a column
    /// before the step.
    sources: Vec<f64>,
    old: Vec<Lanes>,
    /// Surface temperature of the columns on one side and its change, and a copy of their amplitudes.
    outer_surface: Vec<f64>,
    outer: Vec<f64>,
}

impl StripHeatScratch {
    /// Scratch for the given strips.
    pub fn new(basis: &DepthBasis, strips: &Strips) -> StripHeatScratch {
        let m = basis.len();
        let cells = |side| CellFactors::new(basis, strips.outer_positions(side));
        let outer = [Side::Left, Side::Right].map(|side| strips.outer_positions(side).len());
        let longest = outer[0].max(outer[1]);
        let blocks = vec![[0.0; LANES]; strips.blocks() * strips.columns()];
        StripHeatScratch {
            cells: CellFactors::new(basis, strips.window(1.0).positions()),
            outer_cells: [cells(Side::Left), cells(Side::Right)],
            conditions: None,
            modes: vec![Mode::default(); m],
            responses: Responses::new(strips.cells, m),
            unheated: blocks.clone(),
            unheated_content: blocks.clone(),
            flux: blocks,
            sources: vec![0.0; strips.blocks() * strips.columns() * m * LANES],
            old: vec![[0.0; LANES]; m],
            outer_surface: vec![0.0; 2 * longest],
            outer: vec![0.0; longest * m],
        }
    }
}

impl StripHeatMarch<'_> {
    /// Starts a step from `before`, with rail entering at `rise` `K` over the ambient: computes the rail ahead of the
    /// window, in `after`, and the temperature and heat content of the strips without heat flux.
    ///
    /// # Errors
    /// Never: a column without heat flux has no equation to iterate on.
    pub fn start(
        &self,
        before: &StripTemperature,
        rise: f64,
        after: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) -> Result<()> {
        self.adapt(scratch);
        let m = self.basis.len();
        let (ahead, _) = self.strips.ends(self.speed);
        let outer = self.strips.outer(ahead, self.speed);
        let amplitudes = &mut after.outer[ahead as usize];
        self.incoming
            .enter(rise, &mut amplitudes[outer.inflow() * m..][..m], &mut 0.0);
        self.march_outer(ahead, &before.outer[ahead as usize], amplitudes, scratch)?;
        let entering = &after.outer[ahead as usize][outer.outflow() * m..][..m];
        self.enter_window(entering, &mut after.window);
        scratch.flux.fill([0.0; LANES]);
        let (order, scratch) = (self.order(), &mut *scratch);
        dense::vectorised(
            #[inline(always)]
            |fma| {
                let modes = &scratch.modes[..];
                for block in 0..self.strips.blocks() {
                    let (own, columns) = (order.amplitudes(block, m), order.columns(block));
                    kernels::unheated(
                        fma,
                        order,
                        modes,
                        &before.window[own.clone()],
                        &mut after.window[own],
                        ColumnSums {
                            surface: &mut scratch.unheated[columns.clone()],
                            content: &mut scratch.unheated_content[columns],
                        },
                    );
                }
            },
        );
        Ok(())
    }

    /// Heat flux, surface temperature and heat content of the cells of `after` under the exchange at the cells.
    ///
    /// # Errors
    /// [`crate::error::Error::SurfaceHeatNotConverged`].
    pub fn heat(
        &self,
        exchange: &[SurfaceExchange],
        after: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) -> Result<()> {
        let response = scratch.responses.surface[0];
        let window = self.strips.window(self.speed);
        self.respond(after, scratch, |place, cell, unheated, guess| {
            let exchange = &exchange[place];
            if exchange.is_open() {
                return Ok(0.0);
            }
            self.surface.flux(
                exchange,
                SurfaceRise { unheated, response },
                guess,
                window.position(cell + 1),
            )
        })
    }

    /// The amplitudes of `after` under its heat flux, and the rail behind, over a contact of breadth B `breadth` `m`. Without a
    /// contact, at 0, it is that of the last step with one.
    ///
    /// # Errors
    /// Never: a column without heat flux has no equation to iterate on.
    pub fn finalise(
        &self,
        before: &StripTemperature,
        breadth: f64,
        after: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) -> Result<()> {
        let m = self.basis.len();
        self.replace(before, after);
        let order = self.order();
        dense::vectorised(
            #[inline(always)]
            |fma| {
                let modes = &scratch.modes[..];
                for block in 0..self.strips.blocks() {
                    let own = order.amplitudes(block, m);
                    kernels::heated(
                        fma,
                        order,
                        modes,
                        &before.window[own.clone()],
                        &mut after.window[own],
                        &scratch.flux[order.columns(block)],
                    );
                }
            },
        );
        after.breadth = if breadth > 0.0 { breadth } else { before.breadth };
        let (_, behind) = self.strips.ends(self.speed);
        let inflow = self.strips.outer(behind, self.speed).inflow();
        let leaving = self.strips.window(self.speed).outflow();
        for mode in 0..m {
            let value = |strip| after.window[self.place(strip, leaving, mode)];
            after.outer[behind as usize][inflow * m + mode] = self.strips.mean(after.breadth, value);
        }
        self.march_outer(
            behind,
            &before.outer[behind as usize],
            &mut after.outer[behind as usize],
            scratch,
        )
    }

    /// Modal amplitudes of the rail that leaves at the end of the strip, m.
    pub fn leaving<'f>(&self, field: &'f StripTemperature) -> &'f [f64] {
        let (_, behind) = self.strips.ends(self.speed);
        let m = self.basis.len();
        &field.outer[behind as usize][self.strips.outer(behind, self.speed).outflow() * m..][..m]
    }

    fn order(&self) -> Order {
        Order {
            columns: self.strips.columns(),
            forward: self.speed >= 0.0,
        }
    }

    /// Index of a strip's modal amplitude in a column.
    fn place(&self, strip: usize, column: usize, mode: usize) -> usize {
        let row = (strip / LANES * self.strips.columns() + column) * self.basis.len() + mode;
        row * LANES + strip % LANES
    }

    /// The step through a cell of the window under the conditions of the march.
    fn adapt(&self, scratch: &mut StripHeatScratch) {
        let parameters = self.surface.friction.parameters;
        let conditions = Conditions {
            speed: self.speed.abs(),
            duration: self.duration,
            diffusivity: parameters.thermal_diffusivity,
            capacity: parameters.volumetric_heat_capacity(),
        };
        if scratch.conditions == Some(conditions) {
            return;
        }
        scratch.conditions = Some(conditions);
        scratch.cells.adapt(self.basis, conditions);
        dense::vectorised(
            #[inline(always)]
            |fma| {
                let (factors, heat) = scratch.cells.heated_at(fma, self.basis, 0);
                for (mode, kept) in scratch.modes.iter_mut().enumerate() {
                    *kept = Mode {
                        rate: conditions.diffusivity * self.basis.eigenvalues[mode],
                        step: factors.step(mode),
                        source_per_flux: heat.source_per_flux[mode],
                        upstream_response: heat.upstream_response[mode],
                        diagonal_response: heat.diagonal_response[mode],
                        surface: self.basis.surface[mode],
                        content: self.basis.integral[mode],
                    };
                }
                scratch.responses.compute(fma, &scratch.modes);
            },
        );
    }

    /// Sets the same amplitudes in all strips of the inflow column.
    fn enter_window(&self, entering: &[f64], window: &mut [f64]) {
        let (m, inflow) = (self.basis.len(), self.strips.window(self.speed).inflow());
        for block in 0..self.strips.blocks() {
            let column = &mut window[self.place(block * LANES, inflow, 0)..][..m * LANES];
            for (strips, &amplitude) in column.chunks_exact_mut(LANES).zip(entering) {
                strips.fill(amplitude);
            }
        }
    }

    /// Keeps what the step replaces.
    fn replace(&self, before: &StripTemperature, after: &mut StripTemperature) {
        let m = self.basis.len();
        let inflow = self.strips.window(self.speed).inflow();
        let (strips, outer) = after.replaced.split_at_mut(self.strips.blocks() * m * LANES);
        for (block, strips) in strips.chunks_exact_mut(m * LANES).enumerate() {
            strips.copy_from_slice(&before.window[self.place(block * LANES, inflow, 0)..][..m * LANES]);
        }
        let (ahead, behind) = self.strips.ends(self.speed);
        for (side, replaced) in [ahead, behind].into_iter().zip(outer.chunks_exact_mut(m)) {
            let inflow = self.strips.outer(side, self.speed).inflow();
            replaced.copy_from_slice(&before.outer[side as usize][inflow * m..][..m]);
        }
    }

    /// The march through the columns on one side: nothing heats them.
    fn outer_march(&self, side: Side) -> HeatMarch<'_> {
        HeatMarch {
            basis: self.basis,
            transport: self.strips.outer(side, self.speed),
            first_contact: 0,
            duration: self.duration,
            surface: self.surface,
        }
    }

    fn march_outer(&self, side: Side, before: &[f64], after: &mut [f64], scratch: &mut StripHeatScratch) -> Result<()> {
        let mut field = Heated {
            amplitudes: after,
            surface: &mut scratch.outer_surface,
            flux: &mut [],
        };
        self.outer_march(side)
            .advance(before, &[], &mut field, &mut scratch.outer_cells[side as usize])
    }

    /// Flux, surface temperature and heat content of the cells, or their changes, where the flux at a place and cell follows
    /// from the temperature that the surface has without it.
    fn respond(
        &self,
        after: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
        mut flux: impl FnMut(usize, usize, f64, f64) -> Result<f64>,
    ) -> Result<()> {
        let (order, cells) = (self.order(), self.strips.cells);
        dense::vectorised(
            #[inline(always)]
            |fma| {
                for block in 0..self.strips.blocks() {
                    let columns = order.columns(block);
                    let first = block * LANES;
                    let strips = LANES.min(self.strips.strips.saturating_sub(first));
                    let mut cells_of_block = CellFields {
                        flux: &mut after.flux[first * cells..][..strips * cells],
                        surface: &mut after.surface[first * cells..][..strips * cells],
                        content: &mut after.content[first * cells..][..strips * cells],
                        strips,
                    };
                    response::respond(
                        fma,
                        order,
                        &scratch.responses,
                        &ColumnSums {
                            surface: &mut scratch.unheated[columns.clone()],
                            content: &mut scratch.unheated_content[columns.clone()],
                        },
                        &mut scratch.flux[columns],
                        &mut cells_of_block,
                        |place, cell, unheated, guess| flux(first * cells + place, cell, unheated, guess),
                    )?;
                }
                Ok(())
            },
        )
    }
}
