//! Random shapes of wheel and rail, and random wear: profiles that are built in, perturbed as a measured one is and worn in places.
//!
//! A model takes its profiles from files: those of a seed and a model stand in the folder of the machine for such files as long as a run needs them.

use super::random::Random;
use crate::geometry::profile::Profile;
use crate::parameters::{Parameters, ProfileWear, WearLaw, WheelWearLaw};
use std::f64::consts::TAU;
use std::fs;
use std::path::{Path, PathBuf};

/// Distance of the places at which a perturbation is given, `m`: a quarter of its shortest wave.
const SPACING: f64 = 2.5e-3;
/// Shortest and longest wave of a perturbation, `m`.
const WAVES: [f64; 2] = [10e-3, 80e-3];
/// Amplitudes of a perturbation, `m`: of a new profile within its tolerance, of one that is far out of it.
const AMPLITUDES: [f64; 2] = [5e-6, 0.3e-3];
/// Deepest wear of a place, `m`, and half of the breadth over which it goes to nothing.
const DEEPEST: f64 = 1.5e-3;
const BREADTHS: [f64; 2] = [10e-3, 25e-3];
/// Tries for a profile that its wear does not fold.
const TRIES: usize = 20;

/// Stream of the random numbers of a model's bodies: far from those of parameters and drives.
const STREAM: u64 = 1 << 40;

/// Gives the parameters of a model random shapes of wheel and rail, in files, and random wear.
pub fn draw(seed: u64, model: u64, parameters: &mut Parameters) {
    let random = &mut Random::new(seed, STREAM + model);
    let drawn = parameters.clone();
    loop {
        *parameters = drawn.clone();
        wear(random, parameters);
        if parameters.validate().is_ok() {
            break;
        }
    }
    let [rail, wheel] = files(seed, model);
    for (text, path) in [
        (&mut parameters.rail_profile, rail),
        (&mut parameters.wheel_profile, wheel),
    ] {
        if random.chance(0.25) {
            continue;
        }
        // What cannot be written cannot be read either: the model says so.
        let _ = shape(random, text).map(|profile| written(&profile, &path));
        *text = path.to_string_lossy().into_owned();
    }
}

/// Removes the files of a model.
pub fn remove(seed: u64, model: u64) {
    for path in files(seed, model) {
        let _ = fs::remove_file(path);
    }
}

/// Files of rail and wheel of a model, of this process alone.
fn files(seed: u64, model: u64) -> [PathBuf; 2] {
    ["rail.prr", "wheel.prw"].map(|name| {
        let process = std::process::id();
        std::env::temp_dir().join(format!("wheelrail-torture-{process}-{seed}-{model}-{name}"))
    })
}

/// Writes a profile where nobody finds half of it.
fn written(profile: &Profile, path: &Path) -> Option<()> {
    let ending = path.extension()?.to_str()?;
    let beside = path.with_extension(format!("{:?}.{ending}", std::thread::current().id()).replace(['(', ')'], "-"));
    profile.write(&beside).ok()?;
    fs::rename(&beside, path).ok()
}

/// Profile that is built in, with waves of random lengths, and worn in some places.
fn shape(random: &mut Random, name: &str) -> Option<Profile> {
    let new = Profile::built_in(name).ok()?;
    (0..TRIES).find_map(|_| {
        let amplitude = random.decades(AMPLITUDES[0], AMPLITUDES[1]);
        let waves: [[f64; 3]; 4] = std::array::from_fn(|_| {
            let length = random.decades(WAVES[0], WAVES[1]);
            // Long waves are high, short ones low.
            [
                length,
                random.between(0.0, TAU),
                0.5 * amplitude * (length / WAVES[1]).sqrt(),
            ]
        });
        let places: Vec<[f64; 3]> = (0..random.count(0, 2))
            .map(|_| {
                let breadth = random.between(BREADTHS[0], BREADTHS[1]);
                [
                    random.between(0.2, 0.9) * new.length(),
                    breadth,
                    random.decades(1e-5, DEEPEST),
                ]
            })
            .collect();
        let depth = |arc: f64| {
            let perturbed: f64 = waves
                .iter()
                .map(|[length, phase, height]| height * (TAU * arc / length + phase).sin())
                .sum();
            let worn: f64 = places
                .iter()
                .map(|[place, breadth, depth]| {
                    let share = 1.0 - ((arc - place) / breadth).powi(2);
                    depth * share.max(0.0).powi(2)
                })
                .sum();
            perturbed + worn
        };
        let count = (new.length() / SPACING) as usize;
        let rows: Vec<[f64; 2]> = (0..=count)
            .map(|row| {
                let arc = row as f64 * SPACING;
                [arc, depth(arc)]
            })
            .collect();
        new.worn_by(&rows).ok()
    })
}

/// Draws laws of wear, and profiles that wear.
fn wear(random: &mut Random, parameters: &mut Parameters) {
    parameters.wear_law = random.one_of(WearLaw::ALL);
    parameters.wheel_wear_law = random.one_of(WheelWearLaw::ALL);
    parameters.wheel_profile_wear = random.one_of(ProfileWear::ALL);
    parameters.rail_profile_wear = random.one_of(ProfileWear::ALL);
    parameters.rail_wear_length = random.decades(10.0, 1e4);
    parameters.wear_acceleration = if random.chance(0.3) {
        1.0
    } else {
        random.decades(1.0, 1e4)
    };
    parameters.profile_wear_points = if random.chance(0.5) {
        1500
    } else {
        random.count(200, 2000)
    };
}
