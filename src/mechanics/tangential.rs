//! The friction problem (30): Newton for the shear traction.
//!
//! Find τ with τ + μ p φ(s) = 0 on the nodes under pressure, where the slip velocity is
//! s = (ω r₀ − V) − V ∂u₁/∂x₁. The derivative is taken upwind, from the leading side, so that
//! s = (ω r₀ − V) + |V|/Δx (u₁ − u₁ of the node ahead); the bracket is called strain here.
//!
//! The problem is posed around the tractions of the sweep before: pressure and strain there are given, and how both
//! respond to a change of τ (see `Response` of [`crate::mechanics`]). Tractions and displacements are scaled, speeds in m/s.

use crate::error::{Error, Result};
use crate::friction::coulomb::{saturation_slope, saturations};
use crate::numerics::dense::{self, largest};

/// The data of one problem on the m nodes under pressure.
#[derive(Debug, Clone, Copy)]
pub struct TangentialProblem<'a> {
    /// p at the shear the solve starts from, m.
    pub pressure: &'a [f64],
    /// Strain at the shear the solve starts from, m.
    pub strain: &'a [f64],
    /// ∂p/∂τ, m × m.
    pub pressure_response: &'a [f64],
    /// ∂strain/∂τ, m × m.
    pub strain_response: &'a [f64],
    /// μ, m.
    pub friction: &'a [f64],
    /// ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// |V| times the displacement scale over the node spacing, `m/s`.
    pub strain_speed: f64,
    /// ε, `m/s`.
    pub regularisation: f64,
    /// Newton step that may be left out, relative to the largest pressure.
    pub tolerance: f64,
}

/// Where the last solve ended, on the nodes of its problem.
#[derive(Debug, Clone, Copy)]
pub struct Point<'a> {
    /// Pressure, scaled.
    pub pressure: &'a [f64],
    /// Slip velocity, `m/s`.
    pub slip: &'a [f64],
}

/// Newton steps at one regularisation.
const NEWTON_STEPS: usize = 60;
/// Halvings of one step in the line search.
const HALVINGS: usize = 12;
/// Half-decades of continuation in ε.
const CONTINUATION: i32 = 10;
/// A factorisation is kept while each step is shorter than this share of the one before.
const SLOW_CONTRACTION: f64 = 0.1;

/// What is expected of a fresh factorisation, as long as no second step has shown it. What it promises too much is left to
/// the next sweep, which starts from the residual that there is.
const FRESH_CONTRACTION: f64 = 0.01;
/// Nor is less believed where the steps are round-off.
const LEAST_CONTRACTION: f64 = 1e-3;

/// Scratch of the Newton method, and its last factorised matrix.
#[derive(Debug, Clone)]
pub struct Tangential {
    /// Change of the shear since the start of the solve.
    change: Vec<f64>,
    pressure: Vec<f64>,
    strain: Vec<f64>,
    slip: Vec<f64>,
    /// φ(s).
    saturation: Vec<f64>,
    residual: Vec<f64>,
    step: Vec<f64>,
    trial: Vec<f64>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// Whether `factor` may still be used.
    factored: bool,
    /// Length of a step over that of the step before, with this `factor`.
    contraction: f64,
}

impl Tangential {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize) -> Tangential {
        Tangential {
            change: vec![0.0; nodes],
            pressure: vec![0.0; nodes],
            strain: vec![0.0; nodes],
            slip: vec![0.0; nodes],
            saturation: vec![0.0; nodes],
            residual: vec![0.0; nodes],
            step: vec![0.0; nodes],
            trial: vec![0.0; nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            factored: false,
            contraction: FRESH_CONTRACTION,
        }
    }

    /// Forgets the factorised matrix: at the start of a step, so that it does not depend on the steps before, and
    /// when the nodes under pressure change.
    pub fn forget(&mut self) {
        self.factored = false;
    }

