//! Normal–tangential (Panagiotopoulos) iteration, which solves for the tractions at given temperature and wear: the normal problem
//! (37) for given shear, then friction (30) for given pressure, repeated until both have converged (Steps 2 to 5 of section 4.1 of
//! the paper).
//!
//! As long as the active set stays, the pressure is an affine function of the shear. With the active-set solver the
//! friction problem sees that [`Response`], and two iterations do where alternating as printed takes ten; with the paper's
//! linearisation method the two problems alternate as printed.

mod friction;

use super::kinematics::SlipWeights;
use super::normal::active_set::ActiveSet;
use super::normal::normal_problem::NormalProblem;
use super::normal::pschenichnyj::Pschenichnyj;
use super::response::Response;
use super::tangential::Tangential;
use super::traction_problem::{TractionProblem, Tractions, under_pressure};
use crate::error::{Error, Result};
use crate::friction::path::PathNode;
use crate::numerics::dense;
use crate::parameters::NormalSolver;
use crate::settings::{MechanicsSettings, Settings};

/// Change of the tractions by one iteration.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TractionChange {
    /// Largest change of the shear, relative to the peak pressure.
    pub shear_change: f64,
    /// Whether other nodes are under pressure than before.
    pub set_changed: bool,
    /// Residual of the friction law, relative to the peak pressure, beyond the tolerance: of a staggered step, which takes the solution of a
    /// smoother law where none of the law itself is found.
    pub law_residual: f64,
}

impl TractionChange {
    /// No change.
    pub const NONE: TractionChange = TractionChange {
        shear_change: 0.0,
        set_changed: false,
        law_residual: 0.0,
    };

    /// Residual that a staggered step shows: of tractions that do not rest, or of a friction law that they do not keep.
    pub fn residual(&self) -> f64 {
        self.shear_change.max(self.law_residual)
    }

    /// Whether the tractions have converged to a tolerance.
    pub fn has_converged(&self, tolerance: f64) -> bool {
        self.shear_change <= tolerance && !self.set_changed
    }
}

/// Solvers and buffers of the iteration, for one compliance.
pub struct Mechanics {
    pub(super) settings: MechanicsSettings,
    pub(super) active_set: ActiveSet,
    pschenichnyj: Pschenichnyj,
    pub(super) tangential: Tangential,
    pub(super) response: Response,
    /// Multiplications and additions for the response in this step.
    response_work: u64,
    /// Whether the normal compliance was replaced since the last solve.
    replaced: bool,
    /// Response ∂s/∂τ on the nodes under pressure, without the leading-edge correction, m × m, and the weights it was made with.
    pub(super) slip_response: Vec<f64>,
    slip_weights: Option<SlipWeights>,
    /// Profile of the normal problem, with the upward displacement by shear, n.
    pub(super) profile: Vec<f64>,
    /// Displacement along x₁, n.
    pub(super) displacement: Vec<f64>,
    /// Change of the displacement along x₁, n.
    pub(super) moved: Vec<f64>,
    /// Nodes under pressure, and those of the iteration before.
    pub(super) nodes: Vec<usize>,
    nodes_before: Vec<usize>,
    /// Separation of the node ahead of the leading one.
    pub(super) gap: f64,
    cut_off: bool,
    /// Values on the nodes under pressure.
    pub(super) local: Local,
}

/// Values on the m nodes under pressure, in the order of the nodes.
pub(super) struct Local {
    pub(super) pressure: Vec<f64>,
    pub(super) shear: Vec<f64>,
    pub(super) slip: Vec<f64>,
    pub(super) utilisation: Vec<f64>,
    pub(super) friction: Vec<f64>,
    path: Vec<PathNode>,
    /// Change of the profile.
    pub(super) profile: Vec<f64>,
    /// Change of the pressure or of μ that follows a change of the shear.
    pub(super) following: Vec<f64>,
}

impl Mechanics {
    /// Scratch for `nodes` contact nodes.
    pub fn new(nodes: usize, settings: &Settings) -> Mechanics {
        let vector = || vec![0.0; nodes];
        Mechanics {
            settings: settings.mechanics,
            active_set: ActiveSet::new(nodes, settings.normal),
            pschenichnyj: Pschenichnyj::new(nodes, settings.normal),
            tangential: Tangential::new(nodes, settings.tangential),
            response: Response::new(nodes),
            response_work: 0,
            replaced: false,
            slip_response: vec![0.0; nodes * nodes],
            slip_weights: None,
            profile: vector(),
            displacement: vector(),
            moved: vector(),
            nodes: Vec::with_capacity(nodes),
            nodes_before: Vec::with_capacity(nodes),
            gap: 0.0,
            cut_off: false,
            local: Local {
                pressure: vector(),
                shear: vector(),
                slip: vector(),
                utilisation: vector(),
                friction: vector(),
                path: vec![PathNode::default(); nodes],
                profile: vector(),
                following: vector(),
            },
        }
    }

