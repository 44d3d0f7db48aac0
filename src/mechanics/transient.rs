//! ∂u₁/∂t in the slip velocity: the material under the wheel has come from the displacement of the step before.
//!
//! Backward Euler would take (u₁ − u₁ of the step before)/Δt. It relaxes a jump to 1/(1 + |V|Δt/ℓ) in a step, where ℓ is the
//! way on which rolling forgets it, several half-lengths of the contact, because the compliance of the whole body is in
//! series with that of the contact: a step of 5ℓ would leave a sixth of it, in place of exp(−5). So the step is fitted to the
//! exponential that is the solution, Δt* = (ℓ/|V|)(exp(|V|Δt/ℓ) − 1): exact for ∂u/∂t + |V|u/ℓ = F, Δt where the step is
//! short, and without trace where it is long. At rest Δt* = Δt.

/// Weights with which the displacement's rate of change enters the slip.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Transient {
    /// 1/Δt* times the displacement scale: slip velocity per scaled change of displacement, `m/s`.
    pub rate: f64,
    /// Weight θ of the node ahead in the change of the displacement. The strain is the difference of a node and the one ahead of it,
    /// centred between them, and so should the change be: θ = ½. At rest there is no strain that resists a shear alternating from
    /// node to node, and θ = ½ would leave it without stiffness; θ = ½ |V|Δt/(|V|Δt + Δx) is between.
    pub centring: f64,
}

/// Largest |V|Δt/ℓ at which the step before still leaves a trace in double precision.
const FORGOTTEN: f64 = 60.0;

impl Transient {
    /// Weights for a step of `duration` `s` at |V| = `speed` `m/s`, with nodes `spacing` `m` apart and a relaxation length `length`
    /// `m`. They are 0, as in steady rolling, where the step is infinite or 0: a state without a step before it.
    pub fn new(duration: f64, speed: f64, spacing: f64, length: f64, displacement_scale: f64) -> Transient {
        let travelled = speed * duration;
        if !(duration > 0.0 && duration.is_finite()) || travelled > FORGOTTEN * length {
            return Transient::default();
        }
        Transient {
            rate: displacement_scale / (duration * growth(travelled / length)),
            centring: 0.5 * travelled / (travelled + spacing),
        }
    }

    /// Change of the weights with |V|, per `m/s`.
    pub fn tangent(&self, duration: f64, speed: f64, spacing: f64, length: f64) -> Transient {
        if self.rate == 0.0 {
            return Transient::default();
        }
        let travelled = speed * duration;
        Transient {
            rate: -self.rate * growth_slope(travelled / length) * duration / length,
            centring: 0.5 * duration * spacing / ((travelled + spacing) * (travelled + spacing)),
        }
    }
}

/// (eᶻ − 1)/z.
fn growth(z: f64) -> f64 {
    if z < 1e-4 {
        1.0 + z / 2.0 + z * z / 6.0
    } else {
        z.exp_m1() / z
    }
}

/// d/dz ln((eᶻ − 1)/z).
fn growth_slope(z: f64) -> f64 {
    if z < 1e-3 {
        0.5 + z / 12.0
    } else {
        1.0 / -(-z).exp_m1() - 1.0 / z
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::numerics::differences::slope;

    const SPACING: f64 = 2e-4;
    const LENGTH: f64 = 0.02;

    fn at(speed: f64, duration: f64) -> Transient {
        Transient::new(duration, speed, SPACING, LENGTH, 1.0)
    }

    /// A displacement that starts at 1 and is pulled nowhere decays as exp(−|V|t/ℓ), whatever the step.
    #[test]
    fn the_fitted_step_relaxes_as_the_exponential() {
        let speed = 10.0;
        for duration in [1e-5, 1e-3, 1e-2, 0.1] {
            let rate = at(speed, duration).rate;
            let relaxed = rate / (rate + speed / LENGTH);
            let exact = (-speed * duration / LENGTH).exp();
            assert!((relaxed / exact - 1.0).abs() < 1e-12, "{relaxed} {exact}");
        }
        assert_eq!(at(10.0, 0.2), Transient::default());
        assert_eq!(at(10.0, f64::INFINITY), Transient::default());
        assert_eq!(
            at(0.0, 1e-3),
            Transient {
                rate: 1e3,
                centring: 0.0
            }
        );
    }

    /// Checks that the change is centred between the nodes where the step is long, and not at all where it is short.
    #[test]
    fn the_change_is_centred_as_far_as_the_step_goes() {
        for (cells, centring) in [(0.0, 0.0), (1.0, 0.25), (4.0, 0.4), (99.0, 0.495)] {
            assert!((at(cells * SPACING / 1e-3, 1e-3).centring - centring).abs() < 1e-15);
        }
    }

    #[test]
    fn the_tangent_is_the_derivative() {
        for (speed, duration) in [(1e-9, 1e-3), (0.1, 1e-3), (10.0, 1e-3), (10.0, 1e-2), (80.0, 1e-2)] {
            let here = at(speed, duration);
            let tangent = here.tangent(duration, speed, SPACING, LENGTH);
            let close = |value: fn(&Transient) -> f64, size: f64| {
                let difference = slope(|h| value(&at(speed + h, duration)), 1e-6 * f64::max(speed, 1e-3));
                (difference - value(&tangent)).abs() < 1e-6 * (value(&tangent).abs() + size)
            };
            assert!(close(|transient| transient.rate, here.rate));
            assert!(close(|transient| transient.centring, 1.0));
        }
    }
}
