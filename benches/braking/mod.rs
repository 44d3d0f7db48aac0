//! The braking manoeuvre of `examples/braking.csv`, by steps of 1 ms, and models of a given fineness: what all benchmarks
//! step through.

// Each benchmark uses a part of this.
#![allow(dead_code)]

use wheelrail::parameters::ContactModel;
use wheelrail::simulation::{Point, Schedule};
use wheelrail::{Inputs, Parameters, Simulation, SlipSource};

/// Communication step, `s`.
pub const STEP: f64 = 1e-3;
/// Where the measured stretch begins, `s`: full braking, the wheel about to slide.
const FROM: f64 = 4.0;

/// A contact window of `contact_nodes` nodes, the default wheel (elastic, of the rail's material), all effects on, moved by a
/// vehicle.
pub fn parameters(contact_nodes: usize) -> Parameters {
    Parameters {
        slip_source: SlipSource::VehicleSpeed,
        contact_nodes,
        ..Parameters::default()
    }
}

/// A patch of `cells` along its window and `strips` across it, else as [`parameters`].
pub fn patch_parameters(cells: usize, strips: usize) -> Parameters {
    Parameters {
        contact_model: ContactModel::Patch,
        slip_source: SlipSource::VehicleSpeed,
        patch_nodes: cells,
        patch_strips: strips,
        ..Parameters::default()
    }
}

/// The manoeuvre with a lateral creepage of 0.1 % and a spin of 0.3/m at most, which swing as those of a running wheelset.
pub fn swaying_manoeuvre() -> Vec<Inputs> {
    let swing = |step: usize, period: f64| (std::f64::consts::TAU * STEP * step as f64 / period).sin();
    let straight = manoeuvre().into_iter().enumerate();
    straight
        .map(|(step, inputs)| Inputs {
            lateral_speed: 1e-3 * inputs.vehicle_speed * swing(step, 1.3),
            spin_rate: 0.3 * inputs.vehicle_speed * swing(step, 0.9),
            ..inputs
        })
        .collect()
}

/// The inputs at the communication points, linear between the rows of the scenario.
pub fn manoeuvre() -> Vec<Inputs> {
    let points = include_str!("../../examples/braking.csv")
        .lines()
        .skip(1)
        .map(|line| {
            let mut cells = line.split(',').map(|cell| cell.parse().expect("a number"));
            let mut next = || cells.next().expect("four columns");
            let [time, wheel_speed, vehicle_speed, normal_load] = std::array::from_fn(|_| next());
            let inputs = Inputs {
                wheel_speed,
                vehicle_speed,
                normal_load,
                ..Inputs::default()
            };
            Point { time, inputs }
        })
        .collect();
    let schedule = Schedule::new(points).expect("rows in order");
    let steps = schedule.steps(STEP).expect("a step");
    [schedule.start().inputs]
        .into_iter()
        .chain(steps.map(|step| step.to.inputs))
        .collect()
}

/// A wheel under way through the manoeuvre.
pub struct Braking {
    pub simulation: Simulation,
    manoeuvre: Vec<Inputs>,
    next: usize,
}

impl Braking {
    /// At the beginning of the measured stretch, after a hundred steps from cold.
    pub fn new(contact_nodes: usize) -> Braking {
        Braking::through(&parameters(contact_nodes), manoeuvre())
    }

    /// With other parameters, through another manoeuvre.
    pub fn through(parameters: &Parameters, manoeuvre: Vec<Inputs>) -> Braking {
        let next = (FROM / STEP) as usize - 100;
        let simulation = Simulation::new(parameters, &manoeuvre[next]).expect("a model");
        let mut braking = Braking {
            simulation,
            manoeuvre,
            next,
        };
        for _ in 0..100 {
            braking.step();
        }
        braking
    }

    /// One communication step; after the last one the manoeuvre begins again.
    pub fn step(&mut self) {
        self.next += 1;
        if self.next == self.manoeuvre.len() {
            self.next = 0;
        }
        self.simulation.step(&self.manoeuvre[self.next], STEP).expect("a step");
    }

    /// Steps from here to the end of the manoeuvre.
    pub fn remaining(&self) -> usize {
        self.manoeuvre.len() - 1 - self.next
    }

    /// Nodes under pressure.
    pub fn nodes_in_contact(&self) -> usize {
        let nodes = self.simulation.contact_nodes();
        nodes.iter().filter(|node| node.pressure > 0.0).count()
    }
}
