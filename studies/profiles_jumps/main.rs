//! Steps of profiles in which the wheel moves across the rail: is each what the wheel settles at where it has come to?
//!
//!     cargo run --release --example profiles_jumps
//!
//! Wheels go from the tread to the flange by equal ways in steps of 5 ms, at 20 m/s: heat and shear are steady within a step. Every step is compared with the second of two
//! more at the same place. The cases are spread evenly over profiles, loads, yaw angles, ways and where they begin.
//!
//! A row for each way: how many steps are off by more than 1 % of the load in the force across the track, or more than 10 % in the largest pressure; how many of these have another number
//! of contacts than the wheel settles at; the largest of both errors; how many steps say that the contact fills its window.

use std::io::{self, Write};
use wheelrail::Error;
use wheelrail::parameters::{ContactModel, FrictionLaw, Parameters, SlipSource};
use wheelrail::signals::Inputs;
use wheelrail::simulation::Simulation;

/// Ways in a step, `m`.
const WAYS: [f64; 6] = [0.01e-3, 0.05e-3, 0.1e-3, 0.2e-3, 0.5e-3, 1e-3];
/// Steps that are compared for each way.
const STEPS: usize = 2000;
const RAILS: [&str; 4] = ["60E1", "UIC60", "54E1", "49E1"];
/// Vertical loads, `N`.
const LOADS: [f64; 4] = [10e3, 20e3, 50e3, 80e3];
/// Displacements between which a wheel moves, `m`.
const RANGE: [f64; 2] = [2.5e-3, 9e-3];
/// Largest yaw angle, `rad`.
const YAW: f64 = 6e-3;
const SPEED: f64 = 20.0;
/// Time of a step, `s`.
const DURATION: f64 = 5e-3;
/// Steps of a wheel, at most, before the next case.
const DRIVE: usize = 40;

/// What the steps of a way are off by.
#[derive(Debug, Default)]
struct Errors {
    steps: usize,
    off: usize,
    others: usize,
    fills: usize,
    force: f64,
    pressure: f64,
}

impl Errors {
    /// Goes through the steps of a case of a number.
    fn drive(&mut self, way: f64, number: usize) -> Result<(), Error> {
        let share = |square: f64| (number as f64 * square.sqrt()).fract();
        let among = |[low, high]: [f64; 2], share: f64| low + share * (high - low);
        let parameters = Parameters {
            contact_model: ContactModel::Profiles,
            slip_source: SlipSource::VehicleSpeed,
            rail_profile: RAILS[(share(5.0) * RAILS.len() as f64) as usize].to_owned(),
            friction_law: FrictionLaw::Constant,
            friction_cold: 0.3,
            ..Parameters::default()
        };
        let load = LOADS[(share(7.0) * LOADS.len() as f64) as usize];
        let inputs = |lateral_displacement: f64| Inputs {
            normal_load: load,
            vehicle_speed: SPEED,
            wheel_speed: SPEED / parameters.wheel_radius,
            yaw_angle: among([-YAW, YAW], share(3.0)),
            lateral_displacement,
            ..Inputs::default()
        };
        let mut at = among(RANGE, share(2.0));
        let mut simulation = Simulation::new(&parameters, &inputs(at))?;
        for _ in 0..DRIVE {
            at += way;
            // Beyond the flange: the next case.
            if at > RANGE[1] || simulation.step(&inputs(at), DURATION).is_err() {
                break;
            }
            let found = *simulation.outputs();
            let (fills, moved) = (simulation.state.convergence.fills_window, simulation.state.clone());
            let settled = *simulation.hold(&inputs(at), 2.0 * DURATION, 2)?;
            simulation.state = moved;
            let force = (found.force_y - settled.force_y).abs() / load;
            let pressure = (found.peak_pressure / settled.peak_pressure - 1.0).abs();
            self.steps += 1;
            self.fills += usize::from(fills);
            let is_off = force > 0.01 || pressure > 0.1;
            self.off += usize::from(is_off);
            self.others += usize::from(is_off && found.contacts != settled.contacts);
            self.force = self.force.max(force);
            self.pressure = self.pressure.max(pressure);
        }
        Ok(())
    }
}

fn main() -> Result<(), Error> {
    let mut out = io::stdout().lock();
    let header = "| way in a step in mm | steps | off | of these other number of contacts | force in % of the load, pressure in %, at most | window full |\n|---|---|---|---|---|---|";
    writeln!(out, "{header}").unwrap_or_default();
    for way in WAYS {
        let (mut errors, mut number) = (Errors::default(), 0);
        while errors.steps < STEPS {
            number += 1;
            errors.drive(way, number)?;
        }
        let Errors {
            steps,
            off,
            others,
            fills,
            force,
            pressure,
        } = errors;
        let (force, pressure) = (100.0 * force, 100.0 * pressure);
        writeln!(
            out,
            "| {:.2} | {steps} | {off} | {others} | {force:.2}, {pressure:.1} | {fills} |",
            1e3 * way
        )
        .unwrap_or_default();
    }
    Ok(())
}
