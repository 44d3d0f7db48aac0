//! Single steps of the braking manoeuvre: percentiles, growth with the number of nodes in contact, cold start, and two
//! threads against one, each beside its target.
//!
//! Times are those that the thread has computed: what else runs on the machine does not count.

#![allow(unsafe_code)]

mod braking;
mod interface;

use braking::Run;
use interface::common::{Api, OK};
use std::time::Instant;
use wheelrail::wheel_rail::Model;

/// Steps measured at most, and on a fine mesh.
const STEPS: usize = 18_000;
const FINE_STEPS: usize = 3_000;
/// Instances on two threads.
const INSTANCES: usize = 64;

/// Time this thread has computed, `s`.
fn thread_time() -> f64 {
    let mut time = libc::timespec { tv_sec: 0, tv_nsec: 0 };
    // SAFETY: the kernel writes one timespec.
    unsafe { libc::clock_gettime(libc::CLOCK_THREAD_CPUTIME_ID, &mut time) };
    time.tv_sec as f64 + 1e-9 * time.tv_nsec as f64
}

/// What the steps of one mesh took.
struct Steps {
    nodes_in_contact: f64,
    /// Ascending, `µs`.
    times: Vec<f64>,
    iterations: f64,
}

impl Steps {
    fn measure(contact_nodes: usize) -> Steps {
        let mut run = Run::new(contact_nodes);
        let count = run
            .remaining()
            .min(if contact_nodes > 100 { FINE_STEPS } else { STEPS });
        let (mut times, mut nodes, mut iterations) = (Vec::with_capacity(count), 0, 0);
        for _ in 0..count {
            let start = thread_time();
            run.step();
            times.push(1e6 * (thread_time() - start));
            nodes += run.nodes_in_contact();
            iterations += run.state.convergence.iterations;
        }
        times.sort_by(f64::total_cmp);
        Steps {
            nodes_in_contact: nodes as f64 / count as f64,
            times,
            iterations: iterations as f64 / count as f64,
        }
    }

    fn quantile(&self, share: f64) -> f64 {
        self.times[((self.times.len() - 1) as f64 * share) as usize]
    }
}

/// Median time from nothing to the first output, `ms`.
fn cold_start(contact_nodes: usize) -> f64 {
    let inputs = braking::manoeuvre()[0];
    let mut times: Vec<f64> = (0..5)
        .map(|_| {
            let start = thread_time();
            let model = Model::new(braking::parameters(contact_nodes)).expect("a model");
            let mut workspace = model.workspace();
            model.initial_state(&mut workspace, &inputs).expect("a state");
            1e3 * (thread_time() - start)
        })
        .collect();
    times.sort_by(f64::total_cmp);
    times[2]
}

/// How many times faster [`INSTANCES`] instances step on two threads than on one.
fn two_threads() -> f64 {
    let step = |runs: &mut [Run]| runs.iter_mut().for_each(|run| (0..20).for_each(|_| run.step()));
    let mut runs: Vec<Run> = (0..INSTANCES).map(|_| Run::new(61)).collect();
    let start = Instant::now();
    step(&mut runs);
    let one = start.elapsed();
    let (left, right) = runs.split_at_mut(INSTANCES / 2);
    let start = Instant::now();
    std::thread::scope(|scope| {
        scope.spawn(|| step(left));
        step(right);
    });
    one.as_secs_f64() / start.elapsed().as_secs_f64()
}

