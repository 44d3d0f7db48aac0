//! The friction problem: the shear traction for a given pressure.
//!
//! Find τ with (30), τ + μ p φ(s) = 0, on the nodes under pressure, or with Coulomb's law itself: |τ| ≤ μ p, s = 0 where
//! |τ| < μ p, and a slip against τ where |τ| = μ p. The slip velocity is
//! s = ∂u₁/∂t − V ∂u₁/∂x₁ + (ω r₀ − V). The strain is taken between the node and the one ahead of it, the difference of
//! |V|/Δx (u₁ − u₁ of the node ahead): with influences that are exact for the tractions, the equations of nodes that stick are
//! then those of the normal problem. [`super::leading_edge`] corrects the slip of the leading nodes.
//!
//! The problem is posed around the tractions of the iteration before: pressure and slip there are given, and how both
//! respond to a change of τ ([`super::response`]). Tractions and displacements are scaled, speeds in m/s.
//!
//! Both laws are equations a dτ + b ds + c dp at each node once they are linearised, and share the matrix
//! diag(a) + diag(b) ∂s/∂τ + diag(c) ∂p/∂τ; [`newton`] solves the regularised one, [`exchange`] Coulomb's.

mod exchange;
mod globalised;
mod linearised;
mod newton;
mod path;
mod problem;

use super::leading_edge::{EdgeCorrection, EdgeValues};
use crate::error::{Error, Result};
use crate::friction::path::{NodeFriction, Passed};
use crate::numerics::dense::{self, largest};
use crate::settings::TangentialSettings;
use linearised::Responded;
use path::ExchangePath;

pub use linearised::LawRow;
pub use problem::{LeadingRows, TangentialProblem};

/// Point at which the last solve ended, on the nodes of its problem.
#[derive(Debug, Clone, Copy)]
pub struct TangentialPoint<'a> {
    /// Pressure, scaled.
    pub pressure: &'a [f64],
    /// Traction utilisation −τ/(μ p), with the sign of the slip.
    pub utilisation: &'a [f64],
    /// Corrections of the slip of the first two rows at the leading edge.
    pub corrections: &'a [EdgeCorrection; 2],
    /// Change of the shear since the start of the solve.
    pub change: &'a [f64],
    /// Slip velocity of the law, `m/s`.
    pub slip: &'a [f64],
    /// μ.
    pub friction: &'a [f64],
    /// Derivatives of μ, where it depends on slip.
    pub of_slip: &'a [NodeFriction],
}

/// End of an iteration, with the number of steps it took.
#[derive(Debug, Clone, Copy)]
enum Ended {
    /// The last step was below the tolerance.
    Converged(usize),
    /// The limit of the steps was reached, or a method in it failed.
    Stalled(usize),
}

impl Ended {
    fn steps(self) -> usize {
        match self {
            Ended::Converged(steps) | Ended::Stalled(steps) => steps,
        }
    }
}

/// Scratch of the methods, and the last factorised matrix.
#[derive(Debug, Clone)]
pub struct Tangential {
    settings: TangentialSettings,
    /// Change of the shear since the start of the solve.
    change: Vec<f64>,
    pressure: Vec<f64>,
    slip: Vec<f64>,
    corrections: [EdgeCorrection; 2],
    /// μ, or the bound of a layer that flows over the pressure; and where it depends on slip its derivatives.
    friction: Vec<f64>,
    of_slip: Vec<NodeFriction>,
    /// The responses to the shear on some nodes.
    responded: Vec<Responded>,
    /// The law's derivatives by the slip and by the pressure, with what μ of a node follows from its own.
    by_slip: Vec<f64>,
    by_pressure: Vec<f64>,
    /// φ.
    utilisation: Vec<f64>,
    /// Coulomb's law: φ = ±1 of the nodes that slip, 0 of those that stick.
    sliding: Vec<f64>,
    residual: Vec<f64>,
    /// Newton's step.
    step: Vec<f64>,
    /// The change before the step.
    before: Vec<f64>,
    /// The change that solves the law for the least ε so far.
    regularised: Vec<f64>,
    rows: Vec<LawRow>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// Whether `factor` may still be used.
    factored: bool,
    /// Length of a step over that of the step before, with this `factor`.
    contraction: f64,
    path: ExchangePath,
    /// dτ/d ln ε.
    by_logarithm: Vec<f64>,
    /// Direction of the path of solutions in the shear.
    tangent: Vec<f64>,
    /// Whether the methods that are fast where they converge have stalled in this step.
    has_stalled: bool,
    /// Residual that the last solve has left of the law, `Pa`.
    left: f64,
    /// Multiplications and additions in this step.
    work: u64,
}

impl Tangential {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize, settings: TangentialSettings) -> Tangential {
        let vector = || vec![0.0; nodes];
        Tangential {
            settings,
            change: vector(),
            pressure: vector(),
            slip: vector(),
            corrections: Default::default(),
            friction: vector(),
            of_slip: vec![NodeFriction::default(); nodes],
            responded: vec![Responded::default(); nodes],
            by_slip: vector(),
            by_pressure: vector(),
            utilisation: vector(),
            sliding: vector(),
            residual: vector(),
            step: vector(),
            before: vector(),
            regularised: vector(),
            rows: vec![LawRow::default(); nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            factored: false,
            contraction: settings.fresh_contraction,
            path: ExchangePath::new(nodes),
            by_logarithm: vector(),
            tangent: vector(),
            has_stalled: false,
            left: 0.0,
            work: 0,
        }
    }

