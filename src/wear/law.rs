//! Laws of wear beside Archard's with one coefficient: depth worn per time at a point from its own pressure p, slip speed |s| and friction power
//! P = |τ·s|, each with its derivative beside it.
//!
//! **Map** (Jendel, Wear 253 (2002) 89): Archard's law with a coefficient K that has steps over slip speed and pressure,
//!
//! Ẇ = K |s| p / H,  K = (1 − C) (k₁ (1 − S₁) + k₂ (S₁ − S₂) + k₃ S₂) + k₄ C,
//!
//! where S₁ and S₂ step from 0 to 1 at the slip speeds from which on wear is severe and past it, and C at the pressure from which on it is
//! catastrophic, a share of the hardness H.
//!
//! **Energy** (Braghin, Lewis, Dwyer-Joyce and Bruni, Wear 261 (2006) 1253): mass lost per area and distance rolled, r, over the work per area and distance
//! rolled, x = P/|V|, which is the Tγ/A of the point,
//!
//! Ẇ = |V| r(x) / ρ,  r = a x − a ⟨x − R/a⟩ + c ⟨x − x_c⟩ with ⟨t⟩ = max(t, 0):
//!
//! a x up to R/a, R from there to x_c, R + c (x − x_c) beyond. |V| r(P/|V|) stays finite as V → 0.
//!
//! Steps and corners are blended over the width `wear_blend` times the place of each, continuously differentiable ([`step`], [`ramp`]); outside of
//! the blends the laws are as above.

use crate::parameters::{Parameters, WearLaw};

/// State of a point of the surface that wears, or a change of it.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Rubbing {
    /// Pressure p, `Pa`.
    pub pressure: f64,
    /// Slip speed |s|, `m/s`.
    pub speed: f64,
    /// Friction power per area |τ·s|, `W/m²`.
    pub power: f64,
}

