//! Error of the forces over the time of a point: grids of the patch, of FASTSIM, and what is known of CONTACT.
//!
//!     cargo run --release --example error_over_time > results/error_over_time.csv
//!     .venv/bin/python studies error_over_time
//!
//! The error is the largest one of F_x and F_y over μN, and of M_z over μN √(ab), against the limits of CONTACT and of an independent program in
//! steady rolling: creepages and spin alone and combined, on three ellipses. The time of the patch is the median of its steps on the rough track,
//! with heat and wear, that of FASTSIM the mean of a call over the same cases as its error; both are processor time of one thread, the fastest of
//! some rounds. CONTACT's are those of [`contact_points`].

#[path = "../../benches/braking/mod.rs"]
mod braking;
#[path = "../patch_creep_curves/fastsim.rs"]
#[allow(dead_code)]
mod fastsim;
#[path = "../../benches/timing/mod.rs"]
mod timing;
#[path = "../../benches/track/mod.rs"]
mod track;

use fastsim::{Bound, Contact, Creepages, Grid};
use std::hint::black_box;
use timing::thread_time;
use wheelrail::parameters::PatchGrid;
use wheelrail::verification::contact_points::{
    self, ELLIPSES, FASTSIM_RUN_TIMES, FRICTION, LOAD, RUN_TIMES, SHEAR_MODULUS,
};
use wheelrail::verification::kalker::CreepCoefficients;
use wheelrail::verification::patch_creep;
use wheelrail::verification::patch_limits::{LIMITS, Limit};
use wheelrail::{Error, Parameters};

/// Cells along and strips across of the patch's grids beside those that have a name.
const GRIDS: [(usize, usize); 6] = [(8, 5), (8, 8), (12, 9), (16, 11), (24, 15), (34, 21)];
/// Elements along and across of FASTSIM's.
const FASTSIM: [usize; 5] = [5, 10, 20, 40, 100];
/// Rounds of the timing.
const ROUNDS: usize = 3;
/// Calls of FASTSIM in a round, for each case.
const CALLS: usize = 200;

/// The ellipse of a limit with Kalker's coefficients, and the limit's creepages.
fn case(limit: &Limit) -> Option<(Contact, Creepages)> {
    let ellipse = &ELLIPSES[limit.ellipse];
    let of = CreepCoefficients::of(ellipse.along / ellipse.across, contact_points::poisson_ratio())?;
    let contact = Contact {
        along: ellipse.along,
        across: ellipse.across,
        load: LOAD,
        friction: FRICTION,
        shear_modulus: SHEAR_MODULUS,
        coefficients: [of.longitudinal, of.lateral, of.lateral_spin],
    };
    let [longitudinal, lateral, spin] = limit.creepages;
    let creepages = Creepages {
        longitudinal,
        lateral,
        spin: spin / contact.mean_semi_axis(),
    };
    Some((contact, creepages))
}

/// Largest errors of FASTSIM, and its mean time of a call, `µs`.
fn simplified(bound: Bound, n: usize) -> ([f64; 3], f64) {
    let cases: Vec<_> = LIMITS
        .iter()
        .filter_map(|limit| Some((limit.forces, case(limit)?)))
        .collect();
    let grid = Grid { along: n, across: n };
    let mut errors = [0.0_f64; 3];
    for (limits, (contact, creepages)) in &cases {
        let forces = fastsim::forces(contact, creepages, bound, grid);
        let unit = contact.friction_bound();
        let shares = [
            forces.longitudinal / unit,
            forces.lateral / unit,
            forces.spin_moment / (unit * contact.mean_semi_axis()),
        ];
        for ((error, share), limit) in errors.iter_mut().zip(shares).zip(limits) {
            *error = error.max((share - limit).abs());
        }
    }
    let calls = CALLS * 20 / n;
    let mut least = f64::INFINITY;
    for _ in 0..ROUNDS {
        let start = thread_time();
        for (_, (contact, creepages)) in &cases {
            for _ in 0..calls {
                black_box(fastsim::forces(black_box(contact), black_box(creepages), bound, grid));
            }
        }
        least = least.min(thread_time() - start);
    }
    (errors, 1e6 * least / (calls * cases.len()) as f64)
}

/// One line of the table. What is not known is left out.
fn line(by: &str, name: &str, cells: (usize, usize), errors: [Option<f64>; 3], times: [Option<f64>; 3]) {
    let number = |value: Option<f64>| value.map_or(String::new(), |value| format!("{value:.6}"));
    let columns: Vec<_> = errors.into_iter().chain(times).map(number).collect();
    println!("{by},{name},{},{},{}", cells.0, cells.1, columns.join(","));
}

fn main() -> Result<(), Error> {
    println!(
        "by,name,along,across,error of Fx/(mu N) [1],error of Fy/(mu N) [1],error of Mz/(mu N c) [1],time [us],least [us],largest [us]"
    );
    let mut grids: Vec<_> = GRIDS.map(|grid| (String::new(), grid)).into();
    for named in PatchGrid::ALL {
        let cells = (named.nodes(), named.strips());
        match grids.iter_mut().find(|(_, other)| *other == cells) {
            Some((name, _)) => *name = named.name().to_owned(),
            None => grids.push((named.name().to_owned(), cells)),
        }
    }
    let inputs = track::track();
    let straight = track::straight(&inputs);
    let line_of_nodes = braking::parameters(Parameters::default().contact_nodes);
    let mut models = vec![(line_of_nodes, &straight)];
    models.extend(
        grids
            .iter()
            .map(|(_, (nodes, strips))| (braking::patch_parameters(*nodes, *strips), &inputs)),
    );
    let runs = track::least(ROUNDS, &models, |(parameters, inputs)| {
        track::Run::new(parameters, inputs)
    });
    let times = |run: &track::Run| [0.5, 0.5, 0.999].map(|share| Some(run.quantile(share)));
    // A line has neither F_y nor M_z, and another contact: no error of its own.
    line(
        "line",
        "",
        (Parameters::default().contact_nodes, 1),
        [None; 3],
        times(&runs[0]),
    );
    for ((name, cells), run) in grids.iter().zip(&runs[1..]) {
        let errors = patch_creep::largest_deviations(cells.0, cells.1)?;
        line("patch", name, *cells, errors.map(Some), times(run));
    }
    for (by, bound) in [("fastsim", Bound::Parabolic), ("fastsim_elliptic", Bound::Elliptic)] {
        for n in FASTSIM {
            let (errors, time) = simplified(bound, n);
            line(by, "", (n, n), errors.map(Some), [Some(time), None, None]);
        }
    }
    // The error is known at n = 40, of ξ and η alone on the circle, and falls with the first power of n.
    let error = patch_creep::largest_deviation_of_contact();
    for (n, (_, least, largest)) in [20, 30, 40].into_iter().zip(RUN_TIMES) {
        let forces = Some(error * 40.0 / n as f64);
        let times = [0.5 * (least + largest), least, largest].map(|time| Some(1e6 * time));
        line("contact", "", (n, n), [forces, forces, None], times);
    }
    for (n, (_, time)) in [20, 30, 40].into_iter().zip(FASTSIM_RUN_TIMES) {
        let forces = Some(contact_points::FASTSIM_LARGEST_ERROR);
        line(
            "contact_fastsim",
            "",
            (n, n),
            [forces, forces, None],
            [Some(1e6 * time), None, None],
        );
    }
    Ok(())
}
