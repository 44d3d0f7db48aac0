//! Values of CONTACT (E.A.H. Vollebregt and J.J. Kalker; the open version 2025-07-23) for rolling contact on an ellipse.
//!
//! Module 3, steady rolling, full half-spaces, the normal problem solved as well; `n` elements over 2a and over 2b. Like bodies
//! of the default material, V = 20 m/s. Forces are shares of μN, moments of μN √(ab), all as magnitudes: CONTACT's own axes are
//! others than wheelrail's.

/// Shear modulus of both bodies, Pa.
pub const SHEAR_MODULUS: f64 = 8.2e10;
/// Lamé's λ of both bodies, Pa.
pub const LAME_LAMBDA: f64 = 1.166e11;
/// Load N, N.
pub const LOAD: f64 = 80e3;
/// Friction coefficient μ.
pub const FRICTION: f64 = 0.3;
/// Radius of the wheel r₀, m: the gap is x²/(2 r₀) + B y².
pub const WHEEL_RADIUS: f64 = 0.46;

/// Poisson's ratio of both bodies, 0.293555.
pub fn poisson_ratio() -> f64 {
    0.5 * LAME_LAMBDA / (LAME_LAMBDA + SHEAR_MODULUS)
}

/// Hertz's contact under the gap A x² + B y², A = 1/(2 r₀).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ellipse {
    /// B, half the sum of the transverse curvatures, 1/m.
    pub transverse: f64,
    /// Semi-axis a along the rail, m.
    pub along: f64,
    /// Semi-axis b across the rail, m.
    pub across: f64,
    /// Peak pressure p₀, Pa.
    pub peak_pressure: f64,
    /// Approach of the bodies, m.
    pub approach: f64,
}

/// The ellipses with a/b = 0.5, 1 and 2.
pub const ELLIPSES: [Ellipse; 3] = [
    Ellipse {
        transverse: 0.382_360,
        along: 5.137_73e-3,
        across: 10.275_47e-3,
        peak_pressure: 723.53e6,
        approach: 69.05e-6,
    },
    Ellipse {
        transverse: 1.086_957,
        along: 6.195_24e-3,
        across: 6.195_24e-3,
        peak_pressure: 995.21e6,
        approach: 83.43e-6,
    },
    Ellipse {
        transverse: 3.089_949,
        along: 7.253_63e-3,
        across: 3.626_81e-3,
        peak_pressure: 1451.95e6,
        approach: 97.82e-6,
    },
];

/// One force at one creepage on the circle, a/b = 1.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CreepForce {
    /// The creepage that is not zero.
    pub creepage: f64,
    /// Value at n = 40.
    pub coarse: f64,
    /// Value at n = 80.
    pub fine: f64,
}

impl CreepForce {
    const fn new(creepage: f64, coarse: f64, fine: f64) -> CreepForce {
        CreepForce { creepage, coarse, fine }
    }

    /// Limit for ever finer elements, to some 0.002. CONTACT converges with first order: the limit lies once the last
    /// difference beyond n = 80, to about half that difference; ¾ was the best on finer grids.
    pub fn limit(&self) -> f64 {
        self.fine + 0.75 * (self.fine - self.coarse)
    }
}

/// F_x by longitudinal creepage ξ alone. In full slip it is a little under 1, as the elastic slip has a lateral part.
pub const LONGITUDINAL: [CreepForce; 8] = [
    CreepForce::new(0.0002, 0.110_32, 0.109_20),
    CreepForce::new(0.0005, 0.261_93, 0.259_12),
    CreepForce::new(0.001, 0.478_32, 0.473_29),
    CreepForce::new(0.0015, 0.650_90, 0.645_51),
    CreepForce::new(0.002, 0.783_63, 0.778_65),
    CreepForce::new(0.003, 0.945_19, 0.941_68),
    CreepForce::new(0.005, 0.999_25, 0.999_24),
    CreepForce::new(0.01, 0.999_82, 0.999_82),
];

/// F_y by lateral creepage η alone.
pub const LATERAL: [CreepForce; 8] = [
    CreepForce::new(0.0002, 0.096_65, 0.095_55),
    CreepForce::new(0.0005, 0.230_62, 0.228_05),
    CreepForce::new(0.001, 0.425_71, 0.420_90),
    CreepForce::new(0.0015, 0.586_55, 0.581_05),
    CreepForce::new(0.002, 0.716_06, 0.710_53),
    CreepForce::new(0.003, 0.892_20, 0.887_88),
    CreepForce::new(0.005, 0.999_08, 0.998_84),
    CreepForce::new(0.01, 0.999_82, 0.999_82),
];

