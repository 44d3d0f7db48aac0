//! The temperature field (19), (23): transient, carried through the columns of the mesh, conducted in depth.
//!
//! Per column, P1 in depth with consistent mass M and stiffness K:
//! M (θ − θⁿ)/Δt + |V|/Δx M (θ − θ_upstream) + κ K θ = e_surface q/(ρ c_p), θ = 0 at the bottom.
//! In the eigenbasis K φ = λ M φ, φᵀ M φ = 1, a column is a set of independent scalars
//! a = (aⁿ/Δt + |V|/Δx a_upstream + φ(0) q/(ρ c_p)) / (1/Δt + |V|/Δx + κ λ), so its surface temperature is linear in
//! the surface flux q, and the surface condition (23) is one scalar equation a column.

use super::basis::DepthBasis;
use super::surface::{CommonChange, ExchangeTangent, SurfaceCondition, SurfaceExchange};
use crate::error::Result;
use crate::numerics::dense::{self, Arithmetic, LANES};
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
    /// Of |V|, `m/s`.
    pub speed: f64,
    /// What all columns have in common.
    pub common: CommonChange,
    /// The exchange at the contact nodes, not changed.
    pub exchange: &'a [SurfaceExchange],
    /// Its change.
    pub exchange_tangent: &'a [ExchangeTangent],
}

/// A temperature field, or a change of one, and the flux that goes with it.
pub struct Heated<'a> {
    /// Modal amplitudes, columns × modes, column by column.
    pub temperature: &'a mut [f64],
    /// Temperature rise at the surface of the columns, `K`.
    pub surface: &'a mut [f64],
    /// Heat flux into the rail at the contact nodes, `W/m²`.
    pub flux: &'a mut [f64],
}

