//! Tractions for given temperature and wear: the normal problem (37) for given shear ↔ friction (30) for given
//! pressure, repeated until both rest (Steps 2 to 5 of section 4.1 of the paper).
//!
//! As long as the active set stays, the pressure is an affine function of the shear. With the active-set solver the
//! friction problem sees that `Response`, and two sweeps do where alternating blindly takes ten; with the paper's
//! linearisation method the two problems alternate as printed.

pub mod normal;
pub mod softening;
pub mod tangential;

use crate::body::compliance::Compliance;
use crate::error::{Error, Result};
use crate::friction::coulomb::{saturation, saturation_slope};
use crate::injection::{self, Solver};
use crate::mechanics::normal::active_set::ActiveSet;
use crate::mechanics::normal::pschenichnyj::Pschenichnyj;
use crate::mechanics::normal::{Constraint, NormalProblem};
use crate::mechanics::tangential::{Tangential, TangentialProblem};
use crate::numerics::dense;
use crate::parameters::NormalSolver;
use nalgebra::DMatrix;

/// Sweeps between normal and tangential problem.
const SWEEPS: usize = 200;
/// Tolerance of [`Mechanics::linearise`].
const TOLERANCE: f64 = 1e-10;

/// The data of one mechanics problem with n contact nodes, scaled.
#[derive(Debug, Clone, Copy)]
pub struct MechanicsProblem<'a> {
    /// Compliance at rest.
    pub compliance: &'a Compliance,
    /// Its C_nn, softened by the wear of the step where that is treated implicitly.
    pub normal_compliance: &'a DMatrix<f64>,
    /// Profile of the wheel, less wear, plus the upward displacement that heat and inertia cause, n.
    pub profile: &'a [f64],
    /// Displacement along x₁ that heat and inertia cause, n.
    pub displacement: &'a [f64],
    /// μ, n.
    pub friction: &'a [f64],
    /// Load or penetration.
    pub constraint: Constraint,
    /// Method for the normal problem.
    pub normal_solver: NormalSolver,
    /// ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// V times the displacement scale over the node spacing, `m/s`; its sign gives the leading side.
    pub strain_speed: f64,
    /// ε, `m/s`.
    pub regularisation: f64,
}

/// Tractions and what belongs to them, n contact nodes.
pub struct Tractions<'a> {
    /// Pressure, scaled.
    pub pressure: &'a mut [f64],
    /// Shear traction on the rail, scaled.
    pub shear: &'a mut [f64],
    /// Slip velocity, `m/s`, 0 outside the contact.
    pub slip: &'a mut [f64],
    /// Penetration, scaled.
    pub penetration: &'a mut f64,
}

/// How pressure and strain on the nodes under pressure respond to the shear on them, m × m each.
#[derive(Debug, Clone)]
struct Response {
    nodes: Vec<usize>,
    forward: bool,
    load_given: bool,
    /// Whether the pressure follows the shear, or stays as in the paper's alternation.
    follows: bool,
    /// ∂p/∂τ.
    pressure: Vec<f64>,
    /// ∂δ/∂τ, m.
    penetration: Vec<f64>,
    /// ∂(u₁ − u₁ of the node ahead)/∂τ.
    strain: Vec<f64>,
}

/// What a sweep changed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sweep {
    /// Largest change of the shear, relative to the peak pressure.
    pub shear_change: f64,
    /// Whether other nodes are under pressure than before.
    pub set_changed: bool,
}

/// Solvers and scratch.
pub struct Mechanics {
    active_set: ActiveSet,
    pschenichnyj: Pschenichnyj,
    tangential: Tangential,
    response: Response,
    profile: Vec<f64>,
    displacement: Vec<f64>,
    /// Values on the nodes under pressure.
    pressure: Vec<f64>,
    shear: Vec<f64>,
    strain: Vec<f64>,
    friction: Vec<f64>,
    nodes: Vec<usize>,
    nodes_before: Vec<usize>,
}