    /// Pressure and slip at the point of the last solve.
    pub fn point(&self) -> Point<'_> {
        Point {
            pressure: &self.pressure,
            slip: &self.slip,
        }
    }

    /// Factorises at the point of the last solve. False where the matrix is singular.
    pub fn linearise(&mut self, problem: &TangentialProblem) -> bool {
        self.factorise(problem, problem.regularisation, problem.pressure.len())
    }

    /// Solves with the matrix of [`Tangential::linearise`], in place.
    pub fn solve_linear(&self, values: &mut [f64]) {
        dense::lu_solve(&self.factor, values.len(), &self.pivots, values);
    }

    /// Changes `shear` (m, on the nodes of the problem) to the solution. Returns the largest change.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &TangentialProblem, shear: &mut [f64]) -> Result<f64> {
        let m = shear.len();
        self.change[..m].fill(0.0);
        let mut last = self.newton(problem, problem.regularisation, shear);
        if last.is_err() {
            // From a large ε, where the law is nearly linear, down to the one asked for.
            self.change[..m].fill(0.0);
            let mut iterations = last.unwrap_or_else(|steps| steps);
            for half_decades in (0..=CONTINUATION).rev() {
                self.forget();
                let regularisation = problem.regularisation * 10.0_f64.powf(0.5 * f64::from(half_decades));
                last = self.newton(problem, regularisation, shear);
                iterations += last.unwrap_or_else(|steps| steps);
            }
            self.forget();
            last = last.map_err(|_| iterations);
        }
        match last {
            Ok(_) => {
                for (shear, change) in shear.iter_mut().zip(&self.change) {
                    *shear += change;
                }
                Ok(largest(&self.change[..m]))
            }
            Err(iterations) => Err(Error::TangentialNotConverged {
                iterations,
                residual: largest(&self.residual[..m]) / largest(&problem.pressure[..m]),
                tolerance: problem.tolerance,
            }),
        }
    }

    /// Damped Newton at one ε, with the factorised matrix as long as it contracts fast. `Ok` or `Err` with the
    /// number of steps.
    fn newton(
        &mut self,
        problem: &TangentialProblem,
        regularisation: f64,
        shear: &[f64],
    ) -> std::result::Result<usize, usize> {
        let m = shear.len();
        let tolerance = problem.tolerance * largest(problem.pressure);
        let mut norm = self.update_residual(problem, regularisation, shear);
        let mut last_length = f64::INFINITY;
        for steps in 1..=NEWTON_STEPS {
            let fresh = !self.factored;
            if fresh && !self.factorise(problem, regularisation, m) {
                return Err(steps);
            }
            self.find_step(m);
            let length = largest(&self.step[..m]);
            if !fresh && last_length.is_finite() {
                self.contraction = (length / last_length).max(LEAST_CONTRACTION);
            }
            let round_off = length <= tolerance;
            let contracts = length <= SLOW_CONTRACTION * last_length || round_off;
            if !fresh && !contracts {
                self.factored = false;
                continue;
            }
            let last = round_off || length * self.contraction <= tolerance;
            self.trial[..m].copy_from_slice(&self.change[..m]);
            let mut damping = 1.0;
            for halving in 0..=HALVINGS {
                for ((change, trial), step) in self.change.iter_mut().zip(&self.trial).zip(&self.step[..m]) {
                    *change = trial + damping * step;
                }
                let trial = self.update_residual(problem, regularisation, shear);
                // So short a step is within round-off of the residual: it is not asked to fall.
                if round_off || trial <= (1.0 - 0.1 * damping) * norm {
                    norm = trial;
                    break;
                }
                if halving == HALVINGS || !fresh {
                    if fresh {
                        return Err(steps);
                    }
                    // An old matrix may point uphill: factorise at the point before.
                    self.change[..m].copy_from_slice(&self.trial[..m]);
                    norm = self.update_residual(problem, regularisation, shear);
                    self.factored = false;
                    break;
                }
                damping *= 0.5;
            }
            if last && self.factored && damping == 1.0 {
                return Ok(steps);
            }
            last_length = if damping < 1.0 {
                self.factored = false;
                f64::INFINITY
            } else {
                length
            };
        }
        Err(NEWTON_STEPS)
    }

    /// Pressure, slip, φ(s) and residual τ + μ p φ(s) after `self.change`; returns the residual's 2-norm.
    fn update_residual(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) -> f64 {
        let m = shear.len();
        dense::multiply(problem.pressure_response, m, &self.change, &mut self.pressure);
        dense::multiply(problem.strain_response, m, &self.change, &mut self.strain);
        for i in 0..m {
            self.pressure[i] = (problem.pressure[i] + self.pressure[i]).max(0.0);
            self.slip[i] = problem.rigid_slip + problem.strain_speed * (problem.strain[i] + self.strain[i]);
        }
        saturations(&self.slip[..m], regularisation, &mut self.saturation);
        let mut square = 0.0;
        for (i, shear) in shear.iter().enumerate() {
            let bound = problem.friction[i] * self.pressure[i];
            self.residual[i] = shear + self.change[i] + bound * self.saturation[i];
            square += self.residual[i] * self.residual[i];
        }
        square.sqrt()
    }

    /// Factorises 1 + μ p φ′(s) ∂s/∂τ + μ φ(s) ∂p/∂τ at the present point. False where it is singular.
    fn factorise(&mut self, problem: &TangentialProblem, regularisation: f64, m: usize) -> bool {
        for i in 0..m {
            let slope = saturation_slope(self.slip[i], regularisation) * problem.strain_speed;
            self.trial[i] = problem.friction[i] * self.pressure[i] * slope;
            self.step[i] = problem.friction[i] * self.saturation[i];
        }
        for column in 0..m {
            let range = column * m..(column + 1) * m;
            let strain = &problem.strain_response[range.clone()];
            let pressure = &problem.pressure_response[range.clone()];
            for (i, entry) in self.factor[range].iter_mut().enumerate() {
                *entry = self.trial[i] * strain[i] + self.step[i] * pressure[i];
            }
            self.factor[column * m + column] += 1.0;
        }
        self.factored = dense::lu(&mut self.factor[..m * m], m, &mut self.pivots);
        self.contraction = FRESH_CONTRACTION;
        self.factored
    }

    /// Newton step −J⁻¹ residual.
    fn find_step(&mut self, m: usize) {
        for (step, residual) in self.step.iter_mut().zip(&self.residual[..m]) {
            *step = -residual;
        }
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.step[..m]);
    }
}
