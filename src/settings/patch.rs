//! Settings of a patch.

use super::{SensitivitySettings, Settings, SplitSettings};

/// Pressure and shear of a patch.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatchSettings {
    /// Error at which the split of a patch has converged, of the surface temperature relative to its largest value, of upward
    /// displacement and wear relative to the displacement scale.
    pub split_tolerance: f64,
    /// Error of the shear at which it has converged, relative to the peak pressure.
    pub shear_tolerance: f64,
    /// Tolerance of the tractions in the first iteration of the split, whose temperature is only a guess.
    pub first_mechanics_tolerance: f64,
    /// Tolerance of the tractions where they are solved alone, for the initial state.
    pub tolerance: f64,
    /// Smallest tolerance that is asked of the tractions.
    pub least_tolerance: f64,
    /// Largest separation ahead of a cell over its pressure, in displacements of a cell under its own pressure: a cell that has just
    /// joined has next to none.
    pub largest_separation_ratio: f64,
    /// Slip that does not count as slip, relative to that by which a cell's shear of the peak pressure answers.
    pub noise: f64,
    /// The least compliance of a pattern of pressures, over that of one cell by itself.
    pub least_compliance: f64,
    /// Limit of the sets of cells under pressure that are tried. In the second half of them only the worst cell joins.
    pub normal_passes: usize,
    /// Limit of the conjugate gradients on one set.
    pub normal_iterations: usize,
    /// Error of the pressure to which a set is solved while it still changes.
    pub set_tolerance: f64,
    /// Overlap, scaled, below which a cell without pressure counts as touching.
    pub overlap: f64,
    /// Pressure of a cell that joins, relative to the largest.
    pub trace: f64,
    /// Depth of the first set of cells, in displacements of a cell under a pressure of 1 by itself.
    pub first_pressure: f64,
    /// Limit of the Newton steps of the friction law.
    pub newton_steps: usize,
    /// Limit of the Krylov iterations of one of them.
    pub krylov_iterations: usize,
    /// Smallest residual that is asked of a correction, relative to that of the law.
    pub least_forcing: f32,
    /// The largest residual of a correction: while cells change between stick and slip, a closer one gains nothing.
    pub largest_forcing: f32,
    /// Residual of a correction over the square of the ratio by which the last step reduced that of the law (Eisenstat and Walker 1996).
    pub forcing: f64,
    /// Share of the tolerance of the law that its last correction may leave.
    pub forcing_margin: f64,
    /// Share of the residual that a first guess leaves to which pressure and friction law are solved, where that is less exact than the
    /// tolerance: what is left of so large a change is changed again by the next temperature.
    pub reduction: f64,
    /// Factor on the tolerance up to which it is.
    pub slack: f64,
    /// Relative error of products in single precision, with its rounding in the sums of many Newton steps. Where this share of a
    /// correction is below the tolerance, the response to it is the sum of the responses to its Krylov directions, which are such products.
    pub single_round_off: f64,
    /// Tolerance of the pressure, relative to the error it begins with, from which on the products of its conjugate gradients are in
    /// single precision.
    pub single_tolerance: f64,
    /// Residual of the friction law, relative to the peak pressure, that will do in a staggered step where none smaller is reached.
    pub staggered_residual: f64,
    /// Krylov iterations a decimal digit of a correction above which the blocks are inverted anew for the next Newton step.
    pub renewal: f64,
    /// Limit of the halvings of a Newton step.
    pub halvings: usize,
    /// Limit of the regularisations on the way to the law, from the largest slip on.
    pub continuation: usize,
    /// Ratio of two of them.
    pub continuation_step: f64,
    /// Residual at which the next one is taken.
    pub continuation_tolerance: f64,
    /// The last of them, relative to the largest slip.
    pub least_regularisation: f64,
    /// Error of the tangents, relative to the largest, at which the linear split of the derivatives has converged, and residual of its linear
    /// systems, which a small change of the pressure by heat magnifies a hundredfold. Each digit costs a tenth of the time.
    pub sensitivity_tolerance: f64,
}

impl Default for PatchSettings {
    fn default() -> Self {
        PatchSettings {
            split_tolerance: 1e-6,
            shear_tolerance: 1e-6,
            first_mechanics_tolerance: 1e-5,
            tolerance: 1e-9,
            least_tolerance: 1e-10,
            largest_separation_ratio: 1e3,
            noise: 1e-4,
            least_compliance: 0.1,
            normal_passes: 60,
            normal_iterations: 200,
            set_tolerance: 1e-4,
            overlap: 1e-10,
            trace: 1e-6,
            first_pressure: 4.0,
            newton_steps: 40,
            krylov_iterations: 60,
            least_forcing: 1e-5,
            largest_forcing: 1e-1,
            forcing: 0.9,
            forcing_margin: 0.5,
            reduction: 3e-3,
            slack: 10.0,
            single_round_off: 1e-5,
            single_tolerance: 1e-4,
            staggered_residual: 1e-2,
            renewal: 4.5,
            halvings: 12,
            continuation: 12,
            continuation_step: 0.2,
            continuation_tolerance: 1e-4,
            least_regularisation: 1e-4,
            sensitivity_tolerance: 1e-7,
        }
    }
}

impl Settings {
    /// Convergence of the operator split of a patch.
    pub fn patch_split(&self) -> SplitSettings {
        SplitSettings {
            tolerance: self.patch.split_tolerance,
            shear_tolerance: self.patch.shear_tolerance,
            // A linearisation costs as much as many sweeps.
            idle_iterations: self.split.idle_iterations.saturating_mul(2),
            accepted_change: 2e-3,
            stalled_tolerance: 2e-3,
            first_mechanics_tolerance: self.patch.first_mechanics_tolerance,
            largest_mechanics_tolerance: self.patch.first_mechanics_tolerance,
            last_mechanics_tolerance: self.patch.least_tolerance,
            mechanics_tolerance: 1e-1,
            ..self.split
        }
    }

    /// Derivatives of the outputs of a patch: its linear systems are solved by iteration.
    pub fn patch_sensitivity(&self) -> SensitivitySettings {
        SensitivitySettings {
            tolerance: self.patch.sensitivity_tolerance,
            ..self.sensitivity
        }
    }
}
