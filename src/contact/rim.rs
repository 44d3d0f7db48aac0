//! The wheel's rim: its temperature, which is θ_w of (23), and its wear.
//!
//! Heat. The active rim is a ring of outer radius r₀, depth d and width w at one temperature T_w, because a revolution
//! (0.3 s at 10 m/s) is short against the minutes over which the tread warms and the ring is thin against the way that
//! heat goes in that time (√(κ · 60 s) = 29 mm, the default depth). Its heat capacity is C = ρ_w c_w π d (2 r₀ − d) w;
//! tread and both flanks, A = 2π r₀ w + 2π d (2 r₀ − d), give heat to the ambient at T_a:
//!
//! C dT_w/dt = (1 − ᾱ) b ∫ |τ s| dx + ᾱ b ∫ (θ − θ_w) p/r dx − h A (T_w − T_a),  θ_w = T_w − T_a.
//!
//! The first two terms are what (23) leaves of the friction power and what it takes from the rail by conduction: the heat
//! of rail, rim and debris adds up to the friction work. One implicit Euler step of Δt, with G = ᾱ b ∫ p/r dx = ᾱ N/r,
//!
//! T_w = (C/Δt T_wⁿ + h A T_a + G T_a + (1 − ᾱ) b ∫ |τ s| + ᾱ b ∫ θ p/r) / (C/Δt + h A + G),
//!
//! is a weighted mean of the temperatures plus a heat: however small the ring and long the step, it does not overshoot. The
//! surface condition of the rail takes the same θ_w, that of the end of the step: a fixed point, whose slope is between 0 and 1
//! because either side moves by less than the other ([`FixedPoint`]).
//!
//! Neglected: conduction from the rim into the web, radiation, the wheel's own flash temperature in the contact, and
//! brake shoes.
//!
//! Wear. Archard's law on the tread, volume per time k_w ∫ |s| p dA; spread over the circumference, the radius loses
//! k_w ∫ |s| p dx / (2π r₀) per time on the contact's width b. A wheel that does not turn wears a flat instead, which a
//! uniform depth does not show. The loss, micrometres, is not fed back into r₀.

use crate::error::{Error, Result};
use crate::friction::coulomb;
use crate::parameters::{Parameters, WheelHeating};
use crate::settings::HeatSettings;
use std::f64::consts::PI;

/// Section of the ring times its circumference at the centroid, `m³`.
fn volume(parameters: &Parameters) -> f64 {
    face(parameters) * parameters.rim_width
}

/// One flank of the ring, π d (2 r₀ − d), `m²`.
fn face(parameters: &Parameters) -> f64 {
    PI * parameters.rim_depth * (2.0 * parameters.wheel_radius - parameters.rim_depth)
}

/// C, `J/K`.
pub fn heat_capacity(parameters: &Parameters) -> f64 {
    parameters.wheel_density * parameters.wheel_heat_capacity * volume(parameters)
}

/// h A, `W/K`.
pub fn convection(parameters: &Parameters) -> f64 {
    let tread = 2.0 * PI * parameters.wheel_radius * parameters.rim_width;
    parameters.wheel_heat_transfer * (tread + 2.0 * face(parameters))
}

/// Heat that the contact gives to the wheel, or a change of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ContactHeat {
    /// (1 − ᾱ) b ∫ |τ s| dx, `W`.
    pub friction: f64,
    /// ᾱ b ∫ θ p/r dx, `W`.
    pub conducted: f64,
    /// G = ᾱ b ∫ p/r dx, `W/K`.
    pub conductance: f64,
}

/// State of one surface node that heats the wheel, or a change of it. Tractions are scaled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatedNode {
    /// Pressure.
    pub pressure: f64,
    /// Shear traction along the rail and across it.
    pub shear: [f64; 2],
    /// Slip velocity along the rail and across it, `m/s`.
    pub slip: [f64; 2],
    /// Temperature rise of the rail's surface, `K`.
    pub rise: f64,
}

impl ContactHeat {
    /// Heat of nodes on which a scaled traction of 1 is the given force, `N`.
    pub fn new(parameters: &Parameters, unit_force: f64, nodes: impl Iterator<Item = HeatedNode>) -> ContactHeat {
        let weights = Weights::new(parameters, unit_force);
        let mut heat = ContactHeat::default();
        // Of nodes by strips, `for_each` makes two nested loops; `for` would ask for one node after the other.
        nodes.for_each(|node| {
            heat.friction += weights.friction * coulomb::vector_power(node.shear, node.slip);
            heat.conducted += weights.conduction * node.pressure * node.rise;
            heat.conductance += weights.conduction * node.pressure;
        });
        heat
    }