    /// Begins a step: it does not depend on the steps before.
    pub fn start_step(&mut self) {
        self.forget();
        (self.has_stalled, self.work) = (false, 0);
    }

    /// Multiplications and additions in this step, about: a measure of time that is the same on every machine.
    pub fn work(&self) -> u64 {
        self.work
    }

    /// Adds factorisations of a matrix of m nodes and its products with a vector to the work.
    fn count(&mut self, m: usize, factorisations: usize, products: usize) {
        self.work += (factorisations * m * m * m / 3 + products * m * m) as u64;
    }

    /// Forgets the factorised matrix: when the nodes under pressure change.
    pub fn forget(&mut self) {
        self.factored = false;
    }

    /// Residual that the last solve has left of the law, `Pa`: 0 where it is within the tolerance.
    pub fn left(&self) -> f64 {
        self.left
    }

    /// Point of the last solve, with m nodes.
    pub fn point(&self, m: usize) -> TangentialPoint<'_> {
        TangentialPoint {
            pressure: &self.pressure[..m],
            utilisation: &self.utilisation[..m],
            corrections: &self.corrections,
            change: &self.change[..m],
            slip: &self.slip[..m],
            friction: &self.friction[..m],
            of_slip: &self.of_slip[..m],
        }
    }

    /// Changes `shear` (m, on the nodes of the problem) to the solution. `utilisation` is φ at which the solve starts, m: Coulomb's
    /// law starts with the nodes in slip where it is ±1. Returns the largest change.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &TangentialProblem, utilisation: &[f64], shear: &mut [f64]) -> Result<f64> {
        let m = shear.len();
        self.change[..m].fill(0.0);
        self.left = 0.0;
        let mut end = if self.has_stalled {
            Ended::Stalled(0)
        } else if problem.regularisation > 0.0 {
            self.solve_regularised(problem, shear)
        } else {
            self.solve_coulomb(problem, utilisation, shear)
        };
        if let Ended::Stalled(steps) = end {
            self.has_stalled = true;
            end = self.solve_globalised(problem, shear, steps);
        }
        if let Ended::Stalled(iterations) = end {
            return Err(Error::TangentialNotConverged {
                iterations,
                residual: largest(&self.residual[..m]) / largest(problem.pressure),
                tolerance: problem.tolerance,
            });
        }
        for (shear, change) in shear.iter_mut().zip(&self.change) {
            *shear += change;
        }
        Ok(largest(&self.change[..m]))
    }

    /// Updates pressure and slip to those after `self.change`, the corrections at the leading edge included.
    fn update_point(&mut self, problem: &TangentialProblem, shear: &[f64]) {
        let m = shear.len();
        self.count(m, 0, 2);
        dense::multiply(problem.pressure_response, m, &self.change, &mut self.pressure);
        dense::multiply(problem.slip_response, m, &self.change, &mut self.slip);
        for i in 0..m {
            self.pressure[i] = (problem.pressure[i] + self.pressure[i]).max(0.0);
            self.slip[i] += problem.slip[i];
        }
        let leading = &problem.leading;
        let node = |values: &[f64]| leading.rows.map(|row| values[row]);
        let (start, change) = (node(shear), node(&self.change));
        self.corrections = leading.edge.corrections(&EdgeValues {
            pressure: node(&self.pressure),
            shear: std::array::from_fn(|k| start[k] + change[k]),
            friction: problem.friction[leading.rows[0]],
            gap: leading.gap + dense::dot(leading.gap_response, &self.change[..m]),
        });
        for (correction, row) in self.corrections.iter().zip(leading.rows) {
            self.slip[row] += correction.slip;
        }
        self.update_friction(problem);
    }

    /// Updates μ to that at the present slip and pressure.
    fn update_friction(&mut self, problem: &TangentialProblem) {
        let m = problem.friction.len();
        let Some((law, nodes)) = &problem.path else {
            self.friction[..m].copy_from_slice(problem.friction);
            return;
        };
        let mut before = Passed::default();
        for row in law.order(m) {
            let speed = self.slip[row].abs();
            self.of_slip[row] = law.friction(&nodes[row], &before, speed, self.pressure[row]);
            self.friction[row] = self.of_slip[row].coefficient;
            before = self.of_slip[row].passed(speed);
        }
    }

    /// Bound on a node's shear as an affine function of its pressure at an unchanged slip: its part without pressure, and its slope.
    fn bound(&self, problem: &TangentialProblem, node: usize) -> (f64, f64) {
        let friction = self.friction[node];
        if problem.path.is_none() {
            return (0.0, friction);
        }
        let slope = friction + self.pressure[node] * self.of_slip[node].by_pressure();
        ((friction - slope) * self.pressure[node], slope)
    }
}

#[cfg(test)]
mod tests;
