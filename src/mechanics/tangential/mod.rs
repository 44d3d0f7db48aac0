//! The friction problem: the shear traction for a given pressure.
//!
//! Find τ with (30), τ + μ p φ(s) = 0, on the nodes under pressure, or with Coulomb's law itself: |τ| ≤ μ p, s = 0 where
//! |τ| < μ p, and a slip against τ where |τ| = μ p. The slip velocity is
//! s = ∂u₁/∂t − V ∂u₁/∂x₁ + (ω r₀ − V). The strain is taken between the node and the one ahead of it, the difference of
//! |V|/Δx (u₁ − u₁ of the node ahead): with influences that are exact for the tractions, the equations of nodes that stick are
//! then those of the normal problem. What the leading edge adds is in [`super::front`].
//!
//! The problem is posed around the tractions of the sweep before: pressure and slip there are given, and how both
//! respond to a change of τ ([`super::response`]). Tractions and displacements are scaled, speeds in m/s.
//!
//! Both laws are equations a dτ + b ds + c dp at each node once they are linearised, and share the matrix
//! diag(a) + diag(b) ∂s/∂τ + diag(c) ∂p/∂τ; [`newton`] solves the regularised one, [`exchange`] Coulomb's.

mod exchange;
mod newton;
mod path;

use super::front::{Added, Edge, Front};
use crate::error::{Error, Result};
use crate::friction::path::{NodeFriction, PathLaw, PathNode};
use crate::numerics::dense::{self, largest};
use crate::settings::TangentialSettings;
use path::Path;

/// The data of one problem on the m nodes under pressure.
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
    /// How it depends on slip, m nodes; none where it does not.
    pub path: Option<(PathLaw, &'a [PathNode])>,
    /// The leading edge.
    pub edge: LeadingEdge<'a>,
    /// ε, `m/s`; 0 is Coulomb's law.
    pub regularisation: f64,
    /// Newton step that may be left out, relative to the largest pressure.
    pub tolerance: f64,
}

/// The leading edge of a problem.
#[derive(Debug, Clone, Copy)]
pub struct LeadingEdge<'a> {
    /// What it adds to the slip.
    pub front: Front,
    /// The three leading nodes, the first of them first; only the first counts where the front is not resolved.
    pub rows: [usize; 3],
    /// Separation of the node ahead at the shear the solve starts from.
    pub gap: f64,
    /// Its response to the shear, m.
    pub gap_response: &'a [f64],
}

impl LeadingEdge<'_> {
    /// The change of what is added to the slip of the first two rows with the shear on node `column`.
    pub fn response(&self, added: &[Added; 2], pressure_response: &[f64], column: usize) -> [f64; 2] {
        let m = self.gap_response.len();
        let mut change = Edge {
            pressure: self.rows.map(|row| pressure_response[column * m + row]),
            gap: self.gap_response[column],
            ..Edge::default()
        };
        for (shear, row) in change.shear.iter_mut().zip(self.rows) {
            *shear = if row == column { 1.0 } else { 0.0 };
        }
        [added[0].change(&change), added[1].change(&change)]
    }
}

/// Where the last solve ended, on the nodes of its problem.
#[derive(Debug, Clone, Copy)]
pub struct Point<'a> {
    /// Pressure, scaled.
    pub pressure: &'a [f64],
    /// −τ/(μ p).
    pub saturation: &'a [f64],
    /// What the leading edge adds to the slip of the first two rows.
    pub added: &'a [Added; 2],
    /// Change of the shear since the start of the solve.
    pub change: &'a [f64],
    /// The law's slip velocity, `m/s`.
    pub slip: &'a [f64],
    /// μ.
    pub friction: &'a [f64],
    /// Its derivatives, where it depends on slip.
    pub of_slip: &'a [NodeFriction],
}

/// How an iteration ended, with the number of steps it took.
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

