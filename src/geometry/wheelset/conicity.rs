//! Equivalent conicity, by the integration of the wheelset's kinematic motion (EN 15302, annex B; UIC 519).
//!
//! A free wheelset moves along the track by y″ + Δr(y)/(e r₀) = 0, with the distance e of the contacts. With the potential
//! S(y) = ∫ Δr dy a motion between y₁ and y₂, S(y₁) = S(y₂), has the wavelength L = 2 ∫ dy/√(2 (S(y₂) − S(y))/(e r₀)) over
//! [y₁, y₂]; a cone of conicity tan γ has L = 2π √(e r₀/(2 tan γ)). The equivalent conicity of the amplitude (y₂ − y₁)/2 is that of the cone
//! with the same wavelength, in which e r₀ cancels.

use crate::numerics::interpolation;
use std::f64::consts::PI;

/// Conicity of an amplitude.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conicity {
    /// Amplitude: half the way from side to side, `m`.
    pub amplitude: f64,
    /// Equivalent conicity tan γ.
    pub conicity: f64,
    /// Turning points, to the right and to the left, `m`.
    pub ends: [f64; 2],
}

/// Points at which the motion is summed. The midpoint rule over the phase of the motion is exact for a cone, and where the radius
/// difference is smooth; where it jumps, a hundred times as many points change the conicity by 3e-6 of it.
const PHASES: usize = 720;
/// Part of the potential, and of an amplitude, that is round-off: the potential is a sum over 20 000 displacements at most, each of which rounds by 2e-16 of it.
const ROUNDING: f64 = 1e-11;

/// Kinematic motion of a wheelset: the difference of its rolling radii over the lateral displacement, as lines between points.
#[derive(Debug, Clone, PartialEq)]
pub struct KinematicMotion {
    lateral: Vec<f64>,
    difference: Vec<f64>,
    /// Potential S at the points: integral of the difference.
    sums: Vec<f64>,
}

impl KinematicMotion {
    /// Motion for the difference of the rolling radii, left less right, `m`, at ascending lateral displacements to the left, `m`. `None` where they do
    /// not ascend, or are fewer than two.
    pub fn new(lateral: Vec<f64>, difference: Vec<f64>) -> Option<KinematicMotion> {
        let ascending = lateral.windows(2).all(|pair| pair[0] < pair[1]);
        if lateral.len() < 2 || difference.len() != lateral.len() || !ascending {
            return None;
        }
        let mut sums = vec![0.0];
        for k in 1..lateral.len() {
            let mean = 0.5 * (difference[k] + difference[k - 1]);
            sums.push(sums[k - 1] + mean * (lateral[k] - lateral[k - 1]));
        }
        Some(KinematicMotion {
            lateral,
            difference,
            sums,
        })
    }

    /// Potential S at a displacement.
    fn potential(&self, y: f64) -> f64 {
        let (cell, share) = interpolation::between(&self.lateral, y);
        let (from, to) = (self.difference[cell], self.difference[cell + 1]);
        let length = self.lateral[cell + 1] - self.lateral[cell];
        self.sums[cell] + length * share * (from + 0.5 * share * (to - from))
    }

    /// Equivalent conicity of an amplitude, `m`. `None` where no motion of that amplitude lies within the displacements: they do not reach
    /// as far, or the wheels do not steer back.
    pub fn conicity(&self, amplitude: f64) -> Option<Conicity> {
        if !(amplitude > 0.0 && amplitude.is_finite()) {
            return None;
        }
        // The middle m of the motion: S(m + a) − S(m − a) rises through 0 there.
        let last = self.lateral[self.lateral.len() - 1];
        let (mut low, mut high) = (self.lateral[0] + amplitude, last - amplitude);
        let uphill = |middle: f64| self.potential(middle + amplitude) - self.potential(middle - amplitude);
        // An amplitude of half the range has one possible middle: `low` and `high` then differ by round-off, and S at the two ends does as well.
        let rounding = ROUNDING * self.sums.iter().fold(0.0, |most: f64, sum| most.max(sum.abs()));
        if low - high > ROUNDING * amplitude || uphill(low) > rounding || uphill(high) < -rounding {
            return None;
        }
        for _ in 0..60 {
            let middle = 0.5 * (low + high);
            if uphill(middle) < 0.0 {
                low = middle;
            } else {
                high = middle;
            }
        }
        let middle = 0.5 * (low + high);
        let top = 0.5 * (self.potential(middle + amplitude) + self.potential(middle - amplitude));
        // Over y = m + a sin φ, where the integrand has no singularity: L √(2/(e r₀)) = 2 ∫ a cos φ/√(S(y₂) − S(y)) dφ.
        let mut sum = 0.0;
        for k in 0..PHASES {
            let phase = PI * ((k as f64 + 0.5) / PHASES as f64 - 0.5);
            let depth = top - self.potential(middle + amplitude * phase.sin());
            if depth <= 0.0 {
                return None;
            }
            sum += amplitude * phase.cos() / depth.sqrt();
        }
        let length = 2.0 * sum * PI / PHASES as f64;
        // The cone has Δr = 2 y tan γ, S = y² tan γ and ∫ = π/√(tan γ).
        Some(Conicity {
            amplitude,
            conicity: (2.0 * PI / length).powi(2),
            ends: [middle - amplitude, middle + amplitude],
        })
    }
}
