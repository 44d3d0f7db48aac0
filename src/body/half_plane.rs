//! The elastic half-plane x₂ < 0 under tractions on its surface: what rail and wheel are to a contact that is small against
//! them (Johnson, Contact Mechanics, 2.2–2.4).
//!
//! The displacement by a unit force at the origin, `N` per metre of width, along x₁ (Cerruti) and along x₂, upward
//! (Flamant), with k = 1/(2πγ), r² = x₁² + x₂² and ϑ = arctan(x₁/−x₂), the angle from the inward normal:
//!
//! | force | u₁ | u₂ |
//! |---|---|---|
//! | along x₁ | k (−2(1−ν) ln r − x₂²/r²) | k (−(1−2ν) ϑ + x₁x₂/r²) |
//! | along x₂ | k ((1−2ν) ϑ + x₁x₂/r²) | k (−2(1−ν) ln r + x₂²/r²) |
//!
//! each up to a rigid shift, which [`super::remainder`] takes back. On the surface, ϑ = ±π/2 and x₂ = 0, both forces
//! displace along themselves by −2(1−ν)k ln|x₁| and across by ∓(1−2ν)/(4γ), a step. A uniform unit traction on a cell of
//! length h about the origin displaces the surface at the distance d by their integrals,
//!
//! C(d) = −(1−ν)/(πγ) ([y ln|y|] − h) along itself, M(d) = (1−2ν)/(2γ) min(max(d, −h/2), h/2) across,
//!
//! where \[ \] is the difference between y = d + h/2 and y = d − h/2. Two bodies pressed together add C and subtract M.

use crate::parameters::{Parameters, Wheel};
use nalgebra::DMatrix;
use std::f64::consts::PI;

/// The material of one half-plane.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlane {
    /// Poisson's ratio ν.
    pub poisson_ratio: f64,
    /// Shear modulus γ, `Pa`.
    pub shear_modulus: f64,
}

/// Surface displacement of a pair of half-planes, rail against wheel, or of one body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HalfPlanes {
    /// Sum of (1 − ν)/γ over the bodies, `1/Pa`: 2/E*.
    pub direct: f64,
    /// Difference of (1 − 2ν)/(2γ) of the rail and of the wheel, `1/Pa`; 0 where normal and tangential problem are not coupled.
    pub coupling: f64,
}

/// Relative change of the surface displacement under a load that moves at V, per ρV²: first order of the series, `1/Pa`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InertiaFactors {
    /// Factor on the displacement along x₂ by a load along x₂.
    pub normal: f64,
    /// Factor on the displacement along x₁ by a load along x₁.
    pub tangential: f64,
    /// Factor on the displacements across the load: along x₁ by a load along x₂, and the reverse.
    pub mixed: f64,
}

impl HalfPlane {
    /// Half-plane of Lamé's constants λ and γ, `Pa`.
    pub fn new(lambda: f64, shear: f64) -> HalfPlane {
        HalfPlane {
            poisson_ratio: lambda / (2.0 * (lambda + shear)),
            shear_modulus: shear,
        }
    }

    /// The displacement `[u₁, u₂]` at a point other than the origin by a unit force there along `direction` (0 along
    /// x₁, 1 along x₂).
    pub fn displacement(&self, direction: usize, [x, y]: [f64; 2]) -> [f64; 2] {
        let k = 0.5 / (PI * self.shear_modulus);
        let square = x * x + y * y;
        let logarithm = -(1.0 - self.poisson_ratio) * square.ln();
        let rotation = (1.0 - 2.0 * self.poisson_ratio) * x.atan2(-y);
        match direction {
            0 => [k * (logarithm - y * y / square), k * (-rotation + x * y / square)],
            _ => [k * (rotation + x * y / square), k * (logarithm + y * y / square)],
        }
    }

    /// Factor of (x₁, x₂)/r² in the dilatation div u by a unit force along x₁ and along x₂: −(1 − 2ν)/(πγ). The stress is
    /// radial, −(2/π) x/r² (Johnson, 2.15).
    pub fn dilatation(&self) -> f64 {
        -(1.0 - 2.0 * self.poisson_ratio) / (PI * self.shear_modulus)
    }

