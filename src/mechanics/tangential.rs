//! The friction problem (30): Newton for the shear traction.
//!
//! Find τ with τ + μ p φ(s) = 0 on the nodes under pressure, where the slip velocity is
//! s = (ω r₀ − V) − V ∂u₁/∂x₁. The derivative is taken upwind, from the leading side, so that
//! s = (ω r₀ − V) + |V|/Δx (u₁ − u₁ of the node ahead); the bracket is called strain here.
//!
//! The problem is posed around the tractions of the sweep before: pressure and strain there are given, and how both
//! respond to a change of τ ([`super::response`]). Tractions and displacements are scaled, speeds in m/s.

use crate::error::{Error, Result};
use crate::friction::coulomb::{saturation_slope, saturations};
use crate::numerics::dense::{self, largest};
use crate::settings::TangentialSettings;

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

/// How Newton's method at one regularisation ended, with the number of steps it took.
#[derive(Debug, Clone, Copy)]
enum Newton {
    /// The last step was below the tolerance.
    Converged(usize),
    /// The line search or the factorisation failed, or the limit of the steps was reached.
    Stalled(usize),
}

impl Newton {
    fn steps(self) -> usize {
        match self {
            Newton::Converged(steps) | Newton::Stalled(steps) => steps,
        }
    }
}

/// Scratch of the Newton method, and its last factorised matrix.
#[derive(Debug, Clone)]
pub struct Tangential {
    settings: TangentialSettings,
    /// Change of the shear since the start of the solve.
    change: Vec<f64>,
    pressure: Vec<f64>,
    strain: Vec<f64>,
    slip: Vec<f64>,
    /// φ(s).
    saturation: Vec<f64>,
    residual: Vec<f64>,
    /// Newton's step.
    step: Vec<f64>,
    /// The change before the step.
    before: Vec<f64>,
    /// Change of μ p φ(s) with the strain, and with the pressure.
    per_strain: Vec<f64>,
    per_pressure: Vec<f64>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// Whether `factor` may still be used.
    factored: bool,
    /// Length of a step over that of the step before, with this `factor`.
    contraction: f64,
}

impl Tangential {
    /// Scratch for problems with up to `nodes` nodes.
    pub fn new(nodes: usize, settings: TangentialSettings) -> Tangential {
        Tangential {
            settings,
            change: vec![0.0; nodes],
            pressure: vec![0.0; nodes],
            strain: vec![0.0; nodes],
            slip: vec![0.0; nodes],
            saturation: vec![0.0; nodes],
            residual: vec![0.0; nodes],
            step: vec![0.0; nodes],
            before: vec![0.0; nodes],
            per_strain: vec![0.0; nodes],
            per_pressure: vec![0.0; nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            factored: false,
            contraction: settings.fresh_contraction,
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
        let mut end = self.newton(problem, problem.regularisation, shear);
        let mut iterations = end.steps();
        if let Newton::Stalled(_) = end {
            // From a large ε, where the law is nearly linear, down to the one asked for.
            self.change[..m].fill(0.0);
            for half_decades in (0..=self.settings.continuation).rev() {
                self.forget();
                let regularisation = problem.regularisation * 10.0_f64.powf(0.5 * half_decades as f64);
                end = self.newton(problem, regularisation, shear);
                iterations += end.steps();
            }
            self.forget();
        }
        if let Newton::Stalled(_) = end {
            return Err(Error::TangentialNotConverged {
                iterations,
                residual: largest(&self.residual[..m]) / largest(&problem.pressure[..m]),
                tolerance: problem.tolerance,
            });
        }
        for (shear, change) in shear.iter_mut().zip(&self.change) {
            *shear += change;
        }
        Ok(largest(&self.change[..m]))
    }

    /// Damped Newton at one ε, with the factorised matrix as long as it contracts fast.
    fn newton(&mut self, problem: &TangentialProblem, regularisation: f64, shear: &[f64]) -> Newton {
        let m = shear.len();
        let settings = self.settings;
        let tolerance = problem.tolerance * largest(problem.pressure);
        let mut norm = self.update_residual(problem, regularisation, shear);
        let mut last_length = f64::INFINITY;
        for steps in 1..=settings.newton_steps {
            let fresh = !self.factored;
            if fresh && !self.factorise(problem, regularisation, m) {
                return Newton::Stalled(steps);
            }
            self.find_step(m);
            let length = largest(&self.step[..m]);
            if !fresh && last_length.is_finite() {
                self.contraction = (length / last_length).max(settings.least_contraction);
            }
            let round_off = length <= tolerance;
            let contracts = length <= settings.slow_contraction * last_length || round_off;
            if !fresh && !contracts {
                self.factored = false;
                continue;
            }
            let last = round_off || length * self.contraction <= tolerance;
            self.before[..m].copy_from_slice(&self.change[..m]);
            let mut damping = 1.0;
            for halving in 0..=settings.halvings {
                for ((change, before), step) in self.change.iter_mut().zip(&self.before).zip(&self.step[..m]) {
                    *change = before + damping * step;
                }
                let trial = self.update_residual(problem, regularisation, shear);
                // A step as short as round-off cannot be expected to lower the residual.
                if round_off || trial <= (1.0 - 0.1 * damping) * norm {
                    norm = trial;
                    break;
                }
                if halving == settings.halvings || !fresh {
                    if fresh {
                        return Newton::Stalled(steps);
                    }
                    // The step of a matrix that was factorised elsewhere may raise the residual: go back, and factorise here.
                    self.change[..m].copy_from_slice(&self.before[..m]);
                    norm = self.update_residual(problem, regularisation, shear);
                    self.factored = false;
                    break;
                }
                damping *= 0.5;
            }
            if last && self.factored && damping == 1.0 {
                return Newton::Converged(steps);
            }
            last_length = if damping < 1.0 {
                self.factored = false;
                f64::INFINITY
            } else {
                length
            };
        }
        Newton::Stalled(settings.newton_steps)
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
            self.per_strain[i] = problem.friction[i] * self.pressure[i] * slope;
            self.per_pressure[i] = problem.friction[i] * self.saturation[i];
        }
        for column in 0..m {
            let range = column * m..(column + 1) * m;
            let strain = &problem.strain_response[range.clone()];
            let pressure = &problem.pressure_response[range.clone()];
            for (i, entry) in self.factor[range].iter_mut().enumerate() {
                *entry = self.per_strain[i] * strain[i] + self.per_pressure[i] * pressure[i];
            }
            self.factor[column * m + column] += 1.0;
        }
        self.factored = dense::lu(&mut self.factor[..m * m], m, &mut self.pivots);
        self.contraction = self.settings.fresh_contraction;
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::coulomb::saturation;
    use proptest::prelude::*;

    const NODES: usize = 6;

    /// A problem without response: pressure and strain stay what they are.
    fn stiff<'a>(pressure: &'a [f64], zero: &'a [f64], friction: &'a [f64], rigid_slip: f64) -> TangentialProblem<'a> {
        TangentialProblem {
            pressure,
            strain: &zero[..pressure.len()],
            pressure_response: zero,
            strain_response: zero,
            friction,
            rigid_slip,
            strain_speed: 10.0,
            regularisation: 1e-3,
            tolerance: 1e-12,
        }
    }

