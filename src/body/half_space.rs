//! The elastic half-space under tractions on its surface, what rail and wheel are to a contact that is small against them in
//! both directions (Boussinesq, Cerruti; Johnson, Contact Mechanics, 3.2 and 3.6).
//!
//! With u the displacement of the rail's surface less that of the wheel's, τ the shear on the rail, p the pressure, (x, y) the
//! place less that of the load and r its distance,
//!
//! | load | u_x | lift of the rail's surface towards the wheel, or approach |
//! |---|---|---|
//! | τ_x | (1/πG) ∫ ((1−ν)/r + ν x²/r³) τ_x dA | lift −(K/πG) ∫ x/r² τ_x dA |
//! | τ_y | (1/πG) ∫ ν xy/r³ τ_y dA | lift −(K/πG) ∫ y/r² τ_y dA |
//! | p | −(K/πG) ∫ x/r² p dA | approach (1/πG) ∫ (1−ν)/r p dA |
//!
//! and u_y with x and y exchanged. For a pair 1/G = ½(1/G_r + 1/G_w), ν/G = ½(ν_r/G_r + ν_w/G_w) and
//! K/G = ¼((1−2ν_r)/G_r − (1−2ν_w)/G_w); a rigid wheel has 1/G_w = 0. The lift by shear is what reciprocity makes of u by
//! pressure: shear towards +x lowers the surface ahead of it.
//!
//! A traction that is uniform on a rectangle displaces by mixed differences of corner functions, F(x, y) at the four
//! corners of the rectangle as seen from the place (Love 1929; Kalker 1990, appendix C):
//!
//! | integrand | F |
//! |---|---|
//! | x²/r³ | y asinh(x/\|y\|) |
//! | y²/r³ | x asinh(y/\|x\|) |
//! | xy/r³ | −r |
//! | x/r² | ½ y ln r² + x atan(y/x) |
//! | x/r³ | −asinh(y/\|x\|) |
//!
//! The first is y ln(x + r) less y ln|y|, which a mixed difference does not see: the logarithm would cancel where x < 0.
//! 1/r is the sum of the first two.

use super::half_plane::HalfPlane;
use crate::parameters::{Parameters, Wheel};
use std::f64::consts::PI;

/// Surface displacement of a pair of half-spaces, rail against wheel, `1/Pa`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfSpaces {
    /// Factor 1/(πG) on the kernels 1/r.
    pub direct: f64,
    /// Factor ν/(πG) on the kernels of Poisson's effect.
    pub lateral: f64,
    /// Factor K/(πG) of the coupling between normal and tangential displacement; 0 where normal and tangential problem are not coupled.
    pub coupling: f64,
}

impl HalfSpaces {
    /// Half-spaces of rail and wheel. A rigid wheel adds nothing.
    pub fn of_pair(parameters: &Parameters) -> HalfSpaces {
        let rail = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        let wheel = match parameters.wheel {
            Wheel::Rigid => None,
            Wheel::Elastic => Some(HalfPlane::new(
                parameters.wheel_lame_lambda,
                parameters.wheel_shear_modulus,
            )),
        };
        let sum = |of: fn(&HalfPlane) -> f64, sign: f64| {
            of(&rail) / rail.shear_modulus + sign * wheel.map_or(0.0, |wheel| of(&wheel) / wheel.shear_modulus)
        };
        HalfSpaces {
            direct: 0.5 * sum(|_| 1.0, 1.0) / PI,
            lateral: 0.5 * sum(|body| body.poisson_ratio, 1.0) / PI,
            coupling: if parameters.normal_tangential_coupling {
                0.25 * sum(|body| 1.0 - 2.0 * body.poisson_ratio, -1.0) / PI
            } else {
                0.0
            },
        }
    }

    /// Factor (1 − ν)/(πG): approach by pressure, and displacement along a shear from beside it.
    pub fn normal(&self) -> f64 {
        self.direct - self.lateral
    }
}

/// Kernel of a half-space, as what integrates it over rectangles.
#[derive(Debug, Clone, Copy)]
pub struct Kernel {
    /// Corner function F(x, y).
    pub corner: fn(f64, f64) -> f64,
    /// Whether the kernel is odd in x and in y; it is even where it is not.
    pub odd: [bool; 2],
}

/// Kernel x²/r³.
pub const XX_OVER_R3: Kernel = Kernel {
    corner: |x, y| y * (x / y.abs()).asinh(),
    odd: [false, false],
};

/// Kernel y²/r³.
pub const YY_OVER_R3: Kernel = Kernel {
    corner: |x, y| x * (y / x.abs()).asinh(),
    odd: [false, false],
};

/// Kernel xy/r³.
pub const XY_OVER_R3: Kernel = Kernel {
    corner: |x, y| -x.hypot(y),
    odd: [true, true],
};

/// Kernel x/r².
pub const X_OVER_R2: Kernel = Kernel {
    corner: |x, y| 0.5 * y * (x * x + y * y).ln() + x * (y / x).atan(),
    odd: [true, false],
};

/// Kernel y/r².
pub const Y_OVER_R2: Kernel = Kernel {
    corner: |x, y| 0.5 * x * (x * x + y * y).ln() + y * (x / y).atan(),
    odd: [false, true],
};

/// Kernel x/r³.
pub const X_OVER_R3: Kernel = Kernel {
    corner: |x, y| -(y / x.abs()).asinh(),
    odd: [true, false],
};

/// Kernel y/r³.
pub const Y_OVER_R3: Kernel = Kernel {
    corner: |x, y| -(x / y.abs()).asinh(),
    odd: [false, true],
};

/// A rectangle under a uniform load.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rectangle {
    /// Half its extent along x, `m`.
    pub half_length: f64,
    /// Half its extent along y, `m`.
    pub half_breadth: f64,
}