impl HeatMarch<'_> {
    /// Values that [`HeatMarch::advance`] needs: three factors a mode.
    pub fn scratch_len(basis: &DepthBasis) -> usize {
        3 * basis.len()
    }

    /// From the modal amplitudes `before` to the field `after` under the exchange at the contact nodes. The inflow column
    /// of `after` holds what enters. `scratch` holds [`HeatMarch::scratch_len`] values.
    ///
    /// # Errors
    /// [`Error::SurfaceHeatNotConverged`].
    pub fn advance(
        &self,
        before: &[f64],
        exchange: &[SurfaceExchange],
        after: &mut Heated,
        scratch: &mut [f64],
    ) -> Result<()> {
        dense::vectorised(
            #[inline(always)]
            |arithmetic| self.advance_kernel(arithmetic, before, exchange, after, scratch),
        )
    }

    #[inline(always)]
    fn advance_kernel(
        &self,
        arithmetic: Arithmetic,
        before: &[f64],
        exchange: &[SurfaceExchange],
        after: &mut Heated,
        scratch: &mut [f64],
    ) -> Result<()> {
        let parameters = self.surface.friction.parameters;
        let (m, capacity) = (self.basis.len(), parameters.volumetric_heat_capacity());
        let storage = 1.0 / self.duration;
        let (surface, eigenvalues) = (&self.basis.surface[..m], &self.basis.eigenvalues[..m]);
        // What a mode keeps of the step before and of upstream, and what it takes of the heat.
        let (keep, scratch) = scratch.split_at_mut(m);
        let (carry, scratch) = scratch.split_at_mut(m);
        let take = &mut scratch[..m];
        let mut spacing = f64::NAN;
        let mut response = 0.0;
        for column in self.transport.columns() {
            let advection = self.transport.speed() / column.spacing;
            let (own, upstream) = split_columns(after.temperature, column.index, column.upstream, m);
            let old = &before[column.index * m..][..m];
            let contact = column.index.wrapping_sub(self.first_contact);
            let heating = exchange.get(contact).filter(|exchange| !exchange.is_open());
            // Rail that has not been heated since it entered.
            if heating.is_none() && old[0] == 0.0 && upstream[0] == 0.0 {
                own.fill(0.0);
                after.surface[column.index] = 0.0;
                if let Some(flux) = after.flux.get_mut(contact) {
                    *flux = 0.0;
                }
                continue;
            }
            // The factors are those of the last column where the spacing is the same (all over the window).
            if (column.spacing - spacing).abs() > 1e-9 * column.spacing || spacing.is_nan() {
                spacing = column.spacing;
                for mode in 0..m {
                    let rate = storage + advection + parameters.thermal_diffusivity * eigenvalues[mode];
                    let inverse = 1.0 / rate;
                    keep[mode] = storage * inverse;
                    carry[mode] = advection * inverse;
                    take[mode] = surface[mode] * inverse / capacity;
                }
                response = arithmetic.dot(surface, take);
            }
            let unheated = carry_over(arithmetic, own, (keep, old), (carry, upstream), surface);
            after.surface[column.index] = unheated;
            let Some(exchange) = heating else {
                if let Some(flux) = after.flux.get_mut(contact) {
                    *flux = 0.0;
                }
                continue;
            };
            let q = self
                .surface
                .flux(exchange, unheated, response, self.transport.position(column.index))?;
            after.flux[contact] = q;
            after.surface[column.index] += response * q;
            for mode in 0..m {
                own[mode] = arithmetic.multiply_add(q, take[mode], own[mode]);
            }
        }
        Ok(())
    }

    /// The change of [`HeatMarch::advance`]'s result `solution` with its data. The inflow column of `tangent` holds the
    /// change of what enters.
    pub fn advance_tangent(&self, solution: &Heated, change: &MarchChange, tangent: &mut Heated) {
        let (parameters, basis) = (self.surface.friction.parameters, self.basis);
        let (m, capacity) = (basis.len(), parameters.volumetric_heat_capacity());
        let storage = 1.0 / self.duration;
        for column in self.transport.columns() {
            let advection = self.transport.speed() / column.spacing;
            let advection_change = change.speed / column.spacing;
            let inverse =
                |mode: usize| 1.0 / (storage + advection + parameters.thermal_diffusivity * basis.eigenvalues[mode]);
            let (mut response, mut unheated) = (0.0, 0.0);
            for mode in 0..m {
                let inverse = inverse(mode);
                let (own, upstream) = (column.index * m + mode, column.upstream * m + mode);
                let carried = advection_change * (solution.temperature[upstream] - solution.temperature[own]);
                tangent.temperature[own] = (advection * tangent.temperature[upstream] + carried) * inverse;
                unheated += basis.surface[mode] * tangent.temperature[own];
                response += basis.surface[mode] * basis.surface[mode] * inverse / capacity;
            }
            let node = column.index.wrapping_sub(self.first_contact);
            tangent.surface[column.index] = unheated;
            let Some(exchange) = change.exchange.get(node) else {
                continue;
            };
            if exchange.is_open() {
                tangent.flux[node] = 0.0;
                continue;
            }
            let rise = solution.surface[column.index];
            let flux = self.surface.flux_tangent(
                exchange,
                &change.exchange_tangent[node],
                &change.common,
                (rise, unheated, response),
            );
            tangent.flux[node] = flux;
            tangent.surface[column.index] += response * flux;
            for mode in 0..m {
                tangent.temperature[column.index * m + mode] += flux / capacity * basis.surface[mode] * inverse(mode);
            }
        }
    }
}

/// own = keep · old + carry · upstream, and the surface value of it: as [`Arithmetic::dot`], in the same pass.
#[inline(always)]
fn carry_over(
    arithmetic: Arithmetic,
    own: &mut [f64],
    (keep, old): (&[f64], &[f64]),
    (carry, upstream): (&[f64], &[f64]),
    surface: &[f64],
) -> f64 {
    let mut sums = [0.0; LANES];
    let (blocks, rest) = own.as_chunks_mut::<LANES>();
    let whole = LANES * blocks.len();
    let inputs = keep.as_chunks::<LANES>().0.iter().zip(old.as_chunks::<LANES>().0);
    let inputs = inputs.zip(carry.as_chunks::<LANES>().0.iter().zip(upstream.as_chunks::<LANES>().0));
    for ((own, ((keep, old), (carry, upstream))), surface) in
        blocks.iter_mut().zip(inputs).zip(surface.as_chunks::<LANES>().0)
    {
        // All values are loaded before one is stored: otherwise the compiler must assume that the slices overlap, and does
        // not vectorise.
        let mut values = [0.0; LANES];
        for lane in 0..LANES {
            values[lane] = arithmetic.multiply_add(keep[lane], old[lane], carry[lane] * upstream[lane]);
        }
        *own = values;
        for lane in 0..LANES {
            sums[lane] = arithmetic.multiply_add(values[lane], surface[lane], sums[lane]);
        }
    }
    let mut tail = 0.0;
    for (own, mode) in rest.iter_mut().zip(whole..) {
        *own = keep[mode] * old[mode] + carry[mode] * upstream[mode];
        tail += *own * surface[mode];
    }
    tail + sums.iter().sum::<f64>()
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
