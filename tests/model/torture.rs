//! Some of the runs of `wheelrail torture`.

use wheelrail::torture::{Engines, Torture};

/// Runs of a contact model: models, of four runs each, steps of a run, and how many of the steps are taken at least, not on rails that
/// were too hot.
const RUNS: [(Engines, u64, usize, usize); 2] = [(Engines::Line, 40, 150, 18_000), (Engines::Patch, 8, 40, 900)];

/// Largest share of the steps that may be taken staggered. Of the line's runs it is 51 of 23 994.
const STAGGERED: f64 = 3e-3;

/// No run fails, whatever the wheel goes through, and nearly all steps are solved.
#[test]
fn wheels_driven_at_random_arrive() {
    for (engines, models, steps, least) in RUNS {
        let torture = Torture {
            seed: 1,
            steps,
            window: 1.0,
            engines,
        };
        let (mut failed, mut taken, mut staggered) = (0, 0, 0);
        for model in 0..models {
            for run in torture.runs(Torture::runs_of_model(model)) {
                taken += run.steps.len();
                staggered += run.steps.iter().filter(|step| step.staggered).count();
                if let Some(failure) = run.failure {
                    println!("{engines:?}, run {}, step {}: {failure}", run.number, run.length);
                    failed += 1;
                }
            }
        }
        assert!(taken > least, "{engines:?}: {taken}");
        assert_eq!(failed, 0, "{engines:?}");
        let share = staggered as f64 / taken as f64;
        assert!(share < STAGGERED, "{engines:?}: {staggered} of {taken}");
    }
}

/// Runs by contact, seed and number, and steps until the failure, that once failed with "the tangential Newton solver stopped": friction with a
/// memory sent Newton's method to and fro between corners of its law.
const CORNERS: [(Engines, u64, u64, usize); 4] = [
    (Engines::Line, 77, 5, 117),
    (Engines::Line, 77, 6, 19),
    (Engines::Line, 77, 200, 62),
    // A patch on a layer whose staggered sub-step has no solution that is found; a shorter one has.
    (Engines::Patch, 2028, 322, 29),
];

#[test]
fn friction_with_a_memory_has_corners() {
    for (engines, seed, number, steps) in CORNERS {
        let torture = Torture {
            seed,
            steps,
            window: 1.0,
            engines,
        };
        let run = torture.runs(number..number + 1).pop().unwrap();
        assert_eq!(
            run.failure, None,
            "{engines:?}, seed {seed}, run {number}, step {}",
            run.length
        );
        assert_eq!(run.length, steps);
    }
}

/// A run follows from its seed and number, alone or with those that share its model.
#[test]
fn a_run_is_replayed_with_the_same_bits() {
    let torture = Torture {
        seed: 7,
        steps: 40,
        window: 1.0,
        engines: Engines::Both,
    };
    // The odd models are patches.
    let together = torture.runs(Torture::runs_of_model(3));
    for run in &together {
        let alone = torture.runs(run.number..run.number + 1).pop().unwrap();
        assert_eq!(alone.reach, run.reach);
        assert_eq!((alone.length, alone.failure), (run.length, run.failure.clone()));
        let iterations = |steps: &[wheelrail::torture::StepTime]| steps.iter().map(|s| s.iterations).sum::<usize>();
        assert_eq!(iterations(&alone.steps), iterations(&run.steps));
    }
    // And another seed is another drive.
    let other = Torture { seed: 8, ..torture }.runs(Torture::runs_of_model(3));
    assert_ne!(together[0].reach, other[0].reach);
}
