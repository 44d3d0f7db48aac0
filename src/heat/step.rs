//! One mode of the temperature on its way through the cell between two columns.
//!
//! A mode decays at the rate r = κλ with a source f = φ(0) q/(ρ c_p): ∂a/∂t − V ∂a/∂x₁ + r a = f. In the steady state, with f
//! linear over the cell of length Δ from the column upstream (U) to the next one (O), this is solved exactly by an exponential
//! integrator (M. Hochbruck and A. Ostermann, *Exponential integrators*, Acta Numerica 19, 2010),
//!
//! a_O = E a_U + G f_U + H f_O,  G = g ω,  H = g (1 − ω),
//!
//! z = r Δ/|V|,  E = e⁻ᶻ,  g = (1 − E)/r,  ω = 1/z − 1/(eᶻ − 1).
//!
//! It is of second order in Δ, and exact for what decays without a source, however long the cell. What a step of Δt stores,
//! (a − aⁿ)/Δt at both ends, is taken from f with weights c and d, c + d = g:
//!
//! (1 + d/Δt) a_O = (E − c/Δt) a_U + c/Δt aⁿ_U + d/Δt aⁿ_O + G f_U + H f_O,  c = min(G, E Δt).
//!
//! With c = G the storage is linear over the cell like f. Where the rail moves by less than about half a cell in a step, that would take
//! more from upstream than arrives; c is then what arrives, and the scheme the upwind difference. So all weights are positive:
//! nothing oscillates. At V = 0 it is the implicit Euler step of each column. What is settled, a = aⁿ, is the steady
//! state, whatever Δt.
//!
//! With ν = c/g, what the cell stores, loses and takes is balanced to round-off,
//!
//! Δ (ν (a − aⁿ)_U + (1 − ν) (a − aⁿ)_O)/Δt + |V| (a_O − a_U) + r Δ (ω a_U + (1 − ω) a_O) = Δ (ω f_U + (1 − ω) f_O),
//!
//! and over cells of one length the weights of a column add up to 1, whatever V, Δt and λ.

use crate::numerics::decay::{Decay, decay};
use crate::numerics::dense::MultiplyAdd;

/// Speed of the rail below which the change with |V| is that at [`SLOW`], `m/s`. ω rises from 0 to ½ about |V| = r Δ, which of the slowest modes is nanometres per
/// second: the slope there says nothing of any change that can be told from a standstill.
const STANDSTILL: f64 = 1e-4;
/// Slow motion that stands for a standstill, `m/s`: its derivatives are those of changes by millimetres per second.
const SLOW: f64 = 5e-3;

/// Factors on what makes a column's amplitude in a step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModeStep {
    /// Factor on the amplitude upstream.
    pub advected: f64,
    /// Factor on the amplitude upstream in the step before.
    pub old_upstream: f64,
    /// Factor on the amplitude in the step before.
    pub old: f64,
    /// Factor on the source f upstream, `s`.
    pub source_upstream: f64,
    /// Factor on the source f in the column itself, `s`: the diagonal of the recurrence.
    pub source: f64,
}

/// Rate of decay of a mode and its inverse.
#[derive(Debug, Clone, Copy)]
pub struct DecayRate {
    /// Rate of decay r = κλ, `1/s`.
    pub rate: f64,
    /// Inverse 1/r, `s`.
    pub lifetime: f64,
}

impl DecayRate {
    /// Rate r `1/s` of a mode.
    #[cfg(any(test, feature = "verification"))]
    pub fn new(rate: f64) -> DecayRate {
        DecayRate {
            rate,
            lifetime: 1.0 / rate,
        }
    }
}

/// Time in which the rail crosses a cell and its inverse.
#[derive(Debug, Clone, Copy)]
pub struct Transit {
    /// Time Δ/|V|, `s`.
    pub time: f64,
    /// Inverse |V|/Δ, `1/s`.
    pub rate: f64,
}

impl Transit {
    /// Transit through a cell of length Δ `spacing` `m` at |V| `speed` `m/s`.
    pub fn new(spacing: f64, speed: f64) -> Transit {
        Transit {
            time: spacing / speed,
            rate: speed / spacing,
        }
    }
}

/// A mode and a cell.
#[derive(Debug, Clone, Copy)]
pub struct Crossing {
    /// Rate of decay r = κλ, `1/s`.
    pub rate: f64,
    /// Inverse 1/Δt of the step, `1/s`.
    pub storage: f64,
    /// Length Δ of the cell, `m`.
    pub spacing: f64,
    /// Speed |V| of the rail, `m/s`.
    pub speed: f64,
}

/// Amplitudes, those of the step before and f, each upstream and at the column.
#[derive(Debug, Clone, Copy)]
pub struct ModeEnds {
    /// Amplitudes a.
    pub value: [f64; 2],
    /// Amplitudes aⁿ in the step before.
    pub old: [f64; 2],
    /// Sources f, per second.
    pub source: [f64; 2],
}

