//! Steps of a patch: the braking manoeuvre with lateral creepage and spin that vary, all effects on. Percentiles, the ratio to
//! the line engine's step in the same run, growth with the cells each way, cold start, each beside its target; and what accuracy the
//! cells reach, for a figure beside CONTACT's times.
//!
//! Times are those that the thread has computed, as in `summary`.

#![allow(unsafe_code)]

mod braking;

use braking::Braking;
use wheelrail::verification::contact_points::RUN_TIMES;
use wheelrail::verification::patch_creep;
use wheelrail::{Inputs, Model, Parameters};

/// Steps measured: from full braking on.
const STEPS: usize = 3_000;
const ROUNDS: usize = 3;

/// Time this thread has computed, `s`.
fn thread_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the kernel writes one timespec.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// What the steps of one grid took.
struct Steps {
    cells_in_contact: f64,
    /// Ascending, `µs`.
    times: Vec<f64>,
    iterations: f64,
}

impl Steps {
    fn measure(parameters: &Parameters, manoeuvre: Vec<Inputs>, count: usize) -> Steps {
        let mut run = Braking::through(parameters, manoeuvre);
        let (mut times, mut cells, mut iterations) = (Vec::with_capacity(count), 0, 0);
        for _ in 0..count {
            let start = thread_time();
            run.step();
            times.push(1e6 * (thread_time() - start));
            cells += run.nodes_in_contact();
            iterations += run.simulation.state.convergence.iterations;
        }
        times.sort_by(f64::total_cmp);
        Steps {
            cells_in_contact: cells as f64 / count as f64,
            times,
            iterations: iterations as f64 / count as f64,
        }
    }

    fn quantile(&self, share: f64) -> f64 {
        self.times[((self.times.len() - 1) as f64 * share) as usize]
    }
}

/// From nothing to the first output, `ms`: the median of three.
fn cold_start(parameters: &Parameters) -> f64 {
    let inputs = braking::swaying_manoeuvre()[0];
    let mut times = [(); 3].map(|()| {
        let start = thread_time();
        let model = Model::new(parameters.clone()).expect("a model");
        let mut workspace = model.workspace();
        model.initial_state(&mut workspace, &inputs).expect("a state");
        1e3 * (thread_time() - start)
    });
    times.sort_by(f64::total_cmp);
    times[1]
}

fn main() {
    let grids = [(17, 21), (34, 11), (24, 15), (34, 21), (34, 42), (68, 21), (68, 42)];
    let (mut patches, mut lines): (Vec<Option<Steps>>, Option<Steps>) = (grids.iter().map(|_| None).collect(), None);
    for _ in 0..ROUNDS {
        let keep = |best: &mut Option<Steps>, next: Steps| {
            if best.as_ref().is_none_or(|best| next.quantile(0.5) < best.quantile(0.5)) {
                *best = Some(next);
            }
        };
        keep(
            &mut lines,
            Steps::measure(
                &braking::parameters(Parameters::default().contact_nodes),
                braking::manoeuvre(),
                STEPS,
            ),
        );
        for (best, (cells, strips)) in patches.iter_mut().zip(grids) {
            let count = if cells * strips > 1000 { STEPS / 6 } else { STEPS };
            let next = Steps::measure(
                &braking::patch_parameters(cells, strips),
                braking::swaying_manoeuvre(),
                count,
            );
            keep(best, next);
        }
    }
    let line = lines.expect("a round").quantile(0.5);
    let patches: Vec<Steps> = patches.into_iter().map(|steps| steps.expect("a round")).collect();
    println!(
        "one step of 1 ms, braking manoeuvre with lateral creepage and spin, all effects on; fastest of {ROUNDS} rounds"
    );
    println!(
        "cells x strips  in contact  median [us]  99 % [us]  99.9 % [us]  iterations  cold start [ms]  error of the forces"
    );
    let mut table = String::from(
        "patch_nodes,patch_strips,cells_in_contact,median_us,quantile_99_us,quantile_999_us,cold_start_ms,error\n",
    );
    for (steps, (cells, strips)) in patches.iter().zip(grids) {
        let [median, most, nearly_all] = [0.5, 0.99, 0.999].map(|share| steps.quantile(share));
        let cold = cold_start(&braking::patch_parameters(cells, strips));
        let error = patch_creep::largest_deviation(cells, strips).expect("creep curves");
        println!(
            "{cells:>7} x {strips:<4}  {:>10.1}  {median:>11.1}  {most:>9.1}  {nearly_all:>11.1}  {:>10.2}  {cold:>15.1}  {error:>19.4}",
            steps.cells_in_contact, steps.iterations,
        );
        table += &format!(
            "{cells},{strips},{},{median},{most},{nearly_all},{cold},{error}\n",
            steps.cells_in_contact
        );
    }
    let results = std::path::Path::new("results");
    std::fs::create_dir_all(results).expect("a folder for results");
    std::fs::write(results.join("scaling_patch.csv"), table).expect("room for a table");
    // CONTACT's error is known at n = 40; it falls with the first power of n.
    let error = patch_creep::largest_deviation_of_contact();
    let mut contact = String::from("n,cells_in_contact,least_ms,largest_ms,error\n");
    for (n, (cells, least, largest)) in [20.0, 30.0, 40.0].into_iter().zip(RUN_TIMES) {
        contact += &format!("{n},{cells},{},{},{}\n", 1e3 * least, 1e3 * largest, error * 40.0 / n);
    }
    std::fs::write(results.join("scaling_contact.csv"), contact).expect("room for a table");
    let of = |grid: (usize, usize)| {
        grids
            .iter()
            .position(|other| *other == grid)
            .map_or(&patches[0], |place| &patches[place])
    };
    let target = |what: &str, value: f64, bound: f64, unit: &str| {
        let verdict = if value <= bound { "met" } else { "NOT met" };
        println!("{what:<58} {value:>8.2} {unit:<3} target <= {bound:.4} {unit:<3} {verdict}");
    };
    println!();
    let default = of((34, 21));
    target("step at default settings, median", default.quantile(0.5), 1000.0, "us");
    target(
        "step at default settings, 99.9 %",
        default.quantile(0.999),
        6000.0,
        "us",
    );
    target(
        "ratio to the line engine's step",
        default.quantile(0.5) / line,
        28.0,
        "",
    );
    let growth = |from: (usize, usize), to: (usize, usize), more: f64| {
        (of(to).quantile(0.5) / of(from).quantile(0.5)).ln() / more.ln()
    };
    target(
        "growth with the strips, 21 to 42, exponent",
        growth((34, 21), (34, 42), 2.0),
        // Linear times logarithm.
        (2.0 * 42_f64.ln() / 21_f64.ln()).log2(),
        "",
    );
    target(
        "growth with the cells along, 34 to 68, exponent",
        growth((34, 21), (68, 21), 2.0),
        2.0,
        "",
    );
    target(
        "cold start at default settings",
        cold_start(&braking::patch_parameters(34, 21)),
        100.0,
        "ms",
    );
}