impl Rectangle {
    /// Integral of a kernel over the rectangle, seen from `(x, y)` relative to its centre: the mixed difference of its corner function. The
    /// place must not lie on the line of an edge.
    pub fn integral(&self, kernel: &Kernel, x: f64, y: f64) -> f64 {
        let corner = kernel.corner;
        let (ahead, behind) = (x + self.half_length, x - self.half_length);
        let (left, right) = (y + self.half_breadth, y - self.half_breadth);
        (corner(ahead, left) - corner(ahead, right)) - (corner(behind, left) - corner(behind, right))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A kernel of Boussinesq and Cerruti and its integral over a rectangle.
    type Case = (fn(f64, f64) -> f64, Kernel);

    const CASES: [Case; 7] = [
        (|x, y| x * x / x.hypot(y).powi(3), XX_OVER_R3),
        (|x, y| y * y / x.hypot(y).powi(3), YY_OVER_R3),
        (|x, y| x * y / x.hypot(y).powi(3), XY_OVER_R3),
        (|x, y| x / (x * x + y * y), X_OVER_R2),
        (|x, y| y / (x * x + y * y), Y_OVER_R2),
        (|x, y| x / x.hypot(y).powi(3), X_OVER_R3),
        (|x, y| y / x.hypot(y).powi(3), Y_OVER_R3),
    ];

    fn one_over_r(rectangle: &Rectangle, x: f64, y: f64) -> f64 {
        rectangle.integral(&XX_OVER_R3, x, y) + rectangle.integral(&YY_OVER_R3, x, y)
    }

    proptest! {
        /// Gauss's rule with five points each way, from places as far away as the rectangle is large.
        #[test]
        fn corner_functions_are_the_integrals(
            half_length in 0.2..1.0, half_breadth in 0.2..1.0, angle in 0.0..6.2_f64, distance in 4.0..30.0_f64,
        ) {
            let rectangle = Rectangle { half_length, half_breadth };
            let (x, y) = (distance * angle.cos(), distance * angle.sin());
            // Not on the line of an edge.
            prop_assume!((x.abs() - half_length).abs() > 1e-3 && (y.abs() - half_breadth).abs() > 1e-3);
            let points = [0.0, 0.538_469_310_105_683, -0.538_469_310_105_683, 0.906_179_845_938_664, -0.906_179_845_938_664];
            let weights = [128.0 / 225.0, 0.478_628_670_499_366, 0.478_628_670_499_366, 0.236_926_885_056_189, 0.236_926_885_056_189];
            for (function, kernel) in CASES {
                let mut sum = 0.0;
                let mut size = 0.0;
                for (s, ws) in points.iter().zip(weights) {
                    for (t, wt) in points.iter().zip(weights) {
                        let value = function(x - half_length * s, y - half_breadth * t);
                        sum += ws * wt * half_length * half_breadth * value;
                        size += ws * wt * half_length * half_breadth * value.abs();
                    }
                }
                // The rule's error (1/4)^10 of derivatives, and the corner functions' round-off, which grows with the distance.
                let round_off = 1e-15 * distance * distance * distance;
                prop_assert!((rectangle.integral(&kernel, x, y) - sum).abs() < 1e-6 * size + round_off);
            }
        }
    }

    /// ∬1/r from the centre of a rectangle 2a × 2b: 4 (a asinh(b/a) + b asinh(a/b)) (Johnson, 3.25).
    #[test]
    fn the_centre_of_a_loaded_rectangle() {
        let (a, b) = (0.7_f64, 0.3_f64);
        let rectangle = Rectangle {
            half_length: a,
            half_breadth: b,
        };
        let expected = 4.0 * (a * (b / a).asinh() + b * (a / b).asinh());
        assert!((one_over_r(&rectangle, 0.0, 0.0) / expected - 1.0).abs() < 1e-14);
        for odd in [XY_OVER_R3, X_OVER_R2, Y_OVER_R3] {
            assert!(rectangle.integral(&odd, 0.0, 0.0).abs() < 1e-15);
        }
    }

    /// A rectangle that is long across is a cell of a line contact: strain ∂u_x/∂x by τ_x is that of the half-plane,
    /// −(1−ν)/(πγ) of a body over the distance, and the lift by shear differs ahead and behind by (1−2ν)/(2γ) of it.
    #[test]
    fn a_long_rectangle_is_a_cell_of_the_half_plane() {
        let parameters = Parameters {
            wheel: Wheel::Rigid,
            ..Parameters::default()
        };
        let pair = HalfSpaces::of_pair(&parameters);
        let body = HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus);
        let (half_length, half_breadth) = (1e-4, 10.0);
        let rectangle = Rectangle {
            half_length,
            half_breadth,
        };
        let along = |x: f64| {
            pair.normal() * one_over_r(&rectangle, x, 1e-9) + pair.lateral * rectangle.integral(&XX_OVER_R3, x, 1e-9)
        };
        let (x, h) = (3e-3, 1e-6);
        let strain = (along(x + h) - along(x - h)) / (2.0 * h);
        let expected = -(1.0 - body.poisson_ratio) / (PI * body.shear_modulus) * 2.0 * half_length / x;
        assert!((strain / expected - 1.0).abs() < 1e-3, "{strain:e} {expected:e}");
        let lift = |x: f64| -pair.coupling * rectangle.integral(&X_OVER_R2, x, 1e-9);
        let step = lift(-x) - lift(x);
        let expected = (1.0 - 2.0 * body.poisson_ratio) / (2.0 * body.shear_modulus) * 2.0 * half_length;
        assert!((step / expected - 1.0).abs() < 1e-3, "{step:e} {expected:e}");
    }
}
