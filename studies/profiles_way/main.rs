//! What contacts of profiles keep of the way by which the wheel has come: their windows stay as long as they serve.
//!
//!     cargo run --release --example profiles_way
//!
//! Wheels roll at 10 m/s, with a longitudinal creepage of 0.2 %, at a displacement on a rail under a load. One has started there, one has come in 20 ms from another displacement; both have
//! rolled 60 ms there since. The cases are spread evenly over profiles, loads, displacements and ways.
//!
//! A row for each grid: the differences of the largest pressure, over that of the wheel that has started there, and of the force across the track, over the load: their median, 98 % of them, and the
//! largest; how many wheels have another number of contacts; and the case with the largest difference of pressure.

use std::io::{self, Write};
use wheelrail::Error;
use wheelrail::parameters::{ContactModel, Parameters, SlipSource};
use wheelrail::signals::{Inputs, Outputs};
use wheelrail::simulation::Simulation;

const CASES: usize = 400;
/// Cells along and across: those of the grids `fast`, twice with more strips, `default` and `fine`.
const GRIDS: [[usize; 2]; 5] = [[8, 8], [8, 11], [8, 14], [34, 21], [48, 31]];
/// Wheel and rail.
const PROFILES: [[&str; 2]; 4] = [
    ["S1002", "60E1"],
    ["S1002", "54E1"],
    ["UIC519B", "60E2"],
    ["S1002", "UIC60"],
];
/// Vertical loads, `N`.
const LOADS: [f64; 4] = [10e3, 30e3, 60e3, 100e3];
/// Displacements at which the wheels are compared, and from which they come, `m`.
const RANGE: [f64; 2] = [-4e-3, 6.5e-3];
const FROM: [f64; 2] = [-5e-3, 7e-3];
/// Largest way of every second wheel, `m`: those that come from near by keep their windows more often.
const SHORT: f64 = 1e-3;
/// V, `m/s`, and the wheel's circumferential speed over it.
const SPEED: f64 = 10.0;
const SPEED_RATIO: f64 = 1.002;
/// Time of a step, `s`, steps of the way and steps at its end.
const DURATION: f64 = 2e-3;
const WAY: usize = 10;
const REST: usize = 30;

/// A wheel under a load, `N`, that comes from a displacement to another one, `m`.
#[derive(Debug, Clone, Copy)]
struct Case {
    profiles: [&'static str; 2],
    load: f64,
    from: f64,
    to: f64,
}

impl Case {
    /// Case of a number. Multiples of irrational numbers, less what is whole of them, are spread evenly, together as well.
    fn new(number: usize) -> Case {
        let share = |square: f64| (number as f64 * square.sqrt()).fract();
        let among = |[low, high]: [f64; 2], share: f64| low + share * (high - low);
        let to = among(RANGE, share(2.0));
        let from = if number.is_multiple_of(2) {
            among(FROM, share(3.0))
        } else {
            to + among([-SHORT, SHORT], share(3.0))
        };
        Case {
            profiles: PROFILES[(share(5.0) * PROFILES.len() as f64) as usize],
            load: LOADS[(share(7.0) * LOADS.len() as f64) as usize],
            from,
            to,
        }
    }

    /// Outputs of the wheel at the end, with a grid, that has started at a displacement.
    fn outputs(&self, [patch_nodes, patch_strips]: [usize; 2], start: f64) -> Result<Outputs, Error> {
        let [wheel, rail] = self.profiles;
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            slip_source: SlipSource::VehicleSpeed,
            wheel_profile: wheel.to_owned(),
            rail_profile: rail.to_owned(),
            patch_nodes,
            patch_strips,
            ..Parameters::default()
        };
        let inputs = |lateral_displacement: f64| Inputs {
            normal_load: self.load,
            vehicle_speed: SPEED,
            wheel_speed: SPEED_RATIO * SPEED / parameters.wheel_radius,
            lateral_displacement,
            ..Inputs::default()
        };
        let mut simulation = Simulation::new(&parameters, &inputs(start))?;
        for step in 1..=WAY + REST {
            let share = (step as f64 / WAY as f64).min(1.0);
            simulation.step(&inputs(start + share * (self.to - start)), DURATION)?;
        }
        Ok(*simulation.outputs())
    }
}

/// A number of sorted ones that so large a share of them does not exceed.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    sorted[(share * (sorted.len() - 1) as f64) as usize]
}

/// Median, 98 % and largest, in %.
fn spread(mut differences: Vec<f64>) -> String {
    differences.sort_unstable_by(f64::total_cmp);
    let parts = [0.5, 0.98, 1.0].map(|share| format!("{:.3}", 100.0 * quantile(&differences, share)));
    parts.join(", ")
}

/// Row of a grid.
fn row(grid: [usize; 2]) -> Result<String, Error> {
    let (mut pressures, mut forces, mut others) = (Vec::new(), Vec::new(), 0);
    let mut largest = (0.0, String::new());
    for case in (0..CASES).map(Case::new) {
        let (started, come) = (case.outputs(grid, case.to)?, case.outputs(grid, case.from)?);
        let pressure = (come.peak_pressure / started.peak_pressure - 1.0).abs();
        pressures.push(pressure);
        forces.push((come.force_y - started.force_y).abs() / case.load);
        others += usize::from(come.contacts != started.contacts);
        if pressure > largest.0 {
            let Case {
                profiles,
                load,
                from,
                to,
            } = case;
            let [started, come] = [started, come].map(|outputs| outputs.peak_pressure / 1e6);
            let text = format!(
                "{} on {}, {:.0} kN, from {:.3} to {:.3} mm: {come:.0} in place of {started:.0} MPa",
                profiles[0],
                profiles[1],
                load / 1e3,
                1e3 * from,
                1e3 * to
            );
            largest = (pressure, text);
        }
    }
    Ok(format!(
        "| {} × {} | {} | {} | {others} of {CASES} | {} |",
        grid[0],
        grid[1],
        spread(pressures),
        spread(forces),
        largest.1
    ))
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let mut out = io::stdout().lock();
    writeln!(
        out,
        "| cells | largest pressure: median, 98 %, largest [%] | F_y: median, 98 %, largest [% of the load] | other number of contacts | largest difference of pressure |"
    )?;
    writeln!(out, "|---|---|---|---|---|")?;
    for grid in GRIDS {
        writeln!(out, "{}", row(grid)?)?;
    }
    Ok(())
}
