//! Tests of the normal–tangential iteration and of its derivative.

use super::*;
use crate::body::compliance::{RollingCompliance, Scales};
use crate::body::half_plane::HalfPlanes;
use crate::body::mesh::Mesh;
use crate::body::pair;
use crate::friction::coulomb::utilisation;
use crate::mechanics::leading_edge::{EdgeValues, LeadingEdge, NearField};
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
            accepts_regularised: false,
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
    let sum =
        |matrix: &nalgebra::DMatrix<f64>, i: usize, f: &[f64]| (0..NODES).map(|j| matrix[(i, j)] * f[j]).sum::<f64>();
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
        let [ahead, behind] = [h, -h].map(|h| solve(&data.moved(h, &change).problem(&pair, NormalSolver::ActiveSet)));
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