impl Mechanics {
    /// Scratch for `nodes` contact nodes. One of these serves one compliance.
    pub fn new(nodes: usize) -> Mechanics {
        let vector = || vec![0.0; nodes];
        Mechanics {
            active_set: ActiveSet::new(nodes),
            pschenichnyj: Pschenichnyj::new(nodes),
            tangential: Tangential::new(nodes),
            response: Response {
                nodes: Vec::with_capacity(nodes),
                forward: true,
                load_given: true,
                follows: true,
                pressure: vec![0.0; nodes * nodes],
                penetration: vec![0.0; nodes],
                strain: vec![0.0; nodes * nodes],
            },
            profile: vector(),
            displacement: vector(),
            pressure: vector(),
            shear: vector(),
            strain: vector(),
            friction: vector(),
            nodes: Vec::with_capacity(nodes),
            nodes_before: Vec::with_capacity(nodes),
        }
    }

    /// Forgets what was factorised for the step before.
    pub fn start_step(&mut self) {
        self.tangential.forget();
    }

    /// Forgets what belongs to the normal compliance: it has been replaced.
    pub fn forget_normal_compliance(&mut self) {
        self.active_set.forget();
        self.response.nodes.clear();
    }

    /// Solves from the given tractions until the shear changes by less than `tolerance`, relative to the peak pressure.
    ///
    /// # Errors
    /// The first solver that does not converge, [`Error::MechanicsNotConverged`].
    pub fn solve(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions, tolerance: f64) -> Result<()> {
        let mut residual = f64::INFINITY;
        for _ in 0..SWEEPS {
            let sweep = self.sweep(problem, tractions, tolerance)?;
            residual = sweep.shear_change;
            if residual <= tolerance && !sweep.set_changed {
                return Ok(());
            }
        }
        Err(Error::MechanicsNotConverged {
            iterations: SWEEPS,
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
        injection::passes(Solver::Mechanics)?;
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
        injection::passes(match problem.normal_solver {
            NormalSolver::ActiveSet => Solver::ActiveSet,
            NormalSolver::Pschenichnyj => Solver::Pschenichnyj,
        })?;
        *tractions.penetration = solution.penetration;

        self.nodes.clear();
        self.nodes.extend(under_pressure(tractions.pressure));
        let forward = problem.strain_speed >= 0.0;
        let load_given = matches!(problem.constraint, Constraint::Total(_));
        let follows = problem.normal_solver == NormalSolver::ActiveSet && self.active_set.active() == self.nodes;
        let response = &mut self.response;
        let known = response.nodes == self.nodes
            && (response.forward, response.load_given, response.follows) == (forward, load_given, follows);
        if !known {
            response.nodes.clone_from(&self.nodes);
            (response.forward, response.load_given, response.follows) = (forward, load_given, follows);
            self.update_response(problem.compliance);
        }
        // Not whether the response was known: that depends on what was solved before.
        Ok(self.nodes != self.nodes_before)
    }

    /// (30) for given pressure and its response; pressure and penetration follow. Returns the largest change of the shear.
    fn solve_friction(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions, tolerance: f64) -> Result<f64> {
        // Within the bound from the start: a shear left over from a much larger pressure would swamp this one's strain.
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
            let ahead = node_ahead(node, problem.strain_speed >= 0.0);
            self.pressure[row] = tractions.pressure[node];
            self.shear[row] = tractions.shear[node];
            self.friction[row] = problem.friction[node];
            self.strain[row] = self.displacement[node] - self.displacement[ahead];
        }
        let change = self.tangential.solve(
            &TangentialProblem {
                pressure: &self.pressure[..m],
                strain: &self.strain[..m],
                pressure_response: &self.response.pressure,
                strain_response: &self.response.strain,
                friction: &self.friction[..m],
                rigid_slip: problem.rigid_slip,
                strain_speed: problem.strain_speed.abs(),
                regularisation: problem.regularisation,
                tolerance,
            },
            &mut self.shear[..m],
        )?;
        for (row, &node) in self.nodes.iter().enumerate() {
            *tractions.penetration += self.response.penetration[row] * (self.shear[row] - tractions.shear[node]);
        }
        let point = self.tangential.point();
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.shear[node] = self.shear[row];
            tractions.slip[node] = point.slip[row];
            tractions.pressure[node] = point.pressure[row];
        }
        injection::passes(Solver::Tangential)?;
        Ok(change.max(clamped))
    }

