//! Eight wheels of one vehicle on the rough track, in one process, on one thread and on two: the time of a simulated second in steps of 1 ms, and of
//! the single steps of all eight, against real time.
//!
//! A vehicle waits for its slowest wheel, so that what counts is the time of a step of all eight. The wheels run over the same track at different
//! places: each begins at another row of the table. Times are those that a thread has computed; of two threads, the longer one in each step,
//! as if both had a core of their own.
//!
//! What is printed goes into the table `results/eight_wheels.csv` as well.

mod braking;
mod timing;
mod track;

use std::sync::{Arc, Barrier};
use timing::thread_time;
use track::{STEP, WARM_UP};
use wheelrail::parameters::PatchGrid;
use wheelrail::{Inputs, Model, Parameters, Simulation};

const WHEELS: usize = 8;
/// Steps measured: a second.
const STEPS: usize = 1_000;
const ROUNDS: usize = 2;
/// Rows of the track between the places of two wheels: the wheels of a bogie, 2.5 m apart at 25 m/s.
const APART: usize = 100;

/// Model of the wheels, the track, and how many of its rows a step takes.
struct Setting {
    name: String,
    parameters: Parameters,
    track: Vec<Inputs>,
    rows: usize,
}

impl Setting {
    /// Communication step, `s`.
    fn step(&self) -> f64 {
        self.rows as f64 * STEP
    }

    /// Steps measured.
    fn steps(&self) -> usize {
        STEPS / self.rows
    }

    /// Wheels of one model, after the steps of the warm-up.
    fn wheels(&self) -> Vec<Wheel> {
        let model = Arc::new(Model::new(self.parameters.clone()).expect("a model"));
        let wheel = |number: usize| {
            let ahead = self.track[number * APART..].iter().step_by(self.rows);
            let inputs: Vec<Inputs> = ahead.take(WARM_UP + self.steps()).copied().collect();
            let simulation = Simulation::of(model.clone(), &inputs[0]).expect("a state");
            let mut wheel = Wheel {
                simulation,
                inputs,
                step: self.step(),
            };
            (1..WARM_UP).for_each(|step| wheel.step(step));
            wheel
        };
        (0..WHEELS).map(wheel).collect()
    }
}

/// One of the wheels, and the inputs that lie before it.
struct Wheel {
    simulation: Simulation,
    inputs: Vec<Inputs>,
    step: f64,
}

impl Wheel {
    fn step(&mut self, step: usize) {
        self.simulation.step(&self.inputs[step], self.step).expect("a step");
    }
}

/// Times of the steps of all eight, ascending, `µs`.
struct Times(Vec<f64>);

impl Times {
    fn of(mut times: Vec<f64>) -> Times {
        times.sort_by(f64::total_cmp);
        Times(times)
    }

    fn quantile(&self, share: f64) -> f64 {
        self.0[((self.0.len() - 1) as f64 * share) as usize]
    }

    /// Time of a simulated second in such steps, `s`.
    fn second(&self, step: f64) -> f64 {
        1e-6 * self.0.iter().sum::<f64>() / (self.0.len() as f64 * step)
    }

    /// Share of the steps that take longer than they simulate.
    fn late(&self, step: f64) -> f64 {
        self.0.iter().filter(|time| **time > 1e6 * step).count() as f64 / self.0.len() as f64
    }
}

/// Way of taking so many steps of all wheels.
type Drive = fn(Vec<Wheel>, usize) -> Times;

/// One wheel after the other.
fn on_one_thread(mut wheels: Vec<Wheel>, steps: usize) -> Times {
    let step = |step: usize| {
        let start = thread_time();
        wheels.iter_mut().for_each(|wheel| wheel.step(step));
        1e6 * (thread_time() - start)
    };
    Times::of((WARM_UP..WARM_UP + steps).map(step).collect())
}

