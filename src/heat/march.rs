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
    pub temperature: &'a mut [f64],
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
            let (own, upstream) = split_columns(after.temperature, column.index, column.upstream, m);
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
                    self.surface.flux(exchange, rise, f64::INFINITY, position)?
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
        let mut old = change.replaced_inflow.to_vec();
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
                    value: [solution.temperature[upstream], solution.temperature[own]],
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
                tangent.temperature[own] = step.advected * tangent.temperature[upstream]
                    + heat.upstream_response[mode] * upstream_flux
                    + change.speed * step.speed_tangent(&crossing, &ends);
                unheated += surface[mode] * tangent.temperature[own];
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
                &mut tangent.temperature[column.index * m..][..m],
            );
        }
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

    /// Speed, ambient, friction scale, pressure, slip speed, wheel and what comes in all change at once: at speed, so slow that
    /// no cell is crossed in a step, in the steady field, and at standstill, where the derivative is that to positive speeds.
    #[test]
    fn the_tangent_is_the_derivative() {
        let parameters = parameters();
        let depth: Vec<f64> = (0..12).map(|row| 1e-5 * (1.8_f64.powi(row) - 1.0)).collect();
        let basis = DepthBasis::new(&depth).unwrap();
        let m = basis.len();
        let before: Vec<f64> = (0..X.len() * m)
            .map(|k| 0.02 * (1.0 + 0.3 * ((k / m) as f64).sin()) / (1.0 + (k % m) as f64))
            .collect();
        let entering = |h: f64| 10.0 + 3.0 * h;
        for (start, duration) in [
            (10.0, 1e-3),
            (-10.0, 1e-3),
            (0.1, 1e-3),
            (10.0, f64::INFINITY),
            (0.0, 1e-3),
        ] {
            let direction = 1.0_f64.copysign(start);
            let march = |h: f64| HeatMarch {
                basis: &basis,
                transport: Upwind::new(&X, start + direction * 0.7 * h),
                first_contact: FIRST,
                duration,
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
                    .advance(
                        &before,
                        &exchange(h),
                        &mut after.heated(),
                        &mut CellFactors::new(&basis, &X),
                    )
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
                        coefficient: 0.0,
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
                replaced_inflow: &before[march(0.0).transport.inflow() * m..][..m],
            };
            let mut cells = CellFactors::new(&basis, &X);
            march(0.0).advance_tangent(&solution.heated(), &change, &mut tangent.heated(), &mut cells);
            // At standstill the slowest mode decays over a cell even at the speed of 0.7 h.
            let still = start == 0.0;
            let h = if still { 1e-7 } else { 1e-5 };
            let (ahead, behind) = (solve(h), solve(if still { 0.0 } else { -h }));
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
                    let difference = (ahead[k] - behind[k]) / if still { h } else { 2.0 * h };
                    // Truncation h², round-off and the tolerance of the surface condition over h; at standstill, h.
                    let tolerance = if still { 1e-4 } else { 1e-6 };
                    assert!(
                        (exact - difference).abs() < tolerance * size,
                        "{start} {duration} {name} {k}: {exact} {difference} of {size}"
                    );
                }
                assert!(size > 0.0);
            }
            assert!(still || tangent.surface[outflow] != 0.0);
        }
    }
}
