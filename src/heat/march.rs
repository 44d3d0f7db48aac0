//! The temperature field (19), (23): transient, carried through the columns of the mesh, conducted in depth.
//!
//! P1 in depth with consistent mass M and stiffness K: M (∂θ/∂t − V ∂θ/∂x₁) + κ K θ = e_surface q/(ρ c_p), θ = 0 at the bottom.
//! In the eigenbasis K φ = λ M φ, φᵀ M φ = 1, a column is a set of independent scalars, carried from column to column by
//! [`super::step`]. The surface temperature of a column is so linear in its own surface flux q, and the surface condition (23) is
//! one scalar equation a column.

use super::basis::DepthBasis;
use super::factors::{CellFactors, Conditions, Sources};
use super::step::{Crossing, ModeEnds};
use super::surface::{CommonChange, ExchangeTangent, SurfaceCondition, SurfaceExchange, SurfaceRise};
use crate::error::Result;
use crate::numerics::dense::{self, MultiplyAdd};
use crate::transport::Upwind;

/// One implicit time step of the march.
pub struct HeatMarch<'a> {
    /// Eigenbasis of the depth operator.
    pub basis: &'a DepthBasis,
    /// Columns from inflow to outflow.
    pub transport: Upwind<'a>,
    /// First column of the contact window; the exchange slice starts there.
    pub first_contact: usize,
    /// Step Δt, `s`; infinite for the steady field.
    pub duration: f64,
    /// The surface condition.
    pub surface: SurfaceCondition<'a>,
}

/// Change of the data of one step, and the exchange of the step itself.
pub struct MarchChange<'a> {
    /// Change of |V|, `m/s`.
    pub speed: f64,
    /// Change of what all columns have in common.
    pub common: CommonChange,
    /// The exchange at the contact nodes, not changed.
    pub exchange: &'a [SurfaceExchange],
    /// Change of the exchange at the contact nodes.
    pub exchange_tangent: &'a [ExchangeTangent],
    /// Modal amplitudes that stood in the inflow column before the step, m.
    pub replaced_inflow: &'a [f64],
}

/// A temperature field, or a change of one, and the flux that goes with it.
pub struct Heated<'a> {
    /// Modal amplitudes, columns × modes, column by column.
    pub amplitudes: &'a mut [f64],
    /// Temperature rise at the surface of the columns, `K`.
    pub surface: &'a mut [f64],
    /// Heat flux into the rail at the contact nodes, `W/m²`.
    pub flux: &'a mut [f64],
}

