//! Smoothness of the forces of profiles over the lateral displacement: the largest jumps where contacts appear, merge or part, and windows move.
//!
//!     cargo run --release --example profiles_smoothness
//!
//! A wheelset S1002 on 60E1 rolls at 20 m/s and moves from 4 to 8 mm to the left in steps of 0.01 mm, a millisecond each: on the left the load goes from the tread to
//! the flange, on the right it stays on the tread. With the force F_i after the step i and its change d_i = F_{i+1} − F_i, the jump beyond the slope is
//! |d_i − (d_{i−1} + d_{i+1})/2|, over the load. About the largest, and wherever windows change, the way is gone again in tenths of the steps: what jumps stays as
//! large, what is steep or bends becomes smaller by the ten- to the thousandfold.
//!
//! A row for each wheel, load and force: the largest jump, the largest one with a tenth of the step, and of this the place, the way on which the force changes
//! as much by its slope there, and what changes there of the windows.

use std::io::{self, Write};
use wheelrail::parameters::{ContactModel, Parameters, Side, SlipSource};
use wheelrail::signals::{Inputs, Outputs};
use wheelrail::simulation::Simulation;
use wheelrail::wheel_rail::State;
use wheelrail::{Error, Model};

/// Vertical loads, `N`.
const LOADS: [f64; 3] = [10e3, 60e3, 100e3];
/// Displacements from the first to the last, `m`, and steps in a millimetre.
const RANGE: [f64; 2] = [4e-3, 8e-3];
const STEPS_IN_MILLIMETRE: f64 = 100.0;
/// Steps of the finer way in one of the coarse one.
const FINER: usize = 10;
/// V, `m/s`, and the time of a step, `s`: more than a contact is long.
const SPEED: f64 = 20.0;
const DURATION: f64 = 1e-3;
/// Steps that the wheelset rolls at the first displacement.
const SETTLE: usize = 20;

