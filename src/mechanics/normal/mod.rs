//! The normal contact problem (37): a strictly convex quadratic programme with bounds.
//!
//! Find p ≥ 0 with separation w = C p − b − δ ≥ 0 and p·w = 0, where C is the normal compliance and b the profile of
//! the wheel, raised by thermal bulge and friction, lowered by wear. Either δ is given, or Σp is and δ is its Lagrange
//! multiplier. Everything is scaled (see [`crate::body::compliance::Scales`]).
//!
//! Two methods solve it, which must agree to 1e-8: [`active_set`], the default, and [`pschenichnyj`], the paper's.

pub mod active_inverse;
pub mod active_set;
pub mod normal_problem;
pub mod pschenichnyj;

#[cfg(test)]
mod tests {
    use super::active_set::ActiveSet;
    use super::normal_problem::{Constraint, NormalProblem, NormalSolution};
    use super::pschenichnyj::Pschenichnyj;
    use crate::settings::NormalSettings;
    use nalgebra::DMatrix;
    use proptest::prelude::*;

    fn both(problem: &NormalProblem) -> [(Vec<f64>, NormalSolution); 2] {
        let n = problem.profile.len();
        let mut active = vec![0.0; n];
        let first = ActiveSet::new(n, NormalSettings::default())
            .solve(problem, &mut active)
            .unwrap();
        let mut linearised = vec![0.0; n];
        let second = Pschenichnyj::new(n, NormalSettings::default())
            .solve(problem, &mut linearised)
            .unwrap();
        [(active, first), (linearised, second)]
    }

    fn check(problem: &NormalProblem) {
        let [(p, first), (q, second)] = both(problem);
        let largest = p.iter().fold(1.0_f64, |m, v| v.max(m));
        for (p, q) in p.iter().zip(&q) {
            assert!((p - q).abs() <= 1e-8 * largest, "{p} {q} {first:?} {second:?}");
            assert!(*p >= 0.0);
        }
        for end in 0..problem.free_ends {
            assert_eq!((p[end], p[p.len() - 1 - end]), (0.0, 0.0));
        }
        assert!(
            (first.penetration - second.penetration).abs() <= 1e-8 * first.penetration.abs().max(1.0),
            "{first:?} {second:?}"
        );
        if let Constraint::Total(total) = problem.constraint {
            assert!((p.iter().sum::<f64>() - total).abs() <= 1e-11 * total);
        }
    }

    proptest! {
        // Random positive definite matrices with a condition number up to some hundreds.
        #[test]
        fn both_methods_agree(
            entries in prop::collection::vec(-1.0..1.0, 225),
            profile in prop::collection::vec(-1.0..1.0, 15),
            value in 0.01..3.0,
            load in any::<bool>(),
        ) {
            let a: DMatrix<f64> = DMatrix::from_vec(15, 15, entries);
            let compliance: DMatrix<f64> = &a * a.transpose() * 0.3 + DMatrix::identity(15, 15) * 0.1;
            let constraint = if load { Constraint::Total(value) } else { Constraint::Penetration(value - 1.5) };
            for free_ends in 0..2 {
                check(&NormalProblem { compliance: &compliance, profile: &profile, constraint, free_ends });
            }
        }

        #[test]
        fn the_method_that_moves_one_node_at_a_time_gives_the_same(
            entries in prop::collection::vec(-1.0..1.0, 100),
            profile in prop::collection::vec(-1.0..1.0, 10),
            load in any::<bool>(),
        ) {
            let a: DMatrix<f64> = DMatrix::from_vec(10, 10, entries);
            let compliance: DMatrix<f64> = &a * a.transpose() + DMatrix::identity(10, 10) * 0.1;
            let constraint = if load { Constraint::Total(1.0) } else { Constraint::Penetration(0.1) };
            let problem = NormalProblem { compliance: &compliance, profile: &profile, constraint, free_ends: 0 };
            let mut solver = ActiveSet::new(10, NormalSettings::default());
            let (mut p, mut q) = (vec![0.0; 10], vec![0.0; 10]);
            let first = solver.solve(&problem, &mut p).unwrap();
            let second = solver.descend(&problem, &mut q).unwrap();
            prop_assert!((first.penetration - second.penetration).abs() < 1e-10);
            for (p, q) in p.iter().zip(&q) {
                prop_assert!((p - q).abs() < 1e-10);
            }
        }
    }

    #[test]
    fn a_separated_wheel_has_no_pressure() {
        let compliance = DMatrix::identity(4, 4);
        let problem = NormalProblem {
            compliance: &compliance,
            profile: &[-0.3, -0.1, 0.0, -0.2],
            constraint: Constraint::Penetration(-0.5),
            free_ends: 0,
        };
        for (pressure, _) in both(&problem) {
            assert_eq!(pressure, vec![0.0; 4]);
        }
    }
}