    /// ∂p/∂τ = Π C_nt with Π = C_AA⁻¹, under a given load Π = C_AA⁻¹ − C_AA⁻¹1 1ᵀC_AA⁻¹ / (1ᵀC_AA⁻¹1), and the strain of
    /// C_tt − C_tn ∂p/∂τ. With the paper's method ∂p/∂τ is left out.
    fn update_response(&mut self, compliance: &Compliance) {
        self.tangential.forget();
        let nodes = &self.nodes;
        let m = nodes.len();
        let response = &mut self.response;
        let (inverse, unit) = self.active_set.inverse();
        let unit_sum: f64 = unit.iter().sum();
        for (column, &loaded) in nodes.iter().enumerate() {
            let range = column * m..(column + 1) * m;
            let (pressure, strain) = (&mut response.pressure[range.clone()], &mut response.strain[range]);
            pressure.fill(0.0);
            response.penetration[column] = 0.0;
            if response.follows {
                for (row, &node) in nodes.iter().enumerate() {
                    self.pressure[row] = compliance.normal_tangential[(node, loaded)];
                }
                dense::multiply(inverse, m, &self.pressure, pressure);
                if response.load_given {
                    let total = pressure.iter().sum::<f64>() / unit_sum;
                    dense::add_multiple(unit, -total, pressure);
                    response.penetration[column] = -total;
                }
            }
            // Only the columns of nodes under pressure are read.
            self.displacement
                .copy_from_slice(compliance.tangential_tangential.column(loaded).as_slice());
            for (&node, &p) in nodes.iter().zip(pressure.iter()) {
                if p != 0.0 {
                    let moved = compliance.tangential_normal.column(node);
                    dense::vectorised(
                        #[inline(always)]
                        |arithmetic| arithmetic.add_multiple(moved.as_slice(), -p, &mut self.displacement),
                    );
                }
            }
            for (strain, &node) in strain.iter_mut().zip(nodes) {
                *strain = self.displacement[node] - self.displacement[node_ahead(node, response.forward)];
            }
        }
    }
}

/// Change of a [`MechanicsProblem`]'s data in one direction, n contact nodes.
#[derive(Debug, Clone, Copy)]
pub struct ProblemTangent<'a> {
    /// Of the profile.
    pub profile: &'a [f64],
    /// Of the displacement along x₁.
    pub displacement: &'a [f64],
    /// Of μ.
    pub friction: &'a [f64],
    /// Of Σp; without effect where the penetration is given.
    pub total: f64,
    /// Of ω r₀ − V, `m/s`.
    pub rigid_slip: f64,
    /// Of the strain speed's magnitude, `m/s`.
    pub strain_speed: f64,
}

impl Mechanics {
    /// Solves from tractions at rest and factorises there, for [`Mechanics::tangent`].
    ///
    /// # Errors
    /// As [`Mechanics::solve`].
    pub fn linearise(&mut self, problem: &MechanicsProblem, tractions: &mut Tractions) -> Result<()> {
        let problem = MechanicsProblem {
            normal_solver: NormalSolver::ActiveSet,
            ..*problem
        };
        self.solve(&problem, tractions, TOLERANCE)?;
        let singular = Error::MechanicsNotConverged {
            iterations: 0,
            residual: f64::NAN,
            tolerance: TOLERANCE,
        };
        let m = self.nodes.len();
        let friction = &self.friction[..m];
        let tangential = TangentialProblem {
            pressure: &self.pressure[..m],
            strain: &self.strain[..m],
            pressure_response: &self.response.pressure,
            strain_response: &self.response.strain,
            friction,
            rigid_slip: problem.rigid_slip,
            strain_speed: problem.strain_speed.abs(),
            regularisation: problem.regularisation,
            tolerance: TOLERANCE,
        };
        if self.tangential.linearise(&tangential) {
            Ok(())
        } else {
            Err(singular)
        }
    }

