//! A simulation saved as bytes in the middle of its way, and resumed: the same bits as without the break.
//!
//!     cargo run --release --example save_and_resume

use std::error::Error;
use wheelrail::simulation::{Point, Schedule};
use wheelrail::{Inputs, Model, Parameters, Simulation, State};

/// The states at the end: without a break, and resumed.
pub fn both_ways() -> Result<[State; 2], Box<dyn Error>> {
    let rolling = Inputs::default();
    let sliding = Inputs {
        creepage: 0.02,
        ..rolling
    };
    let schedule = Schedule::new(vec![
        Point {
            time: 0.0,
            inputs: rolling,
        },
        Point {
            time: 1.0,
            inputs: sliding,
        },
    ])?;
    let steps = schedule.steps(1e-3)?;

    // Half of the way, then the state as bytes: in any format that serde knows, postcard here.
    let mut simulation = Simulation::new(&Parameters::default(), &rolling)?;
    for step in steps.clone().take(500) {
        simulation.follow(&step)?;
    }
    let bytes = postcard::to_allocvec(&simulation.state)?;
    println!("{} bytes at {} s", bytes.len(), simulation.state.time);
    for step in steps.clone().skip(500) {
        simulation.follow(&step)?;
    }

    // In another process, say: a model of the same parameters, the bytes, and the rest of the way.
    // (A model with profiles from files keeps their contents, `Model::profile_contents`, for `Model::with_contents` here: files change.)
    let state: State = postcard::from_bytes(&bytes)?;
    let mut resumed = Simulation::resume(Model::new(Parameters::default())?.into(), state)?;
    for step in steps.skip(500) {
        resumed.follow(&step)?;
    }
    Ok([simulation.state, resumed.state])
}

fn main() -> Result<(), Box<dyn Error>> {
    let [whole, resumed] = both_ways()?;
    println!("without a break: {} J of friction", whole.outputs.friction_energy);
    println!("resumed:         {} J of friction", resumed.outputs.friction_energy);
    assert_eq!(whole, resumed);
    Ok(())
}
