//! Steps in which the inputs change suddenly, on the rough track: what a user in real time has to expect of a single step.
//!
//! A wheel follows the track; at some of its rows an input is another one from one step to the next, and is back a few steps later. The
//! longest step of those that follow either change counts. The median and the largest of these longest steps are printed, as the
//! processor's time, with the number of sub-steps' sweeps in the largest, over the median step of the track without events in the same run.

mod braking;
mod timing;
mod track;

use std::sync::Arc;
use timing::thread_time;
use track::STEP;
use wheelrail::parameters::PatchGrid;
use wheelrail::{Inputs, Model, Parameters, Settings, Simulation};

/// Rows of the track between two changes, and those after which the input is back.
const PERIOD: usize = 60;
const HELD: usize = 20;

/// Budgets of work of a step, multiplications and additions, the default one first; that of a staggered sub-step is a tenth of it.
const BUDGETS: [u64; 4] = [80_000_000, 3_000_000, 1_000_000, 300_000];

/// A change of the inputs by its name.
type Event = (&'static str, fn(&Inputs) -> Inputs);

const EVENTS: [Event; 8] = [
    ("none", |inputs| *inputs),
    ("a third more load", |inputs| Inputs {
        normal_load: (1.33 * inputs.normal_load).min(100e3),
        ..*inputs
    }),
    ("lifted, and back", |inputs| Inputs {
        normal_load: 0.0,
        ..*inputs
    }),
    ("creepage 1 % more", |inputs| Inputs {
        wheel_speed: 1.01 * inputs.wheel_speed,
        ..*inputs
    }),
    ("creepage 10 % more", |inputs| Inputs {
        wheel_speed: 1.1 * inputs.wheel_speed,
        ..*inputs
    }),
    ("lateral creepage 1 % more", |inputs| Inputs {
        lateral_speed: inputs.lateral_speed + 0.01 * inputs.vehicle_speed,
        ..*inputs
    }),
    ("spin 1/m more", |inputs| Inputs {
        spin_rate: inputs.spin_rate + inputs.vehicle_speed,
        ..*inputs
    }),
    ("wheel locks", |inputs| Inputs {
        wheel_speed: 0.0,
        ..*inputs
    }),
];

/// The longest step after each change, ascending, `µs`, the sweeps in the longest of all, and how many steps were taken staggered.
fn longest(model: &Arc<Model>, track: &[Inputs], event: fn(&Inputs) -> Inputs) -> (Vec<f64>, usize, usize) {
    let mut simulation = Simulation::of(model.clone(), &track[0]).expect("a state");
    let (mut longest, mut sweeps, mut staggered) = (vec![0.0_f64; track.len() / PERIOD], 0, 0);
    let mut most = 0.0;
    for (step, inputs) in track.iter().enumerate().take(longest.len() * PERIOD).skip(1) {
        let inputs = if step % PERIOD >= PERIOD - HELD {
            event(inputs)
        } else {
            *inputs
        };
        let start = thread_time();
        simulation.step(&inputs, STEP).expect("a step");
        let time = 1e6 * (thread_time() - start);
        staggered += usize::from(simulation.state.convergence.staggered);
        // The first period is a warm-up.
        if step >= PERIOD {
            longest[step / PERIOD] = longest[step / PERIOD].max(time);
            if time > most {
                (most, sweeps) = (time, simulation.state.convergence.iterations);
            }
        }
    }
    let mut longest = longest.split_off(1);
    longest.sort_by(f64::total_cmp);
    (longest, sweeps, staggered)
}

fn main() {
    let track = track::track();
    let straight = track::straight(&track);
    let line = braking::parameters(Parameters::default().contact_nodes);
    let patch = |nodes, strips| braking::patch_parameters(nodes, strips);
    let (fast, default) = (PatchGrid::Fast, PatchGrid::Default);
    let settings = [
        ("line".to_owned(), line, &straight),
        (
            format!("fast, {} x {}", fast.nodes(), fast.strips()),
            patch(fast.nodes(), fast.strips()),
            &track,
        ),
        ("24 x 15".to_owned(), patch(24, 15), &track),
        (
            format!("default, {} x {}", default.nodes(), default.strips()),
            patch(default.nodes(), default.strips()),
            &track,
        ),
    ];
    for (name, parameters, track) in &settings {
        let median = track::Run::new(parameters, track).quantile(0.5);
        println!(
            "{name}: median step of the rough track {median:.1} us; the longest of the {PERIOD} steps about a change\n{:>28} {:>11} {:>9} {:>11} {:>7} {:>10}",
            "", "median [us]", "/ step", "worst [us]", "sweeps", "staggered"
        );
        let model = Arc::new(Model::new(parameters.clone()).expect("a model"));
        for (what, event) in EVENTS {
            if *name == "line" && (what.starts_with("lateral") || what.starts_with("spin")) {
                continue;
            }
            let (longest, sweeps, staggered) = longest(&model, track, event);
            let middle = longest[longest.len() / 2];
            let worst = longest[longest.len() - 1];
            println!(
                "{what:>28} {middle:>11.0} {:>9.1} {worst:>11.0} {sweeps:>7} {staggered:>10}",
                middle / median
            );
        }
        println!();
    }
    budgets(&settings[1].1, &track);
}

/// Prints what a smaller budget of work does to the steps about all events.
fn budgets(parameters: &Parameters, track: &[Inputs]) {
    println!(
        "the fast grid with smaller budgets of work a step, all events\n{:>28} {:>11} {:>11} {:>10}",
        "multiplications, additions", "99 % [us]", "worst [us]", "staggered"
    );
    for budget in BUDGETS {
        let mut limited = Settings::default();
        limited.step.work = budget;
        // A staggered sub-step, of which there are four, in proportion.
        limited.step.staggered_work = budget / 10;
        let model = Arc::new(Model::with_settings(parameters.clone(), limited).expect("a model"));
        let (mut times, mut late) = (Vec::new(), 0);
        for (_, event) in EVENTS {
            let (longest, _, staggered) = longest(&model, track, event);
            times.extend(longest);
            late += staggered;
        }
        times.sort_by(f64::total_cmp);
        let most = times[((times.len() - 1) as f64 * 0.99) as usize];
        let steps = EVENTS.len() * track.len() / PERIOD * PERIOD;
        println!(
            "{budget:>28e} {most:>11.0} {:>11.0} {:>8.2} %",
            times[times.len() - 1],
            100.0 * late as f64 / steps as f64
        );
    }
}
