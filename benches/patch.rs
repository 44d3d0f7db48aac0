//! Steps of a patch: the braking manoeuvre with lateral creepage and spin that vary, all effects on. Percentiles, the ratio to
//! the line engine's step in the same run, growth with the cells each way, cold start, each beside its target; and what accuracy the
//! cells reach, for a figure beside CONTACT's times.
//!
//! Times are those that the thread has computed, as in `summary`.

mod braking;
mod timing;

use braking::Braking;
use timing::{Steps, median_of_three, target};
use wheelrail::verification::contact_points::RUN_TIMES;
use wheelrail::verification::patch_creep;
use wheelrail::{Model, Parameters};

/// Steps measured: from full braking on.
const STEPS: usize = 3_000;
const ROUNDS: usize = 3;

/// From nothing to the first output, `ms`.
fn cold_start(parameters: &Parameters) -> f64 {
    let inputs = braking::swaying_manoeuvre()[0];
    median_of_three(|| {
        let model = Model::new(parameters.clone()).expect("a model");
        let mut workspace = model.workspace();
        model.initial_state(&mut workspace, &inputs).expect("a state");
    })
}

/// The rounds of one grid.
struct Grid {
    cells: usize,
    strips: usize,
    /// The round with the least median.
    steps: Steps,
    /// `ms`.
    cold_start: f64,
}

impl Grid {
    fn first_round((cells, strips): (usize, usize)) -> Grid {
        let parameters = braking::patch_parameters(cells, strips);
        let run = Braking::through(&parameters, braking::swaying_manoeuvre());
        let count = if cells * strips > 1000 { STEPS / 6 } else { STEPS };
        Grid {
            cells,
            strips,
            steps: Steps::measure(run, count),
            cold_start: cold_start(&parameters),
        }
    }

    fn next_round(&mut self) {
        let next = Grid::first_round((self.cells, self.strips));
        self.cold_start = self.cold_start.min(next.cold_start);
        if next.steps.quantile(0.5) < self.steps.quantile(0.5) {
            self.steps = next.steps;
        }
    }
}

fn main() {
    let default = Parameters::default();
    let line = || Steps::measure(Braking::new(default.contact_nodes), STEPS).quantile(0.5);
    let mut line_median = line();
    // The default, twice as many across, along and both ways; and coarser ones.
    let mut grids = [(34, 21), (34, 42), (68, 21), (68, 42), (24, 15), (34, 11), (17, 21)].map(Grid::first_round);
    for _ in 1..ROUNDS {
        line_median = line_median.min(line());
        grids.iter_mut().for_each(Grid::next_round);
    }
    println!(
        "one step of 1 ms, braking manoeuvre with lateral creepage and spin, all effects on; fastest of {ROUNDS} rounds"
    );
    println!(
        "cells x strips  in contact  median [us]  99 % [us]  99.9 % [us]  iterations  cold start [ms]  error of the forces"
    );
    let mut table = String::from(
        "patch_nodes,patch_strips,cells_in_contact,median_us,quantile_99_us,quantile_999_us,cold_start_ms,error\n",
    );
    for grid in &grids {
        let (cells, strips, cold, steps) = (grid.cells, grid.strips, grid.cold_start, &grid.steps);
        let [median, most, nearly_all] = [0.5, 0.99, 0.999].map(|share| steps.quantile(share));
        let error = patch_creep::largest_deviation(cells, strips).expect("creep curves");
        println!(
            "{cells:>7} x {strips:<4}  {:>10.1}  {median:>11.1}  {most:>9.1}  {nearly_all:>11.1}  {:>10.2}  {cold:>15.1}  {error:>19.4}",
            steps.in_contact, steps.iterations,
        );
        table += &format!(
            "{cells},{strips},{},{median},{most},{nearly_all},{cold},{error}\n",
            steps.in_contact
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
    println!();
    let [own, across, along, ..] = &grids;
    let median = own.steps.quantile(0.5);
    let growth = |finer: &Grid| (finer.steps.quantile(0.5) / median).log2();
    // Linear times logarithm, to three digits down.
    let linear_log = (1e3 * (2.0 * 42_f64.ln() / 21_f64.ln()).log2()).floor() / 1e3;
    target("step at default settings, median", median, 1000.0, true, "us");
    target(
        "step at default settings, 99.9 %",
        own.steps.quantile(0.999),
        6000.0,
        true,
        "us",
    );
    target("ratio to the line engine's step", median / line_median, 28.0, true, "");
    target(
        "growth with the strips, 21 to 42, exponent",
        growth(across),
        linear_log,
        true,
        "",
    );
    target(
        "growth with the cells along, 34 to 68, exponent",
        growth(along),
        2.0,
        true,
        "",
    );
    target("cold start at default settings", own.cold_start, 100.0, true, "ms");
}
