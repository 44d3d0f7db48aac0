//! The temperature field (19), (23): transient, carried through the columns of the mesh, conducted in depth.
//!
//! Per column, P1 in depth with consistent mass M and stiffness K:
//! M (θ − θⁿ)/Δt + |V|/Δx M (θ − θ_upstream) + κ K θ = e_surface q/(ρ c_p), θ = 0 at the bottom.
//! In the eigenbasis K φ = λ M φ, φᵀ M φ = 1, a column is a set of independent scalars
//! a = (aⁿ/Δt + |V|/Δx a_upstream + φ(0) q/(ρ c_p)) / (1/Δt + |V|/Δx + κ λ), so its surface temperature is linear in
//! the surface flux q, and the surface condition (23) is one scalar equation a column.

use super::basis::DepthBasis;
use crate::error::{Error, Result};
use crate::friction::{self, FrictionState, coulomb};
use crate::injection::{self, Solver};
use crate::numerics::dense::{self, Arithmetic, LANES};
use crate::parameters::Parameters;
use crate::transport::Upwind;

/// What heats and cools one column's surface, at the rail temperature θ (rise):
/// q = ᾱ [ μ(θ) P + S − H θ ], the condition (23) with P = p |φ(s) s|, S = θ_w p / r and H = k ρ c_p |s| p + p / r.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SurfaceExchange {
    /// P: friction power per area and friction coefficient, `W/m²`.
    pub friction: f64,
    /// k ρ c_p |s| p: heat carried off by debris per kelvin, `W/(m² K)`.
    pub debris: f64,
    /// p / r: heat conducted into the wheel per kelvin, `W/(m² K)`.
    pub conduction: f64,
    /// S: heat conducted from a wheel at θ_w into rail at ambient, `W/m²`.
    pub wheel: f64,
}

impl SurfaceExchange {
    /// The exchange under pressure `pressure` `Pa` and slip velocity `slip` `m/s` with a wheel at `wheel_rise` `K` over the
    /// ambient.
    pub fn new(parameters: &Parameters, pressure: f64, slip: f64, wheel_rise: f64) -> SurfaceExchange {
        if pressure == 0.0 {
            return SurfaceExchange::default();
        }
        let saturation = coulomb::saturation(slip, parameters.slip_regularisation);
        let conduction = pressure / parameters.contact_thermal_resistance;
        SurfaceExchange {
            friction: pressure * (saturation * slip).abs(),
            debris: parameters.wear_coefficient * parameters.volumetric_heat_capacity() * slip.abs() * pressure,
            conduction,
            wheel: conduction * wheel_rise,
        }
    }

    /// Whether the surface is free, so that no heat crosses it.
    fn is_open(&self) -> bool {
        self.conduction == 0.0 && self.friction == 0.0
    }
}

/// Limit of the Newton steps of one column's surface condition.
const NEWTON_STEPS: usize = 60;

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
    /// Friction law.
    pub friction: FrictionState<'a>,
}

/// What the march computes.
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
        let parameters = self.friction.parameters;
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
            let q = self.surface_flux(exchange, unheated, response, column.index)?;
            after.flux[contact] = q;
            after.surface[column.index] += response * q;
            for mode in 0..m {
                own[mode] = arithmetic.multiply_add(q, take[mode], own[mode]);
            }
        }
        Ok(())
    }

    /// The flux q that satisfies (23) where θ = `unheated` + `response` q: Newton with a bracket.
    fn surface_flux(&self, exchange: &SurfaceExchange, unheated: f64, response: f64, column: usize) -> Result<f64> {
        let parameters = self.friction.parameters;
        let gain = response * parameters.heat_partition;
        let loss = exchange.debris + exchange.conduction;
        let damping = 1.0 + gain * loss;
        let unheated = unheated + gain * exchange.wheel;
        // Without friction θ is unheated / damping, with the largest μ it is the upper end.
        let largest = self.friction.scale * friction::largest_coefficient(parameters);
        let mut low = unheated / damping;
        let mut high = low + gain * largest * exchange.friction / damping;
        let tolerance = 1e-14 * (low.abs() + high.abs() + 1.0);
        let mut theta = high;
        let mut residual = 0.0;
        for _ in 0..NEWTON_STEPS {
            let (mu, slope) = self.friction.coefficient(theta);
            residual = damping * theta - unheated - gain * mu * exchange.friction;
            if residual.abs() <= tolerance * damping || high - low <= tolerance {
                injection::passes(Solver::SurfaceHeat)?;
                return Ok(parameters.heat_partition * (mu * exchange.friction + exchange.wheel - loss * theta));
            }
            if residual > 0.0 {
                high = theta;
            } else {
                low = theta;
            }
            let newton = theta - residual / (damping - gain * slope * exchange.friction);
            theta = if newton > low && newton < high {
                newton
            } else {
                0.5 * (low + high)
            };
        }
        Err(Error::SurfaceHeatNotConverged {
            position: self.transport.position(column),
            iterations: NEWTON_STEPS,
            residual,
        })
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
        // All are loaded before one is stored, or the compiler would fear that they overlap.
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