/// Force whose jumps are looked at.
type Force = (&'static str, fn(&Outputs) -> f64);

const FORCES: [Force; 3] = [
    ("F_x", |outputs| outputs.force_x),
    ("F_y", |outputs| outputs.force_y),
    ("sum of the normal forces", |outputs| {
        outputs.contact.iter().map(|contact| contact.normal_force).sum()
    }),
];

/// Point of a way: displacement, state, and sizes and places of the windows that carry.
struct Point {
    displacement: f64,
    state: State,
    windows: Vec<[f64; 3]>,
}

/// Wheel under a vertical load, `N`.
struct Case {
    load: f64,
}

impl Case {
    fn inputs(&self, displacement: f64) -> Inputs {
        Inputs {
            normal_load: self.load,
            vehicle_speed: SPEED,
            wheel_speed: SPEED / Parameters::default().wheel_radius,
            lateral_displacement: displacement,
            ..Inputs::default()
        }
    }

    /// Goes from the state that the simulation has to the given displacements.
    fn way(&self, run: &mut Simulation, displacements: impl Iterator<Item = f64>) -> Result<Vec<Point>, Error> {
        displacements
            .map(|displacement| {
                run.step(&self.inputs(displacement), DURATION)?;
                let windows = run.surface_windows()?.into_iter();
                let carrying = windows.filter(|window| window.normal_force() > 0.0);
                Ok(Point {
                    displacement,
                    state: run.state.clone(),
                    windows: carrying
                        .map(|window| [window.cell_length, window.strip_breadth, window.strips[0].arc_length])
                        .collect(),
                })
            })
            .collect()
    }
}

/// Largest jump of a force beyond its slope on a way.
#[derive(Clone, Copy, Default)]
struct Jump {
    /// Jump over the load.
    size: f64,
    /// Way on which the force changes as much, by its slope there, `m`.
    way: f64,
    /// Number of the point before it.
    point: usize,
}

/// Finds the largest jump of a force on a way.
fn largest_jump(points: &[Point], load: f64, force: fn(&Outputs) -> f64) -> Jump {
    let at = |point: &Point| force(&point.state.outputs) / load;
    let jumps = points.windows(4).enumerate().map(|(number, four)| {
        let [a, b, c, d] = [0, 1, 2, 3].map(|k| at(&four[k]));
        let beside = 0.5 * ((b - a) + (d - c));
        let size = (c - b - beside).abs();
        Jump {
            size,
            way: size / beside.abs() * (four[2].displacement - four[1].displacement),
            point: number + 1,
        }
    });
    jumps.max_by(|a, b| a.size.total_cmp(&b.size)).unwrap_or_default()
}

/// Word for windows that have not changed.
const UNCHANGED: &str = "-";

/// Words for what has changed of the windows from one point to the next.
fn changes(before: &Point, after: &Point) -> String {
    let (from, to) = (&before.windows, &after.windows);
    if from.len() != to.len() {
        return format!("{} contacts, then {}", from.len(), to.len());
    }
    let words = from.iter().zip(to).map(|(from, to)| match (from, to) {
        _ if from[1] != to[1] => format!("strips of {:.0} µm, then {:.0}", 1e6 * from[1], 1e6 * to[1]),
        _ if from[0] != to[0] => format!("cells of {:.0} µm, then {:.0}", 1e6 * from[0], 1e6 * to[0]),
        _ if from[2] != to[2] => format!("moved by {:.0} strips", (to[2] - from[2]) / to[1]),
        _ => UNCHANGED.to_owned(),
    });
    let words: Vec<_> = words.collect();
    if words.iter().all(|word| word == UNCHANGED) {
        return UNCHANGED.to_owned();
    }
    words.join("; ")
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "| wheel | load [kN] | force | largest jump, % of the load | with a tenth of the step, % | at [mm] | as much as on a way of [µm] | windows there |"
    )?;
    writeln!(out, "|---|---|---|---|---|---|---|---|")?;
    for (name, side) in [("left", Side::Left), ("right", Side::Right)] {
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            slip_source: SlipSource::VehicleSpeed,
            side,
            ..Parameters::default()
        };
        let model = std::sync::Arc::new(Model::new(parameters)?);
        for load in LOADS {
            let case = Case { load };
            let mut run = Simulation::of(model.clone(), &case.inputs(RANGE[0]))?;
            run.hold(&case.inputs(RANGE[0]), DURATION, SETTLE)?;
            let count = ((RANGE[1] - RANGE[0]) * 1e3 * STEPS_IN_MILLIMETRE).round() as usize;
            let step = 1e-3 / STEPS_IN_MILLIMETRE;
            let points = case.way(&mut run, (0..=count).map(|k| RANGE[0] + step * k as f64))?;
            let largest = FORCES.map(|(_, force)| largest_jump(&points, load, force));
            // About the largest jumps and wherever windows change, in tenths of the steps.
            let changed = (1..points.len() - 2).filter(|&k| changes(&points[k], &points[k + 1]) != UNCHANGED);
            let mut places: Vec<_> = changed.chain(largest.iter().map(|jump| jump.point)).collect();
            places.sort_unstable();
            places.dedup();
            let mut left = [const { None::<(Jump, String, f64)> }; FORCES.len()];
            for place in places {
                let from = &points[place.saturating_sub(3)];
                let mut again = Simulation::resume(model.clone(), from.state.clone())?;
                let finer = (1..=6 * FINER).map(|k| from.displacement + step * k as f64 / FINER as f64);
                let fine = case.way(&mut again, finer)?;
                for ((_, force), left) in FORCES.iter().zip(&mut left) {
                    let jump = largest_jump(&fine, load, *force);
                    if left.as_ref().is_none_or(|(most, ..)| jump.size > most.size) {
                        let [before, after] = [0, 1].map(|k| &fine[jump.point + k]);
                        *left = Some((jump, changes(before, after), before.displacement));
                    }
                }
            }
            for (((force_name, _), coarse), left) in FORCES.iter().zip(largest).zip(left) {
                let (fine, windows, displacement) = left.unwrap_or_default();
                writeln!(
                    out,
                    "| {name} | {:.0} | {force_name} | {:.3} | {:.3} | {:.3} | {:.2} | {windows} |",
                    1e-3 * load,
                    100.0 * coarse.size,
                    100.0 * fine.size,
                    1e3 * displacement,
                    1e6 * fine.way,
                )?;
            }
        }
    }
    Ok(())
}