    /// The surface under a load that moves at V: each table is the one at rest times a factor. With m = ρV²/γ,
    /// q = (1−2ν)/(2(1−ν)), the squared ratio of the speeds of shear and pressure waves, a_s² = 1 − m, a_d² = 1 − qm and
    /// R = 4 a_s a_d − (1 + a_s²)², Rayleigh's function (Johnson, 11.3; Cole and Huth 1958), the factors are
    ///
    /// a_d m/((1−ν)R),  a_s m/((1−ν)R),  2(1 + a_s² − 2 a_s a_d)/((1−2ν)R)
    ///
    /// for the normal, the tangential and the mixed table. To first order in m, with B = (1 + (1−q)²/2)/(2(1−q)), they are
    /// 1 + m(B − q/2), 1 + m(B − ½), 1 + m(B + (1−q)²/(4q)).
    pub fn inertia_factors(&self) -> InertiaFactors {
        let q = (1.0 - 2.0 * self.poisson_ratio) / (2.0 * (1.0 - self.poisson_ratio));
        let rest = 1.0 - q;
        let b = (1.0 + 0.5 * rest * rest) / (2.0 * rest);
        InertiaFactors {
            normal: (b - 0.5 * q) / self.shear_modulus,
            tangential: (b - 0.5) / self.shear_modulus,
            mixed: (b + rest * rest / (4.0 * q)) / self.shear_modulus,
        }
    }
}

impl HalfPlanes {
    /// Half-plane of one body against a rigid one.
    pub fn of_body(body: &HalfPlane) -> HalfPlanes {
        HalfPlanes {
            direct: (1.0 - body.poisson_ratio) / body.shear_modulus,
            coupling: (1.0 - 2.0 * body.poisson_ratio) / (2.0 * body.shear_modulus),
        }
    }

    /// Half-planes of rail and wheel. A rigid wheel adds nothing.
    pub fn of_pair(parameters: &Parameters) -> HalfPlanes {
        let rail = HalfPlanes::of_body(&HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus));
        let wheel = match parameters.wheel {
            Wheel::Rigid => HalfPlanes {
                direct: 0.0,
                coupling: 0.0,
            },
            Wheel::Elastic => HalfPlanes::of_body(&HalfPlane::new(
                parameters.wheel_lame_lambda,
                parameters.wheel_shear_modulus,
            )),
        };
        let mixed = if parameters.normal_tangential_coupling {
            1.0
        } else {
            0.0
        };
        HalfPlanes {
            direct: rail.direct + wheel.direct,
            coupling: mixed * (rail.coupling - wheel.coupling),
        }
    }

    /// Displacement C(d) along a uniform unit traction on a cell of length `h`, at the distance `d` from its middle, `m/Pa`.
    pub fn along(&self, d: f64, h: f64) -> f64 {
        -self.direct / PI * (times_logarithm(d + 0.5 * h) - times_logarithm(d - 0.5 * h) - h)
    }

    /// Displacement M(d) along x₁ by a uniform upward unit traction on a cell; that along x₂ by a traction along x₁ is
    /// −M(d), `m/Pa`.
    pub fn across(&self, d: f64, h: f64) -> f64 {
        self.coupling * d.clamp(-0.5 * h, 0.5 * h)
    }

    /// Displacement of n nodes with the spacing `h` per traction on their cells, 2n × 2n in `m/Pa`: first all along x₁,
    /// then all along x₂.
    pub fn surface_displacement(&self, n: usize, h: f64) -> DMatrix<f64> {
        let distance = |cells: usize| cells as f64 * h;
        let along: Vec<f64> = (0..n).map(|cells| self.along(distance(cells), h)).collect();
        DMatrix::from_fn(2 * n, 2 * n, |row, column| {
            let (i, j) = (row % n, column % n);
            let across = || {
                let size = self.across(distance(i.abs_diff(j)), h);
                if i < j { -size } else { size }
            };
            match (row / n, column / n) {
                (0, 1) => across(),
                (1, 0) => -across(),
                _ => along[i.abs_diff(j)],
            }
        })
    }
}

