//! The friction problem on a few nodes.

use super::*;
use crate::friction::coulomb::utilisation;
use crate::friction::memory::ParticlePath;
use crate::friction::path::{PathLaw, PathStep};
use crate::mechanics::leading_edge::{LeadingEdge, NearField};
use crate::parameters::Parameters;
use proptest::prelude::*;

const NODES: usize = 6;

/// A leading edge that adds nothing.
fn no_edge(zero: &[f64]) -> LeadingRows<'_> {
    LeadingRows {
        edge: LeadingEdge {
            near_field: NearField {
                direct: 1.0,
                coupling: 0.0,
                layer: 0.0,
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
        leading: no_edge(&zero[..pressure.len()]),
        regularisation: 1e-3,
        accepts_regularised: false,
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
                utilisation(rigid_slip, regularisation)
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
    /// Regularisations down to a thousandth of the slip are solved, with a pressure that follows the shear a little.
    #[test]
    fn the_solution_satisfies_the_regularised_law(
        pressure in prop::collection::vec(0.1..1.0, NODES),
        slip in prop::collection::vec(-6e-2..6e-2, NODES),
        friction in prop::collection::vec(0.1..0.6, NODES),
        follows in prop::collection::vec(-0.05..0.05, NODES * NODES),
        log_regularisation in -5.0..-2.0,
        has_stalled in any::<bool>(),
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
            leading: no_edge(&zero),
            regularisation,
            accepts_regularised: false,
            tolerance: 1e-12,
        };
        let mut shear = vec![0.0; NODES];
        let mut solver = Tangential::new(NODES, TangentialSettings::default());
        solver.has_stalled = has_stalled;
        solver.solve(&problem, &zero, &mut shear).unwrap();
        for row in 0..NODES {
            let slip = slip[row] + sum(&response, row, &shear);
            let p = (pressure[row] + sum(&follows, row, &shear)).max(0.0);
            let law = -friction[row] * p * utilisation(slip, regularisation);
            // The slope of the law, μ p/ε ds/dτ ≤ 0.6 · 4e-2/1e-5, times the tolerance of the shear.
            prop_assert!((shear[row] - law).abs() < 1e-8, "{row}: {} {law}", shear[row]);
        }
    }

    /// Coulomb's conditions at every node, by the exchanges, by the path alone and with the line search, from any start.
    #[test]
    fn the_solution_satisfies_coulombs_law(
        pressure in prop::collection::vec(0.1..1.0, NODES),
        slip in prop::collection::vec(-6e-2..6e-2, NODES),
        friction in prop::collection::vec(0.1..0.6, NODES),
        follows in prop::collection::vec(-0.05..0.05, NODES * NODES),
        start in prop::collection::vec(-1.0..1.0_f64, NODES),
        exchanges in 1..14_usize,
        has_stalled in any::<bool>(),
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
            leading: no_edge(&zero),
            regularisation: 0.0,
            accepts_regularised: false,
            tolerance: 1e-12,
        };
        let settings = TangentialSettings { exchanges, ..TangentialSettings::default() };
        let mut solver = Tangential::new(NODES, settings);
        solver.has_stalled = has_stalled;
        solver.solve(&problem, &start, &mut shear).unwrap();
        for row in 0..NODES {
            let slip: f64 = slip[row] + sum(&response, row, &shear);
            let p: f64 = pressure[row] + sum(&follows, row, &shear);
            let bound = friction[row] * p.max(0.0);
            let phi = solver.point(NODES).utilisation[row];
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

/// A node that slips the faster the less it carries: friction that falls with slip, beside elasticity. From any shear the
/// solution is the same, and it is one of the law.
#[test]
fn the_line_search_finds_the_solution_of_friction_that_falls_with_slip() {
    let parameters = Parameters {
        friction_slip_share: 0.3,
        friction_slip_decay: 5.0,
        friction_memory_distance: 1e-6,
        layer_yield_stress: 3e8,
        layer_hardening: 1e13,
        ..Parameters::default()
    };
    let step = PathStep {
        duration: 1e-3,
        spacing: 1e-4,
        speed: 10.0,
        displacement: 1e-6,
        pressure: 1e9,
    };
    let law = PathLaw::new(&parameters, &step).unwrap();
    let static_friction = [0.4; NODES + 2];
    let kept = [0.0; NODES + 2];
    let path = ParticlePath {
        static_friction: &static_friction,
        friction: &static_friction,
        speed: &kept,
        flow: &kept,
    };
    let mut nodes = Vec::new();
    law.prepare(
        &path,
        &static_friction,
        |node| (1..=NODES).contains(&node),
        |_, node| nodes.push(node),
    );
    nodes.reverse();
    let pressure: Vec<f64> = (0..NODES).map(|i| 0.9 - 0.1 * i as f64).collect();
    let friction = [0.4; NODES];
    let (response, zero) = (response(), [0.0; NODES]);
    let follows = [0.0; NODES * NODES];
    for rigid_slip in [-0.3, -0.02, -2e-3, 1e-3, 5e-3, 0.02, 0.1, 1.0] {
        for regularisation in [0.0, 1e-4] {
            let mut solutions = Vec::new();
            for start in [-0.2, 0.0, 0.3] {
                let mut shear: Vec<f64> = pressure.iter().map(|p| start * p).collect();
                let slip: Vec<f64> = (0..NODES).map(|i| rigid_slip + sum(&response, i, &shear)).collect();
                let problem = TangentialProblem {
                    pressure: &pressure,
                    slip: &slip,
                    pressure_response: &follows,
                    slip_response: &response,
                    friction: &friction,
                    path: Some((law, &nodes)),
                    leading: no_edge(&zero),
                    regularisation,
                    accepts_regularised: false,
                    tolerance: 1e-12,
                };
                let mut solver = Tangential::new(NODES, TangentialSettings::default());
                solver.has_stalled = true;
                solver.solve(&problem, &zero, &mut shear).unwrap();
                let mut before = Passed::default();
                for row in (0..NODES).rev() {
                    let slip = rigid_slip + sum(&response, row, &shear);
                    let mu = law.friction(&nodes[row], &before, slip.abs(), pressure[row]);
                    before = mu.passed(slip.abs());
                    let bound = mu.coefficient * pressure[row];
                    let expected = if regularisation > 0.0 {
                        -bound * utilisation(slip, regularisation)
                    } else if slip.abs() > 1e-11 {
                        -bound * slip.signum()
                    } else {
                        shear[row].clamp(-bound, bound)
                    };
                    assert!(
                        (shear[row] - expected).abs() < 1e-9,
                        "{rigid_slip} {row}: {} {expected}",
                        shear[row]
                    );
                }
                solutions.push(shear);
            }
            for other in &solutions[1..] {
                for (one, other) in solutions[0].iter().zip(other) {
                    assert!((one - other).abs() < 1e-9, "{rigid_slip}: {solutions:?}");
                }
            }
        }
    }
}
