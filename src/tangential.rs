//! The friction problem (30): Newton for the shear traction at given pressure.
//!
//! Find τ with τ + μ p φ(s) = 0 on the nodes under pressure, where the slip velocity is
//! s = (ω r₀ − V) − V ∂u₁/∂x₁ and u₁ = C_tt τ + (what pressure and heat cause). The derivative is taken upwind, from the
//! leading side. Tractions and displacements are scaled, speeds are in m/s.

use crate::compliance::Compliance;
use crate::dense;
use crate::error::{Error, Result};
use crate::friction::{saturation, saturation_slope};

/// The data of one problem with n nodes.
#[derive(Debug, Clone, Copy)]
pub struct TangentialProblem<'a> {
    /// The compliance; C_tt is used.
    pub compliance: &'a Compliance,
    /// u₁ caused by pressure and heat, n.
    pub free_displacement: &'a [f64],
    /// μ p, n; the problem is solved where it is positive.
    pub bound: &'a [f64],
    /// ω r₀ − V, [m/s].
    pub rigid_slip: f64,
    /// V times the displacement scale over the node spacing, [m/s]; its sign gives the leading side.
    pub strain_speed: f64,
    /// ε, [m/s].
    pub regularisation: f64,
}

/// Newton steps at one regularisation.
const NEWTON_STEPS: usize = 40;
/// Halvings of one step in the line search.
const HALVINGS: usize = 12;
/// Largest number of decades of continuation in ε.
const CONTINUATION_DECADES: i32 = 8;
/// Newton step at which the iteration stops, relative to the largest bound; the next one would be its square.
const TOLERANCE: f64 = 1e-11;

/// Scratch of the Newton method.
#[derive(Debug, Clone)]
pub struct Tangential {
    nodes: Vec<usize>,
    displacement: Vec<f64>,
    residual: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
    jacobian: Vec<f64>,
    pivots: Vec<usize>,
    start: Vec<f64>,
}

