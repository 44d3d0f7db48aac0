//! Single steps of the braking manoeuvre: percentiles, growth with the number of nodes in contact, cold start, and two
//! threads against one, each beside its target.
//!
//! Times are those that the thread has computed. What else runs on the machine is not in them, but can make the processor
//! slower: all is measured in several rounds, and the fastest counts. For the step, the median of the slowest round is printed
//! too.

#![allow(unsafe_code)]

mod braking;
mod interface;
mod timing;

use braking::Braking;
use interface::common::{Api, Fmi2, OK};
use std::time::Instant;
use timing::{Steps, median_of_three, target};
use wheelrail::Model;

/// Steps measured at most: on the meshes of up to 100 nodes, and on finer ones.
const STEPS: usize = 18_000;
const FINE_STEPS: usize = 3_000;
/// Instances on two threads.
const INSTANCES: usize = 64;
const ROUNDS: usize = 4;
/// Rounds of [`two_threads`], a tenth of a second each.
const SHORT_ROUNDS: usize = 50;

/// The steps of one mesh.
fn steps(contact_nodes: usize) -> Steps {
    let run = Braking::new(contact_nodes);
    let most = if contact_nodes > 100 { FINE_STEPS } else { STEPS };
    let count = run.remaining().min(most);
    Steps::measure(run, count)
}

/// From nothing to the first output, `ms`.
fn cold_start(contact_nodes: usize) -> f64 {
    let inputs = braking::manoeuvre()[0];
    median_of_three(|| {
        let model = Model::new(braking::parameters(contact_nodes)).expect("a model");
        let mut workspace = model.workspace();
        model.initial_state(&mut workspace, &inputs).expect("a state");
    })
}

/// From a model to the first output of one more wheel, `ms`.
fn another_wheel() -> f64 {
    let inputs = braking::manoeuvre()[0];
    let model = Model::new(braking::parameters(61)).expect("a model");
    median_of_three(|| {
        let mut workspace = model.workspace();
        model.initial_state(&mut workspace, &inputs).expect("a state");
    })
}

/// The rounds of one mesh.
struct Mesh {
    contact_nodes: usize,
    /// The round with the least median.
    steps: Steps,
    /// The largest median of a round, `µs`.
    slowest: f64,
    /// `ms`.
    cold_start: f64,
}

impl Mesh {
    fn first_round(contact_nodes: usize) -> Mesh {
        let steps = steps(contact_nodes);
        Mesh {
            contact_nodes,
            slowest: steps.quantile(0.5),
            steps,
            cold_start: cold_start(contact_nodes),
        }
    }

    fn next_round(&mut self) {
        let next = Mesh::first_round(self.contact_nodes);
        self.slowest = self.slowest.max(next.slowest);
        self.cold_start = self.cold_start.min(next.cold_start);
        if next.steps.quantile(0.5) < self.steps.quantile(0.5) {
            self.steps = next.steps;
        }
    }
}

/// How many times faster [`INSTANCES`] instances step on two threads than on one.
fn two_threads() -> f64 {
    let step = |runs: &mut [Braking]| runs.iter_mut().for_each(|run| (0..20).for_each(|_| run.step()));
    let mut runs: Vec<Braking> = (0..INSTANCES).map(|_| Braking::new(61)).collect();
    let (mut one, mut two) = (f64::INFINITY, f64::INFINITY);
    for _ in 0..SHORT_ROUNDS {
        let start = Instant::now();
        step(&mut runs);
        one = one.min(start.elapsed().as_secs_f64());
        let (left, right) = runs.split_at_mut(INSTANCES / 2);
        let start = Instant::now();
        std::thread::scope(|scope| {
            scope.spawn(|| step(left));
            step(right);
        });
        two = two.min(start.elapsed().as_secs_f64());
    }
    one / two
}

/// What the interface costs, `µs`, medians: a step in addition to the native one, saving, restoring.
fn interface_costs() -> [f64; 3] {
    const CALLS: usize = 2_000;
    let api = Api::load(Fmi2);
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
                client.expect(OK, api.get_state(client.component, &mut handle))
            }));
            costs[2].push(timed(&mut || {
                client.expect(OK, api.set_state(client.component, handle))
            }));
        }
    }
    costs.map(|mut costs| {
        costs.sort_by(f64::total_cmp);
        costs[CALLS / 2]
    })
}

fn main() {
    let mut meshes = [41, 51, 83, 165, 331].map(Mesh::first_round);
    for _ in 1..ROUNDS {
        meshes.iter_mut().for_each(Mesh::next_round);
    }
    println!("one step of 1 ms, braking manoeuvre, all effects on; fastest of {ROUNDS} rounds");
    println!(
        "contact_nodes  in contact  median [us]  (slowest round)  99 % [us]  99.9 % [us]  iterations  cold start [ms]"
    );
    let mut table =
        String::from("contact_nodes,nodes_in_contact,median_us,quantile_99_us,quantile_999_us,cold_start_ms\n");
    for mesh in &meshes {
        let (contact_nodes, nodes, cold) = (mesh.contact_nodes, mesh.steps.in_contact, mesh.cold_start);
        let [median, most, nearly_all] = [0.5, 0.99, 0.999].map(|share| mesh.steps.quantile(share));
        println!(
            "{contact_nodes:>13}  {nodes:>10.1}  {median:>11.1}  {:>15.1}  {most:>9.1}  {nearly_all:>11.1}  {:>10.2}  {cold:>15.1}",
            mesh.slowest, mesh.steps.iterations,
        );
        table += &format!("{contact_nodes},{nodes},{median},{most},{nearly_all},{cold}\n");
    }
    // `make bench` draws it: tools/scaling_figure.py.
    let results = std::path::Path::new("results");
    std::fs::create_dir_all(results).expect("a folder for results");
    std::fs::write(results.join("scaling.csv"), table).expect("room for a table");
    let [coarsest, default, .., fine, finest] = &meshes;
    let growth = |quantity: fn(&Mesh) -> f64| (quantity(finest) / quantity(coarsest)).ln();
    println!();
    let map_size = Braking::new(61).simulation.model.thermal_map_size();
    let (moments, effects, gains) = map_size.expect("the line engine has a thermal map");
    println!("thermal map at default settings: {moments} moments a column, {effects} effects, {gains} gains");
    println!();
    target(
        "step at default settings, median",
        default.steps.quantile(0.5),
        40.0,
        true,
        "us",
    );
    target(
        "step at default settings, 99.9 %",
        default.steps.quantile(0.999),
        400.0,
        true,
        "us",
    );
    target(
        "step with about 100 nodes in contact, median",
        fine.steps.quantile(0.5),
        200.0,
        true,
        "us",
    );
    target(
        "growth with the nodes in contact, 25 to 200, exponent",
        growth(|mesh| mesh.steps.quantile(0.5)) / growth(|mesh| mesh.steps.in_contact),
        2.0,
        true,
        "",
    );
    target("cold start at default settings", default.cold_start, 35.0, true, "ms");
    target("one more wheel of the same model", another_wheel(), 5.0, true, "ms");
    let [layer, save, restore] = interface_costs();
    target("the interface's share of a step", layer, 1.0, true, "us");
    target("save a state through the interface", save, 20.0, true, "us");
    target("restore it", restore, 20.0, true, "us");
    target("64 instances, two threads over one", two_threads(), 1.9, false, "");
}
