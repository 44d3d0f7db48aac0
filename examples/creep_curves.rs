//! Creep curves at several speeds, one thread for each, over one model that they share.
//!
//!     cargo run --release --example creep_curves

use std::sync::Arc;
use std::thread;
use wheelrail::{Error, Inputs, Model, Parameters, Simulation};

/// m/s.
pub const SPEEDS: [f64; 4] = [5.0, 10.0, 20.0, 40.0];
/// 1.
pub const CREEPAGES: [f64; 7] = [0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1];

/// Traction coefficient at each creepage, at a rolling speed in m/s.
fn curve(model: Arc<Model>, speed: f64) -> Result<Vec<f64>, Error> {
    let radius = model.parameters().wheel_radius;
    let inputs = |creepage| Inputs {
        creepage,
        wheel_speed: speed * (1.0 + creepage) / radius,
        ..Inputs::default()
    };
    let mut simulation = Simulation::of(model, &inputs(0.0))?;
    CREEPAGES
        .iter()
        // Ten metres: what the creepage before has left on the strip of 4 m is gone.
        .map(|&creepage| {
            Ok(simulation
                .hold(&inputs(creepage), 0.1 / speed, 100)?
                .traction_coefficient)
        })
        .collect()
}

/// A curve for each speed.
pub fn curves() -> Result<Vec<Vec<f64>>, Error> {
    let model = Arc::new(Model::new(Parameters::default())?);
    thread::scope(|scope| {
        SPEEDS
            .map(|speed| {
                let model = model.clone();
                scope.spawn(move || curve(model, speed))
            })
            .map(|thread| thread.join().expect("a thread that did not panic"))
            .into_iter()
            .collect()
    })
}

fn main() -> Result<(), Error> {
    let curves = curves()?;
    println!("traction coefficient; heat lowers the friction coefficient, the more the faster the wheel rolls");
    print!("creepage ");
    SPEEDS.iter().for_each(|speed| print!("{speed:>7} m/s"));
    println!();
    for (row, creepage) in CREEPAGES.iter().enumerate() {
        print!("{creepage:<9}");
        curves.iter().for_each(|curve| print!("{:>11.4}", curve[row]));
        println!();
    }
    Ok(())
}
