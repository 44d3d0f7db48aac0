//! Steps on a rough track (`rough_track.csv`, written by `tools/rough_track.py`): line, patch on several grids, and profiles with one contact on the
//! tread and with two, all effects on.
//! Percentiles, the ratio to the line's step in the same run, and the iterations of the patch's solvers a step, which are the same on
//! every machine.
//!
//! Times are those that the thread has computed, as in `summary`.

mod braking;
mod timing;

use timing::thread_time;
use wheelrail::parameters::ContactModel;
use wheelrail::wheel_rail::Iterations;
use wheelrail::{Inputs, Parameters, Simulation};

/// Steps before the measurement.
const WARM_UP: usize = 50;
const ROUNDS: usize = 3;
/// Cells along and across.
const GRIDS: [(usize, usize); 5] = [(34, 21), (24, 15), (16, 11), (12, 9), (10, 7)];

/// Lateral displacement of the left wheel S1002 on 60E1: on the tread, and where tread and gauge corner carry, `m`.
const PROFILES: [(&str, f64); 2] = [("tread", 0.0), ("two", 5.0e-3)];
/// Part of the track's spin that a contact of profiles has by its inclination, `1/m`.
const INCLINED: f64 = 0.1;

/// The same load, speeds and creepages for a wheelset at a displacement.
fn on_profiles(track: &[Inputs], displacement: f64) -> Vec<Inputs> {
    let inputs = |inputs: &Inputs| Inputs {
        spin_rate: 0.0,
        yaw_rate: inputs.spin_rate - INCLINED * inputs.vehicle_speed,
        lateral_displacement: displacement,
        ..*inputs
    };
    track.iter().map(inputs).collect()
}

/// Inputs at the communication points.
fn track() -> Vec<Inputs> {
    let rows = include_str!("rough_track.csv").lines().skip(1);
    rows.map(|line| {
        let mut cells = line.split(',').map(|cell| cell.parse().expect("a number"));
        let [_, wheel_speed, vehicle_speed, normal_load, lateral_speed, spin_rate] =
            std::array::from_fn(|_| cells.next().expect("six columns"));
        Inputs {
            wheel_speed,
            vehicle_speed,
            normal_load,
            lateral_speed,
            spin_rate,
            ..Inputs::default()
        }
    })
    .collect()
}

/// What the steps of a model took.
struct Run {
    /// Ascending, `µs`.
    times: Vec<f64>,
    /// Sweeps of the split.
    sweeps: usize,
    before: Iterations,
    after: Iterations,
}

impl Run {
    fn new(parameters: &Parameters, track: &[Inputs]) -> Run {
        let mut simulation = Simulation::new(parameters, &track[0]).expect("a model");
        let mut run = Run {
            times: Vec::with_capacity(track.len()),
            sweeps: 0,
            before: Iterations::default(),
            after: Iterations::default(),
        };
        for (step, inputs) in track.iter().enumerate().skip(1) {
            if step == WARM_UP {
                run.before = simulation.workspace.iterations();
            }
            let start = thread_time();
            simulation.step(inputs, braking::STEP).expect("a step");
            let time = thread_time() - start;
            if step >= WARM_UP {
                run.times.push(1e6 * time);
                run.sweeps += simulation.state.convergence.iterations;
            }
        }
        run.after = simulation.workspace.iterations();
        run.times.sort_by(f64::total_cmp);
        run
    }

    /// The time that a share of the steps does not exceed, `µs`.
    fn quantile(&self, share: f64) -> f64 {
        self.times[((self.times.len() - 1) as f64 * share) as usize]
    }

    /// Prints a line of the table.
    fn print(&self, name: &str, line: f64) {
        let per_step =
            |count: fn(&Iterations) -> u64| (count(&self.after) - count(&self.before)) as f64 / self.times.len() as f64;
        let [median, most, nearly_all, worst] = [0.5, 0.99, 0.999, 1.0].map(|share| self.quantile(share));
        println!(
            "{name:>9} {median:>9.1} {most:>9.1} {nearly_all:>9.1} {worst:>9.1} {:>9.1} {:>8.2} {:>8.2} {:>8.1} {:>8.2} {:>8.1}",
            median / line,
            self.sweeps as f64 / self.times.len() as f64,
            per_step(|iterations| iterations.newton),
            per_step(|iterations| iterations.krylov),
            per_step(|iterations| iterations.factorisations),
            per_step(|iterations| iterations.gradients),
        );
    }
}

fn main() {
    let track = track();
    // A line contact has no motion across the rail.
    let straight: Vec<Inputs> = track
        .iter()
        .map(|inputs| Inputs {
            lateral_speed: 0.0,
            spin_rate: 0.0,
            ..*inputs
        })
        .collect();
    let line = braking::parameters(Parameters::default().contact_nodes);
    let patches =
        GRIDS.map(|(cells, strips)| (format!("{cells} x {strips}"), braking::patch_parameters(cells, strips)));
    let profiles = PROFILES.map(|(name, displacement)| {
        let patch = braking::patch_parameters(GRIDS[0].0, GRIDS[0].1);
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            ..patch
        };
        (name, parameters, on_profiles(&track, displacement))
    });
    let models = || {
        std::iter::once((&line, &straight))
            .chain(patches.iter().map(|(_, patch)| (patch, &track)))
            .chain(profiles.iter().map(|(_, parameters, track)| (parameters, track)))
    };
    let round = || -> Vec<Run> {
        models()
            .map(|(parameters, inputs)| Run::new(parameters, inputs))
            .collect()
    };
    let mut best = round();
    for _ in 1..ROUNDS {
        for (best, next) in best.iter_mut().zip(round()) {
            if next.quantile(0.5) < best.quantile(0.5) {
                *best = next;
            }
        }
    }
    println!(
        "one step of 1 ms on a rough track, V = 20 to 70 m/s, all effects on, {} steps; times in us, fastest of {ROUNDS} rounds; iterations a step",
        best[0].times.len()
    );
    println!(
        "{:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "cells", "median", "99 %", "99.9 %", "worst", "/ line", "sweeps", "Newton", "Krylov", "factors", "CG"
    );
    let median = best[0].quantile(0.5);
    for (name, run) in std::iter::once("line")
        .chain(patches.iter().map(|(name, _)| name.as_str()))
        .chain(profiles.iter().map(|(name, ..)| *name))
        .zip(&best)
    {
        run.print(name, median);
    }
}
