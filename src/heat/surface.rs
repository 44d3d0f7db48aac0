//! The condition (23) at the surface of one column: what heats and cools it, and the flux that follows.

use crate::error::{Error, Result};
use crate::friction::coulomb::Sliding;
use crate::friction::{self, FrictionState, PointLaw};
use crate::parameters::Parameters;
use crate::settings::HeatSettings;

/// Heating and cooling of one column's surface at the rail temperature θ (rise): q = ᾱ [ μ(θ) P + S − H θ ], the
/// condition (23) with P = p φ s, S = θ_w p / r and H = k ρ c_p |s| p + p / r.
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
    /// Law of μ(θ) at the column's slip and history.
    pub law: PointLaw,
}

/// Change of pressure, slip speed and the wheel's temperature at one column.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExchangeChange {
    /// dp, `Pa`.
    pub pressure: f64,
    /// d|s| and d(φ s), `m/s`.
    pub sliding: Sliding,
    /// dθ_w, `K`.
    pub wheel_rise: f64,
    /// dμ at an unchanged temperature.
    pub coefficient: f64,
}

/// Change of a [`SurfaceExchange`].
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ExchangeTangent {
    /// dP, `W/m²`.
    pub friction: f64,
    /// Change of k ρ c_p |s| p, `W/(m² K)`.
    pub debris: f64,
    /// Change of p / r, `W/(m² K)`.
    pub conduction: f64,
    /// The two parts of dS: by the conduction, and by the wheel's temperature, `W/m²`.
    pub wheel: [f64; 2],
    /// dμ at an unchanged temperature.
    pub coefficient: f64,
}

impl SurfaceExchange {
    /// The exchange under pressure `pressure` `Pa` and sliding with a wheel at `wheel_rise` `K` over the ambient. Friction depends on the
    /// temperature alone, unless its law is replaced.
    pub fn new(parameters: &Parameters, pressure: f64, sliding: Sliding, wheel_rise: f64) -> SurfaceExchange {
        if pressure == 0.0 {
            return SurfaceExchange::default();
        }
        let conduction = pressure / parameters.contact_thermal_resistance;
        SurfaceExchange {
            friction: pressure * sliding.power,
            debris: parameters.wear_coefficient * parameters.volumetric_heat_capacity() * sliding.speed * pressure,
            conduction,
            wheel: conduction * wheel_rise,
            law: PointLaw::default(),
        }
    }

    /// The change of [`SurfaceExchange::new`] with that of its arguments.
    pub fn tangent(
        parameters: &Parameters,
        pressure: f64,
        sliding: Sliding,
        wheel_rise: f64,
        change: &ExchangeChange,
    ) -> ExchangeTangent {
        let conduction = change.pressure / parameters.contact_thermal_resistance;
        ExchangeTangent {
            friction: change.pressure * sliding.power + pressure * change.sliding.power,
            debris: parameters.wear_coefficient
                * parameters.volumetric_heat_capacity()
                * (change.sliding.speed * pressure + sliding.speed * change.pressure),
            conduction,
            wheel: [
                conduction * wheel_rise,
                pressure / parameters.contact_thermal_resistance * change.wheel_rise,
            ],
            coefficient: change.coefficient,
        }
    }

    /// Whether the surface is free, so that no heat crosses it.
    pub fn is_open(&self) -> bool {
        self.conduction == 0.0 && self.friction == 0.0
    }

    /// Loss H per temperature rise, `W/(m² K)`.
    fn loss(&self) -> f64 {
        self.debris + self.conduction
    }
}

/// The condition (23) of the columns in one step.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceCondition<'a> {
    /// Friction law.
    pub friction: FrictionState<'a>,
    /// Limits.
    pub settings: HeatSettings,
}

/// Changes that all columns have in common.
#[derive(Debug, Clone, Copy)]
pub struct CommonChange {
    /// Change of the ambient temperature, `K`.
    pub ambient: f64,
    /// Change of the factor on μ.
    pub friction_scale: f64,
}

/// Temperature rise at a column's surface as a function of its own heat flux q: θ = `unheated` + `response` q.
#[derive(Debug, Clone, Copy)]
pub struct SurfaceRise {
    /// Rise without heat flux, or its change, `K`.
    pub unheated: f64,
    /// Rise per heat flux, `K/(W/m²)`.
    pub response: f64,
}

