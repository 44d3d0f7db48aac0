//! Some of the runs of `wheelrail torture`.

use wheelrail::torture::{Engines, StepTime, Torture};

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
    replay(&CORNERS);
}

/// Runs of wheelsets on profiles that once failed, and steps until the failure.
const WHEELSETS: [(Engines, u64, u64, usize); 18] = [
    // First states in which the law of friction, with a memory and on a layer, has no solution that is found.
    (Engines::NewProfiles, 3, 89, 2),
    (Engines::NewProfiles, 11, 167, 2),
    // Friction on a flange that pulls the wheel down by more than the pressure lifts it.
    (Engines::NewProfiles, 5, 324, 8),
    // The same pulls it up: the wheel was said to be pressed out of its window.
    (Engines::NewProfiles, 11, 17, 17),
    // A light load at which the height of the first touch counts.
    (Engines::NewProfiles, 11, 65, 2),
    // Walls that press on the wheel the more, the higher it is lifted.
    (Engines::NewProfiles, 11, 141, 2),
    // Contacts that a jump has ended, in whose windows the new one was sought.
    (Engines::NewProfiles, 11, 48, 3),
    (Engines::NewProfiles, 21, 45, 2),
    // A flange beside the head: the height at which they touch was sought to and fro.
    (Engines::NewProfiles, 33, 43, 50),
    // Contacts a third of a millimetre apart that pushed each other away by turns.
    (Engines::Profiles, 44, 50, 15),
    // Wear eight thousand times as fast as in truth, which folds a rail's profile: the step that does is refused, not the one after it.
    (Engines::Profiles, 44, 41, 7),
    // Hot rail that has carried the load at next to no approach, and a wheel that comes down elsewhere.
    (Engines::Profiles, 6001, 299, 149),
    // The budget of a step spent on the work that a window had taken in another one; on the way there, a load that grows to three hundred times what it was and an
    // approach that does not.
    (Engines::Profiles, 6001, 90, 132),
    // A window so broad that lines along the rail's normal at its side miss the wheel, from where the next ones did not find it.
    (Engines::Profiles, 6002, 256, 39),
    // Rough wheels that touch first between points of the search, none of which overlaps.
    (Engines::Profiles, 6002, 46, 28),
    (Engines::Profiles, 6003, 189, 14),
    // A load of next to nothing, whose cells all pulled.
    (Engines::Profiles, 6003, 248, 139),
    // Grooves half a millimetre deep, between which no pressure is found.
    (Engines::Profiles, 6008, 290, 80),
];

#[test]
fn wheelsets_that_jump_find_their_contacts() {
    replay(&WHEELSETS);
}

/// Runs end after all their steps.
fn replay(runs: &[(Engines, u64, u64, usize)]) {
    for &(engines, seed, number, steps) in runs {
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
        let iterations = |steps: &[StepTime]| steps.iter().map(|s| s.iterations).sum::<usize>();
        assert_eq!(iterations(&alone.steps), iterations(&run.steps));
    }
    // And another seed is another drive.
    let other = Torture { seed: 8, ..torture }.runs(Torture::runs_of_model(3));
    assert_ne!(together[0].reach, other[0].reach);
}