/// Four wheels on each of two threads, which meet before each step; of a step the longer time of the two counts.
fn on_two_threads(mut wheels: Vec<Wheel>, steps: usize) -> Times {
    let (own, others) = wheels.split_at_mut(WHEELS / 2);
    let meeting = Barrier::new(2);
    let run = |wheels: &mut [Wheel]| -> Vec<f64> {
        let step = |step: usize| {
            meeting.wait();
            let start = thread_time();
            wheels.iter_mut().for_each(|wheel| wheel.step(step));
            1e6 * (thread_time() - start)
        };
        (WARM_UP..WARM_UP + steps).map(step).collect()
    };
    let (own, others) = std::thread::scope(|scope| {
        let other = scope.spawn(|| run(others));
        (run(own), other.join().expect("a thread"))
    });
    Times::of(own.into_iter().zip(others).map(|(own, other)| own.max(other)).collect())
}

fn main() {
    let track = track::track();
    let line = braking::parameters(Parameters::default().contact_nodes);
    let mut settings = vec![Setting {
        name: "line".to_owned(),
        parameters: line,
        track: track::straight(&track),
        rows: 1,
    }];
    let (fast, default) = (PatchGrid::Fast, PatchGrid::Default);
    for (name, nodes, strips, rows) in [
        ("fast, ", fast.nodes(), fast.strips(), 1),
        ("fast, ", fast.nodes(), fast.strips(), 2),
        ("", 12, 9, 1),
        ("", 24, 15, 1),
        ("default, ", default.nodes(), default.strips(), 1),
    ] {
        settings.push(Setting {
            name: format!("{name}{nodes} x {strips}"),
            parameters: braking::patch_parameters(nodes, strips),
            track: track.clone(),
            rows,
        });
    }
    let runs: [(usize, Drive); 2] = [(1, on_one_thread), (2, on_two_threads)];
    let round = || -> Vec<[Times; 2]> {
        let of = |setting: &Setting| runs.map(|(_, run)| run(setting.wheels(), setting.steps()));
        settings.iter().map(of).collect()
    };
    let mut best = round();
    for _ in 1..ROUNDS {
        for (best, next) in best.iter_mut().flatten().zip(round().into_iter().flatten()) {
            if next.second(STEP) < best.second(STEP) {
                *best = next;
            }
        }
    }
    println!(
        "eight wheels on a rough track, all effects on, a second; times in us of a step of all eight, of a wheel its eighth; fastest of {ROUNDS} rounds"
    );
    println!(
        "{:>16} {:>7} {:>10} {:>13} {:>9} {:>9} {:>9} {:>9} {:>9} {:>9}",
        "cells", "threads", "step [ms]", "a second [s]", "median", "99 %", "99.9 %", "worst", "a wheel", "late"
    );
    std::fs::create_dir_all("results").expect("a folder for results");
    let mut table =
        String::from("cells,threads,step_s,second_s,median_us,quantile_99_us,quantile_999_us,worst_us,late\n");
    for (setting, best) in settings.iter().zip(&best) {
        let (name, step) = (&setting.name, setting.step());
        for ((threads, _), times) in runs.iter().zip(best) {
            let [median, most, nearly_all, worst] = [0.5, 0.99, 0.999, 1.0].map(|share| times.quantile(share));
            let (second, late) = (times.second(step), times.late(step));
            println!(
                "{name:>16} {threads:>7} {:>10} {second:>13.2} {median:>9.0} {most:>9.0} {nearly_all:>9.0} {worst:>9.0} {:>9.1} {:>7.1} %",
                setting.rows,
                median / WHEELS as f64,
                100.0 * late
            );
            table += &format!("{name:?},{threads},{step},{second},{median},{most},{nearly_all},{worst},{late}\n");
        }
    }
    std::fs::write("results/eight_wheels.csv", table).expect("room for a table");
    println!();
    for (setting, best) in settings.iter().zip(&best) {
        for ((threads, _), times) in runs.iter().zip(best) {
            let what = format!(
                "{}, {} ms, threads: {threads}, a simulated second",
                setting.name, setting.rows
            );
            timing::target(&what, times.second(setting.step()), 1.0, true, "s");
        }
    }
}
