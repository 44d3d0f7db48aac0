//! Costs of the model's options on the rough track: the median time of a step over that of the plain step, the runs side by side.
//!
//! Options are falling friction, its memory, layers, the heat of the wheel and the wear of profiles, and of profiles the effects that ask for iterations of a step; besides, a wheel that creeps along, V = 0 to 1 m/s, and one that
//! stands, over one that rolls, and a window for a larger load. The processor's time of a step of each, by turns of a few steps, so that a machine that
//! becomes slower makes them all slower. Iterations a step are the same on every machine. `cargo bench --bench rough_options -- profiles` has the contacts alone
//! whose names begin so.

mod braking;
mod timing;
mod track;

use timing::{target, thread_time};
use track::{STEP, WARM_UP};
use wheelrail::parameters::{ContactModel, ProfileWear};
use wheelrail::wheel_rail::Iterations;
use wheelrail::{Inputs, Parameters, Simulation, WheelHeating};

/// Steps that one run takes before the next one has its turn: short beside the drift of the machine, long beside what a change of the run
/// costs in the caches.
const TURN: usize = 10;
/// Speed of the vehicle at the end of the slow track, `m/s`, from 0 on.
const SLOW: f64 = 1.0;
/// `largest_load` of the windows that are compared, `N`, and the name of the run with the smaller one, which the others are compared with.
const SMALL: f64 = 90e3;
const LARGE: f64 = 150e3;
const WINDOW: &str = "largest_load 90 kN";
/// A run of its own among those side by side.
struct Setting {
    name: &'static str,
    parameters: Parameters,
    inputs: Vec<Inputs>,
    /// Largest ratio that is asked, to the plain step, of a window to that for [`SMALL`].
    asked: f64,
}

/// The track's loads and creepages while the vehicle goes up to a speed, `m/s`, from 0 on; up to 0 it stands, under loads that vary.
fn slow(track: &[Inputs], last_speed: f64) -> Vec<Inputs> {
    let last = (track.len() - 1) as f64;
    let inputs = |(step, inputs): (usize, &Inputs)| {
        let speed = last_speed * step as f64 / last;
        let ratio = speed / inputs.vehicle_speed;
        Inputs {
            wheel_speed: inputs.wheel_speed * ratio,
            vehicle_speed: speed,
            lateral_speed: inputs.lateral_speed * ratio,
            spin_rate: inputs.spin_rate * ratio,
            ..*inputs
        }
    };
    track.iter().enumerate().map(inputs).collect()
}

/// Options of a contact; the first is the plain step.
fn options(plain: &Parameters, track: &[Inputs]) -> Vec<Setting> {
    let option = |name, asked, parameters: Parameters| Setting {
        name,
        parameters,
        inputs: track.to_vec(),
        asked,
    };
    let falling = Parameters {
        friction_slip_share: 0.38,
        friction_slip_decay: 0.7,
        ..plain.clone()
    };
    let layered = Parameters {
        layer_compliance: 1e-13,
        ..plain.clone()
    };
    // Below the peak of the friction bound, so that it flows.
    let flowing = Parameters {
        layer_yield_stress: 100e6,
        layer_hardening: 1e12,
        ..layered.clone()
    };
    let remembering = Parameters {
        friction_memory_distance: 3e-6,
        ..falling.clone()
    };
    let warm = Parameters {
        wheel_heating: WheelHeating::On,
        ..plain.clone()
    };
    let all = Parameters {
        layer_compliance: flowing.layer_compliance,
        layer_yield_stress: flowing.layer_yield_stress,
        layer_hardening: flowing.layer_hardening,
        wheel_heating: WheelHeating::On,
        ..remembering.clone()
    };
    let window = |largest_load| Parameters {
        largest_load,
        ..plain.clone()
    };
    // The window of a patch grows with the cube root of its load, that of a line with the square root.
    let ratio = LARGE / SMALL;
    let more = |cells: usize, factor: f64| (cells as f64 * factor).round() as usize;
    let as_fine = Parameters {
        patch_nodes: more(plain.patch_nodes, ratio.cbrt()),
        patch_strips: more(plain.patch_strips, ratio.cbrt()),
        contact_nodes: more(plain.contact_nodes, ratio.sqrt()),
        ..window(LARGE)
    };
    vec![
        option("plain", f64::INFINITY, plain.clone()),
        option("falling friction", 1.25, falling),
        option("with memory besides", 1.25, remembering),
        option("elastic layer", 1.25, layered),
        option("layer that flows and hardens", 1.25, flowing),
        option("heat of the wheel", 1.25, warm),
        option("all of them", f64::INFINITY, all),
        option(WINDOW, f64::INFINITY, window(SMALL)),
        option("150 kN, as many cells", 1.1, window(LARGE)),
        option("150 kN, cells as large", 1.1, as_fine),
        Setting {
            name: "V = 0 to 1 m/s",
            parameters: plain.clone(),
            inputs: slow(track, SLOW),
            asked: 1.0,
        },
        Setting {
            name: "standing",
            parameters: plain.clone(),
            inputs: slow(track, 0.0),
            asked: 1.0,
        },
    ]
}

