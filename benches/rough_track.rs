//! Steps on a rough track (`rough_track.csv`, written by `tools/rough_track.py`): line, patch on several grids, and profiles with one contact on the
//! tread and with two, all effects on.
//! Percentiles, the ratio to the line's step in the same run, and the iterations of the patch's solvers a step, which are the same on
//! every machine.
//!
//! Times are those that the thread has computed, as in `summary`.

mod braking;
mod timing;
mod track;

use track::Run;
use wheelrail::parameters::ContactModel;
use wheelrail::{Inputs, Parameters};

const ROUNDS: usize = 3;
/// Cells along and across.
const GRIDS: [(usize, usize); 6] = [(34, 21), (24, 15), (16, 11), (12, 9), (10, 7), (8, 5)];

/// Lateral displacement of the left wheel S1002 on 60E1: on the tread, and where tread and gauge corner carry, `m`.
const PROFILES: [(&str, f64); 2] = [("tread", 0.0), ("two", 5.0e-3)];
/// Part of the track's spin that a contact of profiles has by its inclination, `1/m`.
const INCLINED: f64 = 0.1;

/// The same load, speeds and creepages for a wheelset at a displacement.
fn on_profiles(track: &[Inputs], displacement: f64) -> Vec<Inputs> {
    let inputs = |inputs: &Inputs| Inputs {
        spin_rate: 0.0,
        yaw_rate: inputs.spin_rate - INCLINED * inputs.vehicle_speed,
        lateral_displacement: displacement,
        ..*inputs
    };
    track.iter().map(inputs).collect()
}

fn main() {
    let track = track::track();
    let line = braking::parameters(Parameters::default().contact_nodes);
    let mut names = vec!["line".to_owned()];
    let mut models = vec![(line, track::straight(&track))];
    for (cells, strips) in GRIDS {
        names.push(format!("{cells} x {strips}"));
        models.push((braking::patch_parameters(cells, strips), track.clone()));
    }
    for (name, displacement) in PROFILES {
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            ..braking::patch_parameters(GRIDS[0].0, GRIDS[0].1)
        };
        names.push(name.to_owned());
        models.push((parameters, on_profiles(&track, displacement)));
    }
    let runs = track::fastest(ROUNDS, &models, |(parameters, inputs)| Run::new(parameters, inputs));
    println!(
        "one step of 1 ms on a rough track, V = 20 to 70 m/s, all effects on, {} steps; times in us, fastest of {ROUNDS} rounds; iterations a step",
        runs[0].steps()
    );
    Run::print_headings("cells", "/ line");
    let median = runs[0].quantile(0.5);
    for (name, run) in names.iter().zip(&runs) {
        run.print(name, median);
    }
}