impl HeatMarch<'_> {
    /// Advances the modal amplitudes `before` to the field `after` under the exchange at the contact nodes. The inflow
    /// column of `after` holds what enters. `cells` are the factors of the cells between the columns.
    ///
    /// # Errors
    /// [`crate::error::Error::SurfaceHeatNotConverged`].
    pub fn advance(
        &self,
        before: &[f64],
        exchange: &[SurfaceExchange],
        after: &mut Heated,
        cells: &mut CellFactors,
    ) -> Result<()> {
        dense::vectorised(
            #[inline(always)]
            |fma| self.advance_kernel(fma, before, exchange, after, cells),
        )
    }

    #[inline(always)]
    fn advance_kernel(
        &self,
        fma: MultiplyAdd,
        before: &[f64],
        exchange: &[SurfaceExchange],
        after: &mut Heated,
        cells: &mut CellFactors,
    ) -> Result<()> {
        let m = self.basis.len();
        let surface = &self.basis.surface[..m];
        cells.adapt(self.basis, self.conditions());
        // Flux of the column upstream: 0 at the inflow, which is no contact node.
        let mut upstream_flux = 0.0;
        for column in self.transport.columns() {
            let (own, upstream) = split_columns(after.amplitudes, column.index, column.upstream, m);
            let old = &before[column.index * m..][..m];
            let old_upstream = &before[column.upstream * m..][..m];
            let contact = column.index.wrapping_sub(self.first_contact);
            let heated = exchange.get(contact).filter(|exchange| !exchange.is_open());
            if heated.is_none() && upstream_flux == 0.0 {
                if let Some(flux) = after.flux.get_mut(contact) {
                    *flux = 0.0;
                }
                // Nothing heats this column, and nothing warm is in it or is carried into it.
                let warm = old[0] != 0.0 || old_upstream[0] != 0.0 || upstream[0] != 0.0;
                after.surface[column.index] = if warm {
                    let factors = cells.at(fma, cells.length_of(&column));
                    let sources = Sources {
                        upstream,
                        old_upstream,
                        old,
                        flux: None,
                    };
                    factors.advance(fma, own, &sources, surface)
                } else {
                    own.fill(0.0);
                    0.0
                };
                continue;
            }
            let (factors, heat) = cells.heated_at(fma, self.basis, cells.length_of(&column));
            let flux = Some((upstream_flux, heat.upstream_response));
            let sources = Sources {
                upstream,
                old_upstream,
                old,
                flux,
            };
            let unheated = factors.advance(fma, own, &sources, surface);
            upstream_flux = match heated {
                Some(exchange) => {
                    let position = self.transport.position(column.index);
                    let rise = SurfaceRise {
                        unheated,
                        response: heat.response,
                    };
                    self.surface
                        .flux(exchange, rise, after.surface[column.index], position)?
                }
                None => 0.0,
            };
            if let Some(flux) = after.flux.get_mut(contact) {
                *flux = upstream_flux;
            }
            after.surface[column.index] = unheated + heat.response * upstream_flux;
            fma.add_multiple(heat.diagonal_response, upstream_flux, own);
        }
        Ok(())
    }

    fn conditions(&self) -> Conditions {
        let parameters = self.surface.friction.parameters;
        Conditions {
            speed: self.transport.speed(),
            duration: self.duration,
            diffusivity: parameters.thermal_diffusivity,
            capacity: parameters.volumetric_heat_capacity(),
        }
    }

    /// The change of [`HeatMarch::advance`]'s result `solution` with its data. The inflow column of `tangent` holds the
    /// change of what enters.
    pub fn advance_tangent(
        &self,
        solution: &Heated,
        change: &MarchChange,
        tangent: &mut Heated,
        cells: &mut CellFactors,
    ) {
        // With the fma of the step: what is kept in the cells is the same to the last digit.
        dense::vectorised(
            #[inline(always)]
            |fma| self.advance_tangent_kernel(fma, solution, change, tangent, cells),
        );
    }

    #[inline(always)]
    fn advance_tangent_kernel(
        &self,
        fma: MultiplyAdd,
        solution: &Heated,
        change: &MarchChange,
        tangent: &mut Heated,
        cells: &mut CellFactors,
    ) {
        let (m, surface) = (self.basis.len(), &self.basis.surface);
        let diffusivity = self.surface.friction.parameters.thermal_diffusivity;
        cells.adapt(self.basis, self.conditions());
        // The amplitudes before the step follow from its result, column by column.
        let mut old = std::mem::take(&mut cells.old);
        old.copy_from_slice(change.replaced_inflow);
        let (mut heated_upstream, mut upstream_flux) = (0.0, 0.0);
        for column in self.transport.columns() {
            let length = cells.length_of(&column);
            let (factors, heat) = cells.heated_at(fma, self.basis, length);
            let node = column.index.wrapping_sub(self.first_contact);
            let heated = solution.flux.get(node).copied().unwrap_or(0.0);
            let mut unheated = 0.0;
            for mode in 0..m {
                let (own, upstream) = (column.index * m + mode, column.upstream * m + mode);
                let mut ends = ModeEnds {
                    value: [solution.amplitudes[upstream], solution.amplitudes[own]],
                    old: [old[mode], 0.0],
                    source: [
                        heat.source_per_flux[mode] * heated_upstream,
                        heat.source_per_flux[mode] * heated,
                    ],
                };
                let step = factors.step(mode);
                ends.old[1] = step.previous(&ends);
                old[mode] = ends.old[1];
                let crossing = Crossing {
                    rate: diffusivity * self.basis.eigenvalues[mode],
                    storage: 1.0 / self.duration,
                    spacing: column.spacing,
                    speed: self.transport.speed(),
                };
                tangent.amplitudes[own] = step.advected * tangent.amplitudes[upstream]
                    + heat.upstream_response[mode] * upstream_flux
                    + change.speed * step.speed_tangent(&crossing, &ends);
                unheated += surface[mode] * tangent.amplitudes[own];
            }
            heated_upstream = heated;
            tangent.surface[column.index] = unheated;
            upstream_flux = 0.0;
            let Some(exchange) = change.exchange.get(node) else {
                continue;
            };
            if !exchange.is_open() {
                upstream_flux = self.surface.flux_tangent(
                    exchange,
                    &change.exchange_tangent[node],
                    &change.common,
                    solution.surface[column.index],
                    SurfaceRise {
                        unheated,
                        response: heat.response,
                    },
                );
            }
            tangent.flux[node] = upstream_flux;
            tangent.surface[column.index] += heat.response * upstream_flux;
            fma.add_multiple(
                heat.diagonal_response,
                upstream_flux,
                &mut tangent.amplitudes[column.index * m..][..m],
            );
        }
        cells.old = old;
    }
}

/// Two different columns of a field, the first mutable.
fn split_columns(field: &mut [f64], own: usize, other: usize, m: usize) -> (&mut [f64], &[f64]) {
    if own < other {
        let (left, right) = field.split_at_mut(other * m);
        (&mut left[own * m..][..m], &right[..m])
    } else {
        let (left, right) = field.split_at_mut(own * m);
        (&mut right[..m], &left[other * m..][..m])
    }
}

#[cfg(test)]
mod tests;