/// Profiles that stay new, profiles that wear, and new ones with one effect alone of those that couple heat and wear with the mechanics.
fn options_of_profiles(default: &Parameters, inputs: &[Inputs]) -> Vec<Setting> {
    let plain = Parameters {
        contact_model: ContactModel::Profiles,
        ..braking::patch_parameters(default.patch_nodes, default.patch_strips)
    };
    let wearing = Parameters {
        wheel_profile_wear: ProfileWear::On,
        rail_profile_wear: ProfileWear::On,
        wheel_wear_coefficient: plain.wear_coefficient,
        ..plain.clone()
    };
    let uncoupled = Parameters {
        friction_hot: plain.friction_cold,
        thermal_expansion: 0.0,
        wear_coefficient: 0.0,
        ..plain.clone()
    };
    let friction = Parameters {
        friction_hot: plain.friction_hot,
        ..uncoupled.clone()
    };
    let expansion = Parameters {
        thermal_expansion: plain.thermal_expansion,
        ..uncoupled.clone()
    };
    let wear = Parameters {
        wear_coefficient: plain.wear_coefficient,
        ..uncoupled.clone()
    };
    let option = |name, asked, parameters| Setting {
        name,
        parameters,
        inputs: inputs.to_vec(),
        asked,
    };
    vec![
        option("plain", f64::INFINITY, plain),
        option("wear of both profiles", 1.05, wearing.clone()),
        // The work of it alone: surfaces change in the last digits, and the iterations are those of the plain step.
        option(
            "the same, a millionth of it",
            1.05,
            Parameters {
                wear_acceleration: 1e-6,
                ..wearing
            },
        ),
        option("no effects", f64::INFINITY, uncoupled),
        option("friction by temperature alone", f64::INFINITY, friction),
        option("thermal expansion alone", f64::INFINITY, expansion),
        option("wear alone", f64::INFINITY, wear),
    ]
}

/// A wheel under way, and what its steps took.
struct Run<'o> {
    setting: &'o Setting,
    simulation: Simulation,
    next: usize,
    times: Vec<f64>,
    sweeps: usize,
    before: Iterations,
}

impl Run<'_> {
    /// Warmed up.
    fn new(setting: &Setting) -> Run<'_> {
        let mut simulation = Simulation::new(&setting.parameters, &setting.inputs[0]).expect("a model");
        for inputs in &setting.inputs[1..WARM_UP] {
            simulation.step(inputs, STEP).expect("a step");
        }
        Run {
            before: simulation.workspace.iterations(),
            setting,
            simulation,
            next: WARM_UP,
            times: Vec::new(),
            sweeps: 0,
        }
    }

    /// Takes the steps of a turn, as many as are left.
    fn take_a_turn(&mut self) {
        let last = self.setting.inputs.len().min(self.next + TURN);
        for inputs in &self.setting.inputs[self.next..last] {
            let start = thread_time();
            self.simulation.step(inputs, STEP).expect("a step");
            self.times.push(1e6 * (thread_time() - start));
            self.sweeps += self.simulation.state.convergence.iterations;
        }
        self.next = last;
    }

    /// Median time of a step, `µs`.
    fn median(&self) -> f64 {
        self.sorted()[self.times.len() / 2]
    }

    /// Times, ascending, `µs`.
    fn sorted(&self) -> Vec<f64> {
        let mut times = self.times.clone();
        times.sort_by(f64::total_cmp);
        times
    }
}

