//! One warm contact at a given creepage, through the C functions of the shared library and natively, at default settings:
//! the wheel is elastic, of the rail's material.

// Each benchmark uses a part of this.
#![allow(dead_code, unused_imports)]

#[path = "../../tests/fmi/importer/mod.rs"]
pub mod common;

use common::{Api, Client, OK};
use wheelrail::{Inputs, Parameters, Simulation};

const CREEPAGE: f64 = 0.004;
/// Communication step, `s`.
pub const STEP: f64 = 1e-3;
/// Steps from cold until the measurements begin: 0.1 s.
const WARM_UP: u32 = 100;

/// An instance in *stepComplete* after the warm-up, and its time.
pub fn instance(api: &Api) -> (Client<'_>, f64) {
    let client = Client::new(api);
    client.expect(OK, client.begin(0.0, None));
    client.expect(OK, client.set(&[("creepage", CREEPAGE)]));
    client.expect(OK, client.exit());
    let mut time = 0.0;
    for _ in 0..WARM_UP {
        client.expect(OK, client.step(time, STEP));
        time += STEP;
    }
    (client, time)
}

/// The inputs of both.
pub fn inputs() -> Inputs {
    Inputs {
        creepage: CREEPAGE,
        ..Inputs::default()
    }
}

/// The same without the interface.
pub fn native() -> Simulation {
    let mut run = Simulation::new(&Parameters::default(), &inputs()).expect("a model");
    run.hold(&inputs(), STEP, WARM_UP as usize).expect("steps");
    run
}
