//! Convergence of the interface vector (Step 4 of section 4 of the paper: ‖Δθ‖ ≤ η), and how accurately the parts of a sweep are to
//! be solved until then.
//!
//! The iteration contracts: each change is some ratio of the one before, and so the error that remains after a change
//! is about that change times the ratio. The step has converged where that estimate is below the tolerance, which saves the
//! iteration that would only confirm it.

use crate::error::Error;
use crate::mechanics::normal_tangential::TractionChange;
use crate::settings::SplitSettings;

/// Test of the iterations on one interface vector.
#[derive(Debug, Clone, Copy)]
pub struct ConvergenceTest {
    settings: SplitSettings,
    /// Change of the interface vector in the last iteration; infinite before the first.
    change: f64,
    /// Ratio of the last two changes.
    ratio: f64,
    /// Change of the shear in the last iteration, relative to the peak pressure.
    shear_change: f64,
    /// Factor on the tolerance of the mechanics: smaller after iterations that did not contract.
    sharpened: f64,
}

impl ConvergenceTest {
    /// Test before the first iteration.
    pub fn new(settings: SplitSettings) -> ConvergenceTest {
        ConvergenceTest {
            settings,
            change: f64::INFINITY,
            ratio: f64::INFINITY,
            shear_change: f64::INFINITY,
            sharpened: 1.0,
        }
    }

    /// Tolerance for the mechanics of the next iteration. At high speed a small error of the shear is a large one of the slip,
    /// and with it of the heat: where the split does not contract, it may be that error which it sees.
    pub fn mechanics_tolerance(&self) -> f64 {
        let last = self.settings.last_mechanics_tolerance;
        let largest = if self.change.is_finite() {
            self.settings.largest_mechanics_tolerance
        } else {
            self.settings.first_mechanics_tolerance
        };
        (self.sharpened * self.settings.mechanics_tolerance * self.seen_change())
            .clamp(last, (self.sharpened * largest).max(last))
    }

    /// Change that the errors of the next mechanics must not hide. While the iteration contracts, it is the next change, foretold by the last contraction;
    /// one that is foretold smaller than `least_seen_change` counts as that, as a smaller one ends the iteration anyway. Else it is the last change.
    fn seen_change(&self) -> f64 {
        let floor = self.settings.least_seen_change * self.settings.tolerance;
        if self.ratio < self.settings.trusted_contraction {
            self.change.min(floor).max(self.ratio * self.change)
        } else {
            self.change
        }
    }

    /// Takes the change of an iteration and what its mechanics changed. Returns whether the vector has converged.
    pub fn is_passed(&mut self, change: f64, tractions: &TractionChange) -> bool {
        let contraction = self.contraction(change);
        if contraction == 1.0 && self.change.is_finite() {
            self.sharpened *= self.settings.sharpening;
        }
        self.ratio = change / self.change;
        self.change = change;
        self.shear_change = tractions.shear_change;
        // A node that comes and goes with next to no pressure holds nothing up.
        let margin = if tractions.set_changed {
            self.settings.set_margin
        } else {
            1.0
        };
        change * contraction <= margin * self.settings.tolerance
            && tractions.shear_change * contraction <= margin * self.settings.shear_tolerance
    }

    /// Ratio of this change to the last one, 1 where it cannot be trusted.
    fn contraction(&self, change: f64) -> f64 {
        let last = self.change;
        if change < self.settings.trusted_contraction * last && last.is_finite() {
            (change / last).max(self.settings.least_contraction)
        } else {
            1.0
        }
    }

    /// Whether the last iteration has contracted by so much that plain ones go on.
    pub fn contracts(&self) -> bool {
        self.ratio < self.settings.plain_below
    }

    /// Replaces the change of the last iteration, after more of it has been computed.
    pub fn amend(&mut self, change: f64) {
        self.change = change;
    }

    /// Error of a step that has not converged: it names the residual that is too large.
    pub fn error(&self, iterations: usize) -> Error {
        let (tolerance, shear_tolerance) = (self.settings.tolerance, self.settings.shear_tolerance);
        if self.change <= tolerance && self.shear_change > shear_tolerance {
            return Error::MechanicsNotConverged {
                iterations,
                residual: self.shear_change,
                tolerance: shear_tolerance,
            };
        }
        Error::SplitNotConverged {
            iterations,
            residual: self.change,
            tolerance,
        }
    }

    /// Change of the last iteration.
    pub fn change(&self) -> f64 {
        self.change
    }
}