/// A law that depends on more than slip and one coefficient.
#[derive(Debug, Clone, Copy)]
pub enum PointwiseLaw<'a> {
    /// [`WearLaw::ArchardMap`].
    Map(&'a Parameters),
    /// [`WearLaw::Energy`], at the speed |V| `m/s`.
    Energy(&'a Parameters, f64),
}

impl<'a> PointwiseLaw<'a> {
    /// The law of the parameters at a rolling speed V, `m/s`; none of Archard's with one coefficient.
    pub fn new(parameters: &'a Parameters, rolling_speed: f64) -> Option<PointwiseLaw<'a>> {
        match parameters.wear_law {
            WearLaw::Archard => None,
            WearLaw::ArchardMap => Some(PointwiseLaw::Map(parameters)),
            WearLaw::Energy => Some(PointwiseLaw::Energy(parameters, rolling_speed.abs())),
        }
    }

    /// Depth worn per time, `m/s`.
    pub fn rate(&self, point: &Rubbing) -> f64 {
        match *self {
            PointwiseLaw::Map(parameters) => {
                map_coefficient(parameters, point).0 * point.speed * point.pressure / parameters.hardness
            }
            PointwiseLaw::Energy(parameters, speed) => energy_rate(parameters, point.power, speed).0,
        }
    }

    /// Change of [`PointwiseLaw::rate`] with those of the point and of |V|, `m/s`.
    pub fn rate_tangent(&self, point: &Rubbing, change: &Rubbing, speed_change: f64) -> f64 {
        match *self {
            PointwiseLaw::Map(parameters) => {
                let (coefficient, [by_pressure, by_speed]) = map_coefficient(parameters, point);
                let sliding = point.speed * point.pressure;
                let sliding_change = change.speed * point.pressure + point.speed * change.pressure;
                let coefficient_change = by_pressure * change.pressure + by_speed * change.speed;
                (coefficient * sliding_change + coefficient_change * sliding) / parameters.hardness
            }
            PointwiseLaw::Energy(parameters, speed) => {
                let (_, [by_power, by_speed]) = energy_rate(parameters, point.power, speed);
                by_power * change.power + by_speed * speed_change
            }
        }
    }

    /// Wear rate per pressure with which a point's wear is taken into the normal problem, `m/(s Pa)`: at an unchanged slip, under a shear in proportion
    /// to the pressure. It is the larger one of slope and mean slope, with which the split converges whichever way the law bends.
    pub fn per_pressure(&self, point: &Rubbing) -> f64 {
        if point.pressure <= 0.0 {
            return 0.0;
        }
        let mean = self.rate(point) / point.pressure;
        let growing = Rubbing {
            pressure: 1.0,
            speed: 0.0,
            power: point.power / point.pressure,
        };
        mean.max(self.rate_tangent(point, &growing, 0.0))
    }
}

/// K of the map, and its derivatives by pressure and slip speed.
fn map_coefficient(parameters: &Parameters, point: &Rubbing) -> (f64, [f64; 2]) {
    let blend = parameters.wear_blend;
    let (severe, severe_slope) = step(point.speed, parameters.wear_map_slip_severe, blend);
    let (past, past_slope) = step(point.speed, parameters.wear_map_slip_fast, blend);
    let catastrophic_pressure = parameters.wear_map_pressure * parameters.hardness;
    let (catastrophic, catastrophic_slope) = step(point.pressure, catastrophic_pressure, blend);
    let [mild, fast] = [parameters.wear_map_mild, parameters.wear_map_fast];
    let of_slip = mild * (1.0 - severe) + parameters.wear_map_severe * (severe - past) + fast * past;
    let of_slip_slope =
        -mild * severe_slope + parameters.wear_map_severe * (severe_slope - past_slope) + fast * past_slope;
    let highest = parameters.wear_map_catastrophic;
    (
        (1.0 - catastrophic) * of_slip + highest * catastrophic,
        [
            (highest - of_slip) * catastrophic_slope,
            (1.0 - catastrophic) * of_slip_slope,
        ],
    )
}

/// Depth worn per time by the energy's law, `m/s`, at a friction power per area and a speed |V|, and its derivatives by both.
fn energy_rate(parameters: &Parameters, power: f64, speed: f64) -> (f64, [f64; 2]) {
    let (mild, catastrophic) = (parameters.wear_energy_mild, parameters.wear_energy_catastrophic);
    let corners = [
        (-mild, parameters.wear_energy_severe / mild),
        (catastrophic, parameters.wear_energy_threshold),
    ];
    let mut mass = (mild * power, [mild, 0.0]);
    for (slope, place) in corners {
        // |V| ⟨P/|V| − x⟩ = ⟨P − |V| x⟩, blended over a width that is proportional to |V| too.
        let (half, half_by_speed) = (
            0.5 * parameters.wear_blend * place * speed,
            0.5 * parameters.wear_blend * place,
        );
        let (value, [by_distance, by_half]) = ramp(power - place * speed, half);
        mass.0 += slope * value;
        mass.1[0] += slope * by_distance;
        mass.1[1] += slope * (by_half * half_by_speed - by_distance * place);
    }
    let volume = 1.0 / parameters.density;
    (mass.0 * volume, mass.1.map(|slope| slope * volume))
}

/// A step from 0 to 1 at `place` over the width `blend` × `place`, 3t² − 2t³, and its derivative.
fn step(value: f64, place: f64, blend: f64) -> (f64, f64) {
    let width = blend * place;
    let t = (value - place) / width + 0.5;
    if t <= 0.0 {
        (0.0, 0.0)
    } else if t >= 1.0 {
        (1.0, 0.0)
    } else {
        (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t) / width)
    }
}

/// max(t, 0) with its corner blended over −h < t < h by (t + h)²/(4h), and its derivatives by t and h.
fn ramp(distance: f64, half: f64) -> (f64, [f64; 2]) {
    if distance <= -half {
        (0.0, [0.0, 0.0])
    } else if distance >= half {
        (distance, [1.0, 0.0])
    } else {
        let share = 0.5 * (distance + half) / half;
        (share * share * half, [share, share * (1.0 - share)])
    }
}

#[cfg(test)]
mod tests;
