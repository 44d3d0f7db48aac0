//! Braking from 20 m/s with a wheel slide in between: a table of what the contact does.
//!
//!     cargo run --release --example braking_curve

use wheelrail::simulation::{Error, Point, Schedule};
use wheelrail::{Inputs, Outputs, Parameters, Simulation, SlipSource};

/// The vehicle slows down by 1 m/s² from 20 m/s on.
fn point(parameters: &Parameters, time: f64, creepage: f64) -> Point {
    let vehicle_speed = 20.0 - time;
    let inputs = Inputs {
        vehicle_speed,
        wheel_speed: vehicle_speed * (1.0 + creepage) / parameters.wheel_radius,
        ..Inputs::default()
    };
    Point { time, inputs }
}

/// Time and outputs each half second.
pub fn braking() -> Result<Vec<(f64, Outputs)>, Error> {
    let parameters = Parameters {
        slip_source: SlipSource::VehicleSpeed,
        ..Parameters::default()
    };
    // Braked at a creepage of -0.065 %; from 4 s to 6 s the wheel falls behind by a fifth and recovers.
    let rows = [
        (0.0, -0.000_65),
        (4.0, -0.000_65),
        (4.5, -0.2),
        (5.5, -0.2),
        (6.0, -0.000_65),
        (9.0, -0.000_65),
    ];
    let points = rows.map(|(time, creepage)| point(&parameters, time, creepage));
    let schedule = Schedule::new(points.to_vec())?;

    let mut simulation = Simulation::new(&parameters, &schedule.start().inputs)?;
    let mut table = Vec::new();
    for (number, step) in schedule.steps(1e-3)?.enumerate() {
        simulation.follow(&step)?;
        if (number + 1) % 500 == 0 {
            table.push((step.to.time, *simulation.outputs()));
        }
    }
    Ok(table)
}

fn main() -> Result<(), Error> {
    println!("time [s]  traction [kN]  creepage [%]  temperature [K]  friction [1]  worn [mm3]");
    for (time, outputs) in braking()? {
        println!(
            "{time:8.2}  {:13.2}  {:12.2}  {:15.1}  {:12.3}  {:10.4}",
            1e-3 * outputs.traction_force,
            100.0 * outputs.slip_creepage,
            outputs.peak_temperature,
            outputs.friction_coefficient,
            1e9 * outputs.worn_volume,
        );
    }
    Ok(())
}