/// What the interface costs, `µs`, medians: a step in addition to the native one, saving, restoring.
fn interface_costs() -> [f64; 3] {
    const CALLS: usize = 2_000;
    let api = Api::load();
    let (client, start) = interface::instance(&api);
    let mut native = interface::native();
    let mut handle = client.save();
    let mut time = start;
    let timed = |call: &mut dyn FnMut()| {
        let start = Instant::now();
        call();
        1e6 * start.elapsed().as_secs_f64()
    };
    let mut costs = [const { Vec::new() }; 3];
    for _ in 0..CALLS {
        let through = timed(&mut || {
            client.expect(OK, client.step(time, interface::STEP));
        });
        time += interface::STEP;
        let alone = timed(&mut || native.step(&interface::inputs(), interface::STEP).expect("a step"));
        costs[0].push(through - alone);
        // SAFETY: a live instance and its own state.
        unsafe {
            costs[1].push(timed(&mut || {
                client.expect(OK, (api.get_state)(client.component, &mut handle))
            }));
            costs[2].push(timed(&mut || {
                client.expect(OK, (api.set_state)(client.component, handle))
            }));
        }
    }
    costs.map(|mut costs| {
        costs.sort_by(f64::total_cmp);
        costs[CALLS / 2]
    })
}

fn main() {
    println!("one step of 1 ms, braking manoeuvre, all effects on");
    println!("contact_nodes  in contact  median [us]  99 % [us]  99.9 % [us]  iterations  cold start [ms]");
    let mut table =
        String::from("contact_nodes,nodes_in_contact,median_us,quantile_99_us,quantile_999_us,cold_start_ms\n");
    let mut growth = Vec::new();
    let mut measured = Vec::new();
    for contact_nodes in [41, 61, 83, 165, 331] {
        let steps = Steps::measure(contact_nodes);
        let cold = cold_start(contact_nodes);
        println!(
            "{contact_nodes:>13}  {:>10.1}  {:>11.1}  {:>9.1}  {:>11.1}  {:>10.2}  {cold:>15.1}",
            steps.nodes_in_contact,
            steps.quantile(0.5),
            steps.quantile(0.99),
            steps.quantile(0.999),
            steps.iterations,
        );
        table += &format!(
            "{contact_nodes},{},{},{},{},{cold}\n",
            steps.nodes_in_contact,
            steps.quantile(0.5),
            steps.quantile(0.99),
            steps.quantile(0.999),
        );
        growth.push((steps.nodes_in_contact.ln(), steps.quantile(0.5).ln()));
        measured.push((steps, cold));
    }
    // `make bench` draws it: tools/scaling_figure.py.
    let results = std::path::Path::new("results");
    std::fs::create_dir_all(results).expect("a folder for results");
    std::fs::write(results.join("scaling.csv"), table).expect("room for a table");
    let (first, last) = (growth[0], growth[growth.len() - 1]);
    let target = |what: &str, value: f64, bound: f64, most: bool, unit: &str| {
        let met = if most { value <= bound } else { value >= bound };
        let (relation, verdict) = (if most { "<=" } else { ">=" }, if met { "met" } else { "NOT met" });
        println!("{what:<58} {value:>8.2} {unit:<3} target {relation} {bound} {unit:<3} {verdict}");
    };
    println!();
    let (moments, effects, gains) = Run::new(61).model.rail().thermal_map.size();
    println!("thermal map at default settings: {moments} moments a column, {effects} effects, {gains} gains");
    println!();
    target(
        "step at default settings, median",
        measured[1].0.quantile(0.5),
        40.0,
        true,
        "us",
    );
    target(
        "step at default settings, 99.9 %",
        measured[1].0.quantile(0.999),
        400.0,
        true,
        "us",
    );
    target(
        "step with about 100 nodes in contact, median",
        measured[3].0.quantile(0.5),
        200.0,
        true,
        "us",
    );
    target(
        "growth with the nodes in contact, 25 to 200, exponent",
        (last.1 - first.1) / (last.0 - first.0),
        2.0,
        true,
        "",
    );
    target("cold start at default settings", measured[1].1, 60.0, true, "ms");
    let [layer, save, restore] = interface_costs();
    target("the interface's share of a step", layer, 1.0, true, "us");
    target("save a state through the interface", save, 20.0, true, "us");
    target("restore it", restore, 20.0, true, "us");
    target("64 instances, two threads over one", two_threads(), 1.9, false, "");
}