impl SurfaceCondition<'_> {
    /// The flux q into the rail that satisfies (23) at the surface temperature θ of a [`SurfaceRise`]: Newton with a bracket, from the `guess` of θ
    /// if that can be it, else from the hot end. `position` is that of the column, `m`, for the error.
    ///
    /// Friction that rises with temperature may have several solutions: from a guess it is one next to it.
    ///
    /// # Errors
    /// [`Error::SurfaceHeatNotConverged`].
    pub fn flux(&self, exchange: &SurfaceExchange, rise: SurfaceRise, guess: f64, position: f64) -> Result<f64> {
        let SurfaceRise { unheated, response } = rise;
        let parameters = self.friction.parameters;
        let gain = response * parameters.heat_partition;
        let loss = exchange.loss();
        let damping = 1.0 + gain * loss;
        let unheated = unheated + gain * exchange.wheel;
        // Without friction θ is unheated / damping, with the largest μ it is the upper end.
        let largest = exchange
            .law
            .of((self.friction.scale * friction::largest_coefficient(parameters), 0.0))
            .0;
        let mut low = unheated / damping;
        let mut high = low + gain * largest * exchange.friction / damping;
        let tolerance = self.settings.surface_tolerance * (low.abs() + high.abs() + 1.0);
        let mut theta = if low < guess && guess < high { guess } else { high };
        let mut residual = f64::INFINITY;
        for _ in 0..self.settings.surface_newton_steps {
            let (mu, slope) = exchange.law.of(self.friction.coefficient(theta));
            residual = damping * theta - unheated - gain * mu * exchange.friction;
            if residual.abs() <= tolerance * damping || high - low <= tolerance {
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
            position,
            iterations: self.settings.surface_newton_steps,
            residual,
        })
    }

    /// The change of [`SurfaceCondition::flux`] at its solution with surface temperature `rise`, `K`, where `change` holds
    /// the change of the temperature at an unchanged flux.
    pub fn flux_tangent(
        &self,
        exchange: &SurfaceExchange,
        tangent: &ExchangeTangent,
        common: &CommonChange,
        rise: f64,
        change: SurfaceRise,
    ) -> f64 {
        let SurfaceRise { unheated, response } = change;
        let parameters = self.friction.parameters;
        let (mu, slope) = exchange.law.of(self.friction.coefficient(rise));
        let by_scale = friction::coefficient(parameters, self.friction.ambient + rise).0;
        let share = exchange.law.share_at(self.friction.scale * by_scale);
        let scale = share * common.friction_scale * by_scale + tangent.coefficient;
        let loss = exchange.loss();
        let partition = parameters.heat_partition;
        let source =
            slope * (unheated + common.ambient) * exchange.friction + scale * exchange.friction + mu * tangent.friction
                - (tangent.debris + tangent.conduction) * rise
                - loss * unheated
                + tangent.wheel[0]
                + tangent.wheel[1];
        partition * source / (1.0 - partition * response * (slope * exchange.friction - loss))
    }
}

#[cfg(test)]
mod duals;
#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    pub fn condition(parameters: &Parameters) -> SurfaceCondition<'_> {
        SurfaceCondition {
            friction: FrictionState {
                parameters,
                ambient: 293.15,
                scale: 0.9,
            },
            settings: HeatSettings::default(),
        }
    }

    fn parameters(resistance: f64) -> Parameters {
        Parameters {
            contact_thermal_resistance: resistance,
            wear_coefficient: 1e-11,
            ..Parameters::default()
        }
    }

    proptest! {
        #[test]
        fn the_flux_satisfies_the_condition(
            pressure in 1e7..1e9,
            speed in 0.0..1.0_f64,
            utilisation in 0.0..1.0_f64,
            wheel_rise in -20.0..200.0,
            unheated in -5.0..150.0,
            response in 1e-8..1e-6,
            log_resistance in 1.0..4.0,
        ) {
            let parameters = parameters(10.0_f64.powf(log_resistance));
            let condition = condition(&parameters);
            let exchange = SurfaceExchange::new(&parameters, pressure, Sliding::new(-speed, -utilisation), wheel_rise);
            let flux = condition.flux(&exchange, SurfaceRise { unheated, response }, f64::INFINITY, 0.0).unwrap();
            // (23), written out.
            let rise = unheated + response * flux;
            let mu = 0.9 * friction::coefficient(&parameters, 293.15 + rise).0;
            let power = mu * pressure * utilisation * speed;
            let debris = parameters.wear_coefficient * 7.8e3 * 460.0 * rise * speed * pressure;
            let conducted = (rise - wheel_rise) * pressure / parameters.contact_thermal_resistance;
            let expected = 0.5 * (power - debris - conducted);
            let size = 0.5 * (power + debris.abs() + (rise.abs() + wheel_rise.abs()) * pressure / parameters.contact_thermal_resistance);
            prop_assert!((flux - expected).abs() <= 1e-10 * size, "{flux} {expected}");
        }
    }

    #[test]
    fn a_limit_of_no_steps_is_an_error() {
        let parameters = Parameters::default();
        let mut condition = condition(&parameters);
        condition.settings.surface_newton_steps = 0;
        let exchange = SurfaceExchange::new(&parameters, 1e9, Sliding::new(0.1, 1.0), 0.0);
        assert!(matches!(
            condition.flux(&exchange, SurfaceRise { unheated: 0.0, response: 1e-7 }, f64::INFINITY, 1.5e-3),
            Err(Error::SurfaceHeatNotConverged { position, iterations: 0, .. }) if position == 1.5e-3
        ));
    }
}
