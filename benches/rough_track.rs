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
use wheelrail::Parameters;
use wheelrail::parameters::ContactModel;

const ROUNDS: usize = 5;
/// Cells along and across.
const GRIDS: [(usize, usize); 6] = [(34, 21), (24, 15), (16, 11), (12, 9), (8, 8), (8, 5)];

fn main() {
    let track = track::track();
    let line = braking::parameters(Parameters::default().contact_nodes);
    let mut names = vec!["line".to_owned()];
    let mut models = vec![(line, track::straight(&track))];
    for (cells, strips) in GRIDS {
        names.push(format!("{cells} x {strips}"));
        models.push((braking::patch_parameters(cells, strips), track.clone()));
    }
    for profiles in &track::profiles::PROFILES {
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            ..braking::patch_parameters(GRIDS[0].0, GRIDS[0].1)
        };
        names.push(profiles.name.to_owned());
        models.push((parameters, track::on_profiles(&track, profiles)));
    }
    // `cargo bench --bench rough_track -- two`: the line and the contacts that are named, alone.
    let asked: Vec<String> = std::env::args()
        .skip(1)
        .filter(|name| !name.starts_with("--"))
        .collect();
    for name in &asked {
        assert!(
            names.contains(name),
            "no contact {name}: there are {}",
            names.join(", ")
        );
    }
    let is_asked = |name: &String| asked.is_empty() || name == "line" || asked.contains(name);
    let (names, models): (Vec<_>, Vec<_>) = names.into_iter().zip(models).filter(|(name, _)| is_asked(name)).unzip();
    let runs = track::least(ROUNDS, &models, |(parameters, inputs)| Run::new(parameters, inputs));
    println!(
        "one step of 1 ms on a rough track, V = 20 to 70 m/s, all effects on, {} steps; times in us, of each step the least in {ROUNDS} rounds, 'a round' 99.9 % of a single one; iterations a step",
        runs[0].steps()
    );
    Run::print_headings("cells", "/ line");
    let median = runs[0].quantile(0.5);
    for (name, run) in names.iter().zip(&runs) {
        run.print(name, median);
    }
}