    /// Change of the tractions with the data of the problem at the point of [`Mechanics::linearise`], at an unchanged
    /// active set: the implicit function theorem on (37) and (30).
    pub fn tangent(&mut self, problem: &MechanicsProblem, change: &ProblemTangent, tractions: &mut Tractions) {
        let m = self.nodes.len();
        let compliance = problem.compliance;
        let forward = problem.strain_speed >= 0.0;
        let speed = problem.strain_speed.abs();
        // Pressure at unchanged shear.
        for (row, &node) in self.nodes.iter().enumerate() {
            self.friction[row] = change.profile[node];
        }
        let (inverse, unit) = self.active_set.inverse();
        dense::multiply(inverse, m, &self.friction, &mut self.pressure);
        let load_given = self.response.load_given;
        if load_given {
            let lift = (change.total - self.pressure[..m].iter().sum::<f64>()) / unit.iter().sum::<f64>();
            dense::add_multiple(unit, lift, &mut self.pressure[..m]);
        }
        // Strain at unchanged shear.
        tractions.pressure.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = self.pressure[row];
        }
        self.displacement.copy_from_slice(change.displacement);
        dense::multiply_add(
            &compliance.tangential_normal,
            tractions.pressure,
            -1.0,
            &mut self.displacement,
        );
        // (1 + μ p φ′ ∂s/∂τ + μ φ ∂p/∂τ) dτ = −(dμ p φ + μ φ dp + μ p φ′ ds) with dp, ds at unchanged shear.
        let point = self.tangential.point();
        for (row, &node) in self.nodes.iter().enumerate() {
            let strain = self.displacement[node] - self.displacement[node_ahead(node, forward)];
            // |V|/Δx (u₁ − u₁ ahead) is s less the rigid slip.
            let stretched = if speed > 0.0 {
                (point.slip[row] - problem.rigid_slip) / speed
            } else {
                0.0
            };
            self.strain[row] = change.rigid_slip + change.strain_speed * stretched + speed * strain;
            let (phi, slope) = (
                saturation(point.slip[row], problem.regularisation),
                saturation_slope(point.slip[row], problem.regularisation),
            );
            self.shear[row] = -(change.friction[node] * point.pressure[row] * phi
                + problem.friction[node] * phi * self.pressure[row]
                + problem.friction[node] * point.pressure[row] * slope * self.strain[row]);
        }
        self.tangential.solve_linear(&mut self.shear[..m]);

        dense::multiply(&self.response.pressure, m, &self.shear, &mut self.friction);
        dense::add_multiple(&self.friction[..m], 1.0, &mut self.pressure[..m]);
        dense::multiply(&self.response.strain, m, &self.shear, &mut self.friction);
        dense::add_multiple(&self.friction[..m], speed, &mut self.strain[..m]);
        tractions.pressure.fill(0.0);
        tractions.shear.fill(0.0);
        tractions.slip.fill(0.0);
        for (row, &node) in self.nodes.iter().enumerate() {
            tractions.pressure[node] = self.pressure[row];
            tractions.shear[node] = self.shear[row];
            tractions.slip[node] = self.strain[row];
        }
        // δ from any closed node: dδ = (C dp − db) there.
        *tractions.penetration = match (load_given, self.nodes.first()) {
            (true, Some(&node)) => {
                self.profile.copy_from_slice(change.profile);
                dense::multiply_add(&compliance.normal_tangential, tractions.shear, 1.0, &mut self.profile);
                for profile in &mut self.profile {
                    *profile = -*profile;
                }
                dense::multiply_add(problem.normal_compliance, tractions.pressure, 1.0, &mut self.profile);
                self.profile[node]
            }
            _ => 0.0,
        };
    }
}

/// The nodes under pressure. The ends of the window have no neighbour; a contact that rests there is an error of the
/// step.
fn under_pressure(pressure: &[f64]) -> impl Iterator<Item = usize> + '_ {
    (1..pressure.len() - 1).filter(|&i| pressure[i] > 0.0)
}

/// The next node on the leading side: towards +x₁ where V ≥ 0.
fn node_ahead(node: usize, forward: bool) -> usize {
    if forward { node + 1 } else { node - 1 }
}