    /// Change of the heat, from the nodes and the change of each.
    pub fn tangent(
        parameters: &Parameters,
        unit_force: f64,
        nodes: impl Iterator<Item = (HeatedNode, HeatedNode)>,
    ) -> ContactHeat {
        let weights = Weights::new(parameters, unit_force);
        let mut heat = ContactHeat::default();
        for (node, change) in nodes {
            let power = coulomb::vector_power_tangent(node.shear, node.slip, change.shear, change.slip);
            heat.friction += weights.friction * power;
            heat.conducted += weights.conduction * (change.pressure * node.rise + node.pressure * change.rise);
            heat.conductance += weights.conduction * change.pressure;
        }
        heat
    }

    /// Heat flowing into a wheel at θ_w over the ambient, `W`.
    pub fn flow(&self, wheel_rise: f64) -> f64 {
        self.friction + self.conducted - self.conductance * wheel_rise
    }
}

/// Factors on the scaled sums over the nodes.
struct Weights {
    friction: f64,
    conduction: f64,
}

impl Weights {
    fn new(parameters: &Parameters, unit_force: f64) -> Weights {
        Weights {
            friction: (1.0 - parameters.heat_partition) * unit_force,
            conduction: parameters.heat_partition * unit_force / parameters.contact_thermal_resistance,
        }
    }
}

/// T_w at the end of a step of `duration` `s` from `before`, `K`; the ambient's where the wheel is kept cold.
pub fn temperature(parameters: &Parameters, before: f64, ambient: f64, duration: f64, heat: &ContactHeat) -> f64 {
    match parameters.wheel_heating {
        WheelHeating::Off => ambient,
        WheelHeating::On => {
            let storage = heat_capacity(parameters) / duration;
            let loss = convection(parameters) + heat.conductance;
            ambient + (storage * (before - ambient) + heat.friction + heat.conducted) / (storage + loss)
        }
    }
}

/// Change of [`temperature`] with the contact's heat and the ambient, at its result `wheel_temperature`.
pub fn temperature_tangent(
    parameters: &Parameters,
    wheel_temperature: f64,
    ambient: f64,
    ambient_tangent: f64,
    duration: f64,
    heat: &ContactHeat,
    tangent: &ContactHeat,
) -> f64 {
    match parameters.wheel_heating {
        WheelHeating::Off => ambient_tangent,
        WheelHeating::On => {
            let storage = heat_capacity(parameters) / duration;
            let loss = convection(parameters) + heat.conductance;
            (loss * ambient_tangent + tangent.flow(wheel_temperature - ambient)) / (storage + loss)
        }
    }
}

/// Secant method for T_w = rim(rail(T_w)); its first step is that of the plain iteration.
#[derive(Debug, Clone, Copy)]
pub struct FixedPoint {
    settings: HeatSettings,
    temperature: f64,
    /// Iterate and image before.
    last: Option<(f64, f64)>,
    iterations: usize,
}

impl FixedPoint {
    /// Iteration from a first guess, `K`.
    pub fn new(guess: f64, settings: HeatSettings) -> FixedPoint {
        FixedPoint {
            settings,
            temperature: guess,
            last: None,
            iterations: 0,
        }
    }

    /// Iterate, `K`.
    pub fn temperature(&self) -> f64 {
        self.temperature
    }

    /// Takes the iterate's `image` `K`. Returns whether it is the iterate itself; otherwise there is a next iterate.
    ///
    /// # Errors
    /// [`Error::WheelHeatNotConverged`].
    pub fn converges(&mut self, image: f64) -> Result<bool> {
        let residual = image - self.temperature;
        self.iterations += 1;
        let settings = &self.settings;
        let tolerance = if self.iterations <= settings.rim_fast_iterations {
            settings.rim_tolerance
        } else {
            settings.rim_round_off
        };
        if self.iterations > settings.rim_iterations {
            let iterations = settings.rim_iterations;
            return Err(Error::WheelHeatNotConverged { iterations, residual });
        }
        if residual.abs() <= tolerance * image.abs() {
            return Ok(true);
        }
        let slope = match self.last {
            Some((temperature, last)) if temperature != self.temperature => {
                ((image - last) / (self.temperature - temperature)).clamp(0.0, 1.0 - 1e-12)
            }
            _ => 0.0,
        };
        self.last = Some((self.temperature, image));
        self.temperature += residual / (1.0 - slope);
        Ok(false)
    }
}

