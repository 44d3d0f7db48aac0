//! The rough track (`rough_track.csv`, written by `tools/rough_track.py`), and what the steps of a wheel on it took.

// Each benchmark uses a part of this.
#![allow(dead_code)]

pub mod profiles;

use crate::timing::thread_time;
use profiles::OnProfiles;
use wheelrail::wheel_rail::Iterations;
use wheelrail::{Inputs, Parameters, Simulation};

/// Communication step, `s`.
pub const STEP: f64 = 1e-3;
/// Steps before the measurement.
pub const WARM_UP: usize = 50;
/// Share of the steps that those of a vehicle simulation in real time are judged by.
const NEARLY_ALL: f64 = 0.999;

/// Inputs at the communication points.
pub fn track() -> Vec<Inputs> {
    let rows = include_str!("../rough_track.csv").lines().skip(1);
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

/// The same inputs without motion across the rail, which a line contact does not have.
pub fn straight(track: &[Inputs]) -> Vec<Inputs> {
    let without = |inputs: &Inputs| Inputs {
        lateral_speed: 0.0,
        spin_rate: 0.0,
        ..*inputs
    };
    track.iter().map(without).collect()
}

/// Inputs of a wheel with profiles.
pub fn on_profiles(track: &[Inputs], profiles: &OnProfiles) -> Vec<Inputs> {
    track.iter().map(|inputs| profiles.inputs(inputs)).collect()
}

/// What the steps of a model took.
pub struct Run {
    /// Least time of each step in all rounds, in their order, `µs`.
    times: Vec<f64>,
    /// The time that 99.9 % of the steps of each round do not exceed, `µs`.
    rounds: Vec<f64>,
    /// Sweeps of the split.
    sweeps: usize,
    before: Iterations,
    after: Iterations,
}

impl Run {
    /// Steps along the whole track.
    pub fn new(parameters: &Parameters, track: &[Inputs]) -> Run {
        let mut simulation = Simulation::new(parameters, &track[0]).expect("a model");
        let mut run = Run {
            times: Vec::with_capacity(track.len()),
            rounds: Vec::new(),
            sweeps: 0,
            before: Iterations::default(),
            after: Iterations::default(),
        };
        for (step, inputs) in track.iter().enumerate().skip(1) {
            if step == WARM_UP {
                run.before = simulation.workspace.iterations();
            }
            let start = thread_time();
            simulation.step(inputs, STEP).expect("a step");
            let time = thread_time() - start;
            if step >= WARM_UP {
                run.times.push(1e6 * time);
                run.sweeps += simulation.state.convergence.iterations;
            }
        }
        run.after = simulation.workspace.iterations();
        run.rounds.push(run.quantile(NEARLY_ALL));
        run
    }

    /// Takes another round of the same steps into account.
    fn add_round(&mut self, round: &Run) {
        for (least, time) in self.times.iter_mut().zip(&round.times) {
            *least = least.min(*time);
        }
        self.rounds.extend_from_slice(&round.rounds);
    }

    /// Number of steps measured.
    pub fn steps(&self) -> usize {
        self.times.len()
    }

    /// The time that a share of the steps does not exceed, `µs`.
    pub fn quantile(&self, share: f64) -> f64 {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        times[((times.len() - 1) as f64 * share) as usize]
    }

    /// The time that 99.9 % of the steps do not exceed in the middle one of the rounds, with what the machine adds, `µs`.
    fn nearly_all_of_a_round(&self) -> f64 {
        let mut rounds = self.rounds.clone();
        rounds.sort_by(f64::total_cmp);
        rounds[rounds.len() / 2]
    }

    /// Headings of the table that [`Run::print`] writes a line of.
    pub fn print_headings(first: &str, ratio: &str) {
        println!(
            "{first:>9} {:>9} {:>9} {:>9} {:>9} {:>9} {ratio:>9} {:>8} {:>8} {:>8} {:>8} {:>8}",
            "median", "99 %", "99.9 %", "worst", "a round", "sweeps", "Newton", "Krylov", "inverted", "CG"
        );
    }

    /// Prints a line of the table: times, the ratio of the median to another one, iterations a step.
    pub fn print(&self, name: &str, other: f64) {
        let per_step =
            |count: fn(&Iterations) -> u64| (count(&self.after) - count(&self.before)) as f64 / self.times.len() as f64;
        let [median, most, nearly_all, worst] = [0.5, 0.99, NEARLY_ALL, 1.0].map(|share| self.quantile(share));
        println!(
            "{name:>9} {median:>9.1} {most:>9.1} {nearly_all:>9.1} {worst:>9.1} {:>9.1} {:>9.2} {:>8.2} {:>8.2} {:>8.1} {:>8.2} {:>8.1}",
            self.nearly_all_of_a_round(),
            median / other,
            self.sweeps as f64 / self.times.len() as f64,
            per_step(|iterations| iterations.newton),
            per_step(|iterations| iterations.krylov),
            per_step(|iterations| iterations.inversions),
            per_step(|iterations| iterations.gradients),
        );
    }
}

/// Runs each in turn, in so many rounds, and keeps the least time of each step. A step is the same work in every round: what it takes longer in
/// one of them is the machine's.
pub fn least<T>(rounds: usize, runs: &[T], run: impl Fn(&T) -> Run) -> Vec<Run> {
    let mut least: Vec<Run> = runs.iter().map(&run).collect();
    for _ in 1..rounds {
        for (least, setting) in least.iter_mut().zip(runs) {
            least.add_round(&run(setting));
        }
    }
    least
}
