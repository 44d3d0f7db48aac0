//! The data of the normal problem and of its solution.

use nalgebra::DMatrix;

/// What closes the problem.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Constraint {
    /// Σp, positive.
    Total(f64),
    /// δ.
    Penetration(f64),
}

/// The data of one problem with n nodes.
#[derive(Debug, Clone, Copy)]
pub struct NormalProblem<'a> {
    /// C, n × n, symmetric positive definite.
    pub compliance: &'a DMatrix<f64>,
    /// b, n.
    pub profile: &'a [f64],
    /// Load or penetration.
    pub constraint: Constraint,
}

/// What a solver found besides the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalSolution {
    /// δ.
    pub penetration: f64,
    /// Iterations done.
    pub iterations: usize,
}
