//! The derivative of the flux against dual numbers: the condition (23) as the heading of [`super`] has it, solved by one Newton step in
//! dual numbers from the solution, which gives its derivative by any argument.

use super::tests::condition;
use super::*;
use crate::friction::duals::{coefficient_at, lesser, with_table};
use crate::parameters::FrictionLaw;
use num_dual::Dual64;
use proptest::prelude::*;

/// Everything that the condition depends on.
struct Column {
    pressure: Dual64,
    /// |s|, and φ s.
    speed: Dual64,
    power: Dual64,
    wheel_rise: Dual64,
    /// θ without the flux.
    unheated: Dual64,
    /// θ by the flux.
    response: f64,
    ambient: Dual64,
    scale: Dual64,
    /// μ of the point is `base` + `share` μ(θ), but no more than the layer's, `layer_bound`, where there is one.
    base: Dual64,
    share: f64,
    layer_bound: Dual64,
}

impl Column {
    /// q = ᾱ [μ(θ) p φ s − k ρ c_p |s| p θ − (θ − θ_w) p/r] at a rise θ of the rail's surface.
    fn flux(&self, parameters: &Parameters, rise: Dual64) -> Dual64 {
        let of_temperature = coefficient_at(parameters, self.ambient + rise) * self.scale;
        let surfaces = self.base + of_temperature * self.share;
        let mu = if self.layer_bound.re > 0.0 {
            lesser(surfaces, self.layer_bound)
        } else {
            surfaces
        };
        let debris = self.speed
            * rise
            * self.pressure
            * (parameters.wear_coefficient * parameters.density * parameters.heat_capacity);
        let conducted = (rise - self.wheel_rise) * self.pressure / parameters.contact_thermal_resistance;
        (mu * self.pressure * self.power - debris - conducted) * parameters.heat_partition
    }

    /// q where θ = `unheated` + `response` q, next to a rise that solves it.
    fn solved(&self, parameters: &Parameters, rise: f64) -> Dual64 {
        let residual = |rise: Dual64| rise - self.unheated - self.flux(parameters, rise) * self.response;
        let fixed = Column {
            pressure: self.pressure.re.into(),
            speed: self.speed.re.into(),
            power: self.power.re.into(),
            wheel_rise: self.wheel_rise.re.into(),
            ambient: self.ambient.re.into(),
            scale: self.scale.re.into(),
            base: self.base.re.into(),
            layer_bound: self.layer_bound.re.into(),
            ..*self
        };
        let slope = 1.0 - fixed.flux(parameters, Dual64::new(rise, 1.0)).eps * self.response;
        self.flux(parameters, Dual64::from(rise) - residual(Dual64::from(rise)) / slope)
    }
}

proptest! {
    #[test]
    fn the_tangent_is_the_derivative_of_the_condition(
        pressure in 1e7..1e9,
        speed in 1e-3..1.0,
        power in 1e-3..1.0,
        wheel_rise in -20.0..200.0,
        unheated in 20.0..500.0,
        changes in prop::array::uniform8(-1.0..1.0_f64),
        law in prop::sample::select(FrictionLaw::ALL),
        layer_bound in prop_oneof![Just(0.0), 0.05..0.5_f64],
    ) {
        let parameters = Parameters {
            contact_thermal_resistance: 100.0,
            wear_coefficient: 1e-11,
            ..with_table(law)
        };
        let response = 1e-7;
        let [dp, ds, dq, dw, du, ambient, friction_scale, coefficient] = changes;
        let sliding = Sliding { speed, power };
        let change = ExchangeChange {
            pressure: 1e7 * dp,
            sliding: Sliding { speed: 1e-2 * ds, power: 1e-2 * dq },
            wheel_rise: dw,
            coefficient,
        };
        let condition = condition(&parameters);
        let mut exchange = SurfaceExchange::new(&parameters, pressure, sliding, wheel_rise);
        exchange.law = PointLaw { base: 0.05, share: 0.8, layer_bound };
        let flux = condition.flux(&exchange, SurfaceRise { unheated, response }, f64::INFINITY, 0.0).unwrap();
        let rise = unheated + response * flux;
        let column = Column {
            pressure: Dual64::new(pressure, change.pressure),
            speed: Dual64::new(speed, change.sliding.speed),
            power: Dual64::new(power, change.sliding.power),
            wheel_rise: Dual64::new(wheel_rise, dw),
            unheated: Dual64::new(unheated, du),
            response,
            ambient: Dual64::new(condition.friction.ambient, ambient),
            scale: Dual64::new(condition.friction.scale, friction_scale),
            base: Dual64::new(0.05, coefficient),
            share: 0.8,
            // dμ at an unchanged temperature, whatever bounds the friction.
            layer_bound: Dual64::new(layer_bound, coefficient),
        };
        let expected = column.solved(&parameters, rise);
        let tangent = SurfaceExchange::tangent(&parameters, pressure, sliding, wheel_rise, &change);
        let common = CommonChange { ambient, friction_scale };
        let exact = condition.flux_tangent(
            &exchange,
            &tangent,
            &common,
            rise,
            SurfaceRise {
                unheated: du,
                response,
            },
        );
        // Round-off of the terms, whose sum may be much smaller than they are.
        let size = pressure * (power + (rise.abs() + wheel_rise.abs()) / parameters.contact_thermal_resistance);
        prop_assert!((flux - expected.re).abs() < 1e-9 * size, "{flux} {expected}");
        prop_assert!((exact - expected.eps).abs() < 1e-9 * (exact.abs() + size), "{exact} {expected}");
    }
}
