//! Normal–tangential (Panagiotopoulos) iteration, which solves for the tractions at given temperature and wear: the normal problem
//! (37) for given shear, then friction (30) for given pressure, repeated until both have converged (Steps 2 to 5 of section 4.1 of
//! the paper).
//!
//! As long as the active set stays, the pressure is an affine function of the shear. With the active-set solver the
//! friction problem sees that [`Response`], and two iterations do where alternating as printed takes ten; with the paper's
//! linearisation method the two problems alternate as printed.

use super::leading_edge::LeadingEdge;
use super::normal::active_set::ActiveSet;
use super::normal::normal_problem::NormalProblem;
use super::normal::pschenichnyj::Pschenichnyj;
use super::response::Response;
use super::tangential::{LeadingRows, Tangential, TangentialProblem};
use super::traction_problem::{TractionProblem, Tractions, node_ahead, under_pressure};
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
}

impl TractionChange {
    /// No change.
    pub const NONE: TractionChange = TractionChange {
        shear_change: 0.0,
        set_changed: false,
    };

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
    /// Response ∂s/∂τ on the nodes under pressure, without the leading-edge correction, m × m, and the weights it was made with.
    pub(super) slip_response: Vec<f64>,
    slip_weights: (f64, f64),
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
            slip_response: vec![0.0; nodes * nodes],
            slip_weights: (f64::NAN, f64::NAN),
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
        self.response_work = 0;
    }

    /// Multiplications and additions in this step, about: a measure of time that is the same on every machine.
    #[allow(dead_code, reason = "for the budget of a step")]
    pub fn work(&self) -> u64 {
        self.tangential.work() + self.active_set.work() + self.response_work
    }

    /// Forgets all that was computed from the normal compliance: it has been replaced.
    pub fn forget_normal_compliance(&mut self) {
        self.active_set.forget();
        self.response.forget();
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
            self.slip_weights = (f64::NAN, f64::NAN);
        }
        let separation = |node: usize| self.separation(problem, tractions.pressure, solution.penetration, node);
        let gap = self.response.node_ahead_of_the_contact().map_or(0.0, separation);
        let ends = [0, tractions.pressure.len() - 1];
        let cut_off = ends.into_iter().any(|end| separation(end) < -self.settings.overlap);
        (self.gap, self.cut_off) = (gap, cut_off);
        // Not whether the response was computed anew: that depends on what was solved before this step.
        let set_changed = self.nodes != self.nodes_before;
        if set_changed {
            self.response_work += 2 * (self.nodes.len() as u64).pow(3);
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

    /// Updates ∂s/∂τ to the response of the displacement, with the weights of [`TractionProblem::slip_weights`].
    fn update_slip_response(&mut self, problem: &TractionProblem) {
        let weights = problem.slip_weights();
        if weights == self.slip_weights {
            return;
        }
        self.slip_weights = weights;
        let (strain, own) = weights;
        let (span, m) = (self.response.span(), self.nodes.len());
        let forward = problem.is_forward();
        let columns = self.response.displacement().chunks_exact(span.len().max(1));
        for (slips, displacement) in self.slip_response.chunks_exact_mut(m.max(1)).zip(columns).take(m) {
            for (slip, &node) in slips.iter_mut().zip(&self.nodes) {
                let here = displacement[node - span.start];
                let ahead = displacement[node_ahead(node, forward) - span.start];
                *slip = strain * (here - ahead) + own * here;
            }
        }
    }

    /// Leading edge of the nodes under pressure.
    pub(super) fn leading_rows(&self, problem: &TractionProblem) -> LeadingRows<'_> {
        leading_rows(problem, &self.response, &self.nodes, self.gap)
    }

    /// Factorises the friction law at the point of the last solve. False where its matrix is singular.
    pub(super) fn factorise_friction(&mut self, problem: &TractionProblem, tolerance: f64) -> bool {
        let tangential = tangential_problem(
            problem,
            (&self.response, &self.slip_response),
            (&self.local, &self.nodes, self.gap),
            tolerance,
        );
        self.tangential.linearise(&tangential)
    }

    /// Friction for given pressure and its response; pressure and penetration follow. Returns the largest change of the shear.
    fn solve_friction(&mut self, problem: &TractionProblem, tractions: &mut Tractions, tolerance: f64) -> Result<f64> {
        // Within Coulomb's bound from the start: a shear left over from a much larger pressure would make strains that
        // swamp those of this one.
        let mut clamped = 0.0_f64;
        for (node, shear) in tractions.shear.iter_mut().enumerate() {
            let friction = match problem.path {
                None => problem.friction[node],
                // Rail that cools remembers less than it would have at rest, rail that warms more.
                Some(_) => problem.friction[node].max(tractions.friction[node]),
            };
            let bound = friction * tractions.pressure[node];
            let within = shear.clamp(-bound, bound);
            clamped = clamped.max((*shear - within).abs());
            *shear = within;
        }
        let m = self.nodes.len();
        // Nothing touches: a penetration that is given need not reach the rail.
        tractions.friction.copy_from_slice(problem.friction);
        if m == 0 {
            tractions.slip.fill(0.0);
            tractions.utilisation.fill(0.0);
            if problem.path.is_some() {
                tractions.speed.fill(0.0);
                tractions.flow.fill(0.0);
            }
            return Ok(clamped);
        }
        self.displacement.copy_from_slice(problem.displacement);
        problem
            .compliance
            .add_along(1.0, tractions.pressure, tractions.shear, &mut self.displacement);
        self.update_slip_response(problem);
        for (row, &node) in self.nodes.iter().enumerate() {
            self.local.pressure[row] = tractions.pressure[node];
            self.local.shear[row] = tractions.shear[node];
            self.local.friction[row] = problem.friction[node];
            self.local.utilisation[row] = tractions.utilisation[node];
            self.local.slip[row] = law_slip(problem, &self.displacement, node);
        }
        self.prepare_path(problem);
        let mut shear = std::mem::take(&mut self.local.shear);
        let tangential = tangential_problem(
            problem,
            (&self.response, &self.slip_response),
            (&self.local, &self.nodes, self.gap),
            tolerance,
        );
        let solved = self
            .tangential
            .solve(&tangential, &self.local.utilisation[..m], &mut shear[..m]);
        self.local.shear = shear;
        let change = solved?;
        let point = self.tangential.point(m);
        // What follows the change of the shear: the displacement, and the slip with it.
        let span = self.response.span();
        dense::multiply_columns(
            self.response.displacement(),
            span.len(),
            point.change,
            &mut self.displacement[span],
        );
        *tractions.penetration += dense::dot(&self.response.penetration()[..m], point.change);
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        tractions.utilisation.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.shear[node] = self.local.shear[row];
            tractions.slip[node] = mean_slip(problem, &self.displacement, node);
            tractions.utilisation[node] = point.utilisation[row];
            tractions.pressure[node] = point.pressure[row];
        }
        if problem.path.is_some() {
            tractions.speed.fill(0.0);
            tractions.flow.fill(0.0);
            for (row, &node) in self.nodes.iter().enumerate() {
                tractions.friction[node] = point.friction[row];
                tractions.surfaces[node] = point.of_slip[row].surfaces;
                tractions.flow[node] = point.of_slip[row].flow();
                tractions.speed[node] = point.slip[row].abs();
                tractions.share[node] = point.of_slip[row].share;
                tractions.layer_bound[node] = point.of_slip[row].layer_bound();
            }
        }
        Ok(change.max(clamped))
    }

    /// Sets the friction law of the nodes under pressure for the history that their particles bring along.
    fn prepare_path(&mut self, problem: &TractionProblem) {
        let Some((law, path)) = &problem.path else {
            return;
        };
        let nodes = &self.nodes;
        let (forward, m) = (law.is_forward(), nodes.len());
        let own = &mut self.local.path;
        let mut given = 0;
        let touches = |node: usize| nodes.binary_search(&node).is_ok();
        law.prepare(path, problem.friction, touches, |_, node| {
            own[if forward { m - 1 - given } else { given }] = node;
            given += 1;
        });
    }
}