/// The linearised law of one node, a dτ + b ds + c dp + e dμ.
#[derive(Debug, Clone, Copy, Default)]
pub struct LawRow {
    /// By the shear.
    pub by_shear: f64,
    /// By the slip velocity, `s/m`.
    pub by_slip: f64,
    /// By the pressure.
    pub by_pressure: f64,
    /// By μ.
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
    added: [Added; 2],
    /// μ, and where it depends on slip its derivatives.
    friction: Vec<f64>,
    of_slip: Vec<NodeFriction>,
    /// The slip's response to the shear on one node.
    responded: Vec<f64>,
    /// The law's derivatives by the slip, with what μ of a node follows from its own.
    by_slip: Vec<f64>,
    /// φ.
    saturation: Vec<f64>,
    /// Coulomb's law: φ = ±1 of the nodes that slip, 0 of those that stick.
    sliding: Vec<f64>,
    residual: Vec<f64>,
    /// Newton's step.
    step: Vec<f64>,
    /// The change before the step.
    before: Vec<f64>,
    rows: Vec<LawRow>,
    factor: Vec<f64>,
    pivots: Vec<usize>,
    /// Whether `factor` may still be used.
    factored: bool,
    /// Length of a step over that of the step before, with this `factor`.
    contraction: f64,
    path: Path,
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
            added: Default::default(),
            friction: vector(),
            of_slip: vec![NodeFriction::default(); nodes],
            responded: vector(),
            by_slip: vector(),
            saturation: vector(),
            sliding: vector(),
            residual: vector(),
            step: vector(),
            before: vector(),
            rows: vec![LawRow::default(); nodes],
            factor: vec![0.0; nodes * nodes],
            pivots: vec![0; nodes],
            factored: false,
            contraction: settings.fresh_contraction,
            path: Path::new(nodes),
        }
    }

    /// Forgets the factorised matrix: at the start of a step, so that it does not depend on the steps before, and
    /// when the nodes under pressure change.
    pub fn forget(&mut self) {
        self.factored = false;
    }

    /// The point of the last solve with m nodes.
    pub fn point(&self, m: usize) -> Point<'_> {
        Point {
            pressure: &self.pressure[..m],
            saturation: &self.saturation[..m],
            added: &self.added,
            change: &self.change[..m],
            slip: &self.slip[..m],
            friction: &self.friction[..m],
            of_slip: &self.of_slip[..m],
        }
    }

    /// The linearised law at the point of [`Tangential::linearise`].
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

    /// Changes `shear` (m, on the nodes of the problem) to the solution. `saturation` is φ where the solve starts, m: Coulomb's
    /// law starts with the nodes in slip where it is ±1. Returns the largest change.
    ///
    /// # Errors
    /// [`Error::TangentialNotConverged`].
    pub fn solve(&mut self, problem: &TangentialProblem, saturation: &[f64], shear: &mut [f64]) -> Result<f64> {
        let m = shear.len();
        self.change[..m].fill(0.0);
        let end = if problem.regularisation > 0.0 {
            self.solve_regularised(problem, shear)
        } else {
            self.solve_coulomb(problem, saturation, shear)
        };
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

    /// Pressure and slip after `self.change`, what the leading edge adds included.
    fn update_point(&mut self, problem: &TangentialProblem, shear: &[f64]) {
        let m = shear.len();
        dense::multiply(problem.pressure_response, m, &self.change, &mut self.pressure);
        dense::multiply(problem.slip_response, m, &self.change, &mut self.slip);
        for i in 0..m {
            self.pressure[i] = (problem.pressure[i] + self.pressure[i]).max(0.0);
            self.slip[i] += problem.slip[i];
        }
        let edge = &problem.edge;
        let node = |values: &[f64]| edge.rows.map(|row| values[row]);
        let (start, change) = (node(shear), node(&self.change));
        self.added = edge.front.added(&Edge {
            pressure: node(&self.pressure),
            shear: std::array::from_fn(|k| start[k] + change[k]),
            friction: problem.friction[edge.rows[0]],
            gap: edge.gap + dense::dot(edge.gap_response, &self.change[..m]),
        });
        for (added, row) in self.added.iter().zip(edge.rows) {
            self.slip[row] += added.slip;
        }
        self.update_friction(problem);
    }

    /// μ at the present slip.
    fn update_friction(&mut self, problem: &TangentialProblem) {
        let m = problem.friction.len();
        let Some((law, nodes)) = &problem.path else {
            self.friction[..m].copy_from_slice(problem.friction);
            return;
        };
        let mut before = (0.0, 0.0);
        for row in law.order(m) {
            let speed = self.slip[row].abs();
            self.of_slip[row] = law.friction(&nodes[row], before, speed);
            self.friction[row] = self.of_slip[row].coefficient;
            before = (self.friction[row], speed);
        }
    }

    /// Changes of the slip to those of μ by them, in place, at the point of the last solve.
    pub fn friction_tangent(&self, law: &PathLaw, slip: &mut [f64]) {
        follow(law, (&self.of_slip, &self.slip), slip);
    }

    /// Factorises the law's rows at the present point. False where the matrix is singular.
    fn factorise(&mut self, problem: &TangentialProblem) -> bool {
        let m = problem.pressure.len();
        let rows = &self.rows[..m];
        let by_slip = &mut self.by_slip[..m];
        for (row, (by_slip, law)) in by_slip.iter_mut().zip(rows).enumerate() {
            *by_slip = law.by_slip;
            if problem.path.is_some() {
                *by_slip += law.by_friction * self.of_slip[row].by_speed * self.slip[row].signum();
            }
        }
        let linked = problem.path.as_ref().filter(|(law, _)| law.remembers());
        for column in 0..m {
            let range = column * m..(column + 1) * m;
            let slip = &problem.slip_response[range.clone()];
            let pressure = &problem.pressure_response[range.clone()];
            let factor = &mut self.factor[range];
            let laws = rows.iter().zip(&*by_slip);
            for (((entry, (row, by_slip)), slip), pressure) in factor.iter_mut().zip(laws).zip(slip).zip(pressure) {
                *entry = by_slip * slip + row.by_pressure * pressure;
            }
            factor[column] += rows[column].by_shear;
            let added = problem.edge.response(&self.added, problem.pressure_response, column);
            for (added, row) in added.iter().zip(problem.edge.rows) {
                factor[row] += by_slip[row] * added;
            }
            if let Some((law, _)) = linked {
                let friction = &mut self.responded[..m];
                friction.copy_from_slice(slip);
                for (added, row) in added.iter().zip(problem.edge.rows) {
                    friction[row] += added;
                }
                let mut before = (0.0, 0.0);
                for row in law.order(m) {
                    let (of_slip, speed) = (&self.of_slip[row], self.slip[row].signum() * friction[row]);
                    let linked = of_slip.by_before * before.0 + of_slip.by_speed_before * before.1;
                    factor[row] += rows[row].by_friction * linked;
                    before = (linked + of_slip.by_speed * speed, speed);
                }
            }
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

/// Changes of the slip to those of μ by them, in place.
fn follow(law: &PathLaw, (of_slip, slip): (&[NodeFriction], &[f64]), change: &mut [f64]) {
    let mut before = (0.0, 0.0);
    for row in law.order(change.len()) {
        let (of_slip, speed) = (&of_slip[row], slip[row].signum() * change[row]);
        change[row] = of_slip.by_before * before.0 + of_slip.by_speed_before * before.1 + of_slip.by_speed * speed;
        before = (change[row], speed);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::friction::coulomb::saturation;
    use crate::mechanics::front::NearField;
    use proptest::prelude::*;

    const NODES: usize = 6;

    /// A leading edge that adds nothing.
    fn no_edge(zero: &[f64]) -> LeadingEdge<'_> {
        LeadingEdge {
            front: Front {
                near_field: NearField {
                    direct: 1.0,
                    coupling: 0.0,
                    opening: 1.0,
                },
                resolved: false,
                forward: true,
                strain_speed: 0.0,
            },
            rows: [0; 3],
            gap: 0.0,
            gap_response: zero,
        }
    }

    /// A problem without response: pressure and slip stay what they are.
    fn stiff<'a>(pressure: &'a [f64], slip: &'a [f64], zero: &'a [f64], friction: &'a [f64]) -> TangentialProblem<'a> {
        TangentialProblem {
            pressure,
            slip,
            pressure_response: zero,
            slip_response: zero,
            friction,
            path: None,
            edge: no_edge(&zero[..pressure.len()]),
            regularisation: 1e-3,
            tolerance: 1e-12,
        }
    }

    #[test]
    fn without_compliance_the_shear_is_coulombs_law_of_the_rigid_slip() {
        let (pressure, friction) = ([0.2, 1.0, 0.6], [0.4, 0.3, 0.5]);
        let zero = [0.0; 9];
        for rigid_slip in [-0.2, -1e-4, 0.0, 5e-4, 3.0] {
            let slip = [rigid_slip; 3];
            for regularisation in [1e-3, 0.0] {
                let mut shear = [0.05, -0.05, 0.0];
                let mut solver = Tangential::new(3, TangentialSettings::default());
                let problem = TangentialProblem {
                    regularisation,
                    ..stiff(&pressure, &slip, &zero, &friction)
                };
                solver.solve(&problem, &[0.0; 3], &mut shear).unwrap();
                let share = if regularisation > 0.0 {
                    saturation(rigid_slip, regularisation)
                } else if rigid_slip == 0.0 {
                    0.0
                } else {
                    rigid_slip.signum()
                };
                for node in 0..3 {
                    let expected = -friction[node] * pressure[node] * share;
                    assert!((shear[node] - expected).abs() < 1e-12, "{rigid_slip}: {shear:?}");
                }
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
        let failed = Tangential::new(1, settings).solve(&stiff(&one, &one, &zero, &one), &[0.0], &mut shear);
        assert!(matches!(
            failed,
            Err(Error::TangentialNotConverged { iterations: 0, residual, .. }) if residual > 0.5
        ));
        assert_eq!(shear, [0.0]);
    }

    /// Slip that falls with the shear at the node itself and less at its neighbours, as an elastic surface has it.
    fn response() -> Vec<f64> {
        (0..NODES * NODES)
            .map(|k| 2e-2 / (1.0 + (k / NODES).abs_diff(k % NODES) as f64))
            .collect()
    }

    fn sum(matrix: &[f64], row: usize, values: &[f64]) -> f64 {
        (0..NODES)
            .map(|column| matrix[column * NODES + row] * values[column])
            .sum()
    }

    proptest! {
        /// With a pressure that follows a little, regularisations down to a thousandth of the slip.
        #[test]
        fn the_solution_satisfies_the_regularised_law(
            pressure in prop::collection::vec(0.1..1.0, NODES),
            slip in prop::collection::vec(-6e-2..6e-2, NODES),
            friction in prop::collection::vec(0.1..0.6, NODES),
            follows in prop::collection::vec(-0.05..0.05, NODES * NODES),
            log_regularisation in -5.0..-2.0,
        ) {
            let regularisation = 10.0_f64.powf(log_regularisation);
            let response = response();
            let zero = [0.0; NODES];
            let problem = TangentialProblem {
                pressure: &pressure,
                slip: &slip,
                pressure_response: &follows,
                slip_response: &response,
                friction: &friction,
                path: None,
                edge: no_edge(&zero),
                regularisation,
                tolerance: 1e-12,
            };
            let mut shear = vec![0.0; NODES];
            Tangential::new(NODES, TangentialSettings::default()).solve(&problem, &zero, &mut shear).unwrap();
            for row in 0..NODES {
                let slip = slip[row] + sum(&response, row, &shear);
                let p = (pressure[row] + sum(&follows, row, &shear)).max(0.0);
                let law = -friction[row] * p * saturation(slip, regularisation);
                // The slope of the law, μ p/ε ds/dτ ≤ 0.6 · 4e-2/1e-5, times the tolerance of the shear.
                prop_assert!((shear[row] - law).abs() < 1e-8, "{row}: {} {law}", shear[row]);
            }
        }

        /// Coulomb's conditions at every node, by the exchanges and by the path alone, from any start.
        #[test]
        fn the_solution_satisfies_coulombs_law(
            pressure in prop::collection::vec(0.1..1.0, NODES),
            slip in prop::collection::vec(-6e-2..6e-2, NODES),
            friction in prop::collection::vec(0.1..0.6, NODES),
            follows in prop::collection::vec(-0.05..0.05, NODES * NODES),
            start in prop::collection::vec(-1.0..1.0_f64, NODES),
            exchanges in 1..14_usize,
        ) {
            let response = response();
            let zero = [0.0; NODES];
            let start: Vec<f64> = start.iter().map(|phi| if phi.abs() < 0.5 { 0.0 } else { phi.signum() }).collect();
            let mut shear: Vec<f64> = (0..NODES).map(|i| -start[i] * friction[i] * pressure[i]).collect();
            // The problem is posed around the start.
            let at_start: Vec<f64> = (0..NODES).map(|i| slip[i] + sum(&response, i, &shear)).collect();
            let pressure_at_start: Vec<f64> = (0..NODES).map(|i| pressure[i] + sum(&follows, i, &shear)).collect();
            let problem = TangentialProblem {
                pressure: &pressure_at_start,
                slip: &at_start,
                pressure_response: &follows,
                slip_response: &response,
                friction: &friction,
                path: None,
                edge: no_edge(&zero),
                regularisation: 0.0,
                tolerance: 1e-12,
            };
            let settings = TangentialSettings { exchanges, ..TangentialSettings::default() };
            let mut solver = Tangential::new(NODES, settings);
            solver.solve(&problem, &start, &mut shear).unwrap();
            for row in 0..NODES {
                let slip: f64 = slip[row] + sum(&response, row, &shear);
                let p: f64 = pressure[row] + sum(&follows, row, &shear);
                let bound = friction[row] * p.max(0.0);
                let phi = solver.point(NODES).saturation[row];
                prop_assert!((shear[row] + bound * phi).abs() < 1e-11, "{row}: {} {bound} {phi}", shear[row]);
                prop_assert!(phi.abs() <= 1.0);
                if phi.abs() == 1.0 {
                    prop_assert!(phi * slip > -1e-11, "{row}: {phi} {slip}");
                } else {
                    prop_assert!(slip.abs() < 1e-11, "{row}: {phi} {slip}");
                }
            }
        }
    }
}
