//! The work of a step on a rough track, counted: iterations do not depend on the machine, as times do.

use wheelrail::parameters::{ContactModel, Parameters, PatchGrid, SlipSource, WheelHeating};
use wheelrail::{Inputs, Simulation};

#[path = "../../benches/track/profiles.rs"]
mod on_profiles;

use on_profiles::{PROFILES, RADIUS};

/// Steps before the count.
const WARM_UP: usize = 50;
const STEPS: usize = 200;
/// Factor on the recorded counts: another order of a sum may move a step across a tolerance.
const MARGIN: f64 = 1.15;
/// What is counted, in the order of the records.
const COUNTED: [&str; 5] = [
    "Newton steps",
    "Krylov iterations",
    "inversions",
    "conjugate gradients",
    "iterations of the split",
];

/// The manoeuvre of `cargo bench --bench rough_track`, its first steps, with a factor on all speeds.
fn track(speed: f64) -> Vec<Inputs> {
    let rows = include_str!("../../benches/rough_track.csv").lines().skip(1);
    rows.take(WARM_UP + STEPS + 1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            Inputs {
                wheel_speed: speed * cells[1],
                vehicle_speed: speed * cells[2],
                normal_load: cells[3],
                lateral_speed: speed * cells[4],
                spin_rate: speed * cells[5],
                ..Inputs::default()
            }
        })
        .collect()
}

/// A patch on a grid, all else as it starts.
fn patch(patch_nodes: usize, patch_strips: usize) -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        slip_source: SlipSource::VehicleSpeed,
        patch_nodes,
        patch_strips,
        ..Parameters::default()
    }
}

/// Compares what a step takes on average with what was recorded, and a margin.
#[track_caller]
fn takes_no_more(name: &str, parameters: &Parameters, track: &[Inputs], recorded: [f64; 5]) {
    let mut simulation = Simulation::new(parameters, &track[0]).unwrap();
    let mut before = simulation.workspace.iterations();
    let mut sweeps = 0;
    for (step, inputs) in track.iter().enumerate().skip(1) {
        if step == WARM_UP + 1 {
            (before, sweeps) = (simulation.workspace.iterations(), 0);
        }
        simulation.step(inputs, 1e-3).unwrap();
        sweeps += simulation.state.convergence.iterations;
    }
    let after = simulation.workspace.iterations();
    let counted = [
        after.newton - before.newton,
        after.krylov - before.krylov,
        after.inversions - before.inversions,
        after.gradients - before.gradients,
        sweeps as u64,
    ];
    let counted = counted.map(|count| count as f64 / STEPS as f64);
    println!("{name}: {counted:?} a step");
    for ((what, recorded), counted) in COUNTED.into_iter().zip(recorded).zip(counted) {
        assert!(
            counted <= MARGIN * recorded,
            "{name}, {what}: {counted} a step, {recorded} recorded"
        );
        // What is recorded as 0 is not needed there.
        assert!(counted > 0.0 || recorded == 0.0, "{name}, {what} are not counted");
    }
}

/// What a step took on average when it was recorded. Who lowers a count records the lower one.
#[test]
fn a_step_on_a_rough_track_takes_no_more_iterations() {
    let track = track(1.0);
    let fast = PatchGrid::Fast;
    for (name, nodes, strips, recorded) in [
        ("default", 34, 21, [5.5, 28.9, 2.05, 5.6, 2.01]),
        ("24 x 15", 24, 15, [5.2, 25.2, 2.01, 4.8, 2.0]),
        ("fast", fast.nodes(), fast.strips(), [4.6, 19.8, 1.28, 3.0, 2.0]),
    ] {
        takes_no_more(name, &patch(nodes, strips), &track, recorded);
    }
}

/// Profiles under the same loads and speeds: a contact on the tread, and two, whose windows displace each other and share the load.
#[test]
fn profiles_take_no_more_iterations() {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        ..patch(34, 21)
    };
    let recorded = [[5.8, 26.2, 2.04, 8.8, 2.31], [12.1, 67.7, 5.4, 35.3, 3.16]];
    for (profiles, recorded) in PROFILES.iter().zip(recorded) {
        let track: Vec<Inputs> = track(1.0).iter().map(|inputs| profiles.inputs(inputs)).collect();
        takes_no_more(profiles.name, &parameters, &track, recorded);
    }
}