/// Radius that the wheel loses per time, `m/s`, as it wears by a volume per time, `m³/s`, on a contact of the given width, `m`; 0 without
/// contact, which has no width.
pub fn wear_rate(parameters: &Parameters, volume: f64, width: f64) -> f64 {
    if width > 0.0 {
        volume / (2.0 * PI * parameters.wheel_radius * width)
    } else {
        0.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::differences::slope;

    fn parameters() -> Parameters {
        Parameters {
            wheel_heating: WheelHeating::On,
            rim_depth: 2e-3,
            rim_width: 5e-3,
            ..Parameters::default()
        }
    }

    fn nodes(step: f64) -> Vec<HeatedNode> {
        (0..5)
            .map(|i| {
                let x = f64::from(i);
                HeatedNode {
                    pressure: 1.0 - 0.2 * x + step * 0.3,
                    shear: [-0.3 + 0.05 * x + step * 0.1 * x, 0.1 - step * 0.02 * x],
                    slip: [0.2 - 0.03 * x + step * 0.05, -0.05 + step * 0.03],
                    rise: 50.0 + 10.0 * x + step * 7.0,
                }
            })
            .collect()
    }

    /// C (T − T before)/Δt + h A (T − T_a) = what the contact gives to a wheel at T.
    #[test]
    fn the_step_closes_the_rims_heat_balance() {
        let parameters = parameters();
        let heat = ContactHeat::new(&parameters, 1e3, nodes(0.0).into_iter());
        for duration in [1e-4, 1.0, 1e6] {
            let (before, ambient) = (310.0, 295.0);
            let after = temperature(&parameters, before, ambient, duration, &heat);
            let stored = heat_capacity(&parameters) * (after - before) / duration;
            let lost = convection(&parameters) * (after - ambient);
            let given = heat.flow(after - ambient);
            assert!(
                (stored + lost - given).abs() < 1e-8 * given.abs().max(lost),
                "{duration}"
            );
        }
    }

    #[test]
    fn the_tangents_are_the_derivatives() {
        let parameters = parameters();
        let at = |h: f64| {
            let heat = ContactHeat::new(&parameters, 1e3, nodes(h).into_iter());
            temperature(&parameters, 310.0, 295.0 + 2.0 * h, 0.1, &heat)
        };
        let changes = nodes(1.0).into_iter().zip(nodes(0.0)).map(|(moved, node)| HeatedNode {
            pressure: moved.pressure - node.pressure,
            shear: [0, 1].map(|i| moved.shear[i] - node.shear[i]),
            slip: [0, 1].map(|i| moved.slip[i] - node.slip[i]),
            rise: moved.rise - node.rise,
        });
        let heat = ContactHeat::new(&parameters, 1e3, nodes(0.0).into_iter());
        let tangent = ContactHeat::tangent(&parameters, 1e3, nodes(0.0).into_iter().zip(changes));
        let exact = temperature_tangent(&parameters, at(0.0), 295.0, 2.0, 0.1, &heat, &tangent);
        let difference = slope(at, 1e-6);
        // Round-off of 300 K over h.
        assert!(
            (exact - difference).abs() < 1e-6 * (1.0 + exact.abs()),
            "{exact} {difference}"
        );
    }

    /// The secant method ends at the fixed point of a linear map in three iterations, whatever its slope below 1.
    #[test]
    fn the_fixed_point_is_found() {
        for slope in [0.0, 0.3, 0.9999] {
            let map = |t: f64| 300.0 + slope * (t - 350.0);
            let mut point = FixedPoint::new(293.15, HeatSettings::default());
            let mut iterations = 0;
            while !point.converges(map(point.temperature())).unwrap() {
                iterations += 1;
                assert!(iterations < 10, "{slope}");
            }
            let exact = (300.0 - 350.0 * slope) / (1.0 - slope);
            assert!(
                (point.temperature() / exact - 1.0).abs() < 1e-8,
                "{slope}: {}",
                point.temperature()
            );
        }
        let none = HeatSettings {
            rim_iterations: 0,
            ..HeatSettings::default()
        };
        assert!(FixedPoint::new(300.0, none).converges(300.0).is_err());
    }
}
