//! Settings of the interface vector.

/// The interface vector of hard steps by Newton's method, and the linear systems of its changes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct InterfaceSettings {
    /// Limit of the sweeps of Newton's method, line search included.
    pub newton_sweeps: usize,
    /// Limit of the Newton steps.
    pub newton_steps: usize,
    /// Change of the interface vector at which they end, in tolerances of the split: the sweep that closes the step adds to it.
    pub newton_margin: f64,
    /// Residual of the linear system of a Newton step, relative to the right-hand side.
    pub newton_krylov_tolerance: f64,
    /// Limit of the halvings of a Newton step.
    pub halvings: usize,
    /// Steps of Newton's method that are taken in full although the residual does not fall: friction that is steep in temperature may jump.
    pub jumps: usize,
    /// Share of the decrease that the linear system predicts which must be there for a step to be taken.
    pub descent: f64,
    /// Share of a step's budget of work that Newton's method may take.
    pub work: f64,
    /// Limit of the solutions of the mechanics for one interface vector: nodes under pressure may change in each.
    pub mechanics_sweeps: usize,
    /// Change of the shear at which they end, relative to the peak pressure.
    pub mechanics_tolerance: f64,
    /// Limit of the Krylov iterations of one linear system in single precision.
    pub krylov_iterations: usize,
    /// The smallest residual that is asked of it: round-off of single precision.
    pub krylov_tolerance: f64,
    /// Limit of the corrections in single precision to a solution in double precision.
    pub refinements: usize,
    /// Ratio of two residuals above which round-off has been reached.
    pub least_refinement: f64,
}

impl Default for InterfaceSettings {
    fn default() -> Self {
        InterfaceSettings {
            newton_sweeps: 40,
            newton_steps: 25,
            newton_margin: 0.3,
            newton_krylov_tolerance: 1e-3,
            halvings: 6,
            jumps: 3,
            descent: 1e-4,
            work: 0.03,
            mechanics_sweeps: 30,
            mechanics_tolerance: 1e-11,
            krylov_iterations: 60,
            krylov_tolerance: 1e-5,
            refinements: 8,
            least_refinement: 0.5,
        }
    }
}
