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
mod newton;
mod path;

use super::leading_edge::{EdgeCorrection, EdgeValues, LeadingEdge};
use crate::error::{Error, Result};
use crate::friction::path::{NodeFriction, Passed, PassedTogether, PathLaw, PathNode};
use crate::numerics::dense::{self, largest};
use crate::settings::TangentialSettings;
use path::ExchangePath;

/// Data of one problem on the m nodes under pressure.
#[derive(Debug, Clone, Copy)]
pub struct TangentialProblem<'a> {
    /// p at the shear the solve starts from, m.
    pub pressure: &'a [f64],
    /// Slip velocity at the shear the solve starts from, without what the leading edge adds, `m/s`, m.
    pub slip: &'a [f64],
    /// ∂p/∂τ, m × m.
    pub pressure_response: &'a [f64],
    /// ∂s/∂τ without the leading edge, `m/s`, m × m.
    pub slip_response: &'a [f64],
    /// μ, m; where it depends on slip, that without slip.
    pub friction: &'a [f64],
    /// Law by which μ depends on slip, m nodes; none where it does not.
    pub path: Option<(PathLaw, &'a [PathNode])>,
    /// Leading edge, with the rows that it corrects.
    pub leading: LeadingRows<'a>,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
    /// Whether a solution for a larger ε will do where the law has none that is found.
    pub accepts_regularised: bool,
    /// Newton step that may be left out, relative to the largest pressure.
    pub tolerance: f64,
}

/// Leading edge of a problem, with the rows of the nodes that it corrects.
#[derive(Debug, Clone, Copy)]
pub struct LeadingRows<'a> {
    /// Leading edge, which corrects the slip.
    pub edge: LeadingEdge,
    /// Rows of the three leading nodes, the first of them first; only the first counts where the edge is not resolved.
    pub rows: [usize; 3],
    /// Separation of the node ahead at the shear the solve starts from.
    pub gap: f64,
    /// Response of the separation ahead to the shear, m.
    pub gap_response: &'a [f64],
}

impl LeadingRows<'_> {
    /// Change of the corrections of the slip of the first two rows with the shear on node `column`.
    pub fn response(&self, corrections: &[EdgeCorrection; 2], pressure_response: &[f64], column: usize) -> [f64; 2] {
        let m = self.gap_response.len();
        let mut change = EdgeValues {
            pressure: self.rows.map(|row| pressure_response[column * m + row]),
            gap: self.gap_response[column],
            ..EdgeValues::default()
        };
        for (shear, row) in change.shear.iter_mut().zip(self.rows) {
            *shear = if row == column { 1.0 } else { 0.0 };
        }
        [corrections[0].change(&change), corrections[1].change(&change)]
    }
}

/// Columns whose links are followed side by side: each link waits for the one before it in its column. Four at a time saved
/// 3 % of a step with memory.
const LANES: usize = 4;

/// Responses of a node to the shear on some others.
#[derive(Debug, Clone, Copy, Default)]
struct Responded {
    /// Response of the node's slip; later the change of its bound by the slip of the nodes before it.
    slip: [f64; LANES],
    /// Response of the node's pressure.
    pressure: [f64; LANES],
}

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

/// Linearised law of one node, a dτ + b ds + c dp + e dμ.
#[derive(Debug, Clone, Copy, Default)]
pub struct LawRow {
    /// Derivative a by the shear.
    pub by_shear: f64,
    /// Derivative b by the slip velocity, `s/m`.
    pub by_slip: f64,
    /// Derivative c by the pressure.
    pub by_pressure: f64,
    /// Derivative e by μ.
    pub by_friction: f64,
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

    /// Linearised law at the point of [`Tangential::linearise`].
    pub fn rows(&self) -> &[LawRow] {
        &self.rows
    }

    /// Factorises at the point of the last solve. False where the matrix is singular.
    pub fn linearise(&mut self, problem: &TangentialProblem) -> bool {
        if problem.regularisation > 0.0 {
            self.set_regularised_rows(problem, problem.regularisation);
        } else {
            self.set_coulomb_rows(problem);
        }
        self.factorise(problem)
    }

    /// Solves with the matrix of [`Tangential::linearise`], in place.
    pub fn solve_linear(&self, values: &mut [f64]) {
        dense::lu_solve(&self.factor, values.len(), &self.pivots, values);
    }

    /// Changes `shear` (m, on the nodes of the problem) to the solution. `utilisation` is φ at which the solve starts, m: Coulomb's
    /// law starts with the nodes in slip where it is ±1. Returns the largest change.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &TangentialProblem, utilisation: &[f64], shear: &mut [f64]) -> Result<f64> {
        let m = shear.len();
        self.change[..m].fill(0.0);
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