impl Tangential {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize) -> Tangential {
        Tangential {
            nodes: Vec::with_capacity(nodes),
            displacement: vec![0.0; nodes],
            residual: vec![0.0; nodes],
            step: vec![0.0; nodes],
            trial: vec![0.0; nodes],
            jacobian: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            start: vec![0.0; nodes],
        }
    }

    /// Solves from `shear`; `slip` gets s of the solution, 0 outside the contact. Returns the number of Newton steps.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &TangentialProblem, shear: &mut [f64], slip: &mut [f64]) -> Result<usize> {
        self.nodes.clear();
        self.nodes.extend((0..shear.len()).filter(|&i| problem.bound[i] > 0.0));
        for (shear, &bound) in shear.iter_mut().zip(problem.bound) {
            *shear = shear.clamp(-bound.max(0.0), bound.max(0.0));
        }
        self.start.copy_from_slice(shear);
        let mut iterations = 0;
        match self.newton(problem, problem.regularisation, shear, slip) {
            Ok(steps) => return Ok(steps),
            Err(steps) => iterations += steps,
        }
        // From a large ε, where the law is nearly linear, down to the one asked for.
        shear.copy_from_slice(&self.start);
        let mut last = Ok(0);
        for decade in (0..=CONTINUATION_DECADES).rev() {
            let regularisation = problem.regularisation * 10.0_f64.powf(0.5 * f64::from(decade));
            last = self.newton(problem, regularisation, shear, slip);
            iterations += last.unwrap_or_else(|steps| steps);
        }
        let bound = problem.bound.iter().fold(f64::MIN_POSITIVE, |m, &b| b.max(m));
        last.map(|_| iterations).map_err(|_| Error::TangentialNotConverged {
            iterations,
            residual: self.step.iter().fold(0.0, |m: f64, d| d.abs().max(m)) / bound,
            tolerance: TOLERANCE,
        })
    }

    /// Damped Newton at one ε. `Ok` or `Err` with the number of steps done.
    fn newton(
        &mut self,
        problem: &TangentialProblem,
        regularisation: f64,
        shear: &mut [f64],
        slip: &mut [f64],
    ) -> std::result::Result<usize, usize> {
        let bound = problem.bound.iter().fold(0.0, |m: f64, &b| b.max(m));
        let mut norm = self.update_residual(problem, regularisation, shear, slip);
        if bound == 0.0 {
            return Ok(0);
        }
        for steps in 1..=NEWTON_STEPS {
            if !self.newton_step(problem, regularisation, slip) {
                return Err(steps);
            }
            let largest = self.step.iter().fold(0.0, |m: f64, d| d.abs().max(m));
            let last = largest <= TOLERANCE * bound;
            self.trial.copy_from_slice(shear);
            let mut length = 1.0;
            for halving in 0..=HALVINGS {
                for (&i, step) in self.nodes.iter().zip(&self.step) {
                    shear[i] = self.trial[i] + length * step;
                }
                let trial = self.update_residual(problem, regularisation, shear, slip);
                // The last step is within round-off of the residual: it is not asked to fall.
                if last || trial < (1.0 - 0.1 * length) * norm {
                    norm = trial;
                    break;
                }
                if halving == HALVINGS {
                    return Err(steps);
                }
                length *= 0.5;
            }
            if last {
                return Ok(steps);
            }
        }
        Err(NEWTON_STEPS)
    }

    /// Slip and residual τ + μ p φ(s) on the nodes; returns the residual's 2-norm.
    fn update_residual(
        &mut self,
        problem: &TangentialProblem,
        regularisation: f64,
        shear: &[f64],
        slip: &mut [f64],
    ) -> f64 {
        self.displacement.copy_from_slice(problem.free_displacement);
        dense::multiply_add(
            &problem.compliance.tangential_tangential,
            shear,
            1.0,
            &mut self.displacement,
        );
        slip.fill(0.0);
        let mut square = 0.0;
        for (row, &i) in self.nodes.iter().enumerate() {
            let ahead = leading_neighbour(i, problem.strain_speed);
            let strain = self.displacement[i] - self.displacement[ahead];
            slip[i] = problem.rigid_slip + problem.strain_speed.abs() * strain;
            self.residual[row] = shear[i] + problem.bound[i] * saturation(slip[i], regularisation);
            square += self.residual[row] * self.residual[row];
        }
        square.sqrt()
    }

    /// Solves (1 + μ p φ′(s) ∂s/∂τ) Δτ = −residual into `self.step`. False where the matrix is singular.
    fn newton_step(&mut self, problem: &TangentialProblem, regularisation: f64, slip: &[f64]) -> bool {
        let m = self.nodes.len();
        let compliance = &problem.compliance.tangential_tangential;
        self.step.fill(0.0);
        for (row, &i) in self.nodes.iter().enumerate() {
            let ahead = leading_neighbour(i, problem.strain_speed);
            let stiffening = problem.bound[i] * saturation_slope(slip[i], regularisation) * problem.strain_speed.abs();
            for (column, &j) in self.nodes.iter().enumerate() {
                self.jacobian[column * m + row] = stiffening * (compliance[(i, j)] - compliance[(ahead, j)]);
            }
            self.jacobian[row * m + row] += 1.0;
            self.step[row] = -self.residual[row];
        }
        if !dense::lu(&mut self.jacobian[..m * m], m, &mut self.pivots) {
            return false;
        }
        dense::lu_solve(&self.jacobian, m, &self.pivots, &mut self.step[..m]);
        self.step.iter().all(|step| step.is_finite())
    }
}

/// The next node on the leading side, towards +x₁ for V ≥ 0. Contact nodes always have one: a contact that reaches
/// the end of the window is an error of [`crate::contact`].
fn leading_neighbour(node: usize, speed: f64) -> usize {
    if speed >= 0.0 {
        node + 1
    } else {
        node - 1
    }
}