/// M_z by lateral creepage η alone, at n = 80 only: creepage and share. It changes by 0.002 from n = 40 at the most.
pub const MOMENT: [[f64; 2]; 8] = [
    [0.0002, 0.035_58],
    [0.0005, 0.076_67],
    [0.001, 0.117_34],
    [0.0015, 0.130_73],
    [0.002, 0.124_93],
    [0.003, 0.083_61],
    [0.005, 0.018_68],
    [0.01, 0.008_59],
];

/// C₁₁, C₂₂, C₂₃ and C₃₃ of the circle by small creepages, at n = 80 and the material's Poisson's ratio. The first three are
/// 1 % above Kalker's and C₃₃ 2 %, which finer elements take off.
pub const SMALL_CREEPAGE: [f64; 4] = [4.302, 3.752, 1.506, 1.206];
/// C₃₃ of the circle in the same way, at Poisson's ratio 0.25.
pub const SMALL_SPIN_AT_A_QUARTER: f64 = 1.210;

/// Highest rise of temperature on the circle in full slip at ξ = 0.01, K: half of the heat goes into the rail, n = 40. The
/// weight of an element's own heat was corrected; as published it overstates the rise by 11 % and more.
pub const FLASH_TEMPERATURE: f64 = 50.4;

/// Elements in contact, and least and largest CPU time of a call on one thread with inputs that vary from call to call, s, at
/// n = 20, 30 and 40.
pub const RUN_TIMES: [(usize, f64, f64); 3] = [(316, 0.011, 0.018), (725, 0.048, 0.071), (1276, 0.101, 0.187)];
/// Largest difference of the forces of CONTACT's FASTSIM from CONTACT's, at large spin; in the median it is 0.007.
pub const FASTSIM_LARGEST_ERROR: f64 = 0.07;
/// Run times of CONTACT's FASTSIM by number of elements, s.
pub const FASTSIM_RUN_TIMES: [(usize, f64); 3] = [(316, 0.2e-3), (725, 0.4e-3), (1276, 0.6e-3)];

#[cfg(test)]
mod tests {
    use super::super::kalker::CreepCoefficients;
    use super::*;
    use std::f64::consts::PI;

    /// Hertz: p₀ = 3N/(2π ab) everywhere, and on the circle a³ = 3N(1 − ν)/(8 G A), approach 2 A a² (like bodies).
    #[test]
    fn ellipses_are_those_of_hertz() {
        for ellipse in ELLIPSES {
            let peak = 1.5 * LOAD / (PI * ellipse.along * ellipse.across);
            assert!((peak / ellipse.peak_pressure - 1.0).abs() < 1e-5, "{peak}");
        }
        let [_, circle, _] = ELLIPSES;
        let radius = (0.375 * LOAD * (1.0 - poisson_ratio()) / (SHEAR_MODULUS * circle.transverse)).cbrt();
        assert!((radius / circle.along - 1.0).abs() < 1e-5, "{radius}");
        let approach = 2.0 * circle.transverse * radius * radius;
        assert!((approach / circle.approach - 1.0).abs() < 1e-4, "{approach}");
    }

    /// Coefficients by small creepages against Kalker's table between its Poisson's ratios, and the creep curves' first points
    /// below the straight line that they bend from, by what slips: a quarter of it at most.
    #[test]
    fn small_creepages_are_kalkers() {
        let [_, circle, _] = ELLIPSES;
        let kalker = CreepCoefficients::of(1.0, poisson_ratio()).unwrap();
        let coefficients = [kalker.longitudinal, kalker.lateral, kalker.lateral_spin, kalker.spin];
        for (contact, kalker) in SMALL_CREEPAGE.into_iter().zip(coefficients) {
            assert!((contact / kalker - 1.0).abs() < 0.02, "{contact} against {kalker}");
        }
        let unit = SHEAR_MODULUS * circle.along * circle.across / (FRICTION * LOAD);
        for (curve, coefficient) in [(LONGITUDINAL, coefficients[0]), (LATERAL, coefficients[1])] {
            let line = unit * coefficient * curve[0].creepage;
            assert!((0.75..1.0).contains(&(curve[0].limit() / line)), "{line}");
        }
    }

    /// A digit set wrong would break the curves: they rise and bend downward, and finer elements take off less and less.
    #[test]
    fn curves_are_smooth() {
        for curve in [LONGITUDINAL, LATERAL] {
            let slope =
                |pair: &[CreepForce]| (pair[1].limit() - pair[0].limit()) / (pair[1].creepage - pair[0].creepage);
            let slopes: Vec<f64> = curve.windows(2).map(slope).collect();
            assert!(slopes.windows(2).all(|pair| pair[1] < pair[0]), "{slopes:?}");
            assert!(
                curve
                    .iter()
                    .all(|point| (0.0..0.006).contains(&(point.coarse - point.fine)))
            );
        }
    }
}