/// Slip velocity of the law at a node, without what the leading edge adds, `m/s`.
pub(super) fn law_slip(problem: &TractionProblem, displacement: &[f64], node: usize) -> f64 {
    let ahead = node_ahead(node, problem.is_forward());
    let strain = |u: &[f64]| u[node] - u[ahead];
    let before = problem.displacement_before;
    let (by_strain, by_displacement) = problem.slip_weights();
    // The strain of the step before belongs to the change of the displacement, which is taken between the nodes.
    let centred = problem.transient.centring * problem.transient.rate;
    problem.rigid_slip
        + by_strain * strain(displacement)
        + centred * strain(before)
        + by_displacement * (displacement[node] - before[node])
}

/// Slip velocity that heats, wears and takes power: the mean of those in the middle of the two cells beside a node, `m/s`.
/// With it the work of the tractions on the body vanishes in the sum over the nodes, as it does on an elastic body, but for
/// the edges. With the slip of the law, taken on one side, it would not.
fn mean_slip(problem: &TractionProblem, displacement: &[f64], node: usize) -> f64 {
    problem.rigid_slip
        + 0.5 * problem.strain_speed * (displacement[node - 1] - displacement[node + 1])
        + problem.transient.rate * (displacement[node] - problem.displacement_before[node])
}

