//! Data of the normal problem and of its solution.

use nalgebra::DMatrix;
use std::ops::Range;

/// Condition that closes the normal problem: the load or the penetration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Constraint {
    /// Σp, positive.
    Total(f64),
    /// δ.
    Penetration(f64),
}

/// Data of one problem with n nodes.
#[derive(Debug, Clone, Copy)]
pub struct NormalProblem<'a> {
    /// C, n × n, symmetric positive definite.
    pub compliance: &'a DMatrix<f64>,
    /// b, n.
    pub profile: &'a [f64],
    /// Load or penetration.
    pub constraint: Constraint,
    /// Number of nodes at either end that stay free of pressure, whatever their separation.
    pub free_ends: usize,
}

impl NormalProblem<'_> {
    /// Nodes that may come under pressure.
    pub fn candidates(&self) -> Range<usize> {
        self.free_ends..self.profile.len() - self.free_ends
    }
}

/// Solution of a normal problem besides the pressure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NormalSolution {
    /// δ.
    pub penetration: f64,
    /// Iterations done.
    pub iterations: usize,
}
