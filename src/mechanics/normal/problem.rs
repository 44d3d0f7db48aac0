//! The data of the normal problem and of its solution.

use nalgebra::DMatrix;
use std::ops::Range;

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
    /// So many nodes at either end stay free, whatever lies over them.
    pub free_ends: usize,
}

impl NormalProblem<'_> {
    /// The nodes that may come under pressure.
    pub fn candidates(&self) -> Range<usize> {
        self.free_ends..self.profile.len() - self.free_ends
    }
}

/// What a solver found besides the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalSolution {
    /// δ.
    pub penetration: f64,
    /// Iterations done.
    pub iterations: usize,
}