impl ModeStep {
    /// Step of a mode with 1/Δt `storage` `1/s`, without branches: several at once vectorise.
    #[inline(always)]
    pub fn at(fma: MultiplyAdd, rate: DecayRate, storage: f64, transit: Transit) -> ModeStep {
        let DecayRate { rate, lifetime } = rate;
        let Decay { keep, upstream, own } = decay(fma, rate * transit.time, lifetime * transit.rate);
        let (source_upstream, source) = (upstream * lifetime, own * lifetime);
        let stored_upstream = (source_upstream * storage).min(keep);
        let stored = fma.multiply_add(source_upstream + source, storage, -stored_upstream);
        let share = 1.0 / (1.0 + stored);
        ModeStep {
            advected: (keep - stored_upstream) * share,
            old_upstream: stored_upstream * share,
            old: stored * share,
            source_upstream: source_upstream * share,
            source: source * share,
        }
    }

    /// Weight ν of the end upstream in what the cell stores.
    #[cfg(any(test, feature = "verification"))]
    pub fn storage_weight(&self) -> f64 {
        self.old_upstream / (self.old_upstream + self.old)
    }

    /// Weight ω of the end upstream in the source and the decay.
    #[cfg(any(test, feature = "verification"))]
    pub fn source_weight(&self) -> f64 {
        self.source_upstream / (self.source_upstream + self.source)
    }

    /// Amplitude of the step before at the column, from all the others in `ends`: the step solved backwards.
    pub fn previous(&self, ends: &ModeEnds) -> f64 {
        if self.old == 0.0 {
            return 0.0;
        }
        let rest = self.advected * ends.value[0]
            + self.old_upstream * ends.old[0]
            + self.source_upstream * ends.source[0]
            + self.source * ends.source[1];
        (ends.value[1] - rest) / self.old
    }

    /// Change of the column's amplitude with |V|; about a standstill, that of a slow motion.
    pub fn speed_tangent(&self, crossing: &Crossing, ends: &ModeEnds) -> f64 {
        if crossing.speed >= STANDSTILL {
            return self.exact_speed_tangent(crossing, ends);
        }
        let moving = Crossing {
            speed: SLOW,
            ..*crossing
        };
        let rate = DecayRate {
            rate: moving.rate,
            lifetime: 1.0 / moving.rate,
        };
        let transit = Transit::new(moving.spacing, moving.speed);
        ModeStep::at(MultiplyAdd::SEPARATE, rate, moving.storage, transit).exact_speed_tangent(&moving, ends)
    }

