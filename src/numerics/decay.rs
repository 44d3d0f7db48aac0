//! Weights of the exact solution of y′ = −z y + S over a unit interval, for several z at once.

use super::dense::MultiplyAdd;
use std::f64::consts::LOG2_E;

/// The solution at the end of the interval is `keep` times that at its start, plus, of a source S that is linear over the
/// interval, `upstream`/z times its value at the start and `own`/z times that at the end. `keep` + `upstream` + `own` is 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Decay {
    /// Decay E = e⁻ᶻ of the value at the start.
    pub keep: f64,
    /// Weight (1 − E)/z − E of the source at the start.
    pub upstream: f64,
    /// Weight 1 − (1 − E)/z of the source at the end.
    pub own: f64,
}

/// z beyond which e⁻ᶻ is taken as 0. It is below a hundredth of the round-off of 1 there, and products of small numbers, which
/// processors are slow with once they are denormal, do not arise.
const ALL_GONE: f64 = 40.0;

/// Adding this rounds a number below 2⁵¹ to an integer, which is then in the lowest bits.
const ROUND: f64 = 6_755_399_441_055_744.0;
/// ln 2 as a number whose multiples by up to 2¹¹ are exact, and the rest of it.
const LN_2_HIGH: f64 = 0.693_147_180_369_123_8;
const LN_2_LOW: f64 = 1.908_214_929_270_587_7e-10;

/// 1/(k + 2)!, the series of (eᶠ − 1 − f)/f². With |f| ≤ ½ ln 2 what follows is below round-off.
const SERIES: [f64; 12] = [
    1.0 / 2.0,
    1.0 / 6.0,
    1.0 / 24.0,
    1.0 / 120.0,
    1.0 / 720.0,
    1.0 / 5_040.0,
    1.0 / 40_320.0,
    1.0 / 362_880.0,
    1.0 / 3_628_800.0,
    1.0 / 39_916_800.0,
    1.0 / 479_001_600.0,
    1.0 / 6_227_020_800.0,
];

/// The weights at z > 0, to round-off of each and without branches. `inverse` is 1/z; z may be infinite.
#[inline(always)]
pub fn decay(fma: MultiplyAdd, z: f64, inverse: f64) -> Decay {
    let fma = |a, b, c| fma.multiply_add(a, b, c);
    let clamped = z.min(ALL_GONE);
    // z = n ln 2 − f, e⁻ᶻ = 2⁻ⁿ eᶠ.
    let shifted = fma(clamped, LOG2_E, ROUND);
    let n = shifted - ROUND;
    let power = f64::from_bits((1023 - (shifted.to_bits() - ROUND.to_bits())) << 52);
    let f = fma(n, LN_2_LOW, fma(n, LN_2_HIGH, -clamped));
    let c = SERIES;
    let (f2, f4) = (f * f, f * f * f * f);
    let low = fma(f2, fma(f, c[3], c[2]), fma(f, c[1], c[0]));
    let middle = fma(f2, fma(f, c[7], c[6]), fma(f, c[5], c[4]));
    let high = fma(f2, fma(f, c[11], c[10]), fma(f, c[9], c[8]));
    let series = fma(f4, fma(f4, high, middle), low);
    let change = fma(f2, series, f);
    let keep = if z < ALL_GONE { fma(power, change, power) } else { 0.0 };
    let gone = (1.0 - power) - power * change;
    // Where n = 0, f = −z and the two terms of (1 − E)/z − E cancel to z/2: they are taken from the series.
    let cancelled = clamped * fma(-series, 1.0 + clamped, 1.0);
    let upstream = if n == 0.0 { cancelled } else { fma(gone, inverse, -keep) };
    Decay {
        keep,
        upstream,
        own: gone - upstream,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::LN_2;

    #[test]
    fn the_parts_of_ln_2_add_up_to_it() {
        assert_eq!(LN_2_HIGH + LN_2_LOW, LN_2);
        assert_eq!((LN_2_HIGH * 2047.0).to_bits() & 1, 0);
    }

    #[test]
    fn the_weights_are_those_of_the_c_library() {
        for exponent in -2100..=500 {
            let z = 10.0_f64.powf(0.01 * f64::from(exponent));
            let weights = decay(MultiplyAdd::SEPARATE, z, 1.0 / z);
            let keep = (-z).exp();
            // (1 − E)/z − E = Σ (−1)ᵏ⁺¹ zᵏ k/(k+1)!, the other 1 − (1 − E)/z = Σ (−1)ᵏ⁺¹ zᵏ/(k+1)!.
            let (mut upstream, mut own, mut term) = (0.0, 0.0, -1.0);
            for k in 1..40 {
                term *= -z / f64::from(k + 1);
                upstream += f64::from(k) * term;
                own += term;
            }
            if z > 1.0 {
                upstream = -(-z).exp_m1() / z - keep;
                own = 1.0 + (-z).exp_m1() / z;
            }
            for (computed, exact) in [(weights.keep, keep), (weights.upstream, upstream), (weights.own, own)] {
                let size = if z < ALL_GONE { exact } else { 1.0 };
                assert!(
                    (computed - exact).abs() <= 16.0 * f64::EPSILON * size,
                    "{z:e}: {computed:e} {exact:e}"
                );
                assert!(computed >= 0.0);
            }
            assert!((weights.keep + weights.upstream + weights.own - 1.0).abs() <= 4.0 * f64::EPSILON);
        }
        let at_once = Decay {
            keep: 0.0,
            upstream: 0.0,
            own: 1.0,
        };
        assert_eq!(decay(MultiplyAdd::SEPARATE, f64::INFINITY, 0.0), at_once);
    }
}