    #[test]
    fn without_compliance_the_shear_is_coulombs_law_of_the_rigid_slip() {
        let (pressure, friction) = ([0.2, 1.0, 0.6], [0.4, 0.3, 0.5]);
        let zero = [0.0; 9];
        for rigid_slip in [-0.2, -1e-4, 0.0, 5e-4, 3.0] {
            let mut shear = [0.1, -0.2, 0.0];
            let mut solver = Tangential::new(3, TangentialSettings::default());
            let problem = stiff(&pressure, &zero, &friction, rigid_slip);
            solver.solve(&problem, &mut shear).unwrap();
            for node in 0..3 {
                let expected = -friction[node] * pressure[node] * saturation(rigid_slip, 1e-3);
                assert!((shear[node] - expected).abs() < 1e-12, "{rigid_slip}: {shear:?}");
                assert_eq!(solver.point().slip[node], rigid_slip);
            }
        }
    }

    #[test]
    fn a_limit_of_no_steps_is_an_error_with_its_numbers() {
        let settings = TangentialSettings {
            newton_steps: 0,
            ..TangentialSettings::default()
        };
        let (one, zero) = ([1.0], [0.0]);
        let mut shear = [0.0];
        let failed = Tangential::new(1, settings).solve(&stiff(&one, &zero, &one, 1.0), &mut shear);
        assert!(matches!(
            failed,
            Err(Error::TangentialNotConverged { iterations: 0, residual, .. }) if residual > 0.5
        ));
        assert_eq!(shear, [0.0]);
    }

    proptest! {
        /// Strain that falls with the shear at the node itself and less at its neighbours, as an elastic surface has it, a
        /// pressure that follows a little, regularisations down to a thousandth of the slip.
        #[test]
        fn the_solution_satisfies_the_law(
            pressure in prop::collection::vec(0.1..1.0, NODES),
            strain in prop::collection::vec(-1e-3..1e-3, NODES),
            friction in prop::collection::vec(0.1..0.6, NODES),
            follows in prop::collection::vec(-0.05..0.05, NODES * NODES),
            rigid_slip in -0.05..0.05,
            log_regularisation in -5.0..-2.0,
        ) {
            let regularisation = 10.0_f64.powf(log_regularisation);
            let response: Vec<f64> = (0..NODES * NODES)
                .map(|k| 2e-3 / (1.0 + (k / NODES).abs_diff(k % NODES) as f64))
                .collect();
            let problem = TangentialProblem {
                pressure: &pressure,
                strain: &strain,
                pressure_response: &follows,
                strain_response: &response,
                friction: &friction,
                rigid_slip,
                strain_speed: 10.0,
                regularisation,
                tolerance: 1e-12,
            };
            let mut shear = vec![0.0; NODES];
            Tangential::new(NODES, TangentialSettings::default()).solve(&problem, &mut shear).unwrap();
            for row in 0..NODES {
                let sum = |matrix: &[f64]| (0..NODES).map(|column| matrix[column * NODES + row] * shear[column]).sum::<f64>();
                let slip = rigid_slip + 10.0 * (strain[row] + sum(&response));
                let p = (pressure[row] + sum(&follows)).max(0.0);
                let law = -friction[row] * p * saturation(slip, regularisation);
                // The slope of the law, μ p/ε ds/dτ ≤ 0.6 · 10 · 4e-3/1e-5, times the tolerance of the shear.
                prop_assert!((shear[row] - law).abs() < 1e-8, "{row}: {} {law}", shear[row]);
            }
        }
    }
}
