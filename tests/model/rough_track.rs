//! The work of a step on a rough track, counted: iterations do not depend on the machine, as times do.

use wheelrail::parameters::{ContactModel, Parameters, SlipSource};
use wheelrail::{Inputs, Simulation};

/// Steps before the count.
const WARM_UP: usize = 50;
const STEPS: usize = 200;
/// Factor on the recorded counts: another order of a sum may move a step across a tolerance.
const MARGIN: f64 = 1.15;

/// The manoeuvre of `cargo bench --bench rough_track`, its first steps: what a step took on average when it was recorded, and a margin.
/// Who lowers a count records the lower one.
#[test]
fn a_step_on_a_rough_track_takes_no_more_iterations() {
    let recorded = [
        ("Newton steps", 6.1),
        ("Krylov iterations", 33.2),
        ("factorisations", 2.03),
        ("conjugate gradients", 12.6),
        ("iterations of the split", 2.01),
    ];
    let track: Vec<Inputs> = include_str!("../../benches/rough_track.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let cells: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
            Inputs {
                wheel_speed: cells[1],
                vehicle_speed: cells[2],
                normal_load: cells[3],
                lateral_speed: cells[4],
                spin_rate: cells[5],
                ..Inputs::default()
            }
        })
        .collect();
    let parameters = Parameters {
        contact_model: ContactModel::Patch,
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    let mut simulation = Simulation::new(&parameters, &track[0]).unwrap();
    let mut before = simulation.workspace.iterations();
    let mut sweeps = 0;
    for (step, inputs) in track.iter().enumerate().skip(1).take(WARM_UP + STEPS) {
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
        after.factorisations - before.factorisations,
        after.gradients - before.gradients,
        sweeps as u64,
    ];
    for ((what, recorded), counted) in recorded.into_iter().zip(counted) {
        let counted = counted as f64 / STEPS as f64;
        println!("{what}: {counted} a step");
        assert!(
            counted <= MARGIN * recorded,
            "{what}: {counted} a step, {recorded} recorded"
        );
        assert!(counted > 0.0, "{what} are not counted");
    }
}