    /// Replaces changes of the slip, in place, by those of μ that follow from them and from changes of the pressure, at the point of
    /// the last solve.
    pub fn friction_tangent(&self, law: &PathLaw, pressure: &[f64], slip: &mut [f64]) {
        let mut before = Passed::default();
        for row in law.order(slip.len()) {
            let (of_slip, speed) = (&self.of_slip[row], self.slip[row].signum() * slip[row]);
            let (linked, passed) = of_slip.change(&before, speed, pressure[row]);
            slip[row] = linked + of_slip.by_speed() * speed + of_slip.by_pressure() * pressure[row];
            before = passed;
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

    /// Factorises the law's rows at the present point. False where the matrix is singular.
    fn factorise(&mut self, problem: &TangentialProblem) -> bool {
        let m = problem.pressure.len();
        self.count(m, 1, 2);
        let rows = &self.rows[..m];
        let (by_slip, by_pressure) = (&mut self.by_slip[..m], &mut self.by_pressure[..m]);
        for (row, law) in rows.iter().enumerate() {
            (by_slip[row], by_pressure[row]) = (law.by_slip, law.by_pressure);
            if problem.path.is_some() {
                let of_slip = &self.of_slip[row];
                by_slip[row] += law.by_friction * of_slip.by_speed() * self.slip[row].signum();
                by_pressure[row] += law.by_friction * of_slip.by_pressure();
            }
        }
        for column in 0..m {
            let range = column * m..(column + 1) * m;
            let slip = &problem.slip_response[range.clone()];
            let pressure = &problem.pressure_response[range.clone()];
            let factor = &mut self.factor[range];
            let laws = by_pressure.iter().zip(&*by_slip);
            for (((entry, (by_pressure, by_slip)), slip), pressure) in
                factor.iter_mut().zip(laws).zip(slip).zip(pressure)
            {
                *entry = by_slip * slip + by_pressure * pressure;
            }
            factor[column] += rows[column].by_shear;
            let corrections = problem
                .leading
                .response(&self.corrections, problem.pressure_response, column);
            for (correction, row) in corrections.iter().zip(problem.leading.rows) {
                factor[row] += by_slip[row] * correction;
            }
        }
        if let Some((law, _)) = &problem.path
            && law.remembers()
        {
            self.add_links(problem, law);
        }
        self.factored = dense::lu(&mut self.factor[..m * m], m, &mut self.pivots);
        self.contraction = self.settings.fresh_contraction;
        self.factored
    }

    /// Adds to the law's rows the derivatives of a node's bound by the slip of the nodes before it.
    fn add_links(&mut self, problem: &TangentialProblem, law: &PathLaw) {
        let m = problem.pressure.len();
        self.count(m, 0, 4);
        for first in (0..m).step_by(LANES) {
            let columns = LANES.min(m - first);
            for lane in 0..columns {
                let column = first + lane;
                let range = column * m..(column + 1) * m;
                let responses = problem.slip_response[range.clone()]
                    .iter()
                    .zip(&problem.pressure_response[range]);
                for (responded, (slip, pressure)) in self.responded.iter_mut().zip(responses) {
                    (responded.slip[lane], responded.pressure[lane]) = (*slip, *pressure);
                }
                let corrections = problem
                    .leading
                    .response(&self.corrections, problem.pressure_response, column);
                for (correction, row) in corrections.iter().zip(problem.leading.rows) {
                    self.responded[row].slip[lane] += correction;
                }
            }
            let mut before = PassedTogether::default();
            for row in law.order(m) {
                let (of_slip, sign) = (&self.of_slip[row], self.slip[row].signum());
                let responded = &mut self.responded[row];
                responded.slip.iter_mut().for_each(|slip| *slip *= sign);
                of_slip.changes(law.flows(), &mut before, &mut responded.slip, &responded.pressure);
            }
            for lane in 0..columns {
                let factor = &mut self.factor[(first + lane) * m..][..m];
                for ((entry, row), responded) in factor.iter_mut().zip(&self.rows).zip(&self.responded) {
                    *entry += row.by_friction * responded.slip[lane];
                }
            }
        }
    }

    /// Newton step −J⁻¹ residual.
    fn find_step(&mut self, m: usize) {
        self.count(m, 0, 1);
        for (step, residual) in self.step.iter_mut().zip(&self.residual[..m]) {
            *step = -residual;
        }
        dense::lu_solve(&self.factor, m, &self.pivots, &mut self.step[..m]);
    }
}

#[cfg(test)]
mod tests;
