//! Tractions for given temperature and wear: the normal problem (37) for given shear ↔ friction (30) for given
//! pressure, repeated until both rest (Steps 2 to 5 of section 4.1 of the paper).
//!
//! As long as the active set stays, the pressure is an affine function of the shear. With the active-set solver the
//! friction problem sees that [`Response`], and two sweeps do where alternating as printed takes ten; with the paper's
//! linearisation method the two problems alternate as printed.

use super::normal::active_set::ActiveSet;
use super::normal::problem::NormalProblem;
use super::normal::pschenichnyj::Pschenichnyj;
use super::problem::{MechanicsProblem, Tractions, node_ahead, under_pressure};
use super::response::Response;
use super::tangential::{Tangential, TangentialProblem};
use crate::error::{Error, Result};
use crate::numerics::dense;
use crate::parameters::NormalSolver;
use crate::settings::{MechanicsSettings, Settings};

/// What a sweep changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// Largest change of the shear, relative to the peak pressure.
    pub shear_change: f64,
    /// Whether other nodes are under pressure than before.
    pub set_changed: bool,
}

impl Sweep {
    /// Nothing changed.
    pub const NONE: Sweep = Sweep {
        shear_change: 0.0,
        set_changed: false,
    };

    /// Whether the tractions rest to a tolerance.
    pub fn rests(&self, tolerance: f64) -> bool {
        self.shear_change <= tolerance && !self.set_changed
    }
}

/// Solvers and scratch, for one compliance.
pub struct Mechanics {
    pub(super) settings: MechanicsSettings,
    pub(super) active_set: ActiveSet,
    pschenichnyj: Pschenichnyj,
    pub(super) tangential: Tangential,
    pub(super) response: Response,
    /// Of the normal problem, with the upward displacement of the shear, n.
    pub(super) profile: Vec<f64>,
    /// Along x₁, n.
    pub(super) displacement: Vec<f64>,
    /// The nodes under pressure, and those of the sweep before.
    pub(super) nodes: Vec<usize>,
    nodes_before: Vec<usize>,
    /// Values on the nodes under pressure.
    pub(super) local: Local,
}

/// Values on the m nodes under pressure, in the order of the nodes.
pub(super) struct Local {
    pub(super) pressure: Vec<f64>,
    pub(super) shear: Vec<f64>,
    pub(super) strain: Vec<f64>,
    pub(super) friction: Vec<f64>,
    /// Change of the profile.
    pub(super) profile: Vec<f64>,
    /// What follows a change of the shear.
    pub(super) following: Vec<f64>,
}