/// Runs all options by turns, and prints a line for each.
fn compare(contact: &str, options: &[Setting]) {
    let mut runs: Vec<Run> = options.iter().map(Run::new).collect();
    let number = runs.len();
    let steps = options[0].inputs.len() - WARM_UP;
    for turn in 0..steps.div_ceil(TURN) {
        for place in 0..number {
            runs[(turn + place) % number].take_a_turn();
        }
    }
    println!(
        "{contact}: {steps} steps of 1 ms on a rough track, by turns of {TURN}; times in us, iterations a step\n{:>29} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8} {:>8}",
        "", "median", "99.9 %", "worst", "/ plain", "sweeps", "Newton", "Krylov", "inverted", "CG"
    );
    let plain = runs[0].median();
    for run in &runs {
        let times = run.sorted();
        let after = run.simulation.workspace.iterations();
        let per_step = |count: fn(&Iterations) -> u64| (count(&after) - count(&run.before)) as f64 / steps as f64;
        println!(
            "{:>29} {:>8.1} {:>8.1} {:>8.1} {:>8.3} {:>8.2} {:>8.2} {:>8.1} {:>8.2} {:>8.1}",
            run.setting.name,
            times[steps / 2],
            times[((steps - 1) as f64 * 0.999) as usize],
            times[steps - 1],
            times[steps / 2] / plain,
            run.sweeps as f64 / steps as f64,
            per_step(|iterations| iterations.newton),
            per_step(|iterations| iterations.krylov),
            per_step(|iterations| iterations.inversions),
            per_step(|iterations| iterations.gradients),
        );
    }
    println!();
    let small = runs
        .iter()
        .find(|run| run.setting.name == WINDOW)
        .map_or(plain, Run::median);
    for run in runs.iter().filter(|run| run.setting.asked.is_finite()) {
        let name = run.setting.name;
        let (other, median) = if name.starts_with("150 kN") {
            (WINDOW, small)
        } else {
            ("plain", plain)
        };
        let what = format!("{contact}: {name} over {other}");
        target(&what, run.median() / median, run.setting.asked, true, "");
    }
    println!();
}

fn main() {
    // Cargo adds options of its own.
    let asked = std::env::args().skip(1).find(|argument| !argument.starts_with('-'));
    let track = track::track();
    let default = Parameters::default();
    let mut contacts: Vec<(String, Vec<Setting>)> = Vec::new();
    for profiles in &track::profiles::PROFILES {
        let inputs = track::on_profiles(&track, profiles);
        contacts.push((
            format!("profiles, {}", profiles.name),
            options_of_profiles(&default, &inputs),
        ));
    }
    for (nodes, strips) in [(8, 8), (24, 15), (default.patch_nodes, default.patch_strips)] {
        let patch = braking::patch_parameters(nodes, strips);
        contacts.push((format!("{nodes} x {strips}"), options(&patch, &track)));
    }
    let line = braking::parameters(default.contact_nodes);
    contacts.push(("line".to_owned(), options(&line, &track::straight(&track))));
    if let Some(asked) = asked {
        let names: Vec<String> = contacts.iter().map(|(name, _)| name.clone()).collect();
        contacts.retain(|(name, _)| name.starts_with(asked.as_str()));
        assert!(
            !contacts.is_empty(),
            "no contact whose name begins with {asked}: there are {}",
            names.join("; ")
        );
    }
    for (name, settings) in &contacts {
        compare(name, settings);
    }
}