/// The contact that carries most has the creepages of the track, mirrored, and the part of its spin that varies, whatever the wheelset's yaw rate does to the
/// speed of its wheels.
#[test]
fn profiles_have_the_creepages_of_the_track() {
    let parameters = Parameters {
        contact_model: ContactModel::Profiles,
        ..patch(16, 11)
    };
    // Creepages: a tenth of what they vary by. The spin of the inclination varies as the contact moves over the rail's curvature; of the other sign, the
    // track's would be off by 0.7/m.
    let (creepage, spin) = (1e-4, 0.1);
    for profiles in &PROFILES {
        let track = track(1.0);
        let start = profiles.inputs(&track[0]);
        let mut simulation = Simulation::new(&parameters, &start).unwrap();
        let mut inclined = None;
        for patch in &track[1..100] {
            simulation.step(&profiles.inputs(patch), 1e-3).unwrap();
            let contacts = simulation.outputs().contact;
            let main = contacts
                .iter()
                .max_by(|a, b| a.normal_force.total_cmp(&b.normal_force))
                .unwrap();
            let speed = patch.vehicle_speed;
            let longitudinal = RADIUS * patch.wheel_speed / speed - 1.0;
            assert!(
                (main.longitudinal_creepage - longitudinal).abs() < creepage,
                "{}: {} {longitudinal}",
                profiles.name,
                main.longitudinal_creepage
            );
            assert!(
                (main.lateral_creepage + patch.lateral_speed / speed).abs() < creepage,
                "{}: {}",
                profiles.name,
                main.lateral_creepage
            );
            let constant = main.spin_creepage + patch.spin_rate / speed;
            let first = *inclined.get_or_insert(constant);
            assert!((constant - first).abs() < spin, "{}: {constant} {first}", profiles.name);
        }
    }
}

/// Options of the model on 24 × 15 cells, a window for a larger load with cells as large, and a vehicle that moves off slowly.
#[test]
fn options_take_no_more_iterations() {
    let plain = patch(24, 15);
    let falling = Parameters {
        friction_slip_share: 0.38,
        friction_slip_decay: 0.7,
        ..plain.clone()
    };
    let layered = Parameters {
        layer_compliance: 1e-13,
        ..plain.clone()
    };
    let remembering = Parameters {
        friction_memory_distance: 3e-6,
        ..falling.clone()
    };
    let flowing = Parameters {
        layer_yield_stress: 100e6,
        layer_hardening: 1e12,
        ..layered.clone()
    };
    let warm = Parameters {
        wheel_heating: WheelHeating::On,
        ..plain.clone()
    };
    let window = Parameters {
        largest_load: 150e3,
        ..patch(27, 17)
    };
    let rough = track(1.0);
    for (name, parameters, recorded) in [
        ("falling friction", &falling, [5.2, 25.2, 2.02, 4.8, 2.0]),
        ("memory", &remembering, [5.2, 25.2, 2.0, 4.8, 2.0]),
        ("elastic layer", &layered, [3.4, 12.8, 1.68, 4.3, 2.05]),
        ("layer that flows", &flowing, [4.1, 14.6, 1.77, 4.3, 2.05]),
        ("heat of the wheel", &warm, [5.2, 25.2, 2.01, 4.8, 2.0]),
        ("150 kN", &window, [5.2, 25.1, 1.99, 4.7, 2.0]),
    ] {
        takes_no_more(name, parameters, &rough, recorded);
    }
    takes_no_more("at 1 m/s", &plain, &track(0.05), [4.8, 29.2, 2.02, 4.1, 2.0]);
    takes_no_more("standing", &plain, &track(0.0), [0.0, 0.0, 0.0, 7.4, 2.0]);
}

/// Twice the default number of cells each way take eight times the work of a product: the budget of a step grows with it.
#[test]
fn steps_on_twice_the_cells_are_solved() {
    let track = track(1.0);
    let mut simulation = Simulation::new(&patch(68, 42), &track[0]).unwrap();
    for inputs in &track[1..20] {
        simulation.step(inputs, 1e-3).unwrap();
        assert!(!simulation.state.convergence.staggered);
    }
}