/// y ln|y|.
fn times_logarithm(y: f64) -> f64 {
    if y == 0.0 { 0.0 } else { y * y.abs().ln() }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rail() -> HalfPlane {
        let parameters = Parameters::default();
        HalfPlane::new(parameters.lame_lambda, parameters.shear_modulus)
    }

    /// Div σ = 0 by differences of the closed form, and the stress on the surface is that of a point force: none beside it,
    /// and the force itself through a half-circle about it.
    #[test]
    fn a_point_force_is_in_equilibrium() {
        let body = rail();
        let (lambda, shear) = (Parameters::default().lame_lambda, body.shear_modulus);
        // ∂u_a/∂x_b by differences: truncation h², round-off ε/h.
        let h = 1e-5;
        let gradient = |direction: usize, [x, y]: [f64; 2], a: usize, b: usize| {
            let at = |s: f64| body.displacement(direction, if b == 0 { [x + s, y] } else { [x, y + s] })[a];
            (at(h) - at(-h)) / (2.0 * h)
        };
        let stress = |direction: usize, point: [f64; 2]| {
            let g = |a, b| gradient(direction, point, a, b);
            let dilatation = g(0, 0) + g(1, 1);
            let mixed = shear * (g(0, 1) + g(1, 0));
            [
                [lambda * dilatation + 2.0 * shear * g(0, 0), mixed],
                [mixed, lambda * dilatation + 2.0 * shear * g(1, 1)],
            ]
        };
        for direction in 0..2 {
            // Radial stress −(2/π) x_c/r² everywhere, which is in equilibrium and leaves the surface free; its force
            // through any half-circle is the unit force (Johnson, 2.15).
            for [x, y] in [[0.3, -0.7], [-0.9, -0.2], [0.6, -0.01]] {
                let square = x * x + y * y;
                let radial = -2.0 / PI * [x, y][direction] / square;
                for (a, row) in stress(direction, [x, y]).iter().enumerate() {
                    for (b, computed) in row.iter().enumerate() {
                        let exact = radial * [x, y][a] * [x, y][b] / square;
                        assert!(
                            (computed - exact).abs() < 1e-6,
                            "{direction} {a}{b}: {computed} {exact}"
                        );
                    }
                }
                let dilatation = gradient(direction, [x, y], 0, 0) + gradient(direction, [x, y], 1, 1);
                let exact = body.dilatation() * [x, y][direction] / square;
                assert!(
                    (dilatation - exact).abs() < 1e-6 * body.dilatation().abs(),
                    "{direction}"
                );
            }
        }
    }

    /// The tables of a cell are the integrals of the point force over it.
    #[test]
    fn a_cell_is_the_integral_of_point_forces() {
        let body = rail();
        let planes = HalfPlanes::of_body(&body);
        let h = 0.2;
        // The midpoint rule with cells that keep off the singularity; y ln y costs it an order.
        let integral = |d: f64, direction: usize, a: usize| {
            let points = 200_000;
            let sum: f64 = (0..points)
                .map(|i| d - h * ((f64::from(i) + 0.5) / f64::from(points) - 0.5))
                .map(|x| body.displacement(direction, [x, -0.0])[a])
                .sum();
            sum * h / f64::from(points)
        };
        for d in [0.0, 0.05, 0.1, 0.15, -0.3, 1.7] {
            for (direction, a, closed) in [
                (0, 0, planes.along(d, h)),
                (1, 1, planes.along(d, h)),
                (1, 0, planes.across(d, h)),
                (0, 1, -planes.across(d, h)),
            ] {
                let computed = integral(d, direction, a);
                let error = (computed - closed).abs() / (h * planes.direct);
                assert!(error < 1e-5, "{d} {direction} {a}: {computed} {closed}");
            }
        }
    }

    /// Hertz: p₀√(1 − x²/a²) displaces by a parabola, (2 p₀/(a E*)) (a²/2 − x²/2) up to a constant (Johnson, 2.44), at the
    /// order 2 in the cells' length or better.
    #[test]
    fn a_semi_elliptic_pressure_makes_a_parabola() {
        let planes = HalfPlanes::of_pair(&Parameters::default());
        let (a, peak) = (1.0, 1.0);
        let error = |cells: usize| {
            // The contact ends at the ends of cells.
            let h = 2.0 * a / cells as f64;
            let position = |i: usize| (i as f64 + 0.5) * h - a;
            // ∫√(1 − x²/a²)
            let integral = |x: f64| 0.5 * (x * (1.0 - x * x).max(0.0).sqrt() + x.clamp(-1.0, 1.0).asin());
            let mean = |x: f64| peak * (integral(x + 0.5 * h) - integral(x - 0.5 * h)) / h;
            let displacement = |x: f64| -> f64 {
                (0..cells)
                    .map(|j| planes.along(x - position(j), h) * mean(position(j)))
                    .sum()
            };
            let centre = displacement(0.5 * h);
            (cells / 2..cells * 3 / 4)
                .map(|i| {
                    let x = position(i);
                    let parabola = -peak * planes.direct / (2.0 * a) * (x * x - 0.25 * h * h);
                    (displacement(x) - centre - parabola).abs()
                })
                .fold(0.0, f64::max)
                / planes.direct
        };
        let (coarse, fine) = (error(40), error(80));
        assert!(coarse < 1e-3, "{coarse}");
        let order = (coarse / fine).log2();
        assert!(order > 1.9, "{order}");
    }

    /// Displacements under a load e^{ix₁} on the surface that moves at V, from the two waves that decay with depth
    /// and the 2 × 2 equations of the surface: nothing of the closed form. Per unit stress: along, upward, and across.
    fn moving(body: &HalfPlane, lambda: f64, m: f64) -> [f64; 3] {
        let shear = body.shear_modulus;
        let q = shear / (lambda + 2.0 * shear);
        let (a_s, a_d) = ((1.0 - m).sqrt(), (1.0 - q * m).sqrt());
        // Pressure wave u = A (i, a_d) e^{a_d x₂}, shear wave u = B (i a_s, 1) e^{a_s x₂}; σ₁₂ = iγ(2a_d A + (1 + a_s²) B),
        // σ₂₂ = (λ(a_d² − 1) + 2γ a_d²) A + 2γ a_s B.
        let rows = [
            [2.0 * a_d * shear, (1.0 + a_s * a_s) * shear],
            [lambda * (a_d * a_d - 1.0) + 2.0 * shear * a_d * a_d, 2.0 * shear * a_s],
        ];
        let determinant = rows[0][0] * rows[1][1] - rows[0][1] * rows[1][0];
        let solve = |shear_stress: f64, normal: f64| {
            [
                (shear_stress * rows[1][1] - rows[0][1] * normal) / determinant,
                (rows[0][0] * normal - rows[1][0] * shear_stress) / determinant,
            ]
        };
        let along = |[a, b]: [f64; 2]| a + a_s * b;
        let upward = |[a, b]: [f64; 2]| a_d * a + b;
        [along(solve(1.0, 0.0)), upward(solve(0.0, 1.0)), along(solve(0.0, 1.0))]
    }

    /// Transforms of the static kernels −ln|x|/π and sign(x)/2 are 1/|k| and 1/(ik): C is (1−ν)/γ of wave number 1, M
    /// (1−2ν)/(2γ) i⁻¹.
    #[test]
    fn the_inertia_factors_are_the_first_order_of_the_moving_load() {
        for (lambda, shear) in [(11.66e10, 8.2e10), (5e10, 2.6e10), (1e10, 9e10)] {
            let body = HalfPlane::new(lambda, shear);
            let planes = HalfPlanes::of_body(&body);
            let factors = body.inertia_factors();
            let error = |m: f64| {
                let [along, upward, across] = moving(&body, lambda, m);
                let first_order = |factor: f64| 1.0 + factor * shear * m;
                [
                    along / planes.direct - first_order(factors.tangential),
                    upward / planes.direct - first_order(factors.normal),
                    // i u₁ = i across, and 1/i = −i.
                    across / -planes.coupling - first_order(factors.mixed),
                ]
            };
            // m = (V/c_s)²: the error is of the order m², (V/c_s)⁴.
            let (coarse, fine) = (error(0.02), error(0.01));
            for (coarse, fine) in coarse.iter().zip(fine) {
                assert!(coarse.abs() < 5.0 * 0.02_f64.powi(2), "{coarse:e}");
                let order = (coarse / fine).log2();
                assert!((order - 2.0).abs() < 0.1, "{order}");
            }
        }
    }

    #[test]
    fn the_pair_adds_along_and_subtracts_across() {
        let rigid = Parameters {
            wheel: Wheel::Rigid,
            ..Parameters::default()
        };
        let mut elastic = Parameters {
            wheel: Wheel::Elastic,
            wheel_lame_lambda: 5e10,
            wheel_shear_modulus: 2.6e10,
            ..Parameters::default()
        };
        // The direct part is 2/E*.
        for parameters in [&rigid, &elastic] {
            let planes = HalfPlanes::of_pair(parameters);
            assert!((planes.direct * parameters.contact_modulus() - 2.0).abs() < 1e-14);
        }
        assert!(HalfPlanes::of_pair(&rigid).coupling > 0.0);
        // The softer wheel is stretched more than the rail.
        assert!(HalfPlanes::of_pair(&elastic).coupling < 0.0);
        elastic.normal_tangential_coupling = false;
        assert_eq!(HalfPlanes::of_pair(&elastic).coupling, 0.0);
    }
}