    /// Change of the column's amplitude with |V|: the derivative of the formulas.
    fn exact_speed_tangent(&self, crossing: &Crossing, ends: &ModeEnds) -> f64 {
        let Crossing {
            rate,
            storage,
            spacing,
            speed,
        } = *crossing;
        // 1/(1 + d/Δt), from E + r g = 1.
        let share = self.advected + self.old_upstream + rate * (self.source_upstream + self.source);
        let keep = (self.advected + self.old_upstream) / share;
        let source_upstream = self.source_upstream / share;
        // dE/dV = z E/V, dG/dV = (G − E Δ/V)/V and dH/dV = −G/V.
        let per_speed = source_upstream / speed;
        let delayed = keep * spacing / (speed * speed);
        let (keep, upstream, own) = (rate * delayed, per_speed - delayed, -per_speed);
        let stored_upstream = if self.advected > 0.0 { storage * upstream } else { keep };
        let stored = storage * (upstream + own) - stored_upstream;
        let ModeEnds { value, old, source } = ends;
        let growth = stored_upstream * (value[0] - old[0]) + stored * (value[1] - old[1]);
        share * (keep * value[0] + upstream * source[0] + own * source[1] - growth)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn step(crossing: &Crossing) -> ModeStep {
        let Crossing {
            rate,
            storage,
            spacing,
            speed,
        } = *crossing;
        let transit = Transit::new(spacing, speed);
        ModeStep::at(MultiplyAdd::SEPARATE, DecayRate::new(rate), storage, transit)
    }

    /// The amplitude at the column, from all else in `ends`.
    fn advance(step: &ModeStep, ends: &ModeEnds) -> f64 {
        step.advected * ends.value[0]
            + step.old_upstream * ends.old[0]
            + step.old * ends.old[1]
            + step.source_upstream * ends.source[0]
            + step.source * ends.source[1]
    }

    /// Decay, Courant number and their cell, from slow to fast.
    fn crossings() -> impl Strategy<Value = Crossing> {
        (-5.0..3.0, -3.0..3.0, -4.0..0.0, -3.0..2.0).prop_map(|(log_z, log_courant, log_spacing, log_speed)| {
            let (spacing, speed) = (10.0_f64.powf(log_spacing), 10.0_f64.powf(log_speed));
            let passages = speed / spacing;
            Crossing {
                rate: 10.0_f64.powf(log_z) * passages,
                storage: passages / 10.0_f64.powf(log_courant),
                spacing,
                speed,
            }
        })
    }

    proptest! {
        #[test]
        fn weights_are_positive_and_the_cell_is_balanced(
            crossing in crossings(),
            upstream in 0.0..1.0, old in prop::array::uniform2(0.0..1.0), source in prop::array::uniform2(0.0..1.0),
        ) {
            let step = step(&crossing);
            let Crossing { rate, storage, spacing, speed } = crossing;
            for weight in [step.advected, step.old_upstream, step.old, step.source_upstream, step.source] {
                prop_assert!(weight >= 0.0, "{step:?}");
            }
            let source = source.map(|f: f64| f * (rate + storage));
            let mut ends = ModeEnds { value: [upstream, 0.0], old, source };
            ends.value[1] = advance(&step, &ends);
            let mean = |share: f64, [upstream, own]: [f64; 2]| share * upstream + (1.0 - share) * own;
            let stored = |values: [f64; 2]| spacing * storage * mean(step.storage_weight(), values);
            let terms = [
                stored(ends.value),
                -stored(old),
                speed * (ends.value[1] - upstream),
                rate * spacing * mean(step.source_weight(), ends.value),
                -spacing * mean(step.source_weight(), source),
            ];
            let size: f64 = terms.iter().map(|term| term.abs()).sum::<f64>() + speed;
            prop_assert!(terms.iter().sum::<f64>().abs() < 1e-13 * size, "{terms:?}");
            // And what the step was made from is found again, to round-off over what is left of it.
            let found = step.previous(&ModeEnds { old: [old[0], f64::NAN], ..ends });
            prop_assert!((found - old[1]).abs() < 1e-14 * (1.0 + 1.0 / step.old), "{found} {}", old[1]);
        }

        /// Steady state: independent of Δt, and that of the exact solution where there are no sources.
        #[test]
        fn what_is_settled_is_the_steady_state(crossing in crossings(), source in prop::array::uniform2(0.0..1.0)) {
            let steady = step(&Crossing { storage: 0.0, ..crossing });
            let source = source.map(|f: f64| f * crossing.rate);
            let mut ends = ModeEnds { value: [0.7, 0.0], old: [0.7, 0.0], source };
            let settled = advance(&steady, &ends);
            prop_assert!((steady.advected - (-crossing.rate * crossing.spacing / crossing.speed).exp()).abs() < 1e-14);
            ends.old[1] = settled;
            prop_assert!((advance(&step(&crossing), &ends) - settled).abs() < 1e-14);
        }

        #[test]
        fn the_tangent_is_the_derivative(
            crossing in crossings(),
            value in prop::array::uniform2(0.0..1.0), old in prop::array::uniform2(0.0..1.0), source in prop::array::uniform2(0.0..1.0),
        ) {
            let source = source.map(|f: f64| f * (crossing.rate + crossing.storage));
            let ends = ModeEnds { value, old, source };
            let at = |change: f64| {
                let crossing = Crossing { speed: crossing.speed * (1.0 + change), ..crossing };
                let step = step(&crossing);
                (advance(&step, &ends), step.advected > 0.0)
            };
            let h = 1e-4;
            let (ahead, behind) = (at(h), at(-h));
            // Not across the corner of the storage, and not slower than the change is taken at.
            prop_assume!(ahead.1 == behind.1 && crossing.speed * (1.0 - h) > STANDSTILL);
            let mut here = ends;
            let step = step(&crossing);
            here.value[1] = advance(&step, &ends);
            let exact = crossing.speed * step.speed_tangent(&crossing, &here);
            let difference = (ahead.0 - behind.0) / (2.0 * h);
            // Truncation h² with the third derivative of e⁻ᶻ, and round-off over h.
            prop_assert!((exact - difference).abs() < 1e-6, "{exact} {difference}");
        }

        /// About a standstill the change with |V| is that of a slow motion, however slow the mode.
        #[test]
        fn the_tangent_about_a_standstill_is_that_of_a_slow_motion(
            log_rate in -5.0..5.0, log_speed in -12.0..-4.0,
            value in prop::array::uniform2(0.0..1.0), old in prop::array::uniform2(0.0..1.0), source in prop::array::uniform2(0.0..1.0),
        ) {
            let (rate, spacing, storage) = (10.0_f64.powf(log_rate), 5e-4, 1e3);
            let ends = ModeEnds { value, old, source: source.map(|f: f64| f * (rate + storage)) };
            let tangent = |speed: f64| {
                let crossing = Crossing { rate, storage, spacing, speed };
                step(&crossing).speed_tangent(&crossing, &ends)
            };
            for speed in [0.0, 10.0_f64.powf(log_speed)] {
                prop_assert_eq!(tangent(speed), tangent(SLOW));
            }
        }
    }
}
