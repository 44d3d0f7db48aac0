//! The compliance of the contact nodes and the units in which the contact problem is solved.
//!
//! With u the surface displacement of the contact nodes and f the tractions on the rail, u(V) = C(V) f + C_θ θ, and
//! C(V) = C(0) + ρV² dC/d(ρV²): the error is of order (V/c_R)⁴. C_θ is taken at V = 0, an error of order (V/c_R)² in the
//! thermal displacement alone.
//!
//! Everything is scaled: tractions by p₀, displacements by a²/r₀ of the largest load. Raw compliances of
//! 1e-11 m/N beside a 1 would wreck the row of the load constraint.

use super::half_plane::InertiaFactors;
use crate::numerics::dense;
use crate::parameters::Parameters;
use nalgebra::DMatrix;

/// The units in which the contact problem is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scales {
    /// Hertz peak pressure p₀ at the largest load, `Pa`.
    pub pressure: f64,
    /// a²/r₀ at the largest load, `m`.
    pub displacement: f64,
}

impl Scales {
    /// Scales of the given parameters.
    pub fn new(parameters: &Parameters) -> Scales {
        let half_length = parameters.hertz_half_length(parameters.largest_load);
        Scales {
            pressure: parameters.hertz_peak_pressure(parameters.largest_load),
            displacement: half_length * half_length / parameters.wheel_radius,
        }
    }

    /// A compliance, displacement per traction `m/Pa`, in these units.
    pub fn compliance(&self, compliance: f64) -> f64 {
        compliance * self.pressure / self.displacement
    }
}

/// Displacement of the n contact nodes per traction at the n contact nodes, all n × n and scaled. The first word is
/// the displacement (normal is upward), the second the traction on the rail.
#[derive(Debug, Clone)]
pub struct Compliance {
    /// Compliance C_nn: normal displacement by pressure.
    pub normal_normal: DMatrix<f64>,
    /// Compliance C_nt: normal displacement by shear.
    pub normal_tangential: DMatrix<f64>,
    /// Compliance C_tn = C_ntᵀ: tangential displacement by pressure.
    pub tangential_normal: DMatrix<f64>,
    /// Compliance C_tt: tangential displacement by shear.
    pub tangential_tangential: DMatrix<f64>,
}

/// The compliance at rest and its derivative with respect to ρV², `1/Pa`.
#[derive(Debug, Clone)]
pub struct RollingCompliance {
    /// Compliance at rest, C(0).
    pub at_rest: Compliance,
    /// Derivative dC/d(ρV²) of the compliance, `1/Pa`.
    pub inertia: Compliance,
}

/// Thermal displacement of the contact nodes: column `i` (along x₁) and `n + i` (along x₂), scaled, per kelvin at every
/// node of the mesh (row `node`). Nodes × 2n.
pub type ThermalDisplacement = DMatrix<f64>;

impl Compliance {
    /// Splits the 2n × 2n matrix of all displacements per traction, along x₁ first, into its four blocks. Without
    /// `coupling` the mixed ones are zero.
    pub fn from_blocks(all: &DMatrix<f64>, coupling: bool) -> Compliance {
        let n = all.nrows() / 2;
        let mixed = if coupling { 1.0 } else { 0.0 };
        Compliance {
            normal_normal: all.view((n, n), (n, n)).into_owned(),
            normal_tangential: all.view((n, 0), (n, n)).into_owned() * mixed,
            tangential_normal: all.view((0, n), (n, n)).into_owned() * mixed,
            tangential_tangential: all.view((0, 0), (n, n)).into_owned(),
        }
    }

    /// Each block times its factor.
    pub fn scaled(&self, factors: &InertiaFactors) -> Compliance {
        Compliance {
            normal_normal: &self.normal_normal * factors.normal,
            normal_tangential: &self.normal_tangential * factors.mixed,
            tangential_normal: &self.tangential_normal * factors.mixed,
            tangential_tangential: &self.tangential_tangential * factors.tangential,
        }
    }

    /// Adds `factor` times the displacement along x₁ under pressure and shear, n each.
    pub fn add_along(&self, factor: f64, pressure: &[f64], shear: &[f64], along: &mut [f64]) {
        dense::multiply_add(&self.tangential_normal, pressure, -factor, along);
        dense::multiply_add(&self.tangential_tangential, shear, factor, along);
    }

    /// Adds `factor` times the upward displacement under pressure and shear, n each.
    pub fn add_upward(&self, factor: f64, pressure: &[f64], shear: &[f64], upward: &mut [f64]) {
        dense::multiply_add(&self.normal_normal, pressure, -factor, upward);
        dense::multiply_add(&self.normal_tangential, shear, factor, upward);
    }

    /// Adds the wheel's compliance, times a factor: the direct parts add, the mixed ones subtract.
    pub fn add_wheel(&mut self, wheel: &Compliance, factor: f64) {
        self.normal_normal += &wheel.normal_normal * factor;
        self.tangential_tangential += &wheel.tangential_tangential * factor;
        self.normal_tangential -= &wheel.normal_tangential * factor;
        self.tangential_normal -= &wheel.tangential_normal * factor;
    }
}

/// The mean of the entries of a 2n × 2n matrix of displacements, along x₁ first, that reciprocity and the mirror image in
/// x₁ = 0 make equal but for their sign: exactly symmetric, and exactly mirrored. u₁ and the load along x₁ change their sign in
/// the mirror.
pub fn symmetrised(all: &DMatrix<f64>) -> DMatrix<f64> {
    let n = all.nrows() / 2;
    let mirrored = |k: usize| k / n * n + n - 1 - k % n;
    DMatrix::from_fn(2 * n, 2 * n, |i, j| {
        let sign = if i / n == j / n { 0.25 } else { -0.25 };
        let (image_i, image_j) = (mirrored(i), mirrored(j));
        0.25 * (all[(i, j)] + all[(j, i)]) + sign * (all[(image_i, image_j)] + all[(image_j, image_i)])
    })
}
