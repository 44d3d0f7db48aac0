//! The change of a step's result with its data, in the three parts of the step.

use super::kernels::{self, ColumnSums, SolvedStrips};
use super::{StripHeatMarch, StripHeatScratch, StripTemperature};
use crate::error::Result;
use crate::heat::march::{Heated, MarchChange};
use crate::heat::step::Crossing;
use crate::heat::surface::{CommonChange, ExchangeTangent, SurfaceExchange, SurfaceRise};
use crate::numerics::dense::{self, LANES};
use crate::transport::strips::Side;

/// The exchange at the cells, not changed, and its change.
#[derive(Debug, Clone, Copy)]
pub struct StripHeatChange<'a> {
    /// Change of what all cells have in common.
    pub common: CommonChange,
    /// The exchange.
    pub exchange: &'a [SurfaceExchange],
    /// Change of the exchange.
    pub exchange_tangent: &'a [ExchangeTangent],
}

/// Change of what carries heat through the strips.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CarriageChange {
    /// Change of |V|, `m/s`.
    pub speed: f64,
    /// Change of the entering temperature rise, `K`.
    pub rise: f64,
    /// Change of the contact's breadth B, `m`; 0 without a contact.
    pub breadth: f64,
}

impl StripHeatMarch<'_> {
    /// The change of [`StripHeatMarch::start`] where `solution` is the result of the step.
    pub fn start_tangent(
        &self,
        solution: &StripTemperature,
        change: &CarriageChange,
        tangent: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) {
        self.adapt(scratch);
        let m = self.basis.len();
        let (ahead, _) = self.strips.ends(self.speed);
        let outer = self.strips.outer(ahead, self.speed);
        let amplitudes = &mut tangent.outer[ahead as usize];
        if change.speed == 0.0 && change.rise == 0.0 {
            amplitudes.fill(0.0);
            tangent.window.fill(0.0);
            for blocks in [&mut scratch.unheated, &mut scratch.unheated_content, &mut scratch.flux] {
                blocks.fill([0.0; LANES]);
            }
            return;
        }
        self.incoming
            .enter(change.rise, &mut amplitudes[outer.inflow() * m..][..m], &mut 0.0);
        self.outer_tangent(ahead, solution, change.speed, amplitudes, scratch);
        self.enter_window(&amplitudes[outer.outflow() * m..][..m], &mut tangent.window);
        if change.speed != 0.0 {
            self.speed_sources(solution, change.speed, scratch);
        }
        self.window_tangent(change.speed, false, tangent, scratch);
    }

    /// The change of [`StripHeatMarch::heat`].
    ///
    /// # Errors
    /// None.
    pub fn heat_tangent(
        &self,
        solution: &StripTemperature,
        change: &StripHeatChange,
        tangent: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) -> Result<()> {
        let response = scratch.responses.surface[0];
        self.respond(tangent, scratch, |place, _, unheated, _| {
            let exchange = &change.exchange[place];
            if exchange.is_open() {
                return Ok(0.0);
            }
            Ok(self.surface.flux_tangent(
                exchange,
                &change.exchange_tangent[place],
                &change.common,
                solution.surface[place],
                SurfaceRise { unheated, response },
            ))
        })
    }

    /// The change of [`StripHeatMarch::finalise`].
    pub fn finalise_tangent(
        &self,
        solution: &StripTemperature,
        change: &CarriageChange,
        tangent: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) {
        let m = self.basis.len();
        self.window_tangent(change.speed, true, tangent, scratch);
        let (_, behind) = self.strips.ends(self.speed);
        let inflow = self.strips.outer(behind, self.speed).inflow();
        let leaving = self.strips.window(self.speed).outflow();
        let breadth = solution.breadth;
        let widening = -change.breadth * self.strips.breadth / (breadth * breadth);
        for mode in 0..m {
            let change = |strip| tangent.window[self.place(strip, leaving, mode)];
            let value = |strip| solution.window[self.place(strip, leaving, mode)];
            tangent.outer[behind as usize][inflow * m + mode] =
                self.strips.mean(breadth, change) + widening * self.strips.excess(value);
        }
        self.outer_tangent(
            behind,
            solution,
            change.speed,
            &mut tangent.outer[behind as usize],
            scratch,
        );
        tangent.breadth = change.breadth;
    }

    /// Computes the sources that the change of |V| adds to the amplitudes of the strips, into `scratch`.
    fn speed_sources(&self, solution: &StripTemperature, speed: f64, scratch: &mut StripHeatScratch) {
        let (m, order) = (self.basis.len(), self.order());
        let cells = self.strips.cells;
        let crossing = Crossing {
            rate: f64::NAN,
            storage: 1.0 / self.duration,
            spacing: self.strips.spacing(),
            speed: self.speed.abs(),
        };
        for block in 0..self.strips.blocks() {
            let (own, columns) = (order.amplitudes(block, m), order.columns(block));
            let flux = &mut scratch.flux[columns];
            for lane in 0..LANES.min(self.strips.strips.saturating_sub(block * LANES)) {
                let strip = &solution.flux[(block * LANES + lane) * cells..][..cells];
                for (flux, solved) in flux[1..].iter_mut().zip(strip) {
                    flux[lane] = *solved;
                }
            }
            let solved = SolvedStrips {
                amplitudes: &solution.window[own.clone()],
                replaced: &solution.replaced[block * m * LANES..][..m * LANES],
                flux,
                crossing,
            };
            solved.speed_sources(
                order,
                &scratch.modes,
                speed,
                &mut scratch.old,
                &mut scratch.sources[own],
            );
        }
    }

    /// The strips under a change of |V| and of their flux, by that in `scratch`, or without flux, for surface temperature and heat
    /// content.
    fn window_tangent(
        &self,
        speed: f64,
        with_flux: bool,
        tangent: &mut StripTemperature,
        scratch: &mut StripHeatScratch,
    ) {
        let (m, order) = (self.basis.len(), self.order());
        if !with_flux {
            scratch.flux.fill([0.0; LANES]);
        }
        dense::vectorised(
            #[inline(always)]
            |fma| {
                for block in 0..self.strips.blocks() {
                    let (own, columns) = (order.amplitudes(block, m), order.columns(block));
                    let sources = (speed != 0.0).then_some(&scratch.sources[own.clone()]);
                    let unheated = ColumnSums {
                        surface: &mut scratch.unheated[columns.clone()],
                        content: &mut scratch.unheated_content[columns.clone()],
                    };
                    kernels::tangent(
                        fma,
                        order,
                        &scratch.modes,
                        sources,
                        &scratch.flux[columns],
                        &mut tangent.window[own],
                        (!with_flux).then_some(unheated),
                    );
                }
            },
        );
    }

    /// The columns on one side, where the change of what enters stands in their inflow column.
    fn outer_tangent(
        &self,
        side: Side,
        solution: &StripTemperature,
        speed: f64,
        tangent: &mut [f64],
        scratch: &mut StripHeatScratch,
    ) {
        let m = self.basis.len();
        let (ahead, _) = self.strips.ends(self.speed);
        let outer = &solution.outer[side as usize];
        let held = &mut scratch.outer[..outer.len()];
        held.copy_from_slice(outer);
        // The surface temperature acts where there is an exchange.
        let (surface, surface_change) = scratch.outer_surface.split_at_mut(outer.len() / m);
        let solved = Heated {
            amplitudes: held,
            surface,
            flux: &mut [],
        };
        let replaced = &solution.replaced[self.strips.blocks() * m * LANES..];
        let change = MarchChange {
            speed,
            common: CommonChange {
                ambient: 0.0,
                friction_scale: 0.0,
            },
            exchange: &[],
            exchange_tangent: &[],
            replaced_inflow: &replaced[if side == ahead { 0 } else { m }..][..m],
        };
        let mut changed = Heated {
            amplitudes: tangent,
            surface: surface_change,
            flux: &mut [],
        };
        self.outer_march(side)
            .advance_tangent(&solved, &change, &mut changed, &mut scratch.outer_cells[side as usize]);
    }
}
