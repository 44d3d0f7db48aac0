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
    /// [`crate::error::Error::SurfaceHeatNotConverged`].
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
            // Nothing heats this column and nothing warm is carried into it.
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::FrictionState;
    use crate::friction::coulomb::Sliding;
    use crate::heat::surface::ExchangeChange;
    use crate::parameters::{FrictionLaw, Parameters};
    use crate::settings::HeatSettings;

    /// Columns that widen to both sides, the five in the middle in contact.
    const X: [f64; 9] = [-0.1, -0.01, -0.004, -0.002, 0.0, 0.002, 0.004, 0.01, 0.1];
    const FIRST: usize = 2;
    const NODES: usize = 5;

    struct Field {
        temperature: Vec<f64>,
        surface: Vec<f64>,
        flux: Vec<f64>,
    }

    impl Field {
        fn new(modes: usize) -> Field {
            Field {
                temperature: vec![0.0; X.len() * modes],
                surface: vec![0.0; X.len()],
                flux: vec![0.0; NODES],
            }
        }

        fn heated(&mut self) -> Heated<'_> {
            Heated {
                temperature: &mut self.temperature,
                surface: &mut self.surface,
                flux: &mut self.flux,
            }
        }
    }

    fn parameters() -> Parameters {
        Parameters {
            // A law without corners.
            friction_law: FrictionLaw::Table,
            friction_table_points: 2,
            friction_table_temperature: std::array::from_fn(|i| 200.0 + 4000.0 * i as f64),
            contact_thermal_resistance: 100.0,
            wear_coefficient: 1e-11,
            ..Parameters::default()
        }
    }

    /// Speed, ambient, friction scale, pressure, slip speed, wheel and what comes in all change at once.
    #[test]
    fn the_tangent_is_the_derivative() {
        let parameters = parameters();
        let depth: Vec<f64> = (0..12).map(|row| 1e-5 * (1.8_f64.powi(row) - 1.0)).collect();
        let basis = DepthBasis::new(&depth).unwrap();
        let m = basis.len();
        let before: Vec<f64> = (0..X.len() * m).map(|k| 0.02 / (1.0 + (k % m) as f64)).collect();
        let entering = |h: f64| 10.0 + 3.0 * h;
        for direction in [1.0, -1.0] {
            let march = |h: f64| HeatMarch {
                basis: &basis,
                transport: Upwind::new(&X, direction * (10.0 + 0.7 * h)),
                first_contact: FIRST,
                duration: 1e-3,
                surface: SurfaceCondition {
                    friction: FrictionState {
                        parameters: &parameters,
                        ambient: 293.0 + 5.0 * h,
                        scale: 0.9 + 0.1 * h,
                    },
                    settings: HeatSettings::default(),
                },
            };
            let pressure = |node: usize, h: f64| 1e9 * (1.0 + 0.1 * node as f64) + h * 1e8;
            let sliding = |node: usize, h: f64| Sliding {
                speed: 0.1 + 0.02 * node as f64 + h * 0.01,
                power: 0.09 + 0.02 * node as f64 + h * 0.012,
            };
            let exchange = |h: f64| -> Vec<SurfaceExchange> {
                (0..NODES)
                    .map(|node| SurfaceExchange::new(&parameters, pressure(node, h), sliding(node, h), 20.0 + 4.0 * h))
                    .collect()
            };
            let enter = |field: &mut Field, rise: f64, inflow: usize| {
                field.temperature[inflow * m..(inflow + 1) * m].fill(rise);
            };
            let solve = |h: f64| {
                let march = march(h);
                let mut after = Field::new(m);
                enter(&mut after, entering(h), march.transport.inflow());
                march
                    .advance(&before, &exchange(h), &mut after.heated(), &mut vec![0.0; 3 * m])
                    .unwrap();
                after
            };
            let mut solution = solve(0.0);
            let exchange_tangent: Vec<ExchangeTangent> = (0..NODES)
                .map(|node| {
                    let change = ExchangeChange {
                        pressure: 1e8,
                        sliding: Sliding {
                            speed: 0.01,
                            power: 0.012,
                        },
                        wheel_rise: 4.0,
                    };
                    SurfaceExchange::tangent(&parameters, pressure(node, 0.0), sliding(node, 0.0), 20.0, &change)
                })
                .collect();
            let mut tangent = Field::new(m);
            enter(&mut tangent, 3.0, march(0.0).transport.inflow());
            let change = MarchChange {
                speed: 0.7,
                common: CommonChange {
                    ambient: 5.0,
                    friction_scale: 0.1,
                },
                exchange: &exchange(0.0),
                exchange_tangent: &exchange_tangent,
            };
            march(0.0).advance_tangent(&solution.heated(), &change, &mut tangent.heated());
            let h = 1e-5;
            let (ahead, behind) = (solve(h), solve(-h));
            let outflow = march(0.0).transport.outflow();
            for (name, exact, ahead, behind) in [
                (
                    "temperature",
                    &tangent.temperature,
                    &ahead.temperature,
                    &behind.temperature,
                ),
                ("surface", &tangent.surface, &ahead.surface, &behind.surface),
                ("flux", &tangent.flux, &ahead.flux, &behind.flux),
            ] {
                let size = dense::largest(exact);
                for (k, exact) in exact.iter().enumerate() {
                    let difference = (ahead[k] - behind[k]) / (2.0 * h);
                    // Truncation h², round-off and the tolerance of the surface condition over h.
                    assert!(
                        (exact - difference).abs() < 1e-6 * size,
                        "{name} {k}: {exact} {difference}"
                    );
                }
                assert!(size > 0.0);
            }
            assert!(tangent.surface[outflow] != 0.0);
        }
    }
}