/// The friction problem with given pressure, strain and μ on the nodes under pressure.
pub(super) fn tangential_problem<'a>(
    problem: &MechanicsProblem,
    response: &'a Response,
    (pressure, strain, friction): (&'a [f64], &'a [f64], &'a [f64]),
    tolerance: f64,
) -> TangentialProblem<'a> {
    TangentialProblem {
        pressure,
        strain,
        pressure_response: response.pressure(),
        strain_response: response.strain(),
        friction,
        rigid_slip: problem.rigid_slip,
        strain_speed: problem.strain_speed.abs(),
        regularisation: problem.regularisation,
        tolerance,
    }
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
            profile: vector(),
            displacement: vector(),
            nodes: Vec::with_capacity(nodes),
            nodes_before: Vec::with_capacity(nodes),
            local: Local {
                pressure: vector(),
                shear: vector(),
                strain: vector(),
                friction: vector(),
                profile: vector(),
                following: vector(),
            },
        }
    }

    /// Forgets what was factorised for the step before.
    pub fn start_step(&mut self) {
        self.tangential.forget();
    }

    /// Forgets what belongs to the normal compliance: it has been replaced.
    pub fn forget_normal_compliance(&mut self) {
        self.active_set.forget();
        self.response.forget();
    }

    /// Solves from the given tractions until the shear changes by less than `tolerance`, relative to the peak pressure.
    ///
    /// # Errors
    /// The first solver that does not converge, [`Error::MechanicsNotConverged`].
    pub fn solve(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions, tolerance: f64) -> Result<()> {
        let mut residual = f64::INFINITY;
        for _ in 0..self.settings.sweeps {
            let sweep = self.sweep(problem, tractions, tolerance)?;
            residual = sweep.shear_change;
            if sweep.rests(tolerance) {
                return Ok(());
            }
        }
        Err(Error::MechanicsNotConverged {
            iterations: self.settings.sweeps,
            residual,
            tolerance,
        })
    }

    /// One sweep: normal problem, then friction with the pressure that follows, to `tolerance` relative to the peak
    /// pressure. With the active-set solver that is the solution as long as the active set stays.
    ///
    /// # Errors
    /// The first solver that does not converge.
    pub fn sweep(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions, tolerance: f64) -> Result<Sweep> {
        let set_changed = self.solve_normal(problem, tractions)?;
        let change = self.solve_friction(problem, tractions, tolerance)?;
        let largest = tractions.pressure.iter().fold(f64::MIN_POSITIVE, |m, p| p.max(m));
        Ok(Sweep {
            shear_change: change / largest,
            set_changed,
        })
    }

    /// (37) for given shear. Returns whether the set of nodes under pressure changed.
    fn solve_normal(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions) -> Result<bool> {
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
        }
        // Not whether the response was computed anew: that depends on what was solved before this step.
        Ok(self.nodes != self.nodes_before)
    }

    /// (30) for given pressure and its response; pressure and penetration follow. Returns the largest change of the shear.
    fn solve_friction(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions, tolerance: f64) -> Result<f64> {
        // Within Coulomb's bound from the start: a shear left over from a much larger pressure would make strains that
        // swamp those of this one.
        let mut clamped = 0.0_f64;
        for (node, shear) in tractions.shear.iter_mut().enumerate() {
            let bound = problem.friction[node] * tractions.pressure[node];
            let within = shear.clamp(-bound, bound);
            clamped = clamped.max((*shear - within).abs());
            *shear = within;
        }
        self.displacement.copy_from_slice(problem.displacement);
        let compliance = problem.compliance;
        dense::multiply_add(
            &compliance.tangential_normal,
            tractions.pressure,
            -1.0,
            &mut self.displacement,
        );
        dense::multiply_add(
            &compliance.tangential_tangential,
            tractions.shear,
            1.0,
            &mut self.displacement,
        );
        let m = self.nodes.len();
        for (row, &node) in self.nodes.iter().enumerate() {
            let ahead = node_ahead(node, problem.is_forward());
            self.local.pressure[row] = tractions.pressure[node];
            self.local.shear[row] = tractions.shear[node];
            self.local.friction[row] = problem.friction[node];
            self.local.strain[row] = self.displacement[node] - self.displacement[ahead];
        }
        let Local {
            pressure,
            shear,
            strain,
            friction,
            ..
        } = &mut self.local;
        let tangential = tangential_problem(
            problem,
            &self.response,
            (&pressure[..m], &strain[..m], &friction[..m]),
            tolerance,
        );
        let change = self.tangential.solve(&tangential, &mut shear[..m])?;
        for (row, &node) in self.nodes.iter().enumerate() {
            let change = self.local.shear[row] - tractions.shear[node];
            *tractions.penetration += self.response.penetration()[row] * change;
        }
        let point = self.tangential.point();
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.shear[node] = self.local.shear[row];
            tractions.slip[node] = point.slip[row];
            tractions.pressure[node] = point.pressure[row];
        }
        Ok(change.max(clamped))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::compliance::{RollingCompliance, Scales};
    use crate::body::mesh::Mesh;
    use crate::body::pair;
    use crate::friction::coulomb::saturation;
    use crate::mechanics::normal::problem::Constraint;
    use crate::mechanics::problem::ProblemTangent;
    use crate::parameters::Parameters;
    use crate::settings::Settings;

    const NODES: usize = 25;

    /// A rigid wheel on a small rail, so that normal and tangential problem are coupled.
    fn pair() -> (RollingCompliance, Vec<f64>) {
        let parameters = Parameters {
            contact_nodes: NODES,
            depth_nodes: 15,
            ..Parameters::default()
        };
        let mesh = Mesh::new(&parameters);
        let scales = Scales::new(&parameters);
        let (pair, _) = pair::build(&mesh, &parameters, &scales).unwrap();
        let profile = (0..NODES)
            .map(|i| -0.5 * mesh.contact_position(i).powi(2) / parameters.wheel_radius / scales.displacement)
            .collect();
        (pair, profile)
    }

    struct Solved {
        pressure: Vec<f64>,
        shear: Vec<f64>,
        slip: Vec<f64>,
        penetration: f64,
    }

    impl Solved {
        fn new() -> Solved {
            Solved {
                pressure: vec![0.0; NODES],
                shear: vec![0.0; NODES],
                slip: vec![0.0; NODES],
                penetration: 0.0,
            }
        }

        fn tractions(&mut self) -> Tractions<'_> {
            Tractions {
                pressure: &mut self.pressure,
                shear: &mut self.shear,
                slip: &mut self.slip,
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
    }

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
            }
        }

        fn problem<'a>(&'a self, pair: &'a RollingCompliance, normal_solver: NormalSolver) -> MechanicsProblem<'a> {
            MechanicsProblem {
                compliance: &pair.at_rest,
                normal_compliance: &pair.at_rest.normal_normal,
                profile: &self.profile,
                displacement: &self.displacement,
                friction: &self.friction,
                constraint: Constraint::Total(self.total),
                normal_solver,
                rigid_slip: self.rigid_slip,
                strain_speed: self.strain_speed,
                regularisation: 1e-3,
            }
        }
    }

    fn data(profile: &[f64], rigid_slip: f64, strain_speed: f64) -> Data {
        Data {
            profile: profile.to_vec(),
            displacement: vec![0.0; NODES],
            friction: (0..NODES).map(|i| 0.3 + 0.005 * i as f64).collect(),
            total: 8.0,
            rigid_slip,
            strain_speed,
        }
    }

    fn solve(problem: &MechanicsProblem) -> Solved {
        let mut solved = Solved::new();
        let mut mechanics = Mechanics::new(NODES, &Settings::default());
        mechanics.solve(problem, &mut solved.tractions(), 1e-12).unwrap();
        solved
    }

    /// Every condition of (22) and (30) at every node, evaluated from the compliance itself, for both methods and directions.
    #[test]
    fn the_tractions_satisfy_contact_and_friction() {
        let (pair, profile) = pair();
        for (rigid_slip, strain_speed) in [(0.0, 30.0), (0.02, 30.0), (-0.02, -30.0), (0.3, 30.0)] {
            for method in [NormalSolver::ActiveSet, NormalSolver::Pschenichnyj] {
                let data = data(&profile, rigid_slip, strain_speed);
                let problem = data.problem(&pair, method);
                let solved = solve(&problem);
                let (p, tau) = (&solved.pressure, &solved.shear);
                assert!((p.iter().sum::<f64>() - data.total).abs() < 1e-9);
                let sum = |matrix: &nalgebra::DMatrix<f64>, i: usize, f: &[f64]| {
                    (0..NODES).map(|j| matrix[(i, j)] * f[j]).sum::<f64>()
                };
                let c = &pair.at_rest;
                let along = |i: usize| sum(&c.tangential_tangential, i, tau) - sum(&c.tangential_normal, i, p);
                for i in 1..NODES - 1 {
                    let upward = sum(&c.normal_tangential, i, tau) - sum(&c.normal_normal, i, p);
                    let separation = -(upward + profile[i] + solved.penetration);
                    assert!(p[i] >= 0.0 && separation > -1e-8, "{i}: {} {separation}", p[i]);
                    assert!(p[i] * separation < 1e-8, "{i}: {} {separation}", p[i]);
                    if p[i] == 0.0 {
                        assert_eq!((tau[i], solved.slip[i]), (0.0, 0.0));
                        continue;
                    }
                    let ahead = if strain_speed > 0.0 { i + 1 } else { i - 1 };
                    let slip = rigid_slip + strain_speed.abs() * (along(i) - along(ahead));
                    assert!((slip - solved.slip[i]).abs() < 1e-7, "{i}: {slip} {}", solved.slip[i]);
                    let law = -data.friction[i] * p[i] * saturation(slip, 1e-3);
                    assert!((tau[i] - law).abs() < 1e-6, "{i}: {} {law}", tau[i]);
                }
            }
        }
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
        };
        for (rigid_slip, strain_speed) in [(0.01, 30.0), (-0.05, -20.0)] {
            let data = data(&profile, rigid_slip, strain_speed);
            let problem = data.problem(&pair, NormalSolver::ActiveSet);
            let mut solved = solve(&problem);
            let mut mechanics = Mechanics::new(NODES, &Settings::default());
            mechanics.linearise(&problem, &mut solved.tractions()).unwrap();
            let mut tangent = Solved::new();
            // Of the magnitude of the strain speed.
            let sign = strain_speed.signum();
            mechanics.tangent(
                &problem,
                &ProblemTangent {
                    profile: &change.profile,
                    displacement: &change.displacement,
                    friction: &change.friction,
                    total: change.total,
                    rigid_slip: change.rigid_slip,
                    strain_speed: sign * change.strain_speed,
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
            }
            assert!(close(ahead.penetration, behind.penetration, tangent.penetration));
            assert!(tangent.shear.iter().any(|t| t.abs() > 1e-2));
        }
    }
}