    /// Begins a step: forgets the matrices that were factorised for the step before.
    pub fn start_step(&mut self) {
        self.tangential.start_step();
        self.active_set.start_step();
        (self.response_work, self.replaced) = (0, false);
    }

    /// Multiplications and additions in this step, about: a measure of time that is the same on every machine.
    pub fn work(&self) -> u64 {
        self.tangential.work() + self.active_set.work() + self.response_work
    }

    /// Forgets all that was computed from the normal compliance: it has been replaced. Computing it anew counts as work where the step alone
    /// has made the new one.
    pub fn forget_normal_compliance(&mut self, counts: bool) {
        self.active_set.forget();
        self.response.forget();
        self.replaced |= counts;
    }

    /// Solves from the given tractions until the shear changes by less than `tolerance`, relative to the peak pressure.
    ///
    /// # Errors
    /// The first solver that does not converge, [`Error::MechanicsNotConverged`].
    pub fn solve(&mut self, problem: &TractionProblem, tractions: &mut Tractions, tolerance: f64) -> Result<()> {
        let mut residual = f64::INFINITY;
        for _ in 0..self.settings.iterations {
            let change = self.iterate(problem, tractions, tolerance)?;
            residual = change.shear_change;
            if change.has_converged(tolerance) {
                return Ok(());
            }
        }
        Err(Error::MechanicsNotConverged {
            iterations: self.settings.iterations,
            residual,
            tolerance,
        })
    }

    /// Iterates once: solves the normal problem, then friction with the pressure that follows, to `tolerance` relative to the peak
    /// pressure. With the active-set solver that is the solution as long as the active set stays.
    ///
    /// # Errors
    /// The first solver that does not converge.
    pub fn iterate(
        &mut self,
        problem: &TractionProblem,
        tractions: &mut Tractions,
        tolerance: f64,
    ) -> Result<TractionChange> {
        let set_changed = self.solve_normal(problem, tractions)?;
        let change = self.solve_friction(problem, tractions, tolerance)?;
        let largest = tractions.pressure.iter().fold(f64::MIN_POSITIVE, |m, p| p.max(m));
        Ok(TractionChange {
            shear_change: change / largest,
            set_changed,
            law_residual: if self.nodes.is_empty() {
                0.0
            } else {
                self.tangential.left() / largest
            },
        })
    }

    /// Solves the normal problem (37) for given shear. Returns whether the set of nodes under pressure changed.
    fn solve_normal(&mut self, problem: &TractionProblem, tractions: &mut Tractions) -> Result<bool> {
        self.nodes_before.clear();
        self.nodes_before.extend(under_pressure(tractions.pressure));
        self.profile.copy_from_slice(problem.profile);
        dense::multiply_add(
            &problem.compliance.normal_tangential,
            tractions.shear,
            1.0,
            &mut self.profile,
        );
        let normal = NormalProblem {
            compliance: problem.normal_compliance,
            profile: &self.profile,
            constraint: problem.constraint,
            // The slip of a node takes the displacement of its neighbours.
            free_ends: 1,
        };
        let solution = match problem.normal_solver {
            NormalSolver::ActiveSet => self.active_set.solve(&normal, tractions.pressure)?,
            NormalSolver::Pschenichnyj => self.pschenichnyj.solve(&normal, tractions.pressure)?,
        };
        *tractions.penetration = solution.penetration;

        self.nodes.clear();
        self.nodes.extend(under_pressure(tractions.pressure));
        let follows = problem.normal_solver == NormalSolver::ActiveSet && self.active_set.active() == self.nodes;
        if self.response.update(problem, &self.nodes, &self.active_set, follows) {
            self.tangential.forget();
            self.slip_weights = None;
        }
        let separation = |node: usize| self.separation(problem, tractions.pressure, solution.penetration, node);
        let gap = self.response.node_ahead_of_the_contact().map_or(0.0, separation);
        let ends = [0, tractions.pressure.len() - 1];
        let cut_off = ends.into_iter().any(|end| separation(end) < -self.settings.overlap);
        (self.gap, self.cut_off) = (gap, cut_off);
        // Not whether the response was computed anew: that depends on what was solved before this step.
        let set_changed = self.nodes != self.nodes_before;
        let cube = (self.nodes.len() as u64).pow(3);
        if std::mem::take(&mut self.replaced) {
            self.response_work += 2 * cube + 4 * cube / 3;
        } else if set_changed {
            self.response_work += 2 * cube;
        }
        Ok(set_changed)
    }

    /// Separation w = C p − b − δ of a node.
    fn separation(&self, problem: &TractionProblem, pressure: &[f64], penetration: f64, node: usize) -> f64 {
        let row = problem.normal_compliance.row(node);
        let lowered: f64 = self.nodes.iter().map(|&node| row[node] * pressure[node]).sum();
        lowered - self.profile[node] - penetration
    }

    /// Whether the contact of the last iteration would reach beyond the window, had it not been held within it.
    pub fn is_cut_off(&self) -> bool {
        self.cut_off
    }
}

#[cfg(test)]
mod tests;
