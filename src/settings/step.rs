//! Settings of a communication step.

use crate::parameters::{ContactModel, Parameters};

/// Division of a step into sub-steps.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StepSettings {
    /// A change of the inputs by more than this share of their scale is a jump: what follows it is a transient of the
    /// length of a passage, which one long implicit step would smear.
    pub jump: f64,
    /// Length of the first sub-step after a jump, in passages of the contact window; each further one is twice as long.
    pub first_substep: f64,
    /// Largest number of sub-steps of equal length while the inputs change at given rates.
    pub ramp_substeps: f64,
    /// Shortest time that a step takes, `s`: a rate of change over less would overflow, and no output tells the
    /// difference.
    pub shortest: f64,
    /// Number of times in one step that a sub-step that fails is tried again with a quarter of its length; those after
    /// it stay below half of it. 12: a 16-millionth of the step.
    pub retries: usize,
    /// Sub-steps at that limit after which it is doubled.
    pub substeps_at_limit: usize,
    /// Number of sub-steps in which the rest of a step is taken staggered whose coupled equations are not solved; 0 refuses such a
    /// step.
    pub staggered_substeps: usize,
    /// Number of times in one step that a staggered sub-step that fails is tried again with a quarter of its length.
    pub staggered_retries: usize,
    /// Budget of a step in multiplications and additions, about: counted, not timed. That of a line on any mesh, and of patches and profiles on up to the
    /// default number of cells; a model on more cells takes so much more as its solutions do ([`StepSettings::for_cells`]).
    pub work: u64,
    /// Work of the mechanics in a staggered sub-step after which they are not solved any closer, with the same factor.
    pub staggered_work: u64,
}

impl StepSettings {
    /// Settings with budgets for the cells of the given parameters. A product takes work as the square of the cells along times the strips; what
    /// the friction law's blocks take, as the cube of the cells along, is the largest part on many cells.
    pub fn for_cells(self, parameters: &Parameters) -> StepSettings {
        if parameters.contact_model == ContactModel::Line {
            return self;
        }
        let default = Parameters::default();
        let along = parameters.patch_nodes as f64 / default.patch_nodes as f64;
        let across = parameters.patch_strips as f64 / default.patch_strips as f64;
        let factor = (along.powi(3) * across).max(1.0);
        let times = |work: u64| (factor * work as f64) as u64;
        StepSettings {
            work: times(self.work),
            staggered_work: times(self.staggered_work),
            ..self
        }
    }
}

impl Default for StepSettings {
    fn default() -> Self {
        StepSettings {
            jump: 0.2,
            first_substep: 0.25,
            ramp_substeps: 50.0,
            shortest: 1e-100,
            retries: 12,
            substeps_at_limit: 4,
            staggered_substeps: 4,
            staggered_retries: 6,
            work: 80_000_000,
            staggered_work: 8_000_000,
        }
    }
}