fn leading_rows<'a>(problem: &TractionProblem, response: &'a Response, nodes: &[usize], gap: f64) -> LeadingRows<'a> {
    let m = nodes.len();
    let forward = problem.is_forward();
    // Rows from the leading node on; a contact of fewer than three nodes has only the first.
    let last = m.saturating_sub(1);
    let rows = [0, 1, 2].map(|k: usize| if forward { last - k.min(last) } else { k.min(last) });
    LeadingRows {
        edge: LeadingEdge {
            near_field: problem.near_field,
            resolved: m >= 4 && nodes[rows[0]].abs_diff(nodes[rows[2]]) == 2,
            forward,
            strain_speed: problem.strain_speed.abs(),
        },
        rows,
        gap,
        gap_response: response.gap(),
    }
}

fn tangential_problem<'a>(
    problem: &TractionProblem,
    (response, slip_response): (&'a Response, &'a [f64]),
    (local, nodes, gap): (&'a Local, &[usize], f64),
    tolerance: f64,
) -> TangentialProblem<'a> {
    let m = nodes.len();
    TangentialProblem {
        pressure: &local.pressure[..m],
        slip: &local.slip[..m],
        pressure_response: response.pressure(),
        slip_response,
        friction: &local.friction[..m],
        path: problem.path.as_ref().map(|(law, _)| (*law, &local.path[..m])),
        leading: leading_rows(problem, response, nodes, gap),
        regularisation: problem.regularisation,
        tolerance,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::compliance::{RollingCompliance, Scales};
    use crate::body::half_plane::HalfPlanes;
    use crate::body::mesh::Mesh;
    use crate::body::pair;
    use crate::friction::coulomb::utilisation;
    use crate::mechanics::leading_edge::{EdgeValues, NearField};
    use crate::mechanics::normal::normal_problem::Constraint;
    use crate::mechanics::traction_problem::TractionProblemTangent;
    use crate::mechanics::transient::Transient;
    use crate::parameters::{Parameters, Wheel};
    use crate::settings::Settings;

    const NODES: usize = 25;

    /// A rigid wheel on a small rail, so that normal and tangential problem are coupled.
    fn parameters() -> Parameters {
        Parameters {
            contact_nodes: NODES,
            depth_nodes: 15,
            wheel: Wheel::Rigid,
            ..Parameters::default()
        }
    }

    fn pair() -> (RollingCompliance, Vec<f64>) {
        let parameters = parameters();
        let mesh = Mesh::new(&parameters);
        let scales = Scales::new(&parameters);
        let (pair, _) = pair::build(&mesh, &parameters, &scales).unwrap();
        let profile = (0..NODES)
            .map(|i| -0.5 * mesh.contact_position(i).powi(2) / parameters.wheel_radius / scales.displacement)
            .collect();
        (pair, profile)
    }

    struct SolvedTractions {
        pressure: Vec<f64>,
        shear: Vec<f64>,
        slip: Vec<f64>,
        utilisation: Vec<f64>,
        friction: Vec<f64>,
        surfaces: Vec<f64>,
        flow: Vec<f64>,
        speed: Vec<f64>,
        share: Vec<f64>,
        layer_bound: Vec<f64>,
        penetration: f64,
    }

    impl SolvedTractions {
        fn new() -> SolvedTractions {
            SolvedTractions {
                pressure: vec![0.0; NODES],
                shear: vec![0.0; NODES],
                slip: vec![0.0; NODES],
                utilisation: vec![0.0; NODES],
                friction: vec![0.0; NODES],
                surfaces: vec![0.0; NODES],
                flow: vec![0.0; NODES],
                speed: vec![0.0; NODES],
                share: vec![0.0; NODES],
                layer_bound: vec![0.0; NODES],
                penetration: 0.0,
            }
        }

        fn tractions(&mut self) -> Tractions<'_> {
            Tractions {
                pressure: &mut self.pressure,
                shear: &mut self.shear,
                slip: &mut self.slip,
                utilisation: &mut self.utilisation,
                friction: &mut self.friction,
                surfaces: &mut self.surfaces,
                flow: &mut self.flow,
                speed: &mut self.speed,
                share: &mut self.share,
                layer_bound: &mut self.layer_bound,
                penetration: &mut self.penetration,
            }
        }
    }

    /// Data of a problem, moved by a multiple of a change.
    struct Data {
        profile: Vec<f64>,
        displacement: Vec<f64>,
        friction: Vec<f64>,
        total: f64,
        rigid_slip: f64,
        strain_speed: f64,
        transient: Transient,
        regularisation: f64,
    }

    /// Displacement of the step before.
    const BEFORE: [f64; NODES] = {
        let mut before = [0.0; NODES];
        let mut i = 0;
        while i < NODES {
            before[i] = 0.02 * ((i * i) % 7) as f64;
            i += 1;
        }
        before
    };

    impl Data {
        fn moved(&self, step: f64, change: &Data) -> Data {
            let add = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + step * b).collect();
            Data {
                profile: add(&self.profile, &change.profile),
                displacement: add(&self.displacement, &change.displacement),
                friction: add(&self.friction, &change.friction),
                total: self.total + step * change.total,
                rigid_slip: self.rigid_slip + step * change.rigid_slip,
                strain_speed: self.strain_speed + step * change.strain_speed,
                transient: Transient {
                    rate: self.transient.rate + step * change.transient.rate,
                    centring: self.transient.centring + step * change.transient.centring,
                },
                regularisation: self.regularisation,
            }
        }

        fn problem<'a>(&'a self, pair: &'a RollingCompliance, normal_solver: NormalSolver) -> TractionProblem<'a> {
            TractionProblem {
                compliance: &pair.at_rest,
                normal_compliance: &pair.at_rest.normal_normal,
                profile: &self.profile,
                displacement: &self.displacement,
                displacement_before: &BEFORE,
                friction: &self.friction,
                path: None,
                constraint: Constraint::Total(self.total),
                normal_solver,
                rigid_slip: self.rigid_slip,
                strain_speed: self.strain_speed,
                transient: self.transient,
                near_field: near_field(),
                regularisation: self.regularisation,
            }
        }
    }

    fn data(profile: &[f64], rigid_slip: f64, strain_speed: f64, regularisation: f64) -> Data {
        Data {
            profile: profile.to_vec(),
            displacement: vec![0.0; NODES],
            friction: (0..NODES).map(|i| 0.3 + 0.005 * i as f64).collect(),
            total: 8.0,
            rigid_slip,
            strain_speed,
            transient: Transient {
                rate: 3.0,
                centring: 0.2,
            },
            regularisation,
        }
    }

    fn near_field() -> NearField {
        let parameters = parameters();
        let spacing = Mesh::new(&parameters).contact_spacing();
        NearField::new(&HalfPlanes::of_pair(&parameters), spacing, &Scales::new(&parameters))
    }

    fn solve(problem: &TractionProblem) -> SolvedTractions {
        let mut solved = SolvedTractions::new();
        let mut mechanics = Mechanics::new(NODES, &Settings::default());
        mechanics.solve(problem, &mut solved.tractions(), 1e-12).unwrap();
        solved
    }

    /// Every condition of (22) and of the friction law at every node, evaluated from the compliance itself, for both methods,
    /// laws and directions.
    #[test]
    fn the_tractions_satisfy_contact_and_friction() {
        let (pair, profile) = pair();
        for (rigid_slip, strain_speed) in [(0.0, 30.0), (0.02, 30.0), (-0.02, -30.0), (0.3, 30.0), (0.01, 0.0)] {
            for method in [NormalSolver::ActiveSet, NormalSolver::Pschenichnyj] {
                for regularisation in [1e-3, 0.0] {
                    let data = data(&profile, rigid_slip, strain_speed, regularisation);
                    check(&pair, &data, &data.problem(&pair, method));
                }
            }
        }
    }

    fn check(pair: &RollingCompliance, data: &Data, problem: &TractionProblem) {
        let solved = solve(problem);
        let (p, tau) = (&solved.pressure, &solved.shear);
        assert!((p.iter().sum::<f64>() - data.total).abs() < 1e-9);
        let sum = |matrix: &nalgebra::DMatrix<f64>, i: usize, f: &[f64]| {
            (0..NODES).map(|j| matrix[(i, j)] * f[j]).sum::<f64>()
        };
        let c = &pair.at_rest;
        let along = |i: usize| sum(&c.tangential_tangential, i, tau) - sum(&c.tangential_normal, i, p);
        let separation = |i: usize| {
            let upward = sum(&c.normal_tangential, i, tau) - sum(&c.normal_normal, i, p);
            -(upward + data.profile[i] + solved.penetration)
        };
        let forward = data.strain_speed >= 0.0;
        let behind = |i: usize, k: usize| if forward { i - k } else { i + k };
        let ahead = |i: usize| if forward { i + 1 } else { i - 1 };
        let mut closed = (1..NODES - 1).filter(|&i| p[i] > 0.0);
        let first = if forward { closed.next_back() } else { closed.next() }.unwrap();
        let edge = [first, behind(first, 1), behind(first, 2)];
        let corrections = LeadingEdge {
            near_field: near_field(),
            resolved: true,
            forward,
            strain_speed: data.strain_speed.abs(),
        }
        .corrections(&EdgeValues {
            pressure: edge.map(|i| p[i]),
            shear: edge.map(|i| tau[i]),
            friction: data.friction[first],
            gap: separation(ahead(first)),
        });
        for i in 1..NODES - 1 {
            assert!(p[i] >= 0.0 && separation(i) > -1e-8, "{i}: {} {}", p[i], separation(i));
            assert!(p[i] * separation(i) < 1e-8, "{i}: {} {}", p[i], separation(i));
            if p[i] == 0.0 {
                assert_eq!((tau[i], solved.slip[i]), (0.0, 0.0));
                continue;
            }
            let Transient { rate, centring } = data.transient;
            let since = |i: usize| along(i) - BEFORE[i];
            let mean = rigid_slip_between(data, &along, i) + rate * since(i);
            assert!((mean - solved.slip[i]).abs() < 1e-7, "{i}: {mean} {}", solved.slip[i]);
            let mut slip = data.rigid_slip
                + data.strain_speed.abs() * (along(i) - along(ahead(i)))
                + rate * ((1.0 - centring) * since(i) + centring * since(ahead(i)));
            for (row, correction) in edge.iter().zip(corrections) {
                if *row == i {
                    slip += correction.slip;
                }
            }
            let (phi, bound) = (solved.utilisation[i], data.friction[i] * p[i]);
            assert!((tau[i] + bound * phi).abs() < 1e-9 && phi.abs() <= 1.0);
            if data.regularisation > 0.0 {
                assert!((phi - utilisation(slip, 1e-3)).abs() < 1e-5, "{i}: {phi} {slip}");
            } else if phi.abs() == 1.0 {
                assert!(phi * slip > -1e-8, "{i}: {phi} {slip}");
            } else {
                assert!(slip.abs() < 1e-8, "{i}: {phi} {slip}");
            }
        }
    }

    /// ω r₀ − V and the strain between the middles of the two cells beside a node.
    fn rigid_slip_between(data: &Data, along: &impl Fn(usize) -> f64, i: usize) -> f64 {
        data.rigid_slip - 0.5 * data.strain_speed * (along(i + 1) - along(i - 1))
    }

    /// The tangent is the derivative of the solution in every datum at once.
    #[test]
    fn the_tangent_is_the_derivative() {
        let (pair, profile) = pair();
        let change = Data {
            profile: (0..NODES).map(|i| 0.2 * (0.7 * i as f64).sin()).collect(),
            displacement: (0..NODES).map(|i| 0.1 * (0.4 * i as f64).cos()).collect(),
            friction: (0..NODES).map(|i| 0.05 * (0.3 * i as f64).sin()).collect(),
            total: 0.7,
            rigid_slip: 0.03,
            strain_speed: 2.0,
            transient: Transient {
                rate: 1.0,
                centring: 0.3,
            },
            regularisation: 0.0,
        };
        for (rigid_slip, strain_speed, regularisation) in [
            (0.01, 30.0, 1e-3),
            (-0.05, -20.0, 1e-3),
            (0.01, 30.0, 0.0),
            (-0.05, -20.0, 0.0),
        ] {
            let data = data(&profile, rigid_slip, strain_speed, regularisation);
            let problem = data.problem(&pair, NormalSolver::ActiveSet);
            let mut solved = solve(&problem);
            let mut mechanics = Mechanics::new(NODES, &Settings::default());
            mechanics.linearise(&problem, &mut solved.tractions()).unwrap();
            let mut tangent = SolvedTractions::new();
            // Of the magnitude of the strain speed.
            let sign = strain_speed.signum();
            mechanics.tangent(
                &problem,
                &TractionProblemTangent {
                    profile: &change.profile,
                    displacement: &change.displacement,
                    friction: &change.friction,
                    friction_of_slip: &change.friction,
                    total: change.total,
                    rigid_slip: change.rigid_slip,
                    strain_speed: sign * change.strain_speed,
                    transient: change.transient,
                },
                &mut tangent.tractions(),
            );
            let h = 1e-6;
            let [ahead, behind] =
                [h, -h].map(|h| solve(&data.moved(h, &change).problem(&pair, NormalSolver::ActiveSet)));
            // Truncation is h², the tolerance of the two solutions 1e-12/h.
            let close = |a: f64, b: f64, d: f64| ((a - b) / (2.0 * h) - d).abs() < 1e-4 * (1.0 + d.abs());
            for i in 0..NODES {
                assert!(
                    close(ahead.pressure[i], behind.pressure[i], tangent.pressure[i]),
                    "p {i}"
                );
                assert!(close(ahead.shear[i], behind.shear[i], tangent.shear[i]), "tau {i}");
                assert!(close(ahead.slip[i], behind.slip[i], tangent.slip[i]), "s {i}");
                assert!(
                    close(ahead.utilisation[i], behind.utilisation[i], tangent.utilisation[i]),
                    "phi {i}: {} {}",
                    (ahead.utilisation[i] - behind.utilisation[i]) / (2.0 * h),
                    tangent.utilisation[i]
                );
            }
            assert!(close(ahead.penetration, behind.penetration, tangent.penetration));
            assert!(tangent.shear.iter().any(|t| t.abs() > 1e-2));
        }
    }
}
